//! The contract that every contact law of the table keeps, over random contacts.

mod common;

use common::{Collision, answer, table};
use glam::{DQuat, DVec3};
use peristalsis_physics::contact::{
    Cohesion, Contact, ContactModel, CundallStrack, GeneralHistory, Normal, NormalForce, NormalLaw,
    TangentialHistory, TangentialLaw, reduced_radius,
};
use proptest::prelude::*;

/// A contact with a past: the history lies in the plane of contact.
#[derive(Clone, Debug)]
struct Case {
    contact: Contact,
    history: GeneralHistory,
    time_step: f64,
}

fn unit() -> impl Strategy<Value = DVec3> {
    vector(1.0)
        .prop_filter("too short to give a direction", |v| v.length() > 0.1)
        .prop_map(DVec3::normalize)
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    let side = -size..size;
    (side.clone(), side.clone(), side).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn case() -> impl Strategy<Value = Case> {
    (
        (1e-3..0.3, 0.8..1.0, 0.8..1.0, unit()),
        (vector(0.5), vector(0.5)),
        (vector(0.2), vector(0.3), 0.0..0.1, 0.0..0.1),
    )
        .prop_map(
            |(
                (overlap, one, other, normal),
                (relative_velocity, rotation),
                (u, rate, power, time_step),
            )| {
                let lateral = |v: DVec3| v - v.dot(normal) * normal;
                Case {
                    contact: Contact {
                        overlap,
                        distance: 0.5 * (one + other) - overlap,
                        normal,
                        relative_velocity,
                        reduced_radius: reduced_radius(one, other),
                        rotation,
                        spin: DVec3::new(rotation.y, rotation.z, rotation.x) + relative_velocity,
                    },
                    history: GeneralHistory {
                        friction: TangentialHistory {
                            displacement: lateral(u),
                            rate: lateral(rate),
                            power,
                            // As good as any coin for both branches to be seen.
                            sliding: power > 0.0,
                        },
                        rolling: TangentialHistory {
                            displacement: lateral(0.2 * rate),
                            ..TangentialHistory::default()
                        },
                        bond: 0.0,
                    },
                    time_step,
                }
            },
        )
}

fn ask(
    model: &ContactModel,
    case: &Case,
) -> (peristalsis_physics::contact::ContactForce, GeneralHistory) {
    let mut history = case.history;
    (
        answer(model, &case.contact, &mut history, case.time_step),
        history,
    )
}

fn normal_force(normal: Normal, contact: &Contact, velocity: f64) -> NormalForce {
    normal.force(contact.overlap, velocity, contact.reduced_radius)
}

fn undamped(model: &ContactModel) -> ContactModel {
    ContactModel {
        normal: model.normal.undamped(),
        friction: model.friction.map(|law| CundallStrack {
            tangential_damping: 0.0,
            ..law
        }),
        ..*model
    }
}

/// The force that bounds friction, for a normal force f_n.
fn pressing(model: &ContactModel, contact: &Contact, force: f64) -> f64 {
    let pull_off = |law: Cohesion| law.pull_off(contact.reduced_radius);
    let added = match model.cohesion {
        None => 0.0,
        Some(law) if law.is_jkr() => 2.0 * pull_off(law),
        Some(law) => pull_off(law),
    };
    (force + added).max(0.0)
}

fn turned(turn: DQuat, history: TangentialHistory) -> TangentialHistory {
    TangentialHistory {
        displacement: turn * history.displacement,
        rate: turn * history.rate,
        ..history
    }
}

fn close(one: DVec3, other: DVec3, tolerance: f64) -> bool {
    (one - other).length() <= tolerance
}

fn with_overlap(contact: &Contact, overlap: f64) -> Contact {
    Contact {
        overlap,
        ..*contact
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_fresh_contact_at_rest_begins_without_force(case in case()) {
        for (name, model) in table() {
            if model.cohesion.is_some() {
                continue;
            }
            let mut forces = [1e-4, 1e-6, 1e-8].map(|overlap| {
                let mut contact = with_overlap(&case.contact, overlap);
                contact.relative_velocity = DVec3::ZERO;
                contact.rotation = DVec3::ZERO;
                contact.spin = DVec3::ZERO;
                let answer = answer(&model, &contact, &mut GeneralHistory::default(), case.time_step);
                prop_assert!(answer.force.dot(contact.normal) > 0.0, "{}: not repelled", name);
                prop_assert!(answer.energy > 0.0 && answer.energy <= overlap * overlap);
                Ok(answer.force.length() / overlap)
            }).into_iter().collect::<Result<Vec<f64>, _>>()?;
            // Proportional to the overlap, or vanishing faster.
            forces.dedup_by(|later, earlier| *later <= *earlier * (1.0 + 1e-9));
            prop_assert_eq!(forces.len(), 1, "{}", name);
        }
    }

    #[test]
    fn the_partner_feels_the_opposite(case in case()) {
        for (name, model) in table() {
            let (here, history_here) = ask(&model, &case);
            let swapped = Case {
                contact: Contact {
                    normal: -case.contact.normal,
                    relative_velocity: -case.contact.relative_velocity,
                    spin: -case.contact.spin,
                    ..case.contact
                },
                history: GeneralHistory {
                    friction: TangentialHistory {
                        displacement: -case.history.friction.displacement,
                        rate: -case.history.friction.rate,
                        ..case.history.friction
                    },
                    ..case.history
                },
                ..case
            };
            let (there, history_there) = ask(&model, &swapped);
            prop_assert_eq!(here.force, -there.force, "{}", name);
            prop_assert_eq!(here.torque_per_arm, there.torque_per_arm, "{}", name);
            prop_assert_eq!(here.energy, there.energy);
            prop_assert_eq!(here.rolling.couple, -there.rolling.couple, "{}", name);
            prop_assert_eq!(history_here.friction.displacement, -history_there.friction.displacement);
            prop_assert_eq!(history_here.rolling.displacement, history_there.rolling.displacement);
        }
    }

    #[test]
    fn friction_stays_in_the_plane_and_below_the_coulomb_bound(case in case()) {
        for (name, model) in table() {
            let (found, _) = ask(&model, &case);
            let normal = case.contact.normal;
            let lateral = found.tangential.force;
            let pressed = pressing(&model, &case.contact, found.force.dot(normal));
            let couple = found.rolling.couple;
            prop_assert!(couple.dot(normal).abs() <= 1e-14, "{}", name);
            match model.rolling {
                None => prop_assert_eq!(couple, DVec3::ZERO),
                Some(law) => prop_assert!(
                    couple.length()
                        <= law.rolling_friction * pressed * case.contact.reduced_radius * (1.0 + 1e-9),
                    "{}", name,
                ),
            }
            match model.friction {
                None => prop_assert!(close(found.force, found.force.dot(normal) * normal, 1e-14), "{}", name),
                Some(law) => {
                    prop_assert!(lateral.dot(normal).abs() <= 1e-14, "{}", name);
                    let bound = if found.tangential.sliding { law.kinetic_friction } else { law.static_friction };
                    prop_assert!(lateral.length() <= bound * pressed * (1.0 + 1e-12), "{}", name);
                    if found.tangential.sliding {
                        prop_assert!((lateral.length() - bound * pressed).abs() <= 1e-12, "{}", name);
                    }
                    prop_assert!(close(found.torque_per_arm, -normal.cross(lateral), 1e-15));
                }
            }
        }
    }

    #[test]
    fn turning_the_pair_turns_the_answer(case in case(), axis in unit(), angle in 0.0..6.0) {
        let turn = DQuat::from_axis_angle(axis, angle);
        for (name, model) in table() {
            let (plain, history_plain) = ask(&model, &case);
            let turned = Case {
                contact: Contact {
                    normal: turn * case.contact.normal,
                    relative_velocity: turn * case.contact.relative_velocity,
                    rotation: turn * case.contact.rotation,
                    spin: turn * case.contact.spin,
                    ..case.contact
                },
                history: GeneralHistory {
                    friction: turned(turn, case.history.friction),
                    rolling: turned(turn, case.history.rolling),
                    ..case.history
                },
                ..case
            };
            let (found, history_found) = ask(&model, &turned);
            prop_assert!(close(found.force, turn * plain.force, 1e-13), "{}", name);
            prop_assert!(close(found.torque_per_arm, turn * plain.torque_per_arm, 1e-13), "{}", name);
            prop_assert!((found.energy - plain.energy).abs() < 1e-13);
            prop_assert!(close(found.rolling.couple, turn * plain.rolling.couple, 1e-13), "{}", name);
            let displacement = |history: GeneralHistory| history.friction.displacement;
            prop_assert!(close(displacement(history_found), turn * displacement(history_plain), 1e-13));
        }
    }

    /// Of two grains seen from a moving frame the law sees the same contact.
    #[test]
    fn a_moving_observer_sees_the_same_force(
        place in vector(3.0), boost in vector(2.0), velocity in vector(0.3), omega in vector(0.5), angle in 0.1..1.4,
    ) {
        for (name, model) in table() {
            let mut plain = Collision::oblique(model, 0.2, angle);
            plain.position[0] *= 0.95;
            plain.velocity[1] = velocity;
            plain.angular_velocity[0] = omega;
            let mut boosted = plain.clone();
            for i in 0..2 {
                boosted.position[i] += place;
                boosted.velocity[i] += boost;
            }
            plain.evaluate(0.0);
            boosted.evaluate(0.0);
            for _ in 0..20 {
                plain.step(0.02);
                boosted.step(0.02);
            }
            prop_assert!(close(plain.last.force, boosted.last.force, 1e-12), "{}", name);
            prop_assert!(close(plain.velocity[0] + boost, boosted.velocity[0], 1e-12), "{}", name);
        }
    }

    /// A pair that turns like a rigid body has no slip: the levers of the two spheres add up to their distance.
    #[test]
    fn a_pair_that_turns_as_one_has_no_friction(case in case(), rotation in vector(0.5)) {
        let normal = case.contact.normal;
        for (name, model) in table() {
            let contact = Contact {
                relative_velocity: rotation.cross(case.contact.distance * normal),
                rotation: case.contact.distance * rotation,
                spin: DVec3::ZERO,
                ..case.contact
            };
            let found = answer(&model, &contact, &mut GeneralHistory::default(), case.time_step);
            prop_assert!(found.tangential.force.length() < 1e-15, "{}", name);
            prop_assert_eq!(found.rolling.couple, DVec3::ZERO, "{}", name);
        }
    }

    #[test]
    fn without_damping_the_normal_force_is_the_slope_of_the_energy(case in case()) {
        for (name, model) in table() {
            let model = undamped(&model);
            let step = 1e-6;
            let at = |overlap: f64| {
                normal_force(model.normal, &with_overlap(&case.contact, overlap), 0.3)
            };
            let here = at(case.contact.overlap);
            let slope = (at(case.contact.overlap + step).energy - at(case.contact.overlap - step).energy)
                / (2.0 * step);
            prop_assert!((here.force - slope).abs() < 1e-8, "{}: {} {}", name, here.force, slope);
            prop_assert_eq!(here.force, here.elastic_force);
        }
    }

    /// What a sticking spring takes up is the work done against it; nothing is lost without damping.
    #[test]
    fn without_damping_a_sticking_contact_loses_nothing(case in case()) {
        for (name, model) in table() {
            let Some(law) = undamped(&model).friction else { continue };
            let law = CundallStrack { static_friction: 1e9, ..law };
            let mut history = TangentialHistory::default();
            law.force(&case.contact, 1.0, &mut history, 0.0);
            let mut before = history;
            for _ in 0..4 {
                before = history;
                let found = law.force(&case.contact, 1.0, &mut history, 1e-3);
                prop_assert!(!found.sliding);
                prop_assert!((found.damped + found.slid).abs() < 1e-8, "{}: {}", name, found.damped);
            }
            let work = 0.5e-3 * (before.power + history.power);
            let stored = law.stored_energy(&history) - law.stored_energy(&before);
            prop_assert!((work - stored).abs() < 1e-8, "{}", name);
        }
    }

    #[test]
    fn the_normal_force_never_gives_energy(case in case()) {
        for (name, model) in table() {
            let (found, _) = ask(&model, &case);
            prop_assert!(found.normal_dissipation >= 0.0, "{}: {}", name, found.normal_dissipation);
        }
    }

    #[test]
    fn hertz_never_pulls(case in case(), parting in 0.0..50.0) {
        for (name, normal) in common::normals() {
            if let Normal::Hertz(_) = normal {
                let found = normal_force(normal, &case.contact, parting);
                prop_assert!(found.force >= 0.0, "{}", name);
            }
        }
    }

    /// Where a contact pulls, or has let go, friction and its memory are gone.
    #[test]
    fn without_pressure_there_is_no_friction_and_no_memory(case in case()) {
        for sliding in common::SLIDINGS {
            let law = common::friction(sliding);
            let mut history = case.history.friction;
            let stored = law.stored_energy(&history);
            let found = law.force(&case.contact, 0.0, &mut history, case.time_step);
            prop_assert_eq!(found.force, DVec3::ZERO);
            prop_assert_eq!(found.energy, 0.0, "{:?}", sliding);
            prop_assert_eq!(history.displacement, DVec3::ZERO, "{:?}", sliding);
            let expected = stored + 0.5 * case.time_step * case.history.friction.power;
            prop_assert!((found.damped + found.slid - expected).abs() < 1e-14);
        }
    }

    /// The displacement turns with the plane of contact and keeps its length.
    #[test]
    fn the_displacement_turns_with_the_contact(case in case(), axis in unit(), turned in 0.1..3.0) {
        let law = CundallStrack { static_friction: 1e9, ..common::friction(Default::default()) };
        let steps = 2_000;
        let time_step = 1.0 / f64::from(steps);
        let rotation: DVec3 = turned * axis;
        let distance = case.contact.distance;
        let at = |time: f64| {
            let normal = DQuat::from_axis_angle(axis, turned * time) * case.contact.normal;
            Contact {
                normal,
                relative_velocity: rotation.cross(distance * normal),
                rotation: distance * rotation,
                spin: DVec3::ZERO,
                ..case.contact
            }
        };
        let mut history = TangentialHistory { rate: DVec3::ZERO, ..case.history.friction };
        law.force(&at(0.0), 1.0, &mut history, 0.0);
        for step in 1..=steps {
            law.force(&at(f64::from(step) * time_step), 1.0, &mut history, time_step);
        }
        // Turned with the normal, and about it only as parallel transport does: never.
        prop_assert!(history.displacement.dot(at(1.0).normal).abs() < 1e-14);
        let change = history.displacement.length() / case.history.friction.displacement.length();
        prop_assert!((change - 1.0).abs() < 1e-5, "{change}");
    }
}
