//! Errors against the time step: measured with both integrators, and drawn.

use super::plot::open_if;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Points, Tint};
use peristalsis_figures::{Scale, Width};

use crate::Convergence;
use crate::error::Result;
use crate::textbook::experiment::Means;

/// Time steps at which errors are measured, the longest first.
pub(super) struct Steps {
    /// Their unit in documents.
    pub(super) unit: &'static str,
    /// Their unit in figures.
    pub(super) label: &'static str,
    pub(super) lengths: [f64; 4],
}

/// Errors at each step with both integrators; `error` measures one.
pub(super) fn convergences(
    (quantity, setting): (&str, &str),
    steps: &Steps,
    expected_order: [f64; 2],
    error: impl Fn(Means, f64) -> Result<f64>,
) -> Result<Vec<Convergence>> {
    let with = |means: Means| {
        let errors: Result<Vec<f64>> = steps.lengths.iter().map(|h| error(means, *h)).collect();
        Ok(Convergence::new(
            quantity,
            &format!("{setting}, {}", means.name()),
            steps.unit,
            &steps.lengths,
            &errors?,
            expected_order,
        ))
    };
    Means::INTEGRATORS.into_iter().map(with).collect()
}

/// Errors against the time step, one panel for each titled group, with slopes of order 1 and 2 to compare with.
pub(super) fn error_chart(steps: &Steps, groups: &[(&str, &[Convergence])]) -> ChartFigure {
    let panels = groups.iter().map(|(title, group)| {
        let panel = ChartPanel::new(steps.label, "relative error")
            .title(title)
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic);
        error_panel(panel, group)
    });
    let width = if groups.len() > 1 {
        Width::DoubleColumn
    } else {
        Width::SingleColumn
    };
    ChartFigure::grid(groups.len(), panels).width(width)
}

fn error_panel(mut panel: ChartPanel, convergences: &[Convergence]) -> ChartPanel {
    let (mut top, mut ends) = (0.0_f64, [1.0_f64, 0.0]);
    for (number, convergence) in convergences.iter().enumerate() {
        let Convergence { steps, errors, .. } = convergence;
        top = errors.iter().copied().fold(top, f64::max);
        for step in steps {
            ends = [ends[0].min(*step), ends[1].max(*step)];
        }
        // A setting ends with the integrator.
        let integrator = convergence.setting.rsplit(", ").next().unwrap_or_default();
        let name = format!("{}, {integrator}", convergence.quantity);
        let points = Points::new(&name, steps, errors)
            .series(number / 2)
            .joined();
        panel = panel.with(open_if(number % 2 == 1, points));
    }
    for (order, pattern) in [(1.0, Pattern::Dotted), (2.0, Pattern::Dashed)] {
        let at = |step: f64| 2.0 * top * libm::pow(step / ends[1], order);
        let line = Line::new(&format!("order {order}"), &ends, &ends.map(at));
        panel = panel.with(line.pattern(pattern).tint(Tint::Grey));
    }
    panel
}
