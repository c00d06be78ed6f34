//! The figure of Q7: four corners at the bottlenecks that were measured.

use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Points, Reference, Tint,
};
use peristalsis_figures::{Quantity as Axis, Units, Width};
use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::super::spaced;
use super::{Corner, STARTS, State};
use crate::error::ClaimError;
use crate::finding::ReportFigure;

/// Flow against the measured bottleneck, a panel a corner.
pub(super) fn figure(corners: &[Corner<'_>]) -> Result<ReportFigure, ClaimError> {
    let widths = || {
        corners
            .iter()
            .flat_map(|corner| corner.states().map(|state| state.bottleneck.value))
    };
    let least = widths().fold(f64::INFINITY, f64::min);
    let largest = widths().fold(0.0, f64::max);
    let margin = 0.05 * (largest - least).max(0.1);
    let panels = corners.iter().map(|corner| {
        let mut panel = ChartPanel::new(
            "bottleneck as measured, *w*/*d*",
            &Axis::FlowRateRatio.label(Units::Hertz),
        )
        .title(&corner.name())
        .x_range(least - margin..=largest + margin)
        .y_range(-0.2..=1.1)
        .with(Reference::horizontal(0.0));
        for (series, (states, (_, name))) in corner.branches.iter().zip(STARTS).enumerate() {
            // In the order of the bottleneck, so that the line does not run back and forth.
            let mut states = states.clone();
            states.sort_by(|one, other| one.bottleneck.value.total_cmp(&other.bottleneck.value));
            if states.is_empty() {
                continue;
            }
            let column =
                |value: fn(&State) -> f64| -> Vec<f64> { states.iter().map(value).collect() };
            let points = Points::new(
                name,
                &column(|state| state.bottleneck.value),
                &column(|state| state.flow.value),
            )
            .y_errors(&column(|state| state.flow.error))
            .x_errors(&column(|state| state.bottleneck.error))
            .series(series)
            .joined();
            panel = panel.with(if series == 1 { points.open() } else { points });
        }
        let radius = corner.rows.first().map_or(1.0, |row| row.number("radius"));
        let (x, y): (Vec<f64>, Vec<f64>) = spaced(least, largest.min(2.0 * radius), 100)
            .into_iter()
            .filter_map(|width| {
                let fluid = NewtonianPeristalsis::from_width(width, radius, 0.0)?;
                Some((width, fluid.flow_rate_ratio()))
            })
            .unzip();
        if x.len() > 1 {
            panel = panel.with(
                Line::new("Newtonian fluid", &x, &y)
                    .tint(Tint::Grey)
                    .pattern(Pattern::Dashed),
            );
        }
        panel
    });
    Ok(ReportFigure {
        name: "two-by-two".to_owned(),
        caption: "Flow against the bottleneck that was measured: grains with and without friction (left, right) in a prescribed and \
                  in an elastic wall (above, below), from both starts; a wide bottleneck is a small amplitude. Dashed: a Newtonian \
                  fluid in a sine of that bottleneck."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .width(Width::DoubleColumn)
            .share_x()
            .share_y()
            .legend(LegendPlace::Below)
            .description("Flow against bottleneck in four panels: friction by control.")
            .draw()?,
    })
}
