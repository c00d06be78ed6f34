//! Times that diverge with an exponent of 1: their inverse against the width.

use crate::columns::distinct;
use crate::error::{Error, check_points, checked_positive, enough_places};
use crate::numerics::gamma::chi_squared_tail;
use crate::numerics::linear::{LeastSquares, error_of, least_squares};
use crate::uncertain::{Interval, Uncertain};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Errors of the root within which an end of its interval is sought.
const REACH: f64 = 1e3;

/// 1/y = B (w_c - w) + C (w_c - w)^2 fitted to values with errors: a divergence with an exponent of 1 exactly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InverseFit {
    /// Critical width w_c, where 1/y falls through 0; intervals by the profile of chi^2, infinite where the points leave
    /// them open.
    pub critical_width: Uncertain,
    /// B, positive; normal intervals.
    pub linear: Uncertain,
    /// C; `None` for a line.
    pub quadratic: Option<Uncertain>,
    /// Sum of the squared deviations of 1/y in units of their errors.
    pub chi_squared: f64,
    /// Points less free parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a chi^2 at least as large if the law and the errors are right; 1 without degrees of freedom.
    pub probability: f64,
    /// R^2 = 1 - chi^2/chi^2 of a constant: the part of the weighted scatter of 1/y that the law accounts for.
    pub explained: f64,
}

/// Straight line `1/y = B (w_c - w)` with w_c free, by weighted least squares.
///
/// This is the line that one draws to see alpha = 1 in a figure: a regression of 1/tau on w that ends at w_c. The error of 1/y is
/// error/y^2; above some 20 per cent of y it is no longer normal. The interval of w_c is Fieller's (J. R. Stat. Soc. B
/// 16, 175 (1954)); the profile of chi^2 gives the same interval. Compare [`fit_law`](crate::fit_law) with `Law::Power`, which
/// leaves alpha free.
///
/// # Errors
/// [`Error::TooFewPlaces`] below 2 distinct widths, [`Error::Undetermined`] where 1/y does not fall to 0 as the width
/// grows, [`Error::LengthMismatch`], [`Error::NonFinite`], [`Error::NotPositive`] for a value or an error.
///
/// ```
/// use peristalsis_analysis::fit_inverse_line;
/// // tau = 2/(3 - w)
/// let fit = fit_inverse_line(&[2.0, 2.5, 2.75], &[2.0, 4.0, 8.0], &[0.1, 0.2, 0.4])?;
/// assert!((fit.critical_width.value - 3.0).abs() < 1e-12 && (fit.linear.value - 0.5).abs() < 1e-12);
/// assert!((fit.explained - 1.0).abs() < 1e-12 && fit.degrees_of_freedom == 1);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_inverse_line(width: &[f64], value: &[f64], error: &[f64]) -> Result<InverseFit, Error> {
    fit::<2>(width, value, error)
}

/// Parabola `1/y = B (w_c - w) + C (w_c - w)^2` with w_c free: alpha = 1 with a first correction.
///
/// As many parameters as a free power A (w_c - w)^-alpha, so that the chi^2 of the two, this one and that of
/// [`fit_law`](crate::fit_law), can be compared as they are. All else as for [`fit_inverse_line`].
///
/// # Errors
/// [`Error::TooFewPlaces`] below 3 distinct widths, else those of [`fit_inverse_line`].
pub fn fit_inverse_parabola(
    width: &[f64],
    value: &[f64],
    error: &[f64],
) -> Result<InverseFit, Error> {
    fit::<3>(width, value, error)
}

/// A polynomial of N coefficients in w through 1/y, and where it falls through 0.
fn fit<const N: usize>(width: &[f64], value: &[f64], error: &[f64]) -> Result<InverseFit, Error> {
    check_points(width, value, error)?;
    checked_positive(value)?;
    enough_places(distinct(width).len(), N)?;
    let undetermined = Error::undetermined(width.len(), N);
    let inverse: Vec<f64> = value.iter().map(|value| 1.0 / value).collect();
    let weight = value.iter().zip(error);
    let weight: Vec<f64> = weight
        .map(|(value, error)| (value * value / error) * (value * value / error))
        .collect();
    let top = width.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let powers = |u: f64| -> [f64; N] { std::array::from_fn(|k| libm::pow(u, k as f64)) };
    let found = least_squares(|i| powers(width[i] - top), &inverse, &weight);
    let mean = least_squares(|_| [1.0], &inverse, &weight);
    let (Some(found), Some(mean)) = (found, mean) else {
        return Err(undetermined);
    };
    let LeastSquares {
        coefficients,
        covariance,
        chi_squared,
    } = found;
    let of = |k: usize| coefficients.get(k).copied().unwrap_or(0.0);
    let [height, slope, bend] = [0, 1, 2].map(of);
    // Slope where the polynomial falls through 0, and that place counted from the largest width.
    let steepness = (slope * slope - 4.0 * bend * height).sqrt();
    let root = 2.0 * height / (steepness - slope);
    let error_at = |u: f64| error_of(&powers(u), &covariance);
    let root_error = error_at(root) / steepness;
    let is_found = [steepness, root, root_error, chi_squared]
        .iter()
        .all(|it| it.is_finite());
    if !(is_found && steepness > 0.0 && steepness - slope > 0.0 && root_error > 0.0) {
        return Err(undetermined);
    }
    let polynomial = |u: f64| height + u * (slope + u * bend);
    let limits = [root - REACH * root_error, root + REACH * root_error];
    let ends = |deviations: f64| {
        let outside = |u: f64| polynomial(u).abs() - deviations * error_at(u);
        let step = deviations * root_error;
        Interval::around(root, outside, step, limits, Interval::OPEN).map(|u| top + u)
    };
    let gradient = [-2.0 * bend, slope, -2.0 * height].map(|part| part / steepness);
    let linear_error = error_of(&std::array::from_fn(|k| gradient[k]), &covariance);
    let degrees_of_freedom = width.len() - N;
    Ok(InverseFit {
        critical_width: Uncertain::with_intervals(top + root, root_error, ends),
        linear: Uncertain::normal(steepness, linear_error),
        quadratic: (N > 2).then(|| Uncertain::normal(bend, covariance[N - 1][N - 1].sqrt())),
        chi_squared,
        degrees_of_freedom,
        probability: chi_squared_tail(chi_squared, degrees_of_freedom),
        explained: 1.0 - chi_squared / mean.chi_squared,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Law;
    use crate::law_fit::fit_law;
    use crate::tests::{Coverage, assert_coverage, white_noise};

    const WIDTHS: [f64; 9] = [2.4, 2.5, 2.55, 2.6, 2.65, 2.7, 2.73, 2.76, 2.78];

    /// 1/tau = 0.2 d + bend d^2, d = 2.82 - w, with relative errors.
    fn noisy(seed: u64, bend: f64, relative: f64) -> ([f64; 9], [f64; 9]) {
        let noise = white_noise(seed, WIDTHS.len());
        let of = |k: usize| {
            let distance = 2.82 - WIDTHS[k];
            (1.0 + relative * noise[k]) * (0.2 * distance + bend * distance * distance)
        };
        let value = std::array::from_fn(|k| 1.0 / of(k));
        (value, value.map(|value| relative * value))
    }

    #[test]
    fn intervals_cover_and_probabilities_are_uniform() {
        let trials = 400;
        let truths = [
            ("w_c of a line", 2.82),
            ("w_c", 2.82),
            ("B", 0.2),
            ("C", 0.6),
        ];
        let mut coverage = Coverage::of(truths);
        let mut improbable = 0;
        for seed in 0..trials {
            let (value, error) = noisy(seed, 0.0, 0.03);
            let line = fit_inverse_line(&WIDTHS, &value, &error).unwrap();
            improbable += usize::from(line.probability < 0.1);
            let (value, error) = noisy(seed, 0.6, 0.03);
            let bent = fit_inverse_parabola(&WIDTHS, &value, &error).unwrap();
            let quadratic = bent.quadratic.unwrap();
            coverage.count([
                line.critical_width,
                bent.critical_width,
                bent.linear,
                quadratic,
            ]);
            assert!(line.explained > 0.9 && bent.explained > 0.9);
        }
        coverage.judge([0.03; 2]);
        assert_coverage(
            improbable,
            trials as usize,
            0.1,
            0.03,
            "probability of chi^2",
        );
    }

    /// A free power finds 1.5 where alpha is 1, and only the goodness of fit tells.
    #[test]
    fn a_correction_passes_for_another_exponent() {
        let (mut exponent, mut here, mut power, mut line) = (0.0, 0.0, 0.0, 0.0);
        for seed in 0..20 {
            let (value, error) = noisy(seed, 0.6, 0.01);
            let free = fit_law(Law::Power, &WIDTHS, &value, &error, None).unwrap();
            let bent = fit_inverse_parabola(&WIDTHS, &value, &error).unwrap();
            exponent += free.exponent.value / 20.0;
            power += free.chi_squared;
            here += bent.chi_squared;
            line += fit_inverse_line(&WIDTHS, &value, &error)
                .unwrap()
                .chi_squared;
            assert_eq!(free.degrees_of_freedom, bent.degrees_of_freedom);
        }
        assert!(exponent > 1.3 && here < 20.0 * 9.0, "{exponent} {here}");
        assert!(power > here + 100.0 && line > power, "{power} {line}");
    }

    #[test]
    fn what_does_not_end_is_refused() {
        let error = [0.1; 3];
        assert_refused!(
            fit_inverse_line(&[2.0, 2.1, 2.2], &[3.0, 2.0, 1.0], &error) => Undetermined { .. }
        );
        assert_refused!(
            fit_inverse_parabola(&[2.0, 2.1, 2.1], &[1.0, 2.0, 3.0], &error) =>
            TooFewPlaces { needed: 3, found: 2 }
        );
        assert_refused!(fit_inverse_line(&[2.0, 2.1, 2.2], &[1.0, -2.0, 3.0], &error) => NotPositive { .. });
        // 1/y = 1 + (w - 2.1)^2 never reaches 0.
        let value = [1.0 / 1.01, 1.0, 1.0 / 1.01];
        assert_refused!(
            fit_inverse_parabola(&[2.0, 2.1, 2.2], &value, &error) => Undetermined { .. }
        );
    }
}
