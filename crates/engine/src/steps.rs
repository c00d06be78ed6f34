//! The step loop, the same for all kernels.

use crate::integrate::Runaway;
use crate::ledger::{Ledger, Tally};
use crate::wall::Wall;

/// The parts of a step that a kernel does in its own way; [`Course::advance`] says in which order.
pub(crate) trait Stepper {
    /// Moves the spheres to the end of the step, and their velocities to where the forces want them.
    ///
    /// The first call completes the velocities of the step before, where [`Stepper::finish`] has not.
    fn move_spheres(&mut self) -> Result<(), Runaway>;

    /// Sums of the step with the wall as it stands; no contact history moves on.
    fn tally(&mut self, wall: &Wall) -> Tally;

    /// Works out all forces at the end of the step. Sums that only observers read may be left out unless `complete`.
    fn evaluate(&mut self, wall: &Wall, complete: bool);

    /// The sums of the last evaluation. They may be added up while spheres move, so they cost less after that.
    fn sums(&mut self) -> Tally;

    /// Brings the velocities to the end of the last step.
    fn finish(&mut self) -> Result<(), Runaway>;
}

/// Wall, clock and energies of a simulation, which every step moves on.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    pub(crate) wall: Wall,
    /// Sums over the contacts at the end of the last step.
    pub(crate) tally: Tally,
    pub(crate) ledger: Ledger,
    /// Steps done.
    pub(crate) step: u64,
    pub(crate) time_step: f64,
}

impl Course {
    pub(crate) fn time(&self) -> f64 {
        self.step as f64 * self.time_step
    }

    /// Advances by `steps` steps; at a runaway the time is the one of the step that failed.
    #[inline(always)]
    pub(crate) fn advance(&mut self, kernel: &mut impl Stepper, steps: u64) -> Result<(), Runaway> {
        if steps == 0 {
            return Ok(());
        }
        for remaining in (0..steps).rev() {
            let is_first = remaining == steps - 1;
            self.step += 1;
            let time = self.time();
            let moved = kernel.move_spheres();
            if !is_first {
                self.book(kernel.sums());
            }
            moved?;

            // A wall that jumps does work on the contacts that it finds: the difference of what they store and lose after
            // the jump and would without it.
            let jumps = self.wall.move_without_jump(time - self.time_step, time);
            let without_jump = jumps.then(|| kernel.tally(&self.wall).stored_and_lost());
            self.wall.move_to(time);
            kernel.evaluate(&self.wall, remaining == 0 || jumps);
            if let Some(without_jump) = without_jump {
                let work = kernel.sums().stored_and_lost() - without_jump;
                self.ledger.add_jump(work);
            }
        }
        let finished = kernel.finish();
        self.book(kernel.sums());
        finished
    }

    /// Takes the sums at the end of a step up.
    fn book(&mut self, after: Tally) {
        self.ledger.add_step(&self.tally, &after, self.time_step);
        self.tally = after;
    }
}
