//! Errors on the way from an experiment to its report.

use std::path::{Path, PathBuf};

use peristalsis_engine::EngineError;
use peristalsis_figures::FigureError;
use peristalsis_formats::FormatError;
use peristalsis_run::RunError;
use peristalsis_study::StudyError;

/// An error on the way from an experiment to its report. Neither too few runs nor a failed check is an error: both are part
/// of a [`Finding`](crate::Finding).
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A study could not be read or worked on.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A table lacks a column, or a file could not be read or written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A single run for a picture failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A simulation of a textbook case failed.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Two spheres of a textbook case never parted.
    #[error("the spheres of an impact were still in contact after {steps} steps of {time_step}")]
    NoRebound {
        /// Number of steps.
        steps: u64,
        /// Their length \[t\].
        time_step: f64,
    },
    /// An examination panicked: a bug of this program.
    #[error("the analysis panicked: please report this")]
    Panicked,
    /// A claim asked for a study that is not there: a bug of this program.
    #[error("the study {0} is not among the evidence")]
    NoSuchStudy(String),
    /// There is no claim or textbook case of this name.
    #[error("there is no {kind} {asked:?}")]
    NoSuchExperiment {
        /// "claim" or "case".
        kind: &'static str,
        /// The name.
        asked: String,
        /// The names of all claims, or of all cases.
        known: Vec<&'static str>,
    },
    /// A folder for the results cannot be made.
    #[error("cannot write to {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The document that shall hold the results cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The document.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The document has no place for a block, or one that does not end.
    #[error("{} has no place for {block:?}: the line {line:?} is missing", path.display())]
    NoPlace {
        /// The document.
        path: PathBuf,
        /// Name of the block.
        block: String,
        /// The line that is missing.
        line: String,
    },
    /// Somebody asked to stop.
    #[error("stopped")]
    Stopped,
}

/// What may fail here.
pub(crate) type Result<T> = std::result::Result<T, ReproduceError>;

/// Makes a folder for results.
pub(crate) fn make_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|source| ReproduceError::Folder {
        path: path.to_owned(),
        source,
    })
}
