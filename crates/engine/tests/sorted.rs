//! The kernel that keeps grains in the order of z against the reference.

use glam::DVec3;
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Integrator, Kernel, Parameters, Simulation, Wall};
use peristalsis_physics::contact::Normal;
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};
use proptest::prelude::*;

mod common;

use common::{HERTZ, LINEAR, grains, parameters};

/// Largest difference of forces relative to the largest force.
const FORCES: f64 = 1e-11;

const FINE: Lattice = Lattice {
    spheres_per_ring: 24,
    rings_per_wave: 26,
    waves: 2,
    wavelength: 10.0,
    sphere_diameter: 1.0,
};

#[derive(Clone, Debug)]
struct Case {
    wall: Wall,
    normal: Normal,
    time_step: f64,
    states: Vec<(DVec3, DVec3)>,
}

fn tube() -> impl Strategy<Value = (Wall, f64)> {
    let lattice = prop_oneof![
        Just(FINE),
        Just(common::coarse(3)),
        Just(Lattice { waves: 1, ..FINE }),
        Just(Lattice {
            spheres_per_ring: 5,
            rings_per_wave: 8,
            waves: 1,
            ..FINE
        }),
        Just(Lattice {
            spheres_per_ring: 17,
            rings_per_wave: 13,
            waves: 4,
            ..FINE
        }),
    ];
    (
        lattice,
        0.0..2.9_f64,
        any::<bool>(),
        0.0..0.3_f64,
        0.0..40.0_f64,
    )
        .prop_map(|(lattice, width, forward, strain_rate, start)| {
            // A phase at time 0 that is not always the same: the wave has run for a while when the grains come.
            let frequency = Schedule::constant(strain_rate + start * 0.05);
            let wall = PrescribedWall::new(
                lattice,
                1.5,
                Waveform::Sine,
                if forward { 1.0 } else { -1.0 },
                Schedule::constant(1.5 - 0.5 * width),
                frequency,
            );
            (Wall::Prescribed(wall), lattice.length())
        })
}

fn case() -> impl Strategy<Value = Case> {
    let number = prop_oneof![
        Just(0_usize),
        Just(1),
        Just(2),
        Just(7),
        Just(8),
        Just(9),
        10..90_usize,
        300..400_usize,
    ];
    (
        tube(),
        number,
        any::<bool>(),
        prop_oneof![Just(0.05), Just(0.01)],
    )
        .prop_flat_map(|((wall, length), number, hertz, time_step)| {
            let grain = (
                prop_oneof![
                    8 => 0.0..1.4_f64,
                    // On the axis, between the spheres of the wall, outside.
                    1 => Just(0.0),
                    1 => 1.4..3.0_f64,
                ],
                0.0..core::f64::consts::TAU,
                prop_oneof![
                    8 => (0.0..length).boxed(),
                    // At the seam.
                    1 => Just(0.0).boxed(),
                    1 => (length - 1e-9..length).boxed(),
                ],
                prop::array::uniform3(-1.0..1.0_f64),
            )
                .prop_map(|(radius, angle, z, velocity)| {
                    let place = DVec3::new(radius * angle.cos(), radius * angle.sin(), z);
                    (place, DVec3::from_array(velocity))
                });
            (Just(wall), prop::collection::vec(grain, number)).prop_map(move |(wall, states)| {
                Case {
                    wall,
                    normal: if hertz { HERTZ } else { LINEAR },
                    time_step,
                    states,
                }
            })
        })
}

fn start(case: &Case, kernel: Kernel) -> Simulation {
    let parameters = Parameters {
        kernel,
        ..parameters(case.normal, None, Integrator::Verlet, case.time_step)
    };
    Simulation::new(grains(&case.states), case.wall.clone(), parameters)
}

/// Largest difference of two lists of vectors relative to the largest of them.
fn difference(one: &[DVec3], other: &[DVec3]) -> f64 {
    let largest = one.iter().fold(0.0_f64, |most, v| most.max(v.length()));
    let apart = one
        .iter()
        .zip(other)
        .fold(0.0_f64, |most, (a, b)| most.max((*a - *b).length()));
    if apart == 0.0 { 0.0 } else { apart / largest }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forces_and_sums_are_those_of_the_reference(case in case()) {
        let mut reference = start(&case, Kernel::Reference);
        let mut fast = start(&case, Kernel::Fast);
        let expected = reference.advance(1);
        let found = fast.advance(1);
        prop_assert_eq!(expected.is_ok(), found.is_ok());
        prop_assume!(expected.is_ok());
        let length = case.wall.lattice().length();
        let dense = case.states.len() as f64 > 18.0 * length;
        prop_assert!(fast.snapshot().sorting.is_some() || dense, "another kernel ran");

        let (expected, found) = (reference.bodies(), fast.bodies());
        prop_assert!(difference(&expected.position, &found.position) < 1e-15);
        prop_assert!(difference(&expected.velocity, &found.velocity) < 1e-12);
        let apart = difference(&expected.acceleration, &found.acceleration);
        prop_assert!(apart < FORCES, "{}", apart);

        let (expected, found) = (reference.tally(), fast.tally());
        prop_assert_eq!(expected.grain_contacts, found.grain_contacts);
        prop_assert_eq!(expected.wall_contacts, found.wall_contacts);
        let scale = expected.contact_energy + 1e-3;
        for (name, expected, found) in [
            ("energy", expected.contact_energy, found.contact_energy),
            ("wall power", expected.wall_power, found.wall_power),
            ("dissipation", expected.normal_dissipation, found.normal_dissipation),
            ("axial force", expected.wall_axial_force, found.wall_axial_force),
            ("overlap", expected.largest_overlap, found.largest_overlap),
            ("overlaps", expected.total_overlap, found.total_overlap),
        ] {
            prop_assert!((expected - found).abs() < 1e-11 * scale * 1e2, "{}: {} {}", name, expected, found);
        }
        let ledgers = [&reference, &fast].map(|simulation| simulation.ledger().wall_work);
        prop_assert!((ledgers[0] - ledgers[1]).abs() < 1e-11 * scale);
    }
}
