//! Families of distributions of transition times, and their likelihood under censoring.

use crate::numerics::gamma::{ln_gamma, ln_upper_gamma};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Logarithms of the smallest and the largest shape that a fit may find.
pub(crate) const LN_SHAPE_BOUNDS: (f64, f64) = (-4.0, 9.2);

/// Family of distributions of a transition time, each with a mean and at most one shape k.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Family {
    /// `S = exp(-t/m)`: a jam begins by chance at a constant rate. Its relative variance is 1.
    Exponential,
    /// `S = Q(k, k t/m)`: k steps in a row, each begun by chance. Relative variance 1/k.
    Gamma,
    /// `S = exp(-(t/s)^k)`, m = s Gamma(1 + 1/k): the rate grows as t^(k - 1). k = 1 has no memory; for large k the
    /// transition is all but deterministic.
    Weibull,
}

impl Family {
    /// Parameters of the distribution: mean and, but for the exponential, shape.
    pub(crate) fn parameters(self) -> usize {
        match self {
            Self::Exponential => 1,
            Self::Gamma | Self::Weibull => 2,
        }
    }

    /// Relative variance `(<t^2> - <t>^2)/<t>^2` at a shape.
    pub(crate) fn relative_variance(self, shape: f64) -> f64 {
        match self {
            Self::Exponential => 1.0,
            Self::Gamma => 1.0 / shape,
            Self::Weibull => {
                libm::expm1(ln_gamma(1.0 + 2.0 / shape) - 2.0 * ln_gamma(1.0 + 1.0 / shape))
            }
        }
    }
}

/// Log-likelihood with its first and second derivative in the logarithm of the mean.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Derivatives {
    pub(crate) value: f64,
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
}

/// Runs that share one mean, reduced to what a likelihood needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    observed: Vec<f64>,
    /// Distinct times of censoring with the number of runs each; runs that end together are one entry.
    censored: Vec<(f64, f64)>,
    observed_sum: f64,
    observed_log_sum: f64,
    longest: f64,
}

impl Group {
    /// Observed times must be positive; runs censored at 0 say nothing and are left out.
    pub(crate) fn new(times: impl IntoIterator<Item = (f64, bool)>) -> Self {
        let mut group = Self::default();
        let mut ends: Vec<f64> = Vec::new();
        for (time, observed) in times {
            group.longest = group.longest.max(time);
            if observed {
                group.observed.push(time);
            } else if time > 0.0 {
                ends.push(time);
            }
        }
        group.observed_sum = group.observed.iter().sum();
        group.observed_log_sum = group.observed.iter().map(|&time| libm::log(time)).sum();
        ends.sort_by(f64::total_cmp);
        for end in ends {
            match group.censored.last_mut() {
                Some((time, runs)) if *time == end => *runs += 1.0,
                _ => group.censored.push((end, 1.0)),
            }
        }
        group
    }

    pub(crate) fn observed(&self) -> usize {
        self.observed.len()
    }

    /// Whether the observed times scatter enough for a shape.
    pub(crate) fn scatters(&self) -> bool {
        let most = self.observed.iter().copied().fold(0.0, f64::max);
        let least = self.observed.iter().copied().fold(f64::INFINITY, f64::min);
        most > least * (1.0 + 1e-9)
    }

    /// Total time watched over observed transitions: the exponential estimate of the mean, half a transition at least.
    pub(crate) fn crude_mean(&self) -> f64 {
        let censored: f64 = self.censored.iter().map(|(time, runs)| time * runs).sum();
        (self.observed_sum + censored) / (self.observed.len() as f64).max(0.5)
    }

    /// The likelihood at one shape, as a function of the mean.
    pub(crate) fn at_shape(&self, family: Family, shape: f64) -> GroupLikelihood<'_> {
        let observed = self.observed.len() as f64;
        let likelihood = |shape, constant, ln_gamma, form| GroupLikelihood {
            observed,
            shape,
            constant,
            ln_gamma,
            form,
        };
        match family {
            Family::Exponential => {
                let sum = self.crude_mean() * observed.max(0.5) / self.longest;
                likelihood(1.0, 0.0, 0.0, Form::power(sum, self.longest))
            }
            Family::Weibull => {
                let power = |time: f64| libm::pow(time / self.longest, shape);
                let weighted = |&(time, runs): &(f64, f64)| runs * power(time);
                let observed_powers: f64 = self.observed.iter().map(|&time| power(time)).sum();
                let sum = observed_powers + self.censored.iter().map(weighted).sum::<f64>();
                let constant = observed * libm::log(shape) + (shape - 1.0) * self.observed_log_sum;
                let ln_gamma = ln_gamma(1.0 + 1.0 / shape);
                likelihood(shape, constant, ln_gamma, Form::power(sum, self.longest))
            }
            Family::Gamma => {
                let ln_gamma = ln_gamma(shape);
                let constant = (shape - 1.0) * self.observed_log_sum - observed * ln_gamma;
                let ln_shape = libm::log(shape);
                likelihood(
                    shape,
                    constant,
                    ln_gamma,
                    Form::Gamma {
                        group: self,
                        ln_shape,
                    },
                )
            }
        }
    }
}

/// Likelihood of a group at one shape.
pub(crate) struct GroupLikelihood<'a> {
    observed: f64,
    shape: f64,
    constant: f64,
    ln_gamma: f64,
    form: Form<'a>,
}

/// How the likelihood depends on the mean.
#[derive(Clone, Copy)]
enum Form<'a> {
    /// Exponential and Weibull, by the sum of (t/longest)^k over all runs.
    Power { sum: f64, ln_longest: f64 },
    /// Gamma.
    Gamma { group: &'a Group, ln_shape: f64 },
}

impl Form<'_> {
    fn power(sum: f64, longest: f64) -> Self {
        let ln_longest = libm::log(longest);
        Self::Power { sum, ln_longest }
    }
}

impl GroupLikelihood<'_> {
    /// Log-likelihood of the group at a logarithm of the mean; concave in it for every family.
    pub(crate) fn at(&self, ln_mean: f64) -> Derivatives {
        let (observed, shape) = (self.observed, self.shape);
        match self.form {
            Form::Power { sum, .. } if sum == 0.0 || sum.is_nan() => Derivatives::default(),
            Form::Power { sum, ln_longest } => {
                let ln_scale = ln_mean - self.ln_gamma;
                let hazard = sum * libm::exp(shape * (ln_longest - ln_scale));
                Derivatives {
                    value: self.constant - observed * shape * ln_scale - hazard,
                    slope: shape * (hazard - observed),
                    curvature: -shape * shape * hazard,
                }
            }
            Form::Gamma { group, ln_shape } => {
                let ln_scale = ln_mean - ln_shape;
                let sum = group.observed_sum * libm::exp(-ln_scale);
                let mut total = Derivatives {
                    value: self.constant - observed * shape * ln_scale - sum,
                    slope: sum - observed * shape,
                    curvature: -sum,
                };
                for &(time, runs) in &group.censored {
                    let x = time * libm::exp(-ln_scale);
                    let ln_survival = ln_upper_gamma(shape, x);
                    let growth = if x > 0.0 && x.is_finite() {
                        libm::exp(shape * libm::log(x) - x - self.ln_gamma - ln_survival)
                    } else {
                        0.0
                    };
                    total.value += runs * ln_survival;
                    total.slope += runs * growth;
                    // Round-off far in the tail must not make it convex.
                    total.curvature -= runs * (growth * (shape - x + growth)).max(0.0);
                }
                total
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;

    fn group() -> Group {
        Group::new([
            (1.0, true),
            (2.5, true),
            (3.0, false),
            (3.0, false),
            (0.4, false),
            (0.0, false),
        ])
    }

    /// Log-likelihood term by term, densities by differences of the survival function.
    fn directly(family: Family, mean: f64, shape: f64) -> f64 {
        let survival = |time: f64| family.survival(time, mean, shape);
        let density = |time: f64| (survival(time - 1e-4) - survival(time + 1e-4)) / 2e-4;
        libm::log(density(1.0))
            + libm::log(density(2.5))
            + 2.0 * libm::log(survival(3.0))
            + libm::log(survival(0.4))
    }

    #[test]
    fn likelihood_and_derivatives_agree_with_the_survival_function() {
        for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
            for (mean, shape) in [(1.7, 1.0), (2.0, 0.6), (4.0, 3.0)] {
                let group = group();
                let likelihood = group.at_shape(family, shape);
                let at = |ln_mean| likelihood.at(ln_mean);
                let ln_mean = libm::log(mean);
                let expected = directly(family, mean, shape);
                let found = at(ln_mean);
                assert!(
                    (found.value - expected).abs() < 1e-6,
                    "{family:?} {mean} {shape}: {} {expected}",
                    found.value
                );
                let (up, down) = (at(ln_mean + 1e-4), at(ln_mean - 1e-4));
                let slope = (up.value - down.value) / 2e-4;
                assert!((found.slope - slope).abs() < 1e-6);
                let curvature = (up.slope - down.slope) / 2e-4;
                assert!((found.curvature - curvature).abs() < 1e-6);
                assert!(found.curvature < 0.0);
            }
        }
    }

    #[test]
    fn numbers_are_drawn_with_mean_and_variance() {
        let mut randomness = Randomness::new(4, 0);
        let cases = [
            (Family::Exponential, 1.0),
            (Family::Gamma, 0.6),
            (Family::Gamma, 4.0),
            (Family::Weibull, 2.5),
        ];
        for (family, shape) in cases {
            let draws: Vec<f64> = (0..20_000)
                .map(|_| family.draw(shape, &mut randomness))
                .collect();
            let found = crate::ensemble::moments(&draws).unwrap();
            assert!(
                (found.mean - 1.0).abs() < 4.0 * found.mean_error,
                "{family:?}"
            );
            let expected = family.relative_variance(shape);
            assert!((found.variance - expected).abs() < 4.0 * found.variance_error);
        }
    }

    #[test]
    fn relative_variances_by_hand() {
        assert_eq!(Family::Exponential.relative_variance(7.0), 1.0);
        assert_eq!(Family::Gamma.relative_variance(4.0), 0.25);
        assert!((Family::Weibull.relative_variance(1.0) - 1.0).abs() < 1e-13);
        // Rayleigh: 4/pi - 1.
        let rayleigh = Family::Weibull.relative_variance(2.0);
        assert!((rayleigh - (4.0 / std::f64::consts::PI - 1.0)).abs() < 1e-13);
        // Large k: pi^2/(6 k^2).
        let narrow = Family::Weibull.relative_variance(5000.0);
        assert!((narrow * 5000.0 * 5000.0 - 1.644).abs() < 0.01, "{narrow}");
        assert_eq!(Family::Gamma.survival(0.0, 1.0, 2.0), 1.0);
    }
}
