//! What the tests of the engine share: laws, tubes, grains and ways to compare states.

// Each test program uses its own part.
#![allow(dead_code, unused_imports)]

pub(crate) mod apart;
pub(crate) mod states;

pub(crate) use glam::DVec3;
pub(crate) use peristalsis_engine::initial::{InitialState, Packing, pack};
pub(crate) use peristalsis_engine::wall::{
    DriveAngle, ElasticNetwork, ElasticParameters, ElasticWall, NetForce, PrescribedWall, Tethers,
};
pub(crate) use peristalsis_engine::{
    Bodies, EngineError, Instructions, Integrator, Kernel, Parameters, Simulation, Wall,
};
pub(crate) use peristalsis_physics::contact::{
    Cohesion, ContactModel, CundallStrack, DissipationForm, LinearSpringDashpot, Normal, PullOff,
    RollingResistance, Sliding, ViscoelasticHertz,
};
pub(crate) use peristalsis_physics::sizes::Sizes;
pub(crate) use peristalsis_physics::wall::{
    Contraction, Lattice, RadiusTable, Schedule, SegmentDrive, Segments, Waveform,
};

pub(crate) use self::apart::Apart;
pub(crate) use self::states::{Row, State, Tube, lively, random, rows};

/// Both integrators.
pub(crate) const INTEGRATORS: [Integrator; 2] = [Integrator::Verlet, Integrator::AdamsBashforth];

/// The normal law of the frictionless preset.
pub(crate) const LINEAR: Normal = Normal::Linear(linear(1.0, 5.48e-3));

/// The normal law of the frictional preset.
pub(crate) const HERTZ: Normal = Normal::Hertz(ViscoelasticHertz {
    young_modulus: 1.0,
    poisson_ratio: 0.5,
    dissipation_time: 0.1,
    dissipation_form: DissipationForm::Viscoelastic,
});

/// The tangential law of the frictional preset.
pub(crate) const FRICTION: CundallStrack = CundallStrack {
    tangential_stiffness: 1.0,
    tangential_damping: 0.1,
    static_friction: 0.5,
    kinetic_friction: 0.4,
    sliding: Sliding::Spring,
};

/// With one coefficient forces are continuous where a contact begins to slide.
const ONE_FRICTION: CundallStrack = CundallStrack {
    static_friction: 0.4,
    ..FRICTION
};

const ROLLING: RollingResistance = RollingResistance {
    rolling_friction: 0.1,
    rolling_stiffness: 0.8,
    rolling_damping: 0.05,
};

/// A pull that is constant in contact and reaches beyond it.
pub(crate) const PULL: Cohesion = Cohesion {
    cohesion_force: 1e-3,
    cohesion_range: 0.02,
    surface_energy: 0.0,
    pull_off: PullOff::Displacement,
};

const JKR: Cohesion = Cohesion {
    cohesion_force: 0.0,
    cohesion_range: 0.0,
    surface_energy: 3e-4,
    pull_off: PullOff::Displacement,
};

/// The same, which breaks at the pull-off force.
const JKR_FORCE: Cohesion = Cohesion {
    pull_off: PullOff::Force,
    ..JKR
};

pub(crate) fn parameters(
    normal: Normal,
    friction: Option<CundallStrack>,
    integrator: Integrator,
    time_step: f64,
) -> Parameters {
    let contact = ContactModel::new(normal, friction);
    parameters_with(contact, integrator, time_step)
}

pub(crate) fn parameters_with(
    contact: ContactModel,
    integrator: Integrator,
    time_step: f64,
) -> Parameters {
    Parameters {
        contact,
        integrator,
        time_step,
        skin: 0.3,
        kernel: Kernel::default(),
        body_force: DVec3::ZERO,
    }
}

/// The coarse lattice of the frictionless preset.
pub(crate) fn coarse(waves: u32) -> Lattice {
    lattice(12, 14, waves, 10.0)
}

/// A lattice of spheres of diameter 1.
pub(crate) const fn lattice(
    spheres_per_ring: u32,
    rings_per_wave: u32,
    waves: u32,
    wavelength: f64,
) -> Lattice {
    Lattice {
        spheres_per_ring,
        rings_per_wave,
        waves,
        wavelength,
        sphere_diameter: 1.0,
        staggered: true,
    }
}

/// A strain-controlled tube of mean radius 1.5.
pub(crate) fn strained(lattice: Lattice, heading: f64, width: f64, strain_rate: f64) -> Wall {
    prescribed(lattice, 1.5, heading, 1.5 - 0.5 * width, strain_rate)
}

/// A strain-controlled tube.
pub(crate) fn prescribed(
    lattice: Lattice,
    mean_radius: f64,
    heading: f64,
    amplitude: f64,
    strain_rate: f64,
) -> Wall {
    let (amplitude, frequency) = (
        Schedule::constant(amplitude),
        Schedule::constant(strain_rate),
    );
    waving(
        lattice,
        mean_radius,
        Waveform::Sine,
        heading,
        amplitude,
        frequency,
    )
}

/// Three segments that close out of their order.
pub(crate) fn segments() -> Contraction {
    let drive = SegmentDrive {
        segments: 3,
        order: vec![1, 3, 2],
        duty: 0.3,
        rise: 0.2,
        fall: 0.1,
        edge: 0.4,
    };
    Contraction::Segments(Segments::new(&drive).expect("a cycle"))
}

/// A wave that a table gives.
pub(crate) fn tabled() -> Contraction {
    let table = RadiusTable::new(&[0.0, 0.2, 0.35, 0.6, 0.9], &[1.0, 0.9, 0.4, 0.7, 1.0]);
    Contraction::Table(table.expect("a curve"))
}

/// A strain-controlled tube of any waveform that follows schedules.
pub(crate) fn waving(
    lattice: Lattice,
    mean_radius: f64,
    contraction: impl Into<Contraction>,
    heading: f64,
    amplitude: Schedule,
    frequency: Schedule,
) -> Wall {
    let wall = PrescribedWall::new(
        lattice,
        mean_radius,
        contraction,
        heading,
        amplitude,
        frequency,
    );
    Wall::Prescribed(wall)
}

/// A prescribed tube without its spheres.
pub(crate) fn smooth(wall: Wall) -> Wall {
    match wall {
        Wall::Prescribed(wall) => Wall::Prescribed(wall.smooth()),
        elastic => elastic,
    }
}

/// A straight tube whose wall is too far away to be touched.
pub(crate) fn wide(length: f64) -> Wall {
    prescribed(lattice(60, 2, 1, length), 10.0, -1.0, 0.0, 0.1)
}

/// The laws of both presets and what lies between; every kind of cohesion; each without rolling resistance and with it.
pub(crate) fn laws() -> Vec<(String, ContactModel)> {
    let mut laws = Vec::new();
    for (name, normal, cohesion) in [
        ("linear", LINEAR, None),
        ("hertz", HERTZ, None),
        ("linear, pull", LINEAR, Some(PULL)),
        ("hertz, pull", HERTZ, Some(PULL)),
        ("hertz, JKR", HERTZ, Some(JKR)),
        ("hertz, JKR by force", HERTZ, Some(JKR_FORCE)),
    ] {
        let smooth = ContactModel {
            cohesion,
            ..ContactModel::new(normal, None)
        };
        let rolling = ContactModel {
            friction: Some(ONE_FRICTION),
            rolling: Some(ROLLING),
            ..smooth
        };
        laws.push((format!("{name}, smooth"), smooth));
        laws.push((format!("{name}, rolling"), rolling));
        if cohesion.is_none() {
            let rough = ContactModel::new(normal, Some(FRICTION));
            laws.push((format!("{name}, rough"), rough));
        }
    }
    laws
}

/// These laws with both integrators; those that only the reference kernel computes, with one.
pub(crate) fn methods() -> impl Iterator<Item = (String, ContactModel, Integrator)> {
    laws().into_iter().flat_map(|(name, model)| {
        let integrators = if model.is_general() { 1 } else { 2 };
        let both = INTEGRATORS.into_iter().take(integrators);
        both.map(move |integrator| (name.clone(), model, integrator))
    })
}

/// Whether its contacts lose the energy of cohesion when they break.
pub(crate) fn breaks(model: &ContactModel) -> bool {
    model.cohesion.is_some_and(|it| it.is_jkr())
}

/// Both kernels.
pub(crate) const KERNELS: [Kernel; 2] = [Kernel::Fast, Kernel::Reference];

/// The kernels that compute a law: rolling resistance and cohesion only the reference.
pub(crate) fn kernels_of(model: &ContactModel) -> &'static [Kernel] {
    &KERNELS[usize::from(model.is_general())..]
}

/// A small elastic tube, with all that keeps the one of the frictional preset.
pub(crate) fn elastic_parameters() -> ElasticParameters {
    ElasticParameters {
        lattice: lattice(16, 12, 2, 10.4),
        mean_radius: 2.5,
        network: ElasticNetwork::default(),
        force_amplitude: Schedule::constant(0.005),
        frequency: Schedule::constant(0.02),
        heading: 1.0,
        waveform: Waveform::Sine,
        angle: DriveAngle::Reference,
    }
}

/// The same with changes.
pub(crate) fn elastic_with(change: impl FnOnce(&mut ElasticParameters)) -> ElasticParameters {
    let mut parameters = elastic_parameters();
    change(&mut parameters);
    parameters
}

pub(crate) fn elastic(parameters: ElasticParameters) -> Wall {
    Wall::Elastic(ElasticWall::new(parameters))
}

/// Grains of diameter 1 at the given places with the given velocities.
pub(crate) fn grains(states: &[(DVec3, DVec3)]) -> Bodies {
    let position = states.iter().map(|state| state.0).collect();
    let mut bodies = Bodies::grains_at_rest(position, vec![1.0; states.len()]);
    for (velocity, state) in bodies.velocity.iter_mut().zip(states) {
        *velocity = state.1;
    }
    bodies
}

/// Appends the spheres of an elastic wall at their reference places.
pub(crate) fn with_wall_spheres(mut bodies: Bodies, wall: &Wall) -> Bodies {
    wall.append_spheres(&mut bodies);
    bodies
}

/// Grains at rest in a tube, of diameters between `diameter_min` and 1.
pub(crate) fn packed(
    number: usize,
    diameter_min: f64,
    wall: &Wall,
    normal: Normal,
    seed: u64,
) -> Bodies {
    let packing = Packing {
        number,
        sizes: Sizes::Uniform([diameter_min, 1.0]),
        state: InitialState::Rest,
        axial_velocity: 0.0,
        temperature: 0.0,
        seed,
    };
    pack(&packing, wall, normal).expect("the grains fit").0
}

/// Grains so many steps on.
pub(crate) fn advanced(
    bodies: &Bodies,
    wall: &Wall,
    parameters: Parameters,
    steps: u64,
) -> Simulation {
    let mut simulation = Simulation::new(bodies.clone(), wall.clone(), parameters);
    simulation.advance(steps).expect("does not diverge");
    simulation
}

/// A linear law.
pub(crate) const fn linear(normal_stiffness: f64, normal_damping: f64) -> LinearSpringDashpot {
    LinearSpringDashpot {
        normal_stiffness,
        normal_damping,
    }
}

/// All positions, velocities and spins.
pub(crate) fn motion(bodies: &Bodies) -> Vec<DVec3> {
    let vectors = bodies.position.iter().chain(&bodies.velocity);
    vectors.chain(&bodies.angular_velocity).copied().collect()
}

/// The length of the longest.
pub(crate) fn longest(vectors: &[DVec3]) -> f64 {
    vectors
        .iter()
        .fold(0.0, |most, vector| most.max(vector.length()))
}

/// The bits of everything that moves.
pub(crate) fn bits(simulation: &Simulation) -> Vec<u64> {
    let vectors = motion(simulation.bodies()).into_iter();
    vectors
        .flat_map(|vector| vector.to_array())
        .map(f64::to_bits)
        .collect()
}

/// Total angular momentum about the axis of a tube of length `length`.
pub(crate) fn angular_momentum(bodies: &Bodies, length: f64) -> DVec3 {
    (0..bodies.number())
        .map(|i| {
            let place = bodies.position[i].with_z(bodies.unfolded(i, length));
            bodies.mass[i] * place.cross(bodies.velocity[i])
                + bodies.inertia[i] * bodies.angular_velocity[i]
        })
        .sum()
}

/// Total momentum.
pub(crate) fn momentum(bodies: &Bodies) -> DVec3 {
    let velocities = bodies.velocity.iter().zip(&bodies.mass);
    velocities.map(|(v, m)| *m * *v).sum()
}

/// Uniform numbers in [0, 1) for test states; any will do, as long as they are the same each time.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// A vector with components between -`size` and `size`.
    pub(crate) fn vector(&mut self, size: f64) -> DVec3 {
        let mut side = || size * (2.0 * self.uniform() - 1.0);
        DVec3::new(side(), side(), side())
    }
}
