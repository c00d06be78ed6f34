//! The fast kernel for equal smooth grains in a narrow tube with a prescribed wall.
//!
//! The grains are kept in the order of z. A grain's neighbours are then the few that follow it, at the same offsets for
//! eight grains at a time, so that there is no list of pairs and nothing to gather; copies of the first grains, one
//! period on, close the tube. The order is made anew when grains may have come closer along z by more than the skin.
//!
//! Forces are added up tile by tile, each with room for what it exerts on the next, so that neither the number of
//! threads nor the set of instructions changes a bit.

mod columns;
mod motion;
mod order;
mod pairs;
mod sums;
mod wall;

use std::sync::Arc;

use peristalsis_physics::contact::NormalLaw;
use rayon::ThreadPool;
use rayon::prelude::*;

use self::columns::Columns;
use self::motion::{Moved, Phase};
use self::pairs::{Block, PairConstants};
use self::sums::Sums;
use self::wall::WallTable;
use super::lanes::LANES;
use super::machine::{Instructions, Machine, Work};
use crate::bodies::Bodies;
use crate::integrate::Integrator;
use crate::integrate::Runaway;
use crate::ledger::{Ledger, Tally};
use crate::simulation::Parameters;
use crate::wall::{PrescribedWall, Wall};

pub use self::order::{Sorting, SortingView};

/// Grains in a tile, a multiple of the number of lanes.
const TILE: usize = 128;

/// More grains ahead than this on average are served better by a list of neighbours.
const MOST_AHEAD: f64 = 24.0;

/// Grains in the order of z, with all that their motion needs.
#[derive(Clone, Debug)]
pub(crate) struct Sorted {
    grains: usize,
    length: f64,
    skin: f64,
    mass: f64,
    pairs: PairConstants,
    wall: WallTable,
    /// Which grain stands at each place.
    order: Vec<u32>,
    /// Times round the tube up to the last sorting; since then z runs on beyond the ends of the tube.
    turns: Vec<i32>,
    position: Columns,
    velocity: Columns,
    acceleration: Columns,
    /// z at the last sorting.
    origin: Vec<f64>,
    /// For each block of grains, how many that follow a grain may touch it.
    ahead: Vec<u32>,
    /// Number of first grains that are repeated behind the last.
    ghosts: usize,
    tiles: Vec<Tile>,
    scratch: order::Scratch,
    instructions: Instructions,
    /// Where there is to be more than one thread.
    pool: Option<Arc<ThreadPool>>,
}

/// A stretch of places whose forces are added up together.
#[derive(Clone, Debug)]
struct Tile {
    first: usize,
    end: usize,
    /// Forces on the grains of the tile, and behind them those on the grains that follow.
    force: Columns,
    /// How many grains that follow can feel the tile.
    overhang: usize,
    tally: Tally,
    moved: Moved,
}

/// The parts of a simulation that an advance works on.
pub(crate) struct Course<'a> {
    pub(crate) wall: &'a mut PrescribedWall,
    pub(crate) tally: &'a mut Tally,
    pub(crate) ledger: &'a mut Ledger,
    pub(crate) step: &'a mut u64,
    pub(crate) time_step: f64,
    pub(crate) limit: f64,
}

impl Sorted {
    /// Whether this kernel serves such a simulation, and well.
    pub(crate) fn serves(bodies: &Bodies, wall: &Wall, parameters: &Parameters) -> bool {
        parameters.contact.friction.is_none()
            && parameters.integrator == Integrator::Verlet
            && Self::serves_tube(bodies, wall, parameters.skin)
    }

    /// Whether it serves smooth grains in this tube.
    pub(crate) fn serves_tube(bodies: &Bodies, wall: &Wall, skin: f64) -> bool {
        let Wall::Prescribed(wall) = wall else {
            return false;
        };
        let (lattice, grains) = (wall.lattice(), bodies.grains as f64);
        let equal = bodies.diameter.windows(2).all(|pair| pair[0] == pair[1])
            && bodies.mass.windows(2).all(|pair| pair[0] == pair[1]);
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let cutoff = diameter + skin;
        equal
            && lattice.length() > 2.0 * cutoff
            // Rings are counted on beyond the ends of the tube.
            && lattice.rings().is_multiple_of(2)
            && grains / lattice.length() * cutoff <= MOST_AHEAD
    }

    /// The grains of `bodies`, which must be as [`Sorted::serves`] wants them; in the order that `sorting` holds.
    pub(crate) fn new(
        bodies: &Bodies,
        wall: &PrescribedWall,
        skin: f64,
        sorting: Option<&Sorting>,
    ) -> Self {
        let grains = bodies.grains;
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let room = grains + grains.min(TILE) + 3 * LANES;
        let mut sorted = Self {
            grains,
            length: wall.lattice().length(),
            skin,
            mass: bodies.mass.first().copied().unwrap_or(1.0),
            pairs: PairConstants {
                reach: diameter,
                reduced_radius: 0.25 * diameter,
            },
            wall: WallTable::new(wall, diameter),
            order: Vec::with_capacity(grains),
            turns: Vec::with_capacity(grains),
            position: Columns::with_capacity(room),
            velocity: Columns::with_capacity(room),
            acceleration: Columns::with_capacity(room),
            origin: Vec::with_capacity(room),
            ahead: Vec::with_capacity(grains.div_ceil(LANES)),
            ghosts: 0,
            tiles: Vec::new(),
            scratch: order::Scratch::default(),
            instructions: Instructions::widest(),
            pool: None,
        };
        sorted.load(bodies, sorting);
        sorted
    }

    /// Computes with the given instructions and threads from now on; neither changes a bit of the results.
    pub(crate) fn compute_with(
        &mut self,
        instructions: Instructions,
        pool: Option<Arc<ThreadPool>>,
    ) {
        self.instructions = instructions;
        self.pool = pool;
    }

    /// Forces of contacts at rest: takes the positions of `bodies` as they are and answers with their accelerations.
    pub(crate) fn evaluate<N: NormalLaw>(
        &mut self,
        law: &N,
        wall: &PrescribedWall,
        bodies: &mut Bodies,
    ) -> Tally {
        self.take_positions(bodies);
        self.wall.follow(wall);
        let tally = self.forces::<N, true>(law);
        for (place, &grain) in self.order.iter().enumerate() {
            let force = self.tiles[place / TILE].force.get(place % TILE);
            bodies.acceleration[grain as usize] = force / self.mass;
        }
        tally
    }

    /// Advances by `steps` steps; brings `bodies` up to date.
    pub(crate) fn advance<N: NormalLaw>(
        &mut self,
        law: &N,
        course: Course<'_>,
        bodies: &mut Bodies,
        steps: u64,
    ) -> Result<(), Runaway> {
        match self.pool.clone() {
            Some(pool) => pool.install(|| self.take_steps(law, course, bodies, steps)),
            None => self.take_steps(law, course, bodies, steps),
        }
    }

    fn take_steps<N: NormalLaw>(
        &mut self,
        law: &N,
        course: Course<'_>,
        bodies: &mut Bodies,
        steps: u64,
    ) -> Result<(), Runaway> {
        let Course {
            wall,
            tally,
            ledger,
            step,
            time_step,
            limit,
        } = course;
        let mut outcome = Ok(());
        for remaining in (0..steps).rev() {
            let begins = remaining + 1 == steps;
            *step += 1;
            let time = *step as f64 * time_step;
            let phase = if begins {
                Phase::Drift
            } else {
                Phase::KickAndDrift
            };
            outcome = self.go(phase, time_step, limit);
            if outcome.is_err() {
                break;
            }
            self.copy_ghosts();

            // A wall that jumps does work on the contacts that it finds: what they store after the jump but not before.
            let jumps = wall.move_without_jump(time - time_step, time);
            let stored_before_jump = jumps.then(|| {
                self.wall.follow(wall);
                self.forces::<N, true>(law).contact_energy
            });
            wall.move_to(time);
            self.wall.follow(wall);
            let after = if remaining == 0 || jumps {
                self.forces::<N, true>(law)
            } else {
                self.forces::<N, false>(law)
            };
            if let Some(stored) = stored_before_jump {
                ledger.add_jump(after.contact_energy - stored);
            }
            ledger.add_step(tally, &after, time_step);
            *tally = after;
        }
        if outcome.is_ok() && steps > 0 {
            self.go(Phase::Kick, time_step, limit)?;
        }
        self.store(bodies);
        outcome
    }

    /// All forces, left in the tiles, and what they add up to.
    fn forces<N: NormalLaw, const FULL: bool>(&mut self, law: &N) -> Tally {
        let Self {
            grains,
            pairs,
            wall,
            position,
            velocity,
            ahead,
            tiles,
            instructions,
            pool,
            ..
        } = self;
        let one = |tile: &mut Tile| {
            instructions.run(ForcesOnTile::<N, FULL> {
                law,
                pairs,
                wall,
                position,
                velocity,
                ahead,
                grains: *grains,
                tile,
            });
        };
        if pool.is_some() {
            tiles.par_iter_mut().for_each(one);
        } else {
            tiles.iter_mut().for_each(one);
        }
        self.add_overhangs();
        let mut tally = Tally::default();
        for tile in &self.tiles {
            tally.merge(&tile.tally);
        }
        tally
    }

    /// Adds what each tile exerts on grains behind it to the forces there.
    fn add_overhangs(&mut self) {
        for from in 0..self.tiles.len() {
            let Tile {
                first,
                end,
                overhang,
                ..
            } = self.tiles[from];
            for beyond in end..end + overhang {
                let pushed = self.tiles[from].force.get(beyond - first);
                let place = if beyond < self.grains {
                    beyond
                } else {
                    beyond - self.grains
                };
                let (to, within) = (place / TILE, place % TILE);
                let force = &mut self.tiles[to].force;
                force.x[within] += pushed.x;
                force.y[within] += pushed.y;
                force.z[within] += pushed.z;
            }
        }
    }
}

struct ForcesOnTile<'a, N, const FULL: bool> {
    law: &'a N,
    pairs: &'a PairConstants,
    wall: &'a WallTable,
    position: &'a Columns,
    velocity: &'a Columns,
    ahead: &'a [u32],
    grains: usize,
    tile: &'a mut Tile,
}

impl<N: NormalLaw, const FULL: bool> Work for ForcesOnTile<'_, N, FULL> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            law,
            pairs,
            wall,
            position,
            velocity,
            ahead,
            grains,
            tile,
        } = self;
        let (first, end) = (tile.first, tile.end);
        let force = &mut tile.force;
        for column in force.each() {
            column.fill(0.0);
        }
        let mut sums = Sums::<M>::zero();
        for place in (first..end).step_by(LANES) {
            let block = Block::load(position, velocity, place, grains);
            let ahead = ahead[place / LANES] as usize;
            block.add_pairs::<N, FULL>(
                law, pairs, position, velocity, ahead, first, force, &mut sums,
            );
        }
        for place in (first..end).step_by(LANES) {
            let block = Block::load(position, velocity, place, grains);
            if let Some(pushed) = wall.force::<M, N, FULL>(law, &block, &mut sums) {
                force.add(place - first, pushed);
            }
        }
        tile.tally = sums.tally();
    }
}
