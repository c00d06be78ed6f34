//! Rows of a table as curves on the page.

use super::frame::Frame;
use super::layer::{Band, Field};
use crate::geometry::Point;

/// Columns of a thinned curve or field in a point of the page.
const COLUMNS_PER_POINT: f64 = 2.0;
/// How far from the page a curve is followed, in points.
const BEYOND: f64 = 5000.0;

/// The finite rows of two columns on the page, cut into unbroken pieces wherever a row is not finite.
pub(super) fn pieces(frame: &Frame, x: &[f64], y: &[f64]) -> Vec<Vec<Point>> {
    let rows: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let on_page = |&(x, y): &(f64, f64)| {
        let place = frame.place(x, y);
        let [x, y] = [place.x, place.y].map(|it| it.clamp(-BEYOND, BEYOND));
        Point::new(x, y)
    };
    rows.split(|(x, y)| !(x.is_finite() && y.is_finite()))
        .filter(|piece| !piece.is_empty())
        .map(|piece| piece.iter().map(on_page).collect())
        .collect()
}

impl Band {
    /// The upper and the lower curve, neither finite where the other is not.
    pub(super) fn pairs(&self) -> [Vec<f64>; 2] {
        [(&self.upper, &self.lower), (&self.lower, &self.upper)].map(|(bound, other)| {
            let rows = bound.iter().zip(other);
            let known = rows.map(|(&row, other)| if other.is_finite() { row } else { f64::NAN });
            known.collect()
        })
    }
}

/// A curve whose every height holds until the next place.
pub(super) fn steps(curve: &[Point]) -> Vec<Point> {
    let mut stepped = Vec::with_capacity(2 * curve.len());
    for pair in curve.windows(2) {
        stepped.push(pair[0]);
        if pair[1].y != pair[0].y {
            stepped.push(Point::new(pair[1].x, pair[0].y));
        }
    }
    stepped.extend(curve.last());
    stepped
}

/// A curve thinned to what can be seen in a frame.
pub(super) fn thinned(frame: &Frame, curve: Vec<Point>) -> Vec<Point> {
    let area = frame.area;
    envelope(curve, (area.left, area.right()), shown_columns(frame))
}

/// Thins a curve: of all consecutive points in one of `columns` equal steps of x, only the first, the last, the least
/// and the largest remain, in their order, so that no extreme is lost.
///
/// A curve of no more points than four a column comes back unchanged.
fn envelope(curve: Vec<Point>, range: (f64, f64), columns: usize) -> Vec<Point> {
    if curve.len() <= 4 * columns {
        return curve;
    }
    let width = (range.1 - range.0) / columns as f64;
    let column = |point: &Point| ((point.x - range.0) / width).floor();
    let mut thinned = Vec::with_capacity(4 * columns);
    for group in curve.chunk_by(|one, next| column(one) == column(next)) {
        let by_height = |&one: &usize, &other: &usize| group[one].y.total_cmp(&group[other].y);
        let all = 0..group.len();
        let mut kept = vec![0, group.len() - 1];
        kept.extend(all.clone().min_by(by_height));
        kept.extend(all.max_by(by_height));
        kept.sort_unstable();
        kept.dedup();
        thinned.extend(kept.into_iter().map(|index| group[index]));
    }
    thinned
}

fn shown_columns(frame: &Frame) -> usize {
    ((frame.area.width * COLUMNS_PER_POINT) as usize).max(1)
}

impl Field {
    pub(super) fn columns(&self) -> usize {
        self.values.len() / self.rows.max(1)
    }

    /// The cells as a frame shows them, row by row from the top, and the number of columns.
    pub(super) fn shown(&self, frame: &Frame) -> (usize, Vec<f64>) {
        let (columns, values) = averaged(&self.values, self.columns(), shown_columns(frame));
        let rows = values.chunks_exact(columns).rev();
        (columns, rows.flatten().copied().collect())
    }
}

/// A field with at most so many columns, each the mean over the finite values of equally many in a row, and how many
/// there are; the last columns may hold fewer.
fn averaged(values: &[f64], columns: usize, most: usize) -> (usize, Vec<f64>) {
    // Columns must stay equally wide, so that only a divisor of their number would be exact; the mean over the columns
    // that a shown one overlaps most with is right within one of many.
    let shown = columns.min(most);
    let mean = |part: &[f64]| {
        let finite = part.iter().filter(|value| value.is_finite());
        let count = finite.clone().count();
        finite.sum::<f64>() / count as f64
    };
    let end = |column: usize| column * columns / shown;
    let rows = values.chunks_exact(columns);
    let field = rows.flat_map(|row| (0..shown).map(move |it| mean(&row[end(it)..end(it + 1)])));
    (shown, field.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_holds_until_the_next_place() {
        let curve = [(0.0, 5.0), (2.0, 3.0), (4.0, 3.0)].map(|(x, y)| Point::new(x, y));
        let corners: Vec<(f64, f64)> = steps(&curve).iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(corners, [(0.0, 5.0), (2.0, 5.0), (2.0, 3.0), (4.0, 3.0)]);
    }

    #[test]
    fn a_thinned_curve_keeps_its_order_its_ends_and_the_extent_of_every_column() {
        let wave = |count: usize| -> Vec<Point> {
            let x = |index: usize| index as f64 / count as f64;
            (0..count)
                .map(|index| Point::new(x(index), libm::sin(900.0 * x(index))))
                .collect()
        };
        let mut line = wave(50_000);
        line[24_321].y = 17.0;
        line[12_345].y = -23.0;
        let thin = envelope(line.clone(), (0.0, 1.0), 100);
        assert!(thin.len() <= 400, "{}", thin.len());
        assert_eq!(
            (thin[0], thin[thin.len() - 1]),
            (line[0], line[line.len() - 1])
        );
        assert!(thin.windows(2).all(|pair| pair[0].x < pair[1].x));
        for column in 0..100 {
            let extent = |points: &[Point]| {
                let inside = |point: &&Point| (point.x * 100.0).floor() == f64::from(column);
                crate::axis::extent(points.iter().filter(inside).map(|point| point.y))
            };
            assert_eq!(extent(&line), extent(&thin), "column {column}");
        }
        let short = wave(300);
        assert_eq!(envelope(short.clone(), (0.0, 1.0), 100), short);
    }

    #[test]
    fn a_long_field_is_averaged_and_keeps_its_means() {
        let values: Vec<f64> = (0..12_000).map(|index| f64::from(index % 2)).collect();
        let (shown, means) = averaged(&values, 6000, 500);
        assert_eq!((shown, means.len()), (500, 1000));
        assert!(means.iter().all(|mean| (mean - 0.5).abs() < 1e-12));
        assert_eq!(averaged(&[1.0, 2.0], 2, 10), (2, vec![1.0, 2.0]));
    }
}
