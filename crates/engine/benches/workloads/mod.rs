//! The work that is timed (`cargo bench`) and whose instructions are counted (`scripts/instruction_counts.py`).

use peristalsis_engine::initial::{InitialState, Packing, pack};
use peristalsis_engine::wall::{
    DriveAngle, ElasticNetwork, ElasticParameters, ElasticWall, PrescribedWall,
};
use peristalsis_engine::{
    EngineError, Instructions, Integrator, Kernel, Parameters, Simulation, Wall,
};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, DissipationForm, LinearSpringDashpot, Normal, Sliding,
    ViscoelasticHertz,
};
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};

const TIME_STEP: f64 = 0.05;

/// Radius of the prescribed tube \[d\].
const RADIUS: f64 = 1.5;

const FRICTION: CundallStrack = CundallStrack {
    tangential_stiffness: 1.0,
    tangential_damping: 0.1,
    static_friction: 0.5,
    kinetic_friction: 0.4,
    sliding: Sliding::Spring,
};

/// A way to compute.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    pub(crate) name: &'static str,
    pub(crate) kernel: Kernel,
    /// Of the fast kernel.
    pub(crate) instructions: Instructions,
}

impl Path {
    pub(crate) const ALL: [Self; 4] = [
        Self {
            name: "reference",
            kernel: Kernel::Reference,
            instructions: Instructions::Plain,
        },
        Self::fast("plain", Instructions::Plain),
        Self::fast("avx2", Instructions::Avx2),
        Self::fast("avx512", Instructions::Avx512),
    ];

    const fn fast(name: &'static str, instructions: Instructions) -> Self {
        Self {
            name,
            kernel: Kernel::Fast,
            instructions,
        }
    }
}

/// A stretch of flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Workload {
    /// Fine lattice, w = 2.9, strain rate 0.1, 203 grains: slow flow.
    FineUnjammed,
    /// The same with w = 2.64, jammed.
    FineJammed,
    /// Coarse lattice, volume fraction 0.3, w = 2.6, strain rate 0.05, 405 grains, jammed.
    CoarseDense,
    /// Coarse lattice, 304 grains of several sizes with friction, w = 2.6, strain rate 0.05: the list of neighbours in a
    /// prescribed tube.
    FrictionalPrescribed,
    /// Elastic wall of six waves, n = 0.71, 3279 frictional grains, started jammed.
    FrictionalElastic,
}

impl Workload {
    pub(crate) const ALL: [Self; 5] = [
        Self::FineUnjammed,
        Self::FineJammed,
        Self::CoarseDense,
        Self::FrictionalPrescribed,
        Self::FrictionalElastic,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::FineUnjammed => "fine-unjammed",
            Self::FineJammed => "fine-jammed",
            Self::CoarseDense => "coarse-dense",
            Self::FrictionalPrescribed => "frictional-prescribed",
            Self::FrictionalElastic => "frictional-elastic",
        }
    }

    /// How many steps are timed or counted at a time: enough for several renewals of order or list.
    pub(crate) fn steps(self) -> u64 {
        match self {
            Self::FineUnjammed | Self::FineJammed | Self::CoarseDense => 1000,
            Self::FrictionalPrescribed => 400,
            Self::FrictionalElastic => 50,
        }
    }

    /// Steps from the packing to a flow like that of a run, few enough for callgrind.
    fn warm_up(self) -> u64 {
        match self {
            Self::FineUnjammed | Self::FrictionalPrescribed => 400,
            Self::FineJammed | Self::CoarseDense => 1000,
            Self::FrictionalElastic => 50,
        }
    }

    /// The flow, about to be computed this way. It is the same whatever the machine: the fast kernel, which brings it
    /// about, gives the same bits everywhere.
    pub(crate) fn simulation(self, path: Path) -> Result<Simulation, EngineError> {
        let (packing, wall, contact) = self.parts();
        let (bodies, _) = pack(&packing, &wall, contact.normal)?;
        let parameters = |kernel| Parameters {
            contact,
            integrator: Integrator::Verlet,
            time_step: TIME_STEP,
            skin: 0.3,
            kernel,
            body_force: 0.0,
        };
        let mut flow = Simulation::new(bodies, wall.clone(), parameters(Kernel::Fast));
        flow.advance(self.warm_up())?;
        let mut simulation = Simulation::restore(flow.snapshot(), wall, parameters(path.kernel))?;
        simulation.compute_with(path.instructions, 1)?;
        // The first step after a restart makes the list of neighbours.
        simulation.advance(1)?;
        Ok(simulation)
    }

    fn parts(self) -> (Packing, Wall, ContactModel) {
        match self {
            Self::FineUnjammed => strain_controlled(FINE, 0.15, 2.9, 0.1, InitialState::Rest),
            Self::FineJammed => strain_controlled(FINE, 0.15, 2.64, 0.1, InitialState::Jammed),
            Self::CoarseDense => strain_controlled(COARSE, 0.3, 2.6, 0.05, InitialState::Jammed),
            Self::FrictionalPrescribed => {
                let (packing, wall, contact) =
                    strain_controlled(COARSE, 0.225, 2.6, 0.05, InitialState::Rest);
                let packing = Packing {
                    diameter_min: 0.8,
                    ..packing
                };
                let contact = ContactModel {
                    friction: Some(FRICTION),
                    ..contact
                };
                (packing, wall, contact)
            }
            Self::FrictionalElastic => stress_controlled(),
        }
    }
}

const FINE: Lattice = Lattice {
    spheres_per_ring: 24,
    rings_per_wave: 26,
    waves: 10,
    wavelength: 10.0,
    sphere_diameter: 1.0,
};

const COARSE: Lattice = Lattice {
    spheres_per_ring: 12,
    rings_per_wave: 14,
    ..FINE
};

/// Equal smooth grains with linear contacts in a prescribed tube.
fn strain_controlled(
    lattice: Lattice,
    volume_fraction: f64,
    width: f64,
    strain_rate: f64,
    state: InitialState,
) -> (Packing, Wall, ContactModel) {
    let wall = PrescribedWall::new(
        lattice,
        RADIUS,
        Waveform::Sine,
        -1.0,
        Schedule::constant(RADIUS - 0.5 * width),
        Schedule::constant(strain_rate),
    );
    let contact = ContactModel {
        normal: Normal::Linear(LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: 5.48e-3,
        }),
        friction: None,
    };
    let packing = Packing {
        // rho = N/(6 a^2 L)
        number: (volume_fraction * 6.0 * RADIUS * RADIUS * lattice.length()).round() as usize,
        diameter_min: 1.0,
        diameter_max: 1.0,
        state,
        axial_velocity: match state {
            InitialState::Rest => 0.0,
            InitialState::Jammed => -strain_rate * lattice.wavelength,
        },
        seed: 1,
    };
    (packing, Wall::Prescribed(wall), contact)
}

/// Frictional grains in an elastic tube of six waves.
fn stress_controlled() -> (Packing, Wall, ContactModel) {
    let strain_rate = 4.01e-3;
    let lattice = Lattice {
        spheres_per_ring: 22,
        rings_per_wave: 23,
        waves: 6,
        wavelength: 20.0,
        sphere_diameter: 1.0,
    };
    let wall = ElasticWall::new(ElasticParameters {
        lattice,
        mean_radius: 3.5,
        network: ElasticNetwork::default(),
        force_amplitude: Schedule::constant(0.004),
        frequency: Schedule::constant(strain_rate),
        heading: 1.0,
        waveform: Waveform::Sine,
        angle: DriveAngle::Reference,
    });
    let contact = ContactModel {
        normal: Normal::Hertz(ViscoelasticHertz {
            young_modulus: 1.0,
            poisson_ratio: 0.5,
            dissipation_time: 0.1,
            dissipation_form: DissipationForm::Viscoelastic,
        }),
        friction: Some(FRICTION),
    };
    let packing = Packing {
        // n = N d*^3/(pi a^2 L)
        number: (0.71 * core::f64::consts::PI * 3.5 * 3.5 * lattice.length()).round() as usize,
        diameter_min: 0.8,
        diameter_max: 1.0,
        state: InitialState::Jammed,
        axial_velocity: strain_rate * lattice.wavelength,
        seed: 1,
    };
    (packing, Wall::Elastic(wall), contact)
}
