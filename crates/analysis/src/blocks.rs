//! Mean of a correlated series with its error, from averages over blocks.

use crate::columns::{mean_and_scatter, mean_of};
use crate::error::{Error, checked};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest samples from which a mean is given an error.
const LEAST_SAMPLES: usize = 4;
/// Fewest blocks at which the scatter of block averages is trusted: its own error is then 27 per cent.
const LEAST_BLOCKS: usize = 8;

/// Mean of a series with its statistical error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// Mean of all samples.
    pub mean: f64,
    /// Standard error of the mean (one standard deviation), correlations included.
    pub error: f64,
    /// Standard error of `error` itself: error/sqrt(2 (blocks - 1)), times sqrt(5/2) where shorter blocks have their part in it.
    pub error_uncertainty: f64,
    /// Integrated autocorrelation time that the error implies, in samples: (error/error of uncorrelated samples)^2/2.
    pub autocorrelation_time: f64,
    /// Samples in a block.
    pub block_length: usize,
    /// Blocks behind the error.
    pub blocks: usize,
    /// Samples in the series.
    pub samples: usize,
    /// Whether the error has reached its plateau. Of a series shorter than some 100 correlation times it comes out too small
    /// in most cases, with a plateau or without.
    pub converged: bool,
}

/// Error of the mean as it comes out at one length of the blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BlockLevel {
    /// Samples in a block, a power of 2.
    block_length: usize,
    /// Blocks.
    blocks: usize,
    /// Standard error of the mean if the block averages were independent.
    error: f64,
    /// Standard error of `error`.
    error_uncertainty: f64,
}

/// Errors of the mean for blocks of 1, 2, 4, ... samples, down to two blocks: rising with the length of the blocks, then
/// level once the blocks are longer than the correlations.
///
/// `error^2 = sum (x_i - <x>)^2/(n (n - 1)) over the n block averages x_i of a level`
///
/// A last block that is not full is left out. Source: Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989).
fn block_levels(series: &[f64]) -> Result<Vec<BlockLevel>, Error> {
    let mut averages = checked(series, LEAST_SAMPLES)?.to_vec();
    let mut block_length = 1;
    let mut levels = Vec::new();
    while averages.len() >= 2 {
        let blocks = averages.len();
        let (_, scatter) = mean_and_scatter(&averages);
        let free = (blocks - 1) as f64;
        let error = (scatter / (free * blocks as f64)).sqrt();
        levels.push(BlockLevel {
            block_length,
            blocks,
            error,
            error_uncertainty: error / (2.0 * free).sqrt(),
        });
        let pairs = averages.chunks_exact(2);
        averages = pairs.map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        block_length *= 2;
    }
    Ok(levels)
}

/// Mean of a stationary, correlated series with its standard error by blocking.
///
/// The plateau is the shortest block length B, at 8 blocks or more, with
///
/// B^3 > 2 n (s_B/s_1)^4
///
/// n samples, s_B the error from blocks of B samples: there the bias from correlations between blocks and the noise of
/// the error itself are in balance. If no level qualifies the largest error with 8 blocks or more (or, below 8 samples,
/// that of single samples) is chosen and `converged` is false. What correlations between the blocks still lack is added as
///
/// error^2 = max(s_B^2, 2 s_B^2 - s_(B/2)^2)
///
/// Sources: Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989); the choice of B: Lee, Foulkes & Needs, Phys. Rev. E 83,
/// 066706 (2011) after Wolff, Comput. Phys. Commun. 156, 143 (2004); what is added: the lugsail of Vats & Flegal, Biometrika
/// 109, 735 (2022).
///
/// # Errors
/// [`Error::TooFew`] below 4 samples, [`Error::NonFinite`].
///
/// ```
/// use peristalsis_analysis::mean_with_error;
/// let alternating: Vec<f64> = (0..64).map(|k| f64::from(k % 2)).collect();
/// let estimate = mean_with_error(&alternating)?;
/// assert_eq!((estimate.mean, estimate.error), (0.5, 0.0));
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn mean_with_error(series: &[f64]) -> Result<Estimate, Error> {
    let levels = block_levels(series)?;
    let single = levels[0];
    let inefficiency = |level: &BlockLevel| {
        let ratio = level.error / single.error;
        // A constant series has no scatter at any level, and nothing to correlate.
        if single.error == 0.0 {
            1.0
        } else {
            ratio * ratio
        }
    };
    let trusted = levels.iter().enumerate();
    let trusted = trusted.filter(|(_, level)| level.blocks >= LEAST_BLOCKS);
    let plateau = trusted.clone().find(|(_, level)| {
        let length = level.block_length as f64;
        let inefficiency = inefficiency(level);
        length * length * length > 2.0 * series.len() as f64 * inefficiency * inefficiency
    });
    let converged = plateau.is_some();
    let largest = || trusted.reduce(|a, b| if b.1.error > a.1.error { b } else { a });
    let (place, mut chosen) = plateau
        .or_else(largest)
        .map_or((0, single), |(place, level)| (place, *level));
    if let Some(shorter) = place.checked_sub(1).map(|before| levels[before])
        && shorter.error < chosen.error
    {
        let (square, before) = (chosen.error * chosen.error, shorter.error * shorter.error);
        let lifted = (2.0 * square - before).sqrt();
        chosen.error_uncertainty *= 2.5_f64.sqrt() * lifted / chosen.error;
        chosen.error = lifted;
    }
    Ok(Estimate {
        mean: mean_of(series),
        error: chosen.error,
        error_uncertainty: chosen.error_uncertainty,
        autocorrelation_time: 0.5 * inefficiency(&chosen),
        block_length: chosen.block_length,
        blocks: chosen.blocks,
        samples: series.len(),
        converged,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{autoregressive, white_noise};

    /// Share of series whose true mean, 0, lies within one error.
    fn coverage(memory: f64, samples: usize) -> f64 {
        let seeds = 1000;
        let covered = (0..seeds)
            .filter(|&seed| {
                let estimate = mean_with_error(&autoregressive(memory, seed, samples)).unwrap();
                assert!(estimate.converged, "{estimate:?}");
                estimate.mean.abs() < estimate.error
            })
            .count();
        covered as f64 / seeds as f64
    }

    #[test]
    fn the_error_bar_covers_the_mean_in_two_cases_out_of_three() {
        // 1000 trials scatter by 0.015 about 0.683; few blocks cost another 0.01.
        for (memory, samples) in [(0.0, 1000), (0.5, 2000), (0.8, 4000), (0.95, 30_000)] {
            let coverage = coverage(memory, samples);
            assert!(
                (0.63..0.72).contains(&coverage),
                "{coverage} at memory {memory}"
            );
        }
    }

    /// With the error of one level alone it is less than 0.61.
    #[test]
    fn the_error_of_a_short_correlated_series_is_not_much_too_small() {
        let seeds = 1000;
        let memory = 5.0 / 7.0; // A time of 3 samples.
        let covered = (0..seeds)
            .map(|seed| mean_with_error(&autoregressive(memory, seed, 100)).unwrap())
            .filter(|estimate| estimate.mean.abs() < estimate.error)
            .count();
        let coverage = covered as f64 / seeds as f64;
        assert!((0.62..0.72).contains(&coverage), "{coverage}");
    }

    #[test]
    fn error_of_uncorrelated_samples_is_that_of_the_textbook() {
        let series = white_noise(7, 10_000);
        let estimate = mean_with_error(&series).unwrap();
        assert!((estimate.error - 0.01).abs() < 4.0 * estimate.error_uncertainty);
        assert!((estimate.autocorrelation_time - 0.5).abs() < 0.15);
        assert_eq!(estimate.samples, 10_000);
    }

    #[test]
    fn the_errors_of_the_levels_rise_to_the_error_of_the_correlated_mean() {
        // a = 0.9: tau = 9.5, error = sqrt(2 tau/n).
        let series = autoregressive(0.9, 3, 200_000);
        let expected = (19.0_f64 / 200_000.0).sqrt();
        let levels = block_levels(&series).unwrap();
        assert!((levels[0].error * 200_000.0_f64.sqrt() - 1.0).abs() < 0.02);
        let plateau = levels[9];
        assert_eq!((plateau.block_length, plateau.blocks), (512, 390));
        assert!((plateau.error - expected).abs() < 4.0 * plateau.error_uncertainty);
        let estimate = mean_with_error(&series).unwrap();
        assert!(
            (estimate.error / expected - 1.0).abs() < 0.12,
            "{estimate:?}"
        );
        assert!((estimate.autocorrelation_time / 9.5 - 1.0).abs() < 0.25);
    }

    #[test]
    fn levels_of_four_numbers_by_hand() {
        // Single samples: scatter 20 about 4, 4 blocks: sqrt(20/12). Pairs: averages 2 and 6, sqrt(8/2).
        let levels = block_levels(&[1.0, 3.0, 5.0, 7.0]).unwrap();
        assert_eq!(levels.len(), 2);
        assert!((levels[0].error - (20.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert!((levels[1].error - 2.0).abs() < 1e-15);
        assert!((levels[1].error_uncertainty - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_series_shorter_than_its_memory_says_so() {
        let drift: Vec<f64> = (0..256).map(f64::from).collect();
        let estimate = mean_with_error(&drift).unwrap();
        assert!(!estimate.converged);
        // The largest error that 8 blocks give, far above the error of single samples.
        assert_eq!(estimate.blocks, 8);
        assert!(estimate.error > 5.0 * block_levels(&drift).unwrap()[0].error);
        let short = mean_with_error(&[1.0, 2.0, 1.0, 2.0]).unwrap();
        assert!(!short.converged);
        assert_eq!(short.block_length, 1);
    }

    #[test]
    fn a_constant_series_has_no_error() {
        let estimate = mean_with_error(&[0.25; 64]).unwrap();
        assert_eq!((estimate.mean, estimate.error), (0.25, 0.0));
        assert_eq!(estimate.autocorrelation_time, 0.5);
        assert!(estimate.converged);
    }

    #[test]
    fn bad_series_are_refused() {
        let few = Error::TooFew {
            what: "values",
            needed: 4,
            found: 0,
        };
        assert_eq!(mean_with_error(&[]), Err(few));
        let mut series = vec![1.0; 20];
        series[11] = f64::NAN;
        assert_refused!(mean_with_error(&series) => NonFinite { index: 11, .. });
    }
}
