//! The one error type of this crate.

use std::io;
use std::path::{Path, PathBuf};

use crate::value_kind::ValueKind;

/// Errors between a value in memory and its bytes on disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The operating system refused; [`io::Error::kind`] of `source` tells a full disk from a missing permission.
    #[error("cannot {operation} {}: {source}", path.display())]
    Io {
        /// What was tried, as a verb phrase: "write", "replace", "synchronize the folder of".
        operation: &'static str,
        /// The file that the caller asked for.
        path: PathBuf,
        /// The refusal itself.
        source: io::Error,
    },

    /// A table must have at least one column.
    #[error("a table needs at least one column")]
    NoColumns,
    /// A column must have a name.
    #[error("column {0} (counted from 0) has no name")]
    UnnamedColumn(usize),
    /// Two columns have the same name.
    #[error("two columns are named `{0}`")]
    DuplicateColumn(String),
    /// The columns of a table must be equally long.
    #[error("column `{name}` has {found} rows, the columns before it {expected}")]
    UnequalLength {
        /// The first column that differs.
        name: String,
        /// Its number of rows.
        found: usize,
        /// The number of rows of the columns before it.
        expected: usize,
    },
    /// A metadata key is taken by the file format.
    #[error("the metadata key `{0}` is reserved for the file format")]
    ReservedMetadata(String),
    /// Two tables to be joined differ in their columns; holds the first column without an equal.
    #[error(
        "the tables differ at column `{0}`: appending needs the same names, kinds, units and descriptions in the same order"
    )]
    DifferentColumns(String),
    /// The table has no such column.
    #[error("no column named `{0}`")]
    MissingColumn(String),
    /// The column holds values of another kind.
    #[error("column `{name}` holds {found} values, not {expected}")]
    OtherKind {
        /// The column in question.
        name: String,
        /// The kind asked for.
        expected: ValueKind,
        /// The kind in the table.
        found: ValueKind,
    },

    /// The text is not CSV with one header row and equally many fields in every row.
    #[error("CSV line {line}: {reason}")]
    Csv {
        /// Line on which the offending record begins, counted from 1.
        line: usize,
        /// What is wrong there.
        reason: String,
    },

    /// The Parquet library refused to write or read.
    #[error("Parquet: {0}")]
    Parquet(#[from] ::parquet::errors::ParquetError),
    /// A Parquet file changed on disk; holds the sign of it.
    #[error("the Parquet file is corrupt: {0}")]
    CorruptParquet(String),
    /// A Parquet column has a type that no [`Values`](crate::Values) holds, or lacks a value where that kind cannot.
    #[error("Parquet column `{name}`: {reason}")]
    UnsupportedParquet {
        /// The column in question.
        name: String,
        /// What is not supported.
        reason: String,
    },

    /// A file is no trajectory that can be gone on with.
    #[error("{} is no trajectory that can be continued: {reason}", path.display())]
    NotATrajectory {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },

    /// A file is no trajectory that can be read.
    #[error("{} cannot be read as a trajectory: {reason}", path.display())]
    UnreadableTrajectory {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },

    /// The bytes do not begin like a checkpoint.
    #[error("not a checkpoint of this project: the first bytes differ from its signature")]
    NotACheckpoint,
    /// The container has a layout that this program does not know.
    #[error("the checkpoint has format version {found}; this program reads version {readable}")]
    CheckpointVersion {
        /// The version in the file.
        found: u32,
        /// The version that can be read.
        readable: u32,
    },
    /// The checkpoint holds another kind of state.
    #[error("the checkpoint holds a state of kind `{}`, not `{}`", found.escape_ascii(), expected.escape_ascii())]
    CheckpointKind {
        /// The kind in the file.
        found: [u8; 8],
        /// The kind asked for.
        expected: [u8; 8],
    },
    /// The state in the checkpoint is laid out by another version of its type.
    #[error(
        "the state in the checkpoint has layout version {found}; this program reads version {readable}"
    )]
    CheckpointLayout {
        /// The layout version in the file.
        found: u32,
        /// The layout version that the caller reads.
        readable: u32,
    },
    /// The state was computed with another version of the physics, so that it cannot go on to the same bits.
    #[error(
        "it was computed with version {found} of the physics; this program computes version {computed}, which gives \
         other results"
    )]
    OtherPhysicsVersion {
        /// Version of the physics of the state.
        found: u32,
        /// Version of the physics of the reader.
        computed: u32,
    },
    /// The checkpoint belongs to a run with other physics.
    #[error(
        "the checkpoint belongs to other physics: hash {} in the file, {} here",
        crate::hexadecimal(found),
        crate::hexadecimal(expected)
    )]
    OtherPhysics {
        /// The hash in the file.
        found: [u8; 32],
        /// The hash of the run that wanted to continue.
        expected: [u8; 32],
    },
    /// The checkpoint ends too early.
    #[error("the checkpoint is cut short: {found} of {expected} bytes")]
    TruncatedCheckpoint {
        /// Bytes that the header (or, in its absence, the shortest header) asks for.
        expected: u64,
        /// Bytes present.
        found: u64,
    },
    /// The checkpoint has its full length but changed on disk; holds the sign of it.
    #[error("the checkpoint is corrupt: {0}")]
    CorruptCheckpoint(String),
    /// The state is larger than a checkpoint may be.
    #[error("a state of {bytes} bytes is beyond the limit of {limit} bytes for one checkpoint")]
    StateTooLarge {
        /// Size of the encoded state.
        bytes: u64,
        /// The most that a checkpoint holds.
        limit: u64,
    },
    /// The state refused to be serialized.
    #[error("the state cannot be serialized: {0}")]
    Serialize(#[source] postcard::Error),
}

/// Whether the operating system refused since this user may not write there.
pub fn is_closed(error: &io::Error) -> bool {
    use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem};
    matches!(error.kind(), PermissionDenied | ReadOnlyFilesystem)
}

impl FormatError {
    /// What went wrong with a file; an error of ours that came by way of `io` is that error again.
    pub(crate) fn io(operation: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| match source.downcast() {
            Ok(ours) => ours,
            Err(source) => Self::Io {
                operation,
                path: path.to_owned(),
                source,
            },
        }
    }

    pub(crate) fn not_a_trajectory(path: &Path, reason: impl Into<String>) -> Self {
        Self::NotATrajectory {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }
}
