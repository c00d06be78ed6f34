//! The places of the grains, strip by strip, and the keys that they are sorted by.

use super::tile::TILE;

/// z of a grain, and the place where it stood before.
pub(super) type Key = (f64, u32);

/// Grains that a thread brings into order at a time.
pub(super) const PIECE: usize = 32 * TILE;

/// z of places that hold no grain: out of reach of everything.
pub(super) const NOWHERE: f64 = 1e30;

/// The places of a strip: its grains in the order of z, between copies of its last and first grains, a period away.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// Place of the first grain.
    pub(super) first: usize,
    pub(super) grains: usize,
    /// Copies before the grains.
    pub(super) before: usize,
    /// Copies behind them.
    pub(super) behind: usize,
}

impl Row {
    /// Places of the grains.
    pub(super) fn own(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.grains
    }

    /// Places of grains and copies.
    pub(super) fn places(&self) -> core::ops::Range<usize> {
        self.first - self.before..self.first + self.grains + self.behind
    }

    /// Each copy: which place it is a copy of, its own, and how far it is from there along z.
    pub(super) fn copies(&self, length: f64) -> impl Iterator<Item = (usize, usize, f64)> {
        let (first, end) = (self.first, self.first + self.grains);
        let before = (first - self.before..first).map(move |to| (to + end - first, to, -length));
        let behind = (end..end + self.behind).map(move |to| (to + first - end, to, length));
        before.chain(behind)
    }
}

/// Room to make an order in.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// The order that is being made.
    pub(super) keys: Vec<Key>,
    /// How many grains of each strip come from beyond the end of the tube, from within, from before its beginning; then
    /// where the next of them goes.
    pub(super) counts: Vec<[u32; 3]>,
    /// The first of these for each piece of the one row of a narrow tube, where there are threads.
    pub(super) of_pieces: Vec<[u32; 3]>,
    pub(super) column: Vec<f64>,
    pub(super) order: Vec<u32>,
    pub(super) turns: Vec<i32>,
}
