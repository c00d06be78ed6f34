//! The travelling wave of contraction that a strain-controlled wall follows.

use core::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which way the wave runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveDirection {
    /// As the source writes it: towards -z under strain control, towards +z under stress control.
    #[default]
    Forward,
    /// Turned round.
    Backward,
}

/// Shape of one wavelength, a function g of the phase.
///
/// Every one has its throat, g = -1, at phase 3/4, so that the bottleneck's radius is a - b and its width 2 (a - b); s is
/// the distance from there in cycles, |s| <= 1/2. They differ in the rest: the sine opens the tube as much as it narrows
/// it, bolus and roller squeeze a quarter of a cycle to either side and leave a straight tube of radius a between.
///
/// - sine: g = sin(2 pi phase); mean 0.
/// - bolus: g = -cos^2(2 pi s) for |s| < 1/4, else 0; mean -1/4.
/// - roller: a parabola, the circle to lowest order of its curvature, and shoulders where the tube comes off it:
///   g = s^2/(s0 s1) - 1 for |s| < s1, -(s0 - |s|)^2/(s0 (s0 - s1)) up to s0, else 0, with s0 = 1/4 and s1 = 1/5;
///   mean -3/10.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Waveform {
    /// sin(2 pi phase): throats and bellies alike.
    #[default]
    Sine,
    /// One smooth squeeze, cos^2, over half of each wavelength; elsewhere the tube is straight, of radius a.
    Bolus,
    /// A round roller pressed into the tube over half of each wavelength; elsewhere the tube is straight, of radius a.
    Roller,
}

/// s0 of the roller's waveform: where the tube is straight again, in cycles from the throat.
pub const ROLLER_SHOULDER: f64 = 0.25;
/// s1: where the tube comes off the roller.
pub const ROLLER_CONTACT: f64 = 0.2;

impl Waveform {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Sine, Self::Bolus, Self::Roller];

    /// Value at a phase in cycles.
    #[must_use]
    pub fn value(self, phase: f64) -> f64 {
        match self {
            Self::Sine => libm::sin(TAU * phase),
            Self::Bolus | Self::Roller => self.value_and_slope(phase).0,
        }
    }

    /// Value, and derivative with respect to the phase in cycles.
    #[must_use]
    pub fn value_and_slope(self, phase: f64) -> (f64, f64) {
        match self {
            Self::Sine => {
                let (sin, cos) = libm::sincos(TAU * phase);
                (sin, TAU * cos)
            }
            Self::Bolus => {
                let s = from_throat(phase);
                if s.abs() >= 0.25 {
                    return (0.0, 0.0);
                }
                // cos^2(x) = (1 + cos(2 x))/2
                let (sin, cos) = libm::sincos(2.0 * TAU * s);
                (-0.5 * (1.0 + cos), TAU * sin)
            }
            Self::Roller => {
                let s = from_throat(phase);
                let (distance, side) = (s.abs(), if s < 0.0 { -1.0 } else { 1.0 });
                let ([inner, outer], rest) = (ROLLER_CURVATURES, ROLLER_SHOULDER - distance);
                if distance < ROLLER_CONTACT {
                    (0.5 * inner * s * s - 1.0, inner * s)
                } else if rest > 0.0 {
                    (-0.5 * outer * rest * rest, side * outer * rest)
                } else {
                    (0.0, 0.0)
                }
            }
        }
    }

    /// Mean over the wave: that of the radius is a + b times this.
    #[must_use]
    pub fn mean(self) -> f64 {
        match self {
            Self::Sine => 0.0,
            Self::Bolus => -0.25,
            // -2 s1 + 2 s1^2/(3 s0) - 2 (s0 - s1)^2/(3 s0)
            Self::Roller => -0.3,
        }
    }

    /// Largest value; the least is -1.
    #[must_use]
    pub fn largest(self) -> f64 {
        match self {
            Self::Sine => 1.0,
            Self::Bolus | Self::Roller => 0.0,
        }
    }

    /// Largest size of the slope against 2 pi phase.
    #[must_use]
    pub fn steepest(self) -> f64 {
        match self {
            Self::Sine | Self::Bolus => 1.0,
            Self::Roller => ROLLER_CURVATURES[0] * ROLLER_CONTACT / TAU,
        }
    }

    /// Largest size of the second derivative against 2 pi phase.
    #[must_use]
    pub fn most_curved(self) -> f64 {
        match self {
            Self::Sine => 1.0,
            Self::Bolus => 2.0,
            Self::Roller => ROLLER_CURVATURES[1] / (TAU * TAU),
        }
    }
}

/// Second derivatives of the roller's waveform on the roller and, with the other sign, on the shoulder.
pub const ROLLER_CURVATURES: [f64; 2] = [
    2.0 / (ROLLER_SHOULDER * ROLLER_CONTACT),
    2.0 / (ROLLER_SHOULDER * (ROLLER_SHOULDER - ROLLER_CONTACT)),
];

/// Phase less that of the nearest throat, from -1/2 to 1/2.
fn from_throat(phase: f64) -> f64 {
    let from_belly = phase - 0.25;
    from_belly - from_belly.floor() - 0.5
}

/// Radius of a peristaltic tube and its velocity.
///
/// R(z, t) = a + b g(s z/lambda + c t/lambda), g the waveform, s = 1 for a wave towards -z and s = -1 for one towards
/// +z
///
/// a, b, z, lambda \[d\], to the centres of the wall spheres; c t/lambda in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadiusWave {
    /// a \[d\]
    pub mean_radius: f64,
    /// b \[d\]
    pub amplitude: f64,
    /// lambda \[d\]
    pub wavelength: f64,
    /// g
    pub waveform: Waveform,
    /// +1.0 where the wave runs towards +z, -1.0 where it runs towards -z.
    pub heading: f64,
}

/// A ring of a wall that follows the wave, at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ring {
    /// R \[d\]
    pub radius: f64,
    /// dR/dt at fixed z \[d/t\]
    pub velocity: f64,
    /// dR/dz at fixed time
    pub slope: f64,
}

impl RadiusWave {
    /// Phase in cycles at z, after the wave has gone `cycles` = c t/lambda wavelengths.
    #[must_use]
    pub fn phase(&self, z: f64, cycles: f64) -> f64 {
        let phase = cycles - self.heading * z / self.wavelength;
        phase - phase.floor()
    }

    /// R at z \[d\].
    #[must_use]
    pub fn radius(&self, z: f64, cycles: f64) -> f64 {
        self.mean_radius + self.amplitude * self.waveform.value(self.phase(z, cycles))
    }

    /// The wall at z, for frequency c/lambda and rate of change db/dt of the amplitude.
    #[must_use]
    pub fn ring(&self, z: f64, cycles: f64, frequency: f64, amplitude_rate: f64) -> Ring {
        let value_and_slope = self.waveform.value_and_slope(self.phase(z, cycles));
        self.ring_of(value_and_slope, frequency, amplitude_rate)
    }

    /// The wall where the waveform has the given value and slope against phase.
    #[inline]
    #[must_use]
    pub fn ring_of(&self, (value, slope): (f64, f64), frequency: f64, amplitude_rate: f64) -> Ring {
        Ring {
            radius: self.mean_radius + self.amplitude * value,
            velocity: self.amplitude * frequency * slope + amplitude_rate * value,
            slope: -self.heading / self.wavelength * self.amplitude * slope,
        }
    }

    /// Position in the frame of the wave, in wavelengths in \[0, 1): the distance along the wave from a place of phase 0.
    ///
    /// A wave along +z is a function of z - ct; the position is (heading z - c t)/lambda folded to one wavelength.
    #[must_use]
    pub fn wave_frame_position(&self, z: f64, cycles: f64) -> f64 {
        let position = self.heading * z / self.wavelength - cycles;
        position - position.floor()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(heading: f64) -> RadiusWave {
        RadiusWave {
            mean_radius: 1.5,
            amplitude: 0.25,
            wavelength: 10.0,
            waveform: Waveform::Sine,
            heading,
        }
    }

    #[test]
    fn the_wave_of_the_source_runs_towards_negative_z() {
        let wave = wave(-1.0);
        let (epsdot, time, z) = (0.05, 3.7, 4.2);
        let expected = 1.5 + 0.25 * (TAU * (epsdot * 10.0 * time + z) / 10.0).sin();
        assert!((wave.radius(z, epsdot * time) - expected).abs() < 1e-14);
        // What is at z now was at z + c dt before.
        let dt = 0.3;
        let before = wave.radius(z + epsdot * 10.0 * dt, epsdot * (time - dt));
        assert!((before - expected).abs() < 1e-14);
    }

    #[test]
    fn velocity_and_slope_are_the_derivatives_of_the_radius() {
        for heading in [-1.0, 1.0] {
            let wave = wave(heading);
            let (frequency, z, cycles, dt) = (0.1, 2.3, 0.77, 1e-5);
            let later = wave.radius(z, cycles + frequency * dt);
            let earlier = wave.radius(z, cycles - frequency * dt);
            let ring = wave.ring(z, cycles, frequency, 0.0);
            assert_eq!(ring.radius, wave.radius(z, cycles));
            assert!((ring.velocity - (later - earlier) / (2.0 * dt)).abs() < 1e-9);
            let ahead = wave.radius(z + dt, cycles);
            let behind = wave.radius(z - dt, cycles);
            assert!((ring.slope - (ahead - behind) / (2.0 * dt)).abs() < 1e-9);
        }
    }

    #[test]
    fn every_waveform_has_the_throat_the_mean_and_the_bounds_that_it_says() {
        let steps = 40_000;
        for form in Waveform::ALL {
            assert!((form.value(0.75) + 1.0).abs() < 1e-15, "{form:?}");
            let (mut sum, mut least, mut largest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
            let (mut steepest, mut most_curved) = (0.0_f64, 0.0_f64);
            for step in 0..steps {
                // Beyond one cycle on either side, too.
                let phase = 3.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0;
                let (value, slope) = form.value_and_slope(phase);
                assert_eq!(value, form.value(phase));
                assert!((value - form.value(phase + 2.0)).abs() < 1e-13);
                // Even about the throat.
                assert!(
                    (value - form.value(1.5 - phase)).abs() < 1e-13,
                    "{form:?} at {phase}"
                );
                sum += value;
                (least, largest) = (least.min(value), largest.max(value));
                let h = 1e-5;
                let ahead = form.value_and_slope(phase + h);
                let behind = form.value_and_slope(phase - h);
                assert!(
                    (slope - (ahead.0 - behind.0) / (2.0 * h)).abs() < 1e-3,
                    "{form:?} at {phase}"
                );
                steepest = steepest.max(slope.abs() / TAU);
                most_curved = most_curved.max((ahead.1 - behind.1).abs() / (2.0 * h * TAU * TAU));
            }
            assert!(
                (sum / f64::from(steps) - form.mean()).abs() < 1e-8,
                "{form:?}: {sum}"
            );
            assert!((least + 1.0).abs() < 1e-6 && (largest - form.largest()).abs() < 1e-6);
            assert!(
                (steepest / form.steepest() - 1.0).abs() < 1e-3,
                "{form:?}: {steepest}"
            );
            assert!(
                (most_curved / form.most_curved() - 1.0).abs() < 1e-3,
                "{form:?}: {most_curved}"
            );
        }
        // Half way up its flank by hand: cos^2(pi/4), and s = 1/8 on the roller: (1/64)/(1/20) - 1.
        assert!((Waveform::Bolus.value(0.875) + 0.5).abs() < 1e-15);
        assert!((Waveform::Roller.value(0.875) + 0.6875).abs() < 1e-14);
    }

    #[test]
    fn turning_the_wave_round_mirrors_it() {
        let (forward, backward) = (wave(-1.0), wave(1.0));
        for (z, cycles) in [(0.3, 0.1), (7.7, 3.9), (-4.0, 12.25)] {
            assert!((forward.radius(z, cycles) - backward.radius(-z, cycles)).abs() < 1e-14);
            let one = forward.wave_frame_position(z, cycles);
            let other = backward.wave_frame_position(-z, cycles);
            assert!((one - other).abs() < 1e-12);
        }
    }
}
