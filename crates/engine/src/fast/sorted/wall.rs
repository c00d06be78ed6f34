//! Contacts with the spheres of a prescribed wall, eight grains at a time.
//!
//! First all grains look at the rings within reach along the tube; pairs of a grain and a ring whose circle is within its
//! reach are packed as candidates, so that from then on no lane is idle. Then each candidate is turned to the sphere of
//! its ring that is nearest to the grain, and mirrored so that the next sphere lies on the side of positive angles. From
//! there all lanes walk together outward from sphere to sphere, at angles that are the same for all, until no lane
//! touches: the distance to the spheres of a ring grows in that order. In the end the forces go back to the grains, ring
//! by ring.

use peristalsis_physics::contact::{NormalLaw, reduced_radius};
use peristalsis_physics::real::Real;
use peristalsis_physics::wall::Lattice;
use peristalsis_physics::wall::lattice::approximate_angle;

use super::candidates::{Candidates, MOST_EIGHTS};
use super::distances::{Distances, Near};
use super::pairs::Block;
use crate::fast::columns::{ColumnsMut, ColumnsRef};
use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::Machine;
use crate::fast::sums::Sums;
use crate::wall::Wall;

/// The wall at one step, as the kernel reads it.
#[derive(Clone, Debug, Default)]
pub(super) struct WallTable {
    /// Radius of each ring of a wavelength and of those behind it, two by two.
    radii: Vec<[[f64; 2]; RINGS / 2]>,
    /// Radius and its velocity for the rings of a wavelength.
    rings: Vec<[f64; 2]>,
    /// cos and sin of the angles of wall spheres by half steps, a little more than a turn.
    directions: Vec<[f64; 2]>,
    /// cos and sin of the angles, from the nearest sphere of a ring, at which its spheres stand, from the nearest outward.
    outward: Vec<(f64, f64)>,
    /// tan of the angle of half a step.
    half_step: f64,
    /// Half steps by which every other ring is turned.
    turn: f64,
    rings_per_wave: f64,
    waves_per_ring: f64,
    half_steps_per_radian: f64,
    spacing: f64,
    rings_per_length: f64,
    reach: f64,
    reduced_radius: f64,
    /// Radius below which a grain's distance from the axis keeps it clear of every ring.
    clear: f64,
    /// How far beyond a grain the rings begin that are within its reach, less a half.
    rings_within: f64,
    /// How many rings can be in reach of a grain.
    most_rings: usize,
}

/// Rings that are looked at one after another.
const RINGS: usize = 8;

/// Added to the reach, in rings, so that rounding leaves no ring at its edge out.
const MARGIN: f64 = 1e-9;

/// How many rings can be within reach of a grain.
pub(super) fn rings_in_reach(lattice: &Lattice, diameter: f64) -> usize {
    let reach = 0.5 * (diameter + lattice.sphere_diameter);
    (2.0 * (reach / lattice.spacing() + MARGIN)) as usize + 1
}

impl WallTable {
    /// The tables that do not move, for grains of diameter `diameter`.
    pub(super) fn new(lattice: &Lattice, diameter: f64) -> Self {
        let per_ring = lattice.spheres_per_ring;
        let reach = 0.5 * (diameter + lattice.sphere_diameter);
        let angle = |half_steps: f64| half_steps * core::f64::consts::PI / f64::from(per_ring);
        let direction =
            |half_steps: f64| (libm::cos(angle(half_steps)), libm::sin(angle(half_steps)));
        let rings_per_wave = lattice.rings_per_wave as usize;
        let most_rings = rings_in_reach(lattice, diameter);
        let directions = (0..2 * per_ring + 4)
            .map(|step| direction(f64::from(step % (2 * per_ring))).into())
            .collect();
        // From the nearest sphere: 0, 2, -2, 4, ... half steps.
        let place =
            |index: u32| f64::from(index.div_ceil(2)) * if index % 2 == 1 { 2.0 } else { -2.0 };
        let outward = (0..per_ring).map(|index| direction(place(index))).collect();
        Self {
            radii: vec![[[0.0; 2]; RINGS / 2]; rings_per_wave],
            rings: vec![[0.0; 2]; rings_per_wave],
            directions,
            outward,
            half_step: libm::tan(angle(1.0).min(1.0)),
            turn: if lattice.staggered { 1.0 } else { 0.0 },
            rings_per_wave: f64::from(lattice.rings_per_wave),
            waves_per_ring: 1.0 / f64::from(lattice.rings_per_wave),
            half_steps_per_radian: f64::from(per_ring) / core::f64::consts::PI,
            spacing: lattice.spacing(),
            rings_per_length: 1.0 / lattice.spacing(),
            reach,
            rings_within: reach / lattice.spacing() + MARGIN - 0.5,
            most_rings,
            reduced_radius: reduced_radius(diameter, lattice.sphere_diameter),
            ..Self::default()
        }
    }

    /// Takes over the rings where they are now.
    pub(super) fn follow(&mut self, wall: &Wall) {
        let wall = wall.prescribed().expect("a wall that this kernel serves");
        let rings = &wall.rings().expect("a wall of rings").rings;
        for (entry, ring) in self.rings.iter_mut().zip(rings) {
            *entry = [ring.radius, ring.velocity];
        }
        let mut behind = rings.iter().cycle();
        for radii in &mut self.radii {
            let from_here = behind.clone();
            for (radius, ring) in radii.as_flattened_mut().iter_mut().zip(from_here) {
                *radius = ring.radius;
            }
            behind.next();
        }
        self.clear = (wall.wave().throat_radius() - self.reach).max(0.0);
    }

    /// How many rings can be within reach of a grain.
    pub(super) fn most_rings(&self) -> usize {
        self.most_rings
    }

    /// Finds the rings that the grains of a block may touch.
    #[inline(always)]
    pub(super) fn find_candidates<M: Machine>(
        &self,
        block: &Block<M>,
        first_place: usize,
        candidates: &mut Candidates,
    ) {
        let LaneVector { x, y, z } = block.position;
        let from_axis_squared = x * x + y * y;
        let may_touch = Lanes::splat(self.clear * self.clear).less(from_axis_squared) & block.holds;
        // A throat narrower than the reach touches even a grain on the axis.
        if self.clear > 0.0 && !may_touch.any() {
            return;
        }

        // No sphere of a ring is nearer than the ring itself.
        let from_axis = from_axis_squared.lone_sqrt();
        let reach_squared = Lanes::splat(self.reach * self.reach);
        let mut ring = self.first_ring(z);
        let mut before = 0.0;
        let most = self.most_rings as f64;
        while before < most {
            let radii = Lanes::<M>::look_up(&self.radii, self.in_wave(ring));
            let [a, b, c, d, e, f, g, h] = radii;
            for two in 0..RINGS / 2 {
                let pairs = [
                    &a[two], &b[two], &c[two], &d[two], &e[two], &f[two], &g[two], &h[two],
                ];
                for radius in Lanes::<M>::of_pairs(pairs) {
                    let dz = z - ring * Lanes::splat(self.spacing);
                    let gap = radius - from_axis;
                    let meet = (gap * gap + dz * dz).less(reach_squared) & block.holds;
                    if meet.any() {
                        candidates.add(first_place, meet, before);
                    }
                    ring += Lanes::splat(1.0);
                    before += 1.0;
                    if before >= most {
                        return;
                    }
                }
            }
        }
    }

    /// Turns all candidates to the nearest sphere of their ring, and mirrors them; positions and velocities begin with those of
    /// the tile.
    #[inline(always)]
    pub(super) fn turn_to_nearest<M: Machine>(
        &self,
        position: ColumnsRef<'_>,
        velocity: ColumnsRef<'_>,
        candidates: &mut Candidates,
    ) {
        candidates.fill_up();
        for (at, _) in candidates.eights::<M>() {
            let (places, before) = candidates.pairs::<M>(at);
            let LaneVector { x, y, z } = position.gather(places);
            let velocity = velocity.gather(places);
            let ring = self.first_ring(z) + before;
            let [radius, ring_velocity] =
                Lanes::<M>::of_pairs(Lanes::<M>::look_up(&self.rings, self.in_wave(ring)));
            let parity = {
                let (half, _) = (ring * Lanes::splat(0.5) - Lanes::splat(0.25)).round();
                (ring - Lanes::splat(2.0) * half) * Lanes::splat(self.turn)
            };
            let half_steps = approximate_angle(x, y) * Lanes::splat(self.half_steps_per_radian);
            let (sphere, _) = ((half_steps - parity) * Lanes::splat(0.5)).round();
            let (_, direction) = (Lanes::splat(2.0) * sphere + parity).round();
            let [cos, sin] = Lanes::<M>::of_pairs(Lanes::<M>::look_up(&self.directions, direction));
            let across = y * cos - x * sin;
            let side = Lanes::select(
                across.less(Lanes::splat(0.0)),
                Lanes::splat(-1.0),
                Lanes::splat(1.0),
            );
            let dz = z - ring * Lanes::splat(self.spacing);
            let turned = LaneVector::new(x * cos + y * sin, across * side, dz);
            candidates.position.store(at, turned);
            let turned_x = velocity.x * cos + velocity.y * sin;
            let turned_y = (velocity.y * cos - velocity.x * sin) * side;
            let turned = LaneVector::new(turned_x, turned_y, velocity.z);
            candidates.velocity.store(at, turned);
            candidates.radius.store(at, radius);
            candidates.ring_velocity.store(at, ring_velocity);
            candidates.cos.store(at, cos);
            candidates.sin.store(at, sin);
            candidates.side.store(at, side);
        }
    }

    /// Counts the spheres that the candidates touch, from sphere to sphere outward along the rings, so that what follows can
    /// be predicted.
    #[inline(always)]
    pub(super) fn find_touching<M: Machine>(
        &self,
        candidates: &mut Candidates,
        distances: &mut Distances,
    ) {
        distances.clear(MOST_EIGHTS * self.outward.len());
        let reach = Lanes::<M>::splat(self.reach);
        let reach_squared = reach * reach;
        for (at, holds) in candidates.eights::<M>() {
            let LaneVector { x: u, y: v, z: dz } = candidates.position.load::<M>(at);
            let radius = candidates.radius.load::<M>(at);
            // The angle is approximate: a lane that turned to the second nearest sphere touches in a slightly different
            // order, so that it may touch another sphere behind one that it does not touch.
            let patience = usize::from((u * Lanes::splat(self.half_step)).less(v).any());

            // With p = u cos + v sin of a sphere, R of its ring and dz to it, the separation s from the grain has
            // s^2 = rho^2 + R^2 + dz^2 - 2 R p.
            let squares = u * u + v * v + radius * radius + dz * dz;
            // Lanes without a candidate are out of reach wherever they stand.
            let squares = Lanes::select(holds, squares, Lanes::splat(f64::INFINITY));
            let double = radius + radius;
            let (double_u, double_v) = (double * u, double * v);
            let mut visits = 0;
            for (visited, &(cos, sin)) in self.outward.iter().enumerate() {
                let distance_squared =
                    squares - (double_u * Lanes::splat(cos) + double_v * Lanes::splat(sin));
                distances.note(visited, distance_squared);
                if distance_squared.less(reach_squared).any() {
                    visits = visited + 1;
                } else if visited > 0 && visited >= visits + patience {
                    // The first two are always looked at: a lane may stand half way between them.
                    break;
                }
            }
            distances.keep(visits);
            candidates.visits[at / LANES] = visits;
        }
    }

    /// Adds up the forces on the grains of all candidates.
    #[inline(always)]
    pub(super) fn add_up_forces<M: Machine, N: NormalLaw, const FULL: bool>(
        &self,
        law: &N,
        candidates: &Candidates,
        distances: &Distances,
        force: &mut ColumnsMut<'_>,
        sums: &mut Sums<M>,
    ) {
        let zero = Lanes::<M>::splat(0.0);
        let mut eight = 0;
        for (at, _) in candidates.eights::<M>() {
            let LaneVector { x: u, y: v, z: dz } = candidates.position.load::<M>(at);
            let velocity = candidates.velocity.load::<M>(at);
            let radius = candidates.radius.load::<M>(at);
            let ring_velocity = candidates.ring_velocity.load::<M>(at);
            // With V = dR/dt, (v - V) . s is as linear in cos and sin as s^2.
            let along = u * velocity.x + v * velocity.y + dz * velocity.z + ring_velocity * radius;
            let along_u = radius * velocity.x + ring_velocity * u;
            let along_v = radius * velocity.y + ring_velocity * v;
            // Sums of force over distance, and of it times cos and sin of the spheres.
            let (mut pushes, mut by_cos, mut by_sin) = (zero, zero, zero);
            for &(cos, sin) in &self.outward[..candidates.visits[at / LANES]] {
                let (cos, sin) = (Lanes::splat(cos), Lanes::splat(sin));
                let Near {
                    touch,
                    overlap,
                    inverse,
                } = distances.near(eight, self.reach);
                if FULL {
                    sums.wall_contacts += touch.count();
                }
                eight += 1;
                let parting = along - (along_u * cos + along_v * sin);
                let normal_velocity = parting * inverse;
                let answer = law.force(overlap, normal_velocity, Lanes::splat(self.reduced_radius));
                let push = answer.force * inverse;
                pushes += push;
                by_cos += push * cos;
                by_sin += push * sin;
                let lost = (answer.elastic_force - answer.force) * normal_velocity;
                sums.add_contact::<FULL>(overlap, answer.energy, lost);
            }
            // V . s = V (p - R) of each sphere.
            let outward = u * by_cos + v * by_sin - radius * pushes;
            sums.wall_power += ring_velocity * outward;
            let on_u = u * pushes - radius * by_cos;
            let on_v = v * pushes - radius * by_sin;
            let on_z = dz * pushes;
            if FULL {
                sums.wall_axial_force += on_z;
            }
            let cos = candidates.cos.load::<M>(at);
            let sin = candidates.sin.load::<M>(at);
            let on_v = on_v * candidates.side.load::<M>(at);
            let on_grains = LaneVector::new(on_u * cos - on_v * sin, on_u * sin + on_v * cos, on_z);
            candidates.add_forces(at, on_grains, force);
        }
    }

    /// The first ring within reach of a place along the tube, counted on beyond its ends.
    #[inline(always)]
    fn first_ring<M: Machine>(&self, z: Lanes<M>) -> Lanes<M> {
        let place = z * Lanes::splat(self.rings_per_length);
        (place - Lanes::splat(self.rings_within)).round().0
    }

    /// Which ring of a wavelength a ring is.
    #[inline(always)]
    fn in_wave<M: Machine>(&self, ring: Lanes<M>) -> [i32; LANES] {
        let past_middle = (ring + Lanes::splat(0.5)) * Lanes::splat(self.waves_per_ring);
        let (waves, _) = (past_middle - Lanes::splat(0.5)).round();
        let (_, in_wave) = (ring - waves * Lanes::splat(self.rings_per_wave)).round();
        in_wave
    }
}
