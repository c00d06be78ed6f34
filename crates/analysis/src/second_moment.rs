//! Second moment of the flow rate across an ensemble whose runs may end early, and its peak.

use crate::bootstrap::{Bootstrap, bootstrap_errors};
use crate::columns::{mean_and_scatter, mean_of};
use crate::error::{Error, check_replicate, enough};
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest runs at a time from which a variance is estimated.
const LEAST_RUNS: usize = 3;

/// The value of a run after it was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AfterEnd {
    /// Nothing: the moments at each time are taken over the runs still going. Right where runs ended for reasons of their
    /// own; where they were stopped because they had jammed, it removes the jammed ones and with them the variance.
    Leave,
    /// The mean of the last samples of the run: right for runs that were stopped once they had settled in the jammed
    /// state, in which they would have stayed.
    Hold {
        /// Number of last samples averaged, 1 at least.
        samples: usize,
    },
}

/// Mean and variance of j = J/Jmax across an ensemble at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SecondMoment {
    /// Mean `<j>`.
    pub mean: f64,
    /// `chi_J = <j^2> - <j>^2`, estimated without bias (divisor n - 1).
    pub variance: f64,
    /// Runs behind it, held ones included.
    pub runs: usize,
}

/// Peak over time of the second moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MomentPeak {
    /// Position of the peak in the series, from 0, with bootstrap errors.
    pub index: Uncertain,
    /// Height of the peak, with bootstrap errors.
    pub value: Uncertain,
    /// Mean height of the resampled peaks less the variance of the n runs themselves there, `value` (n - 1)/n: the largest of
    /// many noisy values lies too high, and a resample repeats that. The true height is likely near `value - bias`.
    pub bias: f64,
}

/// chi_J(t) of runs of unequal length.
///
/// `chi_J(t) = (<j^2> - <j>^2) n/(n - 1)` over the n runs that have a value at t, up to the end of the longest run
///
/// A run's end is treated as `after_end` says. The series ends before its first time with fewer than 3 runs, so that
/// all of it has a variance. [`ensemble_moments`](crate::ensemble_moments) gives errors at each time for runs of equal
/// length.
///
/// # Errors
/// [`Error::TooFew`] below 3 runs or where fewer than 3 have a first sample, [`Error::NonFiniteReplicate`].
///
/// ```
/// use peristalsis_analysis::{AfterEnd, second_moment};
/// // The first run was stopped jammed at j = 1.
/// let runs = [vec![0.0, 1.0], vec![0.0, 0.5, 1.0], vec![0.0, 0.0, 0.4]];
/// let found = second_moment(&runs, AfterEnd::Hold { samples: 1 })?;
/// assert!((found[1].variance - 0.25).abs() < 1e-15);
/// assert!((found[2].mean - 0.8).abs() < 1e-15 && (found[2].variance - 0.12).abs() < 1e-15);
/// assert_eq!(second_moment(&runs, AfterEnd::Leave)?.len(), 2);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn second_moment<S: AsRef<[f64]>>(
    runs: &[S],
    after_end: AfterEnd,
) -> Result<Vec<SecondMoment>, Error> {
    let runs = checked_runs(runs, after_end)?;
    let moments = moments_of(&runs);
    if moments.is_empty() {
        let with_sample = runs.iter().filter(|run| !run.series.is_empty()).count();
        enough("runs with a sample", with_sample, LEAST_RUNS)?;
    }
    Ok(moments)
}

/// Peak over time of chi_J(t), with errors by resampling whole runs.
///
/// The earliest time counts where several share the largest value. Runs and `after_end` as for [`second_moment`]. The
/// percentile intervals are pulled upward by the bias that is reported beside them; near the transition, where j is
/// near 0 or 1 in each run, the height cannot exceed 1/4 by much, and its growth toward w_c ends there.
///
/// # Errors
/// Those of [`second_moment`]; [`Error::TooFewResamples`].
pub fn second_moment_peak<S: AsRef<[f64]>>(
    runs: &[S],
    after_end: AfterEnd,
    bootstrap: Bootstrap,
) -> Result<MomentPeak, Error> {
    // Refuses what has no moments before anything is resampled.
    let moments = second_moment(runs, after_end)?;
    let group = checked_runs(runs, after_end)?;
    let mut heights = Vec::new();
    let found = bootstrap_errors(&group, bootstrap, |runs| {
        let (index, value) = highest(&moments_of(runs))?;
        heights.push(value);
        Some([index as f64, value])
    })?;
    let (index, value) = (found[0], found[1]);
    let at_peak = moments[index.value as usize].runs as f64;
    // What resamples estimate: the runs are all that they draw from, and their variance has the divisor n.
    let drawn_from = value.value * (1.0 - 1.0 / at_peak);
    // The first one is that of the runs themselves.
    let bias = mean_of(&heights[1..]) - drawn_from;
    Ok(MomentPeak { index, value, bias })
}

/// A run and the value that stands for it after its end.
#[derive(Clone, Copy)]
struct Run<'a> {
    series: &'a [f64],
    held: Option<f64>,
}

fn checked_runs<S: AsRef<[f64]>>(runs: &[S], after_end: AfterEnd) -> Result<Vec<Run<'_>>, Error> {
    enough("runs", runs.len(), LEAST_RUNS)?;
    runs.iter()
        .map(AsRef::as_ref)
        .enumerate()
        .map(|(replicate, series)| {
            check_replicate(replicate, series)?;
            let held = match after_end {
                AfterEnd::Hold { samples } if !series.is_empty() => {
                    let last = &series[series.len().saturating_sub(samples.max(1))..];
                    Some(mean_of(last))
                }
                _ => None,
            };
            Ok(Run { series, held })
        })
        .collect()
}

fn moments_of(runs: &[Run<'_>]) -> Vec<SecondMoment> {
    let longest = runs.iter().map(|run| run.series.len()).max().unwrap_or(0);
    let mut values = Vec::with_capacity(runs.len());
    (0..longest)
        .map_while(|time| {
            let value = |run: &Run<'_>| run.series.get(time).copied().or(run.held);
            values.clear();
            values.extend(runs.iter().filter_map(value));
            (values.len() >= LEAST_RUNS).then(|| {
                let (mean, scatter) = mean_and_scatter(&values);
                SecondMoment {
                    mean,
                    variance: scatter / (values.len() as f64 - 1.0),
                    runs: values.len(),
                }
            })
        })
        .collect()
}

fn highest(moments: &[SecondMoment]) -> Option<(usize, f64)> {
    let variances = moments.iter().map(|moment| moment.variance).enumerate();
    variances.reduce(|best, other| if best.1 >= other.1 { best } else { other })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::{Coverage, white_noise};
    use crate::{Law, fit_law};
    use proptest::prelude::*;

    const BOOTSTRAP: Bootstrap = Bootstrap::new(200, 1);

    /// Each run jams at its own time, uniform in the window, and is stopped 5 samples later at j = 1.
    fn jamming(seed: u64, runs: usize, window: (f64, f64)) -> Vec<Vec<f64>> {
        let mut randomness = Randomness::new(seed, 0);
        (0..runs)
            .map(|_| {
                let jams = window.0 + (window.1 - window.0) * randomness.uniform();
                let end = jams as usize + 5;
                (0..end)
                    .map(|t| f64::from(u8::from(t as f64 > jams)))
                    .collect()
            })
            .collect()
    }

    #[test]
    fn stopped_runs_keep_the_variance_only_when_held() {
        let runs = jamming(3, 400, (20.0, 60.0));
        // Half of the runs have jammed at t = 40: variance 1/4.
        let held = second_moment(&runs, AfterEnd::Hold { samples: 3 }).unwrap();
        assert!((held[40].variance - 0.25).abs() < 0.01);
        assert!((held[40].mean - 0.5).abs() < 0.08);
        assert_eq!((held[60].runs, held[60].variance), (400, 0.0));
        // The others have left: of those still going few have jammed.
        let left = second_moment(&runs, AfterEnd::Leave).unwrap();
        assert!(left[40].runs < 300 && left[40].variance < 0.2);
    }

    #[test]
    fn runs_of_equal_length_agree_with_the_moments_of_the_ensemble() {
        let runs: Vec<Vec<f64>> = (0..6).map(|seed| white_noise(seed, 30)).collect();
        let expected = crate::ensemble_moments(&runs).unwrap();
        for after_end in [AfterEnd::Leave, AfterEnd::Hold { samples: 2 }] {
            let found = second_moment(&runs, after_end).unwrap();
            assert_eq!(found.len(), 30);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found.variance - expected.variance).abs() < 1e-12);
            }
            let peak = second_moment_peak(&runs, after_end, BOOTSTRAP).unwrap();
            let (index, highest) = expected
                .iter()
                .enumerate()
                .max_by(|(_, a), (_, b)| a.variance.total_cmp(&b.variance))
                .unwrap();
            assert_eq!(peak.index.value, index as f64);
            assert!((peak.value.value - highest.variance).abs() < 1e-12);
        }
    }

    #[test]
    fn intervals_of_the_peak_cover_its_height_and_place() {
        // x(t) = a exp(-((t - 20)/6)^2), variance of a = 1: a peak at 20 of height 1.
        let mut coverage = Coverage::of([("height", 1.0)]);
        for seed in 0..200 {
            let runs: Vec<Vec<f64>> = white_noise(seed, 40)
                .iter()
                .map(|amplitude| {
                    let at = |t: i32| {
                        let distance = f64::from(t - 20) / 6.0;
                        amplitude * libm::exp(-distance * distance)
                    };
                    (0..40).map(at).collect()
                })
                .collect();
            let peak = second_moment_peak(&runs, AfterEnd::Leave, BOOTSTRAP).unwrap();
            assert_eq!((peak.index.value, peak.index.error), (20.0, 0.0));
            coverage.count([peak.value]);
        }
        // Percentiles of the variance of 40 numbers are known to be short by some hundredths.
        coverage.judge([0.04, 0.05]);
    }

    #[test]
    fn a_peak_less_its_bias_is_nearer_the_truth() {
        // All runs pass from 0 to 1, at times of their own: the largest variance is 1/4.
        let (ensembles, mut height, mut corrected) = (100, 0.0, 0.0);
        for seed in 0..ensembles {
            let mut randomness = Randomness::new(seed, 3);
            let run = |_| {
                let place = 30.0 + 6.0 * randomness.normal();
                (0..60)
                    .map(|time| f64::from(u8::from(f64::from(time) > place)))
                    .collect()
            };
            let runs: Vec<Vec<f64>> = (0..8).map(run).collect();
            let peak = second_moment_peak(&runs, AfterEnd::Leave, Bootstrap::new(50, 1)).unwrap();
            height += peak.value.value / ensembles as f64;
            corrected += (peak.value.value - peak.bias) / ensembles as f64;
        }
        assert!(height > 0.28, "{height}");
        assert!((corrected - 0.25).abs() < 0.01, "{corrected}");
    }

    #[test]
    fn a_noisy_peak_is_too_high_and_says_by_how_much() {
        let runs: Vec<Vec<f64>> = (0..30).map(|seed| white_noise(seed, 200)).collect();
        let peak = second_moment_peak(&runs, AfterEnd::Leave, BOOTSTRAP).unwrap();
        assert!(peak.value.value > 1.4 && peak.bias > 0.05, "{peak:?}");
        assert!(peak.index.error > 5.0);
    }

    #[test]
    fn the_exponent_of_the_peak_is_found_at_the_critical_width_of_tau() {
        // Heights (2.8 - w)^-1/2 at eight widths, 60 runs each.
        let widths: Vec<f64> = (0..8).map(|k| 2.4 + 0.05 * f64::from(k)).collect();
        let peaks: Vec<Uncertain> = widths
            .iter()
            .enumerate()
            .map(|(k, width)| {
                let scale = libm::pow(2.8 - width, -0.25);
                let runs: Vec<Vec<f64>> = white_noise(k as u64, 60)
                    .iter()
                    .map(|a| vec![0.0, a * scale, 0.1 * a])
                    .collect();
                second_moment_peak(&runs, AfterEnd::Leave, BOOTSTRAP)
                    .unwrap()
                    .value
            })
            .collect();
        let value: Vec<f64> = peaks.iter().map(|peak| peak.value).collect();
        let error: Vec<f64> = peaks.iter().map(|peak| peak.error).collect();
        let known = Some(Uncertain::normal(2.8, 0.003));
        let fit = fit_law(Law::Power, &widths, &value, &error, known).unwrap();
        assert!(fit.exponent.deviations_from(0.5).abs() < 3.0, "{fit:?}");
        assert!(fit.exponent.error < 0.15);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn any_ensemble_gives_moments_or_an_error(
            runs in prop::collection::vec(prop::collection::vec(-1.0..2.0_f64, 0..12), 0..8),
            samples in 0_usize..20,
            odd in prop::option::of(any::<f64>()),
        ) {
            let mut runs = runs;
            if let (Some(odd), Some(run)) = (odd, runs.first_mut()) {
                run.push(odd);
            }
            let bootstrap = Bootstrap::new(20, 0);
            for after_end in [AfterEnd::Leave, AfterEnd::Hold { samples }] {
                if let Ok(found) = second_moment(&runs, after_end) {
                    prop_assert!(found.iter().all(|moment| moment.variance >= 0.0));
                    let _ = second_moment_peak(&runs, after_end, bootstrap);
                }
            }
        }
    }
}
