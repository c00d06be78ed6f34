//! Tiles: stretches of grains that are worked on together, and what is known of each.

use rayon::prelude::*;

use super::strips::AHEAD;
use crate::fast::columns::{Columns, ColumnsMut};
use crate::fast::lanes::LANES;
use crate::ledger::Tally;

/// Grains in a tile, a multiple of the number of lanes.
pub(super) const TILE: usize = 128;

/// Tiles that a thread takes at a time: few, so that threads end together, for one that waits long falls asleep.
pub(super) const AT_A_TIME: usize = 8;
/// The same where there is little to do with each.
pub(super) const OF_LIGHT_WORK: usize = 4 * AT_A_TIME;

/// A stretch of a strip whose forces are added up together, with the pairs that begin there.
#[derive(Clone, Debug, Default)]
pub(super) struct Tile {
    pub(super) strip: usize,
    pub(super) first: usize,
    pub(super) end: usize,
    /// The stretches that its forces fall on: its own, and those in the strips ahead.
    pub(super) windows: [Window; 1 + AHEAD],
    /// The partners of its blocks, window after window, block after block.
    pub(super) partners: Vec<Partners>,
    /// Ends of the partners of each block.
    pub(super) ends: Vec<u32>,
    /// Windows that are in use.
    pub(super) used: usize,
}

/// A stretch of places, and the place of its forces among the forces of the tile.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Window {
    pub(super) first: usize,
    pub(super) length: usize,
    pub(super) base: usize,
}

/// Eight partners of a block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Partners {
    /// Their first place.
    pub(super) start: u32,
    /// Place of their force among the forces of the tile.
    pub(super) force: u32,
}

impl Tile {
    /// Places, as the tile counts them, over all its windows.
    pub(super) fn room(&self) -> usize {
        self.windows()
            .last()
            .map_or(0, |last| last.base + last.length)
    }

    pub(super) fn windows(&self) -> &[Window] {
        &self.windows[..self.used]
    }

    /// How many partners are listed.
    pub(super) fn listed(&self) -> usize {
        self.partners.len()
    }

    /// The partners of the block that begins at `place`.
    #[inline(always)]
    pub(super) fn partners(&self, place: usize) -> &[Partners] {
        let block = (place - self.first) / LANES;
        let begin = if block == 0 { 0 } else { self.ends[block - 1] };
        &self.partners[begin as usize..self.ends[block] as usize]
    }
}

/// The forces that the contacts of a tile's grains exert, window after window, and their sums.
#[derive(Clone, Debug, Default)]
pub(super) struct OfTile {
    pub(super) force: Columns,
    pub(super) tally: Tally,
}

/// Displacements of a drift.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moved {
    /// Least and largest displacement along z since the last sorting \[d\].
    pub(super) least: f64,
    pub(super) largest: f64,
    /// Largest squared displacement across the tube in this step \[d^2\].
    pub(super) lateral_squared: f64,
    /// Place in the stretch of a grain that moved too far, and how far.
    pub(super) runaway: Option<(usize, f64)>,
}

impl Columns {
    pub(super) fn tiles(&mut self) -> impl Iterator<Item = ColumnsMut<'_>> {
        let z = self.z.chunks_mut(TILE);
        let xy = self.x.chunks_mut(TILE).zip(self.y.chunks_mut(TILE));
        xy.zip(z).map(|((x, y), z)| ColumnsMut { x, y, z })
    }

    pub(super) fn par_tiles(&mut self) -> impl IndexedParallelIterator<Item = ColumnsMut<'_>> {
        let z = self.z.par_chunks_mut(TILE);
        let xy = self.x.par_chunks_mut(TILE).zip(self.y.par_chunks_mut(TILE));
        xy.zip(z).map(|((x, y), z)| ColumnsMut { x, y, z })
    }
}
