//! What an estimator refuses, and why.

/// Error of an estimator: its input cannot be judged.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Fewer values than the estimator needs.
    #[error("{found} values are too few: at least {needed} are needed")]
    TooFew {
        /// Values needed.
        needed: usize,
        /// Values given.
        found: usize,
    },
    /// Columns or replicas that belong together differ in length.
    #[error("a column of {found} values stands beside one of {expected}")]
    LengthMismatch {
        /// Length of the first column.
        expected: usize,
        /// Length of the column at fault.
        found: usize,
    },
    /// A value is infinite or not a number.
    #[error("value {index} is {value}, which is not a finite number")]
    NonFinite {
        /// Position in the column, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A value of one replica is infinite or not a number.
    #[error("value {index} of replica {replica} is {value}, which is not a finite number")]
    NonFiniteReplica {
        /// Number of the replica, from 0.
        replica: usize,
        /// Position in the replica, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A number of samples per period of zero.
    #[error("a period must hold at least one sample")]
    NoSamplesPerPeriod,
    /// A sample does not end where its interval should: rows are missing, doubled or unevenly spaced.
    #[error("row {row} ends at period {found}, but should end at period {expected}")]
    UnevenSamples {
        /// Row of the table, from 0.
        row: usize,
        /// Expected end of its interval, in periods.
        expected: f64,
        /// Its end in the table, in periods.
        found: f64,
    },
    /// A threshold outside the open interval from 0 (rest) to 1 (jammed).
    #[error("a threshold of {threshold} does not lie between 0 and 1")]
    Threshold {
        /// The threshold given, J/Jmax.
        threshold: f64,
    },
    /// A wave period that is not a positive finite time.
    #[error("a wave period of {duration} is not a positive time")]
    PeriodDuration {
        /// The period given, in the time unit of the model.
        duration: f64,
    },
    /// Period averages that do not begin with the run.
    #[error("the averages begin with period {first}: a transition before it cannot be excluded")]
    LateStart {
        /// First period given, from 0.
        first: u64,
    },
}

/// The series, unless it is shorter than `needed` or has a value that is not finite.
pub(crate) fn checked(series: &[f64], needed: usize) -> Result<&[f64], Error> {
    if series.len() < needed {
        return Err(Error::TooFew {
            needed,
            found: series.len(),
        });
    }
    match series.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(Error::NonFinite {
            index,
            value: series[index],
        }),
        None => Ok(series),
    }
}

/// Arithmetic mean, summed in order; the series must not be empty.
pub(crate) fn mean_of(series: &[f64]) -> f64 {
    series.iter().sum::<f64>() / series.len() as f64
}
