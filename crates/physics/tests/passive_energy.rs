//! A passive contact, at any angle, spin and friction: what becomes of the energy.

mod common;

use common::{Collision, LINEAR, SLIDINGS, friction, hertz, normals, table};
use glam::DVec3;
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, DissipationForm, Normal, RollingResistance, Sliding,
};
use proptest::prelude::*;

const TIME_STEP: f64 = 2e-3;

/// Kinetic energy after a collision over that before, less 1.
fn gain(mut spheres: Collision) -> f64 {
    let before = spheres.kinetic_energy();
    spheres.run(TIME_STEP);
    spheres.kinetic_energy() / before - 1.0
}

/// Largest gain of grains without spin over angles of impact in whole degrees and three speeds.
fn largest_gain(model: ContactModel) -> (f64, i32, f64) {
    let mut worst = (f64::NEG_INFINITY, 0, 0.0);
    for degrees in 0..90 {
        for speed in [0.03, 0.1, 0.3] {
            let found = gain(Collision::oblique(
                model,
                speed,
                f64::from(degrees).to_radians(),
            ));
            if found > worst.0 {
                worst = (found, degrees, speed);
            }
        }
    }
    worst
}

fn spin() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn any_friction() -> impl Strategy<Value = CundallStrack> {
    (0.0..1.0, 0.0..1.0, 0.05..3.0, 0.0..0.3).prop_map(
        |(static_friction, part, stiffness, damping)| CundallStrack {
            tangential_stiffness: stiffness,
            tangential_damping: damping,
            static_friction,
            kinetic_friction: part * static_friction,
            sliding: Sliding::default(),
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// The default form of sliding: kinetic energy is never gained, whatever the parameters.
    #[test]
    fn a_passive_collision_never_gains_energy(
        law in any_friction(), angle in 0.0..1.57, speed in 0.01..0.2, spins in (spin(), spin()), ratio in 0.3..3.0,
    ) {
        for (name, normal) in normals() {
            for friction in [law, friction(Sliding::default())] {
                let mut spheres = Collision::oblique(ContactModel::new(normal, Some(friction)), speed, angle);
                spheres.mass[1] = ratio;
                spheres.angular_velocity = [4.0 * speed * spins.0, 4.0 * speed * spins.1];
                let found = gain(spheres);
                prop_assert!(found < 1e-9, "{}: gains {}", name, found);
            }
        }
    }

    /// Nor is kinetic plus spring energy at any instant of the collision, up to the integrator's error; and with the
    /// default form the losses in the plane of contact only grow.
    #[test]
    fn energy_falls_all_the_time(
        law in any_friction(), angle in 0.0..1.57, speed in 0.01..0.2, spins in (spin(), spin()),
    ) {
        for (name, normal) in normals() {
            let mut spheres = Collision::oblique(ContactModel::new(normal, Some(law)), speed, angle);
            spheres.angular_velocity = [4.0 * speed * spins.0, 4.0 * speed * spins.1];
            let start = spheres.kinetic_energy();
            let tolerance = 2e-5 * start;
            spheres.evaluate(0.0);
            let (mut least, mut most_lost) = (start, 0.0_f64);
            for _ in 0..4_000 {
                spheres.step(TIME_STEP);
                let energy = spheres.kinetic_energy() + spheres.last.energy;
                prop_assert!(energy <= least + tolerance, "{}: {} above {} of {}", name, energy - least, least, start);
                prop_assert!(spheres.lost[1] >= most_lost - tolerance, "{}: {} {}", name, spheres.lost[1], most_lost);
                least = least.min(energy);
                most_lost = most_lost.max(spheres.lost[1]);
            }
        }
    }
}

/// The gain of the `literal` form: 2.7 % at 49 degrees without a tangential dashpot, still 0.56 % with the preset's
/// friction and printed damping; `spring` and `balance` lose in the same collisions.
#[test]
fn the_literal_form_gains_energy() {
    let without_dashpot = |sliding| CundallStrack {
        tangential_damping: 0.0,
        kinetic_friction: 0.5,
        ..friction(sliding)
    };
    let printed = Normal::Hertz(hertz(DissipationForm::Printed));
    for (law, range) in [
        (
            without_dashpot as fn(Sliding) -> CundallStrack,
            0.025..0.028,
        ),
        (friction, 0.005..0.006),
    ] {
        for sliding in SLIDINGS {
            let (found, degrees, speed) =
                largest_gain(ContactModel::new(printed, Some(law(sliding))));
            println!("{sliding:?}: largest gain {found:.5} at {degrees} degrees, v = {speed}");
            if sliding == Sliding::Literal {
                assert!(
                    range.contains(&found),
                    "{found} at {degrees} degrees, v = {speed}"
                );
            } else {
                assert!(
                    found < 0.0,
                    "{sliding:?}: {found} at {degrees} degrees, v = {speed}"
                );
            }
        }
    }
    let linear = largest_gain(ContactModel::new(
        Normal::Linear(LINEAR),
        Some(without_dashpot(Sliding::Literal)),
    ));
    println!("linear, Literal: {linear:?}");
    assert!((0.019..0.023).contains(&linear.0));
}

/// The `balance` form can gain too, where the dashpot is strong beside the spring: cutting the force below what the
/// dashpot gives turns into a stretch of the spring. `spring` loses in the same collision.
#[test]
fn the_balance_form_can_gain_energy() {
    let found = [Sliding::Balance, Sliding::Spring].map(|sliding| {
        let law = CundallStrack {
            tangential_stiffness: 0.06,
            tangential_damping: 0.29,
            static_friction: 0.184,
            kinetic_friction: 0.132,
            sliding,
        };
        let normal = Normal::Hertz(hertz(DissipationForm::Viscoelastic));
        let mut spheres = Collision::oblique(
            ContactModel::new(normal, Some(law)),
            0.15,
            30.7_f64.to_radians(),
        );
        spheres.angular_velocity = [
            DVec3::new(-0.574, 0.357, -0.373),
            DVec3::new(-0.032, 0.271, 0.0085),
        ];
        gain(spheres)
    });
    println!("gain of balance {}, of spring {}", found[0], found[1]);
    // Measured: 6.5e-4 of the energy.
    assert!(found[0] > 5e-4 && found[0] < 8e-4, "{}", found[0]);
    assert!(found[1] < 0.0, "{}", found[1]);
}

/// Largest |kinetic + spring energy + losses - energy at the start| in a time of 1 in which the contact persists.
fn residual(model: ContactModel, time_step: f64) -> f64 {
    let mut spheres = Collision::oblique(model, 0.25, 0.7);
    spheres.position[0] *= 0.8;
    spheres.angular_velocity = [DVec3::new(0.3, -0.2, 0.4), DVec3::new(-0.1, 0.2, 0.1)];
    spheres.evaluate(0.0);
    let start = spheres.kinetic_energy() + spheres.last.energy;
    let slides = spheres.last.tangential.sliding;
    let mut largest = 0.0_f64;
    for _ in 0..(1.0 / time_step).round() as u32 {
        spheres.step(time_step);
        let energy = spheres.kinetic_energy() + spheres.last.energy;
        largest = largest.max((energy + spheres.lost[0] + spheres.lost[1] - start).abs());
        assert!(spheres.overlap() > 0.0, "the contact must persist");
        assert_eq!(
            spheres.last.tangential.sliding, slides,
            "no change between stick and slip"
        );
    }
    largest
}

/// While a contact persists, sticking or sliding, the ledger closes to order 2.
#[test]
fn the_ledger_of_a_contact_closes_to_order_two() {
    for (name, model) in table() {
        // Friction that never slips, and friction that slips from the start.
        for (state, coefficient) in [("stick", 20.0), ("slip", 0.02)] {
            let friction = model.friction.map(|law| CundallStrack {
                static_friction: coefficient,
                kinetic_friction: coefficient,
                ..law
            });
            let rolling = model.rolling.map(|law| RollingResistance {
                rolling_friction: coefficient,
                ..law
            });
            let model = ContactModel {
                friction,
                rolling,
                ..model
            };
            let found = [0.02, 0.01, 0.005].map(|time_step| residual(model, time_step));
            let order = libm::log2(found[1] / found[2]);
            println!("{name}, {state}: residuals {found:?}, order {order:.3}");
            assert!(
                (order - 2.0).abs() < 0.2,
                "{name}, {state}: order {order}, {found:?}"
            );
        }
    }
}

/// Friction exchanges spin and orbital angular momentum and loses none: the levers add up to the distance.
#[test]
fn angular_momentum_is_kept_to_rounding() {
    for (name, model) in table() {
        let mut spheres = Collision::oblique(model, 0.2, 0.6);
        spheres.diameter = [1.0, 0.8];
        spheres.mass = [1.0, 0.512];
        spheres.angular_velocity = [DVec3::new(0.3, -0.2, 0.4), DVec3::new(-0.1, 0.5, 0.1)];
        let angular_momentum = |spheres: &Collision| -> DVec3 {
            (0..2)
                .map(|i| {
                    let inertia =
                        spheres.mass[i] * spheres.diameter[i] * spheres.diameter[i] / 10.0;
                    spheres.position[i].cross(spheres.mass[i] * spheres.velocity[i])
                        + inertia * spheres.angular_velocity[i]
                })
                .sum()
        };
        let (before, spin) = (angular_momentum(&spheres), spheres.angular_velocity[0]);
        spheres.run(0.01);
        let change = (angular_momentum(&spheres) - before).length();
        assert!(change < 1e-14, "{name}: {change}");
        assert_eq!(
            spheres.angular_velocity[0] == spin,
            model.friction.is_none(),
            "{name}"
        );
    }
}
