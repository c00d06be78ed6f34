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
    /// How many spheres are grains, and the skins with which it was made.
    grains: usize,
    skins: [f64; 2],
    /// Grains, and spheres of the wall, in cells of the range of grains; spheres of the wall in cells of their own range.
    cells: [Cells; 3],
    /// Pairs whose first sphere is a grain, and those whose first is of the wall.
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
            grains: 0,
            skins: [0.0; 2],
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

    /// The partners of sphere i with larger numbers, from `first` on, each with its history.
    pub(crate) fn pairs_of(&self, i: usize, first: usize) -> impl Iterator<Item = (&u32, &H)> {
        let (partners, histories) = (self.partners(i), &self.history[self.rows.range(i)]);
        let before = partners.partition_point(|&j| (j as usize) < first);
        partners[before..].iter().zip(&histories[before..])
    }

    /// All pairs with their histories, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.rows()).flat_map(move |i| {
            let row = self.pairs_of(i, 0);
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

    /// Whether the list holds all admitted pairs that are now closer than (d_i + d_j)/2 + `range`.
    ///
    /// The bound is on differences of displacement: spheres that drift along the tube together never outdate the list.
    pub(crate) fn holds(&self, position: &[DVec3], turns: &[i32], length: f64, range: f64) -> bool {
        let by = |numbers: Range<usize>| {
            let here = unfolded(&position[numbers.clone()], &turns[numbers.clone()], length);
            self.drift(here.zip(numbers))
        };
        let grains = self.grains.min(position.len());
        let drifts = [by(0..grains), by(grains..position.len())];
        self.covers(position.len(), &drifts, [0.5 * range; 2])
    }

    /// Whether the list holds all admitted pairs of so many spheres that are now within these skins; `drifts` are those of
    /// all grains and all spheres of the wall.
    pub(crate) fn covers(&self, spheres: usize, drifts: &[Drift; 2], skins: [f64; 2]) -> bool {
        let left = [0, 1].map(|kind| self.skins[kind] - skins[kind]);
        self.origin.len() == spheres && are_within(drifts, left)
    }

    /// How far spheres, each with its number, are from the places for which the list was made.
    pub(crate) fn drift(&self, unfolded: impl Iterator<Item = (DVec3, usize)>) -> Drift {
        let by = |(place, number): (DVec3, usize)| Some(place - *self.origin.get(number)?);
        Drift::of(unfolded.filter_map(by))
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

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 and their skin, in a time that grows linearly with
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
        let grains = rule.grains.min(position.len());
        let [of_grains, of_wall] = Grid::of(position, rule);
        let Self { cells, found, .. } = self;
        let [grains_cells, beside, wall_cells] = &mut *cells;
        let mut sorts = [
            (grains_cells, of_grains, 0..grains),
            (beside, of_grains, grains..position.len()),
            (wall_cells, of_wall, grains..position.len()),
        ];
        threads.each(&mut sorts, (), &|_| 0, &|(cells, grid, numbers), ()| {
            cells.sort(*grid, position, rule, numbers.clone());
        });
        // The partners of a sphere have larger numbers.
        let [of_grains, of_wall] = found;
        search(of_grains, &cells[..2], rule, threads);
        search(of_wall, &cells[2..], rule, threads);
        threads.each(of_wall, (), &|_| 0, &|piece, ()| {
            piece.found.retain(&rule.admits);
        });
        let found = [&found[0][..], &found[1]];
        self.next
            .collect(position.len(), found, &mut self.collecting, threads);
        (self.grains, self.skins) = (grains, rule.skins);
        self.origin.clear();
        self.origin.extend(unfolded(position, turns, rule.length));
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

/// Where spheres would be in a tube without a period.
fn unfolded<'a>(
    position: &'a [DVec3],
    turns: &'a [i32],
    length: f64,
) -> impl Iterator<Item = DVec3> + use<'a> {
    let spheres = position.iter().zip(turns);
    spheres.map(move |(p, &turns)| p.with_z(p.z + f64::from(turns) * length))
}

/// Bounds of displacements, or of velocities; by default of spheres that stand still.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    /// Along the tube.
    pub(crate) least: f64,
    pub(crate) largest: f64,
    /// Largest across it, whatever the direction.
    pub(crate) lateral: f64,
}

impl Drift {
    /// Of no spheres.
    pub(crate) const NONE: Self = Self {
        least: f64::INFINITY,
        largest: f64::NEG_INFINITY,
        lateral: 0.0,
    };
    /// Of spheres that may be anywhere.
    pub(crate) const UNBOUNDED: Self = Self {
        least: 0.0,
        largest: 0.0,
        lateral: f64::INFINITY,
    };

    /// The bounds of these displacements or velocities.
    pub(crate) fn of(displacements: impl Iterator<Item = DVec3>) -> Self {
        let (mut drift, mut lateral_squared) = (Self::NONE, 0.0);
        for by in displacements {
            lateral_squared = larger(lateral_squared, by.x * by.x + by.y * by.y);
            drift.least = -larger(-drift.least, -by.z);
            drift.largest = larger(drift.largest, by.z);
        }
        drift.lateral = lateral_squared.sqrt();
        drift
    }

    /// Of these spheres and of others.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            largest: self.largest.max(other.largest),
            lateral: self.lateral.max(other.lateral),
        }
    }

    /// Of one displacement after the other.
    pub(crate) fn then(self, next: Self) -> Self {
        Self {
            least: self.least + next.least,
            largest: self.largest + next.largest,
            lateral: self.lateral + next.lateral,
        }
    }

    /// By how much one of these spheres and one of others may have come closer \[d\]; how fast they may, of velocities.
    pub(crate) fn approach(self, other: Self) -> f64 {
        let axial = (self.largest - other.least).max(other.largest - self.least);
        libm::hypot(axial.max(0.0), self.lateral + other.lateral)
    }
}

/// Grains with grains, grains with the wall, the wall with itself.
const KINDS: [[usize; 2]; 3] = [[0, 0], [0, 1], [1, 1]];

/// Whether no two spheres may have come closer by more than the skin of their pair.
pub(crate) fn are_within(drifts: &[Drift; 2], skins: [f64; 2]) -> bool {
    let within = |[a, b]: [usize; 2]| drifts[a].approach(drifts[b]) <= skins[a] + skins[b];
    KINDS.into_iter().all(within)
}

/// The parts that a grain and a sphere of the wall have in a skin: as the speeds of their kinds, by which the list lasts
/// longest. Pairs with a grain have a whole skin at most.
pub(crate) fn skin_shares([grains, of_wall]: &[Drift; 2]) -> [f64; 2] {
    let [grains, of_wall] = [grains, of_wall].map(|kind| kind.approach(*kind));
    match of_wall / (grains + of_wall) {
        share if share > 0.0 => {
            let share = share.clamp(0.25, 0.75);
            let most = (2.0 * (1.0 - share)).max(1.0);
            [1.0 - share, share].map(|part| part / most)
        }
        _ => [0.5; 2],
    }
}

/// For how long none do at these velocities; 0 where they never do.
pub(crate) fn time_within(velocities: &[Drift; 2], skins: [f64; 2]) -> f64 {
    let rates = KINDS.map(|[a, b]| velocities[a].approach(velocities[b]) / (skins[a] + skins[b]));
    match rates.into_iter().fold(0.0, larger) {
        0.0 => 0.0,
        rate => 1.0 / rate,
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
