//! F4: how the scatter of the transition times diverges, and whether it collapses.

use peristalsis_analysis::WidthEnsemble;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f4.md"));

pub(super) const CLAIM: Claim = Claim::new("F4", PROSE, DIVERGENCES, examine);

/// What the source says of chi_tau against the width, and of its scaling.
const EXPONENT: f64 = 3.0;
const SCALING: [f64; 2] = [7.0, 1.5];

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let lattices = OnLattice::all(evidence)?;
    let (mut draft, mut parts, mut means) = (Draft::of(PROSE), Vec::new(), Vec::new());
    let (mut rows, mut collapses) = (Vec::new(), Vec::new());
    for one in &lattices {
        let exponents = one.scattered().map(|(_, fit)| fit.variance_exponent);
        let exponents: Vec<Uncertain> = exponents.collect();
        let (part, words) = mean_exponent(&mut draft, one, EXPONENT, &exponents);
        parts.push(part);
        means.extend(words);
        rows.extend(one.scattered().map(|(line, fit)| {
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
            let exponents = collapsed.quantities(&of, ["*a_{χ}*", "*b_{χ}*"]);
            draft.finding.quantities.extend(exponents);
            collapses.push((one.name.clone(), collapsed));
        }
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if means.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let summary = PROSE.text("summary", values!(means = means.join(", "), why));
    draft.table("exponents", &[], rows);
    let lines = lattices.iter().flat_map(OnLattice::fitted);
    let variances = grid(2, lattices.iter().filter_map(variances))
        .share_y()
        .colour_scale(rate_colours(lines.map(|(line, _)| line.strain_rate)));
    draft.chart("transition-time-variance", &[], variances)?;
    if !collapses.is_empty() {
        let labels = ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*χ_{τ}ε̇*^{7}"];
        let scaled = chart(&collapses, labels, "*χ_{τ}ε̇*^{*a*}", -3.0);
        draft.chart("collapse-of-variances", &[], scaled)?;
    }
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}

/// Variances of one lattice with the fitted laws; `None` without any.
fn variances(lattice: &OnLattice<'_>) -> Option<ChartPanel> {
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
            .map(|(width, variance)| (width, variance.scaled(squared)))
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
