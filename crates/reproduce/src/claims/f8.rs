//! F8: what the volume fraction changes.

use peristalsis_analysis::{Uncertain, fit_line};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Corner, Note, Points};
use peristalsis_figures::{Quantity as Axis, Width};

use super::{Part, best, judge, label};
use crate::branches::Branch;
use crate::claim::Claim;
use crate::critical::{Line, WINDOW, lines_at_own_threshold, weighted_mean};
use crate::crossing::crossing;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::runs::{Run, Start};
use crate::text::{estimate, number, with_error};

const PROSE: Prose = Prose::new(include_str!("f8.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F8",
    prose: PROSE,
    studies: &["density-fine", "density-coarse"],
    examine,
};

/// For this claim: one strain rate, four densities.
const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 8,
    replicates: 10,
    runs: 320,
};
/// Densities that a verdict takes.
const DENSITIES: usize = 4;
/// Change of w_c over the range of densities, as a fraction of w_c, up to which it hardly depends on them.
const HARDLY: f64 = 0.02;
/// Width at which the flow of all densities is compared \[d\]: all of them are jammed there.
const COMPARED: f64 = 2.6;

/// One density.
struct Density {
    fraction: f64,
    branch: Branch,
    critical: Option<Uncertain>,
    exponent: Option<Uncertain>,
    ratio: Option<(f64, f64)>,
    statistics: Statistics,
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut words = Vec::new();
    let mut parts = Vec::new();
    let mut all = Vec::new();
    let mut quantities = Vec::new();
    let mut rows = Vec::new();
    let mut panels: Vec<ChartPanel> = Vec::new();
    for (lattice, study) in [("fine", "density-fine"), ("coarse", "density-coarse")] {
        let densities = densities(&evidence.study(study)?.runs);
        if densities.is_empty() {
            continue;
        }
        let least = Statistics {
            strain_rates: 1,
            ..Statistics::weakest(densities.iter().map(|density| density.statistics))
        };
        all.push(least);
        let judged = judged(&densities);
        let mut said = judged.in_words();
        if densities.len() >= DENSITIES {
            parts.push(Part {
                lattice: lattice.to_owned(),
                holds: judged.all(),
                statistics: least,
            });
        } else {
            said.push_str(&format!(", with fewer than {DENSITIES} densities"));
        }
        words.push(format!("{lattice} lattice: {said}"));
        quantities.extend(judged.quantities(lattice));
        rows.extend(densities.iter().map(|density| {
            vec![
                lattice.to_owned(),
                number(density.fraction, 2),
                density
                    .ratio
                    .map_or("–".to_owned(), |(mean, error)| with_error(mean, error)),
                density
                    .critical
                    .map_or("–".to_owned(), |one| estimate(&one)),
                density
                    .exponent
                    .map_or("–".to_owned(), |one| estimate(&one)),
            ]
        }));
        panels.extend(panels_of(lattice, &densities));
    }
    let (verdict, _, why) = judge(&parts, &NEEDED);
    let found = best(all.into_iter(), &NEEDED);
    if words.is_empty() {
        return Ok(Finding::nothing("No runs yet.", found, &NEEDED));
    }
    let mut finding = Finding::new(
        verdict,
        format!("{}.{why}", words.join(". ")),
        found,
        &NEEDED,
    );
    finding.quantities = quantities;
    finding.paragraphs.push(format!(
        "J/Jmax of the jammed flow is compared at *w* = {COMPARED} *d*; *w*_{{c}} is where half of the runs jam, or the middle of \
         the bracket of the jump where none or all do; *α* is that of the power law of F2 with a *w*_{{c}} of its own through the \
         six widths next to it, which lie farther apart here, so that it is an effective exponent; the threshold is midway up \
         each density's jump. “Hardly” is taken as a change by less than {} per cent from the least to the largest \
         density.",
        100.0 * HARDLY
    ));
    finding.tables.push(ReportTable {
        caption: format!("Density dependence: flow at *w* = {COMPARED} *d*, critical width, exponent of the transition time."),
        head: ["lattice", "*ρ*", "*J*/*J*_{max}", "*w*_{c}/*d*", "*α*"].map(str::to_owned).to_vec(),
        rows,
    });
    finding.weaknesses.push(
        "One strain rate a lattice: 0.1 on the fine, 0.05 on the coarse one. Where the flow falls without a jump, *w*_{c} only \
         says where it passes the threshold. At 0.60 these soft grains overlap strongly."
            .to_owned(),
    );
    finding.figures.push(ReportFigure {
        name: "density".to_owned(),
        caption: "Density dependence on the fine and the coarse lattice: stationary flow against width, critical width against \
                  density, exponent against density."
            .to_owned(),
        drawing: ChartFigure::grid(3, panels)
            .width(Width::DoubleColumn)
            .description("Three panels for each lattice about the density dependence.")
            .draw()?,
    });
    Ok(finding)
}

fn densities(runs: &[Run]) -> Vec<Density> {
    // The number of grains is whole, so that fractions differ a little from those asked for.
    let key = |run: &Run| (run.volume_fraction * 100.0).round();
    let mut keys: Vec<f64> = runs.iter().map(key).collect();
    keys.sort_by(f64::total_cmp);
    keys.dedup();
    keys.into_iter()
        .map(|wanted| {
            let here: Vec<Run> = runs
                .iter()
                .filter(|run| key(run) == wanted)
                .cloned()
                .collect();
            let branch = Branch::of(here.iter(), Start::Rest);
            let line = lines_at_own_threshold(&here).into_iter().next();
            let fit = line.as_ref().and_then(|line: &Line<'_>| line.fit(WINDOW));
            let ratio = branch
                .points
                .iter()
                .find(|point| (point.width - COMPARED).abs() < 1e-9)
                .map(|point| (point.mean, point.error));
            Density {
                fraction: here[0].volume_fraction,
                critical: crossing(&here.iter().collect::<Vec<_>>())
                    .map(|found| found.width)
                    .or_else(|| branch.drop().map(|drop| drop.width())),
                exponent: fit.map(|fit| fit.exponent),
                ratio,
                statistics: branch.statistics(here.len()),
                branch,
            }
        })
        .collect()
}

/// The three parts of the claim.
struct Judged {
    /// Whether the flow falls with every density, by more than its errors; `None` without one at each.
    slower: Option<bool>,
    change: Option<Uncertain>,
    relative_change: f64,
    exponent: Option<Uncertain>,
}

fn judged(densities: &[Density]) -> Judged {
    let ratios: Option<Vec<(f64, f64)>> = densities.iter().map(|density| density.ratio).collect();
    let (mut fraction, mut width, mut error) = (vec![], vec![], vec![]);
    for density in densities {
        if let Some(critical) = density.critical {
            fraction.push(density.fraction);
            width.push(critical.value);
            error.push(critical.error.max(0.003));
        }
    }
    let change = fit_line(&fraction, &width, &error).ok().map(|line| {
        let stretch = line.scale_factor();
        Uncertain::normal(line.slope.value, line.slope.error * stretch)
    });
    let (least, largest) = width
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(least, largest), value| {
            (least.min(*value), largest.max(*value))
        });
    let exponents: Vec<Uncertain> = densities
        .iter()
        .filter_map(|density| density.exponent)
        .collect();
    Judged {
        slower: ratios.map(|ratios| {
            ratios.windows(2).all(|pair| {
                let error = pair[0].1.max(0.0).hypot(pair[1].1.max(0.0));
                pair[0].0 - pair[1].0 > 2.0 * error
            })
        }),
        change,
        relative_change: (largest - least) / largest,
        exponent: weighted_mean(&exponents),
    }
}

impl Judged {
    /// Whether all three hold; `None` where one of them cannot be told.
    fn all(&self) -> Option<bool> {
        let exponent = self.exponent.map(|exponent| super::agrees(&exponent, 1.0));
        let each = [
            self.slower,
            Some(self.relative_change < HARDLY),
            exponent.flatten(),
        ];
        if each.contains(&Some(false)) {
            return Some(false);
        }
        each.iter().all(Option::is_some).then_some(true)
    }

    fn in_words(&self) -> String {
        format!(
            "the flow {} with density, *w*_{{c}} changes by {} per cent over the range, *α* = {}",
            match self.slower {
                Some(true) => "decreases",
                Some(false) => "does not always decrease",
                None => "is not known at every density, hence not how it changes",
            },
            number(100.0 * self.relative_change, 1),
            self.exponent.map_or("–".to_owned(), |one| estimate(&one)),
        )
    }

    fn quantities(&self, lattice: &str) -> Vec<Quantity> {
        vec![
            Quantity {
                name: format!(
                    "change of the critical width with the volume fraction, {lattice} lattice"
                ),
                symbol: "d*w*_{c}/d*ρ*".to_owned(),
                unit: "d".to_owned(),
                source: Some(0.0),
                ours: self.change,
                method: "weighted line through the densities".to_owned(),
            },
            Quantity {
                name: format!(
                    "exponent of the mean transition time, all densities, {lattice} lattice"
                ),
                symbol: "*α*".to_owned(),
                unit: String::new(),
                source: Some(1.0),
                ours: self.exponent,
                method: "weighted mean over the densities".to_owned(),
            },
        ]
    }
}

fn panels_of(lattice: &str, densities: &[Density]) -> [ChartPanel; 3] {
    let mut flow = ChartPanel::new(&label(Axis::Width), &label(Axis::FlowRateRatio))
        .y_range(-0.05..=1.1)
        .title(&format!("{lattice} lattice"));
    for (place, density) in densities.iter().enumerate() {
        let points = &density.branch.points;
        let column = |value: fn(&crate::branches::BranchPoint) -> f64| -> Vec<f64> {
            points.iter().map(value).collect()
        };
        flow = flow.with(
            Points::new(
                &format!("*ρ* = {}", number(density.fraction, 2)),
                &column(|point| point.width),
                &column(|point| point.mean),
            )
            .y_errors(&column(|point| {
                if point.error.is_finite() {
                    point.error
                } else {
                    0.0
                }
            }))
            .series(place)
            .joined(),
        );
    }
    let against = |name: String, value: &dyn Fn(&Density) -> Option<Uncertain>| {
        let known: Vec<(f64, Uncertain)> = densities
            .iter()
            .filter_map(|density| Some((density.fraction, value(density)?)))
            .filter(|(_, one)| one.error.is_finite())
            .collect();
        let panel = ChartPanel::new(&label(Axis::VolumeFraction), &name);
        if known.is_empty() {
            return panel
                .x_range(0.0..=0.7)
                .y_range(0.0..=2.0)
                .with(Note::corner(Corner::TopLeft, "too few transitions"));
        }
        let x: Vec<f64> = known.iter().map(|one| one.0).collect();
        let y: Vec<f64> = known.iter().map(|one| one.1.value).collect();
        let error: Vec<f64> = known.iter().map(|one| one.1.error).collect();
        panel.with(Points::new("", &x, &y).y_errors(&error))
    };
    [
        flow,
        against(label(Axis::CriticalWidth), &|density| density.critical),
        against("exponent, *α*".to_owned(), &|density| density.exponent),
    ]
}
