//! F4: how the scatter of the transition times diverges, and whether it collapses.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Tint};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::{
    LATTICES, fitted, fitted_curve, judge, label, lines_of, of_exponents, rate_colours, statistics,
};
use crate::claim::Claim;
use crate::collapse::{Collapsed, collapse, figure};
use crate::critical::{Line, WINDOW};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, ReportFigure, ReportTable, Statistics};
use crate::prose::Prose;
use crate::text::{estimate, interval, number};

const PROSE: Prose = Prose::new(include_str!("f4.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F4",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// What the source says of chi_tau against the width, and of its scaling.
const EXPONENT: f64 = 3.0;
const SCALING: [f64; 2] = [7.0, 1.5];

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut parts = Vec::new();
    let mut quantities = Vec::new();
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    let mut all_rates = Vec::new();
    let mut means = Vec::new();
    let mut collapses: Vec<(String, Collapsed)> = Vec::new();
    for study in LATTICES {
        let lines = lines_of(evidence, study)?;
        let fits = fitted(&lines);
        let used: Vec<&Line<'_>> = fits.iter().map(|(line, _)| *line).collect();
        all_rates.extend(used.iter().map(|line| line.strain_rate));
        let name = study.0.name();
        panels.extend(panel(&used).map(|panel| panel.title(&format!("{name} lattice"))));
        let exponents: Vec<_> = fits
            .iter()
            .filter_map(|(_, fit)| Some(fit.scatter?.variance_exponent))
            .collect();
        let (part, mean) = of_exponents(
            &name,
            &exponents,
            EXPONENT,
            ["variance of the transition time", "*β*"],
            statistics(&used),
        );
        parts.push(part);
        if let Some((mean, quantity)) = mean {
            means.push((name.clone(), mean));
            quantities.push(quantity);
        }
        for (line, fit) in &fits {
            let Some(fit) = fit.scatter else { continue };
            rows.push(vec![
                name.clone(),
                number(line.strain_rate, 3),
                estimate(&fit.variance_exponent),
                interval(&fit.variance_exponent),
                estimate(&fit.scatter_exponent),
                crate::text::probability(fit.chance_probability),
            ]);
        }
        let variance =
            |ensemble: &peristalsis_analysis::WidthEnsemble| ensemble.fit.map(|fit| fit.variance);
        if let Some(collapsed) = collapse(&fits, SCALING, EXPONENT, variance) {
            quantities.extend(
                collapsed.quantities(&format!("variance, {name} lattice"), ["*a_{χ}*", "*b_{χ}*"]),
            );
            collapses.push((name, collapsed));
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
        .map(|(name, mean)| format!("*β* = {} on the {name} lattice", estimate(mean)))
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!(
            "{}; the source says 3 (its scaling with the strain rate: see the collapse).{why}",
            words.join(", ")
        ),
        statistics_found,
        &Statistics::FOR_A_VERDICT,
    );
    finding.quantities = quantities;
    finding.paragraphs.push(
        "The exponent *β* = 2*α* + *q* comes from the same likelihood as that of F2, in which the relative variance \
         *χ_{τ}*/*τ*^2 ~ (*w*_{c} − *w*)^{−*q*} is fitted along. The last column is the probability that a transition that \
         begins by chance at a constant rate, *χ_{τ}*/*τ*^2 = 1 at every width, would give such transition times: nucleation \
         by chance is excluded where it is small (see Q5)."
            .to_owned(),
    );
    finding.tables.push(ReportTable {
        caption: "Exponent of the variance, that of the relative variance, and the probability of pure chance.".to_owned(),
        head: ["lattice", "*ε̇*", "*β*", "95 %", "*q*", "chance"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    finding.weaknesses.push(
        "A variance from *n* runs has a relative error of some (2/*n*)^{1/2} at each width, and all of its rise hangs on the few \
         widths next to *w*_{c}."
            .to_owned(),
    );
    let drawing = ChartFigure::grid(2, panels)
        .share_y()
        .colour_scale(rate_colours(all_rates.into_iter()))
        .width(Width::DoubleColumn)
        .description("Variance of the transition time against the width of the bottleneck for several strain rates.")
        .draw()?;
    finding.figures.push(ReportFigure {
        name: "transition-time-variance".to_owned(),
        caption: "Variance of the transition time against the width of the bottleneck, in periods squared, on the fine (a) \
                  and the coarse lattice (b), with the fitted power laws."
            .to_owned(),
        drawing,
    });
    if !collapses.is_empty() {
        finding.figures.push(figure(
            &collapses,
            "collapse-of-variances",
            ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*χ_{τ}ε̇*^{7}"],
            "*χ_{τ}ε̇*^{*a*}",
            -3.0,
            "Variances scaled with the exponents of the source (left) and with those that collapse them best (right); \
             dashed: slope −3.",
        )?);
    }
    Ok(finding)
}

/// Variances of one lattice with the fitted laws; `None` without any.
fn panel(lines: &[&Line<'_>]) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel =
        ChartPanel::new(&label(Axis::Width), "variance, *χ_{τ}*/*T*^2").y_scale(Scale::Logarithmic);
    for (number, line) in lines.iter().enumerate() {
        let squared = line.strain_rate * line.strain_rate;
        let (mut width, mut variance, mut error) = (vec![], vec![], vec![]);
        for ensemble in &line.ensembles {
            let Some(fit) = ensemble
                .fit
                .filter(|_| ensemble.observed >= ensemble.censored)
            else {
                continue;
            };
            if fit.variance.value > 0.0 {
                width.push(ensemble.width);
                variance.push(fit.variance.value * squared);
                error.push(fit.variance.error * squared);
            }
        }
        if width.is_empty() {
            continue;
        }
        drawn = true;
        let tint = Tint::Value(line.strain_rate);
        panel = panel.with(
            Points::new("", &width, &variance)
                .y_errors(&error)
                .series(number)
                .tint(tint),
        );
        if let Some(fit) = line.fit(WINDOW).and_then(|fit| fit.scatter) {
            let at = |width| {
                let (mean, relative) = fit.at(width);
                mean * mean * relative * squared
            };
            panel = panel.with_all(fitted_curve(line, fit.critical_width.value, &variance, at));
        }
    }
    drawn.then_some(panel)
}
