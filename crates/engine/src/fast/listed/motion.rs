//! Motion of the spheres from one evaluation of the forces to the next, in one pass.

use glam::DVec3;
use peristalsis_physics::method::Integrator;

use super::record::Record;
use super::spheres::{Spheres, SpheresMut};
use crate::bodies::fold;
use crate::fast::lanes::Quad;
use crate::fast::machine::{Machine, Work};
use crate::integrate::adams_bashforth::AdamsBashforth;
use crate::integrate::verlet::Verlet;
use crate::integrate::{Runaway, Scheme};
use crate::neighbours::Drift;

/// Where in an advance the pass stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// Before the first forces: accelerations stand in the place of forces.
    First,
    /// From the forces of one step to the places of the next.
    Between,
    /// After the last forces: leaves accelerations in the place of forces.
    Last,
}

/// What a pass did to spheres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// Least and largest displacement along each axis.
    least: Record,
    largest: Record,
    /// The first that moved too far, and stayed where it was.
    pub(super) runaway: Option<Runaway>,
}

impl Default for Moved {
    fn default() -> Self {
        Self {
            least: Record([f64::INFINITY; 4]),
            largest: Record([f64::NEG_INFINITY; 4]),
            runaway: None,
        }
    }
}

impl Moved {
    /// Of these spheres and of others.
    pub(super) fn and(mut self, other: Self) -> Self {
        for axis in 0..3 {
            self.least.0[axis] = self.least.0[axis].min(other.least.0[axis]);
            self.largest.0[axis] = self.largest.0[axis].max(other.largest.0[axis]);
        }
        let runaways = [self.runaway, other.runaway].into_iter().flatten();
        self.runaway = runaways.min_by_key(|runaway| runaway.body);
        self
    }

    /// The bounds of the displacements.
    pub(super) fn drift(self) -> Drift {
        let [least_x, least_y, least, _] = self.least.0;
        let [largest_x, largest_y, largest, _] = self.largest.0;
        if least > largest {
            return Drift::NONE;
        }
        let lateral = libm::hypot(largest_x.max(-least_x), largest_y.max(-least_y));
        Drift {
            least,
            largest,
            lateral,
        }
    }
}

impl Spheres {
    /// Makes ready for a pass; answers by which formulas it moves.
    pub(super) fn prepare_to_move(&mut self, integrator: Integrator, stage: Stage) -> Integrator {
        let number = self.number();
        if stage != Stage::Last {
            self.acceleration_before.resize(number, Record::ZERO);
            self.angular_acceleration_before
                .resize(number, Record::ZERO);
        }
        if integrator == Integrator::AdamsBashforth && self.velocity_before.len() != number {
            // Without a past: the first step moves as velocity Verlet does.
            self.velocity_before.clone_from(&self.velocity);
            self.turning_before.clone_from(&self.turning);
            return Integrator::Verlet;
        }
        integrator
    }
}

/// A pass over some spheres, all grains or all of the wall.
pub(super) struct Motion<'a> {
    pub(super) spheres: SpheresMut<'a>,
    /// Forces and torques on them.
    pub(super) forces: [&'a mut [Record]; 2],
    pub(super) of_grains: bool,
    pub(super) integrator: Integrator,
    pub(super) stage: Stage,
    /// Taken off the force on each sphere of the wall.
    pub(super) mean_wall_force: Record,
    pub(super) rotates: bool,
    /// Force over mass, on the grains.
    pub(super) body_force: DVec3,
    pub(super) time_step: f64,
    pub(super) limit: f64,
    pub(super) length: f64,
}

impl Work for Motion<'_> {
    type Answer = Moved;

    #[inline(always)]
    fn run<M: Machine>(self) -> Moved {
        let step = self.time_step;
        match self.integrator {
            Integrator::Verlet => self.at_stage::<M, _>(Verlet::with_step(step)),
            Integrator::AdamsBashforth => self.at_stage::<M, _>(AdamsBashforth { step }),
        }
    }
}

impl Motion<'_> {
    #[inline(always)]
    fn at_stage<M: Machine, S: Scheme<Quad<M>>>(mut self, scheme: S) -> Moved {
        match self.stage {
            Stage::First => self.pass::<M, S, true, true>(scheme),
            Stage::Between => self.pass::<M, S, false, true>(scheme),
            Stage::Last => self.pass::<M, S, false, false>(scheme),
        }
    }

    /// The pass at a stage, which is the first or not, and moves the spheres or not.
    #[inline(always)]
    fn pass<M: Machine, S: Scheme<Quad<M>>, const FIRST: bool, const MOVES: bool>(
        &mut self,
        scheme: S,
    ) -> Moved {
        let mut extremes = Extremes::<M>::none();
        if self.of_grains {
            // Nothing added leaves even the sign of a zero as it is.
            let pushed = (self.body_force != DVec3::ZERO).then_some(self.body_force);
            let on_grains = (Record::ZERO, pushed);
            self.go_on::<M, S, FIRST, MOVES, false>(&scheme, on_grains, &mut extremes);
            if self.rotates {
                let torque = (Record::ZERO, None);
                self.go_on::<M, S, FIRST, MOVES, true>(&scheme, torque, &mut extremes);
            }
        } else {
            let on_wall = (self.mean_wall_force, None);
            self.go_on::<M, S, FIRST, MOVES, false>(&scheme, on_wall, &mut extremes);
            if !MOVES {
                // The spheres of a wall do not rotate, whatever torques contacts wrote there.
                self.forces[1].fill(Record::ZERO);
            }
        }
        Moved {
            least: extremes.least.record(),
            largest: extremes.largest.record(),
            runaway: extremes.runaway,
        }
    }

    /// Moves the spheres, or turns them: `mean` taken off the force (or torque) on each and `body_force` added to its
    /// acceleration.
    #[inline(always)]
    fn go_on<
        M: Machine,
        S: Scheme<Quad<M>>,
        const FIRST: bool,
        const MOVES: bool,
        const TURNS: bool,
    >(
        &mut self,
        scheme: &S,
        (mean, body_force): (Record, Option<DVec3>),
        extremes: &mut Extremes<M>,
    ) {
        let (limit_squared, length) = (self.limit * self.limit, self.length);
        let mean = mean.quad::<M::Quads>();
        let push = body_force.map(|push| Record::new(push, 0.0));
        let push = push.as_ref().map(Record::quad);
        let body = self.spheres.first;
        let count = self.spheres.position.len();
        let position = &mut self.spheres.position[..count];
        let degrees = match TURNS {
            true => &mut self.spheres.spin,
            false => &mut self.spheres.line,
        };
        let velocity = &mut degrees.velocity[..count];
        let force = &mut self.forces[usize::from(TURNS)][..count];
        let inverse_mass = &degrees.inverse[..count];
        let before = &mut degrees.acceleration_before[..count];
        let velocity_before = match S::TWO_STEP && MOVES {
            true => &mut degrees.velocity_before[..count],
            false => &mut [],
        };
        for k in 0..count {
            let mut acceleration = force[k].quad::<M::Quads>();
            let mut v = velocity[k].quad::<M::Quads>();
            if !FIRST {
                acceleration = (acceleration - mean) * inverse_mass[k];
                if let Some(push) = push {
                    acceleration = acceleration + push;
                }
                v = scheme.corrected(v, acceleration, before[k].quad());
            }
            if !MOVES {
                force[k] = acceleration.record();
                velocity[k] = v.record();
                continue;
            }
            if !TURNS {
                let v_before = if S::TWO_STEP {
                    velocity_before[k].quad()
                } else {
                    v
                };
                let by = scheme.displacement(v, acceleration, v_before);
                let [x, y, z, _] = (by * by).record().0;
                let squared = x + y + z;
                // A comparison with NaN is false: written so that NaN is caught.
                let in_reach = squared <= limit_squared;
                if !in_reach {
                    extremes.runaway = extremes.runaway.or(Some(Runaway {
                        body: body + k,
                        displacement: squared.sqrt(),
                    }));
                    continue;
                }
                extremes.add(by);
                position[k] = (position[k].quad() + by).record();
                let z = position[k].0[2];
                if !(0.0..length).contains(&z) {
                    let (folded, turns) = fold(z, length);
                    position[k].0[2] = folded;
                    position[k].0[3] += f64::from(turns);
                }
            }
            if S::TWO_STEP {
                velocity_before[k] = v.record();
            }
            let predicted = scheme.predicted(v, acceleration, before[k].quad());
            velocity[k] = predicted.record();
            before[k] = acceleration.record();
            force[k] = Record::ZERO;
        }
    }
}

/// Least and largest displacement along each axis, and the first sphere that would go too far.
#[derive(Clone, Copy)]
struct Extremes<M: Machine> {
    least: Quad<M>,
    largest: Quad<M>,
    runaway: Option<Runaway>,
}

impl<M: Machine> Extremes<M> {
    #[inline(always)]
    fn none() -> Self {
        Self {
            least: Quad::<M>::splat(f64::INFINITY),
            largest: Quad::<M>::splat(f64::NEG_INFINITY),
            runaway: None,
        }
    }

    #[inline(always)]
    fn add(&mut self, by: Quad<M>) {
        self.least = self.least.min(by);
        self.largest = self.largest.max(by);
    }
}
