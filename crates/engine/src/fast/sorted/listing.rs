//! Which blocks of grains may touch which, until the grains are sorted again.
//!
//! A block is eight grains that follow one another in a strip. Against it stand eight places that follow one another,
//! in the same strip or in one ahead: lane k meets the k-th of them. A start is listed if any of its eight pairs may
//! come to touch.

use peristalsis_physics::real::Real;
use rayon::prelude::*;

use super::rows::Row;
use super::state::Sorted;
use super::strips::{AHEAD, Strips};
use super::tile::{AT_A_TIME, Partners, TILE, Tile, Window};
use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::{Machine, Work};

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
            threads,
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
            (tile.first, tile.end, tile.used) = (0, 0, 0);
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
        if threads.several() {
            let tiles = tiles[..used].par_iter_mut();
            tiles.with_max_len(AT_A_TIME).for_each(one);
        } else {
            tiles[..used].iter_mut().for_each(one);
        }
        // Room for later lists, so that they seldom ask for more.
        let most = tiles.iter().map(|tile| tile.partners.len()).max();
        let room = most.map_or(0, |most| most + most / 4);
        for tile in tiles {
            let missing = room.saturating_sub(tile.partners.len());
            tile.partners.reserve_exact(missing);
        }
        self.share_out();
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
        tile.ends.clear();
        let room = tile.partners.capacity();
        tile.partners.resize(room, Partners::default());
        let mut listed = Listed {
            partners: &mut tile.partners,
            end: 0,
        };
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
            let begin = listed.end;
            for start in block + 1.. {
                let away = here - position.load(start);
                // Partners only get farther from here on.
                if !((-away.z).less(reach) & holds).any() {
                    break;
                }
                let near = squared(away, across).less(reach_squared) & holds;
                listed.note(start, 0, near.any());
            }
            if listed.end > begin {
                spans[0].1 = spans[0].1.max(listed.start(listed.end - 1) + LANES);
            }
            let (lowest, highest) = (z[block] - cutoff, z[(block + LANES).min(end) - 1] + cutoff);
            for (window, (strip, cursor)) in ahead.iter().zip(&mut cursors).enumerate() {
                let Some(strip) = *strip else { continue };
                let stop = rows[strip].places().end;
                while *cursor < stop && z[*cursor] <= lowest {
                    *cursor += 1;
                }
                let mut last = *cursor;
                while last < stop && z[last] < highest {
                    last += 1;
                }
                // Each of these places may be met by any of the lanes.
                let first = if last > *cursor {
                    *cursor + 1 - LANES
                } else {
                    last
                };
                let begin = listed.end;
                for start in first..last {
                    let away = here - position.load(start);
                    let near = squared(away, across).less(reach_squared) & holds;
                    listed.note(start, window + 1, near.any());
                }
                if listed.end > begin {
                    let span = &mut spans[window + 1];
                    span.0 = span.0.min(listed.start(begin));
                    span.1 = span.1.max(listed.start(listed.end - 1) + LANES);
                }
            }
            tile.ends.push(listed.end as u32);
        }
        let end = listed.end;
        tile.partners.truncate(end);
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
        for partners in &mut tile.partners {
            let window = &tile.windows[partners.force as usize];
            partners.force = partners.start - window.first as u32 + window.base as u32;
        }
    }
}

/// Partners that are being listed, and room for more. Until the list is complete `force` holds the number of the window.
struct Listed<'a> {
    partners: &'a mut Vec<Partners>,
    end: usize,
}

impl Listed<'_> {
    /// Lists partners if they are to be, without a branch that could not be foreseen.
    #[inline(always)]
    fn note(&mut self, start: usize, window: usize, wanted: bool) {
        if self.end == self.partners.len() {
            let room = (2 * self.end).max(8 * LANES);
            self.partners.resize(room, Partners::default());
        }
        self.partners[self.end] = Partners {
            start: start as u32,
            force: window as u32,
        };
        self.end += usize::from(wanted);
    }

    #[inline(always)]
    fn start(&self, index: usize) -> usize {
        self.partners[index].start as usize
    }
}

/// Squared distance, with so much of that across the tube.
#[inline(always)]
fn squared<M: Machine>(away: LaneVector<M>, across: Lanes<M>) -> Lanes<M> {
    across * (away.x * away.x + away.y * away.y) + away.z * away.z
}
