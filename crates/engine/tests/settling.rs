//! Grains that settle under gravity: they rest, the wall bears their weight, and what they were pressed into stays.

mod common;

use common::*;
use peristalsis_engine::initial::{AT_REST, PackingReport, settle};
use peristalsis_engine::{EngineError, Ledger};

/// Across the tube, and a little along it.
const GRAVITY: DVec3 = DVec3::new(0.0, -0.003, 0.001);

fn heavy(contact: ContactModel, kernel: Kernel) -> Parameters {
    Parameters {
        kernel,
        body_force: GRAVITY,
        ..parameters_with(contact, Integrator::Verlet, 0.05)
    }
}

/// Packed grains, settled in a tube whose bottlenecks hold them.
fn settled(wall: &Wall, parameters: Parameters) -> Simulation {
    let bodies = packed(50, 0.8, wall, parameters.contact.normal, 3);
    let packed = PackingReport::default();
    let (simulation, report) =
        settle(bodies, wall.clone(), parameters, packed, &|| false).expect("they settle");
    assert_eq!(report.largest_overlap, simulation.tally().largest_overlap);
    simulation
}

fn standing() -> Wall {
    strained(coarse(2), -1.0, 1.6, 0.0)
}

#[test]
fn the_wall_bears_the_weight() {
    for (name, model) in laws() {
        for &kernel in kernels_of(&model) {
            let mut simulation = settled(&standing(), heavy(model, kernel));
            assert_eq!(simulation.time(), 0.0);
            assert_eq!(
                *simulation.ledger(),
                Ledger {
                    initial_energy: simulation.energy(),
                    initial_moment: simulation.ledger().initial_moment,
                    ..Ledger::default()
                }
            );
            assert!(
                simulation
                    .bodies()
                    .velocity
                    .iter()
                    .all(|v| *v == DVec3::ZERO)
            );
            let mass: f64 = simulation.bodies().mass.iter().sum();
            let mut borne = DVec3::ZERO;
            simulation.for_each_wall_contact(|contact| {
                borne += contact.normal_force + contact.tangential_force;
            });
            let apart = (borne + mass * GRAVITY).length() / (mass * GRAVITY.length());
            assert!(apart < 0.02, "{name}, {kernel:?}: {apart}");
            // They stay where they are.
            simulation.advance(400).unwrap();
            let bodies = simulation.bodies();
            let energy = bodies.kinetic_energy(0..50) + bodies.rotational_energy();
            let energy = energy / (mass * GRAVITY.length());
            assert!(energy < 10.0 * AT_REST, "{name}, {kernel:?}: {energy}");
            assert!(simulation.energy_residual() < 1e-3);
        }
    }
}

/// Without its springs a pile of frictional grains would give way once more.
#[test]
fn the_springs_of_contacts_stay() {
    let rough = ContactModel::new(HERTZ, Some(FRICTION));
    let simulation = settled(&standing(), heavy(rough, Kernel::Fast));
    let snapshot = simulation.snapshot();
    assert!(snapshot.pair_histories.len() > 5 && snapshot.wall_histories.len() > 20);
    let stored: f64 = snapshot
        .wall_histories
        .iter()
        .map(|it| it.2.displacement.length())
        .sum();
    assert!(stored > 0.0);
}

#[test]
fn grains_settle_the_same_way_whatever_the_wave_does_later() {
    let smooth = heavy(ContactModel::new(LINEAR, None), Kernel::Fast);
    let slow = settled(&standing(), smooth);
    let fast = settled(&strained(coarse(2), -1.0, 1.6, 0.1), smooth);
    assert_eq!(slow.bodies().position, fast.bodies().position);
    assert_eq!(fast.time(), 0.0);
    // The moving wall does work from the first step on.
    assert!(fast.tally().wall_power != 0.0 && slow.tally().wall_power == 0.0);
}

#[test]
fn what_cannot_settle_says_so() {
    let falling = Parameters {
        body_force: DVec3::new(0.0, 0.0, -0.2),
        ..parameters(LINEAR, None, Integrator::Verlet, 0.05)
    };
    let wall = wide(30.0);
    let bodies = || Bodies::grains_at_rest(vec![DVec3::ZERO, 3.0 * DVec3::Z], vec![1.0; 2]);
    let settle = |bodies, wall: &Wall, parameters, stop: &dyn Fn() -> bool| {
        let packed = PackingReport::default();
        settle(bodies, wall.clone(), parameters, packed, stop).map(|_| ())
    };
    let open = settle(bodies(), &wall, falling, &|| false);
    assert!(
        matches!(open, Err(EngineError::NotSettled { .. })),
        "{open:?}"
    );
    let stopped = settle(bodies(), &wall, falling, &|| true);
    assert_eq!(stopped, Err(EngineError::Stopped));
    let weightless = parameters(LINEAR, None, Integrator::Verlet, 0.05);
    let elastic = elastic(elastic_parameters());
    for (wall, parameters) in [(&wall, weightless), (&elastic, falling)] {
        let bodies = with_wall_spheres(bodies(), wall);
        let refused = settle(bodies, wall, parameters, &|| false);
        assert!(
            matches!(refused, Err(EngineError::InvalidParameter { .. })),
            "{refused:?}"
        );
    }
}
