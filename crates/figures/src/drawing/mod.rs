//! A page with everything on it at its place, ready to be written as SVG or as PNG.

mod png;
mod svg;

use crate::colour::{Colour, WHITE};
use crate::error::FigureError;
use crate::style::POINTS_PER_MILLIMETRE;
use crate::text::Text;

/// A finished figure: one list of shapes that both output formats draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Points across.
    width: f64,
    /// Points down.
    height: f64,
    title: String,
    description: Option<String>,
    /// What the names of definitions in the SVG begin with.
    prefix: String,
    /// Colour of the page.
    paper: Colour,
    /// How finely the page is painted.
    pixels_per_point: f64,
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

/// A place on the page in points, from the top left corner, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

/// A rectangle on the page, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rectangle {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// Pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dash {
    Solid,
    Dashed,
    Dotted,
    /// Long and short strokes in turn.
    Alternating,
}

impl Dash {
    /// Lengths of strokes and gaps in points; empty for a solid line.
    fn lengths(self) -> &'static [f32] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[4.0, 2.2],
            Self::Dotted => &[0.9, 1.6],
            Self::Alternating => &[4.0, 1.7, 0.9, 1.7],
        }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    /// Points.
    pub(crate) weight: f64,
    pub(crate) dash: Dash,
}

impl Stroke {
    pub(crate) const fn solid(colour: Colour, weight: f64) -> Self {
        Self {
            colour,
            weight,
            dash: Dash::Solid,
        }
    }

    pub(crate) const fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }
}

/// Which part of a text stands at its given place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Direction in which a text runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reading {
    Rightward,
    Upward,
}

/// How a circle is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fill {
    Flat(Colour),
    /// Shaded like a sphere that is lit from the upper left.
    Sphere(Colour),
}

/// One thing on the page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    Line {
        points: Vec<Point>,
        stroke: Stroke,
    },
    Polygon {
        points: Vec<Point>,
        fill: Colour,
    },
    Circle {
        centre: Point,
        radius: f64,
        fill: Fill,
        stroke: Option<Stroke>,
    },
    /// The same mark at many places.
    Marks {
        outline: Outline,
        places: Vec<Point>,
        fill: Colour,
        stroke: Stroke,
    },
    /// Straight lines apart from each other, each from its first to its second point.
    Segments {
        segments: Vec<[Point; 2]>,
        stroke: Stroke,
    },
    /// Equal cells of one colour each, row by row from the top left.
    Cells {
        area: Rectangle,
        columns: usize,
        colours: Vec<Colour>,
    },
    /// Bytes of red, green and blue, as many pixels as the area has where it is painted.
    Picture {
        area: Rectangle,
        columns: usize,
        pixels: Vec<u8>,
    },
    Text {
        start: Point,
        reading: Reading,
        text: Text,
        colour: Colour,
    },
}

/// Closed outline of a mark, relative to its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outline {
    Circle { radius: f64 },
    Polygon(Vec<Point>),
}

impl Outline {
    /// The same outline lower on the page; a circle becomes a polygon, for only those stand off their place.
    pub(crate) fn lowered(&self, by: f64) -> Self {
        const CORNERS: u32 = 24;
        let corners = match self {
            Self::Circle { radius } => (0..CORNERS)
                .map(|corner| {
                    let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
                    Point {
                        x: radius * libm::cos(angle),
                        y: radius * libm::sin(angle),
                    }
                })
                .collect(),
            Self::Polygon(corners) => corners.clone(),
        };
        let lowered = |corner: Point| Point {
            y: corner.y + by,
            ..corner
        };
        Self::Polygon(corners.into_iter().map(lowered).collect())
    }
}

/// Shapes that belong together, with a name and perhaps a window outside of which nothing shows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    name: &'static str,
    window: Option<Rectangle>,
    shapes: Vec<Shape>,
}

impl Drawing {
    /// A white page; width and height in points.
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        let title = Text::new(title, 1.0).characters;
        Self {
            width,
            height,
            title,
            description: None,
            prefix: String::new(),
            paper: WHITE,
            pixels_per_point: png::PIXELS_PER_POINT,
            layers: Vec::new(),
        }
    }

    /// The same figure with another `<title>` in its SVG, in markup: what a reader who does not see is told first.
    #[must_use]
    pub fn with_title(self, title: &str) -> Self {
        let title = Text::new(title, 1.0).characters;
        Self { title, ..self }
    }

    /// The same figure with a `<desc>` in its SVG, in markup: what can be seen, in words.
    #[must_use]
    pub fn with_description(self, description: &str) -> Self {
        let description = Some(Text::new(description, 1.0).characters);
        Self {
            description,
            ..self
        }
    }

    /// The same figure with every `id` in its SVG beginning with a prefix, so that many figures can stand in one web
    /// page without sharing an `id`; characters other than ASCII letters, digits, `-` and `_` become `-`.
    ///
    /// Without a prefix an `id` is made from what it names, so figures that share one mean the same by it.
    #[must_use]
    pub fn with_prefix(self, prefix: &str) -> Self {
        let allowed = |character: char| {
            if character.is_ascii_alphanumeric() || character == '_' {
                character
            } else {
                '-'
            }
        };
        let prefix = prefix.chars().map(allowed).collect();
        Self { prefix, ..self }
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
        svg::document(self)
    }

    /// The figure as a PNG picture, at 300 dots per inch unless it is made of pixels itself.
    ///
    /// # Errors
    /// If the page is too large for memory or the encoder fails.
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        png::picture(self)
    }

    /// Pixels across and down of [`Drawing::png`].
    #[must_use]
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

    /// The same on paper of another colour, painted with so many pixels a point.
    pub(crate) fn on_paper(self, paper: Colour, pixels_per_point: f64) -> Self {
        Self {
            paper,
            pixels_per_point,
            ..self
        }
    }

    /// Makes the page higher or lower.
    pub(crate) fn extend_to(&mut self, height: f64) {
        self.height = height;
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
}

impl Layer {
    /// An open line through the points.
    pub(crate) fn line(&mut self, points: impl IntoIterator<Item = Point>, stroke: Stroke) {
        self.shapes.push(Shape::Line {
            points: points.into_iter().collect(),
            stroke,
        });
    }

    /// A straight line.
    pub(crate) fn segment(&mut self, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
        self.line(
            [
                Point {
                    x: from.0,
                    y: from.1,
                },
                Point { x: to.0, y: to.1 },
            ],
            stroke,
        );
    }

    /// A filled polygon.
    pub(crate) fn polygon(&mut self, points: impl IntoIterator<Item = Point>, fill: Colour) {
        self.shapes.push(Shape::Polygon {
            points: points.into_iter().collect(),
            fill,
        });
    }

    /// A filled rectangle.
    pub(crate) fn rectangle(&mut self, area: Rectangle, fill: Colour) {
        let corners = [
            (area.left, area.top),
            (area.right(), area.top),
            (area.right(), area.bottom()),
            (area.left, area.bottom()),
        ];
        self.polygon(corners.map(|(x, y)| Point { x, y }), fill);
    }

    /// The outline of a rectangle, its first side repeated so that the corner closes.
    pub(crate) fn outline(&mut self, area: Rectangle, stroke: Stroke) {
        let (left, top, right, bottom) = (area.left, area.top, area.right(), area.bottom());
        let corners = [
            (left, top),
            (right, top),
            (right, bottom),
            (left, bottom),
            (left, top),
            (right, top),
        ];
        self.line(corners.map(|(x, y)| Point { x, y }), stroke);
    }

    /// A disc.
    pub(crate) fn circle(
        &mut self,
        centre: Point,
        radius: f64,
        fill: Fill,
        stroke: Option<Stroke>,
    ) {
        self.shapes.push(Shape::Circle {
            centre,
            radius,
            fill,
            stroke,
        });
    }

    /// The same mark at many places.
    pub(crate) fn marks(
        &mut self,
        outline: Outline,
        places: Vec<Point>,
        fill: Colour,
        stroke: Stroke,
    ) {
        self.shapes.push(Shape::Marks {
            outline,
            places,
            fill,
            stroke,
        });
    }

    /// Straight lines apart from each other; nothing for none.
    pub(crate) fn segments(&mut self, segments: Vec<[Point; 2]>, stroke: Stroke) {
        if !segments.is_empty() {
            self.shapes.push(Shape::Segments { segments, stroke });
        }
    }

    /// Equal cells that fill an area, row by row from the top left.
    pub(crate) fn cells(&mut self, area: Rectangle, columns: usize, colours: Vec<Colour>) {
        self.shapes.push(Shape::Cells {
            area,
            columns,
            colours,
        });
    }

    /// A picture of red, green and blue bytes.
    pub(crate) fn picture(&mut self, area: Rectangle, columns: usize, pixels: &[u8]) {
        self.shapes.push(Shape::Picture {
            area,
            columns,
            pixels: pixels.to_owned(),
        });
    }

    /// A line of type with its start, middle or end at a place.
    pub(crate) fn text(&mut self, place: (f64, f64), anchor: Anchor, text: Text, colour: Colour) {
        self.place_text(place, anchor, Reading::Rightward, text, colour);
    }

    /// A line of type that reads upwards.
    pub(crate) fn upward_text(
        &mut self,
        place: (f64, f64),
        anchor: Anchor,
        text: Text,
        colour: Colour,
    ) {
        self.place_text(place, anchor, Reading::Upward, text, colour);
    }

    fn place_text(
        &mut self,
        (x, y): (f64, f64),
        anchor: Anchor,
        reading: Reading,
        text: Text,
        colour: Colour,
    ) {
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => text.width / 2.0,
            Anchor::End => text.width,
        };
        let start = match reading {
            Reading::Rightward => Point { x: x - back, y },
            Reading::Upward => Point { x, y: y + back },
        };
        self.shapes.push(Shape::Text {
            start,
            reading,
            text,
            colour,
        });
    }
}
