//! The order to pack grains, and its result.

use peristalsis_physics::method::InitialState;
use peristalsis_physics::sizes::Sizes;
use rand_chacha::ChaCha8Rng;
use rand_core::Rng;
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

/// Of mean 0 and variance 1, by the transform of Box and Muller.
pub(crate) fn standard_normal(random: &mut ChaCha8Rng) -> f64 {
    // In (0, 1]: its logarithm is finite.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - uniform(random)));
    radius * libm::cos(core::f64::consts::TAU * uniform(random))
}

/// Uniform in [0, 1), from the upper 53 bits.
pub(crate) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}
