use super::*;
use crate::Scaling;
use crate::tests::{Coverage, point, white_noise};

const RATES: [f64; 5] = [0.03, 0.05, 0.08, 0.12, 0.2];

fn critical(rate: f64) -> f64 {
    3.02 - 3.75 * rate
}

/// tau = rate^-7/2 f((w_c - w)/rate^3/2), f(x) = 1/(x (1 + x)), with errors of 6 per cent, on unequal grids.
fn transition_times(seed: u64) -> Vec<Curve> {
    let curve = |(k, &parameter): (usize, &f64)| {
        let noise = white_noise(seed * 10 + k as u64, 12);
        let noisy = |j: usize| {
            // x from 0.1 to 6, the grids shifted against each other.
            let x = 0.1 * libm::exp(0.37 * (j as f64 + 0.19 * k as f64));
            let tau = libm::pow(parameter, -3.5) / (x * (1.0 + x));
            let y = tau * libm::exp(0.06 * noise[j]);
            point(
                critical(parameter) - x * libm::pow(parameter, 1.5),
                y,
                0.06 * y,
            )
        };
        let points = (0..12).map(noisy).collect();
        Curve { parameter, points }
    };
    RATES.iter().enumerate().map(curve).collect()
}

fn collapse<'a>(
    curves: &'a [Curve],
    transform: &'a Transform<'a>,
    least_overlap: f64,
) -> Collapse<'a> {
    Collapse {
        curves,
        transform,
        least_overlap,
    }
}

fn known() -> Scaling {
    Scaling::CriticalKnown(RATES.map(critical).to_vec())
}

#[test]
fn exponents_are_found_with_bootstrap_errors_that_cover() {
    let scaling = known();
    let transform = |p: &[f64], k: usize, rate: f64, point| scaling.apply(p, k, rate, point);
    let steps = [0.3, 0.2];
    let trials = 32;
    let mut coverage = Coverage::of([("a", 3.5), ("b", 1.5)]);
    let mut mean_quality = 0.0;
    for seed in 0..trials {
        let curves = transition_times(seed);
        let collapse = collapse(&curves, &transform, 0.5);
        let fit = collapse.fit(&[3.0, 1.2], &steps, 2, 1).unwrap();
        assert!(fit.quality.overlap > 0.8, "{fit:?}");
        mean_quality += fit.quality.quality / trials as f64;
        let bootstrap = Bootstrap::new(40, seed);
        let errors = collapse.bootstrap(&fit, &steps, bootstrap).unwrap();
        let found = [errors.estimates[0], errors.estimates[1]];
        coverage.count(found);
        assert!(found.iter().all(|found| found.error < 0.2), "{found:?}");
    }
    assert!((mean_quality - 1.0).abs() < 0.15, "{mean_quality}");
    // Percentiles of 40 resamples; the noise of the data counts twice in a resample.
    coverage.judge([0.05; 2]);
}

#[test]
fn exponents_and_the_line_of_critical_widths_are_found_together() {
    let curves = transition_times(7);
    let transform =
        |p: &[f64], k: usize, rate: f64, point| Scaling::CriticalLine.apply(p, k, rate, point);
    let collapse = collapse(&curves, &transform, 0.7);
    let (start, steps) = ([3.2, 1.3, -3.7, 3.022], [0.3, 0.2, 0.1, 0.01]);
    let fit = collapse.fit(&start, &steps, 4, 5).unwrap();
    assert!(
        fit.quality.quality < 1.6 && fit.quality.overlap >= 0.7,
        "{fit:?}"
    );
    for (found, truth) in fit.parameters.iter().zip([3.5, 1.5, -3.75, 3.02]) {
        assert!((found - truth).abs() < 0.08 * truth.abs(), "{fit:?}");
    }
}

#[test]
fn leaving_a_curve_out_changes_little_unless_it_is_a_stray() {
    let scaling = known();
    let transform = |p: &[f64], k: usize, rate: f64, point| scaling.apply(p, k, rate, point);
    let mut curves = transition_times(8);
    let exponents = |curves: &[Curve]| -> Vec<f64> {
        let collapse = collapse(curves, &transform, 0.5);
        let fits = collapse.leave_one_out(&[3.2, 1.3], &[0.3, 0.2], 1, 0);
        let fits = fits.unwrap();
        fits.iter().map(|fit| fit.parameters[0]).collect()
    };
    let found = exponents(&curves);
    assert!(found.iter().all(|a| (a - 3.5).abs() < 0.3), "{found:?}");
    // The fastest curve five times too slow: only without it are the exponents right.
    for point in &mut curves[4].points {
        point.y *= 5.0;
        point.error *= 5.0;
    }
    let found = exponents(&curves);
    assert!((found[4] - 3.5).abs() < 0.3, "{found:?}");
    assert!((found[0] - 3.5).abs() > 0.4, "{found:?}");
}

/// Arches of different height, which no shift collapses but which all end at 0.
fn misfits() -> Vec<Curve> {
    (1..5)
        .map(|k| {
            let parameter = f64::from(k);
            let arch = |x: f64| point(x, parameter * x * (9.0 - x), 0.5);
            let points = (0..10).map(|j| arch(f64::from(j))).collect();
            Curve { parameter, points }
        })
        .collect()
}

#[test]
fn a_search_cannot_win_by_pulling_the_curves_apart() {
    let curves = misfits();
    let shift = |p: &[f64], _: usize, parameter: f64, point: CurvePoint| CurvePoint {
        x: point.x + p[0] * parameter,
        ..point
    };
    let fit = |least_overlap| collapse(&curves, &shift, least_overlap).fit(&[0.0], &[3.0], 12, 3);
    let free = fit(0.0).unwrap();
    let held = fit(0.6).unwrap();
    assert!(free.quality.overlap < 0.5, "{free:?}");
    assert!(free.quality.quality < held.quality.quality);
    assert!(
        held.quality.overlap >= 0.6 && held.quality.is_connected,
        "{held:?}"
    );
}

#[test]
fn overlap_that_cannot_be_had_is_refused() {
    let mut curves = misfits();
    for point in &mut curves[3].points {
        point.x += 1000.0;
    }
    let plain = |_: &[f64], _: usize, _: f64, point: CurvePoint| point;
    let collapse = collapse(&curves, &plain, 0.9);
    let refused = collapse.fit(&[0.0], &[1.0], 1, 0);
    assert!(
        matches!(refused, Err(Error::NoOverlap { needed: 0.9, found }) if found > 0.5),
        "{refused:?}"
    );
    let one = Collapse {
        curves: &curves[..1],
        ..collapse
    };
    assert_refused!(one.fit(&[0.0], &[1.0], 1, 0) => TooFew { needed: 2, found: 1 });
    assert_refused!(one.leave_one_out(&[0.0], &[1.0], 1, 0) => TooFew { needed: 3, .. });
    assert!(collapse.fit(&[0.0], &[0.0], 1, 0).is_err());
    assert!(collapse.fit(&[0.0], &[1.0], 0, 0).is_err());
    let beyond = Collapse {
        least_overlap: 1.5,
        ..collapse
    };
    assert_refused!(beyond.fit(&[0.0], &[1.0], 1, 0) => Fraction { value: 1.5 });
}
