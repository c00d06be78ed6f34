//! Motion of the spheres from one evaluation of the forces to the next, in one pass.

use peristalsis_physics::method::Integrator;

use super::record::Record;
use super::spheres::Spheres;
use crate::bodies::fold;
use crate::fast::lanes::Quad;
use crate::fast::machine::{Machine, Work};
use crate::integrate::adams_bashforth::AdamsBashforth;
use crate::integrate::verlet::Verlet;
use crate::integrate::{Runaway, Scheme};

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

/// Bounds of the displacements of a pass, for the list of neighbours.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Travel {
    /// Largest lateral displacement, or more.
    pub(super) lateral: f64,
    /// Largest axial displacement less the least.
    pub(super) axial: f64,
}

impl Travel {
    pub(super) fn add(&mut self, more: Self) {
        self.lateral += more.lateral;
        self.axial += more.axial;
    }

    /// Whether two spheres may have come closer by more than `skin`.
    pub(super) fn exceeds(self, skin: f64) -> bool {
        self.axial * self.axial + 4.0 * self.lateral * self.lateral > skin * skin
    }
}

/// A pass over all spheres.
pub(super) struct Motion<'a> {
    pub(super) spheres: &'a mut Spheres,
    pub(super) integrator: Integrator,
    pub(super) stage: Stage,
    /// Taken off the force on each sphere of the wall.
    pub(super) mean_wall_force: Record,
    pub(super) rotates: bool,
    /// Force over mass along +z, on the grains.
    pub(super) body_force: f64,
    pub(super) time_step: f64,
    pub(super) limit: f64,
    pub(super) length: f64,
}

impl Work for Motion<'_> {
    type Answer = Result<Travel, Runaway>;

    #[inline(always)]
    fn run<M: Machine>(self) -> Self::Answer {
        let verlet = Verlet::with_step(self.time_step);
        let spheres = &mut *self.spheres;
        let number = spheres.number();
        if self.stage != Stage::Last {
            let before = &mut spheres.acceleration_before;
            before.resize(number, Record::ZERO);
            let before = &mut spheres.angular_acceleration_before;
            before.resize(number, Record::ZERO);
        }
        match self.integrator {
            Integrator::Verlet => self.at_stage::<M, _>(verlet),
            Integrator::AdamsBashforth if spheres.velocity_before.len() != number => {
                // Without a past: the first step moves as velocity Verlet does.
                spheres.velocity_before.clone_from(&spheres.velocity);
                spheres.turning_before.clone_from(&spheres.turning);
                self.at_stage::<M, _>(verlet)
            }
            Integrator::AdamsBashforth => {
                let step = self.time_step;
                self.at_stage::<M, _>(AdamsBashforth { step })
            }
        }
    }
}

impl Motion<'_> {
    #[inline(always)]
    fn at_stage<M: Machine, S: Scheme<Quad<M>>>(mut self, scheme: S) -> Result<Travel, Runaway> {
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
    ) -> Result<Travel, Runaway> {
        let grains = self.spheres.grains;
        let number = self.spheres.number();
        let mut extremes = Extremes::<M>::none();
        let mean = self.mean_wall_force;
        // Nothing added leaves even the sign of a zero as it is.
        let pushed = (self.body_force != 0.0).then_some(self.body_force);
        let (on_grains, on_wall) = ((Record::ZERO, pushed), (mean, None));
        self.go_on::<M, S, FIRST, MOVES, false>(&scheme, 0..grains, on_grains, &mut extremes)?;
        self.go_on::<M, S, FIRST, MOVES, false>(&scheme, grains..number, on_wall, &mut extremes)?;
        if self.rotates {
            let torque = (Record::ZERO, None);
            self.go_on::<M, S, FIRST, MOVES, true>(&scheme, 0..grains, torque, &mut extremes)?;
        }
        if !MOVES {
            // The spheres of a wall do not rotate, whatever torques contacts wrote there.
            self.spheres.torque[grains..].fill(Record::ZERO);
        }
        Ok(extremes.travel())
    }

    /// Moves a range of spheres, or turns them: `mean` taken off the force (or torque) on each and `body_force` added to its
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
        range: core::ops::Range<usize>,
        (mean, body_force): (Record, Option<f64>),
        extremes: &mut Extremes<M>,
    ) -> Result<(), Runaway> {
        let (limit_squared, length) = (self.limit * self.limit, self.length);
        let (count, body) = (range.len(), range.start);
        let mean = mean.quad::<M::Quads>();
        let push = body_force.map(|push| Record([0.0, 0.0, push, 0.0]));
        let push = push.as_ref().map(Record::quad);
        let spheres = &mut *self.spheres;
        let position = &mut spheres.position[range.clone()][..count];
        let (velocity, force, inverse_mass, before, velocity_before) = if TURNS {
            (
                &mut spheres.turning,
                &mut spheres.torque,
                &spheres.inverse_inertia,
                &mut spheres.angular_acceleration_before,
                &mut spheres.turning_before,
            )
        } else {
            (
                &mut spheres.velocity,
                &mut spheres.force,
                &spheres.inverse_mass,
                &mut spheres.acceleration_before,
                &mut spheres.velocity_before,
            )
        };
        let velocity = &mut velocity[range.clone()][..count];
        let force = &mut force[range.clone()][..count];
        let inverse_mass = &inverse_mass[range.clone()][..count];
        let before = &mut before[range.clone()][..count];
        let velocity_before = match S::TWO_STEP && MOVES {
            true => &mut velocity_before[range][..count],
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
                    return Err(Runaway {
                        body: body + k,
                        displacement: squared.sqrt(),
                    });
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
        Ok(())
    }
}

/// Least and largest displacement along each axis.
#[derive(Clone, Copy)]
struct Extremes<M: Machine> {
    least: Quad<M>,
    largest: Quad<M>,
}

impl<M: Machine> Extremes<M> {
    #[inline(always)]
    fn none() -> Self {
        Self {
            least: Quad::<M>::splat(f64::INFINITY),
            largest: Quad::<M>::splat(f64::NEG_INFINITY),
        }
    }

    #[inline(always)]
    fn add(&mut self, by: Quad<M>) {
        self.least = self.least.min(by);
        self.largest = self.largest.max(by);
    }

    #[inline(always)]
    fn travel(&self) -> Travel {
        let [least_x, least_y, least_z, _] = self.least.record().0;
        let [largest_x, largest_y, largest_z, _] = self.largest.record().0;
        if least_z > largest_z {
            return Travel::default();
        }
        let x = largest_x.max(-least_x);
        let y = largest_y.max(-least_y);
        Travel {
            lateral: (x * x + y * y).sqrt(),
            axial: largest_z - least_z,
        }
    }
}
