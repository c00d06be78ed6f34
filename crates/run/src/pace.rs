//! How far to advance between two looks at the clock.

use std::time::Duration;

use crate::RunError;
use crate::run::Run;
use crate::stopwatch::Stopwatch;

/// Steps of the first advance.
const FIRST: u64 = 1_000;
/// Steps of an advance at most: fewer than some samples are apart.
const MOST: u64 = 50_000;
/// Time that an advance takes at most, about.
const LONGEST: Duration = Duration::from_millis(200);

/// Advances of at most a fifth of a second or so, however slow a step is: a request to stop between two of them is heard
/// soon. The bits of a run do not depend on it.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    steps: u64,
}

impl Default for Pace {
    fn default() -> Self {
        Self { steps: FIRST }
    }
}

impl Pace {
    /// Advances a run for a moment, at most by `most` steps and to its next sample.
    ///
    /// # Errors
    /// As [`Run::advance`].
    pub fn advance(&mut self, run: &mut Run, most: u64) -> Result<(), RunError> {
        let begin = Stopwatch::begin();
        let outcome = run.advance_at_most(most.min(self.steps));
        let took = begin.elapsed();
        if took > LONGEST {
            self.steps = (self.steps / 2).max(1);
        } else if took < LONGEST / 4 {
            self.steps = (2 * self.steps).min(MOST);
        }
        outcome
    }
}
