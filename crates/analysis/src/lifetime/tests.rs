use super::*;
use crate::bootstrap::Randomness;
use crate::tests::{Coverage, exponential as unit_exponential, remission, watched_runs};

fn weibull(randomness: &mut Randomness, mean: f64, shape: f64) -> f64 {
    let scale = mean / libm::tgamma(1.0 + 1.0 / shape);
    scale * libm::pow(unit_exponential(randomness), 1.0 / shape)
}

/// Sum of three exponential steps: gamma of shape 3.
fn three_steps(randomness: &mut Randomness, mean: f64) -> f64 {
    (0..3).map(|_| unit_exponential(randomness)).sum::<f64>() * mean / 3.0
}

/// Coverage of the intervals of N estimates, and the spread of the deviations of ln value in units of their errors.
fn coverage<const N: usize>(
    truths: [(&'static str, f64); N],
    until: f64,
    draw: impl Fn(&mut Randomness) -> f64,
    fit: impl Fn(&[Transition]) -> [Uncertain; N],
) {
    let (trials, runs) = (300, 50);
    let mut coverage = Coverage::of(truths);
    let mut pull_squares = [0.0; N];
    for seed in 0..trials {
        let mut randomness = Randomness::new(seed, 9);
        let sample = watched_runs(runs, until, || draw(&mut randomness));
        let found = fit(&sample);
        coverage.count(found);
        for ((found, (_, truth)), squares) in found.iter().zip(truths).zip(&mut pull_squares) {
            let pull = libm::log(found.value / truth) * found.value / found.error;
            *squares += pull * pull;
        }
    }
    // Profile intervals of 50 runs fall short of their level by up to a hundredth or two.
    coverage.judge([0.015; 2]);
    for ((name, _), squares) in truths.iter().zip(pull_squares) {
        let spread = (squares / trials as f64).sqrt();
        assert!((0.85..1.2).contains(&spread), "{name}: {spread}");
    }
}

fn coverage_with_shape(
    family: Family,
    shape: f64,
    until: f64,
    draw: impl Fn(&mut Randomness) -> f64,
) {
    let variance = 100.0 * family.relative_variance(shape);
    let truths = [("mean", 10.0), ("variance", variance), ("shape", shape)];
    coverage(truths, until, draw, |sample| {
        let fit = fit_lifetime(family, sample).unwrap();
        [fit.mean, fit.variance, fit.shape.unwrap()]
    });
}

#[test]
fn exponential_intervals_cover_with_a_third_censored() {
    let draw = |randomness: &mut Randomness| 10.0 * unit_exponential(randomness);
    let truths = [("mean", 10.0), ("variance", 100.0)];
    coverage(truths, 11.0, draw, |sample| {
        let fit = fit_lifetime(Family::Exponential, sample).unwrap();
        [fit.mean, fit.variance]
    });
}

#[test]
fn weibull_intervals_cover_with_a_third_censored() {
    coverage_with_shape(Family::Weibull, 1.8, 12.0, |randomness| {
        weibull(randomness, 10.0, 1.8)
    });
}

#[test]
fn gamma_intervals_cover_with_a_third_censored() {
    coverage_with_shape(Family::Gamma, 3.0, 11.5, |randomness| {
        three_steps(randomness, 10.0)
    });
}

#[test]
fn the_textbook_example_as_other_programs_fit_it() {
    let fit = |family| fit_lifetime(family, &remission()).unwrap();
    let exponential = fit(Family::Exponential);
    assert!((exponential.mean.value - 359.0 / 9.0).abs() < 1e-9);
    // lifelines 0.30 (Weibull), a direct minimisation with scipy (gamma).
    let expected = [
        (Family::Weibull, 30.947_171, 1.353_731_6, -41.658_678_5),
        (Family::Gamma, 31.094_068, 1.677_008_9, -41.439_416_2),
    ];
    for (family, mean, shape, log_likelihood) in expected {
        let found = fit(family);
        assert!((found.mean.value / mean - 1.0).abs() < 1e-5);
        assert!((found.shape.unwrap().value / shape - 1.0).abs() < 1e-5);
        assert!((found.log_likelihood - log_likelihood).abs() < 1e-7);
        assert_eq!((found.observed, found.censored), (9, 12));
    }
    let shape_error = fit(Family::Weibull).shape.unwrap().error;
    assert!(
        (shape_error - 0.142_036_f64.sqrt()).abs() < 0.01,
        "{shape_error}"
    );
}

#[test]
fn the_shape_tells_chance_from_determinism_and_the_criterion_finds_the_family() {
    let mut randomness = Randomness::new(2, 0);
    let mut sample = |shape| watched_runs(300, 8.0, || weibull(&mut randomness, 5.0, shape));
    let (chance, sharp) = (sample(1.0), sample(6.0));
    let shape = |runs: &[Transition]| fit_lifetime(Family::Weibull, runs).unwrap().shape.unwrap();
    assert!(shape(&chance).interval_95.contains(1.0));
    assert!(shape(&sharp).deviations_from(6.0).abs() < 3.0);
    assert!(shape(&sharp).interval_95.lower > 4.0);
    let likely = |family, runs: &[Transition]| fit_lifetime(family, runs).unwrap().log_likelihood;
    assert!(likely(Family::Weibull, &sharp) > likely(Family::Gamma, &sharp));
    assert!(likely(Family::Gamma, &sharp) > likely(Family::Exponential, &sharp) + 51.0);
    assert!(likely(Family::Weibull, &chance) < likely(Family::Exponential, &chance) + 3.0);
}

#[test]
fn the_fit_follows_the_kaplan_meier_curve() {
    let mut randomness = Randomness::new(8, 0);
    let sample = watched_runs(500, 7.0, || three_steps(&mut randomness, 4.0));
    let fit = fit_lifetime(Family::Gamma, &sample).unwrap();
    let curve = crate::Survival::new(&sample).unwrap();
    for time in [1.0, 3.0, 5.0, 6.5] {
        let fitted = Family::Gamma.survival(time, fit.mean.value, fit.shape.unwrap().value);
        assert!((fitted - curve.at(time)).abs() < 0.05);
    }
    assert_eq!(fit.observed + fit.censored, 500);
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let at = |time| Transition::At { time, period: 0 };
    let censored = Transition::Censored { time: 3.0 };
    for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
        let refused = fit_lifetime(family, &[censored; 5]);
        assert_refused!(refused => TooFewObserved { observed: 0, runs: 5, .. });
        assert!(fit_lifetime(family, &[]).is_err());
        assert_refused!(
            fit_lifetime(family, &[at(0.0), at(1.0), at(2.0)]) =>
            NotPositive { index: 0, .. }
        );
    }
    for family in [Family::Gamma, Family::Weibull] {
        assert_refused!(fit_lifetime(family, &[at(2.0); 6]) => NoScatter { observed: 6 });
    }
}

#[test]
fn the_relative_variance_of_gamma_times_follows_from_the_shape_alone() {
    let mut randomness = Randomness::new(1, 2);
    let sample = watched_runs(30, 20.0, || three_steps(&mut randomness, 10.0));
    let fit = fit_lifetime(Family::Gamma, &sample).unwrap();
    let found = fit.relative_variance().unwrap();
    let by_moments = fit.variance.value / (fit.mean.value * fit.mean.value);
    assert!((found.value - by_moments).abs() < 1e-9);
    // ln 1/k has the error of ln k, less than that of the variance.
    let shape = fit.shape.unwrap();
    assert!((found.error / found.value - shape.error / shape.value).abs() < 1e-12);
    assert!(found.error / found.value < fit.variance.error / fit.variance.value);
    let other = fit_lifetime(Family::Weibull, &sample).unwrap();
    assert!(other.relative_variance().is_none());
}
