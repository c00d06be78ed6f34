//! The columns of the tables of contacts and of grains at an instant.

use peristalsis_engine::{Simulation, Sphere};
use peristalsis_observe::Reading::{Real, Truth, Whole};
use peristalsis_observe::{GrainContact, Quantity};

/// The columns of a table of contacts, in order.
#[rustfmt::skip]
pub(crate) const CONTACT: &[Quantity<GrainContact>] = &[
    Quantity::new("i", "1", "number of the grain, from 0", Whole(|c| c.touching.first as u64)),
    Quantity::new("j", "1", "number of its partner: from N on a sphere of the wall, or a flank of a smooth one", Whole(|c| c.touching.second as u64)),
    Quantity::new("wall", "", "whether the partner is a sphere of the wall", Truth(|c| c.is_with_wall)),
    Quantity::new("overlap", "d", "overlap", Real(|c| c.touching.overlap)),
    Quantity::new("normal_force", "m d/t^2", "force along the line of centres, positive where it repels", Real(|c| c.touching.normal_force)),
    Quantity::new("tangential_force", "m d/t^2", "size of the force in the plane of contact", Real(|c| c.touching.tangential_force)),
    Quantity::new("force_x", "m d/t^2", "force on grain i, along x", Real(|c| c.touching.force.x)),
    Quantity::new("force_y", "m d/t^2", "force on grain i, along y", Real(|c| c.touching.force.y)),
    Quantity::new("force_z", "m d/t^2", "force on grain i, along z", Real(|c| c.touching.force.z)),
    Quantity::new("tangential_x", "m d/t^2", "its part in the plane of contact, along x", Real(|c| c.tangential_force().x)),
    Quantity::new("tangential_y", "m d/t^2", "its part in the plane of contact, along y", Real(|c| c.tangential_force().y)),
    Quantity::new("tangential_z", "m d/t^2", "its part in the plane of contact, along z", Real(|c| c.tangential_force().z)),
    Quantity::new("x", "d", "where they touch, x", Real(|c| c.point.x)),
    Quantity::new("y", "d", "where they touch, y", Real(|c| c.point.y)),
    Quantity::new("z", "d", "where they touch, z; it may lie a little outside the tube", Real(|c| c.point.z)),
    Quantity::new("sliding", "", "whether the contact slides, as one without a normal force does", Truth(|c| c.touching.sliding)),
];

/// A grain at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grain {
    step: u64,
    time: f64,
    number: usize,
    /// Times round the tube.
    turns: i32,
    sphere: Sphere,
}

/// The columns of a table of grains, in order.
#[rustfmt::skip]
pub(crate) const GRAIN: &[Quantity<Grain>] = &[
    Quantity::new("step", "1", "steps done", Whole(|g| g.step)),
    Quantity::new("time", "t", "time since the start", Real(|g| g.time)),
    Quantity::new("grain", "1", "number of the grain, from 0", Whole(|g| g.number as u64)),
    Quantity::new("diameter", "d", "diameter", Real(|g| g.sphere.diameter)),
    Quantity::new("x", "d", "centre, x", Real(|g| g.sphere.position.x)),
    Quantity::new("y", "d", "centre, y", Real(|g| g.sphere.position.y)),
    Quantity::new("z", "d", "centre, z, within the tube", Real(|g| g.sphere.position.z)),
    Quantity::new("turns", "1", "times round the tube towards +z", Real(|g| f64::from(g.turns))),
    Quantity::new("vx", "d/t", "velocity, x", Real(|g| g.sphere.velocity.x)),
    Quantity::new("vy", "d/t", "velocity, y", Real(|g| g.sphere.velocity.y)),
    Quantity::new("vz", "d/t", "velocity, z, in the frame of the tube", Real(|g| g.sphere.velocity.z)),
    Quantity::new("omegax", "1/t", "angular velocity, x; 0 without friction", Real(|g| g.sphere.angular_velocity.x)),
    Quantity::new("omegay", "1/t", "angular velocity, y", Real(|g| g.sphere.angular_velocity.y)),
    Quantity::new("omegaz", "1/t", "angular velocity, z", Real(|g| g.sphere.angular_velocity.z)),
];

/// All grains as they stand.
pub(crate) fn grains(simulation: &Simulation) -> Vec<Grain> {
    let bodies = simulation.bodies();
    (0..bodies.grains)
        .map(|number| Grain {
            step: simulation.step(),
            time: simulation.time(),
            number,
            turns: bodies.turns[number],
            sphere: bodies.sphere(number),
        })
        .collect()
}
