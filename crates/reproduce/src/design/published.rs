//! What the published runs say of a tube: the mean flow of those like it.

use std::sync::LazyLock;

use peristalsis_analysis::number;
use peristalsis_formats::{FormatError, Table, csv};
use serde::Serialize;

use super::groups::{ALL, GROUPS};
use crate::Start;
use crate::row::extremes;

/// Nearest published point up to which a tube lies within the data.
pub const WITHIN: f64 = 1.0;
/// Beyond it up to this distance errors grow with the distance; farther away nothing is said.
pub const AT_THE_EDGE: f64 = 2.0;
/// Width of the weights of published points, or the distance of the nearest if that is larger.
const KERNEL: f64 = 0.4;
/// Least error of an expectation: so far apart are means of the same tube on walls of other spheres.
const LEAST_ERROR: f64 = 0.05;
/// Weight of a point, over that of the nearest, from which on it is counted.
const COUNTED: f64 = 0.1;

/// The mean flow of the runs of one published tube from one start.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The study that has them.
    pub study: String,
    /// How they began.
    pub start: Start,
    /// The groups, in the order of [`ALL`].
    pub groups: [f64; GROUPS],
    /// Mean of J/Jmax.
    pub flow: f64,
    /// Runs behind it.
    pub runs: i64,
}

/// What to expect of J/Jmax.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expectation {
    /// J/Jmax.
    pub flow_rate_ratio: f64,
    /// Its standard error.
    pub error: f64,
    /// Least and largest flow of the points that count: far apart where there are two kinds of flow.
    pub range: [f64; 2],
    /// Distance of the nearest point; within the data up to 1.
    pub distance: f64,
    /// Published points that count.
    pub points: usize,
    /// The studies that have them.
    pub studies: Vec<String>,
}

/// The published points, as they stand in `published.csv` beside this file.
pub fn published() -> &'static [Point] {
    static POINTS: LazyLock<Vec<Point>> = LazyLock::new(|| {
        let table = csv::decode(include_str!("published.csv"));
        let points = table.and_then(|table| points(&table));
        points.expect("the points are written by a test that reads them")
    });
    &POINTS
}

fn points(table: &Table) -> Result<Vec<Point>, FormatError> {
    let (studies, starts) = (table.texts("study")?, table.texts("start")?);
    let (flows, runs) = (table.reals("flow")?, table.integers("runs")?);
    let mut groups = Vec::new();
    for group in &ALL {
        groups.push(table.reals(group.name)?);
    }
    let point = |row: usize| Point {
        study: studies[row].clone(),
        start: Start::of_name(&starts[row]),
        groups: core::array::from_fn(|group| groups[group][row]),
        flow: flows[row],
        runs: runs[row],
    };
    Ok((0..table.rows()).map(point).collect())
}

/// A number with three significant digits, at most four decimals.
pub fn rounded(value: f64) -> f64 {
    let value = (1e4 * value).round() / 1e4;
    number::rounded(value, 3) + 0.0
}

/// How far a tube is from a published point.
fn distance(groups: &[f64; GROUPS], point: &Point) -> f64 {
    let pairs = groups.iter().zip(&point.groups);
    let squares = ALL.iter().zip(pairs).map(|(group, (one, other))| {
        let apart = group.distance(*one, *other);
        apart * apart
    });
    squares.sum::<f64>().sqrt()
}

/// What to expect of a tube with grains that begin so: the mean flow of the points like it, weighted by
/// exp(-D^2/(2 h^2)), D their distance; the error is their scatter, and grows with the distance of the nearest beyond 1.
/// `None` where there is no point within [`AT_THE_EDGE`].
pub fn expectation(points: &[Point], groups: &[f64; GROUPS], start: Start) -> Option<Expectation> {
    let of_start = points.iter().filter(|point| point.start == start);
    let near: Vec<(f64, &Point)> = of_start.map(|it| (distance(groups, it), it)).collect();
    let least = near.iter().map(|it| it.0).fold(f64::INFINITY, f64::min);
    if least > AT_THE_EDGE {
        return None;
    }
    let kernel = least.max(KERNEL);
    let weight = |distance: f64| libm::exp(-0.5 * (distance / kernel) * (distance / kernel));
    let mean = |value: &dyn Fn(&Point) -> f64| {
        let sums = near.iter().map(|(distance, point)| {
            let weight = weight(*distance);
            [weight * value(point), weight]
        });
        let [sum, weights] = sums.fold([0.0; 2], |sum, it| [sum[0] + it[0], sum[1] + it[1]]);
        sum / weights
    };
    let flow = mean(&|point| point.flow);
    let variance = mean(&|point| (point.flow - flow) * (point.flow - flow));
    let counts = |distance: f64| weight(distance) >= COUNTED * weight(least);
    let counted: Vec<&Point> = near
        .iter()
        .filter(|it| counts(it.0))
        .map(|it| it.1)
        .collect();
    let mut studies: Vec<String> = counted.iter().map(|point| point.study.clone()).collect();
    studies.sort();
    studies.dedup();
    Some(Expectation {
        flow_rate_ratio: flow,
        error: (variance + LEAST_ERROR * LEAST_ERROR).sqrt() * least.max(1.0),
        range: extremes(counted.iter().map(|point| point.flow)),
        distance: least,
        points: counted.len(),
        studies,
    })
}

#[cfg(test)]
mod tests;
