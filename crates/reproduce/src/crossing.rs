//! Where half of the runs from rest have a transition.

use peristalsis_analysis::{FractionCrossing, fraction_crossing};

use crate::finding::Statistics;
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

/// What has the same key together, by ascending key.
pub(crate) fn grouped<T: Copy, K: PartialOrd + Copy>(
    all: impl IntoIterator<Item = T>,
    key: impl Fn(T) -> K,
) -> Vec<(K, Vec<T>)> {
    let mut keyed: Vec<(K, T)> = all.into_iter().map(|one| (key(one), one)).collect();
    keyed.sort_by(|one, other| {
        one.0
            .partial_cmp(&other.0)
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    keyed
        .chunk_by(|one, other| one.0 == other.0)
        .map(|group| (group[0].0, group.iter().map(|(_, one)| *one).collect()))
        .collect()
}

/// How much is behind some runs that differ in width and replicate.
pub(crate) fn behind(runs: &[&Run]) -> Statistics {
    Statistics::at_one_rate(runs.iter().map(|run| run.width))
}
