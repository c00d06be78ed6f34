//! The ensembles of a study, one a width, with every estimate of their transition times side by side.

use crate::columns::{by_width, mean_of};
use crate::error::Error;
use crate::family::Family;
use crate::law_likelihood::RunTable;
use crate::lifetime::{LifetimeFit, fit_lifetime};
use crate::survival::{RestrictedMoments, restricted_moments};
use crate::transition::Transition;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Transition times of the runs at one width, estimated in three ways.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WidthEnsemble {
    /// Width w.
    pub width: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
    /// Longest time at which a run was watched.
    pub watched: f64,
    /// Mean of the observed times alone, which near w_c lies below the truth for want of the long ones; `None` without
    /// any.
    pub naive_mean: Option<f64>,
    /// Mean and variance of min(tau, `watched`): no distribution assumed. `None` below 3 transitions.
    pub restricted: Option<RestrictedMoments>,
    /// Maximum likelihood under censoring, chi_tau its variance; `None` where it has no estimate (no transition, no
    /// scatter).
    pub fit: Option<LifetimeFit>,
}

impl WidthEnsemble {
    /// Part of the runs with an observed transition.
    pub fn observed_fraction(&self) -> f64 {
        self.observed as f64 / (self.observed + self.censored) as f64
    }
}

/// Sorts a table of runs by width and estimates the transition times of each.
///
/// One row per run, `width` beside `transitions`; answers in order of width. Columns for [`fit_law`](crate::fit_law) and
/// its scatter follow from `fit`: mean, variance chi_tau, relative variance with errors.
///
/// # Errors
/// [`Error::LengthMismatch`], [`Error::NonFinite`], [`Error::NotPositive`], [`Error::Negative`].
///
/// ```
/// use peristalsis_analysis::{Family, Transition, ensembles_by_width};
/// let at = |time| Transition::At { time, period: 0 };
/// let runs = [at(1.0), at(3.0), Transition::Censored { time: 4.0 }, at(2.0)];
/// let found = ensembles_by_width(Family::Exponential, &[2.7, 2.8, 2.8, 2.7], &runs)?;
/// assert_eq!((found[1].width, found[1].observed, found[1].censored), (2.8, 1, 1));
/// assert_eq!(found[1].naive_mean, Some(3.0));
/// assert!((found[1].fit.unwrap().mean.value - 7.0).abs() < 1e-9);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn ensembles_by_width(
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<Vec<WidthEnsemble>, Error> {
    let table = RunTable::new(width, transitions)?;
    let (_, transitions) = by_width(width, transitions);
    let ensemble = |(width, runs): (f64, Vec<Transition>)| {
        let times: Vec<f64> = runs.iter().filter_map(|run| run.observed()).collect();
        let watched = runs.iter().map(|run| run.time().0).fold(0.0, f64::max);
        WidthEnsemble {
            width,
            observed: times.len(),
            censored: runs.len() - times.len(),
            watched,
            naive_mean: (!times.is_empty()).then(|| mean_of(&times)),
            restricted: restricted_moments(&runs, watched).ok(),
            fit: fit_lifetime(family, &runs).ok(),
        }
    };
    let groups = table.places.into_iter().zip(transitions);
    Ok(groups.map(ensemble).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::watched;

    #[test]
    fn the_bias_of_dropping_censored_runs_grows_toward_the_critical_width() {
        let mut randomness = Randomness::new(6, 0);
        let (mut width, mut runs) = (Vec::new(), Vec::new());
        // Interleaved, so that the rows are not in order of width.
        for _ in 0..200 {
            for place in [2.79, 2.5, 2.75, 2.9] {
                let mean = if place < 2.8 {
                    1.0 / (2.8 - place)
                } else {
                    1e9
                };
                width.push(place);
                let time = mean * Family::Gamma.draw(2.0, &mut randomness);
                runs.push(watched(time, 30.0));
            }
        }
        let found = ensembles_by_width(Family::Gamma, &width, &runs).unwrap();
        let widths: Vec<f64> = found.iter().map(|ensemble| ensemble.width).collect();
        assert_eq!(widths, [2.5, 2.75, 2.79, 2.9]);
        let shortfall = |k: usize| found[k].naive_mean.unwrap() / found[k].fit.unwrap().mean.value;
        assert!((shortfall(0) - 1.0).abs() < 0.02);
        assert!(
            shortfall(1) < 0.9 && shortfall(2) < 0.35,
            "{}",
            shortfall(2)
        );
        // The fit is right where the plain mean is not; the restricted mean stops at the horizon.
        assert!(found[2].fit.unwrap().mean.deviations_from(100.0).abs() < 3.0);
        assert!(found[1].fit.unwrap().mean.deviations_from(20.0).abs() < 3.0);
        assert!(found[2].restricted.unwrap().mean.value < 30.0);
        assert_eq!(
            (found[3].observed, found[3].fit, found[3].naive_mean),
            (0, None, None)
        );
    }
}
