//! F8: what the volume fraction changes.

use peristalsis_analysis::{Uncertain, fit_line};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Corner, Note};
use peristalsis_figures::{Quantity as Axis, Width};

use crate::branch::{Branch, Control, Point};
use crate::claim::Claim;
use crate::critical::{Line, crossing, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{branch_points, cell, ends, flow_panel, label, points};
use crate::finding::{Finding, Quantity, Statistics};
use crate::judgement::{Part, agrees, all_hold, best, judge};
use crate::prose::Prose;
use crate::row::{Row, Start, grouped};
use crate::text::number;
use crate::thresholds::{
    AGREES_WITHIN, COMPARED_WIDTH, F8_NEEDED, HARDLY, LEAST_DENSITIES, LEAST_ERROR_OF_A_WIDTH,
};

const PROSE: Prose = Prose::new(include_str!("f8.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F8",
    prose: PROSE,
    studies: &["density-fine", "density-coarse"],
    examine,
};

/// What the source says of the transition time.
const EXPONENT: f64 = 1.0;

/// One density.
struct Density<'a> {
    fraction: f64,
    branch: Branch<'a>,
    critical: Option<Uncertain>,
    exponent: Option<Uncertain>,
    /// J/Jmax at [`COMPARED_WIDTH`].
    flow: Option<Uncertain>,
    statistics: Statistics,
}

impl<'a> Density<'a> {
    fn of(rows: &[Row<'a>]) -> Self {
        let branch = Branch::of(rows.iter().copied(), Start::Rest, Control::Width);
        let is_compared = |point: &&Point<'_>| (point.control - COMPARED_WIDTH).abs() < 1e-9;
        let bracket = || branch.step().map(|step| step.place());
        let compared = branch.points.iter().find(is_compared);
        Self {
            fraction: rows[0].number("volume_fraction"),
            critical: crossing(rows).map(|found| found.width).or_else(bracket),
            exponent: Line::at_own_threshold(rows)
                .and_then(|line| line.fit)
                .map(|fit| fit.exponent),
            flow: compared.map(|point| point.flow),
            statistics: branch.statistics(rows.len()),
            branch,
        }
    }

    /// The densities of a study, ascending.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        // The number of grains is whole, so that fractions differ a little from those asked for.
        let key = |row: &Row<'_>| (row.number("volume_fraction") * 100.0).round();
        let groups = grouped(rows, key).into_iter();
        groups.map(|(_, rows)| Self::of(&rows)).collect()
    }

    fn row(&self, lattice: &str) -> Vec<String> {
        vec![
            lattice.to_owned(),
            number(self.fraction, 2),
            cell(self.flow),
            cell(self.critical),
            cell(self.exponent),
        ]
    }
}

/// The three parts of the claim.
struct Judged {
    /// Whether the flow falls with every density, by more than its errors; `None` without one at each.
    slower: Option<bool>,
    /// d w_c/d rho, and the range of w_c over the largest.
    change: Option<Uncertain>,
    relative_change: f64,
    exponent: Option<Uncertain>,
}

impl Judged {
    fn of(densities: &[Density<'_>]) -> Self {
        let flows: Option<Vec<Uncertain>> = densities.iter().map(|density| density.flow).collect();
        let falls = |pair: &[Uncertain]| {
            let error = pair[0].error.max(0.0).hypot(pair[1].error.max(0.0));
            pair[0].value - pair[1].value > AGREES_WITHIN * error
        };
        let (mut fraction, mut width, mut error) = (vec![], vec![], vec![]);
        for density in densities {
            if let Some(critical) = density.critical {
                fraction.push(density.fraction);
                width.push(critical.value);
                error.push(critical.error.max(LEAST_ERROR_OF_A_WIDTH));
            }
        }
        let line = fit_line(&fraction, &width, &error).ok();
        let relative = |(least, largest): (f64, f64)| (largest - least) / largest;
        let exponents = densities.iter().filter_map(|density| density.exponent);
        Self {
            slower: flows.map(|flows| flows.windows(2).all(falls)),
            change: line.map(|line| {
                Uncertain::normal(line.slope.value, line.slope.error * line.scale_factor())
            }),
            relative_change: ends(width.iter().copied()).map_or(0.0, relative),
            exponent: weighted_mean(&exponents.collect::<Vec<_>>()),
        }
    }

    /// Whether all three hold; `None` where one of them cannot be told.
    fn all(&self) -> Option<bool> {
        all_hold(&[
            self.slower,
            Some(self.relative_change < HARDLY),
            self.exponent
                .and_then(|exponent| agrees(&exponent, EXPONENT)),
        ])
    }

    fn in_words(&self, lattice: &str) -> String {
        let how = match self.slower {
            Some(true) => "decreases",
            Some(false) => "does not always decrease",
            None => "is not known at every density, hence not how it changes",
        };
        PROSE.text(
            "lattice",
            &[
                ("lattice", &lattice),
                ("how", &how),
                ("change", &number(100.0 * self.relative_change, 1)),
                ("exponent", &cell(self.exponent)),
            ],
        )
    }

    fn quantities(&self, lattice: &str) -> [Quantity; 2] {
        let unknown = Uncertain::normal(f64::NAN, f64::NAN);
        let change = self.change.unwrap_or(unknown);
        let exponent = self.exponent.unwrap_or(unknown);
        [
            Quantity {
                source: Some(0.0),
                ours: self.change,
                ..PROSE.quantity("change", &[("lattice", &lattice)], change)
            },
            Quantity {
                source: Some(EXPONENT),
                ours: self.exponent,
                ..PROSE.quantity("exponent", &[("lattice", &lattice)], exponent)
            },
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let (mut parts, mut all, mut words) = (Vec::new(), Vec::new(), Vec::new());
    let (mut quantities, mut rows) = (Vec::new(), Vec::new());
    let mut panels: Vec<ChartPanel> = Vec::new();
    for (lattice, study) in [("fine", "density-fine"), ("coarse", "density-coarse")] {
        let densities = Density::all_of(evidence.study(study)?.rows());
        if densities.is_empty() {
            continue;
        }
        let statistics = Statistics {
            strain_rates: 1,
            ..Statistics::weakest(densities.iter().map(|density| density.statistics))
        };
        all.push(statistics);
        let judged = Judged::of(&densities);
        let mut said = judged.in_words(lattice);
        if densities.len() >= LEAST_DENSITIES {
            parts.push(Part {
                lattice: lattice.to_owned(),
                holds: judged.all(),
                statistics,
            });
        } else {
            said.push_str(&PROSE.text("too few", &[("densities", &LEAST_DENSITIES)]));
        }
        words.push(said);
        quantities.extend(judged.quantities(lattice));
        rows.extend(densities.iter().map(|density| density.row(lattice)));
        panels.extend(panels_of(lattice, &densities));
    }
    let (verdict, _, why) = judge(&parts, &F8_NEEDED);
    let found = best(all.into_iter(), &F8_NEEDED);
    if words.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, found, &F8_NEEDED));
    }
    let summary = PROSE.text("summary", &[("found", &words.join(". ")), ("why", &why)]);
    let mut finding = Finding::new(verdict, summary, found, &F8_NEEDED);
    finding.quantities = quantities;
    finding.paragraphs = PROSE.paragraphs(
        "method",
        &[("compared", &COMPARED_WIDTH), ("hardly", &(100.0 * HARDLY))],
    );
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    finding
        .tables
        .push(PROSE.table("densities", &[("compared", &COMPARED_WIDTH)], rows));
    let drawing = ChartFigure::grid(3, panels)
        .width(Width::DoubleColumn)
        .description("Three panels for each lattice about the density dependence.")
        .draw()?;
    finding.figures.push(PROSE.figure("density", &[], drawing));
    Ok(finding)
}

fn panels_of(lattice: &str, densities: &[Density<'_>]) -> [ChartPanel; 3] {
    let mut flow = flow_panel().title(&format!("{lattice} lattice"));
    for (place, density) in densities.iter().enumerate() {
        let name = format!("*ρ* = {}", number(density.fraction, 2));
        let points = branch_points(&name, &density.branch);
        flow = flow.with_all(points.map(|points| points.series(place)));
    }
    let against = |name: &str, value: fn(&Density<'_>) -> Option<Uncertain>| {
        let known = densities
            .iter()
            .filter_map(|density| Some((density.fraction, value(density)?)))
            .filter(|(_, one)| one.error.is_finite());
        let panel = ChartPanel::new(&label(Axis::VolumeFraction), name);
        match points("", known) {
            Some(points) => panel.with(points),
            None => panel
                .x_range(0.0..=0.7)
                .y_range(0.0..=2.0)
                .with(Note::corner(Corner::TopLeft, "too few transitions")),
        }
    };
    [
        flow,
        against(&label(Axis::CriticalWidth), |density| density.critical),
        against("exponent, *α*", |density| density.exponent),
    ]
}
