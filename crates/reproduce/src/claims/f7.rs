//! F7: how the critical width depends on the strain rate.

use peristalsis_analysis::{LineFit, Uncertain, fit_line, fit_parabola};
use peristalsis_figures::chart::{Band, ChartFigure, ChartPanel, Line as Curve, Pattern, Tint};
use peristalsis_figures::{Quantity as Axis, Width};

use crate::claim::Claim;
use crate::critical::{Line, OnLattice};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{cell, cell_of, label, points, spaced};
use crate::finding::{Finding, Quantity, Statistics};
use crate::judgement::{agrees, judge};
use crate::prose::Prose;
use crate::text::{interval, number};
use crate::thresholds::{LEAST_ERROR_OF_A_WIDTH, LEAST_RATES_OF_A_SLOPE};

const PROSE: Prose = Prose::new(include_str!("f7.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F7",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// What the source says.
const SLOPE: f64 = -3.75;
/// The definition of the critical width that the verdict goes by, in words, and the other one.
const DIVERGENCE: &str = "divergence of the mean time";
const HALF: &str = "half of the runs jam";

/// Strain rates with their critical widths, ascending.
type Critical = Vec<(f64, Uncertain)>;

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let (mut parts, mut slopes, mut quantities) = (Vec::new(), Vec::new(), Vec::new());
    let mut rows = Vec::new();
    let mut periods: f64 = 0.0;
    let mut panel =
        ChartPanel::new(&label(Axis::StrainRate), &label(Axis::CriticalWidth)).x_range(0.0..);
    for (place, one) in OnLattice::all(evidence)?.iter().enumerate() {
        let of = |critical: fn(&Line<'_>) -> Option<Uncertain>| -> Critical {
            let tight = one.tight();
            tight
                .filter_map(|line| Some((line.strain_rate, critical(line)?)))
                .collect()
        };
        periods = one.lines.iter().map(Line::periods).fold(periods, f64::max);
        rows.extend(one.lines.iter().map(|line| row(&one.name, line)));
        let diverging = of(diverging);
        if diverging.is_empty() {
            continue;
        }
        let drawn = points(
            &format!("{} lattice", one.name),
            with_least_error(&diverging),
        );
        panel = panel.with_all(drawn.map(|points| points.series(place)));
        let mut holds = None;
        for (how, critical) in [(DIVERGENCE, &diverging), (HALF, &of(half))] {
            let [rate, width, error] = columns(critical);
            let Ok(line) = fit_line(&rate, &width, &error) else {
                continue;
            };
            let slope = stretched(&line, line.slope);
            if how == DIVERGENCE {
                // A line through two points has no say.
                holds = agrees(&slope, SLOPE).filter(|_| rate.len() >= LEAST_RATES_OF_A_SLOPE);
                slopes.push(format!("{slope} on the {} lattice", one.name));
                panel = with_line(panel, &line, &rate, place);
            }
            quantities.extend(of_line(&line, &one.name, how, rate.len()));
            if let Ok(curve) = fit_parabola(&rate, &width, &error) {
                let probability = number(curve.linearity, 3);
                quantities.push(Quantity {
                    source: Some(0.0),
                    ..PROSE.quantity(
                        "curvature",
                        &[
                            ("lattice", &one.name),
                            ("how", &how),
                            ("probability", &probability),
                        ],
                        curve.quadratic,
                    )
                });
            }
        }
        parts.push(one.part(holds));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if slopes.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let ends = [3.0 - 0.075, 3.0 - 0.45];
    panel = panel.with(
        Curve::new("slope −3.75 (talk)", &[0.02, 0.12], &ends)
            .tint(Tint::Black)
            .pattern(Pattern::Dotted),
    );
    let summary = PROSE.text(
        "summary",
        &[("slopes", &slopes.join(" and ")), ("why", &why)],
    );
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    finding.quantities = quantities;
    finding.paragraphs = PROSE.paragraphs("method", &[("periods", &periods)]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    finding
        .tables
        .push(PROSE.table("critical widths", &[], rows));
    let drawing = ChartFigure::new(panel)
        .width(Width::SingleColumn)
        .description("Critical width against strain rate with fitted lines.")
        .draw()?;
    finding
        .figures
        .push(PROSE.figure("critical-width", &[], drawing));
    Ok(finding)
}

fn diverging(line: &Line<'_>) -> Option<Uncertain> {
    Some(line.fit.as_ref()?.critical_width)
}

fn half(line: &Line<'_>) -> Option<Uncertain> {
    Some(line.crossing()?.width)
}

fn row(lattice: &str, line: &Line<'_>) -> Vec<String> {
    let interval = |width: Option<Uncertain>| cell_of(width, |width| interval(&width));
    vec![
        lattice.to_owned(),
        number(line.strain_rate, 3),
        cell(half(line)),
        interval(half(line)),
        cell(diverging(line)),
        interval(diverging(line)),
        number(line.escaped(), 2),
    ]
}

/// Critical widths with errors no smaller than [`LEAST_ERROR_OF_A_WIDTH`].
fn with_least_error(critical: &Critical) -> Critical {
    let widened =
        |width: &Uncertain| Uncertain::normal(width.value, width.error.max(LEAST_ERROR_OF_A_WIDTH));
    critical
        .iter()
        .map(|(rate, width)| (*rate, widened(width)))
        .collect()
}

/// Strain rate, critical width and its error.
fn columns(critical: &Critical) -> [Vec<f64>; 3] {
    let critical = with_least_error(critical);
    [
        critical.iter().map(|one| one.0).collect(),
        critical.iter().map(|one| one.1.value).collect(),
        critical.iter().map(|one| one.1.error).collect(),
    ]
}

/// A parameter of a line with its error stretched to the scatter about the line.
fn stretched(line: &LineFit, parameter: Uncertain) -> Uncertain {
    Uncertain::normal(parameter.value, parameter.error * line.scale_factor())
}

/// Slope and intercept as quantities.
fn of_line(line: &LineFit, lattice: &str, how: &str, rates: usize) -> [Quantity; 2] {
    let method = PROSE.text(
        "line",
        &[
            ("how", &how),
            ("rates", &rates),
            ("chi_squared", &number(line.chi_squared, 1)),
            ("freedom", &line.degrees_of_freedom),
            ("factor", &number(line.scale_factor(), 1)),
        ],
    );
    let slope = PROSE.quantity(
        "slope",
        &[("lattice", &lattice), ("how", &how), ("line", &method)],
        stretched(line, line.slope),
    );
    let intercept = PROSE.quantity(
        "intercept",
        &[("lattice", &lattice), ("how", &how), ("line", &method)],
        stretched(line, line.intercept),
    );
    let source = Some(SLOPE);
    [Quantity { source, ..slope }, intercept]
}

fn with_line(panel: ChartPanel, line: &LineFit, rates: &[f64], place: usize) -> ChartPanel {
    let largest = rates.iter().copied().fold(0.0, f64::max);
    let x = spaced(0.0, largest, 40);
    let at: Vec<Uncertain> = x.iter().map(|rate| line.at(*rate)).collect();
    let reach = line.scale_factor();
    let side = |sign: f64| -> Vec<f64> {
        at.iter()
            .map(|one| one.value + sign * reach * one.error)
            .collect()
    };
    let middle: Vec<f64> = at.iter().map(|one| one.value).collect();
    panel
        .with(Band::new("", &x, &side(-1.0), &side(1.0)).series(place))
        .with(Curve::new("", &x, &middle).series(place).weight(0.8))
}
