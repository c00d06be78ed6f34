//! Names of the ways to compute a run: how it starts, how the motion is stepped, which kernel adds up the forces.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the grains stand at t = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InitialState {
    /// Spread over the tube, at rest: J = 0.
    #[default]
    Rest,
    /// Spread over the tube and fallen until they rest under body.gravity and drive.body_force: J = 0. The wall stands
    /// as it is at t = 0; rest is a mean kinetic energy below 1e-6 m g d. Strain control only.
    Settled,
    /// Gathered in the bellies and moving with the wave: J = Jmax.
    Jammed,
    /// Where a caller of the library has put them. No file says where: only a checkpoint repeats such a run.
    Placed,
}

/// How the equations of motion are stepped; each is of order 2.
///
/// Velocity Verlet gives velocity-dependent forces the velocity predicted at the end of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Velocity Verlet.
    #[default]
    Verlet,
    /// Two-step Adams-Bashforth, the source's choice for the frictional model.
    AdamsBashforth,
}

/// Which kernel computes the forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// The fastest kernel that can compute the tube; the same bits on every machine.
    #[default]
    Fast,
    /// The reference kernel, with which the fast kernels agree up to rounding.
    Reference,
}
