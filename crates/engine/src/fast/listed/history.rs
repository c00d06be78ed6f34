//! Histories of contacts, as the fast kernel keeps them.

use peristalsis_physics::contact::{CundallStrack, Frictionless, TangentialHistory, TangentialLaw};
use peristalsis_physics::real::Real;

use super::record::{self, Record};
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Machine, eight_of};

/// A history in eight numbers.
pub(crate) type Packed = [Record; 2];

/// Histories of the pairs that touched at the last evaluation, one after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// Which pairs of the list they are, in order.
    touched: Vec<u32>,
    before: Vec<Packed>,
    /// Where the history of each contact of an evaluation is among those before; filled up to whole eights.
    from: Vec<u32>,
    /// With what history the evaluation leaves each contact; filled up likewise.
    after: Vec<Packed>,
    /// Room: the pairs that touch.
    now: Vec<u32>,
    /// From one list to the next: the spheres of each pair.
    spheres: Vec<[u32; 2]>,
}

impl Memory {
    pub(super) fn clear(&mut self) {
        self.touched.clear();
        self.before.clear();
    }

    /// Remembers a pair behind all others.
    pub(super) fn push(&mut self, pair: u32, history: Packed) {
        self.touched.push(pair);
        self.before.push(history);
    }

    /// Which pairs of the list are remembered, and how.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Packed)> {
        let pairs = self.touched.iter().map(|&pair| pair as usize);
        pairs.zip(&self.before)
    }

    /// Makes room for so many contacts.
    pub(super) fn reserve(&mut self, contacts: usize) {
        let room = contacts + LANES;
        for numbers in [&mut self.touched, &mut self.from, &mut self.now] {
            numbers.reserve(room.saturating_sub(numbers.len()));
        }
        for histories in [&mut self.before, &mut self.after] {
            histories.reserve(room.saturating_sub(histories.len()));
        }
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
            before,
            after,
            spheres,
            ..
        } = self;
        touched.clear();
        after.clear();
        for (&spheres, history) in spheres.iter().zip(&*before) {
            if let Some(pair) = pair(spheres, history) {
                touched.push(pair);
                after.push(*history);
            }
        }
        core::mem::swap(before, after);
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
            before,
            from,
            after,
            now,
            ..
        } = self;
        before.truncate(touched.len());
        let fresh = touched.len() as u32;
        touched.push(u32::MAX);
        now.clear();
        from.clear();
        let mut old = 0;
        let mut find = |pair: u32, old: &mut usize| {
            while touched[*old] < pair {
                ended(touched[*old] as usize, &before[*old]);
                *old += 1;
            }
            let remembered = touched[*old] == pair;
            let own = if remembered { *old as u32 } else { fresh };
            *old += usize::from(remembered);
            own
        };
        let (eights, rest) = touching.as_chunks::<LANES>();
        for eight in eights {
            let pairs = eight_of(numbers, eight).map(|&pair| pair);
            now.extend(pairs);
            // Mostly the same eight touched before.
            from.extend(match touched[old..].first_chunk() == Some(&pairs) {
                true => {
                    let first = old as u32;
                    old += LANES;
                    core::array::from_fn(|lane| first + lane as u32)
                }
                false => pairs.map(|pair| find(pair, &mut old)),
            });
        }
        for &at in rest {
            let pair = numbers[at as usize];
            now.push(pair);
            from.push(find(pair, &mut old));
        }
        for (&pair, history) in touched[old..].iter().zip(&before[old..]) {
            ended(pair as usize, history);
        }
        before.push(Packed::default());
        from.resize(from.len().next_multiple_of(LANES), fresh);
        after.resize(from.len(), Packed::default());
        core::mem::swap(touched, now);
    }

    /// After an evaluation.
    pub(super) fn end(&mut self) {
        core::mem::swap(&mut self.before, &mut self.after);
    }
}

/// A tangential law whose histories can be packed, and turned into lanes and back.
pub(crate) trait PackedHistory: TangentialLaw {
    fn pack(history: &Self::History<f64>) -> [Record; 2];

    fn unpack(packed: &[Record; 2]) -> Self::History<f64>;

    /// The histories of the eight contacts from `start` on, as they were before the evaluation.
    fn recall<M: Machine>(memory: &Memory, start: usize) -> Self::History<Lanes<M>>;

    /// Keeps the histories of the eight contacts from `start` on.
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
        let packed = eight_of(&memory.before, from);
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
        let after = memory.after[start..].first_chunk_mut::<LANES>();
        for (lane, packed) in after.expect("whole eights").iter_mut().enumerate() {
            *packed = [first[lane].record(), second[lane].record()];
        }
    }
}
