//! A lattice of wall spheres that follow the wave, ring by ring.

use core::f64::consts::TAU;

use glam::DVec3;
use peristalsis_physics::wall::lattice::approximate_angle;
use peristalsis_physics::wall::{Lattice, RadiusWave, Ring};

use super::Instant;

/// Rings whose radius follows a travelling wave.
///
/// No sphere of them is stored: the rings within reach of a grain follow from its z, the nearest sphere of a ring from its
/// angle, and from there the search goes outward while spheres touch, for the distance to the spheres of a ring grows
/// with the angle.
#[derive(Clone, Debug)]
pub(crate) struct Rings {
    pub(super) lattice: Lattice,
    /// Distance of neighbouring rings, and its inverse.
    spacing: f64,
    rings_per_length: f64,
    /// cos and sin of every angle that a wall sphere can have, by half steps.
    directions: Vec<(f64, f64)>,
    /// cos and sin of 2 pi z/lambda of each ring of a wavelength, z along the wave.
    ring_phases: Vec<(f64, f64)>,
    /// The rings of one wavelength now.
    pub(crate) rings: Vec<Ring>,
}

impl Rings {
    pub(super) fn new(lattice: Lattice, heading: f64) -> Self {
        let directions = (0..2 * lattice.spheres_per_ring)
            .map(|half_steps| {
                let angle = f64::from(half_steps) * core::f64::consts::PI
                    / f64::from(lattice.spheres_per_ring);
                (libm::cos(angle), libm::sin(angle))
            })
            .collect();
        let ring_phases = (0..lattice.rings_per_wave)
            .map(|ring| {
                let phase = heading * TAU * f64::from(ring) / f64::from(lattice.rings_per_wave);
                (libm::cos(phase), libm::sin(phase))
            })
            .collect();
        Self {
            lattice,
            spacing: lattice.spacing(),
            rings_per_length: 1.0 / lattice.spacing(),
            directions,
            ring_phases,
            rings: vec![Ring::default(); lattice.rings_per_wave as usize],
        }
    }

    /// Brings the rings to where the wave has them.
    pub(super) fn follow(&mut self, wave: &RadiusWave, now: &Instant) {
        for (number, ring) in self.rings.iter_mut().enumerate() {
            *ring = now.ring(wave, number as f64 * self.spacing, self.ring_phases[number]);
        }
    }

    /// A sphere as it is now: cos and sin of its angle, its ring and z.
    pub(super) fn sphere(&self, index: usize) -> ((f64, f64), Ring, f64) {
        let sphere = self.lattice.sphere(index);
        let direction = self.directions[self.lattice.half_steps(sphere) as usize];
        let ring = self.rings[(sphere.ring % self.lattice.rings_per_wave) as usize];
        (direction, ring, self.lattice.axial_position(sphere.ring))
    }

    /// Calls `touch` for each sphere whose centre is within `reach` of `centre`, with its number, the separation (centre
    /// minus wall sphere) and the wall's velocity; no ring is narrower than `narrowest`.
    #[inline(always)]
    pub(super) fn for_each_touching<F: FnMut(u32, DVec3, DVec3)>(
        &self,
        centre: DVec3,
        reach: f64,
        narrowest: f64,
        mut touch: F,
    ) {
        let axis_distance_squared = centre.x * centre.x + centre.y * centre.y;
        let axis_distance = axis_distance_squared.sqrt();
        if axis_distance + reach <= narrowest {
            return;
        }
        let per_ring = self.lattice.spheres_per_ring as usize;
        let half_steps_per_radian = per_ring as f64 / core::f64::consts::PI;
        let (rings, staggered) = (self.lattice.rings() as usize, self.lattice.staggered);
        let first = ceiling((centre.z - reach) * self.rings_per_length);
        // z is never negative, and truncation rounds down.
        let last = ((centre.z + reach) * self.rings_per_length) as i64;
        // Divisions once for the first ring; from there on by counting.
        let mut ring = first.rem_euclid(rings as i64) as usize;
        let mut in_wave = ring % self.rings.len();
        let mut half_steps = None;
        for unfolded_ring in first..=last {
            let (this_ring, here) = (ring, self.rings[in_wave]);
            let (radius, radial_velocity) = (here.radius, here.velocity);
            ring = if ring + 1 == rings { 0 } else { ring + 1 };
            in_wave = if in_wave + 1 == self.rings.len() {
                0
            } else {
                in_wave + 1
            };

            let dz = centre.z - unfolded_ring as f64 * self.spacing;
            let room = reach * reach - dz * dz;
            let gap = radius - axis_distance;
            if gap * gap >= room {
                continue;
            }
            let parity = if staggered { this_ring % 2 } else { 0 };
            let hint = *half_steps.get_or_insert_with(|| {
                approximate_angle(centre.x, centre.y) * half_steps_per_radian
            });
            // |separation|^2 = rho^2 + R^2 - 2 R (x cos + y sin) + dz^2 < reach^2
            let threshold = (axis_distance_squared + radius * radius - room) / (2.0 * radius);
            let nearest = nearest_place(hint, parity, per_ring);
            // From the nearest sphere on while they touch, then from its other neighbour back while they touch. The hint
            // may be a neighbour's, so that both directions are tried even where the first sphere does not touch.
            let (mut place, mut forward, mut visited) = (nearest, true, 0);
            while visited < per_ring {
                let (cos, sin) = self.directions[2 * place + parity];
                let touches = centre.x * cos + centre.y * sin > threshold;
                if touches {
                    let separation =
                        DVec3::new(centre.x - radius * cos, centre.y - radius * sin, dz);
                    let velocity = DVec3::new(radial_velocity * cos, radial_velocity * sin, 0.0);
                    touch((this_ring * per_ring + place) as u32, separation, velocity);
                }
                let goes_on = touches || visited == 0;
                visited += 1;
                if forward && goes_on {
                    place = if place + 1 == per_ring { 0 } else { place + 1 };
                } else if forward || goes_on {
                    let from = if forward { nearest } else { place };
                    place = if from == 0 { per_ring - 1 } else { from - 1 };
                    forward = false;
                } else {
                    break;
                }
            }
        }
    }
}

/// Least whole number that is not below x: by truncation, for rounding is a library call on the plainest processors.
#[inline(always)]
fn ceiling(x: f64) -> i64 {
    let whole = x as i64;
    whole + i64::from((whole as f64) < x)
}

/// Place on its ring of the sphere whose angle, in half steps, is nearest to `half_steps`.
#[inline(always)]
fn nearest_place(half_steps: f64, parity: usize, per_ring: usize) -> usize {
    // From -1/2 up to M, so that half a place more is never negative and truncation rounds.
    let place = ((half_steps - parity as f64) * 0.5 + 0.5) as usize;
    if place >= per_ring {
        place - per_ring
    } else {
        place
    }
}
