//! Series with known statistics, the same at every test run.

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Independent normal numbers of mean 0 and variance 1 (Box-Muller).
pub(crate) fn white_noise(seed: u64, samples: usize) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || ((generator.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
    (0..samples)
        .map(|_| (-2.0 * libm::log(uniform())).sqrt() * libm::cos(TAU * uniform()))
        .collect()
}

/// Stationary autoregressive series x_(t+1) = a x_t + noise of mean 0 and variance 1.
///
/// Its autocorrelation is a^t and its integrated autocorrelation time (1 + a)/(2 (1 - a)).
pub(crate) fn autoregressive(memory: f64, seed: u64, samples: usize) -> Vec<f64> {
    let mut series = white_noise(seed, samples);
    let innovation = (1.0 - memory * memory).sqrt();
    for k in 1..samples {
        series[k] = memory * series[k - 1] + innovation * series[k];
    }
    series
}
