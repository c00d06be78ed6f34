//! Mean, variance and shape of the transition times of one ensemble, by maximum likelihood under censoring.

use crate::error::{Error, enough_observed, ensure};
use crate::family::{Family, Group, GroupLikelihood, LN_SHAPE_BOUNDS};
use crate::numerics::linear::{Cholesky, curvature};
use crate::numerics::minimum::minimise;
use crate::survival::times;
use crate::transition::Transition;
use crate::uncertain::{Interval, Uncertain};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tolerance of a maximum in the logarithm of mean or shape.
const TOLERANCE: f64 = 1e-6;
/// Farthest end of an interval, in the logarithm, from the estimate.
const FARTHEST: f64 = 40.0;

/// A distribution fitted to the transition times of one ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LifetimeFit {
    /// Family of the distribution.
    pub family: Family,
    /// Mean `<tau>`, of the whole distribution, beyond the time watched too.
    pub mean: Uncertain,
    /// Variance `chi_tau = <tau^2> - <tau>^2`.
    pub variance: Uncertain,
    /// Shape k; `None` for the exponential.
    pub shape: Option<Uncertain>,
    /// Largest log-likelihood, of densities in the unit of the times: comparable between families on the same runs.
    pub log_likelihood: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
}

impl LifetimeFit {
    /// `chi_tau/<tau>^2` of a gamma distribution, 1/k; `None` for the other families.
    pub fn relative_variance(&self) -> Option<Uncertain> {
        let shape = self.shape.filter(|_| self.family == Family::Gamma)?;
        let value = 1.0 / shape.value;
        Some(Uncertain::normal(value, value * shape.error / shape.value))
    }
}

/// Time of a run and whether it is a transition; checked, transitions being at positive times.
pub(crate) fn positive_times(transitions: &[Transition]) -> Result<Vec<(f64, bool)>, Error> {
    let times = times(transitions)?;
    let transition_at_0 = |&(time, observed): &(f64, bool)| observed && time == 0.0;
    match times.iter().position(transition_at_0) {
        Some(index) => Err(Error::NotPositive { index, value: 0.0 }),
        None => Ok(times),
    }
}

/// Checked runs of one ensemble: at least `needed` transitions, all at positive times.
pub(crate) fn group_of(transitions: &[Transition], needed: usize) -> Result<Group, Error> {
    let group = Group::new(positive_times(transitions)?);
    enough_observed(group.observed(), transitions.len(), needed)?;
    Ok(group)
}

/// Logarithm of the mean at which the likelihood of one shape is largest, and its value there.
pub(crate) fn best_mean(likelihood: &GroupLikelihood<'_>, start: f64) -> (f64, f64) {
    let mut ln_mean = start;
    let mut here = likelihood.at(ln_mean);
    for _ in 0..100 {
        let mut step = (-here.slope / here.curvature).clamp(-2.0, 2.0);
        if step.is_nan() {
            break;
        }
        let mut there = likelihood.at(ln_mean + step);
        let mut halvings = 0;
        while there.value < here.value && halvings < 40 {
            step *= 0.5;
            there = likelihood.at(ln_mean + step);
            halvings += 1;
        }
        ln_mean += step;
        here = there;
        if step.abs() < 1e-10 {
            break;
        }
    }
    (ln_mean, here.value)
}

/// Fits a family of distributions to transition times with right-censoring.
///
/// `ln L = sum_observed ln f(t_i) + sum_censored ln S(t_i)`,   f = -dS/dt
///
/// Errors from the observed information in (ln m, ln k); intervals by profile likelihood, ln L(max) - ln L = 1/2 and
/// 1.92, asymmetric where the data are. They hold from some ten transitions on; the shape of fewer is biased upward,
/// and a mean far beyond the time watched rests on the family being right: compare families, and compare with
/// [`restricted_moments`](crate::restricted_moments). Source: Kalbfleisch & Prentice, The Statistical Analysis of
/// Failure Time Data (2002), chapter 3.
///
/// # Errors
/// [`Error::TooFewObserved`] below 1 transition (exponential) or 3 (others), [`Error::NoScatter`] where the times are
/// so nearly equal that the shape has no upper end, [`Error::Undetermined`], [`Error::NotPositive`] for a transition at
/// 0, [`Error::NonFinite`], [`Error::Negative`].
///
/// ```
/// use peristalsis_analysis::{Family, Transition, fit_lifetime};
/// let at = |time| Transition::At { time, period: 0 };
/// let runs = [at(1.0), at(3.0), Transition::Censored { time: 4.0 }];
/// // Eight units of time watched, two transitions.
/// let fit = fit_lifetime(Family::Exponential, &runs)?;
/// assert!((fit.mean.value - 4.0).abs() < 1e-9);
/// assert!((fit.mean.error - 4.0 / 2.0_f64.sqrt()).abs() < 1e-9);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_lifetime(family: Family, transitions: &[Transition]) -> Result<LifetimeFit, Error> {
    let runs = transitions.len();
    match family {
        Family::Exponential => Ok(exponential(&group_of(transitions, 1)?, runs)),
        Family::Gamma | Family::Weibull => with_shape(family, &group_of(transitions, 3)?, runs),
    }
}

fn exponential(group: &Group, runs: usize) -> LifetimeFit {
    let likelihood = group.at_shape(Family::Exponential, 1.0);
    let (ln_mean, largest) = best_mean(&likelihood, libm::log(group.crude_mean()));
    let error = (-1.0 / likelihood.at(ln_mean).curvature).sqrt();
    let profile = |ln_mean| likelihood.at(ln_mean).value;
    let mean = by_profile(ln_mean, error, largest, profile).exponential();
    LifetimeFit {
        family: Family::Exponential,
        mean,
        variance: mean.map(2.0 * mean.value * mean.error, |mean| mean * mean),
        shape: None,
        log_likelihood: largest,
        observed: group.observed(),
        censored: runs - group.observed(),
    }
}

fn with_shape(family: Family, group: &Group, runs: usize) -> Result<LifetimeFit, Error> {
    let observed = group.observed();
    let no_scatter = Error::NoScatter { observed };
    ensure(group.scatters(), no_scatter)?;
    let undetermined = Error::undetermined(runs, 2);
    let start = libm::log(group.crude_mean());
    let likelihood = |ln_shape: f64| group.at_shape(family, libm::exp(ln_shape));
    let at_shape = |ln_shape: f64| best_mean(&likelihood(ln_shape), start);
    let best = minimise(|ln_shape| -at_shape(ln_shape).1, LN_SHAPE_BOUNDS, TOLERANCE);
    ensure(best.place <= LN_SHAPE_BOUNDS.1 - 0.01, no_scatter)?;
    let is_found = best.place >= LN_SHAPE_BOUNDS.0 + 0.01 && best.value.is_finite();
    ensure(is_found, undetermined)?;
    let ln_shape = best.place;
    let (ln_mean, largest) = at_shape(ln_shape);
    let value = |ln_mean: f64, ln_shape: f64| likelihood(ln_shape).at(ln_mean).value;
    // Steps below the scatter of the estimates, so that only the quadratic part shows.
    let step = 0.05 / (observed as f64).sqrt();
    let information = curvature(
        |p: &[f64; 2]| -value(p[0], p[1]),
        &[ln_mean, ln_shape],
        &[step * libm::exp(-0.5 * ln_shape.max(0.0)), step],
    );
    let covariance = Cholesky::new(&information).ok_or(undetermined)?.inverse();
    let ln_relative_variance =
        |ln_shape: f64| libm::log(family.relative_variance(libm::exp(ln_shape)));
    let slope =
        (ln_relative_variance(ln_shape + 1e-4) - ln_relative_variance(ln_shape - 1e-4)) / 2e-4;
    let ln_variance = 2.0 * ln_mean + ln_relative_variance(ln_shape);
    let ln_variance_error = (4.0 * covariance[0][0]
        + 4.0 * slope * covariance[0][1]
        + slope * slope * covariance[1][1])
        .max(0.0)
        .sqrt();
    let shape_error = covariance[1][1].sqrt();
    let bounds = (
        (ln_shape - 15.0 * shape_error).max(LN_SHAPE_BOUNDS.0),
        (ln_shape + 15.0 * shape_error).min(LN_SHAPE_BOUNDS.1),
    );
    let over_shapes = |mean_at: &dyn Fn(f64) -> f64| {
        -minimise(|k| -value(mean_at(k), k), bounds, 1e-3 * shape_error).value
    };
    let mean = by_profile(ln_mean, covariance[0][0].sqrt(), largest, |fixed| {
        over_shapes(&|_| fixed)
    });
    let variance = by_profile(ln_variance, ln_variance_error, largest, |fixed| {
        over_shapes(&|k| 0.5 * (fixed - ln_relative_variance(k)))
    });
    let shape = by_profile(ln_shape, shape_error, largest, |fixed| at_shape(fixed).1);
    Ok(LifetimeFit {
        family,
        mean: mean.exponential(),
        variance: variance.exponential(),
        shape: Some(shape.exponential()),
        log_likelihood: largest,
        observed,
        censored: runs - observed,
    })
}

/// A parameter with the intervals where its profile likelihood stays within 1/2 and 1.92 of the largest.
fn by_profile(value: f64, error: f64, largest: f64, profile: impl Fn(f64) -> f64) -> Uncertain {
    let limits = [value - FARTHEST, value + FARTHEST];
    Uncertain::with_intervals(value, error, |deviations| {
        let deficit = |place: f64| largest - profile(place) - 0.5 * deviations * deviations;
        Interval::around(value, deficit, deviations * error, limits, limits)
    })
}

#[cfg(test)]
mod tests;
