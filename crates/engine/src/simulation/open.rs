//! A simulation whose tube is open.

use super::Simulation;
use crate::ends::{Ends, OpenEnds};
use crate::error::EngineError;
use crate::integrate::Past;

impl Simulation {
    /// The same simulation at time 0 with open ends, and with `more` grains of these diameters that wait outside.
    ///
    /// # Errors
    /// [`EngineError::InvalidParameter`] for an elastic wall, which knows no ends.
    pub fn open(self, ends: OpenEnds, more: &[f64]) -> Result<Self, EngineError> {
        if self.wall().mobile_spheres() > 0 {
            return Err(EngineError::InvalidParameter {
                parameter: "drive.control",
                value: self.wall().mobile_spheres() as f64,
                allowed: "the ends of a wall without mobile spheres can be open",
            });
        }
        let mut snapshot = self.snapshot();
        let (wall, parameters) = (self.course.wall, self.parameters);
        let bodies = &mut snapshot.bodies;
        let ends = Ends::begin(ends, bodies, &wall, parameters.time_step, more);
        // A grain that waits has left its contacts.
        let stays = |grain: u32| !ends.waits(grain as usize);
        let pairs = &mut snapshot.pair_histories;
        pairs.retain(|&(i, j, _)| stays(i) && stays(j));
        snapshot.wall_histories.retain(|&(grain, ..)| stays(grain));
        let [pairs, with_wall] = &mut snapshot.general_histories;
        pairs.retain(|&(i, j, _)| stays(i) && stays(j));
        with_wall.retain(|&(grain, ..)| stays(grain));
        (snapshot.past, snapshot.sorting) = (Past::default(), None);
        snapshot.ends = Some(ends);
        Self::starting_with(snapshot, wall, parameters)
    }

    /// Takes out what has left the open ends, and puts in what comes. The energy that this adds is written down.
    pub(super) fn look_at_ends(&mut self) {
        let now = (self.step(), self.time());
        let (energy, moment) = (self.energy(), self.moment());
        let (wall, bodies) = (&self.course.wall, &mut self.bodies);
        let Some(ends) = &mut self.ends else { return };
        let look = ends.look(bodies, wall, now);
        if look.passed {
            self.refresh_contacts();
            self.evaluate_here();
            // What ended here has gone with the grains, and is no loss of the step.
            let tally = &mut self.course.tally;
            tally.history_reset = 0.0;
            (tally.tangential_lost, tally.sliding_lost) = (0.0, 0.0);
            (tally.rolling_lost, tally.cohesion_lost) = (0.0, 0.0);
        }
        for grain in look.placed {
            self.past.forget(&self.bodies, grain);
        }
        let (exchanged, moved) = (self.energy() - energy, self.moment() - moment);
        let ledger = &mut self.course.ledger;
        ledger.exchanged += exchanged;
        ledger.initial_moment += moved;
    }

    /// The ends of an open tube; `None` of a periodic one.
    pub fn ends(&self) -> Option<&Ends> {
        self.ends.as_deref()
    }

    /// Whether a sphere does not wait outside an open tube.
    pub fn is_present(&self, sphere: usize) -> bool {
        self.ends.as_ref().is_none_or(|ends| !ends.waits(sphere))
    }

    /// Length of the tube \[d\]: the period, or the distance between its open ends.
    pub fn length(&self) -> f64 {
        let period = self.wall().length();
        self.ends().map_or(period, |ends| ends.length(self.wall()))
    }

    /// z of a grain as it has moved since the start: with turns round the tube, without being put in again \[d\].
    pub fn travelled(&self, grain: usize) -> f64 {
        let unfolded = || self.bodies.unfolded(grain, self.wall().length());
        match self.ends() {
            // What it falls between two looks is no motion of it.
            Some(ends) if !self.is_present(grain) => {
                ends.parking_place(grain, self.wall()).z - ends.carried(grain)
            }
            Some(ends) => unfolded() - ends.carried(grain),
            None => unfolded(),
        }
    }
}
