//! Spheres that cohere: a grain that hangs on a plane, and two that meet.

use glam::DVec3;
use peristalsis_engine::{Bodies, Parameters, Simulation};
use peristalsis_physics::contact::ContactModel;

use super::{Means, far_away, plane};
use crate::error::Result;

/// Diameter of the sphere that stands for the plane \[d\].
const PLANE_DIAMETER: f64 = 1e6;
/// The weight grows by this part of the expected pull-off force at a time.
const PART: f64 = 0.0025;
const PARTS: u32 = 480;

/// Weight at which a grain of diameter and mass 1 falls from a plane, which grows slowly past `expected` \[m d/t^2\];
/// infinite where it never falls.
///
/// # Errors
/// Errors of the engine.
pub(crate) fn pull_off(
    contact: ContactModel,
    means: Means,
    time_step: f64,
    expected: f64,
) -> Result<f64> {
    let off_axis = 1e-3;
    let height = 0.5 * (1.0 + PLANE_DIAMETER) - 1e-4;
    let bodies = Bodies::grains_at_rest(vec![DVec3::new(off_axis, 0.0, height)], vec![1.0]);
    let wall = plane(PLANE_DIAMETER, off_axis);
    let parameters = means.parameters(contact, time_step, 0.3);
    let mut simulation = Simulation::new(bodies, wall.clone(), parameters);
    // At the start it falls into its place.
    simulation.advance((400.0 / time_step) as u64)?;
    for part in 1..=PARTS {
        let weight = PART * f64::from(part) * expected;
        let heavier = Parameters {
            body_force: weight * DVec3::Z,
            ..parameters
        };
        simulation = Simulation::restore(simulation.snapshot(), wall.clone(), heavier)?;
        simulation.advance((40.0 / time_step) as u64)?;
        if simulation.tally().wall_contacts == 0 {
            return Ok(weight);
        }
    }
    Ok(f64::INFINITY)
}

/// Restitution of two spheres of diameter and mass 1 that meet head-on at a relative speed; 0 where they stick.
///
/// # Errors
/// Errors of the engine.
pub(crate) fn restitution(
    contact: ContactModel,
    means: Means,
    time_step: f64,
    speed: f64,
) -> Result<f64> {
    let length = 40.0;
    let apart = 1.2;
    let place = |side: f64| DVec3::new(0.5 * side * apart, 0.0, 0.5 * length);
    let mut bodies = Bodies::grains_at_rest(vec![place(1.0), place(-1.0)], vec![1.0; 2]);
    bodies.velocity = [-0.5, 0.5]
        .map(|part| DVec3::new(part * speed, 0.0, 0.0))
        .to_vec();
    let parameters = means.parameters(contact, time_step, 0.3);
    let mut simulation = Simulation::new(bodies, far_away(100.0, length), parameters);
    // To meet, to turn, and to part as far; spheres that stick are still together then.
    let longest = 2.0 * apart / speed + 200.0;
    let mut met = false;
    for _ in 0..(longest / time_step) as u64 {
        simulation.advance(1)?;
        let touch = simulation.tally().grain_contacts > 0;
        if met && !touch {
            let velocity = &simulation.bodies().velocity;
            return Ok((velocity[0] - velocity[1]).x / speed);
        }
        met |= touch;
    }
    Ok(0.0)
}
