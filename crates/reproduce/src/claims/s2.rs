//! S2: jammed flow gives way where the wall yields.

use peristalsis_analysis::{Family, Survival, Transition, fit_lifetime, mean_and_error};

use super::elastic::label;
use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s2.md"));
const STUDIES: &[&str] = &["elastic-yielding", "elastic-branches"];

pub(super) const CLAIM: Claim = Claim::new("S2", PROSE, STUDIES, examine);

/// The runs from jammed at one force.
struct Rung<'a> {
    strain_rate: f64,
    force: f64,
    rows: Vec<Row<'a>>,
    transitions: Vec<Transition>,
    /// Times until the jam gave way, of those runs in which it did.
    times: Vec<f64>,
}

impl<'a> Rung<'a> {
    /// Of the runs from jammed, by strain rate and force.
    fn all_of(rows: &[Row<'a>]) -> Vec<Self> {
        let jammed = |row: &&Row<'_>| row.start() == Start::Jammed && row.force().is_finite();
        let rows = rows.iter().filter(jammed).copied();
        grouped(rows, |row| (row.strain_rate(), row.force()))
            .into_iter()
            .map(|((strain_rate, force), rows)| {
                let transitions = rows.iter().map(|row| row.transition_at(GIVEN_WAY));
                let transitions: Vec<Transition> = transitions.collect();
                let times = transitions.iter().filter_map(|one| one.observed());
                Self {
                    strain_rate,
                    force,
                    rows,
                    times: times.collect(),
                    transitions,
                }
            })
            .collect()
    }

    /// Mean number of periods until the jam gives way, those that did not counted as censored; `None` where none did.
    fn mean(&self) -> Option<Uncertain> {
        let mean = if let Ok(fit) = fit_lifetime(Family::Gamma, &self.transitions) {
            fit.mean
        } else if self.times.len() == self.transitions.len() {
            // Too few for two parameters: their scatter where all were seen, no error of a single one.
            let (mean, error) = mean_and_error(&self.times);
            Uncertain::normal(mean, error)
        } else {
            fit_lifetime(Family::Exponential, &self.transitions)
                .ok()?
                .mean
        };
        Some(mean.scaled(self.strain_rate))
    }

    /// For how many periods all runs were watched at least.
    fn watched(&self) -> f64 {
        let times = self.rows.iter().map(Row::time);
        times.fold(f64::INFINITY, f64::min) * self.strain_rate
    }

    fn most_yield(&self) -> bool {
        2 * self.times.len() >= self.rows.len()
    }

    /// The row of the tables: how many jams gave way, and when.
    fn cells(&self) -> Vec<String> {
        let survival = Survival::new(&self.transitions);
        let median = survival.and_then(|curve| curve.median()).ok();
        let mean = self.mean().map(|mean| {
            if mean.error.is_finite() {
                mean.to_string()
            } else {
                number(mean.value, 1)
            }
        });
        vec![
            self.strain_rate.to_string(),
            self.force.to_string(),
            format!("{} of {}", self.times.len(), self.rows.len()),
            mean.unwrap_or_else(|| format!("> {}", number(self.watched(), 0))),
            cell_of(median, |median| number(median.value * self.strain_rate, 1)),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let study = evidence.study("elastic-yielding")?;
    let (rows, branches) = (study.rows(), evidence.study("elastic-branches")?.rows());
    let ladder = Rung::all_of(&rows);
    if ladder.is_empty() {
        return Ok(nothing(&PROSE));
    }
    let gives_way = ladder.iter().rfind(|rung| rung.most_yield());
    let lasts = ladder.iter().find(|rung| rung.times.is_empty());
    let verdict = match (gives_way, lasts) {
        (Some(gives_way), Some(lasts)) if gives_way.force < lasts.force => Verdict::Reproduced,
        (None, Some(_)) if ladder.iter().all(|rung| rung.times.is_empty()) => Verdict::Differs,
        _ => Verdict::Open,
    };
    let periods = longest(&rows);
    let yielding = gives_way.map_or("at no force".to_owned(), |rung| {
        format!("up to *f*^{{P}} = {} *Yd*^{{2}}", rung.force)
    });
    let lasting = lasts.map_or("some do at every force".to_owned(), |rung| {
        format!("from {} on none does", rung.force)
    });
    let lines = ForceLine::all_of(&branches);
    let summary = PROSE.text("summary", values!(periods, yielding, lasting));
    let mut draft = draft(PROSE);
    for rung in &ladder {
        let (force, runs) = (rung.force, rung.rows.len());
        let censored = runs - rung.times.len();
        draft.quantity("time", values!(force, runs, censored), rung.mean());
    }
    draft.table("times", &[], ladder.iter().map(Rung::cells));
    let all = Rung::all_of(&branches);
    if !all.is_empty() {
        let cells = all.iter().map(Rung::cells);
        draft.table("times at all strain rates", &[], cells);
    }
    draft.paragraph("method", values!(threshold = GIVEN_WAY));
    draft.finding.weaknesses = PROSE.paragraphs("weaknesses", values!(periods));
    let (chart, courses) = match courses(study, &ladder)? {
        none if none.is_empty() => (ChartFigure::new(times(&ladder)), String::new()),
        courses => (figure(courses, &ladder), PROSE.text("courses", &[])),
    };
    draft.chart("yielding", values!(courses, threshold = GIVEN_WAY), chart)?;
    let statistics = together(judged(&lines));
    Ok(draft.concluded(verdict, summary, statistics, &NEEDED))
}

/// J(t) of one run a force, and the time until the jam gives way against the force.
fn figure(courses: Vec<Curve>, ladder: &[Rung<'_>]) -> ChartFigure {
    let in_time = ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio))
        .y_range(..=1.05)
        .title("from jammed, one run a force")
        .with_all(courses);
    let first = ladder[0].force;
    let forces = ladder.iter().map(|rung| rung.force);
    let axis = label(Axis::ForceAmplitude);
    let scale = colours(&axis, forces, (first, 1.01 * first));
    grid(2, [in_time, times(ladder)]).colour_scale(scale)
}

/// The flow in time of the first replicate at each force whose time series is at hand.
fn courses(study: &StudyResults, ladder: &[Rung<'_>]) -> Result<Vec<Curve>> {
    let mut curves = Vec::new();
    for rung in ladder {
        if let Some(row) = rung.rows.iter().find(|row| row.replicate() == 0) {
            let averages = study.period_averages(row)?;
            let known = averages.filter(|averages| !averages.is_empty());
            curves.extend(known.map(|averages| course(rung.force, &averages)));
        }
    }
    Ok(curves)
}

/// The time until the jam gives way against the force, of the runs and their mean.
fn times(ladder: &[Rung<'_>]) -> ChartPanel {
    let single = ladder.iter().flat_map(|rung| {
        let times = rung.times.iter();
        times.map(|time| (rung.force, time * rung.strain_rate))
    });
    let (force, time): (Vec<f64>, Vec<f64>) = single.unzip();
    let runs = Points::new("runs", &force, &time).series(0).open();
    let single = (!force.is_empty()).then(|| runs.tint(Tint::Grey));
    let mean = |rung: &Rung<'_>| rung.mean().filter(|_| rung.most_yield());
    let means = ladder
        .iter()
        .filter_map(|rung| Some((rung.force, mean(rung)?)));
    let (force, watched): (Vec<f64>, Vec<f64>) = ladder
        .iter()
        .filter(|rung| mean(rung).is_none())
        .map(|rung| (rung.force, rung.watched()))
        .unzip();
    let limits = (!force.is_empty()).then(|| {
        Points::new("", &force, &watched)
            .lower_limits(&vec![true; force.len()])
            .limit_name("most outlast the run")
            .series(1)
    });
    ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::TransitionPeriod))
        .y_scale(Scale::Logarithmic)
        .title("until the jam gives way")
        .with_all(single)
        .with_all(numbered([joined("mean", means)]))
        .with_all(limits)
}
