//! Pairs of moving spheres that may touch, and the memory of their contacts.
//!
//! Each pair i < j stands once, in row i, partners ascending. A sphere therefore collects its forces in the order of its
//! partners' numbers, whatever the skin and whenever the list was made: results do not depend on either by a single bit,
//! and a snapshot needs no list.

pub(crate) mod cells;

use glam::DVec3;

pub(crate) use self::cells::PairRule;
use self::cells::{Cells, Grid, Piece, Rows, Search};
use crate::fast::machine::Instructions;
use crate::fast::threads::{PER_THREAD, Threads};

/// Rows of partners with a value of type `H` beside each pair.
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<H> {
    rows: Rows<H>,
    /// Room for the list to come; no history but fresh ones.
    next: Rows<H>,
    /// Unfolded positions when the list was made.
    origin: Vec<DVec3>,
    /// Skin with which it was made.
    skin: f64,
    cells: Cells,
    late_cells: Cells,
    pieces: Vec<Piece>,
    /// Places of the histories that moved when the list was made.
    moved: Vec<u32>,
}

impl<H: Copy + Default + PartialEq> Neighbours<H> {
    /// A list without pairs, which the first [`Neighbours::rebuild`] fills.
    pub(crate) fn empty() -> Self {
        Self {
            rows: Rows {
                start: vec![0],
                ..Rows::default()
            },
            next: Rows::default(),
            origin: Vec::new(),
            skin: 0.0,
            cells: Cells::default(),
            late_cells: Cells::default(),
            pieces: Vec::new(),
            moved: Vec::new(),
        }
    }

    /// Number of listed pairs.
    #[cfg(test)]
    fn pairs(&self) -> usize {
        self.rows.partner.len()
    }

    /// The partners of sphere i with larger numbers, and the histories of their contacts.
    #[inline(always)]
    pub(crate) fn row(&mut self, i: usize) -> (&[u32], &mut [H]) {
        let range = self.rows.range(i);
        (
            &self.rows.partner[range.clone()],
            &mut self.rows.history[range],
        )
    }

    /// Number of pairs in the first so many rows.
    pub(crate) fn pairs_above(&self, rows: usize) -> usize {
        self.rows.start[rows] as usize
    }

    /// Number of rows: spheres when the list was made.
    pub(crate) fn rows(&self) -> usize {
        self.rows.start.len() - 1
    }

    /// The partners of sphere i with larger numbers.
    pub(crate) fn partners(&self, i: usize) -> &[u32] {
        &self.rows.partner[self.rows.range(i)]
    }

    /// The histories of all pairs, row after row.
    pub(crate) fn histories(&self) -> &[H] {
        &self.rows.history
    }

    /// The histories of all pairs, row after row.
    pub(crate) fn histories_mut(&mut self) -> &mut [H] {
        &mut self.rows.history
    }

    /// Places in [`Neighbours::histories`] of all that were no fresh ones when the list was made, in order.
    pub(crate) fn moved(&self) -> &[u32] {
        &self.moved
    }

    /// All pairs with their histories, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.rows()).flat_map(move |i| {
            let row = self
                .partners(i)
                .iter()
                .zip(&self.rows.history[self.rows.range(i)]);
            row.map(move |(&j, history)| (i as u32, j, history))
        })
    }

    /// Sets the history of a listed pair; `false` where the pair is not listed.
    pub(crate) fn set_history(&mut self, i: u32, j: u32, history: H) -> bool {
        let place = self.rows.place(i as usize, j);
        if let Some(place) = place {
            self.rows.history[place] = history;
        }
        place.is_some()
    }

    /// Whether two spheres may have come closer by more than `skin` since the list was made.
    ///
    /// The bound is on differences of displacement: spheres that drift along the tube together never outdate the list.
    pub(crate) fn outdated(
        &self,
        position: &[DVec3],
        turns: &[i32],
        length: f64,
        skin: f64,
    ) -> bool {
        let unfolded = position.iter().zip(turns);
        let unfolded = unfolded.map(|(p, &turns)| p.with_z(p.z + f64::from(turns) * length));
        self.origin.len() != position.len() || self.drift(0, unfolded).approach() > skin
    }

    /// Whether the list holds all admitted pairs of so many spheres that are now closer than (d_i + d_j)/2 + `skin`;
    /// `drift` is that of all.
    pub(crate) fn covers(&self, spheres: usize, drift: Drift, skin: f64) -> bool {
        self.origin.len() == spheres && drift.approach() + skin <= self.skin
    }

    /// How far the spheres from number `first` on have gone since the list was made.
    pub(crate) fn drift(&self, first: usize, unfolded: impl Iterator<Item = DVec3>) -> Drift {
        let mut drift = Drift::NONE;
        let origins = self.origin.get(first..).unwrap_or_default();
        for (place, origin) in unfolded.zip(origins) {
            let by = place - *origin;
            drift.lateral_squared = drift.lateral_squared.max(by.x * by.x + by.y * by.y);
            drift.least = drift.least.min(by.z);
            drift.largest = drift.largest.max(by.z);
        }
        drift
    }

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 + skin, and those that still remember a
    /// contact, in a time that grows linearly with the number of spheres. Histories move with their pairs.
    pub(crate) fn rebuild<F: Fn(usize, usize) -> bool + Sync>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
        threads: &Threads,
    ) where
        H: Sync,
    {
        let grid = Grid::of(position, rule);
        let (cells, late_cells) = (&mut self.cells, &mut self.late_cells);
        let late = rule.admits_all_below.min(position.len());
        let mut sorts = [(cells, 0), (late_cells, late)];
        threads.each(&mut sorts, (), &|_| 0, &|(cells, first), ()| {
            cells.sort(grid, position, rule.diameter, *first);
        });
        let pieces = match threads.number() {
            1 => 1,
            threads => PER_THREAD * threads,
        };
        let rows = |piece: usize| piece * position.len() / pieces;
        self.pieces.resize_with(pieces, Piece::default);
        for (number, piece) in self.pieces.iter_mut().enumerate() {
            piece.rows = rows(number)..rows(number + 1);
        }
        let (cells, late_cells, old) = (&self.cells, &self.late_cells, &self.rows);
        threads.each(&mut self.pieces, (), &|_| 0, &|piece, ()| {
            Instructions::widest().run(Search {
                cells,
                late_cells,
                position,
                rule,
                old,
                piece,
            });
        });
        let Self {
            rows,
            next,
            pieces,
            moved,
            ..
        } = self;
        next.join(pieces);
        // Only histories of contacts need be moved; the old list keeps fresh ones alone.
        next.history.resize(next.partner.len(), H::default());
        moved.clear();
        for &(row, at) in pieces.iter().flat_map(|piece| &piece.remembered) {
            let to = next.place(row as usize, rows.partner[at as usize]);
            let to = to.expect("a pair with a history is listed");
            next.history[to] = core::mem::take(&mut rows.history[at as usize]);
            moved.push(to as u32);
        }
        core::mem::swap(&mut self.rows, &mut self.next);
        self.skin = rule.skin;
        self.origin.clear();
        self.origin.extend(
            position
                .iter()
                .zip(turns)
                .map(|(p, &turns)| DVec3::new(p.x, p.y, p.z + f64::from(turns) * rule.length)),
        );
        debug_assert_eq!(self.rows(), position.len());
    }
}

/// Bounds of displacements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drift {
    least: f64,
    largest: f64,
    lateral_squared: f64,
}

impl Default for Drift {
    fn default() -> Self {
        Self::NONE
    }
}

impl Drift {
    pub(crate) const NONE: Self = Self {
        least: f64::INFINITY,
        largest: f64::NEG_INFINITY,
        lateral_squared: 0.0,
    };

    /// Of these spheres and of others.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            largest: self.largest.max(other.largest),
            lateral_squared: self.lateral_squared.max(other.lateral_squared),
        }
    }

    /// By how much two of the spheres may have come closer \[d\].
    fn approach(self) -> f64 {
        let axial = (self.largest - self.least).max(0.0);
        (axial * axial + 4.0 * self.lateral_squared).sqrt()
    }
}

/// Separation with z brought to the nearest image in a tube of period L, for two positions in \[0, L).
#[inline(always)]
pub(crate) fn periodic(mut separation: DVec3, length: f64) -> DVec3 {
    if separation.z > 0.5 * length {
        separation.z -= length;
    } else if separation.z < -0.5 * length {
        separation.z += length;
    }
    separation
}

#[cfg(test)]
mod tests;
