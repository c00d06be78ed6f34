//! Waveforms in lanes.

use peristalsis_physics::real::Real;
use peristalsis_physics::wall::Waveform;

use crate::fast::lanes::Lanes;
use crate::fast::machine::Machine;

/// Value of a waveform at phases in cycles.
#[inline(always)]
pub(super) fn waveform<M: Machine>(form: Waveform, phase: Lanes<M>) -> Lanes<M> {
    match form {
        Waveform::Sine => sine(phase),
    }
}

/// sin(2 pi x), good to 1e-15.
///
/// |x| below 2^31. By symmetry from the nearest quarter turn, there a Taylor series, whose rest is below (pi/2)^21/21! = 3e-16.
#[inline(always)]
fn sine<M: Machine>(phase: Lanes<M>) -> Lanes<M> {
    let turn = phase - phase.round().0;
    // |turn| <= 1/2: sin(pi - x) = sin(x) brings it to at most 1/4.
    let half = Lanes::select(
        turn.less(Lanes::splat(0.0)),
        Lanes::splat(-0.5),
        Lanes::splat(0.5),
    );
    let quarter = Lanes::select(Lanes::splat(0.25).less(turn.size()), half - turn, turn);
    let x = quarter * Lanes::splat(core::f64::consts::TAU);
    let square = x * x;
    let mut series = Lanes::splat(COEFFICIENTS[0]);
    for &coefficient in &COEFFICIENTS[1..] {
        series = series * square + Lanes::splat(coefficient);
    }
    x * series
}

/// (-1)^k/(2 k + 1)! for k = 9 down to 0.
const COEFFICIENTS: [f64; 10] = [
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
    use crate::fast::machine::Plain;

    #[test]
    fn the_sine_in_lanes_is_the_sine() {
        let mut largest = 0.0_f64;
        for step in -40_000..40_000_i32 {
            let phase = f64::from(step) * 1.7e-4 / 3.0;
            let found = waveform::<Plain>(Waveform::Sine, Lanes::splat(phase)).to_array()[3];
            let expected = Waveform::Sine.value(phase - phase.floor());
            largest = largest.max((found - expected).abs());
        }
        assert!(largest < 2e-15, "{largest:e}");
        let exact = [0.0, 0.25, 0.5, 0.75, 1.0, -0.25, -0.5, 0.125];
        let lanes = Lanes::<Plain>::load(&exact, 0);
        let found = waveform(Waveform::Sine, lanes).to_array();
        let root = core::f64::consts::FRAC_1_SQRT_2;
        for (found, expected) in found
            .into_iter()
            .zip([0.0, 1.0, 0.0, -1.0, 0.0, -1.0, 0.0, root])
        {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
