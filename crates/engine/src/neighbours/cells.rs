//! Spheres by cells, and the search for pairs among them, eight candidates at a time.

use glam::DVec3;
use peristalsis_physics::real::Real;

use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::{Machine, Work};

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

/// Rows of partners, and a value beside each.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows<H> {
    /// Row i is `start[i]..start[i + 1]` of the others.
    pub(super) start: Vec<u32>,
    pub(super) partner: Vec<u32>,
    pub(super) history: Vec<H>,
}

impl<H> Rows<H> {
    #[inline(always)]
    pub(super) fn range(&self, row: usize) -> core::ops::Range<usize> {
        self.start[row] as usize..self.start[row + 1] as usize
    }

    /// Place of a partner of row `row`, if it is listed.
    pub(super) fn place(&self, row: usize, partner: u32) -> Option<usize> {
        let range = self.range(row);
        let place = self.partner[range.clone()].binary_search(&partner).ok()?;
        Some(range.start + place)
    }
}

impl<H> Rows<H> {
    /// Takes the rows of all pieces, without values.
    pub(super) fn join(&mut self, pieces: &[Piece]) {
        self.start.clear();
        self.start.push(0);
        self.partner.clear();
        let partners = pieces.iter().map(|piece| piece.partner.len()).sum();
        if self.partner.capacity() < partners {
            // Room for later lists, so that they seldom ask for more.
            self.partner.reserve(2 * partners);
        }
        for piece in pieces {
            let end = self.partner.len() as u32;
            self.start
                .extend(piece.ends.iter().map(|of_row| end + of_row));
            self.partner.extend_from_slice(&piece.partner);
        }
    }
}

/// Some rows of a list that is being made.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    pub(super) rows: core::ops::Range<usize>,
    /// Where each row ends in `partner`.
    ends: Vec<u32>,
    partner: Vec<u32>,
    /// Row and place of each pair of the list before that remembers a contact.
    pub(super) remembered: Vec<(u32, u32)>,
}

/// Rectangular cells of a tube, at least `cutoff` wide; beyond the outermost cells across the tube a sphere belongs to
/// the nearest, so that one that has escaped is still found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    across: u32,
    along: u32,
    half_width: f64,
    per_across: f64,
    per_along: f64,
}

/// More cells across than this would cost more to visit than they save.
const MOST_CELLS_ACROSS: f64 = 256.0;

impl Grid {
    /// A cell across the tube and those beside it.
    pub(crate) fn beside(&self, cell: u32) -> core::ops::RangeInclusive<u32> {
        cell.saturating_sub(1)..=(cell + 1).min(self.across - 1)
    }

    /// A cell and the two beside it along the periodic tube, each once.
    pub(crate) fn beside_along(&self, cell: u32) -> impl Iterator<Item = u32> + use<> {
        let along = self.along;
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

    /// Cells at least as wide as the farthest pair of a rule.
    pub(super) fn of<F: Fn(usize, usize) -> bool>(
        position: &[DVec3],
        rule: &PairRule<'_, F>,
    ) -> Self {
        let largest_diameter = rule.diameter.iter().copied().fold(0.0, f64::max);
        let cutoff = largest_diameter + rule.skin;
        // Spheres that fly away must not stretch the grid without bound.
        let farthest = position
            .iter()
            .fold(0.0_f64, |far, p| far.max(p.x.abs()).max(p.y.abs()));
        let usual_half_width = rule.half_width + cutoff;
        let half_width = farthest.min(usual_half_width).max(0.5 * cutoff);
        // Never many more cells than spheres.
        Self::new(half_width, cutoff, rule.length, 4 * position.len())
    }

    /// Cells at least `cutoff` wide, about `most` of them at most where there are several along the tube.
    pub(crate) fn new(half_width: f64, cutoff: f64, length: f64, most: usize) -> Self {
        let across = (2.0 * half_width / cutoff)
            .floor()
            .clamp(1.0, MOST_CELLS_ACROSS);
        let most_along = (most as f64 / (across * across)).ceil().max(1.0);
        let along = (length / cutoff).floor().clamp(1.0, most_along);
        Self {
            across: across as u32,
            along: along as u32,
            half_width,
            per_across: across / (2.0 * half_width),
            per_along: along / length,
        }
    }

    pub(crate) fn cells(&self) -> usize {
        self.across as usize * self.across as usize * self.along as usize
    }

    pub(crate) fn cell(&self, position: DVec3) -> [u32; 3] {
        let across = |coordinate: f64| {
            let cell = ((coordinate + self.half_width) * self.per_across).floor();
            cell.clamp(0.0, f64::from(self.across - 1)) as u32
        };
        let along = (position.z * self.per_along)
            .floor()
            .clamp(0.0, f64::from(self.along - 1)) as u32;
        [across(position.x), across(position.y), along]
    }

    pub(crate) fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        ((z * self.across + y) * self.across + x) as usize
    }
}

/// Spheres in the order of their cells; in a cell by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    grid: Grid,
    cell_of: Vec<u32>,
    /// Cell c holds the places `start[c]..start[c + 1]` of the columns.
    start: Vec<u32>,
    number: Vec<u32>,
    place: Columns,
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
        self.place.clear(spheres + LANES);
        for (place, sphere) in filled.clone().enumerate() {
            self.place.set(place, position[sphere]);
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

/// The search for the pairs of a rule in some rows, row by row.
pub(super) struct Search<'a, H, F: Fn(usize, usize) -> bool> {
    /// All spheres.
    pub(super) cells: &'a Cells,
    /// Those alone of whose pairs not all are admitted, in the same grid.
    pub(super) late_cells: &'a Cells,
    pub(super) position: &'a [DVec3],
    pub(super) rule: &'a PairRule<'a, F>,
    /// The list before.
    pub(super) old: &'a Rows<H>,
    pub(super) piece: &'a mut Piece,
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
            old,
            piece,
        } = self;
        let Piece {
            rows,
            ends,
            partner,
            remembered,
        } = piece;
        ends.clear();
        remembered.clear();
        partner.clear();
        let grid = &cells.grid;
        partner.resize(partner.capacity().max(64 * LANES), 0);
        let mut end = 0;
        for i in rows.clone() {
            let centre = position[i];
            let begin = end;
            // Partners have larger numbers.
            let cells = if i < rule.admits_all_below {
                cells
            } else {
                late_cells
            };
            let [cx, cy, cz] = grid.cell(centre);
            let (first_x, last_x) = grid.beside(cx).into_inner();
            let place = LaneVector::<M>::new(
                Lanes::splat(centre.x),
                Lanes::splat(centre.y),
                Lanes::splat(centre.z),
            );
            let reach = Lanes::splat(0.5 * rule.diameter[i] + rule.skin);
            let this = Lanes::splat(i as f64);
            let (half, whole) = (Lanes::splat(0.5 * rule.length), Lanes::splat(rule.length));
            for z in grid.beside_along(cz) {
                for y in grid.beside(cy) {
                    // Cells beside each other across the tube are beside each other in the columns.
                    let from = cells.start[grid.index([first_x, y, z])] as usize;
                    let to = cells.start[grid.index([last_x, y, z]) + 1] as usize;
                    for block in (from..to).step_by(LANES) {
                        let mut separation = place - cells.place.load(block);
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
            if i + 1 < old.start.len() {
                for at in old.range(i) {
                    if old.history[at] == H::default() {
                        continue;
                    }
                    remembered.push((i as u32, at as u32));
                    if !partner[begin..near].contains(&old.partner[at]) {
                        partner[end] = old.partner[at];
                        end += 1;
                        if end + LANES > partner.len() {
                            partner.resize(2 * partner.len(), 0);
                        }
                    }
                }
            }
            sort(&mut partner[begin..end]);
            ends.push(end as u32);
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
