//! Critical width and exponent straight from the runs at all widths, censored ones included.

use crate::error::{Error, ensure};
use crate::family::Family;
use crate::law::Law;
use crate::law_likelihood::{LawLikelihood, RunTable};
use crate::transition::Transition;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A law of the mean transition time fitted to the runs at all widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LawRunsFit {
    /// The law of the mean.
    pub law: Law,
    /// The family of the distribution about the mean.
    pub family: Family,
    /// Critical width w_c; `None` for a law without one. Its lower end never lies below a width that saw a transition;
    /// an upper end of infinity says that the runs do not tell the law from an exponential.
    pub critical_width: Option<Uncertain>,
    /// Exponent, or coefficient of the barrier, B.
    pub exponent: Uncertain,
    /// ln A.
    pub ln_amplitude: f64,
    /// Shape k, common to all widths; `None` for the exponential family.
    pub shape: Option<Uncertain>,
    /// Largest log-likelihood.
    pub log_likelihood: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
}

/// A law fitted to the runs within a window of widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindowRunsFit {
    /// Smallest width of the window.
    pub least: f64,
    /// Largest width of the window.
    pub largest: f64,
    /// The fit.
    pub fit: LawRunsFit,
}

/// Fits a law of the mean transition time to the runs at all widths by maximum likelihood.
///
/// `ln L = sum_observed ln f(t_i; tau(w_i), k) + sum_censored ln S(t_i; tau(w_i), k)`
///
/// f and S of a [`Family`] with mean tau(w) by a [`Law`] and a shape k common to all widths; one row per run, `width`
/// beside `transitions`. Censored runs count with the time that they were watched, so that w_c is not drawn toward the
/// widths where few runs were long enough; runs at w >= w_c say nothing, and w_c lies above every width that saw a
/// transition. At given w_c and k the likelihood is concave in (ln A, B) and solved by Newton's method; w_c is searched
/// from a grid. Intervals by profile likelihood (1/2 and 1.92 below the largest), the standard error being half of the
/// narrow one (infinite where that is open). All of it assumes the family. A wrong one biases w_c and B where runs are
/// censored (its tail stands for the times that were not seen): compare families by Akaike's 2 p - 2 ln L, p parameters.
/// Without censoring below w_c it only misjudges the errors. Source: Kalbfleisch & Prentice, The Statistical Analysis of
/// Failure Time Data (2002), chapter 3 (regression under censoring); Venzon & Moolgavkar, Appl. Stat. 37, 87 (1988)
/// (profile likelihood).
///
/// # Errors
/// [`Error::TooFewPlaces`] where fewer widths saw a transition than the law has parameters, [`Error::NoScatter`],
/// [`Error::Undetermined`] where the best w_c lies at infinity or the shape at its bounds, [`Error::LengthMismatch`],
/// [`Error::NonFinite`], [`Error::NotPositive`], [`Error::Negative`].
///
/// ```
/// use peristalsis_analysis::{Family, Law, Transition, fit_law_to_runs};
/// // tau = 1/(3 - w), one run a width; the last one saw no end in its time.
/// let width = [2.0, 2.5, 2.75, 2.875, 3.1];
/// let mut runs = [1.0, 2.0, 4.0, 8.0].map(|time| Transition::At { time, period: 0 }).to_vec();
/// runs.push(Transition::Censored { time: 50.0 });
/// let fit = fit_law_to_runs(Law::Power, Family::Exponential, &width, &runs)?;
/// assert!((fit.critical_width.unwrap().value - 3.0).abs() < 0.01);
/// assert!((fit.exponent.value - 1.0).abs() < 0.05);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_law_to_runs(
    law: Law,
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<LawRunsFit, Error> {
    let table = RunTable::new(width, transitions)?;
    fit_places(law, family, &table.places, &table.runs)
}

fn fit_places(
    law: Law,
    family: Family,
    places: &[f64],
    runs: &[Vec<(f64, bool)>],
) -> Result<LawRunsFit, Error> {
    let likelihood = LawLikelihood::new(law, family, places, runs)?;
    let best = likelihood.largest()?;
    ensure(!best.is_beyond, likelihood.undetermined())?;
    let (critical_width, exponent, shape) = likelihood.profiles(&best);
    let observed = likelihood.observed();
    Ok(LawRunsFit {
        law,
        family,
        critical_width,
        exponent,
        ln_amplitude: best.ln_amplitude,
        shape,
        log_likelihood: best.log_likelihood,
        observed,
        censored: likelihood.runs - observed,
    })
}

/// Fits a law in windows that leave out the smallest, then the largest widths one by one.
///
/// The first window holds all widths. An asymptotic law fits ever better as small widths, far from w_c, are left out,
/// and its exponent settles; a trend beyond the errors says that the exponent is not the asymptotic one. The fits share
/// their runs and do not scatter independently. Windows without a fit are left out.
///
/// # Errors
/// Those of [`fit_law_to_runs`] for all runs.
pub fn fit_law_to_runs_in_windows(
    law: Law,
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<Vec<WindowRunsFit>, Error> {
    let RunTable { places, runs } = RunTable::new(width, transitions)?;
    let fit_window = |window: Range<usize>| {
        let (places, runs) = (&places[window.clone()], &runs[window]);
        fit_places(law, family, places, runs).map(|fit| WindowRunsFit {
            least: places[0],
            largest: places[places.len() - 1],
            fit,
        })
    };
    let number = places.len();
    let without_smallest = (1..number).map(|first| first..number);
    let without_largest = (1..number).rev().map(|end| 0..end);
    let windows = without_smallest.chain(without_largest);
    let whole = fit_window(0..number)?;
    let others = windows.filter_map(|window| fit_window(window).ok());
    Ok([whole].into_iter().chain(others).collect())
}

#[cfg(test)]
mod tests;
