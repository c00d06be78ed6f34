//! A wall of segments: its spheres move at the rate at which their places change, and grains go with the order.

mod common;

use common::*;

fn driven(heading: f64, order: Vec<u32>) -> Wall {
    let drive = SegmentDrive {
        order,
        ..SegmentDrive::default()
    };
    let segments = Contraction::Segments(Segments::new(&drive).expect("a cycle"));
    let (amplitude, frequency) = (Schedule::constant(0.4), Schedule::constant(0.1));
    waving(
        lattice(24, 26, 2, 10.0),
        1.5,
        segments,
        heading,
        amplitude,
        frequency,
    )
}

#[test]
fn wall_spheres_have_the_velocity_of_their_places() {
    let (step, mut most) = (1e-4, 0.0_f64);
    for heading in [-1.0, 1.0] {
        let parameters = parameters(LINEAR, None, Integrator::Verlet, step);
        let bodies = grains(&[(DVec3::ZERO, DVec3::ZERO)]);
        let mut simulation = Simulation::new(bodies, driven(heading, Vec::new()), parameters);
        for _ in 0..40 {
            let look = |simulation: &Simulation| -> Vec<_> {
                let spheres = simulation.wall().prescribed_spheres();
                spheres
                    .map(|sphere| (sphere.position, sphere.velocity))
                    .collect()
            };
            let before = look(&simulation);
            simulation.advance(1).unwrap();
            let now = look(&simulation);
            simulation.advance(1).unwrap();
            for ((before, now), after) in before.iter().zip(&now).zip(look(&simulation)) {
                let rate = (after.0 - before.0) / (2.0 * step);
                assert!((rate - now.1).length() < 1e-4, "{rate} {}", now.1);
                most = most.max(rate.length());
            }
            simulation.advance(2500).unwrap();
        }
    }
    // 1.5/0.2 of 0.4 within a period of 10.
    assert!((most / 0.3 - 1.0).abs() < 0.05, "{most}");
}

/// Mean velocity of the grains towards +z in the second period.
fn flow(heading: f64, order: Vec<u32>) -> f64 {
    let wall = driven(heading, order);
    let parameters = parameters(LINEAR, None, Integrator::Verlet, 0.05);
    let mut simulation = Simulation::new(packed(60, 0.9, &wall, LINEAR, 2), wall, parameters);
    simulation.advance(200).expect("does not diverge");
    let place = |simulation: &Simulation| -> f64 {
        let bodies = simulation.bodies();
        (0..bodies.grains)
            .map(|grain| bodies.unfolded(grain, 20.0))
            .sum()
    };
    let before = place(&simulation);
    simulation.advance(200).expect("does not diverge");
    (place(&simulation) - before) / (60.0 * 10.0)
}

#[test]
fn grains_go_with_the_order_of_the_segments() {
    for heading in [-1.0, 1.0] {
        let along = heading * flow(heading, Vec::new());
        let against = heading * flow(heading, vec![4, 3, 2, 1]);
        assert!(
            along > 0.05 && against < -0.05,
            "{heading}: {along} {against}"
        );
    }
}
