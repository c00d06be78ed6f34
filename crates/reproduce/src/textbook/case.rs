//! A case: one textbook experiment with its reference.

use crate::textbook::error::ValidateError;
use crate::textbook::finding::Finding;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Some twenty seconds: fewer points and replicates, the same tolerances for what does not scatter.
    Quick,
    /// All of it, in minutes.
    Full,
}

impl Extent {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }

    /// One of two numbers.
    pub(crate) fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// What a case may know of the world: how much to compute, and whether to go on.
#[derive(Clone, Copy)]
pub struct Circumstances<'a> {
    /// How much is computed.
    pub extent: Extent,
    /// Whether somebody asked to stop.
    pub stops: &'a dyn Fn() -> bool,
}

impl Circumstances<'_> {
    /// An error once somebody asked to stop.
    pub(crate) fn go_on(&self) -> Result<(), ValidateError> {
        if (self.stops)() {
            Err(ValidateError::Stopped)
        } else {
            Ok(())
        }
    }
}

/// One textbook experiment with its reference.
#[derive(Clone, Copy)]
pub struct Case {
    /// Short name: letters and hyphens.
    pub name: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// Where experiment and reference come from: author and year.
    pub source: &'static str,
    /// Does it.
    pub examine: fn(Circumstances<'_>) -> Result<Finding, ValidateError>,
}
