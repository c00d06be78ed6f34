//! Histories of contacts, as the fast kernel keeps them.

use peristalsis_physics::contact::{CundallStrack, Frictionless, TangentialHistory, TangentialLaw};
use peristalsis_physics::real::Real;

use super::record::{self, Record};
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{self, Machine, eight_of};

/// A history in eight numbers.
pub(crate) type Packed = [Record; 2];

/// Histories of the pairs that touched at the last evaluation, one after the other.
///
/// An evaluation writes each history somewhat before the place where it read it, into lines that are at hand: it never
/// overwrites a history that is still to be read. When they have come to the start of their room, they are moved to its end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// Which pairs of the list they are, in order.
    touched: Vec<u32>,
    /// Room for the histories.
    histories: Vec<Packed>,
    /// Where the first of them is.
    first: usize,
    /// Where the history of each contact of an evaluation was before; filled up to whole eights.
    from: Vec<u32>,
    /// Room: the pairs that touch.
    now: Vec<u32>,
    /// From one list to the next: the spheres of each pair.
    spheres: Vec<[u32; 2]>,
}

impl Memory {
    pub(super) fn clear(&mut self) {
        self.touched.clear();
        self.histories.clear();
        self.first = 0;
    }

    /// Remembers a pair behind all others, before the first evaluation.
    pub(super) fn push(&mut self, pair: u32, history: Packed) {
        self.touched.push(pair);
        self.histories.push(history);
    }

    /// Which pairs of the list are remembered, and how.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Packed)> {
        let pairs = self.touched.iter().map(|&pair| pair as usize);
        pairs.zip(&self.histories[self.first..])
    }

    /// Makes room for so many contacts.
    pub(super) fn reserve(&mut self, contacts: usize) {
        let room = contacts + LANES;
        for numbers in [&mut self.touched, &mut self.from, &mut self.now] {
            numbers.reserve(room.saturating_sub(numbers.len()));
        }
        let room = (2 * room).saturating_sub(self.histories.len());
        self.histories.reserve(room);
    }

    /// Writes down the spheres of the pairs.
    pub(super) fn note(&mut self, spheres: impl Fn(usize) -> [u32; 2]) {
        self.spheres.clear();
        let pairs = self.touched.iter().map(|&pair| pair as usize);
        self.spheres.extend(pairs.map(spheres));
    }

    /// Finds each of them among the pairs of a new list, or forgets it.
    pub(super) fn find_again(&mut self, mut pair: impl FnMut([u32; 2], &Packed) -> Option<u32>) {
        let Self {
            touched,
            histories,
            first,
            spheres,
            ..
        } = self;
        touched.clear();
        for (at, &spheres) in (*first..).zip(&*spheres) {
            let history = histories[at];
            if let Some(pair) = pair(spheres, &history) {
                histories[*first + touched.len()] = history;
                touched.push(pair);
            }
        }
    }

    /// Before an evaluation: finds the history of each pair that touches, and tells of those that touch no more. Pairs are
    /// those of `numbers` that `touching` chooses, in order.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        touching: &[u32],
        numbers: &[u32],
        mut ended: impl FnMut(usize, &Packed),
    ) {
        let Self {
            touched,
            histories,
            first,
            from,
            now,
            ..
        } = self;
        let before = *first;
        // Behind the histories stands a fresh one.
        let fresh = before + touched.len();
        if histories.len() <= fresh {
            histories.resize(fresh + 1, Packed::default());
        }
        histories[fresh] = Packed::default();
        touched.push(u32::MAX);
        now.clear();
        from.clear();
        let (mut old, mut begun) = (0, 0);
        let mut find = |pair: u32, old: &mut usize| {
            while touched[*old] < pair {
                ended(touched[*old] as usize, &histories[before + *old]);
                *old += 1;
            }
            let remembered = touched[*old] == pair;
            let at = if remembered { before + *old } else { fresh };
            *old += usize::from(remembered);
            begun += usize::from(!remembered);
            at as u32
        };
        let (eights, rest) = touching.as_chunks::<LANES>();
        for eight in eights {
            let pairs = eight_of(numbers, eight).map(|&pair| pair);
            now.extend(pairs);
            // Mostly the same eight touched before.
            from.extend(match touched[old..].first_chunk() == Some(&pairs) {
                true => {
                    let at = (before + old) as u32;
                    old += LANES;
                    core::array::from_fn(|lane| at + lane as u32)
                }
                false => pairs.map(|pair| find(pair, &mut old)),
            });
        }
        for &at in rest {
            let pair = numbers[at as usize];
            now.push(pair);
            from.push(find(pair, &mut old));
        }
        for (&pair, history) in touched[old..].iter().zip(&histories[before + old..fresh]) {
            ended(pair as usize, history);
        }
        from.resize(from.len().next_multiple_of(LANES), fresh as u32);
        core::mem::swap(touched, now);
        // Of the contacts worked out so far all but `begun` at most have read a history. Written so far ahead, they and the
        // eight that are written at once end before the next history to be read.
        let ahead = begun + LANES;
        if ahead > before {
            let remembered = fresh - before;
            let room = histories.len().max(ahead + remembered + remembered / 4 + 1);
            histories.resize(room, Packed::default());
            let by = histories.len() - 1 - fresh;
            histories.copy_within(before..=fresh, before + by);
            from.iter_mut().for_each(|at| *at += by as u32);
            *first += by;
        }
        *first -= ahead;
    }

    /// Asks that the histories of the eight contacts from `start` on, if there are any, be brought near.
    #[inline(always)]
    pub(super) fn bring_near(&self, start: usize) {
        if let Some(from) = self.from.get(start..).and_then(<[u32]>::first_chunk) {
            machine::bring_near(&self.histories, from);
        }
    }
}

/// A tangential law whose histories can be packed, and turned into lanes and back.
pub(crate) trait PackedHistory: TangentialLaw {
    fn pack(history: &Self::History<f64>) -> [Record; 2];

    fn unpack(packed: &[Record; 2]) -> Self::History<f64>;

    /// The histories of the eight contacts from `start` on, as they were before.
    fn recall<M: Machine>(memory: &Memory, start: usize) -> Self::History<Lanes<M>>;

    /// Keeps the histories of the eight contacts from `start` on, after those before them.
    fn keep<M: Machine>(history: &Self::History<Lanes<M>>, memory: &mut Memory, start: usize);
}

impl PackedHistory for Frictionless {
    fn pack((): &()) -> Packed {
        Packed::default()
    }

    fn unpack(_: &Packed) {}

    #[inline(always)]
    fn recall<M: Machine>(_: &Memory, _: usize) {}

    #[inline(always)]
    fn keep<M: Machine>((): &(), _: &mut Memory, _: usize) {}
}

impl PackedHistory for CundallStrack {
    fn pack(history: &TangentialHistory) -> Packed {
        [
            Record::new(history.displacement, history.power),
            Record::new(history.rate, f64::from(history.sliding)),
        ]
    }

    fn unpack([first, second]: &Packed) -> TangentialHistory {
        TangentialHistory {
            displacement: first.vector(),
            rate: second.vector(),
            power: first.0[3],
            sliding: second.0[3] > 0.0,
        }
    }

    #[inline(always)]
    fn recall<M: Machine>(memory: &Memory, start: usize) -> TangentialHistory<Lanes<M>> {
        let mut first = [Quad::<M>::splat(0.0); LANES];
        let mut second = first;
        let from = memory.from[start..].first_chunk().expect("whole eights");
        let packed = eight_of(&memory.histories, from);
        for lane in 0..LANES {
            let [one, other] = packed[lane];
            first[lane] = one.quad();
            second[lane] = other.quad();
        }
        let (displacement, power) = record::into_lanes::<M>(first);
        let (rate, sliding) = record::into_lanes::<M>(second);
        TangentialHistory {
            displacement,
            rate,
            power,
            sliding: Lanes::splat(0.0).less(sliding),
        }
    }

    #[inline(always)]
    fn keep<M: Machine>(history: &TangentialHistory<Lanes<M>>, memory: &mut Memory, start: usize) {
        let sliding = Lanes::select(history.sliding, Lanes::splat(1.0), Lanes::splat(0.0));
        let first = record::from_lanes(history.displacement, history.power);
        let second = record::from_lanes(history.rate, sliding);
        let eight = memory.histories[memory.first + start..].first_chunk_mut::<LANES>();
        for (lane, packed) in eight.expect("room for eight").iter_mut().enumerate() {
            *packed = [first[lane].record(), second[lane].record()];
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Each pair counts, in its history, for how many evaluations in a row it has touched.
        #[test]
        fn histories_follow_their_pairs_however_many_begin_and_end(
            evaluations in prop::collection::vec(prop::collection::btree_set(0_u32..200, 0..150), 1..40),
            room in 0_usize..150,
        ) {
            let numbers: Vec<u32> = (0..200).collect();
            let mut memory = Memory::default();
            memory.reserve(room);
            let mut expected = BTreeMap::new();
            for touching in evaluations {
                let touching: Vec<u32> = touching.into_iter().collect();
                let mut ended = BTreeMap::new();
                memory.begin(&touching, &numbers, |pair, history| {
                    ended.insert(pair as u32, history[0].0[0]);
                });
                for start in (0..touching.len()).step_by(LANES) {
                    let from = memory.from[start..].first_chunk::<LANES>().expect("whole eights");
                    let before = from.map(|at| memory.histories[at as usize][0].0[0]);
                    for (lane, before) in before.into_iter().enumerate() {
                        memory.histories[memory.first + start + lane] = [Record([before + 1.0; 4]); 2];
                    }
                }
                let now: BTreeMap<u32, f64> = touching
                    .iter()
                    .map(|&pair| (pair, expected.remove(&pair).unwrap_or(0.0) + 1.0))
                    .collect();
                prop_assert_eq!(ended, expected);
                let kept = memory.iter().map(|(pair, history)| (pair as u32, history[0].0[0]));
                prop_assert_eq!(kept.collect::<BTreeMap<_, _>>(), now.clone());
                expected = now;
            }
        }
    }
}
