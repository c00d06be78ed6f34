//! S5: no back flow without friction?

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Points, Reference, Tint};
use peristalsis_figures::{Quantity as Axis, Width};

use super::elastic::{
    SOURCE_RATE, branch_points, branch_runs, finding, judged, label, nothing, rate_colours,
    rate_text,
};
use super::s4::{lowest, negative};
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Verdict};
use crate::forces::{ForceLine, ForcePoint, together};
use crate::prose::Prose;
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("s5.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S5",
    prose: PROSE,
    studies: &[
        "elastic-frictionless",
        "elastic-branches",
        "elastic-extremes",
    ],
    examine,
};

/// Errors by which a flow must be above −[`NOT_BACK`] to be no back flow.
const SURE: f64 = 2.0;
/// Part of Jmax up to which a flow against the wave would go unnoticed.
const NOT_BACK: f64 = 0.01;

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let runs = &evidence.study("elastic-frictionless")?.runs;
    let lines = ForceLine::all_of(runs);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(nothing("No runs of frictionless grains yet."));
    }
    let frictional = ForceLine::all_of(&branch_runs(evidence)?);
    let backward = tight.iter().any(|line| !negative(line).is_empty());
    let points = || tight.iter().flat_map(|line| line.points());
    let never = points().all(|point| point.mean + NOT_BACK > SURE * point.error);
    let verdict = match (backward, never) {
        (true, _) => Verdict::Differs,
        (false, true) => Verdict::Reproduced,
        (false, false) => Verdict::Open,
    };
    let smallest = tight
        .iter()
        .filter_map(|line| Some((line.strain_rate, lowest(line)?)))
        .min_by(|one, other| one.1.mean.total_cmp(&other.1.mean));
    let mut found = finding(
        verdict,
        smallest.map_or_else(
            || "No stationary runs yet.".to_owned(),
            |(rate, point)| {
                format!(
                    "Without friction *J*/*J*_{{max}} is {} negative: the smallest of {} means is {}, at *f*^{{P}} = {}, *ε̇* = {}.",
                    if backward { "somewhere" } else { "nowhere" },
                    points().count(),
                    with_error(point.mean, point.error),
                    point.force,
                    rate_text(rate)
                )
            },
        ),
        together(tight.iter().copied()),
    );
    let (mut rows, mut pairs) = (Vec::new(), Vec::new());
    for line in &tight {
        let with = frictional
            .iter()
            .find(|other| other.strain_rate == line.strain_rate);
        let cell = |point: Option<&ForcePoint>| {
            point.map_or("–".to_owned(), |point| {
                with_error(point.mean, point.error)
            })
        };
        for point in &line.rest.points {
            let other = with.and_then(|with| with.rest.at(point.force));
            rows.push(vec![
                rate_text(line.strain_rate),
                format!("{}", point.force),
                cell(Some(point)),
                cell(line.jammed.at(point.force)),
                cell(other),
                number(point.escaped, 3),
            ]);
            if let Some(other) = other {
                pairs.push((line.strain_rate, *point, *other));
            }
        }
    }
    for (rate, without, with) in pairs.iter().filter(|pair| pair.2.mean < 0.0) {
        found.quantities.push(Quantity {
            name: format!(
                "flow rate without friction less that with it, strain rate {rate}, *f*^{{P}} = {}",
                without.force
            ),
            symbol: "Δ*J*/*J*_{max}".to_owned(),
            unit: String::new(),
            source: None,
            ours: Some(Uncertain::normal(
                without.mean - with.mean,
                without.error.hypot(with.error),
            )),
            method: "means over replicates from rest".to_owned(),
        });
    }
    found.tables.push(ReportTable {
        caption: "Stationary *J*/*J*_{max} of frictionless grains from rest and from jammed (“–”: most runs still drift), and of \
                  frictional ones from rest at the same force and strain rate; part of the frictionless grains outside, from rest."
            .to_owned(),
        head: ["*ε̇*", "*f*^{P}", "from rest", "from jammed", "frictional", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    found.paragraphs.push(format!(
        "Both coefficients of friction are 0, all else as with friction. “Never negative” is said where every mean, from either start, \
         is above −{NOT_BACK} by two of its errors."
    ));
    found.figures.push(figure(&lines, &tight, &frictional)?);
    Ok(found)
}

fn figure(
    lines: &[ForceLine],
    tight: &[&ForceLine],
    frictional: &[ForceLine],
) -> Result<ReportFigure, ClaimError> {
    let mut all = ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio))
        .with(Reference::horizontal(0.0));
    for (place, line) in tight.iter().enumerate() {
        for (branch, is_open) in [(&line.rest, false), (&line.jammed, true)] {
            if let Some(points) = branch_points(branch, "", place, line.strain_rate) {
                all = all.with(if is_open { points.open() } else { points });
            }
        }
    }
    let mut panels = vec![all.title("frictionless; filled: from rest, open: from jammed")];
    // At one strain rate that both have, the source's if possible.
    let both: Vec<(&ForceLine, &ForceLine)> = tight
        .iter()
        .filter_map(|line| {
            let with = frictional
                .iter()
                .find(|other| other.strain_rate == line.strain_rate)?;
            Some((*line, with))
        })
        .collect();
    let pair = both
        .iter()
        .find(|pair| pair.0.strain_rate == SOURCE_RATE)
        .or(both.first());
    if let Some((without, with)) = pair {
        let mut panel = ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio))
            .with(Reference::horizontal(0.0));
        for (series, name, line, tint) in [
            (0, "frictionless", without, Tint::Blue),
            (1, "frictional", with, Tint::Vermillion),
        ] {
            let [force, mean, error] = line.rest.columns();
            if !force.is_empty() {
                panel = panel.with(
                    Points::new(name, &force, &mean)
                        .y_errors(&error)
                        .series(series)
                        .tint(tint)
                        .joined(),
                );
            }
        }
        panels.push(panel.title(&format!(
            "from rest, *ε̇* = {}",
            rate_text(without.strain_rate)
        )));
    }
    Ok(ReportFigure {
        name: "frictionless".to_owned(),
        caption: "Stationary *J*/*J*_{max} of frictionless grains in the elastic tube against the force, and beside that of frictional \
                  ones."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .share_y()
            .legend(LegendPlace::Inside)
            .colour_scale(rate_colours(lines))
            .width(Width::DoubleColumn)
            .description("Stationary flow rate of frictionless grains against the force, and that of frictional ones.")
            .draw()?,
    })
}
