//! Answers of the law for the contacts of a stretch, where threads work them out: kept until all are there, then added up
//! sphere by sphere in the order of the list.

use super::book::{Book, ContactTerms, Terms};
use super::contacts::{Eight, Outcome};
use super::pairs::Pairs;
use super::record::Record;
use super::spheres::ForcesMut;
use crate::fast::lanes::LANES;
use crate::fast::machine::{Machine, Work};

/// What a contact does to its spheres.
#[derive(Clone, Copy, Debug, Default)]
struct Answer {
    first: u32,
    second: u32,
    /// Of the first sphere and of the second.
    arms: [f64; 2],
    /// On the first sphere.
    force: Record,
    torque_per_arm: Record,
}

/// Answers for the contacts of a stretch, in their order.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    /// With room for eight more, and what was there before.
    room: Vec<Answer>,
    number: usize,
    pub(super) terms: Terms,
    /// The contacts in the order of the stretches of their second spheres, and where each stretch ends.
    by_second: Vec<u32>,
    ends: Vec<u32>,
}

impl Answers {
    /// Forgets all, and makes room for so many.
    pub(super) fn clear(&mut self, contacts: usize) {
        let room = contacts + LANES;
        if self.room.len() < room {
            self.room.resize(room, Answer::default());
        }
        self.number = 0;
        self.terms.clear();
    }

    fn all(&self) -> &[Answer] {
        &self.room[..self.number]
    }

    /// Sorts the contacts by the stretches of their second spheres, `stretch_of` each sphere one of so many.
    pub(super) fn sort(&mut self, stretch_of: &[u16], stretches: usize) {
        let stretch = |answer: &Answer| stretch_of[answer.second as usize] as usize;
        let answers = &self.room[..self.number];
        self.ends.clear();
        self.ends.resize(stretches, 0);
        for answer in answers {
            self.ends[stretch(answer)] += 1;
        }
        let mut end = 0;
        for ends in &mut self.ends {
            end += *ends;
            *ends = end;
        }
        // Filling backwards brings each end down to its start.
        self.by_second.resize(answers.len(), 0);
        for (contact, answer) in answers.iter().enumerate().rev() {
            let place = &mut self.ends[stretch(answer)];
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
        let room = &mut self.room[self.number..self.number + LANES];
        for (lane, answer) in room.iter_mut().enumerate() {
            answer.first = eight.first[lane] as u32;
            answer.second = eight.second[lane] as u32;
            answer.force = eight.forces[lane].record();
            if ROTATES {
                answer.torque_per_arm = eight.torques_per_arm[lane].record();
                answer.arms = [eight.arms[0][lane], eight.arms[1][lane]];
            }
        }
        self.number += eight.contacts;
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
                let answer = &answers.room[contact as usize];
                let at = answer.second as usize - self.forces.first;
                let force = &mut self.forces.force[at];
                *force = (force.quad::<M::Quads>() - answer.force.quad()).record();
                self.add_torque::<M>(at, answer, answer.arms[1]);
            }
        }
        for answer in self.pairs[stretch].answers.all() {
            let at = answer.first as usize - self.forces.first;
            let force = &mut self.forces.force[at];
            *force = (force.quad::<M::Quads>() + answer.force.quad()).record();
            self.add_torque::<M>(at, answer, answer.arms[0]);
        }
    }
}

impl Gather<'_> {
    #[inline(always)]
    fn add_torque<M: Machine>(&mut self, at: usize, answer: &Answer, arm: f64) {
        if self.rotates {
            let torque = &mut self.forces.torque[at];
            let more = answer.torque_per_arm.quad::<M::Quads>() * arm;
            *torque = (torque.quad() + more).record();
        }
    }
}
