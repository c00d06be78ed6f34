//! F9: hysteresis.

use peristalsis_analysis::{Family, Transition, Uncertain, fit_lifetime, hysteresis};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Window};
use peristalsis_figures::{Quantity as Axis, Width};

use super::{LATTICES, MOST_ESCAPED, Part, judge, label};
use crate::branches::{Branch, BranchPoint};
use crate::claim::Claim;
use crate::critical::{longest, strain_rates};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::runs::{Lattice, Run, Start};
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("f9.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F9",
    prose: PROSE,
    studies: &["branches-fine", "branches-coarse", "jam-lifetime"],
    examine,
};

/// Errors of the loop's width from which on there is a loop.
const CLEAR: f64 = 3.0;
/// Probability of such runs with one critical width for both starts, below which there are two.
const CHANCE: f64 = 0.01;

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
    /// Probability of such runs if both starts had one critical width.
    probability: Option<f64>,
    /// Lower bound of the distance where the jam outlives every width.
    at_least: Option<f64>,
    escaped: f64,
    statistics: Statistics,
}

impl Loop {
    /// Whether jams break up at some width, beyond that at which grains from rest begin to jam.
    fn closes(&self) -> bool {
        self.distance
            .is_some_and(|distance| distance.value > CLEAR * distance.error)
            && self
                .probability
                .is_some_and(|probability| probability < CHANCE)
    }

    /// Whether both flows exist at some width, jams that outlive all runs included.
    fn has_loop(&self) -> bool {
        self.closes() || self.at_least.is_some_and(|least| least > 0.0)
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut loops = Vec::new();
    let mut periods: f64 = 0.0;
    for (lattice, _, study) in LATTICES {
        let runs = &evidence.study(study)?.runs;
        periods = periods.max(longest(runs.iter()));
        loops.extend(
            strain_rates(runs.iter())
                .into_iter()
                .filter_map(|rate| loop_of(runs, lattice, rate)),
        );
    }
    let tight = |lattice: Lattice| {
        loops
            .iter()
            .filter(move |one| one.lattice == lattice && one.escaped <= MOST_ESCAPED)
    };
    let closed = |lattice: Lattice| tight(lattice).filter(|one| one.closes()).count();
    let looping = |lattice: Lattice| tight(lattice).filter(|one| one.has_loop()).count();
    let parts = LATTICES.map(|(lattice, ..)| Part {
        lattice: lattice.name(),
        // Both halves of the claim: two states, and jams that break up.
        holds: (tight(lattice).count() > 0)
            .then(|| looping(lattice) >= needed.strain_rates && closed(lattice) > 0),
        statistics: Statistics::weakest(tight(lattice).map(|one| one.statistics)),
    });
    let (verdict, found, why) = judge(&parts, &needed);
    if loops.is_empty() {
        return Ok(Finding::nothing(
            "No runs from both starts yet.",
            found,
            &needed,
        ));
    }
    let words: Vec<String> = LATTICES
        .iter()
        .map(|(lattice, ..)| {
            format!(
                "on the {} lattice the two starts end in different flows at {} of {} strain rates, at {} of which jams break up at \
                 some width",
                lattice.name(),
                looping(*lattice),
                tight(*lattice).count(),
                closed(*lattice),
            )
        })
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!("Within {periods} periods, {}.{why}", words.join("; ")),
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
        "“> 3” says that jams outlived the runs at every width, that of a straight tube (3 *d*) included: there nothing but the \
         roughness of the wall and dissipation slow grains that move together. *w*_{c}′ in the sense of the claim is then one of \
         much longer times: see the table of lifetimes."
            .to_owned(),
    );
    finding.weaknesses.push(format!(
        "*w*_{{c}} and *w*_{{c}}′ are those of runs of {periods} periods: from rest *w*_{{c}} rises with the time of watching, from \
         jammed *w*_{{c}}′ falls, and a loop of metastable states narrows."
    ));
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
    let threshold = from_rest.threshold()?;
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
    Some(Loop {
        lattice,
        strain_rate,
        critical,
        critical_jammed: found.as_ref().map(|found| found.from_jammed.width),
        distance: found.as_ref().map(|found| found.loop_width),
        probability: found.as_ref().map(|found| found.probability),
        at_least: (found.is_none() && outlives).then_some(largest - drop.after),
        escaped: from_rest.escaped().max(from_jammed.escaped()),
        statistics: Statistics {
            strain_rates: 1,
            runs: here.len(),
            ..Statistics::weakest(
                [&from_rest, &from_jammed]
                    .map(|branch| branch.statistics(0))
                    .into_iter(),
            )
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
            let transitions: Vec<Transition> = group.iter().map(|run| run.transition()).collect();
            let ended = transitions
                .iter()
                .filter(|one| one.observed().is_some())
                .count();
            // Runs that did not end count with the time that they were watched.
            let lifetime = fit_lifetime(Family::Gamma, &transitions)
                .or_else(|_| fit_lifetime(Family::Exponential, &transitions))
                .ok()
                .map(|fit| fit.mean);
            let ratios: Vec<f64> = group.iter().map(|run| run.flow_rate_ratio).collect();
            let (ratio, error) = crate::branches::mean_and_error(&ratios);
            vec![
                first.lattice.name(),
                number(first.strain_rate, 3),
                number(first.width, 2),
                format!("{ended} of {}", group.len()),
                lifetime.map_or_else(
                    || format!("> {}", number(first.time * first.strain_rate, 0)),
                    |mean| {
                        crate::text::with_error(
                            mean.value * first.strain_rate,
                            mean.error * first.strain_rate,
                        )
                    },
                ),
                crate::text::with_error(ratio, error),
            ]
        })
        .collect();
    (!rows.is_empty()).then(|| ReportTable {
        caption: "Lifetime of jammed flow in wide tubes, in periods: runs in which *J*/*J*_{max} fell below 0.5, their mean \
                  time (the others counted as censored), and the flow at the end."
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
            .description("Two branches of the stationary flow.")
            .draw()?,
    }))
}
