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

mod course;
mod frame;
mod message;
mod onlooker;
pub mod page;
mod page_viewer;
#[cfg(feature = "server")]
mod server;
mod steering;
mod timeline;
mod tube;
#[cfg(all(test, feature = "server"))]
mod typescript;
mod welcome;
mod within;

pub use onlooker::Onlooker;
pub use page_viewer::PageViewer;
#[cfg(feature = "server")]
pub use server::{Figure, Options, Recording, Study, Viewer, ViewerError};
