//! What can go wrong on the way from findings to files.

use std::path::PathBuf;

use peristalsis_figures::FigureError;
use peristalsis_formats::FormatError;

/// An error on the way from findings to files.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A folder cannot be made.
    #[error("cannot make {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A figure cannot be turned into a picture.
    #[error("figure {name}: {source}")]
    Figure {
        /// Its name.
        name: String,
        /// Why.
        source: FigureError,
    },
}
