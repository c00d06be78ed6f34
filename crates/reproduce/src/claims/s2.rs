//! S2: jammed flow gives way where the wall yields.

use peristalsis_analysis::{Family, Survival, Transition, fit_lifetime, mean_and_error};

use super::elastic::label;
use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s2.md"));
const STUDIES: &[&str] = &["elastic-yielding", "elastic-branches"];

pub(super) const CLAIM: Claim = claim("S2", PROSE, STUDIES, examine);

/// The runs from jammed at one force.
struct AtForce<'a> {
    strain_rate: f64,
    force: f64,
    rows: Vec<Row<'a>>,
    transitions: Vec<Transition>,
    /// Times until the jam gave way, of those runs in which it did.
    times: Vec<f64>,
}

impl<'a> AtForce<'a> {
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
        let times = self.rows.iter().map(Row::watched);
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

/// The largest force at which most jams give way, and the least at which none does.
fn ends<'a, 'b>(jams: &'b [AtForce<'a>]) -> (Option<&'b AtForce<'a>>, Option<&'b AtForce<'a>>) {
    (
        jams.iter().rfind(|one| one.most_yield()),
        jams.iter().find(|one| one.times.is_empty()),
    )
}

/// Whether jams give way at some forces of one strain rate and last at larger ones; not, where none gives way.
fn yields(jams: &[AtForce<'_>]) -> Option<bool> {
    match ends(jams) {
        (Some(gives_way), Some(lasts)) if gives_way.force < lasts.force => Some(true),
        _ if jams.iter().all(|one| one.times.is_empty()) => Some(false),
        _ => None,
    }
}

/// At which strain rates jams give way at some forces and last at larger ones; undecided where the flow rises smoothly, and
/// where one of two studies of a strain rate is.
fn where_jams_yield(all: &[AtForce<'_>], jams: &[AtForce<'_>], lines: &[ForceLine<'_>]) -> Rates {
    let is_smooth = |rate: f64| {
        let at_rate = lines.iter().find(|line| line.strain_rate == rate);
        at_rate.is_some_and(|line| line.kind() == Kind::Smooth)
    };
    let at_rates = all.chunk_by(|one, other| one.strain_rate == other.strain_rate);
    let found = at_rates
        .chain([jams])
        .map(|jams| (jams[0].strain_rate, yields(jams)));
    Rates::of(grouped(found, |it| it.0).into_iter().map(|(rate, found)| {
        let parts: Vec<Option<bool>> = found.into_iter().map(|it| it.1).collect();
        (rate, all_hold(&parts).filter(|_| !is_smooth(rate)))
    }))
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let study = evidence.study("elastic-yielding")?;
    let (rows, branches) = (study.rows(), evidence.study("elastic-branches")?.rows());
    let jams = AtForce::all_of(&rows);
    if jams.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let all = AtForce::all_of(&branches);
    let (gives_way, lasts) = ends(&jams);
    let rates = where_jams_yield(&all, &jams, &ForceLine::all_of(&branches));
    let verdict = match (rates.holding.len(), rates.failing.len()) {
        (LEAST_RATES.., 0) => Verdict::Reproduced,
        (0, LEAST_RATES..) => Verdict::Differs,
        _ => Verdict::Open,
    };
    let periods = longest(&rows);
    let yielding = gives_way.map_or("at no force".to_owned(), |one| {
        format!("up to *f*^{{P}} = {} *Yd*^{{2}}", one.force)
    });
    let lasting = lasts.map_or("some do at every force".to_owned(), |one| {
        format!("from {} on none does", one.force)
    });
    let rate = jams[0].strain_rate;
    let summary = PROSE.text(
        "summary",
        values!(rate, periods, yielding, lasting, rates = rates.in_words()),
    );
    let mut draft = Draft::of(PROSE);
    for one in &jams {
        let (force, runs) = (one.force, one.rows.len());
        let censored = runs - one.times.len();
        draft.quantity("time", values!(force, runs, censored), one.mean());
    }
    draft.table("times", &[], jams.iter().chain(&all).map(AtForce::cells));
    draft.paragraph("method", values!(threshold = GIVEN_WAY));
    draft.finding.weaknesses = PROSE.paragraphs("weaknesses", values!(periods));
    let (chart, shown) = match courses(study, &jams)? {
        none if none.is_empty() => (
            ChartFigure::new(times(&jams)),
            PROSE.text("times alone", values!(threshold = GIVEN_WAY)),
        ),
        courses => (
            figure(courses, &jams),
            PROSE.text("courses", values!(threshold = GIVEN_WAY)),
        ),
    };
    draft.chart("yielding", values!(shown), chart)?;
    let is_decided = |one: &&AtForce<'_>| {
        rates.holding.contains(&one.strain_rate) || rates.failing.contains(&one.strain_rate)
    };
    let decided = grouped(all.iter().filter(is_decided), |one| one.strain_rate);
    let decided = decided.into_iter().map(|(_, jams)| {
        let rows: Vec<Row<'_>> = jams.iter().flat_map(|one| &one.rows).copied().collect();
        behind(&rows, Row::force)
    });
    let statistics = Statistics::weakest(decided);
    Ok(draft.concluded(verdict, summary, statistics))
}

/// J(t) of one run a force, and the time until the jam gives way against the force.
fn figure(courses: Vec<Curve>, jams: &[AtForce<'_>]) -> ChartFigure {
    let in_time = ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio))
        .y_range(..=1.05)
        .title("from jammed, one run a force")
        .with_all(courses);
    let first = jams[0].force;
    let forces = jams.iter().map(|one| one.force);
    let axis = label(Axis::ForceAmplitude);
    let scale = colours(&axis, forces, (first, 1.01 * first));
    grid(2, [in_time, times(jams)]).colour_scale(scale)
}

/// The flow in time of the first replicate at each force whose time series is at hand.
fn courses(study: &StudyResults, jams: &[AtForce<'_>]) -> Result<Vec<Curve>> {
    let mut curves = Vec::new();
    for one in jams {
        if let Some(row) = one.rows.iter().find(|row| row.replicate() == 0) {
            let averages = study.period_averages(row)?;
            let known = averages.filter(|averages| !averages.is_empty());
            curves.extend(known.map(|averages| course(one.force, &averages)));
        }
    }
    Ok(curves)
}

/// The time until the jam gives way against the force, of the runs and their mean.
fn times(jams: &[AtForce<'_>]) -> ChartPanel {
    let single = jams.iter().flat_map(|one| {
        let times = one.times.iter();
        times.map(|time| (one.force, time * one.strain_rate))
    });
    let (force, time): (Vec<f64>, Vec<f64>) = single.unzip();
    let runs = Points::new("runs", &force, &time).series(0).open();
    let single = (!force.is_empty()).then(|| runs.tint(Tint::Grey));
    let mean = |one: &AtForce<'_>| one.mean().filter(|_| one.most_yield());
    let means = jams.iter().filter_map(|one| Some((one.force, mean(one)?)));
    let (force, watched): (Vec<f64>, Vec<f64>) = jams
        .iter()
        .filter(|one| mean(one).is_none())
        .map(|one| (one.force, one.watched()))
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
