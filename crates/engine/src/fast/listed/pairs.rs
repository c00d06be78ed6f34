//! The listed pairs of the spheres of a section, and which of them touch.
//!
//! A pair across the border of two sections is in both. One pass over the pairs writes down which of them touch; the law is
//! then evaluated for those only ([`super::contacts`]), in the order of the list. Which pairs touch does not depend on the other pairs of the list, so neither do the results.

use peristalsis_physics::real::Real;

use super::book::RowTerms;
use super::history::{Memory, Packed, PackedHistory};
use super::record::{self, Record};
use super::spheres::{Own, Spheres};
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Machine, Work, bring_near, eight_of};
use crate::neighbours::Neighbours;

/// So many blocks before their turn, the places of spheres are brought near.
const AHEAD: usize = 4;

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

    /// Takes up pairs whose first sphere is at place `first`.
    fn extend(&mut self, first: usize, second: &[u32], spheres: &Spheres) {
        let diameter = |place: usize| spheres.turning[place].0[3].abs();
        let own = diameter(first);
        self.first
            .resize(self.first.len() + second.len(), first as u32);
        let second = second.iter().map(|&number| spheres.place[number as usize]);
        self.second.extend(second.clone());
        let reaches = second.map(|place| 0.5 * (own + diameter(place as usize)));
        self.reach.extend(reaches);
    }

    fn fill_up(&mut self) {
        let whole = self.first.len().next_multiple_of(LANES);
        self.first.resize(whole, 0);
        self.second.resize(whole, 0);
        self.reach.resize(whole, 0.0);
    }

    /// Writes down, in order, the pairs that are closer than their reach and `skin`; answers how many there are.
    #[inline(always)]
    pub(super) fn find<M: Machine>(
        &self,
        position: &[Record],
        length: f64,
        skin: f64,
        found: &mut Vec<u32>,
    ) -> usize {
        let room = self.first.len() + LANES;
        if found.len() < room {
            found.resize(room, 0);
        }
        let mut end = 0;
        let (skin, whole) = (Lanes::splat(skin), Lanes::splat(length));
        let seconds = self.second.as_chunks::<LANES>().0;
        let blocks = self.first.as_chunks::<LANES>().0.iter();
        let blocks = blocks.zip(seconds).zip(self.reach.as_chunks::<LANES>().0);
        for (block, ((first, second), reach)) in blocks.enumerate() {
            if let Some(ahead) = seconds.get(block + AHEAD) {
                bring_near(position, ahead);
            }
            let (i, j) = (eight_of(position, first), eight_of(position, second));
            let mut apart = [Quad::<M>::splat(0.0); LANES];
            for lane in 0..LANES {
                apart[lane] = i[lane].quad() - j[lane].quad();
            }
            let (mut separation, _) = record::into_lanes::<M>(apart);
            // To the nearest image.
            let axial = separation.z.abs();
            separation.z = axial.min(whole - axial);
            let squared = separation.squared();
            let reach = Lanes::load(reach, 0) + skin;
            // Coincident centres have no normal.
            let near = squared.less(reach * reach) & Lanes::splat(0.0).less(squared);
            let window = found[end..].first_chunk_mut().expect("room for a block");
            near.write_down((block * LANES) as u32, window);
            end += near.count() as usize;
        }
        end
    }
}

/// A pair of the list whose spheres are in two sections.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    /// The section of its second sphere.
    pub(super) section: u16,
    /// Numbers of its spheres.
    pub(super) first: u32,
    pub(super) second: u32,
    /// Its place in the list.
    pub(super) at: u32,
}

/// A contact of the section's rows that has ended: the numbers of its spheres, and the energy that its tangential spring
/// had left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ended {
    pub(super) spheres: [u32; 2],
    pub(super) energy: f64,
}

/// The pairs of a section, and which of them touch.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    list: Flat,
    /// The place of each in the list of all.
    at: Vec<u32>,
    /// The pairs that may touch before others are chosen.
    pub(super) near: Flat,
    /// Which pair of the list each of them is.
    pub(super) number: Vec<u32>,
    /// The near pairs that touch, so many.
    touching: Vec<u32>,
    pub(super) contacts: usize,
    /// What contacts remember.
    pub(super) memory: Memory,
    /// Since the last evaluation; it adds up their energies.
    pub(super) ended: Vec<Ended>,
    /// Where there are several sections.
    pub(super) terms: RowTerms,
}

impl Pairs {
    /// Takes up `rows` of a list and, in its order, the pairs at the border whose second sphere is in the section.
    pub(super) fn load<H: Copy + Default + PartialEq>(
        &mut self,
        list: &Neighbours<H>,
        rows: impl Iterator<Item = usize>,
        borders: &[Border],
        spheres: &Spheres,
    ) {
        self.list.clear();
        self.at.clear();
        let mut borders = borders.iter().peekable();
        for row in rows {
            while let Some(border) = borders.next_if(|border| (border.first as usize) < row) {
                self.take_border(border, spheres);
            }
            let first = spheres.place[row] as usize;
            self.list.extend(first, list.partners(row), spheres);
            self.at.extend(list.range(row).map(|at| at as u32));
        }
        borders.for_each(|border| self.take_border(border, spheres));
        self.list.fill_up();
    }

    /// How many there are in the list.
    pub(super) fn listed(&self) -> usize {
        self.at.len()
    }

    fn take_border(&mut self, border: &Border, spheres: &Spheres) {
        let first = spheres.place[border.first as usize] as usize;
        self.list.extend(first, &[border.second], spheres);
        self.at.push(border.at);
    }

    /// Takes the histories of its pairs up from those of the rows.
    pub(super) fn take_up<T: PackedHistory>(&mut self, histories: &[T::History<f64>]) {
        self.memory.clear();
        for (k, &at) in (0..).zip(&self.at) {
            let history = &histories[at as usize];
            if *history != T::History::<f64>::default() {
                self.memory.push(k, T::pack(history));
            }
        }
    }

    /// Writes down the numbers of the spheres of the pairs that have a history.
    pub(super) fn note(&mut self, number: &[u32]) {
        let Self { list, memory, .. } = self;
        memory.note(|k| [list.first[k], list.second[k]].map(|place| number[place as usize]));
    }

    /// Finds these pairs in the section's part of a new list. A contact that is not in the list has ended, by a jump of its
    /// spheres.
    pub(super) fn find_again<T: PackedHistory>(
        &mut self,
        list: &Neighbours<T::History<f64>>,
        law: &T,
        place: &[u32],
        own: Own,
    ) {
        let Self {
            at, memory, ended, ..
        } = self;
        let mut k = 0;
        memory.find_again(|spheres, history| {
            let [first, second] = spheres;
            let Some(listed) = list.place(first, second) else {
                if own.holds(place[first as usize] as usize) {
                    ended.push(Ended::of(law, spheres, history));
                }
                return None;
            };
            while (at[k] as usize) < listed {
                k += 1;
            }
            Some(k as u32)
        });
    }

    /// Writes the histories of its own contacts to those of the rows, which are fresh.
    pub(super) fn store<T: PackedHistory>(&self, own: Own, histories: &mut [T::History<f64>]) {
        for (k, history) in self.memory.iter() {
            if own.holds(self.list.first[k] as usize) {
                histories[self.at[k] as usize] = T::unpack(history);
            }
        }
    }

    /// Makes them fresh again.
    pub(super) fn freshen<H: Default>(&self, histories: &mut [H]) {
        for (k, _) in self.memory.iter() {
            histories[self.at[k] as usize] = H::default();
        }
    }

    /// Finds the near pairs that touch.
    #[inline(always)]
    pub(super) fn find_contacts<M: Machine>(&mut self, position: &[Record], length: f64) {
        self.contacts = self
            .near
            .find::<M>(position, length, 0.0, &mut self.touching);
    }

    /// The near pairs of the contacts from `start` on; of the last eight, those to spare are the last once more.
    #[inline(always)]
    pub(super) fn eight_touching(&self, start: usize) -> [u32; LANES] {
        match self.whole_eight_touching(start) {
            Some(eight) => *eight,
            None => {
                core::array::from_fn(|lane| self.touching[(start + lane).min(self.contacts - 1)])
            }
        }
    }

    /// The same, where there are eight contacts from `start` on.
    #[inline(always)]
    pub(super) fn whole_eight_touching(&self, start: usize) -> Option<&[u32; LANES]> {
        self.touching[..self.contacts].get(start..)?.first_chunk()
    }

    /// Finds the histories of the pairs that touch, and ends those of the pairs that touch no more.
    #[inline(always)]
    pub(super) fn begin_contacts<T: PackedHistory>(&mut self, law: &T, own: Own, numbers: &[u32]) {
        let Self {
            list,
            number,
            touching,
            contacts,
            memory,
            ended,
            ..
        } = self;
        memory.begin(&touching[..*contacts], number, |k, history| {
            let [first, second] = [list.first[k], list.second[k]];
            if own.holds(first as usize) {
                let spheres = [first, second].map(|place| numbers[place as usize]);
                ended.push(Ended::of(law, spheres, history));
            }
        });
    }
}

impl Ended {
    fn of<T: PackedHistory>(law: &T, spheres: [u32; 2], history: &Packed) -> Self {
        let energy = law.stored_energy::<f64>(&T::unpack(history));
        Self { spheres, energy }
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
            list,
            near,
            number,
            memory,
            ..
        } = self.pairs;
        let chosen = list.find::<M>(self.position, self.length, self.skin, number);
        near.clear();
        let chosen = number[..chosen].iter().map(|&k| k as usize);
        near.first.extend(chosen.clone().map(|k| list.first[k]));
        near.second.extend(chosen.clone().map(|k| list.second[k]));
        near.reach.extend(chosen.map(|k| list.reach[k]));
        near.fill_up();
        // No more of them can touch, so that warm steps take no memory.
        memory.reserve(near.first.capacity());
    }
}
