//! F9: hysteresis.

use peristalsis_analysis::{Family, Hysteresis, Transition, fit_lifetime, hysteresis};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f9.md"));
const STUDIES: &[&str] = &["branches-fine", "branches-coarse", "jam-lifetime"];

pub(super) const CLAIM: Claim = Claim::new("F9", PROSE, STUDIES, examine);

/// Both critical widths at one strain rate.
struct Loop<'a> {
    lattice: Lattice,
    strain_rate: f64,
    flow: Branches<'a>,
    /// w_c, where no loop is found from the branch alone.
    critical: Uncertain,
    /// Where both starts pass from one flow to the other at some width.
    found: Option<Hysteresis>,
    /// Lower bound of the distance where the jam outlives every width.
    at_least: Option<f64>,
    runs: usize,
}

impl<'a> AtRate<'a> for Loop<'a> {
    fn of(lattice: Lattice, strain_rate: f64, rows: Vec<Row<'a>>) -> Option<Self> {
        let flow = Branches::of(&rows, Control::Width);
        let fall = flow.rest.step()?;
        flow.jammed.step()?;
        let threshold = flow.rest.threshold()?;
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
        Some(Self {
            lattice,
            strain_rate,
            critical: found
                .as_ref()
                .map_or(fall.place(), |found| found.from_rest.width),
            found,
            at_least: outlives.then_some(largest - fall.controls[1]),
            runs: rows.len(),
            flow,
        })
    }

    fn escaped(&self) -> f64 {
        self.flow.escaped()
    }

    fn statistics(&self) -> Statistics {
        let both = self.flow.each().map(|branch| branch.statistics(0));
        Statistics {
            runs: self.runs,
            ..Statistics::weakest_at_one_rate(both.into_iter())
        }
    }
}

impl Loop<'_> {
    /// Whether jams break up at some width, beyond that at which grains from rest begin to jam.
    fn closes(&self) -> bool {
        self.found.as_ref().is_some_and(|found| {
            found.loop_width.value > CLEAR_LOOP * found.loop_width.error
                && found.probability < ONE_WIDTH_BY_CHANCE
        })
    }

    /// The distance of w_c and w_c'.
    fn distance(&self) -> Option<Uncertain> {
        self.found.as_ref().map(|found| found.loop_width)
    }

    /// w_c', which may lie beyond all widths.
    fn critical_jammed(&self) -> Option<Uncertain> {
        self.found.as_ref().map(|found| found.from_jammed.width)
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
            self.critical.to_string(),
            bound(self.critical_jammed(), &|_| "> 3".to_owned()),
            bound(self.distance(), &|least| format!("> {}", number(least, 2))),
            number(self.escaped(), 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let both = Shown::<Loop<'_>>::on_both(evidence)?;
    let (mut parts, mut counts) = (Vec::new(), Vec::new());
    for one in &both {
        let looping = one.tight().filter(|one| one.has_loop()).count();
        let closed = one.tight().filter(|one| one.closes()).count();
        let (lattice, all) = (&one.name, one.tight().count());
        counts.push(PROSE.text("count", values!(lattice, looping, all, closed)));
        // Both halves of the claim: two states, and jams that break up.
        parts.push(one.part(looping >= needed.strain_rates && closed > 0));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    let loops = || both.iter().flat_map(|one| &one.all);
    if loops().next().is_none() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let periods = both.iter().map(|one| one.periods).fold(0.0, f64::max);
    let summary = PROSE.text("summary", values!(periods, counts = counts.join("; "), why));
    let mut draft = Draft::of(PROSE);
    for one in loops().filter(|one| one.is_tight()) {
        let (lattice, rate) = (one.lattice.name(), one.strain_rate);
        draft.quantity("loop", values!(lattice, rate), one.distance());
    }
    draft.table("loops", &[], loops().map(Loop::row));
    let rows = lifetimes(evidence.study("jam-lifetime")?.rows());
    if !rows.is_empty() {
        draft.table("lifetimes", &[], rows);
    }
    draft.finding.weaknesses = PROSE.paragraphs("weaknesses", values!(periods));
    let [fine, coarse] = &both;
    let panels = [coarse, fine].map(|one| widest(&one.all));
    let panels: Vec<ChartPanel> = panels.into_iter().flatten().collect();
    if !panels.is_empty() {
        let chart = grid(2, panels).share_y();
        draft.chart("hysteresis", &[], chart)?;
    }
    Ok(draft.concluded(verdict, summary, statistics, &needed))
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
        let ratio = scattered(&group, Row::flow_rate_ratio);
        vec![
            lattice.name(),
            number(rate, 3),
            number(width, 2),
            format!("{} of {}", ended.count(), group.len()),
            lifetime.map_or_else(
                |_| format!("> {}", number(group[0].time() * rate, 0)),
                |fit| with_error(fit.mean.value * rate, fit.mean.error * rate),
            ),
            with_error(ratio.value, ratio.error),
        ]
    };
    grouped(jammed, key).into_iter().map(lifetime).collect()
}

/// The widest closed loop of a lattice, or the first that does not close.
fn widest(loops: &[Loop<'_>]) -> Option<ChartPanel> {
    let width = |one: &Loop<'_>| one.distance().map_or(0.0, |distance| distance.value);
    let widest = loops
        .iter()
        .filter(|one| one.distance().is_some())
        .max_by(|one, other| width(one).total_cmp(&width(other)));
    let one = widest.or_else(|| loops.iter().find(|one| one.at_least.is_some()))?;
    let lattice = one.lattice.name();
    let mut panel = flow_panel().title(&format!("{lattice} lattice, *ε̇* = {}", one.strain_rate));
    let (rest, jammed) = (one.critical.value, one.critical_jammed());
    if let Some(jammed) = jammed.filter(|jammed| jammed.value > rest) {
        panel = panel.with(Window::new("both states", rest, jammed.value));
    }
    Some(panel.with_all(both_starts(&one.flow).into_iter().flatten()))
}
