//! The viewer as a program: a server on loopback, and threads that own what it shows.

mod assets;
mod error;
mod figure;
pub(crate) mod gallery;
mod guard;
mod recording;
mod recording_host;
mod run_host;
mod session;
mod socket;
pub(crate) mod study;
mod viewer;

pub use error::ViewerError;
pub use figure::Figure;
pub use recording::Recording;
pub use study::Study;
pub use viewer::{Options, Viewer};
