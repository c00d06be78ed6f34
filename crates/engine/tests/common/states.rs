//! Every combination of laws, sizes, tube and integrator, and random states of each.

use peristalsis_engine::wall::Scattered;

use super::*;

/// What surrounds the grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tube {
    /// Prescribed, some two grains wide.
    Narrow,
    /// As narrow, of spheres that stand anywhere.
    Scattered,
    /// As narrow, without spheres.
    Smooth,
    /// Prescribed, ten grains wide, with waves of several grains across.
    Wide,
    /// Of mobile spheres.
    Elastic,
}

/// One way to put a simulation together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) tube: Tube,
    pub(crate) normal: Normal,
    pub(crate) sliding: Option<Sliding>,
    pub(crate) alike: bool,
    pub(crate) integrator: Integrator,
}

/// {linear, hertz printed, hertz viscoelastic} x {smooth, three forms of sliding} x {mono-, polydisperse} x {Verlet,
/// Adams-Bashforth}, in a tube.
pub(crate) fn rows(tube: Tube) -> Vec<Row> {
    let hertz = |dissipation_form| {
        Normal::Hertz(ViscoelasticHertz {
            young_modulus: 1.0,
            poisson_ratio: 0.5,
            dissipation_time: 0.1,
            dissipation_form,
        })
    };
    let normals = [
        LINEAR,
        hertz(DissipationForm::Printed),
        hertz(DissipationForm::Viscoelastic),
    ];
    let slidings = [
        None,
        Some(Sliding::Spring),
        Some(Sliding::Balance),
        Some(Sliding::Literal),
    ];
    let mut rows = Vec::new();
    for normal in normals {
        for sliding in slidings {
            for alike in [true, false] {
                for integrator in INTEGRATORS {
                    rows.push(Row {
                        tube,
                        normal,
                        sliding,
                        alike,
                        integrator,
                    });
                }
            }
        }
    }
    rows
}

/// A simulation that can be begun with any kernel.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) bodies: Bodies,
    pub(crate) wall: Wall,
    pub(crate) parameters: Parameters,
}

impl State {
    pub(crate) fn with(&self, kernel: Kernel) -> Parameters {
        Parameters {
            kernel,
            ..self.parameters
        }
    }

    pub(crate) fn start(&self, kernel: Kernel) -> Simulation {
        Simulation::new(self.bodies.clone(), self.wall.clone(), self.with(kernel))
    }

    /// Goes on from the state of `other` with a kernel.
    pub(crate) fn go_on(&self, other: &Simulation, kernel: Kernel) -> Simulation {
        Simulation::restore(other.snapshot(), self.wall.clone(), self.with(kernel))
            .expect("kernels take each other's snapshots")
    }
}

impl Numbers {
    fn between(&mut self, least: f64, largest: f64) -> f64 {
        least + (largest - least) * self.uniform()
    }

    fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.uniform() * of.len() as f64) as usize]
    }

    fn happens(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// 0, or up to `largest`.
    fn perhaps(&mut self, largest: f64) -> f64 {
        if self.happens(0.4) {
            0.0
        } else {
            self.between(0.0, largest)
        }
    }

    /// A constant, a ramp or a jump about `value` within the first 20 steps.
    fn schedule(&mut self, value: f64, time_step: f64) -> Schedule {
        if self.happens(0.7) {
            return Schedule::constant(value);
        }
        // Between two steps, never on one.
        let start = time_step * ((20.0 * self.uniform()).floor() + 0.5);
        let end = start + time_step * self.perhaps(10.0);
        let other = value * self.uniform();
        Schedule::through(vec![(0.0, value), (start, value), (end, other)]).expect("in order")
    }
}

/// Grains packed into a tube of the row's kind, that move as a wave would have them move.
pub(crate) fn lively(row: Row) -> State {
    let (wall, number) = match row.tube {
        Tube::Narrow | Tube::Scattered => (strained(coarse(2), -1.0, 2.6, 0.1), 60),
        Tube::Smooth => (smooth(strained(coarse(2), -1.0, 2.6, 0.1)), 60),
        Tube::Wide => {
            let lattice = lattice(34, 22, 1, 20.0);
            (prescribed(lattice, 5.0, 1.0, 1.5, 0.02), 300)
        }
        Tube::Elastic => (elastic(elastic_parameters()), 120),
    };
    let diameter_min = if row.alike { 1.0 } else { 0.8 };
    let mut bodies = packed(number, diameter_min, &wall, LINEAR, 7);
    let mut numbers = Numbers(3);
    for velocity in &mut bodies.velocity[..number] {
        *velocity = numbers.vector(0.3);
    }
    let friction = row.sliding.map(|sliding| CundallStrack {
        sliding,
        ..FRICTION
    });
    State {
        bodies,
        wall,
        parameters: parameters(row.normal, friction, row.integrator, 0.04),
    }
}

/// So many grains at random places, among them those where mistakes would hide, with random velocities, in a random tube
/// of the row's kind.
pub(crate) fn random(row: Row, number: usize, seed: u64) -> State {
    let numbers = &mut Numbers(seed);
    let time_step = numbers.one_of(&[0.05, 0.01]);
    let static_friction = numbers.perhaps(1.0);
    let friction = row.sliding.map(|sliding| CundallStrack {
        static_friction,
        kinetic_friction: static_friction * numbers.uniform(),
        sliding,
        ..FRICTION
    });
    let (wall, radius) = match row.tube {
        Tube::Narrow => (narrow_tube(numbers, time_step), 1.5),
        Tube::Scattered => (scattered_tube(numbers, time_step), 1.5),
        Tube::Smooth => (smooth(narrow_tube(numbers, time_step)), 1.5),
        Tube::Wide => (wide_tube(numbers, time_step), 5.0),
        Tube::Elastic => springy(numbers, time_step),
    };
    let mut bodies = scattered(numbers, number, row.alike, radius, wall.length());
    if let Wall::Elastic(elastic) = &wall {
        add_wall_spheres(&mut bodies, elastic, numbers);
    }
    for body in 0..bodies.number() {
        bodies.velocity[body] = numbers.vector(0.7);
        if friction.is_some() && body < number {
            bodies.angular_velocity[body] = numbers.vector(1.0);
        }
    }
    State {
        bodies,
        wall,
        parameters: Parameters {
            contact: ContactModel::new(row.normal, friction),
            integrator: row.integrator,
            time_step,
            skin: numbers.one_of(&[0.02, 0.3, 0.7]),
            kernel: Kernel::Reference,
            body_force: numbers.one_of(&[
                DVec3::ZERO,
                DVec3::new(0.0, 0.0, -0.03),
                DVec3::new(0.01, -0.02, 0.005),
            ]),
        },
    }
}

/// A prescribed tube of radius 1.5: fine, coarse, of one wave, and barely longer than two spheres.
fn narrow_tube(numbers: &mut Numbers, time_step: f64) -> Wall {
    let mut lattice = numbers.one_of(&[
        lattice(24, 26, 2, 10.0),
        lattice(24, 26, 1, 10.0),
        lattice(12, 14, 1, 10.0),
        lattice(12, 14, 3, 10.0),
        lattice(5, 8, 1, 10.0),
        lattice(17, 13, 2, 10.0),
        lattice(17, 13, 4, 10.0),
        lattice(12, 6, 1, 2.62),
        lattice(12, 2, 1, 2.05),
    ]);
    lattice.staggered = numbers.happens(0.6);
    let amplitude = numbers.perhaps(1.5);
    driven(numbers, lattice, 1.5, amplitude, time_step)
}

/// A prescribed tube of radius 1.5 whose spheres stand anywhere.
fn scattered_tube(numbers: &mut Numbers, time_step: f64) -> Wall {
    let lattice = numbers.one_of(&[lattice(12, 14, 1, 10.0), lattice(24, 26, 2, 10.0)]);
    let amplitude = numbers.perhaps(1.5);
    let wall = driven(numbers, lattice, 1.5, amplitude, time_step);
    let spheres = match numbers.happens(0.5) {
        true => Scattered::random(&lattice, 3),
        false => Scattered::disordered(&lattice, 1.5, 3),
    };
    match wall {
        Wall::Prescribed(wall) => Wall::Prescribed(wall.with(spheres)),
        elastic => elastic,
    }
}

/// A prescribed tube of radius 5.
fn wide_tube(numbers: &mut Numbers, time_step: f64) -> Wall {
    let lattice = Lattice {
        spheres_per_ring: numbers.one_of(&[31, 36, 50]),
        rings_per_wave: numbers.one_of(&[16, 20]),
        waves: numbers.one_of(&[1, 2]),
        wavelength: 14.0,
        sphere_diameter: 1.0,
        staggered: true,
    };
    let amplitude = numbers.between(0.5, 4.8);
    driven(numbers, lattice, 5.0, amplitude, time_step)
}

fn driven(
    numbers: &mut Numbers,
    lattice: Lattice,
    radius: f64,
    amplitude: f64,
    time_step: f64,
) -> Wall {
    // Fast enough to have any phase when the grains have moved a few steps.
    let frequency = numbers.perhaps(0.5);
    waving(
        lattice,
        radius,
        numbers.one_of(&[
            Waveform::Sine.into(),
            Waveform::Bolus.into(),
            Waveform::Roller.into(),
            segments(),
            tabled(),
        ]),
        numbers.one_of(&[1.0, -1.0]),
        numbers.schedule(amplitude, time_step),
        numbers.schedule(frequency, time_step),
    )
}

/// An elastic tube and its radius.
fn springy(numbers: &mut Numbers, time_step: f64) -> (Wall, f64) {
    let (spheres_per_ring, rings_per_wave, waves) = numbers.one_of(&[
        (5, 3, 2),
        (7, 4, 1),
        (8, 6, 1),
        (9, 5, 2),
        (12, 8, 1),
        (16, 12, 2),
        (17, 4, 2),
        (22, 11, 2),
    ]);
    let chord = numbers.between(0.8, 1.2);
    let spacing = chord * numbers.between(0.7, 1.0);
    let radius = chord * f64::from(spheres_per_ring) / core::f64::consts::TAU;
    let (force, frequency) = (numbers.perhaps(0.05), numbers.perhaps(0.5));
    let parameters = ElasticParameters {
        lattice: Lattice {
            spheres_per_ring,
            rings_per_wave,
            waves,
            wavelength: spacing * f64::from(rings_per_wave),
            sphere_diameter: numbers.one_of(&[1.0, 0.8]),
            staggered: true,
        },
        mean_radius: radius,
        network: ElasticNetwork {
            sphere_mass: numbers.between(0.1, 0.5),
            spring_stiffness: numbers.between(0.005, 0.1),
            natural_length: numbers.between(0.5, 1.1),
            spring_damping: numbers.perhaps(0.05),
            drag: numbers.perhaps(0.05),
            contact_range: numbers.between(1.2, 3.0),
            tethers: Tethers {
                balance: numbers.happens(0.5),
                radial: numbers.perhaps(0.1),
                azimuthal: numbers.perhaps(0.1),
                axial: numbers.perhaps(0.1),
                net_force: numbers.one_of(&[
                    NetForce::Free,
                    NetForce::Removed,
                    NetForce::RemovedPerRing,
                ]),
            },
        },
        force_amplitude: numbers.schedule(force, time_step),
        frequency: numbers.schedule(frequency, time_step),
        heading: numbers.one_of(&[1.0, -1.0]),
        waveform: numbers.one_of(&Waveform::ALL),
        angle: numbers.one_of(&[DriveAngle::Reference, DriveAngle::Current]),
    };
    (Wall::Elastic(ElasticWall::new(parameters)), radius)
}

/// The spheres of an elastic wall, shaken, often about a throat so close that opposite sides touch.
fn add_wall_spheres(bodies: &mut Bodies, wall: &ElasticWall, numbers: &mut Numbers) {
    let length = wall.lattice().length();
    let (depth, throat) = (numbers.perhaps(0.95), numbers.between(0.0, length));
    let on_axis = numbers.happens(0.2);
    for sphere in 0..wall.lattice().spheres() {
        let mut place = wall.reference(sphere);
        let from_throat = place.z - throat;
        let narrower = 1.0 - depth * libm::exp(-from_throat * from_throat);
        (place.x, place.y) = (place.x * narrower, place.y * narrower);
        place += numbers.vector(0.15);
        if on_axis && sphere == 0 {
            // Where no radius has a direction.
            (place.x, place.y) = (0.0, 0.0);
        }
        bodies.push_wall_sphere(
            place,
            wall.lattice().sphere_diameter,
            wall.parameters().network.sphere_mass,
        );
    }
}

fn scattered(
    numbers: &mut Numbers,
    number: usize,
    alike: bool,
    tube_radius: f64,
    length: f64,
) -> Bodies {
    // All along the tube, or so close together that most touch.
    let stretch = length * numbers.between(0.1, 1.0);
    let mut position = Vec::with_capacity(number);
    for grain in 0..number {
        let inside = tube_radius * numbers.uniform().sqrt();
        let radius = match (12.0 * numbers.uniform()) as u32 {
            0 => 0.0,
            1 => tube_radius + numbers.between(-0.9, 0.9),
            2 => tube_radius + numbers.between(0.6, 3.0),
            _ => inside,
        };
        let angle = core::f64::consts::TAU * numbers.uniform();
        let anywhere = stretch * numbers.uniform();
        let z = match (16.0 * numbers.uniform()) as u32 {
            0 => numbers.one_of(&[0.0, length, -1e-18]),
            1 => numbers.one_of(&[-1.0, 1.0]) * 1e-13,
            2 => length + numbers.one_of(&[-1.0, 1.0]) * 1e-9,
            3 => numbers.between(-1.0, 2.0) * length,
            _ => anywhere,
        };
        let mut place = DVec3::new(radius * libm::cos(angle), radius * libm::sin(angle), z);
        if grain > 0 && numbers.happens(0.05) {
            // Right in another.
            place = position[grain - 1];
        }
        position.push(place);
    }
    let diameter = (0..number)
        .map(|_| {
            if alike {
                1.0
            } else {
                numbers.between(0.6, 1.0)
            }
        })
        .collect();
    Bodies::grains_at_rest(position, diameter)
}
