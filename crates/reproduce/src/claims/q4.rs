//! Q4: length of the tube, and where a jam begins.

use peristalsis_analysis::{Family, Transition, Uncertain, ensembles_by_width, power_exponent};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Field, Points};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use super::label;
use crate::branches::{Branch, BranchPoint};
use crate::claim::Claim;
use crate::crossing::{behind, crossing, grouped};
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::runs::{Run, Start};
use crate::text::{estimate, number, with_error};

const PROSE: Prose = Prose::new(include_str!("q4.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q4",
    prose: PROSE,
    studies: &["length"],
    examine,
};

const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 8,
    replicates: 10,
    runs: 320,
};

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let study = evidence.study("length")?;
    let groups = grouped(&study.runs, |run| run.waves);
    let found = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(groups.iter().map(|(_, here)| behind(here)))
    };
    let mut flow =
        ChartPanel::new(&label(Axis::Width), &label(Axis::FlowRateRatio)).y_range(-0.05..=1.1);
    let mut times = ChartPanel::new(&label(Axis::Width), &label(Axis::TransitionPeriod))
        .y_scale(Scale::Logarithmic);
    let mut timed = false;
    let mut rows = Vec::new();
    let mut quantities = Vec::new();
    // Waves with width, mean time and its error, to compare lengths at the same width.
    let mut means: Vec<(f64, f64, Uncertain)> = Vec::new();
    for (series, (waves, here)) in groups.iter().enumerate() {
        let branch = Branch::of(here.iter().copied(), Start::Rest);
        if branch.points.is_empty() {
            continue;
        }
        let name = format!("{waves} waves");
        let column = |value: fn(&BranchPoint) -> f64| -> Vec<f64> {
            branch.points.iter().map(value).collect()
        };
        flow = flow.with(
            Points::new(&name, &column(|p| p.width), &column(|p| p.mean))
                .y_errors(&column(|p| if p.error.is_finite() { p.error } else { 0.0 }))
                .series(series)
                .joined(),
        );
        let (width, transitions): (Vec<f64>, Vec<Transition>) =
            here.iter().map(|run| (run.width, run.transition())).unzip();
        let ensembles = ensembles_by_width(Family::Gamma, &width, &transitions).unwrap_or_default();
        let rate = here[0].strain_rate;
        let known: Vec<(f64, Uncertain, f64)> = ensembles
            .iter()
            .filter(|ensemble| ensemble.observed > 2 * ensemble.censored)
            .filter_map(|ensemble| {
                let fit = ensemble.fit?;
                Some((
                    ensemble.width,
                    fit.mean,
                    fit.variance.value / fit.mean.value.powi(2),
                ))
            })
            .collect();
        means.extend(
            known
                .iter()
                .map(|(width, mean, _)| (*waves as f64, *width, *mean)),
        );
        if !known.is_empty() {
            let x: Vec<f64> = known.iter().map(|one| one.0).collect();
            let y: Vec<f64> = known.iter().map(|one| one.1.value * rate).collect();
            let error: Vec<f64> = known.iter().map(|one| one.1.error * rate).collect();
            timed = true;
            times = times.with(
                Points::new(&name, &x, &y)
                    .y_errors(&error)
                    .series(series)
                    .joined(),
            );
        }
        let critical = crossing(here);
        let scatter = known
            .iter()
            .map(|one| one.2)
            .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        rows.push(vec![
            waves.to_string(),
            critical
                .as_ref()
                .map_or("–".to_owned(), |found| estimate(&found.width)),
            critical
                .as_ref()
                .map_or("–".to_owned(), |found| number(found.spread, 4)),
            branch
                .jump()
                .map_or("–".to_owned(), |jump| estimate(&jump.height)),
            number(scatter.0 / scatter.1, 4),
        ]);
        if let Some(critical) = critical {
            quantities.push(Quantity {
                name: format!("critical width, {waves} waves"),
                symbol: "*w*_{c}".to_owned(),
                unit: "d".to_owned(),
                source: None,
                ours: Some(critical.width),
                method: "half of the runs from rest jam".to_owned(),
            });
        }
    }
    if rows.len() < 2 {
        return Ok(Finding::nothing(
            "No runs in tubes of two lengths yet.",
            Statistics::default(),
            &NEEDED,
        ));
    }
    let exponents: Vec<(f64, Uncertain)> = exponents(&means);
    for (width, exponent) in &exponents {
        quantities.push(Quantity {
            name: format!("exponent of the transition time in the length, w = {width} d"),
            symbol: "d ln *τ*/d ln *L*".to_owned(),
            unit: String::new(),
            source: None,
            ours: Some(*exponent),
            method: "weighted line through the logarithms".to_owned(),
        });
    }
    let mean =
        crate::critical::weighted_mean(&exponents.iter().map(|one| one.1).collect::<Vec<_>>());
    let mut finding = Finding::new(
        if rows.len() >= 3 {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        format!(
            "The transition time {}: −1 would be a jam that begins anywhere by chance and spreads, 0 one \
             that the whole tube prepares together.",
            mean.map_or("has no exponent in *L* yet".to_owned(), |mean| format!(
                "goes as *L* to the power {}",
                with_error(mean.value, mean.error)
            ))
        ),
        found,
        &NEEDED,
    );
    finding.quantities = quantities;
    finding.tables.push(ReportTable {
        caption: "Critical width, range of widths over which the fraction of jamming runs falls, height of the jump, mean \
                  relative variance of the transition times, by the number of waves."
            .to_owned(),
        head: ["waves", "*w*_{c}/*d*", "spread/*d*", "jump", "*χ_{τ}*/*τ*^2"].map(str::to_owned).to_vec(),
        rows,
    });
    finding
        .weaknesses
        .push("One strain rate, 0.1, on the fine lattice.".to_owned());
    finding.figures.push(ReportFigure {
        name: "length".to_owned(),
        caption: "Stationary flow and, where it is known, mean transition time in tubes of several lengths."
            .to_owned(),
        drawing: ChartFigure::grid(2, [flow].into_iter().chain(timed.then_some(times)))
            .width(Width::DoubleColumn)
            .description("Flow and transition time for several lengths of the tube.")
            .draw()?,
    });
    finding.figures.extend(space_time(study)?);
    Ok(finding)
}

/// Exponent of tau in the length at every width that several lengths share.
fn exponents(means: &[(f64, f64, Uncertain)]) -> Vec<(f64, Uncertain)> {
    let mut widths: Vec<f64> = means.iter().map(|one| one.1).collect();
    widths.sort_by(f64::total_cmp);
    widths.dedup();
    widths
        .into_iter()
        .filter_map(|width| {
            let here: Vec<&(f64, f64, Uncertain)> =
                means.iter().filter(|one| one.1 == width).collect();
            let length: Vec<f64> = here.iter().map(|one| one.0).collect();
            let time: Vec<f64> = here.iter().map(|one| one.2.value).collect();
            let error: Vec<f64> = here.iter().map(|one| one.2.error).collect();
            let line = power_exponent(&length, &time, &error).ok()?;
            let stretch = line.scale_factor();
            Some((
                width,
                Uncertain::normal(line.slope.value, stretch * line.slope.error),
            ))
        })
        .collect()
}

/// The flow of each wave in time, of the longest tube at the widest bottleneck that jammed it.
fn space_time(study: &StudyResults) -> Result<Option<ReportFigure>, ClaimError> {
    let mut candidates: Vec<&Run> = study
        .runs
        .iter()
        .filter(|run| run.transition().observed().is_some() && run.replicate == 0)
        .collect();
    candidates.sort_by(|one, other| {
        (other.waves, other.width)
            .partial_cmp(&(one.waves, one.width))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let Some(run) = candidates.first() else {
        return Ok(None);
    };
    let Some(table) = study.waves(run)? else {
        return Ok(None);
    };
    let (wave, ratio) = (table.integers("wave")?, table.reals("flow_rate_ratio")?);
    let rows = run.waves as usize;
    let columns = ratio.len() / rows.max(1);
    let mut values = vec![f64::NAN; rows * columns];
    let mut seen = vec![0_usize; rows];
    for (wave, ratio) in wave.iter().zip(ratio) {
        let Some(column) = usize::try_from(*wave).ok().and_then(|wave| {
            let column = seen.get_mut(wave)?;
            *column += 1;
            Some((wave, *column - 1))
        }) else {
            continue;
        };
        if column.1 < columns {
            values[column.0 * columns + column.1] = *ratio;
        }
    }
    Ok(Some(ReportFigure {
        name: "space-time".to_owned(),
        caption: format!(
            "Where a jam begins: *J*/*J*_{{max}} of the grains that travel with each wave, period by period, in a tube of {} \
             waves at *w* = {} *d*.",
            run.waves, run.width
        ),
        drawing: ChartFigure::new(
            ChartPanel::new(&label(Axis::Period), &label(Axis::Wave)).with(Field::new(
                &values,
                rows,
                (0.0, columns as f64),
                (0.0, rows as f64),
            )),
        )
        .description("Flow rate of each wave against time.")
        .colour_scale(ColourScale::new(&label(Axis::FlowRateRatio), 0.0, 1.0))
        .panel_height(50.0)
        .width(Width::DoubleColumn)
        .draw()?,
    }))
}
