//! A case: one textbook experiment with its reference.

use crate::error::ReproduceError;
use crate::finding::Finding;
use crate::prose::Prose;
use crate::studies::Size;

/// Circumstances of an examination: how much to compute, and whether to go on.
#[derive(Clone, Copy)]
pub struct Circumstances<'a> {
    /// How much is computed: some twenty seconds with fewer points and replicates, or minutes. Tolerances are the same for
    /// everything that does not scatter.
    pub size: Size,
    /// Whether somebody asked to stop.
    pub stops: &'a dyn Fn() -> bool,
}

impl Circumstances<'_> {
    /// An error once somebody asked to stop.
    pub(crate) fn go_on(&self) -> Result<(), ReproduceError> {
        if (self.stops)() {
            Err(ReproduceError::Stopped)
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
    /// Its title, author and year of experiment and reference, its method and the captions of its figures.
    pub prose: Prose,
    /// Examines it.
    pub examine: fn(Circumstances<'_>) -> Result<Finding, ReproduceError>,
}

impl Case {
    /// A case with its name, its text and its examination.
    pub(crate) const fn new(
        name: &'static str,
        prose: Prose,
        examine: fn(Circumstances<'_>) -> Result<Finding, ReproduceError>,
    ) -> Self {
        Self {
            name,
            prose,
            examine,
        }
    }
}
