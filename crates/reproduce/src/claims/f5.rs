//! F5: the fluctuation of the flow rate across an ensemble.

use peristalsis_analysis::{
    AfterEnd, Bootstrap, Law, MomentPeak, fit_law, jackknife_error, second_moment,
    second_moment_peak,
};
use peristalsis_run::THRESHOLDS;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f5.md"));
const STUDIES: &[&str] = &[
    "divergence-*",
    "near-*",
    "branches-*",
    "second-moment",
    "length",
    "longest-tubes",
];

pub(super) const CLAIM: Claim = Claim::new("F5", PROSE, STUDIES, examine);

/// Resamples for the errors of a peak.
const BOOTSTRAP: Bootstrap = Bootstrap::new(60, 5);
/// Times at which the flows of a width are compared, about.
const TIMES: usize = 60;

/// The second moment at one width.
struct Moment {
    width: f64,
    peak: MomentPeak,
    /// Its variance if half of the runs had passed from one flow to the other, and the others not yet.
    bound: f64,
    /// Integral of chi_J over time, in periods.
    integral: Uncertain,
    /// Time in periods and chi_J.
    course: Vec<(f64, f64)>,
    runs: usize,
    /// Whether most runs had a transition.
    jams: bool,
}

impl Moment {
    /// Of the runs at one width; `None` where these are too few or none had a transition.
    fn of(width: f64, rows: &[Row<'_>], threshold: f64) -> Option<Self> {
        let passed: Vec<Vec<f64>> = rows.iter().map(passages).collect();
        let all = passed.iter().flatten().copied();
        let times = ascending(all.chain([0.0]));
        let times: Vec<f64> = times
            .iter()
            .step_by(times.len().div_ceil(TIMES))
            .copied()
            .collect();
        if rows.len() < LEAST_RUNS_OF_A_MOMENT || times.len() < 3 {
            return None;
        }
        let flows = |passed: &Vec<f64>| -> Vec<f64> {
            let number = |time: &f64| passed.iter().filter(|passed| *passed <= time).count();
            // Between two of the thresholds.
            let flow = |time| (number(time) as f64 + 0.5) / 10.0;
            times.iter().map(flow).collect()
        };
        let series: Vec<Vec<f64>> = passed.iter().map(flows).collect();
        let ends =
            |place: fn(&[f64]) -> Option<&f64>| series.iter().filter_map(move |one| place(one));
        let last = ends(<[f64]>::last).copied().fold(0.0, f64::max);
        let first = ends(<[f64]>::first).copied().fold(1.0, f64::min);
        let moments = second_moment(&series, AfterEnd::Leave).ok()?;
        let without = (0..series.len()).map(|place| {
            let mut rest = series.clone();
            rest.swap_remove(place);
            second_moment(&rest, AfterEnd::Leave).map_or(f64::NAN, |rest| integral(&times, &rest))
        });
        let error = jackknife_error(&without.collect::<Vec<_>>());
        let had = |row: &&Row<'_>| row.transition_at(threshold).observed().is_some();
        let variances = moments.iter().map(|moment| moment.variance);
        Some(Self {
            width,
            peak: second_moment_peak(&series, AfterEnd::Leave, BOOTSTRAP).ok()?,
            bound: (0.5 * (last - first)).powi(2),
            integral: Uncertain::normal(integral(&times, &moments), error),
            course: times.iter().copied().zip(variances).collect(),
            runs: rows.len(),
            jams: 2 * rows.iter().filter(had).count() > rows.len(),
        })
    }

    /// The peak with an error that is not zero.
    fn height(&self) -> Uncertain {
        let peak = self.peak.value;
        Uncertain::normal(peak.value, peak.error.max(LEAST_ERROR_OF_A_MOMENT))
    }

    /// Whether the peak is as high as two flows allow; `None` where its errors do not allow to say, or the flows are too near
    /// one another to be told apart by thresholds 0.1 apart.
    fn is_saturated(&self) -> Option<bool> {
        let (peak, full) = (self.height(), SATURATED * self.bound);
        match self.bound >= LEAST_BOUND {
            true if peak.value >= full => Some(true),
            true if peak.is_below(full) => Some(false),
            _ => None,
        }
    }
}

/// When a run passed each of [`THRESHOLDS`], in periods, as far as it did.
fn passages(row: &Row<'_>) -> Vec<f64> {
    let passages = THRESHOLDS.iter();
    let passages = passages.filter_map(|threshold| row.transition_at(*threshold).observed());
    passages.map(|time| time * row.strain_rate()).collect()
}

fn integral(times: &[f64], moments: &[peristalsis_analysis::SecondMoment]) -> f64 {
    let spans = times.windows(2).zip(moments);
    spans
        .map(|(ends, moment)| (ends[1] - ends[0]) * moment.variance)
        .sum()
}

/// The second moments at one strain rate.
struct Moments {
    strain_rate: f64,
    moments: Vec<Moment>,
    critical: Option<Uncertain>,
}

impl<'a> AtRate<'a> for Moments {
    const ALSO: &'static [&'static str] = &["second-moment"];

    fn of(runs: &Runs<'a>) -> Option<Self> {
        let near = <Line<'_> as AtRate<'_>>::of(runs)?.near;
        let groups = grouped(runs.times.iter().copied(), Row::width).into_iter();
        let moment = |(width, rows): (f64, Vec<Row<'a>>)| Moment::of(width, &rows, runs.threshold);
        let moments: Vec<Moment> = groups.filter_map(moment).collect();
        (!moments.is_empty()).then(|| Self {
            strain_rate: runs.strain_rate,
            critical: near.and_then(|near| near.critical_width()),
            moments,
        })
    }

    fn rows<'b>(runs: &'b Runs<'a>) -> &'b [Row<'a>] {
        &runs.times
    }

    fn statistics(&self) -> Statistics {
        let runs = || self.moments.iter().map(|moment| moment.runs);
        Statistics::of(
            1,
            self.moments.len(),
            runs().min().unwrap_or(0),
            runs().sum(),
        )
    }
}

impl Moments {
    /// The widths below w_c at which most runs jam, ascending.
    fn rising(&self) -> Vec<&Moment> {
        let below = |moment: &&Moment| {
            let critical = self.critical.is_some_and(|w_c| moment.width < w_c.value);
            moment.jams && critical
        };
        self.moments.iter().filter(below).collect()
    }

    /// Exponent of a number of the nearest widths against the distance from w_c.
    fn exponent(&self, widths: usize, number: fn(&Moment) -> Uncertain) -> Option<Uncertain> {
        let rising = self.rising();
        let nearest = &rising[rising.len().saturating_sub(widths)..];
        let numbers = nearest.iter().map(|moment| (moment.width, number(moment)));
        let known = numbers.filter(|(_, one)| one.value > 0.0 && one.error > 0.0);
        let [width, value, error] = columns(known, 0.0);
        let fit = fit_law(Law::Power, &width, &value, &error, Some(self.critical?)).ok()?;
        Some(fit.exponent)
    }

    /// Whether the moment integrated over time, which nothing bounds, grows towards w_c.
    fn grows_without_bound(&self) -> Option<bool> {
        let exponent = self.exponent(WINDOW, |moment| moment.integral)?;
        Some(exponent.is_above(0.0))
    }

    /// Whether the peak still grows next to w_c, and has room to; not, where it is as high as two flows allow.
    fn diverges(&self) -> Option<bool> {
        if self.rising().last()?.is_saturated()? {
            return Some(false);
        }
        let exponent = self.exponent(STRAIGHT, Moment::height)?;
        exponent.is_above(0.0).then_some(true)
    }

    fn row(wall: &str, shown: &Shown<Self>) -> Option<Vec<String>> {
        let rising = shown.found.rising();
        let nearest = rising.last()?;
        let exponent = |widths, number| cell(shown.found.exponent(widths, number));
        Some(vec![
            wall.to_owned(),
            number(shown.strain_rate, 3),
            number(nearest.width, 4),
            nearest.height().to_string(),
            number(nearest.bound, 3),
            exponent(usize::MAX, Moment::height),
            exponent(STRAIGHT, Moment::height),
            exponent(WINDOW, |moment| moment.integral),
        ])
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Moments>::all(evidence)?;
    let (mut draft, mut rows) = (Draft::of(PROSE), Vec::new());
    for one in &walls {
        rows.extend(
            one.tight()
                .filter_map(|shown| Moments::row(&one.name, shown)),
        );
        for shown in one.tight() {
            let (wall, rate) = (&one.name, shown.strain_rate);
            let found = shown.found.exponent(usize::MAX, Moment::height);
            draft.quantity("exponent", values!(wall, rate), found);
            let found = shown.found.exponent(WINDOW, |moment| moment.integral);
            draft.quantity("integral", values!(wall, rate), found);
        }
    }
    let collapses: Vec<Option<Collapsed>> = walls.iter().map(collapsed_of).collect();
    let parts = walls.iter().zip(&collapses);
    let parts = parts.map(|(one, collapsed)| part(one, collapsed.as_ref()));
    let judgement = Judgement::of(parts.collect(), &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let tubes = evidence.rows(&["length", "longest-tubes"])?;
    let lengths = against_length(&tubes);
    // The moment of J itself is that of J/Jmax times the square of the length.
    let length = lengths.map(|power| Uncertain::normal(2.0 + power.value, power.error));
    draft.quantity("length", &[], length);
    let summary = PROSE.text("summary", &[]);
    let saturated = number(100.0 * SATURATED, 0);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(saturated = &saturated));
    let waves = ends(tubes.iter().map(|row| row.number("waves")));
    if let (Some(length), Some((least, most))) = (length, waves) {
        draft.paragraph("extensive", values!(length, least, most));
    }
    draft.table("peaks", &[], rows);
    draft.chart(
        "second-moment-peak",
        values!(saturated),
        against_distance(&walls),
    )?;
    let first = walls.first();
    if let Some((one, shown)) = first.and_then(|one| Some((one, one.all.get(one.all.len() / 2)?))) {
        let wall = &one.name;
        draft.chart("second-moment-in-time", &[], in_time(wall, &shown.found))?;
    }
    let collapses = walls.iter().zip(collapses);
    let collapses = collapses.filter_map(|(one, found)| Some((one.name.clone(), found?)));
    let collapses: Vec<(String, Collapsed)> = collapses.collect();
    for (wall, found) in &collapses {
        let of = format!("peak of the second moment, wall {wall}");
        let exponents = found.quantities(&of, ["*a_{J}*", "*b_{J}*"]);
        draft.finding.quantities.extend(exponents);
    }
    distrust(&mut draft, &collapses);
    Ok(draft.judged(judgement, &summary))
}

fn part(one: &OnWall<Moments>, collapsed: Option<&Collapsed>) -> Part {
    let rates = one.rates(Moments::diverges);
    let integrals = one.rates(Moments::grows_without_bound);
    let nearest = one
        .tight()
        .filter_map(|shown| Some(shown.found.rising().last()?.height()));
    let highest = nearest.map(|height| height.value).fold(0.0, f64::max);
    let exponent = |number: fn(&Moment) -> Uncertain, widths: usize| {
        let exponents = one
            .tight()
            .filter_map(|shown| shown.found.exponent(widths, number));
        cell(weighted_mean(&exponents.collect::<Vec<_>>()))
    };
    let peak = exponent(Moment::height, STRAIGHT);
    let integral = exponent(|moment| moment.integral, WINDOW);
    let highest = number(highest, 2);
    let words = PROSE.text("number", values!(peak, highest));
    let (rates_of_peak, grows) = (rates.in_words(), integrals.count());
    let scaling = said(collapsed.and_then(Collapsed::holds));
    let why = PROSE.text(
        "why",
        values!(rates = rates_of_peak, grows, integral, scaling),
    );
    let all = [
        rates.hold(),
        integrals.hold(),
        collapsed.and_then(Collapsed::holds),
    ];
    let judge = |one: &OnWall<Moments>| {
        let rest = [
            one.rates(Moments::diverges).hold(),
            one.rates(Moments::grows_without_bound).hold(),
        ];
        all_hold_with(&rest, || collapsed_of(one)?.holds())
    };
    one.part_judged(all_hold(&all), judge, words, why)
}

/// Power of the number of waves with which the peak of the moment of J/Jmax goes, over the widths that most runs jam at.
fn against_length(rows: &[Row<'_>]) -> Option<Uncertain> {
    let widths = grouped(rows.iter().copied(), Row::width).into_iter();
    let power = |(width, rows): (f64, Vec<Row<'_>>)| {
        let lengths = grouped(rows, |row| row.number("waves")).into_iter();
        let peak = |(waves, rows): (f64, Vec<Row<'_>>)| {
            let moment = Moment::of(width, &rows, rows[0].number("transition_threshold"))?;
            moment.jams.then(|| (waves, moment.height()))
        };
        fitted_power(lengths.filter_map(peak))
    };
    weighted_mean(&widths.filter_map(power).collect::<Vec<_>>())
}

/// Collapse of the rising sides of the peaks of all strain rates, with free exponents.
fn collapsed_of(one: &OnWall<Moments>) -> Option<Collapsed> {
    let mut curves = Curves::default();
    for shown in one.tight() {
        let rising = shown.found.rising().into_iter();
        let rising = rising.map(|moment| (moment.width, moment.height()));
        curves.add(shown.strain_rate, shown.found.critical?, rising);
    }
    curves.collapse([0.0, 1.0], None)
}

/// Peaks against the distance from w_c, a panel a wall.
fn against_distance(walls: &[OnWall<Moments>]) -> ChartFigure {
    let panel = |one: &OnWall<Moments>| {
        let series = |shown: &Shown<Moments>| {
            let rising = shown.found.rising();
            let critical = shown.found.critical.map_or(f64::NAN, |w_c| w_c.value);
            let peaks = rising.iter().filter(|moment| moment.height().value > 0.0);
            let peaks = peaks.map(|moment| (critical - moment.width, moment.height()));
            (shown.strain_rate, points("", peaks))
        };
        let full = |shown: &Shown<Moments>| {
            let critical = shown.found.critical?.value;
            let rising = shown.found.rising().into_iter();
            let full = rising.map(|one| (critical - one.width, SATURATED * one.bound));
            let (distance, full): (Vec<f64>, Vec<f64>) = full.filter(|one| one.1 > 0.0).unzip();
            let curve = Curve::new("", &distance, &full).tint(Tint::Value(shown.strain_rate));
            (distance.len() > 1).then(|| curve.pattern(Pattern::Dotted).weight(0.7))
        };
        ChartPanel::new(
            "distance, (*w*_{c} − *w*)/*d*",
            "peak of the second moment, *χ_{J}*",
        )
        .x_scale(Scale::Logarithmic)
        .y_scale(Scale::Logarithmic)
        .title(&one.name)
        .with_all(one.tight().filter_map(full))
        .with_all(coloured(one.tight().map(series)))
    };
    let rates = walls
        .iter()
        .flat_map(|one| &one.all)
        .map(|one| one.strain_rate);
    grid(2, walls.iter().map(panel))
        .share_y()
        .colour_scale(rate_colours(rates))
}

/// The times span orders of magnitude; what happens before the first transition is nothing.
fn in_time(wall: &str, found: &Moments) -> ChartFigure {
    let courses = found.rising().into_iter().map(|moment| {
        let after = moment.course.iter().copied().filter(|one| one.0 > 0.0);
        let (time, value): (Vec<f64>, Vec<f64>) = after.unzip();
        Curve::new("", &time, &value)
            .stepped()
            .tint(Tint::Value(moment.width))
    });
    let panel = panel(Axis::Period, Axis::FlowRateMoment)
        .x_scale(Scale::Logarithmic)
        .title(&format!("{wall}, *ε̇* = {}", found.strain_rate))
        .with_all(courses);
    let widths = found.rising().into_iter().map(|moment| moment.width);
    let otherwise = found.moments.first().map_or(2.5, |moment| moment.width);
    let scale = colours(&label(Axis::Width), widths, (otherwise, otherwise + 0.01));
    ChartFigure::new(panel).colour_scale(scale)
}
