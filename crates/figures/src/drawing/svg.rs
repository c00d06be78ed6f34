//! The drawing as an SVG document.
//!
//! Glyphs and shadings are defined once under names made from their content, so that several figures can share one
//! web page, or with a prefix of the caller's; windows are nested `svg` elements, which need no name at all.

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::png::encode;
use super::{
    Drawing, Fill, Image, Layer, Reading, SPHERE_CENTRE, SPHERE_REACH, Shape, Stroke, sphere_shades,
};
use crate::colour::Colour;
use crate::geometry::{Path, Point, Rectangle, Step};
use crate::text::{Face, Glyph, Text};

/// The whole document, every `id` in it beginning with a prefix.
pub(super) fn document(drawing: &Drawing, prefix: &str) -> String {
    let mut out = String::new();
    let [width, height] = [drawing.width, drawing.height].map(number);
    out += &format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n",
        number(drawing.width_millimetres()),
        number(drawing.height_millimetres()),
        escape(&drawing.title),
    );
    if !drawing.description.is_empty() {
        out += &format!("<desc>{}</desc>\n", escape(&drawing.description));
    }
    push_definitions(&mut out, &drawing.layers, prefix);
    let paper = drawing.paper.hexadecimal();
    out += &format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#{paper}\"/>\n");
    for layer in &drawing.layers {
        push_layer(&mut out, layer, prefix);
    }
    out.push_str("</svg>\n");
    out
}

/// The glyphs and the shadings that the layers refer to.
fn push_definitions(out: &mut String, layers: &[Layer], prefix: &str) {
    let mut glyphs = BTreeSet::new();
    let mut spheres = BTreeMap::new();
    for shape in layers.iter().flat_map(|layer| &layer.shapes) {
        match shape {
            Shape::Text { text, .. } => glyphs.extend(text.inked().map(|placed| placed.glyph)),
            Shape::Path {
                fill: Some(Fill::Sphere(colour)),
                ..
            } => {
                spheres.insert(colour.hexadecimal(), *colour);
            }
            _ => {}
        }
    }
    *out += "<defs>\n";
    for (name, colour) in spheres {
        *out += &format!(
            "<radialGradient id=\"{prefix}sphere-{name}\" cx=\"{SPHERE_CENTRE}\" cy=\"{SPHERE_CENTRE}\" r=\"{SPHERE_REACH}\">"
        );
        for (offset, shade) in sphere_shades(colour) {
            let shade = shade.hexadecimal();
            *out += &format!("<stop offset=\"{offset}\" stop-color=\"#{shade}\"/>");
        }
        *out += "</radialGradient>\n";
    }
    for glyph in glyphs {
        let (name, path) = (glyph_name(glyph), path_data(&glyph.outline()));
        *out += &format!("<path id=\"{prefix}{name}\" d=\"{path}\"/>\n");
    }
    *out += "</defs>\n";
}

fn push_layer(out: &mut String, layer: &Layer, prefix: &str) {
    let name = layer.name;
    let end = match layer.window {
        None => {
            *out += &format!("<g class=\"{name}\">\n");
            "</g>\n"
        }
        Some(window) => {
            let [x, y, width, height] = box_numbers(window);
            *out += &format!(
                "<svg class=\"{name}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\" overflow=\"hidden\">\n"
            );
            "</svg>\n"
        }
    };
    for shape in &layer.shapes {
        match shape {
            Shape::Path { path, fill, stroke } => {
                let fill = match fill {
                    None => " fill=\"none\"".to_owned(),
                    Some(Fill::Flat(colour)) => paint("fill", *colour),
                    Some(Fill::Sphere(colour)) => {
                        format!(" fill=\"url(#{prefix}sphere-{})\"", colour.hexadecimal())
                    }
                };
                let stroke = stroke.as_ref().map(stroke_attributes).unwrap_or_default();
                *out += &format!("<path d=\"{}\"{fill}{stroke}/>\n", path_data(path));
            }
            Shape::Image(image) => push_image(out, image),
            Shape::Text {
                start,
                reading,
                text,
                colour,
            } => push_text(out, (*start, *reading), text, *colour, prefix),
        }
    }
    out.push_str(end);
}

fn push_image(out: &mut String, image: &Image) {
    let [x, y, width, height] = box_numbers(image.area);
    let size = [image.columns as u32, image.rows() as u32];
    let picture = encode(size, &image.pixels, None)
        .expect("writing a picture of whole rows to memory cannot fail");
    let pixelated = " style=\"image-rendering:pixelated\"";
    let style = if image.is_smooth { "" } else { pixelated };
    *out += &format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\"{style} href=\"data:image/png;base64,{}\"/>\n",
        STANDARD.encode(picture)
    );
}

fn push_text(
    out: &mut String,
    (start, reading): (Point, Reading),
    text: &Text,
    colour: Colour,
    prefix: &str,
) {
    let turn = match reading {
        Reading::Rightward => "",
        Reading::Upward => " rotate(-90)",
    };
    *out += &format!(
        "<g role=\"img\" aria-label=\"{}\" transform=\"translate({} {}){turn}\"{}>",
        escape(&text.characters),
        number(start.x),
        number(start.y),
        paint("fill", colour)
    );
    for placed in text.inked() {
        *out += &format!(
            "<use href=\"#{prefix}{}\" transform=\"translate({} {}) scale({:.6})\"/>",
            glyph_name(placed.glyph),
            number(placed.x),
            number(placed.y),
            placed.scale
        );
    }
    out.push_str("</g>\n");
}

fn glyph_name(glyph: Glyph) -> String {
    let face = match glyph.face {
        Face::Upright => "upright",
        Face::Italic => "italic",
    };
    format!("{face}-{}", glyph.index)
}

fn path_data(path: &Path) -> String {
    let mut out = String::with_capacity(12 * path.steps.len());
    for step in &path.steps {
        match *step {
            Step::Move(to) => push_step(&mut out, 'M', &[to]),
            Step::Line(to) => push_step(&mut out, 'L', &[to]),
            Step::Quadratic(control, to) => push_step(&mut out, 'Q', &[control, to]),
            Step::Cubic(first, second, to) => push_step(&mut out, 'C', &[first, second, to]),
            Step::Circle(centre, radius) => {
                push_step(&mut out, 'M', &[Point::new(centre.x - radius, centre.y)]);
                let [radius, diameter] = [radius, 2.0 * radius].map(number);
                out += &format!(
                    "a{radius} {radius} 0 1 0 {diameter} 0a{radius} {radius} 0 1 0-{diameter} 0z"
                );
            }
            Step::Close => out.push('Z'),
        }
    }
    out
}

fn push_step(out: &mut String, letter: char, points: &[Point]) {
    for (index, point) in points.iter().enumerate() {
        let before = if index == 0 { letter } else { ' ' };
        *out += &format!("{before}{} {}", number(point.x), number(point.y));
    }
}

fn box_numbers(area: Rectangle) -> [String; 4] {
    [area.left, area.top, area.width, area.height].map(number)
}

fn paint(property: &str, colour: Colour) -> String {
    let mut out = format!(" {property}=\"#{}\"", colour.hexadecimal());
    if colour.opacity < 1.0 {
        out += &format!(" {property}-opacity=\"{}\"", number(colour.opacity));
    }
    out
}

fn stroke_attributes(stroke: &Stroke) -> String {
    let mut out = paint("stroke", stroke.colour);
    let weight = number(stroke.weight);
    out += &format!(" stroke-width=\"{weight}\" stroke-linejoin=\"round\"");
    let lengths = stroke.pattern.lengths().iter();
    let lengths: Vec<String> = lengths.map(f32::to_string).collect();
    if !lengths.is_empty() {
        out += &format!(" stroke-dasharray=\"{}\"", lengths.join(" "));
    }
    out
}

/// A number with at most two decimals, 1/7200 of an inch where it is a length.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
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
