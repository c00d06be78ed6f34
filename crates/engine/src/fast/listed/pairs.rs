//! The listed pairs of moving spheres, stretch by stretch, and which of them touch.
//!
//! One pass over the pairs writes down which of them touch; the law is then evaluated for those only ([`super::contacts`]),
//! in the order of the list. Which pairs touch does not depend on the other pairs of the list, so neither do the results.

use core::ops::Range;

use peristalsis_physics::real::Real;

use super::answers::Answers;
use super::history::{Packed, PackedHistory};
use super::record::{self, Record};
use crate::bodies::Bodies;
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Machine, Work};
use crate::neighbours::Neighbours;

/// Pairs one after the other, filled up to whole blocks with pairs that never touch.
#[derive(Clone, Debug, Default)]
pub(super) struct Flat {
    pub(super) first: Vec<u32>,
    pub(super) second: Vec<u32>,
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
    pub(super) fn find<M: Machine>(
        &self,
        position: &[Record],
        length: f64,
        skin: f64,
        found: &mut Vec<u32>,
    ) {
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

/// The pairs of some rows of a list, and which of them touch.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// Spheres whose rows these are: all grains, or all of the wall.
    pub(super) rows: Range<usize>,
    /// The first pair of the list that is in them, and how many are.
    first: usize,
    listed: usize,
    list: Flat,
    /// The pairs that may touch before others are chosen.
    pub(super) near: Flat,
    /// Which pair of the list each of them is.
    pub(super) number: Vec<u32>,
    /// Histories of the contacts.
    pub(super) histories: Vec<Packed>,
    /// For each pair the evaluation, counted round, at which it last touched.
    stamp: Vec<u8>,
    now: u8,
    /// The pairs that touched at the last evaluation: only they have a history.
    pub(super) touched: Vec<u32>,
    /// Their histories, on the way from one list to the next.
    carried: Vec<Packed>,
    /// The near pairs that touch.
    pub(super) touching: Vec<u32>,
    /// Energy of the tangential springs of contacts that have ended in this step.
    pub(super) ended: Vec<f64>,
    /// Where there are threads.
    pub(super) answers: Answers,
}

impl Pairs {
    /// Makes the flat list from the rows, without histories.
    pub(super) fn load<T: PackedHistory>(
        &mut self,
        list: &Neighbours<T::History<f64>>,
        bodies: &Bodies,
    ) {
        let listed = self.listed_rows(list);
        self.first = list.pairs_above(listed.start);
        self.listed = list.pairs_above(listed.end) - self.first;
        // All others are fresh already.
        for &k in &self.touched {
            self.histories[k as usize] = Packed::default();
        }
        self.touched.clear();
        self.stamp.clear();
        // Wall against wall has no friction.
        if T::ROTATES && self.rows.start < bodies.grains {
            self.histories.resize(self.listed, Packed::default());
            self.stamp.resize(self.listed, self.now.wrapping_sub(1));
        }
        self.list.load(list, listed, &bodies.diameter);
    }

    fn listed_rows<H: Copy + Default + PartialEq>(&self, list: &Neighbours<H>) -> Range<usize> {
        self.rows.start.min(list.rows())..self.rows.end.min(list.rows())
    }

    /// Takes the histories of its pairs out of those of the rows.
    pub(super) fn take_up<T: PackedHistory>(&mut self, histories: &mut [T::History<f64>]) {
        let histories = &mut histories[self.first..self.first + self.listed];
        for (k, (packed, history)) in self.histories.iter_mut().zip(histories).enumerate() {
            if *history != T::History::<f64>::default() {
                *packed = T::pack(&core::mem::take(history));
                self.touched.push(k as u32);
            }
        }
    }

    /// Takes its histories out, to be put into another list.
    pub(super) fn hand_over(&mut self, places: &mut Vec<u32>) {
        let Self {
            histories, touched, ..
        } = self;
        self.carried.clear();
        let of = |&k: &u32| core::mem::take(&mut histories[k as usize]);
        self.carried.extend(touched.iter().map(of));
        places.extend(touched.iter().map(|k| self.first as u32 + k));
        touched.clear();
    }

    /// Puts them in at their places in the new list, those of all stretches.
    pub(super) fn carry_on(&mut self, places: &[u32]) {
        let begin = places.partition_point(|&at| (at as usize) < self.first);
        for (packed, at) in self.carried.iter().zip(&places[begin..]) {
            let k = at - self.first as u32;
            self.histories[k as usize] = *packed;
            self.touched.push(k);
        }
    }

    /// Writes the histories back to those of the rows, which are fresh.
    pub(super) fn store<T: PackedHistory>(&self, histories: &mut [T::History<f64>]) {
        for &k in &self.touched {
            histories[self.first + k as usize] = T::unpack(&self.histories[k as usize]);
        }
    }

    /// Ends the histories of the pairs that touch no more.
    pub(super) fn end_histories<T: PackedHistory>(&mut self, law: &T) {
        self.now = self.now.wrapping_add(1);
        for at in &mut self.touching {
            *at = self.number[*at as usize];
            self.stamp[*at as usize] = self.now;
        }
        for &k in &self.touched {
            if self.stamp[k as usize] != self.now {
                let packed = &mut self.histories[k as usize];
                let history = T::unpack(packed);
                self.ended.push(law.stored_energy::<f64>(&history));
                *packed = Packed::default();
            }
        }
        core::mem::swap(&mut self.touched, &mut self.touching);
    }
}

/// Chooses from the list the pairs that are closer than their reach and `skin`.
pub(super) struct Prune<'a> {
    pub(super) pairs: &'a mut Pairs,
    pub(super) position: &'a [Record],
    pub(super) length: f64,
    pub(super) skin: f64,
}

impl Work for Prune<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Pairs {
            list, near, number, ..
        } = self.pairs;
        list.find::<M>(self.position, self.length, self.skin, number);
        near.clear();
        let chosen = number.iter().map(|&k| k as usize);
        near.first.extend(chosen.clone().map(|k| list.first[k]));
        near.second.extend(chosen.clone().map(|k| list.second[k]));
        near.reach.extend(chosen.map(|k| list.reach[k]));
        near.fill_up();
    }
}
