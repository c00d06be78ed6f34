//! One coordinate system: a frame with ticks on all sides, and the map from values to places on the page.

use crate::axis::{Axis, Tick};
use crate::colour::{BLACK, Colour};
use crate::drawing::{Anchor, Drawing, Point, Rectangle, Stroke};
use crate::series::Sample;
use crate::style::{
    FRAME_WEIGHT, LABEL_BASELINE, LABEL_SIZE, LABEL_SPACE, RIGHT_MARGIN, TICK_SIZE, TICK_SPACE,
};
use crate::text::{DIGIT_HEIGHT, Text};

/// Space on an axis for each label of its ticks, in points.
const ROOM_PER_LABEL_ACROSS: f64 = 38.0;
const ROOM_PER_LABEL_UP: f64 = 13.5;
/// Gap between a frame and the labels of its ticks.
pub(crate) const TICK_GAP: f64 = 3.0;

/// A frame with two axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Panel {
    pub(crate) frame: Rectangle,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
}

/// What is written around a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Labels<'a> {
    /// Name of the horizontal axis; without it the frame shares the axis of the one below and has no numbers.
    pub(crate) x: Option<&'a str>,
    /// Name of the vertical axis.
    pub(crate) y: &'a str,
    /// Letter of the panel in a figure of several.
    pub(crate) letter: Option<char>,
}

/// Ticks of a frame, and where the name of its vertical axis stands.
#[derive(Clone, Debug)]
pub(crate) struct Ticks {
    pub(crate) x: Vec<Tick>,
    pub(crate) y: Vec<Tick>,
    /// Baseline of the name of the vertical axis from the left edge of the page; without it the frame shares the axis
    /// of the one at its left and has no numbers.
    pub(crate) y_baseline: Option<f64>,
}

impl Panel {
    /// Place of a value on the page.
    pub(crate) fn place(&self, x: f64, y: f64) -> Point {
        Point {
            x: self.across(x),
            y: self.up(y),
        }
    }

    /// Horizontal place of a value.
    pub(crate) fn across(&self, x: f64) -> f64 {
        self.frame.left + self.frame.width * self.x.fraction(x)
    }

    /// Vertical place of a value.
    pub(crate) fn up(&self, y: f64) -> f64 {
        self.frame.bottom() - self.frame.height * self.y.fraction(y)
    }

    /// Places of a line.
    pub(crate) fn line<'a>(
        &'a self,
        samples: &'a [Sample],
    ) -> impl DoubleEndedIterator<Item = Point> + 'a {
        samples.iter().map(|sample| self.place(sample.x, sample.y))
    }

    /// Polygon of the band that errors span around a line.
    pub(crate) fn band(&self, samples: &[Sample]) -> Vec<Point> {
        let upper = samples
            .iter()
            .map(|sample| self.place(sample.x, sample.y + sample.error));
        let lower = samples
            .iter()
            .rev()
            .map(|sample| self.place(sample.x, sample.y - sample.error));
        upper.chain(lower).collect()
    }

    /// A line from side to side at a height.
    pub(crate) fn level(
        &self,
        drawing: &mut Drawing,
        name: &'static str,
        value: f64,
        stroke: Stroke,
    ) {
        let height = self.up(value);
        drawing.layer(name, Some(self.frame)).segment(
            (self.frame.left, height),
            (self.frame.right(), height),
            stroke,
        );
    }

    /// Draws the frame, its ticks and its labels.
    pub(crate) fn draw_frame(&self, drawing: &mut Drawing, labels: &Labels<'_>) {
        let ticks = Ticks {
            x: self.x.ticks(labels_across(self.frame.width)),
            y: self.y.ticks(labels_up(self.frame.height)),
            y_baseline: Some(LABEL_BASELINE),
        };
        self.draw_ticked_frame(drawing, labels, &ticks);
    }

    /// Draws the frame and its labels with ticks that were chosen already.
    pub(crate) fn draw_ticked_frame(
        &self,
        drawing: &mut Drawing,
        labels: &Labels<'_>,
        ticks: &Ticks,
    ) {
        let frame = self.frame;
        let pen = Stroke::solid(BLACK, FRAME_WEIGHT);
        let layer = drawing.layer("axes", None);
        let mut marks = Vec::new();
        for tick in &ticks.x {
            let place = self.across(tick.value);
            for (edge, inside) in [(frame.bottom(), -tick.length), (frame.top, tick.length)] {
                marks.push([edge, edge + inside].map(|y| Point { x: place, y }));
            }
            if let (Some(_), Some(label)) = (labels.x, &tick.label) {
                let baseline = frame.bottom() + TICK_GAP + DIGIT_HEIGHT * TICK_SIZE;
                layer.text(
                    (place, baseline),
                    Anchor::Middle,
                    Text::new(label, TICK_SIZE),
                    BLACK,
                );
            }
        }
        for tick in &ticks.y {
            let place = self.up(tick.value);
            for (edge, inside) in [(frame.left, tick.length), (frame.right(), -tick.length)] {
                marks.push([edge, edge + inside].map(|x| Point { x, y: place }));
            }
            if let (Some(_), Some(label)) = (ticks.y_baseline, &tick.label) {
                let baseline = place + DIGIT_HEIGHT * TICK_SIZE / 2.0;
                layer.text(
                    (frame.left - TICK_GAP, baseline),
                    Anchor::End,
                    Text::new(label, TICK_SIZE),
                    BLACK,
                );
            }
        }
        layer.segments(marks, pen);
        layer.outline(frame, pen);
        if let Some(label) = labels.x {
            let middle = (frame.left + frame.right()) / 2.0;
            let text = Text::fitted(label, LABEL_SIZE, frame.width);
            layer.text(
                (middle, frame.bottom() + TICK_SPACE + LABEL_SIZE),
                Anchor::Middle,
                text,
                BLACK,
            );
        }
        if let Some(baseline) = ticks.y_baseline {
            let middle = (frame.top + frame.bottom()) / 2.0;
            let text = Text::fitted(labels.y, LABEL_SIZE, frame.height);
            layer.upward_text((baseline, middle), Anchor::Middle, text, BLACK);
        }
        if let Some(letter) = labels.letter {
            // Outside of the frame, where it can cover nothing.
            let text = Text::new(&format!("({letter})"), LABEL_SIZE);
            layer.text(
                (frame.right() + 3.0, frame.top + DIGIT_HEIGHT * LABEL_SIZE),
                Anchor::Start,
                text,
                BLACK,
            );
        }
    }
}

/// Space at the left of a frame for the name of the vertical axis and the labels of its ticks.
pub(crate) fn left_margin(axis: &Axis, height: f64) -> f64 {
    let widths = axis
        .ticks(labels_up(height))
        .into_iter()
        .filter_map(|tick| tick.label);
    let widest = widths.fold(0.0, |widest: f64, label| {
        widest.max(Text::new(&label, TICK_SIZE).width)
    });
    LABEL_BASELINE + 4.0 + widest + TICK_GAP
}

/// Space at the right of a frame: half of a tick's label may reach over its end.
pub(crate) fn right_margin(axis: &Axis, width: f64) -> f64 {
    let last = axis
        .ticks(labels_across(width))
        .into_iter()
        .rev()
        .find_map(|tick| Some((axis.fraction(tick.value), tick.label?)));
    let over = last.map_or(0.0, |(place, label)| {
        Text::new(&label, TICK_SIZE).width / 2.0 - (1.0 - place) * width
    });
    RIGHT_MARGIN.max(over + 2.0)
}

/// Space below a frame for numbers and name of the horizontal axis.
pub(crate) const BOTTOM_MARGIN: f64 = TICK_SPACE + LABEL_SPACE;

fn labels_across(width: f64) -> usize {
    (width / ROOM_PER_LABEL_ACROSS) as usize
}

fn labels_up(height: f64) -> usize {
    (height / ROOM_PER_LABEL_UP) as usize
}

/// Draws a title, or nothing for an empty one, centred at the top of the page; returns the space that it takes.
pub(crate) fn draw_title(drawing: &mut Drawing, title: &str, width: f64) -> f64 {
    let space = title_space(title);
    if space > 0.0 {
        let text = Text::fitted(title, crate::style::TITLE_SIZE, width - 2.0 * RIGHT_MARGIN);
        drawing
            .layer("title", None)
            .text((width / 2.0, 9.0), Anchor::Middle, text, BLACK);
    }
    space
}

/// Space that a title takes at the top of the page.
pub(crate) fn title_space(title: &str) -> f64 {
    if title.is_empty() {
        0.0
    } else {
        crate::style::TITLE_SPACE
    }
}

/// A thin line at a level that guides the eye.
pub(crate) fn guide() -> Stroke {
    const GUIDE: Colour = Colour::new(185, 185, 185);
    Stroke::solid(GUIDE, 0.4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Scale;

    fn panel(scale: Scale) -> Panel {
        Panel {
            frame: Rectangle {
                left: 30.0,
                top: 10.0,
                width: 200.0,
                height: 100.0,
            },
            x: Axis::linear((0.0, 4.0)),
            y: Axis::with_margin(scale, (0.1, 10.0), 0.0),
        }
    }

    #[test]
    fn larger_values_lie_further_right_and_higher() {
        assert_eq!(
            panel(Scale::Linear).place(0.0, 0.1),
            Point { x: 30.0, y: 110.0 }
        );
        assert_eq!(
            panel(Scale::Linear).place(4.0, 10.0),
            Point { x: 230.0, y: 10.0 }
        );
        let middle = panel(Scale::Logarithmic).place(1.0, 1.0);
        assert!(
            (middle.x - 80.0).abs() < 1e-9 && (middle.y - 60.0).abs() < 1e-9,
            "{middle:?}"
        );
    }

    #[test]
    fn a_band_runs_forth_above_and_back_below() {
        let samples = [
            Sample {
                x: 1.0,
                y: 2.0,
                error: 0.5,
            },
            Sample {
                x: 2.0,
                y: 3.0,
                error: 0.25,
            },
        ];
        let panel = panel(Scale::Linear);
        let expected =
            [(1.0, 2.5), (2.0, 3.25), (2.0, 2.75), (1.0, 1.5)].map(|(x, y)| panel.place(x, y));
        assert_eq!(panel.band(&samples), expected);
    }
}
