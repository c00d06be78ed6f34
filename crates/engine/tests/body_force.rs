//! A body force on the grains: uniform acceleration of free grains, its work in the ledger. Its mirror image: `metamorphic.rs`.

mod common;

use common::*;

/// Along the tube more than across it, so that free grains fall for long.
const BODY_FORCE: DVec3 = DVec3::new(2e-4, -1e-4, -0.004);

/// Laws and integrators such that every kernel has its turn, under the body force.
fn kernels(time_step: f64) -> Vec<Parameters> {
    let methods = methods().filter(|(_, model, _)| model.normal == LINEAR);
    methods
        .flat_map(|(_, model, integrator)| {
            let kernels = kernels_of(&model).iter();
            kernels.map(move |&kernel| Parameters {
                kernel,
                body_force: BODY_FORCE,
                ..parameters_with(model, integrator, time_step)
            })
        })
        .collect()
}

#[test]
fn a_free_grain_falls_as_galilei_says_whatever_its_mass() {
    let velocity = 0.3 * DVec3::Z;
    let start = |x| DVec3::new(x, 0.0, 1.0);
    let state = |x, diameter| (start(x), diameter);
    let free = wide(30.0);
    // Without a drive the elastic wall stays where it is, and is not pushed.
    let springy = elastic(elastic_with(|wall| {
        wall.force_amplitude = Schedule::constant(0.0)
    }));
    for (wall, equal) in [(&free, true), (&free, false), (&springy, true)] {
        for parameters in kernels(0.05) {
            let (places, diameters): (Vec<_>, Vec<_>) =
                [state(-0.7, 1.0), state(0.7, if equal { 1.0 } else { 0.6 })]
                    .into_iter()
                    .unzip();
            let mut bodies = Bodies::grains_at_rest(places, diameters);
            bodies.velocity.fill(velocity);
            let bodies = with_wall_spheres(bodies, wall);
            let mut simulation = Simulation::new(bodies, wall.clone(), parameters);
            // Backward through the seam in the end.
            for steps in [1, 399, 3600] {
                if steps > 1000 && wall.mobile_spheres() > 0 {
                    continue;
                }
                simulation.advance(steps).unwrap();
                let time = simulation.time();
                let length = wall.length();
                for (grain, x) in [-0.7, 0.7].into_iter().enumerate() {
                    let bodies = simulation.bodies();
                    let place = start(x) + velocity * time + 0.5 * BODY_FORCE * time * time;
                    let found = bodies.position[grain].with_z(bodies.unfolded(grain, length));
                    let apart = (found - place).length();
                    assert!(apart < 1e-9, "{parameters:?}: {found}, {place}");
                    let apart = bodies.velocity[grain] - (velocity + BODY_FORCE * time);
                    assert!(apart.length() < 1e-11, "{parameters:?}: {apart}");
                }
                let missing = simulation.energy_residual();
                assert!(missing < 1e-9, "{parameters:?}: {missing}");
                let pushed = &simulation.bodies().velocity[2..];
                assert!(pushed.iter().all(|velocity| velocity.length() < 1e-9));
            }
        }
    }
}

/// m_i g on each grain: what grains do to one another changes nothing of the sum.
#[test]
fn momentum_grows_by_the_weight() {
    let wall = wide(20.0);
    for parameters in kernels(0.05) {
        let mut bodies = packed(40, 0.8, &strained(coarse(2), -1.0, 2.6, 0.1), LINEAR, 5);
        let mut numbers = Numbers(8);
        for velocity in &mut bodies.velocity {
            *velocity = numbers.vector(0.2);
        }
        let mass: f64 = bodies.mass.iter().sum();
        let before = momentum(&bodies);
        let simulation = advanced(&bodies, &wall, parameters, 100);
        assert!(simulation.ledger().largest_overlap > 0.01);
        let gained = momentum(simulation.bodies()) - before;
        let weight = mass * simulation.time() * BODY_FORCE;
        assert!(
            (gained - weight).length() < 1e-11,
            "{parameters:?}: {gained}"
        );
    }
}

/// The same walls and grains as without it (`ledger.rs`), to the same order.
#[test]
fn the_ledger_closes_and_holds_its_work() {
    let walls = [
        strained(coarse(2), -1.0, 2.6, 0.1),
        elastic(elastic_parameters()),
    ];
    for wall in &walls {
        for (normal, friction) in [(LINEAR, None), (HERTZ, Some(FRICTION))] {
            let bodies = packed(60, 0.8, wall, normal, 3);
            for integrator in INTEGRATORS {
                let found = [0.05, 0.0125].map(|time_step| {
                    let parameters = Parameters {
                        body_force: BODY_FORCE,
                        ..parameters(normal, friction, integrator, time_step)
                    };
                    let steps = (20.0 / time_step) as u64;
                    let simulation = advanced(&bodies, wall, parameters, steps);
                    let ledger = simulation.ledger();
                    // What would be missing without it.
                    assert!(
                        ledger.body_work.abs() > 0.01 * ledger.gross_work,
                        "{ledger:?}"
                    );
                    ledger.residual(simulation.energy()).abs() / ledger.gross_work
                });
                assert!(
                    found[0] < 5e-3 && found[1] < 5e-4,
                    "{normal:?}, {integrator:?}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn its_work_is_the_same_in_one_advance_and_in_many() {
    let wall = strained(coarse(2), -1.0, 2.6, 0.1);
    for parameters in kernels(0.05) {
        let bodies = packed(60, 1.0, &wall, LINEAR, 3);
        let mut whole = Simulation::new(bodies, wall.clone(), parameters);
        let mut parts = whole.clone();
        whole.advance(60).unwrap();
        for _ in 0..6 {
            parts.advance(10).unwrap();
            parts = Simulation::restore(parts.snapshot(), wall.clone(), parameters).unwrap();
        }
        assert_eq!(bits(&whole), bits(&parts), "{parameters:?}");
        assert_eq!(whole.ledger(), parts.ledger(), "{parameters:?}");
    }
}

/// Grains at rest that touch nothing, in the order of the kernel that sorts, which has room where no grain stands.
#[test]
fn nothing_but_grains_is_pushed() {
    let states: Vec<_> = (0..5)
        .map(|i| (DVec3::new(0.0, 0.0, 3.0 * f64::from(i)), DVec3::ZERO))
        .collect();
    let parameters = Parameters {
        body_force: DVec3::new(0.01, 0.02, 0.5),
        ..parameters(LINEAR, None, Integrator::Verlet, 0.05)
    };
    let mut simulation = Simulation::new(grains(&states), wide(30.0), parameters);
    assert!(simulation.snapshot().sorting.is_some());
    // By then a thing so pushed from the start would move by more than half a diameter a step.
    simulation.advance(360).unwrap();
    assert!(
        simulation
            .bodies()
            .velocity
            .iter()
            .all(|v| (*v - DVec3::new(0.18, 0.36, 9.0)).length() < 1e-9)
    );
}
