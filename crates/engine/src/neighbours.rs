//! Pairs of moving spheres that may touch, and the memory of their contacts.
//!
//! Each pair i < j stands once, in row i, partners ascending. A sphere therefore collects its forces in the order of its
//! partners' numbers, whatever the skin and whenever the list was made: results do not depend on either by a single bit,
//! and a snapshot needs no list.

pub(crate) mod cells;
mod rows;

use core::ops::Range;

use glam::DVec3;

pub(crate) use self::cells::PairRule;
use self::cells::{Cells, Grid, Piece, Search};
use self::rows::{Collecting, Rows};
use crate::fast::machine::Instructions;
use crate::fast::threads::Threads;

/// Rows of partners with a history of type `H` beside each pair.
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<H> {
    rows: Rows,
    /// Room for the list to come.
    next: Rows,
    /// Of each pair; while others keep the histories all are fresh, and not yet as many as there are pairs.
    history: Vec<H>,
    /// Unfolded positions for which the list was made.
    origin: Vec<DVec3>,
    /// Skin with which it was made.
    skin: f64,
    /// The spheres whose pairs all are admitted, and the others: their cells, and what is found for them.
    cells: [Cells; 2],
    found: [Vec<Piece>; 2],
    collecting: Collecting,
    /// Histories (i, j, history) on their way from one list to the next.
    carried: Vec<(u32, u32, H)>,
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
            history: Vec::new(),
            origin: Vec::new(),
            skin: 0.0,
            cells: Default::default(),
            found: Default::default(),
            collecting: Collecting::default(),
            carried: Vec::new(),
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
        (&self.rows.partner[range.clone()], &mut self.history[range])
    }

    /// The places of the pairs of row i in the list.
    pub(crate) fn range(&self, i: usize) -> Range<usize> {
        self.rows.range(i)
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
        &self.history
    }

    /// The same, to be changed.
    pub(crate) fn histories_mut(&mut self) -> &mut [H] {
        let (partner, next) = (&self.rows.partner, &self.next.partner);
        // Room for later lists, too.
        let room = partner.capacity().max(next.capacity());
        let more = room.saturating_sub(self.history.len());
        self.history.reserve(more);
        self.history.resize(partner.len(), H::default());
        &mut self.history
    }

    /// The partners of sphere i with larger numbers, each with its history.
    pub(crate) fn pairs_of(&self, i: usize) -> impl Iterator<Item = (&u32, &H)> {
        let histories = &self.history[self.rows.range(i)];
        self.partners(i).iter().zip(histories)
    }

    /// All pairs with their histories, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.rows()).flat_map(move |i| {
            let row = self.pairs_of(i);
            row.map(move |(&j, history)| (i as u32, j, history))
        })
    }

    /// The place of a pair in the list, if it is listed.
    pub(crate) fn place(&self, i: u32, j: u32) -> Option<usize> {
        self.rows.place(i as usize, j)
    }

    /// Sets the history of a listed pair; `false` where the pair is not listed.
    pub(crate) fn set_history(&mut self, i: u32, j: u32, history: H) -> bool {
        let place = self.place(i, j);
        if let Some(place) = place {
            self.history[place] = history;
        }
        place.is_some()
    }

    /// Whether two spheres may be closer, by more than `skin`, than at the places for which the list was made.
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
        self.origin.len() != position.len()
            || Drift::between(unfolded.zip(&self.origin)).approach() > skin
    }

    /// Whether the list holds all admitted pairs that are now closer than (d_i + d_j)/2 + `skin`.
    pub(crate) fn holds(&self, position: &[DVec3], turns: &[i32], length: f64, skin: f64) -> bool {
        !self.outdated(position, turns, length, self.skin - skin)
    }

    /// Whether the list holds all admitted pairs of so many spheres that are now closer than (d_i + d_j)/2 + `skin`;
    /// `drift` is the drift of all spheres.
    pub(crate) fn covers(&self, spheres: usize, drift: Drift, skin: f64) -> bool {
        self.origin.len() == spheres && drift.approach() + skin <= self.skin
    }

    /// How far spheres, each with its number, are from the places for which the list was made.
    pub(crate) fn drift(&self, unfolded: impl Iterator<Item = (DVec3, usize)>) -> Drift {
        let here_and_there =
            unfolded.filter_map(|(place, number)| Some((place, self.origin.get(number)?)));
        Drift::between(here_and_there)
    }

    /// All histories but fresh ones, with their pairs, in order.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = (u32, u32, H)> {
        let all = self.iter().map(|(i, j, history)| (i, j, *history));
        all.filter(|(.., history)| *history != H::default())
    }

    /// Takes all histories out, which [`Neighbours::carry_on`] puts into the next list; leaves fresh ones.
    pub(crate) fn carry_out(&mut self) {
        let mut carried = core::mem::take(&mut self.carried);
        carried.clear();
        carried.extend(self.remembered());
        self.carried = carried;
        self.history.fill(H::default());
    }

    /// Puts back the histories that were taken out of the list before.
    pub(crate) fn carry_on(&mut self) {
        let carried = core::mem::take(&mut self.carried);
        // Contacts that ended in this very step are listed once more, however far their spheres have jumped: what they
        // remember must be accounted for.
        let pairs = carried.iter().map(|&(i, j, _)| (i, j));
        let far: Vec<_> = pairs.filter(|&(i, j)| self.place(i, j).is_none()).collect();
        if !far.is_empty() {
            self.rows.insert(&far);
        }
        self.histories_mut();
        for &(i, j, history) in &carried {
            self.set_history(i, j, history);
        }
        self.carried = carried;
    }

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 + skin, in a time that grows linearly with
    /// the number of spheres. All histories must be fresh, and none is looked at before [`Neighbours::carry_on`] or
    /// [`Neighbours::histories_mut`].
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
        let early = rule.admits_all_below.min(position.len());
        let Self { cells, found, .. } = self;
        let [early_cells, late_cells] = &mut *cells;
        let mut sorts = [(early_cells, 0..early), (late_cells, early..position.len())];
        threads.each(&mut sorts, (), &|_| 0, &|(cells, numbers), ()| {
            cells.sort(grid, position, rule.diameter, numbers.clone());
        });
        // The partners of a sphere have larger numbers.
        for (first, found) in found.iter_mut().enumerate() {
            search(found, &cells[first..], rule, threads);
        }
        threads.each(&mut found[1], (), &|_| 0, &|piece, ()| {
            piece.found.retain(&rule.admits);
        });
        let found = [&found[0][..], &found[1]];
        self.next
            .collect(position.len(), found, &mut self.collecting, threads);
        self.skin = rule.skin;
        self.origin.clear();
        let unfolded = position.iter().zip(turns);
        let unfolded = unfolded.map(|(p, &turns)| p.with_z(p.z + f64::from(turns) * rule.length));
        self.origin.extend(unfolded);
        core::mem::swap(&mut self.rows, &mut self.next);
        debug_assert_eq!(self.rows(), position.len());
    }
}

/// Searches for the partners of the spheres in the first of these cells, among all; the pieces of the answer are as many as
/// serve the threads.
fn search<F: Fn(usize, usize) -> bool + Sync>(
    pieces: &mut Vec<Piece>,
    cells: &[Cells],
    rule: &PairRule<'_, F>,
    threads: &Threads,
) {
    let number = threads.stretches(rule.diameter.len());
    let begin = |piece: usize| piece * cells[0].number() / number;
    pieces.resize_with(number, Piece::default);
    for (number, piece) in pieces.iter_mut().enumerate() {
        piece.cells = begin(number)..begin(number + 1);
    }
    threads.each(pieces, (), &|_| 0, &|piece, ()| {
        Instructions::widest().run(Search {
            cells,
            skin: rule.skin,
            length: rule.length,
            piece,
        });
    });
}

/// The larger of two numbers, where [`f64::max`] would look for NaN as well.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
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

    /// Of spheres that are here now and were there.
    fn between<'a>(here_and_there: impl Iterator<Item = (DVec3, &'a DVec3)>) -> Self {
        Self::of(here_and_there.map(|(here, there)| here - *there))
    }

    /// The bounds of these displacements, or velocities.
    pub(crate) fn of(displacements: impl Iterator<Item = DVec3>) -> Self {
        let mut drift = Self::NONE;
        for by in displacements {
            drift.lateral_squared = larger(drift.lateral_squared, by.x * by.x + by.y * by.y);
            drift.least = -larger(-drift.least, -by.z);
            drift.largest = larger(drift.largest, by.z);
        }
        drift
    }

    /// Of these spheres and of others.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            largest: self.largest.max(other.largest),
            lateral_squared: self.lateral_squared.max(other.lateral_squared),
        }
    }

    /// By how much two of the spheres may have come closer \[d\]; how fast they may, of velocities.
    pub(crate) fn approach(self) -> f64 {
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
