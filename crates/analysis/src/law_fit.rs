//! Critical width and exponent from values with errors at several widths.

use crate::columns::{distinct, mean_of};
use crate::error::{Error, check_known, check_points, checked_positive, enough_places};
use crate::law::{CriticalRange, Law};
use crate::numerics::gamma::chi_squared_tail;
use crate::numerics::linear::{Cholesky, add_information, least_squares};
use crate::numerics::minimum::minimise_from_grid;
use crate::uncertain::{Interval, Uncertain};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tolerance of the minimum in ln(w_c - w).
const TOLERANCE: f64 = 1e-6;

/// A law fitted to values with errors at several widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LawFit {
    /// The law.
    pub law: Law,
    /// Critical width w_c, with intervals by the profile of chi^2; `None` for a law without one. An upper end of
    /// infinity says that the points do not tell the law from an exponential.
    pub critical_width: Option<Uncertain>,
    /// Exponent, or coefficient of the barrier, B, with intervals by the profile of chi^2.
    pub exponent: Uncertain,
    /// ln A, in the normal approximation.
    pub ln_amplitude: Uncertain,
    /// Sum of the squared deviations of ln y in units of their errors, the term of a known w_c included.
    pub chi_squared: f64,
    /// Points less free parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a chi^2 at least as large if the law and the errors are right.
    pub probability: f64,
}

/// Points with everything that a fit needs of them.
struct Points<'a> {
    law: Law,
    width: &'a [f64],
    ln_value: Vec<f64>,
    weight: Vec<f64>,
    known: Option<Uncertain>,
    range: CriticalRange,
}

/// chi^2 at one w_c, with ln A and B.
#[derive(Clone, Copy)]
struct AtCritical {
    chi_squared: f64,
    ln_amplitude: f64,
    exponent: f64,
}

impl Points<'_> {
    /// The known w_c where it counts as a point.
    fn known_with_error(&self) -> Option<Uncertain> {
        self.known.filter(|known| known.error > 0.0)
    }

    /// Squared deviation of a w_c from its known value in units of its error.
    fn deviation(&self, critical: f64) -> f64 {
        let score = self
            .known_with_error()
            .map(|known| known.deviations_from(critical));
        score.map_or(0.0, |score| score * score)
    }

    /// The best line at a w_c; `None` where it has none.
    fn line(&self, critical: f64) -> Option<AtCritical> {
        let covariate = |&width: &f64| self.law.covariate(width, critical);
        let x: Vec<f64> = self.width.iter().map(covariate).collect();
        let centre = mean_of(&x);
        let fit = least_squares(|i| [1.0, x[i] - centre], &self.ln_value, &self.weight)?;
        let [middle, exponent] = fit.coefficients;
        Some(AtCritical {
            chi_squared: fit.chi_squared + self.deviation(critical),
            ln_amplitude: middle - exponent * centre,
            exponent,
        })
    }

    /// chi^2 at a w_c and an exponent, over all amplitudes.
    fn at_exponent(&self, critical: f64, exponent: f64) -> f64 {
        let (ln_value, weight, points) = (&self.ln_value, &self.weight, 0..self.width.len());
        let rest = |i: usize| ln_value[i] - exponent * self.law.covariate(self.width[i], critical);
        let total: f64 = weight.iter().sum();
        let mean = points.clone().map(|i| weight[i] * rest(i)).sum::<f64>() / total;
        let squared = |i: usize| weight[i] * (rest(i) - mean) * (rest(i) - mean);
        points.map(squared).sum::<f64>() + self.deviation(critical)
    }

    fn chi_squared(&self, critical: f64) -> f64 {
        let line = self.line(critical);
        line.map_or(f64::INFINITY, |line| line.chi_squared)
    }

    /// Grid of ln(w_c - top), the known value among it.
    fn grid(&self) -> Vec<f64> {
        let mut grid = self.range.grid();
        if let Some(known) = self.known.filter(|known| known.value > self.range.top) {
            grid.push(self.range.ln_distance(known.value));
            grid.sort_by(f64::total_cmp);
        }
        grid
    }

    /// Covariance of (ln A, B, w_c) from the information of the linearised law.
    fn covariance(&self, critical: f64, exponent: f64) -> Option<[[f64; 3]; 3]> {
        let mut information = [[0.0; 3]; 3];
        for (&width, &weight) in self.width.iter().zip(&self.weight) {
            let slopes = [
                1.0,
                self.law.covariate(width, critical),
                exponent * self.law.covariate_slope(width, critical),
            ];
            add_information(&mut information, weight, &slopes);
        }
        if let Some(known) = self.known_with_error() {
            information[2][2] += 1.0 / (known.error * known.error);
        }
        Cholesky::new(&information).map(|factor| factor.inverse())
    }
}

/// Fits a law to values with errors at several widths.
///
/// Minimum over ln A, B and w_c of `chi^2 = sum_i (ln y_i - ln A - B x_i(w_c))^2 y_i^2/error_i^2` (+ ((w_c -
/// known)/error)^2); x as [`Law`] states. At given w_c this is a straight line, solved exactly; what remains is a
/// search in ln(w_c - w_max) from a grid, so that the least of several minima is found. `known`: a critical width from
/// elsewhere with its error (0 to hold it fixed), as for the exponent of chi_tau or of a peak at the w_c of tau; `None`
/// to fit it. Intervals of w_c and B by the profile of chi^2 (+1 and +3.84), standard errors from its curvature. w_c
/// and B are strongly correlated, and errors of some 20 per cent or more bias ln y: prefer
/// [`fit_law_to_runs`](crate::fit_law_to_runs) where the runs are at hand. Source: Seber & Wild, Nonlinear Regression
/// (1989), sections 5.4 and 14.7.
///
/// # Errors
/// [`Error::TooFewPlaces`] with fewer distinct widths than free parameters, [`Error::BeyondCritical`] for a width above
/// a known w_c without error, [`Error::Undetermined`] where the best w_c lies at infinity (the points follow an
/// exponential law), [`Error::LengthMismatch`], [`Error::NonFinite`], [`Error::NotPositive`],
/// [`Error::Negative`] for the error of a known w_c.
///
/// ```
/// use peristalsis_analysis::{Law, fit_law};
/// let width = [2.0, 2.5, 2.75, 2.875];
/// let time = [1.0, 2.0, 4.0, 8.0];
/// let fit = fit_law(Law::Power, &width, &time, &[0.1, 0.2, 0.4, 0.8], None)?;
/// assert!((fit.critical_width.unwrap().value - 3.0).abs() < 1e-4);
/// assert!((fit.exponent.value - 1.0).abs() < 1e-3);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_law(
    law: Law,
    width: &[f64],
    value: &[f64],
    error: &[f64],
    known: Option<Uncertain>,
) -> Result<LawFit, Error> {
    check_points(width, value, error)?;
    checked_positive(value)?;
    if let Law::Barrier { power } = law {
        checked_positive(&[power])?;
    }
    if let Some(known) = known {
        check_known(known)?;
    }
    let fixed = known.filter(|known| known.error <= 0.0);
    let free = fixed.map_or(law.parameters(), |_| 2);
    // A known w_c with an error is a point beside the others.
    let needed = if known.is_some() { 2 } else { law.parameters() };
    enough_places(distinct(width).len(), needed)?;
    let top = width.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let relative = value.iter().zip(error).map(|(value, error)| value / error);
    let points = Points {
        law,
        width,
        ln_value: value.iter().map(|&value| libm::log(value)).collect(),
        weight: relative.map(|ratio| ratio * ratio).collect(),
        known: known.filter(|_| law.is_critical()),
        range: CriticalRange::new(width, top),
    };
    let counted = width.len() + usize::from(known.is_some() && fixed.is_none());
    let undetermined = Error::undetermined(width.len(), free);
    match (law.is_critical(), fixed) {
        (false, _) => at_fixed(&points, 0.0).ok_or(undetermined),
        (true, Some(known)) if known.value <= top => Err(Error::BeyondCritical {
            width: top,
            critical: known.value,
        }),
        (true, Some(known)) => at_fixed(&points, known.value).ok_or(undetermined),
        (true, None) => at_best(&points, counted - free).ok_or(undetermined),
    }
}

/// A law fitted to the values at the largest widths alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NearestFit {
    /// How many widths, the largest ones.
    pub widths: usize,
    /// The least of them.
    pub least: f64,
    /// The fit.
    pub fit: LawFit,
}

/// Fits a law to the values at the k largest widths, for every k: the exponent against the window.
///
/// From one width more than the law has free parameters (4 with w_c free, 3 with a `known` one) up to all. An exponent
/// that moves with the window by more than its error is an effective exponent: it describes the window, not w_c. The fits share
/// their values and do not scatter independently. Windows without a fit are left out.
///
/// # Errors
/// Those of [`fit_law`] for all values.
///
/// ```
/// use peristalsis_analysis::{Law, fit_law_to_nearest};
/// // 1/tau = d + d^2 with d = 3 - w: alpha goes to 1 as the window closes.
/// let distance = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
/// let width = distance.map(|d| 3.0 - d);
/// let time = distance.map(|d| 1.0 / (d + d * d));
/// let fits = fit_law_to_nearest(Law::Power, &width, &time, &time.map(|t| 0.01 * t), None)?;
/// let exponents: Vec<f64> = fits.iter().map(|one| one.fit.exponent.value).collect();
/// assert_eq!((fits[0].widths, fits[0].least, exponents.len()), (4, 2.75, 3));
/// assert!(exponents[0] < exponents[1] && exponents[1] < exponents[2] && exponents[0] > 1.0);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_law_to_nearest(
    law: Law,
    width: &[f64],
    value: &[f64],
    error: &[f64],
    known: Option<Uncertain>,
) -> Result<Vec<NearestFit>, Error> {
    let whole = fit_law(law, width, value, error, known)?;
    let places = distinct(width);
    let free = if known.is_some() { 2 } else { law.parameters() };
    let nearest = |widths: usize| {
        let least = places[places.len() - widths];
        let fit = if widths == places.len() {
            whole
        } else {
            let rows: Vec<usize> = (0..width.len()).filter(|&i| width[i] >= least).collect();
            let of = |column: &[f64]| -> Vec<f64> { rows.iter().map(|&i| column[i]).collect() };
            fit_law(law, &of(width), &of(value), &of(error), known).ok()?
        };
        Some(NearestFit { widths, least, fit })
    };
    Ok((free + 1..=places.len()).filter_map(nearest).collect())
}

/// The fit at a w_c that is fixed or does not matter.
fn at_fixed(points: &Points<'_>, critical: f64) -> Option<LawFit> {
    let line = points.line(critical)?;
    let x = |i: usize| points.law.covariate(points.width[i], critical);
    let fit = least_squares(|i| [1.0, x(i)], &points.ln_value, &points.weight)?;
    let degrees_of_freedom = points.width.len() - 2;
    let [[amplitude_variance, _], [_, exponent_variance]] = fit.covariance;
    Some(LawFit {
        law: points.law,
        critical_width: points.known,
        exponent: Uncertain::normal(line.exponent, exponent_variance.sqrt()),
        ln_amplitude: Uncertain::normal(line.ln_amplitude, amplitude_variance.sqrt()),
        chi_squared: line.chi_squared,
        degrees_of_freedom,
        probability: chi_squared_tail(line.chi_squared, degrees_of_freedom),
    })
}

/// The fit at the best w_c.
fn at_best(points: &Points<'_>, degrees_of_freedom: usize) -> Option<LawFit> {
    let range = points.range;
    let grid = points.grid();
    let at_distance = |ln_distance: f64| points.chi_squared(range.critical(ln_distance));
    let best = minimise_from_grid(at_distance, &grid, TOLERANCE)?;
    if range.is_beyond(best.place) {
        return None;
    }
    let critical = range.critical(best.place);
    let line = points.line(critical)?;
    let covariance = points.covariance(critical, line.exponent)?;
    let [amplitude_error, exponent_error, critical_error] =
        [0, 1, 2].map(|k| covariance[k][k].max(0.0).sqrt());
    let least = line.chi_squared;
    let excess = |chi_squared: f64, deviations: f64| chi_squared - least - deviations * deviations;
    let ends_of_critical = |deviations: f64| {
        let outside = |place: f64| excess(at_distance(place), deviations);
        let step = (deviations * critical_error / (critical - range.top)).clamp(1e-6, 1.0);
        range.interval(best.place, outside, step)
    };
    let ends_of_exponent = |deviations: f64| {
        let outside = |exponent: f64| {
            let at_distance = |place| points.at_exponent(range.critical(place), exponent);
            let least = minimise_from_grid(at_distance, &grid, 1e-4);
            excess(least.map_or(f64::INFINITY, |least| least.value), deviations)
        };
        let step = deviations * exponent_error;
        let limits = [line.exponent - 200.0 * step, line.exponent + 200.0 * step];
        Interval::around(line.exponent, outside, step, limits, Interval::OPEN)
    };
    let critical_width = Uncertain::with_intervals(critical, critical_error, ends_of_critical);
    Some(LawFit {
        law: points.law,
        critical_width: Some(critical_width),
        exponent: Uncertain::with_intervals(line.exponent, exponent_error, ends_of_exponent),
        ln_amplitude: Uncertain::normal(line.ln_amplitude, amplitude_error),
        chi_squared: line.chi_squared,
        degrees_of_freedom,
        probability: chi_squared_tail(line.chi_squared, degrees_of_freedom),
    })
}

#[cfg(test)]
mod tests;
