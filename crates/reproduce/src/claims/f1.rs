//! F1: slow unjammed flow at large widths, a transition to fast jammed flow at small ones.

use peristalsis_analysis::Uncertain;
use peristalsis_configuration::{Configuration, Sources};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Width};
use peristalsis_run::{Run, RunError, snapshot_stack};

use crate::branch::{Branch, Control};
use crate::claim::Claim;
use crate::critical::LATTICES;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::exhibit::{ends, label, periods};
use crate::finding::{Finding, ReportFigure, Statistics};
use crate::judgement::{Part, judge};
use crate::prose::Prose;
use crate::row::{Lattice, Row, Start, by_strain_rate, longest};
use crate::text::number;
use crate::thresholds::{BELOW_THE_JUMP, MOST_ESCAPED, NEAR_ONE, NEARLY_ALL, SLOW};

const PROSE: Prose = Prose::new(include_str!("f1.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F1",
    prose: PROSE,
    studies: &["flow-in-time", "branches-fine", "branches-coarse"],
    examine,
};

/// What the branch from rest of one lattice at one strain rate says.
struct Kind {
    lattice: Lattice,
    strain_rate: f64,
    statistics: Statistics,
    /// Fractions of the runs beyond the jump that stay slow, and of those below it that become fast.
    slow: f64,
    fast: f64,
    /// J/Jmax just beyond the jump, and [`BELOW_THE_JUMP`].
    slow_flow: Uncertain,
    fast_flow: Uncertain,
    escaped: f64,
    jumps: bool,
}

impl Kind {
    fn of(lattice: Lattice, strain_rate: f64, rows: &[Row<'_>]) -> Option<Self> {
        let branch = Branch::of(rows.iter().copied(), Start::Rest, Control::Width);
        let [before, after] = branch.step()?.controls;
        let threshold = branch.threshold()?;
        let fraction = |is_beyond: bool| {
            let side = rows.iter().filter(|row| match is_beyond {
                true => row.width() >= after,
                false => row.width() <= before,
            });
            let right = |row: &&Row<'_>| (row.flow_rate_ratio() < threshold) == is_beyond;
            side.clone().filter(right).count() as f64 / side.count().max(1) as f64
        };
        let mut points = branch.points.iter();
        let fast = points
            .clone()
            .rfind(|point| point.control <= before - BELOW_THE_JUMP)?;
        let slow = points.find(|point| point.control >= after)?;
        Some(Self {
            lattice,
            strain_rate,
            statistics: branch.statistics(rows.len()),
            slow: fraction(true),
            fast: fraction(false),
            slow_flow: slow.flow,
            fast_flow: fast.flow,
            escaped: branch.escaped(),
            jumps: branch.jumps(),
        })
    }

    fn holds(&self) -> bool {
        self.jumps
            && self.slow >= NEARLY_ALL
            && self.fast >= NEARLY_ALL
            && self.slow_flow.value < SLOW
            && self.fast_flow.value >= NEAR_ONE
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.lattice.name(),
            number(self.strain_rate, 3),
            number(self.slow, 2),
            number(self.fast, 2),
            self.slow_flow.to_string(),
            self.fast_flow.to_string(),
            number(self.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let (mut kinds, mut parts, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    let mut periods: f64 = 0.0;
    for (lattice, _, branches) in LATTICES {
        let rows = evidence.study(branches)?.rows();
        periods = periods.max(longest(&rows));
        let from_rest = rows
            .into_iter()
            .filter(|row| row.lattice() == lattice && row.start() == Start::Rest);
        let here: Vec<Kind> = by_strain_rate(from_rest)
            .into_iter()
            .filter_map(|(rate, rows)| Kind::of(lattice, rate, &rows))
            .collect();
        let tight = || here.iter().filter(|kind| kind.escaped <= MOST_ESCAPED);
        let holding = tight().filter(|kind| kind.holds()).count();
        let all = tight().count();
        let name = lattice.name();
        counts.push(PROSE.text(
            "count",
            &[("holding", &holding), ("all", &all), ("lattice", &name)],
        ));
        parts.push(Part {
            lattice: name,
            holds: (all > 0).then_some(holding == all),
            statistics: Statistics::weakest(tight().map(|kind| kind.statistics)),
        });
        kinds.extend(here);
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if kinds.is_empty() {
        return Ok(Finding::nothing(
            &PROSE.text("nothing", &[]),
            statistics,
            &needed,
        ));
    }
    let summary = PROSE.text(
        "summary",
        &[
            ("slow", &SLOW),
            ("below", &BELOW_THE_JUMP),
            ("near", &NEAR_ONE),
            ("counts", &counts.join(" and ")),
            ("why", &why),
        ],
    );
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    let fine = |kind: &&Kind| kind.lattice == Lattice::FINE && kind.escaped <= MOST_ESCAPED;
    for kind in kinds.iter().filter(fine) {
        finding.quantities.push(PROSE.quantity(
            "jammed flow",
            &[("rate", &kind.strain_rate), ("below", &BELOW_THE_JUMP)],
            kind.fast_flow,
        ));
    }
    finding.tables.push(PROSE.table(
        "kinds",
        &[("below", &BELOW_THE_JUMP)],
        kinds.iter().map(Kind::row).collect(),
    ));
    finding.paragraphs = PROSE.paragraphs("method", &[]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[("periods", &periods)]);
    finding
        .figures
        .extend(in_time(evidence.study("flow-in-time")?)?);
    finding.figures.push(snapshots()?);
    Ok(finding)
}

/// J/Jmax in time for several widths, a panel a lattice; nothing where only rows were imported.
fn in_time(study: &StudyResults) -> Result<Option<ReportFigure>, ClaimError> {
    let mut panels = Vec::new();
    let mut widths: Vec<f64> = Vec::new();
    for lattice in [Lattice::COARSE, Lattice::FINE] {
        let mut panel =
            ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio)).y_range(-0.05..=1.1);
        let mut drawn = None;
        let is_shown = |row: &Row<'_>| row.lattice() == lattice && row.replicate() == 0;
        for row in study.rows().into_iter().filter(is_shown) {
            let Some(averages) = study.period_averages(&row)? else {
                continue;
            };
            let curve = Curve::new("", &periods(averages.len()), &averages);
            panel = panel.with(curve.tint(Tint::Value(row.width())));
            widths.push(row.width());
            drawn = Some(row.strain_rate());
        }
        panels.extend(
            drawn.map(|rate| panel.title(&format!("{} lattice, *ε̇* = {rate}", lattice.name()))),
        );
    }
    let Some(first) = widths.first() else {
        return Ok(None);
    };
    let (least, largest) = ends(widths.iter().copied()).unwrap_or((*first, first + 0.01));
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .colour_scale(ColourScale::new(&label(Axis::Width), least, largest))
        .width(Width::DoubleColumn)
        .description("Flow rate in time for several widths of the bottleneck.")
        .draw()?;
    Ok(Some(PROSE.figure("flow-in-time", &[], drawing)))
}

/// Widths of the snapshots \[d\]: jammed and unjammed at this strain rate on the fine lattice, after so many periods.
const SNAPSHOTS: [(f64, &str); 2] = [
    (2.9, "unjammed, *w* = 2.9 *d*"),
    (2.5, "jammed, *w* = 2.5 *d*"),
];

/// Both kinds of flow, coloured by the axial velocity; two runs of a tenth of a second.
fn snapshots() -> Result<ReportFigure, ClaimError> {
    let mut runs = Vec::new();
    for (width, name) in SNAPSHOTS {
        let overrides = [
            format!("drive.width={width}"),
            "drive.strain_rate=0.1".to_owned(),
            "run.periods=60".to_owned(),
        ];
        let configuration = Configuration::from_sources(&Sources {
            file: None,
            preset: Some("frictionless-fine"),
            overrides: &overrides,
        })
        .map_err(RunError::from)?;
        let mut run = Run::new(configuration)?;
        while !run.is_complete() {
            run.advance()?;
        }
        runs.push((name, run));
    }
    let labelled: Vec<(&str, &Run)> = runs.iter().map(|(name, run)| (*name, run)).collect();
    Ok(PROSE.figure("snapshots", &[], snapshot_stack(&labelled)?))
}
