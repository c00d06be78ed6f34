//! Images of a system: mirrored, turned, shifted, renumbered, in other units. Each goes the image of its way, over every
//! combination of laws, sizes, tube and integrator, by the fast kernels.

use glam::DMat3;
use peristalsis_physics::wall::WallSphere;
use proptest::prelude::*;

mod common;

use common::*;

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
    state.parameters.body_force = numbers.vector(0.005);
    state
}

/// What becomes of a system: its spheres have other numbers; places and directions are turned or mirrored, shifted along the
/// tube, and in other units.
struct Map {
    /// Number of each sphere in the image.
    numbers: Vec<usize>,
    turn: DMat3,
    shift: f64,
    units: Units,
    /// How long both go their way.
    steps: u64,
}

impl Map {
    /// Turns or mirrors; `image` is the wall sphere that a wall sphere comes to stand on. Grains keep their numbers.
    fn of(state: &State, turn: DMat3, image: impl Fn(&Lattice, WallSphere) -> WallSphere) -> Self {
        let (lattice, grains) = (
            *state.wall.lattice().expect("a wall of spheres"),
            state.bodies.grains,
        );
        let of_wall = (0..state.bodies.number() - grains)
            .map(|sphere| grains + lattice.index(image(&lattice, lattice.sphere(sphere))));
        Self {
            numbers: (0..grains).chain(of_wall).collect(),
            turn,
            shift: 0.0,
            units: Units {
                length: 1.0,
                mass: 1.0,
                time: 1.0,
            },
            steps: STEPS,
        }
    }

    fn identity(state: &State) -> Self {
        Self::of(state, DMat3::IDENTITY, |_, sphere| sphere)
    }

    fn place(&self, place: DVec3) -> DVec3 {
        self.units.length * (self.turn * place + self.shift * DVec3::Z)
    }

    fn velocity(&self, velocity: DVec3) -> DVec3 {
        self.units.length / self.units.time * (self.turn * velocity)
    }

    /// Spins are axial vectors.
    fn spin(&self, spin: DVec3) -> DVec3 {
        self.turn.determinant().signum() / self.units.time * (self.turn * spin)
    }

    fn bodies(&self, bodies: &Bodies, length: f64) -> Bodies {
        let mut image = bodies.clone();
        let Units {
            length: d, mass, ..
        } = self.units;
        for (i, &j) in self.numbers.iter().enumerate() {
            let mut place = self.place(bodies.position[i]);
            // Within the tube: a wall sphere that has gone round it would pull at its tether.
            place.z = place.z.rem_euclid(length);
            image.position[j] = place;
            image.velocity[j] = self.velocity(bodies.velocity[i]);
            image.angular_velocity[j] = self.spin(bodies.angular_velocity[i]);
            image.diameter[j] = d * bodies.diameter[i];
            image.mass[j] = mass * bodies.mass[i];
            image.inertia[j] = mass * d * d * bodies.inertia[i];
        }
        image
    }

    /// Largest difference, in units of the original, between the image of where the original goes and where its image
    /// goes in `wall` with `parameters`.
    fn difference(&self, original: &State, wall: Wall, parameters: Parameters) -> f64 {
        let length = wall.length();
        let image = State {
            bodies: self.bodies(&original.bodies, length),
            wall,
            parameters,
        };
        let [plain, found] = [original, &image].map(|state| {
            let mut simulation = state.start(Kernel::Fast);
            simulation.advance(self.steps).expect("does not diverge");
            simulation.bodies().clone()
        });
        let Units {
            length: d, time, ..
        } = self.units;
        let apart = self.numbers.iter().enumerate().map(|(i, &j)| {
            let mut place = self.place(plain.position[i]) - found.position[j];
            place.z -= length * (place.z / length).round();
            let velocity = self.velocity(plain.velocity[i]) - found.velocity[j];
            let spin = self.spin(plain.angular_velocity[i]) - found.angular_velocity[j];
            let moved = (place.length() / d).max(velocity.length() * time / d);
            moved.max(spin.length() * time)
        });
        apart.fold(0.0, f64::max)
    }

    /// The same in the wall of the original.
    fn in_place(&self, original: &State) -> f64 {
        let parameters = self.parameters(&original.parameters);
        self.difference(original, original.wall.clone(), parameters)
    }

    /// The same laws and steps, with the body force turned.
    fn parameters(&self, original: &Parameters) -> Parameters {
        Parameters {
            body_force: self.velocity(original.body_force) / self.units.time,
            ..*original
        }
    }
}

/// The wall with its wave turned round.
fn turned_round(wall: &Wall) -> Wall {
    match wall {
        Wall::Prescribed(wall) => {
            let wave = wall.wave();
            waving(
                *wall.lattice().expect("a wall of rings"),
                wave.mean_radius,
                wave.contraction,
                -wave.heading,
                Schedule::constant(wave.amplitude),
                Schedule::constant(wall.frequency(0.0)),
            )
        }
        Wall::Elastic(wall) => elastic(ElasticParameters {
            heading: -wall.parameters().heading,
            ..wall.parameters().clone()
        }),
    }
}

/// z -> -z with the wave and the body force turned round.
fn reversed(original: &State, steps: u64) -> f64 {
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let map = Map {
        shift: original.wall.length(),
        steps,
        ..Map::of(original, mirror, |lattice, sphere| WallSphere {
            ring: (lattice.rings() - sphere.ring) % lattice.rings(),
            ..sphere
        })
    };
    let parameters = map.parameters(&original.parameters);
    map.difference(original, turned_round(&original.wall), parameters)
}

/// y -> -y, a mirror through the axis.
fn mirrored(original: &State) -> f64 {
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
    let map = Map::of(original, mirror, |lattice, sphere| {
        let per_ring = lattice.spheres_per_ring;
        WallSphere {
            ring: sphere.ring,
            place: (2 * per_ring - sphere.place - sphere.ring % 2) % per_ring,
        }
    });
    map.in_place(original)
}

/// By so many steps of the lattice about the axis.
fn turned(original: &State, steps: u32) -> f64 {
    let per_ring = original
        .wall
        .lattice()
        .expect("a wall of spheres")
        .spheres_per_ring;
    let angle = core::f64::consts::TAU * f64::from(steps) / f64::from(per_ring);
    let turn = DMat3::from_rotation_z(angle);
    let map = Map::of(original, turn, |_, sphere| WallSphere {
        ring: sphere.ring,
        place: (sphere.place + steps) % per_ring,
    });
    map.in_place(original)
}

/// By a wavelength along the tube; one of an odd number of rings must be shifted by two, for the seam to close.
fn shifted(original: &State) -> f64 {
    let rings_per_wave = original
        .wall
        .lattice()
        .expect("a wall of spheres")
        .rings_per_wave;
    let waves = 1 + rings_per_wave % 2;
    let map = Map {
        shift: f64::from(waves) * original.wall.wavelength(),
        ..Map::of(original, DMat3::IDENTITY, |lattice, sphere| WallSphere {
            ring: (sphere.ring + waves * rings_per_wave) % lattice.rings(),
            ..sphere
        })
    };
    map.in_place(original)
}

/// Grains numbered in another order.
fn renumbered(original: &State) -> f64 {
    let grains = original.bodies.grains;
    let mut map = Map::identity(original);
    // 7 divides no number of grains here.
    for number in &mut map.numbers[..grains] {
        *number = (7 * *number + 5) % grains;
    }
    map.in_place(original)
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
                    self.lattice(*wall.lattice().expect("a wall of rings")),
                    self.length * wave.mean_radius,
                    wave.contraction,
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
            ..contact
        }
    }
}

/// The same system in other units of length, mass and time.
fn in_other_units(original: &State, units: Units) -> f64 {
    let map = Map {
        units,
        ..Map::identity(original)
    };
    let ours = &original.parameters;
    let parameters = Parameters {
        contact: units.contact(ours.contact),
        time_step: units.time * ours.time_step,
        skin: units.length * ours.skin,
        ..map.parameters(ours)
    };
    map.difference(original, units.wall(&original.wall), parameters)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn a_reversed_wave_and_a_mirror_and_a_turn(row in row(), seed: u64, steps in 1..5_u32) {
        let state = moving(row, seed);
        let found = [reversed(&state, STEPS), mirrored(&state), turned(&state, steps)];
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
        state.parameters.body_force = DVec3::ZERO;
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
        let before = (momentum(plain.bodies()), angular_momentum(plain.bodies(), 20.0));
        plain.advance(STEPS).expect("does not diverge");
        other.advance(STEPS).expect("does not diverge");
        let after = (momentum(plain.bodies()), angular_momentum(plain.bodies(), 20.0));
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

/// Over three periods of the wave.
#[test]
fn the_mirror_image_flows_the_other_way() {
    for row in rows(Tube::Narrow) {
        let apart = reversed(&moving(row, 9), 750);
        assert!(apart < 10.0 * ROUNDING, "{row:?}: {apart}");
    }
}

/// What is no symmetry is seen: the relations above would notice a mistake.
#[test]
fn half_a_step_of_the_lattice_is_something_else() {
    let row = rows(Tube::Narrow)[0];
    let state = moving(row, 1);
    let angle = core::f64::consts::PI
        / f64::from(
            state
                .wall
                .lattice()
                .expect("a wall of spheres")
                .spheres_per_ring,
        );
    let half_turned = Map {
        turn: DMat3::from_rotation_z(angle),
        ..Map::identity(&state)
    };
    assert!(half_turned.in_place(&state) > 1e-3);
    // And a body force that was forgotten.
    let heavier = Parameters {
        body_force: state.parameters.body_force + 0.01 * DVec3::X,
        ..state.parameters
    };
    let apart = Map::identity(&state).difference(&state, state.wall.clone(), heavier);
    assert!(apart > 1e-3);
}
