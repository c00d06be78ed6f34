//! Free places in a panel: where a label or a legend covers no data.

use crate::geometry::{Point, Rectangle};

/// What must not be covered, as straight lines on the page.
#[derive(Clone, Debug, Default)]
pub(super) struct Obstacles {
    segments: Vec<[Point; 2]>,
}

/// Free space kept around an obstacle, in points.
const CLEARANCE: f64 = 2.5;
/// Space between the frame and a box in it.
pub(super) const INSET: f64 = 5.5;
/// Places tried from side to side.
const TRIALS: usize = 24;

impl Obstacles {
    /// A line through points.
    pub(super) fn line(&mut self, points: &[Point]) {
        if let [lone] = points {
            self.segments.push([*lone, *lone]);
        }
        self.segments
            .extend(points.windows(2).map(|pair| [pair[0], pair[1]]));
    }

    /// A box, by its outline and its diagonals.
    pub(super) fn area(&mut self, area: Rectangle) {
        let [a, b, c, d] = area.corners();
        self.line(&[a, b, c, d, a, c]);
        self.line(&[b, d]);
    }

    /// Number of obstacles that a box would cover or come too close to.
    fn covered(&self, area: Rectangle) -> usize {
        let corner = (area.left - CLEARANCE, area.top - CLEARANCE);
        let [width, height] = [area.width, area.height].map(|length| length + 2.0 * CLEARANCE);
        let kept = Rectangle::new(corner, (width, height));
        let segments = self.segments.iter();
        segments.filter(|segment| crosses(**segment, kept)).count()
    }

    /// The first of some boxes that covers least.
    pub(super) fn freest(
        &self,
        places: impl IntoIterator<Item = Rectangle>,
    ) -> Option<(Rectangle, usize)> {
        let mut best = None;
        for place in places {
            let covered = self.covered(place);
            if best.is_none_or(|(_, least)| covered < least) {
                best = Some((place, covered));
            }
            if covered == 0 {
                break;
            }
        }
        best
    }

    /// A place in a frame where a box of some size covers nothing: a corner if there is one, else the place nearest to
    /// one; none if everything is taken.
    pub(super) fn free_place(
        &self,
        frame: Rectangle,
        width: f64,
        height: f64,
    ) -> Option<Rectangle> {
        let across = frame.width - 2.0 * INSET - width;
        let down = frame.height - 2.0 * INSET - height;
        if across < 0.0 || down < 0.0 {
            return None;
        }
        let step = |index: usize| index as f64 / TRIALS as f64;
        let mut shares: Vec<(f64, f64)> = (0..=TRIALS)
            .flat_map(|x| (0..=TRIALS).map(move |y| (step(x), step(y))))
            .collect();
        // From the corners inwards, the upper right first.
        let distance = |share: &(f64, f64)| {
            let (x, y) = (share.0.min(1.0 - share.0), share.1.min(1.0 - share.1));
            let turn = 1e-6 * ((1.0 - share.0) + 2.0 * share.1);
            x.min(y) * 3.0 + x + y + turn
        };
        shares.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
        let places = shares.into_iter().map(|(x, y)| {
            let left = frame.left + INSET + x * across;
            let top = frame.top + INSET + y * down;
            Rectangle::new((left, top), (width, height))
        });
        let (place, covered) = self.freest(places)?;
        (covered == 0).then_some(place)
    }
}

/// Whether a straight line meets a box (Liang and Barsky's clipping).
fn crosses([from, to]: [Point; 2], area: Rectangle) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (start, end, least, largest) in [
        (from.x, to.x, area.left, area.right()),
        (from.y, to.y, area.top, area.bottom()),
    ] {
        let length = end - start;
        if length == 0.0 {
            if start < least || start > largest {
                return false;
            }
            continue;
        }
        let (one, other) = ((least - start) / length, (largest - start) / length);
        enter = enter.max(one.min(other));
        leave = leave.min(one.max(other));
    }
    enter <= leave
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rectangle = Rectangle::new((0.0, 0.0), (100.0, 80.0));

    fn point(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    #[test]
    fn a_line_through_a_box_meets_it_without_an_end_inside() {
        let area = Rectangle::new((10.0, 10.0), (10.0, 10.0));
        assert!(crosses([point(0.0, 15.0), point(30.0, 16.0)], area));
        assert!(crosses([point(15.0, 0.0), point(15.0, 30.0)], area));
        assert!(!crosses([point(0.0, 15.0), point(9.0, 15.0)], area));
        assert!(!crosses([point(-2.0, 19.0), point(19.0, -2.0)], area));
        assert!(crosses([point(12.0, 12.0), point(12.0, 12.0)], area));
    }

    #[test]
    fn a_legend_goes_to_the_corner_that_is_free() {
        let mut obstacles = Obstacles::default();
        let line = [(50.0, 5.0), (95.0, 5.0), (95.0, 75.0), (5.0, 75.0)];
        obstacles.line(&line.map(|(x, y)| point(x, y)));
        let place = obstacles.free_place(FRAME, 30.0, 20.0).expect("room");
        assert_eq!((place.left, place.top), (INSET, INSET));
    }

    #[test]
    fn a_full_panel_has_no_place() {
        let mut obstacles = Obstacles::default();
        for step in 0..20 {
            let y = 4.0 * f64::from(step);
            obstacles.line(&[point(0.0, y), point(100.0, y)]);
        }
        assert!(obstacles.free_place(FRAME, 30.0, 20.0).is_none());
        assert!(Obstacles::default().free_place(FRAME, 99.0, 20.0).is_none());
    }
}
