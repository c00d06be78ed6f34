//! Moments across the replicates of an ensemble.

use crate::columns::{jackknife_error, mean_and_scatter};
use crate::error::{Error, check_replicate, checked, enough, same_length};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest replicates: the variance must exist with one of them left out.
const LEAST_REPLICATES: usize = 3;

/// Mean and variance of independent values, with jackknife errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_error: f64,
    /// Variance `<x^2> - <x>^2` of the distribution, estimated without bias (divisor n - 1).
    pub variance: f64,
    /// Standard error of the variance, by the jackknife.
    pub variance_error: f64,
}

/// Variance of a sample with each of its values left out in turn, in order.
///
/// With `S = sum (x - <x>)^2` over all n values the rest has `S - n (x_i - <x>)^2/(n - 1)`, over n - 2.
fn variances_without_one(sample: &[f64]) -> impl Iterator<Item = f64> {
    let replicates = sample.len() as f64;
    let (mean, scatter) = mean_and_scatter(sample);
    sample.iter().map(move |x| {
        let rest = scatter - (x - mean) * (x - mean) * replicates / (replicates - 1.0);
        // Round-off must not leave a negative variance.
        rest.max(0.0) / (replicates - 2.0)
    })
}

/// Mean of independent values and its standard error.
///
/// `<x> = sum x/n`, error `(sum (x - <x>)^2/(n (n - 1)))^(1/2)`: NaN for a single value, both NaN for none.
///
/// ```
/// assert_eq!(peristalsis_analysis::mean_and_error(&[1.0, 2.0, 3.0]).0, 2.0);
/// ```
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let number = values.len() as f64;
    let (mean, scatter) = mean_and_scatter(values);
    (mean, (scatter / (number * (number - 1.0))).sqrt())
}

/// Variance of independent values, `sum (x - <x>)^2/(n - 1)`: NaN below two of them.
///
/// ```
/// assert_eq!(peristalsis_analysis::variance(&[1.0, 2.0, 3.0]), 1.0);
/// assert!(peristalsis_analysis::variance(&[1.0]).is_nan() && peristalsis_analysis::variance(&[]).is_nan());
/// ```
pub fn variance(values: &[f64]) -> f64 {
    mean_and_scatter(values).1 / (values.len().max(1) - 1) as f64
}

/// Mean and variance of independent values with their jackknife errors.
///
/// The jackknife error of the variance holds for any distribution with a fourth moment. For transition times with their
/// long tails it needs some tens of values. Source: Efron, The Jackknife, the Bootstrap and Other Resampling Plans
/// (SIAM, 1982), chapter 3.
pub(crate) fn moments(sample: &[f64]) -> Result<Moments, Error> {
    let (mean, scatter) = mean_and_scatter(checked(sample, LEAST_REPLICATES)?);
    let replicates = sample.len() as f64;
    let variance = scatter / (replicates - 1.0);
    let without_one: Vec<f64> = variances_without_one(sample).collect();
    Ok(Moments {
        mean,
        mean_error: (variance / replicates).sqrt(),
        variance,
        variance_error: jackknife_error(&without_one),
    })
}

/// Mean `<j>(t)` and second moment `chi_J(t) = <j^2> - <j>^2` across replicates at equal times.
///
/// `replicates`: the series of every replicate, j = J/Jmax at the same times, one series per replicate. Errors of the
/// variance by the jackknife. They are errors at each time by itself: values at nearby times share their replicates and scatter
/// together. Source: Efron, The Jackknife, the Bootstrap and Other Resampling Plans (SIAM, 1982), chapter 3.
///
/// # Errors
/// [`Error::TooFew`] below 3 replicates or without times, [`Error::LengthMismatch`], [`Error::NonFiniteReplicate`].
pub fn ensemble_moments<S: AsRef<[f64]>>(replicates: &[S]) -> Result<Vec<Moments>, Error> {
    enough("replicates", replicates.len(), LEAST_REPLICATES)?;
    let times = replicates[0].as_ref().len();
    for (replicate, series) in replicates.iter().map(AsRef::as_ref).enumerate() {
        same_length(times, series.len())?;
        check_replicate(replicate, series)?;
    }
    enough("times", times, 1)?;
    let at = |time: usize| {
        let column = replicates.iter().map(|series| series.as_ref()[time]);
        moments(&column.collect::<Vec<f64>>())
    };
    (0..times).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::white_noise;
    use proptest::prelude::*;

    #[test]
    fn the_error_of_a_mean_is_that_of_independent_values() {
        let (mean, error) = mean_and_error(&[1.0, 2.0, 3.0]);
        assert_eq!(mean, 2.0);
        assert!((error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!(mean_and_error(&[4.0]).1.is_nan());
        assert!(mean_and_error(&[]).0.is_nan());
    }

    #[test]
    fn moments_of_three_numbers_by_hand() {
        // 1, 2, 6: mean 3, scatter 4 + 1 + 9. Without one: variances of (2, 6), (1, 6), (1, 2): 8, 12.5, 0.5.
        let found = moments(&[1.0, 2.0, 6.0]).unwrap();
        assert_eq!((found.mean, found.variance), (3.0, 7.0));
        assert!((found.mean_error - (7.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        let scatter = 1.0_f64 + 5.5 * 5.5 + 6.5 * 6.5;
        assert!((found.variance_error - (2.0 / 3.0 * scatter).sqrt()).abs() < 1e-13);
    }

    #[test]
    fn errors_of_mean_and_variance_cover_the_truth_in_two_cases_out_of_three() {
        let (seeds, replicates) = (2000, 60);
        let (mut mean_covered, mut variance_covered) = (0, 0);
        for seed in 0..seeds {
            let found = moments(&white_noise(seed, replicates)).unwrap();
            mean_covered += u32::from(found.mean.abs() < found.mean_error);
            variance_covered += u32::from((found.variance - 1.0).abs() < found.variance_error);
        }
        let share = |covered: u32| f64::from(covered) / seeds as f64;
        assert!((0.65..0.71).contains(&share(mean_covered)));
        assert!((0.62..0.71).contains(&share(variance_covered)));
    }

    #[test]
    fn the_moments_of_an_ensemble_follow_its_replicates_in_time() {
        // x(t) = 0.3 + a exp(-((t - 50)/10)^2), variance of a = 1.
        let replicates: Vec<Vec<f64>> = white_noise(11, 400)
            .iter()
            .map(|amplitude| {
                let at = |t: i32| {
                    let distance = f64::from(t - 50) / 10.0;
                    0.3 + amplitude * libm::exp(-distance * distance)
                };
                (0..100).map(at).collect()
            })
            .collect();
        let series = ensemble_moments(&replicates).unwrap();
        assert_eq!(series.len(), 100);
        let peak = series[50];
        // sqrt(2/399) for normal amplitudes.
        assert!((peak.variance_error - 0.0708).abs() < 0.02, "{peak:?}");
        assert!((peak.variance - 1.0).abs() < 3.0 * peak.variance_error);
        // A standard deviation exp(-1) of the peak's at t = 40.
        assert!((series[40].variance / peak.variance - libm::exp(-2.0)).abs() < 1e-12);
        assert!((series[0].mean - 0.3).abs() < 1e-8);
    }

    #[test]
    fn bad_ensembles_are_refused() {
        let none: [Vec<f64>; 0] = [];
        let few = Error::TooFew {
            what: "replicates",
            needed: 3,
            found: 0,
        };
        assert_eq!(ensemble_moments(&none), Err(few));
        assert_refused!(moments(&[]) => TooFew { what: "values", needed: 3, found: 0 });
        assert_refused!(ensemble_moments(&[[0.0; 0]; 3]) => TooFew { needed: 1, .. });
        let uneven = ensemble_moments(&[vec![0.0; 3], vec![0.0; 2], vec![0.0; 3]]);
        assert_refused!(uneven => LengthMismatch { expected: 3, found: 2 });
        let hole = ensemble_moments(&[[0.0, 1.0], [0.0, f64::NAN], [0.0, 1.0]]);
        assert_refused!(hole => NonFiniteReplicate { replicate: 1, index: 1, .. });
    }

    proptest! {
        #[test]
        fn the_shortcut_equals_the_jackknife_done_by_leaving_out(
            sample in prop::collection::vec(-5.0..5.0_f64, 4..30),
        ) {
            for (left_out, shortcut) in variances_without_one(&sample).enumerate() {
                let mut rest = sample.clone();
                rest.remove(left_out);
                let direct = moments(&rest).unwrap().variance;
                prop_assert!((shortcut - direct).abs() < 1e-10);
            }
        }

        #[test]
        fn shift_and_scale(
            sample in prop::collection::vec(-5.0..5.0_f64, 3..30),
            shift in -10.0..10.0_f64,
            scale in 0.1..3.0_f64,
        ) {
            let plain = moments(&sample).unwrap();
            let moved: Vec<f64> = sample.iter().map(|x| shift + scale * x).collect();
            let moved = moments(&moved).unwrap();
            prop_assert!((moved.mean - shift - scale * plain.mean).abs() < 1e-10);
            prop_assert!((moved.variance - scale * scale * plain.variance).abs() < 1e-9);
            prop_assert!((moved.variance_error - scale * scale * plain.variance_error).abs() < 1e-9);
        }
    }
}
