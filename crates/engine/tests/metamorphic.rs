//! Images of a system: mirrored, turned, shifted, renumbered, in other units. Each goes the image of its way, over every
//! combination of laws, sizes, tube and integrator, by the fast kernels.

use glam::DVec3;
use peristalsis_engine::wall::{
    ElasticNetwork, ElasticParameters, ElasticWall, PrescribedWall, Tethers,
};
use peristalsis_engine::{Bodies, Integrator, Kernel, Parameters, Simulation, Wall};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, LinearSpringDashpot, Normal, ViscoelasticHertz,
};
use peristalsis_physics::wall::{Lattice, Schedule, WallSphere};
use proptest::prelude::*;

mod common;

use common::states::{Row, State, Tube, lively, rows};
use common::{Numbers, momentum, wide};

/// Steps of 0.04: long enough for contacts to begin, slide and end.
const STEPS: u64 = 60;
/// Rounding differs between images, and contacts make the difference grow: measured up to 1e-11.
const ROUNDING: f64 = 1e-8;

fn row() -> impl Strategy<Value = Row> {
    prop::sample::select([Tube::Narrow, Tube::Wide, Tube::Elastic].map(rows).concat())
}

/// Packed grains of the row with velocities, spins and a body force drawn at random.
fn moving(row: Row, seed: u64) -> State {
    let mut state = lively(row);
    let mut numbers = Numbers(seed);
    for body in 0..state.bodies.grains {
        state.bodies.velocity[body] = numbers.vector(0.3);
        if state.parameters.contact.friction.is_some() {
            state.bodies.angular_velocity[body] = numbers.vector(0.5);
        }
    }
    state.parameters.body_force = 0.01 * (numbers.uniform() - 0.5);
    state
}

/// Where a sphere of the original is in the image: its number, and what becomes of places and of directions.
struct Image<'a> {
    state: State,
    number: &'a dyn Fn(usize) -> usize,
    place: &'a dyn Fn(DVec3) -> DVec3,
    velocity: &'a dyn Fn(DVec3) -> DVec3,
    spin: &'a dyn Fn(DVec3) -> DVec3,
    /// Length, velocity and spin of the image that are 1 in the original.
    units: [f64; 3],
}

/// Largest difference, in units of the original, between the image of where the original goes and where the image goes.
fn difference(original: &State, image: &Image<'_>) -> f64 {
    let after = |state: &State| {
        let mut simulation: Simulation = state.start(Kernel::Fast);
        simulation.advance(STEPS).expect("does not diverge");
        simulation
    };
    let (plain, other) = (after(original), after(&image.state));
    let (plain, found) = (plain.bodies(), other.bodies());
    let length = image.state.wall.length();
    let [place_unit, velocity_unit, spin_unit] = image.units;
    (0..plain.number())
        .map(|i| {
            let j = (image.number)(i);
            let mut place = (image.place)(plain.position[i]) - found.position[j];
            place.z -= length * (place.z / length).round();
            let velocity = (image.velocity)(plain.velocity[i]) - found.velocity[j];
            let spin = (image.spin)(plain.angular_velocity[i]) - found.angular_velocity[j];
            (place.length() / place_unit)
                .max(velocity.length() / velocity_unit)
                .max(spin.length() / spin_unit)
        })
        .fold(0.0, f64::max)
}

/// The bodies with every sphere mapped.
fn mapped(
    bodies: &Bodies,
    number: &dyn Fn(usize) -> usize,
    place: &dyn Fn(DVec3) -> DVec3,
    velocity: &dyn Fn(DVec3) -> DVec3,
    spin: &dyn Fn(DVec3) -> DVec3,
) -> Bodies {
    let mut image = bodies.clone();
    for i in 0..bodies.number() {
        let j = number(i);
        image.position[j] = place(bodies.position[i]);
        image.velocity[j] = velocity(bodies.velocity[i]);
        image.angular_velocity[j] = spin(bodies.angular_velocity[i]);
        image.diameter[j] = bodies.diameter[i];
        image.mass[j] = bodies.mass[i];
        image.inertia[j] = bodies.inertia[i];
    }
    image
}

/// Number of the sphere whose wall sphere is the image of another's; grains keep theirs.
fn on_the_wall(state: &State, image: impl Fn(&Lattice, WallSphere) -> WallSphere) -> Vec<usize> {
    let (lattice, grains) = (*state.wall.lattice().unwrap(), state.bodies.grains);
    (0..state.bodies.number())
        .map(|i| {
            if i < grains {
                i
            } else {
                grains + lattice.index(image(&lattice, lattice.sphere(i - grains)))
            }
        })
        .collect()
}

/// The wall with its wave turned round.
fn turned_round(wall: &Wall) -> Wall {
    match wall {
        Wall::Prescribed(wall) => {
            let wave = wall.wave();
            Wall::Prescribed(PrescribedWall::new(
                *wall.lattice(),
                wave.mean_radius,
                wave.waveform,
                -wave.heading,
                Schedule::constant(wave.amplitude),
                Schedule::constant(wall.frequency(0.0)),
            ))
        }
        Wall::Elastic(wall) => Wall::Elastic(ElasticWall::new(ElasticParameters {
            heading: -wall.parameters().heading,
            ..wall.parameters().clone()
        })),
    }
}

/// z -> -z with the wave and the body force turned round. Spins are axial vectors.
fn reversed(original: &State) -> f64 {
    let length = original.wall.length();
    let numbers = on_the_wall(original, |lattice, sphere| WallSphere {
        ring: (lattice.rings() - sphere.ring) % lattice.rings(),
        ..sphere
    });
    let number = |i: usize| numbers[i];
    let place = |r: DVec3| DVec3::new(r.x, r.y, if r.z == 0.0 { 0.0 } else { length - r.z });
    let velocity = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
    let spin = |s: DVec3| DVec3::new(-s.x, -s.y, s.z);
    let state = State {
        bodies: mapped(&original.bodies, &number, &place, &velocity, &spin),
        wall: turned_round(&original.wall),
        parameters: Parameters {
            body_force: -original.parameters.body_force,
            ..original.parameters
        },
    };
    let image = Image {
        state,
        number: &number,
        place: &place,
        velocity: &velocity,
        spin: &spin,
        units: [1.0; 3],
    };
    difference(original, &image)
}

/// y -> -y, a mirror through the axis.
fn mirrored(original: &State) -> f64 {
    let numbers = on_the_wall(original, |lattice, sphere| {
        let per_ring = lattice.spheres_per_ring;
        WallSphere {
            ring: sphere.ring,
            place: (2 * per_ring - sphere.place - sphere.ring % 2) % per_ring,
        }
    });
    let number = |i: usize| numbers[i];
    let vector = |v: DVec3| DVec3::new(v.x, -v.y, v.z);
    let spin = |s: DVec3| DVec3::new(-s.x, s.y, -s.z);
    rigidly(original, &number, &vector, &vector, &spin)
}

/// By so many steps of the lattice about the axis.
fn turned(original: &State, steps: u32) -> f64 {
    let per_ring = original.wall.lattice().unwrap().spheres_per_ring;
    let angle = core::f64::consts::TAU * f64::from(steps) / f64::from(per_ring);
    let (sin, cos) = libm::sincos(angle);
    let numbers = on_the_wall(original, |_, sphere| WallSphere {
        ring: sphere.ring,
        place: (sphere.place + steps) % per_ring,
    });
    let number = |i: usize| numbers[i];
    let vector = |v: DVec3| DVec3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z);
    rigidly(original, &number, &vector, &vector, &vector)
}

/// By a wavelength along the tube; one of an odd number of rings must be shifted by two, for the seam to close.
fn shifted(original: &State) -> f64 {
    let lattice = *original.wall.lattice().unwrap();
    let waves = 1 + lattice.rings_per_wave % 2;
    let numbers = on_the_wall(original, |lattice, sphere| WallSphere {
        ring: (sphere.ring + waves * lattice.rings_per_wave) % lattice.rings(),
        ..sphere
    });
    let number = |i: usize| numbers[i];
    let (length, shift) = (lattice.length(), f64::from(waves) * lattice.wavelength);
    // Within the tube: a wall sphere that has gone round it would pull at its tether.
    let place = |r: DVec3| DVec3::new(r.x, r.y, (r.z + shift).rem_euclid(length));
    rigidly(original, &number, &place, &|v| v, &|s| s)
}

/// Grains numbered in another order.
fn renumbered(original: &State) -> f64 {
    let grains = original.bodies.grains;
    // 7 divides no number of grains here.
    let number = |i: usize| if i < grains { (7 * i + 5) % grains } else { i };
    rigidly(original, &number, &|r| r, &|v| v, &|s| s)
}

fn rigidly(
    original: &State,
    number: &dyn Fn(usize) -> usize,
    place: &dyn Fn(DVec3) -> DVec3,
    velocity: &dyn Fn(DVec3) -> DVec3,
    spin: &dyn Fn(DVec3) -> DVec3,
) -> f64 {
    let state = State {
        bodies: mapped(&original.bodies, number, place, velocity, spin),
        ..original.clone()
    };
    let image = Image {
        state,
        number,
        place,
        velocity,
        spin,
        units: [1.0; 3],
    };
    difference(original, &image)
}

/// Units of length, mass and time that are so many of others.
#[derive(Clone, Copy, Debug)]
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

impl Units {
    fn stiffness(self) -> f64 {
        self.mass / (self.time * self.time)
    }

    fn damping(self) -> f64 {
        self.mass / self.time
    }

    fn lattice(self, lattice: Lattice) -> Lattice {
        Lattice {
            wavelength: self.length * lattice.wavelength,
            sphere_diameter: self.length * lattice.sphere_diameter,
            ..lattice
        }
    }

    fn wall(self, wall: &Wall) -> Wall {
        match wall {
            Wall::Prescribed(wall) => {
                let wave = wall.wave();
                Wall::Prescribed(PrescribedWall::new(
                    self.lattice(*wall.lattice()),
                    self.length * wave.mean_radius,
                    wave.waveform,
                    wave.heading,
                    Schedule::constant(self.length * wave.amplitude),
                    Schedule::constant(wall.frequency(0.0) / self.time),
                ))
            }
            Wall::Elastic(wall) => {
                let ours = wall.parameters();
                let network = &ours.network;
                let force = self.stiffness() * self.length;
                Wall::Elastic(ElasticWall::new(ElasticParameters {
                    lattice: self.lattice(ours.lattice),
                    mean_radius: self.length * ours.mean_radius,
                    network: ElasticNetwork {
                        sphere_mass: self.mass * network.sphere_mass,
                        spring_stiffness: self.stiffness() * network.spring_stiffness,
                        natural_length: self.length * network.natural_length,
                        spring_damping: self.damping() * network.spring_damping,
                        drag: self.damping() * network.drag,
                        contact_range: self.length * network.contact_range,
                        tethers: Tethers {
                            radial: self.stiffness() * network.tethers.radial,
                            azimuthal: self.stiffness() * network.tethers.azimuthal,
                            axial: self.stiffness() * network.tethers.axial,
                            ..network.tethers
                        },
                    },
                    force_amplitude: ours.force_amplitude.map(|value| force * value),
                    frequency: ours.frequency.map(|value| value / self.time),
                    ..ours.clone()
                }))
            }
        }
    }

    fn contact(self, contact: ContactModel) -> ContactModel {
        ContactModel {
            normal: if let Normal::Linear(law) = contact.normal {
                Normal::Linear(LinearSpringDashpot {
                    normal_stiffness: self.stiffness() * law.normal_stiffness,
                    normal_damping: self.damping() * law.normal_damping,
                })
            } else if let Normal::Hertz(law) = contact.normal {
                Normal::Hertz(ViscoelasticHertz {
                    young_modulus: self.stiffness() / self.length * law.young_modulus,
                    dissipation_time: self.time * law.dissipation_time,
                    ..law
                })
            } else {
                unreachable!("the states have these two laws")
            },
            friction: contact.friction.map(|law| CundallStrack {
                tangential_stiffness: self.stiffness() * law.tangential_stiffness,
                tangential_damping: self.damping() * law.tangential_damping,
                ..law
            }),
        }
    }
}

/// The same system in other units of length, mass and time.
fn in_other_units(original: &State, units: Units) -> f64 {
    let speed = units.length / units.time;
    let (place, velocity) = (|r: DVec3| units.length * r, |v: DVec3| speed * v);
    let spin = |s: DVec3| s / units.time;
    let number = |i: usize| i;
    let mut bodies = mapped(&original.bodies, &number, &place, &velocity, &spin);
    for i in 0..bodies.number() {
        bodies.diameter[i] *= units.length;
        bodies.mass[i] *= units.mass;
        bodies.inertia[i] *= units.mass * units.length * units.length;
    }
    let ours = &original.parameters;
    let state = State {
        bodies,
        wall: units.wall(&original.wall),
        parameters: Parameters {
            contact: units.contact(ours.contact),
            time_step: units.time * ours.time_step,
            skin: units.length * ours.skin,
            body_force: speed / units.time * ours.body_force,
            ..*ours
        },
    };
    let image = Image {
        state,
        number: &number,
        place: &place,
        velocity: &velocity,
        spin: &spin,
        units: [units.length, speed, 1.0 / units.time],
    };
    difference(original, &image)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn a_reversed_wave_and_a_mirror_and_a_turn(row in row(), seed: u64, steps in 1..5_u32) {
        let state = moving(row, seed);
        let found = [reversed(&state), mirrored(&state), turned(&state, steps)];
        prop_assert!(found.iter().all(|apart| *apart < ROUNDING), "{found:?}");
    }

    #[test]
    fn a_shift_and_other_numbers(row in row(), seed: u64) {
        let state = moving(row, seed);
        let found = [shifted(&state), renumbered(&state)];
        prop_assert!(found.iter().all(|apart| *apart < ROUNDING), "{found:?}");
    }

    #[test]
    fn other_units(
        row in row(),
        seed: u64,
        length in 0.01..100.0_f64,
        mass in 0.01..100.0_f64,
        time in 0.01..100.0_f64,
    ) {
        let state = moving(row, seed);
        let found = in_other_units(&state, Units { length, mass, time });
        prop_assert!(found < ROUNDING, "{found}");
    }

    /// Without a wall: momentum, angular momentum (velocity Verlet), and what an observer in motion sees.
    #[test]
    fn free_grains_keep_their_momenta_whoever_looks(row in row(), seed: u64, boost in -0.3..0.3_f64) {
        let mut state = moving(row, seed);
        state.parameters.body_force = 0.0;
        let grains = 20;
        let mut numbers = Numbers(seed);
        let places = (0..grains).map(|_| numbers.vector(1.3) + DVec3::new(0.0, 0.0, 10.0));
        let mut bodies = Bodies::grains_at_rest(places.collect(), vec![1.0; grains]);
        for body in 0..grains {
            bodies.velocity[body] = numbers.vector(0.1);
            if state.parameters.contact.friction.is_some() {
                bodies.angular_velocity[body] = numbers.vector(0.5);
            }
        }
        state.bodies = bodies;
        state.wall = wide(20.0);
        let mut boosted = state.clone();
        for velocity in &mut boosted.bodies.velocity {
            velocity.z += boost;
        }
        let (mut plain, mut other) = (state.start(Kernel::Fast), boosted.start(Kernel::Fast));
        let before = (momentum(plain.bodies()), angular_momentum(&plain));
        plain.advance(STEPS).expect("does not diverge");
        other.advance(STEPS).expect("does not diverge");
        let after = (momentum(plain.bodies()), angular_momentum(&plain));
        prop_assert!((after.0 - before.0).length() < 1e-12, "momentum {:?}", after.0 - before.0);
        if row.integrator == Integrator::Verlet {
            let change = (after.1 - before.1).length();
            prop_assert!(change < 1e-10, "angular momentum {change}");
        }
        for (one, seen) in plain.bodies().velocity.iter().zip(&other.bodies().velocity) {
            let apart = (*one + boost * DVec3::Z - *seen).length();
            prop_assert!(apart < ROUNDING, "seen in motion {apart}");
        }
    }
}

fn angular_momentum(simulation: &Simulation) -> DVec3 {
    let bodies = simulation.bodies();
    (0..bodies.number())
        .map(|i| {
            let z = bodies.unfolded(i, 20.0);
            let place = DVec3::new(bodies.position[i].x, bodies.position[i].y, z);
            bodies.mass[i] * place.cross(bodies.velocity[i])
                + bodies.inertia[i] * bodies.angular_velocity[i]
        })
        .sum()
}

/// What is no symmetry is seen: the relations above would notice a mistake.
#[test]
fn half_a_step_of_the_lattice_is_something_else() {
    let row = rows(Tube::Narrow)[0];
    let state = moving(row, 1);
    let angle = core::f64::consts::PI / f64::from(state.wall.lattice().unwrap().spheres_per_ring);
    let (sin, cos) = libm::sincos(angle);
    let vector = |v: DVec3| DVec3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z);
    assert!(rigidly(&state, &|i| i, &vector, &vector, &vector) > 1e-3);
    // And a body force that was forgotten.
    let heavier = Parameters {
        body_force: state.parameters.body_force + 0.01,
        ..state.parameters
    };
    let image = Image {
        state: State {
            parameters: heavier,
            ..state.clone()
        },
        number: &|i| i,
        place: &|r| r,
        velocity: &|v| v,
        spin: &|s| s,
        units: [1.0; 3],
    };
    assert!(difference(&state, &image) > 1e-3);
}
