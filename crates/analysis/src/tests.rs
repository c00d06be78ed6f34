//! What the tests of the estimators share: data with known statistics, the same at every test run, and coverage.

use crate::bootstrap::Randomness;
use crate::collapse::CurvePoint;
use crate::family::Family;
use crate::numerics::gamma::{ln_gamma, ln_upper_gamma};
use crate::transition::Transition;
use crate::uncertain::Uncertain;

/// Asserts that an estimator answers with an error of this pattern.
macro_rules! assert_refused {
    ($outcome:expr => $($error:tt)+) => {
        let outcome = $outcome;
        assert!(matches!(outcome, Err(crate::Error::$($error)+)), "{outcome:?}");
    };
}

/// Independent normal numbers of mean 0 and variance 1.
pub(crate) fn white_noise(seed: u64, samples: usize) -> Vec<f64> {
    let mut randomness = Randomness::new(seed, 0);
    (0..samples).map(|_| randomness.normal()).collect()
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

impl Family {
    /// A time drawn from the distribution with mean 1.
    pub(crate) fn draw(self, shape: f64, randomness: &mut Randomness) -> f64 {
        match self {
            Self::Exponential => -libm::log(randomness.uniform()),
            Self::Weibull => {
                let scale = libm::exp(-ln_gamma(1.0 + 1.0 / shape));
                scale * libm::pow(-libm::log(randomness.uniform()), 1.0 / shape)
            }
            Self::Gamma => gamma_number(shape, randomness) / shape,
        }
    }

    /// Probability of no transition up to a time, at a mean and a shape (any value for the exponential).
    pub(crate) fn survival(self, time: f64, mean: f64, shape: f64) -> f64 {
        if time <= 0.0 {
            return 1.0;
        }
        match self {
            Self::Exponential => libm::exp(-time / mean),
            Self::Gamma => libm::exp(ln_upper_gamma(shape, shape * time / mean)),
            Self::Weibull => {
                let scaled = libm::log(time / mean) + ln_gamma(1.0 + 1.0 / shape);
                libm::exp(-libm::exp(shape * scaled))
            }
        }
    }
}

/// Gamma number of unit scale: Marsaglia & Tsang, ACM Trans. Math. Softw. 26, 363 (2000).
fn gamma_number(shape: f64, randomness: &mut Randomness) -> f64 {
    if shape < 1.0 {
        let boost = libm::pow(randomness.uniform(), 1.0 / shape);
        return gamma_number(shape + 1.0, randomness) * boost;
    }
    let reduced = shape - 1.0 / 3.0;
    let slope = 1.0 / (9.0 * reduced).sqrt();
    loop {
        let normal = randomness.normal();
        let root = 1.0 + slope * normal;
        let cube = root * root * root;
        if cube <= 0.0 {
            continue;
        }
        let bound = 0.5 * normal * normal + reduced * (1.0 - cube + libm::log(cube));
        if libm::log(randomness.uniform()) < bound {
            return reduced * cube;
        }
    }
}

/// Exponential number of mean 1.
pub(crate) fn exponential(randomness: &mut Randomness) -> f64 {
    -libm::log(randomness.uniform())
}

/// A transition at a time, unless the run is watched for less.
pub(crate) fn watched(time: f64, until: f64) -> Transition {
    Transition::new(time.min(until), time < until)
}

/// So many runs that have their transition at the times drawn unless they are watched for less.
pub(crate) fn watched_runs(
    runs: usize,
    until: f64,
    mut time: impl FnMut() -> f64,
) -> Vec<Transition> {
    (0..runs).map(|_| watched(time(), until)).collect()
}

/// A point of a curve.
pub(crate) const fn point(x: f64, y: f64, error: f64) -> CurvePoint {
    CurvePoint { x, y, error }
}

/// Width and outcome of runs, so many at each of the places, that have their transition at a time unless they are
/// watched for less.
pub(crate) fn runs_at(
    places: &[f64],
    replicates: usize,
    until: f64,
    mut time: impl FnMut(f64) -> f64,
) -> (Vec<f64>, Vec<Transition>) {
    let replicate = |&place: &f64| std::iter::repeat_n(place, replicates);
    let width: Vec<f64> = places.iter().flat_map(replicate).collect();
    let runs = width.iter().map(|&place| watched(time(place), until));
    (width.clone(), runs.collect())
}

/// Width and outcome of so many runs at each of so many places from 2.6 on, that jam with a probability which falls
/// through a half at a width.
pub(crate) fn jams_at(
    randomness: &mut Randomness,
    [places, replicates]: [usize; 2],
    half: f64,
    spread: f64,
) -> (Vec<f64>, Vec<bool>) {
    let width = (0..places * replicates).map(|k| 2.6 + 0.05 * (k / replicates) as f64);
    let jams = |width: f64| randomness.uniform() < 1.0 / (1.0 + libm::exp((width - half) / spread));
    (width.clone().collect(), width.map(jams).collect())
}

/// How many of the intervals of N estimates cover the truth.
pub(crate) struct Coverage<const N: usize> {
    names: [&'static str; N],
    truths: [f64; N],
    covered: [[usize; 2]; N],
    trials: usize,
}

impl<const N: usize> Coverage<N> {
    pub(crate) fn of(estimates: [(&'static str, f64); N]) -> Self {
        Self {
            names: estimates.map(|(name, _)| name),
            truths: estimates.map(|(_, truth)| truth),
            covered: [[0; 2]; N],
            trials: 0,
        }
    }

    /// Counts the estimates of one trial.
    pub(crate) fn count(&mut self, found: [Uncertain; N]) {
        self.trials += 1;
        for ((found, truth), covered) in found.iter().zip(self.truths).zip(&mut self.covered) {
            covered[0] += usize::from(found.interval_68.contains(truth));
            covered[1] += usize::from(found.interval_95.contains(truth));
        }
    }

    /// Asserts that the intervals of 68 and of 95 per cent of every estimate keep their level, up to a bias of `slack`
    /// of each.
    pub(crate) fn judge(&self, slack: [f64; 2]) {
        for (name, covered) in self.names.iter().zip(self.covered) {
            for ((covered, level), slack) in covered.into_iter().zip([0.6827, 0.95]).zip(slack) {
                assert_coverage(covered, self.trials, level, slack, name);
            }
        }
    }
}

/// Asserts that so many of so many intervals covered the truth as their level promises, within three binomial standard
/// deviations and a bias of the level of `slack`.
pub(crate) fn assert_coverage(covered: usize, trials: usize, level: f64, slack: f64, what: &str) {
    let share = covered as f64 / trials as f64;
    let scatter = (level * (1.0 - level) / trials as f64).sqrt();
    assert!(
        (share - level).abs() < 3.0 * scatter + slack,
        "{what}: {share} of {trials} intervals cover, {level} should"
    );
}

/// Weeks in remission under 6-mercaptopurine, some patients still in remission (Freireich et al., Blood 21, 699
/// (1963)).
pub(crate) fn remission() -> Vec<Transition> {
    let relapsed = [6.0, 6.0, 6.0, 7.0, 10.0, 13.0, 16.0, 22.0, 23.0];
    let censored = [
        6.0, 9.0, 10.0, 11.0, 17.0, 19.0, 20.0, 25.0, 32.0, 32.0, 34.0, 35.0,
    ];
    let relapsed = relapsed.map(|time| Transition::new(time, true));
    let censored = censored.map(|time| Transition::new(time, false));
    relapsed.into_iter().chain(censored).collect()
}
