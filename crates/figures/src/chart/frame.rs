//! One coordinate system on the page: a frame with ticks on all sides, and the map from values to places.

use crate::axis::{Axis, Side, Tick};
use crate::colour::BLACK;
use crate::drawing::{Anchor, Drawing, Stroke};
use crate::geometry::{Path, Point, Rectangle};
use crate::style::{FRAME_WEIGHT, LABEL_SIZE, TICK_SPACE};
use crate::text::Text;

/// A rectangle with two axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) area: Rectangle,
    pub(super) x: Axis,
    pub(super) y: Axis,
}

/// What stands around a frame.
#[derive(Clone, Debug)]
pub(super) struct Surround {
    pub(super) x_ticks: Vec<Tick>,
    pub(super) y_ticks: Vec<Tick>,
    /// Without numbers the frame shares the axis of the one below.
    pub(super) has_x_numbers: bool,
    /// Baseline of the name of the vertical axis from the left edge of the page; without it the frame shares the axis
    /// of the one at its left and has no numbers.
    pub(super) y_baseline: Option<f64>,
}

impl Frame {
    /// Place of a value on the page.
    pub(super) fn place(&self, x: f64, y: f64) -> Point {
        Point::new(self.across(x), self.up(y))
    }

    /// Horizontal place of a value.
    pub(super) fn across(&self, x: f64) -> f64 {
        self.area.left + self.area.width * self.x.fraction(x)
    }

    /// Vertical place of a value.
    pub(super) fn up(&self, y: f64) -> f64 {
        self.area.bottom() - self.area.height * self.y.fraction(y)
    }

    /// Draws the frame, its ticks with their numbers, and the names of its axes.
    pub(super) fn draw(
        &self,
        drawing: &mut Drawing,
        around: &Surround,
        [x_name, y_name]: [&str; 2],
    ) {
        let area = self.area;
        let layer = drawing.layer("axes", None);
        let mut marks = Vec::new();
        for tick in &around.x_ticks {
            let x = self.across(tick.value);
            for (edge, inside) in [(area.bottom(), -tick.length), (area.top, tick.length)] {
                marks.push([edge, edge + inside].map(|y| Point::new(x, y)));
            }
            if around.has_x_numbers {
                layer.number((x, area.bottom()), Side::Below, tick, BLACK);
            }
        }
        for tick in &around.y_ticks {
            let y = self.up(tick.value);
            for (edge, inside) in [(area.left, tick.length), (area.right(), -tick.length)] {
                marks.push([edge, edge + inside].map(|x| Point::new(x, y)));
            }
            if around.y_baseline.is_some() {
                layer.number((area.left, y), Side::Left, tick, BLACK);
            }
        }
        let pen = Stroke::solid(BLACK, FRAME_WEIGHT);
        layer.stroke(Path::segments(marks), pen);
        layer.stroke(Path::polygon(area.corners()), pen);
        if around.has_x_numbers {
            let middle = area.left + area.width / 2.0;
            let baseline = area.bottom() + TICK_SPACE + LABEL_SIZE;
            let text = Text::fitted(x_name, LABEL_SIZE, area.width);
            layer.text((middle, baseline), Anchor::Middle, text, BLACK);
        }
        if let Some(baseline) = around.y_baseline {
            let middle = area.top + area.height / 2.0;
            let text = Text::fitted(y_name, LABEL_SIZE, area.height);
            layer.text_upward((baseline, middle), Anchor::Middle, text, BLACK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Scale;

    #[test]
    fn larger_values_lie_further_right_and_higher() {
        let frame = |scale| Frame {
            area: Rectangle::new((30.0, 10.0), (200.0, 100.0)),
            x: Axis::new(Scale::Linear, (0.0, 4.0)),
            y: Axis::new(scale, (0.1, 10.0)),
        };
        let linear = frame(Scale::Linear);
        assert_eq!(linear.place(0.0, 0.1), Point::new(30.0, 110.0));
        assert_eq!(linear.place(4.0, 10.0), Point::new(230.0, 10.0));
        let middle = frame(Scale::Logarithmic).place(1.0, 1.0);
        assert!(
            (middle.x - 80.0).abs() < 1e-9 && (middle.y - 60.0).abs() < 1e-9,
            "{middle:?}"
        );
    }
}
