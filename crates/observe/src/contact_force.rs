//! The forces that grains bear at their contacts, at some moments of a run: what may break them.

use peristalsis_engine::Simulation;
use serde::{Deserialize, Serialize};

use crate::load::for_each_grain_contact;
use crate::series::{Join, Series, joined};

/// Part of the contacts below [`ContactForce::high`].
const PART: f64 = 0.99;

/// The normal forces at the contacts of the grains, with each other and with the wall, at a moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactForce {
    /// The moment \[t\].
    pub time: f64,
    /// Largest of them; 0 without contacts \[m d/t^2\].
    pub largest: f64,
    /// Force that 99 % of them do not exceed; 0 without contacts \[m d/t^2\].
    pub high: f64,
}

impl ContactForce {
    /// The forces now.
    pub fn of(simulation: &Simulation) -> Self {
        let mut forces = Vec::new();
        for_each_grain_contact(simulation, |it| forces.push(it.touching.normal_force));
        forces.sort_by(f64::total_cmp);
        let rank = (PART * forces.len() as f64).ceil() as usize;
        Self {
            time: simulation.time(),
            largest: forces.last().copied().unwrap_or(0.0).max(0.0),
            high: forces
                .get(rank.saturating_sub(1))
                .map_or(0.0, |it| it.max(0.0)),
        }
    }
}

/// Of several moments the largest force, and the mean of those that 99 % do not exceed.
impl Join for ContactForce {
    fn join(&mut self, own: u64, next: &Self, others: u64) {
        *self = Self {
            time: next.time,
            largest: self.largest.max(next.largest),
            high: joined(self.high, own, next.high, others),
        };
    }
}

/// The forces at moments all along a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactForces {
    looks: Series<ContactForce>,
    /// Step from which on the next look is due.
    due: u64,
}

impl Default for ContactForces {
    fn default() -> Self {
        Self {
            looks: Series::new(1),
            due: 0,
        }
    }
}

impl ContactForces {
    /// Records the forces now, where the next record is due, `interval` steps after the last.
    pub fn look(&mut self, simulation: &Simulation, interval: u64) {
        if simulation.step() >= self.due {
            self.due = simulation.step() + interval;
            self.looks.push([ContactForce::of(simulation)]);
        }
    }

    /// The records from the time `start` \[t\] on.
    pub fn late(&self, start: f64) -> &[ContactForce] {
        let looks = self.looks.rows();
        &looks[looks.partition_point(|look| look.time < start)..]
    }

    /// Whether a run can have come to this state, read from a file.
    pub fn fits(&self) -> bool {
        self.looks.fits(1)
    }
}
