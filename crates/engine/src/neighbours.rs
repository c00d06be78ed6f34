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

/// Pairs of [`Late`] spheres are seldom near, so the search for them goes farther than the skin \[d\] and serves several lists.
const FARTHER: f64 = 1.0;

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
    late: Late,
    cells: Cells,
    late_cells: Cells,
    pieces: Vec<Piece>,
    collecting: Collecting,
    /// Room: pairs that remember a contact, as (i, j, place in the list before).
    remembered: Vec<[u32; 3]>,
}

/// The last spheres, of whose pairs with each other not all are admitted (those of an elastic wall), as they were when these
/// pairs were searched for.
#[derive(Clone, Debug, Default)]
struct Late {
    /// Number of the first.
    first: usize,
    /// Their unfolded positions.
    origin: Vec<DVec3>,
    /// Skin of the search.
    skin: f64,
    found: Vec<Piece>,
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
            late: Late::default(),
            cells: Cells::default(),
            late_cells: Cells::default(),
            pieces: Vec::new(),
            collecting: Collecting::default(),
            remembered: Vec::new(),
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
        &self.rows.history
    }

    /// The same, to be changed.
    pub(crate) fn histories_mut(&mut self) -> &mut [H] {
        let Rows {
            partner, history, ..
        } = &mut self.rows;
        // Room for later lists, too.
        let room = partner.capacity().max(self.next.partner.capacity());
        history.reserve(room.saturating_sub(history.len()));
        history.resize(partner.len(), H::default());
        history
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

    /// The place of a pair in the list, if it is listed.
    pub(crate) fn place(&self, i: u32, j: u32) -> Option<usize> {
        self.rows.place(i as usize, j)
    }

    /// Sets the history of a listed pair; `false` where the pair is not listed.
    pub(crate) fn set_history(&mut self, i: u32, j: u32, history: H) -> bool {
        let place = self.place(i, j);
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
        self.origin.len() != position.len()
            || Drift::of(unfolded.zip(&self.origin)).approach() > skin
    }

    /// Whether the list holds all admitted pairs of so many spheres that are now closer than (d_i + d_j)/2 + `skin`;
    /// `drift` is the drift of all spheres.
    pub(crate) fn covers(&self, spheres: usize, drift: Drift, skin: f64) -> bool {
        self.origin.len() == spheres && drift.approach() + skin <= self.skin
    }

    /// How far spheres, each with its number, have gone since the list was made.
    pub(crate) fn drift(&self, unfolded: impl Iterator<Item = (DVec3, usize)>) -> Drift {
        let here_and_there =
            unfolded.filter_map(|(place, number)| Some((place, self.origin.get(number)?)));
        Drift::of(here_and_there)
    }

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 + skin, perhaps some farther ones, and those that
    /// still remember a contact, in a time that grows linearly with the number of spheres. Histories move with their pairs.
    pub(crate) fn rebuild<F: Fn(usize, usize) -> bool + Sync>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
        threads: &Threads,
    ) where
        H: Sync,
    {
        self.collect(position, turns, rule, threads);
        self.move_histories();
        core::mem::swap(&mut self.rows, &mut self.next);
    }

    /// The same while others keep the histories: all here are fresh, and none is looked at before
    /// [`Neighbours::histories_mut`].
    pub(crate) fn rebuild_fresh<F: Fn(usize, usize) -> bool + Sync>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
        threads: &Threads,
    ) where
        H: Sync,
    {
        self.collect(position, turns, rule, threads);
        let Self { rows, next, .. } = self;
        core::mem::swap(rows, next);
        // One array of fresh histories serves all these lists.
        core::mem::swap(&mut rows.history, &mut next.history);
    }

    /// Makes the rows to come, without histories.
    fn collect<F: Fn(usize, usize) -> bool + Sync>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
        threads: &Threads,
    ) where
        H: Sync,
    {
        let unfolded = position.iter().zip(turns);
        let unfolded = unfolded.map(|(p, &turns)| p.with_z(p.z + f64::from(turns) * rule.length));
        self.search_late(position, unfolded.clone(), rule, threads);
        let grid = Grid::of(position, rule, rule.skin);
        let early = rule.admits_all_below.min(position.len());
        let (cells, late_cells) = (&mut self.cells, &mut self.late_cells);
        let mut sorts = [(cells, 0..early), (late_cells, early..position.len())];
        threads.each(&mut sorts, (), &|_| 0, &|(cells, numbers), ()| {
            cells.sort(grid, position, rule.diameter, numbers.clone());
        });
        let among = [&self.cells, &self.late_cells];
        search(
            &mut self.pieces,
            &self.cells,
            &among,
            rule.skin,
            rule.length,
            threads,
        );
        let Self { next, .. } = self;
        let found = [&self.pieces[..], &self.late.found];
        next.collect(position.len(), found, &mut self.collecting, threads);
        self.skin = rule.skin;
        self.origin.clear();
        self.origin.extend(unfolded);
        debug_assert_eq!(next.start.len(), position.len() + 1);
    }

    /// Moves the histories that are no fresh ones to the rows to come; the rows of now keep fresh ones alone.
    fn move_histories(&mut self) {
        let Self {
            rows,
            next,
            remembered,
            ..
        } = self;
        remembered.clear();
        for row in 0..rows.start.len() - 1 {
            for at in rows.range(row) {
                if rows.history[at] != H::default() {
                    remembered.push([row as u32, rows.partner[at], at as u32]);
                }
            }
        }
        let place = |next: &Rows<H>, i: u32, j: u32| next.place(i as usize, j);
        // Contacts that ended in this very step are listed once more, however far their spheres have jumped: what they
        // remember must be accounted for.
        let is_far = |&&[i, j, _]: &&[u32; 3]| place(next, i, j).is_none();
        let far = remembered.iter().filter(is_far);
        let far: Vec<_> = far.map(|&[i, j, _]| (i, j)).collect();
        if !far.is_empty() {
            next.insert(&far);
        }
        next.history.resize(next.partner.len(), H::default());
        for &[i, j, at] in &*remembered {
            if let Some(to) = place(next, i, j) {
                next.history[to] = core::mem::take(&mut rows.history[at as usize]);
            }
        }
    }

    /// Searches for the pairs of late spheres, unless what was found before holds all that are wanted.
    fn search_late<F: Fn(usize, usize) -> bool + Sync>(
        &mut self,
        position: &[DVec3],
        unfolded: impl Iterator<Item = DVec3> + Clone,
        rule: &PairRule<'_, F>,
        threads: &Threads,
    ) {
        let first = rule.admits_all_below.min(position.len());
        let late = &mut self.late;
        let unfolded = unfolded.skip(first);
        let same = late.first == first && late.origin.len() == position.len() - first;
        let drift = Drift::of(unfolded.clone().zip(&late.origin));
        if same && drift.approach() + rule.skin <= late.skin {
            return;
        }
        late.first = first;
        late.skin = rule.skin + FARTHER;
        late.origin.clear();
        late.origin.extend(unfolded);
        if late.origin.is_empty() {
            late.found.clear();
            return;
        }
        let grid = Grid::of(position, rule, late.skin);
        let cells = &mut self.late_cells;
        cells.sort(grid, position, rule.diameter, first..position.len());
        let cells = &*cells;
        search(
            &mut late.found,
            cells,
            &[cells],
            late.skin,
            rule.length,
            threads,
        );
        threads.each(&mut late.found, (), &|_| 0, &|piece, ()| {
            piece.found.retain(&rule.admits);
        });
    }
}

/// Searches all cells for partners; the pieces of the answer are as many as serve the threads.
fn search(
    pieces: &mut Vec<Piece>,
    of: &Cells,
    among: &[&Cells],
    skin: f64,
    length: f64,
    threads: &Threads,
) {
    let number = threads.stretches();
    let begin = |piece: usize| piece * of.number() / number;
    pieces.resize_with(number, Piece::default);
    for (number, piece) in pieces.iter_mut().enumerate() {
        piece.cells = begin(number)..begin(number + 1);
    }
    threads.each(pieces, (), &|_| 0, &|piece, ()| {
        Instructions::widest().run(Search {
            of,
            among,
            skin,
            length,
            piece,
        });
    });
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
    fn of<'a>(here_and_there: impl Iterator<Item = (DVec3, &'a DVec3)>) -> Self {
        let mut drift = Self::NONE;
        for (place, origin) in here_and_there {
            let by = place - *origin;
            drift.lateral_squared = drift.lateral_squared.max(by.x * by.x + by.y * by.y);
            drift.least = drift.least.min(by.z);
            drift.largest = drift.largest.max(by.z);
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
