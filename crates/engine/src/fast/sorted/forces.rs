//! Forces of the contacts, tile by tile, and their sums.

use std::cell::RefCell;

use peristalsis_physics::contact::NormalLaw;
use rayon::prelude::*;

use super::candidates::Candidates;
use super::pairs::{Block, PairConstants, Touching};
use super::state::Sorted;
use super::tile::{AT_A_TIME, OF_LIGHT_WORK, OfTile, TILE, Tile};
use super::wall::WallTable;
use crate::fast::columns::{Columns, ColumnsMut};
use crate::fast::lanes::LANES;
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::ledger::Tally;

impl Sorted {
    /// Adds up all forces, from zero, and answers their sums.
    pub(super) fn forces<N: NormalLaw, const FULL: bool>(&mut self, law: &N) -> Tally {
        let instructions = self.instructions;
        let one = |(of_tile, tile): (&mut OfTile, &Tile)| {
            ROOM.with_borrow_mut(|room| {
                instructions.run(ForcesOfTile::<N, FULL> {
                    law,
                    pairs: &self.pairs,
                    wall: &self.wall,
                    position: &self.position,
                    velocity: &self.velocity,
                    tile,
                    of_tile,
                    room,
                });
            });
        };
        let (tiles, of_tiles) = (&self.tiles, &mut self.of_tiles);
        let mut tally = Tally::default();
        if self.threads.several() {
            let work = of_tiles.par_iter_mut().zip(tiles);
            work.with_max_len(AT_A_TIME).for_each(one);
            let stretches = self.force.par_tiles().zip(&self.reached_by).enumerate();
            let stretches = stretches.with_max_len(OF_LIGHT_WORK);
            stretches.for_each(|(stretch, (force, reached_by))| {
                instructions.run(AddUp {
                    first: stretch * TILE,
                    reached_by,
                    tiles,
                    of_tiles,
                    force,
                });
            });
            for of_tile in &*of_tiles {
                tally.merge(&of_tile.tally);
            }
        } else {
            for (number, tile) in tiles.iter().enumerate() {
                one((&mut of_tiles[0], tile));
                let all = [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4)];
                instructions.run(AddUp {
                    first: 0,
                    reached_by: &all[..tile.windows().len()],
                    tiles: &tiles[number..=number],
                    of_tiles,
                    force: self.force.as_mut(),
                });
                tally.merge(&of_tiles[0].tally);
            }
        }
        self.gather_from_copies();
        tally
    }

    /// Finds out which stretches of places the tiles reach, so that threads can add up a stretch each.
    pub(super) fn share_out(&mut self) {
        let number = if self.threads.several() {
            self.tiles.len()
        } else {
            1
        };
        self.of_tiles.resize_with(number, OfTile::default);
        if !self.threads.several() {
            return;
        }
        let stretches = self.origin.len().div_ceil(TILE);
        self.reached_by.resize_with(stretches, Vec::new);
        self.reached_by.iter_mut().for_each(Vec::clear);
        for (number, tile) in self.tiles.iter().enumerate() {
            for (index, window) in tile.windows().iter().enumerate() {
                let stretches = window.first / TILE..(window.first + window.length).div_ceil(TILE);
                for reached_by in &mut self.reached_by[stretches] {
                    reached_by.push((number as u32, index as u32));
                }
            }
        }
    }

    pub(super) fn forget_forces(&mut self) {
        self.force.clear(self.origin.len());
    }
}

thread_local! {
    /// Room that each thread uses again for every tile.
    static ROOM: RefCell<Room> = RefCell::default();
}

/// What the work on a tile is written down in.
#[derive(Debug, Default)]
struct Room {
    touching: Touching,
    candidates: Candidates,
}

struct ForcesOfTile<'a, N, const FULL: bool> {
    law: &'a N,
    pairs: &'a PairConstants,
    wall: &'a WallTable,
    position: &'a Columns,
    velocity: &'a Columns,
    tile: &'a Tile,
    of_tile: &'a mut OfTile,
    room: &'a mut Room,
}

impl<N: NormalLaw, const FULL: bool> Work for ForcesOfTile<'_, N, FULL> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            law,
            wall,
            tile,
            room: Room {
                touching,
                candidates,
            },
            ..
        } = self;
        let places = self.position.x.len();
        let (position, velocity) = (self.position.first(places), self.velocity.first(places));
        let OfTile { force, tally } = self.of_tile;
        force.clear(tile.room());
        let mut force = force.as_mut();
        let mut sums = Sums::<M>::default();
        let blocks = || (tile.first..tile.end).step_by(LANES);
        let block = |place| Block::<M>::load(position, velocity, place, tile.end);
        touching.clear(tile.listed());
        let mut ends = [0; TILE / LANES];
        for (place, end) in blocks().zip(&mut ends) {
            block(place).find_touching(self.pairs.reach, position, tile, touching);
            *end = touching.distances.number();
        }
        let mut begin = 0;
        for (place, end) in blocks().zip(ends) {
            block(place).add_pairs::<N, FULL>(
                law,
                self.pairs,
                position,
                velocity,
                tile,
                touching,
                begin..end,
                &mut force,
                &mut sums,
            );
            begin = end;
        }
        let (own_position, own_velocity) = (position.from(tile.first), velocity.from(tile.first));
        let mut place = tile.first;
        while place < tile.end {
            candidates.clear();
            while place < tile.end && candidates.have_room(wall.most_rings()) {
                wall.find_candidates(&block(place), place - tile.first, candidates);
                place += LANES;
            }
            wall.turn_to_nearest::<M>(own_position, own_velocity, candidates);
            wall.find_touching::<M>(candidates, &mut touching.distances);
            wall.add_up_forces::<M, N, FULL>(
                law,
                candidates,
                &touching.distances,
                &mut force,
                &mut sums,
            );
        }
        *tally = Tally::default();
        sums.add_to(tally);
    }
}

/// Adds the forces in windows of tiles to the forces of a stretch of places.
struct AddUp<'a> {
    first: usize,
    /// Tile and window, in the order of the tiles.
    reached_by: &'a [(u32, u32)],
    tiles: &'a [Tile],
    of_tiles: &'a [OfTile],
    force: ColumnsMut<'a>,
}

impl Work for AddUp<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let (first, force) = (self.first, self.force);
        let end = first + force.x.len();
        for &(tile, window) in self.reached_by {
            let of_tile = &self.of_tiles[tile as usize].force;
            let window = &self.tiles[tile as usize].windows()[window as usize];
            let from = window.first.max(first);
            let to = (window.first + window.length).min(end).max(from);
            for (all, of_tile) in [
                (&mut *force.x, &of_tile.x),
                (&mut *force.y, &of_tile.y),
                (&mut *force.z, &of_tile.z),
            ] {
                let all = &mut all[from - first..to - first];
                let base = window.base + (from - window.first);
                let of_tile = &of_tile[base..base + (to - from)];
                for (all, of_tile) in all.iter_mut().zip(of_tile) {
                    *all += of_tile;
                }
            }
        }
    }
}
