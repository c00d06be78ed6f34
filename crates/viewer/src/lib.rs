//! The browser viewer: a tube that runs in the engine, watched and driven from a page.
//!
//! [`Viewer::open`] takes a run and listens on loopback; [`Viewer::serve`] answers until it is asked to stop. One thread
//! owns the run and advances it; each client gets frames over a WebSocket as fast as it takes them, and sends
//! commands ([`message`]). The page itself is part of the program, and nothing is read from disk for a client.

mod assets;
mod frame;
mod guard;
pub mod message;
mod server;
mod tube;
mod welcome;

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
    /// The system gives no thread.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
}
