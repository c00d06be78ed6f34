//! F9: hysteresis.

use peristalsis_analysis::{Uncertain, hysteresis};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Window};
use peristalsis_figures::{Quantity as Axis, Width};

use super::{LATTICES, MOST_ESCAPED, label};
use crate::branches::{Branch, BranchPoint};
use crate::claim::Claim;
use crate::critical::strain_rates;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::runs::{Lattice, Run, Start};
use crate::text::{estimate, number};

pub(super) const CLAIM: Claim = Claim {
    id: "F9",
    title: "Hysteresis: a transition of first order",
    statement: "From jammed: at small *w* the flow stays jammed, at large *w* it turns at some time into unjammed flow, at \
                *w*_{c}′ ≠ *w*_{c}: a first-order transition.",
    source: "talk",
    studies: &["branches-fine", "branches-coarse", "jam-lifetime"],
    examine,
};

/// Errors of the loop's width from which on there is a loop.
const CLEAR: f64 = 3.0;

/// Both critical widths at one strain rate.
struct Loop {
    lattice: Lattice,
    strain_rate: f64,
    from_rest: Branch,
    from_jammed: Branch,
    /// w_c, w_c' and their distance; w_c' may lie beyond all widths.
    critical: Option<Uncertain>,
    critical_jammed: Option<Uncertain>,
    distance: Option<Uncertain>,
    /// Lower bound of the distance where the jam outlives every width.
    at_least: Option<f64>,
    escaped: f64,
    statistics: Statistics,
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut loops = Vec::new();
    for (lattice, _, study) in LATTICES {
        let runs = &evidence.study(study)?.runs;
        loops.extend(
            strain_rates(runs.iter())
                .into_iter()
                .filter_map(|rate| loop_of(runs, lattice, rate)),
        );
    }
    let of = |lattice: Lattice| {
        let tight = || {
            loops
                .iter()
                .filter(move |one| one.lattice == lattice && one.escaped <= MOST_ESCAPED)
        };
        Statistics {
            strain_rates: tight().count(),
            widths: tight().map(|one| one.statistics.widths).min().unwrap_or(0),
            replicates: tight()
                .map(|one| one.statistics.replicates)
                .min()
                .unwrap_or(0),
            runs: tight().map(|one| one.statistics.runs).sum(),
        }
    };
    let found = super::larger(of(Lattice::FINE), of(Lattice::COARSE));
    if loops.is_empty() {
        return Ok(Finding::nothing(
            "No runs from both starts yet.",
            found,
            &needed,
        ));
    }
    let has_loop = |one: &&Loop| {
        one.at_least.is_some_and(|least| least > 0.0)
            || one
                .distance
                .is_some_and(|distance| distance.value > CLEAR * distance.error)
    };
    let tight = || loops.iter().filter(|one| one.escaped <= MOST_ESCAPED);
    let unjammed = tight().filter(|one| one.critical_jammed.is_some()).count();
    let closed = tight()
        .filter(|one| one.critical_jammed.is_some() && has_loop(one))
        .count();
    let looping = tight().filter(has_loop).count();
    let holds = looping >= 4 && closed > 0;
    let mut finding = Finding::new(
        if holds {
            Verdict::Reproduced
        } else {
            Verdict::Differs
        },
        format!(
            "The two starts end in different flows at {looping} of {} strain rates; jammed flow unjams within the run's 500 \
             periods at some width at {unjammed} of them, with a loop at {closed}.",
            tight().count()
        ),
        found,
        &needed,
    );
    for one in loops.iter().filter(|one| one.escaped <= MOST_ESCAPED) {
        if let Some(distance) = one.distance {
            finding.quantities.push(Quantity {
                name: format!(
                    "width of the loop, {} lattice, strain rate {}",
                    one.lattice.name(),
                    one.strain_rate
                ),
                symbol: "*w*_{c}′ − *w*_{c}".to_owned(),
                unit: "d".to_owned(),
                source: None,
                ours: Some(distance),
                method: "widths at which half of the runs from either start end jammed".to_owned(),
            });
        }
    }
    finding.tables.push(ReportTable {
        caption: "Critical widths from rest and from jammed, and the width of the loop; “> 3” where jammed flow outlives the \
                  run in every tube, the straight one (*w* = 3 *d*) included."
            .to_owned(),
        head: ["lattice", "*ε̇*", "*w*_{c}", "*w*_{c}′", "loop", "outside"].map(str::to_owned).to_vec(),
        rows: loops
            .iter()
            .map(|one| {
                vec![
                    one.lattice.name(),
                    number(one.strain_rate, 3),
                    one.critical.map_or("–".to_owned(), |width| estimate(&width)),
                    one.critical_jammed.map_or_else(
                        || if one.at_least.is_some() { "> 3".to_owned() } else { "–".to_owned() },
                        |width| estimate(&width),
                    ),
                    one.distance.map_or_else(
                        || one.at_least.map_or("–".to_owned(), |least| format!("> {}", number(least, 2))),
                        |distance| estimate(&distance),
                    ),
                    number(one.escaped, 2),
                ]
            })
            .collect(),
    });
    finding
        .tables
        .extend(lifetimes(&evidence.study("jam-lifetime")?.runs));
    finding.paragraphs.push(
        "Where the wave is fast and the wall smooth, a jam that is once there does not break up in 500 periods at any width, \
         not even in a straight tube: nothing but the roughness of the wall slows grains that move together. *w*_{c}′ in the \
         sense of the claim then exists only for much longer times (table of lifetimes); on the coarse lattice at strain rates \
         of 0.05 and below it lies within reach."
            .to_owned(),
    );
    finding.weaknesses.push(
        "*w*_{c} and *w*_{c}′ are those of runs of 500 periods: from rest *w*_{c} rises with the time of watching, from jammed \
         *w*_{c}′ falls, and a loop of metastable states narrows."
            .to_owned(),
    );
    finding.figures.extend(figure(&loops)?);
    Ok(finding)
}

fn loop_of(runs: &[Run], lattice: Lattice, strain_rate: f64) -> Option<Loop> {
    let here: Vec<Run> = runs
        .iter()
        .filter(|run| run.lattice == lattice && run.strain_rate == strain_rate)
        .cloned()
        .collect();
    let from_rest = Branch::of(here.iter(), Start::Rest);
    let from_jammed = Branch::of(here.iter(), Start::Jammed);
    let drop = from_rest.drop()?;
    from_jammed.drop()?;
    let threshold = drop.threshold();
    let outcome = |start: Start| -> (Vec<f64>, Vec<bool>) {
        here.iter()
            .filter(|run| run.start == start && run.flow_rate_ratio.is_finite())
            .map(|run| (run.width, run.flow_rate_ratio > threshold))
            .unzip()
    };
    let (rest, jammed) = (outcome(Start::Rest), outcome(Start::Jammed));
    let found = hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1)).ok();
    let critical = found
        .as_ref()
        .map(|found| found.from_rest.width)
        .or_else(|| Some(drop.width()));
    let outlives = jammed.1.iter().all(|jammed| *jammed);
    let largest = jammed.0.iter().copied().fold(0.0, f64::max);
    let least_of = |branch: &Branch| {
        branch
            .points
            .iter()
            .map(|point| point.runs)
            .min()
            .unwrap_or(0)
    };
    Some(Loop {
        lattice,
        strain_rate,
        critical,
        critical_jammed: found.as_ref().map(|found| found.from_jammed.width),
        distance: found.as_ref().map(|found| found.loop_width),
        at_least: (found.is_none() && outlives).then_some(largest - drop.after),
        escaped: from_rest
            .points
            .iter()
            .filter(|point| (point.width - drop.before).abs() < 0.1)
            .map(|point| point.escaped)
            .fold(0.0, f64::max),
        statistics: Statistics {
            strain_rates: 1,
            widths: from_rest.points.len().min(from_jammed.points.len()),
            replicates: least_of(&from_rest).min(least_of(&from_jammed)),
            runs: here.len(),
        },
        from_rest,
        from_jammed,
    })
}

/// How long jams last in tubes too wide for them.
fn lifetimes(runs: &[Run]) -> Option<ReportTable> {
    let key = |run: &Run| (run.lattice, run.strain_rate.to_bits(), run.width.to_bits());
    let mut sorted: Vec<&Run> = runs
        .iter()
        .filter(|run| run.start == Start::Jammed)
        .collect();
    sorted.sort_by_key(|run| key(run));
    let rows: Vec<Vec<String>> = sorted
        .chunk_by(|one, other| key(one) == key(other))
        .map(|group| {
            let first = group[0];
            let times: Vec<f64> = group
                .iter()
                .filter_map(|run| run.transition().observed())
                .map(|time| time * first.strain_rate)
                .collect();
            let (mean, error) = crate::branches::mean_and_error(&times);
            vec![
                first.lattice.name(),
                number(first.strain_rate, 3),
                number(first.width, 2),
                format!("{} of {}", times.len(), group.len()),
                if times.is_empty() {
                    format!("> {}", number(first.time * first.strain_rate, 0))
                } else {
                    crate::text::with_error(mean, error)
                },
                crate::text::with_error(
                    group.iter().map(|run| run.flow_rate_ratio).sum::<f64>() / group.len() as f64,
                    f64::NAN,
                ),
            ]
        })
        .collect();
    (!rows.is_empty()).then(|| ReportTable {
        caption: "Lifetime of jammed flow in wide tubes, in periods: runs in which *J*/*J*_{max} fell below 0.5, their mean \
                  time, and the flow at the end."
            .to_owned(),
        head: ["lattice", "*ε̇*", "*w*/*d*", "ended", "lifetime/*T*", "*J*/*J*_{max} at the end"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    })
}

fn figure(loops: &[Loop]) -> Result<Option<ReportFigure>, ClaimError> {
    let column = |branch: &Branch, value: fn(&BranchPoint) -> f64| -> Vec<f64> {
        branch.points.iter().map(value).collect()
    };
    let chosen: Vec<&Loop> = [Lattice::COARSE, Lattice::FINE]
        .iter()
        .filter_map(|lattice| {
            // The widest closed loop, or the widest at all.
            let of = || loops.iter().filter(move |one| one.lattice == *lattice);
            of().filter(|one| one.distance.is_some())
                .max_by(|one, other| {
                    let width = |one: &Loop| one.distance.map_or(0.0, |distance| distance.value);
                    width(one).total_cmp(&width(other))
                })
                .or_else(|| of().find(|one| one.at_least.is_some()))
        })
        .collect();
    let panels: Vec<ChartPanel> = chosen
        .iter()
        .map(|one| {
            let mut panel = ChartPanel::new(&label(Axis::Width), &label(Axis::FlowRateRatio))
                .y_range(-0.05..=1.1)
                .title(&format!(
                    "{} lattice, *ε̇* = {}",
                    one.lattice.name(),
                    one.strain_rate
                ));
            if let (Some(rest), Some(jammed)) = (one.critical, one.critical_jammed)
                && jammed.value > rest.value
            {
                panel = panel.with(Window::new("both states", rest.value, jammed.value));
            }
            for (series, name, branch) in [
                (0, "from rest", &one.from_rest),
                (1, "from jammed", &one.from_jammed),
            ] {
                let points = Points::new(
                    name,
                    &column(branch, |p| p.width),
                    &column(branch, |p| p.mean),
                )
                .y_errors(&column(branch, |p| {
                    if p.error.is_finite() { p.error } else { 0.0 }
                }))
                .series(series)
                .joined();
                panel = panel.with(if series == 1 { points.open() } else { points });
            }
            panel
        })
        .collect();
    if panels.is_empty() {
        return Ok(None);
    }
    Ok(Some(ReportFigure {
        name: "hysteresis".to_owned(),
        caption:
            "Stationary flow from rest and from jammed: both states exist in the shaded window."
                .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .share_y()
            .width(Width::DoubleColumn)
            .description(
                "Two branches of the stationary flow with a window of widths in which both exist.",
            )
            .draw()?,
    }))
}
