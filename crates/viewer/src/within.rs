//! The study that a run belongs to, as the page of the run is told.

use serde::Serialize;

/// Where a run stands in its study.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Within {
    /// Name of the study.
    pub(crate) study: String,
    /// What the run is called in the addresses of pages.
    pub(crate) number: usize,
    /// The runs of the same point, this one among them.
    pub(crate) siblings: Vec<Sibling>,
}

/// A run that differs by its random numbers alone.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Sibling {
    pub(crate) number: usize,
    /// Number of the replicate, from 0.
    pub(crate) replicate: u32,
}
