//! Contacts between moving spheres, eight at a time.
//!
//! One pass over the listed pairs writes down which of them touch; the law is then evaluated for those only, in lanes,
//! in the order of the list. Which pairs touch does not depend on the other pairs of the list, so neither do the results.

use core::ops::Range;

use peristalsis_physics::contact::{Contact, ContactForce, ContactLaw, NormalLaw};
use peristalsis_physics::real::Real;

use super::history::{Packed, PackedHistory};
use super::record::{self, Record};
use super::spheres::Spheres;
use crate::bodies::Bodies;
use crate::fast::lanes::{LANES, Lanes, Mask, Quad};
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::ledger::Tally;
use crate::neighbours::Neighbours;

/// Pairs one after the other, filled up to whole blocks with pairs that never touch.
#[derive(Clone, Debug, Default)]
struct Flat {
    first: Vec<u32>,
    second: Vec<u32>,
    /// Distance below which a pair touches.
    reach: Vec<f64>,
}

impl Flat {
    fn clear(&mut self) {
        self.first.clear();
        self.second.clear();
        self.reach.clear();
    }

    /// The pairs of some rows of a list.
    fn load<H: Copy + Default + PartialEq>(
        &mut self,
        list: &Neighbours<H>,
        rows: Range<usize>,
        diameter: &[f64],
    ) {
        self.clear();
        for i in rows {
            let (own, partners) = (diameter[i], list.partners(i));
            let whole = self.first.len() + partners.len();
            self.first.resize(whole, i as u32);
            self.second.extend_from_slice(partners);
            let reaches = partners.iter().map(|&j| 0.5 * (own + diameter[j as usize]));
            self.reach.extend(reaches);
        }
        self.fill_up();
    }

    fn fill_up(&mut self) {
        let whole = self.first.len().next_multiple_of(LANES);
        self.first.resize(whole, 0);
        self.second.resize(whole, 0);
        self.reach.resize(whole, 0.0);
    }

    /// Writes down, in order, the pairs that are closer than their reach and `skin`.
    #[inline(always)]
    fn find<M: Machine>(&self, position: &[Record], length: f64, skin: f64, found: &mut Vec<u32>) {
        found.resize(self.first.len() + LANES, 0);
        let mut end = 0;
        let skin = Lanes::splat(skin);
        let blocks = self.first.as_chunks::<LANES>().0.iter();
        let blocks = blocks
            .zip(self.second.as_chunks::<LANES>().0)
            .zip(self.reach.as_chunks::<LANES>().0);
        for (block, ((first, second), reach)) in blocks.enumerate() {
            let mut apart = [Quad::<M>::splat(0.0); LANES];
            for lane in 0..LANES {
                let (i, j) = (first[lane] as usize, second[lane] as usize);
                apart[lane] = position[i].quad() - position[j].quad();
            }
            let (separation, _) = record::into_lanes::<M>(apart);
            let squared = record::periodic(separation, length).squared();
            let reach = Lanes::load(reach, 0) + skin;
            // Coincident centres have no normal.
            let near = squared.less(reach * reach) & Lanes::splat(0.0).less(squared);
            let window = found[end..].first_chunk_mut().expect("room for a block");
            near.write_down((block * LANES) as u32, window);
            end += near.count() as usize;
        }
        found.truncate(end);
    }
}

/// The pairs of a list that may touch before it is pruned again.
#[derive(Clone, Debug, Default)]
struct Pruned {
    list: Flat,
    near: Flat,
    /// Which pair of `list` each pair of `near` is.
    number: Vec<u32>,
}

impl Pruned {
    #[inline(always)]
    fn prune<M: Machine>(&mut self, position: &[Record], length: f64, skin: f64) {
        let Self { list, near, number } = self;
        list.find::<M>(position, length, skin, number);
        near.clear();
        let chosen = number.iter().map(|&k| k as usize);
        near.first.extend(chosen.clone().map(|k| list.first[k]));
        near.second.extend(chosen.clone().map(|k| list.second[k]));
        near.reach.extend(chosen.map(|k| list.reach[k]));
        near.fill_up();
    }
}

/// The listed pairs, and which of them touch.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// Pairs of a grain with a grain or a wall sphere, in the order of the list.
    grains: Pruned,
    /// Pairs of two wall spheres.
    wall: Pruned,
    /// Histories of the contacts of `grains`.
    histories: Vec<Packed>,
    /// For each of them the evaluation, counted round, at which it last touched.
    stamp: Vec<u8>,
    now: u8,
    /// The pairs of `grains` that touched at the last evaluation: only they have a history.
    touched: Vec<u32>,
    /// Those that did so when they were taken from the rows.
    loaded: Vec<u32>,
    touching: Vec<u32>,
}

impl Pairs {
    /// Makes the flat lists from the rows.
    pub(super) fn load<T: PackedHistory>(
        &mut self,
        list: &Neighbours<T::History<f64>>,
        bodies: &Bodies,
    ) {
        let (grains, diameter) = (bodies.grains.min(list.rows()), &bodies.diameter[..]);
        self.grains.list.load(list, 0..grains, diameter);
        self.wall.list.load(list, grains..list.rows(), diameter);
        self.histories.clear();
        self.touched.clear();
        self.stamp.clear();
        if T::ROTATES {
            let histories = &list.histories()[..list.pairs_above(grains)];
            self.histories.resize(histories.len(), Packed::default());
            for (k, history) in histories.iter().enumerate() {
                if *history != T::History::<f64>::default() {
                    self.histories[k] = T::pack(history);
                    self.touched.push(k as u32);
                }
            }
            self.stamp.resize(histories.len(), self.now.wrapping_sub(1));
        }
        self.loaded.clone_from(&self.touched);
    }

    /// Writes the histories back to the rows.
    pub(super) fn store<T: PackedHistory>(&self, list: &mut Neighbours<T::History<f64>>) {
        let histories = list.histories_mut();
        for &k in &self.loaded {
            histories[k as usize] = T::History::<f64>::default();
        }
        for &k in &self.touched {
            histories[k as usize] = T::unpack(&self.histories[k as usize]);
        }
    }
}

/// Chooses from the list the pairs that are closer than their reach and `skin`.
pub(super) struct Prune<'a> {
    pub(super) pairs: &'a mut Pairs,
    pub(super) spheres: &'a Spheres,
    pub(super) length: f64,
    pub(super) skin: f64,
}

impl Work for Prune<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let (pairs, position) = (self.pairs, &self.spheres.position[..]);
        let (length, skin) = (self.length, self.skin);
        pairs.grains.prune::<M>(position, length, skin);
        pairs.wall.prune::<M>(position, length, skin);
    }
}

/// Adds the forces and torques of all contacts between moving spheres.
pub(super) struct PairForces<'a, N, T: PackedHistory> {
    pub(super) law: &'a ContactLaw<N, T>,
    pub(super) pairs: &'a mut Pairs,
    pub(super) spheres: &'a mut Spheres,
    pub(super) length: f64,
    pub(super) time_step: f64,
    pub(super) tally: &'a mut Tally,
}

impl<N: NormalLaw, T: PackedHistory> Work for PairForces<'_, N, T> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Pairs {
            grains,
            wall,
            histories,
            stamp,
            now,
            touched,
            touching,
            ..
        } = self.pairs;
        grains
            .near
            .find::<M>(&self.spheres.position, self.length, 0.0, touching);
        let step = (self.length, self.time_step);
        add_contacts::<M, _, _>(self.law, grains, touching, self.spheres, histories, step)
            .add_to(self.tally);
        if T::ROTATES {
            *now = now.wrapping_add(1);
            for at in touching.iter_mut() {
                *at = grains.number[*at as usize];
                stamp[*at as usize] = *now;
            }
            for &k in touched.iter() {
                if stamp[k as usize] != *now {
                    let packed = &mut histories[k as usize];
                    let history = T::unpack(packed);
                    self.tally.history_reset += self.law.tangential.stored_energy::<f64>(&history);
                    *packed = Packed::default();
                }
            }
            core::mem::swap(touched, touching);
        }
        // Wall against wall, across a closing throat: the same normal law, no friction.
        if !wall.near.first.is_empty() {
            wall.near
                .find::<M>(&self.spheres.position, self.length, 0.0, touching);
            let smooth = self.law.frictionless();
            let of_wall =
                add_contacts::<M, _, _>(&smooth, wall, touching, self.spheres, &mut [], step);
            self.tally.contact_energy += of_wall.contact_energy.sum();
            self.tally.normal_dissipation += of_wall.normal_dissipation.sum();
        }
    }
}

impl<M: Machine> Sums<M> {
    /// Adds the answers for `contacts` contacts, one in each of the first lanes.
    #[inline(always)]
    fn add(
        &mut self,
        answer: &ContactForce<Lanes<M>>,
        overlap: Lanes<M>,
        with_wall: Mask<M>,
        contacts: usize,
    ) {
        let (zero, valid) = (Lanes::splat(0.0), Mask::first(contacts));
        let overlap = Lanes::select(valid, overlap, zero);
        self.contact_energy += Lanes::select(valid, answer.energy, zero);
        self.normal_dissipation += Lanes::select(valid, answer.normal_dissipation, zero);
        self.tangential_lost += Lanes::select(valid, answer.tangential.damped, zero);
        self.sliding_lost += Lanes::select(valid, answer.tangential.slid, zero);
        self.total_overlap += overlap;
        self.largest_overlap = self.largest_overlap.max(overlap);
        self.wall_axial_force += Lanes::select(valid & with_wall, answer.force.z, zero);
        let with_wall = (valid & with_wall).count();
        self.wall_contacts += with_wall;
        self.grain_contacts += contacts as u64 - with_wall;
        self.sliding_contacts += (valid & answer.tangential.sliding).count();
    }
}

/// Adds the forces and torques of the pairs that touch; answers their sums.
#[inline(always)]
fn add_contacts<M: Machine, N: NormalLaw, T: PackedHistory>(
    law: &ContactLaw<N, T>,
    pairs: &Pruned,
    touching: &[u32],
    spheres: &mut Spheres,
    histories: &mut [Packed],
    (length, time_step): (f64, f64),
) -> Sums<M> {
    let grains = spheres.grains;
    let position = &spheres.position[..];
    let velocity = &spheres.velocity[..];
    let turning = &spheres.turning[..];
    let force = &mut spheres.force[..];
    let torque = &mut spheres.torque[..];
    let zero = Lanes::<M>::splat(0.0);
    let mut sums = Sums::<M>::default();
    for block in touching.chunks(LANES) {
        let lanes = block.len();
        let (mut pair, mut i, mut j) = ([0; LANES], [0; LANES], [0; LANES]);
        let nothing = Quad::<M>::splat(0.0);
        let (mut apart, mut relative) = ([nothing; LANES], [nothing; LANES]);
        let (mut turnings_i, mut turnings_j) = ([nothing; LANES], [nothing; LANES]);
        let mut with_wall = 0;
        for lane in 0..LANES {
            // Lanes to spare do the last contact again, to no effect.
            let k = block[lane.min(lanes - 1)] as usize;
            pair[lane] = pairs.number[k] as usize;
            i[lane] = pairs.near.first[k] as usize;
            j[lane] = pairs.near.second[k] as usize;
            let (i, j) = (i[lane], j[lane]);
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
        let mut history = T::History::<Lanes<M>>::default();
        if T::ROTATES {
            history = T::into_lanes::<M>(pair.map(|k| &histories[k]));
        }
        let answer = law.force(&contact, &mut history, time_step);
        sums.add(&answer, contact.overlap, Mask::from_bits(with_wall), lanes);
        let forces = record::from_lanes(answer.force, zero);
        let torques = record::from_lanes(answer.torque_per_arm, zero);
        let (arms_i, arms_j) = (arms.0.to_array(), arms.1.to_array());
        for lane in 0..lanes {
            let (i, j) = (i[lane], j[lane]);
            force[i] = (force[i].quad() + forces[lane]).record();
            force[j] = (force[j].quad() - forces[lane]).record();
            if T::ROTATES {
                torque[i] = (torque[i].quad() + torques[lane] * arms_i[lane]).record();
                torque[j] = (torque[j].quad() + torques[lane] * arms_j[lane]).record();
            }
        }
        if T::ROTATES {
            let [first, second] = T::from_lanes::<M>(&history);
            for lane in 0..lanes {
                histories[pair[lane]] = [first[lane].record(), second[lane].record()];
            }
        }
    }
    sums
}
