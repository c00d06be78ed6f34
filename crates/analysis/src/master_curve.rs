//! The common curve of scaled points: any smooth one, weighed by how smooth it is, with a correction that fades.

use crate::collapse::CurvePoint;

/// Intervals between the knots of the common curve.
pub(crate) const INTERVALS: usize = 14;
/// Splines that are not 0 within an interval.
const SPLINES: usize = 4;
/// Directions of the coefficients that smoothness leaves free: height, slope and bend of the curve, so that parameters that
/// would make it straight are not favoured; height and slope of the correction.
const FREE: usize = 3;
const FREE_OF_CORRECTION: usize = 2;
/// Part of a pivot that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// A scaled point, with the size of the correction at its curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled {
    pub(crate) correction: f64,
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
    pub(crate) const fn free(is_corrected: bool) -> usize {
        FREE + if is_corrected { FREE_OF_CORRECTION } else { 0 }
    }

    /// Likelihood of points about a curve `f(X) + correction g(X)`; f alone where it `is_corrected` not.
    ///
    /// f is a cubic spline of so many even `intervals` whose third differences are normal numbers of variance `1/stiffness` in
    /// units of the mean error, and so integrated out (Eilers & Marx, Stat. Sci. 11, 89 (1996)); g is another, of second
    /// differences. What lies between the points is thus as uncertain as the curve is free to bend there, and curves that
    /// are pulled apart gain nothing.
    pub(crate) fn of(
        points: &[Scaled],
        intervals: usize,
        ln_stiffness: f64,
        is_corrected: bool,
    ) -> Option<Self> {
        let n = points.len() as f64;
        let logarithms = points.iter().map(|one| libm::log(one.point.error));
        let unit = libm::exp(logarithms.sum::<f64>() / n);
        let x = || points.iter().map(|scaled| scaled.point.x);
        let low = x().fold(f64::INFINITY, f64::min);
        let span = x().fold(f64::NEG_INFINITY, f64::max) - low;
        if !(span > 0.0 && span.is_finite()) {
            return None;
        }
        // The coefficients of both curves alternate, so that those which meet lie close.
        let curves = if is_corrected { 2 } else { 1 };
        let each = intervals + SPLINES - 1;
        let mut system = System::new(curves * each, curves * SPLINES);
        for Scaled { correction, point } in points {
            let mut row = [(0, 0.0); 2 * SPLINES];
            for (place, (k, value)) in splines((point.x - low) / span, intervals).enumerate() {
                row[curves * place] = (curves * k, value);
                if is_corrected {
                    row[curves * place + 1] = (curves * k + 1, value * correction);
                }
            }
            let weight = unit * unit / (point.error * point.error);
            system.add(&row[..curves * SPLINES], point.y / unit, weight);
        }
        let stiffness = libm::exp(ln_stiffness);
        for k in 0..each - FREE {
            let bend = [1.0, -3.0, 3.0, -1.0];
            let bend = [0, 1, 2, 3].map(|next| (curves * (k + next), bend[next]));
            system.add(&bend, 0.0, stiffness);
        }
        let of_correction = if is_corrected {
            each - FREE_OF_CORRECTION
        } else {
            0
        };
        for k in 0..of_correction {
            let bend = [1.0, -2.0, 1.0];
            let bend = [0, 1, 2].map(|next| (curves * (k + next) + 1, bend[next]));
            system.add(&bend, 0.0, stiffness);
        }
        let (squares, ln_determinant) = system.solve();
        let ln_volume = ln_determinant - (each - FREE + of_correction) as f64 * ln_stiffness;
        let is_finite = squares.is_finite() && ln_volume.is_finite();
        is_finite.then_some(Self { squares, ln_volume })
    }
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

/// Normal equations of a linear least-squares fit in which only close coefficients meet.
struct System {
    /// The band up to the diagonal, row by row.
    matrix: Vec<f64>,
    /// Entries of a row.
    band: usize,
    right: Vec<f64>,
    squares: f64,
}

impl System {
    fn new(size: usize, band: usize) -> Self {
        Self {
            matrix: vec![0.0; size * band],
            band,
            right: vec![0.0; size],
            squares: 0.0,
        }
    }

    /// Place of an entry; the diagonal ends its row.
    const fn place(&self, row: usize, column: usize) -> usize {
        (row + 1) * self.band - 1 + column - row
    }

    /// Adds an equation of some coefficients, in order, with its weight.
    fn add(&mut self, row: &[(usize, f64)], y: f64, weight: f64) {
        for (index, &(k, value)) in row.iter().enumerate() {
            let weighted = weight * value;
            self.right[k] += weighted * y;
            for &(before, other) in &row[..=index] {
                let place = self.place(k, before);
                self.matrix[place] += weighted * other;
            }
        }
        self.squares += weight * y * y;
    }

    /// Least sum of squares, and ln of the determinant, by the factors of Cholesky. Directions that the others contain
    /// count as 1.
    fn solve(mut self) -> (f64, f64) {
        let mut ln_determinant = 0.0;
        for row in 0..self.right.len() {
            let first = (row + 1).saturating_sub(self.band);
            // What the factors before a column already hold of an entry.
            let known = |factors: &[f64], of: &Self, column: usize| -> f64 {
                let start = first.max((column + 1).saturating_sub(of.band));
                let own = &factors[of.place(row, start)..of.place(row, column)];
                let other = &factors[of.place(column, start)..of.place(column, column)];
                own.iter().zip(other).map(|(a, b)| a * b).sum()
            };
            for column in first..row {
                let pivot = self.matrix[self.place(column, column)];
                let place = self.place(row, column);
                let rest = self.matrix[place] - known(&self.matrix, &self, column);
                self.matrix[place] = if pivot > 0.0 { rest / pivot } else { 0.0 };
            }
            let end = self.place(row, row);
            let diagonal = self.matrix[end];
            let rest = diagonal - known(&self.matrix, &self, row);
            if rest > ROUND_OFF * diagonal {
                let pivot = rest.sqrt();
                self.matrix[end] = pivot;
                ln_determinant += libm::log(rest);
                let own = &self.matrix[self.place(row, first)..end];
                let right = &self.right[first..row];
                let known: f64 = own.iter().zip(right).map(|(a, b)| a * b).sum();
                self.right[row] = (self.right[row] - known) / pivot;
                self.squares -= self.right[row] * self.right[row];
            } else {
                self.matrix[end] = 0.0;
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

    fn scaled(correction: f64, x: f64, y: f64) -> Scaled {
        let point = point(x, y, 0.5);
        Scaled { correction, point }
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
        let mut system = System::new(2, 2);
        for (x, y) in [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)] {
            system.add(&[(0, 1.0), (1, x)], y, 1.0);
        }
        let (squares, ln_determinant) = system.solve();
        assert!((squares - 1.0 / 6.0).abs() < 1e-12);
        assert!((ln_determinant - libm::log(6.0)).abs() < 1e-12);
    }

    #[test]
    fn a_correction_takes_up_what_fades_along_the_curves() {
        let at = |size: f64| (0..9).map(move |k| (size, f64::from(k)));
        let points = [1.0, 0.5, 0.25].into_iter().flat_map(at);
        let points = points.map(|(size, x)| scaled(size, x, 2.0 * x + 2.0 * (3.0 - x) * size));
        let points: Vec<Scaled> = points.collect();
        let left = |is_corrected| {
            Smooth::of(&points, INTERVALS, 3.0, is_corrected)
                .unwrap()
                .squares
        };
        assert!(left(false) > 10.0 && left(true) < 1e-6);
        assert!(Smooth::of(&points[..1], INTERVALS, 0.0, false).is_none());
    }
}
