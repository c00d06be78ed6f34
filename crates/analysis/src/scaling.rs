//! Scalings of a curve's points in which curves are expected to collapse.

use crate::collapse::CurvePoint;
use serde::{Deserialize, Serialize};

/// A scaling with its free parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// `y = p^-a f((w_c - w)/p^b)` with `w_c = slope p + w_max`: p the strain rate, w the abscissa, y the transition
    /// time or its variance. Parameters a, b, slope, w_max.
    CriticalLine,
    /// As `CriticalLine`, with a w_c of its own for every curve. Parameters a, b, then w_c of each curve in turn.
    CriticalEach,
    /// As `CriticalLine`, with known w_c, one a curve. Parameters a, b.
    CriticalKnown(Vec<f64>),
    /// `y = p^-a f((x - x_c) p^b)`: p the length of the system. Parameters a, b, x_c. Plain axes, not logarithms.
    FiniteSize,
}

impl Scaling {
    /// Names of the parameters for `curves` curves.
    pub fn parameters(&self, curves: usize) -> Vec<String> {
        let names: &[&str] = match self {
            Self::CriticalLine => &["a", "b", "slope", "w_max"],
            Self::CriticalEach | Self::CriticalKnown(_) => &["a", "b"],
            Self::FiniteSize => &["a", "b", "x_c"],
        };
        let mut names: Vec<String> = names.iter().map(ToString::to_string).collect();
        if let Self::CriticalEach = self {
            names.extend((1..=curves).map(|curve| format!("w_c of curve {curve}")));
        }
        names
    }

    /// The scaled point: abscissa, ordinate and its error.
    ///
    /// The critical scalings work in logarithms, X = ln((w_c - w)/p^b), Y = ln(y p^a), in which a power law is
    /// straight; a point at w >= w_c is not a number and counts as not overlapping. Where f is a pure power x^-alpha
    /// over the whole range, only a - b alpha is determined: the collapse is then equally good along a line of (a, b),
    /// and intervals of a and b are as long as the overlap allows. Missing parameters give not a number too.
    pub fn apply(
        &self,
        parameters: &[f64],
        curve: usize,
        parameter: f64,
        point: CurvePoint,
    ) -> CurvePoint {
        let free = |index: usize| parameters.get(index).copied().unwrap_or(f64::NAN);
        let (a, b) = (free(0), free(1));
        let ln_parameter = libm::log(parameter);
        let critical = match self {
            Self::CriticalLine => free(2) * parameter + free(3),
            Self::CriticalEach => free(2 + curve),
            Self::CriticalKnown(known) => known.get(curve).copied().unwrap_or(f64::NAN),
            Self::FiniteSize => {
                let growth = libm::exp(a * ln_parameter);
                return CurvePoint {
                    x: (point.x - free(2)) * libm::exp(b * ln_parameter),
                    y: point.y * growth,
                    error: point.error * growth,
                };
            }
        };
        CurvePoint {
            x: libm::log(critical - point.x) - b * ln_parameter,
            y: libm::log(point.y) + a * ln_parameter,
            error: point.error / point.y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::point;

    #[test]
    fn scaled_points_by_hand() {
        let point = point(2.5, 8.0, 0.4);
        // p = 4: w_c = 3 - 0.5/8 * 4 = 2.75, so X = ln(0.25/8), Y = ln(8 16).
        let line = Scaling::CriticalLine.apply(&[2.0, 1.5, -0.0625, 3.0], 0, 4.0, point);
        assert!((line.x - libm::log(0.25 / 8.0)).abs() < 1e-14);
        assert!((line.y - libm::log(128.0)).abs() < 1e-14);
        assert!((line.error - 0.05).abs() < 1e-15);
        let each = Scaling::CriticalEach.apply(&[2.0, 1.5, 9.0, 2.75], 1, 4.0, point);
        let known = Scaling::CriticalKnown(vec![9.0, 2.75]).apply(&[2.0, 1.5], 1, 4.0, point);
        for scaled in [each, known] {
            assert!((scaled.x - line.x).abs() < 1e-14 && (scaled.y - line.y).abs() < 1e-14);
        }
        let size = Scaling::FiniteSize.apply(&[-1.0, 0.5, 2.0], 0, 4.0, point);
        assert!((size.x - 1.0).abs() < 1e-14 && (size.y - 2.0).abs() < 1e-14);
        assert!((size.error - 0.1).abs() < 1e-15);
    }

    #[test]
    fn points_beyond_the_critical_width_and_missing_parameters_are_not_numbers() {
        let point = point(2.8, 1.0, 0.1);
        let beyond = Scaling::CriticalKnown(vec![2.7]);
        assert!(beyond.apply(&[1.0, 1.0], 0, 0.1, point).x.is_nan());
        assert!(beyond.apply(&[1.0, 1.0], 1, 0.1, point).x.is_nan());
        assert!(Scaling::FiniteSize.apply(&[1.0], 0, 0.1, point).x.is_nan());
    }
}
