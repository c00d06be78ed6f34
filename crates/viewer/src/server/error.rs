//! What can go wrong before the viewer serves.

use std::path::PathBuf;

/// Why the viewer cannot serve.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// The address is taken, or the system allows no server.
    #[error("cannot listen on 127.0.0.1:{port}: {source}")]
    Listen {
        /// The port asked for.
        port: u16,
        /// Why.
        source: std::io::Error,
    },
    /// The system gives no random numbers for the token.
    #[error("the system gives no random numbers: {0}")]
    Token(getrandom::Error),
    /// A trajectory cannot be read.
    #[error(transparent)]
    Trajectory(#[from] peristalsis_formats::FormatError),
    /// A trajectory is not of the run that it should be of.
    #[error("{}: {reason}", path.display())]
    ForeignTrajectory {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },
    /// A store or a study file cannot be read.
    #[error(transparent)]
    Study(#[from] peristalsis_study::StudyError),
    /// A table is not one of rows of runs.
    #[error("{name} is no table of finished runs: {reason}")]
    NotRows {
        /// The table.
        name: String,
        /// What is wrong.
        reason: String,
    },
    /// What a reproduction found cannot be read.
    #[error("cannot read {}: {reason}", path.display())]
    Claims {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The system gives no thread.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
}
