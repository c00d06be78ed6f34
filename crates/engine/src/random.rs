//! Random numbers.

use rand_chacha::ChaCha8Rng;
use rand_core::Rng;

/// Uniform in [0, 1), from the upper 53 bits.
pub(crate) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// Of mean 0 and variance 1, by the transform of Box and Muller.
pub(crate) fn standard_normal(random: &mut ChaCha8Rng) -> f64 {
    // In (0, 1]: its logarithm is finite.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - uniform(random)));
    radius * libm::cos(core::f64::consts::TAU * uniform(random))
}
