//! Squared distances of the pairs that may touch, eight at a time.

use peristalsis_physics::real::Real;

use crate::fast::lanes::{Lanes, Mask};
use crate::fast::machine::{Line, Machine};

/// Squared distance \[d^2\] below which two centres count as one, and have no normal.
const COINCIDENT: f64 = 1e-30;

/// Squared distances \[d^2\].
#[derive(Debug, Default)]
pub(super) struct Distances {
    eights: Vec<Line>,
    number: usize,
}

/// Eight pairs, some of which touch.
pub(super) struct Near<M: Machine> {
    pub(super) touch: Mask<M>,
    /// Zero for those that do not touch, as is the next.
    pub(super) overlap: Lanes<M>,
    /// 1/distance
    pub(super) inverse: Lanes<M>,
}

impl Distances {
    /// Begins anew, with room for so many eights.
    pub(super) fn clear(&mut self, room: usize) {
        self.number = 0;
        if self.eights.len() < room {
            self.eights.resize(room, Line::default());
        }
    }

    /// How many eights there are.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// Writes down squared distances, `ahead` eights behind those that are kept.
    #[inline(always)]
    pub(super) fn note<M: Machine>(&mut self, ahead: usize, squared: Lanes<M>) {
        let Line(numbers) = &mut self.eights[self.number + ahead];
        squared.store(numbers, 0);
    }

    /// Keeps so many more of the eights that were written down.
    #[inline(always)]
    pub(super) fn keep(&mut self, more: usize) {
        self.number += more;
    }

    /// An eight; those pairs touch that are nearer than `reach`.
    // V8 has few registers: with roots and law in one loop it moves numbers to the stack and back, so a call is faster there.
    #[cfg_attr(target_family = "wasm", inline(never))]
    #[cfg_attr(not(target_family = "wasm"), inline(always))]
    pub(super) fn near<M: Machine>(&self, eight: usize, reach: f64) -> Near<M> {
        let squared = Lanes::from_array(&self.eights[eight].0);
        let (reach, zero) = (Lanes::splat(reach), Lanes::splat(0.0));
        let touch = squared.less(reach * reach) & Lanes::splat(COINCIDENT).less(squared);
        let inverse = squared.reciprocal_sqrt();
        Near {
            touch,
            overlap: Lanes::select(touch, reach - squared * inverse, zero),
            inverse: Lanes::select(touch, inverse, zero),
        }
    }
}
