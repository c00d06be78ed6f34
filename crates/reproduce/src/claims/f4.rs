//! F4: how the scatter of the transition times diverges, and whether it collapses.

use peristalsis_analysis::{Uncertain, WidthEnsemble};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Tint};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use crate::claim::Claim;
use crate::collapse::{collapse, drawing};
use crate::critical::{OnLattice, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{fitted_curve, label, points, rate_colours};
use crate::finding::{Finding, Quantity, Statistics};
use crate::judgement::{agrees, judge};
use crate::prose::Prose;
use crate::text::{interval, number, probability};
use crate::thresholds::WINDOW;

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
    let needed = Statistics::FOR_A_VERDICT;
    let lattices = OnLattice::all(evidence)?;
    let (mut parts, mut means, mut quantities) = (Vec::new(), Vec::new(), Vec::new());
    let (mut rows, mut collapses) = (Vec::new(), Vec::new());
    for one in &lattices {
        let scatters = || {
            one.fitted()
                .filter_map(|(line, fit)| Some((line, fit.scatter?)))
        };
        let exponents: Vec<Uncertain> = scatters().map(|(_, fit)| fit.variance_exponent).collect();
        let mean = weighted_mean(&exponents);
        parts.push(one.part(mean.and_then(|mean| agrees(&mean, EXPONENT))));
        if let Some(mean) = mean {
            means.push(PROSE.text("mean", &[("mean", &mean), ("lattice", &one.name)]));
            quantities.push(Quantity {
                source: Some(EXPONENT),
                ..PROSE.quantity(
                    "exponent",
                    &[
                        ("lattice", &one.name),
                        ("rates", &exponents.len()),
                        ("window", &WINDOW),
                    ],
                    mean,
                )
            });
        }
        rows.extend(scatters().map(|(line, fit)| {
            vec![
                one.name.clone(),
                number(line.strain_rate, 3),
                fit.variance_exponent.to_string(),
                interval(&fit.variance_exponent),
                fit.scatter_exponent.to_string(),
                probability(fit.chance_probability),
            ]
        }));
        let variance = |ensemble: &WidthEnsemble| Some(ensemble.fit?.variance);
        if let Some(collapsed) = collapse(one, SCALING, EXPONENT, variance) {
            let of = format!("variance, {} lattice", one.name);
            quantities.extend(collapsed.quantities(&of, ["*a_{χ}*", "*b_{χ}*"]));
            collapses.push((one.name.clone(), collapsed));
        }
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if means.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let summary = PROSE.text("summary", &[("means", &means.join(", ")), ("why", &why)]);
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    finding.quantities = quantities;
    finding.paragraphs = PROSE.paragraphs("method", &[]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    finding.tables.push(PROSE.table("exponents", &[], rows));
    let lines = lattices.iter().flat_map(OnLattice::fitted);
    let variances = ChartFigure::grid(2, lattices.iter().filter_map(panel))
        .share_y()
        .colour_scale(rate_colours(lines.map(|(line, _)| line.strain_rate)))
        .width(Width::DoubleColumn)
        .description("Variance of the transition time against the width of the bottleneck for several strain rates.")
        .draw()?;
    finding
        .figures
        .push(PROSE.figure("transition-time-variance", &[], variances));
    if !collapses.is_empty() {
        let labels = ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*χ_{τ}ε̇*^{7}"];
        let scaled = drawing(&collapses, labels, "*χ_{τ}ε̇*^{*a*}", -3.0)?;
        finding
            .figures
            .push(PROSE.figure("collapse-of-variances", &[], scaled));
    }
    Ok(finding)
}

/// Variances of one lattice with the fitted laws; `None` without any.
fn panel(lattice: &OnLattice<'_>) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel = ChartPanel::new(&label(Axis::Width), "variance, *χ_{τ}*/*T*^2")
        .y_scale(Scale::Logarithmic)
        .title(&format!("{} lattice", lattice.name));
    for (number, (line, fit)) in lattice.fitted().enumerate() {
        let squared = line.strain_rate * line.strain_rate;
        let variances: Vec<(f64, Uncertain)> = line
            .ensembles
            .iter()
            .filter(|one| one.observed >= one.censored)
            .filter_map(|one| Some((one.width, one.fit?.variance)))
            .filter(|(_, variance)| variance.value > 0.0)
            .map(|(width, variance)| {
                let scaled = Uncertain::normal(variance.value * squared, variance.error * squared);
                (width, scaled)
            })
            .collect();
        let Some(points) = points("", variances.iter().copied()) else {
            continue;
        };
        drawn = true;
        panel = panel.with(points.series(number).tint(Tint::Value(line.strain_rate)));
        if let Some(fit) = fit.scatter {
            let at = |width| {
                let (mean, relative) = fit.at(width);
                mean * mean * relative * squared
            };
            panel = panel.with_all(fitted_curve(line, fit.critical_width.value, &variances, at));
        }
    }
    drawn.then_some(panel)
}
