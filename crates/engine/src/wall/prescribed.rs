//! A wall whose spheres move as prescribed: strain control.

use core::f64::consts::TAU;

use glam::DVec3;
use peristalsis_physics::contact::Contact;
use peristalsis_physics::wall::lattice::approximate_angle;
use peristalsis_physics::wall::{Lattice, RadiusWave, Ring, Schedule, Waveform};

use crate::bodies::Sphere;

/// Staggered rings whose radius follows a travelling wave.
///
/// No sphere of it is stored: the rings within reach of a grain follow from its z, the nearest sphere of a ring from its
/// angle, and from there the search goes outward while spheres touch, for the distance to the spheres of a ring grows
/// with the angle.
#[derive(Clone, Debug)]
pub struct PrescribedWall {
    lattice: Lattice,
    amplitude: Schedule,
    frequency: Schedule,
    /// Distance of neighbouring rings, and its inverse.
    spacing: f64,
    rings_per_length: f64,
    /// cos and sin of every angle that a wall sphere can have, by half steps.
    directions: Vec<(f64, f64)>,
    /// cos and sin of 2 pi z/lambda of each ring of a wavelength, z along the wave.
    ring_phases: Vec<(f64, f64)>,
    /// The rings of one wavelength now.
    pub(crate) rings: Vec<Ring>,
    wave: RadiusWave,
    /// Wavelengths that the wave has run since the start, c t/lambda.
    pub(super) cycles: f64,
}

impl PrescribedWall {
    /// The wall at time 0.
    ///
    /// `mean_radius` a \[d\], `amplitude` b(t) \[d\], `frequency` c(t)/lambda \[1/t\], `heading` +1 for a wave towards +z,
    /// -1 towards -z.
    pub fn new(
        lattice: Lattice,
        mean_radius: f64,
        waveform: Waveform,
        heading: f64,
        amplitude: Schedule,
        frequency: Schedule,
    ) -> Self {
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
        let wave = RadiusWave {
            mean_radius,
            amplitude: amplitude.value(0.0),
            wavelength: lattice.wavelength,
            waveform,
            heading,
        };
        let mut wall = Self {
            lattice,
            amplitude,
            frequency,
            spacing: lattice.spacing(),
            rings_per_length: 1.0 / lattice.spacing(),
            directions,
            ring_phases,
            rings: vec![Ring::default(); lattice.rings_per_wave as usize],
            wave,
            cycles: 0.0,
        };
        wall.move_to(0.0);
        wall
    }

    /// Moves the wall to where it is at `time`.
    pub(crate) fn move_to(&mut self, time: f64) {
        self.move_with_amplitude(time, self.amplitude.value(time));
    }

    /// Moves the wall to where it would be at `time` had its amplitude not jumped since `start`; `false`, and nothing
    /// moves, where it has not.
    pub(crate) fn move_without_jump(&mut self, start: f64, time: f64) -> bool {
        let jump = self.amplitude.jump(start, time);
        if jump != 0.0 {
            self.move_with_amplitude(time, self.amplitude.value(time) - jump);
        }
        jump != 0.0
    }

    fn move_with_amplitude(&mut self, time: f64, amplitude: f64) {
        self.cycles = self.frequency.integral(time);
        self.wave.amplitude = amplitude;
        let (frequency, amplitude_rate) = (self.frequency.value(time), self.amplitude.rate(time));
        if self.wave.waveform == Waveform::Sine {
            // One sine for all rings: sin(a - b) = sin a cos b - cos a sin b.
            let (sin, cos) = libm::sincos(TAU * (self.cycles - self.cycles.floor()));
            for (ring, (ring_cos, ring_sin)) in self.rings.iter_mut().zip(&self.ring_phases) {
                let value = sin * ring_cos - cos * ring_sin;
                let slope = TAU * (cos * ring_cos + sin * ring_sin);
                *ring = self.wave.ring_of((value, slope), frequency, amplitude_rate);
            }
        } else {
            for (number, ring) in self.rings.iter_mut().enumerate() {
                let z = number as f64 * self.spacing;
                *ring = self.wave.ring(z, self.cycles, frequency, amplitude_rate);
            }
        }
    }

    /// The lattice.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The wave as it is now.
    pub fn wave(&self) -> &RadiusWave {
        &self.wave
    }

    /// c/lambda at `time` \[1/t\].
    pub fn frequency(&self, time: f64) -> f64 {
        self.frequency.value(time)
    }

    /// A wall sphere as it is now; its velocity is radial.
    pub(crate) fn sphere(&self, index: usize) -> Sphere {
        let sphere = self.lattice.sphere(index);
        let (cos, sin) = self.directions[self.lattice.half_steps(sphere) as usize];
        let ring = self.rings[(sphere.ring % self.lattice.rings_per_wave) as usize];
        let z = self.lattice.axial_position(sphere.ring);
        Sphere {
            position: DVec3::new(ring.radius * cos, ring.radius * sin, z),
            velocity: DVec3::new(ring.velocity * cos, ring.velocity * sin, 0.0),
            angular_velocity: DVec3::ZERO,
            diameter: self.lattice.sphere_diameter,
        }
    }

    /// Calls `touch` for each wall sphere that overlaps a sphere of diameter `diameter` at `centre`, with the number of
    /// the wall sphere, the separation (centre minus wall sphere, length below the reach) and the wall's velocity.
    #[inline(always)]
    fn for_each_touching<F: FnMut(u32, DVec3, DVec3)>(
        &self,
        centre: DVec3,
        diameter: f64,
        mut touch: F,
    ) {
        let reach = 0.5 * (diameter + self.lattice.sphere_diameter);
        let axis_distance_squared = centre.x * centre.x + centre.y * centre.y;
        let axis_distance = axis_distance_squared.sqrt();
        let narrowest = self.wave.mean_radius - self.wave.amplitude.abs();
        if axis_distance + reach <= narrowest {
            return;
        }
        let per_ring = self.lattice.spheres_per_ring as usize;
        let half_steps_per_radian = per_ring as f64 / core::f64::consts::PI;
        let rings = self.lattice.rings() as usize;
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
            let parity = this_ring % 2;
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

    /// Calls `touch` for each contact of a grain: with the number of the wall sphere, the contact (the grain not rotating)
    /// and the velocity of the wall there.
    #[inline(always)]
    pub(crate) fn for_each_contact(
        &self,
        grain: &Sphere,
        mut touch: impl FnMut(u32, Contact, DVec3),
    ) {
        let diameters = (grain.diameter, self.lattice.sphere_diameter);
        let at = (grain.position, grain.diameter);
        self.for_each_touching(at.0, at.1, |sphere, separation, velocity| {
            let contact = Contact::new(diameters, separation, grain.velocity - velocity);
            // Rounding may leave a sphere at the very edge of reach.
            if contact.touches() {
                touch(sphere, contact, velocity);
            }
        });
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

#[cfg(test)]
mod tests;
