//! The viewer as a client sees it, friendly or not.

#[allow(clippy::unwrap_used, reason = "a test")]
mod client;
mod driving;
#[allow(clippy::unwrap_used, reason = "a test")]
mod playing;
mod refusing;
#[allow(clippy::unwrap_used, reason = "a test")]
mod studying;
