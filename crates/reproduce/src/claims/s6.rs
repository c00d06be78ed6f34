//! S6: unjammed flow of frictional grains in the elastic tube beside that of frictionless grains in the prescribed one.

mod figures;

use std::ops::Range;

use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s6.md"));
const STUDIES: &[&str] = &["elastic-flow", "elastic-branches", "unjammed-frictionless"];

pub(super) const CLAIM: Claim = Claim::new("S6", PROSE, STUDIES, examine);

/// Name and symbol of a number, and its value in a run.
type Number = (&'static str, &'static str, fn(&Row<'_>) -> f64);

/// The numbers that are compared, each of one run, free of units.
const NUMBERS: [Number; 6] = [
    (
        "grains per length in the throat over those in the belly",
        "*n*_{1,throat}/*n*_{1,belly}",
        |row| row.number("throat_density") / row.number("belly_density"),
    ),
    ("axial velocity in the throat", "*v*_{throat}/*c*", |row| {
        row.number("throat_axial_velocity") / row.wave_speed()
    }),
    ("axial velocity in the belly", "*v*_{belly}/*c*", |row| {
        row.number("belly_axial_velocity") / row.wave_speed()
    }),
    (
        "temperature in the throat",
        "*T*_{throat}/*mc*^{2}",
        |row| row.number("throat_granular_temperature") / row.wave_speed().powi(2),
    ),
    ("temperature in the belly", "*T*_{belly}/*mc*^{2}", |row| {
        row.number("belly_granular_temperature") / row.wave_speed().powi(2)
    }),
    ("flow rate", "*J*/*J*_{max}", |row| row.flow_rate_ratio()),
];
/// Those that decide by their difference whether two flows differ, density and velocities, and by their ratio, temperatures.
const BY_DIFFERENCE: Range<usize> = 0..3;
const BY_RATIO: Range<usize> = 3..5;

/// In what two flows differ.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// In density or velocity.
    Differ,
    /// In temperature only.
    DifferInTemperature,
    /// In none of them.
    Agree,
    /// The errors do not allow to say, or are not known.
    Unknown,
}

/// One flow: the runs of one point.
struct Flow<'a> {
    name: String,
    rows: Vec<Row<'a>>,
}

impl<'a> Flow<'a> {
    /// The flow of some runs as far as they are unjammed, stationary and hold their grains; `None` without one.
    fn of(name: String, rows: impl IntoIterator<Item = Row<'a>>) -> Option<Self> {
        let counts = |row: &Row<'_>| {
            row.is_stationary()
                && row.flow_rate_ratio() < UNJAMMED
                && row.escaped_fraction() <= MOST_ESCAPED
                && row.number("throat_density").is_finite()
        };
        let rows: Vec<Row<'a>> = rows.into_iter().filter(counts).collect();
        (!rows.is_empty()).then_some(Self { name, rows })
    }

    fn mean(&self, value: fn(&Row<'_>) -> f64) -> Uncertain {
        scattered(&self.rows, value)
    }

    /// In what it differs from another flow.
    fn beside(&self, other: &Self) -> Outcome {
        let mut known = true;
        let mut any = |numbers: Range<usize>, scale: fn(f64) -> f64, least: f64| {
            NUMBERS[numbers].iter().any(|(_, _, value)| {
                let (one, two) = (self.mean(*value), other.mean(*value));
                let difference = (scale(one.value) - scale(two.value)).abs();
                // To first order; the error of a logarithm is the relative error.
                let scaled =
                    |mean: &Uncertain| (scale(mean.value + mean.error) - scale(mean.value)).abs();
                let error = scaled(&one).hypot(scaled(&two));
                known &= error.is_finite() && error < least;
                error.is_finite() && difference > least.max(CLEAR * error)
            })
        };
        if any(BY_DIFFERENCE, |value| value, LEAST_DIFFERENCE) {
            Outcome::Differ
        } else if any(BY_RATIO, f64::ln, LEAST_RATIO.ln()) {
            Outcome::DifferInTemperature
        } else if known {
            Outcome::Agree
        } else {
            Outcome::Unknown
        }
    }

    fn row(&self) -> Vec<String> {
        let means = NUMBERS.iter().map(|(_, _, value)| {
            let mean = self.mean(*value);
            if mean.error.is_finite() {
                mean.to_string()
            } else {
                number(mean.value, 4)
            }
        });
        [self.name.clone(), self.rows.len().to_string()]
            .into_iter()
            .chain(means)
            .collect()
    }
}

/// The unjammed flows of frictional grains: from rest along the branches, and of the pictures, which began jammed, where no
/// flow from rest is there.
fn frictional<'a>(lines: &[ForceLine<'a>], pictures: &[Row<'a>]) -> Vec<Flow<'a>> {
    let name = |rate: f64, force: f64| format!("frictional, *f*^{{P}} = {force}, *ε̇* = {rate}");
    let mut flows: Vec<Flow<'a>> = Vec::new();
    for line in lines {
        flows.extend(line.flow.rest.points.iter().filter_map(|point| {
            let name = name(line.strain_rate, point.control);
            Flow::of(name, point.rows.iter().copied())
        }));
    }
    for row in pictures {
        let name = name(row.strain_rate(), row.force());
        if flows.iter().all(|flow| flow.name != name) {
            let here = pictures
                .iter()
                .copied()
                .filter(|other| other.force() == row.force() && !is_frictionless(other));
            flows.extend(Flow::of(name, here));
        }
    }
    flows
}

/// The unjammed flows of frictionless grains between prescribed walls.
fn frictionless<'a>(rows: &[Row<'a>]) -> Vec<Flow<'a>> {
    by_strain_rate(rows.iter().copied())
        .into_iter()
        .filter_map(|(rate, here)| {
            let width = here[0].width();
            let name = format!("frictionless, prescribed wall, *w* = {width} *d*, *ε̇* = {rate}");
            Flow::of(name, here)
        })
        .collect()
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let branches = evidence.study("elastic-branches")?.rows();
    let elastic = evidence.study("elastic-flow")?;
    let prescribed = evidence.study("unjammed-frictionless")?;
    let lines = ForceLine::all_of(&branches);
    let frictional = frictional(&lines, &elastic.rows());
    let frictionless = frictionless(&prescribed.rows());
    if frictional.is_empty() || frictionless.is_empty() {
        return Ok(nothing(&PROSE));
    }
    let pairs: Vec<(&Flow<'_>, &Flow<'_>, Outcome)> = frictional
        .iter()
        .flat_map(|one| {
            let others = frictionless.iter();
            others.map(move |other| (one, other, one.beside(other)))
        })
        .collect();
    let number_of = |outcome| pairs.iter().filter(|pair| pair.2 == outcome).count();
    let differ = number_of(Outcome::Differ);
    let warmer = number_of(Outcome::DifferInTemperature);
    let agree = number_of(Outcome::Agree);
    // The same measure among the flows of one model says whether it tells models apart, or any two flows.
    let own = frictional.iter().enumerate().flat_map(|(place, one)| {
        let others = frictional[place + 1..].iter();
        others.map(move |other| one.beside(other))
    });
    let own: Vec<Outcome> = own.collect();
    let differs =
        |outcome: &&Outcome| matches!(outcome, Outcome::Differ | Outcome::DifferInTemperature);
    let within = own.iter().filter(differs).count();
    let is_specific = within as f64 <= MOST_WITHIN * own.len() as f64;
    let verdict = if differ + warmer == pairs.len() && is_specific {
        Verdict::Reproduced
    } else if agree == pairs.len() {
        Verdict::Differs
    } else {
        Verdict::Open
    };
    let number = pairs.len();
    let own = own.len();
    let summary = PROSE.text(
        "summary",
        values!(differ, pairs = number, warmer, agree, within, own),
    );
    let mut draft = draft(PROSE);
    let alike = pairs.iter().filter_map(|(one, other, outcome)| {
        let alike = match outcome {
            Outcome::DifferInTemperature => "differ in temperature only",
            Outcome::Agree => "agree",
            Outcome::Differ | Outcome::Unknown => return None,
        };
        let (one, other) = (&one.name, &other.name);
        Some(PROSE.text("alike", values!(alike, one, other)))
    });
    draft.finding.weaknesses.splice(0..0, alike);
    // The first, at the smallest force, of the source's strain rate where there is one.
    let shown = frictional
        .iter()
        .find(|flow| flow.rows[0].strain_rate() == SOURCE_RATE)
        .unwrap_or(&frictional[0]);
    let shown = [shown].into_iter().chain(&frictionless);
    for flow in shown {
        for (name, symbol, value) in &NUMBERS[..5] {
            let (runs, mean) = (flow.rows.len(), flow.mean(*value));
            let flow = &flow.name;
            draft.quantity("mean", values!(name, flow, symbol, runs), mean);
        }
    }
    let flows = frictional.iter().chain(&frictionless);
    let mut table = PROSE.table("flows", &[], flows.map(Flow::row));
    let symbols = NUMBERS.iter().map(|(_, symbol, _)| (*symbol).to_owned());
    table.head.extend(symbols);
    draft.finding.tables.push(table);
    draft.paragraph("tubes", &[]);
    let (difference, ratio, errors) = (LEAST_DIFFERENCE, LEAST_RATIO, CLEAR);
    draft.paragraph("method", values!(difference, ratio, errors));
    figures::profiles(&mut draft, elastic, prescribed)?;
    let statistics = together(judged(&lines));
    Ok(draft.concluded(verdict, summary, statistics, &NEEDED))
}
