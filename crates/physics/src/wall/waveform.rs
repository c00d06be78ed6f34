//! Shapes of the wave: how the radius, or the force on the wall, follows the phase.

use core::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::real::Real;

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
const ROLLER_SHOULDER: f64 = 0.25;
/// s1: where the tube comes off the roller.
const ROLLER_CONTACT: f64 = 0.2;

impl Waveform {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Sine, Self::Bolus, Self::Roller];

    /// Value at a phase in cycles.
    pub fn value(self, phase: f64) -> f64 {
        match self {
            Self::Sine => libm::sin(TAU * phase),
            Self::Bolus | Self::Roller => self.value_and_slope(phase).0,
        }
    }

    /// Value, and derivative with respect to the phase in cycles.
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

    /// The same value for any number type, good to 1e-14, at phases below 2^31 in size.
    #[inline(always)]
    pub fn value_by_series<R: Real>(self, phase: R) -> R {
        let one = R::splat(1.0);
        match self {
            Self::Sine => sine_by_series(phase),
            Self::Bolus => {
                let distance = distance_from_throat(phase);
                // -cos^2(2 pi s) = -(1 + sin(2 pi (2 s + 1/4)))/2
                let sine = sine_by_series(distance + distance + R::splat(0.25));
                let squeezed = R::splat(-0.5) * (one + sine);
                R::select(distance.less(R::splat(0.25)), squeezed, R::splat(0.0))
            }
            Self::Roller => {
                let [inner, outer] = ROLLER_CURVATURES.map(|curvature| R::splat(0.5 * curvature));
                let distance = distance_from_throat(phase);
                let rest = (R::splat(ROLLER_SHOULDER) - distance).positive_part();
                let pressed = inner * (distance * distance) - one;
                let on_roller = distance.less(R::splat(ROLLER_CONTACT));
                R::select(on_roller, pressed, R::splat(0.0) - outer * (rest * rest))
            }
        }
    }

    /// Mean g over the wave; the mean radius is a + b g.
    pub fn mean(self) -> f64 {
        match self {
            Self::Sine => 0.0,
            Self::Bolus => -0.25,
            // -2 s1 + 2 s1^2/(3 s0) - 2 (s0 - s1)^2/(3 s0)
            Self::Roller => -0.3,
        }
    }

    /// Largest value; the least is -1.
    pub fn largest(self) -> f64 {
        match self {
            Self::Sine => 1.0,
            Self::Bolus | Self::Roller => 0.0,
        }
    }

    /// Largest size of the slope against 2 pi phase.
    pub fn steepest(self) -> f64 {
        match self {
            Self::Sine | Self::Bolus => 1.0,
            Self::Roller => ROLLER_CURVATURES[0] * ROLLER_CONTACT / TAU,
        }
    }

    /// Length over which it has one bend at most, about, in cycles.
    pub fn finest(self) -> f64 {
        match self {
            Self::Sine | Self::Bolus => 0.25,
            Self::Roller => 0.05,
        }
    }
}

/// Second derivatives of the roller's waveform on the roller and, with the other sign, on the shoulder.
const ROLLER_CURVATURES: [f64; 2] = [
    2.0 / (ROLLER_SHOULDER * ROLLER_CONTACT),
    2.0 / (ROLLER_SHOULDER * (ROLLER_SHOULDER - ROLLER_CONTACT)),
];

/// Phase measured from the nearest throat, from -1/2 to 1/2.
fn from_throat(phase: f64) -> f64 {
    let from_belly = phase - 0.25;
    from_belly - from_belly.floor() - 0.5
}

/// Distance of a phase from the nearest throat, up to 1/2.
#[inline(always)]
fn distance_from_throat<R: Real>(phase: R) -> R {
    let from_throat = phase - R::splat(0.75);
    (from_throat - from_throat.nearest_integer()).abs()
}

/// sin(2 pi x), good to 1e-15.
///
/// By symmetry from the nearest quarter turn; there a Taylor series, whose remainder is below (pi/2)^21/21! = 3e-16.
#[inline(always)]
fn sine_by_series<R: Real>(phase: R) -> R {
    let turn = phase - phase.nearest_integer();
    // |turn| <= 1/2: sin(pi - x) = sin(x) brings it to at most 1/4.
    let half = R::select(turn.less(R::splat(0.0)), R::splat(-0.5), R::splat(0.5));
    let quarter = R::select(R::splat(0.25).less(turn.abs()), half - turn, turn);
    let x = quarter * R::splat(TAU);
    let square = x * x;
    let mut series = R::splat(SINE_COEFFICIENTS[0]);
    for &coefficient in &SINE_COEFFICIENTS[1..] {
        series = series * square + R::splat(coefficient);
    }
    x * series
}

/// (-1)^k/(2 k + 1)! for k = 9 down to 0.
const SINE_COEFFICIENTS: [f64; 10] = [
    -1.0 / 121_645_100_408_832_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5_040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
    1.0,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_waveform_has_the_throat_the_mean_and_the_bounds_that_it_says() {
        let steps = 40_000;
        for form in Waveform::ALL {
            assert!((form.value(0.75) + 1.0).abs() < 1e-15, "{form:?}");
            let (mut sum, mut least, mut largest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
            let mut steepest = 0.0_f64;
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
        }
        // Half way up its flank by hand: cos^2(pi/4), and s = 1/8 on the roller: (1/64)/(1/20) - 1.
        assert!((Waveform::Bolus.value(0.875) + 0.5).abs() < 1e-15);
        assert!((Waveform::Roller.value(0.875) + 0.6875).abs() < 1e-14);
    }

    #[test]
    fn the_series_are_the_waveforms() {
        for form in Waveform::ALL {
            let mut largest = 0.0_f64;
            for step in -40_000..40_000_i32 {
                let phase = f64::from(step) * 1.7e-4 / 3.0;
                let expected = form.value(phase - phase.floor());
                largest = largest.max((form.value_by_series(phase) - expected).abs());
            }
            // Bolus and roller are as steep as 2 pi and 8 cycles.
            let limit = if form == Waveform::Sine { 2e-15 } else { 1e-14 };
            assert!(largest < limit, "{form:?}: {largest:e}");
        }
        let root = core::f64::consts::FRAC_1_SQRT_2;
        for (phase, sine) in [
            (0.0, 0.0),
            (0.25, 1.0),
            (0.75, -1.0),
            (1.0, 0.0),
            (-0.25, -1.0),
            (0.125, root),
        ] {
            assert!((Waveform::Sine.value_by_series(phase) - sine).abs() < 1e-15);
        }
    }
}
