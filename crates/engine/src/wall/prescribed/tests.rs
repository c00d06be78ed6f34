//! The arithmetic search for wall spheres against a look at all of them.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::bodies::Bodies;
use crate::ledger::Tally;
use crate::neighbours::periodic;
use crate::wall::Wall;
use crate::wall::memory::WallMemory;

const COARSE: Lattice = Lattice {
    spheres_per_ring: 12,
    rings_per_wave: 14,
    waves: 2,
    wavelength: 10.0,
    sphere_diameter: 1.0,
    staggered: true,
};

fn wall(lattice: Lattice, heading: f64, amplitude: Schedule) -> PrescribedWall {
    let frequency = Schedule::constant(0.07);
    PrescribedWall::new(lattice, 1.5, Waveform::Sine, heading, amplitude, frequency)
}

/// The spheres that touch, by looking at all of them, with their separations.
fn by_looking_at_all(wall: &PrescribedWall, centre: DVec3, diameter: f64) -> BTreeMap<u32, DVec3> {
    let reach = 0.5 * (diameter + wall.sphere_diameter);
    (0..wall.number())
        .map(|sphere| {
            let apart = periodic(centre - wall.sphere(sphere).position, wall.length);
            (sphere as u32, apart)
        })
        .filter(|(_, apart)| apart.length() < reach)
        .collect()
}

fn check(wall: &PrescribedWall, centre: DVec3, diameter: f64) -> usize {
    let expected = by_looking_at_all(wall, centre, diameter);
    let mut found = BTreeMap::new();
    wall.for_each_touching(
        centre,
        0.5 * (diameter + wall.sphere_diameter),
        |sphere, separation, _| {
            assert!(
                found.insert(sphere, separation).is_none(),
                "sphere {sphere} twice"
            );
        },
    );
    let reach = 0.5 * (diameter + wall.sphere_diameter);
    for (sphere, apart) in &expected {
        // At the very edge rounding decides.
        if apart.length() < reach - 1e-12 {
            let separation = found
                .get(sphere)
                .unwrap_or_else(|| panic!("{sphere} missed at {centre}"));
            assert!((*separation - *apart).length() < 1e-13);
        }
    }
    for (sphere, separation) in &found {
        assert!(
            expected.contains_key(sphere) || separation.length() > reach - 1e-12,
            "{sphere} at {centre}"
        );
    }
    expected.len()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_spheres_that_touch_are_those_a_search_over_all_finds(
        from_axis in 0.0..2.6, angle in -3.2..3.2, z in 0.0..20.0, diameter in 0.3..1.6,
        time in 0.0..40.0, amplitude in 0.0..1.3, backward: bool, refinement in 1_u32..4, standing in 0..4,
        waveform in 0..Waveform::ALL.len(),
    ) {
        let lattice = Lattice {
            spheres_per_ring: 12 * refinement,
            rings_per_wave: 14 * refinement,
            staggered: standing == 0,
            ..COARSE
        };
        let heading = if backward { 1.0 } else { -1.0 };
        let (amplitude, frequency) = (Schedule::constant(amplitude), Schedule::constant(0.07));
        let waveform = Waveform::ALL[waveform];
        let mut wall = PrescribedWall::new(lattice, 1.5, waveform, heading, amplitude, frequency);
        wall = match standing {
            2 => wall.with(Scattered::random(&lattice, refinement.into())),
            3 => wall.with(Scattered::disordered(&lattice, 1.5, refinement.into())),
            _ => wall,
        };
        wall.move_to(time);
        let place = DVec3::new(from_axis * libm::cos(angle), from_axis * libm::sin(angle), z);
        check(&wall, place, diameter);
    }
}

#[test]
fn on_the_axis_at_the_seam_and_where_many_touch() {
    for heading in [-1.0, 1.0] {
        // A bottleneck of radius 0.2 at some z: a grain on the axis touches whole rings.
        let mut wall = wall(COARSE, heading, Schedule::constant(1.3));
        let mut most = 0;
        for step in 0..400 {
            wall.move_to(0.1 * f64::from(step));
            let z = 0.05 * f64::from(step);
            most = most.max(check(&wall, DVec3::new(0.0, 0.0, z), 1.0));
            check(&wall, DVec3::new(-0.0, 1e-300, z), 1.0);
            check(&wall, DVec3::new(1e-9, -1e-9, z), 1.0);
            for at_the_seam in [0.0, 1e-12, 19.999_999, 20.0 - 1e-12] {
                check(&wall, DVec3::new(0.9, -0.4, at_the_seam), 1.0);
                check(&wall, DVec3::new(-0.3, 0.0, at_the_seam), 1.0);
            }
        }
        assert!(most >= 24, "{most}");
    }
}

/// Half way between two spheres of a ring, where the approximate angle may point to either.
#[test]
fn between_two_spheres_of_a_ring() {
    let wall = wall(COARSE, -1.0, Schedule::constant(0.1));
    for half_steps in 0..24 {
        let angle = f64::from(half_steps) * core::f64::consts::PI / 12.0;
        for turn in [-1e-6, -1e-15, 0.0, 1e-15, 1e-6] {
            let (sin, cos) = (libm::sin(angle + turn), libm::cos(angle + turn));
            for ring in 0..3 {
                let z = 10.0 / 14.0 * f64::from(ring);
                assert!(check(&wall, DVec3::new(1.1 * cos, 1.1 * sin, z), 1.0) > 0);
            }
        }
    }
}

#[test]
fn a_grain_clear_of_the_wall_touches_nothing() {
    let wall = wall(COARSE, -1.0, Schedule::constant(0.1));
    wall.for_each_touching(DVec3::new(0.2, 0.1, 7.0), 1.0, |sphere, _, _| {
        panic!("touches {sphere}")
    });
    wall.for_each_touching(DVec3::new(8.0, 0.0, 7.0), 1.0, |sphere, _, _| {
        panic!("touches {sphere}")
    });
}

/// Also while the amplitude follows a ramp.
#[test]
fn the_velocity_is_the_derivative_of_the_place() {
    let ramp = Schedule::through(vec![(0.0, 0.1), (10.0, 0.6)]).unwrap();
    for heading in [-1.0, 1.0] {
        for amplitude in [Schedule::constant(0.3), ramp.clone()] {
            let mut wall = wall(COARSE, heading, amplitude);
            let (time, step) = (3.3, 1e-5);
            let places = |wall: &mut PrescribedWall, time: f64| -> Vec<DVec3> {
                wall.move_to(time);
                (0..COARSE.spheres())
                    .map(|sphere| wall.sphere(sphere).position)
                    .collect()
            };
            let (before, after) = (
                places(&mut wall, time - step),
                places(&mut wall, time + step),
            );
            wall.move_to(time);
            let mut seen = 0;
            for grain in 0..200 {
                let z = 0.1 * f64::from(grain);
                wall.for_each_touching(DVec3::new(0.3, 1.2, z), 1.0, |sphere, _, velocity| {
                    let sphere = sphere as usize;
                    let slope = (after[sphere] - before[sphere]) / (2.0 * step);
                    assert!((velocity - slope).length() < 1e-8, "{velocity} {slope}");
                    seen += usize::from(velocity.length() > 1e-3);
                });
            }
            assert!(seen > 100);
        }
    }
}

/// The force on a grain and the wall's power are sums over those spheres.
#[test]
fn forces_are_sums_over_the_spheres() {
    use peristalsis_physics::contact::{ContactLaw, Frictionless, LinearSpringDashpot};
    let normal = LinearSpringDashpot {
        normal_stiffness: 2.0,
        normal_damping: 0.3,
    };
    let law = ContactLaw {
        normal,
        tangential: Frictionless,
    };
    for heading in [-1.0, 1.0] {
        let mut wall = wall(COARSE, heading, Schedule::constant(0.4));
        wall.move_to(5.1);
        let mut bodies = Bodies::grains_at_rest(
            vec![DVec3::new(0.5, -0.6, 19.9), DVec3::new(-0.9, 0.2, 6.0)],
            vec![1.0, 0.8],
        );
        bodies.velocity = vec![DVec3::new(0.1, 0.2, -0.3), DVec3::new(-0.2, 0.1, 0.05)];
        let mut tally = Tally::default();
        let memory = &mut WallMemory::default();
        let rigid = Wall::Prescribed(wall.clone());
        rigid.add_forces(&law, &mut bodies, memory, 0.05, &mut tally);
        let (mut power, mut contacts) = (0.0, 0);
        for grain in 0..2 {
            let (centre, diameter) = (bodies.position[grain], bodies.diameter[grain]);
            let mut expected = DVec3::ZERO;
            for (sphere, apart) in by_looking_at_all(&wall, centre, diameter) {
                let ring = COARSE.sphere(sphere as usize).ring;
                let z = COARSE.axial_position(ring);
                let speed = wall.wave.ring(z, wall.cycles, 0.07, 0.0).velocity;
                let place = wall.sphere(sphere as usize).position;
                let velocity = speed * DVec3::new(place.x, place.y, 0.0).normalize();
                let n = apart.normalize();
                let overlap = 0.5 * (diameter + 1.0) - apart.length();
                let force = (2.0 * overlap - 0.3 * (bodies.velocity[grain] - velocity).dot(n)) * n;
                expected += force;
                power += force.dot(velocity);
                contacts += 1;
            }
            assert!((bodies.acceleration[grain] - expected).length() < 1e-13);
        }
        assert!((tally.wall_power - power).abs() < 1e-13 && power != 0.0);
        assert_eq!(tally.wall_contacts, contacts);
    }
}
