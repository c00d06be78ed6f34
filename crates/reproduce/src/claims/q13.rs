//! Q13: the flow against the occlusion of the throat, against a head, and with what else may matter.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q13.md"));

pub(super) const CLAIM: Claim =
    Claim::new("Q13", PROSE, &["closure"], examine).varying("width", Q13_NEEDED);

/// Part of the flow at complete closure from which on the tube counts as a positive displacement pump.
const NEARLY: f64 = 0.9;
/// Points that a curve against the head has at least.
const LEAST_HEADS: usize = 3;

/// Throats from this width on let the largest grain through \[d\].
const PASSES: f64 = 1.1;

/// One occlusion under one body force.
struct Place {
    occlusion: f64,
    width: f64,
    /// Body force along the wave, negative against it \[d/t^2\].
    body_force: f64,
    flow: Uncertain,
    /// Solid volume that a stroke moves over the volume that closed throats enclose.
    moved: Uncertain,
    /// Largest overlap at any time \[d\], and the part of the late time in which one exceeds 0.1 d.
    overlap: f64,
    pressed: f64,
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
        let most = |column| largest(rows, |row| row.number(column));
        Some(Self {
            occlusion: 1.0 - width / (2.0 * radius),
            width,
            body_force,
            flow,
            moved: Uncertain::normal(part * flow.value, part * flow.error),
            overlap: most("largest_overlap"),
            pressed: most("pressed"),
        })
    }

    fn cells(&self, case: &Case) -> Vec<String> {
        vec![
            number(case.filling, 1),
            number(case.rate, 4),
            number(case.cohesion, 3),
            number(self.body_force, 4),
            number(self.occlusion, 2),
            self.flow.to_string(),
            self.moved.to_string(),
            number(self.overlap, 2),
            number(self.pressed, 2),
        ]
    }
}

/// All runs of one filling, strain rate and cohesion.
struct Case {
    filling: f64,
    rate: f64,
    /// Pull-off force of two grains of diameter 1 \[m d/t^2\].
    cohesion: f64,
    /// By ascending body force, and occlusion.
    curves: Vec<(f64, Vec<Place>)>,
}

impl Case {
    /// All cases, that with most runs first.
    fn all_of<'a>(rows: &[Row<'a>]) -> Vec<(Self, Vec<Row<'a>>)> {
        let key = |row: &Row<'_>| {
            let cohesion = row.number_or("contact.cohesion_force", 0.0);
            [row.volume_fraction(), row.strain_rate(), cohesion]
        };
        let of = |([filling, rate, cohesion], rows): ([f64; 3], Vec<Row<'a>>)| {
            let by_force = grouped(rows.iter().copied(), body_force).into_iter();
            let curves = by_force.map(|(force, rows)| (force, places(force, rows)));
            let case = Self {
                filling,
                rate,
                cohesion,
                curves: curves.collect(),
            };
            (case, rows)
        };
        let mut cases: Vec<_> = grouped(rows.iter().copied(), key)
            .into_iter()
            .map(of)
            .collect();
        cases.sort_by_key(|(_, rows)| std::cmp::Reverse(rows.len()));
        cases
    }

    fn places(&self) -> impl Iterator<Item = &Place> {
        self.curves.iter().flat_map(|(_, places)| places)
    }

    /// The curve without body force.
    fn lying(&self) -> Option<&[Place]> {
        let curve = self.curves.iter().find(|(force, _)| *force == 0.0);
        curve.map(|(_, places)| &places[..])
    }

    /// The curve against the head that was tried at most occlusions.
    fn lifting(&self) -> Option<&[Place]> {
        let loaded = self.curves.iter().filter(|(force, _)| *force < 0.0);
        let most = loaded.max_by_key(|(_, places)| places.len());
        most.map(|(_, places)| &places[..])
    }

    /// What another case changes of this one: at how many places it does so clearly, of how many, and where most.
    fn against(&self, other: &Self) -> Option<String> {
        let same = |one: &Place, place: &Place| {
            one.width == place.width && one.body_force == place.body_force
        };
        let beside = |place| {
            let own = self.places().find(|one| same(one, place))?;
            Some((place, place.flow - own.flow))
        };
        let pairs: Vec<(&Place, Uncertain)> = other.places().filter_map(beside).collect();
        let clear = |change: &Uncertain| !change.interval_95.contains(0.0);
        let by_size = |one: &&(&Place, Uncertain), other: &&(&Place, Uncertain)| {
            one.1.value.abs().total_cmp(&other.1.value.abs())
        };
        let (place, most) = pairs.iter().max_by(by_size)?;
        let what = match () {
            () if other.cohesion != self.cohesion => PROSE.text("cohesion", &[]),
            () if other.rate != self.rate => {
                PROSE.text("rate", values!(rate = number(other.rate, 4)))
            }
            () => PROSE.text("filling", values!(filling = number(other.filling, 1))),
        };
        let how = if place.body_force < 0.0 {
            "lifting"
        } else {
            "lying"
        };
        Some(PROSE.text(
            "change",
            values!(
                what,
                clear = pairs.iter().filter(|(_, change)| clear(change)).count(),
                all = pairs.len(),
                most = most,
                occlusion = number(place.occlusion, 2),
                how
            ),
        ))
    }
}

fn body_force(row: &Row<'_>) -> f64 {
    row.number_or("body_force", 0.0)
}

/// The places of one body force, by ascending occlusion.
fn places(body_force: f64, rows: Vec<Row<'_>>) -> Vec<Place> {
    let by_width = grouped(rows, Row::width).into_iter().rev();
    by_width
        .filter_map(|(_, rows)| Place::of(body_force, &rows))
        .collect()
}

/// Where a line between two points with errors in y reaches `y`.
fn reached(y: Uncertain, [from, to]: [(f64, Uncertain); 2]) -> Uncertain {
    let part = (y.value - from.1.value) / (to.1.value - from.1.value);
    let error = y
        .error
        .hypot((1.0 - part) * from.1.error)
        .hypot(part * to.1.error);
    let slope = (to.1.value - from.1.value) / (to.0 - from.0);
    Uncertain::normal(from.0 + part * (to.0 - from.0), (error / slope).abs())
}

/// The flow at complete closure, and the least occlusion from which on the flow is nearly as large; `None` where it is so
/// at the largest one alone.
fn onset(places: &[Place]) -> Option<(Uncertain, Option<Uncertain>)> {
    let closed = places.last()?.flow;
    let enough = Uncertain::normal(NEARLY * closed.value, NEARLY * closed.error);
    let short = places
        .iter()
        .rposition(|place| place.flow.value < enough.value)?;
    let (below, above) = (&places[short], places.get(short + 1)?);
    let occlusion = reached(enough, [below, above].map(|it| (it.occlusion, it.flow)));
    let is_tried = short + 2 < places.len();
    Some((closed, is_tried.then_some(occlusion)))
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = evidence.study("closure")?.rows();
    let cases = Case::all_of(&rows);
    let nothing = |statistics| Ok(PROSE.nothing(statistics));
    let Some((main, main_rows)) = cases.first() else {
        return nothing(Statistics::default());
    };
    // Heads are tried at some of the occlusions alone.
    let of_forces = grouped(main_rows.iter().copied(), body_force);
    let of_forces = of_forces.iter().map(|(_, rows)| behind(rows, Row::width));
    let most = of_forces.clone().map(|it| it.widths).max();
    let statistics =
        Statistics::weakest_at_one_rate(of_forces.filter(|it| Some(it.widths) == most));
    let (Some(lying), Some(lifting)) = (main.lying(), main.lifting()) else {
        return nothing(statistics);
    };
    let mut draft = Draft::of(PROSE);
    let mut ends = Vec::new();
    for (how, places) in [("lying", lying), ("lifting", lifting)] {
        let Some((closed, from)) = onset(places) else {
            return nothing(statistics);
        };
        draft.quantity("flow", values!(how), closed);
        draft.quantity("onset", values!(how), from);
        let words = match from {
            Some(occlusion) => PROSE.text("from", values!(occlusion)),
            None => PROSE.text("never", &[]),
        };
        ends.push((closed.to_string(), words));
    }
    let [(lying_flow, from_lying), (lifting_flow, from_lifting)] = &ends[..] else {
        return nothing(statistics);
    };
    let mut heads = Vec::new();
    let against = pump_curves(main);
    for (occlusion, places) in &against {
        let end = shut_off(places);
        let at = number(*occlusion, 2);
        draft.quantity("shut-off", values!(occlusion = at), end);
        heads.push(match end {
            Some(head) => PROSE.text("end", values!(occlusion = at, head)),
            None => loss(&at, places),
        });
    }
    let matters = |places: &[&Place]| {
        shut_off(places).is_some() || lost(places).is_some_and(|it| !it.interval_95.contains(0.0))
    };
    let last = against.iter().rposition(|(_, places)| matters(places));
    let ends = last.and_then(|last| Some((against[last].0, against.get(last + 1)?.0)));
    let no_longer = ends.map(|ends| {
        let (last, first) = (number(ends.0, 2), number(ends.1, 2));
        PROSE.text("no longer", values!(last, first))
    });
    let changes = cases[1..].iter().filter_map(|(case, _)| main.against(case));
    let changes: Vec<String> = changes.collect();
    let summary = PROSE.text(
        "summary",
        values!(
            lying = lying_flow,
            from_lying,
            lifting = lifting_flow,
            from_lifting,
            heads = heads.join(" "),
            no_longer = no_longer.unwrap_or_default(),
            changes = changes.join(" ")
        ),
    );
    let cells = |(case, _): &(Case, Vec<Row<'_>>)| -> Vec<Vec<String>> {
        case.places().map(|place| place.cells(case)).collect()
    };
    draft.table("closure", &[], cases.iter().flat_map(cells));
    let all = || cases.iter().flat_map(|(case, _)| case.places());
    let part = |open: bool| {
        let places = || all().filter(|place| (place.width >= PASSES) == open);
        let most = |of: fn(&Place) -> f64| places().map(of).fold(0.0, f64::max);
        (
            number(most(|it| it.overlap), 2),
            number(100.0 * most(|it| it.pressed), 0),
        )
    };
    let ((open, often), (closed, often_closed)) = (part(true), part(false));
    draft.weakness("pressed", values!(open, often, closed, often_closed));
    let cohesive = cases.iter().find(|(case, _)| case.cohesion > 0.0);
    let cohesive = cohesive.and_then(|(case, _)| Some((case.lying()?, case.lifting()?)));
    let curve = |name, places: &[Place]| {
        joined(
            name,
            places.iter().map(|place| (place.occlusion, place.flow)),
        )
    };
    let mut series = vec![curve("lying", lying), curve("lifting", lifting)];
    if let Some((lying, lifting)) = cohesive {
        series.extend([
            curve("lying, cohesive", lying),
            curve("lifting, cohesive", lifting),
        ]);
    }
    let flow = label(Axis::FlowRateRatio);
    let against_occlusion =
        ChartPanel::new("occlusion, 1 − *w*/(2*a*)", &flow).with_all(numbered(series));
    let series = against.iter().map(|(occlusion, places)| {
        let points = places
            .iter()
            .map(|place| (-1e3 * place.body_force, place.flow));
        joined(&format!("occlusion {}", number(*occlusion, 2)), points)
    });
    let against_head =
        ChartPanel::new("back pressure, −10^{3} *g* *t*^{2}/*d*", &flow).with_all(numbered(series));
    draft.chart("closure", &[], grid(2, [against_occlusion, against_head]))?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

/// The places against heads, by ascending head, of each occlusion at which enough were tried.
fn pump_curves(case: &Case) -> Vec<(f64, Vec<&Place>)> {
    let loaded = case.places().filter(|place| place.body_force < 0.0);
    grouped(loaded, |place| place.occlusion)
        .into_iter()
        .filter(|(_, places)| places.len() >= LEAST_HEADS)
        .map(|(occlusion, places)| (occlusion, places.into_iter().rev().collect()))
        .collect()
}

/// The head at which the flow ends; `None` where it does so at none that was tried.
fn shut_off(places: &[&Place]) -> Option<Uncertain> {
    let pair = places.windows(2).find(|pair| pair[1].flow.value <= 0.0)?;
    let ends = [pair[0], pair[1]].map(|place| (-place.body_force, place.flow));
    Some(reached(Uncertain::normal(0.0, 0.0), ends))
}

/// What the largest head takes of the flow against the smallest one.
fn lost(places: &[&Place]) -> Option<Uncertain> {
    Some(places.first()?.flow - places.last()?.flow)
}

/// The same in words.
fn loss(occlusion: &str, places: &[&Place]) -> String {
    let (Some(smallest), Some(largest), Some(loss)) = (places.first(), places.last(), lost(places))
    else {
        return String::new();
    };
    PROSE.text(
        "head",
        values!(
            occlusion,
            least = number(-smallest.body_force, 3),
            head = number(-largest.body_force, 3),
            loss
        ),
    )
}
