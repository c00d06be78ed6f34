//! Answers of the law for the contacts of a stretch, where threads work them out: kept until all are there, then added up
//! sphere by sphere in the order of the list.

use super::book::{Book, ContactTerms, Terms};
use super::contacts::{Eight, Outcome};
use super::pairs::Pairs;
use super::record::Record;
use super::spheres::ForcesMut;
use crate::fast::machine::{Machine, Work};

/// Forces and torques of the contacts of a stretch, in their order.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    first: Vec<u32>,
    second: Vec<u32>,
    /// On the first sphere.
    force: Vec<Record>,
    torque_per_arm: Vec<Record>,
    arms: [Vec<f64>; 2],
    pub(super) terms: Terms,
    /// The contacts in the order of the stretches of their second spheres, and where each stretch ends.
    by_second: Vec<u32>,
    ends: Vec<u32>,
}

impl Answers {
    pub(super) fn clear(&mut self) {
        self.first.clear();
        self.second.clear();
        self.force.clear();
        self.torque_per_arm.clear();
        self.arms.iter_mut().for_each(Vec::clear);
        self.terms.clear();
    }

    /// Sorts the contacts by the stretches of their second spheres, `stretch_of` each sphere one of so many.
    pub(super) fn sort(&mut self, stretch_of: &[u16], stretches: usize) {
        let stretch = |&second: &u32| stretch_of[second as usize] as usize;
        self.ends.clear();
        self.ends.resize(stretches, 0);
        for second in &self.second {
            self.ends[stretch(second)] += 1;
        }
        let mut end = 0;
        for ends in &mut self.ends {
            end += *ends;
            *ends = end;
        }
        // Filling backwards brings each end down to its start.
        self.by_second.resize(self.second.len(), 0);
        for (contact, second) in self.second.iter().enumerate().rev() {
            let place = &mut self.ends[stretch(second)];
            *place -= 1;
            self.by_second[*place as usize] = contact as u32;
        }
        self.ends.push(end);
    }

    fn with_second_in(&self, stretch: usize) -> &[u32] {
        &self.by_second[self.ends[stretch] as usize..self.ends[stretch + 1] as usize]
    }
}

impl<M: Machine> Outcome<M> for Answers {
    #[inline(always)]
    fn take<const ROTATES: bool>(&mut self, eight: Eight<M>) {
        for lane in 0..eight.contacts {
            self.first.push(eight.first[lane] as u32);
            self.second.push(eight.second[lane] as u32);
            self.force.push(eight.forces[lane].record());
            if ROTATES {
                self.torque_per_arm
                    .push(eight.torques_per_arm[lane].record());
                for (all, arms) in self.arms.iter_mut().zip(&eight.arms) {
                    all.push(arms[lane]);
                }
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, terms: ContactTerms<M>) {
        Book::<M>::contacts(&mut self.terms, terms);
    }
}

/// Adds the answers for the contacts of the spheres of a stretch to the forces and torques on them.
pub(super) struct Gather<'a> {
    /// Of the stretches up to this one.
    pub(super) pairs: &'a [Pairs],
    pub(super) forces: ForcesMut<'a>,
    pub(super) rotates: bool,
}

impl Work for Gather<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(mut self) {
        // A sphere is second in the rows of spheres before it, and then first in its own.
        let stretch = self.pairs.len() - 1;
        for answers in self.pairs.iter().map(|pairs| &pairs.answers) {
            for &contact in answers.with_second_in(stretch) {
                let contact = contact as usize;
                let at = answers.second[contact] as usize - self.forces.first;
                let force = &mut self.forces.force[at];
                *force = (force.quad::<M::Quads>() - answers.force[contact].quad()).record();
                self.add_torque::<M>(at, answers, contact, 1);
            }
        }
        let answers = &self.pairs[stretch].answers;
        for (contact, first) in answers.first.iter().enumerate() {
            let at = *first as usize - self.forces.first;
            let force = &mut self.forces.force[at];
            *force = (force.quad::<M::Quads>() + answers.force[contact].quad()).record();
            self.add_torque::<M>(at, answers, contact, 0);
        }
    }
}

impl Gather<'_> {
    #[inline(always)]
    fn add_torque<M: Machine>(
        &mut self,
        at: usize,
        answers: &Answers,
        contact: usize,
        side: usize,
    ) {
        if self.rotates {
            let torque = &mut self.forces.torque[at];
            let more = answers.torque_per_arm[contact].quad::<M::Quads>();
            *torque = (torque.quad() + more * answers.arms[side][contact]).record();
        }
    }
}
