//! Q13: the flow against the occlusion of the throat, and against a head.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q13.md"));

pub(super) const CLAIM: Claim = Claim::new("Q13", PROSE, &["closure"], examine);

/// Part of the flow at complete closure from which on the tube counts as a positive displacement pump.
const NEARLY: f64 = 0.9;
/// Points that a curve against the head has at least.
const LEAST_HEADS: usize = 3;

/// One occlusion under one body force.
struct Place {
    occlusion: f64,
    width: f64,
    /// Body force along the wave, negative against it \[d/t^2\].
    body_force: f64,
    flow: Uncertain,
    /// Solid volume that a stroke moves over the volume that closed throats enclose.
    moved: Uncertain,
    overlap: f64,
}

impl Place {
    fn of(body_force: f64, rows: &[Row<'_>]) -> Option<Self> {
        let first = rows.first()?;
        let (radius, width) = (first.radius(), first.width());
        let flow = mean(rows, "flow_rate_ratio")?;
        let amplitude = radius - 0.5 * width;
        // Both over pi lambda.
        let held = first.volume_fraction() * radius * radius;
        let geometric = radius * radius + 0.5 * amplitude * amplitude;
        let part = held / geometric;
        let overlaps = rows.iter().map(|row| row.number("largest_overlap"));
        Some(Self {
            occlusion: 1.0 - width / (2.0 * radius),
            width,
            body_force,
            flow,
            moved: Uncertain::normal(part * flow.value, part * flow.error),
            overlap: overlaps.fold(0.0, f64::max),
        })
    }

    fn cells(&self) -> Vec<String> {
        vec![
            number(self.body_force, 4),
            number(self.occlusion, 2),
            number(self.width, 2),
            self.flow.to_string(),
            self.moved.to_string(),
            number(self.overlap, 2),
        ]
    }
}

/// The places of one body force, by ascending occlusion.
fn places(body_force: f64, rows: Vec<Row<'_>>) -> Vec<Place> {
    let by_width = grouped(rows, Row::width).into_iter().rev();
    by_width
        .filter_map(|(_, rows)| Place::of(body_force, &rows))
        .collect()
}

/// The flow at complete closure, and the least occlusion from which on the flow is nearly as large; `None` where it is so
/// at the largest one alone.
fn onset(places: &[Place]) -> Option<(Uncertain, Option<f64>)> {
    let closed = places.last()?.flow;
    let enough = NEARLY * closed.value;
    let short = places.iter().rposition(|place| place.flow.value < enough)?;
    let (below, above) = (&places[short], places.get(short + 1)?);
    let part = (enough - below.flow.value) / (above.flow.value - below.flow.value);
    let occlusion = below.occlusion + part * (above.occlusion - below.occlusion);
    let is_tried = short + 2 < places.len();
    Some((closed, is_tried.then_some(occlusion)))
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = evidence.study("closure")?.rows();
    let force = |row: &Row<'_>| row.number_or("body_force", 0.0);
    let of_forces = grouped(rows.iter().copied(), force);
    // Heads are tried at some of the occlusions alone.
    let of_most = of_forces.iter().map(|(_, rows)| behind(rows, Row::width));
    let most = of_most.clone().map(|it| it.widths).max();
    let statistics = Statistics::weakest_at_one_rate(of_most.filter(|it| Some(it.widths) == most));
    let curves: Vec<(f64, Vec<Place>)> = grouped(rows, force)
        .into_iter()
        .map(|(force, rows)| (force, places(force, rows)))
        .collect();
    let lying = curves.iter().find(|(force, _)| *force == 0.0);
    let loaded = curves.iter().filter(|(force, _)| *force < 0.0);
    let lifting = loaded.max_by_key(|(_, places)| places.len());
    let (Some((_, lying)), Some((_, lifting))) = (lying, lifting) else {
        return Ok(PROSE.nothing(statistics, &Q13_NEEDED));
    };
    let mut draft = Draft::of(PROSE);
    let mut ends = Vec::new();
    for (how, places) in [("lying", lying), ("lifting", lifting)] {
        let Some((closed, from)) = onset(places) else {
            return Ok(PROSE.nothing(statistics, &Q13_NEEDED));
        };
        draft.quantity("flow", values!(how), closed);
        let occlusion = from.map(|from| Uncertain::normal(from, f64::NAN));
        draft.quantity("onset", values!(how), occlusion);
        let words = match from {
            Some(from) => PROSE.text("from", values!(occlusion = number(from, 2))),
            None => PROSE.text("never", &[]),
        };
        ends.push((closed.to_string(), words));
    }
    let everywhere = || curves.iter().flat_map(|(_, places)| places);
    let against = grouped(everywhere(), |place| place.occlusion);
    let against: Vec<_> = against
        .into_iter()
        .filter(|(_, places)| places.iter().filter(|it| it.body_force < 0.0).count() >= LEAST_HEADS)
        .collect();
    let heads: Vec<String> = against
        .iter()
        .filter_map(|(o, places)| loss(*o, places))
        .collect();
    let [(lying_flow, from_lying), (lifting_flow, from_lifting)] = &ends[..] else {
        return Ok(PROSE.nothing(statistics, &Q13_NEEDED));
    };
    let summary = PROSE.text(
        "summary",
        values!(
            lying = lying_flow,
            from_lying,
            lifting = lifting_flow,
            from_lifting,
            heads = heads.join(" ")
        ),
    );
    draft.table("closure", &[], everywhere().map(Place::cells));
    let series = [("lying", lying), ("lifting", lifting)].map(|(name, places)| {
        joined(
            name,
            places.iter().map(|place| (place.occlusion, place.flow)),
        )
    });
    let flow = label(Axis::FlowRateRatio);
    let against_occlusion =
        ChartPanel::new("occlusion 1 − *w*/(2*a*)", &flow).with_all(numbered(series));
    let series = against.iter().map(|(occlusion, places)| {
        let loaded = places.iter().rev().filter(|place| place.body_force < 0.0);
        let points = loaded.map(|place| (-1e3 * place.body_force, place.flow));
        joined(&format!("occlusion {}", number(*occlusion, 2)), points)
    });
    let against_head =
        ChartPanel::new("head −*g*, 10^{−3} *d* *t*^{−2}", &flow).with_all(numbered(series));
    draft.chart("closure", &[], grid(2, [against_occlusion, against_head]))?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics, &Q13_NEEDED))
}

/// What the largest head takes from the flow against the smallest one.
fn loss(occlusion: f64, places: &[&Place]) -> Option<String> {
    let loaded = || places.iter().filter(|place| place.body_force < 0.0);
    let (largest, smallest) = (loaded().next()?, loaded().next_back()?);
    Some(PROSE.text(
        "head",
        values!(
            occlusion = number(occlusion, 2),
            head = number(-largest.body_force, 4),
            loss = difference(&smallest.flow, &largest.flow)
        ),
    ))
}
