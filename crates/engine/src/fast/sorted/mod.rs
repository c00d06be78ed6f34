//! The fast kernel for equal smooth grains in a tube with a prescribed wall.
//!
//! The grains are kept in the order of z, in a wide tube strip by strip along it. A grain's partners are then few places
//! that follow one another, so that eight grains meet eight partners at a time without gathering: a list for each eight
//! grains says where their partners begin. Copies of the grains near the ends, one period on, close the tube. Order and
//! list are made anew when grains may have come closer by more than the skin.
//!
//! Forces are added up tile by tile, and the tiles in their order, so that neither the number of threads nor the set of
//! instructions changes a bit.

mod columns;
mod keys;
mod listing;
mod meetings;
mod motion;
mod order;
mod pairs;
mod strips;
mod sums;
mod wall;

use std::cell::RefCell;
use std::sync::Arc;

use peristalsis_physics::contact::NormalLaw;
use rayon::ThreadPool;
use rayon::prelude::*;

use self::columns::{Columns, ColumnsMut};
use self::listing::{Partners, Tile};
use self::meetings::Meetings;
use self::motion::{Motion, Moved, Phase};
use self::order::Row;
use self::pairs::{Block, PairConstants};
use self::strips::{SKINS, Strips};
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

pub use self::order::Sorting;

/// Grains in a tile, a multiple of the number of lanes.
const TILE: usize = 128;

/// Tiles that a thread takes at a time: few, so that threads end together, for one that waits long falls asleep.
const AT_A_TIME: usize = 8;
/// The same where there is little to do with each.
const OF_LIGHT_WORK: usize = 4 * AT_A_TIME;

/// Grains in the order of z, with all that their motion needs.
#[derive(Clone, Debug)]
pub(crate) struct Sorted {
    grains: usize,
    length: f64,
    skin: f64,
    mass: f64,
    pairs: PairConstants,
    wall: WallTable,
    strips: Strips,
    /// The places of each strip.
    rows: Vec<Row>,
    /// Which grain stands at each place, itself or its copy.
    order: Vec<u32>,
    /// Times round the tube up to the last sorting; since then z runs on beyond the ends of the tube.
    turns: Vec<i32>,
    position: Columns,
    velocity: Columns,
    acceleration: Columns,
    /// Zero but while forces are worked out.
    force: Columns,
    /// z at the last sorting.
    origin: Vec<f64>,
    /// Bound of the distance that a grain has gone across the tube since then.
    lateral: f64,
    tiles: Vec<Tile>,
    /// Forces of a tile, or of each where there are threads.
    of_tiles: Vec<OfTile>,
    /// For each stretch of places, which windows of which tiles reach it; where there are threads.
    reached_by: Vec<Vec<(u32, u32)>>,
    moved: Vec<Moved>,
    scratch: order::Scratch,
    instructions: Instructions,
    /// Where there is to be more than one thread.
    pool: Option<Arc<ThreadPool>>,
}

/// What the contacts of a tile's grains exert, window after window, and add up to.
#[derive(Clone, Debug, Default)]
struct OfTile {
    force: Columns,
    tally: Tally,
    /// Room to write down who touches.
    touching: Vec<Partners>,
}

/// The parts of a simulation that an advance works on.
pub(crate) struct Course<'a> {
    pub(crate) wall: &'a mut PrescribedWall,
    pub(crate) tally: &'a mut Tally,
    pub(crate) ledger: &'a mut Ledger,
    pub(crate) step: &'a mut u64,
    pub(crate) time_step: f64,
    pub(crate) body_force: f64,
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
        let lattice = wall.lattice();
        let equal = bodies.diameter.windows(2).all(|pair| pair[0] == pair[1])
            && bodies.mass.windows(2).all(|pair| pair[0] == pair[1]);
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let cutoff = diameter + SKINS * skin;
        equal
            && lattice.length() > 2.0 * cutoff
            // Rings are counted on beyond the ends of the tube.
            && lattice.rings().is_multiple_of(2)
            // A block's meetings with a very fine wall are worked out at once.
            && wall::rings_in_reach(lattice, diameter) <= meetings::MOST_RINGS
    }

    /// How many strips the grains stand in.
    pub(crate) fn strips(bodies: &Bodies, wall: &PrescribedWall, skin: f64) -> usize {
        Self::strips_of(bodies, wall, skin).number()
    }

    fn strips_of(bodies: &Bodies, wall: &PrescribedWall, skin: f64) -> Strips {
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let (length, radius) = (wall.lattice().length(), wall.wave().mean_radius);
        Strips::new(bodies.grains, length, radius, diameter, skin)
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
        let strips = Self::strips_of(bodies, wall, skin);
        let mut sorted = Self {
            grains,
            length: wall.lattice().length(),
            skin: strips.skin,
            mass: bodies.mass.first().copied().unwrap_or(1.0),
            pairs: PairConstants {
                reach: diameter,
                reduced_radius: 0.25 * diameter,
            },
            wall: WallTable::new(wall, diameter),
            strips,
            rows: Vec::new(),
            order: Vec::new(),
            turns: Vec::new(),
            position: Columns::default(),
            velocity: Columns::default(),
            acceleration: Columns::default(),
            force: Columns::default(),
            origin: Vec::new(),
            lateral: 0.0,
            tiles: Vec::new(),
            of_tiles: vec![OfTile::default()],
            reached_by: Vec::new(),
            moved: Vec::new(),
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
        self.share_out();
    }

    /// The threads, where there is to be more than one.
    pub(crate) fn pool(&self) -> Option<&ThreadPool> {
        self.pool.as_deref()
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
        for place in self.rows.iter().flat_map(Row::own) {
            let grain = self.order[place] as usize;
            bodies.acceleration[grain] = self.force.get(place) / self.mass;
        }
        self.forget_forces();
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
            body_force,
            limit,
        } = course;
        let motion = Motion {
            time_step,
            body_force,
            limit,
        };
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
            outcome = self.go(phase, motion);
            if outcome.is_err() {
                break;
            }

            // A wall that jumps does work on the contacts that it finds: what they store after the jump but not before.
            let jumps = wall.move_without_jump(time - time_step, time);
            let stored_before_jump = jumps.then(|| {
                self.wall.follow(wall);
                let stored = self.forces::<N, true>(law).contact_energy;
                self.forget_forces();
                stored
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
            self.go(Phase::Kick, motion)?;
        }
        self.store(bodies);
        outcome
    }

    /// Adds up all forces, from zero, and answers what they add up to.
    fn forces<N: NormalLaw, const FULL: bool>(&mut self, law: &N) -> Tally {
        let Self {
            pairs,
            wall,
            position,
            velocity,
            force,
            tiles,
            of_tiles,
            reached_by,
            instructions,
            pool,
            ..
        } = self;
        let one = |(of_tile, tile): (&mut OfTile, &Tile)| {
            MEETINGS.with_borrow_mut(|meetings| {
                instructions.run(ForcesOfTile::<N, FULL> {
                    law,
                    pairs,
                    wall,
                    position,
                    velocity,
                    tile,
                    of_tile,
                    meetings,
                });
            });
        };
        let mut tally = Tally::default();
        if pool.is_some() {
            let work = of_tiles.par_iter_mut().zip(&*tiles);
            work.with_max_len(AT_A_TIME).for_each(one);
            let stretches = force.par_tiles().zip(&*reached_by).enumerate();
            let stretches = stretches.with_max_len(OF_LIGHT_WORK);
            stretches.for_each(|(stretch, (force, reached_by))| {
                instructions.run(AddUp {
                    first: stretch * TILE,
                    reached_by,
                    tiles,
                    of_tiles,
                    force,
                });
            });
            for of_tile in &*of_tiles {
                tally.merge(&of_tile.tally);
            }
        } else {
            for (number, tile) in tiles.iter().enumerate() {
                one((&mut of_tiles[0], tile));
                let all = [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4)];
                instructions.run(AddUp {
                    first: 0,
                    reached_by: &all[..tile.windows().len()],
                    tiles: &tiles[number..=number],
                    of_tiles,
                    force: force.as_mut(),
                });
                tally.merge(&of_tiles[0].tally);
            }
        }
        self.gather_from_copies();
        tally
    }

    /// Finds out which stretches of places the tiles reach, so that threads can add up a stretch each.
    fn share_out(&mut self) {
        let number = if self.pool.is_some() {
            self.tiles.len()
        } else {
            1
        };
        self.of_tiles.resize_with(number, OfTile::default);
        if self.pool.is_none() {
            return;
        }
        let stretches = self.origin.len().div_ceil(TILE);
        self.reached_by.resize_with(stretches, Vec::new);
        self.reached_by.iter_mut().for_each(Vec::clear);
        for (number, tile) in self.tiles.iter().enumerate() {
            for (index, window) in tile.windows().iter().enumerate() {
                let stretches = window.first / TILE..(window.first + window.length).div_ceil(TILE);
                for reached_by in &mut self.reached_by[stretches] {
                    reached_by.push((number as u32, index as u32));
                }
            }
        }
    }

    fn forget_forces(&mut self) {
        for column in self.force.each() {
            column.fill(0.0);
        }
    }
}

thread_local! {
    /// Room that each thread uses again for every tile.
    static MEETINGS: RefCell<Meetings> = RefCell::default();
}

struct ForcesOfTile<'a, N, const FULL: bool> {
    law: &'a N,
    pairs: &'a PairConstants,
    wall: &'a WallTable,
    position: &'a Columns,
    velocity: &'a Columns,
    tile: &'a Tile,
    of_tile: &'a mut OfTile,
    meetings: &'a mut Meetings,
}

impl<N: NormalLaw, const FULL: bool> Work for ForcesOfTile<'_, N, FULL> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            law,
            pairs,
            wall,
            position,
            velocity,
            tile,
            of_tile:
                OfTile {
                    force,
                    tally,
                    touching,
                },
            meetings,
        } = self;
        for column in force.each() {
            column.clear();
            column.resize(tile.room(), 0.0);
        }
        if touching.len() < tile.listed() {
            touching.resize(tile.listed(), Partners::default());
        }
        let mut sums = Sums::<M>::zero();
        for place in (tile.first..tile.end).step_by(LANES) {
            let block = Block::load(position, velocity, place, tile.end);
            block.add_pairs::<N, FULL>(
                law, pairs, position, velocity, tile, touching, force, &mut sums,
            );
        }
        let mut place = tile.first;
        while place < tile.end {
            meetings.clear();
            while place < tile.end && meetings.have_room(wall.most_rings()) {
                let block = Block::<M>::load(position, velocity, place, tile.end);
                wall.meet(&block, place - tile.first, meetings);
                place += LANES;
            }
            wall.turn::<M>(meetings);
            wall.push::<M, N, FULL>(law, meetings, &mut sums);
            meetings.add_forces::<M>(force);
        }
        *tally = sums.tally();
    }
}

/// Adds what windows of tiles hold to the forces of a stretch of places.
struct AddUp<'a> {
    first: usize,
    /// Tile and window, in the order of the tiles.
    reached_by: &'a [(u32, u32)],
    tiles: &'a [Tile],
    of_tiles: &'a [OfTile],
    force: ColumnsMut<'a>,
}

impl Work for AddUp<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            first,
            reached_by,
            tiles,
            of_tiles,
            force,
        } = self;
        let end = first + force.x.len();
        for &(tile, window) in reached_by {
            let of_tile = &of_tiles[tile as usize].force;
            let window = &tiles[tile as usize].windows()[window as usize];
            let from = window.first.max(first);
            let to = (window.first + window.length).min(end).max(from);
            for (all, of_tile) in [
                (&mut *force.x, &of_tile.x),
                (&mut *force.y, &of_tile.y),
                (&mut *force.z, &of_tile.z),
            ] {
                let all = &mut all[from - first..to - first];
                let base = window.base + (from - window.first);
                let of_tile = &of_tile[base..base + (to - from)];
                for (all, of_tile) in all.iter_mut().zip(of_tile) {
                    *all += of_tile;
                }
            }
        }
    }
}
