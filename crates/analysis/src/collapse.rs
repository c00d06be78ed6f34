//! Quality of a scaling collapse: how well several curves lie on one.

use crate::error::{Error, enough, ensure};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point of a curve with the standard error of its ordinate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// Standard error of the ordinate, positive.
    pub error: f64,
}

/// The points measured at one value of a parameter, such as the strain rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Value of the parameter.
    pub parameter: f64,
    /// Points, in any order.
    pub points: Vec<CurvePoint>,
}

/// How well scaled curves lie on a common one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CollapseQuality {
    /// Mean squared distance S from the master curve in units of the errors: about 1 for a perfect collapse, the larger
    /// the worse. Meaningless without the overlap.
    pub quality: f64,
    /// Fraction of all points that lie within the range of another curve, and so are compared at all. Points that the
    /// scaling sends to infinity, such as those beyond the critical width, count among all.
    pub overlap: f64,
    /// Points compared.
    pub compared: usize,
    /// Whether the curves hang together: each is compared with another, and no group stands apart from the rest.
    pub is_connected: bool,
}

/// Quality of the collapse of curves that are scaled already.
///
/// `S = 1/N sum_ij (y_ij - Y_ij)^2/(error_ij^2 + dY_ij^2)`
///
/// over the N points j of curves i that lie within the abscissas of another curve. Y_ij +- dY_ij is the master curve
/// there: the weighted straight line through the two points of every other curve that enclose x_ij, evaluated at x_ij.
/// The grids need not agree. S becomes small also where curves are pulled apart until little is left to compare: hence
/// the overlap. A master curve that bends between two points of a curve raises S: give ordinates in which it is nearly
/// straight, such as logarithms of a power law. Source: Houdayer & Hartmann, Phys. Rev. B 70, 014418 (2004), appendix
/// A; after Kawashima & Ito, J. Phys. Soc. Jpn. 62, 435 (1993).
///
/// # Errors
/// [`Error::TooFew`] below 2 curves, [`Error::NoOverlap`] where no point can be compared.
///
/// ```
/// use peristalsis_analysis::{CurvePoint, collapse_quality};
/// let point = |x, y| CurvePoint { x, y, error: 1.0 };
/// let curves = [vec![point(0.0, 0.0), point(2.0, 2.0)], vec![point(1.0, 3.0), point(5.0, 5.0)]];
/// let found = collapse_quality(&curves)?;
/// // (1, 3) lies 2 above 1 +- sqrt(1/2); (2, 2) lies 1.5 below 3.5 +- sqrt(10)/4.
/// assert!((found.quality - 0.5 * (4.0 / 1.5 + 2.25 / 1.625)).abs() < 1e-12);
/// assert_eq!(found.overlap, 0.5);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn collapse_quality(curves: &[Vec<CurvePoint>]) -> Result<CollapseQuality, Error> {
    enough("curves", curves.len(), 2)?;
    let total: usize = curves.iter().map(Vec::len).sum();
    let sorted = |curve: &Vec<CurvePoint>| {
        let mut points: Vec<CurvePoint> = curve
            .iter()
            .copied()
            .filter(CurvePoint::is_usable)
            .collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        points
    };
    let sorted: Vec<Vec<CurvePoint>> = curves.iter().map(sorted).collect();
    let mut sum = 0.0;
    for (own, curve) in sorted.iter().enumerate() {
        for point in curve {
            let mut line = Line::default();
            for (_, curve) in sorted.iter().enumerate().filter(|(other, _)| *other != own) {
                if let Some([left, right]) = enclosing(curve, point.x) {
                    line.add(left, point.x);
                    line.add(right, point.x);
                }
            }
            if let Some((height, variance)) = line.at_origin() {
                let distance = point.y - height;
                sum += distance * distance / (point.error * point.error + variance);
            }
        }
    }
    let (compared, is_connected) = overlap(curves);
    let (needed, found) = (0.0, 0.0);
    ensure(compared > 0, Error::NoOverlap { needed, found })?;
    Ok(CollapseQuality {
        quality: sum / compared as f64,
        overlap: compared as f64 / total as f64,
        compared,
        is_connected,
    })
}

/// Points within the range of another curve, and whether all curves hang together.
pub(crate) fn overlap(curves: &[Vec<CurvePoint>]) -> (usize, bool) {
    let usable = |curve: &Vec<CurvePoint>| -> Vec<f64> {
        let points = curve.iter().filter(|point| point.is_usable());
        points.map(|point| point.x).collect()
    };
    let places: Vec<Vec<f64>> = curves.iter().map(usable).collect();
    let range = |places: &Vec<f64>| match places.len() {
        0 | 1 => (f64::INFINITY, f64::NEG_INFINITY),
        _ => places
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
                (low.min(x), high.max(x))
            }),
    };
    let ranges: Vec<(f64, f64)> = places.iter().map(range).collect();
    let mut groups: Vec<usize> = (0..curves.len()).collect();
    let mut compared = 0;
    for (own, places) in places.iter().enumerate() {
        for x in places {
            let mut is_compared = false;
            for (other, (low, high)) in ranges.iter().enumerate() {
                if other != own && low <= x && x <= high {
                    is_compared = true;
                    join(&mut groups, own, other);
                }
            }
            compared += usize::from(is_compared);
        }
    }
    (compared, groups.iter().all(|&group| group == groups[0]))
}

impl CurvePoint {
    pub(crate) fn is_usable(&self) -> bool {
        let finite = self.x.is_finite() && self.y.is_finite() && self.error.is_finite();
        finite && self.error > 0.0
    }
}

/// Neighbouring points of a sorted curve with a place between them.
fn enclosing(curve: &[CurvePoint], x: f64) -> Option<[CurvePoint; 2]> {
    let (first, last) = (curve.first()?, curve.last()?);
    if curve.len() < 2 || x < first.x || x > last.x {
        return None;
    }
    let right = curve.partition_point(|point| point.x < x);
    let right = right.clamp(1, curve.len() - 1);
    Some([curve[right - 1], curve[right]])
}

/// Makes two curves members of one group.
fn join(groups: &mut [usize], a: usize, b: usize) {
    let (kept, gone) = (groups[a].min(groups[b]), groups[a].max(groups[b]));
    if kept == gone {
        return;
    }
    for group in groups.iter_mut().filter(|group| **group == gone) {
        *group = kept;
    }
}

/// Sums of a weighted straight line, abscissas counted from the place at which it is wanted.
#[derive(Default)]
struct Line {
    weight: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
}

impl Line {
    fn add(&mut self, point: CurvePoint, origin: f64) {
        let weight = 1.0 / (point.error * point.error);
        let x = point.x - origin;
        self.weight += weight;
        self.x += weight * x;
        self.y += weight * point.y;
        self.xx += weight * x * x;
        self.xy += weight * x * point.y;
    }

    /// Height of the line at the origin with its variance; the mean where all points share one abscissa.
    fn at_origin(&self) -> Option<(f64, f64)> {
        if self.weight == 0.0 {
            return None;
        }
        let determinant = self.weight * self.xx - self.x * self.x;
        if determinant <= 1e-12 * self.weight * self.xx {
            return Some((self.y / self.weight, 1.0 / self.weight));
        }
        let height = (self.xx * self.y - self.x * self.xy) / determinant;
        Some((height, self.xx / determinant))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{point, white_noise};

    /// Curves on y = 2 - x with unequal grids and errors of 0.1.
    fn straight(seed: u64, offsets: &[f64]) -> Vec<Vec<CurvePoint>> {
        let curve = |(k, offset): (usize, &f64)| {
            let noise = white_noise(seed * 100 + k as u64, 20);
            let noisy = |(j, noise): (usize, &f64)| {
                let x = 0.1 * j as f64 + offset;
                point(x, 2.0 - x + 0.1 * noise, 0.1)
            };
            noise.iter().enumerate().map(noisy).collect()
        };
        offsets.iter().enumerate().map(curve).collect()
    }

    #[test]
    fn a_perfect_collapse_has_quality_one() {
        let mut mean = 0.0;
        for seed in 0..100 {
            let found = collapse_quality(&straight(seed, &[0.0, 0.03, -0.4, 0.71])).unwrap();
            mean += found.quality / 100.0;
            assert!(found.is_connected);
            assert!(found.overlap > 0.85 && found.overlap < 1.0);
        }
        assert!((mean - 1.0).abs() < 0.05, "{mean}");
    }

    #[test]
    fn curves_apart_are_seen_as_such() {
        // Two pairs, each collapsed by itself.
        let found = collapse_quality(&straight(1, &[0.0, 0.05, 40.0, 40.05])).unwrap();
        assert!(found.overlap > 0.9 && !found.is_connected);
        let found = collapse_quality(&straight(1, &[0.0, 1.8])).unwrap();
        assert!(found.is_connected && (found.overlap - 0.1).abs() < 0.03);
        assert_refused!(
            collapse_quality(&straight(1, &[0.0, 50.0])) =>
            NoOverlap { needed: 0.0, found: 0.0 }
        );
        assert_refused!(collapse_quality(&straight(1, &[0.0])) => TooFew { needed: 2, .. });
    }

    #[test]
    fn points_sent_to_infinity_lower_the_overlap() {
        let mut curves = straight(2, &[0.0, 0.05]);
        let before = collapse_quality(&curves).unwrap();
        for point in &mut curves[0][..10] {
            point.x = f64::NAN;
        }
        let after = collapse_quality(&curves).unwrap();
        assert!(after.overlap < before.overlap - 0.3);
    }

    #[test]
    fn a_shifted_curve_raises_the_quality() {
        let mut curves = straight(3, &[0.0, 0.05, 0.1]);
        for point in &mut curves[1] {
            point.y += 0.5;
        }
        assert!(collapse_quality(&curves).unwrap().quality > 5.0);
    }
}
