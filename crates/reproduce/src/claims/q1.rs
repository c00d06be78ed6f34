//! Q1: small strain rates.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::{MOST_ESCAPED, label};
use crate::branches::Branch;
use crate::claim::Claim;
use crate::critical::{longest, strain_rates};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::runs::Start;
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("q1.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q1",
    prose: PROSE,
    studies: &[
        "small-strain-rate-coarse",
        "small-strain-rate-fine",
        "branches-coarse",
        "branches-fine",
    ],
    examine,
};

/// For an answer: four strain rates, five replicates.
const NEEDED: Statistics = Statistics {
    strain_rates: 4,
    widths: 8,
    replicates: 5,
    runs: 300,
};

/// One strain rate on one lattice.
struct Row {
    lattice: &'static str,
    strain_rate: f64,
    critical: Uncertain,
    jammed: Option<Uncertain>,
    height: Option<Uncertain>,
    half: Option<f64>,
    /// Whether the fall counts as a jump.
    jumps: bool,
    /// Whether there are runs from jammed.
    both_starts: bool,
    /// Longest time of a run, in periods.
    periods: f64,
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut rows = Vec::new();
    let mut all = Vec::new();
    for (lattice, small, usual) in [
        ("coarse", "small-strain-rate-coarse", "branches-coarse"),
        ("fine", "small-strain-rate-fine", "branches-fine"),
    ] {
        let mut of_lattice = Vec::new();
        for (name, is_small) in [(small, true), (usual, false)] {
            let runs = &evidence.study(name)?.runs;
            for rate in strain_rates(runs.iter()) {
                // Strain rates of both studies are taken from the one that is about them.
                if !is_small
                    && rows
                        .iter()
                        .any(|row: &Row| row.lattice == lattice && row.strain_rate == rate)
                {
                    continue;
                }
                let here = || runs.iter().filter(move |run| run.strain_rate == rate);
                let branch = Branch::of(here(), Start::Rest);
                let Some(drop) = branch.drop() else { continue };
                let jammed = Branch::of(here(), Start::Jammed);
                if branch.escaped().max(jammed.escaped()) > MOST_ESCAPED {
                    continue;
                }
                if is_small {
                    of_lattice.push(branch.statistics(here().count()));
                }
                rows.push(Row {
                    lattice,
                    strain_rate: rate,
                    critical: drop.width(),
                    jammed: jammed
                        .drop()
                        .filter(|drop| drop.ratio.0 - drop.ratio.1 > 0.05)
                        .map(|drop| drop.width()),
                    height: branch.jump().map(|jump| jump.height),
                    half: crossing_of_half(&branch),
                    jumps: branch.jumps(),
                    both_starts: !jammed.points.is_empty(),
                    periods: longest(here()),
                });
            }
        }
        all.push(Statistics::weakest(of_lattice.into_iter()));
    }
    let found = super::best(all.into_iter(), &NEEDED);
    if rows.is_empty() {
        return Ok(Finding::nothing("No runs yet.", found, &NEEDED));
    }
    rows.sort_by(|one, other| {
        (one.lattice, one.strain_rate)
            .partial_cmp(&(other.lattice, other.strain_rate))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let words: Vec<String> = ["coarse", "fine"]
        .iter()
        .map(|lattice| {
            let slowest = rows.iter().find(|row| row.lattice == *lattice && row.jumps);
            let steady = rows
                .iter()
                .filter(|row| row.lattice == *lattice && !row.jumps);
            let steady: Vec<String> = steady.map(|row| row.strain_rate.to_string()).collect();
            let jump = slowest.map_or("no jump at all".to_owned(), |row| {
                format!(
                    "the smallest strain rate with a jump is {}, at *w*_{{c}} = {}",
                    row.strain_rate,
                    estimate(&row.critical)
                )
            });
            let none = if steady.is_empty() {
                String::new()
            } else {
                format!(" (none seen at {})", steady.join(", "))
            };
            format!(
                "{lattice} lattice: {jump}{none}; {}; {}",
                turning(&rows, lattice),
                turning_of_half(&rows, lattice)
            )
        })
        .collect();
    let mut finding = Finding::new(
        Verdict::Answered,
        format!("{}.", words.join(". ")),
        found,
        &NEEDED,
    );
    for row in rows.iter().filter(|row| row.jumps) {
        finding.quantities.push(Quantity {
            name: format!(
                "critical width from rest, {} lattice, strain rate {}",
                row.lattice, row.strain_rate
            ),
            symbol: "*w*_{c}".to_owned(),
            unit: "d".to_owned(),
            source: None,
            ours: Some(row.critical),
            method: "bracket of the largest fall of the stationary flow".to_owned(),
        });
    }
    finding.tables.push(ReportTable {
        caption: "Where the stationary flow falls most, from rest and from jammed, the height of the jump, and where it passes \
                  one half."
            .to_owned(),
        head: ["lattice", "*ε̇*", "*w*_{c}", "*w*_{c}′", "height", "kind", "periods", "*J* = *J*_{max}/2"].map(str::to_owned).to_vec(),
        rows: rows
            .iter()
            .map(|row| {
                vec![
                    row.lattice.to_owned(),
                    number(row.strain_rate, 4),
                    estimate(&row.critical),
                    row.jammed.map_or_else(
                        || if row.both_starts { "none seen" } else { "–" }.to_owned(),
                        |width| estimate(&width),
                    ),
                    row.height.map_or("–".to_owned(), |height| estimate(&height)),
                    if row.jumps { "jump" } else { "none seen" }.to_owned(),
                    number(row.periods, 0),
                    row.half.map_or("–".to_owned(), |width| number(width, 3)),
                ]
            })
            .collect(),
    });
    finding.paragraphs.push(
        "Where the flow passes one half is not where it jumps if the fast flow itself falls with *w*: a threshold of one half then \
         finds that passage, and one midway between the branches the jump."
            .to_owned(),
    );
    finding.weaknesses.push(
        "Strain rates of both studies stand side by side, with runs of other lengths: see the column of periods."
            .to_owned(),
    );
    finding.figures.push(figure(&rows)?);
    Ok(finding)
}

/// Whether the critical width falls toward the smallest strain rates at which there is a jump, by more than its errors.
fn turning(rows: &[Row], lattice: &str) -> String {
    let jumps: Vec<&Row> = rows
        .iter()
        .filter(|row| row.lattice == lattice && row.jumps)
        .collect();
    let highest = jumps
        .iter()
        .max_by(|one, other| one.critical.value.total_cmp(&other.critical.value));
    let (Some(slowest), Some(highest)) = (jumps.first(), highest) else {
        return "so that *w*_{c} cannot turn back".to_owned();
    };
    let fall = highest.critical.value - slowest.critical.value;
    let error = highest.critical.error.hypot(slowest.critical.error);
    if fall > 3.0 * error {
        format!(
            "*w*_{{c}} turns back below *ε̇* = {}, by {} *d*",
            highest.strain_rate,
            number(fall, 3)
        )
    } else {
        "*w*_{c} of the jump does not turn back".to_owned()
    }
}

/// The strain rate at which the flow passes one half in the widest tube, in words.
fn turning_of_half(rows: &[Row], lattice: &str) -> String {
    let halves: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.lattice == lattice)
        .filter_map(|row| Some((row.strain_rate, row.half?)))
        .collect();
    let widest = halves
        .iter()
        .max_by(|one, other| one.1.total_cmp(&other.1))
        .copied();
    match (halves.first(), widest) {
        (Some(slowest), Some(widest)) if widest.0 > slowest.0 => format!(
            "the width at which *J* = *J*_{{max}}/2 does, below *ε̇* = {}: {} there, {} at {}",
            widest.0,
            number(widest.1, 3),
            number(slowest.1, 3),
            slowest.0
        ),
        _ => "the width at which *J* = *J*_{max}/2 is not seen to".to_owned(),
    }
}

/// The width at which a branch passes one half, between two points on a straight line.
fn crossing_of_half(branch: &Branch) -> Option<f64> {
    branch
        .points
        .windows(2)
        .rev()
        .find(|pair| pair[0].mean >= 0.5 && pair[1].mean < 0.5)
        .map(|pair| {
            let part = (pair[0].mean - 0.5) / (pair[0].mean - pair[1].mean);
            pair[0].width + part * (pair[1].width - pair[0].width)
        })
}

fn figure(rows: &[Row]) -> Result<ReportFigure, ClaimError> {
    let mut width = ChartPanel::new(&label(Axis::StrainRate), &label(Axis::CriticalWidth))
        .x_scale(Scale::Logarithmic);
    let mut height = ChartPanel::new(
        &label(Axis::StrainRate),
        "height of the largest fall, Δ*J*/*J*_{max}",
    )
    .x_scale(Scale::Logarithmic)
    .y_range(0.0..);
    for (series, lattice) in ["coarse", "fine"].into_iter().enumerate() {
        let of: Vec<&Row> = rows.iter().filter(|row| row.lattice == lattice).collect();
        if of.is_empty() {
            continue;
        }
        let rate: Vec<f64> = of.iter().map(|row| row.strain_rate).collect();
        // Where nothing jumps, the largest fall has no meaning.
        let jumping: Vec<&Row> = of.iter().copied().filter(|row| row.jumps).collect();
        if !jumping.is_empty() {
            let column =
                |of: fn(&Row) -> f64| jumping.iter().map(|row| of(row)).collect::<Vec<f64>>();
            width = width.with(
                Points::new(
                    &format!("{lattice}, jump"),
                    &column(|row| row.strain_rate),
                    &column(|row| row.critical.value),
                )
                .y_errors(&column(|row| row.critical.interval_95.length() / 2.0))
                .series(series)
                .joined(),
            );
        }
        let half: Vec<f64> = of.iter().map(|row| row.half.unwrap_or(f64::NAN)).collect();
        if half.iter().any(|width| width.is_finite()) {
            width = width.with(
                Points::new(&format!("{lattice}, *J* = *J*_{{max}}/2"), &rate, &half)
                    .series(series)
                    .open(),
            );
        }
        let jump: Vec<f64> = of
            .iter()
            .map(|row| row.height.map_or(f64::NAN, |height| height.value))
            .collect();
        let jump_error: Vec<f64> = of
            .iter()
            .map(|row| row.height.map_or(0.0, |height| height.error))
            .collect();
        if jump.iter().any(|height| height.is_finite()) {
            height = height.with(
                Points::new(&format!("{lattice} lattice"), &rate, &jump)
                    .y_errors(&jump_error)
                    .series(series)
                    .joined(),
            );
        }
    }
    Ok(ReportFigure {
        name: "small-strain-rates".to_owned(),
        caption: "Critical width (a) where there is a jump, bars: its bracket, open: where the stationary flow passes one half; \
                  and height of the largest fall (b) against strain rate."
            .to_owned(),
        drawing: ChartFigure::grid(2, [width, height])
            .width(Width::DoubleColumn)
            .description("Critical width and height of the jump against strain rate on both lattices.")
            .draw()?,
    })
}
