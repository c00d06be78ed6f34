//! A drive and a friction that change while the simulation runs.

mod common;

use common::*;

const TIME_STEP: f64 = 0.05;

fn constant(value: f64) -> Schedule {
    Schedule::constant(value)
}

/// Constant up to half a step after `step`, then linear within 20 time units.
fn from_step(step: u64, from: f64, to: f64) -> Schedule {
    let start = (step as f64 + 0.5) * TIME_STEP;
    Schedule::through(vec![(start, from), (start + 20.0, to)]).expect("two knots in order")
}

fn strained_wall(amplitude: Schedule, frequency: Schedule) -> Wall {
    waving(coarse(2), 1.5, Waveform::Sine, -1.0, amplitude, frequency)
}

fn elastic_wall(force_amplitude: Schedule, frequency: Schedule) -> Wall {
    elastic(elastic_with(|wall| {
        (wall.force_amplitude, wall.frequency) = (force_amplitude, frequency);
    }))
}

/// A way to make walls, the amplitudes and frequencies before and after, and whether there is friction.
type Case = (fn(Schedule, Schedule) -> Wall, [f64; 2], [f64; 2], bool);

const CASES: [Case; 4] = [
    (strained_wall, [0.1, 0.2], [0.05, 0.08], false),
    (strained_wall, [0.1, 0.2], [0.05, 0.08], true),
    (elastic_wall, [0.005, 0.007], [0.02, 0.03], false),
    (elastic_wall, [0.005, 0.007], [0.02, 0.03], true),
];

fn start((wall, amplitude, frequency, friction): Case) -> Simulation {
    let wall = wall(constant(amplitude[0]), constant(frequency[0]));
    let normal = if friction { HERTZ } else { LINEAR };
    let bodies = packed(30, 1.0, &wall, normal, 5);
    let friction = friction.then_some(FRICTION);
    let parameters = parameters(normal, friction, Integrator::Verlet, TIME_STEP);
    Simulation::new(bodies, wall, parameters)
}

#[test]
fn a_drive_that_changes_on_the_way_is_one_that_was_to_change_from_the_start() {
    for case in CASES {
        let (wall, [a0, a1], [f0, f1], _) = case;
        let mut driven = start(case);
        driven.advance(100).unwrap();
        let later = || wall(from_step(100, a0, a1), from_step(100, f0, f1));
        driven.drive_by(later()).unwrap();
        driven.advance(900).unwrap();

        let mut scheduled = start(case);
        scheduled.drive_by(later()).unwrap();
        scheduled.advance(1000).unwrap();
        assert_eq!(bits(&driven), bits(&scheduled));
        assert_eq!(driven.ledger(), scheduled.ledger());

        // It did change, and the ledger knows of it.
        let mut left_alone = start(case);
        left_alone.advance(1000).unwrap();
        assert_ne!(bits(&driven), bits(&left_alone));
        assert!(driven.wall().cycles() > left_alone.wall().cycles() + 0.1);
        assert!(
            driven.energy_residual() < 1e-2,
            "{}",
            driven.energy_residual()
        );
    }
}

#[test]
fn the_same_course_again_changes_no_bit() {
    for case in CASES {
        let (wall, amplitude, frequency, friction) = case;
        let mut one = start(case);
        let mut other = one.clone();
        one.advance(200).unwrap();
        other.advance(100).unwrap();
        other
            .drive_by(wall(constant(amplitude[0]), constant(frequency[0])))
            .unwrap();
        if friction {
            other
                .set_friction(FRICTION.static_friction, FRICTION.kinetic_friction)
                .unwrap();
        }
        other.advance(100).unwrap();
        assert_eq!(bits(&one), bits(&other));
        assert_eq!(one.snapshot(), other.snapshot());
    }
}

#[test]
fn friction_that_changes_slides_at_once_and_stays_in_the_ledger() {
    let mut simulation = start(CASES[3]);
    simulation.advance(400).unwrap();
    let mut smooth = simulation.clone();
    smooth.set_friction(0.01, 0.005).unwrap();
    let friction = smooth.parameters().contact.friction.unwrap();
    assert_eq!(
        (friction.static_friction, friction.kinetic_friction),
        (0.01, 0.005)
    );
    let slid = |simulation: &Simulation| simulation.ledger().sliding_dissipated;
    let before = slid(&smooth);
    smooth.advance(400).unwrap();
    simulation.advance(400).unwrap();
    assert_ne!(bits(&smooth), bits(&simulation));
    assert!(slid(&smooth) >= before);
    assert!(
        smooth.energy_residual() < 1e-2,
        "{}",
        smooth.energy_residual()
    );
    // Gone on with from a snapshot under the new law: the same bits.
    let wall = CASES[3].0(constant(0.005), constant(0.02));
    let mut restored = Simulation::restore(smooth.snapshot(), wall, *smooth.parameters()).unwrap();
    restored.advance(100).unwrap();
    smooth.advance(100).unwrap();
    assert_eq!(bits(&restored), bits(&smooth));
}

#[test]
fn what_would_jump_or_is_another_tube_is_refused() {
    let mut simulation = start(CASES[0]);
    simulation.advance(10).unwrap();
    let before = simulation.snapshot();
    let walls = [
        strained_wall(constant(0.11), constant(0.05)),
        strained_wall(constant(0.1), constant(0.06)),
        strained(coarse(3), -1.0, 2.8, 0.05),
        strained(coarse(2), 1.0, 2.8, 0.05),
        elastic(elastic_parameters()),
    ];
    for wall in walls {
        let refused = simulation.drive_by(wall);
        assert!(matches!(refused, Err(EngineError::OtherWall { .. })));
    }
    let no_friction = simulation.set_friction(0.5, 0.4);
    assert!(matches!(
        no_friction,
        Err(EngineError::InvalidParameter { .. })
    ));
    assert_eq!(simulation.snapshot(), before);

    let mut rough = start(CASES[1]);
    for (of_rest, of_motion) in [
        (0.0, 0.0),
        (-1.0, 0.0),
        (0.3, 0.4),
        (0.3, -0.1),
        (f64::NAN, 0.1),
    ] {
        assert!(rough.set_friction(of_rest, of_motion).is_err());
    }
}
