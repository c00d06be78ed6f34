//! The energy ledger closes to the order of the integrator.

mod common;

use common::*;

const DURATION: f64 = 20.0;

/// Largest residual of ten samples over the gross work, and the simulation at its end.
fn residual(bodies: &Bodies, wall: &Wall, parameters: Parameters) -> (f64, Simulation) {
    let mut simulation = Simulation::new(bodies.clone(), wall.clone(), parameters);
    let mut largest = 0.0_f64;
    for _ in 0..10 {
        let steps = (0.1 * DURATION / parameters.time_step).round() as u64;
        simulation.advance(steps).expect("does not diverge");
        largest = largest.max(simulation.ledger().residual(simulation.energy()).abs());
    }
    (largest / simulation.ledger().gross_work, simulation)
}

/// Residuals with steps of 0.05, 0.025 and 0.0125, for each law.
///
/// Measured, with some hundred contacts that begin and end meanwhile: the residual falls as h^1.9 to h^2.6. What a contact's
/// onset does to the state to order 1 (see `two_grains.rs`) it does to the energies and to their integrals alike. Under JKR,
/// whose contacts break with a jump of energy, the residual falls as h^0.8 to h^3.
#[allow(
    clippy::print_stdout,
    reason = "the numbers are for docs/verification.md"
)]
fn closes(wall: &Wall, number: usize, check: impl Fn(&Simulation)) {
    for (name, model, integrator) in methods() {
        let name = format!("{name}, {integrator:?}");
        let bodies = packed(number, 0.8, wall, model.normal, 3);
        let found = [0.05, 0.025, 0.0125].map(|time_step| {
            let parameters = parameters_with(model, integrator, time_step);
            let (residual, simulation) = residual(&bodies, wall, parameters);
            check(&simulation);
            let ledger = simulation.ledger();
            assert!(ledger.normal_dissipated > 0.0);
            let rough = ledger.tangential_dissipated > 0.0 && ledger.sliding_dissipated > 0.0;
            assert_eq!(rough, model.friction.is_some(), "{name}: {ledger:?}");
            assert_eq!(ledger.rolling_dissipated > 0.0, model.rolling.is_some());
            assert_eq!(ledger.cohesion_dissipated > 0.0, breaks(&model), "{name}");
            residual
        });
        let order = 0.5 * libm::log2(found[0] / found[2]);
        println!("{name}: residuals {found:?}, order {order:.2}");
        assert!(found[0] < 1e-2 && found[2] < 5e-4, "{name}: {found:?}");
        // Each break is somewhere within a step: an error of order 1 of either sign.
        let orders = match breaks(&model) {
            true => 0.7..3.5,
            false => 1.7..2.9,
        };
        assert!(orders.contains(&order), "{name}: order {order}, {found:?}");
    }
}

#[test]
fn under_strain_control() {
    closes(&strained(coarse(2), -1.0, 2.6, 0.1), 60, |simulation| {
        assert!(simulation.ledger().wall_work != 0.0);
    });
}

#[test]
fn under_a_smooth_wall() {
    let wall = smooth(strained(coarse(2), -1.0, 2.6, 0.1));
    closes(&wall, 60, |simulation| {
        assert!(simulation.ledger().wall_work != 0.0);
    });
}

/// Springs with dashpots, drag, every part of what keeps the wall, the drive, grains: all at once.
#[test]
fn under_stress_control_with_everything_on() {
    for net_force in [NetForce::Removed, NetForce::RemovedPerRing] {
        let wall = elastic_with(|wall| {
            wall.network.spring_damping = 0.01;
            wall.network.drag = 0.005;
            wall.network.tethers.radial = 0.002;
            wall.network.tethers.net_force = net_force;
        });
        closes(&elastic(wall), 120, |simulation| {
            let ledger = simulation.ledger();
            assert!(ledger.drive_work != 0.0);
            assert!(ledger.drag_dissipated > 0.0 && ledger.network_dissipated > 0.0);
        });
    }
}

/// Two grains that collide without friction in a tube that does nothing: what is lost is in the ledger, term by term.
#[test]
fn the_terms_of_a_single_impact() {
    let law = linear(1.0, 0.1);
    let bodies = grains(&[
        (DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, 0.1)),
        (DVec3::new(0.0, 0.0, 6.01), DVec3::ZERO),
    ]);
    let parameters = parameters(Normal::Linear(law), None, INTEGRATORS[0], 1e-3);
    let mut simulation = Simulation::new(bodies, wide(20.0), parameters);
    simulation.advance(5_000).unwrap();
    let e = law.restitution(0.5);
    // m_ij v^2 (1 - e^2)/2 with m_ij = 1/2
    let expected = 0.25 * 0.01 * (1.0 - e * e);
    let ledger = simulation.ledger();
    assert!(
        (ledger.normal_dissipated - expected).abs() < 1e-6,
        "{} {expected}",
        ledger.normal_dissipated
    );
    assert_eq!(ledger.input(), 0.0);
    assert!((ledger.initial_energy - 0.005).abs() < 1e-17);
    assert_eq!(ledger.dissipated(), ledger.normal_dissipated);
    // Nothing entered: the residual is in units of the initial energy.
    assert!(simulation.energy_residual() < 1e-5);
}

/// What contacts lose where a wall that jumps outwards breaks them, the jump has done work for. The forces of the step
/// change by the jump, which leaves an error of order 1 in the step open.
#[test]
fn the_ledger_closes_over_a_jump_that_breaks_contacts() {
    let time_step = 5e-4;
    let jump = 10.0 + 0.5 * time_step;
    for (name, model) in laws() {
        let amplitude = Schedule::through(vec![(0.0, 0.3), (jump, 0.3), (jump, 0.26)]).unwrap();
        let frequency = Schedule::constant(0.1);
        let wall = waving(coarse(2), 1.5, Waveform::Sine, -1.0, amplitude, frequency);
        let bodies = packed(60, 0.8, &wall, model.normal, 3);
        let parameters = parameters_with(model, INTEGRATORS[0], time_step);
        let mut simulation = Simulation::new(bodies, wall, parameters);
        let mut told = |steps| {
            simulation.advance(steps).unwrap();
            let ledger = simulation.ledger();
            let residual = ledger.residual(simulation.energy());
            (residual, ledger.cohesion_dissipated, ledger.wall_work)
        };
        let (before, after) = (told(20_000), told(1));
        let residual = (after.0 - before.0).abs();
        assert!((after.2 - before.2).abs() > 1e-3, "no jump: {after:?}");
        assert!(residual < 1e-5, "{name}: {residual}");
        if breaks(&model) {
            let broken = after.1 - before.1;
            assert!(broken > 3.0 * residual, "{name}: {residual} {broken}");
        }
    }
}
