//! S3: the stationary flow against the force, a jump at large strain rates and none at small ones.

use peristalsis_analysis::{Bootstrap, Uncertain, dip_test, histogram, two_peaks};
use peristalsis_figures::chart::{
    Bars, ChartFigure, ChartPanel, LegendPlace, Points, Reference, Tint, Window,
};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::elastic::{
    branch_points, branch_runs, finding, judged, label, nothing, rate_colours, rate_text,
};
use crate::branches::bracket;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Verdict};
use crate::forces::{ForceLine, Kind, LEAST_JUMP, MOST_ESCAPED, outside, together};
use crate::prose::Prose;
use crate::runs::Run;
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("s3.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S3",
    prose: PROSE,
    studies: &["elastic-branches", "elastic-extremes"],
    examine,
};

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let runs = branch_runs(evidence)?;
    let lines = ForceLine::all_of(&runs);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(nothing("No runs yet."));
    }
    let of_kind = |kind: Kind| -> Vec<f64> {
        tight
            .iter()
            .filter(|line| line.kind() == kind)
            .map(|line| line.strain_rate)
            .collect()
    };
    let (jumping, smooth) = (of_kind(Kind::Jump), of_kind(Kind::Smooth));
    let vanishes = vanishing(&jumping, &smooth);
    let verdict = if vanishes.is_some() {
        Verdict::Reproduced
    } else if jumping.len() == tight.len() || smooth.len() == tight.len() {
        Verdict::Differs
    } else {
        Verdict::Open
    };
    let listed = |rates: &[f64]| -> String {
        if rates.is_empty() {
            return "no strain rate".to_owned();
        }
        let texts: Vec<String> = rates.iter().map(|rate| rate_text(*rate)).collect();
        format!("*ε̇* = {}", texts.join(", "))
    };
    let mut found = finding(
        verdict,
        format!(
            "The flow jumps, or both flows exist at one force, at {}; it rises smoothly, the same from both starts, at {}.{}",
            listed(&jumping),
            listed(&smooth),
            vanishes.as_ref().map_or(String::new(), |rate| format!(
                " The jump vanishes between {} and {}.",
                rate.interval_95.lower, rate.interval_95.upper
            )),
        ),
        together(tight.iter().copied()),
    );
    if let Some(rate) = vanishes {
        found.quantities.push(Quantity {
            name: "strain rate below which the jump vanishes".to_owned(),
            symbol: "*ε̇*".to_owned(),
            unit: "1/*t*^{\\*}".to_owned(),
            source: None,
            ours: Some(rate),
            method: "between the largest strain rate without a jump and the smallest with one"
                .to_owned(),
        });
    }
    for line in &tight {
        if let Some(height) = line.height() {
            found.quantities.push(Quantity {
                name: format!(
                    "height of the largest rise, strain rate {}",
                    line.strain_rate
                ),
                symbol: "Δ*J*/*J*_{max}".to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(height),
                method: "distance of both flows at the forces that have both, else both sides of the rise continued to it by straight lines, the smaller of both starts".to_owned(),
            });
        }
    }
    found.tables.push(table(&runs, &lines));
    found.paragraphs.push(format!(
        "A jump is a rise between forces 0.0005 apart by more than {LEAST_JUMP} when both sides are continued to its middle by straight \
         lines, or a force at which grains that began jammed flow faster by more than that than those that began at rest; both by four \
         of their errors. Forces at which more than {} per cent of the grains leave the tube are left out, and listed.",
        number(100.0 * MOST_ESCAPED, 0)
    ));
    found.weaknesses.push(
        "Peaks and dip are of runs at chosen forces: where these lie far apart, a smooth rise leaves a gap as well."
            .to_owned(),
    );
    found.weaknesses.push(
        "A continuous transition and a small jump that the distance of the forces hides look the same: the table gives the bracket."
            .to_owned(),
    );
    found.figures.push(branches(&lines, &tight)?);
    found.figures.extend(peaks(&runs, &tight)?);
    Ok(found)
}

/// The bracket of the strain rate at which the jump vanishes: all that jump are faster than all that do not.
fn vanishing(jumping: &[f64], smooth: &[f64]) -> Option<Uncertain> {
    let slowest = jumping.iter().copied().reduce(f64::min)?;
    let fastest = smooth.iter().copied().reduce(f64::max)?;
    (fastest < slowest).then(|| bracket(fastest, slowest))
}

/// J/Jmax of all stationary runs of a line.
fn flows(runs: &[Run], line: &ForceLine) -> Vec<f64> {
    runs.iter()
        .filter(|run| run.strain_rate == line.strain_rate && run.is_stationary())
        .filter(|run| !line.leaking.contains(&run.force()))
        .map(|run| run.flow_rate_ratio)
        .filter(|ratio| ratio.is_finite())
        .collect()
}

fn table(runs: &[Run], lines: &[ForceLine]) -> ReportTable {
    let none = || "–".to_owned();
    let rows = lines
        .iter()
        .map(|line| {
            let flows = flows(runs, line);
            let bootstrap = Bootstrap {
                resamples: 500,
                seed: 7,
            };
            vec![
                rate_text(line.strain_rate),
                line.rest
                    .rise()
                    .map_or_else(none, |rise| format!("{} … {}", rise.before, rise.after)),
                line.jammed
                    .rise()
                    .map_or_else(none, |rise| format!("{} … {}", rise.before, rise.after)),
                line.height().map_or_else(none, |height| estimate(&height)),
                line.window().map_or_else(none, |(least, largest)| {
                    if largest.is_finite() {
                        format!("{} … {}", number(least, 4), number(largest, 4))
                    } else if least > 0.0 {
                        format!("> {}", number(least, 4))
                    } else {
                        // One force, the last that was tried.
                        "> 0".to_owned()
                    }
                }),
                two_peaks(&flows).map_or_else(
                    |_| none(),
                    |peaks| if peaks.is_double() { "two" } else { "one" }.to_owned(),
                ),
                dip_test(&flows, bootstrap)
                    .map_or_else(|_| none(), |test| number(test.probability, 3)),
                // A line that leaks all along is called so in its last column.
                outside(
                    line.escaped,
                    if line.is_empty() { &[] } else { &line.leaking },
                ),
                match line.kind() {
                    _ if line.is_empty() && !line.leaking.is_empty() => "leaks",
                    Kind::Jump => "jump",
                    Kind::Smooth => "smooth",
                    Kind::Unclear => "unclear",
                }
                .to_owned(),
            ]
        })
        .collect();
    ReportTable {
        caption: "Where the stationary flow rises most, from rest and from jammed (bracket in *f*^{P}); height of that rise; width of the \
                  window of forces with both flows; peaks of *J*/*J*_{max} over all forces and both starts (two normal peaks against one) and the \
                  probability of so deep a dip with one peak (Hartigan); largest part of the grains outside, and the forces left out for it."
            .to_owned(),
        head: ["*ε̇*", "rise, from rest", "from jammed", "height", "window", "peaks", "dip", "outside", "kind"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }
}

/// Both branches at each strain rate, and the height of the rise against the strain rate.
fn branches(lines: &[ForceLine], tight: &[&ForceLine]) -> Result<ReportFigure, ClaimError> {
    let mut flow = ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio));
    for (place, line) in tight.iter().enumerate() {
        if let Some(rest) = branch_points(&line.rest, "", place, line.strain_rate) {
            flow = flow.with(rest);
        }
        if let Some(jammed) = branch_points(&line.jammed, "", place, line.strain_rate) {
            flow = flow.with(jammed.open());
        }
    }
    let windows = tight.iter().rev().filter_map(|line| {
        let both = line.both();
        Some((*both.first()?, *both.last()?))
    });
    if let Some((first, last)) = windows.into_iter().find(|(first, last)| last > first) {
        flow = flow.with(Window::new("", first, last));
    }
    let mut panels = vec![flow.title("filled: from rest, open: from jammed")];
    if tight.iter().any(|line| line.height().is_some()) {
        let mut heights = ChartPanel::new(
            &label(Axis::StrainRate),
            "height of the jump, Δ*J*/*J*_{max}",
        )
        .x_scale(Scale::Logarithmic)
        .y_range(0.0..=1.05)
        .with(Reference::horizontal(LEAST_JUMP).label("counts as a jump"));
        for (place, line) in tight.iter().enumerate() {
            if let Some(found) = line.height() {
                let point = Points::new("", &[line.strain_rate], &[found.value.max(0.0)])
                    .y_errors(&[found.error])
                    .series(place)
                    .tint(Tint::Value(line.strain_rate));
                heights = heights.with(if line.kind() == Kind::Unclear {
                    point.open()
                } else {
                    point
                });
            }
        }
        panels.push(heights.title("open: forces too far apart to tell"));
    }
    Ok(ReportFigure {
        name: "branches".to_owned(),
        caption: "Stationary *J*/*J*_{max} against the force from rest (filled) and from jammed (open) at several strain rates; shaded: \
                  both flows exist, at the largest of them that has several such forces. Right: distance of both flows where both exist, else how high the \
                  flow rises at once between two forces, both sides continued."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .legend(LegendPlace::Hidden)
            .colour_scale(rate_colours(lines))
            .width(Width::DoubleColumn)
            .description("Stationary flow rate against the force from both starts, and the height of its largest rise.")
            .draw()?,
    })
}

/// Histograms of J/Jmax, for the slowest and the fastest wave of those with most runs.
fn peaks(runs: &[Run], tight: &[&ForceLine]) -> Result<Option<ReportFigure>, ClaimError> {
    let most = tight
        .iter()
        .map(|line| line.statistics.runs)
        .max()
        .unwrap_or(0);
    let many: Vec<&ForceLine> = tight
        .iter()
        .copied()
        .filter(|line| 2 * line.statistics.runs >= most)
        .collect();
    let chosen = many
        .first()
        .into_iter()
        .chain(many.last().filter(|_| many.len() > 1));
    let mut panels = Vec::new();
    for line in chosen {
        let Ok(counts) = histogram(&flows(runs, line), -0.2, 1.0, 24) else {
            continue;
        };
        let heights: Vec<f64> = counts.counts.iter().map(|count| *count as f64).collect();
        if heights.iter().sum::<f64>() > 0.0 {
            panels.push(
                ChartPanel::new(&label(Axis::FlowRateRatio), "runs")
                    .title(&format!("*ε̇* = {}", rate_text(line.strain_rate)))
                    .with(Bars::new("", &counts.edges, &heights).tint(Tint::Blue)),
            );
        }
    }
    if panels.is_empty() {
        return Ok(None);
    }
    Ok(Some(ReportFigure {
        name: "peaks-against-force".to_owned(),
        caption: "Stationary *J*/*J*_{max} of all runs from both starts and at all forces, at the smallest and the largest strain rate of \
                  those with most runs: a jump leaves a gap, a smooth rise none but those between its forces."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .width(Width::DoubleColumn)
            .description("Histograms of the stationary flow rate.")
            .draw()?,
    }))
}
