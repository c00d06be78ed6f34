//! Experiments with the engine itself: its kernels and integrators, through its public interface.

pub(crate) mod chain;
pub(crate) mod cohering;
pub(crate) mod column;
pub(crate) mod falling;
pub(crate) mod gas;
pub(crate) mod impact;
pub(crate) mod sliding;

use glam::DVec3;
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Integrator, Kernel, Parameters, Wall};
use peristalsis_physics::contact::{ContactModel, Normal};
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};

/// Integrator and kernel of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Means {
    pub(crate) integrator: Integrator,
    pub(crate) kernel: Kernel,
}

impl Means {
    /// The defaults of a run.
    pub(crate) const USUAL: Self = Self {
        integrator: Integrator::Verlet,
        kernel: Kernel::Fast,
    };

    /// Both integrators by the fast kernels.
    pub(crate) const INTEGRATORS: [Self; 2] = [
        Self::USUAL,
        Self {
            integrator: Integrator::AdamsBashforth,
            kernel: Kernel::Fast,
        },
    ];

    /// The same integrator by the reference kernel.
    pub(crate) fn by_reference(self) -> Self {
        Self {
            kernel: Kernel::Reference,
            ..self
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self.integrator {
            Integrator::Verlet => "Verlet",
            Integrator::AdamsBashforth => "Adams-Bashforth",
        }
    }

    /// Parameters of a simulation by these means.
    pub(crate) fn parameters(self, contact: ContactModel, time_step: f64, skin: f64) -> Parameters {
        Parameters {
            contact,
            integrator: self.integrator,
            time_step,
            skin,
            kernel: self.kernel,
            body_force: DVec3::ZERO,
        }
    }
}

/// A contact without friction.
pub(crate) fn frictionless(normal: Normal) -> ContactModel {
    ContactModel::new(normal, None)
}

/// A wall at rest: a straight tube.
fn straight(lattice: Lattice, radius: f64) -> Wall {
    Wall::Prescribed(PrescribedWall::new(
        lattice,
        radius,
        Waveform::Sine,
        1.0,
        Schedule::constant(0.0),
        Schedule::constant(0.0),
    ))
}

/// A wall of two rings of one sphere each, so large that it stands for a plane and too far apart for a grain to meet both.
pub(crate) fn plane(diameter: f64, radius: f64) -> Wall {
    let lattice = Lattice {
        spheres_per_ring: 1,
        rings_per_wave: 2,
        waves: 1,
        wavelength: 4.0 * diameter,
        sphere_diameter: diameter,
        staggered: true,
    };
    straight(lattice, radius)
}

/// A periodic tube whose wall is too far away to be touched.
pub(crate) fn far_away(radius: f64, length: f64) -> Wall {
    let lattice = Lattice {
        spheres_per_ring: 4,
        rings_per_wave: 2,
        waves: 1,
        wavelength: length,
        sphere_diameter: 1.0,
        staggered: true,
    };
    straight(lattice, radius)
}
