//! F9: hysteresis.

use peristalsis_analysis::{
    Family, Transition, Uncertain, fit_lifetime, hysteresis, mean_and_error,
};
use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Window};

use crate::branch::{Branch, Control};
use crate::claim::Claim;
use crate::critical::LATTICES;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{branch_points, cell, flow_panel};
use crate::finding::{Finding, ReportFigure, Statistics};
use crate::judgement::{Part, judge};
use crate::prose::Prose;
use crate::row::{Lattice, Row, Start, by_strain_rate, grouped, longest};
use crate::text::{number, with_error};
use crate::thresholds::{CLEAR_LOOP, MOST_ESCAPED, ONE_WIDTH_BY_CHANCE};

const PROSE: Prose = Prose::new(include_str!("f9.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F9",
    prose: PROSE,
    studies: &["branches-fine", "branches-coarse", "jam-lifetime"],
    examine,
};

/// Both critical widths at one strain rate.
struct Loop<'a> {
    lattice: Lattice,
    strain_rate: f64,
    from_rest: Branch<'a>,
    from_jammed: Branch<'a>,
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

impl<'a> Loop<'a> {
    fn of(lattice: Lattice, strain_rate: f64, rows: Vec<Row<'a>>) -> Option<Self> {
        let branch = |start| Branch::of(rows.iter().copied(), start, Control::Width);
        let (from_rest, from_jammed) = (branch(Start::Rest), branch(Start::Jammed));
        let fall = from_rest.step()?;
        from_jammed.step()?;
        let threshold = from_rest.threshold()?;
        let outcome = |start: Start| -> (Vec<f64>, Vec<bool>) {
            rows.iter()
                .filter(|row| row.start() == start && row.flow_rate_ratio().is_finite())
                .map(|row| (row.width(), row.flow_rate_ratio() > threshold))
                .unzip()
        };
        let (rest, jammed) = (outcome(Start::Rest), outcome(Start::Jammed));
        let found = hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1)).ok();
        let outlives = found.is_none() && jammed.1.iter().all(|jammed| *jammed);
        let largest = jammed.0.iter().copied().fold(0.0, f64::max);
        let found = found.as_ref();
        let both = [&from_rest, &from_jammed].map(|branch| branch.statistics(0));
        Some(Self {
            lattice,
            strain_rate,
            critical: found.map_or(Some(fall.place()), |found| Some(found.from_rest.width)),
            critical_jammed: found.map(|found| found.from_jammed.width),
            distance: found.map(|found| found.loop_width),
            probability: found.map(|found| found.probability),
            at_least: outlives.then_some(largest - fall.controls[1]),
            escaped: from_rest.escaped().max(from_jammed.escaped()),
            statistics: Statistics {
                strain_rates: 1,
                runs: rows.len(),
                ..Statistics::weakest(both.into_iter())
            },
            from_rest,
            from_jammed,
        })
    }

    /// Whether jams break up at some width, beyond that at which grains from rest begin to jam.
    fn closes(&self) -> bool {
        self.distance
            .is_some_and(|distance| distance.value > CLEAR_LOOP * distance.error)
            && self
                .probability
                .is_some_and(|probability| probability < ONE_WIDTH_BY_CHANCE)
    }

    /// Whether both flows exist at some width, jams that outlive all runs included.
    fn has_loop(&self) -> bool {
        self.closes() || self.at_least.is_some_and(|least| least > 0.0)
    }

    fn row(&self) -> Vec<String> {
        let bound = |width: Option<Uncertain>, bound: &dyn Fn(f64) -> String| match (
            width,
            self.at_least,
        ) {
            (None, Some(least)) => bound(least),
            _ => cell(width),
        };
        vec![
            self.lattice.name(),
            number(self.strain_rate, 3),
            cell(self.critical),
            bound(self.critical_jammed, &|_| "> 3".to_owned()),
            bound(self.distance, &|least| format!("> {}", number(least, 2))),
            number(self.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let (mut loops, mut parts, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    let mut periods: f64 = 0.0;
    for (lattice, _, study) in LATTICES {
        let rows = evidence.study(study)?.rows();
        periods = periods.max(longest(&rows));
        let here: Vec<Loop<'_>> = by_strain_rate(rows)
            .into_iter()
            .filter_map(|(rate, rows)| Loop::of(lattice, rate, rows))
            .collect();
        let tight = || here.iter().filter(|one| one.escaped <= MOST_ESCAPED);
        let looping = tight().filter(|one| one.has_loop()).count();
        let closed = tight().filter(|one| one.closes()).count();
        let (all, name) = (tight().count(), lattice.name());
        counts.push(PROSE.text(
            "count",
            &[
                ("lattice", &name),
                ("looping", &looping),
                ("all", &all),
                ("closed", &closed),
            ],
        ));
        parts.push(Part {
            lattice: name,
            // Both halves of the claim: two states, and jams that break up.
            holds: (all > 0).then_some(looping >= needed.strain_rates && closed > 0),
            statistics: Statistics::weakest(tight().map(|one| one.statistics)),
        });
        loops.extend(here);
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if loops.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let summary = PROSE.text(
        "summary",
        &[
            ("periods", &periods),
            ("counts", &counts.join("; ")),
            ("why", &why),
        ],
    );
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    for one in loops.iter().filter(|one| one.escaped <= MOST_ESCAPED) {
        finding.quantities.extend(one.distance.map(|distance| {
            PROSE.quantity(
                "loop",
                &[("lattice", &one.lattice.name()), ("rate", &one.strain_rate)],
                distance,
            )
        }));
    }
    let rows = loops.iter().map(Loop::row).collect();
    finding.tables.push(PROSE.table("loops", &[], rows));
    let rows = lifetimes(evidence.study("jam-lifetime")?.rows());
    if !rows.is_empty() {
        finding.tables.push(PROSE.table("lifetimes", &[], rows));
    }
    finding.paragraphs = PROSE.paragraphs("method", &[]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[("periods", &periods)]);
    finding.figures.extend(figure(&loops)?);
    Ok(finding)
}

/// How long jams last in tubes too wide for them.
fn lifetimes(rows: Vec<Row<'_>>) -> Vec<Vec<String>> {
    let jammed = rows.into_iter().filter(|row| row.start() == Start::Jammed);
    let key = |row: &Row<'_>| (row.lattice(), row.strain_rate(), row.width());
    let lifetime = |((lattice, rate, width), group): ((Lattice, f64, f64), Vec<Row<'_>>)| {
        let transitions: Vec<Transition> = group.iter().map(Row::transition).collect();
        let ended = transitions.iter().filter(|one| one.observed().is_some());
        // Runs that did not end count with the time that they were watched.
        let lifetime = fit_lifetime(Family::Gamma, &transitions)
            .or_else(|_| fit_lifetime(Family::Exponential, &transitions));
        let ratios: Vec<f64> = group.iter().map(Row::flow_rate_ratio).collect();
        let (ratio, error) = mean_and_error(&ratios);
        vec![
            lattice.name(),
            number(rate, 3),
            number(width, 2),
            format!("{} of {}", ended.count(), group.len()),
            lifetime.map_or_else(
                |_| format!("> {}", number(group[0].time() * rate, 0)),
                |fit| with_error(fit.mean.value * rate, fit.mean.error * rate),
            ),
            with_error(ratio, error),
        ]
    };
    grouped(jammed, key).into_iter().map(lifetime).collect()
}

/// On each lattice the widest closed loop, or the first that does not close.
fn figure(loops: &[Loop<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let mut panels = Vec::new();
    for lattice in [Lattice::COARSE, Lattice::FINE] {
        let of = || loops.iter().filter(move |one| one.lattice == lattice);
        let width = |one: &Loop<'_>| one.distance.map_or(0.0, |distance| distance.value);
        let widest = of()
            .filter(|one| one.distance.is_some())
            .max_by(|one, other| width(one).total_cmp(&width(other)));
        panels.extend(
            widest
                .or_else(|| of().find(|one| one.at_least.is_some()))
                .map(panel),
        );
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .width(Width::DoubleColumn)
        .description("Two branches of the stationary flow.")
        .draw()?;
    Ok(Some(PROSE.figure("hysteresis", &[], drawing)))
}

fn panel(one: &Loop<'_>) -> ChartPanel {
    let lattice = one.lattice.name();
    let mut panel = flow_panel().title(&format!("{lattice} lattice, *ε̇* = {}", one.strain_rate));
    if let (Some(rest), Some(jammed)) = (one.critical, one.critical_jammed)
        && jammed.value > rest.value
    {
        panel = panel.with(Window::new("both states", rest.value, jammed.value));
    }
    panel
        .with_all(branch_points("from rest", &one.from_rest).map(|points| points.series(0)))
        .with_all(
            branch_points("from jammed", &one.from_jammed).map(|points| points.series(1).open()),
        )
}
