//! Rows of a table as curves on the page.

use crate::drawing::Point;
use crate::envelope::envelope;
use crate::panel::Panel;
use crate::series::Sample;

/// x and y.
pub(super) type Row = (f64, f64);

/// Columns of the envelope in a point of the page.
const COLUMNS_PER_POINT: f64 = 2.0;
/// How far from the page a curve is followed, in points.
const BEYOND: f64 = 5000.0;

/// The finite rows on the page, cut into unbroken pieces wherever a row is not finite.
pub(super) fn pieces(panel: &Panel, rows: &[Row]) -> Vec<Vec<Point>> {
    rows.split(|(x, y)| !(x.is_finite() && y.is_finite()))
        .filter(|piece| !piece.is_empty())
        .map(|piece| {
            let on_page = |&(x, y): &Row| {
                let place = panel.place(x, y);
                Point {
                    x: place.x.clamp(-BEYOND, BEYOND),
                    y: place.y.clamp(-BEYOND, BEYOND),
                }
            };
            piece.iter().map(on_page).collect()
        })
        .collect()
}

/// A curve whose every height holds until the next place.
pub(super) fn steps(curve: &[Point]) -> Vec<Point> {
    let mut stepped = Vec::with_capacity(2 * curve.len());
    for pair in curve.windows(2) {
        stepped.push(pair[0]);
        if pair[1].y != pair[0].y {
            stepped.push(Point {
                x: pair[1].x,
                y: pair[0].y,
            });
        }
    }
    stepped.extend(curve.last());
    stepped
}

/// A curve thinned to what can be seen.
pub(super) fn thinned(panel: &Panel, curve: Vec<Point>) -> Vec<Point> {
    let samples: Vec<Sample> = curve
        .iter()
        .map(|point| Sample {
            x: point.x,
            y: point.y,
            error: 0.0,
        })
        .collect();
    let frame = panel.frame;
    let columns = (frame.width * COLUMNS_PER_POINT) as usize;
    envelope(&samples, (frame.left, frame.right()), columns.max(1))
        .iter()
        .map(|sample| Point {
            x: sample.x,
            y: sample.y,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_holds_until_the_next_place() {
        let curve = [(0.0, 5.0), (2.0, 3.0), (4.0, 3.0)].map(|(x, y)| Point { x, y });
        let corners: Vec<(f64, f64)> = steps(&curve).iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(corners, [(0.0, 5.0), (2.0, 5.0), (2.0, 3.0), (4.0, 3.0)]);
    }
}
