//! Whether a series has come to rest.

use crate::blocks::{Estimate, mean_with_error};
use crate::error::{Error, checked};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest samples: both halves must be able to reach a plateau of their error.
const LEAST_SAMPLES: usize = 16;

/// Comparison of the two halves of a series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Stationarity {
    /// Mean of the first half.
    pub first: Estimate,
    /// Mean of the second half.
    pub second: Estimate,
    /// Difference of the means, second less first, in units of its standard error.
    pub score: f64,
}

impl Stationarity {
    /// Whether the halves agree within this many standard errors; 2 is the customary limit.
    pub(crate) fn agrees_within(&self, limit: f64) -> bool {
        self.score.abs() <= limit
    }
}

/// Compares the means of the first and of the second half of a series.
///
/// `z = (<x>_2 - <x>_1)/sqrt(error_1^2 + error_2^2)`
///
/// Errors by blocking, so that correlations count. For a stationary series much longer than its correlations z is
/// normal with variance 1; a slow approach to the steady state or a drift shows as a large |z|. A middle sample of an
/// odd number belongs to the second half. Look at `first.converged` and `second.converged` too: halves that are too
/// short have errors that are too small. Source: Geweke's diagnostic (Bayesian Statistics 4, 169 (1992)), here with
/// two halves in place of the first tenth and the last half.
///
/// # Errors
/// [`Error::TooFew`] below 16 samples, [`Error::NonFinite`].
pub fn stationarity(series: &[f64]) -> Result<Stationarity, Error> {
    let (first, second) = checked(series, LEAST_SAMPLES)?.split_at(series.len() / 2);
    let first = mean_with_error(first)?;
    let second = mean_with_error(second)?;
    let difference = second.mean - first.mean;
    let error = (first.error * first.error + second.error * second.error).sqrt();
    // Two constant halves: either equal, or apart beyond any error.
    let score = if difference == 0.0 {
        0.0
    } else {
        difference / error
    };
    Ok(Stationarity {
        first,
        second,
        score,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::autoregressive;

    fn share_in_agreement(drift: f64) -> f64 {
        let (seeds, samples) = (500, 4000);
        let agreeing = (0..seeds)
            .filter(|&seed| {
                let mut series = autoregressive(0.8, seed, samples);
                for (k, value) in series.iter_mut().enumerate() {
                    *value += drift * k as f64 / samples as f64;
                }
                stationarity(&series).unwrap().agrees_within(2.0)
            })
            .count();
        agreeing as f64 / seeds as f64
    }

    #[test]
    fn stationary_series_agree_in_nineteen_cases_out_of_twenty() {
        let share = share_in_agreement(0.0);
        assert!((0.91..0.98).contains(&share), "{share}");
    }

    #[test]
    fn a_drift_of_one_standard_deviation_is_seen() {
        // Difference of the halves 0.5, its error 2 sqrt(9/4000) = 0.095.
        assert!(share_in_agreement(1.0) < 0.05);
    }

    #[test]
    fn a_late_step_is_seen_and_its_sign_kept() {
        let mut series = autoregressive(0.5, 1, 2000);
        for value in &mut series[1200..] {
            *value -= 2.0;
        }
        let found = stationarity(&series).unwrap();
        assert!(found.score < -3.0, "{found:?}");
    }

    #[test]
    fn constant_halves_and_bad_series() {
        assert_eq!(stationarity(&[0.5; 32]).unwrap().score, 0.0);
        let mut step = [0.0; 32];
        step[16..].fill(1.0);
        assert_eq!(stationarity(&step).unwrap().score, f64::INFINITY);
        assert_refused!(stationarity(&[0.0; 15]) => TooFew { .. });
        let mut series = [0.0; 32];
        series[20] = f64::NAN;
        assert_refused!(stationarity(&series) => NonFinite { index: 20, .. });
    }
}
