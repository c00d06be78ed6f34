//! Mean, variance and shape of the transition times of one ensemble, by maximum likelihood under censoring.

use crate::error::Error;
use crate::family::{Family, Group, GroupLikelihood, LN_SHAPE_BOUNDS};
use crate::numerics::linear::{Cholesky, curvature};
use crate::numerics::minimum::{crossing, minimise};
use crate::survival::times;
use crate::transition::Transition;
use crate::uncertain::{Interval, NARROW, Uncertain, WIDE};
use serde::{Deserialize, Serialize};

/// Tolerance of a maximum in the logarithm of mean or shape.
const TOLERANCE: f64 = 1e-6;
/// Farthest end of an interval, in the logarithm, from the estimate.
const FARTHEST: f64 = 40.0;

/// A distribution fitted to the transition times of one ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Akaike's criterion, 2 p - 2 ln L: of two families the one with the smaller value is nearer to the truth; a
    /// difference below 2 decides nothing. Source: Akaike, IEEE Trans. Autom. Control 19, 716 (1974).
    pub fn akaike(&self) -> f64 {
        2.0 * self.family.parameters() as f64 - 2.0 * self.log_likelihood
    }

    /// Fitted probability of no transition up to a time.
    pub fn survival(&self, time: f64) -> f64 {
        let shape = self.shape.map_or(1.0, |shape| shape.value);
        self.family.survival(time, self.mean.value, shape)
    }

    /// Relative variance chi_tau/tau^2: 1 for nucleation by chance, small for a deterministic approach.
    pub fn relative_variance(&self) -> Uncertain {
        match self.shape {
            None => Uncertain::normal(1.0, 0.0),
            Some(shape) => {
                let of = |shape: f64| self.family.relative_variance(shape);
                let slope = (of(shape.value * 1.001) - of(shape.value / 1.001)) / 0.002;
                let error = slope.abs() * shape.error / shape.value;
                // It falls with the shape: the ends change places.
                let turned = |interval: Interval| Interval {
                    lower: of(interval.upper),
                    upper: of(interval.lower.max(libm::exp(LN_SHAPE_BOUNDS.0))),
                };
                Uncertain {
                    value: of(shape.value),
                    error,
                    interval_68: turned(shape.interval_68),
                    interval_95: turned(shape.interval_95),
                }
            }
        }
    }
}

/// Checked runs of one ensemble: at least `needed` transitions, all at positive times.
pub(crate) fn group_of(transitions: &[Transition], needed: usize) -> Result<Group, Error> {
    let times = times(transitions)?;
    let transition_at_0 = |&(time, observed): &(f64, bool)| observed && time == 0.0;
    if let Some(index) = times.iter().position(transition_at_0) {
        return Err(Error::NotPositive { index, value: 0.0 });
    }
    let group = Group::new(times);
    if group.observed() < needed {
        return Err(Error::TooFewObserved {
            needed,
            observed: group.observed(),
            runs: transitions.len(),
        });
    }
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
/// 1.92, asymmetric where the data are. They hold from some ten transitions on; the shape of fewer is biased upward, and
/// a mean far beyond the time watched rests on the family being right: compare families, and compare with
/// [`restricted_moments`](crate::restricted_moments). Source: Kalbfleisch & Prentice, The Statistical Analysis of
/// Failure Time Data (2002), chapter 3.
///
/// # Errors
/// [`Error::TooFewObserved`] below 1 transition (exponential) or 3 (others), [`Error::NoScatter`] where the times are so
/// nearly equal that the shape has no upper end, [`Error::Undetermined`], [`Error::NotPositive`] for a transition at 0,
/// [`Error::NonFinite`], [`Error::Negative`].
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
    let needed = match family {
        Family::Exponential => 1,
        Family::Gamma | Family::Weibull => 3,
    };
    let group = group_of(transitions, needed)?;
    match family {
        Family::Exponential => Ok(exponential(&group, transitions.len())),
        Family::Gamma | Family::Weibull => with_shape(family, &group, transitions.len()),
    }
}

fn exponential(group: &Group, runs: usize) -> LifetimeFit {
    let likelihood = group.at_shape(Family::Exponential, 1.0);
    let (ln_mean, largest) = best_mean(&likelihood, libm::log(group.crude_mean()));
    let error = (-1.0 / likelihood.at(ln_mean).curvature).sqrt();
    let ln_mean = by_profile(ln_mean, error, largest, |ln_mean| {
        likelihood.at(ln_mean).value
    });
    let mean = ln_mean.exponential();
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
    if !group.scatters() {
        return Err(no_scatter);
    }
    let undetermined = Error::Undetermined {
        points: runs,
        parameters: 2,
    };
    let start = libm::log(group.crude_mean());
    let at_shape = |ln_shape: f64| best_mean(&group.at_shape(family, libm::exp(ln_shape)), start);
    let best = minimise(|ln_shape| -at_shape(ln_shape).1, LN_SHAPE_BOUNDS, TOLERANCE);
    if best.place > LN_SHAPE_BOUNDS.1 - 0.01 {
        return Err(no_scatter);
    }
    if best.place < LN_SHAPE_BOUNDS.0 + 0.01 || !best.value.is_finite() {
        return Err(undetermined);
    }
    let ln_shape = best.place;
    let (ln_mean, largest) = at_shape(ln_shape);
    let value = |ln_mean: f64, ln_shape: f64| {
        group
            .at_shape(family, libm::exp(ln_shape))
            .at(ln_mean)
            .value
    };
    // Steps below the scatter of the estimates, so that the quadratic part is what is seen.
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
    let ends = |deviations: f64| {
        let deficit = |place: f64| largest - profile(place) - 0.5 * deviations * deviations;
        let end = |limit: f64| crossing(deficit, value, deviations * error, limit).unwrap_or(limit);
        Interval {
            lower: end(value - FARTHEST),
            upper: end(value + FARTHEST),
        }
    };
    Uncertain {
        value,
        error,
        interval_68: ends(NARROW),
        interval_95: ends(WIDE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::synthetic::{assert_coverage, exponential as unit_exponential, remission, watched};
    use proptest::prelude::*;

    fn weibull(randomness: &mut Randomness, mean: f64, shape: f64) -> f64 {
        let scale = mean / libm::tgamma(1.0 + 1.0 / shape);
        scale * libm::pow(unit_exponential(randomness), 1.0 / shape)
    }

    /// Sum of three exponential steps: gamma of shape 3.
    fn three_steps(randomness: &mut Randomness, mean: f64) -> f64 {
        (0..3).map(|_| unit_exponential(randomness)).sum::<f64>() * mean / 3.0
    }

    struct Coverage {
        name: &'static str,
        truth: f64,
        narrow: usize,
        wide: usize,
        pull_squares: f64,
    }

    impl Coverage {
        fn new(name: &'static str, truth: f64) -> Self {
            Self {
                name,
                truth,
                narrow: 0,
                wide: 0,
                pull_squares: 0.0,
            }
        }

        fn count(&mut self, found: Uncertain) {
            self.narrow += usize::from(found.interval_68.contains(self.truth));
            self.wide += usize::from(found.interval_95.contains(self.truth));
            let pull = libm::log(found.value / self.truth) * found.value / found.error;
            self.pull_squares += pull * pull;
        }

        fn judge(&self, trials: usize, slack: f64) {
            assert_coverage(self.narrow, trials, 0.6827, slack, self.name);
            assert_coverage(self.wide, trials, 0.95, slack, self.name);
            let spread = (self.pull_squares / trials as f64).sqrt();
            assert!((0.85..1.2).contains(&spread), "{}: {spread}", self.name);
        }
    }

    fn coverage(family: Family, shape: f64, until: f64, draw: impl Fn(&mut Randomness) -> f64) {
        let (trials, runs, mean) = (300, 50, 10.0);
        let variance = mean * mean * family.relative_variance(shape);
        let mut means = Coverage::new("mean", mean);
        let mut variances = Coverage::new("variance", variance);
        let mut shapes = Coverage::new("shape", shape);
        for seed in 0..trials {
            let mut randomness = Randomness::new(seed, 9);
            let sample: Vec<Transition> = (0..runs)
                .map(|_| watched(draw(&mut randomness), until))
                .collect();
            let fit = fit_lifetime(family, &sample).unwrap();
            means.count(fit.mean);
            variances.count(fit.variance);
            if let Some(shape) = fit.shape {
                shapes.count(shape);
            }
        }
        // Profile intervals of 50 runs fall short of their level by up to a hundredth or two.
        means.judge(trials as usize, 0.015);
        variances.judge(trials as usize, 0.015);
        if family != Family::Exponential {
            shapes.judge(trials as usize, 0.015);
        }
    }

    #[test]
    fn exponential_intervals_cover_with_a_third_censored() {
        coverage(Family::Exponential, 1.0, 11.0, |randomness| {
            10.0 * unit_exponential(randomness)
        });
    }

    #[test]
    fn weibull_intervals_cover_with_a_third_censored() {
        coverage(Family::Weibull, 1.8, 12.0, |randomness| {
            weibull(randomness, 10.0, 1.8)
        });
    }

    #[test]
    fn gamma_intervals_cover_with_a_third_censored() {
        coverage(Family::Gamma, 3.0, 11.5, |randomness| {
            three_steps(randomness, 10.0)
        });
    }

    #[test]
    fn the_textbook_example_as_other_programs_fit_it() {
        let fit = |family| fit_lifetime(family, &remission()).unwrap();
        let exponential = fit(Family::Exponential);
        assert!((exponential.mean.value - 359.0 / 9.0).abs() < 1e-9);
        // lifelines 0.30 (Weibull), a direct minimisation with scipy (gamma).
        let expected = [
            (Family::Weibull, 30.947_171, 1.353_731_6, -41.658_678_5),
            (Family::Gamma, 31.094_068, 1.677_008_9, -41.439_416_2),
        ];
        for (family, mean, shape, log_likelihood) in expected {
            let found = fit(family);
            assert!((found.mean.value / mean - 1.0).abs() < 1e-5);
            assert!((found.shape.unwrap().value / shape - 1.0).abs() < 1e-5);
            assert!((found.log_likelihood - log_likelihood).abs() < 1e-7);
            assert_eq!((found.observed, found.censored), (9, 12));
        }
        let shape_error = fit(Family::Weibull).shape.unwrap().error;
        assert!(
            (shape_error - 0.142_036_f64.sqrt()).abs() < 0.01,
            "{shape_error}"
        );
    }

    #[test]
    fn the_shape_tells_chance_from_determinism_and_the_criterion_finds_the_family() {
        let mut randomness = Randomness::new(2, 0);
        let mut sample = |shape: f64| -> Vec<Transition> {
            (0..300)
                .map(|_| watched(weibull(&mut randomness, 5.0, shape), 8.0))
                .collect()
        };
        let (chance, sharp) = (sample(1.0), sample(6.0));
        let shape =
            |runs: &[Transition]| fit_lifetime(Family::Weibull, runs).unwrap().shape.unwrap();
        assert!(shape(&chance).interval_95.contains(1.0));
        assert!(shape(&sharp).deviations_from(6.0).abs() < 3.0);
        assert!(shape(&sharp).interval_95.lower > 4.0);
        let akaike = |family, runs: &[Transition]| fit_lifetime(family, runs).unwrap().akaike();
        let exponential = akaike(Family::Exponential, &sharp);
        assert!(akaike(Family::Weibull, &sharp) < akaike(Family::Gamma, &sharp));
        assert!(akaike(Family::Gamma, &sharp) < exponential - 100.0);
        assert!(akaike(Family::Weibull, &chance) > akaike(Family::Exponential, &chance) - 4.0);
        let relative = fit_lifetime(Family::Weibull, &sharp)
            .unwrap()
            .relative_variance();
        let expected = Family::Weibull.relative_variance(6.0);
        assert!(relative.deviations_from(expected).abs() < 3.0);
        assert!(relative.interval_68.contains(relative.value) && relative.error < 0.02);
    }

    #[test]
    fn the_fit_follows_the_kaplan_meier_curve() {
        let mut randomness = Randomness::new(8, 0);
        let sample: Vec<Transition> = (0..500)
            .map(|_| watched(three_steps(&mut randomness, 4.0), 7.0))
            .collect();
        let fit = fit_lifetime(Family::Gamma, &sample).unwrap();
        let curve = crate::Survival::new(&sample).unwrap();
        for time in [1.0, 3.0, 5.0, 6.5] {
            assert!((fit.survival(time) - curve.at(time)).abs() < 0.05);
        }
        assert_eq!(fit.observed + fit.censored, 500);
    }

    #[test]
    fn what_cannot_be_fitted_is_refused() {
        let at = |time| Transition::At { time, period: 0 };
        let censored = Transition::Censored { time: 3.0 };
        for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
            let refused = fit_lifetime(family, &[censored; 5]);
            assert!(matches!(
                refused,
                Err(Error::TooFewObserved {
                    observed: 0,
                    runs: 5,
                    ..
                })
            ));
            assert!(fit_lifetime(family, &[]).is_err());
            assert!(matches!(
                fit_lifetime(family, &[at(0.0), at(1.0), at(2.0)]),
                Err(Error::NotPositive { index: 0, .. })
            ));
        }
        for family in [Family::Gamma, Family::Weibull] {
            assert_eq!(
                fit_lifetime(family, &[at(2.0); 6]),
                Err(Error::NoScatter { observed: 6 })
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]
        #[test]
        fn any_runs_give_finite_estimates_or_an_error(
            times in prop::collection::vec((-4.0..4.0_f64, any::<bool>()), 0..20),
            odd in prop::option::of(prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(-1.0)]),
        ) {
            let mut runs: Vec<Transition> = times
                .iter()
                .map(|&(log, observed)| {
                    let time = libm::exp(2.0 * log);
                    if observed {
                        Transition::At { time, period: 0 }
                    } else {
                        Transition::Censored { time }
                    }
                })
                .collect();
            if let Some(time) = odd {
                runs.push(Transition::Censored { time });
            }
            for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
                if let Ok(fit) = fit_lifetime(family, &runs) {
                    prop_assert!(odd.is_none());
                    for number in [Some(fit.mean), Some(fit.variance), fit.shape].into_iter().flatten() {
                        prop_assert!(number.value > 0.0 && number.value.is_finite());
                        prop_assert!(number.error > 0.0 && number.error.is_finite());
                        prop_assert!(number.interval_68.contains(number.value));
                        prop_assert!(number.interval_95.lower <= number.interval_68.lower * 1.001);
                    }
                }
            }
        }
    }
}
