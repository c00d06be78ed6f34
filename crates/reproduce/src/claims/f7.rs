//! F7: how the critical width depends on the strain rate.

use peristalsis_analysis::{LineFit, fit_line, fit_parabola};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f7.md"));

pub(super) const CLAIM: Claim = Claim::new("F7", PROSE, DIVERGENCES, examine);

/// What the source says.
const SLOPE: f64 = -3.75;
/// The definition of the critical width that the verdict goes by, in words, and the other one.
const DIVERGENCE: &str = "divergence of the mean time";
const HALF: &str = "half of the runs jam";

/// Strain rates with their critical widths, ascending, of errors no smaller than [`LEAST_ERROR_OF_A_WIDTH`].
type Critical = Vec<(f64, Uncertain)>;

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let (mut draft, mut parts, mut slopes) = (Draft::of(PROSE), Vec::new(), Vec::new());
    let (mut rows, mut periods) = (Vec::new(), 0.0);
    let mut panel = panel(Axis::StrainRate, Axis::CriticalWidth).x_range(0.0..);
    for (place, one) in OnLattice::all(evidence)?.iter().enumerate() {
        let of = |critical: fn(&Line<'_>) -> Option<Uncertain>| -> Critical {
            let known = |line: &Line<'_>| {
                let width = critical(line)?;
                let error = width.error.max(LEAST_ERROR_OF_A_WIDTH);
                Some((line.strain_rate, Uncertain::normal(width.value, error)))
            };
            one.tight().filter_map(known).collect()
        };
        periods = one.lines.iter().map(Line::periods).fold(periods, f64::max);
        rows.extend(one.lines.iter().map(|line| row(&one.name, line)));
        let diverging = of(diverging);
        if diverging.is_empty() {
            continue;
        }
        let drawn = points(&format!("{} lattice", one.name), diverging.clone());
        panel = panel.with_all(drawn.map(|points| points.series(place)));
        let mut holds = None;
        for (how, critical) in [(DIVERGENCE, &diverging), (HALF, &of(half))] {
            let [rate, width, error] = columns(critical.iter().copied(), 0.0);
            let Ok(line) = fit_line(&rate, &width, &error) else {
                continue;
            };
            let slope = slope(&line);
            if how == DIVERGENCE {
                // A line through two points has no say.
                holds = agrees(&slope, SLOPE).filter(|_| rate.len() >= LEAST_RATES_OF_A_SLOPE);
                slopes.push(format!("{slope} on the {} lattice", one.name));
                panel = with_line(panel, &line, &rate, place);
            }
            let quantities = &mut draft.finding.quantities;
            quantities.extend(of_line(&line, &one.name, how, rate.len()));
            if let Ok(curve) = fit_parabola(&rate, &width, &error) {
                let probability = match curve.linearity < 5e-4 {
                    true => "below 0.001".to_owned(),
                    false => number(curve.linearity, 3),
                };
                let (lattice, ours) = (&one.name, curve.quadratic);
                let curvature =
                    PROSE.quantity("curvature", values!(lattice, how, probability), ours);
                quantities.push(curvature.sourced(0.0));
            }
        }
        parts.push(one.part(holds));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if slopes.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let ends = [3.0 - 0.075, 3.0 - 0.45];
    panel = panel.with(
        Curve::new("slope −3.75 (talk)", &[0.02, 0.12], &ends)
            .tint(Tint::Black)
            .pattern(Pattern::Dotted),
    );
    let summary = PROSE.text("summary", values!(slopes = slopes.join(" and "), why));
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(periods));
    draft.table("critical widths", &[], rows);
    draft.chart("critical-width", &[], ChartFigure::new(panel))?;
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}

fn diverging(line: &Line<'_>) -> Option<Uncertain> {
    Some(line.fit.as_ref()?.critical_width)
}

fn half(line: &Line<'_>) -> Option<Uncertain> {
    Some(line.crossing()?.width)
}

fn row(lattice: &str, line: &Line<'_>) -> Vec<String> {
    let interval = |width: Option<Uncertain>| cell_of(width, |width| interval(&width));
    vec![
        lattice.to_owned(),
        number(line.strain_rate, 3),
        cell(half(line)),
        interval(half(line)),
        cell(diverging(line)),
        interval(diverging(line)),
        number(line.escaped(), 2),
    ]
}

/// Slope and intercept as quantities.
fn of_line(line: &LineFit, lattice: &str, how: &str, rates: usize) -> [Quantity; 2] {
    let (freedom, factor) = (line.degrees_of_freedom, line.scale_factor());
    let intercept = line.intercept;
    let intercept = Uncertain::normal(intercept.value, intercept.error * factor);
    let slope = slope(line);
    let (chi_squared, factor) = (number(line.chi_squared, 1), number(factor, 1));
    let line = PROSE.text("line", values!(how, rates, chi_squared, freedom, factor));
    let slope = PROSE.quantity("slope", values!(lattice, how, line), slope);
    let intercept = PROSE.quantity("intercept", values!(lattice, how, line), intercept);
    [slope.sourced(SLOPE), intercept]
}

fn with_line(panel: ChartPanel, line: &LineFit, rates: &[f64], place: usize) -> ChartPanel {
    let largest = rates.iter().copied().fold(0.0, f64::max);
    let x = spaced(0.0, largest, 40);
    let at: Vec<Uncertain> = x.iter().map(|rate| line.at(*rate)).collect();
    let middle: Vec<f64> = at.iter().map(|one| one.value).collect();
    let reach = line.scale_factor();
    let error: Vec<f64> = at.iter().map(|one| reach * one.error).collect();
    panel
        .with(error_band(&x, &middle, &error).series(place))
        .with(Curve::new("", &x, &middle).series(place).weight(0.8))
}
