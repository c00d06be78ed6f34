//! The grains in their order, and whether this kernel serves them.

use peristalsis_physics::method::Integrator;

use super::candidates::MOST_RINGS;
use super::pairs::PairConstants;
use super::rows::{Row, Scratch};
use super::strips::{SKINS, Strips};
use super::tile::{Moved, OfTile, Tile};
use super::wall::{WallTable, rings_in_reach};
use crate::bodies::Bodies;
use crate::fast::columns::Columns;
use crate::fast::machine::Instructions;
use crate::fast::threads::Threads;
use crate::parameters::Parameters;
use crate::wall::Wall;

/// Grains in the order of z, with all that their motion needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sorted {
    pub(super) grains: usize,
    pub(super) length: f64,
    pub(super) skin: f64,
    pub(super) mass: f64,
    pub(super) pairs: PairConstants,
    pub(super) wall: WallTable,
    pub(super) strips: Strips,
    /// The places of each strip.
    pub(super) rows: Vec<Row>,
    /// Which grain stands at each place, itself or its copy.
    pub(super) order: Vec<u32>,
    /// Times round the tube up to the last sorting; since then z runs on beyond the ends of the tube.
    pub(super) turns: Vec<i32>,
    pub(super) position: Columns,
    pub(super) velocity: Columns,
    pub(super) acceleration: Columns,
    /// Zero but while forces are worked out.
    pub(super) force: Columns,
    /// z at the last sorting.
    pub(super) origin: Vec<f64>,
    /// Bound of the distance that a grain has gone across the tube since then.
    pub(super) lateral: f64,
    pub(super) tiles: Vec<Tile>,
    /// Forces of a tile, or of each where there are threads.
    pub(super) of_tiles: Vec<OfTile>,
    /// For each stretch of places, which windows of which tiles reach it; where there are threads.
    pub(super) reached_by: Vec<Vec<(u32, u32)>>,
    pub(super) moved: Vec<Moved>,
    pub(super) scratch: Scratch,
    pub(super) instructions: Instructions,
    pub(super) threads: Threads,
}

impl Sorted {
    /// Whether this kernel serves such a simulation, and well.
    pub(crate) fn serves(bodies: &Bodies, wall: &Wall, parameters: &Parameters) -> bool {
        parameters.contact.friction.is_none()
            && parameters.integrator == Integrator::Verlet
            && Self::serves_tube(bodies, wall, parameters.skin)
    }

    /// Whether it serves frictionless grains in this tube.
    pub(super) fn serves_tube(bodies: &Bodies, wall: &Wall, skin: f64) -> bool {
        let Some(prescribed) = wall.prescribed() else {
            return false;
        };
        let Some(lattice) = prescribed.lattice() else {
            return false;
        };
        let equal = bodies.diameter.windows(2).all(|pair| pair[0] == pair[1])
            && bodies.mass.windows(2).all(|pair| pair[0] == pair[1]);
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let cutoff = diameter + SKINS * skin;
        equal
            && lattice.length() > 2.0 * cutoff
            // Rings are counted on beyond the ends of the tube.
            && (!lattice.staggered || lattice.rings().is_multiple_of(2))
            // The candidates of a block are worked out at once, also with a very fine wall.
            && rings_in_reach(lattice, diameter) <= MOST_RINGS
    }

    /// How many strips the grains stand in.
    pub(crate) fn strips(bodies: &Bodies, wall: &Wall, skin: f64) -> usize {
        Self::strips_of(bodies, wall, skin).number()
    }

    pub(super) fn strips_of(bodies: &Bodies, wall: &Wall, skin: f64) -> Strips {
        let diameter = bodies.diameter.first().copied().unwrap_or(1.0);
        let (length, radius) = (wall.length(), wall.mean_radius());
        Strips::new(bodies.grains, length, radius, diameter, skin)
    }

    /// Computes with the given instructions and threads from now on; neither changes a bit of the results.
    pub(crate) fn compute_with(&mut self, instructions: Instructions, threads: Threads) {
        self.instructions = instructions;
        self.threads = threads;
        self.share_out();
    }
}
