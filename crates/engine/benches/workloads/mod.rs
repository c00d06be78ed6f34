//! The work that is timed (`cargo bench`) and whose instructions are counted (`scripts/instruction_counts.py`).

#[path = "../../tests/common/mod.rs"]
mod common;

use std::iter;

use self::common::*;

const TIME_STEP: f64 = 0.05;

/// Radius of the prescribed tube \[d\].
const RADIUS: f64 = 1.5;

/// A way to compute.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    pub(crate) name: &'static str,
    pub(crate) kernel: Kernel,
    /// Of the fast kernel.
    pub(crate) instructions: Instructions,
}

impl Path {
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let reference = ("reference", Kernel::Reference, Instructions::Plain);
        let fast = Instructions::ALL.iter();
        let fast = fast.map(|&(name, instructions, _)| (name, Kernel::Fast, instructions));
        iter::once(reference)
            .chain(fast)
            .map(|(name, kernel, instructions)| Self {
                name,
                kernel,
                instructions,
            })
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
            kernel,
            ..parameters(
                contact.normal,
                contact.friction,
                Integrator::Verlet,
                TIME_STEP,
            )
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
                    sizes: Sizes::Uniform([0.8, 1.0]),
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

const FINE: Lattice = lattice(24, 26, 10, 10.0);

const COARSE: Lattice = lattice(12, 14, 10, 10.0);

/// Equal frictionless grains with linear contacts in a prescribed tube.
fn strain_controlled(
    lattice: Lattice,
    volume_fraction: f64,
    width: f64,
    strain_rate: f64,
    state: InitialState,
) -> (Packing, Wall, ContactModel) {
    let contact = ContactModel::new(LINEAR, None);
    let packing = Packing {
        // rho = N/(6 a^2 L)
        number: (volume_fraction * 6.0 * RADIUS * RADIUS * lattice.length()).round() as usize,
        sizes: Sizes::Uniform([1.0, 1.0]),
        state,
        axial_velocity: match state {
            InitialState::Rest | InitialState::Settled | InitialState::Placed => 0.0,
            InitialState::Jammed => -strain_rate * lattice.wavelength,
        },
        temperature: 0.0,
        seed: 1,
    };
    (
        packing,
        strained(lattice, -1.0, width, strain_rate),
        contact,
    )
}

/// Frictional grains in an elastic tube of six waves.
fn stress_controlled() -> (Packing, Wall, ContactModel) {
    let strain_rate = 4.01e-3;
    let lattice = lattice(22, 23, 6, 20.0);
    let wall = elastic(elastic_with(|wall| {
        (wall.lattice, wall.mean_radius) = (lattice, 3.5);
        wall.force_amplitude = Schedule::constant(0.004);
        wall.frequency = Schedule::constant(strain_rate);
    }));
    let contact = ContactModel::new(HERTZ, Some(FRICTION));
    let packing = Packing {
        // n = N d*^3/(pi a^2 L)
        number: (0.71 * core::f64::consts::PI * 3.5 * 3.5 * lattice.length()).round() as usize,
        sizes: Sizes::Uniform([0.8, 1.0]),
        state: InitialState::Jammed,
        axial_velocity: strain_rate * lattice.wavelength,
        temperature: 0.0,
        seed: 1,
    };
    (packing, wall, contact)
}
