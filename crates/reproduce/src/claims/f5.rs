//! F5: the fluctuation of the flow rate across an ensemble.

use peristalsis_analysis::{
    AfterEnd, Bootstrap, Interval, Law, MomentPeak, fit_law, second_moment, second_moment_peak,
};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f5.md"));

pub(super) const CLAIM: Claim = Claim::new("F5", PROSE, &["second-moment"], examine);

/// Resamples for the errors of a peak.
const BOOTSTRAP: Bootstrap = Bootstrap::new(200, 5);
/// Periods whose mean stands for a run after its end.
const HELD: usize = 5;

/// The peak of chi_J at one width.
struct Peak {
    width: f64,
    peak: MomentPeak,
    runs: usize,
}

impl Peak {
    fn height(&self) -> Uncertain {
        self.peak.value
    }
}

/// One strain rate.
struct Line {
    strain_rate: f64,
    peaks: Vec<Peak>,
    /// chi_J(t) by width.
    moments: Vec<(f64, Vec<f64>)>,
    /// Largest width at which most runs had a transition.
    last: f64,
}

impl Line {
    fn of(study: &StudyResults, strain_rate: f64, rows: Vec<Row<'_>>) -> Result<Self> {
        let (mut peaks, mut moments) = (Vec::new(), Vec::new());
        let mut last = f64::NAN;
        for (width, group) in grouped(rows, Row::width) {
            let has_jammed = |row: &&Row<'_>| row.transition().observed().is_some();
            if 2 * group.iter().filter(has_jammed).count() > group.len() {
                last = width;
            }
            let mut series = Vec::new();
            for row in &group {
                let averages = study.period_averages(row)?;
                series.extend(averages.filter(|averages| averages.len() > HELD));
            }
            if series.len() < LEAST_RUNS_OF_A_MOMENT {
                continue;
            }
            let after_end = AfterEnd::Hold { samples: HELD };
            if let (Ok(peak), Ok(moment)) = (
                second_moment_peak(&series, after_end, BOOTSTRAP),
                second_moment(&series, after_end),
            ) {
                let runs = series.len();
                peaks.push(Peak { width, peak, runs });
                moments.push((width, moment.iter().map(|moment| moment.variance).collect()));
            }
        }
        Ok(Self {
            strain_rate,
            peaks,
            moments,
            last,
        })
    }

    /// Midway between the last width at which most runs jammed and the next one.
    fn critical_width(&self) -> Option<Uncertain> {
        let mut widths = self.peaks.iter().map(|peak| peak.width);
        let beyond = widths.find(|width| *width > self.last)?;
        let interval = Interval {
            lower: self.last,
            upper: beyond,
        };
        Some(Uncertain {
            value: 0.5 * (self.last + beyond),
            error: 0.3 * (beyond - self.last),
            interval_68: interval,
            interval_95: interval,
        })
    }

    /// Width and height of the peaks at the widths at which most runs jam.
    fn rising(&self) -> impl Iterator<Item = (f64, Uncertain)> {
        let rising = self.peaks.iter().filter(|peak| peak.width <= self.last);
        rising.map(|peak| (peak.width, peak.height()))
    }

    fn highest(&self) -> Option<&Peak> {
        let height = |peak: &Peak| peak.height().value;
        self.peaks
            .iter()
            .max_by(|one, other| height(one).total_cmp(&height(other)))
    }

    fn row(&self, highest: &Peak) -> Vec<String> {
        let beyond = self.peaks.iter().filter(|peak| peak.width > self.last);
        let beyond = beyond
            .map(|peak| peak.height().value)
            .fold(f64::NAN, f64::max);
        vec![
            number(self.strain_rate, 3),
            number(self.last, 3),
            number(highest.width, 3),
            highest.height().to_string(),
            with_error(highest.peak.index.value, highest.peak.index.error),
            number(beyond, 3),
        ]
    }

    /// Exponent of the rise of the peak toward the critical width, where it can be fitted, and the number of widths.
    fn exponent(&self) -> Option<(Uncertain, usize)> {
        let [width, value, error] = columns(self.rising(), LEAST_ERROR_OF_A_MOMENT);
        let critical = self.critical_width()?;
        let fit = fit_law(Law::Power, &width, &value, &error, Some(critical)).ok()?;
        Some((fit.exponent, width.len()))
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let study = evidence.study("second-moment")?;
    let mut lines = Vec::new();
    for (rate, rows) in by_strain_rate(study.rows()) {
        lines.push(Line::of(study, rate, rows)?);
    }
    lines.retain(|line| line.peaks.len() > 1);
    let peaks = || lines.iter().flat_map(|line| &line.peaks);
    let statistics = Statistics {
        strain_rates: lines.len(),
        widths: lines.iter().map(|line| line.peaks.len()).min().unwrap_or(0),
        replicates: peaks().map(|peak| peak.runs).min().unwrap_or(0),
        runs: study.rows().len(),
    };
    if lines.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let (mut draft, mut rows, mut bounded) = (Draft::of(PROSE), Vec::new(), 0);
    for line in &lines {
        let Some(highest) = line.highest() else {
            continue;
        };
        bounded += usize::from(highest.height().value < BOUNDED_MOMENT);
        let (rate, width) = (line.strain_rate, highest.width);
        let height = highest.height();
        draft.quantity("peak", values!(rate, width), height);
        if let Some((exponent, widths)) = line.exponent() {
            draft.quantity("exponent", values!(rate, widths), exponent);
        }
        rows.push(line.row(highest));
    }
    let scaling = scaling_relation(&lines);
    let in_words = match &scaling {
        None => PROSE.text("no scaling", &[]),
        Some(found) => {
            let how = if found.quality() <= SAME_CURVE {
                "fall on one curve within their errors"
            } else if found.holds() {
                "come near one curve, but differ by more than their errors"
            } else {
                "do not fall on one curve"
            };
            PROSE.text("scaling", values!(how, exponents = found.in_words()))
        }
    };
    let verdict = match bounded == lines.len() {
        true => Verdict::Differs,
        false => Verdict::Open,
    };
    let all = lines.len();
    let summary = PROSE.text("summary", values!(bounded, all, scaling = in_words));
    draft.table("peaks", &[], rows);
    if let Some(found) = scaling {
        let of = "peak of the second moment";
        let exponents = found.quantities(of, ["*a_{J}*", "*b_{J}*"]);
        draft.finding.quantities.extend(exponents);
        draft.finding.tables.push(found.table(of));
        let found = [("fine".to_owned(), found)];
        let chart = chart(&found, ["", ""], "max_{*t*} *χ_{J}ε̇*^{*a*}", -1.0);
        draft.chart("collapse-of-second-moments", &[], chart)?;
    }
    draft.chart("second-moment-peak", &[], against_width(&lines))?;
    if let Some(line) = lines.get(lines.len() / 2) {
        draft.chart("second-moment-in-time", &[], in_time(line))?;
    }
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}

/// Collapse of the rising sides of the peaks of all strain rates, with free exponents.
fn scaling_relation(lines: &[Line]) -> Option<Collapsed> {
    let mut curves = Curves::default();
    for line in lines {
        if let Some(width) = line.critical_width() {
            let rising = line.rising().map(|(x, height)| {
                let error = height.error.max(LEAST_ERROR_OF_A_MOMENT);
                (x, Uncertain::normal(height.value, error))
            });
            curves.add(line.strain_rate, &width, 1.0, rising);
        }
    }
    curves.collapse([0.0, 1.0], None)
}

fn against_width(lines: &[Line]) -> ChartFigure {
    let series = |line: &Line| {
        let known = line.peaks.iter().filter(|peak| peak.height().value > 0.0);
        let peaks = known.map(|peak| (peak.width, peak.height()));
        (line.strain_rate, joined("", peaks))
    };
    let panel = ChartPanel::new(&label(Axis::Width), "peak of *χ_{J}*")
        .y_scale(Scale::Logarithmic)
        .with_all(coloured(lines.iter().map(series)));
    let rates = lines.iter().map(|line| line.strain_rate);
    ChartFigure::new(panel).colour_scale(rate_colours(rates))
}

fn in_time(line: &Line) -> ChartFigure {
    let courses = line.moments.iter();
    let panel = panel(Axis::Period, Axis::FlowRateMoment)
        .title(&format!("*ε̇* = {}", line.strain_rate))
        .with_all(courses.map(|(width, moment)| course(*width, moment)));
    let widths = line.moments.iter().map(|one| one.0);
    let scale = colours(&label(Axis::Width), widths, (line.last, line.last));
    ChartFigure::new(panel).colour_scale(scale)
}
