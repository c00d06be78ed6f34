//! Tables and figures that claims draw alike.

use peristalsis_analysis::number::decimal as number;
use peristalsis_analysis::{Bootstrap, Uncertain, dip_test, histogram, two_peaks};
use peristalsis_figures::chart::{
    Band, Bars, ChartFigure, ChartPanel, Line as Curve, Pattern, Points, Tint,
};
use peristalsis_figures::{ColourScale, Quantity, Units, Width};

use crate::branch::{Branch, Branches};
use crate::critical::Line;
use crate::row::extremes;
use crate::thresholds::WINDOW;

/// What stands in a cell without a value.
pub(crate) const NONE: &str = "–";

/// Resamples of the test for a dip.
const BOOTSTRAP: Bootstrap = Bootstrap::new(500, 7);

/// A cell with a number and its error, or a dash.
pub(crate) fn cell(number: Option<Uncertain>) -> String {
    cell_of(number, |number| number.to_string())
}

/// A cell with the text of a value, or a dash.
pub(crate) fn cell_of<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or(NONE.to_owned(), text)
}

/// Numbers in a row.
pub(crate) fn listed(numbers: impl IntoIterator<Item = f64>) -> String {
    let texts: Vec<String> = numbers.into_iter().map(|one| one.to_string()).collect();
    texts.join(", ")
}

/// A probability; very small ones come from the tails of approximate distributions, and are called small.
pub(crate) fn probability(value: f64) -> String {
    if value < 1e-3 {
        "< 0.001".to_owned()
    } else {
        number(value, 3)
    }
}

/// Two cells: the number of peaks of some flows, and the probability of so deep a dip with one peak.
pub(crate) fn cells_of_peaks(flows: &[f64]) -> [String; 2] {
    [
        cell_of(two_peaks(flows).ok(), |peaks| {
            if peaks.is_double() { "two" } else { "one" }.to_owned()
        }),
        cell_of(dip_test(flows, BOOTSTRAP).ok(), |test| {
            probability(test.probability)
        }),
    ]
}

/// Width of the bins of J/Jmax.
const BIN: f64 = 0.05;

/// The number of runs by their flow, in bins about multiples of [`BIN`] from one flow to another: that of no flow is not
/// split. `None` without any run.
pub(crate) fn flow_histogram(flows: &[f64], from: f64, to: f64) -> Option<Bars> {
    let bins = ((to - from) / BIN).round() as usize + 1;
    let counts = histogram(flows, from - 0.5 * BIN, to + 0.5 * BIN, bins).ok()?;
    let heights: Vec<f64> = counts.counts.iter().map(|count| *count as f64).collect();
    let any = heights.iter().any(|height| *height > 0.0);
    any.then(|| Bars::new("", &counts.edges, &heights))
}

/// Label of an axis of the prescribed tube.
pub(crate) fn label(quantity: Quantity) -> String {
    quantity.label(Units::Linear)
}

/// An empty panel of one quantity of the prescribed tube against another.
pub(crate) fn panel(x: Quantity, y: Quantity) -> ChartPanel {
    ChartPanel::new(&label(x), &label(y))
}

/// Panels over both columns of a page, so many beside one another.
pub(crate) fn grid(columns: usize, panels: impl IntoIterator<Item = ChartPanel>) -> ChartFigure {
    ChartFigure::grid(columns, panels).width(Width::DoubleColumn)
}

/// A panel of J/Jmax against the width.
pub(crate) fn flow_panel() -> ChartPanel {
    panel(Quantity::Width, Quantity::FlowRateRatio).y_range(-0.05..=1.1)
}

/// Points with their 68 per cent intervals as bars; a side that is not known is not drawn. `None` without a point.
pub(crate) fn points(
    name: &str,
    points: impl IntoIterator<Item = (f64, Uncertain)>,
) -> Option<Points> {
    let (x, y): (Vec<f64>, Vec<Uncertain>) = points.into_iter().unzip();
    let values: Vec<f64> = y.iter().map(|y| y.value).collect();
    let sides = |y: &Uncertain| [y.value - y.interval_68.lower, y.interval_68.upper - y.value];
    let errors: Vec<[f64; 2]> = y.iter().map(sides).collect();
    (!x.is_empty()).then(|| Points::new(name, &x, &values).y_sides(&errors))
}

/// The same, joined.
pub(crate) fn joined(
    name: &str,
    all: impl IntoIterator<Item = (f64, Uncertain)>,
) -> Option<Points> {
    points(name, all).map(Points::joined)
}

/// A branch as points with error bars, joined but for its jump.
pub(crate) fn branch_points(name: &str, branch: &Branch<'_>) -> Option<Points> {
    let points = joined(name, branch.flows())?;
    let jump = branch.step().filter(|_| branch.jumps());
    Some(match jump {
        Some(jump) => points.broken_at(jump.place().value),
        None => points,
    })
}

/// Both branches, filled from rest and open from jammed.
pub(crate) fn both_starts(branches: &Branches<'_>) -> [Option<Points>; 2] {
    let rest = branch_points("from rest", &branches.rest);
    let jammed = branch_points("from jammed", &branches.jammed);
    [
        rest.map(|points| points.series(0)),
        jammed.map(|points| points.series(1).open()),
    ]
}

/// Series, each numbered by its place; a place without points keeps its number.
pub(crate) fn numbered(
    all: impl IntoIterator<Item = Option<Points>>,
) -> impl Iterator<Item = Points> {
    let all = all.into_iter().enumerate();
    all.filter_map(|(number, points)| Some(points?.series(number)))
}

/// Series, each coloured by a value.
pub(crate) fn coloured(
    all: impl IntoIterator<Item = (f64, Option<Points>)>,
) -> impl Iterator<Item = Points> {
    let tinted = |(value, points): (f64, Option<Points>)| Some(points?.tint(Tint::Value(value)));
    all.into_iter().filter_map(tinted)
}

/// Averages over periods in time, coloured by a value.
pub(crate) fn course(value: f64, averages: &[f64]) -> Curve {
    let middles: Vec<f64> = (0..averages.len())
        .map(|place| place as f64 + 0.5)
        .collect();
    Curve::new("", &middles, averages).tint(Tint::Value(value))
}

/// The curve of a Newtonian fluid; `None` with fewer than two points.
pub(crate) fn fluid(
    tint: Tint,
    points: impl IntoIterator<Item = Option<(f64, f64)>>,
) -> Option<Curve> {
    let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().flatten().unzip();
    (x.len() > 1).then(|| {
        Curve::new("Newtonian fluid", &x, &y)
            .tint(tint)
            .pattern(Pattern::Dashed)
    })
}

/// The band of one standard error about a curve.
pub(crate) fn error_band(x: &[f64], value: &[f64], error: &[f64]) -> Band {
    let end = |sign: f64| -> Vec<f64> {
        let pairs = value.iter().zip(error);
        pairs.map(|(value, error)| value + sign * error).collect()
    };
    Band::new("", x, &end(-1.0), &end(1.0))
}

/// Least and largest of some numbers; `None` where they do not differ.
pub(crate) fn ends(numbers: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let [least, largest] = extremes(numbers);
    (least < largest).then_some((least, largest))
}

/// Colours for values of the quantity with this label; `otherwise` are the ends of the scale where these do not differ.
pub(crate) fn colours(
    label: &str,
    values: impl Iterator<Item = f64>,
    otherwise: (f64, f64),
) -> ColourScale {
    let (least, largest) = ends(values).unwrap_or(otherwise);
    ColourScale::new(label, least, largest)
}

/// Colours for strain rates of the prescribed tube.
pub(crate) fn rate_colours(rates: impl Iterator<Item = f64>) -> ColourScale {
    colours(&label(Quantity::StrainRate), rates, (0.02, 0.2)).logarithmic()
}

/// Equally spaced numbers from end to end.
pub(crate) fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|place| from + (to - from) * place as f64 / (count.max(2) - 1) as f64)
        .collect()
}

/// A fitted law in the window of its fit, as far as it stays in sight of the points; `None` where nothing of it does.
pub(crate) fn fitted_curve(
    line: &Line<'_>,
    critical: f64,
    points: &[(f64, Uncertain)],
    law: impl Fn(f64) -> f64,
) -> Option<Curve> {
    let largest = points.iter().map(|one| one.1.value).fold(0.0, f64::max);
    let (x, y): (Vec<f64>, Vec<f64>) = spaced(line.window_from(WINDOW)?, critical, 200)
        .into_iter()
        .map(|width| (width, law(width)))
        .filter(|point| point.1.is_finite() && point.1 < 3.0 * largest)
        .unzip();
    (x.len() > 1).then(|| {
        Curve::new("", &x, &y)
            .tint(Tint::Value(line.strain_rate))
            .weight(0.8)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It was "probability of a line: 0.000".
    #[test]
    fn a_probability_is_never_nought() {
        for (value, expected) in [(0.0, "< 0.001"), (9e-4, "< 0.001"), (0.0312, "0.031")] {
            assert_eq!(probability(value), expected);
        }
    }
}
