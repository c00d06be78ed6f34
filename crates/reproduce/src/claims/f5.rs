//! F5: the fluctuation of the flow rate across an ensemble.

use peristalsis_analysis::{
    AfterEnd, Bootstrap, Curve as Scaled, CurvePoint, Interval, Law, MomentPeak, Uncertain,
    fit_law, second_moment, second_moment_peak,
};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use super::{label, rate_colours};
use crate::claim::Claim;
use crate::collapse::{Collapsed, collapse_curves, figure as collapse_figure};
use crate::critical::strain_rates;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::text::{estimate, number, with_error};

const PROSE: Prose = Prose::new(include_str!("f5.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F5",
    prose: PROSE,
    studies: &["second-moment"],
    examine,
};

/// Resamples for the errors of a peak.
const RESAMPLES: usize = 200;
/// Periods whose mean stands for a run after its end.
const HELD: usize = 5;
/// Runs at a width below which there is no variance.
const LEAST_RUNS: usize = 4;

/// Houdayer and Hartmann's S up to which curves agree within their errors.
const AGREED: f64 = 2.0;
/// Error below which that of a peak, which is resampled, is not believed.
const LEAST_ERROR: f64 = 1e-4;

/// The peak of chi_J at one width.
struct Peak {
    width: f64,
    peak: MomentPeak,
    runs: usize,
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
    /// Midway between the last width at which most runs jammed and the next one.
    fn critical_width(&self) -> Option<Uncertain> {
        let beyond = self
            .peaks
            .iter()
            .map(|peak| peak.width)
            .find(|width| *width > self.last)?;
        let critical = Uncertain {
            value: 0.5 * (self.last + beyond),
            error: 0.3 * (beyond - self.last),
            interval_68: Interval {
                lower: self.last,
                upper: beyond,
            },
            interval_95: Interval {
                lower: self.last,
                upper: beyond,
            },
        };
        Some(critical)
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let study = evidence.study("second-moment")?;
    let lines: Vec<Line> = strain_rates(study.runs.iter())
        .into_iter()
        .map(|rate| line(study, rate))
        .collect::<Result<_, _>>()?;
    let lines: Vec<Line> = lines
        .into_iter()
        .filter(|line| line.peaks.len() > 1)
        .collect();
    let statistics = Statistics {
        strain_rates: lines.len(),
        widths: lines.iter().map(|line| line.peaks.len()).min().unwrap_or(0),
        replicates: lines
            .iter()
            .flat_map(|line| line.peaks.iter().map(|peak| peak.runs))
            .min()
            .unwrap_or(0),
        runs: study.runs.len(),
    };
    if lines.is_empty() {
        return Ok(Finding::nothing(
            "Time series of too few runs are here (rows that were imported have none).",
            statistics,
            &needed,
        ));
    }
    let mut rows = Vec::new();
    let mut quantities = Vec::new();
    let mut bounded = 0;
    for line in &lines {
        let Some(highest) = line
            .peaks
            .iter()
            .max_by(|one, other| one.peak.value.value.total_cmp(&other.peak.value.value))
        else {
            continue;
        };
        let beyond = line.peaks.iter().filter(|peak| peak.width > line.last);
        let beyond = beyond
            .map(|peak| peak.peak.value.value)
            .fold(f64::NAN, f64::max);
        // 1/4 is the variance of a number that is 0 or 1 with equal probability.
        bounded += usize::from(highest.peak.value.value < 0.3);
        quantities.push(Quantity {
            name: format!(
                "largest peak of the second moment, strain rate {}",
                line.strain_rate
            ),
            symbol: "max *χ_{J}*".to_owned(),
            unit: String::new(),
            source: None,
            ours: Some(highest.peak.value),
            method: format!("at w = {} d, resampled runs", highest.width),
        });
        quantities.extend(exponent(line));
        rows.push(vec![
            number(line.strain_rate, 3),
            number(line.last, 3),
            number(highest.width, 3),
            estimate(&highest.peak.value),
            with_error(highest.peak.index.value, highest.peak.index.error),
            number(beyond, 3),
        ]);
    }
    let scaling = scaling_relation(&lines);
    let in_words = scaling.as_ref().map_or_else(
        || "too few strain rates to look for a scaling relation".to_owned(),
        |found| {
            format!(
                "scaled, the peaks of all strain rates {}: {}",
                match found.quality() {
                    quality if quality <= AGREED => "fall on one curve within their errors",
                    _ if found.holds() =>
                        "come near one curve, but differ by more than their errors",
                    _ => "do not fall on one curve",
                },
                found.in_words()
            )
        },
    );
    let mut finding = Finding::new(
        if bounded == lines.len() {
            Verdict::Differs
        } else {
            Verdict::Open
        },
        format!(
            "*χ_{{J}}* peaks next to *w*_{{c}} and stays below 0.3 at {bounded} of {} strain rates: where each run is slow or \
             fast it cannot exceed 1/4 by much, so that in this sense nothing diverges; {in_words}.",
            lines.len()
        ),
        statistics,
        &needed,
    );
    finding.quantities = quantities;
    finding.tables.push(ReportTable {
        caption: "Largest peak of *χ_{J}* over widths: last width at which most runs jammed, width, height and time of the \
                  peak in periods, and the highest beyond."
            .to_owned(),
        head: ["*ε̇*", "last jamming *w*", "*w* of the peak", "max *χ_{J}*", "*t*/*T*", "beyond"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    finding.paragraphs.push(
        "*j* of a run is averaged over each period; a run that was ended 120 periods after its transition stays at its last \
         value. *χ_{J}*(*t*) is taken over the runs at one width (without bias), its peak over *t* with errors from resampled \
         runs. A peak of 1/4 means that half of the runs have jammed at that time: it measures how much transition times \
         scatter in comparison with how long the jump itself takes. The exponent is that of the height of the peak against \
         (*w*_{c} − *w*), as far as it rises. The scaling relation is that of F3 and F4 with free exponents: the peak times \
         *ε̇*^{*a*} against (*w*_{c} − *w*)/*ε̇*^{*b*}, with *w*_{c} midway between the last width that jams and the next."
            .to_owned(),
    );
    if let Some(found) = scaling {
        let of = "peak of the second moment";
        finding
            .quantities
            .extend(found.quantities(of, ["*a_{J}*", "*b_{J}*"]));
        finding.tables.extend(found.tables(of));
        finding.figures.push(collapse_figure(
            &[("fine".to_owned(), found)],
            "collapse-of-second-moments",
            ["", ""],
            "max_{*t*} *χ_{J}ε̇*^{*a*}",
            -1.0,
            "Peaks of the second moment of all strain rates, scaled with the exponents that collapse them best; dashed: \
             slope −1.",
        )?);
    }
    finding.weaknesses.push(
        "The abstract does not say whether the moment is that of *J*, of *J*/*J*_{max} or of *J* in time; a moment of *J* \
         itself, which is extensive, may well grow without bound in longer tubes."
            .to_owned(),
    );
    finding.figures.extend(figures(&lines)?);
    Ok(finding)
}

fn line(study: &StudyResults, strain_rate: f64) -> Result<Line, ClaimError> {
    let mut here: Vec<_> = study
        .runs
        .iter()
        .filter(|run| run.strain_rate == strain_rate)
        .collect();
    here.sort_by(|one, other| one.width.total_cmp(&other.width));
    let mut peaks = Vec::new();
    let mut moments = Vec::new();
    let mut last = f64::NAN;
    for group in here.chunk_by(|one, other| one.width == other.width) {
        let width = group[0].width;
        let jammed = group
            .iter()
            .filter(|run| run.transition().observed().is_some())
            .count();
        if 2 * jammed > group.len() {
            last = width;
        }
        let mut series = Vec::new();
        for run in group {
            series.extend(
                study
                    .period_averages(run)?
                    .filter(|averages| averages.len() > HELD),
            );
        }
        if series.len() < LEAST_RUNS {
            continue;
        }
        let after_end = AfterEnd::Hold { samples: HELD };
        let bootstrap = Bootstrap {
            resamples: RESAMPLES,
            seed: 5,
        };
        if let (Ok(peak), Ok(moment)) = (
            second_moment_peak(&series, after_end, bootstrap),
            second_moment(&series, after_end),
        ) {
            peaks.push(Peak {
                width,
                peak,
                runs: series.len(),
            });
            moments.push((width, moment.iter().map(|moment| moment.variance).collect()));
        }
    }
    Ok(Line {
        strain_rate,
        peaks,
        moments,
        last,
    })
}

/// Collapse of the rising sides of the peaks of all strain rates, with free exponents.
fn scaling_relation(lines: &[Line]) -> Option<Collapsed> {
    let mut critical = Vec::new();
    let mut curves = Vec::new();
    for line in lines {
        let Some(width) = line.critical_width() else {
            continue;
        };
        let points: Vec<CurvePoint> = line
            .peaks
            .iter()
            .filter(|peak| peak.width <= line.last && peak.peak.value.value > 0.0)
            .map(|peak| {
                let found = peak.peak.value;
                let steepness = found.value / (width.value - peak.width);
                CurvePoint {
                    x: peak.width,
                    y: found.value,
                    error: found.error.max(LEAST_ERROR).hypot(steepness * width.error),
                }
            })
            .collect();
        if points.len() > 2 {
            critical.push(width.value);
            curves.push(Scaled {
                parameter: line.strain_rate,
                points,
            });
        }
    }
    collapse_curves(critical, curves, [0.0, 1.0], None)
}

/// Exponent of the rise of the peak toward the critical width, where it can be fitted.
fn exponent(line: &Line) -> Option<Quantity> {
    let rising: Vec<&Peak> = line
        .peaks
        .iter()
        .filter(|peak| peak.width <= line.last)
        .collect();
    let width: Vec<f64> = rising.iter().map(|peak| peak.width).collect();
    let value: Vec<f64> = rising.iter().map(|peak| peak.peak.value.value).collect();
    let error: Vec<f64> = rising
        .iter()
        .map(|peak| peak.peak.value.error.max(LEAST_ERROR))
        .collect();
    let critical = line.critical_width()?;
    let fit = fit_law(Law::Power, &width, &value, &error, Some(critical)).ok()?;
    Some(Quantity {
        name: format!(
            "exponent of the peak of the second moment, strain rate {}",
            line.strain_rate
        ),
        symbol: "*γ_{J}*".to_owned(),
        unit: String::new(),
        source: None,
        ours: Some(fit.exponent),
        method: format!("power law through {} widths below w_c", rising.len()),
    })
}

fn figures(lines: &[Line]) -> Result<Vec<ReportFigure>, ClaimError> {
    let mut against_width =
        ChartPanel::new(&label(Axis::Width), "peak of *χ_{J}*").y_scale(Scale::Logarithmic);
    for (place, line) in lines.iter().enumerate() {
        let known: Vec<&Peak> = line
            .peaks
            .iter()
            .filter(|peak| peak.peak.value.value > 0.0)
            .collect();
        let width: Vec<f64> = known.iter().map(|peak| peak.width).collect();
        let value: Vec<f64> = known.iter().map(|peak| peak.peak.value.value).collect();
        let error: Vec<f64> = known.iter().map(|peak| peak.peak.value.error).collect();
        against_width = against_width.with(
            Points::new("", &width, &value)
                .y_errors(&error)
                .series(place)
                .tint(Tint::Value(line.strain_rate))
                .joined(),
        );
    }
    let peaks = ReportFigure {
        name: "second-moment-peak".to_owned(),
        caption: "Peak over time of the ensemble's second moment of *J*/*J*_{max} against the width of the bottleneck.".to_owned(),
        drawing: ChartFigure::new(against_width)
            .colour_scale(rate_colours(lines.iter().map(|line| line.strain_rate)))
            .description("Peak of the second moment against width for several strain rates.")
            .draw()?,
    };
    let mut figures = vec![peaks];
    if let Some(line) = lines.get(lines.len() / 2) {
        let mut panel = ChartPanel::new(&label(Axis::Period), &label(Axis::FlowRateMoment))
            .title(&format!("*ε̇* = {}", line.strain_rate));
        for (width, moment) in &line.moments {
            let period: Vec<f64> = (0..moment.len())
                .map(|number| number as f64 + 0.5)
                .collect();
            panel = panel.with(Curve::new("", &period, moment).tint(Tint::Value(*width)));
        }
        let least = line
            .moments
            .iter()
            .map(|one| one.0)
            .fold(f64::INFINITY, f64::min);
        let largest = line.moments.iter().map(|one| one.0).fold(0.0, f64::max);
        figures.push(ReportFigure {
            name: "second-moment-in-time".to_owned(),
            caption:
                "Second moment of *J*/*J*_{max} across the ensemble in time, for several widths."
                    .to_owned(),
            drawing: ChartFigure::new(panel)
                .width(Width::SingleColumn)
                .colour_scale(ColourScale::new(&label(Axis::Width), least, largest))
                .description("Second moment in time, one peak a width.")
                .draw()?,
        });
    }
    Ok(figures)
}
