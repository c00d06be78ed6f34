//! Integrators of the equations of motion: one file each.

pub mod adams_bashforth;
pub mod verlet;

use glam::DVec3;

pub use peristalsis_physics::method::Integrator;

use crate::bodies::Bodies;

/// What an integrator remembers of the step before.
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
    time_step: f64,
    limit: f64,
) -> Result<(), Runaway> {
    match integrator {
        Integrator::Verlet => verlet::before_forces(bodies, past, time_step, limit),
        Integrator::AdamsBashforth => {
            adams_bashforth::before_forces(bodies, past, time_step, limit)
        }
    }
}

/// Brings velocities to the end of the step, now that the forces there are known.
pub(crate) fn after_forces(
    integrator: Integrator,
    bodies: &mut Bodies,
    past: &Past,
    time_step: f64,
) {
    match integrator {
        Integrator::Verlet => verlet::after_forces(bodies, past, time_step),
        Integrator::AdamsBashforth => {}
    }
}

/// Adds displacements to positions; stops at the first that is longer than `limit` or not finite.
fn displace(
    bodies: &mut Bodies,
    limit: f64,
    displacement: impl Fn(&Bodies, usize) -> DVec3,
) -> Result<(), Runaway> {
    for body in 0..bodies.number() {
        let by = displacement(bodies, body);
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
    Ok(())
}
