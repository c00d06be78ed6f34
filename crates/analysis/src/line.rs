//! Straight lines, parabolas and powers through points with errors.

use crate::columns::distinct;
use crate::error::{Error, check_points, checked_positive, enough_places};
use crate::numerics::gamma::{chi_squared_tail, two_sided_tail};
use crate::numerics::linear::{LeastSquares, error_of, least_squares};
use crate::numerics::student::two_sided_tail as student_tail;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A straight line through points with errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LineFit {
    /// Value at x = 0.
    pub intercept: Uncertain,
    /// Slope.
    pub slope: Uncertain,
    /// Covariance of intercept and slope.
    pub covariance: f64,
    /// Sum of the squared deviations in units of their errors.
    pub chi_squared: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a chi^2 at least as large if the line and the errors are right; 1 without degrees of freedom.
    pub probability: f64,
}

/// A parabola through points with errors, beside the straight line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurveFit {
    /// Value of the parabola at x = 0.
    pub constant: Uncertain,
    /// Its slope at x = 0.
    pub linear: Uncertain,
    /// Coefficient of x^2.
    pub quadratic: Uncertain,
    /// chi^2 of the parabola.
    pub chi_squared: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a chi^2 at least as large if the parabola and the errors are right.
    pub probability: f64,
    /// The straight line through the same points.
    pub line: LineFit,
    /// Probability of a quadratic term at least as large, of either sign, if the points lie on a line.
    pub linearity: f64,
}

/// A straight line through points that scatter about it by more than their errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScatteredLine {
    /// The line; its errors are those of points and scatter, the intervals of intercept and slope Student's.
    pub line: LineFit,
    /// R^2, the part of the weighted variance of y that the line explains.
    pub determination: f64,
    /// Probability of a quadratic term at least as large if the points scatter about a line: F-test of line against
    /// parabola; `None` with three places, through which every parabola goes.
    pub linearity: Option<f64>,
}

impl LineFit {
    /// Value of the line at x with its error.
    pub fn at(&self, x: f64) -> Uncertain {
        let variance = self.intercept.error * self.intercept.error
            + 2.0 * x * self.covariance
            + x * x * self.slope.error * self.slope.error;
        let value = self.intercept.value + self.slope.value * x;
        Uncertain::normal(value, variance.max(0.0).sqrt())
    }

    /// Factor by which the errors of the points would have to grow for chi^2 to equal its expectation; 1 at least.
    ///
    /// Errors of the parameters grow alike: Birge, Phys. Rev. 40, 207 (1932).
    pub fn scale_factor(&self) -> f64 {
        let reduced = self.chi_squared / self.degrees_of_freedom.max(1) as f64;
        reduced.sqrt().max(1.0)
    }
}

/// Weights of checked columns with at least so many distinct places.
fn weights(x: &[f64], y: &[f64], error: &[f64], parameters: usize) -> Result<Vec<f64>, Error> {
    check_points(x, y, error)?;
    enough_places(distinct(x).len(), parameters)?;
    Ok(error.iter().map(|error| 1.0 / (error * error)).collect())
}

/// Weighted mean of the places, from which powers are reckoned so that their sums stay well conditioned.
fn centre(x: &[f64], weight: &[f64]) -> f64 {
    let total: f64 = weight.iter().sum();
    let sum: f64 = x.iter().zip(weight).map(|(x, weight)| x * weight).sum();
    sum / total
}

/// Straight line y = intercept + slope x through points with known errors of y.
///
/// Minimum of `chi^2 = sum_i (y_i - intercept - slope x_i)^2/error_i^2`. Errors from the errors of the points, not from
/// their scatter; normal intervals, exact for normal errors. Serves w_c(epsdot) = slope epsdot + w_max. Source:
/// Bevington & Robinson, Data Reduction and Error Analysis (2003), chapter 6.
///
/// # Errors
/// [`Error::TooFewPlaces`] below 2 distinct x, [`Error::LengthMismatch`], [`Error::NonFinite`], [`Error::NotPositive`]
/// for an error, [`Error::Undetermined`] for places or errors beyond floating point.
///
/// ```
/// use peristalsis_analysis::fit_line;
/// let fit = fit_line(&[0.0, 1.0, 2.0], &[1.0, 2.0, 6.0], &[1.0, 1.0, 1.0])?;
/// assert!((fit.slope.value - 2.5).abs() < 1e-12 && (fit.intercept.value - 0.5).abs() < 1e-12);
/// // Deviations 1/2, -1, 1/2.
/// assert!((fit.chi_squared - 1.5).abs() < 1e-12);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_line(x: &[f64], y: &[f64], error: &[f64]) -> Result<LineFit, Error> {
    let weight = weights(x, y, error, 2)?;
    let centre = centre(x, &weight);
    let fit = solved(least_squares(|i| [1.0, x[i] - centre], y, &weight), x.len())?;
    let [middle, slope] = fit.coefficients;
    let [[middle_variance, mixed], [_, slope_variance]] = fit.covariance;
    let intercept_variance =
        middle_variance - 2.0 * centre * mixed + centre * centre * slope_variance;
    let degrees_of_freedom = x.len() - 2;
    Ok(LineFit {
        intercept: Uncertain::normal(middle - slope * centre, intercept_variance.sqrt()),
        slope: Uncertain::normal(slope, slope_variance.sqrt()),
        covariance: mixed - centre * slope_variance,
        chi_squared: fit.chi_squared,
        degrees_of_freedom,
        probability: chi_squared_tail(fit.chi_squared, degrees_of_freedom),
    })
}

/// Parabola through points with known errors of y, and whether its quadratic term is needed.
///
/// `y = constant + linear x + quadratic x^2`
///
/// `linearity` is the two-sided probability of quadratic/error(quadratic), which equals the chi^2 test of the
/// difference between line and parabola with one degree of freedom. Errors as for [`fit_line`].
///
/// # Errors
/// [`Error::TooFewPlaces`] below 3 distinct x, else as for [`fit_line`].
pub fn fit_parabola(x: &[f64], y: &[f64], error: &[f64]) -> Result<CurveFit, Error> {
    let weight = weights(x, y, error, 3)?;
    let centre = centre(x, &weight);
    let basis = |i: usize| {
        let from_centre: f64 = x[i] - centre;
        [1.0, from_centre, from_centre * from_centre]
    };
    let fit = solved(least_squares(basis, y, &weight), x.len())?;
    let [a, b, c] = fit.coefficients;
    // Row k: coefficient of x^k in terms of the centred ones.
    let back = [
        [1.0, -centre, centre * centre],
        [0.0, 1.0, -2.0 * centre],
        [0.0, 0.0, 1.0],
    ];
    let coefficient = |row: usize| {
        let [p, q, r] = back[row];
        Uncertain::normal(p * a + q * b + r * c, error_of(&back[row], &fit.covariance))
    };
    let quadratic = coefficient(2);
    let degrees_of_freedom = x.len() - 3;
    Ok(CurveFit {
        constant: coefficient(0),
        linear: coefficient(1),
        quadratic,
        chi_squared: fit.chi_squared,
        degrees_of_freedom,
        probability: chi_squared_tail(fit.chi_squared, degrees_of_freedom),
        line: fit_line(x, y, error)?,
        linearity: two_sided_tail(quadratic.deviations_from(0.0)),
    })
}

/// Straight line through points that scatter by more than their errors `error` (0 where nothing is known of them).
///
/// Each point gets the error `(error_i^2 + s^2)^(1/2)`, with the scatter s at which `chi^2` about the line is n - 2, or 0 where
/// the errors suffice. With errors of 0 all points weigh alike, as one draws a line through them. Intercept and slope follow
/// Student's distribution of n - 2 degrees of freedom; whether the points bend is asked by the F-test of the quadratic term
/// with n - 3, in the same weights. Source: Paule & Mandel, J. Res. Natl. Bur. Stand. 87, 377 (1982); Bevington & Robinson,
/// Data Reduction and Error Analysis (2003), chapters 6 and 11.
///
/// # Errors
/// [`Error::TooFewPlaces`] below 3 distinct x, [`Error::NotPositive`] for an error below 0, else as for [`fit_line`].
///
/// ```
/// use peristalsis_analysis::fit_line_to_scatter;
/// let fit = fit_line_to_scatter(&[0.0, 1.0, 2.0], &[1.0, 2.0, 6.0], &[0.0; 3])?;
/// // chi^2 = 3/2 with one degree of freedom: the slope's variance is 3/4, Student's 95 per cent are 12.7 errors.
/// assert!((fit.line.slope.error - 0.75_f64.sqrt()).abs() < 1e-12);
/// assert!((fit.line.slope.interval_95.length() / fit.line.slope.error - 2.0 * 12.706).abs() < 1e-3);
/// assert!((fit.determination - (1.0 - 1.5 / 14.0)).abs() < 1e-12 && fit.linearity.is_none());
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_line_to_scatter(x: &[f64], y: &[f64], error: &[f64]) -> Result<ScatteredLine, Error> {
    check_points(x, y, &vec![1.0; x.len()])?;
    // Errors of 0 are none.
    let positive = |error: &f64| if *error == 0.0 { 1.0 } else { *error };
    check_points(x, y, &error.iter().map(positive).collect::<Vec<_>>())?;
    enough_places(distinct(x).len(), 3)?;
    let total = scattered_errors(x, y, error)?;
    let mut line = fit_line(x, y, &total)?;
    let freedom = line.degrees_of_freedom;
    let student = |one: Uncertain| Uncertain::student(one.value, one.error, freedom);
    (line.intercept, line.slope) = (student(line.intercept), student(line.slope));
    let weight: Vec<f64> = total.iter().map(|error| 1.0 / (error * error)).collect();
    let mean = centre(y, &weight);
    let squares = y.iter().zip(&weight);
    let all: f64 = squares.map(|(y, weight)| weight * (y - mean).powi(2)).sum();
    let linearity = (distinct(x).len() > 3).then(|| {
        let bent = fit_parabola(x, y, &total)?;
        let gain = (line.chi_squared - bent.chi_squared).max(0.0);
        let variance = bent.chi_squared.max(1e-200) / bent.degrees_of_freedom as f64;
        let score = (gain / variance).sqrt();
        Ok(student_tail(score, bent.degrees_of_freedom))
    });
    Ok(ScatteredLine {
        line,
        determination: if all > 0.0 {
            1.0 - line.chi_squared / all
        } else {
            0.0
        },
        linearity: linearity.transpose()?,
    })
}

/// The errors with the least scatter of their own that makes chi^2 about the line n - 2 at most.
fn scattered_errors(x: &[f64], y: &[f64], error: &[f64]) -> Result<Vec<f64>, Error> {
    let with = |scatter: f64| -> Vec<f64> {
        // Points on a line have no scatter, but errors must be positive.
        let total = |error: &f64| error.hypot(scatter).max(1e-100);
        error.iter().map(total).collect()
    };
    let alike = fit_line(x, y, &vec![1.0; x.len()])?;
    let freedom = alike.degrees_of_freedom as f64;
    // With this scatter chi^2 is n - 2 at most whatever the errors are, and just that without errors.
    let (mut least, mut most) = (0.0, (alike.chi_squared / freedom).sqrt());
    if error.iter().any(|error| *error > 0.0) {
        while most - least > 1e-12 * most {
            let middle = 0.5 * (least + most);
            match fit_line(x, y, &with(middle))?.chi_squared > freedom {
                true => least = middle,
                false => most = middle,
            }
        }
    }
    Ok(with(most))
}

/// Exponent of a power law y = A x^slope, as a line through the logarithms.
///
/// `ln y = intercept + slope ln x`, the error of ln y being error/y; `intercept` is ln A. For errors above some 20 per
/// cent the logarithm of a mean is biased downward by half of its squared relative error. Serves tau against L.
///
/// # Errors
/// [`Error::NotPositive`] for an x, a y or an error, else as for [`fit_line`].
pub fn power_exponent(x: &[f64], y: &[f64], error: &[f64]) -> Result<LineFit, Error> {
    check_points(x, y, error)?;
    let logarithms =
        |column: &[f64]| -> Vec<f64> { column.iter().map(|&value| libm::log(value)).collect() };
    let ln_x = logarithms(checked_positive(x)?);
    let ln_y = logarithms(checked_positive(y)?);
    let relative: Vec<f64> = error.iter().zip(y).map(|(error, y)| error / y).collect();
    fit_line(&ln_x, &ln_y, &relative)
}

fn solved<const N: usize>(
    fit: Option<LeastSquares<N>>,
    points: usize,
) -> Result<LeastSquares<N>, Error> {
    fit.filter(|fit| fit.chi_squared.is_finite())
        .ok_or(Error::undetermined(points, N))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{assert_coverage, white_noise};

    const RATES: [f64; 6] = [0.03, 0.05, 0.08, 0.1, 0.15, 0.2];
    const ERRORS: [f64; 6] = [0.01, 0.02, 0.01, 0.03, 0.02, 0.01];

    fn noisy(seed: u64, bend: f64) -> Vec<f64> {
        let noise = white_noise(seed, RATES.len());
        (0..RATES.len())
            .map(|i| 3.0 - 3.75 * RATES[i] + bend * RATES[i] * RATES[i] + ERRORS[i] * noise[i])
            .collect()
    }

    #[test]
    fn errors_of_the_line_cover_and_its_probability_is_uniform() {
        let trials = 1000;
        let mut covered = [0; 4];
        let mut improbable = 0;
        let mut bent = 0;
        for seed in 0..trials {
            let y = noisy(seed, 0.0);
            let fit = fit_line(&RATES, &y, &ERRORS).unwrap();
            covered[0] += usize::from(fit.slope.interval_68.contains(-3.75));
            covered[1] += usize::from(fit.slope.interval_95.contains(-3.75));
            covered[2] += usize::from(fit.intercept.interval_68.contains(3.0));
            covered[3] += usize::from(fit.at(0.5).interval_95.contains(3.0 - 1.875));
            improbable += usize::from(fit.probability < 0.1);
            bent += usize::from(fit_parabola(&RATES, &y, &ERRORS).unwrap().linearity < 0.05);
        }
        let trials = trials as usize;
        assert_coverage(covered[0], trials, 0.6827, 0.0, "slope");
        assert_coverage(covered[1], trials, 0.95, 0.0, "slope");
        assert_coverage(covered[2], trials, 0.6827, 0.0, "intercept");
        assert_coverage(covered[3], trials, 0.95, 0.0, "value far outside");
        assert_coverage(improbable, trials, 0.1, 0.0, "probability of chi^2");
        assert_coverage(bent, trials, 0.05, 0.0, "false bends");
    }

    #[test]
    fn a_bend_is_seen_and_its_coefficients_found() {
        let y = noisy(3, 12.0);
        let found = fit_parabola(&RATES, &y, &ERRORS).unwrap();
        assert!(found.linearity < 1e-3, "{found:?}");
        assert!(found.line.probability < 1e-3);
        assert!(found.line.scale_factor() > 1.5);
        assert!(found.quadratic.deviations_from(12.0).abs() < 3.0);
        assert!(found.linear.deviations_from(-3.75).abs() < 3.0);
        assert!(found.constant.deviations_from(3.0).abs() < 3.0);
        assert!(found.probability > 1e-3);
        // The difference of the chi^2 is the square of the quadratic term's score.
        let difference = found.line.chi_squared - found.chi_squared;
        let score = found.quadratic.deviations_from(0.0);
        assert!((difference - score * score).abs() < 1e-8 * difference);
    }

    #[test]
    fn a_line_through_scatter_covers_and_bends_are_told() {
        let trials = 1000;
        let (mut covered, mut bent) = ([0; 2], [0; 2]);
        for seed in 0..trials {
            let noise = white_noise(seed, 5);
            let [straight, curved] = [0.0, 40.0].map(|bend| {
                let y =
                    |i: usize| 3.0 - 3.75 * RATES[i] + bend * RATES[i].powi(2) + 0.01 * noise[i];
                let y: Vec<f64> = (0..5).map(y).collect();
                fit_line_to_scatter(&RATES[..5], &y, &[0.0; 5]).unwrap()
            });
            covered[0] += usize::from(straight.line.slope.interval_68.contains(-3.75));
            covered[1] += usize::from(straight.line.slope.interval_95.contains(-3.75));
            for (fit, bent) in [straight, curved].iter().zip(&mut bent) {
                *bent += usize::from(fit.linearity.unwrap() < 0.05);
            }
        }
        let trials = trials as usize;
        assert_coverage(covered[0], trials, 0.6827, 0.0, "slope");
        assert_coverage(covered[1], trials, 0.95, 0.0, "slope");
        assert_coverage(bent[0], trials, 0.05, 0.0, "false bends");
        assert!(bent[1] > trials / 2, "{bent:?}");
        assert_refused!(
            fit_line_to_scatter(&[1.0, 2.0, 2.0], &[1.0; 3], &[0.0; 3]) =>
            TooFewPlaces { needed: 3, found: 2 }
        );
    }

    /// Errors that suffice stay as they are, those that do not grow by one scatter, and where there is nothing else all points
    /// weigh alike: one rule between the weighted line and the plain one.
    #[test]
    fn scatter_is_added_where_errors_do_not_explain_it() {
        let trials = 1000;
        let mut covered = 0;
        for seed in 0..trials {
            let y = noisy(seed, 0.0);
            // A further scatter of the size of the errors, of which these know nothing.
            let more = white_noise(seed + 5000, RATES.len());
            let y: Vec<f64> = y
                .iter()
                .zip(&more)
                .map(|(y, more)| y + 0.02 * more)
                .collect();
            let fit = fit_line_to_scatter(&RATES, &y, &ERRORS).unwrap();
            let reduced = fit.line.chi_squared / 4.0;
            assert!(reduced <= 1.0 + 1e-9, "{reduced}");
            covered += usize::from(fit.line.slope.interval_95.contains(-3.75));
        }
        assert_coverage(covered, trials as usize, 0.95, 0.02, "slope");
        let y = RATES.map(|rate| 3.0 - 3.75 * rate + if rate == 0.1 { 0.01 } else { 0.0 });
        let [free, known] = [[0.0; 6], [0.1; 6]].map(|error| {
            let fit = fit_line_to_scatter(&RATES, &y, &error).unwrap();
            fit.line
        });
        let plain = fit_line(&RATES, &y, &[0.1; 6]).unwrap();
        assert!((free.slope.value - plain.slope.value).abs() < 1e-12);
        assert!((free.chi_squared - 4.0).abs() < 1e-9);
        assert_eq!(known.slope.error, plain.slope.error);
        assert_refused!(
            fit_line_to_scatter(&RATES, &RATES, &[-0.1; 6]) =>
            NotPositive { index: 0, .. }
        );
    }

    #[test]
    fn a_power_is_found_from_its_logarithms() {
        let length = [5.0, 10.0, 20.0, 40.0];
        let time = length.map(|l: f64| 7.0 * libm::pow(l, -1.0));
        let error = time.map(|t| 0.1 * t);
        let fit = power_exponent(&length, &time, &error).unwrap();
        assert!((fit.slope.value + 1.0).abs() < 1e-12);
        assert!((fit.intercept.value - 7.0_f64.ln()).abs() < 1e-12);
        // Equal relative errors at equal steps of ln 2: 0.1/(ln 2 sqrt(5)).
        assert!((fit.slope.error - 0.1 / (2.0_f64.ln() * 5.0_f64.sqrt())).abs() < 1e-12);
        assert_refused!(
            power_exponent(&[1.0, -2.0], &[1.0, 1.0], &[0.1, 0.1]) =>
            NotPositive { index: 1, .. }
        );
    }

    #[test]
    fn too_few_places_and_bad_columns_are_refused() {
        assert_refused!(
            fit_line(&[2.0; 5], &[1.0; 5], &[0.1; 5]) =>
            TooFewPlaces { needed: 2, found: 1 }
        );
        assert_refused!(
            fit_parabola(&[1.0, 1.0, 2.0], &[1.0; 3], &[0.1; 3]) =>
            TooFewPlaces { needed: 3, .. }
        );
        assert_refused!(fit_line(&[], &[], &[]) => TooFewPlaces { found: 0, .. });
        assert_refused!(
            fit_line(&[1.0, 2.0], &[1.0, 2.0], &[0.1, 0.0]) =>
            NotPositive { index: 1, .. }
        );
        assert_refused!(fit_line(&[1.0, 2.0], &[1.0], &[0.1, 0.1]) => LengthMismatch { .. });
    }
}
