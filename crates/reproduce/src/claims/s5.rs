//! S5: no back flow without friction?

use super::elastic::*;
use super::prelude::*;
use super::s4::{negative, range};

const PROSE: Prose = Prose::new(include_str!("s5.md"));
const STUDIES: &[&str] = &[
    "elastic-frictionless",
    "elastic-branches",
    "elastic-extremes",
    "two-by-two-strain",
    "branches-*",
];

pub(super) const CLAIM: Claim = claim("S5", PROSE, STUDIES, examine);

/// A line of frictionless grains with that of frictional ones at the same strain rate, where there is one.
type Pair<'b, 'a> = (&'b ForceLine<'a>, Option<&'b ForceLine<'a>>);

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = evidence.study("elastic-frictionless")?.rows();
    let lines = ForceLine::all_of(&rows);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let frictional = ForceLine::all_of(&evidence.rows(BRANCHES)?);
    let beside = |line: &ForceLine<'_>| {
        let mut others = frictional.iter();
        others.find(|other| other.strain_rate == line.strain_rate)
    };
    let pairs: Vec<Pair<'_, '_>> = tight.iter().map(|line| (*line, beside(line))).collect();
    let counting = ForceLine::all_of(&counting(&rows));
    let counting = judged(&counting);
    let flows_back = counting.iter().any(|line| !negative(line).is_empty());
    let mut points = counting.iter().flat_map(|line| line.flow.points());
    let never = points.all(|point| point.flow.is_above(-LEAST_BACK_FLOW));
    let verdict = match (flows_back, never) {
        (true, _) => Verdict::Differs,
        (false, true) if !counting.is_empty() => Verdict::Reproduced,
        (false, _) => Verdict::Open,
    };
    let statistics = together(tight.iter().copied());
    let summary = summary(&counting);
    let mut draft = Draft::of(PROSE);
    if let Some((rate, point)) = smallest(&counting) {
        let force = point.control;
        draft.quantity("smallest", values!(rate, force), point.flow);
    }
    let compared = pairs.iter().flat_map(compared);
    for (rate, without, with) in compared.filter(|(.., with)| with.flow.value < 0.0) {
        let (force, more) = (without.control, without.flow - with.flow);
        draft.quantity("difference", values!(rate, force), more);
    }
    draft.table("flows", &[], pairs.iter().flat_map(cells));
    draft.paragraph("method", values!(least = LEAST_BACK_FLOW));
    if let Some((line, gap)) = both_flows(&counting) {
        let (rate, force) = (line.strain_rate, gap.controls[0]);
        let [rest, jammed] = line
            .flow
            .each()
            .map(|branch| cell(branch.at(force).map(|it| it.flow)));
        draft.paragraph("both", values!(force, rate, rest, jammed));
    }
    if let Some(flows) = between_prescribed_walls(evidence)? {
        draft.weakness("prescribed", values!(flows));
    }
    draft.chart("frictionless", &[], figure(&lines, &pairs))?;
    Ok(draft.concluded(verdict, summary, statistics))
}

/// The smallest flow, and its strain rate.
fn smallest<'b, 'a>(tight: &[&'b ForceLine<'a>]) -> Option<(f64, &'b Point<'a>)> {
    let lowest = tight
        .iter()
        .filter_map(|line| Some((line.strain_rate, line.flow.lowest()?)));
    lowest.min_by(|one, other| one.1.flow.value.total_cmp(&other.1.flow.value))
}

/// The force at which both flows lie farthest apart, at the source's strain rate if they do there.
fn both_flows<'b, 'a>(tight: &[&'b ForceLine<'a>]) -> Option<(&'b ForceLine<'a>, Step)> {
    let apart = |line: &&'b ForceLine<'a>| {
        let gap = line.flow.gap()?;
        gap.rises_by(LEAST_JUMP).then_some((*line, gap))
    };
    let mut all: Vec<_> = tight.iter().filter_map(apart).collect();
    all.sort_by(|one, other| other.1.height.value.total_cmp(&one.1.height.value));
    let of_source = all
        .iter()
        .position(|(line, _)| line.strain_rate == SOURCE_RATE);
    (!all.is_empty()).then(|| all.swap_remove(of_source.unwrap_or(0)))
}

/// Where the flow is negative, and the smallest.
fn summary(tight: &[&ForceLine<'_>]) -> String {
    let Some((rate, point)) = smallest(tight) else {
        return "No stationary runs yet.".to_owned();
    };
    let place = |line: &&ForceLine<'_>| {
        let forces = negative(line);
        let rate = line.strain_rate;
        (!forces.is_empty()).then(|| PROSE.text("negative", values!(forces = range(&forces), rate)))
    };
    let places: Vec<String> = tight.iter().filter_map(place).collect();
    let place = match places.is_empty() {
        true => "nowhere".to_owned(),
        false => PROSE.text("places", values!(places = places.join("; "))),
    };
    let means = tight.iter().flat_map(|line| line.flow.points()).count();
    let (smallest, force) = (point.flow, point.control);
    PROSE.text("summary", values!(place, means, smallest, force, rate))
}

/// The smallest flow of frictionless grains in each tube of a prescribed wall in which one is negative, in words.
fn between_prescribed_walls(evidence: &Evidence) -> Result<Option<String>> {
    let mut tubes = vec![("Q7".to_owned(), evidence.study("two-by-two-strain")?.rows())];
    tubes[0].1.retain(is_frictionless);
    let walls = WALLS.iter();
    tubes.extend(walls.map(|wall| (wall.name(), wall.rows("branches", evidence))));
    let smallest = |(tube, rows): (String, Vec<Row<'_>>)| {
        let flows = by_strain_rate(rows).into_iter().filter_map(|(rate, rows)| {
            let branches = Branches::of(&rows, Control::Width);
            Some((rate, branches.lowest()?.clone()))
        });
        let (rate, point) =
            flows.min_by(|one, other| one.1.flow.value.total_cmp(&other.1.flow.value))?;
        let is_negative = is_clearly_below(&point, 0.0);
        let (flow, width) = (point.flow, point.control);
        is_negative.then(|| PROSE.text("smallest", values!(flow, width, rate, tube)))
    };
    let found: Vec<String> = tubes.into_iter().filter_map(smallest).collect();
    Ok((!found.is_empty()).then(|| found.join("; ")))
}

/// The flows from rest without and with friction at each force that has both, and the strain rate.
fn compared<'b, 'a>(
    (line, other): &Pair<'b, 'a>,
) -> impl Iterator<Item = (f64, &'b Point<'a>, &'b Point<'a>)> {
    let (line, other) = (*line, *other);
    let other = move |point: &Point<'_>| other?.flow.rest.at(point.control);
    let points = line.flow.rest.points.iter();
    points.filter_map(move |point| Some((line.strain_rate, point, other(point)?)))
}

/// The rows of the table for one strain rate.
fn cells((line, other): &Pair<'_, '_>) -> Vec<Vec<String>> {
    let flow = |point: Option<&Point<'_>>| cell(point.map(|point| point.flow));
    let row = |point: &Point<'_>| {
        vec![
            line.strain_rate.to_string(),
            point.control.to_string(),
            flow(Some(point)),
            flow(line.flow.jammed.at(point.control)),
            flow(other.and_then(|other| other.flow.rest.at(point.control))),
            number(point.escaped(), 3),
        ]
    };
    line.flow.rest.points.iter().map(row).collect()
}

/// All flows without friction, and beside them those with friction at one strain rate that both have, the source's if
/// possible.
fn figure(lines: &[ForceLine<'_>], pairs: &[Pair<'_, '_>]) -> ChartFigure {
    let empty = || flow_against_force().with(Reference::horizontal(0.0));
    let tight: Vec<&ForceLine<'_>> = pairs.iter().map(|(line, _)| *line).collect();
    let all = with_branches(empty(), &tight).title("frictionless");
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
                ("frictionless", &without.flow.rest, Tint::Blue),
                ("frictional", &with.flow.rest, Tint::Vermillion),
            ];
            let points = kinds.map(|(name, branch, tint)| {
                branch_points(name, branch).map(|points| points.tint(tint))
            });
            let title = format!("from rest, *ε̇* = {}", without.strain_rate);
            empty().with_all(numbered(points)).title(&title)
        });
    let near_zero = with_branches(empty(), &tight)
        .x_range(4e-4..=1.1e-3)
        .y_range(-0.05..=0.05)
        .title("frictionless, near *J* = 0");
    grid(3, [all, near_zero].into_iter().chain(beside))
        .legend(LegendPlace::Inside)
        .colour_scale(colours_of_rates(lines))
}
