//! Which blocks of grains may touch which, until the grains are sorted again.
//!
//! A block is eight grains that follow one another in a strip. Against it stand eight places that follow one another,
//! in the same strip or in one ahead: lane k meets the k-th of them. A start is listed if any of its eight pairs may
//! come to touch.

use peristalsis_physics::real::Real;
use rayon::prelude::*;

use super::columns::Columns;
use super::order::Row;
use super::strips::{AHEAD, Strips};
use super::{Sorted, TILE};
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::{Machine, Work};

/// A stretch of a strip whose forces are added up together, with the pairs that begin there.
#[derive(Clone, Debug, Default)]
pub(super) struct Tile {
    strip: usize,
    pub(super) first: usize,
    pub(super) end: usize,
    /// The stretches that its forces fall on: its own, and those in the strips ahead.
    windows: [Window; 1 + AHEAD],
    /// Where eight partners of a block begin: window after window, block after block.
    starts: Vec<u32>,
    /// Ends of the starts of each window of each block.
    ends: Vec<u32>,
    /// Windows that are in use.
    used: usize,
    /// Starts in a window that a block needs, a bit each.
    marks: Vec<u64>,
}

/// A stretch of places, and where its forces stand among those of the tile.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Window {
    pub(super) first: usize,
    pub(super) length: usize,
    pub(super) base: usize,
}

/// Starts that stand in a window.
#[derive(Clone, Copy)]
pub(super) struct Partners<'a> {
    pub(super) starts: &'a [u32],
    /// Add this to a place to get to its force.
    pub(super) shift: usize,
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

    /// The partners of the block that begins at `place`.
    #[inline(always)]
    pub(super) fn partners(&self, place: usize) -> impl Iterator<Item = Partners<'_>> {
        let block = (place - self.first) / LANES;
        let begin = block * self.used;
        let before = if block == 0 { 0 } else { self.ends[begin - 1] };
        let ends = &self.ends[begin..begin + self.used];
        let windows = self.windows[..self.used].iter().zip(ends);
        windows.scan(before as usize, |from, (window, &end)| {
            let starts = &self.starts[*from..end as usize];
            *from = end as usize;
            Some(Partners {
                starts,
                shift: window.base.wrapping_sub(window.first),
            })
        })
    }
}

impl Sorted {
    /// Lists all pairs, the grains having just been sorted.
    pub(super) fn list(&mut self) {
        let Self {
            skin,
            pairs,
            strips,
            rows,
            position,
            tiles,
            instructions,
            pool,
            ..
        } = self;
        let mut used = 0;
        for (strip, row) in rows.iter().enumerate() {
            let own = row.own();
            for first in own.clone().step_by(TILE) {
                if used == tiles.len() {
                    tiles.push(Tile::default());
                }
                let tile = &mut tiles[used];
                (tile.strip, tile.first) = (strip, first);
                tile.end = (first + TILE).min(own.end);
                used += 1;
            }
        }
        // Tiles to spare stay, with what they have allocated, and hold nothing.
        for tile in &mut tiles[used..] {
            (tile.end, tile.used) = (tile.first, 0);
        }
        let (cutoff, instructions) = (pairs.reach + *skin, *instructions);
        let one = |tile: &mut Tile| {
            instructions.run(List {
                tile,
                strips,
                rows,
                position,
                cutoff,
            });
        };
        if pool.is_some() {
            tiles[..used].par_iter_mut().for_each(one);
        } else {
            tiles[..used].iter_mut().for_each(one);
        }
        // Room for later lists, so that they seldom ask for more.
        let most = tiles.iter().map(|tile| tile.starts.len()).max();
        let room = most.map_or(0, |most| most + most / 4);
        for tile in tiles {
            let missing = room.saturating_sub(tile.starts.len());
            tile.starts.reserve_exact(missing);
        }
    }
}

/// Lists the pairs that begin in a tile.
struct List<'a> {
    tile: &'a mut Tile,
    strips: &'a Strips,
    rows: &'a [Row],
    position: &'a Columns,
    cutoff: f64,
}

impl Work for List<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            tile,
            strips,
            rows,
            position,
            cutoff,
        } = self;
        let (first, end) = (tile.first, tile.end);
        let z = &position.z[..];
        // In a narrow tube grains count as near by z alone, and may move across it as they like.
        let across = Lanes::<M>::splat(if strips.several() { 1.0 } else { 0.0 });
        let (reach, reach_squared) = (Lanes::splat(cutoff), Lanes::splat(cutoff * cutoff));
        let ahead = strips.ahead(tile.strip);
        tile.used = if strips.several() { 1 + AHEAD } else { 1 };
        tile.starts.clear();
        tile.ends.clear();
        let mut spans = [(usize::MAX, 0); 1 + AHEAD];
        spans[0] = (first, first + (end - first).next_multiple_of(LANES));
        // Where the search in each strip ahead begins.
        let mut cursors = ahead.map(|strip| {
            strip.map_or(0, |strip| {
                let places = rows[strip].places();
                places.start + z[places].partition_point(|&there| there <= z[first] - cutoff)
            })
        });
        for block in (first..end).step_by(LANES) {
            let here = position.load::<M>(block);
            let holds = Mask::first(end - block);
            for start in block + 1.. {
                let away = here - position.load(start);
                // Partners only get farther from here on.
                if !((-away.z).less(reach) & holds).any() {
                    break;
                }
                if (squared(away, across).less(reach_squared) & holds).any() {
                    tile.starts.push(start as u32);
                    spans[0].1 = spans[0].1.max(start + LANES);
                }
            }
            tile.ends.push(tile.starts.len() as u32);
            if !strips.several() {
                continue;
            }
            for ((strip, cursor), span) in ahead.iter().zip(&mut cursors).zip(&mut spans[1..]) {
                if let Some(strip) = *strip {
                    let stop = rows[strip].places().end;
                    // The least start at which a lane can meet the place of the cursor.
                    let least = *cursor + 1 - LANES;
                    tile.marks.clear();
                    for lane in 0..(end - block).min(LANES) {
                        let here = position.get(block + lane);
                        while *cursor < stop && z[*cursor] <= here.z - cutoff {
                            *cursor += 1;
                        }
                        let highest = here.z + cutoff;
                        let here = LaneVector::<M>::new(
                            Lanes::splat(here.x),
                            Lanes::splat(here.y),
                            Lanes::splat(here.z),
                        );
                        let mut place = *cursor;
                        while place < stop && z[place] < highest {
                            let away = here - position.load(place);
                            let near = squared(away, across).less(reach_squared);
                            mark(&mut tile.marks, place - lane - least, near.to_bits());
                            place += LANES;
                        }
                    }
                    for (word, &marks) in tile.marks.iter().enumerate() {
                        let mut marks = marks;
                        while marks != 0 {
                            let start = least + 64 * word + marks.trailing_zeros() as usize;
                            marks &= marks - 1;
                            tile.starts.push(start as u32);
                            *span = (span.0.min(start), span.1.max(start + LANES));
                        }
                    }
                }
                tile.ends.push(tile.starts.len() as u32);
            }
        }
        let mut base = 0;
        for (window, (from, to)) in tile.windows.iter_mut().zip(spans) {
            let length = to.saturating_sub(from);
            let first = if length == 0 { 0 } else { from };
            *window = Window {
                first,
                length,
                base,
            };
            base += length;
        }
    }
}

/// Marks the eight bits from `first` on that `bits` has.
#[inline(always)]
fn mark(marks: &mut Vec<u64>, first: usize, bits: u8) {
    let (word, shift) = (first / 64, first % 64);
    if marks.len() < word + 2 {
        marks.resize(word + 2, 0);
    }
    let both = u128::from(bits) << shift;
    marks[word] |= both as u64;
    marks[word + 1] |= (both >> 64) as u64;
}

/// Squared distance, with so much of that across the tube.
#[inline(always)]
fn squared<M: Machine>(away: LaneVector<M>, across: Lanes<M>) -> Lanes<M> {
    across * (away.x * away.x + away.y * away.y) + away.z * away.z
}
