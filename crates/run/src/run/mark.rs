//! Moments of a run to come back to.

use super::Run;
use crate::recorder::Lengths;

/// A moment of a run to come back to: its state without the measurements before, which the run keeps.
#[derive(Clone, Debug)]
pub struct Mark {
    run: Run,
    lengths: Lengths,
}

impl Mark {
    /// Number of steps before it.
    pub fn step(&self) -> u64 {
        self.run.simulation.step()
    }
}

impl Run {
    /// Marks this moment. A mark takes as much memory as the state, however long the run is.
    pub fn mark(&mut self) -> Mark {
        let series = self.recorder.take_series();
        let mark = Mark {
            run: self.clone(),
            lengths: series.lengths(),
        };
        self.recorder.give_series(series);
        mark
    }

    /// Comes back to a moment of its own course; what was measured later is forgotten.
    pub fn back_to(&mut self, mark: &Mark) {
        let mut series = self.recorder.take_series();
        series.truncate(mark.lengths);
        *self = mark.run.clone();
        self.recorder.give_series(series);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::*;

    #[test]
    fn a_run_that_came_back_goes_on_to_the_same_bits_and_marks_do_not_grow() {
        let settings = ["tube.waves=2", "run.periods=4"];
        let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
        let mut run = Run::new(configuration).unwrap();
        let advance = |run: &mut Run, samples: usize| {
            (0..samples).for_each(|_| run.advance().unwrap());
        };
        advance(&mut run, 25);
        let mark = run.mark();
        assert!(mark.run.recorder.samples().is_empty() && mark.run.recorder.waves().is_empty());
        assert_eq!(run.recorder().samples().len(), 25);
        advance(&mut run, 35);
        let first = run.recorder().clone();
        run.back_to(&mark);
        assert_eq!(
            (run.simulation().step(), run.recorder().samples().len()),
            (mark.step(), 25)
        );
        advance(&mut run, 35);
        assert_eq!(*run.recorder(), first);
    }
}
