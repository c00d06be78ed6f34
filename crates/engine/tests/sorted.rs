//! The kernel that keeps grains in the order of z, strip by strip, against the reference.

use glam::DVec3;
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Bodies, Instructions, Integrator, Kernel, Parameters, Simulation, Wall};
use peristalsis_physics::contact::Normal;
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};
use proptest::prelude::*;

mod common;

use common::{HERTZ, LINEAR, grains, packed, parameters, prescribed};

/// Largest difference of forces relative to the largest force.
const FORCES: f64 = 1e-11;

const FINE: Lattice = Lattice {
    spheres_per_ring: 24,
    rings_per_wave: 26,
    waves: 2,
    wavelength: 10.0,
    sphere_diameter: 1.0,
};

const WIDE: Lattice = Lattice {
    spheres_per_ring: 34,
    rings_per_wave: 14,
    waves: 1,
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

/// A tube and its mean radius.
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
        Just(WIDE),
        Just(Lattice { waves: 2, ..WIDE }),
    ];
    (
        lattice,
        0.0..2.9_f64,
        any::<bool>(),
        0.0..0.3_f64,
        0.0..40.0_f64,
        prop::sample::select(Waveform::ALL.to_vec()),
    )
        .prop_map(|(lattice, width, forward, strain_rate, start, waveform)| {
            // A phase at time 0 that is not always the same: the wave has run for a while when the grains come.
            let frequency = Schedule::constant(strain_rate + start * 0.05);
            let radius = if lattice.spheres_per_ring == WIDE.spheres_per_ring {
                4.0
            } else {
                1.5
            };
            let wall = PrescribedWall::new(
                lattice,
                radius,
                waveform,
                if forward { 1.0 } else { -1.0 },
                Schedule::constant(1.5 - 0.5 * width),
                frequency,
            );
            (Wall::Prescribed(wall), radius)
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
        600..700_usize,
    ];
    (
        tube(),
        number,
        any::<bool>(),
        prop_oneof![Just(0.05), Just(0.01)],
    )
        .prop_flat_map(|((wall, tube_radius), number, hertz, time_step)| {
            let length = wall.length();
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
                .prop_map(move |(radius, angle, z, velocity)| {
                    let radius = radius * tube_radius / 1.5;
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
        prop_assert!(fast.snapshot().sorting.is_some(), "another kernel ran");

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

/// Equal smooth grains, packed, in a narrow and in a wide tube, given velocities that mix them.
fn mixed() -> Vec<(Bodies, Wall)> {
    [(common::coarse(3), 1.5, 2.5, 130), (WIDE, 4.0, 7.0, 420)]
        .into_iter()
        .map(|(lattice, radius, width, number)| {
            let wall = prescribed(lattice, radius, 1.0, radius - 0.5 * width, 0.1);
            let mut bodies = packed(number, 1.0, &wall, LINEAR, 9);
            for (grain, velocity) in bodies.velocity.iter_mut().enumerate() {
                let turn = 2.4 * grain as f64;
                *velocity = 0.4 * DVec3::new(turn.cos(), turn.sin(), (1.7 * turn).cos());
            }
            (bodies, wall)
        })
        .collect()
}

fn begin(bodies: &Bodies, wall: &Wall, kernel: Kernel) -> Simulation {
    let parameters = Parameters {
        kernel,
        ..parameters(LINEAR, None, Integrator::Verlet, 0.05)
    };
    Simulation::new(bodies.clone(), wall.clone(), parameters)
}

#[test]
fn trajectories_are_those_of_the_reference_until_chaos_parts_them() {
    for (bodies, wall) in mixed() {
        let mut reference = begin(&bodies, &wall, Kernel::Reference);
        let mut fast = begin(&bodies, &wall, Kernel::Fast);
        // Grains go some 4 diameters: the order is made anew many times.
        for _ in 0..10 {
            reference.advance(20).unwrap();
            fast.advance(20).unwrap();
            let (expected, found) = (reference.bodies(), fast.bodies());
            let apart = difference(&expected.position, &found.position);
            assert!(apart < 1e-7, "{apart} at {}", fast.time());
            assert_eq!(expected.turns, found.turns);
            let (expected, found) = (reference.tally(), fast.tally());
            assert_eq!(expected.grain_contacts, found.grain_contacts);
            assert_eq!(expected.wall_contacts, found.wall_contacts);
        }
        assert!(fast.tally().grain_contacts > 50 && fast.tally().wall_contacts > 20);
        assert!(fast.energy_residual() < 1e-3);
    }
}

#[test]
fn threads_instructions_and_restarts_do_not_change_a_bit() {
    for (bodies, wall) in mixed() {
        let mut expected = begin(&bodies, &wall, Kernel::Fast);
        expected.advance(150).unwrap();
        let sets = [
            Instructions::Plain,
            Instructions::Avx2,
            Instructions::Avx512,
        ];
        for (instructions, threads) in sets.into_iter().zip([3, 1, 2]) {
            let mut other = begin(&bodies, &wall, Kernel::Fast);
            other.compute_with(instructions, threads).unwrap();
            let mut done = 0;
            for stop in [1, 37, 38, 90, 150] {
                other.advance(stop - done).unwrap();
                done = stop;
                let snapshot = other.snapshot();
                let parameters = *other.parameters();
                other = Simulation::restore(snapshot, wall.clone(), parameters).unwrap();
                other.compute_with(instructions, threads).unwrap();
            }
            assert!(other.snapshot() == expected.snapshot(), "{instructions:?}");
        }
    }
}

/// So many grains that threads note and sort pieces of the one row, and so fast that many go through the seam.
#[test]
fn threads_that_share_the_sorting_of_a_long_tube_do_not_change_a_bit() {
    let wall = prescribed(common::coarse(400), 1.5, 1.0, 0.2, 0.05);
    let number = 10_000_u32;
    let along = wall.length() / f64::from(number);
    let places = (0..number).map(|grain| {
        let angle = 2.4 * f64::from(grain);
        DVec3::new(
            0.5 * angle.cos(),
            0.5 * angle.sin(),
            along * f64::from(grain),
        )
    });
    let mut bodies = Bodies::grains_at_rest(places.collect(), vec![1.0; number as usize]);
    for (velocity, grain) in bodies.velocity.iter_mut().zip(0_u32..) {
        let chance = grain.wrapping_mul(2_654_435_761) % 1000;
        velocity.z = 0.004 * f64::from(chance) - 2.0;
    }
    let end_with = |threads| {
        let mut simulation = begin(&bodies, &wall, Kernel::Fast);
        simulation
            .compute_with(Instructions::widest(), threads)
            .unwrap();
        simulation.advance(60).unwrap();
        let mut one_by_one = Vec::new();
        simulation.for_each_wall_contact(|contact| one_by_one.push(contact));
        let in_pieces = simulation.add_up_wall_contacts(|_| Vec::new(), Vec::push);
        assert!(in_pieces.len() > 1);
        assert!(in_pieces.concat() == one_by_one);
        (simulation.snapshot(), in_pieces)
    };
    let expected = end_with(1);
    let (snapshot, contacts) = &expected;
    assert_eq!(contacts.concat().len() as u64, snapshot.tally.wall_contacts);
    let through_the_seam = snapshot.bodies.turns.iter().filter(|&&turns| turns != 0);
    assert!(through_the_seam.count() > 3);
    for threads in [2, 3] {
        assert!(end_with(threads) == expected, "{threads}");
    }
}

#[test]
fn an_order_that_cannot_be_is_refused() {
    let (bodies, wall) = mixed().pop().unwrap();
    let mut simulation = begin(&bodies, &wall, Kernel::Fast);
    simulation.advance(10).unwrap();
    let snapshot = simulation.snapshot();
    assert!(snapshot.sorting.as_ref().unwrap().strips.len() > 1);
    let restore = |change: &dyn Fn(&mut peristalsis_engine::Sorting)| {
        let mut changed = snapshot.clone();
        change(changed.sorting.as_mut().unwrap());
        Simulation::restore(changed, wall.clone(), *simulation.parameters())
    };
    assert!(restore(&|_| ()).is_ok());
    assert!(restore(&|sorting| sorting.order[0] = sorting.order[1]).is_err());
    assert!(restore(&|sorting| sorting.strips[0] += 1).is_err());
    assert!(restore(&|sorting| sorting.strips.truncate(3)).is_err());
    assert!(restore(&|sorting| sorting.unfolded[3] = 1e9).is_err());
    assert!(restore(&|sorting| sorting.origin[3] = -1.0).is_err());
    assert!(restore(&|sorting| sorting.lateral = f64::NAN).is_err());
}
