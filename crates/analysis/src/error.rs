//! Errors of the estimators.

use crate::uncertain::Uncertain;

/// Error of an estimator: its input cannot be judged.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Fewer data than the estimator needs.
    #[error("{found} {what} are too few: at least {needed} are needed")]
    TooFew {
        /// Of what, in the plural.
        what: &'static str,
        /// Values needed.
        needed: usize,
        /// Values given.
        found: usize,
    },
    /// Columns or replicates that belong together differ in length.
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
    /// A value of one replicate is infinite or not a number.
    #[error("value {index} of replicate {replicate} is {value}, which is not a finite number")]
    NonFiniteReplicate {
        /// Number of the replicate, from 0.
        replicate: usize,
        /// Position in the replicate, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A threshold that is infinite or not a number.
    #[error("a threshold of {threshold} is not a finite number")]
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
    /// A value that must be positive is not: a time, a strain rate, a standard error.
    #[error("value {index} is {value}, but must be positive")]
    NotPositive {
        /// Position in the column, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A time or the error of a known number below 0.
    #[error("value {index} is {value}, but must not be negative")]
    Negative {
        /// Position in the column, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Too few runs with an observed transition: the others were censored.
    #[error("{observed} of {runs} runs show a transition: at least {needed} are needed")]
    TooFewObserved {
        /// Observed transitions needed.
        needed: usize,
        /// Observed transitions given.
        observed: usize,
        /// Runs given, censored ones included.
        runs: usize,
    },
    /// Too few distinct places, such as widths, for the parameters of a fit.
    #[error("{found} distinct places are too few for this fit: at least {needed} are needed")]
    TooFewPlaces {
        /// Distinct places needed.
        needed: usize,
        /// Distinct places given.
        found: usize,
    },
    /// A survival curve that has not fallen to the level asked for when the last run ends.
    #[error("the survival curve ends at {survival}, above {level}: watch the runs for longer")]
    LevelNotReached {
        /// Level asked for.
        level: f64,
        /// Survival at the end.
        survival: f64,
    },
    /// A horizon at which no run is watched any more.
    #[error("a horizon of {horizon} lies outside the time watched, 0 to {watched}")]
    Horizon {
        /// Horizon given.
        horizon: f64,
        /// Longest time watched.
        watched: f64,
    },
    /// Times so nearly equal that a distribution cannot be fitted: its shape would be infinite.
    #[error("{observed} values scatter too little for a distribution to be fitted")]
    NoScatter {
        /// Observed transitions.
        observed: usize,
    },
    /// A fit whose likelihood or sum of squares has no minimum that can be told from its surroundings.
    #[error(
        "the fit does not settle: {points} points do not determine its {parameters} parameters, or go another way than its law"
    )]
    Undetermined {
        /// Points or runs given.
        points: usize,
        /// Parameters sought.
        parameters: usize,
    },
    /// A width at which a law that ends at the critical width has no value.
    #[error("a finite value at width {width} contradicts a critical width of {critical}")]
    BeyondCritical {
        /// The width.
        width: f64,
        /// The critical width given.
        critical: f64,
    },
    /// A number of bootstrap resamples too small for an interval.
    #[error("{found} resamples are too few for an interval: at least {needed} are needed")]
    TooFewResamples {
        /// Resamples needed.
        needed: usize,
        /// Resamples given, or left after the failed ones.
        found: usize,
    },
    /// Curves that share too little of the abscissa to be compared.
    #[error("{}", no_overlap(*needed, *found))]
    NoOverlap {
        /// Least fraction accepted.
        needed: f64,
        /// Largest fraction found.
        found: f64,
    },
    /// Runs that all ended alike, so that there is no width at which they change.
    #[error("all {runs} runs end alike: widths with either outcome are needed")]
    OneOutcome {
        /// Runs given.
        runs: usize,
    },
    /// A fraction that must lie between 0 and 1.
    #[error("a fraction of {value} does not lie between 0 and 1")]
    Fraction {
        /// The value given.
        value: f64,
    },
    /// A series that has not come to rest: its average would be over a transient.
    #[error(
        "the series drifts: without {discarded} of {samples} samples its halves differ by {score} standard errors"
    )]
    NotStationary {
        /// Difference of the halves in standard errors; infinite where no stationary part was found at all.
        score: f64,
        /// Samples left out at the beginning.
        discarded: usize,
        /// Samples in the series.
        samples: usize,
    },
}

impl Error {
    /// Points or runs that do not determine so many parameters.
    pub(crate) const fn undetermined(points: usize, parameters: usize) -> Self {
        Self::Undetermined { points, parameters }
    }
}

/// An error unless a condition holds.
pub(crate) fn ensure(holds: bool, otherwise: Error) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(otherwise) }
}

/// The series, unless it is shorter than `needed` or has a value that is not finite.
pub(crate) fn checked(series: &[f64], needed: usize) -> Result<&[f64], Error> {
    enough("values", series.len(), needed)?;
    match first(series, |value| !value.is_finite()) {
        Some((index, value)) => Err(Error::NonFinite { index, value }),
        None => Ok(series),
    }
}

/// Why curves cannot be compared.
fn no_overlap(needed: f64, found: f64) -> String {
    if needed == 0.0 {
        return "no point lies within the extent of another curve".to_owned();
    }
    format!(
        "no search found more than a part {} of the points within the extent of another curve, and at least {needed} must be: \
         begin nearer to the collapse",
        crate::number::rounded(found, 3)
    )
}

/// Refuses fewer of `what` than `needed`.
pub(crate) fn enough(what: &'static str, found: usize, needed: usize) -> Result<(), Error> {
    ensure(
        found >= needed,
        Error::TooFew {
            what,
            needed,
            found,
        },
    )
}

/// The first value with a property, and its place.
fn first(column: &[f64], is_so: impl Fn(f64) -> bool) -> Option<(usize, f64)> {
    let index = column.iter().position(|&value| is_so(value))?;
    Some((index, column[index]))
}

/// Refuses a series of a replicate with a value that is not finite.
pub(crate) fn check_replicate(replicate: usize, series: &[f64]) -> Result<(), Error> {
    match first(series, |value| !value.is_finite()) {
        Some((index, value)) => Err(Error::NonFiniteReplicate {
            replicate,
            index,
            value,
        }),
        None => Ok(()),
    }
}

/// Refuses fewer observed transitions than `needed` among the runs.
pub(crate) fn enough_observed(observed: usize, runs: usize, needed: usize) -> Result<(), Error> {
    let too_few = Error::TooFewObserved {
        needed,
        observed,
        runs,
    };
    ensure(observed >= needed, too_few)
}

/// Refuses columns of different length.
pub(crate) fn same_length(expected: usize, found: usize) -> Result<(), Error> {
    ensure(expected == found, Error::LengthMismatch { expected, found })
}

/// Refuses values that are not finite and positive.
pub(crate) fn checked_positive(column: &[f64]) -> Result<&[f64], Error> {
    checked(column, 0)?;
    match first(column, |value| value <= 0.0) {
        Some((index, value)) => Err(Error::NotPositive { index, value }),
        None => Ok(column),
    }
}

/// Refuses a known number that is not finite, or whose error is below 0.
pub(crate) fn check_known(known: Uncertain) -> Result<(), Error> {
    let Uncertain { value, error, .. } = known;
    checked(&[value, error], 2)?;
    let negative = Error::Negative {
        index: 1,
        value: error,
    };
    ensure(error >= 0.0, negative)
}

/// Refuses points (x, y, error) that are not of equal number, finite, and with positive errors.
pub(crate) fn check_points(x: &[f64], y: &[f64], error: &[f64]) -> Result<(), Error> {
    same_length(x.len(), y.len())?;
    same_length(x.len(), error.len())?;
    checked(x, 0)?;
    checked(y, 0)?;
    checked_positive(error)?;
    Ok(())
}

/// Refuses fewer distinct places than a fit needs.
pub(crate) fn enough_places(found: usize, needed: usize) -> Result<(), Error> {
    ensure(found >= needed, Error::TooFewPlaces { needed, found })
}
