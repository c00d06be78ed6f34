//! The listed pairs of the spheres of a section, and which of them touch.
//!
//! A pair across the border of two sections is in both. One pass over the pairs writes down which of them touch; the law is
//! then evaluated for those only ([`super::contacts`]), in the order of the list. Which pairs touch does not depend on the other pairs of the list, so neither do the results.

use core::ops::Range;

use peristalsis_physics::real::Real;

use super::history::{Memory, Packed, PackedHistory};
use super::record::{self, Record};
use super::spheres::{Own, Spheres};
use super::terms::RowTerms;
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
    /// Distance below which a pair touches, with a minus where its second sphere is one of the wall.
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
        let diameter = |place: usize| spheres.turning[place].0[3];
        let own = diameter(first).abs();
        self.first
            .resize(self.first.len() + second.len(), first as u32);
        let second = second.iter().map(|&number| spheres.place[number as usize]);
        self.second.extend(second.clone());
        let reaches = second.map(|place| {
            let other = diameter(place as usize);
            (0.5 * (own + other.abs())).copysign(other)
        });
        self.reach.extend(reaches);
    }

    fn fill_up(&mut self) {
        let whole = self.first.len().next_multiple_of(LANES);
        self.first.resize(whole, 0);
        self.second.resize(whole, 0);
        self.reach.resize(whole, 0.0);
    }

    /// Finds the pairs that are closer than their reach and the skin of a pair with a grain, or with a sphere of the wall.
    #[inline(always)]
    fn find<M: Machine>(
        &self,
        position: &[Record],
        length: f64,
        skins: [f64; 2],
        found: &mut Found,
    ) {
        let Found {
            pairs,
            number,
            eights,
        } = found;
        let room = self.first.len() + LANES;
        if pairs.len() < room {
            pairs.resize(room, 0);
            eights.resize(room / LANES, (0, 0));
        }
        let mut end = 0;
        let (zero, whole) = (Lanes::splat(0.0), Lanes::splat(length));
        let [skin, skin_at_wall] = skins.map(Lanes::splat);
        let seconds = self.second.as_chunks::<LANES>().0;
        let blocks = self.first.as_chunks::<LANES>().0.iter();
        let blocks = blocks.zip(seconds).zip(self.reach.as_chunks::<LANES>().0);
        for (block, (((first, second), reach), eight)) in blocks.zip(&mut *eights).enumerate() {
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
            let reach = Lanes::load(reach, 0);
            let skin = Lanes::select(reach.less(zero), skin_at_wall, skin);
            let reach = reach.abs() + skin;
            // Coincident centres have no normal.
            let near = squared.less(reach * reach) & zero.less(squared);
            let window = pairs[end..].first_chunk_mut().expect("room for a block");
            near.write_down((block * LANES) as u32, window);
            *eight = (end as u32, near.to_bits());
            end += near.count() as usize;
        }
        eights[seconds.len()] = (end as u32, 0);
        *number = end;
    }
}

/// The pairs of a [`Flat`] that were found, in order.
#[derive(Clone, Debug, Default)]
struct Found {
    /// Their places in it; behind them are others.
    pairs: Vec<u32>,
    number: usize,
    /// Of each eight pairs how many were found before them, and which of them were, a bit for each. One more stands behind,
    /// and then others.
    eights: Vec<(u32, u8)>,
}

impl Found {
    fn all(&self) -> &[u32] {
        &self.pairs[..self.number]
    }

    /// How many of the first so many pairs were found.
    fn of_first(&self, pairs: usize) -> usize {
        let (before, found) = self.eights[pairs / LANES];
        let those = found & ((1 << (pairs % LANES)) - 1);
        before as usize + those.count_ones() as usize
    }

    /// Which of those found are of these pairs.
    fn of(&self, pairs: &Range<usize>) -> Range<usize> {
        self.of_first(pairs.start)..self.of_first(pairs.end)
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
    /// The pairs that may touch before others are chosen, and which of the list they are.
    pub(super) near: Flat,
    chosen: Found,
    /// Which of the near pairs touch.
    touching: Found,
    /// The pairs of each run of the section's rows: in the list, and of those near.
    listed_runs: Vec<Range<usize>>,
    near_runs: Vec<Range<usize>>,
    /// What contacts remember.
    pub(super) memory: Memory,
    /// Since the last evaluation; it adds up their energies.
    pub(super) ended: Vec<Ended>,
    /// Where there are several sections.
    pub(super) terms: RowTerms,
}

impl Pairs {
    /// Takes up the rows of a list for the spheres at the places of `runs`, which follow each other in the list, and, in its
    /// order, the pairs at the border whose second sphere is in the section.
    pub(super) fn load<H: Copy + Default + PartialEq>(
        &mut self,
        list: &Neighbours<H>,
        runs: impl Iterator<Item = Range<usize>>,
        borders: &[Border],
        spheres: &Spheres,
    ) {
        self.list.clear();
        self.at.clear();
        self.listed_runs.clear();
        let mut borders = borders.iter().peekable();
        for run in runs {
            // The wall's spheres may have no rows.
            let numbers = &spheres.number[run.clone()];
            let rows = numbers.partition_point(|&number| (number as usize) < list.rows());
            if let Some(&row) = numbers[..rows].first() {
                while let Some(border) = borders.next_if(|border| border.first < row) {
                    self.take_border(border, spheres);
                }
            }
            let begin = self.at.len();
            for (first, &row) in run.zip(&numbers[..rows]) {
                self.list
                    .extend(first, list.partners(row as usize), spheres);
                self.at.extend(list.range(row as usize).map(|at| at as u32));
            }
            self.listed_runs.push(begin..self.at.len());
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
        let touching = &mut self.touching;
        self.near.find::<M>(position, length, [0.0; 2], touching);
    }

    /// How many near pairs touch.
    pub(super) fn contacts(&self) -> usize {
        self.touching.number
    }

    /// Which of the contacts are of each run of rows.
    pub(super) fn contacts_of_runs(&self) -> impl Iterator<Item = Range<usize>> {
        self.near_runs.iter().map(|near| self.touching.of(near))
    }

    /// The near pairs of the contacts from `start` on; of the last eight, those to spare are the last once more.
    #[inline(always)]
    pub(super) fn eight_touching(&self, start: usize) -> [u32; LANES] {
        match self.whole_eight_touching(start) {
            Some(eight) => *eight,
            None => {
                let last = self.contacts() - 1;
                core::array::from_fn(|lane| self.touching.pairs[(start + lane).min(last)])
            }
        }
    }

    /// The same, where there are eight contacts from `start` on.
    #[inline(always)]
    pub(super) fn whole_eight_touching(&self, start: usize) -> Option<&[u32; LANES]> {
        self.touching.all().get(start..)?.first_chunk()
    }

    /// Finds the histories of the pairs that touch, and ends those of the pairs that touch no more.
    #[inline(always)]
    pub(super) fn begin_contacts<T: PackedHistory>(&mut self, law: &T, own: Own, numbers: &[u32]) {
        let Self {
            list,
            chosen,
            touching,
            memory,
            ended,
            ..
        } = self;
        memory.begin(touching.all(), &chosen.pairs, |k, history| {
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

/// Chooses from the list the pairs that are closer than their reach and a skin.
pub(super) struct Prune<'a> {
    pub(super) pairs: &'a mut Pairs,
    pub(super) position: &'a [Record],
    pub(super) length: f64,
    /// Of pairs with a grain, and with a sphere of the wall.
    pub(super) skins: [f64; 2],
}

impl Work for Prune<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Pairs {
            list,
            near,
            chosen,
            listed_runs,
            near_runs,
            memory,
            ..
        } = self.pairs;
        list.find::<M>(self.position, self.length, self.skins, chosen);
        near.clear();
        let pairs = chosen.all().iter().map(|&k| k as usize);
        near.first.extend(pairs.clone().map(|k| list.first[k]));
        near.second.extend(pairs.clone().map(|k| list.second[k]));
        near.reach.extend(pairs.map(|k| list.reach[k]));
        near.fill_up();
        near_runs.clear();
        near_runs.extend(listed_runs.iter().map(|run| chosen.of(run)));
        // No more of them can touch, so that warm steps take no memory.
        memory.reserve(near.first.capacity());
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::fast::machine::Instructions;

    struct Find<'a>(&'a Flat, &'a [Record], &'a mut Found);

    impl Work for Find<'_> {
        type Answer = ();

        #[inline(always)]
        fn run<M: Machine>(self) {
            let Self(flat, position, found) = self;
            flat.find::<M>(position, 1000.0, [0.0; 2], found);
        }
    }

    proptest! {
        /// Twice in the same room, with more pairs and with fewer.
        #[test]
        fn it_is_known_how_many_of_the_first_pairs_were_found(
            lists in prop::array::uniform2(prop::collection::vec(prop::bool::ANY, 0..70)),
        ) {
            let position: Vec<Record> = [0.0, 0.5, 5.0].map(|z| Record([0.0, 0.0, z, 0.0])).into();
            let mut found = Found::default();
            for near in lists {
                let mut flat = Flat {
                    first: vec![0; near.len()],
                    second: near.iter().map(|&near| if near { 1 } else { 2 }).collect(),
                    reach: vec![1.0; near.len()],
                };
                flat.fill_up();
                Instructions::default().run(Find(&flat, &position, &mut found));
                let expected = (0..).zip(&near).filter_map(|(pair, &near)| near.then_some(pair));
                let expected: Vec<u32> = expected.collect();
                prop_assert_eq!(found.all(), &expected[..]);
                for pairs in 0..=near.len() {
                    let before = expected.iter().filter(|&&pair| (pair as usize) < pairs);
                    prop_assert_eq!(found.of_first(pairs), before.count());
                }
            }
        }
    }
}
