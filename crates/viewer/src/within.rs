//! The study that a run belongs to, for the page of the run.

use serde::Serialize;

/// The place of a run in its study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Within {
    /// Name of the study.
    pub(crate) study: String,
    /// Number of the run in the addresses of pages.
    pub(crate) number: usize,
    /// The finished runs of the same point, and this one.
    pub(crate) siblings: Vec<Sibling>,
}

/// A run of the same point with other random numbers.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Sibling {
    pub(crate) number: usize,
    /// Number of the replicate, from 0.
    pub(crate) replicate: u32,
}
