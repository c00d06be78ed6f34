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

use super::candidates::Candidates;
use super::pairs::{Block, COINCIDENT};
use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::Machine;
use crate::fast::sums::Sums;
use crate::wall::Wall;

/// The wall at one step, as the kernel reads it.
#[derive(Clone, Debug, Default)]
pub(super) struct WallTable {
    /// Radius of the rings of a wavelength, and once more of the first few.
    radius: Vec<f64>,
    /// Radius and its velocity, in turn, for the rings of a wavelength.
    rings: Vec<f64>,
    /// cos and sin, in turn, of the angles of wall spheres by half steps, a little more than a turn.
    directions: Vec<f64>,
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
            .map(|step| direction(f64::from(step % (2 * per_ring))))
            .flat_map(|(cos, sin)| [cos, sin])
            .collect();
        // From the nearest sphere: 0, 2, -2, 4, ... half steps.
        let place =
            |index: u32| f64::from(index.div_ceil(2)) * if index % 2 == 1 { 2.0 } else { -2.0 };
        let outward = (0..per_ring).map(|index| direction(place(index))).collect();
        Self {
            radius: vec![0.0; rings_per_wave + most_rings.next_multiple_of(4)],
            rings: vec![0.0; 2 * rings_per_wave + 2],
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
        for (entry, ring) in self.rings.chunks_exact_mut(2).zip(rings) {
            entry.copy_from_slice(&[ring.radius, ring.velocity]);
        }
        for (radius, ring) in self.radius.iter_mut().zip(rings.iter().cycle()) {
            *radius = ring.radius;
        }
        let wave = wall.wave();
        let amplitude = wave.amplitude.abs();
        self.clear = (wave.mean_radius - amplitude - self.reach).max(0.0);
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
        let from_axis = from_axis_squared.sqrt();
        let reach_squared = Lanes::splat(self.reach * self.reach);
        let place = z * Lanes::splat(self.rings_per_length);
        let (first, _) = (place - Lanes::splat(self.rings_within)).round();
        let in_wave = self.in_wave(first);
        let mut ring = first;
        for four in (0..self.most_rings).step_by(4) {
            let radii = Lanes::<M>::windows(&self.radius[four..], in_wave);
            for radius in radii.into_iter().take(self.most_rings - four) {
                let dz = z - ring * Lanes::splat(self.spacing);
                let gap = radius - from_axis;
                let meet = (gap * gap + dz * dz).less(reach_squared) & block.holds;
                if meet.any() {
                    candidates.add(first_place, meet, block.position, block.velocity, ring);
                }
                ring += Lanes::splat(1.0);
            }
        }
    }

    /// Turns all candidates to the nearest sphere of their ring, and mirrors them.
    #[inline(always)]
    pub(super) fn turn_to_nearest<M: Machine>(&self, candidates: &mut Candidates) {
        for (at, holds) in candidates.eights::<M>() {
            let LaneVector { x, y, z } = candidates.position.load::<M>(at);
            let velocity = candidates.velocity.load::<M>(at);
            // The numbers of the other lanes are arbitrary.
            let ring = Lanes::load(&candidates.ring, at);
            let ring = Lanes::select(holds, ring, Lanes::splat(0.0));
            let [radius, ring_velocity, ..] =
                Lanes::<M>::windows(&self.rings, self.in_wave(ring).map(|ring| 2 * ring));
            let parity = {
                let (half, _) = (ring * Lanes::splat(0.5) - Lanes::splat(0.25)).round();
                (ring - Lanes::splat(2.0) * half) * Lanes::splat(self.turn)
            };
            let half_steps = approximate_angle(x, y) * Lanes::splat(self.half_steps_per_radian);
            let (sphere, _) = ((half_steps - parity) * Lanes::splat(0.5)).round();
            let (_, direction) = (Lanes::splat(2.0) * sphere + parity).round();
            let [cos, sin, ..] =
                Lanes::<M>::windows(&self.directions, direction.map(|direction| 2 * direction));
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
            radius.store(&mut candidates.ring, at);
            ring_velocity.store(&mut candidates.ring_velocity, at);
            cos.store(&mut candidates.cos, at);
            sin.store(&mut candidates.sin, at);
            side.store(&mut candidates.side, at);
        }
    }

    /// Works out the forces, from sphere to sphere outward along the rings.
    #[inline(always)]
    pub(super) fn add_up_forces<M: Machine, N: NormalLaw, const FULL: bool>(
        &self,
        law: &N,
        candidates: &mut Candidates,
        sums: &mut Sums<M>,
    ) {
        let zero = Lanes::<M>::splat(0.0);
        let reach = Lanes::splat(self.reach);
        let reach_squared = reach * reach;
        for (at, holds) in candidates.eights::<M>() {
            let LaneVector { x: u, y: v, z: dz } = candidates.position.load::<M>(at);
            let velocity = candidates.velocity.load::<M>(at);
            let radius = Lanes::load(&candidates.ring, at);
            let ring_velocity = Lanes::load(&candidates.ring_velocity, at);
            // The angle is approximate: a lane that turned to the second nearest sphere touches in a slightly different
            // order, so that it may touch another sphere behind one that it does not touch.
            let patience = usize::from((u * Lanes::splat(self.half_step)).less(v).any());

            // With p = u cos + v sin of a sphere, R of its ring, dz to it and V = dR/dt, the separation s from the grain
            // has s^2 = rho^2 + R^2 + dz^2 - 2 R p, and (v - V) . s is as linear in cos and sin.
            let squares = u * u + v * v + radius * radius + dz * dz;
            // Lanes without a candidate are out of reach wherever they stand.
            let squares = Lanes::select(holds, squares, Lanes::splat(f64::INFINITY));
            let double = radius + radius;
            let (double_u, double_v) = (double * u, double * v);
            let along = u * velocity.x + v * velocity.y + dz * velocity.z + ring_velocity * radius;
            let along_u = radius * velocity.x + ring_velocity * u;
            let along_v = radius * velocity.y + ring_velocity * v;
            // First the number of spheres that lanes touch, so that the branches below can be predicted.
            let mut visits = 0;
            for (visited, &(cos, sin)) in self.outward.iter().enumerate() {
                let distance_squared =
                    squares - (double_u * Lanes::splat(cos) + double_v * Lanes::splat(sin));
                if distance_squared.less(reach_squared).any() {
                    visits = visited + 1;
                } else if visited > 0 && visited >= visits + patience {
                    // The first two are always looked at: a lane may stand half way between them.
                    break;
                }
            }
            // Sums of force over distance, and of it times cos and sin of the spheres.
            let (mut pushes, mut by_cos, mut by_sin) = (zero, zero, zero);
            for &(cos, sin) in &self.outward[..visits] {
                let (cos, sin) = (Lanes::splat(cos), Lanes::splat(sin));
                let distance_squared = squares - (double_u * cos + double_v * sin);
                let touches = distance_squared.less(reach_squared)
                    & Lanes::splat(COINCIDENT).less(distance_squared);
                let inverse = distance_squared.reciprocal_sqrt();
                let overlap = Lanes::select(touches, reach - distance_squared * inverse, zero);
                let parting = along - (along_u * cos + along_v * sin);
                let normal_velocity = Lanes::select(touches, parting * inverse, zero);
                let answer = law.force(overlap, normal_velocity, Lanes::splat(self.reduced_radius));
                let push = Lanes::select(touches, answer.force * inverse, zero);
                pushes += push;
                by_cos += push * cos;
                by_sin += push * sin;
                let lost = (answer.elastic_force - answer.force) * normal_velocity;
                sums.add_contact::<FULL>(overlap, answer.energy, lost);
                if FULL {
                    sums.wall_contacts += touches.count();
                }
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
            let cos = Lanes::load(&candidates.cos, at);
            let sin = Lanes::load(&candidates.sin, at);
            let on_v = on_v * Lanes::load(&candidates.side, at);
            let force = LaneVector::new(on_u * cos - on_v * sin, on_u * sin + on_v * cos, on_z);
            candidates.position.store(at, force);
        }
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
