//! Velocity Verlet for forces that depend on velocity.
//!
//! x' = x + h v + h^2 a/2;  a' = f(x', v + h a)/m;  v' = v + h (a + a')/2
//!
//! The velocity that the forces see is predicted to the end of the step, with an error of order h^2, so that damping is
//! integrated to order 2 as well (a velocity of the half step would leave order 1). Without damping this is the
//! symplectic velocity Verlet method. Groot & Warren, J. Chem. Phys. 107, 4423 (1997), with lambda = 1.

use super::{Past, Runaway, displace};
use crate::bodies::Bodies;

pub(super) fn before_forces(
    bodies: &mut Bodies,
    past: &mut Past,
    h: f64,
    limit: f64,
) -> Result<(), Runaway> {
    displace(bodies, limit, |bodies, i| {
        h * (bodies.velocity[i] + 0.5 * h * bodies.acceleration[i])
    })?;
    for (velocity, acceleration) in bodies.velocity.iter_mut().zip(&bodies.acceleration) {
        *velocity += h * *acceleration;
    }
    for (velocity, acceleration) in bodies
        .angular_velocity
        .iter_mut()
        .zip(&bodies.angular_acceleration)
    {
        *velocity += h * *acceleration;
    }
    past.acceleration.clone_from(&bodies.acceleration);
    past.angular_acceleration
        .clone_from(&bodies.angular_acceleration);
    Ok(())
}

pub(super) fn after_forces(bodies: &mut Bodies, past: &Past, h: f64) {
    let half = 0.5 * h;
    for ((velocity, now), then) in bodies
        .velocity
        .iter_mut()
        .zip(&bodies.acceleration)
        .zip(&past.acceleration)
    {
        *velocity += half * (*now - *then);
    }
    for ((velocity, now), then) in bodies
        .angular_velocity
        .iter_mut()
        .zip(&bodies.angular_acceleration)
        .zip(&past.angular_acceleration)
    {
        *velocity += half * (*now - *then);
    }
}
