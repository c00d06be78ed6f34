use super::*;
use crate::tests::{Coverage, assert_coverage, white_noise};

const WIDTHS: [f64; 10] = [2.3, 2.4, 2.5, 2.55, 2.6, 2.65, 2.7, 2.73, 2.76, 2.78];

/// tau = 5 (2.82 - w)^-alpha with relative errors of 8 per cent.
fn noisy(seed: u64, alpha: f64) -> ([f64; 10], [f64; 10]) {
    let noise = white_noise(seed, WIDTHS.len());
    let mut value = WIDTHS.map(|width| 5.0 * libm::pow(2.82 - width, -alpha));
    for (value, noise) in value.iter_mut().zip(noise) {
        *value *= libm::exp(0.08 * noise);
    }
    // The relative error is known.
    (value, value.map(|value| 0.08 * value))
}

#[test]
fn intervals_of_critical_width_and_exponent_cover() {
    let trials = 300;
    let mut coverage = Coverage::of([("w_c", 2.82), ("exponent", 1.0)]);
    let mut improbable = 0;
    for seed in 0..trials {
        let (value, error) = noisy(seed, 1.0);
        let fit = fit_law(Law::Power, &WIDTHS, &value, &error, None).unwrap();
        coverage.count([fit.critical_width.unwrap(), fit.exponent]);
        improbable += usize::from(fit.probability < 0.1);
    }
    coverage.judge([0.01; 2]);
    let trials = trials as usize;
    assert_coverage(improbable, trials, 0.1, 0.01, "probability of chi^2");
}

#[test]
fn a_known_critical_width_sharpens_the_exponent_and_its_error_enters() {
    let mut coverage = Coverage::of([("exponent", 3.0)]);
    let (mut free_error, mut known_error, mut fixed_error) = (0.0, 0.0, 0.0);
    for seed in 0..300 {
        let (value, error) = noisy(seed, 3.0);
        // A measurement of w_c elsewhere, wrong by its own error.
        let elsewhere = 2.82 + 0.004 * white_noise(seed + 10_000, 1)[0];
        let known = Uncertain::normal(elsewhere, 0.004);
        let fit = |known| fit_law(Law::Power, &WIDTHS, &value, &error, known).unwrap();
        let exponent = fit(Some(known)).exponent;
        coverage.count([exponent]);
        known_error += exponent.error;
        free_error += fit(None).exponent.error;
        fixed_error += fit(Some(Uncertain::normal(2.82, 0.0))).exponent.error;
    }
    coverage.judge([0.01; 2]);
    assert!(fixed_error < known_error && known_error < free_error);
}

#[test]
fn barrier_and_exponential_laws_are_found_exactly() {
    let barrier = Law::Barrier { power: 1.0 };
    let value = WIDTHS.map(|width| 3.0 * libm::exp(0.2 / (2.9 - width)));
    let error = value.map(|value| 0.05 * value);
    let fit = fit_law(barrier, &WIDTHS, &value, &error, None).unwrap();
    assert!((fit.critical_width.unwrap().value - 2.9).abs() < 1e-4);
    assert!((fit.exponent.value - 0.2).abs() < 1e-3);
    assert!((fit.ln_amplitude.value - 3.0_f64.ln()).abs() < 1e-2);
    let value = WIDTHS.map(|width| libm::exp(4.0 * width - 2.0));
    let error = value.map(|value| 0.05 * value);
    let fit = fit_law(Law::Exponential, &WIDTHS, &value, &error, None).unwrap();
    assert!((fit.exponent.value - 4.0).abs() < 1e-10);
    assert_eq!((fit.critical_width, fit.degrees_of_freedom), (None, 8));
    // Its critical width lies at infinity.
    assert_refused!(
        fit_law(Law::Power, &WIDTHS, &value, &error, None) =>
        Undetermined { points: 10, parameters: 3 }
    );
}

#[test]
fn what_does_not_determine_a_law_is_refused() {
    let few = fit_law(Law::Power, &[2.0, 2.1, 2.1], &[1.0; 3], &[0.1; 3], None);
    assert_refused!(few => TooFewPlaces { needed: 3, found: 2 });
    let known = Some(Uncertain::normal(2.05, 0.0));
    assert_refused!(
        fit_law(Law::Power, &[2.0, 2.1], &[1.0, 2.0], &[0.1; 2], known) =>
        BeyondCritical { width: 2.1, critical: 2.05 }
    );
    let below = Some(Uncertain::normal(2.2, -0.1));
    assert_refused!(
        fit_law(Law::Power, &WIDTHS, &[1.0; 10], &[0.1; 10], below) =>
        Negative { index: 1, .. }
    );
    let barrier = Law::Barrier { power: -1.0 };
    assert!(fit_law(barrier, &WIDTHS, &[1.0; 10], &[0.1; 10], None).is_err());
    assert_refused!(
        fit_law(Law::Power, &WIDTHS, &[0.0; 10], &[0.1; 10], None) =>
        NotPositive { index: 0, .. }
    );
}

/// The exponent is that of the window until the window is close to w_c.
#[test]
fn the_exponent_against_the_window() {
    let (value, error) = noisy(3, 1.0);
    let fits = fit_law_to_nearest(Law::Power, &WIDTHS, &value, &error, None).unwrap();
    let widths: Vec<usize> = fits.iter().map(|one| one.widths).collect();
    assert_eq!(widths, [4, 5, 6, 7, 8, 9, 10]);
    let whole = fit_law(Law::Power, &WIDTHS, &value, &error, None).unwrap();
    assert_eq!((fits[6].fit, fits[6].least), (whole, 2.3));
    let agrees = |one: &NearestFit| one.fit.exponent.interval_95.contains(1.0);
    assert!(
        fits.iter().filter(|one| agrees(one)).count() >= 6,
        "{fits:?}"
    );
    // The rows come in any order.
    let back = |column: [f64; 10]| -> Vec<f64> { column.into_iter().rev().collect() };
    let known = Some(Uncertain::normal(2.82, 0.0));
    let fit = |width: &[f64], value: &[f64], error: &[f64]| {
        fit_law_to_nearest(Law::Power, width, value, error, known).unwrap()
    };
    let (there, here) = (
        fit(&back(WIDTHS), &back(value), &back(error)),
        fit(&WIDTHS, &value, &error),
    );
    assert_eq!((there.len(), there[0].widths, there[0].least), (8, 3, 2.73));
    let difference = there[3].fit.exponent.value - here[3].fit.exponent.value;
    assert!(difference.abs() < 1e-9, "{difference}");
    assert_refused!(fit_law_to_nearest(Law::Power, &[2.0], &[1.0], &[0.1], None) => TooFewPlaces { .. });
}
