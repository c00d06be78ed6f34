//! Q1: small strain rates.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::{MOST_ESCAPED, label};
use crate::branches::Branch;
use crate::claim::Claim;
use crate::critical::strain_rates;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::runs::Start;
use crate::text::{estimate, number};

pub(super) const CLAIM: Claim = Claim {
    id: "Q1",
    title: "Small strain rates: does the critical width turn back?",
    statement: "The source leaves open *w*_{c} for *ε̇* ≤ 10^{−2}. First runs with a threshold of one half suggested that it \
                turns back below *ε̇* ~ 0.03 on the coarse lattice.",
    source: "open in the source",
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
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut rows = Vec::new();
    let mut found = Statistics::default();
    for (lattice, small, usual) in [
        ("coarse", "small-strain-rate-coarse", "branches-coarse"),
        ("fine", "small-strain-rate-fine", "branches-fine"),
    ] {
        let mut least = Statistics {
            widths: usize::MAX,
            replicates: usize::MAX,
            ..Statistics::default()
        };
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
                let tight = branch
                    .points
                    .iter()
                    .filter(|point| (point.width - drop.before).abs() < 0.1)
                    .all(|point| point.escaped <= MOST_ESCAPED);
                if !tight {
                    continue;
                }
                if is_small {
                    least.strain_rates += 1;
                    least.widths = least.widths.min(branch.points.len());
                    let fewest = branch
                        .points
                        .iter()
                        .map(|point| point.runs)
                        .min()
                        .unwrap_or(0);
                    least.replicates = least.replicates.min(fewest);
                    least.runs += here().count();
                }
                let jammed = Branch::of(here(), Start::Jammed);
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
                });
            }
        }
        if least.strain_rates == 0 {
            least = Statistics::default();
        }
        found = super::larger(found, least);
    }
    if rows.is_empty() {
        return Ok(Finding::nothing("No runs yet.", found, &NEEDED));
    }
    rows.sort_by(|one, other| {
        (one.lattice, one.strain_rate)
            .partial_cmp(&(other.lattice, other.strain_rate))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let coarse: Vec<&Row> = rows.iter().filter(|row| row.lattice == "coarse").collect();
    let turns = |value: &dyn Fn(&Row) -> Option<f64>| {
        let known: Vec<f64> = coarse.iter().filter_map(|row| value(row)).collect();
        // Ascending with the strain rate somewhere at the lower end: it turns back.
        known.windows(2).any(|pair| pair[1] > pair[0] + 0.03)
    };
    let mut finding = Finding::new(
        Verdict::Answered,
        format!(
            "On the coarse lattice the width of the largest fall {} toward small strain rates, that at which the flow passes \
             one half {}; the jump itself shrinks there (table).",
            if turns(&|row| Some(row.critical.value)) {
                "turns back"
            } else {
                "does not turn back"
            },
            if turns(&|row| row.half) {
                "does"
            } else {
                "does not either"
            },
        ),
        found,
        &NEEDED,
    );
    for row in &rows {
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
        head: ["lattice", "*ε̇*", "*w*_{c}", "*w*_{c}′", "jump", "*J* = *J*_{max}/2"].map(str::to_owned).to_vec(),
        rows: rows
            .iter()
            .map(|row| {
                vec![
                    row.lattice.to_owned(),
                    number(row.strain_rate, 4),
                    estimate(&row.critical),
                    row.jammed.map_or("> 3".to_owned(), |width| estimate(&width)),
                    row.height.map_or("–".to_owned(), |height| estimate(&height)),
                    row.half.map_or("–".to_owned(), |width| number(width, 3)),
                ]
            })
            .collect(),
    });
    finding.paragraphs.push(
        "A slow wave on a rough wall lets jammed grains slip back through the bottleneck, so that *J*/*J*_{max} of the jammed \
         branch itself falls continuously with *w* and passes one half long before the jump. A threshold of one half then finds \
         that passage and not the transition; midway between the branches it finds the jump."
            .to_owned(),
    );
    finding.weaknesses.push(
        "Runs of 200 periods at strain rates up to 0.03: a slow wave's period is long, and so these are 6,000 to 40,000 *t*."
            .to_owned(),
    );
    finding.figures.push(figure(&rows)?);
    Ok(finding)
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
        "height of the jump, Δ*J*/*J*_{max}",
    )
    .x_scale(Scale::Logarithmic)
    .y_range(0.0..);
    for (series, lattice) in ["coarse", "fine"].into_iter().enumerate() {
        let of: Vec<&Row> = rows.iter().filter(|row| row.lattice == lattice).collect();
        if of.is_empty() {
            continue;
        }
        let rate: Vec<f64> = of.iter().map(|row| row.strain_rate).collect();
        let critical: Vec<f64> = of.iter().map(|row| row.critical.value).collect();
        let error: Vec<f64> = of
            .iter()
            .map(|row| row.critical.interval_95.length() / 2.0)
            .collect();
        width = width.with(
            Points::new(&format!("{lattice}, jump"), &rate, &critical)
                .y_errors(&error)
                .series(series)
                .joined(),
        );
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
        caption: "Critical width (a), bars: bracket of the jump, open: where the stationary flow passes one half; and height \
                  of the jump (b) against strain rate."
            .to_owned(),
        drawing: ChartFigure::grid(2, [width, height])
            .width(Width::DoubleColumn)
            .description("Critical width and height of the jump against strain rate on both lattices.")
            .draw()?,
    })
}
