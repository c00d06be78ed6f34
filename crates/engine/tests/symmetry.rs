//! Independence of the skin of the neighbour search. Images of a system: `metamorphic.rs`.

mod common;

use common::*;

/// A kernel whose sums do not depend on when neighbours were last searched: all but the one that keeps frictionless grains in
/// the order of z.
fn skinless(friction: Option<CundallStrack>) -> Kernel {
    match friction {
        None => Kernel::Reference,
        Some(_) => Kernel::Fast,
    }
}

/// The skin decides how often the list is made, and nothing else.
#[test]
fn the_skin_changes_no_bit() {
    let tubes = [
        (strained(coarse(2), -1.0, 2.6, 0.1), 54),
        (elastic(elastic_parameters()), 120),
    ];
    for (wall, number) in &tubes {
        for (name, model) in laws() {
            let bodies = packed(*number, 0.8, wall, model.normal, 9);
            let with = |skin: f64| {
                let parameters = Parameters {
                    skin,
                    kernel: skinless(model.friction),
                    ..parameters_with(model, Integrator::Verlet, 0.05)
                };
                advanced(&bodies, wall, parameters, 800).snapshot()
            };
            let usual = with(0.3);
            assert_eq!(with(0.02), usual, "{name}");
            assert_eq!(with(1.0), usual, "{name}");
        }
    }
}

/// The same for a tube of one wave, for few grains or none, for a wide tube, and with grains that have escaped.
#[test]
fn the_skin_changes_no_bit_in_odd_tubes() {
    let escaped = |mut bodies: Bodies| {
        bodies.position[0] = DVec3::new(40.0, -3.0, 4.0);
        bodies.position[1] = DVec3::new(40.7, -3.2, 4.1);
        bodies.position[2] = DVec3::new(-700.0, 900.0, 0.01);
        bodies.position[3] = DVec3::new(-700.1, 900.3, 9.8);
        bodies
    };
    let one_wave = strained(coarse(1), -1.0, 2.6, 0.1);
    let wide_tube = wide(10.0);
    let many = packed(300, 0.7, &wide_tube, LINEAR, 2);
    let mut moving = many.clone();
    let mut numbers = Numbers(5);
    moving
        .velocity
        .iter_mut()
        .for_each(|velocity| *velocity = numbers.vector(0.5));
    let full = packed(25, 0.8, &one_wave, LINEAR, 4);
    for (name, wall, bodies) in [
        ("no grain", &one_wave, packed(0, 1.0, &one_wave, LINEAR, 4)),
        ("one grain", &one_wave, packed(1, 1.0, &one_wave, LINEAR, 4)),
        (
            "two grains",
            &one_wave,
            packed(2, 1.0, &one_wave, LINEAR, 4),
        ),
        ("one wave", &one_wave, full.clone()),
        ("escaped grains", &one_wave, escaped(full)),
        ("wide tube", &wide_tube, moving),
    ] {
        for friction in [None, Some(FRICTION)] {
            let with = |skin: f64| {
                let parameters = Parameters {
                    skin,
                    kernel: skinless(friction),
                    ..parameters(LINEAR, friction, Integrator::Verlet, 0.05)
                };
                advanced(&bodies, wall, parameters, 300).snapshot()
            };
            let usual = with(0.3);
            assert_eq!(with(0.05), usual, "{name}");
            assert_eq!(with(1.0), usual, "{name}");
            if name == "escaped grains" {
                // The two pairs outside have pushed each other apart, one of them across the seam.
                assert!(
                    usual.bodies.velocity[..4]
                        .iter()
                        .all(|velocity| velocity.length() > 0.05)
                );
            }
        }
    }
}

/// A contact that parts by more than the skin in a single step still accounts for the spring energy that it forgets.
#[test]
fn the_skin_changes_no_bit_of_the_ledger_of_a_fast_parting() {
    let with = |skin: f64| {
        let mut bodies = grains(&[
            (DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.3, 0.0, -2.0)),
            (DVec3::new(0.0, 0.0, 5.7), DVec3::new(0.0, 0.0, 2.0)),
        ]);
        bodies.angular_velocity[0] = DVec3::X;
        let parameters = Parameters {
            skin,
            kernel: Kernel::Fast,
            ..parameters(LINEAR, Some(FRICTION), Integrator::Verlet, 0.05)
        };
        advanced(&bodies, &wide(20.0), parameters, 10).snapshot()
    };
    let usual = with(0.3);
    assert!(usual.ledger.history_reset > 1e-4);
    assert_eq!(with(0.05), usual);
    assert_eq!(with(1.0), usual);
}
