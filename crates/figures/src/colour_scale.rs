//! Colours that mean values, and the bar that says which.

use crate::axis::{Axis, Scale, Side, Tick, widest};
use crate::colour::{BLACK, Colour, GREY, cyclic, diverging, force, sequential};
use crate::drawing::{Anchor, Drawing, Image, Layer, Stroke};
use crate::error::FigureError;
use crate::geometry::{Path, Point, Rectangle};
use crate::style::{FRAME_WEIGHT, LABEL_SIZE, MAJOR_TICK, TICK_GAP, TICK_SIZE, TICK_SPACE};
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
    /// Dark violet through red to light yellow, for forces beside grains in colours of another scale.
    Force,
}

/// Which value has which colour; values beyond the ends have the colours of the ends.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct ColourScale {
    pub(crate) label: String,
    least: f64,
    largest: f64,
    scale: Scale,
    palette: Palette,
    /// Part of the sequential palette that is used: its lightest end is lost as a line on white.
    pub(crate) reach: f64,
    /// Least and largest of the values that are shown, where some may lie beyond the ends.
    found: (f64, f64),
}

/// Width of a bar beside panels.
const BAR_WIDTH: f64 = 7.0;
/// Height and width of a bar below panels, and the space above it.
const LOW_BAR: (f64, f64) = (6.0, 110.0);
/// Largest part of the panels' width that it takes.
const LOW_BAR_PART: f64 = 0.36;
const SPACE_ABOVE: f64 = 5.0;
const BAR_STEPS: usize = 128;
/// Gap between a frame and the bar at its right.
pub(crate) const BAR_GAP: f64 = 7.0;
const ROOM_PER_LABEL: f64 = 13.5;
const MOST_LABELS: usize = 6;
/// From one line of a label to the next, and how many have room beside a bar.
const LINE: f64 = 8.8;
const LINES_BESIDE_BAR: f64 = 2.0;
/// Gap between the numbers of a bar across.
const ROOM_BETWEEN_LABELS: f64 = 8.0;
/// Room between the label of a bar across and the number at its left end, where they stand side by side.
const ROOM_BEFORE_NUMBER: f64 = 4.0;
/// Part of the sequential palette without the colours that would be lost as lines on white.
pub(crate) const REACH_ON_WHITE: f64 = 0.9;

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
            found: (least, largest),
        }
    }

    /// This scale with equal steps of colour for equal ratios.
    pub fn logarithmic(mut self) -> Self {
        self.scale = Scale::Logarithmic;
        self
    }

    /// This scale in the colours of another palette.
    pub fn palette(mut self, palette: Palette) -> Self {
        self.palette = palette;
        self
    }

    /// This scale for values between two: where some lie beyond its ends, the bar says so.
    pub fn found(mut self, least: f64, largest: f64) -> Self {
        self.found = (least, largest);
        self
    }

    /// Red, green and blue of a value as bytes of sRGB; grey where it is not a number.
    pub fn srgb(&self, value: f64) -> [u8; 3] {
        let is_known = !value.is_nan();
        let colour = is_known.then(|| self.colour(value));
        colour.unwrap_or(GREY).srgb()
    }

    /// Where a value lies between the ends, from 0 to 1.
    pub fn part(&self, value: f64) -> f64 {
        self.axis().fraction(value).clamp(0.0, 1.0)
    }

    pub(crate) fn check(&self) -> Result<(), FigureError> {
        let lowest = match self.scale {
            Scale::Linear | Scale::Counting => f64::MIN,
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
        Axis::new(self.scale, (self.least, self.largest))
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
            Palette::Force => force(fraction),
        }
    }

    /// Ticks of a bar, and numbers at its ends where there is room; an end with values beyond it is marked so, and numbers
    /// in the way of its mark are left out.
    fn ticks(&self, length: f64, most: usize, extent: impl Fn(&str) -> f64) -> Vec<Tick> {
        let axis = self.axis();
        let mut ticks = axis.fitting_ticks(length, most, &extent);
        let ends = [
            (self.least, self.found.0 < self.least, "≤ "),
            (self.largest, self.found.1 > self.largest, "≥ "),
        ];
        for (value, _, sign) in ends.into_iter().filter(|(_, is_passed, _)| *is_passed) {
            let place = axis.fraction(value);
            let apart = |tick: &Tick| length * (axis.fraction(tick.value) - place).abs();
            let at_end = ticks.iter().find(|tick| apart(tick) < 1e-6);
            let number = at_end.and_then(|tick| tick.label.clone());
            let number = number.unwrap_or_else(|| axis.label_of_end(value));
            let room = extent(&number);
            ticks.retain(|tick| apart(tick) >= 1e-6);
            for tick in ticks.iter_mut().filter(|tick| apart(tick) < room) {
                tick.label = None;
            }
            ticks.push(Tick {
                value,
                length: MAJOR_TICK,
                label: Some(format!("{sign}{number}")),
            });
        }
        ticks.extend(axis.end_ticks(length, &ticks, extent));
        ticks
    }

    fn ticks_across(&self, width: f64) -> Vec<Tick> {
        self.ticks(width, MOST_LABELS, |label| {
            Text::new(label, TICK_SIZE).width + ROOM_BETWEEN_LABELS
        })
    }

    /// How far the numbers of a bar across reach over its left and its right end.
    pub(crate) fn overhangs(&self, width: f64) -> [f64; 2] {
        let mut over: [f64; 2] = [0.0; 2];
        for tick in self.ticks_across(width) {
            let Some(label) = &tick.label else { continue };
            let half = Text::new(label, TICK_SIZE).width / 2.0;
            let place = width * self.axis().fraction(tick.value);
            over[0] = over[0].max(half - place);
            over[1] = over[1].max(half - (width - place));
        }
        over
    }

    fn ticks_up(&self, height: f64) -> Vec<Tick> {
        let most = ((height / ROOM_PER_LABEL) as usize).min(MOST_LABELS);
        self.ticks(height, most, |_| ROOM_PER_LABEL - 3.0)
    }

    /// Space that a bar of a height takes at the right of a frame, up to the edge of the page.
    pub(crate) fn space(&self, height: f64) -> f64 {
        let has_label = !self.label.is_empty();
        let label = if has_label { LABEL_SIZE + 3.0 } else { 0.0 };
        BAR_GAP + BAR_WIDTH + TICK_GAP + widest(&self.ticks_up(height)) + label + 3.0
    }

    /// Draws the bar across, its label before it, in lines that reach no further left than `from`, and its numbers below.
    pub(crate) fn draw_bar_across(
        &self,
        drawing: &mut Drawing,
        area: Rectangle,
        from: f64,
        ink: Colour,
    ) {
        let layer = drawing.layer("colour bar", None);
        layer.image(Image::of_cells(area, BAR_STEPS, self.steps()));
        let mut segments = Vec::new();
        for tick in self.ticks_across(area.width) {
            let x = area.left + area.width * self.axis().fraction(tick.value);
            let length = if tick.length < MAJOR_TICK { 1.0 } else { 2.0 };
            segments.push([area.bottom(), area.bottom() + length].map(|y| Point::new(x, y)));
            layer.number((x, area.bottom()), Side::Below, &tick, ink);
        }
        outline(layer, area, segments, ink);
        let middle = area.top + area.height / 2.0 + DIGIT_HEIGHT * LABEL_SIZE / 2.0;
        let room = self.label_room(area.width, area.left - from);
        let (end, lines) = (from + room, self.label_lines(room));
        for (number, line) in lines.iter().enumerate() {
            let below = (number as f64 - 0.5 * (lines.len() - 1) as f64) * LINE;
            let text = Text::fitted(line, LABEL_SIZE, room);
            layer.text((end, middle + below), Anchor::End, text, ink);
        }
    }

    /// Room for the label of a bar across, of all at its left: the last of several lines stands beside the number at the left
    /// end, and must not run into it.
    fn label_room(&self, width: f64, all: f64) -> f64 {
        let room = all - BAR_GAP;
        match self.label_lines(room).len() {
            0 | 1 => room,
            _ => room.min(all - self.overhangs(width)[0] - ROOM_BEFORE_NUMBER),
        }
    }

    /// The label in lines that the room holds: its words, and where they leave no room beside them, its symbol below.
    fn label_lines(&self, room: f64) -> Vec<String> {
        let symbol = self
            .label
            .rfind(", ")
            .map_or(self.label.len(), |place| place + 2);
        let (words, symbol) = self.label.split_at(symbol);
        let pieces = words
            .split_whitespace()
            .chain((!symbol.is_empty()).then_some(symbol));
        let mut lines: Vec<String> = Vec::new();
        for piece in pieces {
            let longer = lines.last().map(|line| format!("{line} {piece}"));
            let fitting = longer.filter(|line| Text::new(line, LABEL_SIZE).width <= room);
            match (lines.last_mut(), fitting) {
                (Some(last), Some(longer)) => *last = longer,
                _ => lines.push(piece.to_owned()),
            }
        }
        lines
    }

    /// How much further down than usual a bar of a width stands so that all lines of its label have room, in all the room at
    /// its left.
    pub(crate) fn drop(&self, width: f64, room: f64) -> f64 {
        let lines = self.label_lines(self.label_room(width, room)).len();
        0.5 * LINE * (lines as f64 - LINES_BESIDE_BAR).max(0.0)
    }

    /// How far the lines of the label reach below the middle of a bar of a width, in all the room at its left.
    pub(crate) fn reach_below(&self, width: f64, room: f64) -> f64 {
        let lines = self.label_lines(self.label_room(width, room)).len();
        0.5 * LINE * lines as f64
    }

    /// Draws the bar with its label in the middle below panels; returns the height that it takes.
    pub(crate) fn draw_bar_below(&self, drawing: &mut Drawing, span: Rectangle, top: f64) -> f64 {
        let (height, width) = (LOW_BAR.0, LOW_BAR.1.min(LOW_BAR_PART * span.width));
        let label = Text::new(&self.label, LABEL_SIZE).width + BAR_GAP;
        let middle = span.left + (span.width + label - width) / 2.0;
        let left = middle.min(span.right() - width);
        let area = Rectangle::new((left, top + SPACE_ABOVE), (width, height));
        self.draw_bar_across(drawing, area, BAR_GAP, BLACK);
        SPACE_ABOVE + height + TICK_SPACE
    }

    /// Draws the bar at the right of a frame.
    pub(crate) fn draw_bar_beside(&self, drawing: &mut Drawing, frame: Rectangle) {
        let area = Rectangle {
            left: frame.right() + BAR_GAP,
            width: BAR_WIDTH,
            ..frame
        };
        let layer = drawing.layer("colour bar", None);
        layer.image(Image::of_cells(area, 1, self.steps().rev()));
        let ticks = self.ticks_up(area.height);
        let mut segments = Vec::new();
        for tick in &ticks {
            let y = area.bottom() - area.height * self.axis().fraction(tick.value);
            // Ticks inside would be lost in dark colours.
            let length = tick.length * if tick.length < MAJOR_TICK { 0.6 } else { 0.66 };
            segments.push([area.right(), area.right() + length].map(|x| Point::new(x, y)));
            layer.number((area.right(), y), Side::Right, tick, BLACK);
        }
        outline(layer, area, segments, BLACK);
        let baseline = area.right() + TICK_GAP + widest(&ticks) + LABEL_SIZE + 1.0;
        let middle = (area.top + area.bottom()) / 2.0;
        let text = Text::fitted(&self.label, LABEL_SIZE, area.height);
        layer.text_upward((baseline, middle), Anchor::Middle, text, BLACK);
    }

    /// The colours of a bar from its least to its largest value.
    fn steps(&self) -> impl DoubleEndedIterator<Item = Colour> {
        let fraction = |step: usize| (step as f64 + 0.5) / BAR_STEPS as f64;
        (0..BAR_STEPS).map(move |step| self.colour_at(fraction(step)))
    }
}

/// Draws the outline of a bar, and its ticks.
fn outline(layer: &mut Layer, area: Rectangle, ticks: Vec<[Point; 2]>, ink: Colour) {
    let pen = Stroke::solid(ink, FRAME_WEIGHT);
    layer.stroke(Path::segments(ticks), pen);
    layer.stroke(Path::polygon(area.corners()), pen);
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

    /// Colour bars lacked their lower end.
    #[test]
    fn a_bar_says_where_it_begins_and_ends() {
        let ends = |scale: ColourScale| {
            let mut ticks = scale.ticks_up(200.0);
            ticks.retain(|tick| tick.label.is_some());
            ticks.sort_by(|one, other| one.value.total_cmp(&other.value));
            [&ticks[0], &ticks[ticks.len() - 1]].map(|tick| tick.label.clone().unwrap())
        };
        let rates = ColourScale::new("", 0.03, 0.2).logarithmic();
        assert_eq!(ends(rates), ["0.03", "0.2"]);
        assert_eq!(
            ends(ColourScale::new("", 0.001, 0.008).logarithmic()),
            ["0.001", "0.008"]
        );
        assert_eq!(
            ends(ColourScale::new("", -0.2374, 1.0)),
            ["\u{2212}0.24", "1.0"]
        );
        // A number that stands close to an end says enough.
        assert_eq!(ends(ColourScale::new("", 0.0, 1.02)), ["0.0", "1.0"]);
    }

    #[test]
    fn an_end_with_values_beyond_it_is_marked_where_no_tick_stands() {
        for (least, largest) in [(-0.33, 0.33), (-1.0, 1.0), (0.0, 0.00731), (0.0, 0.0503)] {
            let scale = ColourScale::new("", least, largest).found(-9.0, f64::INFINITY);
            for ticks in [scale.ticks_up(60.0), scale.ticks_across(110.0)] {
                let labels: Vec<&str> = ticks.iter().filter_map(|it| it.label.as_deref()).collect();
                for sign in ["≤ ", "≥ "] {
                    let marked = labels.iter().filter(|label| label.starts_with(sign));
                    assert_eq!(marked.count(), 1, "{least} to {largest}: {labels:?}");
                }
            }
        }
    }

    #[test]
    fn a_long_label_takes_lines_and_its_symbol_stays_whole() {
        let scale = ColourScale::new("position in the wave frame, (*z* − *ct*)/*λ*", 0.0, 1.0);
        assert_eq!(scale.label_lines(400.0), [&*scale.label]);
        let two = ["position in the wave frame,", "(*z* − *ct*)/*λ*"];
        assert_eq!(scale.label_lines(110.0), two);
        let three = ["position in the", "wave frame,", "(*z* − *ct*)/*λ*"];
        assert_eq!(scale.label_lines(60.0), three);
        assert!(scale.drop(90.0, 117.0) == 0.0 && scale.drop(90.0, 67.0) > 0.0);
    }

    /// A pump engineer: the last line of a label ran into the number below the bar's left end.
    #[test]
    fn the_last_line_of_a_label_keeps_clear_of_the_number_beside_it() {
        let label = "axial velocity along the wave, *v_z*/*c*";
        let scale = ColourScale::new(label, -1.0, 1.0).found(-2.0, 2.0);
        let [left, _] = scale.overhangs(90.0);
        assert!(left > BAR_GAP);
        assert_eq!(scale.label_room(90.0, 400.0), 400.0 - BAR_GAP);
        assert!(scale.label_lines(110.0).len() > 1);
        assert!(scale.label_room(90.0, 110.0) < 110.0 - left);
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
