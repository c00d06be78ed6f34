//! Height of the jump of the flow rate at the critical width.

use crate::columns::distinct;
use crate::error::{Error, check_known, check_points, enough};
use crate::line::fit_line;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The two branches of the stationary flow rate at the critical width.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Jump {
    /// Jammed branch at w_c.
    pub upper: Uncertain,
    /// Unjammed branch at w_c.
    pub lower: Uncertain,
    /// Their difference.
    pub height: Uncertain,
}

/// Height of the jump, both branches continued to w_c as straight lines.
///
/// `upper`, `lower`: columns width, mean of the stationary J/Jmax and its error, of the jammed branch (w < w_c) and the
/// unjammed one (w > w_c); a few widths next to w_c. With w_c = `critical`,
///
/// `height = upper(w_c) - lower(w_c)`,
/// `error^2 = error_upper^2 + error_lower^2 + (slope_upper - slope_lower)^2 error_w^2`
///
/// A branch with a single width counts with its weighted mean as if it were level. A height of many errors that does
/// not shrink with the strain rate or the length of the tube speaks for a discontinuous transition; a steep continuous
/// rise between two widths looks the same, so that the widths must close in on w_c.
///
/// # Errors
/// [`Error::TooFew`] for a branch without points, [`Error::LengthMismatch`], [`Error::NonFinite`],
/// [`Error::NotPositive`], [`Error::Negative`] for the error of w_c.
///
/// ```
/// use peristalsis_analysis::{Uncertain, jump_height};
/// let jammed = [&[2.6, 2.7][..], &[1.0, 0.9], &[0.01, 0.01]];
/// let unjammed = [&[2.9][..], &[0.2], &[0.03]];
/// let jump = jump_height(jammed, unjammed, Uncertain::normal(2.8, 0.0))?;
/// assert!((jump.height.value - 0.6).abs() < 1e-12);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn jump_height(
    upper: [&[f64]; 3],
    lower: [&[f64]; 3],
    critical: Uncertain,
) -> Result<Jump, Error> {
    check_known(critical)?;
    let (upper, upper_slope) = branch(upper, critical.value)?;
    let (lower, lower_slope) = branch(lower, critical.value)?;
    let shift = (upper_slope - lower_slope) * critical.error;
    let variance = upper.error * upper.error + lower.error * lower.error + shift * shift;
    // At w_c a branch is known as well as w_c is; both move together.
    let at_critical = |branch: Uncertain, slope: f64| {
        Uncertain::normal(branch.value, branch.error.hypot(slope * critical.error))
    };
    Ok(Jump {
        upper: at_critical(upper, upper_slope),
        lower: at_critical(lower, lower_slope),
        height: Uncertain::normal(upper.value - lower.value, variance.sqrt()),
    })
}

/// Value of a branch at a width, and its slope.
fn branch([width, ratio, error]: [&[f64]; 3], at: f64) -> Result<(Uncertain, f64), Error> {
    check_points(width, ratio, error)?;
    enough("widths", width.len(), 1)?;
    if distinct(width).len() > 1 {
        let line = fit_line(width, ratio, error)?;
        return Ok((line.at(at), line.slope.value));
    }
    let (mut weights, mut sum) = (0.0, 0.0);
    for (ratio, error) in ratio.iter().zip(error) {
        weights += 1.0 / (error * error);
        sum += ratio / (error * error);
    }
    let mean = Uncertain::normal(sum / weights, (1.0 / weights).sqrt());
    Ok((mean, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Coverage, white_noise};

    #[test]
    fn intervals_of_the_height_cover_with_an_uncertain_critical_width() {
        let (jammed, unjammed) = ([2.6, 2.65, 2.7, 2.75], [2.85, 2.9, 2.95]);
        let truth = [("height", 0.7), ("upper", 0.9), ("lower", 0.2)];
        let mut coverage = Coverage::of(truth);
        for seed in 0..400 {
            let noise = white_noise(seed, 8);
            let upper: Vec<f64> = (0..4)
                .map(|i| 0.9 - 0.5 * (jammed[i] - 2.8) + 0.02 * noise[i])
                .collect();
            let lower: Vec<f64> = (0..3)
                .map(|i| 0.2 - 1.0 * (unjammed[i] - 2.8) + 0.03 * noise[4 + i])
                .collect();
            let critical = Uncertain::normal(2.8 + 0.02 * noise[7], 0.02);
            let jump = jump_height(
                [&jammed, &upper, &[0.02; 4]],
                [&unjammed, &lower, &[0.03; 3]],
                critical,
            )
            .unwrap();
            coverage.count([jump.height, jump.upper, jump.lower]);
        }
        coverage.judge([0.01; 2]);
    }

    #[test]
    fn branches_without_points_are_refused() {
        let one: [&[f64]; 3] = [&[2.7], &[0.9], &[0.1]];
        let none: [&[f64]; 3] = [&[], &[], &[]];
        let critical = Uncertain::normal(2.8, 0.01);
        assert_refused!(jump_height(one, none, critical) => TooFew { needed: 1, .. });
        let uneven: [&[f64]; 3] = [&[2.7], &[0.9, 0.8], &[0.1]];
        assert_refused!(jump_height(uneven, one, critical) => LengthMismatch { .. });
        assert!(jump_height(one, one, Uncertain::normal(f64::NAN, 0.1)).is_err());
        let below = Uncertain::normal(2.8, -0.1);
        assert_refused!(jump_height(one, one, below) => Negative { index: 1, .. });
    }
}
