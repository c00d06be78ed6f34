//! Q7: friction and control, two by two.

mod figures;

use peristalsis_analysis::Uncertain;

use super::MOST_ESCAPED;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::rows::{Mean, Row, behind, by, mean};
use crate::runs::{MOST_DRIFT, Start};
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("q7.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q7",
    prose: PROSE,
    studies: &["two-by-two-strain", "two-by-two-stress"],
    examine,
};

/// For an answer: eight bottlenecks a corner, three replicates.
const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 8,
    replicates: 3,
    runs: 192,
};

/// Distance of the two starts, or rise between two neighbouring controls, that counts; and in errors.
const LEAST_JUMP: f64 = 0.1;
const CLEAR: f64 = 4.0;
/// Flow that counts as fast, and flow below which it goes back.
const FAST: f64 = 0.5;
const BACK: f64 = -0.01;

/// How the wall is driven.
struct Wall {
    study: &'static str,
    name: &'static str,
    control: &'static str,
    symbol: &'static str,
}

const WALLS: [Wall; 2] = [
    Wall {
        study: "two-by-two-strain",
        name: "prescribed wall",
        control: "width",
        symbol: "*w*/*d*",
    },
    Wall {
        study: "two-by-two-stress",
        name: "elastic wall",
        control: "force_amplitude",
        symbol: "*f*^{P}/*Yd*^2",
    },
];
const STARTS: [(Start, &str); 2] = [(Start::Rest, "from rest"), (Start::Jammed, "from jammed")];

/// One kind of grains in one kind of wall.
struct Corner<'a> {
    wall: &'static Wall,
    /// mu_s.
    friction: f64,
    /// From rest, from jammed.
    branches: [Vec<State>; 2],
    /// States that are left out: they still drift, or too many grains are outside.
    left_out: usize,
    rows: Vec<Row<'a>>,
}

/// The late flow at one value of the control from one start.
#[derive(Clone, Copy)]
struct State {
    control: f64,
    flow: Mean,
    /// w \[d\].
    bottleneck: Mean,
}

/// A difference of two flows, where it lies on the control.
struct Step {
    at: (f64, f64),
    height: f64,
    error: f64,
}

impl Step {
    fn between(one: &State, other: &State) -> Self {
        Self {
            at: (one.control, other.control),
            height: other.flow.value - one.flow.value,
            error: one.flow.error.max(0.0).hypot(other.flow.error.max(0.0)),
        }
    }

    fn counts(&self) -> bool {
        self.height.abs() > LEAST_JUMP.max(CLEAR * self.error)
    }
}

impl<'a> Corner<'a> {
    fn of(wall: &'static Wall, friction: f64, rows: Vec<Row<'a>>) -> Self {
        let mut left_out = 0;
        let branches = STARTS.map(|(start, _)| {
            let from: Vec<Row<'a>> = rows
                .iter()
                .filter(|row| row.start() == start)
                .copied()
                .collect();
            let states = by(&from, |row| row.number(wall.control));
            let states = states.into_iter().filter_map(|(control, rows)| {
                if !is_steady(&rows) {
                    left_out += 1;
                    return None;
                }
                Some(State {
                    control,
                    flow: mean(&rows, "flow_rate_ratio")?,
                    bottleneck: mean(&rows, "bottleneck")?,
                })
            });
            states.collect()
        });
        Self {
            wall,
            friction,
            branches,
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

    fn states(&self) -> impl Iterator<Item = &State> {
        self.branches.iter().flatten()
    }

    /// The largest distance of the two starts at one value of the control.
    fn gap(&self) -> Option<Step> {
        let [rest, jammed] = &self.branches;
        rest.iter()
            .filter_map(|one| {
                let other = jammed.iter().find(|other| other.control == one.control)?;
                Some(Step::between(one, other))
            })
            .max_by(|one, other| one.height.total_cmp(&other.height))
    }

    /// The largest difference from one value of the control to the next, from rest.
    fn steepest(&self) -> Option<Step> {
        self.branches[0]
            .windows(2)
            .map(|pair| Step::between(&pair[0], &pair[1]))
            .max_by(|one, other| one.height.abs().total_cmp(&other.height.abs()))
    }

    fn extreme(&self, better: fn(f64, f64) -> bool) -> Option<&State> {
        self.states().reduce(|best, one| {
            if better(one.flow.value, best.flow.value) {
                one
            } else {
                best
            }
        })
    }

    fn lowest(&self) -> Option<&State> {
        self.extreme(|one, best| one < best)
    }

    fn highest(&self) -> Option<&State> {
        self.extreme(|one, best| one > best)
    }

    fn is_bistable(&self) -> bool {
        self.gap().is_some_and(|gap| gap.counts())
    }

    fn flows_back(&self) -> bool {
        self.lowest()
            .is_some_and(|state| state.flow.value < BACK.min(-2.0 * state.flow.error.max(0.0)))
    }

    fn is_fast(&self) -> bool {
        self.highest().is_some_and(|state| state.flow.value > FAST)
    }
}

/// Whether most runs of a state no longer drift, and hold their grains.
fn is_steady(rows: &[Row<'_>]) -> bool {
    let steady = rows.iter().filter(|row| {
        let drift = row.number("flow_rate_ratio_drift");
        let escaped = row.number("escaped") / row.number("grains").max(1.0);
        (drift.is_nan() || drift.abs() <= MOST_DRIFT) && escaped <= MOST_ESCAPED
    });
    2 * steady.count() > rows.len()
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

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut corners = Vec::new();
    for wall in &WALLS {
        let rows = evidence.study(wall.study)?.rows();
        for (friction, rows) in by(&rows, |row| row.number("contact.static_friction"))
            .into_iter()
            .rev()
        {
            corners.push(Corner::of(wall, friction, rows));
        }
    }
    if corners.is_empty() {
        return Ok(Finding::nothing(
            "No runs yet.",
            Statistics::default(),
            &NEEDED,
        ));
    }
    let statistics = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(corners.iter().map(|corner| {
            let behind = behind(&corner.rows, |row| row.number(corner.wall.control));
            // Both starts are needed of each.
            Statistics {
                replicates: behind.replicates / 2,
                ..behind
            }
        }))
    };
    let mut finding = Finding::new(
        if corners.len() == 4 {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        format!(
            "A fast flow is seen {}. Two flows at one value of the control, by the start, are seen {}. Back flow is seen {}.",
            where_seen(&corners, Corner::is_fast),
            where_seen(&corners, Corner::is_bistable),
            where_seen(&corners, Corner::flows_back),
        ),
        statistics,
        &NEEDED,
    );
    for corner in &corners {
        finding.quantities.extend(quantities(corner));
    }
    finding.tables.push(table(&corners));
    finding.varied = "bottleneck";
    finding.paragraphs.push(
        "All corners have one tube (*a* = 3.5 *d*, *λ* = 20 *d*, two waves, 22 × 24 wall spheres a wave), one density (*n* = 0.71), one \
         strain rate and the same grains but for their friction. Amplitudes are matched by the bottleneck: the prescribed widths \
         cover what the elastic wall is seen to have, and all flows are drawn against the bottleneck that was measured, twice the \
         least radius of a slice of the wall, averaged over the late part of the run. (The elastic wall gives way: at one force its \
         bottleneck depends on the grains and on the start.)"
            .to_owned(),
    );
    finding.weaknesses.push(
        "The elastic wall is no sine: at one bottleneck its belly differs from \
         that of the prescribed wall. 24 rings a wave in place of the 23 of the preset, for a prescribed wall needs an even number."
            .to_owned(),
    );
    let left_out: usize = corners.iter().map(|corner| corner.left_out).sum();
    if left_out > 0 {
        finding.weaknesses.push(format!(
            "States that still drift, or of which more than a twentieth of the grains are outside, are left out: {left_out}."
        ));
    }
    finding.figures.push(figures::figure(&corners)?);
    Ok(finding)
}

fn quantities(corner: &Corner<'_>) -> Vec<Quantity> {
    let quantity = |name: &str, value: f64, error: f64, method: &str| Quantity {
        name: format!("{name}, {}", corner.name()),
        symbol: "*J*/*J*_{max}".to_owned(),
        unit: String::new(),
        source: None,
        ours: Some(Uncertain::normal(value, error)),
        method: method.to_owned(),
    };
    let lowest = corner.lowest().map(|state| {
        let Mean { value, error, .. } = state.flow;
        quantity("lowest flow", value, error, "over all controls and starts")
    });
    let gap = corner.gap().map(|gap| {
        quantity(
            "largest distance of the two starts",
            gap.height,
            gap.error,
            "at one value of the control, jammed less rest",
        )
    });
    lowest.into_iter().chain(gap).collect()
}

fn table(corners: &[Corner<'_>]) -> ReportTable {
    let decimals = |corner: &Corner<'_>| {
        if corner.wall.control == "width" { 2 } else { 4 }
    };
    let rows = corners
        .iter()
        .map(|corner| {
            let digits = decimals(corner);
            let state = |state: Option<&State>| {
                state.map_or("–".to_owned(), |state| {
                    format!(
                        "{} at {} (*w* = {} *d*)",
                        with_error(state.flow.value, state.flow.error),
                        number(state.control, digits),
                        number(state.bottleneck.value, 2)
                    )
                })
            };
            let step = corner.steepest().map_or("–".to_owned(), |step| {
                format!(
                    "{} from {} to {}",
                    with_error(step.height, step.error),
                    number(step.at.0, digits),
                    number(step.at.1, digits)
                )
            });
            let gap = corner.gap().map_or("–".to_owned(), |gap| {
                format!(
                    "{} at {}",
                    with_error(gap.height, gap.error),
                    number(gap.at.0, digits)
                )
            });
            vec![
                corner.grains().to_owned(),
                format!("{}, {}", corner.wall.name, corner.wall.symbol),
                state(corner.highest()),
                state(corner.lowest()),
                step,
                gap,
            ]
        })
        .collect();
    ReportTable {
        caption:
            "Highest and lowest flow of each corner, the largest difference from rest between two \
                  neighbouring values of the control, and the largest difference of the two starts."
                .to_owned(),
        head: [
            "grains",
            "wall, control",
            "highest *J*/*J*_{max}",
            "lowest",
            "steepest",
            "jammed less rest",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}
