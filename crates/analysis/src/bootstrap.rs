//! Resampling with replacement, the same at every run.

use crate::error::{Error, ensure};
use crate::uncertain::Uncertain;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// Fewest resamples from which an interval is read.
const LEAST_RESAMPLES: usize = 20;

/// How often to resample, and with which random numbers.
///
/// Resample k draws from its own stream of the generator (`ChaCha8`, stream k of the seed), so that more resamples
/// leave the first ones as they were. 200 give a standard error to 5 per cent; the ends of a 95 per cent interval need
/// 1000. Source: Efron & Tibshirani, An Introduction to the Bootstrap (1993), chapters 6 and 13.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bootstrap {
    /// Number of resamples.
    pub resamples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Bootstrap {
    /// `resamples` resamples, by the random numbers of `seed`.
    pub const fn new(resamples: usize, seed: u64) -> Self {
        Self { resamples, seed }
    }

    /// Random numbers of every resample, in order.
    pub(crate) fn streams(self) -> Result<impl Iterator<Item = Randomness>, Error> {
        enough_resamples(self.resamples)?;
        Ok((0..self.resamples as u64).map(move |stream| Randomness::new(self.seed, stream)))
    }
}

/// Bootstrap errors of any N numbers computed from a sample of independent things.
///
/// Things are drawn with replacement, as many as there are. `statistic` gives the numbers of a sample, first of the data
/// themselves, or `None` where they cannot be had, so that this sample is left out; an infinite number counts in the
/// intervals, so that they end there.
pub(crate) fn bootstrap_errors<T: Clone, const N: usize>(
    sample: &[T],
    bootstrap: Bootstrap,
    mut statistic: impl FnMut(&[T]) -> Option<[f64; N]>,
) -> Result<Vec<Uncertain>, Error> {
    let values = statistic(sample).ok_or(Error::undetermined(sample.len(), N))?;
    let resampled = bootstrap.streams()?;
    let resampled = resampled.filter_map(|mut randomness| statistic(&randomness.resample(sample)));
    let resampled: Vec<[f64; N]> = resampled.collect();
    enough_resamples(resampled.len())?;
    let with_error = |k: usize| {
        let column: Vec<f64> = resampled.iter().map(|numbers| numbers[k]).collect();
        let found = Uncertain::from_bootstrap(values[k], &column);
        found.ok_or(too_few_resamples(resampled.len()))
    };
    (0..N).map(with_error).collect()
}

fn enough_resamples(found: usize) -> Result<(), Error> {
    ensure(found >= LEAST_RESAMPLES, too_few_resamples(found))
}

const fn too_few_resamples(found: usize) -> Error {
    let needed = LEAST_RESAMPLES;
    Error::TooFewResamples { needed, found }
}

/// Random numbers of one stream.
pub(crate) struct Randomness {
    generator: ChaCha8Rng,
}

impl Randomness {
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self { generator }
    }

    /// Uniform number in the open interval from 0 to 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        ((self.generator.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Uniform integer below `count`.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        ((u128::from(self.generator.next_u64()) * count as u128) >> 64) as usize
    }

    /// Normal number of mean 0 and variance 1 (Box-Muller), for made-up data.
    #[cfg(test)]
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// As many elements drawn with replacement.
    pub(crate) fn resample<T: Clone>(&mut self, sample: &[T]) -> Vec<T> {
        (0..sample.len())
            .map(|_| sample[self.index(sample.len())].clone())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::mean_of;

    #[test]
    fn a_resample_does_not_depend_on_how_many_follow() {
        let draw = |resamples| -> Vec<Vec<u32>> {
            let sample: Vec<u32> = (0..50).collect();
            Bootstrap { resamples, seed: 7 }
                .streams()
                .unwrap()
                .map(|mut randomness| randomness.resample(&sample))
                .collect()
        };
        assert_eq!(draw(20)[..], draw(30)[..20]);
        assert_ne!(draw(20)[0], draw(20)[1]);
        let few = Bootstrap::new(19, 7);
        assert!(matches!(
            few.streams().err(),
            Some(Error::TooFewResamples { found: 19, .. })
        ));
    }

    #[test]
    fn the_error_of_a_mean() {
        let bootstrap = Bootstrap::new(200, 1);
        let mean = |sample: &[f64]| Some([mean_of(sample)]);
        let found = bootstrap_errors(&[1.0, 2.0, 3.0, 4.0], bootstrap, mean).unwrap();
        assert_eq!(found[0].value, 2.5);
        // sqrt(5/16), the variance of the mean with divisor n.
        assert!((found[0].error - 0.559).abs() < 0.06);
    }

    #[test]
    fn uniform_and_normal_numbers_have_their_moments() {
        let mut randomness = Randomness::new(1, 0);
        let n = 40_000;
        let (mut sum, mut squares, mut counts) = (0.0, 0.0, [0_u32; 5]);
        for _ in 0..n {
            let normal = randomness.normal();
            sum += normal;
            squares += normal * normal;
            counts[randomness.index(5)] += 1;
        }
        assert!((sum / f64::from(n)).abs() < 0.02);
        assert!((squares / f64::from(n) - 1.0).abs() < 0.03);
        assert!(counts.iter().all(|&count| count.abs_diff(8000) < 330));
    }
}
