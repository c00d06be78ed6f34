//! The kernel from its beginning to the end of an advance.

use glam::DVec3;
use peristalsis_physics::contact::{NormalLaw, reduced_radius};

use super::motion::{Motion, Phase};
use super::order::Sorting;
use super::pairs::PairConstants;
use super::rows::Row;
use super::state::Sorted;
use super::tile::OfTile;
use super::wall::WallTable;
use crate::bodies::Bodies;
use crate::integrate::Runaway;
use crate::ledger::Tally;
use crate::steps::{Course, Stepper};
use crate::wall::Wall;

impl Sorted {
    /// The grains of `bodies`, without friction whatever their law, in the order that `sorting` holds; `None` where this
    /// kernel does not serve them.
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
                reduced_radius: reduced_radius(diameter, diameter),
            },
            wall: WallTable::new(wall.prescribed()?.lattice()?, diameter),
            strips,
            of_tiles: vec![OfTile::default()],
            ..Self::default()
        };
        sorted.load(bodies, sorting);
        Some(sorted)
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
        (body_force, limit): (DVec3, f64),
        steps: u64,
    ) -> Result<(), Runaway> {
        let motion = Motion {
            time_step: course.time_step,
            body_force,
            limit,
        };
        let threads = self.threads.clone();
        let mut stepping = Stepping {
            sorted: self,
            law,
            motion,
            phase: Phase::Drift,
            sums: Tally::default(),
        };
        let outcome = threads.install(|| course.advance(&mut stepping, steps));
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
    /// Of the last evaluation.
    sums: Tally,
}

impl<N: NormalLaw> Stepper for Stepping<'_, N> {
    fn move_spheres(&mut self) -> Result<(), Runaway> {
        self.sorted.go(self.phase, self.motion)?;
        self.phase = Phase::KickAndDrift;
        Ok(())
    }

    fn tally(&mut self, wall: &Wall) -> Tally {
        self.sorted.wall.follow(wall);
        let tally = self.sorted.forces::<N, true>(self.law);
        self.sorted.forget_forces();
        tally
    }

    fn evaluate(&mut self, wall: &Wall, complete: bool) {
        self.sorted.wall.follow(wall);
        self.sums = if complete {
            self.sorted.forces::<N, true>(self.law)
        } else {
            self.sorted.forces::<N, false>(self.law)
        };
    }

    fn sums(&mut self) -> Tally {
        self.sums
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        self.sorted.go(Phase::Kick, self.motion)
    }
}
