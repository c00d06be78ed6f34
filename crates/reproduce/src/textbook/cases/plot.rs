//! Points and curves of the figures.

use peristalsis_figures::chart::{Line, Pattern, Points, Tint};

/// Points of measured rows, from the coordinates of each.
pub(super) fn points<'a, R: 'a>(
    name: &str,
    rows: impl IntoIterator<Item = &'a R>,
    coordinates: impl Fn(&R) -> (f64, f64),
) -> Points {
    let (x, y): (Vec<f64>, Vec<f64>) = rows.into_iter().map(coordinates).unzip();
    Points::new(name, &x, &y)
}

/// The graph of a function at these places.
pub(super) fn curve(name: &str, x: &[f64], function: impl Fn(f64) -> f64) -> Line {
    let y: Vec<f64> = x.iter().map(|x| function(*x)).collect();
    Line::new(name, x, &y)
}

/// The graph of a closed form at these places.
pub(super) fn closed_form(name: &str, x: &[f64], function: impl Fn(f64) -> f64) -> Line {
    let line = curve(name, x, function).tint(Tint::Black);
    line.pattern(Pattern::Dashed)
}

/// The name of a curve in the first of several panels, so that a legend has it once.
pub(super) fn named_once(name: &str, panel: usize) -> &str {
    if panel == 0 { name } else { "" }
}

/// Points as rings, to be told from others that may cover them.
pub(super) fn open_if(is_open: bool, points: Points) -> Points {
    if is_open { points.open() } else { points }
}
