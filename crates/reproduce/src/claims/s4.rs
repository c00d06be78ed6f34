//! S4: back flow at small forces.

use peristalsis_analysis::number::counted;

use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s4.md"));

pub(super) const CLAIM: Claim = claim("S4", PROSE, BRANCHES, examine);

/// The forces at which the flow of a line is negative from rest and, where that start was run too, from jammed, unless the
/// jam lasts there.
pub(super) fn negative(line: &ForceLine<'_>) -> Vec<f64> {
    let flows_back = |point: &Point<'_>| is_clearly_below(point, -LEAST_BACK_FLOW);
    let lasts = |rest: &Point<'_>, jammed: &Point<'_>| {
        jammed.flow.value > rest.flow.value + LEAST_JUMP_AGAINST_FORCE
    };
    let from_rest = line.flow.rest.points.iter();
    from_rest
        .filter(|rest| flows_back(rest))
        .filter(|rest| {
            let jammed = line.flow.jammed.at(rest.control);
            jammed.is_none_or(|jammed| flows_back(jammed) || lasts(rest, jammed))
        })
        .map(|rest| rest.control)
        .collect()
}

/// All forces of a line, ascending.
fn forces(line: &ForceLine<'_>) -> Vec<f64> {
    ascending(line.flow.points().map(|point| point.control))
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = evidence.rows(BRANCHES)?;
    let lines = ForceLine::all_of(&rows);
    let drawn = judged(&lines);
    if drawn.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let counting = ForceLine::all_of(&counting(&rows));
    let tight = judged(&counting);
    let (forward, backward): (Vec<&ForceLine<'_>>, _) =
        tight.iter().partition(|line| negative(line).is_empty());
    let verdict = if tight.is_empty() {
        Verdict::Open
    } else if backward.is_empty() {
        Verdict::Differs
    } else {
        Verdict::Reproduced
    };
    let statistics = together(drawn.iter().copied());
    let mut draft = Draft::of(PROSE);
    let lowest = |line: &&ForceLine<'_>| {
        let point = line.flow.lowest()?;
        Some((line.strain_rate, point.control, point.flow))
    };
    let mut lowest: Vec<_> = tight.iter().filter_map(lowest).collect();
    lowest.sort_by(|one, other| one.2.value.total_cmp(&other.2.value));
    for (rate, force, flow) in lowest {
        draft.quantity("lowest", values!(rate, force), flow);
    }
    draft.table("flows", &[], drawn.iter().flat_map(|line| cells(line)));
    draft.paragraph("method", values!(least = LEAST_BACK_FLOW, clear = CLEAR));
    // Those whose flow is negative at larger forces only, and not at the smallest.
    let only_beyond = |line: &&ForceLine<'_>| {
        negative(line)
            .first()
            .is_some_and(|first| *first > forces(line)[0])
    };
    let beyond: Vec<&ForceLine<'_>> = tight.iter().copied().filter(only_beyond).collect();
    if !beyond.is_empty() {
        draft.weakness("only beyond", values!(rates = rates(&beyond)));
    }
    let zero = Reference::horizontal(0.0);
    let panel = flow_against_force()
        .y_range(-0.12..=0.12)
        .with(zero.tint(Tint::Grey).pattern(Pattern::Solid))
        .with(Reference::horizontal(-LEAST_BACK_FLOW));
    let chart = ChartFigure::new(with_branches(panel, &drawn))
        .legend(LegendPlace::Below)
        .colour_scale(colours_of_rates(&lines));
    let (least, clear) = (LEAST_BACK_FLOW, CLEAR);
    draft.chart("back-flow", values!(least, clear), chart)?;
    let summary = summary(&backward, &forward);
    Ok(draft.concluded(verdict, summary, statistics))
}

/// The strain rates of some lines in words.
fn rates(lines: &[&ForceLine<'_>]) -> String {
    listed(lines.iter().map(|line| line.strain_rate))
}

/// Where the flow is negative.
fn summary(backward: &[&ForceLine<'_>], forward: &[&ForceLine<'_>]) -> String {
    let at_rate = |line: &&ForceLine<'_>| {
        let point = line.flow.lowest()?;
        let (rate, forces) = (line.strain_rate, range(&negative(line)));
        let (lowest, force) = (&point.flow, point.control);
        Some(PROSE.text("at a strain rate", values!(rate, forces, lowest, force)))
    };
    let words: Vec<String> = backward.iter().filter_map(at_rate).collect();
    if words.is_empty() {
        return PROSE.text("nowhere", &[]);
    }
    let elsewhere = if forward.is_empty() {
        String::new()
    } else {
        let asked = |line: &&ForceLine<'_>| {
            let (rate, forces) = (line.strain_rate, counted(forces(line).len(), "force"));
            PROSE.text("asked", values!(rate, forces))
        };
        let rates: Vec<String> = forward.iter().map(asked).collect();
        PROSE.text("elsewhere", values!(rates = rates.join(", ")))
    };
    PROSE.text("summary", values!(rates = words.join(", "), elsewhere))
}

/// Forces in words.
pub(super) fn range(forces: &[f64]) -> String {
    match forces {
        [] => "nowhere".to_owned(),
        [one] => format!("= {one}"),
        [first, .., last] => format!("from {first} to {last}"),
    }
}

/// The rows of the table for one strain rate.
fn cells(line: &ForceLine<'_>) -> Vec<Vec<String>> {
    let row = |force: f64| {
        let starts = line.flow.each().map(|branch| branch.at(force));
        let flows = starts.map(|point| cell(point.map(|point| point.flow)));
        let runs = starts.map(|point| point.map_or(0, |point| counting(&point.rows).len()));
        let escaped = starts.into_iter().flatten().map(Point::escaped);
        let [from_rest, from_jammed] = flows;
        vec![
            line.strain_rate.to_string(),
            force.to_string(),
            from_rest,
            from_jammed,
            format!("{} + {}", runs[0], runs[1]),
            number(escaped.fold(0.0, f64::max), 3),
        ]
    };
    forces(line).into_iter().map(row).collect()
}
