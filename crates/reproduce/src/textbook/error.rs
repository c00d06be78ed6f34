//! What can go wrong on the way from a case to its page.

use std::path::PathBuf;

use peristalsis_engine::EngineError;
use peristalsis_figures::FigureError;
use peristalsis_formats::FormatError;

/// An error of the validation. A check that fails is none: it is a finding.
#[derive(Debug, thiserror::Error)]
pub enum ValidateError {
    /// A simulation of a case failed.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Two spheres of a case never parted.
    #[error("the spheres of an impact were still in contact after {steps} steps of {time_step}")]
    NoRebound {
        /// Steps that were made.
        steps: u64,
        /// Their length \[t\].
        time_step: f64,
    },
    /// A file could not be written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A case was asked for that is not there.
    #[error("there is no case {asked:?}")]
    NoSuchCase {
        /// What was asked for.
        asked: String,
        /// The names of all cases.
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
    /// The document to be written into cannot be read.
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
