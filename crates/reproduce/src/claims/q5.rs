//! Q5: is the divergence real?

use peristalsis_analysis::{Family, Law, Survival, Transition, compare_laws};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use super::{LATTICES, best, fitted, label, lines_of, rate_colours, statistics};
use crate::claim::Claim;
use crate::critical::{Line, WINDOW, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("q5.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q5",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// The laws that are compared, with their names.
const LAWS: [(&str, Law); 4] = [
    ("power", Law::Power),
    ("barrier, 1/(*w*_{c} − *w*)", Law::Barrier { power: 1.0 }),
    ("barrier, 1/(*w*_{c} − *w*)^2", Law::Barrier { power: 2.0 }),
    ("exponential", Law::Exponential),
];
/// Difference of Akaike's criterion from which on a law is worse.
const WORSE: f64 = 4.0;

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut all = Vec::new();
    let mut rows = Vec::new();
    let mut quantities = Vec::new();
    let mut ratios = ChartPanel::new("distance, (*w*_{c} − *w*)/*d*", "*χ_{τ}*/*τ*^2")
        .x_scale(Scale::Logarithmic)
        .y_scale(Scale::Logarithmic);
    let mut rates = Vec::new();
    let mut power_best = 0;
    let mut barrier_best = 0;
    let mut exponential_best = 0;
    let mut compared = 0;
    let mut chance_excluded = 0;
    let mut lines_compared = 0;
    let mut survival = None;
    for study in LATTICES {
        let lines = lines_of(evidence, study)?;
        let fits = fitted(&lines);
        let used: Vec<&Line<'_>> = fits.iter().map(|(line, _)| *line).collect();
        all.push(statistics(&used));
        let name = study.0.name();
        let scatter: Vec<_> = fits
            .iter()
            .filter_map(|(_, fit)| Some(fit.scatter?.scatter_exponent))
            .collect();
        if let Some(mean) = weighted_mean(&scatter) {
            quantities.push(Quantity {
                name: format!("exponent of the relative variance, {name} lattice"),
                symbol: "*q*".to_owned(),
                unit: String::new(),
                source: Some(1.0),
                ours: Some(mean),
                method: format!(
                    "weighted mean over {} strain rates; 0 for a constant one",
                    scatter.len()
                ),
            });
        }
        for (line, fit) in &fits {
            let Some(fit) = fit.scatter else { continue };
            lines_compared += 1;
            chance_excluded += usize::from(fit.chance_probability < 1e-3);
            let Some((width, transitions)) = line.window(WINDOW) else {
                continue;
            };
            let evidence = compare_laws(
                &LAWS.map(|(_, law)| law),
                Family::Gamma,
                &width,
                &transitions,
            )
            .unwrap_or_default();
            let of = |law: Law| {
                evidence
                    .iter()
                    .find(|one| one.law == law)
                    .map_or("–".to_owned(), |one| number(one.excess, 1))
            };
            if let Some(power) = evidence.iter().find(|one| one.law == Law::Power) {
                compared += 1;
                power_best += usize::from(power.excess < WORSE);
                let good = |of: fn(&Law) -> bool| {
                    usize::from(
                        evidence
                            .iter()
                            .any(|one| of(&one.law) && one.excess < WORSE),
                    )
                };
                barrier_best += good(|law| matches!(law, Law::Barrier { .. }));
                exponential_best += good(|law| *law == Law::Exponential);
            }
            rows.push(vec![
                name.clone(),
                number(line.strain_rate, 3),
                of(LAWS[0].1),
                of(LAWS[1].1),
                of(LAWS[2].1),
                of(LAWS[3].1),
                estimate(&fit.scatter_exponent),
                crate::text::probability(fit.chance_probability),
                number(fit.constant_probability, 3),
                number(fit.inverse_probability, 3),
            ]);
            let critical = fit.critical_width.value;
            let known: Vec<(f64, f64, f64)> = line
                .ensembles
                .iter()
                .filter(|ensemble| {
                    ensemble.observed > 2 * ensemble.censored && ensemble.width < critical
                })
                .filter_map(|ensemble| {
                    let lifetime = ensemble.fit?;
                    let ratio = lifetime.variance.value / lifetime.mean.value.powi(2);
                    let error = lifetime.variance.error / lifetime.mean.value.powi(2);
                    (ratio > 0.0).then_some((critical - ensemble.width, ratio, error))
                })
                .collect();
            if !known.is_empty() {
                let x: Vec<f64> = known.iter().map(|one| one.0).collect();
                let y: Vec<f64> = known.iter().map(|one| one.1).collect();
                let error: Vec<f64> = known.iter().map(|one| one.2).collect();
                rates.push(line.strain_rate);
                let points = Points::new("", &x, &y)
                    .y_errors(&error)
                    .series(usize::from(name == "coarse"))
                    .tint(Tint::Value(line.strain_rate));
                ratios = ratios.with(points);
            }
            if survival.is_none() && name == "fine" && (line.strain_rate - 0.1).abs() < 0.03 {
                survival = survival_panel(line, fit.critical_width.value);
            }
        }
    }
    let found = best(all.into_iter(), &needed);
    if rows.is_empty() {
        return Ok(Finding::nothing(
            "Too few runs had a transition.",
            found,
            &needed,
        ));
    }
    let mut finding = Finding::new(
        Verdict::Answered,
        format!(
            "Pure chance (*χ_{{τ}}*/*τ*^2 = 1) is excluded at {chance_excluded} of {lines_compared} strain rates. A power law is as good \
             as the best law at {power_best} of {compared}, a barrier at {barrier_best}, an exponential without a critical width at \
             {exponential_best}."
        ),
        found,
        &needed,
    );
    finding.quantities = quantities;
    finding.tables.push(ReportTable {
        caption: "Laws of the mean transition time by censored likelihood (gamma distributed): Akaike's criterion above that of \
                  the best; exponent of the relative variance; probabilities of such data if the relative variance is 1, \
                  constant, or ~ 1/(*w*_{c} − *w*)."
            .to_owned(),
        head: [
            "lattice", "*ε̇*", "power", "barrier 1", "barrier 2", "exponential", "*q*", "chance", "constant", "inverse",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    });
    finding.paragraphs.push(
        "A transition that begins by chance at a constant rate has *χ_{τ}*/*τ*^2 = 1 and the grey survival curve; one that takes the \
         same time in each run has 0 and a step. Runs under way are in the figure of F1: how *J* goes before it jumps."
            .to_owned(),
    );
    finding.weaknesses.push(
        "The widths closest to *w*_{c} decide, and have the fewest transitions; probabilities are asymptotic."
            .to_owned(),
    );
    if !rates.is_empty() {
        let figure = ChartFigure::new(ratios)
            .colour_scale(rate_colours(rates.into_iter()))
            .width(Width::SingleColumn)
            .description("Relative variance against distance from the critical width.")
            .draw()?;
        finding.figures.push(ReportFigure {
            name: "relative-variance".to_owned(),
            caption: "Relative variance of the transition times against the distance from the critical width; 1 would be pure \
                      chance (discs: fine, squares: coarse lattice)."
                .to_owned(),
            drawing: figure,
        });
    }
    if let Some((panel, scale)) = survival {
        finding.figures.push(ReportFigure {
            name: "survival".to_owned(),
            caption: "Fraction of runs without a transition (Kaplan-Meier) against time over its mean, fine lattice; grey: pure \
                      chance."
                .to_owned(),
            drawing: ChartFigure::new(panel)
                .colour_scale(scale)
                .description("Survival curves beside an exponential.")
                .draw()?,
        });
    }
    Ok(finding)
}

/// Survival against time over its mean at each width below the critical one, coloured by the width.
fn survival_panel(line: &Line<'_>, critical: f64) -> Option<(ChartPanel, ColourScale)> {
    let mut panel = ChartPanel::new("time over its mean, *t*/*τ*_{mean}", &label(Axis::Survival))
        .x_range(0.0..=2.5)
        .y_range(0.0..=1.05);
    let (width, transitions) = line.columns();
    let mut widths = Vec::new();
    for ensemble in &line.ensembles {
        let resolved = ensemble
            .naive_mean
            .is_some_and(|mean| mean > 10.0 * line.period());
        if ensemble.observed <= 2 * ensemble.censored || !resolved || ensemble.width >= critical {
            continue;
        }
        let here: Vec<Transition> = width
            .iter()
            .zip(&transitions)
            .filter(|(width, _)| **width == ensemble.width)
            .map(|(_, transition)| *transition)
            .collect();
        let (Some(mean), Ok(survival)) =
            (ensemble.fit.map(|fit| fit.mean.value), Survival::new(&here))
        else {
            continue;
        };
        let mut time = vec![0.0];
        let mut left = vec![1.0];
        for step in &survival.steps {
            time.push(step.time / mean);
            left.push(step.survival.value);
        }
        panel = panel.with(
            Curve::new("", &time, &left)
                .stepped()
                .tint(Tint::Value(ensemble.width)),
        );
        widths.push(ensemble.width);
    }
    let least = widths.first().copied()?;
    let largest = widths.last().copied().filter(|largest| *largest > least)?;
    let time = super::spaced(0.0, 2.5, 60);
    let chance: Vec<f64> = time.iter().map(|time| (-time).exp()).collect();
    panel = panel.with(Curve::new("chance", &time, &chance).tint(Tint::Grey));
    Some((panel, ColourScale::new(&label(Axis::Width), least, largest)))
}
