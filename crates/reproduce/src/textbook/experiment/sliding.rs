//! A sphere thrown along a plane on which its weight presses it.

use glam::DVec3;
use peristalsis_engine::{Bodies, Parameters, Simulation};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, LinearSpringDashpot, Normal, RollingResistance,
};

use super::{Means, plane};
use crate::error::Result;

/// Diameter of the sphere that stands for the plane \[d\]: a path of a few d inclines it by some 1e-5 only.
const PLANE_DIAMETER: f64 = 1e6;

/// A sphere of diameter and mass 1 on a plane, level or inclined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Throw {
    pub(crate) normal: LinearSpringDashpot,
    pub(crate) friction: CundallStrack,
    pub(crate) rolling: Option<RollingResistance>,
    /// g \[d/t^2\]
    pub(crate) gravity: f64,
    /// tan(theta) of the plane, which falls along the throw.
    pub(crate) slope: f64,
    /// v_0 \[d/t\]
    pub(crate) speed: f64,
}

/// The motion at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub(crate) time: f64,
    /// Velocity of the centre \[d/t\].
    pub(crate) velocity: f64,
    /// Velocity at which the sphere would roll with its spin \[d/t\].
    pub(crate) rolling: f64,
}

impl Throw {
    /// Gravity: down the plane is y, into it -z.
    fn weight(&self) -> DVec3 {
        let cosine = 1.0 / (1.0 + self.slope * self.slope).sqrt();
        self.gravity * cosine * DVec3::new(0.0, self.slope, -1.0)
    }

    /// Overlap under the weight \[d\].
    pub(crate) fn overlap(&self) -> f64 {
        -self.weight().z / self.normal.normal_stiffness
    }

    /// a/g along the plane in the second half of `duration`, after the spring of the contact has come to rest.
    ///
    /// # Errors
    /// Errors of the engine.
    pub(crate) fn late_acceleration(
        &self,
        means: Means,
        time_step: f64,
        duration: f64,
    ) -> Result<f64> {
        let course = self.simulate(means, time_step, duration)?;
        let [middle, last] = [course.len() / 2, course.len() - 1].map(|step| course[step]);
        Ok((last.velocity - middle.velocity) / (self.gravity * (last.time - middle.time)))
    }

    /// The motion at every step up to `duration`.
    ///
    /// # Errors
    /// Errors of the engine.
    pub(crate) fn simulate(
        &self,
        means: Means,
        time_step: f64,
        duration: f64,
    ) -> Result<Vec<Instant>> {
        // A ring of one sphere (almost) on the axis: its top is a plane across the axis.
        let off_axis = 1e-3;
        let height = 0.5 * (1.0 + PLANE_DIAMETER) - self.overlap();
        let mut bodies = Bodies::grains_at_rest(vec![DVec3::new(off_axis, 0.0, height)], vec![1.0]);
        bodies.velocity[0] = DVec3::new(0.0, self.speed, 0.0);
        let contact = ContactModel {
            rolling: self.rolling,
            ..ContactModel::new(Normal::Linear(self.normal), Some(self.friction))
        };
        let parameters = Parameters {
            body_force: self.weight(),
            ..means.parameters(contact, time_step, 0.3)
        };
        let mut simulation = Simulation::new(bodies, plane(PLANE_DIAMETER, off_axis), parameters);
        let arm = 0.5 * (1.0 - self.overlap());
        let steps = (duration / time_step).round() as usize;
        let mut instants = Vec::with_capacity(steps + 1);
        for step in 0..=steps {
            if step > 0 {
                simulation.advance(1)?;
            }
            let bodies = simulation.bodies();
            instants.push(Instant {
                time: simulation.time(),
                velocity: bodies.velocity[0].y,
                rolling: -arm * bodies.angular_velocity[0].x,
            });
        }
        Ok(instants)
    }
}
