//! S3: the stationary flow against the force, a jump at large strain rates and none at small ones.

use peristalsis_analysis::{Bootstrap, Uncertain, dip_test, histogram, two_peaks};
use peristalsis_figures::chart::{
    Bars, ChartFigure, ChartPanel, LegendPlace, Points, Reference, Tint, Window,
};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::elastic::{
    branch_rows, finding, flow_against_force, judged, label, nothing, rate_colours, with_branches,
};
use crate::branch::{Branch, bracket};
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{cell, cell_of};
use crate::finding::{Finding, Quantity, ReportFigure, Verdict};
use crate::forces::{ForceLine, Kind, outside, together};
use crate::prose::Prose;
use crate::row::Row;
use crate::text::number;
use crate::thresholds::{LEAST_JUMP_AGAINST_FORCE, MOST_ESCAPED};

const PROSE: Prose = Prose::new(include_str!("s3.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S3",
    prose: PROSE,
    studies: &["elastic-branches", "elastic-extremes"],
    examine,
};

/// Resamples of the test for a dip.
const BOOTSTRAP: Bootstrap = Bootstrap {
    resamples: 500,
    seed: 7,
};

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let rows = branch_rows(evidence)?;
    let lines = ForceLine::all_of(&rows);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(nothing("No runs yet."));
    }
    let of_kind = |kind: Kind| -> Vec<f64> {
        let lines = tight.iter().filter(|line| line.kind() == kind);
        lines.map(|line| line.strain_rate).collect()
    };
    let (jumping, smooth) = (of_kind(Kind::Jump), of_kind(Kind::Smooth));
    let vanishing = vanishing(&jumping, &smooth);
    let verdict = if vanishing.is_some() {
        Verdict::Reproduced
    } else if jumping.len() == tight.len() || smooth.len() == tight.len() {
        Verdict::Differs
    } else {
        Verdict::Open
    };
    let mut summary = PROSE.text(
        "summary",
        &[("jumping", &listed(&jumping)), ("smooth", &listed(&smooth))],
    );
    if let Some(rate) = vanishing {
        let bounds = rate.interval_95;
        let sentence = PROSE.text(
            "vanishing",
            &[("lower", &bounds.lower), ("upper", &bounds.upper)],
        );
        summary = format!("{summary} {sentence}");
    }
    let mut found = finding(verdict, summary, together(tight.iter().copied()));
    let vanishes = vanishing.map(|rate| PROSE.quantity("vanishing", &[], rate));
    let heights = tight.iter().filter_map(|line| height(line));
    found.quantities = vanishes.into_iter().chain(heights).collect();
    let cells = lines.iter().map(|line| cells(&rows, line)).collect();
    found.tables.push(PROSE.table("rises", &[], cells));
    found.paragraphs.push(PROSE.text(
        "method",
        &[
            ("least", &LEAST_JUMP_AGAINST_FORCE),
            ("escaped", &number(100.0 * MOST_ESCAPED, 0)),
        ],
    ));
    found.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    found.figures.push(branches(&lines, &tight)?);
    found.figures.extend(peaks(&rows, &tight)?);
    Ok(found)
}

/// The bracket of the strain rate at which the jump vanishes: all that jump are faster than all that do not.
fn vanishing(jumping: &[f64], smooth: &[f64]) -> Option<Uncertain> {
    let slowest = jumping.iter().copied().reduce(f64::min)?;
    let fastest = smooth.iter().copied().reduce(f64::max)?;
    (fastest < slowest).then(|| bracket(fastest, slowest))
}

/// Strain rates in words.
fn listed(rates: &[f64]) -> String {
    if rates.is_empty() {
        return "no strain rate".to_owned();
    }
    let texts: Vec<String> = rates.iter().map(f64::to_string).collect();
    format!("*ε̇* = {}", texts.join(", "))
}

fn height(line: &ForceLine<'_>) -> Option<Quantity> {
    Some(PROSE.quantity("height", &[("rate", &line.strain_rate)], line.height()?))
}

/// J/Jmax of all stationary runs of a line.
fn flows(rows: &[Row<'_>], line: &ForceLine<'_>) -> Vec<f64> {
    rows.iter()
        .filter(|row| row.strain_rate() == line.strain_rate && row.is_stationary())
        .filter(|row| !line.leaking.contains(&row.force()))
        .map(Row::flow_rate_ratio)
        .filter(|ratio| ratio.is_finite())
        .collect()
}

/// The row of the table for one strain rate.
fn cells(rows: &[Row<'_>], line: &ForceLine<'_>) -> Vec<String> {
    let flows = flows(rows, line);
    let rise = |branch: &Branch<'_>| {
        cell_of(branch.rise(), |rise| {
            format!("{} … {}", rise.controls[0], rise.controls[1])
        })
    };
    let window = |(least, largest): (f64, f64)| {
        if largest.is_finite() {
            format!("{} … {}", number(least, 4), number(largest, 4))
        } else if least > 0.0 {
            format!("> {}", number(least, 4))
        } else {
            // One force, the last that was tried.
            "> 0".to_owned()
        }
    };
    let leaks_all_along = line.is_empty() && !line.leaking.is_empty();
    let kind = match line.kind() {
        _ if leaks_all_along => "leaks",
        Kind::Jump => "jump",
        Kind::Smooth => "smooth",
        Kind::Unclear => "unclear",
    };
    let left_out: &[f64] = if leaks_all_along { &[] } else { &line.leaking };
    vec![
        line.strain_rate.to_string(),
        rise(&line.rest),
        rise(&line.jammed),
        cell(line.height()),
        cell_of(line.window(), window),
        cell_of(two_peaks(&flows).ok(), |peaks| {
            if peaks.is_double() { "two" } else { "one" }.to_owned()
        }),
        cell_of(dip_test(&flows, BOOTSTRAP).ok(), |test| {
            number(test.probability, 3)
        }),
        outside(line.escaped, left_out),
        kind.to_owned(),
    ]
}

/// Both branches at each strain rate, and the height of the rise against the strain rate.
fn branches(lines: &[ForceLine<'_>], tight: &[&ForceLine<'_>]) -> Result<ReportFigure, ClaimError> {
    let window = tight
        .iter()
        .rev()
        .filter_map(|line| line.both_ends())
        .find(|(first, last)| last > first);
    let flow = with_branches(flow_against_force(), tight)
        .with_all(window.map(|(first, last)| Window::new("", first, last)))
        .title("filled: from rest, open: from jammed");
    let figure = ChartFigure::grid(2, [flow].into_iter().chain(heights(tight)))
        .legend(LegendPlace::Hidden)
        .colour_scale(rate_colours(lines))
        .width(Width::DoubleColumn)
        .description("Stationary flow rate against the force from both starts, and the height of its largest rise.");
    Ok(PROSE.figure("branches", &[], figure.draw()?))
}

/// The height of the rise against the strain rate; `None` where no height is known.
fn heights(tight: &[&ForceLine<'_>]) -> Option<ChartPanel> {
    let points: Vec<Points> = tight
        .iter()
        .enumerate()
        .filter_map(|(place, line)| {
            let height = line.height()?;
            let point = Points::new("", &[line.strain_rate], &[height.value.max(0.0)])
                .y_errors(&[height.error])
                .series(place)
                .tint(Tint::Value(line.strain_rate));
            Some(if line.kind() == Kind::Unclear {
                point.open()
            } else {
                point
            })
        })
        .collect();
    let panel = ChartPanel::new(
        &label(Axis::StrainRate),
        "height of the jump, Δ*J*/*J*_{max}",
    )
    .x_scale(Scale::Logarithmic)
    .y_range(0.0..=1.05)
    .with(Reference::horizontal(LEAST_JUMP_AGAINST_FORCE).label("counts as a jump"))
    .title("open: forces too far apart to tell");
    (!points.is_empty()).then(|| panel.with_all(points))
}

/// Histograms of J/Jmax, for the slowest and the fastest wave of those with most runs.
fn peaks(rows: &[Row<'_>], tight: &[&ForceLine<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let runs = |line: &ForceLine<'_>| line.statistics.runs;
    let most = tight.iter().map(|line| runs(line)).max().unwrap_or(0);
    let many: Vec<&&ForceLine<'_>> = tight.iter().filter(|line| 2 * runs(line) >= most).collect();
    let last = many.last().filter(|_| many.len() > 1);
    let mut panels = Vec::new();
    for line in many.first().into_iter().chain(last) {
        let Ok(counts) = histogram(&flows(rows, line), -0.2, 1.0, 24) else {
            continue;
        };
        let heights: Vec<f64> = counts.counts.iter().map(|count| *count as f64).collect();
        if heights.iter().sum::<f64>() > 0.0 {
            panels.push(
                ChartPanel::new(&label(Axis::FlowRateRatio), "runs")
                    .title(&format!("*ε̇* = {}", line.strain_rate))
                    .with(Bars::new("", &counts.edges, &heights).tint(Tint::Blue)),
            );
        }
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let figure = ChartFigure::grid(2, panels)
        .width(Width::DoubleColumn)
        .description("Histograms of the stationary flow rate.");
    Ok(Some(PROSE.figure(
        "peaks-against-force",
        &[],
        figure.draw()?,
    )))
}
