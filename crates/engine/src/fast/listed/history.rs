//! Histories of contacts, as the fast kernel keeps them.

use peristalsis_physics::contact::{CundallStrack, Frictionless, TangentialHistory, TangentialLaw};
use peristalsis_physics::real::Real;

use super::record::{self, Record};
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Machine, eight_of};

/// A history in eight numbers.
pub(crate) type Packed = [Record; 2];

/// A tangential law whose histories can be packed, and turned into lanes and back.
pub(crate) trait PackedHistory: TangentialLaw {
    fn pack(history: &Self::History<f64>) -> [Record; 2];

    fn unpack(packed: &[Record; 2]) -> Self::History<f64>;

    /// Histories of a list, side by side.
    fn into_lanes<M: Machine>(packed: &[Packed], at: &[u32; LANES]) -> Self::History<Lanes<M>>;

    /// Packs the histories of the first so many lanes into the list.
    fn from_lanes<M: Machine>(history: &Self::History<Lanes<M>>, packed: &mut [Packed], at: &[u32]);
}

impl PackedHistory for Frictionless {
    fn pack((): &()) -> Packed {
        Packed::default()
    }

    fn unpack(_: &Packed) {}

    #[inline(always)]
    fn into_lanes<M: Machine>(_: &[Packed], _: &[u32; LANES]) {}

    #[inline(always)]
    fn from_lanes<M: Machine>((): &(), _: &mut [Packed], _: &[u32]) {}
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
    fn into_lanes<M: Machine>(packed: &[Packed], at: &[u32; LANES]) -> TangentialHistory<Lanes<M>> {
        let mut first = [Quad::<M>::splat(0.0); LANES];
        let mut second = first;
        let packed = eight_of(packed, at);
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
    fn from_lanes<M: Machine>(
        history: &TangentialHistory<Lanes<M>>,
        packed: &mut [Packed],
        at: &[u32],
    ) {
        let sliding = Lanes::select(history.sliding, Lanes::splat(1.0), Lanes::splat(0.0));
        let first = record::from_lanes(history.displacement, history.power);
        let second = record::from_lanes(history.rate, sliding);
        for (lane, &at) in at.iter().enumerate() {
            packed[at as usize] = [first[lane].record(), second[lane].record()];
        }
    }
}
