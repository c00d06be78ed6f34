//! Q4: length of the tube, and where a jam begins.

use peristalsis_analysis::{
    Family, FractionCrossing, Transition, ensembles_by_width, power_exponent,
};
use peristalsis_figures::ColourScale;
use peristalsis_figures::chart::Field;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q4.md"));

pub(super) const CLAIM: Claim =
    Claim::new("Q4", PROSE, &["length"], examine).varying("width", Q4_NEEDED);

/// A tube of some length.
struct Tube<'a> {
    waves: f64,
    strain_rate: f64,
    branch: Branch<'a>,
    critical: Option<FractionCrossing>,
    /// Mean transition time and relative variance by width, where most runs had a transition.
    times: Vec<(f64, Uncertain, Uncertain)>,
}

impl<'a> Tube<'a> {
    fn of(waves: f64, rows: &[Row<'a>]) -> Option<Self> {
        let branch = Branch::of(rows, Start::Rest, Control::Width);
        let (width, transitions): (Vec<f64>, Vec<Transition>) = rows
            .iter()
            .map(|row| (row.width(), row.transition()))
            .unzip();
        let ensembles = ensembles_by_width(Family::Gamma, &width, &transitions).unwrap_or_default();
        let seen = ensembles
            .iter()
            .filter(|one| one.observed_fraction() >= MOSTLY_SEEN);
        let times = seen.filter_map(|one| {
            let fit = one.fit?;
            Some((one.width, fit.mean, fit.relative_variance()?))
        });
        (!branch.points.is_empty()).then(|| Self {
            waves,
            strain_rate: rows[0].strain_rate(),
            branch,
            critical: crossing(rows),
            times: times.collect(),
        })
    }

    /// Mean relative variance over the widths; `None` without one.
    fn relative_variance(&self) -> Option<Uncertain> {
        let widths = self.times.len() as f64;
        let sum: f64 = self.times.iter().map(|one| one.2.value).sum();
        let squares: f64 = self.times.iter().map(|one| one.2.error.powi(2)).sum();
        (widths > 0.0).then(|| Uncertain::normal(sum / widths, squares.sqrt() / widths))
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.waves.to_string(),
            cell(self.critical.as_ref().map(|found| found.width)),
            cell_of(self.critical.as_ref(), spread),
            cell(self.branch.jump().map(|jump| jump.height)),
            cell(self.relative_variance()),
        ]
    }
}

/// The range of widths over which the fraction falls; where the runs are separated only a bound is known.
fn spread(found: &FractionCrossing) -> String {
    match found.last_all.zip(found.first_none) {
        Some((last, first)) if found.is_separated => format!("< {}", number(first - last, 4)),
        _ => number(found.spread, 4),
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let study = evidence.study("length")?;
    let groups = grouped(study.rows(), |row| row.number("waves"));
    let each = groups.iter().map(|(_, rows)| behind(rows, Row::width));
    let statistics = Statistics::weakest_at_one_rate(each);
    let tubes: Vec<Tube<'_>> = groups
        .iter()
        .filter_map(|(waves, rows)| Tube::of(*waves, rows))
        .collect();
    if tubes.len() < 2 {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let exponents = exponents(&tubes);
    let of_widths: Vec<Uncertain> = exponents.iter().map(|one| one.1).collect();
    let how = match weighted_mean(&of_widths) {
        Some(mean) => PROSE.text("power", values!(exponent = mean)),
        None => PROSE.text("no power", &[]),
    };
    let verdict = Verdict::answered_if(tubes.len() >= LEAST_LENGTHS);
    let summary = PROSE.text("summary", values!(how));
    let mut draft = Draft::of(PROSE);
    for tube in &tubes {
        let width = tube.critical.as_ref().map(|found| found.width);
        draft.quantity("critical width", values!(waves = tube.waves), width);
    }
    for (width, exponent) in &exponents {
        draft.quantity("exponent", values!(width), *exponent);
    }
    draft.table("lengths", &[], tubes.iter().map(Tube::row));
    draft.chart("length", &[], figure(&tubes))?;
    space_time(&mut draft, study)?;
    Ok(draft.concluded(verdict, summary, statistics))
}

/// Exponent of tau in the length at every width that several lengths share.
fn exponents(tubes: &[Tube<'_>]) -> Vec<(f64, Uncertain)> {
    let all = tubes.iter().flat_map(|tube| {
        let times = tube.times.iter();
        times.map(|(width, time, _)| (*width, tube.waves, *time))
    });
    let exponent = |(width, here): (f64, Vec<(f64, f64, Uncertain)>)| {
        let times = here.iter().map(|one| (one.1, one.2));
        let [length, time, error] = columns(times, 0.0);
        let line = power_exponent(&length, &time, &error).ok()?;
        Some((width, slope(&line)))
    };
    grouped(all, |one| one.0)
        .into_iter()
        .filter_map(exponent)
        .collect()
}

fn figure(tubes: &[Tube<'_>]) -> ChartFigure {
    let name = |tube: &Tube<'_>| format!("{} waves", tube.waves);
    let flows = tubes.iter();
    let flows = flows.map(|tube| branch_points(&name(tube), &tube.branch));
    let times = tubes.iter().map(|tube| {
        let times = tube.times.iter();
        let in_periods = times.map(|(width, time, _)| (*width, time.scaled(tube.strain_rate)));
        joined(&name(tube), in_periods)
    });
    let flow = flow_panel().with_all(numbered(flows));
    let times = panel(Axis::Width, Axis::TransitionPeriod)
        .y_scale(Scale::Logarithmic)
        .with_all(numbered(times));
    let timed = tubes.iter().any(|tube| !tube.times.is_empty());
    let panels = [flow].into_iter().chain(timed.then_some(times));
    grid(2, panels)
}

/// The flow of each wave in time, of the longest tube at the widest bottleneck that jammed it.
fn space_time(draft: &mut Draft, study: &StudyResults) -> Result<()> {
    let key = |row: &Row<'_>| (row.number("waves"), row.width());
    let jammed = study
        .rows()
        .into_iter()
        .filter(|row| row.transition().observed().is_some() && row.replicate() == 0);
    let Some((_, widest)) = grouped(jammed, key).pop() else {
        return Ok(());
    };
    let row = widest[0];
    let Some(table) = study.product(&row, files::WAVES)? else {
        return Ok(());
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
    let field = Field::new(
        &values,
        rows,
        (0.0, columns as f64),
        (-0.5, rows as f64 - 0.5),
    );
    let chart = ChartFigure::new(
        panel(Axis::Period, Axis::Wave)
            .y_scale(Scale::Counting)
            .with(field),
    )
    .colour_scale(ColourScale::new(&label(Axis::FlowRateRatio), 0.0, 1.0))
    .panel_height(50.0);
    let (waves, width) = (rows, row.width());
    draft.chart("space-time", values!(waves, width), chart)
}
