//! Waveforms in lanes.

use peristalsis_physics::real::Real;
use peristalsis_physics::wall::Waveform;
use peristalsis_physics::wall::wave::{ROLLER_CONTACT, ROLLER_CURVATURES, ROLLER_SHOULDER};

use crate::fast::lanes::Lanes;
use crate::fast::machine::Machine;

/// Value of a waveform at phases in cycles.
#[inline(always)]
pub(super) fn value<M: Machine>(form: Waveform, phase: Lanes<M>) -> Lanes<M> {
    let zero = Lanes::splat(0.0);
    match form {
        Waveform::Sine => sine(phase),
        Waveform::Bolus => {
            let distance = from_throat(phase);
            // -cos^2(2 pi s) = -(1 + sin(2 pi (2 s + 1/4)))/2
            let sine = sine(distance + distance + Lanes::splat(0.25));
            let squeezed = Lanes::splat(-0.5) * (Lanes::splat(1.0) + sine);
            Lanes::select(distance.less(Lanes::splat(0.25)), squeezed, zero)
        }
        Waveform::Roller => {
            let [inner, outer] = ROLLER_CURVATURES.map(|curvature| Lanes::splat(0.5 * curvature));
            let distance = from_throat(phase);
            let rest = (Lanes::splat(ROLLER_SHOULDER) - distance).positive_part();
            let pressed = inner * (distance * distance) - Lanes::splat(1.0);
            let on_roller = distance.less(Lanes::splat(ROLLER_CONTACT));
            Lanes::select(on_roller, pressed, zero - outer * (rest * rest))
        }
    }
}

/// Distance of a phase from that of the nearest throat, up to 1/2.
#[inline(always)]
fn from_throat<M: Machine>(phase: Lanes<M>) -> Lanes<M> {
    let from_throat = phase - Lanes::splat(0.75);
    (from_throat - from_throat.round().0).size()
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
    fn waveforms_in_lanes_are_the_waveforms() {
        for form in Waveform::ALL {
            let mut largest = 0.0_f64;
            for step in -40_000..40_000_i32 {
                let phase = f64::from(step) * 1.7e-4 / 3.0;
                let found = value::<Plain>(form, Lanes::splat(phase)).to_array()[3];
                let expected = form.value(phase - phase.floor());
                largest = largest.max((found - expected).abs());
            }
            // Bolus and roller are as steep as 2 pi and 8 cycles.
            let limit = if form == Waveform::Sine { 2e-15 } else { 1e-14 };
            assert!(largest < limit, "{form:?}: {largest:e}");
        }
        let exact = [0.0, 0.25, 0.5, 0.75, 1.0, -0.25, -0.5, 0.125];
        let lanes = Lanes::<Plain>::load(&exact, 0);
        let found = value(Waveform::Sine, lanes).to_array();
        let root = core::f64::consts::FRAC_1_SQRT_2;
        for (found, expected) in found
            .into_iter()
            .zip([0.0, 1.0, 0.0, -1.0, 0.0, -1.0, 0.0, root])
        {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
