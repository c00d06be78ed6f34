//! Sums over the contacts of grains with what of the wall no force moves, at once or later.

use glam::DVec3;
use peristalsis_physics::contact::ContactForce;

use crate::ledger::Tally;

/// The terms that a contact of a grain with the wall adds to the sums.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallTerms {
    pub(crate) answer: ContactForce,
    pub(crate) overlap: f64,
    pub(crate) wall_velocity: DVec3,
}

/// Takes the terms of the sums, contact after contact.
pub(crate) trait WallSums {
    fn add(&mut self, terms: &WallTerms);
    /// The energy of a tangential spring whose contact has ended.
    fn add_ended(&mut self, energy: f64);
    /// Energies that rolling resistance and breaking cohesion took in this step, where the reference kernel computes.
    fn add_general(&mut self, _rolling: f64, _cohesion: f64) {}
    /// All contacts of a grain are there.
    fn end_grain(&mut self) {}
}

impl WallSums for Tally {
    #[inline(always)]
    fn add(&mut self, terms: &WallTerms) {
        let force = terms.answer.force;
        self.add_contact(&terms.answer, terms.overlap);
        self.wall_contacts += 1;
        self.wall_power += force.dot(terms.wall_velocity);
        self.wall_axial_force += force.z;
    }

    #[inline(always)]
    fn add_ended(&mut self, energy: f64) {
        self.history_reset += energy;
    }

    fn add_general(&mut self, rolling: f64, cohesion: f64) {
        self.rolling_lost += rolling;
        self.cohesion_lost += cohesion;
    }
}

/// Terms that wait for those of the grains before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Waiting {
    terms: Vec<WallTerms>,
    ended: Vec<f64>,
    /// Where the terms of each grain end.
    ends: Vec<[usize; 2]>,
    /// The grain whose terms come next, and where they begin.
    next: (usize, [usize; 2]),
}

impl Waiting {
    /// Adds the terms of the next grain.
    pub(crate) fn add_row(&mut self, tally: &mut Tally) {
        let (grain, [begin, ended_begin]) = self.next;
        let [end, ended_end] = self.ends[grain];
        let terms = &self.terms[begin..end];
        terms.iter().for_each(|terms| tally.add(terms));
        let ended = &self.ended[ended_begin..ended_end];
        ended.iter().for_each(|&energy| tally.add_ended(energy));
        self.next = (grain + 1, [end, ended_end]);
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.terms.clear();
        self.ended.clear();
        self.ends.clear();
        self.next = Default::default();
    }
}

impl WallSums for Waiting {
    fn add(&mut self, terms: &WallTerms) {
        self.terms.push(*terms);
    }

    fn add_ended(&mut self, energy: f64) {
        self.ended.push(energy);
    }

    fn end_grain(&mut self) {
        self.ends.push([self.terms.len(), self.ended.len()]);
    }
}
