//! Colours that mean values, and the bar that says which.

use crate::axis::{Axis, Scale, Tick};
use crate::colour::{BLACK, Colour, GREY, cyclic, diverging, sequential};
use crate::drawing::{Anchor, Drawing, Point, Rectangle, Stroke};
use crate::error::FigureError;
use crate::panel::TICK_GAP;
use crate::style::{FRAME_WEIGHT, LABEL_SIZE, MAJOR_TICK, TICK_SIZE};
use crate::text::{DIGIT_HEIGHT, Text};

/// A family of colours that colour-blind readers can order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    /// Dark violet through green to yellow, for amounts.
    #[default]
    Sequential,
    /// Blue through white to red, for values on both sides of the middle of the scale.
    Diverging,
    /// Light through blue, dark and red to light again, for what begins anew where it ends.
    Cyclic,
}

/// Which value has which colour; values beyond the ends have the colours of the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourScale {
    label: String,
    least: f64,
    largest: f64,
    scale: Scale,
    palette: Palette,
    /// Part of the sequential palette that is used: its lightest end is lost as a line on white.
    reach: f64,
}

const BAR_WIDTH: f64 = 7.0;
const BAR_STEPS: usize = 128;
/// Gap between a frame and the bar at its right.
const BAR_GAP: f64 = 7.0;
const ROOM_PER_LABEL: f64 = 13.5;
const MOST_LABELS: usize = 6;
/// Gap between the numbers of a bar across.
const ROOM_BETWEEN_LABELS: f64 = 8.0;
const REACH_ON_WHITE: f64 = 0.9;

impl ColourScale {
    /// A linear scale in sequential colours, with its label in markup.
    pub fn new(label: &str, least: f64, largest: f64) -> Self {
        Self {
            label: label.to_owned(),
            least,
            largest,
            scale: Scale::Linear,
            palette: Palette::Sequential,
            reach: 1.0,
        }
    }

    /// The same with equal steps of colour for equal ratios.
    #[must_use]
    pub fn logarithmic(self) -> Self {
        Self {
            scale: Scale::Logarithmic,
            ..self
        }
    }

    /// The same in the colours of another palette.
    #[must_use]
    pub fn palette(self, palette: Palette) -> Self {
        Self { palette, ..self }
    }

    /// The same without the colours that would be lost as lines on white.
    pub(crate) fn on_white(self) -> Self {
        Self {
            reach: REACH_ON_WHITE,
            ..self
        }
    }

    /// Red, green and blue of a value as bytes of sRGB; grey where it is not a number.
    #[must_use]
    pub fn srgb(&self, value: f64) -> [u8; 3] {
        let colour = if value.is_nan() {
            GREY
        } else {
            self.colour(value)
        };
        [colour.red, colour.green, colour.blue]
    }

    pub(crate) fn check(&self) -> Result<(), FigureError> {
        let lowest = match self.scale {
            Scale::Linear => f64::MIN,
            Scale::Logarithmic => f64::MIN_POSITIVE,
        };
        if lowest <= self.least && self.least < self.largest && self.largest.is_finite() {
            Ok(())
        } else {
            Err(FigureError::AxisRange {
                axis: "colour",
                least: self.least,
                largest: self.largest,
            })
        }
    }

    fn axis(&self) -> Axis {
        Axis::exact(self.scale, (self.least, self.largest))
    }

    /// Colour of a value.
    pub(crate) fn colour(&self, value: f64) -> Colour {
        self.colour_at(self.axis().fraction(value))
    }

    fn colour_at(&self, fraction: f64) -> Colour {
        match self.palette {
            Palette::Sequential => sequential(self.reach * fraction.clamp(0.0, 1.0)),
            Palette::Diverging => diverging(2.0 * fraction - 1.0),
            Palette::Cyclic => cyclic(fraction),
        }
    }

    fn ticks(&self, height: f64) -> Vec<Tick> {
        self.axis().fitting_ticks(
            height,
            ((height / ROOM_PER_LABEL) as usize).min(MOST_LABELS),
            |_| ROOM_PER_LABEL - 3.0,
        )
    }

    fn numbers_width(&self, height: f64) -> f64 {
        self.ticks(height)
            .iter()
            .filter_map(|tick| tick.label.as_ref())
            .fold(0.0, |widest: f64, label| {
                widest.max(Text::new(label, TICK_SIZE).width)
            })
    }

    /// Space that a bar of a height takes at the right of a frame, up to the edge of the page.
    pub(crate) fn space(&self, height: f64) -> f64 {
        let label = if self.label.is_empty() {
            0.0
        } else {
            LABEL_SIZE + 3.0
        };
        BAR_GAP + BAR_WIDTH + TICK_GAP + self.numbers_width(height) + label + 3.0
    }

    /// Draws the bar across, its label before it and its numbers below.
    pub(crate) fn draw_bar_across(&self, drawing: &mut Drawing, area: Rectangle, ink: Colour) {
        let layer = drawing.layer("colour bar", None);
        let colours =
            (0..BAR_STEPS).map(|step| self.colour_at((step as f64 + 0.5) / BAR_STEPS as f64));
        layer.cells(area, BAR_STEPS, colours.collect());
        let pen = Stroke::solid(ink, FRAME_WEIGHT);
        let axis = self.axis();
        let ticks = axis.fitting_ticks(area.width, MOST_LABELS, |label| {
            Text::new(label, TICK_SIZE).width + ROOM_BETWEEN_LABELS
        });
        let mut segments = Vec::new();
        for tick in ticks {
            let x = area.left + area.width * axis.fraction(tick.value);
            let length = if tick.length < MAJOR_TICK { 1.0 } else { 2.0 };
            segments.push([area.bottom(), area.bottom() + length].map(|y| Point { x, y }));
            if let Some(label) = &tick.label {
                let baseline = area.bottom() + TICK_GAP + DIGIT_HEIGHT * TICK_SIZE;
                layer.text(
                    (x, baseline),
                    Anchor::Middle,
                    Text::new(label, TICK_SIZE),
                    ink,
                );
            }
        }
        layer.segments(segments, pen);
        layer.outline(area, pen);
        let middle = area.top + area.height / 2.0 + DIGIT_HEIGHT * LABEL_SIZE / 2.0;
        layer.text(
            (area.left - BAR_GAP, middle),
            Anchor::End,
            Text::new(&self.label, LABEL_SIZE),
            ink,
        );
    }

    /// Draws the bar at the right of a frame.
    pub(crate) fn draw_bar(&self, drawing: &mut Drawing, frame: Rectangle) {
        let area = Rectangle {
            left: frame.right() + BAR_GAP,
            width: BAR_WIDTH,
            ..frame
        };
        let layer = drawing.layer("colour bar", None);
        let colours = (0..BAR_STEPS)
            .rev()
            .map(|step| self.colour_at((step as f64 + 0.5) / BAR_STEPS as f64));
        layer.cells(area, 1, colours.collect());
        let pen = Stroke::solid(BLACK, FRAME_WEIGHT);
        let axis = self.axis();
        let mut segments = Vec::new();
        for tick in self.ticks(area.height) {
            let y = area.bottom() - area.height * axis.fraction(tick.value);
            // Ticks inside would be lost in dark colours.
            let length = tick.length * if tick.length < MAJOR_TICK { 0.6 } else { 0.66 };
            segments.push([area.right(), area.right() + length].map(|x| Point { x, y }));
            if let Some(label) = &tick.label {
                layer.text(
                    (area.right() + TICK_GAP, y + DIGIT_HEIGHT * TICK_SIZE / 2.0),
                    Anchor::Start,
                    Text::new(label, TICK_SIZE),
                    BLACK,
                );
            }
        }
        layer.segments(segments, pen);
        layer.outline(area, pen);
        if !self.label.is_empty() {
            let baseline =
                area.right() + TICK_GAP + self.numbers_width(area.height) + LABEL_SIZE + 1.0;
            let middle = (area.top + area.bottom()) / 2.0;
            let text = Text::fitted(&self.label, LABEL_SIZE, area.height);
            layer.upward_text((baseline, middle), Anchor::Middle, text, BLACK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_scale_are_the_ends_of_the_palette() {
        let scale = ColourScale::new("", 0.01, 1.0).logarithmic();
        assert_eq!(scale.colour(0.01), sequential(0.0));
        assert_eq!(scale.colour(1.0), sequential(1.0));
        assert_eq!(scale.colour(0.1), sequential(0.5));
        let signed = ColourScale::new("", -2.0, 2.0).palette(Palette::Diverging);
        assert_eq!(signed.colour(0.0), diverging(0.0));
        assert_eq!(signed.colour(9.0), diverging(1.0));
    }

    #[test]
    fn a_scale_must_increase_and_be_positive_where_it_is_logarithmic() {
        assert!(ColourScale::new("", 0.0, 1.0).check().is_ok());
        for scale in [
            ColourScale::new("", 0.0, 1.0).logarithmic(),
            ColourScale::new("", 1.0, 1.0),
            ColourScale::new("", f64::NAN, 1.0),
            ColourScale::new("", 0.0, f64::INFINITY),
        ] {
            assert!(matches!(
                scale.check(),
                Err(FigureError::AxisRange { axis: "colour", .. })
            ));
        }
    }
}
