//! The common curve of scaled points: any smooth one, weighed by how smooth it is, with a correction that fades.

use crate::collapse::CurvePoint;

/// Intervals between the knots of the common curve.
const INTERVALS: usize = 14;
/// Splines that are not 0 within an interval.
const SPLINES: usize = 4;
/// Directions of the coefficients that smoothness leaves free: height, slope and bend of the curve, so that parameters that
/// would make it straight are not favoured; height and slope of the correction.
const FREE: usize = 3;
const FREE_OF_CORRECTION: usize = 2;
/// Part of a pivot that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// A scaled point, with the parameter of its curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled {
    pub(crate) parameter: f64,
    pub(crate) point: CurvePoint,
}

/// How likely points are to lie on one smooth curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smooth {
    /// Squared distances in units of the errors, with the bends of the curve in units of what is expected of them.
    pub(crate) squares: f64,
    /// ln of the determinant that goes with it.
    pub(crate) ln_volume: f64,
}

impl Smooth {
    /// Coefficients that smoothness leaves free.
    pub(crate) fn free(correction: Option<f64>) -> usize {
        FREE + correction.map_or(0, |_| FREE_OF_CORRECTION)
    }

    /// Likelihood of points about a curve `f(X) + p^power g(X)`.
    ///
    /// f is a cubic spline with even knots whose third differences are normal numbers of variance `1/stiffness` in
    /// units of the mean error, and so integrated out (Eilers & Marx, Stat. Sci. 11, 89 (1996)); g is another, of second
    /// differences. What lies between the points is thus as uncertain as the curve is free to bend there, and curves that
    /// are pulled apart gain nothing.
    pub(crate) fn of(
        points: &[Scaled],
        ln_stiffness: f64,
        correction: Option<f64>,
    ) -> Option<Self> {
        let n = points.len() as f64;
        let unit = points
            .iter()
            .map(|one| libm::log(one.point.error))
            .sum::<f64>()
            / n;
        let unit = libm::exp(unit);
        let x = || points.iter().map(|scaled| scaled.point.x);
        let low = x().fold(f64::INFINITY, f64::min);
        let span = x().fold(f64::NEG_INFINITY, f64::max) - low;
        if !(span > 0.0 && span.is_finite()) {
            return None;
        }
        let curve = INTERVALS + SPLINES - 1;
        let curves = if correction.is_some() { 2 } else { 1 };
        let weights = correction.map(|power| fading(points, power));
        let mut system = System::new(curves * curve);
        for (place, scaled) in points.iter().enumerate() {
            let CurvePoint { x, y, error } = scaled.point;
            let place_in = (x - low) / span;
            let mut row: Vec<(usize, f64)> = splines(place_in, INTERVALS).collect();
            if let Some(weights) = &weights {
                let correction = splines(place_in, INTERVALS);
                row.extend(correction.map(|(k, value)| (curve + k, value * weights[place])));
            }
            system.add(&row, y / unit, unit * unit / (error * error));
        }
        let stiffness = libm::exp(ln_stiffness);
        let bent = |k: usize| [(k, 1.0), (k + 1, -3.0), (k + 2, 3.0), (k + 3, -1.0)];
        for k in 0..curve - FREE {
            system.add(&bent(k), 0.0, stiffness);
        }
        let curved = |k: usize| [(k, 1.0), (k + 1, -2.0), (k + 2, 1.0)];
        let correction = if curves > 1 {
            curve - FREE_OF_CORRECTION
        } else {
            0
        };
        for k in 0..correction {
            system.add(&curved(curve + k), 0.0, stiffness);
        }
        let (squares, ln_determinant) = system.solve();
        let ln_volume = ln_determinant - (curve - FREE + correction) as f64 * ln_stiffness;
        let is_finite = squares.is_finite() && ln_volume.is_finite();
        is_finite.then_some(Self { squares, ln_volume })
    }
}

/// Sizes of a correction `p^power` at every point, 1 at the largest.
fn fading(points: &[Scaled], power: f64) -> Vec<f64> {
    let logarithm = |scaled: &Scaled| power * libm::log(scaled.parameter);
    let logarithms: Vec<f64> = points.iter().map(logarithm).collect();
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    logarithms
        .iter()
        .map(|one| libm::exp(one - largest))
        .collect()
}

/// The cubic B-splines that are not 0 at a place between 0 and 1, with so many even intervals: number and value.
fn splines(place: f64, intervals: usize) -> impl Iterator<Item = (usize, f64)> {
    let place = place * intervals as f64;
    let interval = (place as usize).min(intervals - 1);
    let t = place - interval as f64;
    let s = 1.0 - t;
    let inner = |t: f64| 4.0 - 6.0 * t * t + 3.0 * t * t * t;
    let values = [s * s * s, inner(t), inner(s), t * t * t];
    (0..SPLINES).map(move |k| (interval + k, values[k] / 6.0))
}

/// Normal equations of a linear least-squares fit.
struct System {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
    squares: f64,
}

impl System {
    fn new(size: usize) -> Self {
        let matrix = (0..size).map(|row| vec![0.0; row + 1]).collect();
        let right = vec![0.0; size];
        let squares = 0.0;
        Self {
            matrix,
            right,
            squares,
        }
    }

    /// Adds an equation of some coefficients, in order, with its weight.
    fn add(&mut self, row: &[(usize, f64)], y: f64, weight: f64) {
        for (index, &(k, value)) in row.iter().enumerate() {
            self.right[k] += weight * value * y;
            for &(before, other) in &row[..=index] {
                self.matrix[k][before] += weight * value * other;
            }
        }
        self.squares += weight * y * y;
    }

    /// Least sum of squares, and ln of the determinant, by the factors of Cholesky. Directions that the others contain
    /// count as 1.
    fn solve(mut self) -> (f64, f64) {
        let mut ln_determinant = 0.0;
        for row in 0..self.right.len() {
            let (above, own) = self.matrix.split_at_mut(row);
            let own = &mut own[0];
            let diagonal = own[row];
            for (column, other) in above.iter().enumerate() {
                let known: f64 = own[..column].iter().zip(other).map(|(a, b)| a * b).sum();
                let pivot = other[column];
                own[column] = if pivot > 0.0 {
                    (own[column] - known) / pivot
                } else {
                    0.0
                };
            }
            let known: f64 = own[..row].iter().map(|entry| entry * entry).sum();
            let rest = diagonal - known;
            if rest > ROUND_OFF * diagonal {
                own[row] = rest.sqrt();
                ln_determinant += libm::log(rest);
                let known: f64 = own[..row].iter().zip(&self.right).map(|(a, b)| a * b).sum();
                self.right[row] = (self.right[row] - known) / own[row];
                self.squares -= self.right[row] * self.right[row];
            } else {
                own[row] = 0.0;
                self.right[row] = 0.0;
            }
        }
        (self.squares.max(0.0), ln_determinant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::point;

    fn scaled(parameter: f64, x: f64, y: f64) -> Scaled {
        let point = point(x, y, 0.5);
        Scaled { parameter, point }
    }

    #[test]
    fn splines_add_up_to_one_and_hold_straight_lines() {
        for place in [0.0, 0.13, 0.25, 0.5, 0.999, 1.0] {
            let sum: f64 = splines(place, 4).map(|(_, value)| value).sum();
            let line: f64 = splines(place, 4).map(|(k, value)| k as f64 * value).sum();
            assert!((sum - 1.0).abs() < 1e-14 && (line - 4.0 * place - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_system_of_two_by_hand() {
        // y = a + b x through (0, 1), (1, 2), (2, 4): rest 1/6, determinant of (3 3; 3 5).
        let mut system = System::new(2);
        for (x, y) in [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)] {
            system.add(&[(0, 1.0), (1, x)], y, 1.0);
        }
        let (squares, ln_determinant) = system.solve();
        assert!((squares - 1.0 / 6.0).abs() < 1e-12);
        assert!((ln_determinant - libm::log(6.0)).abs() < 1e-12);
    }

    #[test]
    fn a_correction_takes_up_what_fades_along_the_curves() {
        let at = |p: f64| (0..9).map(move |k| (p, f64::from(k)));
        let points = [4.0, 8.0, 16.0].into_iter().flat_map(at);
        let points = points.map(|(p, x)| scaled(p, x, 2.0 * x + 9.0 * (3.0 - x) / p));
        let points: Vec<Scaled> = points.collect();
        let left = |correction| Smooth::of(&points, 3.0, correction).unwrap().squares;
        assert!(left(None) > 10.0 && left(Some(-1.0)) < 1e-6);
        assert!(Smooth::of(&points[..1], 0.0, None).is_none());
    }
}
