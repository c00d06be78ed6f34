//! Laws of a transition time, or of another positive quantity, against the width of the bottleneck.

use crate::family::Family;
use crate::uncertain::Interval;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a quantity y grows as the width w rises toward the critical width w_c.
///
/// Each is a straight line in ln y at a known w_c: `ln y = ln A + B x(w)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Law {
    /// `y = A (w_c - w)^-B`: a divergence as of a critical point or the end of a branch (a spinodal).
    Power,
    /// `y = A exp(B/(w_c - w)^power)`: nucleation over a barrier that diverges where the two flows coexist. A droplet
    /// of d dimensions has power d - 1: 2 in bulk, 1 in a plane.
    Barrier {
        /// Power of the barrier, positive.
        power: f64,
    },
    /// `y = A exp(B w)`: a barrier that grows with the width and stays finite, so that there is no w_c: nucleation in a
    /// tube, in which a front costs the same wherever it stands.
    Exponential,
}

impl Law {
    /// Parameters ln A and B, and w_c where there is one.
    pub fn parameters(self) -> usize {
        2 + usize::from(self.is_critical())
    }

    /// Whether the law ends at a critical width.
    pub(crate) fn is_critical(self) -> bool {
        self != Self::Exponential
    }

    /// Free parameters with a family of distributions about the mean, whose shape is common to all widths.
    pub(crate) fn parameters_with(self, family: Family) -> usize {
        self.parameters() + family.parameters() - 1
    }

    /// Covariate x at a distance w_c - w > 0, or at a width for the exponential law.
    pub(crate) fn covariate(self, width: f64, critical: f64) -> f64 {
        match self {
            Self::Power => -libm::log(critical - width),
            Self::Barrier { power } => libm::pow(critical - width, -power),
            Self::Exponential => width,
        }
    }

    /// Derivative of the covariate in w_c.
    pub(crate) fn covariate_slope(self, width: f64, critical: f64) -> f64 {
        match self {
            Self::Power => -1.0 / (critical - width),
            Self::Barrier { power } => -power * libm::pow(critical - width, -power - 1.0),
            Self::Exponential => 0.0,
        }
    }
}

/// Range of w_c in which fits look for the best one, as a distance from the largest width below it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CriticalRange {
    /// Largest width at which the quantity is finite.
    pub(crate) top: f64,
    /// Distance of the outermost widths.
    pub(crate) span: f64,
}

impl CriticalRange {
    /// Nearest and farthest distance, in spans.
    const NEAREST: f64 = 1e-4;
    const FARTHEST: f64 = 100.0;
    /// Places in the grid of ln(w_c - top).
    const PLACES: usize = 48;

    pub(crate) fn new(widths: &[f64], top: f64) -> Self {
        let least = widths.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            top,
            span: top - least,
        }
    }

    pub(crate) fn critical(self, ln_distance: f64) -> f64 {
        self.top + libm::exp(ln_distance)
    }

    pub(crate) fn ln_distance(self, critical: f64) -> f64 {
        libm::log(critical - self.top)
    }

    /// Bounds of ln(w_c - top).
    pub(crate) fn bounds(self) -> (f64, f64) {
        [Self::NEAREST, Self::FARTHEST]
            .map(|spans| libm::log(spans * self.span))
            .into()
    }

    /// Grid of ln(w_c - top), evenly spaced.
    pub(crate) fn grid(self) -> Vec<f64> {
        let (low, high) = self.bounds();
        let step = (high - low) / (Self::PLACES - 1) as f64;
        (0..Self::PLACES).map(|k| low + step * k as f64).collect()
    }

    /// Interval of w_c about its best place ln(w_c - top), where a function of such places is at most 0; see
    /// [`Interval::around`].
    pub(crate) fn interval(
        self,
        best: f64,
        outside: impl Fn(f64) -> f64,
        first_step: f64,
    ) -> Interval {
        let (nearest, farthest) = self.bounds();
        // A w_c within round-off of the largest width is as good as that width.
        let limits = [nearest.min(best) - 7.0, farthest];
        Interval::around(best, outside, first_step, limits, Interval::OPEN)
            .map(|ln_distance| self.critical(ln_distance))
    }

    /// Whether a fit has run away to a w_c that the widths do not determine.
    pub(crate) fn is_beyond(self, ln_distance: f64) -> bool {
        ln_distance > self.bounds().1 - 0.02
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covariates_and_their_slopes() {
        let laws = [Law::Power, Law::Barrier { power: 2.0 }, Law::Exponential];
        for (law, expected) in laws.into_iter().zip([2.0_f64.ln(), 4.0, 2.5]) {
            assert!((law.covariate(2.5, 3.0) - expected).abs() < 1e-14);
            let difference = law.covariate(2.5, 3.0 + 1e-6) - law.covariate(2.5, 3.0 - 1e-6);
            assert!((law.covariate_slope(2.5, 3.0) - difference / 2e-6).abs() < 1e-6);
        }
        assert_eq!(Law::Exponential.parameters(), 2);
        assert!(Law::Power.is_critical() && !Law::Exponential.is_critical());
    }

    #[test]
    fn the_grid_spans_its_bounds() {
        let range = CriticalRange::new(&[2.5, 2.6, 2.75], 2.75);
        let grid = range.grid();
        assert!((range.critical(grid[0]) - 2.750_025).abs() < 1e-12);
        assert!((range.critical(grid[47]) - 27.75).abs() < 1e-9);
        assert!(range.is_beyond(grid[47]) && !range.is_beyond(grid[46]));
        assert!((range.ln_distance(range.critical(-1.3)) + 1.3).abs() < 1e-12);
    }
}
