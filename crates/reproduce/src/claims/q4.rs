//! Q4: length of the tube, and where a jam begins.

use peristalsis_analysis::{
    Family, FractionCrossing, Transition, Uncertain, ensembles_by_width, power_exponent,
};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Field};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use crate::branch::{Branch, Control};
use crate::claim::Claim;
use crate::critical::{crossing, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::exhibit::{branch_points, cell, cell_of, flow_panel, label, points};
use crate::finding::{Finding, ReportFigure, Statistics, Verdict};
use crate::prose::Prose;
use crate::row::{Row, Start, behind, grouped};
use crate::text::number;
use crate::thresholds::{LEAST_LENGTHS, Q4_NEEDED};

const PROSE: Prose = Prose::new(include_str!("q4.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q4",
    prose: PROSE,
    studies: &["length"],
    examine,
};

/// A tube of some length.
struct Tube<'a> {
    waves: f64,
    strain_rate: f64,
    branch: Branch<'a>,
    critical: Option<FractionCrossing>,
    /// Mean transition time and relative variance by width, where most runs had a transition.
    times: Vec<(f64, Uncertain, f64)>,
}

impl<'a> Tube<'a> {
    fn of(waves: f64, rows: &[Row<'a>]) -> Option<Self> {
        let branch = Branch::of(rows.iter().copied(), Start::Rest, Control::Width);
        let (width, transitions): (Vec<f64>, Vec<Transition>) = rows
            .iter()
            .map(|row| (row.width(), row.transition()))
            .unzip();
        let ensembles = ensembles_by_width(Family::Gamma, &width, &transitions).unwrap_or_default();
        let seen = ensembles
            .iter()
            .filter(|one| one.observed > 2 * one.censored);
        let times = seen.filter_map(|one| {
            let fit = one.fit?;
            let relative = fit.variance.value / fit.mean.value.powi(2);
            Some((one.width, fit.mean, relative))
        });
        (!branch.points.is_empty()).then(|| Self {
            waves,
            strain_rate: rows[0].strain_rate(),
            branch,
            critical: crossing(rows),
            times: times.collect(),
        })
    }

    fn row(&self) -> Vec<String> {
        let sum: f64 = self.times.iter().map(|one| one.2).sum();
        vec![
            self.waves.to_string(),
            cell(self.critical.as_ref().map(|found| found.width)),
            cell_of(self.critical.as_ref(), |found| number(found.spread, 4)),
            cell(self.branch.jump().map(|jump| jump.height)),
            number(sum / self.times.len() as f64, 4),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let study = evidence.study("length")?;
    let groups = grouped(study.rows(), |row| row.number("waves"));
    let statistics = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(groups.iter().map(|(_, rows)| behind(rows, Row::width)))
    };
    let tubes: Vec<Tube<'_>> = groups
        .iter()
        .filter_map(|(waves, rows)| Tube::of(*waves, rows))
        .collect();
    if tubes.len() < 2 {
        let (nothing, none) = (PROSE.text("nothing", &[]), Statistics::default());
        return Ok(Finding::nothing(&nothing, none, &Q4_NEEDED));
    }
    let exponents = exponents(&tubes);
    let of_widths: Vec<Uncertain> = exponents.iter().map(|one| one.1).collect();
    let how = match weighted_mean(&of_widths) {
        Some(mean) => PROSE.text("power", &[("exponent", &mean)]),
        None => PROSE.text("no power", &[]),
    };
    let verdict = match tubes.len() >= LEAST_LENGTHS {
        true => Verdict::Answered,
        false => Verdict::Open,
    };
    let summary = PROSE.text("summary", &[("how", &how)]);
    let mut finding = Finding::new(verdict, summary, statistics, &Q4_NEEDED);
    for tube in &tubes {
        let width = tube.critical.as_ref().map(|found| found.width);
        finding.quantities.extend(
            width.map(|width| PROSE.quantity("critical width", &[("waves", &tube.waves)], width)),
        );
    }
    for (width, exponent) in &exponents {
        finding
            .quantities
            .push(PROSE.quantity("exponent", &[("width", width)], *exponent));
    }
    let rows = tubes.iter().map(Tube::row).collect();
    finding.tables.push(PROSE.table("lengths", &[], rows));
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    finding.figures.push(figure(&tubes)?);
    finding.figures.extend(space_time(study)?);
    Ok(finding)
}

/// Exponent of tau in the length at every width that several lengths share.
fn exponents(tubes: &[Tube<'_>]) -> Vec<(f64, Uncertain)> {
    let all = tubes.iter().flat_map(|tube| {
        let times = tube.times.iter();
        times.map(|(width, time, _)| (*width, tube.waves, *time))
    });
    let exponent = |(width, here): (f64, Vec<(f64, f64, Uncertain)>)| {
        let length: Vec<f64> = here.iter().map(|one| one.1).collect();
        let time: Vec<f64> = here.iter().map(|one| one.2.value).collect();
        let error: Vec<f64> = here.iter().map(|one| one.2.error).collect();
        let line = power_exponent(&length, &time, &error).ok()?;
        let error = line.scale_factor() * line.slope.error;
        Some((width, Uncertain::normal(line.slope.value, error)))
    };
    grouped(all, |one| one.0)
        .into_iter()
        .filter_map(exponent)
        .collect()
}

fn figure(tubes: &[Tube<'_>]) -> Result<ReportFigure, ClaimError> {
    let mut flow = flow_panel();
    let mut times = ChartPanel::new(&label(Axis::Width), &label(Axis::TransitionPeriod))
        .y_scale(Scale::Logarithmic);
    for (series, tube) in tubes.iter().enumerate() {
        let name = format!("{} waves", tube.waves);
        let points_of_flow = branch_points(&name, &tube.branch);
        flow = flow.with_all(points_of_flow.map(|points| points.series(series)));
        let rate = tube.strain_rate;
        let in_periods = tube.times.iter().map(|(width, time, _)| {
            let time = Uncertain::normal(time.value * rate, time.error * rate);
            (*width, time)
        });
        let points_of_times = points(&name, in_periods);
        times = times.with_all(points_of_times.map(|points| points.series(series).joined()));
    }
    let timed = tubes.iter().any(|tube| !tube.times.is_empty());
    let drawing = ChartFigure::grid(2, [flow].into_iter().chain(timed.then_some(times)))
        .width(Width::DoubleColumn)
        .description("Flow and transition time for several lengths of the tube.")
        .draw()?;
    Ok(PROSE.figure("length", &[], drawing))
}

/// The flow of each wave in time, of the longest tube at the widest bottleneck that jammed it.
fn space_time(study: &StudyResults) -> Result<Option<ReportFigure>, ClaimError> {
    let key = |row: &Row<'_>| (row.number("waves"), row.width());
    let jammed = study
        .rows()
        .into_iter()
        .filter(|row| row.transition().observed().is_some() && row.replicate() == 0);
    let Some((_, widest)) = grouped(jammed, key).pop() else {
        return Ok(None);
    };
    let row = widest[0];
    let Some(table) = study.waves(&row)? else {
        return Ok(None);
    };
    let (wave, ratio) = (table.integers("wave")?, table.reals("flow_rate_ratio")?);
    let rows = row.number("waves") as usize;
    let columns = ratio.len() / rows.max(1);
    let mut values = vec![f64::NAN; rows * columns];
    let mut seen = vec![0_usize; rows];
    for (wave, ratio) in wave.iter().zip(ratio) {
        let Ok(wave) = usize::try_from(*wave) else {
            continue;
        };
        if let Some(column) = seen.get_mut(wave).filter(|column| **column < columns) {
            values[wave * columns + *column] = *ratio;
            *column += 1;
        }
    }
    let field = Field::new(&values, rows, (0.0, columns as f64), (0.0, rows as f64));
    let panel = ChartPanel::new(&label(Axis::Period), &label(Axis::Wave)).with(field);
    let drawing = ChartFigure::new(panel)
        .description("Flow rate of each wave against time.")
        .colour_scale(ColourScale::new(&label(Axis::FlowRateRatio), 0.0, 1.0))
        .panel_height(50.0)
        .width(Width::DoubleColumn)
        .draw()?;
    Ok(Some(PROSE.figure(
        "space-time",
        &[("waves", &rows), ("width", &row.width())],
        drawing,
    )))
}
