//! F6: the stationary flow jumps, which a Newtonian fluid's does not.

use peristalsis_analysis::{Bootstrap, Uncertain, dip_test, histogram, two_peaks};
use peristalsis_figures::chart::{
    Bars, ChartFigure, ChartPanel, Line as Curve, Pattern, Points, Tint,
};
use peristalsis_figures::{Quantity as Axis, Width};
use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::{LATTICES, MOST_ESCAPED, Part, judge, label, rate_colours, spaced};
use crate::branches::Branch;
use crate::claim::Claim;
use crate::critical::{longest, strain_rates, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::runs::{Lattice, Run, Start};
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("f6.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F6",
    prose: PROSE,
    studies: &["branches-fine", "branches-coarse"],
    examine,
};

/// Widths about the jump, as a distance, whose runs make the histogram.
const NEAR: f64 = 0.05;

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut parts = Vec::new();
    let mut periods: f64 = 0.0;
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    let mut quantities = Vec::new();
    let mut rates = Vec::new();
    let mut verdicts = Vec::new();
    let mut near_all: Vec<f64> = Vec::new();
    for (lattice, _, study) in LATTICES {
        let runs = &evidence.study(study)?.runs;
        periods = periods.max(longest(runs.iter()));
        let mut panel = ChartPanel::new(&label(Axis::Width), &label(Axis::FlowRateRatio))
            .y_range(-0.05..=1.1)
            .title(&format!("{} lattice", lattice.name()));
        let (mut jumping, mut tight) = (0, 0);
        let mut statistics = Vec::new();
        let mut heights = Vec::new();
        for (place, rate) in strain_rates(runs.iter()).into_iter().enumerate() {
            let here = || runs.iter().filter(move |run| run.strain_rate == rate);
            let branch = Branch::of(here(), Start::Rest);
            let (Some(drop), false) = (branch.drop(), branch.points.is_empty()) else {
                continue;
            };
            rates.push(rate);
            let column = |value: fn(&crate::branches::BranchPoint) -> f64| -> Vec<f64> {
                branch.points.iter().map(value).collect()
            };
            panel = panel.with(
                Points::new("", &column(|p| p.width), &column(|p| p.mean))
                    .y_errors(&column(|p| if p.error.is_finite() { p.error } else { 0.0 }))
                    .series(place)
                    .tint(Tint::Value(rate))
                    .joined(),
            );
            let escaped = branch.escaped();
            let near = near(here(), drop.before, drop.after);
            let test = dip_test(
                &near,
                Bootstrap {
                    resamples: 500,
                    seed: 7,
                },
            )
            .ok();
            let peaks = two_peaks(&near).ok();
            if escaped <= MOST_ESCAPED {
                tight += 1;
                jumping += usize::from(branch.jumps());
                statistics.push(branch.statistics(here().count()));
                near_all.extend(near.iter().filter(|_| lattice == Lattice::FINE));
            }
            let height = branch.jump().map(|jump| jump.height);
            if let Some(height) = height.filter(|_| escaped <= MOST_ESCAPED) {
                heights.push(height);
                quantities.push(Quantity {
                    name: format!(
                        "height of the jump, {} lattice, strain rate {rate}",
                        lattice.name()
                    ),
                    symbol: "Δ*J*/*J*_{max}".to_owned(),
                    unit: String::new(),
                    source: None,
                    ours: Some(height),
                    method: "both branches continued to the jump by straight lines".to_owned(),
                });
            }
            rows.push(vec![
                lattice.name(),
                number(rate, 3),
                format!("{} … {}", number(drop.before, 3), number(drop.after, 3)),
                height.map_or("–".to_owned(), |height| estimate(&height)),
                if branch.jumps() { "jump" } else { "none seen" }.to_owned(),
                peaks.map_or("–".to_owned(), |peaks| {
                    if peaks.is_double() { "two" } else { "one" }.to_owned()
                }),
                test.map_or("–".to_owned(), |test| number(test.probability, 3)),
                number(escaped, 2),
            ]);
        }
        parts.push(Part {
            lattice: lattice.name(),
            holds: (tight > 0).then_some(jumping == tight),
            statistics: Statistics::weakest(statistics.into_iter()),
        });
        verdicts.push((lattice, jumping, tight));
        drop_heights(&mut quantities, lattice, &heights);
        panels.push(newtonian(panel));
    }
    let (verdict, found, why) = judge(&parts, &needed);
    if rates.is_empty() {
        return Ok(Finding::nothing("No runs yet.", found, &needed));
    }
    let words: Vec<String> = verdicts
        .iter()
        .map(|(lattice, jumping, tight)| {
            format!(
                "at {jumping} of {tight} strain rates on the {} lattice",
                lattice.name()
            )
        })
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!(
            "A jump by more than 0.1 and four of its errors between neighbouring widths {}. The Newtonian curve is smooth.{why}",
            words.join(" and ")
        ),
        found,
        &needed,
    );
    finding.quantities = quantities;
    finding.tables.push(ReportTable {
        caption: format!(
            "The largest fall of the stationary flow from rest: bracket in *w*, height, whether it counts as a jump, number \
             of peaks of *J*/*J*_{{max}} over the runs within {NEAR} *d* of it (two normal peaks against one), probability of \
             so deep a dip with one peak (Hartigan), fraction of grains outside."
        ),
        head: ["lattice", "*ε̇*", "*w*_{c}", "height", "", "peaks", "dip", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    finding.paragraphs.push(
        format!("Runs of {periods} periods from rest, the last quarter averaged, those that still drift left out; at each strain rate the widths close in on the jump by \
         bisection. The Newtonian flow of a tube with the same wall (no inertia, long wave, no mean pressure) rises smoothly \
         as the bottleneck narrows, whether its bore is reckoned to the centres of the wall spheres (black) or is the clear \
         one (grey)."),
    );
    finding.weaknesses.push(
        "A steep continuous rise within the bracket would look the same; see its width in the table."
            .to_owned(),
    );
    finding.figures.push(ReportFigure {
        name: "stationary-flow".to_owned(),
        caption: "Stationary *J*/*J*_{max} from rest against the width of the bottleneck, beside that of a Newtonian fluid \
                  (dashed; grey: the clear bore)."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .share_y()
            .colour_scale(rate_colours(rates.into_iter()))
            .width(Width::DoubleColumn)
            .description("Stationary flow rate against width for several strain rates, beside that of a Newtonian fluid.")
            .draw()?,
    });
    if let Ok(counts) = histogram(&near_all, -0.05, 1.05, 22) {
        let heights: Vec<f64> = counts.counts.iter().map(|count| *count as f64).collect();
        if heights.iter().sum::<f64>() > 0.0 {
            let panel = ChartPanel::new(&label(Axis::FlowRateRatio), "runs").with(Bars::new(
                "",
                &counts.edges,
                &heights,
            ));
            finding.figures.push(ReportFigure {
                name: "two-peaks".to_owned(),
                caption: format!(
                    "Stationary *J*/*J*_{{max}} of all runs from rest within {NEAR} *d* of the jump, fine lattice, all strain \
                     rates."
                ),
                drawing: ChartFigure::new(panel)
                    .description("Histogram of the stationary flow rate.")
                    .draw()?,
            });
        }
    }
    Ok(finding)
}

/// J/Jmax of the runs from rest within reach of the jump.
fn near<'a>(runs: impl Iterator<Item = &'a Run>, before: f64, after: f64) -> Vec<f64> {
    runs.filter(|run| run.start == Start::Rest)
        .filter(|run| run.width > before - NEAR && run.width < after + NEAR)
        .map(|run| run.flow_rate_ratio)
        .filter(|ratio| ratio.is_finite())
        .collect()
}

/// The mean height over strain rates, before the heights themselves.
fn drop_heights(quantities: &mut Vec<Quantity>, lattice: Lattice, heights: &[Uncertain]) {
    if let Some(mean) = weighted_mean(heights) {
        quantities.insert(
            0,
            Quantity {
                name: format!("height of the jump, {} lattice, mean", lattice.name()),
                symbol: "Δ*J*/*J*_{max}".to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(mean),
                method: format!("weighted mean over {} strain rates", heights.len()),
            },
        );
    }
}

/// The panel with the flow of a Newtonian fluid.
fn newtonian(panel: ChartPanel) -> ChartPanel {
    // Radius of the tube to the centres of the wall spheres, and half a diameter.
    let (radius, half) = (1.5, 0.5);
    let widths = spaced(2.4, 3.0, 60);
    let ratios = |inset: f64| -> Vec<f64> {
        widths
            .iter()
            .map(|width| {
                NewtonianPeristalsis::from_width(width - 2.0 * inset, radius - inset, 0.0)
                    .map_or(f64::NAN, |fluid| fluid.flow_rate_ratio())
            })
            .collect()
    };
    panel
        .with(
            Curve::new("Newtonian", &widths, &ratios(0.0))
                .tint(Tint::Black)
                .pattern(Pattern::Dashed),
        )
        .with(
            Curve::new("Newtonian, clear bore", &widths, &ratios(half))
                .tint(Tint::Grey)
                .pattern(Pattern::Dashed),
        )
}
