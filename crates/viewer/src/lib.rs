//! The browser viewer: a tube that runs in the engine, watched and driven from a page.
//!
//! [`Viewer::open`] takes a run, [`Viewer::play`] a [`Recording`], and both listen on loopback; [`Viewer::serve`] answers
//! until it is asked to stop. One thread owns the run and advances it, and each client gets frames over a WebSocket as
//! fast as it takes them; or it owns the recording, and each client gets the frames that it asks for by their number.
//! [`Viewer::exhibit`] takes studies and figures; what a client can name of them is a number, and a run that it opens gets
//! a thread as above.
//! Clients send commands (`message.rs`). The pages are part of the program, and no file is read for a client but recordings,
//! rows and figures of what was opened.
//!
//! Without the feature `server` there is only [`PageViewer`]: a tube without threads, files or a clock of its own, which the
//! page computes itself. `browser/exports.rs` exports it to JavaScript as WebAssembly (`scripts/web.sh`).

#![forbid(unsafe_code)]

#[cfg(feature = "server")]
mod assets;
#[cfg(feature = "server")]
mod figure;
mod frame;
#[cfg(feature = "server")]
mod gallery;
#[cfg(feature = "server")]
mod guard;
mod message;
mod page_viewer;
#[cfg(feature = "server")]
mod recording;
#[cfg(feature = "server")]
mod recording_host;
#[cfg(feature = "server")]
mod run_host;
#[cfg(feature = "server")]
mod server;
#[cfg(feature = "server")]
mod session;
#[cfg(feature = "server")]
mod socket;
#[cfg(feature = "server")]
mod study;
mod timeline;
mod tube;
mod welcome;
mod within;

#[cfg(feature = "server")]
pub use figure::Figure;
pub use page_viewer::PageViewer;
#[cfg(feature = "server")]
pub use recording::Recording;
#[cfg(feature = "server")]
pub use server::{Options, Viewer};
#[cfg(feature = "server")]
pub use study::Study;

#[cfg(feature = "server")]
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
        path: std::path::PathBuf,
        /// Why.
        reason: String,
    },
    /// The system gives no thread.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
}
