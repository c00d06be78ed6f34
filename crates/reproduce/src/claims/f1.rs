//! F1: slow unjammed flow at large widths, a transition to fast jammed flow at small ones.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Width};

use peristalsis_configuration::{Configuration, Sources};
use peristalsis_run::{RunError, snapshot_stack};

use super::{LATTICES, MOST_ESCAPED, Part, judge, label};
use crate::branches::Branch;
use crate::claim::Claim;
use crate::critical::{longest, strain_rates};
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::runs::{Lattice, Run, Start};
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("f1.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F1",
    prose: PROSE,
    studies: &["flow-in-time", "branches-fine", "branches-coarse"],
    examine,
};

/// J/Jmax below which a flow is slow.
const SLOW: f64 = 0.5;
/// J/Jmax from which on a flow is near Jmax.
const NEAR_ONE: f64 = 0.9;
/// Distance below the jump \[d\] at which the jammed flow is read off.
const BELOW: f64 = 0.1;
/// Fraction of runs that must do as the claim says.
const NEARLY_ALL: f64 = 0.95;

/// What the branches of one lattice at one strain rate say.
struct Kind {
    lattice: Lattice,
    strain_rate: f64,
    /// What is behind it.
    statistics: Statistics,
    /// Fractions of the runs beyond the jump that stay slow, and of those below it that become fast.
    slow: f64,
    fast: f64,
    /// J/Jmax just beyond the jump, and `BELOW` it, with errors.
    slow_ratio: (f64, f64),
    fast_ratio: (f64, f64),
    escaped: f64,
    /// Whether the branch has a jump at all.
    jumps: bool,
}

impl Kind {
    fn holds(&self) -> bool {
        self.jumps
            && self.slow >= NEARLY_ALL
            && self.fast >= NEARLY_ALL
            && self.slow_ratio.0 < SLOW
            && self.fast_ratio.0 >= NEAR_ONE
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut kinds = Vec::new();
    let mut periods: f64 = 0.0;
    for (lattice, _, branches) in LATTICES {
        let runs = &evidence.study(branches)?.runs;
        periods = periods.max(longest(runs.iter()));
        for rate in strain_rates(runs.iter()) {
            kinds.extend(kind(runs, lattice, rate));
        }
    }
    let tight = |lattice: Lattice| {
        kinds
            .iter()
            .filter(move |kind| kind.lattice == lattice && kind.escaped <= MOST_ESCAPED)
    };
    let of = |lattice: Lattice| Statistics::weakest(tight(lattice).map(|kind| kind.statistics));
    let needed = Statistics::FOR_A_VERDICT;
    let parts = LATTICES.map(|(lattice, ..)| Part {
        lattice: lattice.name(),
        holds: (tight(lattice).count() > 0).then(|| tight(lattice).all(Kind::holds)),
        statistics: of(lattice),
    });
    let (verdict, statistics, why) = judge(&parts, &needed);
    if kinds.is_empty() {
        return Ok(Finding::nothing("No runs yet.", statistics, &needed));
    }
    let counts: Vec<String> = LATTICES
        .iter()
        .map(|(lattice, ..)| {
            format!(
                "at {} of {} strain rates on the {} lattice",
                tight(*lattice).filter(|kind| kind.holds()).count(),
                tight(*lattice).count(),
                lattice.name()
            )
        })
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!(
            "Slow beyond a jump (below {SLOW} *J*_{{max}}) and fast {BELOW} *d* below it (above {NEAR_ONE} *J*_{{max}}) {}.{why}",
            counts.join(" and ")
        ),
        statistics,
        &needed,
    );
    for kind in tight(Lattice::FINE) {
        finding.quantities.push(Quantity {
            name: format!(
                "flow rate of the jammed state, fine lattice, strain rate {}",
                kind.strain_rate
            ),
            symbol: "*J*/*J*_{max}".to_owned(),
            unit: String::new(),
            source: None,
            ours: Some(peristalsis_analysis::Uncertain::normal(
                kind.fast_ratio.0,
                kind.fast_ratio.1,
            )),
            method: format!("mean over replicates, {BELOW} d below the jump"),
        });
    }
    finding.tables.push(ReportTable {
        caption: format!(
            "The two kinds of flow from rest: fraction of runs beyond the jump that stay slow, of runs below it that become \
             fast, and *J*/*J*_{{max}} just beyond the jump and {BELOW} *d* below it."
        ),
        head: ["lattice", "*ε̇*", "stay slow", "become fast", "slow flow", "fast flow", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows: kinds
            .iter()
            .map(|kind| {
                vec![
                    kind.lattice.name(),
                    number(kind.strain_rate, 3),
                    number(kind.slow, 2),
                    number(kind.fast, 2),
                    with_error(kind.slow_ratio.0, kind.slow_ratio.1),
                    with_error(kind.fast_ratio.0, kind.fast_ratio.1),
                    number(kind.escaped, 2),
                ]
            })
            .collect(),
    });
    finding.paragraphs.push(
        "Runs that still drift at their end are left out. Where the fast flow stays below *J*_{max} the jammed grains slip back \
         through the bottleneck: see the branches of F6."
            .to_owned(),
    );
    finding.weaknesses.push(
        format!(
            "Which flow is the slow one is decided by where the stationary flow falls, within {} periods a run: next to *w*_{{c}} a \
             transition may come later.",
            periods
        ),
    );
    finding
        .figures
        .extend(in_time(evidence.study("flow-in-time")?)?);
    finding.figures.push(snapshots()?);
    Ok(finding)
}

fn kind(runs: &[Run], lattice: Lattice, strain_rate: f64) -> Option<Kind> {
    let here = || {
        runs.iter().filter(move |run| {
            run.lattice == lattice && run.strain_rate == strain_rate && run.start == Start::Rest
        })
    };
    let branch = Branch::of(here(), Start::Rest);
    let drop = branch.drop()?;
    let threshold = branch.threshold()?;
    let fraction = |beyond: bool| {
        let side = || {
            here().filter(move |run| {
                if beyond {
                    run.width >= drop.after
                } else {
                    run.width <= drop.before
                }
            })
        };
        let right = side().filter(|run| (run.flow_rate_ratio < threshold) == beyond);
        right.count() as f64 / side().count().max(1) as f64
    };
    let fast = branch
        .points
        .iter()
        .rfind(|point| point.width <= drop.before - BELOW)?;
    let slow = branch
        .points
        .iter()
        .find(|point| point.width >= drop.after)?;
    Some(Kind {
        lattice,
        strain_rate,
        statistics: branch.statistics(here().count()),
        slow: fraction(true),
        fast: fraction(false),
        slow_ratio: (slow.mean, slow.error),
        fast_ratio: (fast.mean, fast.error),
        escaped: branch.escaped(),
        jumps: branch.jumps(),
    })
}

/// J/Jmax in time for several widths, a panel a lattice; nothing where only rows were imported.
fn in_time(study: &StudyResults) -> Result<Option<ReportFigure>, ClaimError> {
    let mut panels = Vec::new();
    let mut widths: Vec<f64> = Vec::new();
    for lattice in [Lattice::COARSE, Lattice::FINE] {
        let mut panel =
            ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio)).y_range(-0.05..=1.1);
        let mut lines = 0;
        let mut rate = 0.0;
        for run in study
            .runs
            .iter()
            .filter(|run| run.lattice == lattice && run.replicate == 0)
        {
            let Some(averages) = study.period_averages(run)? else {
                continue;
            };
            let period: Vec<f64> = (0..averages.len())
                .map(|number| number as f64 + 0.5)
                .collect();
            panel = panel.with(Curve::new("", &period, &averages).tint(Tint::Value(run.width)));
            widths.push(run.width);
            rate = run.strain_rate;
            lines += 1;
        }
        if lines > 0 {
            panels.push(panel.title(&format!("{} lattice, *ε̇* = {rate}", lattice.name())));
        }
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let least = widths.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = widths.iter().copied().fold(0.0, f64::max);
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .colour_scale(ColourScale::new(
            &label(Axis::Width),
            least,
            largest.max(least + 0.01),
        ))
        .width(Width::DoubleColumn)
        .description("Flow rate in time for several widths of the bottleneck.")
        .draw()?;
    Ok(Some(ReportFigure {
        name: "flow-in-time".to_owned(),
        caption: "*J*/*J*_{max}, averaged over each period, from rest for several widths of the bottleneck.".to_owned(),
        drawing,
    }))
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
        let mut run = peristalsis_run::Run::new(configuration)?;
        while !run.is_complete() {
            run.advance()?;
        }
        runs.push((name, run));
    }
    let labelled: Vec<(&str, &peristalsis_run::Run)> =
        runs.iter().map(|(name, run)| (*name, run)).collect();
    Ok(ReportFigure {
        name: "snapshots".to_owned(),
        caption: "Unjammed and jammed flow after 60 periods from rest, *ε̇* = 0.1, fine lattice; the wave runs to the right, \
                  colours are axial velocities over the wave's speed."
            .to_owned(),
        drawing: snapshot_stack(&labelled)?,
    })
}
