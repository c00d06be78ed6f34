//! The drawing as an SVG document.
//!
//! Glyphs and shadings are defined once under names made from their content, so that several figures can share one
//! web page, or with a prefix of the caller's; windows are nested `svg` elements, which need no name at all.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use ttf_parser::OutlineBuilder;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Drawing, Fill, Layer, Outline, Point, Reading, Shape, Stroke};
use crate::colour::Colour;
use crate::drawing::png::{
    SPHERE_CENTRE, SPHERE_REACH, cells_picture, pixels_picture, sphere_stops,
};
use crate::text::{Face, Glyph};

/// The whole document.
pub(super) fn document(drawing: &Drawing) -> String {
    let title = escape(&drawing.title);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" role=\"img\">\n<title>{title}</title>\n",
        number(drawing.width_millimetres()),
        number(drawing.height_millimetres()),
        number(drawing.width),
        number(drawing.height),
    );
    if let Some(description) = &drawing.description {
        push(
            &mut out,
            format_args!("<desc>{}</desc>\n", escape(description)),
        );
    }
    out.push_str(&definitions(&drawing.layers, &drawing.prefix));
    push(
        &mut out,
        format_args!(
            "<rect width=\"{}\" height=\"{}\" fill=\"#{}\"/>\n",
            number(drawing.width),
            number(drawing.height),
            drawing.paper.hexadecimal()
        ),
    );
    for layer in &drawing.layers {
        push_layer(&mut out, layer, &drawing.prefix);
    }
    out.push_str("</svg>\n");
    out
}

fn definitions(layers: &[Layer], prefix: &str) -> String {
    let mut glyphs = BTreeSet::new();
    let mut spheres = BTreeMap::new();
    for shape in layers.iter().flat_map(|layer| &layer.shapes) {
        match shape {
            Shape::Text { text, .. } => glyphs.extend(
                text.glyphs
                    .iter()
                    .filter(|placed| placed.glyph.ink().is_some())
                    .map(|placed| placed.glyph),
            ),
            Shape::Circle {
                fill: Fill::Sphere(colour),
                ..
            } => {
                spheres.insert(colour.hexadecimal(), *colour);
            }
            _ => {}
        }
    }
    let mut out = String::from("<defs>\n");
    for (name, colour) in spheres {
        push(
            &mut out,
            format_args!(
                "<radialGradient id=\"{prefix}sphere-{name}\" cx=\"{SPHERE_CENTRE}\" cy=\"{SPHERE_CENTRE}\" r=\"{SPHERE_REACH}\">"
            ),
        );
        for (offset, shade) in sphere_stops(colour) {
            push(
                &mut out,
                format_args!(
                    "<stop offset=\"{offset}\" stop-color=\"#{}\"/>",
                    shade.hexadecimal()
                ),
            );
        }
        out.push_str("</radialGradient>\n");
    }
    for glyph in glyphs {
        let mut outline = GlyphPath(String::new());
        glyph.outline(&mut outline);
        push(
            &mut out,
            format_args!(
                "<path id=\"{prefix}{}\" d=\"{}\"/>\n",
                glyph_name(glyph),
                outline.0
            ),
        );
    }
    out.push_str("</defs>\n");
    out
}

fn push_layer(out: &mut String, layer: &Layer, prefix: &str) {
    let end = match &layer.window {
        None => {
            push(out, format_args!("<g class=\"{}\">\n", layer.name));
            "</g>\n"
        }
        Some(window) => {
            let [x, y, width, height] =
                [window.left, window.top, window.width, window.height].map(number);
            push(
                out,
                format_args!(
                    "<svg class=\"{}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\" overflow=\"hidden\">\n",
                    layer.name
                ),
            );
            "</svg>\n"
        }
    };
    for shape in &layer.shapes {
        push_shape(out, shape, prefix);
    }
    out.push_str(end);
}

fn push_shape(out: &mut String, shape: &Shape, prefix: &str) {
    match shape {
        Shape::Line { points, stroke } => {
            push(
                out,
                format_args!(
                    "<path d=\"{}\" fill=\"none\"{}/>\n",
                    polyline(points),
                    stroke_attributes(stroke)
                ),
            );
        }
        Shape::Polygon { points, fill } => {
            push(
                out,
                format_args!(
                    "<path d=\"{}Z\"{}/>\n",
                    polyline(points),
                    paint("fill", *fill)
                ),
            );
        }
        Shape::Circle {
            centre,
            radius,
            fill,
            stroke,
        } => {
            let fill = match fill {
                Fill::Flat(colour) => paint("fill", *colour),
                Fill::Sphere(colour) => {
                    format!(" fill=\"url(#{prefix}sphere-{})\"", colour.hexadecimal())
                }
            };
            let stroke = stroke.as_ref().map(stroke_attributes).unwrap_or_default();
            let [x, y, radius] = [centre.x, centre.y, *radius].map(number);
            push(
                out,
                format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{fill}{stroke}/>\n"),
            );
        }
        Shape::Marks {
            outline,
            places,
            fill,
            stroke,
        } => {
            push(
                out,
                format_args!(
                    "<path d=\"{}\"{}{}/>\n",
                    marks(outline, places),
                    paint("fill", *fill),
                    stroke_attributes(stroke)
                ),
            );
        }
        Shape::Segments { segments, stroke } => {
            let path: String = segments.iter().map(|ends| polyline(ends)).collect();
            push(
                out,
                format_args!("<path d=\"{path}\"{}/>\n", stroke_attributes(stroke)),
            );
        }
        Shape::Cells {
            area,
            columns,
            colours,
        } => {
            let [x, y, width, height] = [area.left, area.top, area.width, area.height].map(number);
            let picture = STANDARD.encode(cells_picture(*columns, colours));
            push(
                out,
                format_args!(
                    "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{picture}\"/>\n"
                ),
            );
        }
        Shape::Picture {
            area,
            columns,
            pixels,
        } => {
            let [x, y, width, height] = [area.left, area.top, area.width, area.height].map(number);
            let picture = STANDARD.encode(pixels_picture(*columns, pixels));
            push(
                out,
                format_args!(
                    "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"data:image/png;base64,{picture}\"/>\n"
                ),
            );
        }
        Shape::Text {
            start,
            reading,
            text,
            colour,
        } => {
            let turn = match reading {
                Reading::Rightward => "",
                Reading::Upward => " rotate(-90)",
            };
            push(
                out,
                format_args!(
                    "<g role=\"img\" aria-label=\"{}\" transform=\"translate({} {}){turn}\"{}>",
                    escape(&text.characters),
                    number(start.x),
                    number(start.y),
                    paint("fill", *colour)
                ),
            );
            for placed in text
                .glyphs
                .iter()
                .filter(|placed| placed.glyph.ink().is_some())
            {
                push(
                    out,
                    format_args!(
                        "<use href=\"#{prefix}{}\" transform=\"translate({} {}) scale({:.6})\"/>",
                        glyph_name(placed.glyph),
                        number(placed.x),
                        number(placed.y),
                        placed.scale
                    ),
                );
            }
            out.push_str("</g>\n");
        }
    }
}

fn glyph_name(glyph: Glyph) -> String {
    let face = match glyph.face {
        Face::Upright => "upright",
        Face::Italic => "italic",
    };
    format!("{face}-{}", glyph.index)
}

fn polyline(points: &[Point]) -> String {
    let mut out = String::with_capacity(12 * points.len());
    for (index, point) in points.iter().enumerate() {
        out.push(if index == 0 { 'M' } else { 'L' });
        push(
            &mut out,
            format_args!("{} {}", number(point.x), number(point.y)),
        );
    }
    out
}

/// One path of all marks: absolute to each place, relative around it.
fn marks(outline: &Outline, places: &[Point]) -> String {
    let (start, rest) = match outline {
        Outline::Circle { radius } => {
            let (radius, diameter) = (number(*radius), number(2.0 * radius));
            let start = Point { x: 0.0, y: 0.0 };
            (
                start,
                format!(
                    "m-{radius} 0a{radius} {radius} 0 1 0 {diameter} 0a{radius} {radius} 0 1 0-{diameter} 0z"
                ),
            )
        }
        Outline::Polygon(corners) => {
            let steps = corners.windows(2).map(|pair| {
                format!(
                    "l{} {}",
                    number(pair[1].x - pair[0].x),
                    number(pair[1].y - pair[0].y)
                )
            });
            (corners[0], steps.chain(["z".to_owned()]).collect())
        }
    };
    places
        .iter()
        .map(|place| {
            format!(
                "M{} {}{rest}",
                number(place.x + start.x),
                number(place.y + start.y)
            )
        })
        .collect()
}

fn paint(property: &str, colour: Colour) -> String {
    if colour.opacity < 1.0 {
        format!(
            " {property}=\"#{}\" {property}-opacity=\"{}\"",
            colour.hexadecimal(),
            number(colour.opacity)
        )
    } else {
        format!(" {property}=\"#{}\"", colour.hexadecimal())
    }
}

fn stroke_attributes(stroke: &Stroke) -> String {
    let mut out = format!(
        "{} stroke-width=\"{}\" stroke-linejoin=\"round\"",
        paint("stroke", stroke.colour),
        number(stroke.weight)
    );
    if let [first, rest @ ..] = stroke.dash.lengths() {
        let lengths = rest
            .iter()
            .fold(first.to_string(), |list, length| format!("{list} {length}"));
        push(&mut out, format_args!(" stroke-dasharray=\"{lengths}\""));
    }
    out
}

/// A number with at most two decimals, 1/7200 of an inch where it is a length.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no way to write most control characters.
            character if character.is_control() => out.push(' '),
            character => out.push(character),
        }
    }
    out
}

fn push(out: &mut String, arguments: std::fmt::Arguments<'_>) {
    out.write_fmt(arguments)
        .expect("writing to a string cannot fail");
}

/// Path data of a glyph in font units, turned so that y runs downwards.
struct GlyphPath(String);

impl GlyphPath {
    fn command(&mut self, letter: char, coordinates: &[f32]) {
        self.0.push(letter);
        for (index, pair) in coordinates.chunks_exact(2).enumerate() {
            let gap = if index == 0 { "" } else { " " };
            push(
                &mut self.0,
                format_args!(
                    "{gap}{} {}",
                    number(f64::from(pair[0])),
                    number(-f64::from(pair[1]))
                ),
            );
        }
    }
}

impl OutlineBuilder for GlyphPath {
    fn move_to(&mut self, x: f32, y: f32) {
        self.command('M', &[x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.command('L', &[x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.command('Q', &[x1, y1, x, y]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.command('C', &[x1, y1, x2, y2, x, y]);
    }

    fn close(&mut self) {
        self.0.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_minus_zero() {
        assert_eq!(
            [1.0, -0.001, 2.345_678, 100.0, -3.5].map(number),
            ["1", "0", "2.35", "100", "-3.5"]
        );
    }

    #[test]
    fn text_is_made_safe_for_xml() {
        assert_eq!(escape("a<b & \"c\"\u{7}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
