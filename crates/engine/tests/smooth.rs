//! A smooth wall: its forces, what it conserves, and that ever finer lattices come to it.

mod common;

use common::*;

/// The wave of most tests: a sine of amplitude b in a tube of radius 1.5 and wavelength 10, towards -z.
fn wave(lattice: Lattice, amplitude: f64, frequency: f64) -> Wall {
    prescribed(lattice, 1.5, -1.0, amplitude, frequency)
}

fn even(amplitude: f64, frequency: f64) -> Wall {
    smooth(wave(coarse(2), amplitude, frequency))
}

fn elastic_law(stiffness: f64) -> Normal {
    Normal::Linear(linear(stiffness, 0.0))
}

fn start(states: &[(DVec3, DVec3)], wall: Wall, parameters: Parameters) -> Simulation {
    Simulation::new(grains(states), wall, parameters)
}

/// Force on the only grain at the start.
fn force(place: DVec3, wall: &Wall, normal: Normal) -> DVec3 {
    let parameters = parameters(normal, None, Integrator::Verlet, 0.05);
    start(&[(place, DVec3::ZERO)], wall.clone(), parameters)
        .bodies()
        .acceleration[0]
}

/// By hand: in a straight tube whose radius grows, xi = (d + d_w)/2 - (R - rho), f = k xi - eta v_n, v_n counted from the wall.
#[test]
fn the_force_of_a_straight_tube() {
    let widening = Schedule::through(vec![(0.0, 0.0), (10.0, -0.5)]).unwrap();
    let still = Schedule::constant(0.0);
    // The throat of a static sine stands at z = 7.5, R = 1.5 - b there.
    let wall = waving(coarse(2), 1.5, Waveform::Sine, -1.0, widening, still);
    let normal = Normal::Linear(linear(2.0, 0.3));
    let (place, velocity) = (DVec3::new(0.36, 0.48, 7.5), DVec3::new(0.03, 0.04, 0.2));
    let parameters = parameters(normal, None, Integrator::Verlet, 0.05);
    let simulation = start(&[(place, velocity)], smooth(wall), parameters);
    // rho = 0.6, outwards with 0.05; the wall moves outwards with 0.05 as well.
    let expected = -2.0 * (1.0 - 0.9) * DVec3::new(0.6, 0.8, 0.0);
    let found = simulation.bodies().acceleration[0] * simulation.bodies().mass[0];
    assert!((found - expected).length() < 1e-14, "{found}");
    let tally = simulation.tally();
    assert_eq!(tally.wall_contacts, 1);
    assert!((tally.contact_energy - 0.01).abs() < 1e-15);
    assert!((tally.wall_power - expected.length() * -0.05).abs() < 1e-15);
    let mut contacts = Vec::new();
    simulation.for_each_wall_contact(|contact| contacts.push(contact));
    // Half of the overlap inside the grain's surface.
    let expected = DVec3::new(0.6, 0.8, 0.0) * (0.6 + 0.45) + 7.5 * DVec3::Z;
    assert!((contacts[0].point - expected).length() < 1e-14);
}

/// Against a look at all places of the curve, on both sides of the axis, for every shape and thickness.
#[test]
fn the_force_follows_from_the_nearest_places() {
    const GRID: i32 = 40_000;
    let numbers = &mut Numbers(5);
    let shapes = [
        Waveform::Sine.into(),
        Waveform::Bolus.into(),
        Waveform::Roller.into(),
        tabled(),
        segments(),
    ];
    let (mut touched, mut opposite) = (0, 0);
    for shape in shapes {
        for _ in 0..60 {
            let amplitude = 1.5 * numbers.uniform();
            let thickness = 0.8 * numbers.uniform();
            let lattice = Lattice {
                sphere_diameter: thickness,
                ..coarse(1)
            };
            let (amplitude, frequency) = (Schedule::constant(amplitude), Schedule::constant(0.1));
            let wall = smooth(waving(lattice, 1.5, shape, 1.0, amplitude, frequency));
            let wave = *wall.wave().unwrap();
            let z = 10.0 * numbers.uniform();
            let radius = wave.radius(z, 0.0);
            let from_axis = numbers.uniform() * radius;
            let reach = 0.5 * (1.0 + thickness);
            // What the grid does not resolve.
            let (mut expected, mut unsure) = (DVec3::ZERO, 1e-9);
            for side in [1.0, -1.0] {
                let offset = side * from_axis;
                let at = |step: i32| reach * f64::from(step) / f64::from(GRID);
                let apart = |step: i32| (wave.radius(z + at(step), 0.0) - offset).hypot(at(step));
                for step in -GRID..=GRID {
                    let here = apart(step);
                    if here < reach && here < apart(step - 1) && here <= apart(step + 1) {
                        let across = offset - wave.radius(z + at(step), 0.0);
                        expected +=
                            (reach - here) / here * DVec3::new(side * across, 0.0, -at(step));
                        unsure += 4.0 * at(1) / here;
                        touched += 1;
                        opposite += i32::from(side < 0.0);
                    }
                }
            }
            let found = force(DVec3::new(from_axis, 0.0, z), &wall, elastic_law(1.0));
            assert!(
                (found - expected).length() < unsure,
                "{found} {expected} {wave:?}"
            );
        }
    }
    assert!(touched > 150 && opposite > 20, "{touched} {opposite}");
}

/// Frictionless grains slide along a straight smooth tube for ever, and are not turned about its axis by any wave.
#[test]
fn no_drag_along_a_straight_tube_and_no_moment_about_its_axis() {
    for integrator in INTEGRATORS {
        let pressed = Parameters {
            body_force: DVec3::new(0.0, -0.01, 0.0),
            ..parameters(LINEAR, None, integrator, 0.05)
        };
        let at = DVec3::new(0.1, -0.5, 3.0);
        let velocity = DVec3::new(0.0, 0.0, 0.2);
        let mut simulation = start(&[(at, velocity)], even(0.0, 0.1), pressed);
        let mut touches = 0;
        for _ in 0..100 {
            simulation.advance(50).unwrap();
            touches += simulation.tally().wall_contacts;
            assert!((simulation.bodies().velocity[0].z - 0.2).abs() < 1e-14);
        }
        assert!(touches > 10);
    }
    let wall = even(0.7, 0.1);
    let bodies = packed(60, 0.8, &wall, LINEAR, 4);
    let mut simulation = Simulation::new(
        bodies,
        wall,
        parameters(LINEAR, None, Integrator::Verlet, 0.05),
    );
    let before = angular_momentum(simulation.bodies(), 20.0).z;
    simulation.advance(2000).unwrap();
    let after = angular_momentum(simulation.bodies(), 20.0).z;
    assert!((after - before).abs() < 1e-12, "{before} {after}");
    assert!(simulation.tally().wall_contacts > 10);
}

/// Without dissipation the energy in the wave's frame, m |v - c|^2/2 with the contact's, is conserved: there the wall stands
/// still. A lattice moves through that frame and changes it.
fn change_of_energy_in_the_wave(wall: &Wall, stiffness: f64) -> (f64, DVec3) {
    let numbers = &mut Numbers(9);
    let (mut squares, mut rebound) = (0.0, DVec3::ZERO);
    for _ in 0..LAUNCHES {
        // From the axis of the belly towards the wall, not further than a wavelength.
        let place = DVec3::new(0.0, 0.0, 2.0 + 2.0 * numbers.uniform());
        let angle = core::f64::consts::TAU * numbers.uniform();
        let velocity = DVec3::new(libm::cos(angle), libm::sin(angle), numbers.uniform() - 0.5);
        let parameters = parameters(elastic_law(stiffness), None, Integrator::Verlet, 2e-4);
        let mut simulation = start(&[(place, velocity)], wall.clone(), parameters);
        let energy = |simulation: &Simulation| {
            let velocity = simulation.bodies().velocity[0] + SPEED * DVec3::Z;
            0.5 * simulation.bodies().mass[0] * velocity.length_squared()
                + simulation.tally().contact_energy
        };
        let (before, mut touched) = (energy(&simulation), false);
        while !touched || simulation.tally().wall_contacts > 0 {
            simulation.advance(20).expect("does not diverge");
            touched |= simulation.tally().wall_contacts > 0;
        }
        let change = (energy(&simulation) - before) / before;
        squares += change * change;
        rebound += simulation.bodies().velocity[0];
    }
    (
        (squares / f64::from(LAUNCHES)).sqrt(),
        rebound / f64::from(LAUNCHES),
    )
}

const LAUNCHES: u32 = 12;
const PLACES: u32 = 300;
/// c of a wave of frequency 0.05.
const SPEED: f64 = 0.5;

#[test]
#[allow(
    clippy::print_stdout,
    reason = "the numbers are for docs/verification.md"
)]
fn finer_lattices_conserve_the_energy_in_the_waves_frame_as_the_smooth_wall_does() {
    let (of_smooth, rebound) = change_of_energy_in_the_wave(&even(0.7, 0.05), 100.0);
    assert!(of_smooth < 1e-5, "{of_smooth}");
    let of_lattices = [1_u32, 2, 4, 8].map(|refinement| {
        let finer = lattice(12 * refinement, 14 * refinement, 2, 10.0);
        // So many spheres share the load.
        let stiffness = 100.0 / f64::from(refinement * refinement);
        let (change, apart) = change_of_energy_in_the_wave(&wave(finer, 0.7, 0.05), stiffness);
        (change, (apart - rebound).length())
    });
    println!("smooth {of_smooth:.1e}, lattices {of_lattices:?}");
    assert!(
        of_lattices.is_sorted_by(|coarse, fine| fine.0 < 0.7 * coarse.0),
        "{of_lattices:?}"
    );
}

/// The overlap of the sphere of the lattice that is touched most comes to that of the smooth wall as the square of their
/// spacing, and the direction of the force of all spheres to its normal.
#[test]
#[allow(
    clippy::print_stdout,
    reason = "the numbers are for docs/verification.md"
)]
fn finer_lattices_come_to_the_smooth_wall() {
    let parameters = parameters(elastic_law(1.0), None, Integrator::Verlet, 0.05);
    let found = [1_u32, 2, 4, 8].map(|refinement| {
        let numbers = &mut Numbers(11);
        let finer = wave(
            lattice(12 * refinement, 14 * refinement, 2, 10.0),
            0.7,
            0.05,
        );
        let (mut overlaps, mut directions) = (0.0_f64, 0.0);
        let overlap = 0.2 / f64::from(refinement);
        for _ in 0..PLACES {
            let z = 20.0 * numbers.uniform();
            let radius = even(0.7, 0.05).wave().unwrap().radius(z, 0.0);
            let from_axis = radius - 1.0 + overlap;
            let angle = core::f64::consts::TAU * numbers.uniform();
            let place = DVec3::new(
                from_axis * libm::cos(angle),
                from_axis * libm::sin(angle),
                z,
            );
            // Where the other side is far.
            if from_axis < 0.3 {
                continue;
            }
            let [smooth, spheres] = [even(0.7, 0.05), finer.clone()]
                .map(|wall| start(&[(place, DVec3::ZERO)], wall, parameters));
            let deepest = |simulation: &Simulation| simulation.tally().largest_overlap;
            overlaps = overlaps.max(deepest(&smooth) - deepest(&spheres));
            let along = |simulation: &Simulation| simulation.bodies().acceleration[0].normalize();
            directions += (along(&smooth) - along(&spheres)).length() / f64::from(PLACES);
        }
        (overlaps, directions)
    });
    println!("largest difference of overlaps, mean difference of directions: {found:?}");
    let [.., (overlap, direction)] = found;
    assert!(overlap < 0.004 && direction < 0.03, "{found:?}");
    for pair in found.windows(2) {
        assert!((3.0..5.5).contains(&(pair[0].0 / pair[1].0)), "{found:?}");
        assert!(pair[1].1 < 0.7 * pair[0].1, "{found:?}");
    }
}

/// A grain pressed on a straight tube with friction: it stays where the pull is below the Coulomb bound, and slides with
/// mu_k m g where it does not.
#[test]
fn friction_remembers_its_contact() {
    let friction = CundallStrack {
        static_friction: 0.5,
        kinetic_friction: 0.4,
        ..FRICTION
    };
    let place = DVec3::new(0.0, -0.51, 5.0);
    for (pull, moves) in [(0.002, false), (0.02, true)] {
        let parameters = Parameters {
            body_force: DVec3::new(0.0, -0.01, pull),
            ..parameters(
                Normal::Linear(linear(1.0, 0.3)),
                Some(friction),
                Integrator::Verlet,
                0.02,
            )
        };
        // Between two others, which keep it from rolling: here a grain that cannot turn.
        let mut bodies = grains(&[(place, DVec3::ZERO)]);
        bodies.inertia[0] = 1e12;
        let mut simulation = Simulation::new(bodies, even(0.0, 0.1), parameters);
        simulation.advance(5_000).unwrap();
        let grain = simulation.bodies().sphere(0);
        let expected = if moves {
            (pull - 0.4 * 0.01) * 100.0
        } else {
            0.0
        };
        assert!(
            (grain.velocity.z - expected).abs() < 0.02 * expected + 1e-4,
            "{grain:?}"
        );
        // Held by a spring of stiffness 1.
        assert!(moves || (grain.position.z - 5.0 - pull).abs() < 1e-4);
        let residual = simulation.energy_residual();
        assert!(residual < 5e-3, "{residual}");
        assert_eq!(simulation.snapshot().wall_histories.len(), 1);
    }
}

/// A throat that closes on a grain holds it from both sides: the force has no jump where the grain crosses the axis, and
/// a grain beyond the wall is pushed back.
#[test]
fn a_throat_that_closes() {
    let thin = Lattice {
        sphere_diameter: 1e-3,
        ..coarse(2)
    };
    for amplitude in [1.2, 1.5] {
        let wall = smooth(wave(thin, amplitude, 0.05));
        let of = |x: f64, z: f64| force(DVec3::new(x, 0.0, z), &wall, elastic_law(1.0));
        for z in [6.5, 7.0, 7.5, 8.0] {
            let [before, there, after] = [-1e-7, 0.0, 1e-7].map(|x| of(x, z));
            assert!((before - there).length() < 1e-6 && (after - there).length() < 1e-6);
            assert!(there.truncate().length() < 1e-12 && there.is_finite());
            // Out of the throat along the tube, and back to the axis from either side.
            assert!((there.z + of(0.0, 15.0 - z).z).abs() < 1e-9);
            assert!(of(0.2, z).x < 0.0 && of(-0.2, z).x > 0.0);
        }
        // The wall closes, and takes the grain along in front of it or lets it slip; nothing is lost.
        let friction = CundallStrack {
            static_friction: 0.3,
            kinetic_friction: 0.3,
            ..FRICTION
        };
        for friction in [None, Some(friction)] {
            let parameters = parameters(LINEAR, friction, Integrator::Verlet, 0.01);
            let bodies = packed(60, 0.8, &wall, LINEAR, 4);
            let mut simulation = Simulation::new(bodies, wall.clone(), parameters);
            simulation.advance(4_000).unwrap();
            assert!(
                simulation.energy_residual() < 2e-3,
                "{}",
                simulation.energy_residual()
            );
            let outside = |position: &DVec3| {
                let radius = simulation
                    .wall()
                    .wave()
                    .unwrap()
                    .radius(position.z, simulation.wall().cycles());
                position.truncate().length() > radius + 0.5
            };
            assert!(!simulation.bodies().position.iter().any(outside));
        }
    }
    let beyond = force(DVec3::new(1.7, 0.0, 1.0), &even(0.0, 0.1), elastic_law(1.0));
    assert!(
        (beyond - DVec3::new(-1.2, 0.0, 0.0)).length() < 1e-12,
        "{beyond}"
    );
}

/// It is drawn as beads whose inner side is its surface, at any time.
#[test]
fn a_smooth_wall_is_drawn_where_it_is() {
    let wall = even(0.7, 0.05);
    assert!(wall.lattice().is_none() && wall.prescribed_spheres().count() == 0);
    assert!(wave(coarse(2), 0.7, 0.05).drawn(0.0).is_none());
    for time in [0.0, 3.3] {
        let drawn = wall.drawn(time).unwrap();
        let wave = wall.wave().unwrap();
        let beads: Vec<_> = drawn.prescribed_spheres().collect();
        assert!(beads.len() > 500);
        for bead in beads {
            let inner = bead.position.truncate().length() - 0.5 * bead.diameter;
            let surface = wave.radius(bead.position.z, 0.05 * time) - 0.5;
            assert!((inner - surface).abs() < 1e-12, "{inner} {surface}");
        }
    }
}
