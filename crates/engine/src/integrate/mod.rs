//! Integrators of the equations of motion: the formulas of each in a file, the same for all kernels.

pub(crate) mod adams_bashforth;
mod scheme;
pub(crate) mod verlet;

use glam::DVec3;
use peristalsis_physics::method::Integrator;

use self::adams_bashforth::AdamsBashforth;
pub(crate) use self::scheme::Scheme;
use self::verlet::Verlet;
use crate::bodies::Bodies;

/// Velocities and accelerations of the step before, as far as the integrator needs them.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Past {
    pub(crate) velocity: Vec<DVec3>,
    pub(crate) acceleration: Vec<DVec3>,
    pub(crate) angular_velocity: Vec<DVec3>,
    pub(crate) angular_acceleration: Vec<DVec3>,
}

/// A sphere that moved too far in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Runaway {
    pub(crate) body: usize,
    pub(crate) displacement: f64,
}

/// Moves positions to the end of the step and velocities to where the forces want them.
pub(crate) fn before_forces(
    integrator: Integrator,
    bodies: &mut Bodies,
    past: &mut Past,
    step: f64,
    limit: f64,
) -> Result<(), Runaway> {
    match integrator {
        Integrator::Verlet => begin(Verlet::with_step(step), step, bodies, past, limit),
        Integrator::AdamsBashforth => begin(AdamsBashforth { step }, step, bodies, past, limit),
    }
}

/// Brings velocities to the end of the step, now that the forces there are known.
pub(crate) fn after_forces(integrator: Integrator, bodies: &mut Bodies, past: &Past, step: f64) {
    match integrator {
        Integrator::Verlet => end(Verlet::with_step(step), bodies, past),
        Integrator::AdamsBashforth => end(AdamsBashforth { step }, bodies, past),
    }
}

/// Moves positions and predicts velocities; stops at the first displacement that is longer than `limit` or not finite.
fn begin<S: Scheme<DVec3>>(
    scheme: S,
    step: f64,
    bodies: &mut Bodies,
    past: &mut Past,
    limit: f64,
) -> Result<(), Runaway> {
    let has_past = S::TWO_STEP && past.velocity.len() == bodies.number();
    for body in 0..bodies.number() {
        let (velocity, acceleration) = (bodies.velocity[body], bodies.acceleration[body]);
        let by = if has_past {
            scheme.displacement(velocity, acceleration, past.velocity[body])
        } else {
            Verlet::with_step(step).displacement(velocity, acceleration, velocity)
        };
        let squared = by.length_squared();
        // A comparison with NaN is false: written so that NaN is caught.
        let in_reach = squared <= limit * limit;
        if !in_reach {
            return Err(Runaway {
                body,
                displacement: squared.sqrt(),
            });
        }
        bodies.position[body] += by;
    }
    if S::TWO_STEP {
        past.velocity.clone_from(&bodies.velocity);
        past.angular_velocity.clone_from(&bodies.angular_velocity);
    }
    if !has_past {
        // With a past equal to the present the formula below is the formula of a first step.
        past.remember_accelerations(bodies);
    }
    for (velocity, now, before) in velocities(bodies, past) {
        *velocity = scheme.predicted(*velocity, *now, *before);
    }
    past.remember_accelerations(bodies);
    Ok(())
}

/// Corrects velocities.
fn end(scheme: impl Scheme<DVec3>, bodies: &mut Bodies, past: &Past) {
    for (velocity, now, before) in velocities(bodies, past) {
        *velocity = scheme.corrected(*velocity, *now, *before);
    }
}

impl Past {
    /// Sets the past of a body that was put elsewhere to its present.
    pub(crate) fn forget(&mut self, bodies: &Bodies, body: usize) {
        let present = [
            (&mut self.velocity, &bodies.velocity),
            (&mut self.acceleration, &bodies.acceleration),
            (&mut self.angular_velocity, &bodies.angular_velocity),
            (&mut self.angular_acceleration, &bodies.angular_acceleration),
        ];
        for (past, present) in present {
            if let Some(past) = past.get_mut(body) {
                *past = present[body];
            }
        }
    }

    fn remember_accelerations(&mut self, bodies: &Bodies) {
        self.acceleration.clone_from(&bodies.acceleration);
        self.angular_acceleration
            .clone_from(&bodies.angular_acceleration);
    }
}

/// Each velocity and angular velocity with its acceleration now and a step before.
fn velocities<'a>(
    bodies: &'a mut Bodies,
    past: &'a Past,
) -> impl Iterator<Item = (&'a mut DVec3, &'a DVec3, &'a DVec3)> {
    let velocities = bodies
        .velocity
        .iter_mut()
        .chain(&mut bodies.angular_velocity);
    let now = bodies
        .acceleration
        .iter()
        .chain(&bodies.angular_acceleration);
    let before = past.acceleration.iter().chain(&past.angular_acceleration);
    velocities
        .zip(now)
        .zip(before)
        .map(|((velocity, now), before)| (velocity, now, before))
}
