//! Velocity Verlet, tile by tile: the kick that ends a step and the drift that begins the next in one pass.

use glam::DVec3;
use peristalsis_physics::real::Real;
use rayon::prelude::*;

use super::rows::NOWHERE;
use super::state::Sorted;
use super::tile::{Moved, OF_LIGHT_WORK, TILE};
use crate::fast::columns::ColumnsMut;
use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::{Machine, Work};
use crate::integrate::verlet::Verlet;
use crate::integrate::{Runaway, Scheme};

/// Which part of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// x' = x + h v + h^2 a/2, v* = v + h a: the beginning of a step.
    Drift,
    /// v' = v* + h (a' - a)/2: its end.
    Kick,
    /// The end of a step and the beginning of the next.
    KickAndDrift,
}

/// Parameters of the motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) time_step: f64,
    /// Force over mass.
    pub(super) body_force: DVec3,
    /// Longest displacement of a step.
    pub(super) limit: f64,
}

impl Sorted {
    /// Moves all grains; makes the order anew where it no longer holds.
    pub(super) fn go(&mut self, phase: Phase, motion: Motion) -> Result<(), Runaway> {
        let (per_mass, instructions) = (1.0 / self.mass, self.instructions);
        let stretches = self.origin.len().div_ceil(TILE);
        self.moved.resize(stretches, Moved::default());
        // The columns of a stretch of places, as they come zipped.
        let work = move |(((((moved, position), velocity), acceleration), force), origin)| Move {
            moved,
            position,
            velocity,
            acceleration,
            force,
            origin,
            phase,
            motion,
            per_mass,
        };
        if self.threads.several() {
            let stretches = self.moved.par_iter_mut().zip(self.position.par_tiles());
            stretches
                .zip(self.velocity.par_tiles())
                .zip(self.acceleration.par_tiles())
                .zip(self.force.par_tiles())
                .zip(self.origin.par_chunks(TILE))
                .with_max_len(OF_LIGHT_WORK)
                .for_each(|stretch| instructions.run(work(stretch)));
        } else {
            let stretches = self.moved.iter_mut().zip(self.position.tiles());
            stretches
                .zip(self.velocity.tiles())
                .zip(self.acceleration.tiles())
                .zip(self.force.tiles())
                .zip(self.origin.chunks(TILE))
                .for_each(|stretch| instructions.run(work(stretch)));
        }
        if phase == Phase::Kick {
            return Ok(());
        }
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut lateral_squared = 0.0_f64;
        for (stretch, moved) in self.moved.iter().enumerate() {
            if let Some((place, displacement)) = moved.runaway {
                return Err(Runaway {
                    body: self.order[stretch * TILE + place] as usize,
                    displacement,
                });
            }
            least = least.min(moved.least);
            largest = largest.max(moved.largest);
            lateral_squared = lateral_squared.max(moved.lateral_squared);
        }
        self.follow(least, largest, lateral_squared);
        Ok(())
    }
}

/// A stretch of places, copies of grains and places without one among them.
struct Move<'a> {
    moved: &'a mut Moved,
    position: ColumnsMut<'a>,
    velocity: ColumnsMut<'a>,
    acceleration: ColumnsMut<'a>,
    /// Left at zero, for the forces that come.
    force: ColumnsMut<'a>,
    origin: &'a [f64],
    phase: Phase,
    motion: Motion,
    per_mass: f64,
}

impl Work for Move<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        match self.phase {
            Phase::Drift => self.go::<M, false, true>(),
            Phase::Kick => self.go::<M, true, false>(),
            Phase::KickAndDrift => self.go::<M, true, true>(),
        }
    }
}

impl Move<'_> {
    #[inline(always)]
    fn go<M: Machine, const KICK: bool, const DRIFT: bool>(mut self) {
        let Motion {
            time_step,
            body_force,
            limit,
        } = self.motion;
        let verlet = Verlet {
            step: Lanes::<M>::splat(time_step),
            half_step: Lanes::splat(0.5 * time_step),
        };
        let per_mass = Lanes::splat(self.per_mass);
        let limit_squared = Lanes::splat(limit * limit);
        let somewhere = Lanes::splat(0.5 * NOWHERE);
        let pushed = body_force != DVec3::ZERO;
        let mut least = Lanes::splat(f64::INFINITY);
        let mut largest = Lanes::splat(f64::NEG_INFINITY);
        let mut most_lateral = Lanes::splat(0.0);
        let mut runaway = None;
        for at in (0..self.origin.len()).step_by(LANES) {
            let mut velocity = self.velocity.load(at);
            let mut acceleration = self.acceleration.load(at);
            if KICK {
                let mut now = self.force.load(at) * per_mass;
                if pushed {
                    // Places without a grain stay where they are.
                    let holds = Lanes::load(self.origin, at).less(somewhere);
                    let push = |by: f64| Lanes::select(holds, Lanes::splat(by), Lanes::splat(0.0));
                    now.x += push(body_force.x);
                    now.y += push(body_force.y);
                    now.z += push(body_force.z);
                }
                self.force.store(at, LaneVector::<M>::default());
                velocity = verlet.corrected(velocity, now, acceleration);
                acceleration = now;
                self.acceleration.store(at, acceleration);
            }
            if DRIFT {
                let by = verlet.displacement(velocity, acceleration, velocity);
                let position = self.position.load(at) + by;
                velocity = verlet.predicted(velocity, acceleration, acceleration);
                self.position.store(at, position);
                let lateral = by.x * by.x + by.y * by.y;
                let squared = lateral + by.z * by.z;
                most_lateral = most_lateral.max(lateral);
                let apart = !squared.at_most(limit_squared);
                if apart.any() {
                    let lane = apart.to_bits().trailing_zeros() as usize;
                    let by = squared.to_array()[lane].sqrt();
                    runaway = runaway.or(Some((at + lane, by)));
                }
                let origin = Lanes::load(self.origin, at);
                let holds = origin.less(somewhere);
                let displacement = position.z - origin;
                least = least.min(Lanes::select(holds, displacement, least));
                largest = largest.max(Lanes::select(holds, displacement, largest));
            }
            self.velocity.store(at, velocity);
        }
        if DRIFT {
            *self.moved = Moved {
                least: -(-least).max_lane(),
                largest: largest.max_lane(),
                lateral_squared: most_lateral.max_lane(),
                runaway,
            };
        }
    }
}
