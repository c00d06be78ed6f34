//! F7: how the critical width depends on the strain rate.

use peristalsis_analysis::{LineFit, Uncertain, fit_line, fit_parabola};
use peristalsis_figures::chart::{
    Band, ChartFigure, ChartPanel, Line as Curve, Pattern, Points, Tint,
};
use peristalsis_figures::{Quantity as Axis, Width};

use super::{LATTICES, MOST_ESCAPED, Part, agrees, judge, label, lines_of, spaced, statistics};
use crate::claim::Claim;
use crate::critical::{Line, WINDOW};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::text::{estimate, interval, number};

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
/// The definition of the critical width that the verdict goes by, in words.
const DIVERGENCE: &str = "divergence of the mean time";
/// Strain rates that a slope takes.
const LEAST_RATES: usize = 3;
/// Smallest error of a critical width \[d\] that a fit uses: half of the spacing of the widths about it.
const LEAST_ERROR: f64 = 0.003;

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut parts = Vec::new();
    let mut quantities = Vec::new();
    let mut rows = Vec::new();
    let mut words = Vec::new();
    let mut periods: f64 = 0.0;
    let mut panel =
        ChartPanel::new(&label(Axis::StrainRate), &label(Axis::CriticalWidth)).x_range(0.0..);
    for (place, study) in LATTICES.into_iter().enumerate() {
        let lines = lines_of(evidence, study)?;
        let tight: Vec<&Line<'_>> = lines
            .iter()
            .filter(|line| line.escaped() <= MOST_ESCAPED)
            .collect();
        let fitted: Vec<&Line<'_>> = tight
            .iter()
            .copied()
            .filter(|line| line.fit(WINDOW).is_some())
            .collect();
        let mut holds = None;
        let name = study.0.name();
        periods = lines.iter().map(Line::periods).fold(periods, f64::max);
        for line in &lines {
            rows.push(row(&name, line));
        }
        let half: Vec<(f64, Uncertain)> = tight
            .iter()
            .filter_map(|line| Some((line.strain_rate, line.crossing()?.width)))
            .collect();
        let diverging: Vec<(f64, Uncertain)> = tight
            .iter()
            .filter_map(|line| Some((line.strain_rate, line.fit(WINDOW)?.critical_width)))
            .collect();
        if diverging.is_empty() {
            continue;
        }
        panel = with_points(panel, &diverging, &format!("{name} lattice"), place);
        for (how, critical) in [(DIVERGENCE, &diverging), ("half of the runs jam", &half)] {
            let [rate, width, error] = columns(critical);
            let Ok(line) = fit_line(&rate, &width, &error) else {
                continue;
            };
            let slope = stretched(&line);
            if how == DIVERGENCE {
                // A line through two points has no say.
                holds = agrees(&slope, SLOPE).filter(|_| rate.len() >= LEAST_RATES);
                words.push(format!("{} on the {name} lattice", estimate(&slope)));
                panel = with_line(panel, &line, &rate, place);
            }
            quantities.extend(of_line(&line, &slope, &name, how, critical.len()));
            if let Ok(curve) = fit_parabola(&rate, &width, &error) {
                quantities.push(Quantity {
                    name: format!("curvature of the critical width, {name} lattice, {how}"),
                    symbol: "*w*_{c}″/2".to_owned(),
                    unit: "d t^2".to_owned(),
                    source: Some(0.0),
                    ours: Some(curve.quadratic),
                    method: format!(
                        "parabola; probability of a line: {}",
                        number(curve.linearity, 3)
                    ),
                });
            }
        }
        parts.push(Part {
            lattice: name,
            holds,
            statistics: statistics(&fitted),
        });
    }
    let (verdict, found, why) = judge(&parts, &needed);
    if words.is_empty() {
        return Ok(Finding::nothing(
            "Too few strain rates with a critical width.",
            found,
            &needed,
        ));
    }
    panel = panel.with(
        Curve::new(
            "slope −3.75 (talk)",
            &[0.02, 0.12],
            &[3.0 - 0.075, 3.0 - 0.45],
        )
        .tint(Tint::Black)
        .pattern(Pattern::Dotted),
    );
    let mut finding = Finding::new(
        verdict,
        format!(
            "The slope is {}; the source says −3.75.{why}",
            words.join(" and ")
        ),
        found,
        &needed,
    );
    finding.quantities = quantities;
    finding.paragraphs.push(format!(
        "*w*_{{c}} is that of the power law of F2. The width at which half of the runs from rest jam within {periods} periods is \
         given beside it; it cannot lie higher but for its error, since runs end before the longest transitions. The arrangement \
         of the wall spheres, which the source does not give, decides the slope: see Q2. Strain rates at which more than 5 per \
         cent of the grains leave the tube are left out."
    ));
    finding.tables.push(ReportTable {
        caption: "Critical width of each strain rate, where half of the runs jam and where the mean time diverges.".to_owned(),
        head: ["lattice", "*ε̇*", "half jam", "bracket", "divergence", "95 %", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    finding.weaknesses.push(
        "Where *χ*^2 exceeds its degrees of freedom, the line or the errors of *w*_{c} are not the whole truth; the error of \
         the slope is then stretched by Birge's ratio."
            .to_owned(),
    );
    finding.figures.push(ReportFigure {
        name: "critical-width".to_owned(),
        caption: "Critical width against strain rate on both lattices with fitted lines and their 68 per cent bands; dotted: \
                  the slope of the source through *w*_{max} = 2*a*."
            .to_owned(),
        drawing: ChartFigure::new(panel)
            .width(Width::SingleColumn)
            .description("Critical width against strain rate with fitted lines.")
            .draw()?,
    });
    Ok(finding)
}

fn row(name: &str, line: &Line<'_>) -> Vec<String> {
    let half = line.crossing().map(|crossing| crossing.width);
    let diverging = line.fit(WINDOW).map(|fit| fit.critical_width);
    let cell = |width: &Option<Uncertain>, say: fn(&Uncertain) -> String| {
        width.as_ref().map_or("–".to_owned(), say)
    };
    vec![
        name.to_owned(),
        number(line.strain_rate, 3),
        cell(&half, estimate),
        cell(&half, interval),
        cell(&diverging, estimate),
        cell(&diverging, interval),
        number(line.escaped(), 2),
    ]
}

/// Strain rate, critical width and its error.
fn columns(critical: &[(f64, Uncertain)]) -> [Vec<f64>; 3] {
    [
        critical.iter().map(|one| one.0).collect(),
        critical.iter().map(|one| one.1.value).collect(),
        critical
            .iter()
            .map(|one| one.1.error.max(LEAST_ERROR))
            .collect(),
    ]
}

fn with_points(
    panel: ChartPanel,
    critical: &[(f64, Uncertain)],
    name: &str,
    place: usize,
) -> ChartPanel {
    let [rate, width, error] = columns(critical);
    panel.with(
        Points::new(name, &rate, &width)
            .y_errors(&error)
            .series(place),
    )
}

/// Slope and intercept as quantities.
fn of_line(
    line: &LineFit,
    slope: &Uncertain,
    name: &str,
    how: &str,
    rates: usize,
) -> [Quantity; 2] {
    let method = format!(
        "{how}; weighted line through {rates} strain rates; χ^2 = {} for {} degrees of freedom, error stretched by {}",
        number(line.chi_squared, 1),
        line.degrees_of_freedom,
        number(line.scale_factor(), 1),
    );
    let quantity =
        |symbol: &str, what: &str, unit: &str, source: Option<f64>, ours: Uncertain| Quantity {
            name: format!("{what}, {name} lattice, {how}"),
            symbol: symbol.to_owned(),
            unit: unit.to_owned(),
            source,
            ours: Some(ours),
            method: method.clone(),
        };
    [
        quantity(
            "d*w*_{c}/d*ε̇*",
            "slope of the critical width",
            "d t",
            Some(SLOPE),
            *slope,
        ),
        quantity(
            "*w*_{max}",
            "critical width at strain rate 0",
            "d",
            None,
            Uncertain::normal(
                line.intercept.value,
                line.intercept.error * line.scale_factor(),
            ),
        ),
    ]
}

/// The slope with its error stretched to the scatter about the line.
fn stretched(line: &LineFit) -> Uncertain {
    Uncertain::normal(line.slope.value, line.slope.error * line.scale_factor())
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
