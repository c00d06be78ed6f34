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

/// Residuals with steps of 0.05, 0.025 and 0.0125, for each law, with and without friction, with either integrator.
///
/// Measured, with some hundred contacts that begin and end meanwhile: the residual falls as h^1.9 to h^2.6. What a contact's onset does to the state to order 1 (see `two_grains.rs`) it does to the energies and to
/// their integrals alike.
#[allow(
    clippy::print_stdout,
    reason = "the numbers are for docs/verification.md"
)]
fn closes(wall: &Wall, number: usize, check: impl Fn(&Simulation)) {
    for (name, normal, friction, integrator) in methods() {
        let name = format!("{name}, {integrator:?}");
        let bodies = packed(number, 0.8, wall, normal, 3);
        let found = [0.05, 0.025, 0.0125].map(|time_step| {
            let parameters = parameters(normal, friction, integrator, time_step);
            let (residual, simulation) = residual(&bodies, wall, parameters);
            check(&simulation);
            let ledger = simulation.ledger();
            assert!(ledger.normal_dissipated > 0.0);
            let rough = ledger.tangential_dissipated > 0.0 && ledger.sliding_dissipated > 0.0;
            assert_eq!(rough, friction.is_some(), "{name}: {ledger:?}");
            residual
        });
        let order = 0.5 * libm::log2(found[0] / found[2]);
        println!("{name}: residuals {found:?}, order {order:.2}");
        assert!(found[0] < 1e-2 && found[2] < 5e-4, "{name}: {found:?}");
        assert!(
            (1.7..2.9).contains(&order),
            "{name}: order {order}, {found:?}"
        );
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
