//! Whether the transition time diverges: laws compared by their likelihood.

use crate::error::Error;
use crate::family::Family;
use crate::law::Law;
use crate::law_likelihood::{LawLikelihood, RunTable};
use crate::scatter_law::largest_with_scatter;
use crate::transition::Transition;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the runs say for one law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LawEvidence {
    /// The law.
    pub law: Law,
    /// Largest log-likelihood.
    pub log_likelihood: f64,
    /// Akaike's criterion 2 p - 2 ln L.
    pub akaike: f64,
    /// Akaike's criterion minus the criterion of the best law: beyond some 10 the law has next to no support.
    pub excess: f64,
    /// Akaike weight exp(-excess/2) over the sum of all laws compared: how probable it is to be the nearest of them.
    pub weight: f64,
    /// Best w_c, infinite where the law does best as an exponential one; `None` for a law without w_c.
    pub critical_width: Option<f64>,
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
    compare(laws, |law| {
        let likelihood = LawLikelihood::new(law, family, &table.places, &table.runs)?;
        let best = likelihood.largest()?;
        let critical = likelihood.critical_width(&best);
        let parameters = law.parameters_with(family);
        Ok((best.log_likelihood, parameters, critical))
    })
}

/// As [`compare_laws`], with a scatter that changes toward the critical width, as the scatter of jams does.
///
/// Gamma distributions about the mean, whose relative variance goes as (w_c - w)^-q, or as exp(-q w) in a law without
/// w_c, q free: two parameters of the scatter for every law. With a constant scatter, rejected by runs as a rule
/// ([`ScatterLawFit::constant_probability`](crate::ScatterLawFit::constant_probability)), the runs near w_c count too
/// much, and may choose the wrong law.
///
/// # Errors
/// Those of [`compare_laws`].
///
/// ```
/// use peristalsis_analysis::{Law, Transition, compare_laws_with_scatter};
/// // Two runs each of 5, 10, 15, 20 and 40 per cent about 1/(3 - w).
/// let width = [2.0, 2.0, 2.5, 2.5, 2.75, 2.75, 2.875, 2.875, 2.9375, 2.9375];
/// let time = [0.95, 1.05, 1.8, 2.2, 3.4, 4.6, 6.4, 9.6, 9.6, 22.4];
/// let runs = time.map(|time| Transition::At { time, period: 0 });
/// let evidence = compare_laws_with_scatter(&[Law::Power, Law::Exponential], &width, &runs)?;
/// assert!(evidence[0].excess == 0.0 && evidence[1].excess > 10.0);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn compare_laws_with_scatter(
    laws: &[Law],
    width: &[f64],
    transitions: &[Transition],
) -> Result<Vec<LawEvidence>, Error> {
    let table = RunTable::new(width, transitions)?;
    compare(laws, |law| {
        let common = LawLikelihood::new(law, Family::Gamma, &table.places, &table.runs)?;
        let (log_likelihood, critical) = largest_with_scatter(&common)?;
        Ok((log_likelihood, law.parameters() + 2, critical))
    })
}

/// Evidence for laws from the largest log-likelihood, the number of parameters and the w_c of each.
fn compare(
    laws: &[Law],
    largest: impl Fn(Law) -> Result<(f64, usize, f64), Error>,
) -> Result<Vec<LawEvidence>, Error> {
    let evidence_of = |&law: &Law| {
        let (log_likelihood, parameters, critical) = largest(law)?;
        Ok(LawEvidence {
            law,
            log_likelihood,
            akaike: 2.0 * parameters as f64 - 2.0 * log_likelihood,
            excess: 0.0,
            weight: 0.0,
            critical_width: law.is_critical().then_some(critical),
        })
    };
    let mut evidence: Vec<_> = laws.iter().map(evidence_of).collect::<Result<_, Error>>()?;
    let criteria = evidence.iter().map(|evidence| evidence.akaike);
    let least = criteria.fold(f64::INFINITY, f64::min);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::{exponential, runs_at};

    #[test]
    fn the_law_that_made_the_runs_has_the_least_criterion() {
        let laws = [Law::Power, Law::Barrier { power: 1.0 }, Law::Exponential];
        let places = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|k| 2.43 + 0.04 * f64::from(k));
        // Runs at ten widths up to 2.79 with a mean that depends on the width.
        let best = |mean: fn(f64) -> f64| {
            let mut randomness = Randomness::new(3, 8);
            let time = |place| mean(place) * exponential(&mut randomness);
            let (width, runs) = runs_at(&places, 400, 2000.0, time);
            let evidence = compare_laws(&laws, Family::Exponential, &width, &runs).unwrap();
            let total: f64 = evidence.iter().map(|evidence| evidence.weight).sum();
            assert!((total - 1.0).abs() < 1e-12);
            evidence
        };
        let found = best(|place| 10.0 / (2.8 - place));
        assert_eq!(found[0].excess, 0.0, "{found:?}");
        assert!(found[2].excess > 10.0 && found[0].weight > 0.9);
        assert!((found[0].critical_width.unwrap() - 2.8).abs() < 0.01);
        let found = best(|place| 20.0 * libm::exp(8.0 * (place - 2.43)));
        // The others do as well only by moving w_c far away, and pay for it.
        assert!(found[2].excess < 2.0, "{found:?}");
        assert_eq!(found[2].critical_width, None);
        assert!(best(|place| libm::exp(1.0 / (3.05 - place)))[1].excess < 4.0);
    }

    /// Laws were compared with a constant scatter, which the runs reject.
    #[test]
    fn laws_are_told_apart_where_the_scatter_grows() {
        let laws = [Law::Power, Law::Barrier { power: 1.0 }, Law::Exponential];
        let places = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|k| 2.43 + 0.04 * f64::from(k));
        let evidence = |seed: u64, mean: fn(f64) -> f64, shape: fn(f64) -> f64| {
            let mut randomness = Randomness::new(seed, 9);
            let time = |place| mean(place) * Family::Gamma.draw(shape(place), &mut randomness);
            let (width, runs) = runs_at(&places, 60, 5000.0, time);
            let grown = compare_laws_with_scatter(&laws, &width, &runs).unwrap();
            (
                grown,
                compare_laws(&laws, Family::Gamma, &width, &runs).unwrap(),
            )
        };
        for seed in 0..3 {
            let power = |place: f64| 10.0 / (2.8 - place);
            let (grown, common) = evidence(seed, power, |place| (2.8 - place) / 0.03);
            assert!(grown[0].excess < 2.0 && grown[2].excess > 10.0, "{grown:?}");
            assert!((grown[0].critical_width.unwrap() - 2.8).abs() < 0.01);
            // Two more parameters of the scatter are worth it.
            assert!(
                grown[0].akaike < common[0].akaike - 20.0,
                "{grown:?} {common:?}"
            );
            let growth = |place: f64| 20.0 * libm::exp(8.0 * (place - 2.43));
            let shape = |place: f64| 30.0 * libm::exp(-8.0 * (place - 2.43));
            let (grown, _) = evidence(seed, growth, shape);
            assert!(grown[2].excess < 4.0, "{grown:?}");
        }
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let censored = [Transition::Censored { time: 1.0 }; 5];
        let width = [2.0, 2.1, 2.2, 2.3, 2.4];
        assert_refused!(
            compare_laws(&[Law::Power], Family::Exponential, &width, &censored) =>
            TooFewPlaces { found: 0, .. }
        );
        assert!(
            compare_laws(&[], Family::Exponential, &[], &[])
                .unwrap()
                .is_empty()
        );
    }
}
