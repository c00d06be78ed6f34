//! The drawing as a PNG picture: the same shapes, painted at 300 dots per inch.

use tiny_skia::{
    FillRule, GradientStop, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, RadialGradient,
    Shader, SpreadMode, StrokeDash, Transform,
};
use ttf_parser::OutlineBuilder;

use super::{Drawing, Fill, Outline, Point, Raster, Reading, Rectangle, Shape, Stroke};
use crate::colour::{BLACK, Colour, WHITE};
use crate::error::FigureError;

/// 300 dots per inch.
pub(super) const PIXELS_PER_POINT: f64 = 300.0 / 72.0;
const POINTS_PER_METRE: f64 = 72.0 / 0.0254;

/// Where the light of a sphere is brightest, as a fraction of the box around it, from the left and from the top.
pub(super) const SPHERE_CENTRE: f64 = 0.36;
/// Distance from there to the darkest shade, as a fraction of the box.
pub(super) const SPHERE_REACH: f64 = 0.72;

/// The shades of a sphere from its brightest place outwards, with the fraction of the reach where each stands.
pub(super) fn sphere_stops(colour: Colour) -> [(f64, Colour); 3] {
    [
        (0.0, colour.towards(WHITE, 0.5)),
        (0.45, colour),
        (1.0, colour.towards(BLACK, 0.42)),
    ]
}

/// The encoded picture.
pub(super) fn picture(drawing: &Drawing) -> Result<Vec<u8>, FigureError> {
    encode(&raster(drawing)?, drawing.pixels_per_point)
}

/// The painted page.
pub(super) fn raster(drawing: &Drawing) -> Result<Raster, FigureError> {
    let scale = drawing.pixels_per_point;
    // Non-negative by construction; a page too large saturates and is refused below.
    let [width, height] = drawing.size();
    let mut pixels =
        Pixmap::new(width, height).ok_or(FigureError::PictureTooLarge { width, height })?;
    pixels.fill(colour_of(drawing.paper));
    let mut painter = Painter { pixels, scale };
    for layer in &drawing.layers {
        let mask = match &layer.window {
            Some(window) => Some(painter.window_mask(*window)?),
            None => None,
        };
        for shape in &layer.shapes {
            painter.paint_shape(shape, mask.as_ref());
        }
    }
    // The page is opaque, so the premultiplied colours are the colours.
    let colours = painter.pixels.data().chunks_exact(4);
    Ok(Raster {
        width,
        height,
        pixels: colours
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect(),
    })
}

/// A page that is being painted.
struct Painter {
    pixels: Pixmap,
    /// Pixels a point.
    scale: f64,
}

impl Painter {
    /// Opaque inside the window, clear outside.
    fn window_mask(&self, window: Rectangle) -> Result<Mask, FigureError> {
        let (width, height) = (self.pixels.width(), self.pixels.height());
        let mut mask =
            Mask::new(width, height).ok_or(FigureError::PictureTooLarge { width, height })?;
        let rectangle = tiny_skia::Rect::from_xywh(
            window.left as f32,
            window.top as f32,
            window.width as f32,
            window.height as f32,
        );
        if let Some(rectangle) = rectangle {
            mask.fill_path(
                &PathBuilder::from_rect(rectangle),
                FillRule::Winding,
                true,
                self.page(),
            );
        }
        Ok(mask)
    }

    /// Points to pixels.
    fn page(&self) -> Transform {
        Transform::from_scale(self.scale as f32, self.scale as f32)
    }

    fn paint_shape(&mut self, shape: &Shape, mask: Option<&Mask>) {
        let page = self.page();
        match shape {
            Shape::Line { points, stroke } => {
                if let Some(path) = polyline(points, false) {
                    self.stroke_path(&path, stroke, mask);
                }
            }
            Shape::Polygon { points, fill } => {
                if let Some(path) = polyline(points, true) {
                    self.pixels
                        .fill_path(&path, &flat(*fill), FillRule::EvenOdd, page, mask);
                }
            }
            Shape::Circle {
                centre,
                radius,
                fill,
                stroke,
            } => {
                let Some(path) =
                    PathBuilder::from_circle(centre.x as f32, centre.y as f32, *radius as f32)
                else {
                    return;
                };
                let paint = match fill {
                    Fill::Flat(colour) => flat(*colour),
                    Fill::Sphere(colour) => sphere(*centre, *radius, *colour),
                };
                self.pixels
                    .fill_path(&path, &paint, FillRule::Winding, page, mask);
                if let Some(stroke) = stroke {
                    self.stroke_path(&path, stroke, mask);
                }
            }
            Shape::Marks {
                outline,
                places,
                fill,
                stroke,
            } => {
                if let Some(path) = marks(outline, places) {
                    self.pixels
                        .fill_path(&path, &flat(*fill), FillRule::Winding, page, mask);
                    self.stroke_path(&path, stroke, mask);
                }
            }
            Shape::Segments { segments, stroke } => {
                let mut builder = PathBuilder::new();
                for [from, to] in segments {
                    builder.move_to(from.x as f32, from.y as f32);
                    builder.line_to(to.x as f32, to.y as f32);
                }
                if let Some(path) = builder.finish() {
                    self.stroke_path(&path, stroke, mask);
                }
            }
            Shape::Cells {
                area,
                columns,
                colours,
            } => self.paint_cells(*area, *columns, colours, mask),
            Shape::Picture {
                area,
                columns,
                pixels,
            } => self.paint_picture(*area, *columns, pixels),
            Shape::Text {
                start,
                reading,
                text,
                colour,
            } => {
                let line = page.pre_translate(start.x as f32, start.y as f32);
                let line = match reading {
                    Reading::Rightward => line,
                    Reading::Upward => {
                        line.pre_concat(Transform::from_row(0.0, -1.0, 1.0, 0.0, 0.0, 0.0))
                    }
                };
                for placed in &text.glyphs {
                    let mut outline = GlyphPath(PathBuilder::new());
                    placed.glyph.outline(&mut outline);
                    if let Some(path) = outline.0.finish() {
                        let scale = placed.scale as f32;
                        let transform = line
                            .pre_translate(placed.x as f32, placed.y as f32)
                            .pre_scale(scale, -scale);
                        self.pixels.fill_path(
                            &path,
                            &flat(*colour),
                            FillRule::Winding,
                            transform,
                            mask,
                        );
                    }
                }
            }
        }
    }

    /// Paints whole pixels, each in the colour of the cell that its middle lies in.
    fn paint_cells(
        &mut self,
        area: Rectangle,
        columns: usize,
        colours: &[Colour],
        mask: Option<&Mask>,
    ) {
        let rows = colours.len() / columns.max(1);
        // On the page, so far from negative, and at most as many as the page has.
        let pixel = |length: f64| (length * self.scale).round() as usize;
        let (left, right) = (pixel(area.left), pixel(area.right()));
        let (top, bottom) = (pixel(area.top), pixel(area.bottom()));
        let (width, height) = (self.pixels.width() as usize, self.pixels.height() as usize);
        let canvas = self.pixels.pixels_mut();
        for y in top..bottom.min(height) {
            let row = (2 * (y - top) + 1) * rows / (2 * (bottom - top));
            for x in left..right.min(width) {
                let column = (2 * (x - left) + 1) * columns / (2 * (right - left));
                let place = y * width + x;
                if mask.is_none_or(|mask| mask.data()[place] > 127) {
                    let colour = colour_of(colours[row * columns + column]);
                    canvas[place] = colour.premultiply().to_color_u8();
                }
            }
        }
    }

    /// Copies a picture whose pixels are those of the page; what lies beyond the page is left out.
    fn paint_picture(&mut self, area: Rectangle, columns: usize, colours: &[u8]) {
        // On the page, so far from negative.
        let pixel = |length: f64| (length * self.scale).round() as usize;
        let (left, top) = (pixel(area.left), pixel(area.top));
        let (width, height) = (self.pixels.width() as usize, self.pixels.height() as usize);
        let canvas = self.pixels.pixels_mut();
        let rows = colours.chunks_exact(3 * columns.max(1));
        for (y, row) in (top..height).zip(rows) {
            for (x, colour) in (left..width).zip(row.chunks_exact(3)) {
                let colour = tiny_skia::ColorU8::from_rgba(colour[0], colour[1], colour[2], 255);
                canvas[y * width + x] = colour.premultiply();
            }
        }
    }

    fn stroke_path(&mut self, path: &Path, stroke: &Stroke, mask: Option<&Mask>) {
        let lengths = stroke.dash.lengths();
        let pen = tiny_skia::Stroke {
            width: stroke.weight as f32,
            line_join: LineJoin::Round,
            dash: if lengths.is_empty() {
                None
            } else {
                StrokeDash::new(lengths.to_vec(), 0.0)
            },
            ..tiny_skia::Stroke::default()
        };
        let page = self.page();
        self.pixels
            .stroke_path(path, &flat(stroke.colour), &pen, page, mask);
    }
}

/// Cells as a PNG with one pixel a cell.
pub(super) fn cells_picture(columns: usize, colours: &[Colour]) -> Vec<u8> {
    let data: Vec<u8> = colours
        .iter()
        .flat_map(|colour| [colour.red, colour.green, colour.blue])
        .collect();
    pixels_picture(columns, &data)
}

/// Bytes of red, green and blue as a PNG.
pub(super) fn pixels_picture(columns: usize, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let rows = data.len() / (3 * columns).max(1);
    let mut encoder = ::png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(data))
        .expect("writing a picture of whole rows to memory cannot fail");
    bytes
}

/// One path of all marks; none without a place.
fn marks(outline: &Outline, places: &[Point]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for place in places {
        match outline {
            Outline::Circle { radius } => {
                builder.push_circle(place.x as f32, place.y as f32, *radius as f32);
            }
            Outline::Polygon(corners) => {
                for (index, corner) in corners.iter().enumerate() {
                    let (x, y) = ((place.x + corner.x) as f32, (place.y + corner.y) as f32);
                    if index == 0 {
                        builder.move_to(x, y);
                    } else {
                        builder.line_to(x, y);
                    }
                }
                builder.close();
            }
        }
    }
    builder.finish()
}

fn polyline(points: &[Point], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (index, point) in points.iter().enumerate() {
        if index == 0 {
            builder.move_to(point.x as f32, point.y as f32);
        } else {
            builder.line_to(point.x as f32, point.y as f32);
        }
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

fn colour_of(colour: Colour) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(
        colour.red,
        colour.green,
        colour.blue,
        (colour.opacity.clamp(0.0, 1.0) * 255.0).round() as u8,
    )
}

fn flat(colour: Colour) -> Paint<'static> {
    Paint {
        shader: Shader::SolidColor(colour_of(colour)),
        anti_alias: true,
        ..Paint::default()
    }
}

fn sphere(centre: Point, radius: f64, colour: Colour) -> Paint<'static> {
    let corner = Point {
        x: centre.x - radius,
        y: centre.y - radius,
    };
    let light = tiny_skia::Point::from_xy(
        (corner.x + 2.0 * radius * SPHERE_CENTRE) as f32,
        (corner.y + 2.0 * radius * SPHERE_CENTRE) as f32,
    );
    let stops = sphere_stops(colour)
        .map(|(offset, shade)| GradientStop::new(offset as f32, colour_of(shade)))
        .to_vec();
    let reach = (2.0 * radius * SPHERE_REACH) as f32;
    match RadialGradient::new(
        light,
        0.0,
        light,
        reach,
        stops,
        SpreadMode::Pad,
        Transform::identity(),
    ) {
        Some(shader) => Paint {
            shader,
            anti_alias: true,
            ..Paint::default()
        },
        // A sphere too small to shade is a dot.
        None => flat(colour),
    }
}

fn encode(raster: &Raster, pixels_per_point: f64) -> Result<Vec<u8>, FigureError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, raster.width, raster.height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    let pixels_per_metre = (pixels_per_point * POINTS_PER_METRE).round() as u32;
    let density = ::png::PixelDimensions {
        xppu: pixels_per_metre,
        yppu: pixels_per_metre,
        unit: ::png::Unit::Meter,
    };
    encoder.set_pixel_dims(Some(density));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&raster.pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// Outline of a glyph in font units.
struct GlyphPath(PathBuilder);

impl OutlineBuilder for GlyphPath {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}
