//! A page with everything on it at its place, ready to be written as SVG or as PNG.
//!
//! Every shape is one of three: a path that is filled or drawn along, an image of pixels, or a line of type.

mod png;
mod svg;

use crate::colour::{BLACK, Colour, WHITE};
use crate::error::FigureError;
use crate::geometry::{Path, Point, Rectangle};
use crate::style::POINTS_PER_MILLIMETRE;
use crate::text::{Text, plain};

/// A finished figure: one list of shapes that both output formats draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Points across.
    width: f64,
    /// Points down.
    pub(crate) height: f64,
    title: String,
    /// What can be seen, in words without markup.
    pub(crate) description: String,
    /// Colour of the page.
    pub(crate) paper: Colour,
    /// How finely the page is painted.
    pub(crate) pixels_per_point: f64,
    layers: Vec<Layer>,
}

/// A painted page: three bytes of sRGB a pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green and blue of each pixel.
    pub pixels: Vec<u8>,
}

/// Pattern of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Unbroken.
    #[default]
    Solid,
    /// Strokes.
    Dashed,
    /// Dots.
    Dotted,
    /// Long and short strokes in turn.
    DashDotted,
}

impl Pattern {
    /// Lengths of strokes and gaps in points; empty for a solid line.
    fn lengths(self) -> &'static [f32] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[4.0, 2.2],
            Self::Dotted => &[0.9, 1.6],
            Self::DashDotted => &[4.0, 1.7, 0.9, 1.7],
        }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    /// Points.
    pub(crate) weight: f64,
    pub(crate) pattern: Pattern,
}

impl Stroke {
    pub(crate) const fn solid(colour: Colour, weight: f64) -> Self {
        Self {
            colour,
            weight,
            pattern: Pattern::Solid,
        }
    }
}

/// Which part of a text stands at its given place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// Length of a text before its anchor.
    fn before(self, text: &Text) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => text.width / 2.0,
            Self::End => text.width,
        }
    }
}

/// Direction in which a text runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reading {
    Rightward,
    Upward,
}

/// How a path is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fill {
    Flat(Colour),
    /// Shaded like a sphere that is lit from the upper left.
    Sphere(Colour),
}

/// Where the light of a sphere is brightest, as a fraction of the box around it, from the left and from the top.
const SPHERE_CENTRE: f64 = 0.36;
/// Distance from there to the darkest shade, as a fraction of the box.
const SPHERE_REACH: f64 = 0.72;

/// The shades of a sphere from its brightest place outwards, with the fraction of the reach where each stands.
fn sphere_shades(colour: Colour) -> [(f64, Colour); 3] {
    [
        (0.0, colour.towards(WHITE, 0.5)),
        (0.45, colour),
        (1.0, colour.towards(BLACK, 0.42)),
    ]
}

/// One thing on the page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    Path {
        path: Path,
        fill: Option<Fill>,
        stroke: Option<Stroke>,
    },
    Image(Image),
    Text {
        start: Point,
        reading: Reading,
        text: Text,
        colour: Colour,
    },
}

/// Equal cells that fill an area, one pixel each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Image {
    pub(crate) area: Rectangle,
    pub(crate) columns: usize,
    /// Bytes of red, green and blue, row by row from the top left.
    pub(crate) pixels: Vec<u8>,
    /// Whether colours run into each other where the image is enlarged.
    pub(crate) is_smooth: bool,
}

impl Image {
    /// Cells of one colour each.
    pub(crate) fn of_cells(
        area: Rectangle,
        columns: usize,
        colours: impl IntoIterator<Item = Colour>,
    ) -> Self {
        Self {
            area,
            columns,
            pixels: colours.into_iter().flat_map(Colour::srgb).collect(),
            is_smooth: false,
        }
    }

    fn rows(&self) -> usize {
        self.pixels.len() / (3 * self.columns).max(1)
    }
}

/// Shapes that belong together, with a name and perhaps a window that clips them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    name: &'static str,
    window: Option<Rectangle>,
    shapes: Vec<Shape>,
}

impl Drawing {
    /// A white page; width and height in points.
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        Self {
            width,
            height,
            title: plain(title),
            description: String::new(),
            paper: WHITE,
            pixels_per_point: png::PIXELS_PER_POINT,
            layers: Vec::new(),
        }
    }

    /// Width of the page in millimetres.
    pub fn width_millimetres(&self) -> f64 {
        self.width / POINTS_PER_MILLIMETRE
    }

    /// Height of the page in millimetres.
    pub fn height_millimetres(&self) -> f64 {
        self.height / POINTS_PER_MILLIMETRE
    }

    /// The figure as a stand-alone SVG document, with text as outlines and its characters as accessible labels.
    pub fn svg(&self) -> String {
        self.svg_with_prefix("")
    }

    /// As [`Drawing::svg`], with every `id` beginning with a prefix, so that many figures can stand in one web page without sharing
    /// an `id`; characters other than ASCII letters, digits, `-` and `_` become `-`.
    ///
    /// Without a prefix an `id` is made from what it names, so figures that share one mean the same by it.
    pub fn svg_with_prefix(&self, prefix: &str) -> String {
        let is_other = |character: char| !character.is_ascii_alphanumeric() && character != '_';
        svg::document(self, &prefix.replace(is_other, "-"))
    }

    /// The figure as a PNG picture, at 300 dots per inch unless it is made of pixels itself.
    ///
    /// # Errors
    /// If the page is too large for memory or the encoder fails.
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        png::encoded(self)
    }

    /// Pixels across and down of [`Drawing::png`].
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height].map(|length| (length * self.pixels_per_point).round() as u32)
    }

    /// The pixels of [`Drawing::png`].
    ///
    /// # Errors
    /// If the page is too large for memory.
    pub fn raster(&self) -> Result<Raster, FigureError> {
        png::raster(self)
    }

    /// Opens a layer above all others.
    pub(crate) fn layer(&mut self, name: &'static str, window: Option<Rectangle>) -> &mut Layer {
        let place = self.layers.len();
        self.layers.push(Layer {
            name,
            window,
            shapes: Vec::new(),
        });
        &mut self.layers[place]
    }

    /// The shapes of all layers of a name.
    #[cfg(test)]
    pub(crate) fn shapes(&self, name: &str) -> Vec<&Shape> {
        self.layers
            .iter()
            .filter(|layer| layer.name == name)
            .flat_map(|layer| &layer.shapes)
            .collect()
    }

    /// The paths of all layers of a name.
    #[cfg(test)]
    pub(crate) fn paths(&self, name: &str) -> Vec<&Path> {
        let mut paths = Vec::new();
        for shape in self.shapes(name) {
            if let Shape::Path { path, .. } = shape {
                paths.push(path);
            }
        }
        paths
    }

    /// The lines of type of all layers of a name, with their starts.
    #[cfg(test)]
    pub(crate) fn texts(&self, name: &str) -> Vec<(Point, &str)> {
        let text = |shape| match shape {
            &Shape::Text {
                start, ref text, ..
            } => Some((start, text.characters.as_str())),
            _ => None,
        };
        self.shapes(name).into_iter().filter_map(text).collect()
    }
}

impl Layer {
    /// A path that is filled, drawn along, or both; nothing for a path without steps.
    pub(crate) fn path(&mut self, path: Path, fill: Option<Fill>, stroke: Option<Stroke>) {
        if !path.steps.is_empty() {
            self.shapes.push(Shape::Path { path, fill, stroke });
        }
    }

    pub(crate) fn fill(&mut self, path: Path, colour: Colour) {
        self.path(path, Some(Fill::Flat(colour)), None);
    }

    pub(crate) fn stroke(&mut self, path: Path, stroke: Stroke) {
        self.path(path, None, Some(stroke));
    }

    pub(crate) fn image(&mut self, image: Image) {
        self.shapes.push(Shape::Image(image));
    }

    /// A line of type with its start, middle or end at a place.
    pub(crate) fn text(&mut self, place: (f64, f64), anchor: Anchor, text: Text, colour: Colour) {
        let start = Point::new(place.0 - anchor.before(&text), place.1);
        self.push_text(start, Reading::Rightward, text, colour);
    }

    /// The same, read upwards.
    pub(crate) fn text_upward(
        &mut self,
        place: (f64, f64),
        anchor: Anchor,
        text: Text,
        colour: Colour,
    ) {
        let start = Point::new(place.0, place.1 + anchor.before(&text));
        self.push_text(start, Reading::Upward, text, colour);
    }

    fn push_text(&mut self, start: Point, reading: Reading, text: Text, colour: Colour) {
        self.shapes.push(Shape::Text {
            start,
            reading,
            text,
            colour,
        });
    }
}
