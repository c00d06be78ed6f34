//! Averages over whole periods of the wave.

use crate::error::{Error, checked, mean_of};
use serde::{Deserialize, Serialize};

/// Deviation of a sample's end from its place, in sample intervals, that still counts as round-off of the time axis.
const SPACING_TOLERANCE: f64 = 0.01;
/// Number of a sample, 2^52, beyond which the time axis no longer resolves its interval.
const LARGEST_SAMPLE: f64 = 4_503_599_627_370_496.0;

/// Averages of a quantity over consecutive whole periods of the wave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeriodMeans {
    /// Number of the first period: period k lasts from k T to (k + 1) T.
    pub first_period: u64,
    /// Average over each period, from the first.
    pub means: Vec<f64>,
}

/// Averages J/Jmax, or any other quantity, over whole periods.
///
/// m_k = (1/n) sum of the n rows whose intervals make up the period from k T to (k + 1) T
///
/// `period` is the time at which the interval of a row ends, in wave periods; `ratio` the mean of the quantity over that
/// interval; `samples_per_period` the number n of equal intervals in a period. A first row at time 0 (the initial
/// state, which has no interval before it) is passed over, and so are the rows of incomplete periods at either end; a
/// table that holds no whole period gives no averages.
///
/// # Errors
/// [`Error::TooFew`] for an empty table, [`Error::LengthMismatch`], [`Error::NoSamplesPerPeriod`],
/// [`Error::NonFinite`] for a value that is not a number anywhere, [`Error::UnevenSamples`] where rows are missing,
/// doubled, or off their place by more than a hundredth of an interval.
///
/// ```
/// use peristalsis_analysis::period_means;
/// let averages = period_means(&[0.5, 1.0, 1.5, 2.0, 2.5], &[0.1, 0.3, 0.6, 0.8, 0.9], 2)?;
/// assert_eq!(averages.means, [0.2, 0.7]);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn period_means(
    period: &[f64],
    ratio: &[f64],
    samples_per_period: usize,
) -> Result<PeriodMeans, Error> {
    if samples_per_period == 0 {
        return Err(Error::NoSamplesPerPeriod);
    }
    if period.len() != ratio.len() {
        return Err(Error::LengthMismatch {
            expected: period.len(),
            found: ratio.len(),
        });
    }
    checked(period, 1)?;
    checked(ratio, 1)?;
    let samples = samples_per_period as f64;
    let start = usize::from((period[0] * samples).abs() <= SPACING_TOLERANCE);
    let Some(first_end) = period.get(start).map(|end| (end * samples).round()) else {
        return Ok(PeriodMeans {
            first_period: 0,
            means: Vec::new(),
        });
    };
    for (row, &found) in period.iter().enumerate().skip(start) {
        // The first interval ends one interval after the start of the run at the earliest.
        let expected = (first_end.max(1.0) + (row - start) as f64) / samples;
        let offset = (found - expected).abs() * samples;
        let even = offset <= SPACING_TOLERANCE && found * samples < LARGEST_SAMPLE;
        if !even {
            return Err(Error::UnevenSamples {
                row,
                expected,
                found,
            });
        }
    }
    let intervals_before = first_end as u64 - 1;
    let first_period = intervals_before.div_ceil(samples_per_period as u64);
    let partial = (first_period * samples_per_period as u64 - intervals_before) as usize;
    let whole = ratio.get(start + partial..).unwrap_or_default();
    Ok(PeriodMeans {
        first_period,
        means: whole
            .chunks_exact(samples_per_period)
            .map(mean_of)
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_initial_state_is_passed_over() {
        let averages = period_means(&[0.0, 0.5, 1.0, 1.5], &[9.0, 0.2, 0.4, 7.0], 2).unwrap();
        assert_eq!(averages.first_period, 0);
        assert_eq!(averages.means.len(), 1);
        assert!((averages.means[0] - 0.3).abs() < 1e-15);
        assert_eq!(period_means(&[0.0], &[9.0], 2).unwrap().means, [0.0; 0]);
    }

    #[test]
    fn a_table_that_begins_inside_a_period_begins_with_the_next_whole_one() {
        let period = [3.5, 3.75, 4.0, 4.25, 4.5, 4.75, 5.0, 5.25];
        let ratio = [9.0, 9.0, 9.0, 1.0, 2.0, 3.0, 4.0, 9.0];
        let averages = period_means(&period, &ratio, 4).unwrap();
        assert_eq!(averages.first_period, 4);
        assert_eq!(averages.means, [2.5]);
        // Too short to reach the next whole period.
        assert_eq!(period_means(&[3.5], &[9.0], 4).unwrap().means, [0.0; 0]);
    }

    #[test]
    fn bad_tables_are_refused_with_the_row_at_fault() {
        assert_eq!(
            period_means(&[], &[], 2),
            Err(Error::TooFew {
                needed: 1,
                found: 0
            })
        );
        assert_eq!(
            period_means(&[0.5], &[0.5], 0),
            Err(Error::NoSamplesPerPeriod)
        );
        assert_eq!(
            period_means(&[0.5, 1.0], &[0.5], 2),
            Err(Error::LengthMismatch {
                expected: 2,
                found: 1
            })
        );
        let missing = period_means(&[0.5, 1.0, 2.0], &[0.1; 3], 2);
        assert_eq!(
            missing,
            Err(Error::UnevenSamples {
                row: 2,
                expected: 1.5,
                found: 2.0
            })
        );
        let doubled = period_means(&[0.5, 0.5, 1.0], &[0.1; 3], 2);
        assert!(matches!(doubled, Err(Error::UnevenSamples { row: 1, .. })));
        let coarse = period_means(&[0.5, 1.0, 1.5], &[0.1; 3], 4);
        assert!(matches!(coarse, Err(Error::UnevenSamples { row: 1, .. })));
        let negative = period_means(&[-0.5, 0.0], &[0.1; 2], 2);
        assert!(matches!(negative, Err(Error::UnevenSamples { row: 0, .. })));
        let not_a_number = period_means(&[0.5, 1.0], &[0.1, f64::NAN], 2);
        assert!(matches!(
            not_a_number,
            Err(Error::NonFinite { index: 1, .. })
        ));
        let unresolved = period_means(&[1e30], &[0.1], 2);
        assert!(matches!(
            unresolved,
            Err(Error::UnevenSamples { row: 0, .. })
        ));
        let no_time = period_means(&[f64::INFINITY, 1.0], &[0.1, 0.1], 2);
        assert!(matches!(no_time, Err(Error::NonFinite { index: 0, .. })));
    }

    proptest! {
        #[test]
        fn the_mean_of_all_period_means_is_the_mean_of_all_whole_periods(
            ratio in prop::collection::vec(-1.0..1.0_f64, 1..200),
            samples in 1_usize..12,
            jitter in -1e-9..1e-9_f64,
        ) {
            let period: Vec<f64> = (0..ratio.len())
                .map(|k| (k as f64 + 1.0) / samples as f64 * (1.0 + jitter))
                .collect();
            let averages = period_means(&period, &ratio, samples).unwrap();
            prop_assert_eq!(averages.means.len(), ratio.len() / samples);
            let whole = averages.means.len() * samples;
            let expected: f64 = ratio[..whole].iter().sum();
            let found: f64 = averages.means.iter().sum::<f64>() * samples as f64;
            prop_assert!((expected - found).abs() < 1e-10);
        }
    }
}
