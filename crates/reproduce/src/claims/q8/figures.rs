//! The figure of Q8: flow and fluctuation in tubes of several lengths, and the loops of sweeps.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Points, Reference};
use peristalsis_figures::{Quantity as Axis, Scale, Units, Width};

use super::{Ladder, Loop, PASSED, Rung};
use crate::error::ClaimError;
use crate::finding::ReportFigure;
use crate::rows::Mean;
use crate::text::number;

/// Forces are drawn in thousandths of Y d^2.
const THOUSAND: f64 = 1e3;

/// Flow and fluctuation against the force, a column a strain rate, and below the loops.
pub(super) fn figure(
    rates: &[f64],
    ladders: &[Ladder<'_>],
    loops: &[Loop],
) -> Result<Option<ReportFigure>, ClaimError> {
    let mut panels = Vec::new();
    let title = |rate: f64| {
        format!(
            "*ε̇* = {} × 10^{{−3}}/*t*^{{\\*}}",
            number(THOUSAND * rate, 2)
        )
    };
    let force = "force amplitude, 10^{3}*f*^{P}/*Yd*^{2}";
    let flows = if ladders.is_empty() { &[] } else { rates };
    for rate in flows {
        let panel = ChartPanel::new(force, &Axis::FlowRateRatio.label(Units::Hertz))
            .title(&title(*rate))
            .with(Reference::horizontal(0.0));
        panels.push(with_lengths(panel, *rate, ladders, |rung| Some(rung.flow)));
    }
    for rate in flows {
        let panel =
            ChartPanel::new(force, "fluctuation, (*L*/*λ*) *χ_J*").y_scale(Scale::Logarithmic);
        panels.push(with_lengths(panel, *rate, ladders, |rung| {
            rung.fluctuation.filter(|mean| mean.value > 0.0)
        }));
    }
    let swept = loops
        .iter()
        .any(|one| one.up.is_some() || one.down.is_some());
    for rate in if swept { rates } else { &[] } {
        let mut here: Vec<&Loop> = loops.iter().filter(|one| one.rate == *rate).collect();
        here.sort_by(|one, other| one.periods.total_cmp(&other.periods));
        let mut panel = ChartPanel::new(
            "length of the sweep, periods",
            "*J*/*J*_{max} = 1/2 at 10^{3}*f*^{P}/*Yd*^{2}",
        )
        .title(&title(*rate))
        .x_scale(Scale::Logarithmic);
        let mut is_empty = true;
        for (series, (name, value)) in [
            (
                "force raised",
                (|one: &Loop| one.up) as fn(&Loop) -> Option<Mean>,
            ),
            ("force lowered", |one| one.down),
        ]
        .into_iter()
        .enumerate()
        {
            let known: Vec<(f64, Mean)> = here
                .iter()
                .filter_map(|one| Some((one.periods, value(one)?)))
                .collect();
            if !known.is_empty() {
                let points = points(name, &known, THOUSAND).series(3 + series);
                panel = panel.with(if series == 1 { points.open() } else { points });
                is_empty = false;
            }
        }
        panels.push(if is_empty { empty(panel) } else { panel });
    }
    if panels.is_empty() {
        return Ok(None);
    }
    Ok(Some(ReportFigure {
        name: "small-speed".to_owned(),
        caption: format!(
            "Stationary flow from rest and its fluctuation (variance of the period averages times the number of waves) against the \
             force in tubes of several lengths, and the forces at which slow sweeps pass *J*/*J*_{{max}} = {PASSED}, at two strain \
             rates."
        ),
        drawing: ChartFigure::grid(rates.len(), panels)
            .width(Width::DoubleColumn)
            .panel_height(36.0)
            .legend(LegendPlace::Below)
            .description("Flow, fluctuation and loops of sweeps at two strain rates.")
            .draw()?,
    }))
}

/// A panel without data, with ranges to itself.
fn empty(panel: ChartPanel) -> ChartPanel {
    panel.x_range(1.0..=10.0).y_range(0.01..=1.0)
}

/// A series for each length.
fn with_lengths(
    mut panel: ChartPanel,
    rate: f64,
    ladders: &[Ladder<'_>],
    value: impl Fn(&Rung) -> Option<Mean>,
) -> ChartPanel {
    let here = ladders.iter().filter(|one| one.rate == rate);
    let mut is_empty = true;
    for (series, ladder) in here.enumerate() {
        let known: Vec<(f64, Mean)> = ladder
            .points
            .iter()
            .filter_map(|rung| Some((THOUSAND * rung.force, value(rung)?)))
            .collect();
        if !known.is_empty() {
            let name = format!("{} waves", ladder.waves);
            let points = points(&name, &known, 1.0).series(series);
            // Curves that fall on one another are told apart by open marks.
            panel = panel.with(if series % 2 == 1 {
                points.open()
            } else {
                points
            });
            is_empty = false;
        }
    }
    if is_empty { empty(panel) } else { panel }
}

/// Points with errors, joined; ordinates times a factor.
fn points(name: &str, known: &[(f64, Mean)], factor: f64) -> Points {
    let column =
        |value: &dyn Fn(&(f64, Mean)) -> f64| -> Vec<f64> { known.iter().map(value).collect() };
    Points::new(
        name,
        &column(&|one| one.0),
        &column(&|one| factor * one.1.value),
    )
    .y_errors(&column(&|one| factor * one.1.error))
    .joined()
}
