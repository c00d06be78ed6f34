//! The contacts with the wall, one by one, are all that the wall does to the grains.

mod common;

use common::*;

const BODY_FORCE: DVec3 = DVec3::new(0.001, -0.0005, -0.003);

fn walls() -> [Wall; 3] {
    let driven = elastic_with(|wall| wall.force_amplitude = Schedule::constant(0.02));
    let strained = strained(coarse(2), -1.0, 2.4, 0.1);
    [strained.clone(), smooth(strained), elastic(driven)]
}

/// Normal and tangential force on all grains, and the number of contacts.
fn forces(simulation: &Simulation) -> (DVec3, DVec3, u64) {
    let (mut normal, mut tangential, mut contacts) = (DVec3::ZERO, DVec3::ZERO, 0);
    simulation.for_each_wall_contact(|contact| {
        normal += contact.normal_force;
        tangential += contact.tangential_force;
        contacts += 1;
    });
    (normal, tangential, contacts)
}

fn of_grains(bodies: &Bodies) -> Bodies {
    let mut grains = bodies.clone();
    grains.mass[bodies.grains..].fill(0.0);
    grains
}

/// Force of the wall plus weight is the rate of change of the grains' momentum, for every law, wall, kernel and
/// integrator.
#[test]
fn the_momentum_balance_closes() {
    for wall in &walls() {
        for (_, model, integrator) in methods().filter(|(_, it, _)| !it.is_general()) {
            let bodies = packed(80, 0.8, wall, model.normal, 3);
            for kernel in KERNELS {
                let parameters = Parameters {
                    kernel,
                    body_force: BODY_FORCE,
                    ..parameters_with(model, integrator, 0.02)
                };
                balance(Simulation::new(bodies.clone(), wall.clone(), parameters));
            }
        }
    }
}

fn balance(mut simulation: Simulation) {
    let time_step = simulation.parameters().time_step;
    let frictional = simulation.parameters().contact.friction.is_some();
    let mass: f64 = of_grains(simulation.bodies()).mass.iter().sum();
    let weight = mass * BODY_FORCE;
    let start = momentum(&of_grains(simulation.bodies()));
    let (mut impulse, mut gross, mut by_friction) = (DVec3::ZERO, 0.0, 0.0);
    let (mut apart, mut axial) = (0.0, 0.0);
    let mut before = forces(&simulation);
    for _ in 0..1000 {
        simulation.advance(1).expect("does not diverge");
        let after = forces(&simulation);
        let tally = simulation.tally();
        assert_eq!(after.2, tally.wall_contacts);
        let half = 0.5 * time_step;
        let mean = before.0 + before.1 + after.0 + after.1;
        impulse += half * mean + time_step * weight;
        gross += half * mean.length();
        by_friction += half * (before.1 + after.1).length();
        apart += (after.0.z + after.1.z - tally.wall_axial_force).abs();
        axial += tally.wall_axial_force.abs();
        before = after;
    }
    let gained = momentum(&of_grains(simulation.bodies())) - start;
    assert!(gross > 0.1 && gained.length() > 1e-3);
    assert_eq!(by_friction > 1e-4, frictional);
    let missing = (gained - impulse).length();
    assert!(
        missing < 2e-3 * gross,
        "{:?}: {gained} and {impulse}, of {gross}",
        simulation.parameters()
    );
    // Forces of the step saw velocities that the integrator has corrected since: a contact about to slide may slide.
    assert!(apart < 2e-2 * axial, "{apart} of {axial}");
}

/// Where they touch is on both spheres' side of the line of centres, half the overlap inside the grain's surface.
#[test]
fn contacts_lie_on_the_wall() {
    let wall = strained(coarse(2), -1.0, 3.0, 0.0);
    let bodies = packed(80, 1.0, &wall, LINEAR, 3);
    let parameters = parameters(LINEAR, Some(FRICTION), INTEGRATORS[0], 0.05);
    let simulation = Simulation::new(bodies, wall, parameters);
    let mut contacts = 0;
    simulation.for_each_wall_contact(|contact| {
        contacts += 1;
        let centre = simulation.bodies().position[contact.grain];
        let arm = centre - contact.point;
        let along = arm.dot(contact.normal_force) / contact.normal_force.length();
        assert!((along - arm.length()).abs() < 1e-12 && arm.length() < 0.5);
        // A straight tube of radius 1.5, its spheres' radius 1/2 and half the overlap more at most.
        let from_axis = contact.point.truncate().length();
        assert!((0.9..1.6).contains(&from_axis), "{contact:?}");
    });
    assert!(contacts > 0);
}

/// A grain that gravity presses on the wall, and pushes along it, touches nothing else: the powers of its contacts add up
/// to the ledger's loss by sliding within a percent or two, what is told a step ahead of a grain that bounces. Without friction there is none.
#[test]
fn what_sliding_on_the_wall_takes_is_in_the_ledger() {
    for wall in walls() {
        for (name, model, integrator) in methods().filter(|(_, it, _)| !it.is_general()) {
            let start = DVec3::new(0.0, -0.4, 5.0);
            let bodies = with_wall_spheres(grains(&[(start, DVec3::ZERO)]), &wall);
            let missing = |kernel, time_step| {
                let parameters = Parameters {
                    kernel,
                    body_force: DVec3::new(0.0, -0.01, 0.02),
                    ..parameters_with(model, integrator, time_step)
                };
                let simulation = Simulation::new(bodies.clone(), wall.clone(), parameters);
                missing_of_sliding(simulation)
            };
            for kernel in KERNELS {
                let found = missing(kernel, 0.02);
                assert!(found < 0.02, "{name}, {kernel:?}: {found}");
            }
            let found = missing(KERNELS[0], 0.005);
            assert!(found < 0.015, "{name}: {found}");
        }
    }
}

/// |powers times step - ledger| over the ledger's loss by sliding.
fn missing_of_sliding(mut simulation: Simulation) -> f64 {
    let time_step = simulation.parameters().time_step;
    let mut work = 0.0;
    for _ in 0..(60.0 / time_step) as u64 {
        simulation.for_each_wall_contact(|contact| work += time_step * contact.sliding_power);
        simulation.advance(1).expect("does not diverge");
    }
    let lost = simulation.ledger().sliding_dissipated;
    if simulation.parameters().contact.friction.is_none() {
        assert_eq!((work, lost), (0.0, 0.0));
        return 0.0;
    }
    assert!(lost > 0.01, "{lost}");
    (work - lost).abs() / lost
}
