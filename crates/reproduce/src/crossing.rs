//! Where half of the runs from rest have a transition.

use peristalsis_analysis::{FractionCrossing, fraction_crossing};

use crate::finding::Statistics;
pub(crate) use crate::row::grouped;
use crate::runs::{Run, Start};

/// The width at which half of some runs from rest have a transition at the threshold of their study; `None` where all of
/// them have one, or none.
pub(crate) fn crossing(runs: &[&Run]) -> Option<FractionCrossing> {
    let (width, jammed): (Vec<f64>, Vec<bool>) = runs
        .iter()
        .filter(|run| run.start == Start::Rest)
        .map(|run| (run.width, run.transition().observed().is_some()))
        .unzip();
    fraction_crossing(&width, &jammed).ok()
}

/// How much is behind some runs that differ in width and replicate.
pub(crate) fn behind(runs: &[&Run]) -> Statistics {
    Statistics::at_one_rate(runs.iter().map(|run| run.width))
}
