//! What a case found: numbers beside what they must be, errors against the time step, tables and figures.

use peristalsis_figures::Drawing;
use peristalsis_formats::Table;
use serde::Serialize;

/// A number beside what it must be.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What is compared, with its unit.
    pub quantity: String,
    /// In which experiment.
    pub setting: String,
    /// Where the expected value comes from.
    pub reference: String,
    /// What it must be.
    pub expected: f64,
    /// What the engine gives.
    pub found: f64,
    /// Standard error of what was found, where it is a mean over replicates.
    pub standard_error: Option<f64>,
    /// |found - expected|, relative to the expected value unless that is no scale.
    pub deviation: f64,
    /// Largest deviation that passes.
    pub tolerance: f64,
    /// Whether it does.
    pub passed: bool,
}

impl Check {
    /// A check of the deviation relative to the expected value.
    #[must_use]
    pub fn relative(
        quantity: &str,
        setting: &str,
        expected: f64,
        found: f64,
        tolerance: f64,
    ) -> Self {
        Self::scaled(
            quantity,
            setting,
            expected,
            found,
            tolerance,
            expected.abs(),
        )
    }

    /// A check of the deviation itself.
    #[must_use]
    pub fn absolute(
        quantity: &str,
        setting: &str,
        expected: f64,
        found: f64,
        tolerance: f64,
    ) -> Self {
        Self::scaled(quantity, setting, expected, found, tolerance, 1.0)
    }

    fn scaled(
        quantity: &str,
        setting: &str,
        expected: f64,
        found: f64,
        tolerance: f64,
        scale: f64,
    ) -> Self {
        let deviation = (found - expected).abs() / scale;
        Self {
            quantity: quantity.to_owned(),
            setting: setting.to_owned(),
            reference: String::new(),
            expected,
            found,
            standard_error: None,
            deviation,
            tolerance,
            // A deviation that is no number fails.
            passed: deviation <= tolerance,
        }
    }

    /// Where the expected value comes from.
    #[must_use]
    pub fn by(self, reference: &str) -> Self {
        Self {
            reference: reference.to_owned(),
            ..self
        }
    }

    /// A mean over replicates with its standard error.
    #[must_use]
    pub fn with_error(self, standard_error: f64) -> Self {
        Self {
            standard_error: Some(standard_error),
            ..self
        }
    }
}

/// Error of a quantity against the time step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// What converges.
    pub quantity: String,
    /// In which experiment, with which integrator.
    pub setting: String,
    /// Unit of the steps, in markup of a document.
    pub unit: String,
    /// Steps, the longest first.
    pub steps: Vec<f64>,
    /// Relative error at each.
    pub errors: Vec<f64>,
    /// Slope of ln error against ln step, by least squares; none where the errors are those of rounding.
    pub order: Option<f64>,
    /// Least and largest order that pass.
    pub expected_order: [f64; 2],
    /// Whether the order does.
    pub passed: bool,
}

/// Relative errors below this are rounding.
const ROUNDING: f64 = 1e-10;

impl Convergence {
    /// Errors at steps, the longest first, with the range of orders that pass.
    #[must_use]
    pub fn new(
        quantity: &str,
        setting: &str,
        unit: &str,
        steps: &[f64],
        errors: &[f64],
        expected_order: [f64; 2],
    ) -> Self {
        let is_rounding = errors.iter().all(|error| *error < ROUNDING);
        let order = (!is_rounding).then(|| slope(steps, errors));
        Self {
            quantity: quantity.to_owned(),
            setting: setting.to_owned(),
            unit: unit.to_owned(),
            steps: steps.to_vec(),
            errors: errors.to_vec(),
            order,
            expected_order,
            passed: order
                .is_none_or(|order| (expected_order[0]..=expected_order[1]).contains(&order)),
        }
    }
}

/// Slope of ln y against ln x by least squares.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let number = x.len() as f64;
    let logarithms =
        |values: &[f64]| -> Vec<f64> { values.iter().map(|v| libm::log(*v)).collect() };
    let (x, y) = (logarithms(x), logarithms(y));
    let centre = |values: &[f64]| values.iter().sum::<f64>() / number;
    let (x_mean, y_mean) = (centre(&x), centre(&y));
    let above: f64 = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (x - x_mean) * (y - y_mean))
        .sum();
    let below: f64 = x.iter().map(|x| (x - x_mean) * (x - x_mean)).sum();
    above / below
}

/// A figure of a case.
#[derive(Clone, Debug)]
pub struct CaseFigure {
    /// Short name, used for files: letters, digits and hyphens.
    pub name: &'static str,
    /// What it shows and how to read it, one or two sentences.
    pub caption: &'static str,
    /// The drawing.
    pub drawing: Drawing,
}

/// What a case found.
#[derive(Clone, Debug, Default)]
pub struct Finding {
    /// What was done and what differs by nature, a paragraph each, in Markdown.
    pub paragraphs: Vec<String>,
    /// Numbers beside what they must be.
    pub checks: Vec<Check>,
    /// Errors against the time step.
    pub convergences: Vec<Convergence>,
    /// Everything that was measured, for programs.
    pub table: Option<Table>,
    /// Figures.
    pub figures: Vec<CaseFigure>,
}

impl Finding {
    /// Whether every check and every order passed; a case that checked nothing has not.
    #[must_use]
    pub fn passed(&self) -> bool {
        !self.checks.is_empty()
            && self.checks.iter().all(|check| check.passed)
            && self
                .convergences
                .iter()
                .all(|convergence| convergence.passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_passes_within_its_tolerance_only() {
        assert!(Check::relative("", "", 2.0, 2.01, 0.0051).passed);
        assert!(!Check::relative("", "", 2.0, 2.01, 0.0049).passed);
        assert!(!Check::absolute("", "", 0.0, f64::NAN, 1.0).passed);
        assert!(!Finding::default().passed(), "nothing was checked");
    }

    #[test]
    fn the_order_is_the_slope_and_rounding_has_none() {
        let steps = [0.1, 0.05, 0.025];
        let errors = steps.map(|h: f64| 3.0 * h * h);
        let found = Convergence::new("", "", "", &steps, &errors, [1.9, 2.1]);
        assert!((found.order.unwrap() - 2.0).abs() < 1e-12 && found.passed);
        assert!(!Convergence::new("", "", "", &steps, &steps, [1.9, 2.1]).passed);
        let rounding = Convergence::new("", "", "", &steps, &[1e-13, 2e-14, 3e-13], [1.9, 2.1]);
        assert!(rounding.order.is_none() && rounding.passed);
    }
}
