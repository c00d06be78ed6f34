//! S2: jammed flow gives way where the wall yields.

use peristalsis_analysis::{Family, Survival, Transition, Uncertain, fit_lifetime};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use super::elastic::{finding, judged, label, nothing, rate_text};
use crate::branches::mean_and_error;
use crate::claim::Claim;
use crate::critical::longest;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Verdict};
use crate::forces::{ForceLine, together};
use crate::prose::Prose;
use crate::runs::{Run, Start};
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("s2.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S2",
    prose: PROSE,
    studies: &["elastic-yielding", "elastic-branches"],
    examine,
};

/// J/Jmax below which the jam has given way: between that of the jam, 0.6 and more, and that of the unjammed flow, near 0.
const GIVEN_WAY: f64 = 0.3;

/// The runs from jammed at one force.
struct Rung<'a> {
    strain_rate: f64,
    force: f64,
    runs: Vec<&'a Run>,
}

impl Rung<'_> {
    fn transitions(&self) -> Vec<Transition> {
        self.runs
            .iter()
            .map(|run| run.transition_at(GIVEN_WAY))
            .collect()
    }

    fn yielded(&self) -> usize {
        self.transitions()
            .iter()
            .filter(|one| one.observed().is_some())
            .count()
    }

    /// Mean time until the jam gives way, those that did not counted as censored; `None` where none did.
    fn mean(&self) -> Option<Uncertain> {
        let transitions = self.transitions();
        if let Ok(fit) = fit_lifetime(Family::Gamma, &transitions) {
            return Some(fit.mean);
        }
        // Too few for two parameters: their scatter where all were seen, no error of a single one, else one parameter.
        let times: Vec<f64> = transitions
            .iter()
            .filter_map(|one| one.observed())
            .collect();
        if times.len() > 1 && times.len() == transitions.len() {
            let (mean, error) = mean_and_error(&times);
            return Some(Uncertain::normal(mean, error));
        }
        if let ([time], 1) = (times.as_slice(), transitions.len()) {
            return Some(Uncertain::normal(*time, f64::NAN));
        }
        let fit = fit_lifetime(Family::Exponential, &transitions).ok()?;
        Some(fit.mean)
    }

    /// For how long all runs were watched at least.
    fn watched(&self) -> f64 {
        self.runs
            .iter()
            .map(|run| run.time)
            .fold(f64::INFINITY, f64::min)
    }

    fn most_yield(&self) -> bool {
        2 * self.yielded() >= self.runs.len()
    }
}

/// Runs from jammed by strain rate and force.
fn rungs(runs: &[Run]) -> Vec<Rung<'_>> {
    let key = |run: &Run| (run.strain_rate, run.force());
    let mut sorted: Vec<&Run> = runs
        .iter()
        .filter(|run| run.start == Start::Jammed && run.force().is_finite())
        .collect();
    sorted.sort_by(|one, other| {
        key(one)
            .partial_cmp(&key(other))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    sorted
        .chunk_by(|one, other| key(one) == key(other))
        .map(|group| Rung {
            strain_rate: group[0].strain_rate,
            force: group[0].force(),
            runs: group.to_vec(),
        })
        .collect()
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let study = evidence.study("elastic-yielding")?;
    let branches = &evidence.study("elastic-branches")?.runs;
    let lines = ForceLine::all_of(branches);
    let ladder = rungs(&study.runs);
    if ladder.is_empty() {
        return Ok(nothing("No runs from jammed yet."));
    }
    let yielding: Vec<&Rung<'_>> = ladder.iter().filter(|rung| rung.most_yield()).collect();
    let lasting: Vec<&Rung<'_>> = ladder.iter().filter(|rung| rung.yielded() == 0).collect();
    let (gives_way, lasts) = (yielding.last(), lasting.first());
    let verdict = match (gives_way, lasts) {
        (Some(gives_way), Some(lasts)) if gives_way.force < lasts.force => Verdict::Reproduced,
        (None, Some(_)) if lasting.len() == ladder.len() => Verdict::Differs,
        _ => Verdict::Open,
    };
    let periods = longest(study.runs.iter());
    let mut found = finding(
        verdict,
        format!(
            "Within {periods} periods most jams give way {}; {}.",
            gives_way.map_or("at no force".to_owned(), |rung| format!(
                "up to *f*^{{P}} = {} *Yd*^{{2}}",
                rung.force
            )),
            lasts.map_or("some do at every force".to_owned(), |rung| format!(
                "from {} on none does",
                rung.force
            )),
        ),
        together(judged(&lines).into_iter()),
    );
    for rung in &ladder {
        if let Some(mean) = rung.mean() {
            let period = rung.runs[0].period();
            found.quantities.push(Quantity {
                name: format!("time until the jam gives way, *f*^{{P}} = {}", rung.force),
                symbol: "*τ*/*T*".to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(scaled(&mean, 1.0 / period)),
                method: format!(
                    "mean over {} runs, {} of them censored",
                    rung.runs.len(),
                    rung.runs.len() - rung.yielded()
                ),
            });
        }
    }
    found.tables.push(times(
        &ladder,
        "Runs from jammed in which *J*/*J*_{max} fell below 0.3 for good, the mean time until then (likelihood, the others counted \
         as censored) and the median (Kaplan-Meier), in periods.",
    ));
    let all = rungs(branches);
    if !all.is_empty() {
        found.tables.push(times(
            &all,
            "The same at all strain rates, from the runs behind S3. At small strain rates the flow passes 0.3 without a jump.",
        ));
    }
    found.paragraphs.push(format!(
        "The jam counts as given way when the period average of *J*/*J*_{{max}} passes {GIVEN_WAY} downwards for good. A run that keeps \
         its jam to the end is censored there, not dropped: where most are, the mean is that of the fitted distribution and not of the \
         times seen."
    ));
    found.weaknesses.push(format!(
        "A jam that outlasts {periods} periods may give way later: the border between lasting and yielding forces falls with the time of \
         watching."
    ));
    found.figures.extend(figure(study, &ladder)?);
    Ok(found)
}

/// A number in another unit.
fn scaled(number: &Uncertain, factor: f64) -> Uncertain {
    let interval = |interval: peristalsis_analysis::Interval| peristalsis_analysis::Interval {
        lower: interval.lower * factor,
        upper: interval.upper * factor,
    };
    Uncertain {
        value: number.value * factor,
        error: number.error * factor,
        interval_68: interval(number.interval_68),
        interval_95: interval(number.interval_95),
    }
}

fn times(rungs: &[Rung<'_>], caption: &str) -> ReportTable {
    let rows = rungs
        .iter()
        .map(|rung| {
            let rate = rung.strain_rate;
            let median = Survival::new(&rung.transitions()).and_then(|curve| curve.median());
            vec![
                rate_text(rate),
                format!("{}", rung.force),
                format!("{} of {}", rung.yielded(), rung.runs.len()),
                rung.mean().map_or_else(
                    || format!("> {}", number(rung.watched() * rate, 0)),
                    |mean| {
                        if mean.error.is_finite() {
                            with_error(mean.value * rate, mean.error * rate)
                        } else {
                            number(mean.value * rate, 1)
                        }
                    },
                ),
                median.map_or("–".to_owned(), |median| number(median.value * rate, 1)),
            ]
        })
        .collect();
    ReportTable {
        caption: caption.to_owned(),
        head: ["*ε̇*", "*f*^{P}", "gave way", "*τ*/*T*", "median"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }
}

/// J(t) of one run a force, and the time until the jam gives way against the force.
fn figure(study: &StudyResults, ladder: &[Rung<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let mut flow =
        ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateRatio)).y_range(..=1.05);
    let mut drawn = 0;
    for rung in ladder {
        let Some(run) = rung.runs.iter().find(|run| run.replicate == 0) else {
            continue;
        };
        let Some(averages) = study.period_averages(run)? else {
            continue;
        };
        let period: Vec<f64> = (0..averages.len()).map(|k| k as f64 + 0.5).collect();
        if !averages.is_empty() {
            flow = flow.with(Curve::new("", &period, &averages).tint(Tint::Value(rung.force)));
            drawn += 1;
        }
    }
    let mut panels = Vec::new();
    if drawn > 0 {
        panels.push(flow.title("from jammed, one run a force"));
    }
    let mut single: [Vec<f64>; 2] = Default::default();
    let mut mean: [Vec<f64>; 3] = Default::default();
    let mut limits: [Vec<f64>; 2] = Default::default();
    for rung in ladder {
        for transition in rung.transitions() {
            if let Some(time) = transition.observed() {
                single[0].push(rung.force);
                single[1].push(time * rung.strain_rate);
            }
        }
        match rung.mean().filter(|_| rung.most_yield()) {
            Some(time) => {
                mean[0].push(rung.force);
                mean[1].push(time.value * rung.strain_rate);
                mean[2].push(time.error * rung.strain_rate);
            }
            None => {
                limits[0].push(rung.force);
                limits[1].push(rung.watched() * rung.strain_rate);
            }
        }
    }
    let mut times = ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::TransitionPeriod))
        .y_scale(Scale::Logarithmic);
    if !single[0].is_empty() {
        times = times.with(
            Points::new("runs", &single[0], &single[1])
                .series(0)
                .tint(Tint::Grey)
                .open(),
        );
    }
    if !mean[0].is_empty() {
        times = times.with(
            Points::new("mean", &mean[0], &mean[1])
                .y_errors(&mean[2])
                .series(0)
                .joined(),
        );
    }
    if !limits[0].is_empty() {
        times = times.with(
            Points::new("", &limits[0], &limits[1])
                .lower_limits(&vec![true; limits[0].len()])
                .limit_name("most outlast the run")
                .series(1),
        );
    }
    panels.push(times.title("until the jam gives way"));
    let forces = ladder.iter().map(|rung| rung.force);
    let (least, largest) = forces.fold((f64::INFINITY, 0.0_f64), |(least, largest), force| {
        (least.min(force), largest.max(force))
    });
    let mut figure = ChartFigure::grid(2, panels)
        .width(Width::DoubleColumn)
        .description("Flow rate in time from jammed, and the time until the jam gives way against the force.");
    if drawn > 0 {
        figure = figure.colour_scale(ColourScale::new(
            &label(Axis::ForceAmplitude),
            least,
            largest.max(least * 1.01),
        ));
    }
    Ok(Some(ReportFigure {
        name: "yielding".to_owned(),
        caption: "Jammed flow gives way at small forces: *J*/*J*_{max}, averaged over each period, and the time at which it falls \
                  below 0.3; arrows: most runs keep their jam to the end."
            .to_owned(),
        drawing: figure.draw()?,
    }))
}
