//! Collapses of data that are not ours: the correlation length of Ising strips, which is known exactly.

use crate::collapse::{Curve, CurvePoint};
use crate::collapse_fit::Collapse;
use crate::scaling::Scaling;
use crate::tests::{point, white_noise};

/// Circumference over correlation length of an Ising strip, infinite to one side: Onsager, Phys. Rev. 65, 117 (1944).
fn circumference_over_length(size: u32, temperature: f64) -> f64 {
    let coupling = 2.0 / temperature;
    let (cosh, sinh) = (libm::cosh(coupling), libm::sinh(coupling));
    let gamma = |k: u32| match k {
        0 => coupling + libm::log(libm::tanh(0.5 * coupling)),
        _ => libm::acosh(
            cosh * cosh / sinh - libm::cos(std::f64::consts::PI * f64::from(k) / f64::from(size)),
        ),
    };
    let pairs = (0..size).map(|r| gamma(2 * r + 1) - gamma(2 * r));
    0.5 * f64::from(size) * pairs.sum::<f64>()
}

/// T_c = 2/ln(1 + 2^(1/2)).
fn critical() -> f64 {
    2.0 / libm::log(1.0 + 2.0_f64.sqrt())
}

fn curves(sizes: &[u32], seed: u64) -> Vec<Curve> {
    let curve = |&size: &u32| {
        let noise = white_noise(100 * seed + u64::from(size), 15);
        let noisy = |j: usize| {
            let offset = 0.01 * f64::from(size % 7);
            let x = critical() + (0.2 * (j as f64 - 7.0) + offset) / f64::from(size);
            point(
                x,
                circumference_over_length(size, x) + 0.01 * noise[j],
                0.01,
            )
        };
        Curve {
            parameter: f64::from(size),
            points: (0..15).map(noisy).collect(),
        }
    };
    sizes.iter().map(curve).collect()
}

#[test]
fn strips_at_the_critical_temperature_have_the_length_of_conformal_theory() {
    // L/xi = 2 pi/8.
    let found = circumference_over_length(64, critical());
    assert!(
        (found - std::f64::consts::FRAC_PI_4).abs() < 1e-3,
        "{found}"
    );
    assert!((circumference_over_length(8, 1e3) / 8.0 - libm::log(1e3)).abs() < 0.01);
}

/// With Ising data 1/nu came out as 1.057 +- 0.008.
#[test]
fn the_exponents_of_ising_are_found() {
    let transform = |p: &[f64], k: usize, size: f64, point: CurvePoint| {
        Scaling::FiniteSize.apply(p, k, size, point)
    };
    let truth = [0.0, 1.0, critical()];
    let mut covered = [0; 3];
    for seed in 0..12 {
        let curves = curves(&[8, 16, 32, 64], seed);
        let collapse = Collapse {
            curves: &curves,
            transform: &transform,
            least_overlap: 0.5,
        };
        let estimate = |correction| {
            collapse
                .estimate(
                    &[],
                    &[0.05, 0.9, 2.25],
                    &[0.05, 0.1, 0.02],
                    4,
                    seed,
                    correction,
                )
                .unwrap()
        };
        let found = estimate(Some(-1.0));
        assert!(
            found.trusted && found.parameters[1].error < 0.1,
            "{found:?}"
        );
        for ((parameter, truth), covered) in found.parameters.iter().zip(truth).zip(&mut covered) {
            *covered += usize::from(parameter.interval_95.contains(truth));
        }
        // Small strips depart from the scaling: without a correction the exponents are wrong, and the fit knows.
        assert!(seed > 0 || !estimate(None).trusted);
    }
    assert!(covered.iter().all(|&covered| covered >= 10), "{covered:?}");
}
