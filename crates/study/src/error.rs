//! Errors of a study and its store.

use std::path::PathBuf;

use peristalsis_configuration::ConfigurationError;
use peristalsis_formats::FormatError;
use peristalsis_run::RunError;

/// A result of this crate.
pub(crate) type Result<T, E = StudyError> = std::result::Result<T, E>;

/// Errors of a study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The study file, or a configuration that follows from it, is not one that can run.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A file that was named cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file or folder cannot be made, moved, read or written, or is not what it should be.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The index of the store cannot be read or written.
    #[error("the index of the store, {}: {source}", path.display())]
    Index {
        /// The file.
        path: PathBuf,
        /// Why.
        source: rusqlite::Error,
    },
    /// A run cannot be packed, saved or written.
    #[error("run {identity}: {source}")]
    Run {
        /// The run.
        identity: crate::Identity,
        /// Why.
        source: RunError,
    },
    /// The products of a run do not read back as they were written.
    #[error("run {identity} does not read back as it was written: {reason}")]
    NotWritten {
        /// The run.
        identity: crate::Identity,
        /// What differs.
        reason: String,
    },
    /// There is no store where one was named.
    #[error("{} is no store of a study: {reason}", path.display())]
    NoStore {
        /// The folder.
        path: PathBuf,
        /// The missing part.
        reason: String,
    },
    /// The store holds another study.
    #[error("{} holds the study `{found}`, not `{expected}`", path.display())]
    OtherStudy {
        /// The folder.
        path: PathBuf,
        /// Name of the study in the store.
        found: String,
        /// Name of the study that was asked for.
        expected: String,
    },
    /// No run, or more than one, has an identity that begins so.
    #[error("{number} runs of this store have an identity that begins with {prefix:?}")]
    NoSuchRun {
        /// What was asked for.
        prefix: String,
        /// How many there are.
        number: usize,
    },
    /// A table is not one of rows of finished runs.
    #[error("nothing is taken from {}: {reason}", path.display())]
    NotRows {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
    /// Some run cannot be estimated.
    #[error("trial of a run ({point}): {source}")]
    Trial {
        /// Its settings in words.
        point: String,
        /// The fault.
        source: RunError,
    },
}

impl StudyError {
    /// Whether the store is there and cannot be written to.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Index { source, .. } => is_closed(source),
            Self::Format(FormatError::Io { source, .. }) => peristalsis_formats::is_closed(source),
            _ => false,
        }
    }

    /// Says which file that was named cannot be read.
    pub fn read(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Read { path, source }
    }

    /// Says from which file no rows of finished runs are taken.
    pub fn not_rows(path: impl Into<PathBuf>) -> impl FnOnce(String) -> Self {
        let path = path.into();
        move |reason| Self::NotRows { path, reason }
    }

    /// Says what was tried where.
    pub(crate) fn io(
        operation: &'static str,
        path: impl Into<PathBuf>,
    ) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| {
            Self::Format(FormatError::Io {
                operation,
                path,
                source,
            })
        }
    }
}

/// Whether the database exists and cannot be written to.
pub(crate) fn is_closed(error: &rusqlite::Error) -> bool {
    use rusqlite::ErrorCode;
    matches!(
        error.sqlite_error_code(),
        Some(ErrorCode::ReadOnly | ErrorCode::CannotOpen | ErrorCode::PermissionDenied)
    )
}
