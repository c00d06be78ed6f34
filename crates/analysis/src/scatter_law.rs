//! Mean and scatter of the transition times fitted together, both as powers of the distance from w_c.

use crate::error::Error;
use crate::family::{Family, LN_SHAPE_BOUNDS};
use crate::law::Law;
use crate::law_likelihood::{Largest, LawLikelihood, RunTable};
use crate::numerics::gamma::chi_squared_tail;
use crate::numerics::linear::{Cholesky, curvature, error_of};
use crate::numerics::simplex::{Lowest, nelder_mead};
use crate::transition::Transition;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// First steps in ln(w_c - w), ln k and q.
const STEPS: [f64; 3] = [0.3, 0.3, 0.5];
/// Tolerance relative to the steps, and most evaluations of a search.
const TOLERANCE: f64 = 1e-4;
const EVALUATIONS: usize = 600;
/// ln L, in units of 1/2, by which a search may fall short of its maximum and still count as converged.
const SLACK: f64 = 1e-3;

/// Power laws of the mean transition time and of its relative variance, fitted to the runs at all widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScatterLawFit {
    /// Critical width w_c; intervals normal in ln(w_c - largest width that saw a transition).
    pub critical_width: Uncertain,
    /// alpha of tau ~ (w_c - w)^-alpha. Intervals of alpha, q and beta are normal: where the largest width that saw a
    /// transition is far from w_c, those of 95 per cent cover 87 to 90.
    pub exponent: Uncertain,
    /// q of chi_tau/tau^2 ~ (w_c - w)^-q.
    pub scatter_exponent: Uncertain,
    /// beta = 2 alpha + q of chi_tau ~ (w_c - w)^-beta.
    pub variance_exponent: Uncertain,
    /// ln A of tau = A (w_c - w)^-alpha.
    pub ln_amplitude: f64,
    /// ln C of chi_tau/tau^2 = C (w_c - w)^-q.
    pub ln_scatter: f64,
    /// Largest log-likelihood; five parameters.
    pub log_likelihood: f64,
    /// Probability of so large a likelihood ratio if chi_tau/tau^2 = 1 at all widths: nucleation at a constant rate.
    pub chance_probability: f64,
    /// The same if chi_tau/tau^2 has one value at all widths, q = 0.
    pub constant_probability: f64,
    /// The same if chi_tau/tau^2 ~ 1/(w_c - w), q = 1.
    pub inverse_probability: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
}

/// Likelihood of gamma distributions whose shape changes toward w_c, on the runs of the likelihood with one shape.
struct ScatterLikelihood<'a>(&'a LawLikelihood);

impl ScatterLikelihood<'_> {
    /// Minus the log-likelihood, a and b at (ln(w_c - top), ln k at one span, q); at a given exponent where there is
    /// one. The shape is a power q of the distance from w_c; `exp(q distance)` of that from the largest width with a
    /// transition where the law has no w_c.
    fn at(&self, [place, ln_shape, q]: [f64; 3], exponent: Option<f64>) -> (f64, f64, f64) {
        let LawLikelihood {
            law,
            places,
            groups,
            range,
            ..
        } = self.0;
        let critical = range.critical(place);
        let nowhere = (f64::INFINITY, f64::NAN, f64::NAN);
        let below = self.0.below(critical);
        let mut likelihoods = Vec::with_capacity(below);
        for (&place, group) in places[..below].iter().zip(groups) {
            let distance = match law.is_critical() {
                true => libm::log((critical - place) / range.span),
                false => (range.top - place) / range.span,
            };
            let ln_shape = ln_shape + q * distance;
            let possible = ln_shape > LN_SHAPE_BOUNDS.0 && ln_shape < LN_SHAPE_BOUNDS.1;
            if !possible {
                return nowhere;
            }
            likelihoods.push(group.at_shape(Family::Gamma, libm::exp(ln_shape)));
        }
        let regression = self.0.regression(&likelihoods, place);
        match exponent {
            Some(exponent) => (-regression.at_slope(exponent), f64::NAN, exponent),
            None => {
                let (a, b, value) = regression.largest();
                (-value, a, b)
            }
        }
    }

    /// The best of all three parameters, from the best with a common shape.
    fn best(&self, start: Largest) -> Option<Lowest> {
        let range = self.0.range;
        // A constant scatter may put w_c far off, or even at infinity, where a growing one does not.
        let place = start.ln_distance.min(libm::log(range.span));
        let found = [0.0, 1.0].map(|q| match self.0.law.is_critical() {
            true => self.lowest(&[place, start.ln_shape, q], |p| [p[0], p[1], p[2]]),
            false => self.lowest(&[start.ln_shape, q], |p| [0.0, p[0], p[1]]),
        });
        let found = found.into_iter().min_by(|a, b| a.value.total_cmp(&b.value));
        found.filter(|best| best.value.is_finite())
    }

    /// Search for the minimum from a start, begun afresh until it stays.
    fn lowest(&self, start: &[f64], full: impl Fn(&[f64]) -> [f64; 3]) -> Lowest {
        let objective = |parameters: &[f64]| self.at(full(parameters), None).0;
        let mut steps = STEPS[..start.len()].to_vec();
        let mut best = nelder_mead(objective, start, &steps, TOLERANCE, EVALUATIONS);
        for _ in 0..4 {
            for step in &mut steps {
                *step *= -0.5;
            }
            let again = nelder_mead(objective, &best.place, &steps, TOLERANCE, EVALUATIONS);
            let gain = best.value - again.value;
            if gain > 0.0 {
                best = again;
            }
            if gain < SLACK {
                break;
            }
        }
        best
    }
}

/// Largest log-likelihood of a law whose scatter changes toward w_c, and that w_c, infinite where it has run away.
pub(crate) fn largest_with_scatter(common: &LawLikelihood) -> Result<(f64, f64), Error> {
    let best = ScatterLikelihood(common).best(common.largest()?);
    let best = best.ok_or_else(|| common.undetermined())?;
    let critical = match common.range.is_beyond(best.place[0]) {
        true => f64::INFINITY,
        false => common.range.critical(best.place[0]),
    };
    Ok((-best.value, critical))
}

/// Fits power laws of the mean and of the relative variance of the transition times to the runs at all widths.
///
/// `tau = A (w_c - w)^-alpha`,   `chi_tau/tau^2 = C (w_c - w)^-q`,   gamma distributions of shape tau^2/chi_tau
///
/// Maximum likelihood under censoring, one row per run. Where the scatter grows toward w_c a common shape as in
/// [`fit_law_to_runs`](crate::fit_law_to_runs) is wrong just where runs are censored and moves w_c and alpha; here it
/// is fitted along. Standard errors from the observed information; intervals in the normal approximation, that of w_c
/// in its logarithmic distance. The three probabilities are of likelihood ratios against chi^2 with 2 (chance), 1 and 1
/// degrees of freedom, and hold from some hundred transitions on. Source: Kalbfleisch & Prentice, The Statistical
/// Analysis of Failure Time Data (2002), chapter 3.
///
/// # Errors
/// [`Error::TooFewPlaces`] where fewer than 3 widths saw a transition, [`Error::NoScatter`], [`Error::Undetermined`]
/// where the likelihood has no maximum inside (w_c at infinity, no curvature), and those of a table of runs.
pub fn fit_law_with_scatter(
    width: &[f64],
    transitions: &[Transition],
) -> Result<ScatterLawFit, Error> {
    let table = RunTable::new(width, transitions)?;
    let common = LawLikelihood::new(Law::Power, Family::Gamma, &table.places, &table.runs)?;
    let chance = LawLikelihood::new(Law::Power, Family::Exponential, &table.places, &table.runs)?;
    let undetermined = Error::undetermined(width.len(), 5);
    let likelihood = ScatterLikelihood(&common);
    let range = common.range;
    let start = common.largest().map_err(|_| undetermined)?;
    let chance = chance.largest().map_err(|_| undetermined)?;
    let best = likelihood
        .best(start)
        .filter(|best| !range.is_beyond(best.place[0]))
        .ok_or(undetermined)?;
    let parameters = [best.place[0], best.place[1], best.place[2]];
    let (deficit, ln_amplitude, exponent) = likelihood.at(parameters, None);
    let covariance = covariance(&likelihood, parameters, exponent).ok_or(undetermined)?;
    let start = [parameters[0], parameters[1]];
    let at_q = |q: f64| likelihood.lowest(&start, |p| [p[0], p[1], q]).value;
    let probability =
        |worse: f64, free: usize| chi_squared_tail(2.0 * (worse - deficit).max(0.0), free);
    let error = |weights: [f64; 4]| error_of(&weights, &covariance);
    let [place, _, q] = parameters;
    let place_error = error([0.0, 1.0, 0.0, 0.0]);
    let ln_distance = Uncertain::normal(place, place_error);
    let critical = |place| range.critical(place);
    let observed = common.observed();
    Ok(ScatterLawFit {
        critical_width: ln_distance.map(libm::exp(place) * place_error, critical),
        exponent: Uncertain::normal(exponent, error([1.0, 0.0, 0.0, 0.0])),
        scatter_exponent: Uncertain::normal(q, error([0.0, 0.0, 0.0, 1.0])),
        variance_exponent: Uncertain::normal(2.0 * exponent + q, error([2.0, 0.0, 0.0, 1.0])),
        ln_amplitude,
        ln_scatter: -parameters[1] + q * libm::log(range.span),
        log_likelihood: -deficit,
        chance_probability: probability(-chance.log_likelihood, 2),
        constant_probability: probability(at_q(0.0), 1),
        inverse_probability: probability(at_q(1.0), 1),
        observed,
        censored: width.len() - observed,
    })
}

/// Covariance of (alpha, ln(w_c - top), ln k, q) from the curvature of the likelihood, the amplitude at its best.
fn covariance(
    likelihood: &ScatterLikelihood<'_>,
    [place, ln_shape, q]: [f64; 3],
    exponent: f64,
) -> Option<[[f64; 4]; 4]> {
    // Steps well below the errors, well above the accuracy of the likelihood.
    let step = 0.1 / (likelihood.0.observed() as f64).sqrt();
    let information = curvature(
        |p: &[f64; 4]| likelihood.at([p[1], p[2], p[3]], Some(p[0])).0,
        &[exponent, place, ln_shape, q],
        &[step; 4],
    );
    let finite = information.iter().flatten().all(|entry| entry.is_finite());
    Some(finite.then(|| Cholesky::new(&information))??.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::fit_law_to_runs;
    use crate::tests::{Coverage, assert_coverage, runs_at};

    /// tau = 10/(2.8 - w) with chi_tau/tau^2 = C (2.8 - w)^-q, 20 runs at ten widths, watched for 500.
    fn runs(seed: u64, constant: f64, q: f64) -> (Vec<f64>, Vec<Transition>) {
        let mut randomness = Randomness::new(seed, 11);
        let places = [2.3, 2.4, 2.5, 2.6, 2.65, 2.7, 2.74, 2.77, 2.79, 2.83];
        runs_at(&places, 20, 500.0, |place| {
            let distance = 2.8 - place;
            if distance <= 0.0 {
                return f64::INFINITY;
            }
            let shape = libm::pow(distance, q) / constant;
            10.0 / distance * Family::Gamma.draw(shape, &mut randomness)
        })
    }

    #[test]
    fn intervals_of_all_exponents_cover_where_the_scatter_grows() {
        let trials = 80;
        let mut coverage = Coverage::of([("w_c", 2.8), ("alpha", 1.0), ("q", 1.0), ("beta", 3.0)]);
        let (mut inverse_rejected, mut constant_rejected) = (0, 0);
        for seed in 0..trials {
            // From 0.06 at 2.3 to 3 at 2.79.
            let (width, runs) = runs(seed, 0.03, 1.0);
            let found = fit_law_with_scatter(&width, &runs).unwrap();
            coverage.count([
                found.critical_width,
                found.exponent,
                found.scatter_exponent,
                found.variance_exponent,
            ]);
            inverse_rejected += usize::from(found.inverse_probability < 0.1);
            constant_rejected += usize::from(found.constant_probability < 0.01);
            assert!(found.chance_probability < 0.01);
        }
        coverage.judge([0.03; 2]);
        let trials = trials as usize;
        assert_coverage(
            inverse_rejected,
            trials,
            0.1,
            0.03,
            "false rejections of q = 1",
        );
        assert!(constant_rejected > trials * 9 / 10, "{constant_rejected}");
    }

    #[test]
    fn chance_is_recognised() {
        let trials = 60;
        let (mut rejected, mut inverse) = (0, 0);
        for seed in 0..trials {
            let (width, runs) = runs(seed, 1.0, 0.0);
            let found = fit_law_with_scatter(&width, &runs).unwrap();
            rejected += usize::from(found.chance_probability < 0.1);
            inverse += usize::from(found.inverse_probability < 0.01);
        }
        assert_coverage(rejected, trials as usize, 0.1, 0.03, "false rejections");
        assert!(inverse > 50, "{inverse}");
    }

    #[test]
    fn a_common_shape_is_biased_where_this_is_not() {
        let trials = 20;
        let (mut here, mut common) = (0.0, 0.0);
        for seed in 100..100 + trials {
            let (width, runs) = runs(seed, 0.03, 1.0);
            let found = fit_law_with_scatter(&width, &runs).unwrap();
            here += (found.exponent.value - 1.0) / trials as f64;
            let shared = fit_law_to_runs(Law::Power, Family::Gamma, &width, &runs);
            common += shared.map_or(1.0, |fit| fit.exponent.value - 1.0) / trials as f64;
            let distance = found.critical_width.value - 2.5;
            let at = |amplitude: f64, exponent: f64| amplitude.exp() * distance.powf(-exponent);
            let mean = at(found.ln_amplitude, found.exponent.value);
            let relative_variance = at(found.ln_scatter, found.scatter_exponent.value);
            assert!((mean * 0.03 - 1.0).abs() < 0.4 && relative_variance < 0.3);
            assert_eq!(found.observed + found.censored, 200);
        }
        assert!(here.abs() < 0.06, "{here}");
        assert!(common.abs() > 2.0 * here.abs(), "{common} {here}");
    }

    #[test]
    fn too_few_widths_are_refused() {
        let at = |time| Transition::At { time, period: 0 };
        assert_refused!(
            fit_law_with_scatter(&[2.0, 2.1], &[at(1.0), at(2.0)]) =>
            TooFewPlaces { needed: 3, .. }
        );
        let single = [at(1.0), at(2.0), at(4.0)];
        assert_eq!(
            fit_law_with_scatter(&[2.0, 2.1, 2.2], &single),
            Err(Error::NoScatter { observed: 3 })
        );
    }
}
