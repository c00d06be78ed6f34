//! A wall whose spheres move as prescribed: strain control.

mod rings;
mod scattered;
mod smooth;

use core::f64::consts::TAU;

use glam::DVec3;
use peristalsis_physics::contact::Contact;
use peristalsis_physics::wall::{Contraction, Lattice, RadiusWave, Ring, Schedule, Waveform};

pub(crate) use self::rings::Rings;
pub use self::scattered::Scattered;
use self::smooth::Smooth;
use crate::bodies::Sphere;

/// Spheres whose distance from the axis follows a travelling wave.
#[derive(Clone, Debug)]
pub struct PrescribedWall {
    spheres: WallSpheres,
    sphere_diameter: f64,
    waves: u32,
    length: f64,
    amplitude: Schedule,
    frequency: Schedule,
    wave: RadiusWave,
    now: Instant,
    /// Wavelengths that the wave has run since the start, c t/lambda.
    pub(super) cycles: f64,
}

/// Where the spheres stand on the tube.
#[derive(Clone, Debug)]
enum WallSpheres {
    Rings(Rings),
    Scattered(Scattered),
    /// No spheres: the wall is smooth.
    Smooth(Smooth),
}

/// A moment of the wave.
#[derive(Clone, Copy, Debug, Default)]
struct Instant {
    cycles: f64,
    /// c/lambda
    frequency: f64,
    /// db/dt
    amplitude_rate: f64,
    /// sin and cos of 2 pi c t/lambda, of a sine.
    sine: Option<(f64, f64)>,
}

impl Instant {
    /// The wall at z; `phase` is cos and sin of 2 pi z/lambda, z along the wave.
    #[inline(always)]
    fn ring(&self, wave: &RadiusWave, z: f64, phase: (f64, f64)) -> Ring {
        let (frequency, amplitude_rate) = (self.frequency, self.amplitude_rate);
        let Some((sin, cos)) = self.sine else {
            return wave.ring(z, self.cycles, frequency, amplitude_rate);
        };
        // One sine for all places: sin(a - b) = sin a cos b - cos a sin b.
        let value = sin * phase.0 - cos * phase.1;
        let slope = TAU * (cos * phase.0 + sin * phase.1);
        wave.ring_of((value, slope), frequency, amplitude_rate)
    }
}

impl PrescribedWall {
    /// A lattice, at time 0.
    ///
    /// `mean_radius` a \[d\], `amplitude` b(t) \[d\], `frequency` c(t)/lambda \[1/t\], `heading` +1 for a wave towards +z,
    /// -1 towards -z.
    pub fn new(
        lattice: Lattice,
        mean_radius: f64,
        contraction: impl Into<Contraction>,
        heading: f64,
        amplitude: Schedule,
        frequency: Schedule,
    ) -> Self {
        let wave = RadiusWave {
            mean_radius,
            amplitude: amplitude.value(0.0),
            wavelength: lattice.wavelength,
            contraction: contraction.into(),
            heading,
        };
        let mut wall = Self {
            spheres: WallSpheres::Rings(Rings::new(lattice, heading)),
            sphere_diameter: lattice.sphere_diameter,
            waves: lattice.waves,
            length: lattice.length(),
            amplitude,
            frequency,
            wave,
            now: Instant::default(),
            cycles: 0.0,
        };
        wall.move_to(0.0);
        wall
    }

    /// The same wall with spheres that stand anywhere instead of its lattice.
    pub fn with(mut self, spheres: Scattered) -> Self {
        self.spheres = WallSpheres::Scattered(spheres);
        self
    }

    /// The same wall without spheres: the smooth surface that lies half of their diameter, along its normal, inside the
    /// radius R(z, t).
    pub fn smooth(mut self) -> Self {
        self.spheres = WallSpheres::Smooth(Smooth::new(&self.wave));
        self
    }

    /// A smooth wall as it is drawn, at `time`: a fine lattice of beads whose inner side is its surface; `None` for a wall
    /// of spheres.
    pub(super) fn drawn(&self, time: f64) -> Option<Self> {
        let WallSpheres::Smooth(_) = self.spheres else {
            return None;
        };
        let mut wall = self.clone();
        wall.wave.mean_radius += 0.5 * (smooth::BEAD - self.sphere_diameter);
        let lattice = smooth::beads(&wall.wave, self.waves);
        wall.sphere_diameter = lattice.sphere_diameter;
        wall.spheres = WallSpheres::Rings(Rings::new(lattice, wall.wave.heading));
        wall.move_to(time);
        Some(wall)
    }

    /// The same wall, standing still for ever as it is at time 0.
    pub(crate) fn at_rest(&self) -> Self {
        let mut still = self.clone();
        still.amplitude = Schedule::constant(self.amplitude.value(0.0));
        still.frequency = Schedule::constant(0.0);
        still.move_to(0.0);
        still
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
        let is_sine = self.wave.contraction == Contraction::Wave(Waveform::Sine);
        self.now = Instant {
            cycles: self.cycles,
            frequency: self.frequency.value(time),
            amplitude_rate: self.amplitude.rate(time),
            sine: is_sine.then(|| libm::sincos(TAU * (self.cycles - self.cycles.floor()))),
        };
        if let WallSpheres::Rings(rings) = &mut self.spheres {
            rings.follow(&self.wave, &self.now);
        }
    }

    /// The lattice; `None` where the spheres stand anywhere.
    pub fn lattice(&self) -> Option<&Lattice> {
        self.rings().map(|rings| &rings.lattice)
    }

    /// The rings of the lattice.
    pub(crate) fn rings(&self) -> Option<&Rings> {
        match &self.spheres {
            WallSpheres::Rings(rings) => Some(rings),
            WallSpheres::Scattered(_) | WallSpheres::Smooth(_) => None,
        }
    }

    /// Length of the tube \[d\], waves in it, and diameter of the wall's spheres \[d\].
    pub(super) fn extent(&self) -> (f64, u32, f64) {
        (self.length, self.waves, self.sphere_diameter)
    }

    /// Whether the spheres of another wall stand as those of this one.
    pub(super) fn stands_as(&self, other: &Self) -> bool {
        match (&self.spheres, &other.spheres) {
            (WallSpheres::Rings(ours), WallSpheres::Rings(theirs)) => {
                ours.lattice == theirs.lattice
            }
            (WallSpheres::Scattered(ours), WallSpheres::Scattered(theirs)) => ours == theirs,
            (WallSpheres::Smooth(_), WallSpheres::Smooth(_)) => self.extent() == other.extent(),
            _ => false,
        }
    }

    /// The wave as it is now.
    pub fn wave(&self) -> &RadiusWave {
        &self.wave
    }

    /// c/lambda at `time` \[1/t\].
    pub fn frequency(&self, time: f64) -> f64 {
        self.frequency.value(time)
    }

    /// How many spheres there are.
    pub(crate) fn number(&self) -> usize {
        match &self.spheres {
            WallSpheres::Rings(rings) => rings.lattice.spheres(),
            WallSpheres::Scattered(scattered) => scattered.spheres(),
            WallSpheres::Smooth(_) => 0,
        }
    }

    /// A wall sphere as it is now; its velocity is radial.
    pub(crate) fn sphere(&self, index: usize) -> Sphere {
        let ((cos, sin), ring, z) = match &self.spheres {
            WallSpheres::Rings(rings) => rings.sphere(index),
            WallSpheres::Scattered(scattered) => scattered.sphere(index, &self.wave, &self.now),
            WallSpheres::Smooth(_) => unreachable!("a smooth wall has no spheres"),
        };
        Sphere {
            position: DVec3::new(ring.radius * cos, ring.radius * sin, z),
            velocity: DVec3::new(ring.velocity * cos, ring.velocity * sin, 0.0),
            angular_velocity: DVec3::ZERO,
            diameter: self.sphere_diameter,
        }
    }

    /// Calls `touch` for each wall sphere nearer than `reach` to `centre`, with the number of the wall sphere, the
    /// separation (centre minus wall sphere, length below the reach) and the wall's velocity.
    #[inline(always)]
    fn for_each_touching(&self, centre: DVec3, reach: f64, touch: impl FnMut(u32, DVec3, DVec3)) {
        match &self.spheres {
            WallSpheres::Rings(rings) => {
                rings.for_each_touching(centre, reach, self.wave.throat_radius(), touch);
            }
            WallSpheres::Scattered(scattered) => {
                scattered.for_each_touching(centre, reach, &self.wave, &self.now, touch);
            }
            WallSpheres::Smooth(_) => {}
        }
    }

    /// Calls `touch` for each contact of a grain, or each gap up to `range`: with the number of the wall sphere (of a smooth
    /// wall, of the contact), the contact (the grain not rotating) and the velocity of the wall there.
    #[inline(always)]
    pub(crate) fn for_each_contact(
        &self,
        grain: &Sphere,
        range: f64,
        mut touch: impl FnMut(u32, Contact, DVec3),
    ) {
        if let WallSpheres::Smooth(smooth) = &self.spheres {
            let half = 0.5 * self.sphere_diameter;
            let instant = (&self.wave, &self.now);
            return smooth.for_each_contact(grain, half, range, instant, touch);
        }
        let diameters = (grain.diameter, self.sphere_diameter);
        let overlaps = 0.5 * (grain.diameter + self.sphere_diameter);
        let reach = if range > 0.0 {
            overlaps + range
        } else {
            overlaps
        };
        self.for_each_touching(grain.position, reach, |sphere, separation, velocity| {
            let contact = Contact::new(diameters, separation, grain.velocity - velocity);
            // Rounding may leave a sphere at the very edge of reach.
            if contact.touches() || range > 0.0 && contact.distance > 0.0 {
                touch(sphere, contact, velocity);
            }
        });
    }
}

#[cfg(test)]
mod tests;
