//! The order of the grains, strip by strip and along each strip: making it, and bringing grains into it and back.

use glam::DVec3;
use rayon::prelude::*;

use super::keys::put_strips_in_order;
use super::rows::{Key, NOWHERE, PIECE, Row, Scratch};
use super::state::Sorted;
use crate::bodies::{Bodies, fold};
use crate::fast::lanes::LANES;

/// The order for a restart, which then goes on with the same bits.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sorting {
    /// The grains in their order.
    pub order: Vec<u32>,
    /// z at the last sorting, in this order \[d\].
    pub origin: Vec<f64>,
    /// z now, running on beyond the ends of the tube since then, in this order \[d\].
    pub unfolded: Vec<f64>,
    /// How many grains stand in each strip along the tube.
    pub strips: Vec<u32>,
    /// Bound of the distance across the tube that grains have gone since the last sorting \[d\].
    pub lateral: f64,
}

impl Sorting {
    /// Whether this can be the order of so many grains in a tube of this length; else why not.
    pub(crate) fn check(&self, grains: usize, strips: usize, length: f64) -> Result<(), String> {
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
        let standing: u64 = self.strips.iter().map(|&number| u64::from(number)).sum();
        if self.strips.len() != strips || standing != grains as u64 {
            return Err("its order belongs to other strips".to_owned());
        }
        if !(0.0..f64::INFINITY).contains(&self.lateral) {
            return Err("its grains have gone no distance that there is".to_owned());
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
const MOST_DRIFT: f64 = 1.0;

impl Sorted {
    /// Takes over all grains.
    pub(super) fn load(&mut self, bodies: &Bodies, sorting: Option<&Sorting>) {
        // For a start they stand in one row as they come.
        let first = self.first_place();
        let mut add = |grain: usize, z: f64| {
            let mut position = bodies.position[grain];
            position.z = z;
            self.order.push(grain as u32);
            self.turns.push(bodies.turns[grain]);
            self.position.push(position);
            self.velocity.push(bodies.velocity[grain]);
            self.acceleration.push(bodies.acceleration[grain]);
        };
        if self.grains > 0 {
            (0..first).for_each(|_| add(0, NOWHERE));
        }
        match sorting {
            Some(sorting) => {
                let places = sorting.order.iter().zip(&sorting.origin);
                places.for_each(|(&grain, &z)| add(grain as usize, z));
            }
            None => (0..self.grains).for_each(|grain| add(grain, bodies.position[grain].z)),
        }
        let place = if self.grains > 0 { first } else { 0 };
        self.rows = vec![Row {
            first: place,
            grains: self.grains,
            ..Row::default()
        }];
        let Some(sorting) = sorting else {
            self.sort();
            return;
        };
        // The rest depends on the places at the last sorting, and is made from them.
        let keys = sorting.origin.iter().copied().zip(place as u32..);
        self.scratch.keys.extend(keys);
        self.arrange(sorting.strips.iter().map(|&number| number as usize));
        self.lateral = sorting.lateral;
        let mut unfolded = sorting.unfolded.iter();
        for row in &self.rows {
            for (place, &z) in row.own().zip(&mut unfolded) {
                self.position.z[place] = z;
                self.turns[place] -= fold(z, self.length).1;
            }
        }
        self.copy_grains();
    }

    /// The first place that can hold a grain or a copy: before it stand as many that hold none.
    fn first_place(&self) -> usize {
        if self.strips.several() { LANES } else { 0 }
    }

    /// Takes over where the grains are; makes the order anew where it no longer holds.
    pub(super) fn take_positions(&mut self, bodies: &Bodies) {
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut lateral_squared = 0.0_f64;
        for place in self.rows.iter().flat_map(Row::own) {
            let grain = self.order[place] as usize;
            let DVec3 { x, y, z } = bodies.position[grain];
            let turned = f64::from(bodies.turns[grain] - self.turns[place]);
            let unfolded = z + turned * self.length;
            let (by_x, by_y) = (x - self.position.x[place], y - self.position.y[place]);
            lateral_squared = lateral_squared.max(by_x * by_x + by_y * by_y);
            self.position.x[place] = x;
            self.position.y[place] = y;
            self.position.z[place] = unfolded;
            least = least.min(unfolded - self.origin[place]);
            largest = largest.max(unfolded - self.origin[place]);
        }
        self.follow(least, largest, lateral_squared);
    }

    /// Makes the order anew unless all pairs that can touch are still listed, grains having moved along z by so much at
    /// least and at most since it was made, and across the tube in this step.
    pub(super) fn follow(&mut self, least: f64, largest: f64, lateral_squared: f64) {
        self.lateral += lateral_squared.sqrt();
        let spread = largest - least;
        let across = if self.strips.several() {
            2.0 * self.lateral
        } else {
            0.0
        };
        let drift = largest.max(-least);
        let near = spread * spread + across * across <= self.skin * self.skin;
        if near && drift <= MOST_DRIFT * self.length {
            self.copy_grains();
        } else {
            self.sort();
        }
    }

    /// Brings the grains back to where the rest of the program looks for them.
    pub(super) fn store(&self, bodies: &mut Bodies) {
        for place in self.rows.iter().flat_map(Row::own) {
            let grain = self.order[place] as usize;
            let (z, turns) = fold(self.position.z[place], self.length);
            bodies.position[grain] = DVec3::new(self.position.x[place], self.position.y[place], z);
            bodies.turns[grain] = self.turns[place] + turns;
            bodies.velocity[grain] = self.velocity.get(place);
            bodies.acceleration[grain] = self.acceleration.get(place);
        }
    }

    /// The order for a restart.
    pub(crate) fn sorting(&self) -> Sorting {
        let places = || self.rows.iter().flat_map(Row::own);
        Sorting {
            order: places().map(|place| self.order[place]).collect(),
            origin: places().map(|place| self.origin[place]).collect(),
            unfolded: places().map(|place| self.position.z[place]).collect(),
            strips: self.rows.iter().map(|row| row.grains as u32).collect(),
            lateral: self.lateral,
        }
    }

    /// Makes the order anew.
    pub(super) fn sort(&mut self) {
        let parallel = self.threads.several();
        if parallel && !self.strips.several() {
            self.note_row_in_pieces();
        } else {
            self.note_strips();
        }
        let Scratch { keys, counts, .. } = &mut self.scratch;
        put_strips_in_order(keys, counts, parallel);
        let counts = core::mem::take(counts);
        let ends = counts.iter().map(|count| count[2] as usize);
        let begins = core::iter::once(0).chain(ends.clone());
        self.arrange(ends.zip(begins).map(|(end, begin)| end - begin));
        self.scratch.counts = counts;
    }

    /// Brings all columns into the order of the keys, so many of which belong to each strip.
    fn arrange(&mut self, strips: impl Iterator<Item = usize>) {
        let several = self.strips.several();
        let cutoff = self.pairs.reach + self.skin;
        let mut place = self.first_place();
        self.rows.clear();
        let mut rest = &self.scratch.keys[..];
        for grains in strips {
            let row;
            (row, rest) = rest.split_at(grains);
            let near_end = row.partition_point(|key| key.0 <= self.length - cutoff);
            let row = Row {
                first: place,
                grains,
                // One row alone looks ahead only.
                before: if several { grains - near_end } else { 0 },
                behind: row.partition_point(|key| key.0 < cutoff),
            };
            let row = Row {
                first: place + row.before,
                ..row
            };
            place = row.places().end + LANES;
            self.rows.push(row);
        }
        let places = place.next_multiple_of(LANES);
        let gather = Gather {
            rows: &self.rows,
            keys: &self.scratch.keys,
            places,
            parallel: self.threads.several(),
        };
        for columns in [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ] {
            for values in columns.each() {
                gather.bring(values, 0.0, &mut self.scratch.column);
            }
        }
        for gap in gather.gaps() {
            self.position.z[gap].fill(NOWHERE);
        }
        gather.bring(&mut self.order, u32::MAX, &mut self.scratch.order);
        gather.bring(&mut self.turns, 0, &mut self.scratch.turns);

        self.force.clear(places);
        for row in &self.rows {
            for (from, to, _) in row.copies(self.length) {
                self.order[to] = self.order[from];
                self.acceleration.copy(from, to, 0.0);
            }
        }
        self.copy_grains();
        self.origin.clone_from(&self.position.z);
        self.lateral = 0.0;
        self.list();
    }

    /// Repeats the grains near the ends of the tube, one period on or back.
    pub(super) fn copy_grains(&mut self) {
        for row in &self.rows {
            for (from, to, shift) in row.copies(self.length) {
                self.position.copy(from, to, shift);
                self.velocity.copy(from, to, 0.0);
            }
        }
    }

    /// Adds the forces on copies to the forces on the grains, and moves the copies along with them.
    pub(super) fn gather_from_copies(&mut self) {
        for row in &self.rows {
            for (from, to, _) in row.copies(self.length) {
                let force = self.force.get(from) + self.force.get(to);
                self.force.set(from, force);
            }
            for (from, to, _) in row.copies(self.length) {
                self.force.copy(from, to, 0.0);
            }
        }
    }
}

/// The order of the keys, row by row, that values are to be brought into.
struct Gather<'a> {
    rows: &'a [Row],
    keys: &'a [Key],
    places: usize,
    parallel: bool,
}

impl Gather<'_> {
    /// The stretches of places between the grains of the rows, and before and behind them.
    fn gaps(&self) -> impl Iterator<Item = core::ops::Range<usize>> {
        let ends = core::iter::once(0).chain(self.rows.iter().map(|row| row.own().end));
        let begins = self.rows.iter().map(|row| row.first);
        ends.zip(begins.chain(core::iter::once(self.places)))
            .map(|(end, begin)| end..begin)
    }

    /// Brings values into the order; `filler` stands where there is no grain.
    fn bring<T: Copy + Send + Sync>(&self, values: &mut Vec<T>, filler: T, scratch: &mut Vec<T>) {
        scratch.resize(self.places, filler);
        for gap in self.gaps() {
            scratch[gap].fill(filler);
        }
        let from = &values[..];
        let one = |(gathered, keys): (&mut [T], &[Key])| {
            for (gathered, &(_, place)) in gathered.iter_mut().zip(keys) {
                *gathered = from[place as usize];
            }
        };
        let mut keys = self.keys;
        for row in self.rows {
            let own;
            (own, keys) = keys.split_at(row.grains);
            let gathered = &mut scratch[row.own()];
            if self.parallel && row.grains > PIECE {
                let pieces = gathered.par_chunks_mut(PIECE);
                pieces.zip(own.par_chunks(PIECE)).for_each(one);
            } else {
                one((gathered, own));
            }
        }
        core::mem::swap(values, scratch);
    }
}
