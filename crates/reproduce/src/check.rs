//! Numbers beside their expected values, and errors against the time step.

use peristalsis_analysis::number::{self, significant};
use peristalsis_analysis::power_exponent;
use serde::Serialize;

use crate::contents::ReportTable;

/// A number beside its expected value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// The quantity, with its unit.
    pub quantity: String,
    /// The experiment.
    pub setting: String,
    /// Source of the expected value.
    pub reference: String,
    /// The expected value.
    pub expected: f64,
    /// The value that the engine gives.
    pub found: f64,
    /// Standard error of the value found, where it is a mean over replicates.
    pub standard_error: Option<f64>,
    /// |found - expected|, over |expected| in a relative check.
    pub deviation: f64,
    /// Largest deviation that passes.
    pub tolerance: f64,
    /// Whether the deviation passes.
    pub passed: bool,
}

impl Check {
    /// A check of the deviation relative to the expected value.
    pub fn relative(
        quantity: &str,
        setting: &str,
        expected: f64,
        found: f64,
        tolerance: f64,
    ) -> Self {
        let mut check = Self::absolute(quantity, setting, expected, found, tolerance);
        check.deviation /= expected.abs();
        check.passed = check.deviation <= tolerance;
        check
    }

    /// A check of the deviation itself.
    pub fn absolute(
        quantity: &str,
        setting: &str,
        expected: f64,
        found: f64,
        tolerance: f64,
    ) -> Self {
        let deviation = (found - expected).abs();
        Self {
            quantity: quantity.to_owned(),
            setting: setting.to_owned(),
            reference: String::new(),
            expected,
            found,
            standard_error: None,
            deviation,
            tolerance,
            // NaN does not pass.
            passed: deviation <= tolerance,
        }
    }

    /// The same with the source of the expected value.
    #[must_use]
    pub fn by(mut self, reference: &str) -> Self {
        reference.clone_into(&mut self.reference);
        self
    }

    /// The same for a mean over replicates with its standard error.
    #[must_use]
    pub fn with_error(mut self, standard_error: f64) -> Self {
        self.standard_error = Some(standard_error);
        self
    }

    /// Checks as a table.
    pub(crate) fn table(checks: &[Self]) -> ReportTable {
        let row = |check: &Self| {
            vec![
                check.quantity.clone(),
                check.setting.clone(),
                check.reference.clone(),
                written(check.expected, 6),
                match check.standard_error {
                    Some(error) => number::with_error(check.found, error),
                    None => written(check.found, 6),
                },
                written(check.deviation, 2),
                written(check.tolerance, 2),
                verdict(check.passed).to_owned(),
            ]
        };
        ReportTable::new(
            "",
            "quantity, experiment, reference, expected, found, deviation, allowed, ".split(", "),
            checks.iter().map(row),
        )
    }
}

/// Error of a quantity against the time step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// The quantity.
    pub quantity: String,
    /// The experiment and the integrator.
    pub setting: String,
    /// Unit of the steps.
    pub unit: String,
    /// Time steps, the longest first.
    pub steps: Vec<f64>,
    /// Relative error at each.
    pub errors: Vec<f64>,
    /// Slope of ln error against ln step by least squares; `None` where the errors are rounding errors.
    pub order: Option<f64>,
    /// Least and largest order that pass.
    pub expected_order: [f64; 2],
    /// Whether the order passes.
    pub passed: bool,
}

/// Relative errors below this are rounding errors.
const ROUNDING: f64 = 1e-10;

impl Convergence {
    /// Errors at time steps, the longest first, with the range of orders that pass.
    pub fn new(
        quantity: &str,
        setting: &str,
        unit: &str,
        steps: &[f64],
        errors: &[f64],
        expected_order: [f64; 2],
    ) -> Self {
        let is_rounding = errors.iter().all(|error| *error < ROUNDING);
        let order = (!is_rounding).then(|| order(steps, errors));
        let [least, largest] = expected_order;
        Self {
            quantity: quantity.to_owned(),
            setting: setting.to_owned(),
            unit: unit.to_owned(),
            steps: steps.to_vec(),
            errors: errors.to_vec(),
            order,
            expected_order,
            passed: order.is_none_or(|order| (least..=largest).contains(&order)),
        }
    }

    /// Errors as tables, one for each sequence of steps.
    pub(crate) fn tables(convergences: &[Self]) -> Vec<ReportTable> {
        convergences
            .chunk_by(|one, other| one.unit == other.unit && one.steps == other.steps)
            .map(Self::table)
            .collect()
    }

    /// Errors at the same steps.
    fn table(group: &[Self]) -> ReportTable {
        let row = |one: &Self| {
            let mut row = vec![one.quantity.clone(), one.setting.clone()];
            row.extend(one.errors.iter().map(|error| written(*error, 2)));
            let order = one.order.map(|order| format!("{order:.2}"));
            let [least, largest] = one.expected_order;
            row.extend([
                order.unwrap_or("rounding".to_owned()),
                format!("{least} – {largest}"),
                verdict(one.passed).to_owned(),
            ]);
            row
        };
        let Self { unit, steps, .. } = &group[0];
        let steps = steps.iter().map(|step| format!("h = {step} {unit}"));
        let before = ["relative error of", "experiment"].map(str::to_owned);
        let behind = ["order", "allowed", ""].map(str::to_owned);
        ReportTable::new(
            "",
            before.into_iter().chain(steps).chain(behind),
            group.iter().map(row),
        )
    }
}

/// Power of the step with which errors go.
fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let line = power_exponent(steps, errors, errors);
    line.map_or(f64::NAN, |line| line.slope.value)
}

/// The word for a check or a case, in Markdown.
pub(crate) fn verdict(passed: bool) -> &'static str {
    if passed { "passed" } else { "**failed**" }
}

/// [`significant`], but 0 as "0" and what is not finite as a dash.
fn written(value: f64, digits: usize) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if !value.is_finite() => "–".to_owned(),
        _ => significant(value, digits),
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
