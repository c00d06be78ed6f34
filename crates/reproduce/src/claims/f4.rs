//! F4: how the scatter of the transition times diverges, and whether it collapses.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f4.md"));

pub(super) const CLAIM: Claim = Claim::new("F4", PROSE, TRANSITIONS, examine);

/// What the source says of chi_tau against the width, and of its scaling.
const EXPONENT: f64 = 3.0;
const SCALING: [f64; 2] = [7.0, 1.5];

/// Power of the strain rate in chi_tau (w_c − w)^3 that follows where g(x) ~ x^−3.
const AMPLITUDE: f64 = EXPONENT * SCALING[1] - SCALING[0];

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Line<'_>>::all(evidence)?;
    let (mut draft, mut parts) = (Draft::of(PROSE), Vec::new());
    let (mut rows, mut collapses) = (Vec::new(), Vec::new());
    for one in &walls {
        let collapsed = collapsed_of(one);
        parts.push(part(&mut draft, one, collapsed.as_ref()));
        rows.extend(one.tight().filter_map(|shown| row(&one.name, shown)));
        if let Some(collapsed) = collapsed {
            let of = format!("variance, wall {}", one.name);
            let exponents = collapsed.quantities(&of, ["*a_{χ}*", "*b_{χ}*"]);
            draft.finding.quantities.extend(exponents);
            collapses.push((one.name.clone(), collapsed));
        }
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let summary = PROSE.text("summary", &[]);
    draft.table("exponents", &[], rows);
    let lines = walls.iter().flat_map(OnWall::tight);
    let variances = grid(2, walls.iter().filter_map(variances))
        .share_y()
        .colour_scale(rate_colours(lines.map(|shown| shown.strain_rate)));
    draft.chart("transition-time-variance", &[], variances)?;
    distrust(&mut draft, &collapses);
    if !collapses.is_empty() {
        let labels = ["(*w*_{c} − *w*)/*r*^{3/2}", "*χ_{τ}r*^{7}"];
        let scaled = chart(&collapses, labels, "*χ_{τ}r*^{*a*}", -3.0);
        draft.chart("collapse-of-variances", &[], scaled)?;
    }
    Ok(draft.judged(judgement, &summary))
}

/// What one wall says of both halves: the exponent, and the scaling with the strain rate.
fn part(draft: &mut Draft, one: &OnWall<Line<'_>>, collapsed: Option<&Collapsed>) -> Part {
    let wall = &one.name;
    let agrees_at = |line: &Line<'_>| agrees(&line.near.as_ref()?.variance_exponent()?, EXPONENT);
    let judged = |one: &OnWall<Line<'_>>| one.rates(agrees_at);
    let exponents = at_rates(one.near(), Near::variance_exponent);
    let exponents: Vec<Uncertain> = exponents.into_iter().map(|one| one.1).collect();
    let mean = weighted_mean(&exponents);
    let amplitudes =
        |one: &OnWall<Line<'_>>| at_rates(one.near(), |near| near.variance_amplitude(EXPONENT));
    let power = |one: &OnWall<Line<'_>>| fitted_power(amplitudes(one));
    let agrees_power = |one: &OnWall<Line<'_>>| agrees(&power(one)?, AMPLITUDE);
    let scales = all_hold(&[agrees_power(one), collapsed.and_then(Collapsed::agrees)]);
    let rates = exponents.len();
    draft.compared("exponent", values!(wall, rates), mean, EXPONENT);
    let rates = amplitudes(one).len();
    let found = power(one);
    draft.compared("amplitude", values!(wall, rates), found, AMPLITUDE);
    let (exponent, power) = (cell(mean), cell(found));
    let all = judged(one);
    let (words, scaling) = (all.in_words(), said(scales));
    let (half, chance) = (said(all.hold()), cell_of(collapsed, Collapsed::chance));
    let why = PROSE.text("why", values!(half, words, scaling, chance));
    let number = PROSE.text("number", values!(exponent, power));
    let judge = |one: &OnWall<Line<'_>>| {
        let rest = [judged(one).hold(), agrees_power(one)];
        all_hold_with(&rest, || collapsed_of(one)?.agrees())
    };
    one.part_judged(all_hold(&[all.hold(), scales]), judge, number, why)
}

fn collapsed_of(one: &OnWall<Line<'_>>) -> Option<Collapsed> {
    collapse(one, SCALING, |ensemble| Some(ensemble.fit?.variance))
}

fn row(wall: &str, shown: &Shown<Line<'_>>) -> Option<Vec<String>> {
    let near = shown.found.near.as_ref()?;
    let scatter = shown.found.fit.and_then(|fit| fit.scatter);
    Some(vec![
        wall.to_owned(),
        number(shown.strain_rate, 3),
        cell(near.variance_exponent()),
        cell(near.variance_amplitude(EXPONENT)),
        cell(scatter.map(|fit| fit.variance_exponent)),
    ])
}

/// Variances on one wall with the fitted laws; `None` without any.
fn variances(one: &OnWall<Line<'_>>) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel = ChartPanel::new(&label(Axis::Width), "variance, *χ_{τ}*/*T*^2")
        .y_scale(Scale::Logarithmic)
        .title(&one.name);
    for line in one.tight().map(|shown| &shown.found) {
        let squared = line.strain_rate * line.strain_rate;
        let variances: Vec<(f64, Uncertain)> = line
            .ensembles
            .iter()
            .filter(|one| one.observed_fraction() >= SEEN && line.resolves(one, RESOLVED))
            .filter_map(|one| Some((one.width, one.fit?.variance)))
            .filter(|(_, variance)| variance.value > 0.0)
            .map(|(width, variance)| (width, variance.scaled(squared)))
            .collect();
        let Some(points) = points("", variances.iter().copied()) else {
            continue;
        };
        drawn = true;
        panel = panel.with(points.tint(Tint::Value(line.strain_rate)));
        if let Some((law, critical)) = line.near.as_ref().and_then(Near::variance_law) {
            let at = |width: f64| law(width) * squared;
            panel = panel.with_all(fitted_curve(line, critical, &variances, at));
        }
    }
    drawn.then_some(panel)
}
