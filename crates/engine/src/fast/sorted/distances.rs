//! Distances of the pairs that may touch, eight at a time.
//!
//! The roots of many pairs are taken one after another: each waits for long, none for another.

use peristalsis_physics::real::Real;

use crate::fast::lanes::{LANES, Lanes};
use crate::fast::machine::Machine;

/// Squared distance \[d^2\] below which two centres count as one, and have no normal.
const COINCIDENT: f64 = 1e-30;

/// Eights of pairs.
#[derive(Debug, Default)]
pub(super) struct Distances {
    eights: Vec<Eight>,
    number: usize,
}

/// Eight pairs: first their squared distances, then how far they overlap and the inverse of the distance.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Eight {
    overlap: [f64; LANES],
    inverse: [f64; LANES],
}

impl Distances {
    /// Begins anew, with room for so many eights.
    pub(super) fn clear(&mut self, room: usize) {
        self.number = 0;
        if self.eights.len() < room {
            self.eights.resize(room, Eight::default());
        }
    }

    /// How many eights there are.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// Writes down squared distances, `ahead` eights behind those that are kept.
    #[inline(always)]
    pub(super) fn note<M: Machine>(&mut self, ahead: usize, squared: Lanes<M>) {
        let eight = &mut self.eights[self.number + ahead];
        squared.store(&mut eight.overlap, 0);
    }

    /// Keeps so many more of the eights that were written down.
    #[inline(always)]
    pub(super) fn keep(&mut self, more: usize) {
        self.number += more;
    }

    /// From the squared distances to the overlaps and inverse distances of those that are nearer than `reach`, and zeros
    /// for the others; how many touch.
    #[inline(always)]
    pub(super) fn take_roots<M: Machine, const COUNT: bool>(&mut self, reach: f64) -> u64 {
        let (reach, zero) = (Lanes::<M>::splat(reach), Lanes::splat(0.0));
        let reach_squared = reach * reach;
        let mut touch = 0;
        for eight in &mut self.eights[..self.number] {
            let squared = Lanes::from_array(&eight.overlap);
            let touches = squared.less(reach_squared) & Lanes::splat(COINCIDENT).less(squared);
            let inverse = squared.reciprocal_sqrt();
            let overlap = Lanes::select(touches, reach - squared * inverse, zero);
            overlap.store(&mut eight.overlap, 0);
            Lanes::select(touches, inverse, zero).store(&mut eight.inverse, 0);
            if COUNT {
                touch += touches.count();
            }
        }
        touch
    }

    /// Overlaps and inverse distances of an eight.
    #[inline(always)]
    pub(super) fn get<M: Machine>(&self, eight: usize) -> (Lanes<M>, Lanes<M>) {
        let Eight { overlap, inverse } = &self.eights[eight];
        (Lanes::from_array(overlap), Lanes::from_array(inverse))
    }
}
