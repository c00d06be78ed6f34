//! S4: back flow at small forces.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::Quantity as Axis;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Reference};

use super::elastic::{
    branch_points, branch_runs, finding, judged, label, nothing, rate_colours, rate_text,
};
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Verdict};
use crate::forces::{ForceLine, ForcePoint, LEAST_JUMP, together};
use crate::prose::Prose;
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("s4.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S4",
    prose: PROSE,
    studies: &["elastic-branches", "elastic-extremes"],
    examine,
};

/// Part of *J*max from which on a flow against the wave is more than none.
const LEAST_FLOW: f64 = 0.01;

/// The forces at which the flow of a line is negative from rest and, where that start was run too, from jammed, unless the
/// jam lasts there.
pub(super) fn negative(line: &ForceLine) -> Vec<f64> {
    line.rest
        .points
        .iter()
        .filter(|rest| rest.is_below(-LEAST_FLOW))
        .filter(|rest| {
            line.jammed.at(rest.force).is_none_or(|jammed| {
                jammed.is_below(-LEAST_FLOW) || jammed.mean > rest.mean + LEAST_JUMP
            })
        })
        .map(|rest| rest.force)
        .collect()
}

/// Whether the flow of a line is negative at larger forces only, and not at its smallest.
fn only_beyond(line: &ForceLine) -> bool {
    let smallest = line.points().map(|point| point.force).reduce(f64::min);
    negative(line)
        .first()
        .is_some_and(|first| Some(*first) > smallest)
}

/// The point of the strongest flow against the wave, of both starts.
pub(super) fn lowest(line: &ForceLine) -> Option<ForcePoint> {
    line.points()
        .copied()
        .min_by(|one, other| one.mean.total_cmp(&other.mean))
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let lines = ForceLine::all_of(&branch_runs(evidence)?);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(nothing("No runs yet."));
    }
    let backward: Vec<(&ForceLine, Vec<f64>)> = tight
        .iter()
        .map(|line| (*line, negative(line)))
        .filter(|(_, forces)| !forces.is_empty())
        .collect();
    let verdict = if backward.is_empty() {
        Verdict::Differs
    } else {
        Verdict::Reproduced
    };
    let words: Vec<String> = backward
        .iter()
        .filter_map(|(line, forces)| {
            let lowest = lowest(line)?;
            Some(format!(
                "at *ε̇* = {} for *f*^{{P}} {} (down to {} at {})",
                rate_text(line.strain_rate),
                range(forces),
                with_error(lowest.mean, lowest.error),
                lowest.force
            ))
        })
        .collect();
    let without: Vec<String> = tight
        .iter()
        .filter(|line| negative(line).is_empty())
        .map(|line| rate_text(line.strain_rate))
        .collect();
    let mut found = finding(
        verdict,
        format!(
            "*J* is negative {}{}.",
            if words.is_empty() {
                "nowhere".to_owned()
            } else {
                words.join(", ")
            },
            if without.is_empty() || words.is_empty() {
                String::new()
            } else {
                format!(", and nowhere at *ε̇* = {}", without.join(", "))
            }
        ),
        together(tight.iter().copied()),
    );
    for line in &tight {
        if let Some(lowest) = lowest(line) {
            found.quantities.push(Quantity {
                name: format!(
                    "smallest flow rate, strain rate {}, at *f*^{{P}} = {}",
                    line.strain_rate, lowest.force
                ),
                symbol: "*J*/*J*_{max}".to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(Uncertain::normal(lowest.mean, lowest.error)),
                method: "mean over replicates of stationary runs; the smallest of several, and so a little too small".to_owned(),
            });
        }
    }
    found.tables.push(table(&tight));
    found.paragraphs.push(format!(
        "A flow counts as negative where its mean is below −{LEAST_FLOW} by four of its errors from rest, and from jammed as well unless \
         the jam lasts there. Errors are those of \
         the scatter over replicates, of the blocks of one run where there is but one."
    ));
    let beyond: Vec<String> = tight
        .iter()
        .filter(|line| only_beyond(line))
        .map(|line| rate_text(line.strain_rate))
        .collect();
    if !beyond.is_empty() {
        found.weaknesses.push(format!(
            "The claim says small forces: at *ε̇* = {} the smallest that were tried carry the grains along, and only larger ones turn \
             the flow round.",
            beyond.join(", ")
        ));
    }
    found.figures.push(ReportFigure {
        name: "back-flow".to_owned(),
        caption: "Stationary *J*/*J*_{max} below the transition, from rest (filled) and from jammed (open): below the dotted line grains \
                  flow against the wave."
            .to_owned(),
        drawing: below_transition(&lines, &tight)?,
    });
    Ok(found)
}

/// Forces in words.
fn range(forces: &[f64]) -> String {
    match forces {
        [] => "nowhere".to_owned(),
        [one] => format!("= {one}"),
        [first, .., last] => format!("from {first} to {last}"),
    }
}

/// Both branches of each line about J = 0.
fn below_transition(
    lines: &[ForceLine],
    tight: &[&ForceLine],
) -> Result<peristalsis_figures::Drawing, ClaimError> {
    let mut panel = ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio))
        .y_range(-0.12..=0.12)
        .with(Reference::horizontal(0.0));
    for (place, line) in tight.iter().enumerate() {
        for (branch, is_open) in [(&line.rest, false), (&line.jammed, true)] {
            if let Some(points) = branch_points(branch, "", place, line.strain_rate) {
                panel = panel.with(if is_open { points.open() } else { points });
            }
        }
    }
    Ok(ChartFigure::new(panel)
        .legend(LegendPlace::Hidden)
        .colour_scale(rate_colours(lines))
        .description("Stationary flow rate against the force about zero, from both starts.")
        .draw()?)
}

fn table(tight: &[&ForceLine]) -> ReportTable {
    let mut rows = Vec::new();
    for line in tight {
        let mut forces: Vec<f64> = line.points().map(|point| point.force).collect();
        forces.sort_by(f64::total_cmp);
        forces.dedup();
        for force in forces {
            let cell = |point: Option<&ForcePoint>| {
                point.map_or("–".to_owned(), |point| {
                    with_error(point.mean, point.error)
                })
            };
            let counted = |point: Option<&ForcePoint>| point.map_or(0, |point| point.counted);
            let (rest, jammed) = (line.rest.at(force), line.jammed.at(force));
            rows.push(vec![
                rate_text(line.strain_rate),
                format!("{force}"),
                cell(rest),
                cell(jammed),
                format!("{} + {}", counted(rest), counted(jammed)),
                number(
                    rest.into_iter()
                        .chain(jammed)
                        .map(|point| point.escaped)
                        .fold(0.0, f64::max),
                    3,
                ),
            ]);
        }
    }
    ReportTable {
        caption: "Stationary *J*/*J*_{max} from rest and from jammed, runs from either start that average over 50 stationary periods, and \
                  part of the grains outside; “–”: most runs still drift."
            .to_owned(),
        head: ["*ε̇*", "*f*^{P}", "from rest", "from jammed", "runs that count", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }
}
