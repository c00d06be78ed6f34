//! Integrated autocorrelation time.

use crate::columns::mean_of;
use crate::error::{Error, checked};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest samples from which correlations are estimated.
const LEAST_SAMPLES: usize = 16;
/// Length of the window in autocorrelation times (Sokal's c): truncation costs exp(-c), below 1 per cent.
const WINDOW: f64 = 5.0;
/// Longest window, as a fraction of the series: longer lags are noise.
const LARGEST_WINDOW: usize = 10;

/// Integrated autocorrelation time of a series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AutocorrelationTime {
    /// tau = 1/2 + sum of the normalised autocorrelations, in samples; 1/2 for uncorrelated samples.
    pub time: f64,
    /// Its standard error, 2 |tau| sqrt((W + 1/2 - tau)/n); for exponential correlations some 15 per cent too
    /// large, and meaningless unless converged.
    pub error: f64,
    /// Largest lag W of the sum, in samples.
    pub window: usize,
    /// Whether the window closed by itself; if not, `time` is a lower bound, and the series is too short. Of a series shorter
    /// than 100 tau the time comes out too small even so.
    pub converged: bool,
}

/// Integrated autocorrelation time of a stationary series, with a window that closes by itself.
///
/// `tau(W) = 1/2 + sum_(t=1)^W rho(t),   rho(t) = sum_i (x_i - <x>)(x_(i+t) - <x>)/sum_i (x_i - <x>)^2`
///
/// W is the least lag with W >= 5 tau(W) > 0, n/10 at most; the time is tau(W) (1 + (2 W + 1)/n), as the mean of the series is
/// not known better. The variance of the mean is 2 tau/n times that of one sample. Sources: Madras & Sokal, J. Stat. Phys.
/// 50, 109 (1988), appendix C; the error and the factor: Wolff, Comput. Phys. Commun. 156, 143 (2004).
///
/// # Errors
/// [`Error::TooFew`] below 16 samples, [`Error::NonFinite`].
pub fn autocorrelation_time(series: &[f64]) -> Result<AutocorrelationTime, Error> {
    let mean = mean_of(checked(series, LEAST_SAMPLES)?);
    let deviations: Vec<f64> = series.iter().map(|x| x - mean).collect();
    let variance: f64 = deviations.iter().map(|x| x * x).sum();
    let mut time = 0.5;
    let mut window = 0;
    let mut converged = variance == 0.0;
    while !converged && window < series.len() / LARGEST_WINDOW {
        window += 1;
        let pairs = deviations.iter().zip(&deviations[window..]);
        time += pairs.map(|(now, later)| now * later).sum::<f64>() / variance;
        converged = time > 0.0 && window as f64 >= WINDOW * time;
    }
    let samples = series.len() as f64;
    if window > 0 {
        time *= 1.0 + (2 * window + 1) as f64 / samples;
    }
    Ok(AutocorrelationTime {
        time,
        error: 2.0 * time.abs() * ((window as f64 + 0.5 - time).max(0.0) / samples).sqrt(),
        window,
        converged,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{autoregressive, white_noise};

    #[test]
    fn an_autoregressive_series_has_its_known_time_within_the_error() {
        for memory in [0.3, 0.7, 0.95] {
            let expected = 0.5 * (1.0 + memory) / (1.0 - memory);
            let seeds = 500;
            let mut within = 0;
            let (mut time_sum, mut square_sum, mut error_sum) = (0.0, 0.0, 0.0);
            for seed in 0..seeds {
                let found = autocorrelation_time(&autoregressive(memory, seed, 20_000)).unwrap();
                assert!(found.converged);
                time_sum += found.time;
                square_sum += (found.time - expected) * (found.time - expected);
                error_sum += found.error;
                within += u32::from((found.time - expected).abs() < found.error);
            }
            let seeds = seeds as f64;
            let mean = time_sum / seeds;
            assert!((mean / expected - 1.0).abs() < 0.03, "{mean}, {expected}");
            let conservative = error_sum / seeds / (square_sum / seeds).sqrt();
            assert!(
                (1.0..1.25).contains(&conservative),
                "{conservative} at {memory}"
            );
            let coverage = f64::from(within) / seeds;
            assert!((0.67..0.80).contains(&coverage), "{coverage} at {memory}");
        }
    }

    #[test]
    fn white_noise_is_uncorrelated() {
        let found = autocorrelation_time(&white_noise(5, 20_000)).unwrap();
        assert!((found.time - 0.5).abs() < 3.0 * found.error);
    }

    #[test]
    fn a_drift_does_not_close_the_window_and_a_constant_needs_none() {
        let drift: Vec<f64> = (0..400).map(f64::from).collect();
        let found = autocorrelation_time(&drift).unwrap();
        assert!(!found.converged);
        assert_eq!(found.window, 40);
        // 0.1 is no sum of powers of 2.
        for value in [0.5, 0.1] {
            let constant = autocorrelation_time(&[value; 100]).unwrap();
            assert_eq!((constant.time, constant.converged), (0.5, true));
        }
    }

    #[test]
    fn a_series_that_swings_has_a_positive_time() {
        for memory in [-0.6, -0.9] {
            let expected = 0.5 * (1.0 + memory) / (1.0 - memory);
            for seed in 0..200 {
                let found = autocorrelation_time(&autoregressive(memory, seed, 200)).unwrap();
                assert!(found.time > 0.0 && found.error > 0.0, "{found:?}");
                assert!(found.converged && found.time < expected + 0.5, "{found:?}");
            }
        }
    }

    #[test]
    fn bad_series_are_refused() {
        assert_refused!(autocorrelation_time(&[]) => TooFew { .. });
        let mut series = [0.0; 30];
        series[3] = f64::NEG_INFINITY;
        assert_refused!(autocorrelation_time(&series) => NonFinite { index: 3, .. });
    }
}
