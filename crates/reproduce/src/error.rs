//! What can go wrong on the way from runs to findings.

use std::path::PathBuf;

use peristalsis_figures::FigureError;
use peristalsis_formats::FormatError;
use peristalsis_run::RunError;
use peristalsis_study::StudyError;

/// An error on the way from runs to findings. Statistics that are too thin are none: they are a [`Finding`](crate::Finding).
#[derive(Debug, thiserror::Error)]
pub enum ClaimError {
    /// A study could not be read or worked on.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A table lacks what it must have, or a file could not be read or written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A single run for a picture failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A claim asked for a study that is not there: an error of ours.
    #[error("the study {0} is not among the evidence")]
    NoSuchStudy(String),
    /// A claim was asked for that is not there.
    #[error("there is no claim {asked:?}")]
    NoSuchClaim {
        /// What was asked for.
        asked: String,
        /// The names of all claims.
        known: Vec<&'static str>,
    },
    /// The folder for the results cannot be made.
    #[error("cannot write to {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
