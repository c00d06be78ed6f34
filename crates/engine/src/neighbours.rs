//! Pairs of moving spheres that may touch, and the memory of their contacts.
//!
//! Each pair i < j stands once, in row i, partners ascending. A sphere therefore collects its forces in the order of its
//! partners' numbers, whatever the skin and whenever the list was made: results do not depend on either by a single bit,
//! and a snapshot needs no list.

mod cells;

use glam::DVec3;

use self::cells::{Cells, Grid, Search};
use crate::fast::machine::Instructions;

/// Rows of partners with a value of type `H` beside each pair.
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<H> {
    /// Row i is `partner[start[i]..start[i + 1]]`.
    start: Vec<u32>,
    partner: Vec<u32>,
    history: Vec<H>,
    /// Unfolded positions when the list was made.
    origin: Vec<DVec3>,
    /// Skin with which it was made.
    skin: f64,
    scratch: Scratch<H>,
}

#[derive(Clone, Debug, Default)]
struct Scratch<H> {
    cells: Cells,
    late_cells: Cells,
    start: Vec<u32>,
    partner: Vec<u32>,
    history: Vec<H>,
    remembered: Vec<(u32, u32)>,
}

/// The rule by which pairs are listed.
pub(crate) struct PairRule<'a, F: Fn(usize, usize) -> bool> {
    /// Diameters of the spheres \[d\].
    pub(crate) diameter: &'a [f64],
    /// Period of the tube \[d\].
    pub(crate) length: f64,
    /// Added to the reach of every pair \[d\].
    pub(crate) skin: f64,
    /// Half width of the region where spheres usually are \[d\].
    pub(crate) half_width: f64,
    /// All pairs i < j whose i is less than this can have a contact.
    pub(crate) admits_all_below: usize,
    /// Which of the other pairs i < j can have a contact at all.
    pub(crate) admits: F,
}

impl<H: Copy + Default + PartialEq> Neighbours<H> {
    /// A list without pairs, which the first [`Neighbours::rebuild`] fills.
    pub(crate) fn empty() -> Self {
        Self {
            start: vec![0],
            partner: Vec::new(),
            history: Vec::new(),
            origin: Vec::new(),
            skin: 0.0,
            scratch: Scratch::default(),
        }
    }

    /// Number of listed pairs.
    #[cfg(test)]
    fn pairs(&self) -> usize {
        self.partner.len()
    }

    /// The partners of sphere i with larger numbers, and the histories of their contacts.
    #[inline(always)]
    pub(crate) fn row(&mut self, i: usize) -> (&[u32], &mut [H]) {
        let range = self.start[i] as usize..self.start[i + 1] as usize;
        (&self.partner[range.clone()], &mut self.history[range])
    }

    /// Number of pairs in the first so many rows.
    pub(crate) fn pairs_above(&self, rows: usize) -> usize {
        self.start[rows] as usize
    }

    /// Number of rows: spheres when the list was made.
    pub(crate) fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// The partners of sphere i with larger numbers.
    pub(crate) fn partners(&self, i: usize) -> &[u32] {
        &self.partner[self.start[i] as usize..self.start[i + 1] as usize]
    }

    /// The histories of all pairs, row after row.
    pub(crate) fn histories(&self) -> &[H] {
        &self.history
    }

    /// The histories of all pairs, row after row.
    pub(crate) fn histories_mut(&mut self) -> &mut [H] {
        &mut self.history
    }

    /// All pairs with their histories, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.start.len() - 1).flat_map(move |i| {
            let range = self.start[i] as usize..self.start[i + 1] as usize;
            self.partner[range.clone()]
                .iter()
                .zip(&self.history[range])
                .map(move |(&j, history)| (i as u32, j, history))
        })
    }

    /// Sets the history of a listed pair; `false` where the pair is not listed.
    pub(crate) fn set_history(&mut self, i: u32, j: u32, history: H) -> bool {
        let range = self.start[i as usize] as usize..self.start[i as usize + 1] as usize;
        match self.partner[range.clone()].binary_search(&j) {
            Ok(at) => {
                self.history[range.start + at] = history;
                true
            }
            Err(_) => false,
        }
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
        self.approach(position, turns, length) > skin
    }

    /// Whether the list holds all admitted pairs that are now closer than (d_i + d_j)/2 + `skin`.
    pub(crate) fn covers(&self, position: &[DVec3], turns: &[i32], length: f64, skin: f64) -> bool {
        self.approach(position, turns, length) + skin <= self.skin
    }

    /// By how much two spheres may have come closer since the list was made \[d\]; infinite for other spheres.
    fn approach(&self, position: &[DVec3], turns: &[i32], length: f64) -> f64 {
        if self.origin.len() != position.len() {
            return f64::INFINITY;
        }
        if position.is_empty() {
            return 0.0;
        }
        let (mut least, mut largest, mut lateral) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for ((position, turns), origin) in position.iter().zip(turns).zip(&self.origin) {
            let dx = position.x - origin.x;
            let dy = position.y - origin.y;
            let dz = position.z + f64::from(*turns) * length - origin.z;
            lateral = lateral.max(dx * dx + dy * dy);
            least = least.min(dz);
            largest = largest.max(dz);
        }
        let axial = largest - least;
        (axial * axial + 4.0 * lateral).sqrt()
    }

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 + skin, and those that still remember a
    /// contact, in a time that grows linearly with the number of spheres. Histories move with their pairs.
    pub(crate) fn rebuild<F: Fn(usize, usize) -> bool>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
    ) {
        let Scratch {
            cells,
            late_cells,
            start,
            partner,
            history,
            remembered,
        } = &mut self.scratch;
        let grid = Grid::of(position, rule);
        cells.sort(grid, position, rule.diameter, 0);
        let late = rule.admits_all_below.min(position.len());
        late_cells.sort(grid, position, rule.diameter, late);
        remembered.clear();
        start.clear();
        partner.clear();
        start.push(0);
        Instructions::widest().run(Search {
            cells,
            late_cells,
            position,
            rule,
            old: (&self.start, &self.partner, &self.history),
            start,
            partner,
            remembered,
        });
        // Only histories of contacts need be moved.
        history.clear();
        history.resize(partner.len(), H::default());
        for &(row, at) in &*remembered {
            let (row, at) = (row as usize, at as usize);
            let new = start[row] as usize..start[row + 1] as usize;
            let to = partner[new.clone()].binary_search(&self.partner[at]);
            history[new.start + to.expect("a pair with a history is listed")] = self.history[at];
        }
        core::mem::swap(&mut self.start, start);
        core::mem::swap(&mut self.partner, partner);
        core::mem::swap(&mut self.history, history);
        self.skin = rule.skin;
        self.origin.clear();
        self.origin.extend(
            position
                .iter()
                .zip(turns)
                .map(|(p, &turns)| DVec3::new(p.x, p.y, p.z + f64::from(turns) * rule.length)),
        );
        debug_assert_eq!(self.start.len(), position.len() + 1);
    }
}

/// Separation with z brought to the nearest image in a tube of period L, for two positions in \[0, L).
#[inline(always)]
#[must_use]
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
