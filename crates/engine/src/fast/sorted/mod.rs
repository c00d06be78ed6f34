//! The fast kernel for equal smooth grains in a tube with a prescribed wall.
//!
//! The grains are kept in the order of z, in a wide tube strip by strip along it. A grain's partners are then few places
//! that follow one another, so that eight grains meet eight partners at a time without gathering: a list for each eight
//! grains says where their partners begin. Copies of the grains near the ends, one period on, close the tube. Order and
//! list are made anew when grains may have come closer by more than the skin.
//!
//! Forces are added up tile by tile, and the tiles in their order, so that neither the number of threads nor the set of
//! instructions changes a bit.

mod candidates;
mod columns;
mod forces;
mod keys;
mod listing;
mod motion;
mod order;
mod pairs;
mod strips;
mod sums;
mod wall;

use std::sync::Arc;

use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::method::Integrator;
use rayon::ThreadPool;

use self::columns::Columns;
use self::forces::OfTile;
use self::listing::Tile;
use self::motion::{Motion, Moved, Phase};
use self::order::Row;
use self::pairs::PairConstants;
use self::strips::{SKINS, Strips};
use self::wall::WallTable;
use super::machine::Instructions;
use crate::bodies::Bodies;
use crate::integrate::Runaway;
use crate::ledger::Tally;
use crate::parameters::Parameters;
use crate::steps::{Course, Stepper};
use crate::wall::Wall;

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

impl Sorted {
    /// Whether this kernel serves such a simulation, and well.
    pub(crate) fn serves(bodies: &Bodies, wall: &Wall, parameters: &Parameters) -> bool {
        parameters.contact.friction.is_none()
            && parameters.integrator == Integrator::Verlet
            && Self::serves_tube(bodies, wall, parameters.skin)
    }

    /// Whether it serves smooth grains in this tube.
    fn serves_tube(bodies: &Bodies, wall: &Wall, skin: f64) -> bool {
        let Some(prescribed) = wall.prescribed() else {
            return false;
        };
        let lattice = prescribed.lattice();
        let equal = bodies.diameter.windows(2).all(|pair| pair[0] == pair[1])
            && bodies.mass.windows(2).all(|pair| pair[0] == pair[1]);
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let cutoff = diameter + SKINS * skin;
        equal
            && lattice.length() > 2.0 * cutoff
            // Rings are counted on beyond the ends of the tube.
            && lattice.rings().is_multiple_of(2)
            // The candidates of a block are worked out at once, also with a very fine wall.
            && wall::rings_in_reach(lattice, diameter) <= candidates::MOST_RINGS
    }

    /// How many strips the grains stand in.
    pub(crate) fn strips(bodies: &Bodies, wall: &Wall, skin: f64) -> usize {
        Self::strips_of(bodies, wall, skin).number()
    }

    fn strips_of(bodies: &Bodies, wall: &Wall, skin: f64) -> Strips {
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let (length, radius) = (wall.length(), wall.mean_radius());
        Strips::new(bodies.grains, length, radius, diameter, skin)
    }

    /// The grains of `bodies`, smooth whatever their law, in the order that `sorting` holds; `None` where this kernel
    /// does not serve them.
    pub(crate) fn new(
        bodies: &Bodies,
        wall: &Wall,
        skin: f64,
        sorting: Option<&Sorting>,
    ) -> Option<Self> {
        if !Self::serves_tube(bodies, wall, skin) {
            return None;
        }
        let grains = bodies.grains;
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let strips = Self::strips_of(bodies, wall, skin);
        let mut sorted = Self {
            grains,
            length: wall.length(),
            skin: strips.skin,
            mass: bodies.mass.first().copied().unwrap_or(1.0),
            pairs: PairConstants {
                reach: diameter,
                reduced_radius: 0.25 * diameter,
            },
            wall: WallTable::new(wall.prescribed()?.lattice(), diameter),
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
        Some(sorted)
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
        wall: &Wall,
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
        course: &mut Course,
        bodies: &mut Bodies,
        (body_force, limit): (f64, f64),
        steps: u64,
    ) -> Result<(), Runaway> {
        let motion = Motion {
            time_step: course.time_step,
            body_force,
            limit,
        };
        let pool = self.pool.clone();
        let mut stepping = Stepping {
            sorted: self,
            law,
            motion,
            phase: Phase::Drift,
        };
        let outcome = match pool {
            Some(pool) => pool.install(|| course.advance(&mut stepping, steps)),
            None => course.advance(&mut stepping, steps),
        };
        self.store(bodies);
        outcome
    }
}

/// The kernel in the middle of an advance.
struct Stepping<'a, N> {
    sorted: &'a mut Sorted,
    law: &'a N,
    motion: Motion,
    phase: Phase,
}

impl<N: NormalLaw> Stepper for Stepping<'_, N> {
    fn move_spheres(&mut self) -> Result<(), Runaway> {
        self.sorted.go(self.phase, self.motion)?;
        self.phase = Phase::KickAndDrift;
        Ok(())
    }

    fn contact_energy(&mut self, wall: &Wall) -> f64 {
        self.sorted.wall.follow(wall);
        let stored = self.sorted.forces::<N, true>(self.law).contact_energy;
        self.sorted.forget_forces();
        stored
    }

    fn evaluate(&mut self, wall: &Wall, complete: bool) -> Tally {
        self.sorted.wall.follow(wall);
        if complete {
            self.sorted.forces::<N, true>(self.law)
        } else {
            self.sorted.forces::<N, false>(self.law)
        }
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        self.sorted.go(Phase::Kick, self.motion)
    }
}
