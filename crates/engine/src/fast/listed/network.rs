//! Springs, tethers and drive of an elastic wall, eight spheres of a ring at a time.
//!
//! The spheres of a ring are neighbours in memory and their bonds follow from their places: next on the ring, two on the
//! ring above. Rings are turned into lanes one by one; the forces of a ring's bonds on the ring above are carried on to it.

use peristalsis_physics::real::{Real, Vector};

use super::record::{self, Record};
use super::spheres::Moving;
use super::terms::{Book, WallTerms};
use crate::fast::columns::LineColumns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask, Quad};
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::fast::threads::THREADS_EXIST;
use crate::ledger::Tally;
use crate::wall::{DriveAngle, ElasticWall, NetForce};

/// Where the first sphere of a ring stands: at the start of a line of the cache, which loads and stores then do not cross.
const FIRST: usize = LANES;

/// Vectors of the spheres of a ring: sphere p at `FIRST` + p; before and after them stand copies of the last and first, which
/// are their neighbours.
impl LineColumns {
    /// Copies the ends round.
    #[inline(always)]
    fn close(&mut self, count: usize) {
        for component in self.each() {
            component[FIRST - 1] = component[FIRST + count - 1];
            component[FIRST + count] = component[FIRST];
        }
    }
}

/// The spheres of a ring.
#[derive(Clone, Debug, Default)]
struct Ring {
    place: LineColumns,
    velocity: LineColumns,
    /// Turns round the tube, sphere p at p.
    turns: Vec<f64>,
}

impl Ring {
    fn clear(&mut self, room: usize) {
        self.place.clear(room);
        self.velocity.clear(room);
        self.turns.clear();
        self.turns.resize(room, 0.0);
    }

    /// Takes up the first so many spheres. The lanes behind them may hold others, whose numbers nobody reads.
    #[inline(always)]
    fn take_up<M: Machine>(
        &mut self,
        (position, velocity): (&[Record], &[Record]),
        spheres: usize,
    ) {
        let room = room_for(spheres);
        let mut places = self.place.first_mut(room);
        let mut velocities = self.velocity.first_mut(room);
        for start in (0..spheres).step_by(LANES) {
            let (vectors, turns) = record::into_lanes::<M>(eight_from::<M>(&position[start..]));
            places.store(FIRST + start, vectors);
            turns.store(&mut self.turns, start);
            let (vectors, _) = record::into_lanes::<M>(eight_from::<M>(&velocity[start..]));
            velocities.store(FIRST + start, vectors);
        }
        self.place.close(spheres);
        self.velocity.close(spheres);
    }
}

/// The first eight records, with zeros where there are fewer.
#[inline(always)]
fn eight_from<M: Machine>(records: &[Record]) -> [Quad<M>; LANES] {
    let mut few = [Record::ZERO; LANES];
    // Read in place: a copy would be written and read in registers of other widths, and the reading would wait.
    let records = match records.first_chunk() {
        Some(eight) => eight,
        None => {
            few[..records.len()].copy_from_slice(records);
            &few
        }
    };
    let mut eight = [Quad::<M>::splat(0.0); LANES];
    for lane in 0..LANES {
        eight[lane] = records[lane].quad();
    }
    eight
}

/// Room for the forces on a ring.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Forces of the bonds: along the ring, and to the two spheres above.
    along: LineColumns,
    first: LineColumns,
    second: LineColumns,
    /// Force of the bonds from the ring below.
    carried: LineColumns,
    force: LineColumns,
    cos: [Vec<f64>; 2],
    sin: [Vec<f64>; 2],
}

/// Length of the columns for a ring of so many spheres.
fn room_for(spheres: usize) -> usize {
    FIRST + spheres.next_multiple_of(LANES) + LANES
}

impl Rows {
    fn resize(&mut self, wall: &ElasticWall) {
        let spheres = wall.lattice().spheres_per_ring as usize;
        for row in [
            &mut self.along,
            &mut self.first,
            &mut self.second,
            &mut self.carried,
            &mut self.force,
        ] {
            row.clear(room_for(spheres));
        }
        let room = spheres.next_multiple_of(LANES);
        for parity in 0..2 {
            let directions = &wall.directions[parity * spheres..(parity + 1) * spheres];
            self.cos[parity].clear();
            self.cos[parity].extend(directions.iter().map(|direction| direction.0));
            self.cos[parity].resize(room, 0.0);
            self.sin[parity].clear();
            self.sin[parity].extend(directions.iter().map(|direction| direction.1));
            self.sin[parity].resize(room, 0.0);
        }
    }
}

/// Room for the rings of a section, and what their forces and velocities come to.
#[derive(Clone, Debug, Default)]
pub(super) struct Rings {
    /// The ring at hand, and the one above it, in turn.
    at_hand: [Ring; 2],
    rows: Rows,
    /// Sums of the forces on the spheres of each ring, and of their velocities, for another thread to read. A core waits to
    /// write where another has read, so they are written here all at once.
    pub(super) of_rings: Vec<[Record; 2]>,
    /// Room: the same, ring by ring.
    sums: Vec<[Record; 2]>,
    /// Where there are several sections.
    pub(super) terms: WallTerms,
}

/// Adds all forces on the spheres of the rings of a section except contact forces, which must be there already, and the
/// mean force that is taken off all.
pub(super) struct WallForces<'a> {
    pub(super) wall: &'a ElasticWall,
    pub(super) rings: &'a mut Rings,
    pub(super) spheres: Moving<'a>,
    /// The places of the spheres of the wall.
    pub(super) places: &'a [u32],
    /// The first of them that is in the section.
    pub(super) first: usize,
    pub(super) force: &'a mut [Record],
    /// Where the sums go at once; without it they become the terms of the rings.
    pub(super) tally: Option<&'a mut Tally>,
    /// Whether energies are wanted.
    pub(super) complete: bool,
}

impl Work for WallForces<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(mut self) {
        self.rings.terms.clear();
        match self.tally.take() {
            Some(tally) => {
                let mut sums = Sums::<M>::default();
                self.add_to::<M>(&mut sums);
                sums.add_to(tally);
            }
            None if !THREADS_EXIST => unreachable!("one thread adds up at once"),
            None => {
                let mut terms = core::mem::take(&mut self.rings.terms);
                self.add_to::<M>(&mut terms);
                self.rings.terms = terms;
            }
        }
    }
}

impl WallForces<'_> {
    #[inline(always)]
    fn add_to<M: Machine>(&mut self, book: &mut impl Book<M>) {
        let network = &self.wall.parameters().network;
        let dissipates = network.spring_damping != 0.0 || network.drag != 0.0;
        match self.complete || dissipates {
            true => self.add::<M, _, true>(book),
            false => self.add::<M, _, false>(book),
        }
    }

    /// With or without energies and dissipation.
    #[inline(always)]
    fn add<M: Machine, B: Book<M>, const ALL: bool>(&mut self, book: &mut B) {
        let wall = self.wall;
        let Rings {
            at_hand: [here, above],
            rows,
            of_rings,
            sums: sums_of_rings,
            ..
        } = &mut *self.rings;
        let Moving {
            position, velocity, ..
        } = self.spheres;
        let lattice = wall.lattice();
        let (per_ring, all) = (lattice.spheres_per_ring as usize, lattice.rings() as usize);
        if rows.cos[0].len() != per_ring.next_multiple_of(LANES) || rows.force.is_empty() {
            here.clear(room_for(per_ring));
            above.clear(room_for(per_ring));
            rows.resize(wall);
        }
        let (mut here, mut above) = (here, above);
        // The spheres of a ring are in one section, one after the other.
        let start = |ring: usize| self.places[ring * per_ring] as usize;
        let from = |ring: usize| (&position[start(ring)..], &velocity[start(ring)..]);
        of_rings.clear();
        sums_of_rings.clear();
        let first = (0..all).find(|&ring| start(ring) == self.first);
        let Some(first) = first else {
            return;
        };

        // Forces of the bonds of the ring below on the first.
        here.take_up::<M>(from((first + all - 1) % all), per_ring);
        above.take_up::<M>(from(first), per_ring);
        bonds::<M, _, ALL>(
            wall,
            [here, above],
            rows,
            (first + 1) % 2,
            &mut Sums::<M>::default(),
        );
        let rings = self.force.chunks_exact_mut(per_ring);
        for (ring, forces) in (first..).zip(rings) {
            core::mem::swap(&mut here, &mut above);
            above.take_up::<M>(from((ring + 1) % all), per_ring);
            carry::<M>(rows, ring % 2, per_ring);
            bonds::<M, _, ALL>(wall, [here, above], rows, ring % 2, book);
            tethers_and_drive::<M, _, ALL>(wall, here, rows, ring, book);
            let mut sums = [Quad::<M>::splat(0.0); 2];
            let (blocks, rest) = forces.as_chunks_mut::<LANES>();
            let (velocities, rest_velocities) =
                velocity[start(ring)..][..per_ring].as_chunks::<LANES>();
            let of_rest = blocks.len() * LANES;
            for (block, (forces, velocities)) in blocks.iter_mut().zip(velocities).enumerate() {
                add_eight::<M>(&rows.force, block * LANES, forces, velocities, &mut sums);
            }
            add_eight::<M>(&rows.force, of_rest, rest, rest_velocities, &mut sums);
            let [ring_force, ring_velocity] = sums;
            if wall.parameters().network.tethers.net_force == NetForce::RemovedPerRing {
                let mean = ring_force * (1.0 / per_ring as f64);
                for force in forces.iter_mut() {
                    *force = (force.quad() - mean).record();
                }
            }
            sums_of_rings.push([ring_force.record(), ring_velocity.record()]);
        }
        of_rings.extend_from_slice(sums_of_rings);
    }
}

/// Adds the forces of up to eight spheres of a ring, from sphere `start` on, to those of their contacts; the sums over the
/// ring go on.
#[inline(always)]
fn add_eight<M: Machine>(
    more: &LineColumns,
    start: usize,
    forces: &mut [Record],
    velocities: &[Record],
    [ring_force, ring_velocity]: &mut [Quad<M>; 2],
) {
    let more = record::from_lanes(more.load::<M>(FIRST + start), Lanes::splat(0.0));
    for ((force, velocity), more) in forces.iter_mut().zip(velocities).zip(more) {
        let whole = force.quad() + more;
        *force = whole.record();
        *ring_force = *ring_force + whole;
        *ring_velocity = *ring_velocity + velocity.quad();
    }
}

/// Turns the forces of the last ring's bonds into forces on this ring, whose parity is `parity`.
#[inline(always)]
fn carry<M: Machine>(rows: &mut Rows, parity: usize, per_ring: usize) {
    rows.first.close(per_ring);
    rows.second.close(per_ring);
    // The ring below has the other parity; its place p is bound to the places p - 1 + o and p + o here, o its parity.
    let odd = 1 - parity;
    for start in (0..per_ring).step_by(LANES) {
        let on_these =
            rows.first.load::<M>(FIRST + start + 1 - odd) + rows.second.load(FIRST + start - odd);
        rows.carried.store(FIRST + start, -on_these);
    }
}

/// A spring with a dashpot beside it.
struct Bond<M: Machine> {
    stiffness: Lanes<M>,
    natural_length: Lanes<M>,
    /// Of the dashpot, if there is one.
    damping: Option<Lanes<M>>,
    length: f64,
}

impl<M: Machine> Bond<M> {
    /// Force on the spheres at `place` of bonds to the spheres at `place_there`.
    #[inline(always)]
    fn force(
        &self,
        (place, velocity): (LaneVector<M>, LaneVector<M>),
        (place_there, velocity_there): (LaneVector<M>, LaneVector<M>),
        valid: Mask<M>,
        [energy, dissipation]: &mut [Lanes<M>; 2],
    ) -> LaneVector<M> {
        let zero = Lanes::splat(0.0);
        let separation = record::periodic(place - place_there, self.length);
        let distance = separation.squared().sqrt();
        let inverse = Lanes::splat(1.0) / distance;
        let stretch = distance - self.natural_length;
        let mut pull = self.stiffness * stretch;
        *energy = Lanes::select(valid, Lanes::splat(0.5) * (pull * stretch), zero);
        if let Some(damping) = self.damping {
            let rate = (velocity - velocity_there).dot(separation) * inverse;
            pull += damping * rate;
            *dissipation = Lanes::select(valid, damping * (rate * rate), zero);
        }
        separation * (-(pull * inverse))
    }
}

/// Forces of the bonds of a ring of parity `parity`.
#[inline(always)]
fn bonds<M: Machine, B: Book<M>, const ALL: bool>(
    wall: &ElasticWall,
    [here, above]: [&Ring; 2],
    rows: &mut Rows,
    parity: usize,
    book: &mut B,
) {
    let parameters = wall.parameters();
    let per_ring = parameters.lattice.spheres_per_ring as usize;
    let network = &parameters.network;
    let damped = ALL && network.spring_damping != 0.0;
    let bond = Bond {
        stiffness: Lanes::splat(network.spring_stiffness),
        natural_length: Lanes::splat(network.natural_length),
        damping: damped.then_some(Lanes::splat(network.spring_damping)),
        length: parameters.lattice.length(),
    };
    let room = room_for(per_ring);
    let (place, velocity) = (here.place.first(room), here.velocity.first(room));
    let place_above = above.place.first(room);
    let velocity_above = above.velocity.first(room);
    let mut on_along = rows.along.first_mut(room);
    let mut on_first = rows.first.first_mut(room);
    let mut on_second = rows.second.first_mut(room);
    for start in (0..per_ring).step_by(LANES) {
        let valid = Mask::first(per_ring - start);
        let here = (place.load(FIRST + start), velocity.load(FIRST + start));
        let next = (
            place.load(FIRST + start + 1),
            velocity.load(FIRST + start + 1),
        );
        let first = (
            place_above.load(FIRST + start + parity - 1),
            velocity_above.load(FIRST + start + parity - 1),
        );
        let second = (
            place_above.load(FIRST + start + parity),
            velocity_above.load(FIRST + start + parity),
        );
        let mut terms = [[Lanes::splat(0.0); 2]; 3];
        let along = bond.force(here, next, valid, &mut terms[0]);
        let first = bond.force(here, first, valid, &mut terms[1]);
        let second = bond.force(here, second, valid, &mut terms[2]);
        if ALL {
            book.bonds(terms);
        }
        on_along.store(FIRST + start, along);
        on_first.store(FIRST + start, first);
        on_second.store(FIRST + start, second);
    }
    rows.along.close(per_ring);
}

/// Sums all forces on the spheres of a ring except contact forces.
#[inline(always)]
fn tethers_and_drive<M: Machine, B: Book<M>, const ALL: bool>(
    wall: &ElasticWall,
    here: &Ring,
    rows: &mut Rows,
    ring: usize,
    book: &mut B,
) {
    let parameters = wall.parameters();
    let lattice = &parameters.lattice;
    let (length, wavelength) = (lattice.length(), lattice.wavelength);
    let per_ring = lattice.spheres_per_ring as usize;
    let (zero, half, balance) = (
        Lanes::<M>::splat(0.0),
        Lanes::splat(0.5),
        Lanes::splat(wall.balance),
    );
    let network = &parameters.network;
    let tethers = network.tethers;
    let (radial, azimuthal, axial) = (
        Lanes::splat(tethers.radial),
        Lanes::splat(tethers.azimuthal),
        Lanes::splat(tethers.axial),
    );
    let (drags, drag) = (network.drag != 0.0, Lanes::splat(network.drag));
    let radius = Lanes::splat(parameters.mean_radius);
    let reference_z = Lanes::splat(lattice.axial_position(ring as u32));
    let parity = ring % 2;
    let (room, in_lanes) = (room_for(per_ring), per_ring.next_multiple_of(LANES));
    let (places, velocities) = (here.place.first(room), here.velocity.first(room));
    let (along, carried) = (rows.along.first(room), rows.carried.first(room));
    let (first, second) = (rows.first.first(room), rows.second.first(room));
    let (cos, sin) = (&rows.cos[parity][..in_lanes], &rows.sin[parity][..in_lanes]);
    let turns = &here.turns[..in_lanes];
    let mut force = rows.force.first_mut(room);
    for start in (0..per_ring).step_by(LANES) {
        let valid = Mask::first(per_ring - start);
        let place = places.load(FIRST + start);
        let velocity = velocities.load(FIRST + start);
        let (cos, sin) = (Lanes::load(cos, start), Lanes::load(sin, start));
        let (x, y) = (place.x - radius * cos, place.y - radius * sin);
        let away_radial = x * cos + y * sin;
        let away_across = y * cos - x * sin;
        let turns = Lanes::load(turns, start);
        let away_axial = place.z + turns * Lanes::splat(length) - reference_z;
        let outward = balance - radial * away_radial;
        let across = -(azimuthal * away_across);
        let phase = Lanes::splat(parameters.heading) * place.z / Lanes::splat(wavelength)
            - Lanes::splat(wall.cycles);
        let push = Lanes::splat(wall.amplitude) * parameters.waveform.value_by_series(phase);
        let (drive_cos, drive_sin) = match parameters.angle {
            DriveAngle::Reference => (cos, sin),
            DriveAngle::Current => {
                let from_axis = (place.x * place.x + place.y * place.y).sqrt();
                let off_axis = zero.less(from_axis);
                (
                    Lanes::select(off_axis, place.x / from_axis, zero),
                    Lanes::select(off_axis, place.y / from_axis, zero),
                )
            }
        };
        let (drive_x, drive_y) = (push * drive_cos, push * drive_sin);
        let drive_power = drive_x * velocity.x + drive_y * velocity.y;
        book.drive(Lanes::select(valid, drive_power, zero));
        if ALL {
            let keep_energy = half
                * (radial * away_radial * away_radial
                    + azimuthal * away_across * away_across
                    + axial * away_axial * away_axial)
                - balance * away_radial;
            let dissipation = drag * velocity.squared();
            book.tethers([
                Lanes::select(valid, keep_energy, zero),
                Lanes::select(valid, dissipation, zero),
            ]);
        }
        let tethers_and_drive = LaneVector::new(
            drive_x + (outward * cos - across * sin),
            drive_y + (outward * sin + across * cos),
            -(axial * away_axial),
        );
        let tethers_and_drive = match drags {
            true => tethers_and_drive - velocity * drag,
            false => tethers_and_drive,
        };
        let springs = (along.load(FIRST + start) - along.load(FIRST + start - 1))
            + (first.load(FIRST + start) + second.load(FIRST + start))
            + carried.load(FIRST + start);
        force.store(FIRST + start, springs + tethers_and_drive);
    }
}
