//! The elastic wall by itself: equilibrium, forces and energies, bonds, the mean force, contact across the throat.

use std::collections::BTreeSet;

use peristalsis_physics::wall::WallSphere;

mod common;

use common::*;

/// The wall of the frictional preset.
fn preset() -> ElasticParameters {
    elastic_with(|wall| (wall.lattice, wall.mean_radius) = (lattice(22, 23, 2, 20.0), 3.5))
}

fn undriven(parameters: ElasticParameters) -> ElasticParameters {
    ElasticParameters {
        force_amplitude: Schedule::constant(0.0),
        ..parameters
    }
}

fn alone(parameters: ElasticParameters, change: impl Fn(&mut Bodies)) -> Simulation {
    let wall = elastic(parameters);
    let mut bodies = with_wall_spheres(Bodies::default(), &wall);
    change(&mut bodies);
    Simulation::new(
        bodies,
        wall,
        common::parameters(LINEAR, None, Integrator::Verlet, 0.05),
    )
}

fn forces(simulation: &Simulation) -> Vec<DVec3> {
    let bodies = simulation.bodies();
    bodies
        .acceleration
        .iter()
        .zip(&bodies.mass)
        .map(|(a, m)| *m * *a)
        .collect()
}

#[test]
fn the_balanced_tube_is_in_equilibrium() {
    for parameters in [elastic_parameters(), preset()] {
        let mut parameters = undriven(parameters);
        // Each part of the mean would cancel in a straight tube anyway: it is left in.
        parameters.network.tethers.net_force = NetForce::Free;
        let mut simulation = alone(parameters.clone(), |_| ());
        let largest = longest(&forces(&simulation));
        assert!(largest < 1e-15, "{largest}");
        simulation.advance(500).unwrap();
        let fastest = longest(&simulation.bodies().velocity);
        assert!(fastest < 1e-9, "{fastest}");

        // Without the balance it shrinks: the springs are stretched.
        parameters.network.tethers.balance = false;
        let free = alone(parameters, |_| ());
        let inwards = free
            .bodies()
            .position
            .iter()
            .zip(forces(&free))
            .all(|(place, force)| force.dot(DVec3::new(place.x, place.y, 0.0)) < -1e-3);
        assert!(inwards);
    }
}

fn shaken(size: f64, seed: u64) -> impl Fn(&mut Bodies) {
    move |bodies| {
        let mut numbers = Numbers(seed);
        for position in &mut bodies.position {
            *position += numbers.vector(size);
        }
    }
}

/// F = -dE/dr for springs, tethers, the balancing force and the contacts across the tube.
#[test]
fn the_forces_are_the_slope_of_the_energy() {
    let mut parameters = undriven(elastic_parameters());
    parameters.network.tethers.radial = 0.02;
    parameters.network.tethers.net_force = NetForce::Free;
    // A tube so narrow that opposite sides touch.
    parameters.mean_radius = 0.55;
    parameters.network.contact_range = 1.0;
    let normal = Normal::Linear(linear(1.0, 0.0));
    let law = common::parameters(normal, None, Integrator::Verlet, 0.05);
    let wall = elastic(parameters);
    let mut bodies = with_wall_spheres(Bodies::default(), &wall);
    shaken(0.2, 3)(&mut bodies);
    let energy = |bodies: &Bodies| {
        let simulation = Simulation::new(bodies.clone(), wall.clone(), law);
        let tally = *simulation.tally();
        assert!(
            tally.network_energy > 0.0 && tally.keep_energy != 0.0 && tally.contact_energy > 0.0
        );
        tally.potential_energy()
    };
    let found = forces(&Simulation::new(bodies.clone(), wall.clone(), law));
    let step = 1e-5;
    for sphere in [0, 1, 17, 100, 190, 383] {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let moved = |by: f64| {
                let mut moved = bodies.clone();
                moved.position[sphere] += by * axis;
                energy(&moved)
            };
            let slope = -(moved(step) - moved(-step)) / (2.0 * step);
            let force = found[sphere].dot(axis);
            assert!(
                (force - slope).abs() < 1e-7,
                "sphere {sphere}: {force} {slope}"
            );
        }
    }
}

#[test]
fn each_bond_counts_once() {
    for parameters in [elastic_parameters(), preset()] {
        let parameters = undriven(parameters);
        let simulation = alone(parameters.clone(), shaken(0.1, 4));
        let lattice = parameters.lattice;
        let pairs: BTreeSet<(usize, usize)> = (0..lattice.spheres())
            .flat_map(|one| {
                lattice.neighbours(lattice.sphere(one)).map(|other| {
                    let other = lattice.index(other);
                    (one.min(other), one.max(other))
                })
            })
            .collect();
        assert_eq!(pairs.len(), 3 * lattice.spheres());
        let expected: f64 = pairs
            .iter()
            .map(|&(one, other)| {
                let mut apart =
                    simulation.bodies().position[one] - simulation.bodies().position[other];
                apart.z -= lattice.length() * (apart.z / lattice.length()).round();
                0.5 * parameters.network.spring_stiffness
                    * (apart.length() - parameters.network.natural_length).powi(2)
            })
            .sum();
        let found = simulation.tally().network_energy;
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// With the mean force removed the momentum of a driven wall never changes; per ring, not that of any ring; left free,
/// the drive of a shaken wall moves it.
#[test]
fn a_removed_mean_force_leaves_the_momentum() {
    for integrator in INTEGRATORS {
        for (net_force, kept) in [
            (NetForce::Removed, true),
            (NetForce::RemovedPerRing, true),
            (NetForce::Free, false),
        ] {
            let parameters = elastic_with(|wall| wall.network.tethers.net_force = net_force);
            let per_ring = parameters.lattice.spheres_per_ring as usize;
            let wall = elastic(parameters);
            let mut bodies = with_wall_spheres(Bodies::default(), &wall);
            shaken(0.1, 8)(&mut bodies);
            let mut simulation = Simulation::new(
                bodies,
                wall,
                common::parameters(LINEAR, None, integrator, 0.05),
            );
            simulation.advance(400).unwrap();
            let found = momentum(simulation.bodies()).length();
            assert_eq!(found < 1e-13, kept, "{net_force:?}: {found}");
            let of_rings = simulation
                .bodies()
                .velocity
                .chunks(per_ring)
                .map(|ring| ring.iter().sum::<DVec3>().length())
                .fold(0.0, f64::max);
            assert_eq!(
                of_rings < 1e-12,
                net_force == NetForce::RemovedPerRing,
                "{net_force:?}: {of_rings}"
            );
        }
    }
}

#[test]
fn far_wall_spheres_repel_and_lattice_neighbours_do_not() {
    let parameters = undriven(preset());
    let lattice = parameters.lattice;
    let contact_energy = |one: usize, other: usize| {
        let simulation = alone(parameters.clone(), |bodies| {
            let middle = 0.5 * (bodies.position[one] + bodies.position[other]);
            let apart = (bodies.position[one] - bodies.position[other]).normalize();
            bodies.position[one] = middle + 0.4 * apart;
            bodies.position[other] = middle - 0.4 * apart;
        });
        let force = forces(&simulation)[one];
        (
            simulation.tally().contact_energy,
            force.dot(simulation.bodies().position[one] - simulation.bodies().position[other]),
        )
    };
    // Opposite spheres of a ring meet on the axis, by 0.2.
    let (energy, outwards) = contact_energy(0, 11);
    assert!(
        (energy - 0.5 * 0.2 * 0.2).abs() < 1e-12 && outwards > 0.0,
        "{energy}"
    );
    for neighbour in lattice.neighbours(lattice.sphere(100)) {
        let (energy, _) = contact_energy(100, lattice.index(neighbour));
        assert_eq!(energy, 0.0);
    }
}

/// The drive is f^P sin(2 pi (z - c t)/lambda) along the reference radius, or along the present one.
#[test]
fn the_drive_pushes_radially_as_the_wave_has_it() {
    for (angle, heading) in [
        (DriveAngle::Reference, 1.0),
        (DriveAngle::Reference, -1.0),
        (DriveAngle::Current, 1.0),
    ] {
        let parameters = elastic_with(|wall| {
            wall.network.spring_stiffness = 0.0;
            wall.network.tethers = Tethers {
                balance: false,
                radial: 0.0,
                azimuthal: 0.0,
                axial: 0.0,
                net_force: NetForce::Free,
            };
            (wall.angle, wall.heading) = (angle, heading);
            wall.force_amplitude = Schedule::constant(0.004);
            wall.frequency = Schedule::constant(0.03);
        });
        let mut simulation = alone(parameters.clone(), shaken(0.2, 12));
        simulation.advance(37).unwrap();
        let time = simulation.time();
        for (sphere, force) in forces(&simulation).iter().enumerate() {
            let place = simulation.bodies().position[sphere];
            let phase = (heading * place.z - 0.03 * 10.4 * time) / 10.4;
            let push = 0.004 * (core::f64::consts::TAU * phase).sin();
            let radius = match angle {
                DriveAngle::Current => place,
                DriveAngle::Reference => match simulation.wall() {
                    Wall::Elastic(wall) => wall.reference(sphere),
                    Wall::Prescribed(_) => unreachable!("the wall is elastic"),
                },
            };
            let expected = push * DVec3::new(radius.x, radius.y, 0.0).normalize();
            assert!(
                (*force - expected).length() < 1e-14,
                "sphere {sphere}: {force} {expected}"
            );
        }
        assert!(simulation.ledger().drive_work > 0.0);
    }
}

/// Forward and backward drives are mirror images.
#[test]
fn turning_the_drive_round_mirrors_the_wall() {
    let run = |heading: f64| {
        let mut simulation = alone(elastic_with(|wall| wall.heading = heading), |_| ());
        simulation.advance(400).unwrap();
        simulation
    };
    let (forward, backward) = (run(1.0), run(-1.0));
    let lattice = elastic_parameters().lattice;
    let mut moved = 0.0_f64;
    for index in 0..lattice.spheres() {
        let sphere = lattice.sphere(index);
        let ring = (lattice.rings() - sphere.ring) % lattice.rings();
        let image = lattice.index(WallSphere { ring, ..sphere });
        let (one, other) = (
            forward.bodies().velocity[index],
            backward.bodies().velocity[image],
        );
        assert!((one - DVec3::new(other.x, other.y, -other.z)).length() < 1e-12);
        moved = moved.max(one.length());
    }
    assert!(moved > 1e-3);
}

/// A wall that is shaken loses its energy to drag and dashpots, and to nothing else.
#[test]
fn drag_and_dashpots_take_the_energy_out() {
    let mut parameters = undriven(elastic_parameters());
    (parameters.network.drag, parameters.network.spring_damping) = (0.02, 0.02);
    let mut simulation = alone(parameters, shaken(0.1, 5));
    let start = simulation.energy();
    let rest = alone(undriven(elastic_parameters()), |_| ()).energy();
    simulation.advance(4_000).unwrap();
    assert!(simulation.energy() - rest < 0.02 * (start - rest));
    let ledger = simulation.ledger();
    let lost = ledger.drag_dissipated + ledger.network_dissipated;
    assert!((start - simulation.energy() + ledger.keep_work - lost).abs() < 1e-3 * lost);
    assert_eq!(ledger.dissipated(), lost);
}

/// A wall that drifts as a whole stretches its tethers against the removed mean force: what removes it does that work.
/// From rest the wall's momentum stays zero, and so does this work.
#[test]
fn what_removes_the_mean_force_does_work_on_a_drifting_wall() {
    for net_force in [NetForce::Removed, NetForce::RemovedPerRing] {
        let mut parameters = undriven(elastic_parameters());
        parameters.network.tethers.net_force = net_force;
        let axial = parameters.network.tethers.axial;
        let mut simulation = alone(parameters, |bodies| {
            bodies.velocity.fill(DVec3::new(0.0, 0.0, 0.02));
        });
        let start = simulation.energy();
        simulation.advance(400).unwrap();
        let drifted = 0.02 * simulation.time();
        let spheres = simulation.bodies().number() as f64;
        let expected = spheres * 0.5 * axial * drifted * drifted;
        let ledger = simulation.ledger();
        assert!(
            (ledger.keep_work - expected).abs() < 1e-9 * expected,
            "{} {expected}",
            ledger.keep_work
        );
        assert!((simulation.energy() - start - expected).abs() < 1e-9 * expected);
    }
}
