//! A picture of pixels with its key: notes, marks, a scale and a bar of colours.

use crate::colour::{BLACK, Colour, WHITE};
use crate::colour_scale::ColourScale;
use crate::drawing::{Anchor, Drawing, Image, Layer, Stroke};
use crate::error::FigureError;
use crate::geometry::{Path, Point, Rectangle};
use crate::style::{LABEL_SIZE, LEGEND_SIZE, TICK_SIZE, Width};
use crate::text::{DIGIT_HEIGHT, Text};

/// A picture of pixels, such as the tube as it looks, with notes above it, marks along its upper edge, and a scale and
/// bars of colours below. No pixel of the picture is hidden, and none is changed.
#[derive(Clone, Copy, Debug, Default)]
pub struct PictureFigure<'a> {
    /// Description of the picture, in markup: the title of the SVG, not drawn.
    pub title: &'a str,
    /// Red, green and blue, row by row from the top.
    pub pixels: &'a [u8],
    /// Pixels across.
    pub columns: u32,
    /// Notes above the picture in markup, the first at its left, the last at its right.
    pub notes: &'a [String],
    /// Places along the upper edge; `None` without room for any, which pictures of one size all have or all lack.
    pub marks: Option<&'a [PlaceMark]>,
    /// The length that is shown for scale.
    pub scale_bar: Option<&'a ScaleBar>,
    /// What the colours mean, from the uppermost bar.
    pub colours: &'a [&'a ColourScale],
    /// Colour of the page around.
    pub paper: Paper,
    /// Width on a journal's page, from which the size of type follows; a coarse picture has larger type.
    pub width: Width,
}

/// A place along the upper edge of a picture, with a word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceMark {
    /// Part of the width, from the left.
    pub place: f64,
    /// Text of the mark, in markup.
    pub label: &'static str,
}

/// A length in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleBar {
    /// Part of the width.
    pub length: f64,
    /// How long that is, in markup.
    pub label: String,
}

/// The page that a picture is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// White, written on in black.
    #[default]
    Light,
    /// Nearly black, written on in white.
    Dark,
}

impl Paper {
    /// Its red, green and blue.
    pub fn srgb(self) -> [u8; 3] {
        let [page, ..] = self.colours();
        page.srgb()
    }

    /// Colours of the page, of its text, and of less important text.
    fn colours(self) -> [Colour; 3] {
        match self {
            Self::Light => [WHITE, BLACK, Colour::new(90, 90, 90)],
            Self::Dark => [(13, 15, 20), (236, 236, 236), (165, 168, 175)]
                .map(|(red, green, blue)| Colour::new(red, green, blue)),
        }
    }
}

/// Fewest pixels in a point: letters of coarser pictures would not be read.
const FEWEST_PIXELS_PER_POINT: f64 = 1.65;
/// Margin between the page's edge and the texts.
const EDGE: f64 = 5.0;
const BAR_HEIGHT: f64 = 5.5;
/// Widest bar of colours, and its part of a narrow page.
const BAR_WIDTH: f64 = 120.0;
const BAR_PART: f64 = 0.3;
/// Height of a bar of colours with its numbers, and of the gap to the next.
const ROW: f64 = BAR_HEIGHT + TICK_SIZE + 4.0;
/// Gap below the picture.
const GAP_BELOW: f64 = 6.0;
/// Space between the scale and its label, and around both.
const SCALE_GAP: f64 = 4.0;
const ROOM_BESIDE_SCALE: f64 = 12.0;
/// Half the width of a mark, and its height.
const MARK: (f64, f64) = (2.2, 3.4);

impl PictureFigure<'_> {
    /// Lays the figure out, and paints it with the picture's own pixels.
    ///
    /// # Errors
    /// If there are no pixels or no whole number of rows, or if the range of the colours is empty.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let columns = self.columns as usize;
        let rows = self.pixels.len() / (3 * columns).max(1);
        if self.pixels.is_empty() || 3 * rows * columns != self.pixels.len() {
            return Err(FigureError::GridSize {
                rows,
                columns,
                found: self.pixels.len() / 3,
            });
        }
        for colours in self.colours {
            colours.check()?;
        }
        let [page, ink, faint_ink] = self.paper.colours();
        let scale = (columns as f64 / self.width.points()).max(FEWEST_PIXELS_PER_POINT);
        // The picture begins with a whole pixel of the page.
        let whole = |points: f64| (points * scale).ceil() / scale;
        let above = whole(self.space_above());
        let size = (columns as f64 / scale, rows as f64 / scale);
        let area = Rectangle::new((0.0, above), size);
        let (bar_left, bar_width) = self.place_of_bars(area.width);
        let free_from = self.end_of_scale(area.width);
        let drop = |colours: &ColourScale| colours.drop(bar_width, bar_left - free_from);
        // The lines of a label reach as far below its bar as above it, where the next bar follows.
        let mut drops: Vec<f64> = self.colours.iter().copied().map(drop).collect();
        for upper in (1..drops.len()).rev() {
            drops[upper] += drops[upper - 1];
        }
        let mut below = self.space_below() + drops.iter().sum::<f64>();
        if let Some(last) = self.colours.last() {
            let middle = below - EDGE + 2.0 - ROW + 0.5 * BAR_HEIGHT;
            below = below.max(middle + last.reach_below(bar_width, bar_left - free_from) + 2.0);
        }
        let height = area.bottom() + whole(below);
        let mut drawing = Drawing::new(area.width, height, self.title);
        (drawing.paper, drawing.pixels_per_point) = (page, scale);
        drawing.layer("picture", None).image(Image {
            area,
            columns,
            pixels: self.pixels.to_vec(),
            is_smooth: true,
        });
        self.draw_notes(drawing.layer("notes", None), area.width, ink);
        self.draw_marks(drawing.layer("marks", None), area, faint_ink);
        self.draw_scale_bar(drawing.layer("scale", None), area, ink);
        let mut top = area.bottom() + GAP_BELOW;
        for (colours, drop) in self.colours.iter().zip(drops) {
            top += drop;
            let bar = Rectangle::new((bar_left, top), (bar_width, BAR_HEIGHT));
            colours.draw_bar_across(&mut drawing, bar, free_from, ink);
            top += ROW;
        }
        Ok(drawing)
    }

    /// Left end and width of the bars of colours on a page of some width.
    fn place_of_bars(&self, page: f64) -> (f64, f64) {
        let width = BAR_WIDTH.min(BAR_PART * page);
        let overhangs = self
            .colours
            .iter()
            .map(|colours| colours.overhangs(width)[1]);
        let left = page - EDGE - overhangs.fold(0.0, f64::max) - width;
        (left, width)
    }

    /// Where there is room at the right of the scale.
    fn end_of_scale(&self, page: f64) -> f64 {
        self.scale_bar.map_or(EDGE, |bar| {
            let text = Text::new(&bar.label, LABEL_SIZE);
            EDGE + bar.length * page + SCALE_GAP + text.width + ROOM_BESIDE_SCALE
        })
    }

    fn space_above(&self) -> f64 {
        let mut space = 0.0;
        if !self.notes.is_empty() {
            space += EDGE + LABEL_SIZE + 2.0;
        }
        if self.marks.is_some() {
            space += LEGEND_SIZE + MARK.1 + 2.0;
        }
        space
    }

    fn space_below(&self) -> f64 {
        match self.colours.len() {
            0 if self.scale_bar.is_none() => 0.0,
            bars => GAP_BELOW + bars.max(1) as f64 * ROW + EDGE - 2.0,
        }
    }

    /// Notes at equal distances: the first from the left edge, the last up to the right one.
    fn draw_notes(&self, layer: &mut Layer, width: f64, ink: Colour) {
        let baseline = EDGE + DIGIT_HEIGHT * LABEL_SIZE;
        let last = self.notes.len().saturating_sub(1);
        let room = (width - 2.0 * EDGE) / self.notes.len().max(1) as f64;
        for (index, note) in self.notes.iter().enumerate() {
            let text = Text::fitted(note, LABEL_SIZE, room);
            let (x, anchor) = match index {
                0 => (EDGE, Anchor::Start),
                _ if index == last => (width - EDGE, Anchor::End),
                _ => (width * index as f64 / last as f64, Anchor::Middle),
            };
            layer.text((x, baseline), anchor, text, ink);
        }
    }

    /// Small triangles that point down to the picture, each with its word, which keeps off the edges of the page; a mark whose
    /// word would stand on another is left out.
    fn draw_marks(&self, layer: &mut Layer, area: Rectangle, ink: Colour) {
        let tip = area.top - 0.5;
        let mut taken: Vec<(f64, f64)> = Vec::new();
        for mark in self.marks.unwrap_or_default() {
            let x = area.width * mark.place;
            let text = Text::new(mark.label, LEGEND_SIZE);
            let half = 0.5 * text.width + 2.0;
            let middle = x.min(area.width - half).max(half);
            let (left, right) = (middle - half, middle + half);
            let is_free = taken.iter().all(|&(from, to)| right < from || left > to);
            if !is_free || right > area.width + 1e-9 {
                continue;
            }
            taken.push((left, right));
            let corners = [(0.0, 0.0), (-MARK.0, -MARK.1), (MARK.0, -MARK.1)];
            let corners = corners.map(|(side, up)| Point::new(x + side, tip + up));
            layer.fill(Path::polygon(corners), ink);
            let baseline = tip - MARK.1 - 2.0;
            layer.text((middle, baseline), Anchor::Middle, text, ink);
        }
    }

    fn draw_scale_bar(&self, layer: &mut Layer, area: Rectangle, ink: Colour) {
        let Some(bar) = self.scale_bar else {
            return;
        };
        let (left, middle) = (EDGE, area.bottom() + GAP_BELOW + 0.5 * BAR_HEIGHT);
        let right = left + bar.length * area.width;
        let end = 0.5 * BAR_HEIGHT;
        let mut segments = vec![[left, right].map(|x| Point::new(x, middle))];
        segments.extend([left, right].map(|x| [-end, end].map(|up| Point::new(x, middle + up))));
        layer.stroke(Path::segments(segments), Stroke::solid(ink, 1.0));
        let baseline = middle + 0.5 * DIGIT_HEIGHT * LABEL_SIZE;
        let text = Text::new(&bar.label, LABEL_SIZE);
        let start = (right + SCALE_GAP, baseline);
        layer.text(start, Anchor::Start, text, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(pixels: &[u8]) -> Result<Drawing, FigureError> {
        let marks = [(0.01, "throat"), (0.3, "throat"), (0.31, "belly")];
        draw_with(
            pixels,
            Some(&marks.map(|(place, label)| PlaceMark { place, label })),
        )
    }

    fn draw_with(pixels: &[u8], marks: Option<&[PlaceMark]>) -> Result<Drawing, FigureError> {
        let notes = ["*t*/*T* = 1.5", "*J*/*J*_{max} = 0.9"].map(str::to_owned);
        let (length, label) = (0.25, "10 *d*".to_owned());
        let scale_bar = ScaleBar { length, label };
        PictureFigure {
            pixels,
            columns: 400,
            notes: &notes,
            marks,
            scale_bar: Some(&scale_bar),
            ..PictureFigure::default()
        }
        .draw()
    }

    #[test]
    fn the_picture_is_on_the_page_pixel_by_pixel() {
        let pixels: Vec<u8> = (0..400 * 90_u32)
            .flat_map(|it| [it as u8, (it / 400) as u8, 7])
            .collect();
        let drawing = draw(&pixels).expect("drawable");
        let raster = drawing.raster().expect("small");
        assert_eq!(raster.width, 400);
        let row = |number: usize| &raster.pixels[1200 * number..1200 * (number + 1)];
        let first = (0..raster.height as usize).find(|&it| *row(it) == pixels[..1200]);
        let first = first.expect("the first row is there");
        assert!((0..90).all(|it| *row(first + it) == pixels[1200 * it..1200 * (it + 1)]));
        // Notes above and a scale below leave ink.
        let is_inked = |it: usize| row(it).iter().any(|&byte| byte < 60);
        let inked = |mut rows: std::ops::Range<usize>| rows.any(is_inked);
        assert!(inked(0..first) && inked(first + 90..raster.height as usize));
        let png = drawing.png().expect("encodable");
        assert!(png.starts_with(b"\x89PNG"));
        assert!(drawing.svg().contains("data:image/png;base64,"));
    }

    #[test]
    fn words_do_not_stand_on_each_other_and_the_scale_is_as_long_as_it_says() {
        let pixels = vec![255; 1200 * 60];
        let drawing = draw(&pixels).expect("drawable");
        // The first word is moved in from the edge; the last mark, whose word has no room, is left out.
        assert_eq!(drawing.texts("marks").len(), 2);
        assert_eq!(drawing.paths("marks").len(), 2);
        let [from, to, ..] = drawing.paths("scale")[0].points()[..] else {
            panic!("a scale is of segments");
        };
        assert!((to.x - from.x - 0.25 * 400.0 / FEWEST_PIXELS_PER_POINT).abs() < 1e-9);
    }

    #[test]
    fn room_for_marks_is_kept_where_there_is_none_at_the_moment() {
        let pixels = vec![255; 1200 * 60];
        let height = |marks: Option<&[PlaceMark]>| draw_with(&pixels, marks).unwrap().size()[1];
        let mark = |place, label| PlaceMark { place, label };
        assert_eq!(height(Some(&[])), height(Some(&[mark(0.3, "belly")])));
        assert!(height(Some(&[])) > height(None));
    }

    #[test]
    fn a_label_of_many_lines_ends_above_the_edge_of_the_page() {
        let label = "axial velocity along the tube, (*m*/*k*)^{1/2}*d* and more and more of it";
        let colours = ColourScale::new(label, -0.2, 0.2);
        let (length, label) = (0.25, "5 *d*".to_owned());
        let scale_bar = ScaleBar { length, label };
        let drawing = PictureFigure {
            pixels: &vec![255; 900 * 60],
            columns: 300,
            scale_bar: Some(&scale_bar),
            colours: &[&colours],
            ..PictureFigure::default()
        };
        let drawing = drawing.draw().expect("drawable");
        let texts = drawing.texts("colour bar");
        let lowest = texts.iter().map(|(start, _)| start.y).fold(0.0, f64::max);
        assert!(texts.len() > 8, "{texts:?}");
        assert!(
            lowest + 2.0 < drawing.height,
            "{lowest} of {}",
            drawing.height
        );
    }

    #[test]
    fn pixels_that_are_no_picture_are_refused() {
        for pixels in [&[][..], &[0; 1201]] {
            assert!(matches!(draw(pixels), Err(FigureError::GridSize { .. })));
        }
    }
}
