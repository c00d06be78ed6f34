//! Grains that fall, and grains that have settled in a tube.

use glam::DVec3;
use peristalsis_engine::initial::{InitialState, Packing, pack, settle};
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Bodies, Parameters, Simulation, Wall};
use peristalsis_physics::contact::ContactModel;
use peristalsis_physics::sizes::Sizes;
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};

use super::{Means, far_away};
use crate::error::Result;

/// How far a grain falls from rest in a time \[d\].
///
/// # Errors
/// Errors of the engine.
pub(crate) fn fall(
    contact: ContactModel,
    means: Means,
    gravity: DVec3,
    (time_step, duration): (f64, f64),
) -> Result<DVec3> {
    let (radius, length) = (1e3, 40.0);
    let bodies = Bodies::grains_at_rest(vec![DVec3::ZERO], vec![1.0]);
    let parameters = Parameters {
        body_force: gravity,
        ..means.parameters(contact, time_step, 0.3)
    };
    let mut simulation = Simulation::new(bodies, far_away(radius, length), parameters);
    simulation.advance((duration / time_step).round() as u64)?;
    let bodies = simulation.bodies();
    Ok(bodies.position[0].with_z(bodies.unfolded(0, length)))
}

/// Force of the wall on grains that have settled, over their weight; along gravity upward, so that it is 1 at rest.
///
/// # Errors
/// Errors of the engine.
pub(crate) fn borne_weight(contact: ContactModel, means: Means, gravity: DVec3) -> Result<f64> {
    let lattice = Lattice {
        spheres_per_ring: 12,
        rings_per_wave: 14,
        waves: 2,
        wavelength: 10.0,
        sphere_diameter: 1.0,
        staggered: true,
    };
    // Throats of width 1.2 between centres, which no grain passes.
    let wall = Wall::Prescribed(PrescribedWall::new(
        lattice,
        1.5,
        Waveform::Sine,
        -1.0,
        Schedule::constant(0.9),
        Schedule::constant(0.0),
    ));
    let packing = Packing {
        number: 30,
        sizes: Sizes::Uniform([0.8, 1.0]),
        state: InitialState::Settled,
        axial_velocity: 0.0,
        temperature: 0.0,
        seed: 1,
    };
    let parameters = Parameters {
        body_force: gravity,
        ..means.parameters(contact, 0.05, 0.3)
    };
    let (bodies, packed) = pack(&packing, &wall, contact.normal)?;
    let (simulation, _) = settle(bodies, wall, parameters, packed, &|| false)?;
    let mut borne = DVec3::ZERO;
    simulation.for_each_wall_contact(|contact| {
        borne += contact.normal_force + contact.tangential_force;
    });
    let bodies = simulation.bodies();
    let mass: f64 = bodies.mass[..bodies.grains].iter().sum();
    Ok(-borne.dot(gravity) / (mass * gravity.length_squared()))
}
