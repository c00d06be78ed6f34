//! What is said of contacts, against the accelerations and the tally of the same instant.

mod common;

use common::*;

#[test]
fn the_forces_of_contacts_add_up_to_the_accelerations_of_the_grains() {
    let strain = strained(coarse(2), -1.0, 2.6, 0.1);
    let stress = elastic(elastic_parameters());
    for (wall, number) in [(&strain, 60), (&stress, 120)] {
        for (name, model) in laws() {
            for &kernel in kernels_of(&model) {
                let bodies = packed(number, 1.0, wall, model.normal, 5);
                let parameters = Parameters {
                    kernel,
                    ..parameters_with(model, INTEGRATORS[0], 0.01)
                };
                let simulation = advanced(&bodies, wall, parameters, 2_000);
                assert_forces(&simulation, &format!("{name} {kernel:?} {number} grains"));
            }
        }
    }
}

#[test]
fn contacts_slide_as_the_tally_says_in_each_form_of_sliding() {
    let wall = strained(coarse(2), -1.0, 2.6, 0.1);
    for normal in [LINEAR, HERTZ] {
        for sliding in [Sliding::Spring, Sliding::Balance, Sliding::Literal] {
            let bodies = packed(60, 1.0, &wall, normal, 5);
            let friction = CundallStrack {
                sliding,
                ..FRICTION
            };
            let parameters = parameters(normal, Some(friction), INTEGRATORS[0], 0.01);
            let simulation = advanced(&bodies, &wall, parameters, 2_000);
            let found = simulation.touching().iter().filter(|it| it.sliding).count() as u64;
            let expected = simulation.tally().sliding_contacts;
            // Whether a contact presses is asked at velocities a little later.
            assert!(
                expected > 10 && found.abs_diff(expected) <= 1,
                "{sliding:?}: {found} slide, not {expected}"
            );
        }
    }
}

fn assert_forces(simulation: &Simulation, case: &str) {
    let (bodies, tally) = (simulation.bodies(), simulation.tally());
    let touching = simulation.touching();
    let of_grains = |wall: bool| {
        let grains = touching.iter().filter(|touch| touch.first < bodies.grains);
        grains
            .filter(|touch| (touch.second >= bodies.grains) == wall)
            .count() as u64
    };
    assert_eq!(of_grains(false), tally.grain_contacts, "{case}");
    assert_eq!(of_grains(true), tally.wall_contacts, "{case}");
    assert!(
        tally.grain_contacts > 10 && tally.wall_contacts > 10,
        "{case}"
    );
    let sliding = touching.iter().filter(|touch| touch.sliding).count() as u64;
    assert!(
        sliding.abs_diff(tally.sliding_contacts) <= 2 + tally.sliding_contacts / 10,
        "{case}: {sliding} slide, not {}",
        tally.sliding_contacts
    );

    let model = simulation.parameters().contact;
    let across_gaps = touching.iter().any(|touch| touch.overlap <= 0.0);
    match model.cohesion {
        None => assert!(!across_gaps, "{case}"),
        Some(cohesion) => assert!(across_gaps || cohesion != PULL, "{case}"),
    }
    let rolls = touching.iter().any(|touch| touch.couple != DVec3::ZERO);
    assert_eq!(rolls, model.rolling.is_some(), "{case}");

    let mut forces = vec![DVec3::ZERO; bodies.grains];
    let (mut largest_overlap, mut expected_by_wall) = (0.0_f64, DVec3::ZERO);
    for touch in &touching {
        let in_plane = touch.force - touch.normal_force * touch.separation.normalize();
        assert!(
            (in_plane.length() - touch.tangential_force).abs() < 1e-12,
            "{case}"
        );
        assert!(touch.first < touch.second);
        if touch.first >= bodies.grains {
            continue;
        }
        largest_overlap = largest_overlap.max(touch.overlap);
        forces[touch.first] += touch.force;
        if touch.second < bodies.grains {
            forces[touch.second] -= touch.force;
        } else {
            expected_by_wall += touch.force;
        }
        let mut prescribed = simulation.wall().prescribed_spheres();
        let position = match bodies.position.get(touch.second) {
            Some(position) => *position,
            None => {
                let sphere = prescribed.nth(touch.second - bodies.grains);
                sphere.expect("a sphere of the wall").position
            }
        };
        let length = simulation.wall().length();
        let mut away = bodies.position[touch.first] - position - touch.separation;
        away.z -= (away.z / length).round() * length;
        assert!(away.length() < 1e-12, "{case}");
    }
    let mut by_wall = DVec3::ZERO;
    simulation.for_each_wall_contact(|contact| {
        by_wall += contact.normal_force + contact.tangential_force;
    });
    assert!((by_wall - expected_by_wall).length() < 1e-12, "{case}");
    assert!(
        (largest_overlap - tally.largest_overlap).abs() < 1e-12,
        "{case}"
    );
    // Forces of the step itself were those of velocities predicted for its end: the same to the order of the step.
    let scale = longest(&forces);
    let most = if model.is_general() { 5e-3 } else { 2e-3 };
    for (grain, force) in forces.iter().enumerate() {
        let expected = bodies.mass[grain] * bodies.acceleration[grain];
        assert!(
            (*force - expected).length() < most * scale,
            "{case}: grain {grain}: {force} instead of {expected}"
        );
    }
}
