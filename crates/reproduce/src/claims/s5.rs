//! S5: no back flow without friction?

use peristalsis_analysis::Uncertain;
use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, LegendPlace, Reference, Tint};

use super::elastic::{
    SOURCE_RATE, branch_rows, finding, flow_against_force, judged, nothing, rate_colours,
    with_branches,
};
use super::s4::negative;
use crate::branch::Point;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{branch_points, cell};
use crate::finding::{Finding, ReportFigure, Verdict};
use crate::forces::{ForceLine, lowest, together};
use crate::prose::Prose;
use crate::text::number;
use crate::thresholds::{LEAST_BACK_FLOW, NO_BACK_FLOW_BY};

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

/// A line of frictionless grains with that of frictional ones at the same strain rate, where there is one.
type Pair<'b, 'a> = (&'b ForceLine<'a>, Option<&'b ForceLine<'a>>);

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let rows = evidence.study("elastic-frictionless")?.rows();
    let lines = ForceLine::all_of(&rows);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(nothing("No runs of frictionless grains yet."));
    }
    let frictional = ForceLine::all_of(&branch_rows(evidence)?);
    let pairs: Vec<Pair<'_, '_>> = tight
        .iter()
        .map(|line| {
            let mut others = frictional.iter();
            (
                *line,
                others.find(|other| other.strain_rate == line.strain_rate),
            )
        })
        .collect();
    let flows_back = tight.iter().any(|line| !negative(line).is_empty());
    let points = || tight.iter().flat_map(|line| line.points());
    let never = points()
        .all(|point| point.flow.value + LEAST_BACK_FLOW > NO_BACK_FLOW_BY * point.flow.error);
    let verdict = match (flows_back, never) {
        (true, _) => Verdict::Differs,
        (false, true) => Verdict::Reproduced,
        (false, false) => Verdict::Open,
    };
    let mut found = finding(
        verdict,
        summary(&tight, flows_back),
        together(tight.iter().copied()),
    );
    let compared = pairs.iter().flat_map(compared);
    for (rate, without, with) in compared.filter(|(.., with)| with.flow.value < 0.0) {
        let error = without.flow.error.hypot(with.flow.error);
        found.quantities.push(PROSE.quantity(
            "difference",
            &[("rate", &rate), ("force", &without.control)],
            Uncertain::normal(without.flow.value - with.flow.value, error),
        ));
    }
    let cells = pairs.iter().flat_map(cells).collect();
    found.tables.push(PROSE.table("flows", &[], cells));
    let method = PROSE.text("method", &[("least", &LEAST_BACK_FLOW)]);
    found.paragraphs.push(method);
    found.figures.push(figure(&lines, &pairs)?);
    Ok(found)
}

/// Whether any flow is negative, and the smallest of them.
fn summary(tight: &[&ForceLine<'_>], flows_back: bool) -> String {
    let points = || tight.iter().flat_map(|line| line.points());
    let smallest = tight
        .iter()
        .filter_map(|line| Some((line.strain_rate, lowest(line.points())?)))
        .min_by(|one, other| one.1.flow.value.total_cmp(&other.1.flow.value));
    smallest.map_or_else(
        || "No stationary runs yet.".to_owned(),
        |(rate, point)| {
            PROSE.text(
                "summary",
                &[
                    ("place", &if flows_back { "somewhere" } else { "nowhere" }),
                    ("means", &points().count()),
                    ("smallest", &point.flow),
                    ("force", &point.control),
                    ("rate", &rate),
                ],
            )
        },
    )
}

/// The flows from rest without and with friction at each force that has both, and the strain rate.
fn compared<'b, 'a>(
    (line, other): &Pair<'b, 'a>,
) -> impl Iterator<Item = (f64, &'b Point<'a>, &'b Point<'a>)> {
    let (line, other) = (*line, *other);
    line.rest
        .points
        .iter()
        .filter_map(move |point| Some((line.strain_rate, point, other?.rest.at(point.control)?)))
}

/// The rows of the table for one strain rate.
fn cells((line, other): &Pair<'_, '_>) -> Vec<Vec<String>> {
    let flow = |point: Option<&Point<'_>>| cell(point.map(|point| point.flow));
    let row = |point: &Point<'_>| {
        vec![
            line.strain_rate.to_string(),
            point.control.to_string(),
            flow(Some(point)),
            flow(line.jammed.at(point.control)),
            flow(other.and_then(|other| other.rest.at(point.control))),
            number(point.escaped(), 3),
        ]
    };
    line.rest.points.iter().map(row).collect()
}

/// All flows without friction, and beside them those with friction at one strain rate that both have, the source's if
/// possible.
fn figure(lines: &[ForceLine<'_>], pairs: &[Pair<'_, '_>]) -> Result<ReportFigure, ClaimError> {
    let empty = || flow_against_force().with(Reference::horizontal(0.0));
    let tight: Vec<&ForceLine<'_>> = pairs.iter().map(|(line, _)| *line).collect();
    let all =
        with_branches(empty(), &tight).title("frictionless; filled: from rest, open: from jammed");
    let both = || {
        pairs
            .iter()
            .filter_map(|(line, other)| Some((line, (*other)?)))
    };
    let beside = both()
        .find(|(line, _)| line.strain_rate == SOURCE_RATE)
        .or(both().next())
        .map(|(without, with)| {
            let kinds = [
                ("frictionless", &without.rest, Tint::Blue),
                ("frictional", &with.rest, Tint::Vermillion),
            ];
            let points =
                kinds
                    .into_iter()
                    .enumerate()
                    .filter_map(|(series, (name, branch, tint))| {
                        Some(branch_points(name, branch)?.series(series).tint(tint))
                    });
            let title = format!("from rest, *ε̇* = {}", without.strain_rate);
            empty().with_all(points).title(&title)
        });
    let figure = ChartFigure::grid(2, [all].into_iter().chain(beside))
        .share_y()
        .legend(LegendPlace::Inside)
        .colour_scale(rate_colours(lines))
        .width(Width::DoubleColumn)
        .description("Stationary flow rate of frictionless grains against the force, and that of frictional ones.");
    Ok(PROSE.figure("frictionless", &[], figure.draw()?))
}
