//! Spheres by cells, and the search for pairs among them, eight candidates at a time.

use core::ops::Range;
use core::slice;

use glam::DVec3;
use peristalsis_physics::real::Real;

use super::larger;
use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::{Machine, Work};

/// The rule by which pairs are listed.
pub(crate) struct PairRule<'a, F: Fn(usize, usize) -> bool> {
    /// Diameters of the spheres \[d\].
    pub(crate) diameter: &'a [f64],
    /// Period of the tube \[d\].
    pub(crate) length: f64,
    /// Added to the reach of a pair, for each of its spheres: for a grain, and for a sphere of the wall \[d\].
    pub(crate) skins: [f64; 2],
    /// Half width of the region where spheres usually are \[d\].
    pub(crate) half_width: f64,
    /// How many spheres are grains; they come first, and all their pairs can have a contact.
    pub(crate) grains: usize,
    /// Which pairs i < j of spheres of the wall can have a contact at all.
    pub(crate) admits: F,
}

/// Partners of some spheres, in no order.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub(super) partner: Vec<u32>,
    /// Each of the spheres, and where its partners end.
    pub(super) ends: Vec<(u32, u32)>,
}

impl Found {
    /// Keeps the pairs i < j that `admits` admits.
    pub(super) fn retain(&mut self, admits: impl Fn(usize, usize) -> bool) {
        let (mut begin, mut kept) = (0, 0);
        for (i, end) in &mut self.ends {
            for at in begin..*end as usize {
                let j = self.partner[at];
                self.partner[kept] = j;
                kept += usize::from(admits(*i as usize, j as usize));
            }
            begin = *end as usize;
            *end = kept as u32;
        }
        self.partner.truncate(kept);
    }
}

/// Some cells, whose spheres' partners are searched for.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    pub(super) cells: Range<usize>,
    pub(super) found: Found,
    /// The spheres in a cell and beside it.
    around: Side,
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

    /// Cells at least as wide as the farthest pair of a rule that has a grain, and such for pairs of spheres of the wall.
    pub(super) fn of<F: Fn(usize, usize) -> bool>(
        position: &[DVec3],
        rule: &PairRule<'_, F>,
    ) -> [Self; 2] {
        let largest_diameter = rule.diameter.iter().copied().fold(0.0, larger);
        // Spheres that fly away must not stretch the grid without bound.
        let farthest = position
            .iter()
            .fold(0.0, |far, p| larger(larger(far, p.x.abs()), p.y.abs()));
        let [of_grain, of_wall] = rule.skins;
        [of_grain + larger(of_grain, of_wall), of_wall + of_wall].map(|skin| {
            let cutoff = largest_diameter + skin;
            let usual_half_width = rule.half_width + cutoff;
            let half_width = farthest.min(usual_half_width).max(0.5 * cutoff);
            // Never many more cells than spheres.
            Self::new(half_width, cutoff, rule.length, 4 * position.len())
        })
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
        // What is less than 0 becomes 0.
        let across = |coordinate: f64| {
            let cell = (coordinate + self.half_width) * self.per_across;
            (cell as u32).min(self.across - 1)
        };
        let along = ((position.z * self.per_along) as u32).min(self.along - 1);
        [across(position.x), across(position.y), along]
    }

    pub(crate) fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        ((z * self.across + y) * self.across + x) as usize
    }
}

/// Spheres side by side, with room for eight more.
#[derive(Clone, Debug, Default)]
struct Side {
    place: Columns,
    /// Radius, with its part of the skin.
    radius: Vec<f64>,
    number: Vec<u32>,
    /// The numbers once more, to be compared in lanes.
    number_in_lanes: Vec<f64>,
}

impl Side {
    /// Makes room for so many.
    fn resize(&mut self, spheres: usize) {
        for column in self.place.each() {
            column.resize(spheres + LANES, 0.0);
        }
        self.radius.resize(spheres + LANES, 0.0);
        self.number.resize(spheres + LANES, 0);
        self.number_in_lanes.resize(spheres + LANES, 0.0);
    }

    /// The first so many, eight by eight, and whatever fills up the last eight.
    #[inline(always)]
    fn blocks(&self, spheres: usize) -> impl Iterator<Item = Block<'_>> {
        let all = ..spheres.next_multiple_of(LANES);
        let Columns { x, y, z } = &self.place;
        let [x, y, z, radius, number_in_lanes] =
            [x, y, z, &self.radius, &self.number_in_lanes].map(|column| eights(&column[all]));
        let places = x.zip(y).zip(z).zip(radius);
        let numbers = number_in_lanes.zip(eights(&self.number[all]));
        places
            .zip(numbers)
            .map(|((((x, y), z), radius), (number_in_lanes, number))| Block {
                x,
                y,
                z,
                radius,
                number_in_lanes,
                number,
            })
    }

    /// Copies the eight from place `from` on of others to place `to` and on.
    #[inline(always)]
    fn copy<M: Machine>(&mut self, to: usize, others: &Self, from: usize) {
        self.place.store(to, others.place.load::<M>(from));
        Lanes::<M>::load(&others.radius, from).store(&mut self.radius, to);
        Lanes::<M>::load(&others.number_in_lanes, from).store(&mut self.number_in_lanes, to);
        self.number[to..to + LANES].copy_from_slice(&others.number[from..from + LANES]);
    }
}

/// Eight spheres side by side.
struct Block<'a> {
    x: &'a [f64; LANES],
    y: &'a [f64; LANES],
    z: &'a [f64; LANES],
    radius: &'a [f64; LANES],
    number_in_lanes: &'a [f64; LANES],
    number: &'a [u32; LANES],
}

fn eights<T>(column: &[T]) -> slice::Iter<'_, [T; LANES]> {
    column.as_chunks().0.iter()
}

/// Spheres in the order of their cells; in a cell by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    grid: Grid,
    cell_of: Vec<u32>,
    /// Cell c holds the places `start[c]..start[c + 1]`.
    start: Vec<u32>,
    spheres: Side,
}

impl Cells {
    /// Counting sort of some spheres into the cells of a grid.
    pub(super) fn sort<F: Fn(usize, usize) -> bool>(
        &mut self,
        grid: Grid,
        position: &[DVec3],
        rule: &PairRule<'_, F>,
        numbers: Range<usize>,
    ) {
        self.grid = grid;
        let (grid, start) = (&self.grid, &mut self.start);
        self.cell_of.clear();
        let cells = position[numbers.clone()]
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
        self.spheres.resize(numbers.len());
        // Filling backwards brings each cell's end down to its start.
        for (sphere, &cell) in numbers.zip(&self.cell_of).rev() {
            let place = &mut start[cell as usize];
            *place -= 1;
            let at = *place as usize;
            self.spheres.place.set(at, position[sphere]);
            let skin = rule.skins[usize::from(sphere >= rule.grains)];
            self.spheres.radius[at] = 0.5 * rule.diameter[sphere] + skin;
            self.spheres.number[at] = sphere as u32;
            self.spheres.number_in_lanes[at] = sphere as f64;
        }
    }

    pub(super) fn number(&self) -> usize {
        self.grid.cells()
    }

    fn of_cell(&self, cell: usize) -> Range<usize> {
        self.start[cell] as usize..self.start[cell + 1] as usize
    }

    /// Copies the spheres in a cell and beside it behind the first `number` of others; answers how many there are then.
    #[inline(always)]
    fn gather<M: Machine>(&self, cell: usize, around: &mut Side, mut number: usize) -> usize {
        let grid = &self.grid;
        let across = grid.across as usize;
        let (x, y) = ((cell % across) as u32, (cell / across % across) as u32);
        let z = (cell / (across * across)) as u32;
        let (first_x, last_x) = grid.beside(x).into_inner();
        for z in grid.beside_along(z) {
            for y in grid.beside(y) {
                // Cells beside each other across the tube are beside each other in the columns.
                let from = self.start[grid.index([first_x, y, z])] as usize;
                let to = self.start[grid.index([last_x, y, z]) + 1] as usize;
                let whole = number + to - from;
                if around.number.len() < whole + 2 * LANES {
                    around.resize(2 * whole + 2 * LANES);
                }
                for block in (from..to).step_by(LANES) {
                    around.copy::<M>(number + block - from, &self.spheres, block);
                }
                number = whole;
            }
        }
        number
    }
}

/// The search, in some cells, for partners: pairs i < j nearer than (d_i + d_j)/2 and their skin.
pub(super) struct Search<'a> {
    /// In one grid: the spheres i, and all that may be spheres j.
    pub(super) cells: &'a [Cells],
    /// Period of the tube \[d\].
    pub(super) length: f64,
    pub(super) piece: &'a mut Piece,
}

impl Work for Search<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            cells,
            length,
            piece,
        } = self;
        let Piece {
            cells: these,
            found: Found { partner, ends },
            around,
        } = piece;
        ends.clear();
        let of = &cells[0];
        let whole = Lanes::<M>::splat(length);
        let mut end = 0;
        for cell in these.clone() {
            let own = of.of_cell(cell);
            if own.is_empty() {
                continue;
            }
            let mut number = 0;
            for cells in cells {
                number = cells.gather::<M>(cell, around, number);
            }
            // Behind the last no number is larger.
            Lanes::<M>::splat(f64::NEG_INFINITY).store(&mut around.number_in_lanes, number);
            for i in own {
                if partner.len() < end + number + LANES {
                    partner.resize(2 * (end + number) + 64 * LANES, 0);
                }
                let centre = of.spheres.place.get(i);
                let place = LaneVector::<M>::new(
                    Lanes::splat(centre.x),
                    Lanes::splat(centre.y),
                    Lanes::splat(centre.z),
                );
                let reach = Lanes::splat(of.spheres.radius[i]);
                let this = Lanes::splat(of.spheres.number_in_lanes[i]);
                for block in around.blocks(number) {
                    let places = LaneVector::new(
                        Lanes::from_array(block.x),
                        Lanes::from_array(block.y),
                        Lanes::from_array(block.z),
                    );
                    let mut separation = place - places;
                    // To the nearest image.
                    let axial = separation.z.abs();
                    separation.z = axial.min(whole - axial);
                    let reach = reach + Lanes::from_array(block.radius);
                    let near = separation.squared().less(reach * reach)
                        & this.less(Lanes::from_array(block.number_in_lanes));
                    let window = partner[end..].first_chunk_mut();
                    near.choose(block.number, window.expect("room for a block"));
                    end += near.count() as usize;
                }
                ends.push((of.spheres.number[i], end as u32));
            }
        }
        partner.truncate(end);
    }
}
