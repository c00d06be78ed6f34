//! F6: the stationary flow jumps, which a Newtonian fluid's does not.

use peristalsis_analysis::{Bootstrap, Uncertain, dip_test, histogram, two_peaks};
use peristalsis_figures::chart::{Bars, ChartFigure, ChartPanel, Line as Curve, Pattern, Tint};
use peristalsis_figures::{Quantity as Axis, Width};
use peristalsis_physics::newtonian::NewtonianPeristalsis;

use crate::branch::{Branch, Control, Step};
use crate::claim::Claim;
use crate::critical::{LATTICES, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{branch_points, cell, cell_of, flow_panel, label, rate_colours, spaced};
use crate::finding::{Finding, Quantity, ReportFigure, Statistics};
use crate::judgement::{Part, judge};
use crate::prose::Prose;
use crate::row::{Lattice, Row, Start, by_strain_rate, longest};
use crate::text::number;
use crate::thresholds::{MOST_ESCAPED, NEAR_THE_JUMP};

const PROSE: Prose = Prose::new(include_str!("f6.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F6",
    prose: PROSE,
    studies: &["branches-fine", "branches-coarse"],
    examine,
};

/// Resamples of the test for two peaks.
const BOOTSTRAP: Bootstrap = Bootstrap {
    resamples: 500,
    seed: 7,
};

/// The branch from rest at one strain rate, with its largest fall.
struct Line<'a> {
    strain_rate: f64,
    branch: Branch<'a>,
    fall: Step,
    height: Option<Uncertain>,
    /// J/Jmax of the runs from rest near the fall.
    near: Vec<f64>,
    escaped: f64,
    statistics: Statistics,
}

impl<'a> Line<'a> {
    fn of(strain_rate: f64, rows: Vec<Row<'a>>) -> Option<Self> {
        let branch = Branch::of(rows.iter().copied(), Start::Rest, Control::Width);
        let fall = branch.step()?;
        let [before, after] = fall.controls;
        let is_near = |row: &&Row<'_>| {
            row.start() == Start::Rest
                && row.width() > before - NEAR_THE_JUMP
                && row.width() < after + NEAR_THE_JUMP
        };
        let near = rows.iter().filter(is_near).map(Row::flow_rate_ratio);
        Some(Self {
            strain_rate,
            near: near.filter(|ratio| ratio.is_finite()).collect(),
            height: branch.jump().map(|jump| jump.height),
            escaped: branch.escaped(),
            statistics: branch.statistics(rows.len()),
            branch,
            fall,
        })
    }

    fn is_tight(&self) -> bool {
        self.escaped <= MOST_ESCAPED
    }

    fn row(&self, lattice: &str) -> Vec<String> {
        let [before, after] = self.fall.controls;
        let jumps = self.branch.jumps();
        let peaks = two_peaks(&self.near).ok();
        let test = dip_test(&self.near, BOOTSTRAP).ok();
        vec![
            lattice.to_owned(),
            number(self.strain_rate, 3),
            format!("{} … {}", number(before, 3), number(after, 3)),
            cell(self.height),
            if jumps { "jump" } else { "none seen" }.to_owned(),
            cell_of(peaks, |peaks| {
                if peaks.is_double() { "two" } else { "one" }.to_owned()
            }),
            cell_of(test, |test| number(test.probability, 3)),
            number(self.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let (mut parts, mut counts, mut panels) = (Vec::new(), Vec::new(), Vec::new());
    let (mut rows, mut means, mut quantities) = (Vec::new(), Vec::new(), Vec::new());
    let (mut rates, mut near) = (Vec::new(), Vec::new());
    let mut periods: f64 = 0.0;
    for (lattice, _, study) in LATTICES {
        let runs = evidence.study(study)?.rows();
        periods = periods.max(longest(&runs));
        let name = lattice.name();
        let lines: Vec<Line<'_>> = by_strain_rate(runs)
            .into_iter()
            .filter_map(|(rate, rows)| Line::of(rate, rows))
            .collect();
        let tight: Vec<&Line<'_>> = lines.iter().filter(|line| line.is_tight()).collect();
        let jumping = tight.iter().filter(|line| line.branch.jumps()).count();
        counts.push(PROSE.text(
            "count",
            &[
                ("jumping", &jumping),
                ("all", &tight.len()),
                ("lattice", &name),
            ],
        ));
        let heights = tight
            .iter()
            .filter_map(|line| Some((line.strain_rate, line.height?)));
        let heights: Vec<(f64, Uncertain)> = heights.collect();
        means.splice(0..0, mean_height(&name, &heights));
        quantities.extend(heights.iter().map(|(rate, height)| {
            PROSE.quantity("height", &[("lattice", &name), ("rate", rate)], *height)
        }));
        if lattice == Lattice::FINE {
            near.extend(tight.iter().flat_map(|line| line.near.iter().copied()));
        }
        rows.extend(lines.iter().map(|line| line.row(&name)));
        rates.extend(lines.iter().map(|line| line.strain_rate));
        panels.push(panel(&name, &lines));
        parts.push(Part {
            lattice: name,
            holds: (!tight.is_empty()).then_some(jumping == tight.len()),
            statistics: Statistics::weakest(tight.iter().map(|line| line.statistics)),
        });
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if rates.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let summary = PROSE.text(
        "summary",
        &[("counts", &counts.join(" and ")), ("why", &why)],
    );
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    finding.quantities = [means, quantities].concat();
    finding
        .tables
        .push(PROSE.table("jumps", &[("near", &NEAR_THE_JUMP)], rows));
    finding.paragraphs = PROSE.paragraphs("method", &[("periods", &periods)]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .colour_scale(rate_colours(rates.into_iter()))
        .width(Width::DoubleColumn)
        .description("Stationary flow rate against width for several strain rates, beside that of a Newtonian fluid.")
        .draw()?;
    finding
        .figures
        .push(PROSE.figure("stationary-flow", &[], drawing));
    finding.figures.extend(peaks(&near)?);
    Ok(finding)
}

/// The mean height of the jumps on one lattice.
fn mean_height(lattice: &str, heights: &[(f64, Uncertain)]) -> Option<Quantity> {
    let heights: Vec<Uncertain> = heights.iter().map(|one| one.1).collect();
    let mean = weighted_mean(&heights)?;
    Some(PROSE.quantity(
        "mean height",
        &[("lattice", &lattice), ("rates", &heights.len())],
        mean,
    ))
}

/// The branches of one lattice beside the flow of a Newtonian fluid.
fn panel(lattice: &str, lines: &[Line<'_>]) -> ChartPanel {
    let mut panel = flow_panel().title(&format!("{lattice} lattice"));
    for (place, line) in lines.iter().enumerate() {
        let points = branch_points("", &line.branch);
        let tint = Tint::Value(line.strain_rate);
        panel = panel.with_all(points.map(|points| points.series(place).tint(tint)));
    }
    // Radius of the tube to the centres of the wall spheres, and half a diameter.
    let (radius, half) = (1.5, 0.5);
    let widths = spaced(2.4, 3.0, 60);
    let newtonian = |name: &str, inset: f64, tint: Tint| {
        let ratio = |width: &f64| {
            NewtonianPeristalsis::from_width(width - 2.0 * inset, radius - inset, 0.0)
                .map_or(f64::NAN, |fluid| fluid.flow_rate_ratio())
        };
        let ratios: Vec<f64> = widths.iter().map(ratio).collect();
        Curve::new(name, &widths, &ratios)
            .tint(tint)
            .pattern(Pattern::Dashed)
    };
    panel
        .with(newtonian("Newtonian", 0.0, Tint::Black))
        .with(newtonian("Newtonian, clear bore", half, Tint::Grey))
}

/// The flows of the runs near the jump; `None` without any.
fn peaks(near: &[f64]) -> Result<Option<ReportFigure>, ClaimError> {
    let Ok(counts) = histogram(near, -0.05, 1.05, 22) else {
        return Ok(None);
    };
    let heights: Vec<f64> = counts.counts.iter().map(|count| *count as f64).collect();
    if heights.iter().sum::<f64>() == 0.0 {
        return Ok(None);
    }
    let bars = Bars::new("", &counts.edges, &heights);
    let panel = ChartPanel::new(&label(Axis::FlowRateRatio), "runs").with(bars);
    let drawing = ChartFigure::new(panel)
        .description("Histogram of the stationary flow rate.")
        .draw()?;
    Ok(Some(PROSE.figure(
        "two-peaks",
        &[("near", &NEAR_THE_JUMP)],
        drawing,
    )))
}
