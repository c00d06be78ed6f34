//! The course of a run: moments to come back to, and how it was steered between them.

use std::collections::VecDeque;

use peristalsis_run::{Mark, Run};

use crate::message::{Steered, Turn};

/// States kept to come back to.
const MARKS: usize = 24;

/// Where a run can be taken back to, and what to do again on the way from there.
#[derive(Debug)]
pub(crate) struct Course {
    /// Earlier states in the order of time, the first of all at least, and how often each had been steered.
    marks: Vec<(Mark, usize)>,
    /// How the run was steered so far.
    turns: Vec<Turn>,
    /// How it was steered between here and where it is to come to again.
    ahead: VecDeque<Turn>,
}

impl Course {
    pub(crate) fn begin(run: &mut Run) -> Self {
        Self {
            marks: vec![(run.mark(), 0)],
            turns: Vec::new(),
            ahead: VecDeque::new(),
        }
    }

    /// Steps before the first mark.
    pub(crate) fn first_step(&self) -> u64 {
        self.marks[0].0.step()
    }

    /// How the run was steered so far.
    pub(crate) fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// Steers the run as it says, from its start on.
    pub(crate) fn follow(&mut self, run: &mut Run, turns: Vec<Turn>) {
        self.marks.truncate(1);
        run.back_to(&self.marks[0].0);
        self.turns.clear();
        self.ahead = turns.into();
    }

    /// Notes how the run was steered now, and marks the moment after that.
    pub(crate) fn turn(&mut self, run: &mut Run, parameter: Steered, value: f64) {
        let step = run.simulation().step();
        self.turns.push(Turn {
            step,
            parameter,
            value,
        });
        self.mark(run);
    }

    /// The next turn, if it has to be repeated at the present step.
    pub(crate) fn due(&mut self, run: &Run) -> Option<Turn> {
        let step = run.simulation().step();
        self.ahead.pop_front_if(|turn| turn.step <= step)
    }

    /// Steps to the next turn that has to be repeated, at most `most`.
    pub(crate) fn steps_to_next(&self, run: &Run, most: u64) -> u64 {
        let step = run.simulation().step();
        self.ahead
            .front()
            .map_or(most, |turn| most.min(turn.step - step))
    }

    /// Leaves the course that it was to follow again.
    pub(crate) fn leave(&mut self) {
        self.ahead.clear();
    }

    /// Takes the run back to the last mark up to a step. What steered it from there to the step is done again on the way;
    /// what came later is forgotten.
    pub(crate) fn back(&mut self, run: &mut Run, target: u64) {
        let known = self
            .marks
            .partition_point(|(mark, _)| mark.step() <= target);
        self.marks.truncate(known.max(1));
        let (mark, done) = &self.marks[self.marks.len() - 1];
        run.back_to(mark);
        let later = self.turns.drain(done..).collect::<Vec<_>>();
        self.ahead = later.into_iter().chain(self.ahead.drain(..)).collect();
        self.ahead.retain(|turn| turn.step <= target);
    }

    /// Marks the moment if the last mark is far away: the longer the run, the further apart.
    pub(crate) fn mark_now_and_then(&mut self, run: &mut Run) {
        let step = run.simulation().step();
        let [last, first] =
            [self.marks.last(), self.marks.first()].map(|it| it.map_or(0, |(mark, _)| mark.step()));
        let each = run.configuration().run.steps_per_sample;
        if step >= last + (20 * each).max((step - first) / (MARKS as u64 / 2)) {
            self.mark(run);
        }
    }

    fn mark(&mut self, run: &mut Run) {
        let now = run.simulation().step();
        // The first of all stays.
        let mut place = 0;
        self.marks.retain(|(mark, _)| {
            place += 1;
            place == 1 || mark.step() < now
        });
        self.marks.push((run.mark(), self.turns.len()));
        if self.marks.len() > MARKS {
            // Drops the state whose neighbours are nearest to each other.
            let gaps = self.marks.windows(3);
            let gaps = gaps.map(|it| it[2].0.step() - it[0].0.step());
            if let Some((index, _)) = gaps.enumerate().min_by_key(|(_, gap)| *gap) {
                self.marks.remove(index + 1);
            }
        }
    }
}
