//! Contacts with the spheres of a prescribed wall, eight grains at a time.
//!
//! Each lane finds by arithmetic the first ring that it can touch and turns to the sphere of that ring which is nearest
//! to it, mirrored so that the next sphere lies on the side of positive angles. From there on all lanes walk together:
//! ring by ring, and on each ring outward from sphere to sphere, at angles that are the same for all lanes, until no
//! lane touches. The distance to the spheres of a ring grows in that order.

use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::real::Real;
use peristalsis_physics::wall::lattice::approximate_angle;

use super::Sums;
use super::pairs::{Block, COINCIDENT};
use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::Machine;
use crate::wall::PrescribedWall;

/// The wall at one step, as the kernel reads it.
#[derive(Clone, Debug, Default)]
pub(super) struct WallTable {
    /// Radius, its velocity and its slope along the tube for the rings of a wavelength, and once more the first few.
    radius: Vec<f64>,
    velocity: Vec<f64>,
    slope: Vec<f64>,
    /// cos and sin of the angles of wall spheres by half steps, a little more than a turn.
    cos: Vec<f64>,
    sin: Vec<f64>,
    /// cos and sin of the angles, from the nearest sphere of the first ring, at which the spheres of rings of the first
    /// ring's parity stand, from the nearest outward; and of rings of the other parity.
    outward: [Vec<(f64, f64)>; 2],
    /// tan of the angle of half a step.
    half_step: f64,
    rings_per_wave: f64,
    waves_per_ring: f64,
    half_steps_per_radian: f64,
    spacing: f64,
    rings_per_length: f64,
    reach: f64,
    reduced_radius: f64,
    /// Radius below which a grain's distance from the axis keeps it clear of every ring.
    clear: f64,
    /// Largest |dR/dz|, and half the largest |d^2R/dz^2|.
    steepest: f64,
    half_curvature: f64,
    /// 1 + s^2, s the largest slope, and its inverse.
    stretch: f64,
    per_stretch: f64,
}

/// Sums of force over distance on the spheres of a ring, and of it times their cos and sin.
struct RingSums<M: Machine> {
    all: Lanes<M>,
    cos: Lanes<M>,
    sin: Lanes<M>,
}

impl<M: Machine> Default for RingSums<M> {
    #[inline(always)]
    fn default() -> Self {
        Self {
            all: Lanes::default(),
            cos: Lanes::default(),
            sin: Lanes::default(),
        }
    }
}

/// Keeps what is at the edge of reach within, whatever the rounding.
const MARGIN: f64 = 1e-9;

impl WallTable {
    /// The tables that do not move, for grains of diameter `diameter`.
    pub(super) fn new(wall: &PrescribedWall, diameter: f64) -> Self {
        let lattice = wall.lattice();
        let per_ring = lattice.spheres_per_ring;
        let reach = 0.5 * (diameter + lattice.sphere_diameter);
        let angle = |half_steps: f64| half_steps * core::f64::consts::PI / f64::from(per_ring);
        let direction =
            |half_steps: f64| (libm::cos(angle(half_steps)), libm::sin(angle(half_steps)));
        let turn = (0..2 * per_ring + 4).map(|step| direction(f64::from(step % (2 * per_ring))));
        let (cos, sin) = turn.unzip();
        // From the nearest sphere: 0, 2, -2, 4, ... half steps; and 1, -1, 3, -3, ...
        let place =
            |index: u32| f64::from(index.div_ceil(2)) * if index % 2 == 1 { 2.0 } else { -2.0 };
        let aligned = (0..per_ring).map(|index| direction(place(index))).collect();
        let between = (0..per_ring)
            .map(|index| {
                direction(if index % 2 == 0 {
                    f64::from(index + 1)
                } else {
                    -f64::from(index)
                })
            })
            .collect();
        let entries =
            lattice.rings_per_wave as usize + (2.0 * reach / lattice.spacing()) as usize + 3;
        Self {
            radius: vec![0.0; entries],
            velocity: vec![0.0; entries],
            slope: vec![0.0; entries],
            cos,
            sin,
            outward: [aligned, between],
            half_step: libm::tan(angle(1.0).min(1.0)),
            rings_per_wave: f64::from(lattice.rings_per_wave),
            waves_per_ring: 1.0 / f64::from(lattice.rings_per_wave),
            half_steps_per_radian: f64::from(per_ring) / core::f64::consts::PI,
            spacing: lattice.spacing(),
            rings_per_length: 1.0 / lattice.spacing(),
            reach,
            reduced_radius: diameter * lattice.sphere_diameter
                / (2.0 * (diameter + lattice.sphere_diameter)),
            ..Self::default()
        }
    }

    /// Takes over the rings where they are now.
    pub(super) fn follow(&mut self, wall: &PrescribedWall) {
        let rings = wall.rings();
        for entry in 0..self.radius.len() {
            let ring = &rings[entry % rings.len()];
            self.radius[entry] = ring.radius;
            self.velocity[entry] = ring.velocity;
            self.slope[entry] = ring.slope;
        }
        let wave = wall.wave();
        let amplitude = wave.amplitude.abs();
        let wave_number = core::f64::consts::TAU / wave.wavelength;
        self.clear = (wave.mean_radius - amplitude - self.reach).max(0.0);
        self.steepest = amplitude * wave_number * wave.waveform.steepest();
        self.stretch = 1.0 + self.steepest * self.steepest;
        self.per_stretch = 1.0 / self.stretch;
        self.half_curvature =
            0.5 * amplitude * wave_number * wave_number * wave.waveform.most_curved();
    }

    /// Forces of the wall on the grains of a block.
    #[inline(always)]
    pub(super) fn force<M: Machine, N: NormalLaw, const FULL: bool>(
        &self,
        law: &N,
        block: &Block<M>,
        sums: &mut Sums<M>,
    ) -> Option<LaneVector<M>> {
        let zero = Lanes::<M>::splat(0.0);
        let LaneVector { x, y, z } = block.position;
        let from_axis_squared = x * x + y * y;
        let may_touch = Lanes::splat(self.clear * self.clear).less(from_axis_squared) & block.holds;
        // A throat narrower than the reach touches even a grain on the axis.
        if self.clear > 0.0 && !may_touch.any() {
            return None;
        }

        // The rings in reach: |R(z + dz) - rho| >= gap - s |dz|, and so no contact beyond the root of
        // (gap - s |dz|)^2 + dz^2 = reach^2.
        let from_axis = from_axis_squared.sqrt();
        let place = z * Lanes::splat(self.rings_per_length);
        let (nearest, nearest_index) = place.round();
        let from_ring = z - nearest * Lanes::splat(self.spacing);
        let in_wave = self.in_wave(nearest_index, nearest);
        let radius_here = Lanes::from_lanes(|lane| self.radius[in_wave[lane]])
            + from_ring * Lanes::from_lanes(|lane| self.slope[in_wave[lane]])
            - Lanes::splat(self.half_curvature) * (from_ring * from_ring);
        let steepest = Lanes::splat(self.steepest);
        // (A gap so small that some ring's may vanish has every ring in reach.)
        let gap = (radius_here - from_axis).larger(Lanes::splat(self.steepest * self.reach));
        let reach = Lanes::splat(self.reach);
        let reach_squared = reach * reach;
        let under_root = Lanes::splat(self.reach * self.reach * self.stretch) - gap * gap;
        let near = zero.less(under_root) & block.holds;
        if !near.any() {
            return None;
        }
        let within = ((steepest * gap + under_root.positive_part().sqrt())
            * Lanes::splat(self.per_stretch))
        .lesser(reach);
        let rings_within =
            within * Lanes::splat(self.rings_per_length) + Lanes::splat(MARGIN - 0.5);
        let (first, first_index) = (place - rings_within).round();
        let (last, _) = (place + rings_within).round();
        let number = Lanes::select(near, last - first + Lanes::splat(1.0), zero);
        let most = number.largest();
        if most < 0.5 {
            return None;
        }

        // Turn to the nearest sphere of the first ring, and mirror.
        let parity = {
            let (half, _) = (first * Lanes::splat(0.5) - Lanes::splat(0.25)).round();
            first - Lanes::splat(2.0) * half
        };
        let half_steps = approximate_angle(x, y) * Lanes::splat(self.half_steps_per_radian);
        let (sphere, _) = ((half_steps - parity) * Lanes::splat(0.5)).round();
        let (_, direction) = (Lanes::splat(2.0) * sphere + parity).round();
        let cos = Lanes::from_lanes(|lane| self.cos[direction[lane] as usize]);
        let sin = Lanes::from_lanes(|lane| self.sin[direction[lane] as usize]);
        let u = x * cos + y * sin;
        let across = y * cos - x * sin;
        let side = Lanes::select(across.less(zero), Lanes::splat(-1.0), Lanes::splat(1.0));
        let v = across * side;
        let velocity_u = block.velocity.x * cos + block.velocity.y * sin;
        let velocity_v = (block.velocity.y * cos - block.velocity.x * sin) * side;
        let velocity_z = block.velocity.z;
        // The angle is approximate: a lane that turned to the second nearest sphere touches in a slightly different
        // order, so that one sphere out of touch does not yet mean that there is none behind it.
        let patience = 1 + usize::from((u * Lanes::splat(self.half_step)).less(v).any());

        // With p = u cos + v sin of a sphere, R of its ring and dz to it, the separation s from the grain has
        // s^2 = rho^2 + R^2 + dz^2 - 2 R p, and the rest of what a contact needs is as linear in cos and sin.
        let first_in_wave = self.in_wave(first_index, first);
        let mut on_u = zero;
        let mut on_v = zero;
        let mut on_z = zero;
        for ring in 0..most as usize {
            let index = Lanes::splat(ring as f64);
            let radius = Lanes::from_lanes(|lane| self.radius[first_in_wave[lane] + ring]);
            let dz = z - (first + index) * Lanes::splat(self.spacing);
            let gap = radius - from_axis;
            let room = reach_squared - dz * dz;
            let active = index.less(number) & block.holds & (gap * gap).less(room);
            if !active.any() {
                continue;
            }
            let ring_velocity = Lanes::from_lanes(|lane| self.velocity[first_in_wave[lane] + ring]);
            let twice_radius = radius + radius;
            let squares = from_axis_squared + radius * radius + dz * dz;
            // Lanes that are not active are out of reach wherever they stand.
            let squares = Lanes::select(active, squares, Lanes::splat(f64::INFINITY));
            let along = u * velocity_u + v * velocity_v + dz * velocity_z;
            let mut pushes = RingSums::default();
            let mut misses = 0;
            for (visited, &(cos, sin)) in self.outward[ring % 2].iter().enumerate() {
                let (cos, sin) = (Lanes::splat(cos), Lanes::splat(sin));
                let projection = u * cos + v * sin;
                let distance_squared = squares - twice_radius * projection;
                let touches = distance_squared.less(reach_squared)
                    & Lanes::splat(COINCIDENT).less(distance_squared);
                if !touches.any() {
                    misses += 1;
                    // The first two are always looked at: a lane may stand half way between them.
                    if visited > 0 && misses >= patience {
                        break;
                    }
                    continue;
                }
                misses = 0;
                let inverse = distance_squared.reciprocal_sqrt();
                let overlap = Lanes::select(touches, reach - distance_squared * inverse, zero);
                // V . s and v . s
                let wall_along = ring_velocity * (projection - radius);
                let grain_along = along - radius * (velocity_u * cos + velocity_v * sin);
                let normal_velocity =
                    Lanes::select(touches, (grain_along - wall_along) * inverse, zero);
                let answer = law.force(overlap, normal_velocity, Lanes::splat(self.reduced_radius));
                let push = Lanes::select(touches, answer.force * inverse, zero);
                pushes.all += push;
                pushes.cos += push * cos;
                pushes.sin += push * sin;
                sums.wall_power += push * wall_along;
                let lost = (answer.elastic_force - answer.force) * normal_velocity;
                sums.add_contact::<FULL>(overlap, answer.energy, lost);
                if FULL {
                    sums.wall_contacts += touches.count();
                }
            }
            on_u += u * pushes.all - radius * pushes.cos;
            on_v += v * pushes.all - radius * pushes.sin;
            on_z += dz * pushes.all;
        }
        if FULL {
            sums.wall_axial_force += on_z;
        }
        let on_v = on_v * side;
        Some(LaneVector::new(
            on_u * cos - on_v * sin,
            on_u * sin + on_v * cos,
            on_z,
        ))
    }

    /// Which ring of a wavelength a ring is.
    #[inline(always)]
    fn in_wave<M: Machine>(&self, index: [i32; LANES], ring: Lanes<M>) -> [usize; LANES] {
        let past_middle = (ring + Lanes::splat(0.5)) * Lanes::splat(self.waves_per_ring);
        let (waves, _) = (past_middle - Lanes::splat(0.5)).round();
        let (_, before) = (waves * Lanes::splat(self.rings_per_wave)).round();
        core::array::from_fn(|lane| (index[lane] - before[lane]) as usize)
    }
}
