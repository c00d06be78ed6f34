//! Whether the transition time diverges: power law or barrier, and how its scatter grows.

use crate::bootstrap::{Bootstrap, LEAST_RESAMPLES};
use crate::error::{Error, checked_positive, same_length};
use crate::family::{Family, LN_SHAPE_BOUNDS};
use crate::law::Law;
use crate::law_fit::{LawFit, fit_law};
use crate::law_likelihood::{Largest, LawLikelihood, RunTable};
use crate::numerics::gamma::chi_squared_tail;
use crate::transition::Transition;
use crate::uncertain::Uncertain;
use serde::{Deserialize, Serialize};

/// What the runs say for one law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawEvidence {
    /// The law.
    pub law: Law,
    /// Largest log-likelihood.
    pub log_likelihood: f64,
    /// Akaike's criterion 2 p - 2 ln L.
    pub akaike: f64,
    /// Akaike's criterion less that of the best law: beyond some 10 the law has next to no support.
    pub excess: f64,
    /// Akaike weight exp(-excess/2) over the sum of all laws compared: how probable it is to be the nearest of them.
    pub weight: f64,
    /// Best w_c, infinite where the law does best as an exponential one; `None` for a law without w_c.
    pub critical_width: Option<f64>,
}

/// Likelihood ratio of two laws with its distribution under either.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LikelihoodRatio {
    /// `ln L(first) - ln L(second)`: positive where the runs speak for the first law.
    pub ratio: f64,
    /// Probability, if the first law is right, of a ratio at most as large: small speaks against the first.
    pub probability_if_first: f64,
    /// Probability, if the second law is right, of a ratio at least as large: small speaks against the second.
    pub probability_if_second: f64,
    /// Simulated data sets behind each probability, which is known to `sqrt(p (1 - p)/n)`.
    pub simulations: usize,
}

/// How the relative variance chi_tau/tau^2 depends on the distance from w_c.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScatterTest {
    /// chi^2 against chi_tau/tau^2 = 1, with as many degrees of freedom as points.
    pub chance: f64,
    /// Probability of so large a chi^2 if jams begin by chance at a constant rate.
    pub chance_probability: f64,
    /// chi^2 against C/(w_c - w), with one degree of freedom less; w_c at its value.
    pub inverse: f64,
    /// Probability of so large a chi^2 if chi_tau ~ (w_c - w)^-3 and tau ~ (w_c - w)^-1.
    pub inverse_probability: f64,
    /// Fit of C (w_c - w)^-q with free q, the error of w_c included: q = 0 for chance, 1 for the claims F2 with F4.
    pub power: LawFit,
}

/// Compares laws of the mean transition time by their likelihood under censoring.
///
/// A law that diverges at w_c (power, barrier) against one that grows without end but does not diverge (exponential);
/// all with the same `family` about the mean and a common shape. Akaike's criterion charges each parameter 2. On widths
/// that stay far from w_c the laws look alike, and the excess says so. Source: Burnham & Anderson, Model Selection and
/// Multimodel Inference (2002), section 2.6 and 2.9.
///
/// # Errors
/// [`Error::TooFewPlaces`] where fewer widths saw a transition than a law has parameters, [`Error::Undetermined`] for a
/// law without a maximum, else as for [`fit_law_to_runs`](crate::fit_law_to_runs).
///
/// ```
/// use peristalsis_analysis::{Family, Law, Transition, compare_laws};
/// let width = [2.0, 2.5, 2.75, 2.875];
/// let runs = [1.0, 2.0, 4.0, 8.0].map(|time| Transition::At { time, period: 0 });
/// let evidence = compare_laws(&[Law::Power, Law::Exponential], Family::Exponential, &width, &runs)?;
/// // Four runs: the power law fits better, yet not by what its third parameter costs.
/// assert!(evidence[0].log_likelihood > evidence[1].log_likelihood);
/// assert!(evidence[1].excess == 0.0 && evidence[0].excess < 2.0);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn compare_laws(
    laws: &[Law],
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<Vec<LawEvidence>, Error> {
    let table = RunTable::new(width, transitions)?;
    let mut evidence = laws
        .iter()
        .map(|&law| {
            let (likelihood, best) = fitted(law, family, &table)?;
            let parameters = law.parameters() + family.parameters() - 1;
            Ok(LawEvidence {
                law,
                log_likelihood: best.log_likelihood,
                akaike: 2.0 * parameters as f64 - 2.0 * best.log_likelihood,
                excess: 0.0,
                weight: 0.0,
                critical_width: law.is_critical().then(|| likelihood.critical_width(&best)),
            })
        })
        .collect::<Result<Vec<_>, Error>>()?;
    let least = evidence
        .iter()
        .map(|evidence| evidence.akaike)
        .fold(f64::INFINITY, f64::min);
    for evidence in &mut evidence {
        evidence.excess = evidence.akaike - least;
        evidence.weight = libm::exp(-0.5 * evidence.excess);
    }
    let total: f64 = evidence.iter().map(|evidence| evidence.weight).sum();
    for evidence in &mut evidence {
        evidence.weight /= total;
    }
    Ok(evidence)
}

fn fitted(law: Law, family: Family, table: &RunTable) -> Result<(LawLikelihood, Largest), Error> {
    let likelihood = LawLikelihood::new(law, family, &table.places, &table.runs)?;
    let best = likelihood
        .largest(LN_SHAPE_BOUNDS)
        .ok_or(Error::Undetermined {
            points: table.count(),
            parameters: law.parameters() + family.parameters() - 1,
        })?;
    Ok((likelihood, best))
}

/// Tests two laws, neither a special case of the other, by simulating data sets from the best fit of each.
///
/// The ratio of the likelihoods is compared with its distribution over data sets simulated under the first and under
/// the second law, with the same widths and run lengths and both laws fitted again to each: the runs may reject one,
/// both or neither. `horizon`: the time for which each run was or would have been watched, one a run (for a censored
/// run the time of censoring). Simulated sets to which a law cannot be fitted are left out. Sources: Cox, J. R. Stat.
/// Soc. B 24, 406 (1962); by simulation: Williams, Biometrics 26, 23 (1970).
///
/// # Errors
/// Those of [`compare_laws`]; [`Error::NotPositive`] for a horizon, [`Error::TooFewResamples`].
pub fn likelihood_ratio(
    laws: [Law; 2],
    family: Family,
    width: &[f64],
    transitions: &[Transition],
    horizon: &[f64],
    bootstrap: Bootstrap,
) -> Result<LikelihoodRatio, Error> {
    same_length(width.len(), horizon.len())?;
    checked_positive(horizon)?;
    let table = RunTable::new(width, transitions)?;
    let horizons: Vec<Vec<f64>> = table
        .places
        .iter()
        .map(|&place| {
            let here = width
                .iter()
                .zip(horizon)
                .filter(|(width, _)| **width == place);
            here.map(|(_, &horizon)| horizon).collect()
        })
        .collect();
    let [first, second] = laws;
    let fits = [
        fitted(first, family, &table)?,
        fitted(second, family, &table)?,
    ];
    let ratio = fits[0].1.log_likelihood - fits[1].1.log_likelihood;
    let mut probabilities = [0.0; 2];
    let mut simulations = bootstrap.resamples;
    for (which, (truth, best)) in fits.iter().enumerate() {
        let seed = bootstrap.seed ^ which as u64;
        let (mut extreme, mut succeeded) = (0_usize, 0_usize);
        for mut randomness in (Bootstrap { seed, ..bootstrap }).streams()? {
            let simulated = RunTable {
                places: table.places.clone(),
                runs: truth.simulate(best, &horizons, &mut randomness),
            };
            let pair = fitted(first, family, &simulated)
                .and_then(|first| Ok((first.1, fitted(second, family, &simulated)?.1)));
            if let Ok((first, second)) = pair {
                let simulated_ratio = first.log_likelihood - second.log_likelihood;
                succeeded += 1;
                extreme += usize::from(if which == 0 {
                    simulated_ratio <= ratio
                } else {
                    simulated_ratio >= ratio
                });
            }
        }
        if succeeded < LEAST_RESAMPLES {
            return Err(Error::TooFewResamples {
                needed: LEAST_RESAMPLES,
                found: succeeded,
            });
        }
        // The data set itself is one more, so that no probability is 0.
        probabilities[which] = (extreme + 1) as f64 / (succeeded + 1) as f64;
        simulations = simulations.min(succeeded);
    }
    Ok(LikelihoodRatio {
        ratio,
        probability_if_first: probabilities[0],
        probability_if_second: probabilities[1],
        simulations,
    })
}

/// Tests the relative variance of the transition times against 1 and against 1/(w_c - w).
///
/// Claims F2 and F4 together imply `chi_tau/tau^2 ~ (w_c - w)^(2 alpha - beta) = 1/(w_c - w)`, which grows without
/// bound; nucleation by chance at a constant rate has exactly 1, at any width; a deterministic approach less than 1.
/// `ratio` with `error`: chi_tau/tau^2 at each width, as from
/// [`LifetimeFit::relative_variance`](crate::LifetimeFit::relative_variance); reckoned in logarithms. `critical`: w_c
/// from elsewhere. [`fit_law_with_scatter`](crate::fit_law_with_scatter) asks the same of all runs at once, without an
/// estimate at each width.
///
/// # Errors
/// [`Error::BeyondCritical`] for a width at or above w_c, else as for [`fit_law`].
///
/// ```
/// use peristalsis_analysis::{Uncertain, scatter_test};
/// // chi_tau/tau^2 = 1/(3 - w), each to 10 per cent.
/// let found = scatter_test(
///     &[2.5, 2.75, 2.875],
///     &[2.0, 4.0, 8.0],
///     &[0.2, 0.4, 0.8],
///     Uncertain::normal(3.0, 0.0),
/// )?;
/// assert!(found.inverse < 1e-9 && found.chance_probability < 1e-9);
/// assert!((found.power.exponent.value - 1.0).abs() < 1e-9);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn scatter_test(
    width: &[f64],
    ratio: &[f64],
    error: &[f64],
    critical: Uncertain,
) -> Result<ScatterTest, Error> {
    let power = fit_law(Law::Power, width, ratio, error, Some(critical))?;
    if let Some(&width) = width.iter().find(|&&width| width >= critical.value) {
        return Err(Error::BeyondCritical {
            width,
            critical: critical.value,
        });
    }
    // Deviation of ln ratio from 0, and from -ln(w_c - w), with its weight.
    let rows: Vec<(f64, f64, f64)> = (0..width.len())
        .map(|i| {
            let ln_ratio = libm::log(ratio[i]);
            let weight = (ratio[i] / error[i]) * (ratio[i] / error[i]);
            (
                ln_ratio,
                ln_ratio + libm::log(critical.value - width[i]),
                weight,
            )
        })
        .collect();
    let chance: f64 = rows
        .iter()
        .map(|(flat, _, weight)| weight * flat * flat)
        .sum();
    let total: f64 = rows.iter().map(|row| row.2).sum();
    let ln_constant = rows
        .iter()
        .map(|(_, rest, weight)| weight * rest)
        .sum::<f64>()
        / total;
    let inverse: f64 = rows
        .iter()
        .map(|(_, rest, weight)| weight * (rest - ln_constant) * (rest - ln_constant))
        .sum();
    Ok(ScatterTest {
        chance,
        chance_probability: chi_squared_tail(chance, rows.len()),
        inverse,
        inverse_probability: chi_squared_tail(inverse, rows.len() - 1),
        power,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::ensembles_by_width;
    use crate::synthetic::{assert_coverage, watched};

    const POWER: Law = Law::Power;
    const BARRIER: Law = Law::Barrier { power: 1.0 };

    /// Runs at ten widths up to 2.79 with a mean that depends on the width.
    fn runs(
        seed: u64,
        replicas: usize,
        until: f64,
        family: Family,
        mean_and_shape: impl Fn(f64) -> (f64, f64),
    ) -> (Vec<f64>, Vec<Transition>) {
        let mut randomness = Randomness::new(seed, 8);
        let (mut width, mut runs) = (Vec::new(), Vec::new());
        for k in 0..10 {
            let place = 2.43 + 0.04 * f64::from(k);
            let (mean, shape) = mean_and_shape(place);
            for _ in 0..replicas {
                width.push(place);
                runs.push(watched(mean * family.draw(shape, &mut randomness), until));
            }
        }
        (width, runs)
    }

    fn power(place: f64) -> (f64, f64) {
        (10.0 / (2.8 - place), 1.0)
    }

    fn barrier(place: f64) -> (f64, f64) {
        (libm::exp(1.0 / (3.05 - place)), 1.0)
    }

    fn exponential(place: f64) -> (f64, f64) {
        (20.0 * libm::exp(8.0 * (place - 2.43)), 1.0)
    }

    #[test]
    fn the_law_that_made_the_runs_has_the_least_criterion() {
        let laws = [POWER, BARRIER, Law::Exponential];
        let family = Family::Exponential;
        let best = |truth: &dyn Fn(f64) -> (f64, f64)| {
            let (width, runs) = runs(3, 400, 2000.0, family, truth);
            let evidence = compare_laws(&laws, family, &width, &runs).unwrap();
            let total: f64 = evidence.iter().map(|evidence| evidence.weight).sum();
            assert!((total - 1.0).abs() < 1e-12);
            evidence
        };
        let found = best(&power);
        assert_eq!(found[0].excess, 0.0, "{found:?}");
        assert!(found[2].excess > 10.0 && found[0].weight > 0.9);
        assert!((found[0].critical_width.unwrap() - 2.8).abs() < 0.01);
        let found = best(&exponential);
        // The others do as well only by moving w_c far away, and pay for it.
        assert!(found[2].excess < 2.0, "{found:?}");
        assert_eq!(found[2].critical_width, None);
        assert!(best(&barrier)[1].excess < 4.0);
    }

    #[test]
    fn the_ratio_rejects_the_wrong_law_and_keeps_the_right_one() {
        let family = Family::Exponential;
        let bootstrap = Bootstrap {
            resamples: 60,
            seed: 2,
        };
        let (width, runs) = runs(5, 200, 1500.0, family, power);
        let horizon = vec![1500.0; width.len()];
        let laws = [POWER, Law::Exponential];
        let found = likelihood_ratio(laws, family, &width, &runs, &horizon, bootstrap).unwrap();
        assert!(found.ratio > 5.0);
        assert!(found.probability_if_second < 0.05 && found.probability_if_first > 0.05);
        assert_eq!(found.simulations, 60);
    }

    #[test]
    fn the_probabilities_are_uniform_under_the_law_that_holds() {
        let family = Family::Exponential;
        let trials = 60;
        let mut low = 0;
        for seed in 0..trials {
            let bootstrap = Bootstrap {
                resamples: 39,
                seed: 1000 + seed,
            };
            let (width, runs) = runs(seed, 10, 300.0, family, power);
            let horizon = vec![300.0; width.len()];
            let found =
                likelihood_ratio([POWER, BARRIER], family, &width, &runs, &horizon, bootstrap);
            low += usize::from(found.unwrap().probability_if_first <= 0.3);
        }
        assert_coverage(low, trials as usize, 0.3, 0.03, "probability if first");
    }

    #[test]
    fn chance_and_growing_scatter_are_told_apart() {
        let critical = Uncertain::normal(2.8, 0.002);
        let test = |truth: &dyn Fn(f64) -> (f64, f64)| {
            let (width, runs) = runs(4, 60, 1e6, Family::Gamma, truth);
            let found = ensembles_by_width(Family::Gamma, &width, &runs).unwrap();
            let ratio: Vec<Uncertain> = found
                .iter()
                .map(|ensemble| ensemble.fit.unwrap().relative_variance())
                .collect();
            let column = |pick: &dyn Fn(&Uncertain) -> f64| ratio.iter().map(pick).collect();
            let places: Vec<f64> = found.iter().map(|ensemble| ensemble.width).collect();
            let values: Vec<f64> = column(&|ratio| ratio.value);
            let errors: Vec<f64> = column(&|ratio| ratio.error);
            scatter_test(&places, &values, &errors, critical).unwrap()
        };
        let chance = test(&power);
        assert!(chance.chance_probability > 0.01, "{chance:?}");
        assert!(chance.inverse_probability < 1e-4);
        assert!(chance.power.exponent.deviations_from(0.0).abs() < 3.0);
        // chi_tau/tau^2 = 0.03/(2.8 - w): from 0.08 to 3.
        let growing = test(&|place| (10.0 / (2.8 - place), (2.8 - place) / 0.03));
        assert!(growing.chance_probability < 1e-4, "{growing:?}");
        assert!(growing.inverse_probability > 0.005);
        assert!(growing.power.exponent.deviations_from(1.0).abs() < 3.0);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let critical = Uncertain::normal(2.5, 0.01);
        assert_eq!(
            scatter_test(&[2.4, 2.45, 2.6], &[1.0; 3], &[0.1; 3], critical),
            Err(Error::BeyondCritical {
                width: 2.6,
                critical: 2.5
            })
        );
        let censored = [Transition::Censored { time: 1.0 }; 5];
        let width = [2.0, 2.1, 2.2, 2.3, 2.4];
        assert!(matches!(
            compare_laws(&[POWER], Family::Exponential, &width, &censored),
            Err(Error::TooFewPlaces { found: 0, .. })
        ));
        assert!(
            compare_laws(&[], Family::Exponential, &[], &[])
                .unwrap()
                .is_empty()
        );
    }
}
