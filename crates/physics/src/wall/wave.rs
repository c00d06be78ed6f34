//! The travelling wave of contraction that a strain-controlled wall follows.

use core::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{RadiusTable, Segments, Squeeze, Waveform};

/// Which way the wave runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveDirection {
    /// As the source writes it: towards -z under strain control, towards +z under stress control.
    #[default]
    Forward,
    /// The other way.
    Backward,
}

/// How a wavelength of the tube is squeezed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "a tube has one, and asks it by reference"
)]
pub enum Contraction {
    /// By a wave that keeps its shape.
    Wave(Waveform),
    /// By a wave whose shape a table gives.
    Table(RadiusTable),
    /// By segments in turn.
    Segments(Segments),
}

impl From<Waveform> for Contraction {
    fn from(waveform: Waveform) -> Self {
        Self::Wave(waveform)
    }
}

impl Contraction {
    /// Largest value anywhere, at any time.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Wave(waveform) => waveform.largest(),
            Self::Table(_) | Self::Segments(_) => 0.0,
        }
    }

    /// Largest size of the slope along the tube \[1/lambda\].
    pub fn steepest(&self) -> f64 {
        match self {
            Self::Wave(waveform) => TAU * waveform.steepest(),
            Self::Table(table) => table.steepest(),
            Self::Segments(segments) => segments.steepest(),
        }
    }

    /// Length along the tube over which the shape has one bend at most, about \[lambda\].
    pub fn finest(&self) -> f64 {
        match self {
            Self::Wave(waveform) => waveform.finest(),
            Self::Table(table) => table.closest(),
            Self::Segments(segments) => segments.border(),
        }
    }
}

/// Radius of a peristaltic tube and its velocity.
///
/// R(z, t) = a + b g(s z/lambda + c t/lambda), g the waveform, s = 1 for a wave towards -z and s = -1 for one towards
/// +z; of segments a + b G(-s z/lambda, c t/lambda), see [`Segments`]
///
/// a, b, z, lambda \[d\], to the centres of the wall spheres; c t/lambda in cycles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusWave {
    /// a \[d\]
    pub mean_radius: f64,
    /// b \[d\]
    pub amplitude: f64,
    /// lambda \[d\]
    pub wavelength: f64,
    /// g or G.
    pub contraction: Contraction,
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
    pub fn phase(&self, z: f64, cycles: f64) -> f64 {
        let phase = cycles - self.heading * z / self.wavelength;
        phase - phase.floor()
    }

    /// R at z \[d\].
    pub fn radius(&self, z: f64, cycles: f64) -> f64 {
        let value = match &self.contraction {
            Contraction::Wave(waveform) => waveform.value(self.phase(z, cycles)),
            Contraction::Table(table) => table.value_and_slope(self.phase(z, cycles)).0,
            Contraction::Segments(segments) => segments.squeeze(self.along(z), cycles).value,
        };
        self.mean_radius + self.amplitude * value
    }

    /// a - |b|: the least R anywhere, at any time \[d\].
    #[inline]
    pub fn throat_radius(&self) -> f64 {
        self.mean_radius - self.amplitude.abs()
    }

    /// a + |b| g, g the [largest](Contraction::largest) contraction: the largest R anywhere, at any time \[d\].
    pub fn belly_radius(&self) -> f64 {
        self.mean_radius + self.amplitude.abs() * self.contraction.largest()
    }

    /// Least R anywhere now \[d\].
    pub fn narrowest(&self, cycles: f64) -> f64 {
        let depth = match &self.contraction {
            Contraction::Wave(_) | Contraction::Table(_) => 1.0,
            Contraction::Segments(segments) => segments.depth(cycles),
        };
        self.mean_radius - depth * self.amplitude.abs()
    }

    /// The wall at z, for frequency c/lambda and rate of change db/dt of the amplitude.
    pub fn ring(&self, z: f64, cycles: f64, frequency: f64, amplitude_rate: f64) -> Ring {
        match &self.contraction {
            Contraction::Wave(waveform) => {
                let value_and_slope = waveform.value_and_slope(self.phase(z, cycles));
                self.ring_of(value_and_slope, frequency, amplitude_rate)
            }
            Contraction::Table(table) => {
                let value_and_slope = table.value_and_slope(self.phase(z, cycles));
                self.ring_of(value_and_slope, frequency, amplitude_rate)
            }
            Contraction::Segments(segments) => {
                let Squeeze {
                    value,
                    in_time,
                    along,
                } = segments.squeeze(self.along(z), cycles);
                Ring {
                    radius: self.mean_radius + self.amplitude * value,
                    velocity: self.amplitude * frequency * in_time + amplitude_rate * value,
                    slope: self.heading / self.wavelength * self.amplitude * along,
                }
            }
        }
    }

    /// Place along the wave, in wavelengths.
    fn along(&self, z: f64) -> f64 {
        self.heading * z / self.wavelength
    }

    /// The wall where the waveform has the given value and slope against phase.
    #[inline]
    pub fn ring_of(&self, (value, slope): (f64, f64), frequency: f64, amplitude_rate: f64) -> Ring {
        Ring {
            radius: self.mean_radius + self.amplitude * value,
            velocity: self.amplitude * frequency * slope + amplitude_rate * value,
            slope: -self.heading / self.wavelength * self.amplitude * slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wall::SegmentDrive;

    fn wave(heading: f64) -> RadiusWave {
        RadiusWave {
            mean_radius: 1.5,
            amplitude: 0.25,
            wavelength: 10.0,
            contraction: Waveform::Sine.into(),
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
        let segments = Segments::new(&SegmentDrive::default()).unwrap();
        let table = RadiusTable::new(&[0.05, 0.3, 0.5, 0.8], &[1.5, 0.9, 1.0, 1.2]).unwrap();
        let contractions = [
            Waveform::Sine.into(),
            Contraction::Table(table),
            Contraction::Segments(segments),
        ];
        for (heading, contraction) in [-1.0, 1.0]
            .into_iter()
            .flat_map(|heading| contractions.map(|contraction| (heading, contraction)))
        {
            let wave = RadiusWave {
                contraction,
                ..wave(heading)
            };
            let (frequency, z, cycles, dt) = (0.1, 2.3, 0.77, 1e-5);
            let later = wave.radius(z, cycles + frequency * dt);
            let earlier = wave.radius(z, cycles - frequency * dt);
            let ring = wave.ring(z, cycles, frequency, 0.0);
            assert_eq!(ring.radius, wave.radius(z, cycles));
            assert!((ring.velocity - (later - earlier) / (2.0 * dt)).abs() < 1e-9);
            let ahead = wave.radius(z + dt, cycles);
            let behind = wave.radius(z - dt, cycles);
            assert!((ring.slope - (ahead - behind) / (2.0 * dt)).abs() < 1e-9);
            let slope = |step: u32| wave.ring(1e-3 * f64::from(step), 0.9, 0.1, 0.0).slope.abs();
            let steepest = (0..10_000).map(slope).fold(0.0, f64::max);
            let bound = wave.contraction.steepest() * 0.25 / 10.0;
            assert!(steepest <= bound * (1.0 + 1e-12), "{steepest} {bound}");
            assert!(steepest > 0.4 * bound, "{steepest} {bound}");
        }
    }

    #[test]
    fn turning_the_wave_round_mirrors_it() {
        let (forward, backward) = (wave(-1.0), wave(1.0));
        for (z, cycles) in [(0.3, 0.1), (7.7, 3.9), (-4.0, 12.25)] {
            assert!((forward.radius(z, cycles) - backward.radius(-z, cycles)).abs() < 1e-14);
        }
    }
}
