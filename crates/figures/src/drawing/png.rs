//! The drawing as a PNG picture: the same shapes, painted at 300 dots per inch.

use tiny_skia::{
    FillRule, GradientStop, LineJoin, Mask, Paint, PathBuilder, Pixmap, RadialGradient, Shader,
    SpreadMode, StrokeDash, Transform,
};

use super::{
    Drawing, Fill, Image, Raster, Reading, SPHERE_CENTRE, SPHERE_REACH, Shape, Stroke,
    sphere_shades,
};
use crate::colour::Colour;
use crate::error::FigureError;
use crate::geometry::{Path, Point, Rectangle, Step};
use crate::text::Text;

/// 300 dots per inch.
pub(super) const PIXELS_PER_POINT: f64 = 300.0 / 72.0;
const POINTS_PER_METRE: f64 = 72.0 / 0.0254;

/// The encoded picture.
pub(super) fn encoded(drawing: &Drawing) -> Result<Vec<u8>, FigureError> {
    let raster = raster(drawing)?;
    let pixels_per_metre = (drawing.pixels_per_point * POINTS_PER_METRE).round() as u32;
    let density = ::png::PixelDimensions {
        xppu: pixels_per_metre,
        yppu: pixels_per_metre,
        unit: ::png::Unit::Meter,
    };
    let size = [raster.width, raster.height];
    Ok(encode(size, &raster.pixels, Some(density))?)
}

/// Bytes of red, green and blue as a PNG.
pub(super) fn encode(
    [width, height]: [u32; 2],
    pixels: &[u8],
    density: Option<::png::PixelDimensions>,
) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_pixel_dims(density);
    // A run of a second should not spend half of it on files that are a fifth to a half smaller.
    encoder.set_compression(::png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// The painted page.
pub(super) fn raster(drawing: &Drawing) -> Result<Raster, FigureError> {
    // Non-negative by construction; a page too large saturates and is refused below.
    let [width, height] = drawing.size();
    let too_large = FigureError::PictureTooLarge { width, height };
    let Some(mut pixels) = Pixmap::new(width, height) else {
        return Err(too_large);
    };
    pixels.fill(skia_colour(drawing.paper));
    let mut painter = Painter {
        pixels,
        scale: drawing.pixels_per_point,
        mask: None,
    };
    for layer in &drawing.layers {
        painter.mask = layer.window.and_then(|window| painter.mask_of(window));
        for shape in &layer.shapes {
            painter.paint(shape);
        }
    }
    // The page is opaque, so the premultiplied colours are the colours.
    let (colours, _) = painter.pixels.data().as_chunks();
    let mut pixels = vec![0; 3 * colours.len()];
    for (pixel, &[red, green, blue, _]) in pixels.as_chunks_mut().0.iter_mut().zip(colours) {
        *pixel = [red, green, blue];
    }
    Ok(Raster {
        width,
        height,
        pixels,
    })
}

/// A page that is being painted.
struct Painter {
    pixels: Pixmap,
    /// Pixels a point.
    scale: f64,
    /// Opaque inside the window of the layer.
    mask: Option<Mask>,
}

impl Painter {
    /// Opaque inside the window, clear outside.
    fn mask_of(&self, window: Rectangle) -> Option<Mask> {
        let mut mask = Mask::new(self.pixels.width(), self.pixels.height())?;
        let path = skia_path(&Path::polygon(window.corners()))?;
        mask.fill_path(&path, FillRule::Winding, true, self.page());
        Some(mask)
    }

    /// Points to pixels.
    fn page(&self) -> Transform {
        Transform::from_scale(self.scale as f32, self.scale as f32)
    }

    fn paint(&mut self, shape: &Shape) {
        match shape {
            Shape::Path { path, fill, stroke } => {
                let Some(path) = skia_path(path) else { return };
                if let Some(fill) = fill {
                    let paint = match *fill {
                        Fill::Flat(colour) => flat(colour),
                        Fill::Sphere(colour) => sphere(path.bounds(), colour),
                    };
                    self.fill(&path, &paint, self.page());
                }
                if let Some(stroke) = stroke {
                    self.stroke(&path, stroke);
                }
            }
            Shape::Image(image) => self.paint_image(image),
            Shape::Text {
                start,
                reading,
                text,
                colour,
            } => self.paint_text(*start, *reading, text, *colour),
        }
    }

    fn fill(&mut self, path: &tiny_skia::Path, paint: &Paint<'_>, transform: Transform) {
        let mask = self.mask.as_ref();
        self.pixels
            .fill_path(path, paint, FillRule::Winding, transform, mask);
    }

    fn stroke(&mut self, path: &tiny_skia::Path, stroke: &Stroke) {
        let pen = tiny_skia::Stroke {
            width: stroke.weight as f32,
            line_join: LineJoin::Round,
            // A solid line has no lengths, so no pattern.
            dash: StrokeDash::new(stroke.pattern.lengths().to_vec(), 0.0),
            ..tiny_skia::Stroke::default()
        };
        let (page, mask) = (self.page(), self.mask.as_ref());
        self.pixels
            .stroke_path(path, &flat(stroke.colour), &pen, page, mask);
    }

    fn paint_text(&mut self, start: Point, reading: Reading, text: &Text, colour: Colour) {
        let line = self.page().pre_translate(start.x as f32, start.y as f32);
        let line = match reading {
            Reading::Rightward => line,
            Reading::Upward => line.pre_concat(Transform::from_row(0.0, -1.0, 1.0, 0.0, 0.0, 0.0)),
        };
        for placed in &text.glyphs {
            if let Some(path) = skia_path(&placed.glyph.outline()) {
                let scale = placed.scale as f32;
                let transform = line
                    .pre_translate(placed.x as f32, placed.y as f32)
                    .pre_scale(scale, scale);
                self.fill(&path, &flat(colour), transform);
            }
        }
    }

    /// Paints whole pixels, each in the colour of the cell that its middle lies in; what lies beyond the page is left out.
    fn paint_image(&mut self, image: &Image) {
        let area = image.area;
        // On the page, so far from negative.
        let pixel = |length: f64| (length * self.scale).round() as usize;
        let (left, right) = (pixel(area.left), pixel(area.right()));
        let (top, bottom) = (pixel(area.top), pixel(area.bottom()));
        let (width, height) = (self.pixels.width() as usize, self.pixels.height() as usize);
        let canvas = self.pixels.pixels_mut();
        for y in top..bottom.min(height) {
            let row = (2 * (y - top) + 1) * image.rows() / (2 * (bottom - top));
            for x in left..right.min(width) {
                let column = (2 * (x - left) + 1) * image.columns / (2 * (right - left));
                let first = 3 * (row * image.columns + column);
                let [red, green, blue] = [0, 1, 2].map(|channel| image.pixels[first + channel]);
                let colour = tiny_skia::ColorU8::from_rgba(red, green, blue, 255);
                canvas[y * width + x] = colour.premultiply();
            }
        }
    }
}

/// The path as the painter takes it; none without an extent.
fn skia_path(path: &Path) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let place = |point: Point| (point.x as f32, point.y as f32);
    for step in &path.steps {
        match *step {
            Step::Move(to) => builder.move_to(to.x as f32, to.y as f32),
            Step::Line(to) => builder.line_to(to.x as f32, to.y as f32),
            Step::Quadratic(control, to) => {
                let ((x1, y1), (x, y)) = (place(control), place(to));
                builder.quad_to(x1, y1, x, y);
            }
            Step::Cubic(first, second, to) => {
                let ((x1, y1), (x2, y2), (x, y)) = (place(first), place(second), place(to));
                builder.cubic_to(x1, y1, x2, y2, x, y);
            }
            Step::Circle(centre, radius) => {
                builder.push_circle(centre.x as f32, centre.y as f32, radius as f32);
            }
            Step::Close => builder.close(),
        }
    }
    builder.finish()
}

fn skia_colour(colour: Colour) -> tiny_skia::Color {
    let [red, green, blue] = colour.srgb();
    let opacity = (colour.opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
    tiny_skia::Color::from_rgba8(red, green, blue, opacity)
}

fn painted(shader: Shader<'_>) -> Paint<'_> {
    Paint {
        shader,
        anti_alias: true,
        ..Paint::default()
    }
}

fn flat(colour: Colour) -> Paint<'static> {
    painted(Shader::SolidColor(skia_colour(colour)))
}

/// The shading of a sphere in a box.
fn sphere(area: tiny_skia::Rect, colour: Colour) -> Paint<'static> {
    let light = tiny_skia::Point::from_xy(
        area.left() + area.width() * SPHERE_CENTRE as f32,
        area.top() + area.height() * SPHERE_CENTRE as f32,
    );
    let reach = area.width() * SPHERE_REACH as f32;
    let stops = sphere_shades(colour)
        .map(|(offset, shade)| GradientStop::new(offset as f32, skia_colour(shade)))
        .to_vec();
    let transform = Transform::identity();
    RadialGradient::new(light, 0.0, light, reach, stops, SpreadMode::Pad, transform)
        // A sphere too small to shade is a dot.
        .map_or(flat(colour), painted)
}
