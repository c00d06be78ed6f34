//! Tables and figures that claims draw alike.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{Band, ChartPanel, Line as Curve, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity, Units};

use crate::branch::Branch;
use crate::critical::Line;
use crate::text::estimate;
use crate::thresholds::WINDOW;

/// What stands in a cell without a value.
pub(crate) const NONE: &str = "–";

/// A cell with a number and its error, or a dash.
pub(crate) fn cell(number: Option<Uncertain>) -> String {
    number.map_or(NONE.to_owned(), |number| estimate(&number))
}

/// A cell with the text of a value, or a dash.
pub(crate) fn cell_of<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or(NONE.to_owned(), text)
}

/// Label of an axis of the prescribed tube.
pub(crate) fn label(quantity: Quantity) -> String {
    quantity.label(Units::Linear)
}

/// Points with error bars; an error that is not known is not drawn. `None` without a point.
pub(crate) fn points(
    name: &str,
    points: impl IntoIterator<Item = (f64, Uncertain)>,
) -> Option<Points> {
    let (x, y): (Vec<f64>, Vec<Uncertain>) = points.into_iter().unzip();
    let values: Vec<f64> = y.iter().map(|y| y.value).collect();
    let known = |error: f64| if error.is_finite() { error } else { 0.0 };
    let errors: Vec<f64> = y.iter().map(|y| known(y.error)).collect();
    (!x.is_empty()).then(|| Points::new(name, &x, &values).y_errors(&errors))
}

/// A branch as joined points with error bars.
pub(crate) fn branch_points(name: &str, branch: &Branch<'_>) -> Option<Points> {
    points(name, branch.flows()).map(Points::joined)
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
    let ends = numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, largest), x| {
        (least.min(x), largest.max(x))
    });
    (ends.0 < ends.1).then_some(ends)
}

/// Colours for strain rates of the prescribed tube.
pub(crate) fn rate_colours(rates: impl Iterator<Item = f64>) -> ColourScale {
    rate_colours_in(Units::Linear, rates, (0.02, 0.2))
}

/// Colours for strain rates; `otherwise` are the ends of the scale where these do not differ.
pub(crate) fn rate_colours_in(
    units: Units,
    rates: impl Iterator<Item = f64>,
    otherwise: (f64, f64),
) -> ColourScale {
    let (least, largest) = ends(rates).unwrap_or(otherwise);
    ColourScale::new(&Quantity::StrainRate.label(units), least, largest).logarithmic()
}

/// Equally spaced numbers from end to end.
pub(crate) fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|place| from + (to - from) * place as f64 / (count.max(2) - 1) as f64)
        .collect()
}

/// The middles of so many periods, counted from 0.
pub(crate) fn periods(count: usize) -> Vec<f64> {
    (0..count).map(|number| number as f64 + 0.5).collect()
}

/// A panel of J/Jmax against the width.
pub(crate) fn flow_panel() -> ChartPanel {
    ChartPanel::new(&label(Quantity::Width), &label(Quantity::FlowRateRatio)).y_range(-0.05..=1.1)
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
