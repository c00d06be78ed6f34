//! The order to pack grains, and its result.

use peristalsis_physics::method::InitialState;
use peristalsis_physics::sizes::Sizes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest mean overlap of touching grains, in units of the largest diameter, that still counts as fitting.
pub const LARGEST_MEAN_OVERLAP: f64 = 0.5;

/// The grains to be packed.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// Number of grains.
    pub number: usize,
    /// How their diameters are distributed.
    pub sizes: Sizes,
    /// How the grains stand at t = 0.
    pub state: InitialState,
    /// Velocity of all grains along z \[d/t\].
    pub axial_velocity: f64,
    /// m ⟨v²⟩/3 of the velocities that each grain has besides \[m d^2/t^2\].
    pub temperature: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// How the packing came out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PackingReport {
    /// Grains that random insertion placed without overlap; the others were grown into place.
    pub inserted: usize,
    /// Iterations of the relaxation; 0 where insertion placed all.
    pub iterations: usize,
    /// Mean overlap of the contacts left \[d\].
    pub mean_overlap: f64,
    /// Largest overlap \[d\].
    pub largest_overlap: f64,
    /// Elastic energy stored \[m d^2/t^2\].
    pub stored_energy: f64,
}
