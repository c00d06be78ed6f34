use super::*;
use crate::bootstrap::Randomness;
use crate::columns::mean_of;
use crate::tests::{Coverage, exponential, remission, watched, watched_runs};
use proptest::prelude::*;

#[test]
fn the_textbook_example_of_remission_times() {
    let found = Survival::new(&remission()).unwrap();
    assert_eq!((found.runs, found.observed, found.watched), (21, 9, 35.0));
    let expected = [
        (6.0, 21, 0.857, 0.0764),
        (7.0, 17, 0.807, 0.0869),
        (10.0, 15, 0.753, 0.0963),
        (13.0, 12, 0.690, 0.1068),
        (16.0, 11, 0.627, 0.1141),
        (22.0, 7, 0.538, 0.1282),
        (23.0, 6, 0.448, 0.1346),
    ];
    assert_eq!(found.steps.len(), expected.len());
    for (step, (time, at_risk, survival, error)) in found.steps.iter().zip(expected) {
        assert_eq!((step.time, step.at_risk), (time, at_risk));
        assert!((step.survival.value - survival).abs() < 5.1e-4);
        assert!((step.survival.error - error).abs() < 5.1e-5);
    }
    let median = found.median().unwrap();
    assert_eq!(median.value, 23.0);
    assert_eq!(median.interval_95, Interval::new(13.0, f64::INFINITY));
    assert_eq!(found.at(22.5), found.steps[5].survival.value);
    assert_eq!(found.at(0.0), 1.0);
}

#[test]
fn without_censoring_the_restricted_moments_are_those_of_the_sample() {
    let times = [3.0, 1.0, 7.0, 2.0, 2.0];
    let runs = times.map(|time| Transition::At { time, period: 0 });
    let found = restricted_moments(&runs, 9.0).unwrap();
    let plain = crate::ensemble::moments(&times).unwrap();
    assert!((found.mean.value - plain.mean).abs() < 1e-14);
    assert!((found.mean.error - plain.mean_error).abs() < 1e-14);
    assert!((found.variance.value - plain.variance).abs() < 1e-13);
    // ln s^2 without one of them: pseudo-values of mean 2.7722 and error 1.8516. No variance of times below 9 is above 25.3125.
    let logarithm = Uncertain::student(2.772_193_239, 1.851_621_887, 4);
    let lower = libm::exp(logarithm.interval_68.lower);
    assert!((found.variance.interval_68.lower - lower).abs() < 1e-8);
    assert!((found.variance.interval_68.upper - 25.3125).abs() < 1e-12);
    let survival = Survival::new(&runs).unwrap();
    assert_eq!(survival.median().unwrap().value, 2.0);
    assert_eq!(survival.at(7.0), 0.0);
}

#[test]
fn one_late_run_does_not_make_the_variance_endless() {
    for apart in [0.0, 1e-9, 1e-6, 0.01, 0.3, 1.0] {
        let time = |k: u32| {
            if k < 9 {
                10.0 + apart * f64::from(k)
            } else {
                20.0
            }
        };
        let runs: Vec<Transition> = (0..10).map(|k| Transition::new(time(k), true)).collect();
        let variance = restricted_moments(&runs, 30.0).unwrap().variance;
        let Interval { lower, upper } = variance.interval_95;
        assert!(
            lower <= variance.value && variance.value <= upper,
            "{variance:?}"
        );
        assert!(
            upper <= 250.0 && variance.error < 40.0 && variance.error > 4.0,
            "{variance:?}"
        );
        // One run makes up nearly all of it.
        if apart < 0.5 {
            let times: Vec<f64> = (0..10).map(time).collect();
            let plain = crate::ensemble::moments(&times).unwrap();
            assert!((variance.error - plain.variance_error).abs() < 1e-9);
        }
    }
    // Two values, five runs each: all is known alike, and the interval holds the variance.
    let runs = [1.1, 3.3].repeat(5);
    let runs: Vec<Transition> = runs
        .into_iter()
        .map(|time| Transition::new(time, true))
        .collect();
    let variance = restricted_moments(&runs, 30.0).unwrap().variance;
    assert!(variance.interval_68.contains(variance.value));
}

/// Symmetric intervals from the jackknife of the variance itself cover it in 0.55 and 0.77 of the cases.
#[test]
fn intervals_of_the_variance_of_ten_runs_cover() {
    let mut coverage = Coverage::of([("mean", 3.0), ("variance", 3.0)]);
    for seed in 0..1000 {
        let mut randomness = Randomness::new(seed, 1);
        let mut exponential = || -libm::log(1.0 - randomness.uniform());
        let runs: Vec<Transition> = (0..10)
            .map(|_| Transition::new(exponential() + exponential() + exponential(), true))
            .collect();
        let found = restricted_moments(&runs, 1e3).unwrap();
        coverage.count([found.mean, found.variance]);
    }
    coverage.judge([0.05, 0.04]);
}

#[test]
fn intervals_of_survival_median_and_restricted_mean_cover() {
    let (runs, horizon) = (40, 1.5);
    let true_mean = 1.0 - libm::exp(-horizon);
    // E min(t, h)^2 = 2 (1 - (1 + h) exp(-h)).
    let true_variance = 2.0 * (1.0 - (1.0 + horizon) * libm::exp(-horizon)) - true_mean * true_mean;
    let mut coverage = Coverage::of([
        ("survival", libm::exp(-1.0)),
        ("median", 2.0_f64.ln()),
        ("restricted mean", true_mean),
    ]);
    for seed in 0..400 {
        let mut randomness = Randomness::new(seed, 1);
        // Watched for a time uniform from 1 to 3, whatever happens.
        let sample: Vec<Transition> = (0..runs)
            .map(|_| {
                let until = 1.0 + 2.0 * randomness.uniform();
                watched(exponential(&mut randomness), until)
            })
            .collect();
        let survival = Survival::new(&sample).unwrap();
        let mut before = survival.steps.iter();
        let step = before.rfind(|step| step.time <= 1.0).unwrap();
        let median = survival.median().unwrap();
        let Ok(moments) = restricted_moments(&sample, horizon) else {
            panic!("seed {seed}: nobody watched at the horizon");
        };
        coverage.count([step.survival, median, moments.mean]);
        assert!((moments.variance.value - true_variance).abs() < 6.0 * moments.variance.error);
    }
    // A survival of 40 runs has steps of 0.025, which costs some hundredths of the level.
    coverage.judge([0.02, 0.01]);
}

#[test]
fn dropping_censored_runs_biases_the_mean_and_the_curve_does_not() {
    // As at a width near w_c: mean 1, watched for 1, so that 37 per cent of the runs are censored.
    let mut randomness = Randomness::new(5, 0);
    let sample = watched_runs(1500, 1.0, || exponential(&mut randomness));
    let times: Vec<f64> = sample.iter().filter_map(|run| run.observed()).collect();
    let naive = mean_of(&times);
    // E(t | t < 1) = 1 - 1/(e - 1).
    assert!((naive - 0.418).abs() < 0.03);
    let restricted = restricted_moments(&sample, 1.0).unwrap().mean;
    assert!((restricted.value - 0.632).abs() < 0.03);
    let fitted = crate::fit_lifetime(crate::Family::Exponential, &sample).unwrap();
    assert!((fitted.mean.value - 1.0).abs() < 0.1);
}

#[test]
fn bad_runs_and_horizons_are_refused() {
    assert_refused!(Survival::new(&[]) => TooFew { needed: 1, .. });
    let censored = |time| Transition::Censored { time };
    assert_refused!(Survival::new(&[censored(-1.0)]) => Negative { index: 0, .. });
    assert_refused!(
        Survival::new(&[censored(1.0), censored(f64::NAN)]) =>
        NonFinite { index: 1, .. }
    );
    let all_censored = Survival::new(&[censored(1.0); 4]).unwrap();
    assert_refused!(all_censored.median() => LevelNotReached { level: 0.5, survival: 1.0 });
    assert_refused!(all_censored.restricted_mean(1.0) => TooFewObserved { observed: 0, .. });
    let found = Survival::new(&remission()).unwrap();
    for horizon in [35.5, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_refused!(found.restricted_mean(horizon) => Horizon { .. });
    }
}

proptest! {
    #[test]
    fn the_curve_falls_and_its_intervals_hold_it(
        times in prop::collection::vec((0.0..10.0_f64, any::<bool>()), 1..40),
    ) {
        let runs: Vec<Transition> = times
            .iter()
            .map(|&(time, observed)| {
                // Rounded, so that ties occur.
                let time = time.round();
                if observed {
                    Transition::At { time, period: 0 }
                } else {
                    Transition::Censored { time }
                }
            })
            .collect();
        let survival = Survival::new(&runs).unwrap();
        let mut last = 1.0;
        for step in &survival.steps {
            let value = step.survival.value;
            prop_assert!(value < last && value >= 0.0);
            prop_assert!(step.survival.interval_95.contains(value));
            prop_assert!(step.survival.interval_68.contains(value));
            last = value;
        }
        if let Ok(mean) = survival.restricted_mean(survival.watched) {
            prop_assert!(mean.value >= 0.0 && mean.value <= survival.watched + 1e-9);
            prop_assert!(mean.error.is_finite());
        }
        if let Ok(median) = survival.median() {
            prop_assert!(median.interval_95.contains(median.value));
        }
    }
}
