//! How a simulation is computed.

use glam::DVec3;
use peristalsis_physics::contact::ContactModel;
pub use peristalsis_physics::method::{Integrator, Kernel};

/// How a simulation is computed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Parameters {
    /// The contact law.
    pub contact: ContactModel,
    /// The integrator of the motion.
    pub integrator: Integrator,
    /// Length of a step \[t\].
    pub time_step: f64,
    /// Skin of the neighbour list \[d\]; results depend on it by rounding at most.
    pub skin: f64,
    /// Which kernel computes the forces.
    pub kernel: Kernel,
    /// Body force on the grains: force over mass, the same everywhere and at all times; gravity is one \[d/t^2\].
    pub body_force: DVec3,
}
