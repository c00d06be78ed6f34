//! Q7: friction and control, two by two.

mod figures;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q7.md"));
const STUDIES: &[&str] = &["two-by-two-strain", "two-by-two-stress"];

pub(super) const CLAIM: Claim =
    Claim::new("Q7", PROSE, STUDIES, examine).varying("bottleneck", Q7_NEEDED);

/// How the wall is driven.
struct Wall {
    study: &'static str,
    name: &'static str,
    control: Control,
    symbol: &'static str,
    /// Digits of the control in tables.
    digits: usize,
}

const WALLS: [Wall; 2] = [
    Wall {
        study: "two-by-two-strain",
        name: "prescribed wall",
        control: Control::Width,
        symbol: "*w*/*d*",
        digits: 2,
    },
    Wall {
        study: "two-by-two-stress",
        name: "elastic wall",
        control: Control::Force,
        symbol: "*f*^{P}/*Yd*^2",
        digits: 4,
    },
];

/// One kind of grains in one kind of wall.
struct Corner<'a> {
    wall: &'static Wall,
    /// mu_s.
    friction: f64,
    flow: Branches<'a>,
    /// States that are left out: they still drift, or too many grains are outside.
    left_out: usize,
    rows: Vec<Row<'a>>,
}

impl<'a> Corner<'a> {
    /// The corners of one wall, those with friction first.
    fn all_of(wall: &'static Wall, rows: Vec<Row<'a>>) -> impl Iterator<Item = Self> {
        grouped(rows, |row| row.number("contact.static_friction"))
            .into_iter()
            .rev()
            .map(move |(friction, rows)| Self::of(wall, friction, rows))
    }

    fn of(wall: &'static Wall, friction: f64, rows: Vec<Row<'a>>) -> Self {
        let mut left_out = 0;
        let mut branch = |start: Start| {
            let from = rows.iter().copied().filter(|row| row.start() == start);
            Branch::with(from, wall.control, |all| {
                if !is_steady(all) {
                    left_out += 1;
                    return None;
                }
                mean(all, "bottleneck")?;
                Some((all.to_vec(), mean(all, "flow_rate_ratio")?))
            })
        };
        Self {
            wall,
            friction,
            flow: Branches {
                rest: branch(Start::Rest),
                jammed: branch(Start::Jammed),
            },
            left_out,
            rows,
        }
    }

    fn name(&self) -> String {
        format!("{}, {}", self.grains(), self.wall.name)
    }

    fn grains(&self) -> &'static str {
        if self.friction > 0.0 {
            "frictional grains"
        } else {
            "frictionless grains"
        }
    }

    /// The largest difference from one value of the control to the next, from rest.
    fn steepest(&self) -> Option<Step> {
        self.flow.rest.largest_step(f64::abs)
    }

    fn highest(&self) -> Option<&Point<'a>> {
        // The first where several are alike.
        let points = self.flow.points();
        points.min_by(|one, other| other.flow.value.total_cmp(&one.flow.value))
    }

    fn is_bistable(&self) -> bool {
        self.flow.gap().is_some_and(|gap| gap.rises_by(LEAST_JUMP))
    }

    fn flows_back(&self) -> bool {
        let lowest = self.flow.lowest();
        lowest.is_some_and(|point| is_clearly_below(point, -LEAST_BACK_FLOW))
    }

    fn is_fast(&self) -> bool {
        self.highest().is_some_and(|point| point.flow.value > FAST)
    }

    fn statistics(&self) -> Statistics {
        let behind = behind(&self.rows, |row| self.wall.control.of(row));
        // Both starts are needed of each.
        Statistics {
            replicates: behind.replicates / 2,
            ..behind
        }
    }

    fn row(&self) -> Vec<String> {
        let control = |value: f64| number(value, self.wall.digits);
        let state = |point: Option<&Point<'_>>| {
            cell_of(point, |point| {
                let width = bottleneck(point).value;
                let (control, width) = (control(point.control), number(width, 2));
                format!("{} at {control} (*w* = {width} *d*)", point.flow)
            })
        };
        vec![
            self.grains().to_owned(),
            format!("{}, {}", self.wall.name, self.wall.symbol),
            state(self.highest()),
            state(self.flow.lowest()),
            cell_of(self.steepest(), |step| {
                let [from, to] = step.controls.map(control);
                format!("{} from {from} to {to}", step.height)
            }),
            cell_of(self.flow.gap(), |gap| {
                format!("{} at {}", gap.height, control(gap.controls[0]))
            }),
        ]
    }
}

/// w \[d\] as it was measured.
fn bottleneck(point: &Point<'_>) -> Uncertain {
    point
        .mean("bottleneck")
        .unwrap_or(Uncertain::normal(f64::NAN, f64::NAN))
}

/// Whether most runs of a state no longer drift, and hold their grains.
fn is_steady(rows: &[Row<'_>]) -> bool {
    let is_steady = |row: &&Row<'_>| row.is_stationary() && row.escaped_fraction() <= MOST_ESCAPED;
    2 * rows.iter().filter(is_steady).count() > rows.len()
}

/// In which corners something is seen, in words.
fn where_seen<'a>(corners: &[Corner<'a>], seen: impl Fn(&Corner<'a>) -> bool) -> String {
    let holds: Vec<&Corner<'a>> = corners.iter().filter(|corner| seen(corner)).collect();
    let all = |belongs: &dyn Fn(&Corner<'a>) -> bool| {
        holds.iter().all(|corner| belongs(corner))
            && corners.iter().filter(|corner| belongs(corner)).count() == holds.len()
    };
    let Some(first) = holds.first() else {
        return "nowhere".to_owned();
    };
    if holds.len() == corners.len() {
        "everywhere".to_owned()
    } else if all(&|corner| corner.wall.name == first.wall.name) {
        format!("in the {} only, whatever the grains", first.wall.name)
    } else if all(&|corner| corner.friction == first.friction) {
        format!("with {} only, whatever the wall", first.grains())
    } else {
        let names: Vec<String> = holds.iter().map(|corner| corner.name()).collect();
        format!(
            "in {} of {} corners: {}",
            holds.len(),
            corners.len(),
            names.join("; ")
        )
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut corners = Vec::new();
    for wall in &WALLS {
        corners.extend(Corner::all_of(wall, evidence.study(wall.study)?.rows()));
    }
    if corners.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let statistics = Statistics::weakest_at_one_rate(corners.iter().map(Corner::statistics));
    let verdict = Verdict::answered_if(corners.len() == 4);
    let fast = where_seen(&corners, Corner::is_fast);
    let bistable = where_seen(&corners, Corner::is_bistable);
    let back = where_seen(&corners, Corner::flows_back);
    let summary = PROSE.text("summary", values!(fast, bistable, back));
    let mut draft = Draft::of(PROSE);
    for one in &corners {
        let lowest = one.flow.lowest().map(|point| point.flow);
        let (gap, corner) = (one.flow.gap().map(|gap| gap.height), one.name());
        draft.quantity("lowest", values!(corner), lowest);
        draft.quantity("gap", values!(corner), gap);
    }
    draft.table("corners", &[], corners.iter().map(Corner::row));
    let left_out: usize = corners.iter().map(|corner| corner.left_out).sum();
    if left_out > 0 {
        draft.weakness("left out", values!(states = left_out));
    }
    draft.chart("two-by-two", &[], figures::chart(&corners))?;
    Ok(draft.concluded(verdict, summary, statistics))
}
