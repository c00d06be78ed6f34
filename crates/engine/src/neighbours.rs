//! Pairs of moving spheres that may touch, and the memory of their contacts.
//!
//! Each pair i < j stands once, in row i, partners ascending. A sphere therefore collects its forces in the order of its
//! partners' numbers, whatever the skin and whenever the list was made: results do not depend on either by a single bit,
//! and a snapshot needs no list.

use glam::DVec3;

/// Rows of partners with a value of type `H` beside each pair.
#[derive(Clone, Debug)]
pub struct Neighbours<H> {
    /// Row i is `partner[start[i]..start[i + 1]]`.
    start: Vec<u32>,
    partner: Vec<u32>,
    history: Vec<H>,
    /// Unfolded positions when the list was made.
    origin: Vec<DVec3>,
    scratch: Scratch<H>,
}

#[derive(Clone, Debug)]
struct Scratch<H> {
    cell_of: Vec<u32>,
    cell_start: Vec<u32>,
    sorted: Vec<u32>,
    start: Vec<u32>,
    partner: Vec<u32>,
    history: Vec<H>,
}

impl<H> Default for Scratch<H> {
    fn default() -> Self {
        Self {
            cell_of: Vec::new(),
            cell_start: Vec::new(),
            sorted: Vec::new(),
            start: Vec::new(),
            partner: Vec::new(),
            history: Vec::new(),
        }
    }
}

/// Rectangular cells of a tube, at least `cutoff` wide; beyond the outermost cells across the tube a sphere belongs to
/// the nearest, so that one that has escaped is still found.
struct Grid {
    across: u32,
    along: u32,
    half_width: f64,
    per_across: f64,
    per_along: f64,
}

/// More cells across than this would cost more to visit than they save.
const MOST_CELLS_ACROSS: f64 = 256.0;

impl Grid {
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

/// What decides which pairs are listed.
pub struct PairRule<'a, F: Fn(usize, usize) -> bool> {
    /// Diameters of the spheres \[d\].
    pub diameter: &'a [f64],
    /// Period of the tube \[d\].
    pub length: f64,
    /// Added to the reach of every pair \[d\].
    pub skin: f64,
    /// Half width of the region where spheres usually are \[d\].
    pub half_width: f64,
    /// Which pairs i < j can have a contact at all.
    pub admits: F,
}

impl<H: Copy + Default + PartialEq> Neighbours<H> {
    /// A list without pairs, which the first [`Neighbours::rebuild`] fills.
    #[must_use]
    pub fn empty() -> Self {
        Self {
            start: vec![0],
            partner: Vec::new(),
            history: Vec::new(),
            origin: Vec::new(),
            scratch: Scratch::default(),
        }
    }

    /// Number of listed pairs.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.partner.len()
    }

    /// The partners of sphere i with larger numbers, and what their contacts remember.
    #[inline(always)]
    pub fn row(&mut self, i: usize) -> (&[u32], &mut [H]) {
        let range = self.start[i] as usize..self.start[i + 1] as usize;
        (&self.partner[range.clone()], &mut self.history[range])
    }

    /// All pairs with their histories, in order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.start.len() - 1).flat_map(move |i| {
            let range = self.start[i] as usize..self.start[i + 1] as usize;
            self.partner[range.clone()]
                .iter()
                .zip(&self.history[range])
                .map(move |(&j, history)| (i as u32, j, history))
        })
    }

    /// Sets the history of a listed pair; `false` where the pair is not listed.
    pub fn set_history(&mut self, i: u32, j: u32, history: H) -> bool {
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
    #[must_use]
    pub fn outdated(&self, position: &[DVec3], turns: &[i32], length: f64, skin: f64) -> bool {
        if self.origin.len() != position.len() {
            return true;
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
        axial * axial + 4.0 * lateral > skin * skin
    }

    /// Makes the list anew: all admitted pairs closer than (d_i + d_j)/2 + skin, and those that still remember a
    /// contact, in a time that grows linearly with the number of spheres. Histories move with their pairs.
    pub fn rebuild<F: Fn(usize, usize) -> bool>(
        &mut self,
        position: &[DVec3],
        turns: &[i32],
        rule: &PairRule<'_, F>,
    ) {
        let number = position.len();
        let largest_diameter = rule.diameter.iter().copied().fold(0.0, f64::max);
        let cutoff = largest_diameter + rule.skin;
        let grid = Grid::new(position, cutoff, rule.length, rule.half_width + cutoff);
        self.sort_into_cells(position, &grid);

        let Scratch {
            cell_of: _,
            cell_start,
            sorted,
            start,
            partner,
            history,
        } = &mut self.scratch;
        start.clear();
        partner.clear();
        history.clear();
        start.push(0);
        for (i, &centre) in position.iter().enumerate() {
            let begin = partner.len();
            let [cx, cy, cz] = grid.cell(centre);
            for z in axial_cells(cz, grid.along) {
                for y in cy.saturating_sub(1)..=(cy + 1).min(grid.across - 1) {
                    for x in cx.saturating_sub(1)..=(cx + 1).min(grid.across - 1) {
                        let cell = grid.index([x, y, z]);
                        let members = cell_start[cell] as usize..cell_start[cell + 1] as usize;
                        for &j in &sorted[members] {
                            let other = j as usize;
                            if other <= i {
                                continue;
                            }
                            let reach = 0.5 * (rule.diameter[i] + rule.diameter[other]) + rule.skin;
                            let separation = periodic(centre - position[other], rule.length);
                            if separation.length_squared() < reach * reach
                                && (rule.admits)(i, other)
                            {
                                partner.push(j);
                            }
                        }
                    }
                }
            }
            let old = if i + 1 < self.start.len() {
                self.start[i] as usize..self.start[i + 1] as usize
            } else {
                0..0
            };
            // A contact that ended in this very step is listed once more, however far its spheres have jumped: what it
            // remembers must be accounted for.
            let near = partner.len();
            for at in old.clone() {
                let remembers = self.history[at] != H::default();
                if remembers && !partner[begin..near].contains(&self.partner[at]) {
                    partner.push(self.partner[at]);
                }
            }
            partner[begin..].sort_unstable();
            start.push(partner.len() as u32);
            let (old_partner, old_history) = (&self.partner[old.clone()], &self.history[old]);
            history.extend(partner[begin..].iter().map(|j| {
                old_partner
                    .binary_search(j)
                    .map_or_else(|_| H::default(), |at| old_history[at])
            }));
        }
        core::mem::swap(&mut self.start, start);
        core::mem::swap(&mut self.partner, partner);
        core::mem::swap(&mut self.history, history);
        self.origin.clear();
        self.origin.extend(
            position
                .iter()
                .zip(turns)
                .map(|(p, &turns)| DVec3::new(p.x, p.y, p.z + f64::from(turns) * rule.length)),
        );
        debug_assert_eq!(self.start.len(), number + 1);
    }

    /// Counting sort of the spheres into cells.
    fn sort_into_cells(&mut self, position: &[DVec3], grid: &Grid) {
        let Scratch {
            cell_of,
            cell_start,
            sorted,
            ..
        } = &mut self.scratch;
        cell_of.clear();
        cell_of.extend(position.iter().map(|&p| grid.index(grid.cell(p)) as u32));
        cell_start.clear();
        cell_start.resize(grid.cells() + 1, 0);
        for &cell in cell_of.iter() {
            cell_start[cell as usize + 1] += 1;
        }
        for cell in 0..grid.cells() {
            cell_start[cell + 1] += cell_start[cell];
        }
        sorted.clear();
        sorted.resize(position.len(), 0);
        // Filling backwards leaves each cell's start where it belongs.
        for (sphere, &cell) in cell_of.iter().enumerate().rev() {
            cell_start[cell as usize + 1] -= 1;
            sorted[cell_start[cell as usize + 1] as usize] = sphere as u32;
        }
        // After the backward fill entry c + 1 holds the start of cell c.
        cell_start.remove(0);
        cell_start.push(position.len() as u32);
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
