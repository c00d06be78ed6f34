//! The entries of the index: the state of a run, and the lease of the process that works on it.

use std::time::Duration;

use super::owner::{Owner, now};

/// Seconds by which the clock of another machine may be ahead of ours.
const MOST_AHEAD: i64 = 3600;

/// The state of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Nothing is there yet.
    Pending,
    /// Some process works on it.
    Leased,
    /// It was interrupted, and goes on from its last checkpoint.
    Checkpointed,
    /// Finished: the hashes of its products check, or its row was imported.
    Done,
    /// It ended in an error, which is kept.
    Failed,
    /// Its files were not what had been written; they were moved aside, and it will be computed again.
    Quarantined,
}

impl State {
    /// Its name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pending => "pending",
            Self::Leased => "leased",
            Self::Checkpointed => "checkpointed",
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Quarantined => "quarantined",
        }
    }

    /// Whether it may still give a row.
    pub fn is_unfinished(self) -> bool {
        !matches!(self, Self::Done | Self::Failed)
    }

    pub(crate) fn of_name(name: &str) -> Self {
        let kept = [
            Self::Checkpointed,
            Self::Done,
            Self::Failed,
            Self::Quarantined,
        ];
        let found = kept.into_iter().find(|state| state.name() == name);
        found.unwrap_or(Self::Pending)
    }
}

/// The entry of a run in the index.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its state.
    pub state: State,
    /// Why it failed or was quarantined; where the row of a finished run came from, if it was imported.
    pub reason: Option<String>,
    /// Row of a finished run as CSV.
    pub(crate) row: Option<String>,
    /// tau \[t\] of a finished run.
    pub transition_time: Option<f64>,
    /// Sizes and times of change of the products when their hashes were last checked.
    pub(crate) stamp: Option<String>,
}

impl Entry {
    pub(crate) fn new(state: State, reason: Option<String>) -> Self {
        Self {
            state,
            reason,
            row: None,
            transition_time: None,
            stamp: None,
        }
    }

    /// Whether the run was finished here, rather than imported.
    pub(crate) fn is_computed(&self) -> bool {
        self.state == State::Done && self.reason.is_none()
    }
}

/// A lease: who works on a run.
#[derive(Clone, Debug)]
pub(crate) struct Lease {
    pub(crate) owner: Owner,
    pub(crate) heartbeat: i64,
}

impl Lease {
    /// Whether the run may be taken over: its owner is dead, or has been silent for too long.
    ///
    /// A heartbeat far in the future counts as silence: the clock has been set back since.
    pub(crate) fn is_void(&self, timeout: Duration) -> bool {
        let silent = now() - self.heartbeat;
        self.owner.is_dead() || silent > timeout.as_secs() as i64 || silent < -MOST_AHEAD
    }

    /// Who holds it, in words.
    pub(crate) fn in_words(&self) -> String {
        format!(
            "process {} on {}, last heard of {} s ago",
            self.owner.process,
            self.owner.host.split_whitespace().next().unwrap_or("?"),
            (now() - self.heartbeat).max(0)
        )
    }
}
