//! F2: how the mean transition time diverges.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Tint};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::{
    LATTICES, MOST_ESCAPED, fitted, fitted_curve, judge, label, lines_of, of_exponents,
    rate_colours, statistics,
};
use crate::claim::Claim;
use crate::critical::{Line, WINDOW};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::text::{estimate, interval, number};

const PROSE: Prose = Prose::new(include_str!("f2.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F2",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// What the source says.
const EXPONENT: f64 = 1.0;
/// Other thresholds that the fits are made with, relative to the one midway.
const SHIFTS: [f64; 3] = [-0.1, 0.0, 0.1];

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut parts = Vec::new();
    let mut quantities = Vec::new();
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    let mut all_rates = Vec::new();
    let mut means = Vec::new();
    let mut sensitivity: Vec<Vec<String>> = Vec::new();
    for study in LATTICES {
        let lines = lines_of(evidence, study)?;
        let fits = fitted(&lines);
        let used: Vec<&Line<'_>> = fits.iter().map(|(line, _)| *line).collect();
        all_rates.extend(lines.iter().map(|line| line.strain_rate));
        let name = study.0.name();
        panels.extend(panel(&lines).map(|panel| panel.title(&format!("{name} lattice"))));
        let exponents: Vec<_> = fits.iter().map(|(_, fit)| fit.exponent).collect();
        let (part, mean) = of_exponents(
            &name,
            &exponents,
            EXPONENT,
            ["mean transition time", "*α*"],
            statistics(&used),
        );
        parts.push(part);
        if let Some((mean, quantity)) = mean {
            means.push((name.clone(), mean));
            quantities.push(quantity);
        }
        for (line, fit) in &fits {
            let windows = line.fits();
            let range = windows.iter().map(|fit| fit.exponent.value).fold(
                (f64::INFINITY, f64::NEG_INFINITY),
                |(least, largest), value| (least.min(value), largest.max(value)),
            );
            rows.push(vec![
                name.clone(),
                number(line.strain_rate, 3),
                number(line.threshold, 1),
                estimate(&fit.critical_width),
                estimate(&fit.exponent),
                interval(&fit.exponent),
                format!("{} … {}", number(range.0, 2), number(range.1, 2)),
                format!("{}/{}", fit.observed, fit.observed + fit.censored),
                number(line.escaped(), 2),
            ]);
            sensitivity.push(
                [name.clone(), number(line.strain_rate, 3)]
                    .into_iter()
                    .chain(SHIFTS.map(|shift| {
                        let fit = line.at_threshold(line.threshold + shift).fit(WINDOW);
                        fit.map_or("–".to_owned(), |fit| {
                            format!(
                                "{}; {}",
                                estimate(&fit.critical_width),
                                estimate(&fit.exponent)
                            )
                        })
                    }))
                    .collect(),
            );
        }
        for line in lines
            .iter()
            .filter(|line| !used.iter().any(|one| one.strain_rate == line.strain_rate))
        {
            rows.push(vec![
                name.clone(),
                number(line.strain_rate, 3),
                number(line.threshold, 1),
                if line.escaped() > MOST_ESCAPED {
                    "left out"
                } else {
                    "no fit"
                }
                .to_owned(),
                String::new(),
                String::new(),
                String::new(),
                String::new(),
                number(line.escaped(), 2),
            ]);
        }
    }
    let (verdict, statistics_found, why) = judge(&parts, &Statistics::FOR_A_VERDICT);
    if means.is_empty() {
        return Ok(Finding::nothing(
            "Too few runs had a transition.",
            statistics_found,
            &Statistics::FOR_A_VERDICT,
        ));
    }
    let words: Vec<String> = means
        .iter()
        .map(|(name, mean)| format!("*α* = {} on the {name} lattice", estimate(mean)))
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!(
            "Next to the critical width {}; the source says 1.{why}",
            words.join(", ")
        ),
        statistics_found,
        &Statistics::FOR_A_VERDICT,
    );
    finding.quantities = quantities;
    finding.paragraphs.push(format!(
        "The transition counts where the period-averaged flow passes the value midway between the two branches at that \
         strain rate, and stays for three periods; runs that end before are censored, not dropped. Mean and scatter are \
         fitted together by maximum likelihood, *τ* = *A*(*w*_{{c}} − *w*)^{{−*α*}} with a gamma distribution whose \
         relative variance is a power of the distance as well, to the {WINDOW} largest widths at which at least half of \
         the runs had a transition, and to all beyond."
    ));
    finding.tables.push(ReportTable {
        caption: "Critical width and exponent at each strain rate; the range is over windows from four widths to all; \
                  transitions seen of all runs in the window; fraction of grains outside the tube. Strain rates with \
                  more than 5 per cent outside are left out."
            .to_owned(),
        head: [
            "lattice", "*ε̇*", "threshold", "*w*_{c}", "*α*", "95 %", "range", "seen", "outside",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    });
    finding.tables.push(ReportTable {
        caption: "Sensitivity: *w*_{c} and *α* with the threshold lower by 0.1, as it is, and higher by 0.1.".to_owned(),
        head: ["lattice", "*ε̇*", "−0.1", "midway", "+0.1"].map(str::to_owned).to_vec(),
        rows: sensitivity,
    });
    finding.weaknesses.push(
        "An effective exponent depends on how near to *w*_{c} the fit looks, since *w*_{c} is fitted too: see the range \
         over windows. Runs end some periods after their own threshold is passed, so that one much higher is not always \
         reached: that biases the last column of the sensitivity."
            .to_owned(),
    );
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .colour_scale(rate_colours(all_rates.into_iter()))
        .width(Width::DoubleColumn)
        .description(
            "Mean transition time against the width of the bottleneck for several strain rates.",
        )
        .draw()?;
    finding.figures.push(ReportFigure {
        name: "transition-times".to_owned(),
        caption: "Mean transition time from rest against the width of the bottleneck, in periods, on the fine (a) and \
                  the coarse lattice (b); arrows: widths at which most runs saw none; lines: fitted power laws."
            .to_owned(),
        drawing,
    });
    Ok(finding)
}

/// Mean transition times of one lattice with the fitted laws; `None` without any.
fn panel(lines: &[Line<'_>]) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel = ChartPanel::new(&label(Axis::Width), &label(Axis::TransitionPeriod))
        .y_scale(Scale::Logarithmic);
    for (number, line) in lines.iter().enumerate() {
        let (mut width, mut time, mut error, mut limit) = (vec![], vec![], vec![], vec![]);
        for ensemble in &line.ensembles {
            let seen = ensemble.observed >= ensemble.censored && ensemble.observed > 0;
            let mean = ensemble.fit.map(|fit| fit.mean);
            let value = if seen {
                mean.map_or(ensemble.naive_mean.unwrap_or(f64::NAN), |mean| mean.value)
            } else {
                ensemble.watched
            };
            width.push(ensemble.width);
            time.push(value * line.strain_rate);
            error.push(
                mean.filter(|_| seen)
                    .map_or(0.0, |mean| mean.error * line.strain_rate),
            );
            limit.push(!seen);
        }
        if width.is_empty() {
            continue;
        }
        drawn = true;
        let tint = Tint::Value(line.strain_rate);
        let points = Points::new("", &width, &time)
            .y_errors(&error)
            .lower_limits(&limit)
            .series(number)
            .tint(tint);
        panel = panel.with(points);
        if let Some(fit) = line.fit(WINDOW) {
            let mean = |width| fit.mean(width) * line.strain_rate;
            panel = panel.with_all(fitted_curve(line, fit.critical_width.value, &time, mean));
        }
    }
    drawn.then_some(panel)
}
