//! Time of a piece of work, where there is a clock.

use std::time::{Duration, Instant};

/// A time that goes on from its begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch(Option<Instant>);

impl Stopwatch {
    /// Begins now. WebAssembly has no clock of its own, and asking for one would end the program there.
    pub(crate) fn begin() -> Self {
        Self((!cfg!(target_family = "wasm")).then(Instant::now))
    }

    /// Time since the begin; none where there is no clock.
    pub(crate) fn elapsed(self) -> Duration {
        self.0.map_or(Duration::ZERO, |begin| begin.elapsed())
    }
}
