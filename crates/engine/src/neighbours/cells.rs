//! Spheres by cells, and the search for pairs among them, eight candidates at a time.

use glam::DVec3;
use peristalsis_physics::real::Real;

use super::PairRule;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::{Machine, Work};

/// Rectangular cells of a tube, at least `cutoff` wide; beyond the outermost cells across the tube a sphere belongs to
/// the nearest, so that one that has escaped is still found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Grid {
    across: u32,
    along: u32,
    half_width: f64,
    per_across: f64,
    per_along: f64,
}

/// More cells across than this would cost more to visit than they save.
const MOST_CELLS_ACROSS: f64 = 256.0;

impl Grid {
    /// Cells at least as wide as the farthest pair of a rule.
    pub(super) fn of<F: Fn(usize, usize) -> bool>(
        position: &[DVec3],
        rule: &PairRule<'_, F>,
    ) -> Self {
        let largest_diameter = rule.diameter.iter().copied().fold(0.0, f64::max);
        let cutoff = largest_diameter + rule.skin;
        Self::new(position, cutoff, rule.length, rule.half_width + cutoff)
    }

    fn new(position: &[DVec3], cutoff: f64, length: f64, usual_half_width: f64) -> Self {
        // Spheres that fly away must not stretch the grid without bound.
        let farthest = position
            .iter()
            .fold(0.0_f64, |far, p| far.max(p.x.abs()).max(p.y.abs()));
        let half_width = farthest.min(usual_half_width).max(0.5 * cutoff);
        let across = (2.0 * half_width / cutoff)
            .floor()
            .clamp(1.0, MOST_CELLS_ACROSS);
        // Never many more cells than spheres.
        let most_along = (4.0 * position.len() as f64 / (across * across))
            .ceil()
            .max(1.0);
        let along = (length / cutoff).floor().clamp(1.0, most_along);
        Self {
            across: across as u32,
            along: along as u32,
            half_width,
            per_across: across / (2.0 * half_width),
            per_along: along / length,
        }
    }

    fn cells(&self) -> usize {
        self.across as usize * self.across as usize * self.along as usize
    }

    fn cell(&self, position: DVec3) -> [u32; 3] {
        let across = |coordinate: f64| {
            let cell = ((coordinate + self.half_width) * self.per_across).floor();
            cell.clamp(0.0, f64::from(self.across - 1)) as u32
        };
        let along = (position.z * self.per_along)
            .floor()
            .clamp(0.0, f64::from(self.along - 1)) as u32;
        [across(position.x), across(position.y), along]
    }

    fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        ((z * self.across + y) * self.across + x) as usize
    }
}

/// The cell itself and the two beside it along the periodic tube, each once.
fn axial_cells(cell: u32, along: u32) -> impl Iterator<Item = u32> {
    let beside = match along {
        1 => [Some(cell), None, None],
        2 => [Some(cell), Some(1 - cell), None],
        _ => [
            Some((cell + along - 1) % along),
            Some(cell),
            Some((cell + 1) % along),
        ],
    };
    beside.into_iter().flatten()
}

/// Spheres in the order of their cells; in a cell by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    grid: Grid,
    cell_of: Vec<u32>,
    /// Cell c holds the places `start[c]..start[c + 1]` of the columns.
    start: Vec<u32>,
    number: Vec<u32>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    radius: Vec<f64>,
    /// The numbers once more, to be compared in lanes.
    number_in_lanes: Vec<f64>,
}

impl Cells {
    /// Counting sort of the spheres from number `first` on into the cells of a grid.
    pub(super) fn sort(&mut self, grid: Grid, position: &[DVec3], diameter: &[f64], first: usize) {
        self.grid = grid;
        let (grid, start) = (&self.grid, &mut self.start);
        let spheres = position.len() - first;
        self.cell_of.clear();
        let cells = position[first..]
            .iter()
            .map(|&p| grid.index(grid.cell(p)) as u32);
        self.cell_of.extend(cells);
        start.clear();
        start.resize(grid.cells() + 1, 0);
        for &cell in &self.cell_of {
            start[cell as usize] += 1;
        }
        let mut end = 0;
        for start in start.iter_mut() {
            end += *start;
            *start = end;
        }
        // Filling backwards brings each cell's end down to its start.
        self.number.clear();
        self.number.resize(spheres + LANES, 0);
        for (sphere, &cell) in self.cell_of.iter().enumerate().rev() {
            let place = &mut start[cell as usize];
            *place -= 1;
            self.number[*place as usize] = (first + sphere) as u32;
        }
        let filled = self.number[..spheres].iter().map(|&number| number as usize);
        for (column, of) in [
            (&mut self.x, (|p: DVec3| p.x) as fn(DVec3) -> f64),
            (&mut self.y, |p| p.y),
            (&mut self.z, |p| p.z),
        ] {
            column.clear();
            column.extend(filled.clone().map(|sphere| of(position[sphere])));
            column.resize(spheres + LANES, 0.0);
        }
        self.radius.clear();
        self.radius
            .extend(filled.map(|sphere| 0.5 * diameter[sphere]));
        self.radius.resize(spheres + LANES, 0.0);
        self.number_in_lanes.clear();
        self.number_in_lanes
            .extend(self.number.iter().map(|&number| f64::from(number)));
    }
}

/// The search for the pairs of a rule, row by row.
pub(super) struct Search<'a, H, F: Fn(usize, usize) -> bool> {
    /// All spheres.
    pub(super) cells: &'a Cells,
    /// Those alone of whose pairs not all are admitted, in the same grid.
    pub(super) late_cells: &'a Cells,
    pub(super) position: &'a [DVec3],
    pub(super) rule: &'a PairRule<'a, F>,
    /// Rows, partners and histories of the list before.
    pub(super) old: (&'a [u32], &'a [u32], &'a [H]),
    pub(super) start: &'a mut Vec<u32>,
    pub(super) partner: &'a mut Vec<u32>,
    /// Row and place of each pair of the list before that remembers a contact.
    pub(super) remembered: &'a mut Vec<(u32, u32)>,
}

impl<H: Default + PartialEq, F: Fn(usize, usize) -> bool> Work for Search<'_, H, F> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            cells,
            late_cells,
            position,
            rule,
            old: (old_start, old_partner, old_history),
            start,
            partner,
            remembered,
        } = self;
        let grid = &cells.grid;
        partner.resize(partner.capacity().max(64 * LANES), 0);
        let mut end = 0;
        for (i, &centre) in position.iter().enumerate() {
            let begin = end;
            // Partners have larger numbers.
            let cells = if i < rule.admits_all_below {
                cells
            } else {
                late_cells
            };
            let [cx, cy, cz] = grid.cell(centre);
            let (first_x, last_x) = (cx.saturating_sub(1), (cx + 1).min(grid.across - 1));
            let place = LaneVector::<M>::new(
                Lanes::splat(centre.x),
                Lanes::splat(centre.y),
                Lanes::splat(centre.z),
            );
            let reach = Lanes::splat(0.5 * rule.diameter[i] + rule.skin);
            let this = Lanes::splat(i as f64);
            let (half, whole) = (Lanes::splat(0.5 * rule.length), Lanes::splat(rule.length));
            for z in axial_cells(cz, grid.along) {
                for y in cy.saturating_sub(1)..=(cy + 1).min(grid.across - 1) {
                    // Cells beside each other across the tube are beside each other in the columns.
                    let from = cells.start[grid.index([first_x, y, z])] as usize;
                    let to = cells.start[grid.index([last_x, y, z]) + 1] as usize;
                    for block in (from..to).step_by(LANES) {
                        let other = LaneVector::new(
                            Lanes::load(&cells.x, block),
                            Lanes::load(&cells.y, block),
                            Lanes::load(&cells.z, block),
                        );
                        let mut separation = place - other;
                        separation.z = separation.z.abs();
                        separation.z = Lanes::select(
                            half.less(separation.z),
                            whole - separation.z,
                            separation.z,
                        );
                        let reach = reach + Lanes::load(&cells.radius, block);
                        let near = separation.squared().less(reach * reach)
                            & this.less(Lanes::load(&cells.number_in_lanes, block))
                            & Mask::first(to - block);
                        let numbers = &cells.number[block..block + LANES];
                        near.choose(
                            numbers.first_chunk().expect("a block of numbers"),
                            partner[end..].first_chunk_mut().expect("room for a block"),
                        );
                        end += near.count() as usize;
                        if end + LANES > partner.len() {
                            partner.resize(2 * partner.len(), 0);
                        }
                    }
                }
            }
            if i >= rule.admits_all_below {
                let mut kept = begin;
                for at in begin..end {
                    partner[kept] = partner[at];
                    kept += usize::from((rule.admits)(i, partner[at] as usize));
                }
                end = kept;
            }
            // A contact that ended in this very step is listed once more, however far its spheres have jumped: what it
            // remembers must be accounted for.
            let near = end;
            if i + 1 < old_start.len() {
                for at in old_start[i] as usize..old_start[i + 1] as usize {
                    if old_history[at] == H::default() {
                        continue;
                    }
                    remembered.push((i as u32, at as u32));
                    if !partner[begin..near].contains(&old_partner[at]) {
                        partner[end] = old_partner[at];
                        end += 1;
                        if end + LANES > partner.len() {
                            partner.resize(2 * partner.len(), 0);
                        }
                    }
                }
            }
            sort(&mut partner[begin..end]);
            start.push(end as u32);
        }
        partner.truncate(end);
    }
}

/// Sorts a few numbers.
#[inline(always)]
fn sort(numbers: &mut [u32]) {
    if numbers.len() > 24 {
        numbers.sort_unstable();
        return;
    }
    for end in 1..numbers.len() {
        let number = numbers[end];
        let mut at = end;
        while at > 0 && numbers[at - 1] > number {
            numbers[at] = numbers[at - 1];
            at -= 1;
        }
        numbers[at] = number;
    }
}
