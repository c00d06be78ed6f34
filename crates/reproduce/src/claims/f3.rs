//! F3: whether transition times of several strain rates collapse.

use peristalsis_analysis::WidthEnsemble;
use peristalsis_figures::Units;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f3.md"));

pub(super) const CLAIM: Claim = Claim::new("F3", PROSE, TRANSITIONS, examine);

/// Powers of the strain rate that the source gives: of the time, and of the distance; and that of tau (w_c − w), which
/// follows from them where f(x) ~ 1/x.
const EXPONENTS: [f64; 2] = [3.5, 1.5];
pub(super) const AMPLITUDE: f64 = EXPONENTS[1] - EXPONENTS[0];

/// Distances from w_c, over epsdot^(3/2), at which the power of tau (w_c − w) is asked for, farthest first: the source's laws
/// are for distances about 1.
const DISTANCES: [f64; 6] = [16.0, 8.0, 4.0, 2.0, 1.0, 0.5];

/// The power of the strain rate in tau (w_c − w) where the distance over epsdot^(3/2) is this, within a factor of 2^(1/2).
fn power_at(one: &OnWall<Line<'_>>, distance: f64) -> Option<Uncertain> {
    let amplitude = |line: &Line<'_>| {
        let critical = line.near.as_ref()?.critical_width()?;
        let apart = |one: &WidthEnsemble| {
            let reduced = (critical.value - one.width) * line.strain_rate.powf(-1.5);
            (reduced / distance).log2().abs()
        };
        let seen = |one: &&WidthEnsemble| one.observed_fraction() >= SEEN && apart(one) <= 0.5;
        let those = line.ensembles.iter().filter(seen);
        let nearest = those.min_by(|one, other| apart(one).total_cmp(&apart(other)))?;
        let (mean, width) = (nearest.fit?.mean, critical.value - nearest.width);
        let error = (mean.error * width).hypot(mean.value * critical.error);
        Some((
            line.strain_rate,
            Uncertain::normal(mean.value * width, error),
        ))
    };
    let known = one.tight().filter_map(|shown| amplitude(&shown.found));
    fitted_power(known)
}

/// Power of the strain rate in C.
fn power_of(one: &OnWall<Line<'_>>) -> Option<Uncertain> {
    fitted_power(at_rates(one.near(), Near::amplitude))
}

fn collapsed_of(one: &OnWall<Line<'_>>) -> Option<Collapsed> {
    collapse(one, EXPONENTS, |ensemble| Some(ensemble.fit?.mean))
}

/// Whether both halves hold.
fn holds(one: &OnWall<Line<'_>>, collapses: impl FnOnce() -> Option<bool>) -> Option<bool> {
    let scales = power_of(one).and_then(|power| agrees(&power, AMPLITUDE));
    all_hold_with(&[scales], collapses)
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut found: Vec<(String, Collapsed)> = Vec::new();
    let (mut draft, mut parts) = (Draft::of(PROSE), Vec::new());
    let (mut rows, mut amplitudes) = (Vec::new(), Vec::new());
    let (mut windows, mut powers) = (Vec::new(), Vec::new());
    for one in OnWall::<Line<'_>>::all(evidence)? {
        let collapsed = collapsed_of(&one);
        let known = at_rates(one.near(), Near::amplitude);
        let power = power_of(&one);
        let wall = &one.name;
        let rates = known.len();
        draft.compared("amplitude", values!(wall, rates), power, AMPLITUDE);
        let row = |(rate, found): &(f64, Uncertain)| {
            vec![wall.clone(), number(*rate, 3), found.to_string()]
        };
        rows.extend(known.iter().map(row));
        let at = DISTANCES.map(|distance| power_at(&one, distance));
        windows.push([vec![wall.clone()], at.map(cell).to_vec()].concat());
        powers.extend(at.into_iter().flatten());
        let words = PROSE.text("number", values!(power = cell(power)));
        let why = cell_of(collapsed.as_ref(), |collapsed| {
            let (found, chance) = (collapsed.in_words(), collapsed.chance());
            PROSE.text("collapse", values!(found, chance))
        });
        let all = holds(&one, || collapsed.as_ref().and_then(Collapsed::agrees));
        let judge = |one: &OnWall<Line<'_>>| holds(one, || collapsed_of(one)?.agrees());
        parts.push(one.part_judged(all, judge, words, why));
        amplitudes.push((one.name.clone(), known));
        found.extend(collapsed.map(|collapsed| (one.name, collapsed)));
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let summary = PROSE.text("summary", &[]);
    powers.sort_by(|one, other| one.value.total_cmp(&other.value));
    if let (Some(least), Some(most)) = (powers.first(), powers.last()) {
        let [nearest, farthest] = [DISTANCES[DISTANCES.len() - 1], DISTANCES[0]];
        draft.paragraph("everywhere", values!(nearest, farthest, least, most));
    }
    draft.table("amplitudes", &[], rows);
    draft.table("windows", &[], windows);
    distrust(&mut draft, &found);
    for (name, collapsed) in &found {
        let of = format!("wall {name}");
        let exponents = collapsed.quantities(&of, ["*a*", "*b*"]);
        draft.finding.quantities.extend(exponents);
        draft.finding.tables.push(collapsed.table(&of));
    }
    draft.chart("amplitudes", &[], against_rate(&amplitudes))?;
    if !found.is_empty() {
        let labels = ["(*w*_{c} − *w*)/*r*^{3/2}", "*τr*^{7/2}"];
        let chart = chart(&found, labels, "*τr*^{*a*}", -1.0);
        draft.chart("collapse-of-transition-times", &[], chart)?;
    }
    Ok(draft.judged(judgement, &summary))
}

/// tau (w_c − w) of each wall against the strain rate, beside the power of the source through the first of them.
fn against_rate(walls: &[(String, Vec<(f64, Uncertain)>)]) -> ChartFigure {
    let all = || walls.iter().flat_map(|(_, known)| known);
    let drawn = walls
        .iter()
        .map(|(name, known)| points(name, known.iter().copied()));
    let amplitude = format!("amplitude, *C*/*d* {}", Units::Linear.rate());
    let mut panel = ChartPanel::new(&label(Axis::StrainRate), &amplitude)
        .x_scale(Scale::Logarithmic)
        .y_scale(Scale::Logarithmic)
        .with_all(numbered(drawn));
    for (series, (_, known)) in walls.iter().enumerate() {
        if let Some((line, (least, most))) =
            logarithmic_line(known.iter().copied()).zip(ends(known.iter().map(|one| one.0)))
        {
            let at = |rate: f64| (line.intercept.value + line.slope.value * rate.ln()).exp();
            let curve = Curve::new("", &[least, most], &[at(least), at(most)]);
            panel = panel.with(curve.series(series).weight(0.8));
        }
    }
    // The source's power, through the middle of all points, as long as they reach.
    let lowest = all()
        .map(|(_, one)| one.value - one.error)
        .filter(|end| *end > 0.0);
    let highest = all().map(|(_, one)| one.value + one.error);
    if let (Some((slowest, fastest)), Some((least, most))) =
        (ends(all().map(|one| one.0)), ends(lowest.chain(highest)))
    {
        let rate = (slowest * fastest).sqrt();
        let value = (least * most).sqrt();
        let at_value = |end: f64| rate * (end / value).powf(1.0 / AMPLITUDE);
        let (from, to) = (at_value(most).max(slowest), at_value(least).min(fastest));
        let at = |rate_there: f64| value * (rate_there / rate).powf(AMPLITUDE);
        let curve = Curve::new("*ε̇*^{−2} (talk)", &[from, to], &[at(from), at(to)]);
        panel = panel.with(curve.tint(Tint::Black).pattern(Pattern::Dotted));
    }
    ChartFigure::new(panel)
}
