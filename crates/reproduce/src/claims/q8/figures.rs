//! The figure of Q8: flow and fluctuation in tubes of several lengths, and the loops of sweeps.

use super::{AtRate, Loop, Size};
use crate::claims::elastic::label;
use crate::claims::prelude::*;

/// Flow and fluctuation against the force, a column a strain rate, and below the loops.
pub(super) fn panels(rates: &[AtRate<'_, '_>]) -> Vec<ChartPanel> {
    let mut panels = Vec::new();
    if rates.iter().any(|at| !at.sizes.is_empty()) {
        panels.extend(rates.iter().map(flow));
        panels.extend(rates.iter().map(fluctuation));
    }
    let has_passed = |one: &&Loop| one.up.is_some() || one.down.is_some();
    if rates.iter().any(|at| at.loops.iter().any(has_passed)) {
        panels.extend(rates.iter().map(sweeps));
    }
    panels
}

fn title(at: &AtRate<'_, '_>) -> String {
    let rate = number(1e3 * at.rate, 2);
    format!("*ε̇* = {rate} × 10^{{−3}}/*t*^{{\\*}}")
}

fn flow(at: &AtRate<'_, '_>) -> ChartPanel {
    let panel = against_force(&label(Axis::FlowRateRatio))
        .title(&title(at))
        .with(Reference::horizontal(0.0));
    with_series(panel, by_length(at, |_, point| Some(point.flow)))
}

fn fluctuation(at: &AtRate<'_, '_>) -> ChartPanel {
    let panel = against_force("fluctuation, (*L*/*λ*) *χ_J*").y_scale(Scale::Logarithmic);
    let fluctuation = |size: &Size<'_>, point: &Point<'_>| {
        size.fluctuation(point).filter(|mean| mean.value > 0.0)
    };
    with_series(panel, by_length(at, fluctuation))
}

fn against_force(y_label: &str) -> ChartPanel {
    ChartPanel::new("force amplitude, 10^{3}*f*^{P}/*Yd*^{2}", y_label)
}

/// How far points at one force are apart, in the unit of the axis.
const ASIDE: f64 = 0.05;

/// A series for each length, its points a little aside of those of the others.
fn by_length(
    at: &AtRate<'_, '_>,
    value: impl Fn(&Size<'_>, &Point<'_>) -> Option<Uncertain>,
) -> Vec<Points> {
    let series = |(place, size): (usize, &&Size<'_>)| {
        let aside = ASIDE * (place as f64 - 1.0);
        let at = |point: &Point<'_>| 1e3 * point.control + aside;
        let known = size.branch.points.iter();
        let known = known.filter_map(|point| Some((at(point), value(size, point)?)));
        let points = joined(&format!("{} waves", size.waves), known)?;
        // Curves that fall on one another are told apart by open marks.
        let is_open = place % 2 == 1;
        Some(if is_open { points.open() } else { points })
    };
    numbered(at.sizes.iter().enumerate().map(series)).collect()
}

fn sweeps(at: &AtRate<'_, '_>) -> ChartPanel {
    let force = |name: &str, force: fn(&Loop) -> Option<Uncertain>| {
        let known = at.loops.iter();
        let forces = known.filter_map(|one| Some((one.periods, force(one)?.scaled(1e3))));
        joined(name, forces)
    };
    let raised = force("force raised", |one| one.up).map(|points| points.series(3));
    let lowered = force("force lowered", |one| one.down).map(|points| points.series(4).open());
    let panel = ChartPanel::new(
        "length of the sweep, periods",
        "*J*/*J*_{max} = 1/2 at 10^{3}*f*^{P}/*Yd*^{2}",
    )
    .title(&title(at))
    .x_scale(Scale::Logarithmic);
    with_series(panel, raised.into_iter().chain(lowered).collect())
}

/// A panel without data has ranges to itself.
fn with_series(panel: ChartPanel, series: Vec<Points>) -> ChartPanel {
    if series.is_empty() {
        return panel.x_range(1.0..=10.0).y_range(0.01..=1.0);
    }
    panel.with_all(series)
}
