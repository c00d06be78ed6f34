//! The fast kernels against the reference, over every combination of laws, sizes, tube and integrator.

use proptest::prelude::*;

mod common;

use common::*;

/// After one step. Places are those of the reference bit for bit, so that the same spheres touch; the rest differs by a few
/// roundings.
const LISTED: Apart = Apart {
    places: 0.0,
    velocities: 1e-15,
    spins: 1e-15,
    forces: 4e-15,
    torques: 2e-15,
    histories: 4e-15,
    tally: 5e-14,
    ledger: 2e-14,
};

/// How far squared distances may be off in the kernel that sorts \[d^2\]: it takes those from spheres of the wall as the
/// difference of squares of up to 100, each a few roundings off.
const CANCELLED: f64 = 5e-14;

/// After 200 steps.
const LATER: Apart = Apart {
    places: 2e-12,
    velocities: 2e-12,
    spins: 2e-12,
    forces: 2e-12,
    torques: 2e-12,
    histories: 2e-12,
    tally: 1e-10,
    ledger: 2e-12,
};

fn all_rows() -> Vec<Row> {
    [
        Tube::Narrow,
        Tube::Scattered,
        Tube::Smooth,
        Tube::Wide,
        Tube::Elastic,
    ]
    .map(rows)
    .concat()
}

fn number() -> impl Strategy<Value = usize> {
    prop_oneof![
        // About the number of lanes.
        3 => prop::sample::select(vec![0_usize, 1, 2, 7, 8, 9, 15, 16, 17]),
        2 => 10..90_usize,
        1 => 200..300_usize,
    ]
}

/// The reference so many steps on, so that contacts have histories; fewer where it would diverge.
fn prepare(state: &State, steps: u64) -> Simulation {
    let mut simulation = state.start(Kernel::Reference);
    for _ in 0..steps {
        let before = simulation.clone();
        if simulation.advance(1).is_err() {
            return before;
        }
    }
    simulation
}

/// One step of both kernels from a state of the reference; `None` where both diverge alike.
fn step_from(state: &State, prepared: &Simulation) -> Option<Simulation> {
    let mut reference = state.go_on(prepared, Kernel::Reference);
    let mut fast = state.go_on(prepared, Kernel::Fast);
    let outcome = reference.advance(1);
    assert_eq!(outcome, fast.advance(1));
    outcome.ok()?;
    let apart = Apart::between(&reference, &fast);
    let overlap = reference.tally().largest_overlap;
    let most = match fast.snapshot().sorting {
        Some(_) if overlap > 0.0 => {
            // All spheres that this kernel serves here have diameter 1. A distance s is off by CANCELLED/(2 s), and with it
            // the direction of a force, by that over s, and its size, by that over the overlap.
            let nearest = 1.0 - overlap;
            let more = CANCELLED / nearest * (1.0 / nearest + 1.0 / overlap);
            Apart {
                velocities: LISTED.velocities + apart.forces * kick(&reference, state),
                forces: LISTED.forces + more,
                // Energies go as the overlap to the power of 5/2 at most, powers as the square of a velocity.
                tally: LISTED.tally + 3.0 * more,
                ledger: LISTED.ledger + 3.0 * more,
                ..LISTED
            }
        }
        _ => LISTED,
    };
    apart.assert_within(&most);
    Some(reference)
}

/// What the unit of forces adds to a velocity at the end of a step, in units of the largest velocity.
fn kick(simulation: &Simulation, state: &State) -> f64 {
    let bodies = simulation.bodies();
    let forces = bodies.acceleration.iter().zip(&bodies.mass);
    let forces = forces.map(|(acceleration, mass)| acceleration.length() * mass);
    let unit = forces.fold(simulation.tally().largest_overlap, f64::max);
    let lightest = bodies.mass.iter().copied().fold(f64::INFINITY, f64::min);
    let fastest = longest(&bodies.velocity).max(f64::MIN_POSITIVE);
    0.5 * state.parameters.time_step * unit / lightest / fastest
}

/// Rows that the kernel serves which sorts.
fn smooth() -> Vec<Row> {
    let mut rows = [Tube::Narrow, Tube::Wide].map(rows).concat();
    rows.retain(|row| row.alike && row.sliding.is_none() && row.integrator == Integrator::Verlet);
    rows
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Also with so many grains that they stand in several strips.
    #[test]
    fn a_step_of_equal_smooth_grains(
        row in prop::sample::select(smooth()), number in prop_oneof![2 => number(), 1 => 300..700_usize, 1 => 600..700_usize],
        seed: u64, steps in 0..3_u64,
    ) {
        let state = random(row, number, seed);
        let prepared = prepare(&state, steps);
        step_from(&state, &prepared);
        let sorted = state.go_on(&prepared, Kernel::Fast).snapshot().sorting.is_some();
        // Shorter tubes are the other kernel's.
        prop_assert!(sorted || state.wall.length() < 10.0, "another kernel ran");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 768, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_step_in_any_tube(
        row in prop::sample::select(all_rows()), number in number(), seed: u64, steps in 0..20_u64,
    ) {
        let state = random(row, number, seed);
        step_from(&state, &prepare(&state, steps));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Many steps at once are one after the other, bit for bit.
    #[test]
    fn one_advance_is_many(
        row in prop::sample::select(all_rows()), number in number(), seed: u64, steps in 0..20_u64,
    ) {
        let state = random(row, number, seed);
        let prepared = prepare(&state, steps);
        let mut at_once = state.go_on(&prepared, Kernel::Fast);
        let mut one_by_one = at_once.clone();
        let outcome = at_once.advance(12);
        let outcomes = (0..12).try_for_each(|_| one_by_one.advance(1));
        assert_eq!(outcome, outcomes);
        if outcome.is_ok() {
            assert!(at_once.snapshot() == one_by_one.snapshot());
        }
    }
}

/// One grain, ever nearer to a wall of many spheres.
#[test]
fn a_grain_that_touches_any_number_of_wall_spheres() {
    let lattice = lattice(24, 26, 1, 10.0);
    let dense = elastic_with(|wall| (wall.lattice, wall.mean_radius) = (lattice, 1.5));
    for wall in [strained(lattice, -1.0, 2.9, 0.1), elastic(dense)] {
        let mut seen = [false; 13];
        for place in 0..200 {
            let place = f64::from(place);
            let (radius, angle, z) = (0.4 + 0.004 * place, 0.37 * place, 0.067 * place);
            let at = DVec3::new(radius * libm::cos(angle), radius * libm::sin(angle), z);
            let state = State {
                bodies: with_wall_spheres(grains(&[(at, DVec3::new(0.1, 0.2, 0.3))]), &wall),
                wall: wall.clone(),
                parameters: parameters(HERTZ, Some(FRICTION), Integrator::Verlet, 0.02),
            };
            let after = step_from(&state, &prepare(&state, 1)).unwrap();
            if let Some(seen) = seen.get_mut(after.tally().wall_contacts as usize) {
                *seen = true;
            }
        }
        assert_eq!(seen, [true; 13]);
    }
}

/// Nothing moves what is at rest exactly in another sphere, nor drives a sphere exactly on the axis.
#[test]
fn where_no_normal_and_no_radius_has_a_direction() {
    let lattice = lattice(5, 8, 1, 10.0);
    let slack = |force_amplitude| {
        elastic(elastic_with(|wall| {
            (wall.lattice, wall.mean_radius) = (lattice, 1.5);
            wall.network.spring_stiffness = 0.0;
            wall.network.tethers.net_force = NetForce::Free;
            wall.force_amplitude = Schedule::constant(force_amplitude);
            wall.angle = DriveAngle::Current;
        }))
    };
    let on_axis = DVec3::new(0.0, 0.0, 5.6);
    let in_wall = DVec3::new(1.5, 0.0, 0.0);
    let states = [in_wall, on_axis, on_axis].map(|place| (place, DVec3::ZERO));
    for (normal, friction) in [(LINEAR, None), (HERTZ, Some(FRICTION))] {
        for (wall, driven) in [
            (strained(lattice, 1.0, 3.0, 0.1), false),
            (slack(0.0), false),
            (slack(0.01), true),
        ] {
            // A driven wall has one of its spheres on the axis, and no grain in any.
            let mut bodies = with_wall_spheres(grains(&states[usize::from(driven)..]), &wall);
            if driven {
                bodies.position[2] = DVec3::ZERO;
            }
            let state = State {
                bodies,
                wall,
                parameters: parameters(normal, friction, Integrator::Verlet, 0.05),
            };
            let after = step_from(&state, &prepare(&state, 1)).unwrap();
            let contacts = after.tally().grain_contacts + after.tally().wall_contacts;
            assert_eq!((contacts, after.tally().contact_energy), (0, 0.0));
            let still = after.bodies().velocity.iter().map(|v| *v == DVec3::ZERO);
            assert!(still.clone().take(3).all(|still| still));
            assert_eq!(still.skip(3).any(|still| !still), driven);
        }
    }
}

/// Contacts end within a step, some by leaps beyond what the list reaches.
#[test]
fn what_ended_contacts_held_is_lost_once() {
    let soft = elastic(elastic_parameters());
    for (wall, radius) in [(strained(coarse(2), -1.0, 3.0, 0.1), 1.5), (soft, 2.5)] {
        for (normal, integrator) in [
            (LINEAR, Integrator::Verlet),
            (HERTZ, Integrator::AdamsBashforth),
        ] {
            for skin in [0.0, 0.02, 0.1, 0.3, 0.7] {
                // One grain in a sphere of the wall, and two in each other, all slipping.
                let beside_wall = DVec3::new(
                    radius - 0.8,
                    0.0,
                    wall.lattice().expect("a wall of spheres").axial_position(2),
                );
                let on_axis = DVec3::new(0.0, 0.0, 5.0);
                let bodies = grains(&[
                    (beside_wall, DVec3::Z),
                    (on_axis, DVec3::X),
                    (on_axis + 0.8 * DVec3::Z, DVec3::Y),
                ]);
                let state = State {
                    bodies: with_wall_spheres(bodies, &wall),
                    wall: wall.clone(),
                    parameters: Parameters {
                        skin,
                        ..parameters(normal, Some(FRICTION), integrator, 0.05)
                    },
                };
                let mut prepared = prepare(&state, 2).snapshot();
                let contacts =
                    [&prepared.pair_histories[..], &prepared.wall_histories[..]].concat();
                assert!(contacts.len() >= 2);
                let stretched = contacts
                    .iter()
                    .map(|contact| contact.2.displacement.length_squared());
                let stored = 0.5 * FRICTION.tangential_stiffness * stretched.sum::<f64>();
                let lost_before = prepared.ledger.history_reset;
                for (grain, away) in [-DVec3::X, -DVec3::Z, DVec3::Z].into_iter().enumerate() {
                    prepared.bodies.velocity[grain] = 6.0 * away;
                }
                let go_on = |kernel| {
                    let parameters = state.with(kernel);
                    Simulation::restore(prepared.clone(), wall.clone(), parameters).unwrap()
                };
                let mut reference = go_on(Kernel::Reference);
                let mut fast = go_on(Kernel::Fast);
                reference.advance(3).unwrap();
                fast.advance(3).unwrap();
                println!(
                    "APART end sorted false {:?}",
                    Apart::between(&reference, &fast)
                );
                let after = fast.snapshot();
                assert!(after.pair_histories.is_empty() && after.wall_histories.is_empty());
                let lost = after.ledger.history_reset - lost_before;
                assert!(stored > 1e-5 && (lost / stored - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// Packed grains in motion: the difference grows, but slowly.
#[test]
fn trajectories_stay_together() {
    for row in all_rows() {
        let state = lively(row);
        let mut reference = state.start(Kernel::Reference);
        let mut fast = state.start(Kernel::Fast);
        reference.advance(200).unwrap();
        fast.advance(200).unwrap();
        assert!(reference.tally().grain_contacts > 0 && reference.tally().wall_contacts > 0);
        Apart::between(&reference, &fast).assert_within(&LATER);
    }
}

/// A state in a wall that jumps at t = 1.01.
fn jumping(row: Row) -> State {
    let amplitude = Schedule::through(vec![(0.0, 0.2), (1.01, 0.2), (1.01, 0.3)]);
    let amplitude = amplitude.expect("times that ascend");
    let mut state = lively(row);
    let frequency = Schedule::constant(0.1);
    state.wall = waving(coarse(2), 1.5, Waveform::Sine, -1.0, amplitude, frequency);
    state
}

/// What a wall that jumps does to the contacts that it finds is work, also where they slide.
#[test]
fn a_jump_does_the_same_work() {
    for row in rows(Tube::Narrow) {
        let state = jumping(row);
        let mut reference = state.start(Kernel::Reference);
        let mut fast = state.start(Kernel::Fast);
        for (steps, jumps) in [(25, false), (1, true)] {
            let before = fast.ledger().wall_work;
            reference.advance(steps).unwrap();
            fast.advance(steps).unwrap();
            Apart::between(&reference, &fast).assert_within(&LATER);
            let by_jump = (fast.ledger().wall_work - before) / steps as f64;
            assert_eq!(by_jump.abs() > 0.01, jumps, "{by_jump}");
        }
    }
}

/// Those that the machine lacks are replaced by the widest that it has; and any number of threads.
#[test]
fn all_instructions_give_the_same_bits() {
    // One that the machine lacks stands for all of these: the widest that there are take their place.
    let (here, lacking): (Vec<_>, Vec<_>) =
        (Instructions::ALL.iter()).partition(|set| set.1.available());
    let sets: Vec<_> = here
        .into_iter()
        .chain(lacking.into_iter().take(1))
        .collect();
    for (seed, row) in (0..).zip(all_rows()) {
        for number in [9, 60] {
            let state = random(row, number, seed);
            let end = |instructions, threads| {
                let mut simulation = state.start(Kernel::Fast);
                simulation.compute_with(instructions, threads).unwrap();
                let outcome = simulation.advance(100);
                (outcome, simulation.snapshot())
            };
            let plain = end(Instructions::Plain, 1);
            assert_eq!(plain.0, Ok(()));
            for &&(name, instructions, _) in &sets {
                assert!(end(instructions, 1) == plain, "{name}, {row:?}");
            }
            assert!(end(Instructions::Plain, 2) == plain, "two threads, {row:?}");
            let three = end(Instructions::widest(), 3);
            assert!(three == plain, "three threads, {row:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// From any state on, in pieces, and also where a run diverges.
    #[test]
    fn threads_change_no_bit(
        row in prop::sample::select(all_rows()), number in number(), seed: u64, steps in 0..20_u64, threads in 2..6_usize,
    ) {
        let state = random(row, number, seed);
        let prepared = prepare(&state, steps);
        let go_on = |threads| {
            let mut simulation = state.go_on(&prepared, Kernel::Fast);
            simulation.compute_with(Instructions::widest(), threads).unwrap();
            let outcome = [1, 7, 20].into_iter().try_for_each(|steps| simulation.advance(steps));
            (outcome, simulation.snapshot())
        };
        let (one, several) = (go_on(1), go_on(threads));
        prop_assert_eq!(&one.0, &several.0);
        prop_assert!(one.0.is_err() || one.1 == several.1);
    }
}

/// A wall that jumps while threads keep what its contacts remember.
#[test]
fn threads_change_no_bit_of_a_jump() {
    for row in rows(Tube::Narrow) {
        let state = jumping(row);
        let [one, several] = [1, 3].map(|threads| {
            let mut simulation = state.start(Kernel::Fast);
            simulation
                .compute_with(Instructions::widest(), threads)
                .unwrap();
            simulation.advance(40).unwrap();
            simulation.snapshot()
        });
        assert!(one == several, "{row:?}");
    }
}

/// Grains that run past each other in one advance, until those of one section of the tube are all over it.
#[test]
fn threads_change_no_bit_of_grains_that_mix() {
    for tube in [Tube::Narrow, Tube::Elastic] {
        for row in rows(tube).into_iter().filter(|row| row.sliding.is_some()) {
            let mut state = lively(row);
            let grains = state.bodies.grains;
            for (grain, velocity) in state.bodies.velocity[..grains].iter_mut().enumerate() {
                velocity.z += if grain % 2 == 0 { 0.3 } else { -0.3 };
            }
            let [one, several] = [1, 3].map(|threads| {
                let mut simulation = state.start(Kernel::Fast);
                simulation
                    .compute_with(Instructions::widest(), threads)
                    .unwrap();
                let outcome = simulation.advance(1500);
                (outcome, simulation.snapshot())
            });
            assert_eq!(one.0, several.0);
            assert!(one.0.is_err() || one.1 == several.1, "{row:?}");
        }
    }
}
