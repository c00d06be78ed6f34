//! The progress of a study, as a person sees it.

use std::time::Duration;

use peristalsis_run::Progress;

use crate::identity::Identity;
use crate::refinement::Bracket;

/// How far a study is.
#[derive(Clone, Debug, Default)]
pub struct Board {
    /// Runs of the plan, those that refinement has added so far included.
    pub total: usize,
    /// Finished runs.
    pub done: usize,
    /// Runs that failed.
    pub failed: usize,
    /// Part of the work, in grains times steps, that is done.
    pub fraction: f64,
    /// Time left, from the speed since this process began; `None` while nothing can be said.
    pub left: Option<Duration>,
    /// Work of each worker of this process.
    pub workers: Vec<Option<Working>>,
    /// Runs that other programs hold, where this one has nothing to do but to wait for them.
    pub waits_for: usize,
    /// Running estimates of the critical value, one for each combination of the other axes.
    pub brackets: Vec<Bracket>,
    /// What happened since the last look, in words: runs that failed, files that were moved aside.
    pub news: Vec<String>,
}

/// A run in progress.
#[derive(Clone, Debug)]
pub struct Working {
    /// The run.
    pub identity: Identity,
    /// Its point in words.
    pub point: String,
    /// How far it is.
    pub progress: Option<Progress>,
}
