//! Motion of the spheres from one evaluation of the forces to the next, in one pass.

use super::record::{Quad, Record};
use super::spheres::Spheres;
use crate::bodies::fold;
use crate::fast::machine::{Machine, Work};
use crate::integrate::{Integrator, Runaway};

/// Where in an advance the pass stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// Before the first forces: what stands in the place of forces is accelerations.
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
    fn run<M: Machine>(mut self) -> Self::Answer {
        let number = self.spheres.number();
        let has_past = self.spheres.velocity_before.len() == number;
        if self.stage != Stage::Last {
            self.spheres
                .acceleration_before
                .resize(number, Record::ZERO);
            self.spheres
                .angular_acceleration_before
                .resize(number, Record::ZERO);
            if self.integrator == Integrator::AdamsBashforth {
                self.spheres.velocity_before.resize(number, Record::ZERO);
                self.spheres.spin_before.resize(number, Record::ZERO);
            }
        }
        match (self.integrator, self.stage) {
            (Integrator::Verlet, Stage::First) => self.pass::<M, false, true, true, false>(),
            (Integrator::Verlet, Stage::Between) => self.pass::<M, false, false, true, false>(),
            (Integrator::Verlet, Stage::Last) => self.pass::<M, false, false, false, false>(),
            (Integrator::AdamsBashforth, Stage::First) if !has_past => {
                self.pass::<M, true, true, true, true>()
            }
            (Integrator::AdamsBashforth, Stage::First) => self.pass::<M, true, true, true, false>(),
            (Integrator::AdamsBashforth, Stage::Between) => {
                self.pass::<M, true, false, true, false>()
            }
            (Integrator::AdamsBashforth, Stage::Last) => {
                self.pass::<M, true, false, false, false>()
            }
        }
    }
}

impl Motion<'_> {
    /// The pass for `ADAMS`-Bashforth or Verlet; `FIRST`: forces are accelerations; `MOVES`: not the last; `FRESH`:
    /// Adams-Bashforth without a past.
    #[inline(always)]
    fn pass<
        M: Machine,
        const ADAMS: bool,
        const FIRST: bool,
        const MOVES: bool,
        const FRESH: bool,
    >(
        &mut self,
    ) -> Result<Travel, Runaway> {
        let grains = self.spheres.grains;
        let number = self.spheres.number();
        let mut extremes = Extremes::<M>::none();
        let mean = self.mean_wall_force;
        // Nothing added leaves even the sign of a zero as it is.
        let pushed = (self.body_force != 0.0).then_some(self.body_force);
        let (on_grains, on_wall) = ((Record::ZERO, pushed), (mean, None));
        self.translate::<M, ADAMS, FIRST, MOVES, FRESH>(0..grains, on_grains, &mut extremes)?;
        self.translate::<M, ADAMS, FIRST, MOVES, FRESH>(grains..number, on_wall, &mut extremes)?;
        if self.rotates {
            self.rotate::<M, ADAMS, FIRST, MOVES, FRESH>(grains);
        }
        if !MOVES {
            // The spheres of a wall do not rotate, whatever torques contacts wrote there.
            self.spheres.torque[grains..].fill(Record::ZERO);
        }
        Ok(extremes.travel())
    }

    #[inline(always)]
    fn translate<
        M: Machine,
        const ADAMS: bool,
        const FIRST: bool,
        const MOVES: bool,
        const FRESH: bool,
    >(
        &mut self,
        range: core::ops::Range<usize>,
        (mean, body_force): (Record, Option<f64>),
        extremes: &mut Extremes<M>,
    ) -> Result<(), Runaway> {
        let h = self.time_step;
        let (half, limit_squared, length) = (0.5 * h, self.limit * self.limit, self.length);
        let (count, body) = (range.len(), range.start);
        let mean = mean.quad::<M>();
        let push = body_force.map(|push| Record([0.0, 0.0, push, 0.0]));
        let push = push.as_ref().map(Record::quad);
        let spheres = &mut *self.spheres;
        let position = &mut spheres.position[range.clone()][..count];
        let velocity = &mut spheres.velocity[range.clone()][..count];
        let force = &mut spheres.force[range.clone()][..count];
        let inverse_mass = &spheres.inverse_mass[range.clone()][..count];
        let before = &mut spheres.acceleration_before[range.clone()][..count];
        let velocity_before = match ADAMS && MOVES {
            true => &mut spheres.velocity_before[range][..count],
            false => &mut [],
        };
        for k in 0..count {
            let mut acceleration = force[k].quad::<M>();
            if !FIRST {
                acceleration = (acceleration - mean) * inverse_mass[k];
                if let Some(push) = push {
                    acceleration = acceleration + push;
                }
            }
            let mut v = velocity[k].quad::<M>();
            if !ADAMS && !FIRST {
                v = v + (acceleration - before[k].quad()) * half;
            }
            if !MOVES {
                force[k] = acceleration.record();
                velocity[k] = v.record();
                continue;
            }
            let by = if ADAMS && !FRESH {
                (v * 1.5 - velocity_before[k].quad() * 0.5) * h
            } else {
                (v + acceleration * half) * h
            };
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
            if ADAMS {
                velocity_before[k] = v.record();
            }
            let gained = if ADAMS && !FRESH {
                acceleration * 1.5 - before[k].quad() * 0.5
            } else {
                acceleration
            };
            velocity[k] = (v + gained * h).record();
            before[k] = acceleration.record();
            force[k] = Record::ZERO;
        }
        Ok(())
    }

    #[inline(always)]
    fn rotate<
        M: Machine,
        const ADAMS: bool,
        const FIRST: bool,
        const MOVES: bool,
        const FRESH: bool,
    >(
        &mut self,
        grains: usize,
    ) {
        let h = self.time_step;
        let half = 0.5 * h;
        let spheres = &mut *self.spheres;
        let spin = &mut spheres.spin[..grains];
        let torque = &mut spheres.torque[..grains];
        let inverse_inertia = &spheres.inverse_inertia[..grains];
        let before = &mut spheres.angular_acceleration_before[..grains];
        let spin_before = match ADAMS && MOVES {
            true => &mut spheres.spin_before[..grains],
            false => &mut [],
        };
        for k in 0..grains {
            let mut acceleration = torque[k].quad::<M>();
            if !FIRST {
                acceleration = acceleration * inverse_inertia[k];
            }
            let mut omega = spin[k].quad::<M>();
            if !ADAMS && !FIRST {
                omega = omega + (acceleration - before[k].quad()) * half;
            }
            if !MOVES {
                torque[k] = acceleration.record();
                spin[k] = omega.record();
                continue;
            }
            if ADAMS {
                spin_before[k] = omega.record();
            }
            let gained = if ADAMS && !FRESH {
                acceleration * 1.5 - before[k].quad() * 0.5
            } else {
                acceleration
            };
            spin[k] = (omega + gained * h).record();
            before[k] = acceleration.record();
            torque[k] = Record::ZERO;
        }
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
            least: Quad::splat(f64::INFINITY),
            largest: Quad::splat(f64::NEG_INFINITY),
        }
    }

    #[inline(always)]
    fn add(&mut self, by: Quad<M>) {
        self.least = self.least.lesser(by);
        self.largest = self.largest.larger(by);
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
