//! Where a transient ends, and a mean that refuses to be taken over one.

use crate::blocks::{Estimate, mean_with_error};
use crate::columns::mean_of;
use crate::error::{Error, checked, ensure};
use crate::stationarity::{Stationarity, stationarity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Samples in a batch: single ones would end the transient at a chance fluctuation.
const BATCH: usize = 5;
/// Fewest samples.
const LEAST_SAMPLES: usize = 32;
/// Difference of the halves, in standard errors, beyond which a mean is refused.
const LIMIT: f64 = 3.0;

/// Mean of the stationary part of a series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StationaryMean {
    /// Samples left out at the beginning.
    pub discarded: usize,
    /// Mean of the rest with its error.
    pub estimate: Estimate,
    /// Comparison of the halves of the rest.
    pub halves: Stationarity,
}

/// Finds the end of a transient by the marginal standard error rule (MSER-5).
///
/// `d* = argmin_d sum_(i >= d) (y_i - <y>_d)^2/(m - d)^2`
///
/// over averages y_i of 5 samples each, `<y>_d` being the mean of those from d on: leaving samples out is worth it as
/// long as it makes the mean's (uncorrelated) standard error smaller. The last 5 batches are never tried as starts.
/// Gives the samples to leave out at the beginning, and whether they end within the first half of the series: if not,
/// the series is still in its transient, or too short to tell. Sources: White, Simulation 69, 323 (1997); White, Cobb &
/// Spratt, Proc. 2000 Winter Simulation Conference, 755.
fn truncation(series: &[f64]) -> Result<(usize, bool), Error> {
    let batches = checked(series, LEAST_SAMPLES)?.chunks_exact(BATCH);
    let batches: Vec<f64> = batches.map(mean_of).collect();
    let count = batches.len();
    let mut best = (f64::INFINITY, 0);
    // Welford's update from the end: mean and scatter of the batches from `start` on.
    let (mut mean, mut scatter) = (0.0, 0.0);
    for start in (0..count).rev() {
        let kept = (count - start) as f64;
        let from_mean = batches[start] - mean;
        mean += from_mean / kept;
        scatter += from_mean * (batches[start] - mean);
        let criterion = scatter / (kept * kept);
        if count - start > BATCH && criterion <= best.0 {
            best = (criterion, start);
        }
    }
    Ok((best.1 * BATCH, 2 * best.1 <= count))
}

/// Mean of a series without its transient, unless no part of it is stationary.
///
/// Leaves out what `truncation` finds, and refuses the rest where its halves differ by more than 3 standard errors
/// ([`stationarity`]) or where the truncation lies in the second half: an average over a transient is no average. White
/// noise passes in 99 cases of 100 with 400 samples, in 90 with 100 of them. Look at `estimate.converged` too: a series of
/// a few correlation times cannot show its own drift. Error of the mean by blocking ([`mean_with_error`]).
///
/// # Errors
/// [`Error::NotStationary`], [`Error::TooFew`] below 32 samples, [`Error::NonFinite`].
///
/// ```
/// use peristalsis_analysis::{Error, stationary_mean};
/// let settled: Vec<f64> = (0..80).map(|k| f64::from(k % 2)).collect();
/// assert_eq!(stationary_mean(&settled)?.estimate.mean, 0.5);
/// let drifting: Vec<f64> = (0..80).map(f64::from).collect();
/// assert!(matches!(stationary_mean(&drifting), Err(Error::NotStationary { .. })));
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn stationary_mean(series: &[f64]) -> Result<StationaryMean, Error> {
    let (discarded, is_settled) = truncation(series)?;
    let refused = |score: f64| Error::NotStationary {
        score,
        discarded,
        samples: series.len(),
    };
    ensure(is_settled, refused(f64::INFINITY))?;
    let rest = &series[discarded..];
    let halves = stationarity(rest)?;
    ensure(halves.agrees_within(LIMIT), refused(halves.score))?;
    Ok(StationaryMean {
        discarded,
        estimate: mean_with_error(rest)?,
        halves,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{assert_coverage, autoregressive};
    use proptest::prelude::*;

    /// Noise about 0.9 after a start near 0 that dies out with a time of 60 samples.
    fn approach(seed: u64, samples: usize) -> Vec<f64> {
        let mut series = autoregressive(0.6, seed, samples);
        for (k, value) in series.iter_mut().enumerate() {
            *value = 0.9 * (1.0 - libm::exp(-(k as f64) / 60.0)) + 0.05 * *value;
        }
        series
    }

    #[test]
    fn the_mean_after_a_transient_covers_and_the_plain_mean_is_biased() {
        let trials = 300;
        let (mut covered, mut passed, mut bias, mut plain_bias) = (0, 0, 0.0, 0.0);
        for seed in 0..trials {
            let series = approach(seed, 3000);
            let Ok(found) = stationary_mean(&series) else {
                continue;
            };
            passed += 1;
            assert!(
                (100..1200).contains(&found.discarded),
                "{}",
                found.discarded
            );
            covered += usize::from((found.estimate.mean - 0.9).abs() < found.estimate.error);
            bias += found.estimate.mean - 0.9;
            plain_bias += mean_with_error(&series).unwrap().mean - 0.9;
        }
        assert!(passed > 285, "{passed}");
        assert_coverage(covered, passed, 0.6827, 0.05, "mean after the transient");
        // 0.9 60/3000 too low with the transient, ten standard errors.
        assert!((plain_bias / passed as f64 + 0.018).abs() < 0.001);
        assert!((bias / passed as f64).abs() < 0.001);
    }

    #[test]
    fn stationary_series_are_kept_nearly_whole() {
        let mut kept = 0;
        for seed in 0..200 {
            let series = autoregressive(0.7, seed, 2000);
            if let Ok(found) = stationary_mean(&series) {
                kept += 1;
                assert!(found.estimate.samples > 999);
            }
        }
        assert!(kept > 180, "{kept}");
    }

    #[test]
    fn drifts_and_unfinished_transients_are_refused() {
        let drift: Vec<f64> = autoregressive(0.5, 3, 1000)
            .iter()
            .enumerate()
            .map(|(k, noise)| 0.002 * k as f64 + 0.2 * noise)
            .collect();
        assert_refused!(stationary_mean(&drift) => NotStationary { samples: 1000, .. });
        // A run that jams near its end.
        let mut late = autoregressive(0.5, 4, 1000);
        for value in &mut late[800..] {
            *value += 40.0;
        }
        assert_refused!(stationary_mean(&late) => NotStationary { .. });
        assert!(!truncation(&late).unwrap().1);
        assert_refused!(stationary_mean(&[0.0; 31]) => TooFew { needed: 32, .. });
    }

    #[test]
    fn a_step_is_cut_off_and_a_constant_series_is_stationary() {
        let step: Vec<f64> = (0..200)
            .map(|k| if k < 40 { 3.0 } else { f64::from(k % 2) })
            .collect();
        assert_eq!(truncation(&step).unwrap().0, 40);
        let found = stationary_mean(&[0.5; 64]).unwrap();
        assert_eq!((found.discarded, found.estimate.mean), (0, 0.5));
    }

    proptest! {
        #[test]
        fn any_series_is_judged(series in prop::collection::vec(any::<f64>(), 0..120)) {
            if let Ok((discard, _)) = truncation(&series) {
                prop_assert!(discard < series.len());
            }
            let _ = stationary_mean(&series);
        }
    }
}
