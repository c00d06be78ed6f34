//! The browser viewer: a tube that runs in the engine, watched and driven from a page.
//!
//! [`Viewer::open`] takes a run, [`Viewer::play`] a [`Recording`], and both listen on loopback; [`Viewer::serve`] answers
//! until it is asked to stop. One thread owns the run and advances it, and each client gets frames over a WebSocket as
//! fast as it takes them; or it owns the recording, and each client gets the frames that it asks for by their number.
//! Clients send commands ([`message`]). The page itself is part of the program, and no file is read for a client but the
//! one recording.

#![forbid(unsafe_code)]

mod assets;
mod course;
mod frame;
mod guard;
pub mod message;
mod player;
mod recording;
mod server;
mod tube;
mod welcome;

pub use recording::Recording;
pub use server::{Options, Viewer};

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
        path: std::path::PathBuf,
        /// What does not fit.
        reason: String,
    },
    /// The system gives no thread.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
}
