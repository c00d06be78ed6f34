//! Contacts between moving spheres, eight at a time.

use peristalsis_physics::contact::{Contact, ContactForce, ContactLaw, NormalLaw};
use peristalsis_physics::real::Real;

use super::history::PackedHistory;
use super::pairs::Pairs;
use super::record::{self, Record};
use super::spheres::{Forces, Moving, Own};
use super::terms::RowTerms;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask, Quad};
use crate::fast::machine::{Machine, Work, bring_near, eight_of, eight_of_each};
use crate::fast::sums::Sums;
use crate::fast::threads::THREADS_EXIST;
use crate::ledger::Tally;

/// What becomes of the answers of the law.
trait Outcome<M: Machine> {
    /// Where the forces on spheres are added up.
    fn at(&self, places: &[u32; LANES]) -> [u32; LANES];
    fn add(&mut self, eight: &Eight<M>);
}

/// The answers for eight contacts, or for as many as there are.
struct Eight<M: Machine> {
    /// The first of them.
    start: usize,
    contacts: usize,
    /// Where the forces on their first spheres are added up.
    rows: [u32; LANES],
    answer: ContactForce<Lanes<M>>,
    overlap: Lanes<M>,
    /// Which are with the wall.
    with_wall: Mask<M>,
}

/// Finds and works out the contacts of the spheres of a section.
pub(super) struct PairForces<'a, N, T: PackedHistory> {
    pub(super) law: &'a ContactLaw<N, T>,
    pub(super) pairs: &'a mut Pairs,
    pub(super) of_grains: bool,
    pub(super) spheres: Moving<'a>,
    /// Their numbers.
    pub(super) number: &'a [u32],
    pub(super) forces: &'a mut Forces,
    pub(super) length: f64,
    pub(super) time_step: f64,
    /// Where sums go at once, of the only section; without it they become the terms of the pairs.
    pub(super) tally: Option<&'a mut Tally>,
    /// Whether all sums are wanted.
    pub(super) complete: bool,
}

impl<N: NormalLaw, T: PackedHistory> Work for PairForces<'_, N, T> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(mut self) {
        let own = self.forces.own;
        self.pairs
            .find_contacts::<M>(self.spheres.position, self.length);
        let remembers = T::ROTATES && self.of_grains;
        if remembers {
            self.pairs
                .begin_contacts(&self.law.tangential, own, self.number);
        }
        match self.tally.take() {
            Some(tally) => {
                let mut at_once = AtOnce::<M> {
                    sums: Sums::default(),
                    complete: self.complete,
                };
                self.work_out::<M>(&mut at_once);
                at_once.sums.add_to(tally);
            }
            None if !THREADS_EXIST => unreachable!("one thread adds up at once"),
            None => {
                let mut terms = core::mem::take(&mut self.pairs.terms);
                terms.clear(self.pairs.contacts(), self.complete);
                let mut of_rows = OfRows {
                    own,
                    terms: &mut terms,
                    complete: self.complete,
                    largest_overlap: Lanes::splat(0.0),
                };
                self.work_out::<M>(&mut of_rows);
                terms.largest_overlap = of_rows.largest_overlap.max_lane();
                terms.runs.extend(self.pairs.contacts_of_runs());
                self.pairs.terms = terms;
            }
        }
    }
}

impl<N: NormalLaw, T: PackedHistory> PairForces<'_, N, T> {
    #[inline(always)]
    fn work_out<M: Machine>(&mut self, outcome: &mut impl Outcome<M>) {
        let step = (self.length, self.time_step);
        let (pairs, forces) = (&mut *self.pairs, &mut *self.forces);
        if self.of_grains {
            work_out(self.law, pairs, self.spheres, forces, step, outcome);
        } else {
            // Wall against wall, across a closing throat: the same normal law, no friction.
            let law = &self.law.frictionless();
            work_out(law, pairs, self.spheres, forces, step, outcome);
        }
    }
}

/// So many contacts before their turn, what they ask of spheres is brought near.
const AHEAD: usize = 2 * LANES;

/// Works out the contacts of the pairs that touch, and adds up forces and torques.
#[inline(always)]
fn work_out<M: Machine, N: NormalLaw, T: PackedHistory>(
    law: &ContactLaw<N, T>,
    pairs: &mut Pairs,
    spheres: Moving<'_>,
    forces: &mut Forces,
    (length, time_step): (f64, f64),
    outcome: &mut impl Outcome<M>,
) {
    let Moving {
        position,
        velocity,
        turning,
    } = spheres;
    let force = &mut forces.force[..];
    // Of one length: looked at once.
    let torque = &mut forces.torque[..force.len()];
    let zero = Lanes::<M>::splat(0.0);
    for start in (0..pairs.contacts()).step_by(LANES) {
        let near = pairs.eight_touching(start);
        let contacts = LANES.min(pairs.contacts() - start);
        let spheres = [&pairs.near.first[..], &pairs.near.second];
        let [first, second] = eight_of_each(spheres, &near).map(|eight| eight.map(|&place| place));
        if let Some(near) = pairs.whole_eight_touching(start + AHEAD) {
            // The first spheres follow each other, so that the processor brings them near unasked.
            let second = eight_of(&pairs.near.second, near).map(|&place| place);
            for records in [position, velocity, turning] {
                bring_near(records, &second);
            }
            let rows = outcome.at(&second);
            bring_near(force, &rows);
            if T::ROTATES {
                bring_near(torque, &rows);
            }
            pairs.memory.bring_near(start + AHEAD);
        }
        let nothing = Quad::<M>::splat(0.0);
        let (mut apart, mut relative) = ([nothing; LANES], [nothing; LANES]);
        let (mut turnings_i, mut turnings_j) = ([nothing; LANES], [nothing; LANES]);
        let records = [position, velocity, turning];
        let [place_i, velocity_i, turning_i] = eight_of_each(records, &first);
        let [place_j, velocity_j, turning_j] = eight_of_each(records, &second);
        for lane in 0..LANES {
            apart[lane] = place_i[lane].quad() - place_j[lane].quad();
            relative[lane] = velocity_i[lane].quad() - velocity_j[lane].quad();
            turnings_i[lane] = turning_i[lane].quad();
            turnings_j[lane] = turning_j[lane].quad();
        }
        let separation = record::periodic(record::into_lanes::<M>(apart).0, length);
        let (relative_velocity, _) = record::into_lanes::<M>(relative);
        let (turning_i, diameter_i) = record::into_lanes::<M>(turnings_i);
        let (turning_j, diameter_j) = record::into_lanes::<M>(turnings_j);
        let with_wall = diameter_j.less(zero);
        let (diameter_i, diameter_j) = (diameter_i.abs(), diameter_j.abs());
        let mut contact = Contact::new((diameter_i, diameter_j), separation, relative_velocity);
        let arms = (contact.arm(diameter_i), contact.arm(diameter_j));
        if T::ROTATES {
            contact.rotation = turning_i * arms.0 + turning_j * arms.1;
        }
        let mut history = T::recall::<M>(&pairs.memory, start);
        let answer = law.force(&contact, &mut history, time_step);
        T::keep::<M>(&history, &mut pairs.memory, start);
        let on_first = record::from_lanes(answer.force, zero);
        let per_arm = record::from_lanes(answer.torque_per_arm, zero);
        let (arms_i, arms_j) = (arms.0.to_array(), arms.1.to_array());
        let (rows, columns) = (outcome.at(&first), outcome.at(&second));
        for lane in 0..contacts {
            let (i, j) = (rows[lane] as usize, columns[lane] as usize);
            let (on_first, per_arm) = (on_first[lane], per_arm[lane]);
            force[i] = (force[i].quad() + on_first).record();
            force[j] = (force[j].quad() - on_first).record();
            if T::ROTATES {
                torque[i] = (torque[i].quad() + per_arm * arms_i[lane]).record();
                torque[j] = (torque[j].quad() + per_arm * arms_j[lane]).record();
            }
        }
        outcome.add(&Eight {
            start,
            contacts,
            rows,
            answer,
            overlap: contact.overlap,
            with_wall,
        });
    }
}

/// All spheres are in one section: sums are added up at once, those that only observers read where all are wanted.
struct AtOnce<M: Machine> {
    sums: Sums<M>,
    complete: bool,
}

impl<M: Machine> Outcome<M> for AtOnce<M> {
    #[inline(always)]
    fn at(&self, places: &[u32; LANES]) -> [u32; LANES] {
        *places
    }

    #[inline(always)]
    fn add(&mut self, eight: &Eight<M>) {
        let Self { sums, complete } = self;
        let (zero, valid) = (Lanes::splat(0.0), Mask::first(eight.contacts));
        let answer = &eight.answer;
        let overlap = Lanes::select(valid, eight.overlap, zero);
        sums.normal_dissipation += Lanes::select(valid, answer.normal_dissipation, zero);
        sums.tangential_lost += Lanes::select(valid, answer.tangential.damped, zero);
        sums.sliding_lost += Lanes::select(valid, answer.tangential.slid, zero);
        sums.largest_overlap = sums.largest_overlap.max(overlap);
        if *complete {
            let with_wall = valid & eight.with_wall;
            sums.contact_energy += Lanes::select(valid, answer.energy, zero);
            sums.total_overlap += overlap;
            sums.wall_axial_force += Lanes::select(with_wall, answer.force.z, zero);
            sums.grain_contacts += eight.contacts as u64 - with_wall.count();
            sums.wall_contacts += with_wall.count();
            sums.sliding_contacts += (valid & answer.tangential.sliding).count();
        }
    }
}

/// The terms of all contacts are kept, and those in the section's rows of the list are counted.
struct OfRows<'a, M: Machine> {
    own: Own,
    terms: &'a mut RowTerms,
    complete: bool,
    largest_overlap: Lanes<M>,
}

impl<M: Machine> Outcome<M> for OfRows<'_, M> {
    #[inline(always)]
    fn at(&self, places: &[u32; LANES]) -> [u32; LANES] {
        self.own.at(places)
    }

    #[inline(always)]
    fn add(&mut self, eight: &Eight<M>) {
        let terms = &mut *self.terms;
        let answer = &eight.answer;
        let zero = Lanes::splat(0.0);
        let lost = LaneVector::new(
            answer.normal_dissipation,
            answer.tangential.damped,
            answer.tangential.slid,
        );
        let losses = record::from_lanes(lost, answer.energy);
        write_down::<M>(&mut terms.losses[eight.start..], losses);
        let valid = Mask::first(eight.contacts);
        let overlap = Lanes::select(valid, eight.overlap, zero);
        self.largest_overlap = self.largest_overlap.max(overlap);
        if !self.complete {
            return;
        }
        let axial_force = Lanes::select(eight.with_wall, answer.force.z, zero);
        let vector = LaneVector::new(eight.overlap, axial_force, zero);
        let rest = record::from_lanes(vector, zero);
        write_down::<M>(&mut terms.rest[eight.start..], rest);
        let is_own = |row: u32| row < self.own.number as u32;
        // Mostly all are.
        let owned = match eight.rows.iter().fold(true, |all, &row| all & is_own(row)) {
            true => valid,
            false => {
                let bit = |lane: usize| u8::from(is_own(eight.rows[lane])) << lane;
                valid & Mask::from_bits((0..LANES).fold(0, |bits, lane| bits | bit(lane)))
            }
        };
        let with_wall = (owned & eight.with_wall).count();
        let [of_grains, of_wall, sliding] = &mut terms.numbers;
        *of_grains += owned.count() - with_wall;
        *of_wall += with_wall;
        *sliding += (owned & answer.tangential.sliding).count();
    }
}

/// Writes down the terms of eight contacts, or of as many as there are and some that nobody reads.
#[inline(always)]
fn write_down<M: Machine>(to: &mut [Record], terms: [Quad<M>; LANES]) {
    let to = to.first_chunk_mut::<LANES>().expect("room for eight more");
    for (to, terms) in to.iter_mut().zip(terms) {
        *to = terms.record();
    }
}
