//! The tube in a visitor's own browser: the viewer's run as WebAssembly, behind a few functions for the page's worker.
//!
//! [`Cabin`] is the whole of it, in terms of bytes and texts. `exports.rs` hands it to JavaScript: texts go in through one
//! buffer, and texts and frames come out through another.

mod cabin;
mod exports;

pub use cabin::Cabin;
