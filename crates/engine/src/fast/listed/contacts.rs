//! Contacts between moving spheres, eight at a time.

use peristalsis_physics::contact::{Contact, ContactForce, ContactLaw, NormalLaw};
use peristalsis_physics::real::Real;

use super::book::{Book, ContactTerms};
use super::history::PackedHistory;
use super::pairs::Pairs;
use super::record;
use super::spheres::{ForcesMut, Moving};
use crate::fast::lanes::{LANES, Lanes, Mask, Quad};
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::ledger::Tally;

/// What becomes of the answers of the law.
pub(super) trait Outcome<M: Machine> {
    fn take<const ROTATES: bool>(&mut self, eight: Eight<M>);
    fn add(&mut self, terms: ContactTerms<M>);
}

/// The answers for eight contacts, or for as many as there are.
pub(super) struct Eight<M: Machine> {
    pub(super) contacts: usize,
    pub(super) first: [usize; LANES],
    pub(super) second: [usize; LANES],
    /// On the first sphere.
    pub(super) forces: [Quad<M>; LANES],
    pub(super) torques_per_arm: [Quad<M>; LANES],
    /// Of the first spheres and of the second.
    pub(super) arms: [[f64; LANES]; 2],
}

/// Finds and works out the contacts of some rows of the list.
pub(super) struct PairForces<'a, N, T: PackedHistory> {
    pub(super) law: &'a ContactLaw<N, T>,
    pub(super) pairs: &'a mut Pairs,
    pub(super) spheres: Moving<'a>,
    pub(super) length: f64,
    pub(super) time_step: f64,
    /// Where forces, torques and sums go at once; without it they become the answers of the pairs.
    pub(super) at_once: Option<(ForcesMut<'a>, &'a mut Tally)>,
}

impl<N: NormalLaw, T: PackedHistory> Work for PairForces<'_, N, T> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(mut self) {
        self.pairs.answers.clear(0);
        self.pairs.ended.clear();
        if self.pairs.near.first.is_empty() && self.pairs.touched.is_empty() {
            return;
        }
        let Pairs { near, touching, .. } = &mut *self.pairs;
        near.find::<M>(self.spheres.position, self.length, 0.0, touching);
        let of_grains = self.pairs.rows.start < self.spheres.grains;
        match self.at_once.take() {
            Some((forces, tally)) => {
                let sums = Sums::<M>::default();
                let mut outcome = AtOnce { forces, sums };
                self.work_out::<M>(of_grains, &mut outcome);
                outcome.sums.add_to(tally);
            }
            None => {
                let mut answers = core::mem::take(&mut self.pairs.answers);
                answers.clear(self.pairs.touching.len());
                self.work_out::<M>(of_grains, &mut answers);
                self.pairs.answers = answers;
            }
        }
        if T::ROTATES && of_grains {
            self.pairs.end_histories(&self.law.tangential);
        }
    }
}

impl<N: NormalLaw, T: PackedHistory> PairForces<'_, N, T> {
    #[inline(always)]
    fn work_out<M: Machine>(&mut self, of_grains: bool, outcome: &mut impl Outcome<M>) {
        let step = (self.length, self.time_step);
        if of_grains {
            work_out(self.law, self.pairs, self.spheres, step, outcome);
        } else {
            // Wall against wall, across a closing throat: the same normal law, no friction.
            work_out(
                &self.law.frictionless(),
                self.pairs,
                self.spheres,
                step,
                outcome,
            );
        }
    }
}

/// Works out the contacts of the pairs that touch.
#[inline(always)]
fn work_out<M: Machine, N: NormalLaw, T: PackedHistory>(
    law: &ContactLaw<N, T>,
    pairs: &mut Pairs,
    spheres: Moving<'_>,
    (length, time_step): (f64, f64),
    outcome: &mut impl Outcome<M>,
) {
    let Moving {
        grains,
        position,
        velocity,
        turning,
    } = spheres;
    let histories = &mut pairs.histories[..];
    let zero = Lanes::<M>::splat(0.0);
    for block in pairs.touching.chunks(LANES) {
        let contacts = block.len();
        let (mut pair, mut first, mut second) = ([0; LANES], [0; LANES], [0; LANES]);
        let nothing = Quad::<M>::splat(0.0);
        let (mut apart, mut relative) = ([nothing; LANES], [nothing; LANES]);
        let (mut turnings_i, mut turnings_j) = ([nothing; LANES], [nothing; LANES]);
        let mut with_wall = 0;
        for lane in 0..LANES {
            // Lanes to spare do the last contact again, to no effect.
            let k = block[lane.min(contacts - 1)] as usize;
            pair[lane] = pairs.number[k] as usize;
            first[lane] = pairs.near.first[k] as usize;
            second[lane] = pairs.near.second[k] as usize;
            let (i, j) = (first[lane], second[lane]);
            apart[lane] = position[i].quad() - position[j].quad();
            relative[lane] = velocity[i].quad() - velocity[j].quad();
            turnings_i[lane] = turning[i].quad();
            turnings_j[lane] = turning[j].quad();
            with_wall |= u8::from(j >= grains) << lane;
        }
        let separation = record::periodic(record::into_lanes::<M>(apart).0, length);
        let (relative_velocity, _) = record::into_lanes::<M>(relative);
        let (turning_i, diameter_i) = record::into_lanes::<M>(turnings_i);
        let (turning_j, diameter_j) = record::into_lanes::<M>(turnings_j);
        let mut contact = Contact::new((diameter_i, diameter_j), separation, relative_velocity);
        let arms = (contact.arm(diameter_i), contact.arm(diameter_j));
        if T::ROTATES {
            contact.rotation = turning_i * arms.0 + turning_j * arms.1;
        }
        let mut history = T::into_lanes::<M>(histories, pair);
        let answer = law.force(&contact, &mut history, time_step);
        let with_wall = Mask::from_bits(with_wall);
        outcome.add(terms(&answer, contact.overlap, with_wall, contacts));
        let (arms_i, arms_j) = (arms.0.to_array(), arms.1.to_array());
        let eight = Eight {
            contacts,
            first,
            second,
            forces: record::from_lanes(answer.force, zero),
            torques_per_arm: record::from_lanes(answer.torque_per_arm, zero),
            arms: [arms_i, arms_j],
        };
        match T::ROTATES {
            true => outcome.take::<true>(eight),
            false => outcome.take::<false>(eight),
        }
        T::from_lanes::<M>(&history, histories, &pair[..contacts]);
    }
}

/// What is added up of the answers for so many contacts, one in each of the first lanes.
#[inline(always)]
fn terms<M: Machine>(
    answer: &ContactForce<Lanes<M>>,
    overlap: Lanes<M>,
    with_wall: Mask<M>,
    contacts: usize,
) -> ContactTerms<M> {
    let (zero, valid) = (Lanes::splat(0.0), Mask::first(contacts));
    let with_wall = valid & with_wall;
    let number = with_wall.count();
    ContactTerms {
        in_lanes: [
            Lanes::select(valid, answer.energy, zero),
            Lanes::select(valid, answer.normal_dissipation, zero),
            Lanes::select(valid, answer.tangential.damped, zero),
            Lanes::select(valid, answer.tangential.slid, zero),
            Lanes::select(valid, overlap, zero),
            Lanes::select(with_wall, answer.force.z, zero),
        ],
        numbers: [
            contacts as u64 - number,
            number,
            (valid & answer.tangential.sliding).count(),
        ],
    }
}

/// Forces and torques are added at once.
struct AtOnce<'a, M: Machine> {
    forces: ForcesMut<'a>,
    sums: Sums<M>,
}

impl<M: Machine> Outcome<M> for AtOnce<'_, M> {
    #[inline(always)]
    fn take<const ROTATES: bool>(&mut self, eight: Eight<M>) {
        let ForcesMut { force, torque, .. } = &mut self.forces;
        for lane in 0..eight.contacts {
            let (i, j) = (eight.first[lane], eight.second[lane]);
            let on_first = eight.forces[lane];
            force[i] = (force[i].quad() + on_first).record();
            force[j] = (force[j].quad() - on_first).record();
            if ROTATES {
                let per_arm = eight.torques_per_arm[lane];
                torque[i] = (torque[i].quad() + per_arm * eight.arms[0][lane]).record();
                torque[j] = (torque[j].quad() + per_arm * eight.arms[1][lane]).record();
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, terms: ContactTerms<M>) {
        self.sums.contacts(terms);
    }
}
