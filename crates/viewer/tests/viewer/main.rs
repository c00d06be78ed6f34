//! The viewer as a client sees it, friendly or not.

#[allow(clippy::unwrap_used, reason = "a test")]
mod client;
mod driving;
mod playing;
mod refusing;
