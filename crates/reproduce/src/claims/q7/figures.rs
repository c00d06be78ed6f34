//! The figure of Q7: four corners at the bottlenecks that were measured.

use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::{Corner, bottleneck};
use crate::claims::elastic::label;
use crate::claims::prelude::*;

/// Flow against the measured bottleneck, a panel a corner.
pub(super) fn chart(corners: &[Corner<'_>]) -> ChartFigure {
    let points = corners.iter().flat_map(|corner| corner.flow.points());
    let [least, largest] = extremes(points.map(|point| bottleneck(point).value));
    let panels = corners.iter().map(|corner| panel(corner, least, largest));
    grid(2, panels)
        .share_x()
        .share_y()
        .legend(LegendPlace::Below)
}

/// One corner, between the least and the largest bottleneck of all.
fn panel(corner: &Corner<'_>, least: f64, largest: f64) -> ChartPanel {
    let margin = 0.05 * (largest - least).max(0.1);
    let rest = flows("from rest", &corner.flow.rest);
    let jammed = flows("from jammed", &corner.flow.jammed);
    ChartPanel::new(
        "bottleneck as measured, *w*/*d*",
        &label(Axis::FlowRateRatio),
    )
    .title(&corner.name())
    .x_range(least - margin..=largest + margin)
    .y_range(-0.2..=1.1)
    .with(Reference::horizontal(0.0))
    .with_all(rest.map(|points| points.series(0)))
    .with_all(jammed.map(|points| points.series(1).open()))
    .with_all(of_fluid(corner, least, largest))
}

/// A branch against the bottleneck, in its order, so that the line does not run back and forth.
fn flows(name: &str, branch: &Branch<'_>) -> Option<Points> {
    let known = branch.points.iter();
    let mut known: Vec<_> = known.map(|point| (bottleneck(point), point.flow)).collect();
    known.sort_by(|one, other| one.0.value.total_cmp(&other.0.value));
    let errors: Vec<f64> = known
        .iter()
        .map(|one| 0.5 * one.0.interval_68.length())
        .collect();
    let points = joined(name, known.iter().map(|one| (one.0.value, one.1)))?;
    let points = points.x_errors(&errors);
    let jump = branch.step().filter(|_| branch.jumps());
    let ends = jump.map(|jump| {
        jump.controls
            .map(|control| branch.at(control).map(bottleneck))
    });
    Some(match ends {
        Some([Some(one), Some(other)]) => points.broken_at(0.5 * (one.value + other.value)),
        _ => points,
    })
}

/// A Newtonian fluid in a sine of each bottleneck.
fn of_fluid(corner: &Corner<'_>, least: f64, largest: f64) -> Option<Curve> {
    let radius = corner.rows.first()?.radius();
    let flow = |width| {
        let fluid = NewtonianPeristalsis::from_width(width, radius, 0.0)?;
        Some((width, fluid.flow_rate_ratio()))
    };
    let widths = spaced(least, largest.min(2.0 * radius), 100);
    fluid(Tint::Grey, widths.into_iter().map(flow))
}
