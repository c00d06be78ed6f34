//! The kernel that keeps grains in the order of z, strip by strip, against the reference.

mod common;

use common::*;

/// Equal frictionless grains, packed, in a narrow and in a wide tube, given velocities that mix them.
fn mixed() -> Vec<(Bodies, Wall)> {
    [
        (coarse(3), 1.5, 2.5, 130),
        (lattice(34, 14, 1, 10.0), 4.0, 7.0, 420),
    ]
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
            // Turns and numbers of contacts are the same.
            let apart = Apart::between(&reference, &fast).places;
            assert!(apart < 1e-7 * wall.length(), "{apart} at {}", fast.time());
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
        for (instructions, threads) in Instructions::here().zip([2, 1, 3]) {
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
    let wall = prescribed(coarse(400), 1.5, 1.0, 0.2, 0.05);
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

/// A cluster that leaves the ends of the tube, and with it its copies, while a grain leaves its strip: the order is made anew
/// with fewer strips in use, and with fewer places than there were before the last of them.
#[test]
fn strips_and_places_can_become_fewer() {
    let wall = prescribed(lattice(40, 14, 1, 10.0), 5.0, 1.0, 0.1, 0.01);
    let each = |number: u32| (0..number).map(move |it| f64::from(it) - 0.5 * f64::from(number - 1));
    let layer = each(6).flat_map(|x| each(6).map(move |y| (x, y)));
    let cluster =
        layer.flat_map(|(x, y)| each(5).map(move |z| DVec3::new(x, y, z.rem_euclid(10.0))));
    let mut places: Vec<DVec3> = cluster.collect();
    places.push(DVec3::new(0.0, 3.9, 8.5));
    let number = places.len();
    let mut bodies = Bodies::grains_at_rest(places, vec![1.0; number]);
    bodies.velocity.fill(DVec3::Z);
    bodies.velocity[number - 1] = -DVec3::Y;
    let [mut reference, mut fast] =
        [Kernel::Reference, Kernel::Fast].map(|kernel| begin(&bodies, &wall, kernel));
    reference.advance(100).unwrap();
    fast.advance(100).unwrap();
    assert!(fast.snapshot().sorting.unwrap().strips.len() > 1);
    assert!(Apart::between(&reference, &fast).places < 1e-9);
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
