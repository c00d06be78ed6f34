//! Two-step Adams-Bashforth, the integrator of the source.
//!
//! x' = x + h (3 v - v_before)/2;  v' = v + h (3 a - a_before)/2;  then a' = f(x', v')/m
//!
//! The first step has no past: x' = x + h v + h^2 a/2, v' = v + h a. Its local errors, of order h^3 in x and h^2 in v,
//! occur once, so that the order stays 2. A snapshot holds the past, so that a restart is no first step.

use super::{Past, Runaway, displace};
use crate::bodies::Bodies;

pub(super) fn before_forces(
    bodies: &mut Bodies,
    past: &mut Past,
    h: f64,
    limit: f64,
) -> Result<(), Runaway> {
    if past.velocity.len() == bodies.number() {
        displace(bodies, limit, |bodies, i| {
            h * (1.5 * bodies.velocity[i] - 0.5 * past.velocity[i])
        })?;
    } else {
        displace(bodies, limit, |bodies, i| {
            h * (bodies.velocity[i] + 0.5 * h * bodies.acceleration[i])
        })?;
        // A past equal to the present makes the formulas below those of the first step.
        past.acceleration.clone_from(&bodies.acceleration);
        past.angular_acceleration
            .clone_from(&bodies.angular_acceleration);
    }
    past.velocity.clone_from(&bodies.velocity);
    past.angular_velocity.clone_from(&bodies.angular_velocity);
    let advance = |velocity: &mut [glam::DVec3], now: &[glam::DVec3], then: &[glam::DVec3]| {
        for ((velocity, now), then) in velocity.iter_mut().zip(now).zip(then) {
            *velocity += h * (1.5 * *now - 0.5 * *then);
        }
    };
    advance(
        &mut bodies.velocity,
        &bodies.acceleration,
        &past.acceleration,
    );
    advance(
        &mut bodies.angular_velocity,
        &bodies.angular_acceleration,
        &past.angular_acceleration,
    );
    past.acceleration.clone_from(&bodies.acceleration);
    past.angular_acceleration
        .clone_from(&bodies.angular_acceleration);
    Ok(())
}
