//! The order along the tube: making it, and bringing grains into it and back.

use glam::DVec3;
use rayon::prelude::*;

use super::{Sorted, TILE, Tile};
use crate::bodies::{Bodies, fold};
use crate::fast::lanes::LANES;

/// What a restart needs to go on in the same order, and so with the same bits.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sorting {
    /// Which grain stands at each place.
    pub order: Vec<u32>,
    /// z at the last sorting, by place \[d\].
    pub origin: Vec<f64>,
    /// z now, running on beyond the ends of the tube since then, by place \[d\].
    pub unfolded: Vec<f64>,
}

/// A [`Sorting`] in the hands of its kernel.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct SortingView<'a> {
    order: &'a [u32],
    origin: &'a [f64],
    unfolded: &'a [f64],
}

impl SortingView<'_> {
    pub(crate) fn into_owned(self) -> Sorting {
        Sorting {
            order: self.order.to_vec(),
            origin: self.origin.to_vec(),
            unfolded: self.unfolded.to_vec(),
        }
    }
}

impl Sorting {
    /// Whether this can be the order of so many grains in a tube of this length; else why not.
    pub(crate) fn check(&self, grains: usize, length: f64) -> Result<(), String> {
        if [self.order.len(), self.origin.len(), self.unfolded.len()] != [grains; 3] {
            return Err("its order holds another number of grains".to_owned());
        }
        let mut seen = vec![false; grains];
        for &grain in &self.order {
            match seen.get_mut(grain as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => return Err("its order does not hold each grain once".to_owned()),
            }
        }
        let in_tube = |z: f64| (0.0..length).contains(&z);
        let near = |drift: f64| drift.abs() <= (MOST_DRIFT + 1.0) * length;
        let mut places = self.origin.iter().zip(&self.unfolded);
        if !places.all(|(&origin, &unfolded)| in_tube(origin) && near(unfolded - origin)) {
            return Err("its order holds places that are not in the tube".to_owned());
        }
        Ok(())
    }
}

/// The order is made anew when a grain has drifted by so many lengths of the tube: z loses digits far from 0.
pub(super) const MOST_DRIFT: f64 = 1.0;

#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// (z, place before) in the order that is being made.
    keys: Vec<(f64, u32)>,
    above: Vec<(f64, u32)>,
    column: Vec<f64>,
    order: Vec<u32>,
    turns: Vec<i32>,
}

/// z of places that hold no grain: out of reach of everything.
const NOWHERE: f64 = 1e30;

impl Sorted {
    /// Takes over all grains.
    pub(super) fn load(&mut self, bodies: &Bodies, sorting: Option<&Sorting>) {
        self.order.clear();
        match sorting {
            Some(sorting) => self.order.extend(&sorting.order),
            None => self.order.extend(0..self.grains as u32),
        }
        for &grain in &self.order {
            let grain = grain as usize;
            self.turns.push(bodies.turns[grain]);
            self.position.push(bodies.position[grain]);
            self.velocity.push(bodies.velocity[grain]);
            self.acceleration.push(bodies.acceleration[grain]);
        }
        match sorting {
            Some(sorting) => {
                for (place, &unfolded) in sorting.unfolded.iter().enumerate() {
                    self.turns[place] -= fold(unfolded, self.length).1;
                }
                // What depends on where the grains were sorted is made from there.
                self.position.z.copy_from_slice(&sorting.origin);
                self.mark();
                self.position.z[..self.grains].copy_from_slice(&sorting.unfolded);
                self.copy_ghosts();
            }
            None => {
                self.position
                    .z
                    .iter_mut()
                    .zip(&mut self.turns)
                    .for_each(|(z, turns)| {
                        let (folded, count) = fold(*z, self.length);
                        *z = folded;
                        *turns += count;
                    });
                self.scratch.keys.clear();
                let places = self.position.z.iter().zip(0..);
                self.scratch
                    .keys
                    .extend(places.map(|(&z, place)| (z, place)));
                self.scratch
                    .keys
                    .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                self.permute();
                self.mark();
                self.copy_ghosts();
            }
        }
    }

    /// Takes over where the grains are; makes the order anew where it no longer holds.
    pub(super) fn take_positions(&mut self, bodies: &Bodies) {
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (place, &grain) in self.order.iter().enumerate() {
            let grain = grain as usize;
            let DVec3 { x, y, z } = bodies.position[grain];
            let turned = f64::from(bodies.turns[grain] - self.turns[place]);
            let unfolded = z + turned * self.length;
            self.position.x[place] = x;
            self.position.y[place] = y;
            self.position.z[place] = unfolded;
            least = least.min(unfolded - self.origin[place]);
            largest = largest.max(unfolded - self.origin[place]);
        }
        if largest - least > self.skin {
            self.sort();
        } else {
            self.copy_ghosts();
        }
    }

    /// Brings the grains back to where the rest of the program looks for them.
    pub(super) fn store(&self, bodies: &mut Bodies) {
        for (place, &grain) in self.order.iter().enumerate() {
            let grain = grain as usize;
            let (z, turns) = fold(self.position.z[place], self.length);
            bodies.position[grain] = DVec3::new(self.position.x[place], self.position.y[place], z);
            bodies.turns[grain] = self.turns[place] + turns;
            bodies.velocity[grain] = self.velocity.get(place);
            bodies.acceleration[grain] = self.acceleration.get(place);
        }
    }

    /// What a restart needs.
    pub(crate) fn sorting(&self) -> SortingView<'_> {
        SortingView {
            order: &self.order,
            origin: &self.origin[..self.grains],
            unfolded: &self.position.z[..self.grains],
        }
    }

    /// Makes the order anew.
    pub(super) fn sort(&mut self) {
        let Scratch { keys, above, .. } = &mut self.scratch;
        // Grains that left the tube at its end come first, those that left at its beginning last: what then remains to
        // be done is little.
        keys.clear();
        above.clear();
        let places = || self.position.z[..self.grains].iter().zip(0_u32..);
        for (&z, place) in places() {
            if z >= self.length {
                keys.push((z, place));
            } else if z < 0.0 {
                above.push((z, place));
            }
        }
        for (&z, place) in places() {
            if (0.0..self.length).contains(&z) {
                keys.push((z, place));
            }
        }
        keys.append(above);
        for (z, place) in keys.iter_mut() {
            let (folded, turns) = fold(*z, self.length);
            *z = folded;
            self.turns[*place as usize] += turns;
        }
        for (z, &mut place) in keys.iter_mut().map(|(z, place)| (*z, place)) {
            self.position.z[place as usize] = z;
        }
        insertion_sort(keys);
        self.permute();
        self.mark();
        self.copy_ghosts();
    }

    /// Brings all columns into the order of the keys.
    fn permute(&mut self) {
        let Scratch {
            keys,
            column,
            order,
            turns,
            ..
        } = &mut self.scratch;
        let parallel = self.pool.is_some();
        for columns in [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ] {
            for values in columns.each() {
                // What stands behind the grains is made anew by `mark`.
                column.resize(values.len(), 0.0);
                gather(keys, values, column, parallel);
                core::mem::swap(values, column);
            }
        }
        order.resize(self.grains, 0);
        gather(keys, &self.order, order, parallel);
        core::mem::swap(&mut self.order, order);
        turns.resize(self.grains, 0);
        gather(keys, &self.turns, turns, parallel);
        core::mem::swap(&mut self.turns, turns);
    }

    /// Notes where the grains stand now and who may touch whom until they are sorted again.
    fn mark(&mut self) {
        let grains = self.grains;
        let blocks = grains.div_ceil(LANES);
        self.ahead.resize(blocks, 0);
        let cutoff = self.pairs.reach + self.skin;
        let (z, length) = (&self.position.z[..grains], self.length);
        let tile = |(tile, ahead): (usize, &mut [u32])| {
            count_ahead(z, length, cutoff, tile * TILE, ahead);
        };
        if self.pool.is_some() {
            let tiles = self.ahead.par_chunks_mut(TILE / LANES);
            tiles.enumerate().for_each(tile);
        } else {
            let tiles = self.ahead.chunks_mut(TILE / LANES);
            tiles.enumerate().for_each(tile);
        }

        let tiles = grains.div_ceil(TILE);
        let (mut most_ahead, mut farthest) = (0, 0);
        self.tiles.resize_with(tiles, Tile::empty);
        for (index, tile) in self.tiles.iter_mut().enumerate() {
            tile.first = index * TILE;
            tile.end = (tile.first + TILE).min(grains);
            let mut last = 0;
            for place in (tile.first..tile.end).step_by(LANES) {
                let ahead = self.ahead[place / LANES] as usize;
                most_ahead = most_ahead.max(ahead);
                last = last.max((place + LANES).min(grains) - 1 + ahead);
            }
            tile.overhang = (last + 1).saturating_sub(tile.end).min(grains);
            farthest = farthest.max(last);
        }
        self.ghosts = (farthest + 1).saturating_sub(grains).min(grains);

        let room = grains + self.ghosts + most_ahead + 2 * LANES;
        for columns in [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ] {
            columns.resize(room);
        }
        self.position.z[grains..].fill(NOWHERE);
        self.origin.clear();
        self.origin.extend_from_slice(&self.position.z);
        for tile in &mut self.tiles {
            tile.force.resize(TILE + most_ahead + LANES);
        }
    }

    /// Repeats the first grains behind the last, one period on.
    pub(super) fn copy_ghosts(&mut self) {
        for ghost in 0..self.ghosts {
            self.position.copy(ghost, self.grains + ghost, self.length);
            self.velocity.copy(ghost, self.grains + ghost, 0.0);
        }
    }
}

/// For each block from place `first` on, how many grains ahead may come within `cutoff` of a grain of it.
fn count_ahead(z: &[f64], length: f64, cutoff: f64, first: usize, ahead: &mut [u32]) {
    let grains = z.len();
    // z of a place, going on round the tube.
    let unfolded = |place: usize| {
        if place < grains {
            z[place]
        } else {
            z[place - grains] + length
        }
    };
    let mut end = 0;
    for (block, ahead) in ahead.iter_mut().enumerate() {
        let start = first + block * LANES;
        let mut most = 0;
        for (place, &here) in z.iter().enumerate().skip(start).take(LANES) {
            end = end.max(place + 1);
            // A grain never meets itself.
            while end < place + grains && unfolded(end) < here + cutoff {
                end += 1;
            }
            most = most.max(end - 1 - place);
        }
        *ahead = most as u32;
    }
}

impl Tile {
    fn empty() -> Self {
        Self {
            first: 0,
            end: 0,
            force: super::Columns::default(),
            overhang: 0,
            tally: super::Tally::default(),
            moved: super::Moved::default(),
        }
    }
}

/// Copies values into the order of the keys.
fn gather<T: Copy + Send + Sync>(
    keys: &[(f64, u32)],
    values: &[T],
    gathered: &mut [T],
    parallel: bool,
) {
    let one = |(gathered, keys): (&mut [T], &[(f64, u32)])| {
        for (gathered, &(_, place)) in gathered.iter_mut().zip(keys) {
            *gathered = values[place as usize];
        }
    };
    const PIECE: usize = 16 * TILE;
    if parallel {
        let pieces = gathered.par_chunks_mut(PIECE);
        pieces.zip(keys.par_chunks(PIECE)).for_each(one);
    } else {
        one((gathered, keys));
    }
}

/// Sorts what is nearly sorted.
fn insertion_sort(keys: &mut [(f64, u32)]) {
    for unsorted in 1..keys.len() {
        let key = keys[unsorted];
        let mut hole = unsorted;
        while hole > 0 && key.0 < keys[hole - 1].0 {
            keys[hole] = keys[hole - 1];
            hole -= 1;
        }
        keys[hole] = key;
    }
}
