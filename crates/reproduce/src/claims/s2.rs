//! S2: jammed flow gives way where the wall yields.

use peristalsis_analysis::{Family, Survival, Transition, Uncertain, fit_lifetime, mean_and_error};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use super::elastic::{finding, judged, label, nothing};
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::exhibit::{self, cell_of, ends, periods};
use crate::finding::{Finding, ReportFigure, Verdict};
use crate::forces::{ForceLine, together};
use crate::prose::Prose;
use crate::row::{Row, Start, grouped, longest};
use crate::text::number;
use crate::thresholds::GIVEN_WAY;

const PROSE: Prose = Prose::new(include_str!("s2.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S2",
    prose: PROSE,
    studies: &["elastic-yielding", "elastic-branches"],
    examine,
};

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
                let transitions: Vec<Transition> = rows
                    .iter()
                    .map(|row| row.transition_at(GIVEN_WAY))
                    .collect();
                Self {
                    strain_rate,
                    force,
                    rows,
                    times: transitions
                        .iter()
                        .filter_map(|one| one.observed())
                        .collect(),
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
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let study = evidence.study("elastic-yielding")?;
    let (rows, branches) = (study.rows(), evidence.study("elastic-branches")?.rows());
    let ladder = Rung::all_of(&rows);
    if ladder.is_empty() {
        return Ok(nothing("No runs from jammed yet."));
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
    let mut found = finding(
        verdict,
        PROSE.text(
            "summary",
            &[
                ("periods", &periods),
                ("yielding", &yielding),
                ("lasting", &lasting),
            ],
        ),
        together(judged(&lines)),
    );
    for rung in &ladder {
        let runs = rung.rows.len();
        found.quantities.extend(rung.mean().map(|mean| {
            PROSE.quantity(
                "time",
                &[
                    ("force", &rung.force),
                    ("runs", &runs),
                    ("censored", &(runs - rung.times.len())),
                ],
                mean,
            )
        }));
    }
    found.tables.push(PROSE.table("times", &[], cells(&ladder)));
    let all = Rung::all_of(&branches);
    if !all.is_empty() {
        let table = PROSE.table("times at all strain rates", &[], cells(&all));
        found.tables.push(table);
    }
    let method = PROSE.text("method", &[("threshold", &GIVEN_WAY)]);
    found.paragraphs.push(method);
    let weaknesses = PROSE.paragraphs("weaknesses", &[("periods", &periods)]);
    found.weaknesses.extend(weaknesses);
    found.figures.push(figure(study, &ladder)?);
    Ok(found)
}

/// How many jams gave way, and when.
fn cells(rungs: &[Rung<'_>]) -> Vec<Vec<String>> {
    let row = |rung: &Rung<'_>| {
        let median = Survival::new(&rung.transitions)
            .and_then(|curve| curve.median())
            .ok();
        let mean = rung.mean().map(|mean| {
            if mean.error.is_finite() {
                mean.to_string()
            } else {
                number(mean.value, 1)
            }
        });
        vec![
            rung.strain_rate.to_string(),
            rung.force.to_string(),
            format!("{} of {}", rung.times.len(), rung.rows.len()),
            mean.unwrap_or_else(|| format!("> {}", number(rung.watched(), 0))),
            cell_of(median, |median| number(median.value * rung.strain_rate, 1)),
        ]
    };
    rungs.iter().map(row).collect()
}

/// J(t) of one run a force, and the time until the jam gives way against the force.
fn figure(study: &StudyResults, ladder: &[Rung<'_>]) -> Result<ReportFigure, ClaimError> {
    let courses = courses(study, ladder)?;
    let is_coloured = courses.is_some();
    let panels = courses.into_iter().chain([times(ladder)]);
    let mut figure = ChartFigure::grid(2, panels)
        .width(Width::DoubleColumn)
        .description("Flow rate in time from jammed, and the time until the jam gives way against the force.");
    if is_coloured {
        let first = ladder[0].force;
        let forces = ladder.iter().map(|rung| rung.force);
        let (least, largest) = ends(forces).unwrap_or((first, 1.01 * first));
        let scale = ColourScale::new(&label(Axis::ForceAmplitude), least, largest);
        figure = figure.colour_scale(scale);
    }
    Ok(PROSE.figure("yielding", &[("threshold", &GIVEN_WAY)], figure.draw()?))
}

/// The flow in time of the first replicate at each force; `None` where no time series is at hand.
fn courses(study: &StudyResults, ladder: &[Rung<'_>]) -> Result<Option<ChartPanel>, ClaimError> {
    let mut curves = Vec::new();
    for rung in ladder {
        let Some(row) = rung.rows.iter().find(|row| row.replicate() == 0) else {
            continue;
        };
        let averages = study.period_averages(row)?.unwrap_or_default();
        if !averages.is_empty() {
            let curve = Curve::new("", &periods(averages.len()), &averages);
            curves.push(curve.tint(Tint::Value(rung.force)));
        }
    }
    let panel = ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio))
        .y_range(..=1.05)
        .title("from jammed, one run a force");
    Ok((!curves.is_empty()).then(|| panel.with_all(curves)))
}

/// The time until the jam gives way against the force, of the runs and their mean.
fn times(ladder: &[Rung<'_>]) -> ChartPanel {
    let single = ladder.iter().flat_map(|rung| {
        let times = rung.times.iter();
        times.map(|time| (rung.force, time * rung.strain_rate))
    });
    let (force, time): (Vec<f64>, Vec<f64>) = single.unzip();
    let single = (!force.is_empty()).then(|| {
        Points::new("runs", &force, &time)
            .series(0)
            .tint(Tint::Grey)
            .open()
    });
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
        .with_all(exhibit::points("mean", means).map(|points| points.series(0).joined()))
        .with_all(limits)
}
