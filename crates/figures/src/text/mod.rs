//! Labels set in type: glyphs of the embedded font with their places on one line.

mod font;
mod markup;

pub(crate) use font::{Face, Glyph};
pub use markup::{Letter, Level, letters};

/// Size of subscripts and superscripts relative to the line.
const SCRIPT_SIZE: f64 = 0.7;
/// How far a subscript goes below the baseline, in ems of the line.
const SUBSCRIPT_DROP: f64 = 0.18;
/// How far a superscript rises above the baseline, in ems of the line.
const SUPERSCRIPT_RISE: f64 = 0.36;
/// Space between a letter and the dot above it, in ems.
const DOT_GAP: f64 = 0.07;
const COMBINING_DOT: char = '\u{307}';

/// The characters of a label without markup.
pub(crate) fn plain(markup: &str) -> String {
    let letters = letters(markup);
    letters.iter().map(|letter| letter.character).collect()
}

/// Height of a digit above the baseline, in ems.
pub(crate) const DIGIT_HEIGHT: f64 = 0.71;

/// A glyph at its place relative to the start of the line's baseline, in points with y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedGlyph {
    pub(crate) glyph: Glyph,
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Points per font unit.
    pub(crate) scale: f64,
}

/// One line of type.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    pub(crate) glyphs: Vec<PlacedGlyph>,
    /// The characters without markup, for readers that do not see.
    pub(crate) characters: String,
    /// Length of the line in points.
    pub(crate) width: f64,
}

impl Text {
    /// Sets a label in type of the given size in points.
    pub(crate) fn new(markup: &str, size: f64) -> Self {
        let letters = letters(markup);
        let mut glyphs: Vec<PlacedGlyph> = Vec::with_capacity(letters.len());
        let mut pen = 0.0;
        for letter in &letters {
            if letter.character == COMBINING_DOT {
                // The upright dot: a slanted one is drawn off centre.
                let dot = Face::Upright.glyph(COMBINING_DOT);
                let placed = glyphs.last().and_then(|base| dot_above(base, dot));
                glyphs.extend(placed);
                continue;
            }
            let (relative_size, y) = setting(letter);
            let glyph = Face::of(letter.italic).glyph(letter.character);
            let scale = size * relative_size / glyph.units_per_em();
            glyphs.push(PlacedGlyph {
                glyph,
                x: pen,
                y: y * size,
                scale,
            });
            pen += glyph.advance() * scale;
        }
        Self {
            glyphs,
            characters: letters.iter().map(|letter| letter.character).collect(),
            width: pen,
        }
    }

    /// The glyphs that leave ink.
    pub(crate) fn inked(&self) -> impl Iterator<Item = &PlacedGlyph> {
        let has_ink = |placed: &&PlacedGlyph| placed.glyph.ink().is_some();
        self.glyphs.iter().filter(has_ink)
    }

    /// Sets a label in type of the given size, or smaller where it would be longer than the room that there is.
    pub(crate) fn fitted(markup: &str, size: f64, room: f64) -> Self {
        let text = Self::new(markup, size);
        if text.width <= room {
            text
        } else {
            Self::new(markup, size * room / text.width)
        }
    }
}

/// Relative size, and height below the baseline in ems.
fn setting(letter: &Letter) -> (f64, f64) {
    match letter.level {
        Level::Base => (1.0, 0.0),
        Level::Subscript => (SCRIPT_SIZE, SUBSCRIPT_DROP),
        Level::Superscript => (SCRIPT_SIZE, -SUPERSCRIPT_RISE),
    }
}

/// The dot centred over the ink of a glyph, a little above it.
fn dot_above(base: &PlacedGlyph, dot: Glyph) -> Option<PlacedGlyph> {
    let (below, above) = (base.glyph.ink()?, dot.ink()?);
    let middle = |ink: ttf_parser::Rect| f64::from(ink.x_min + ink.x_max) / 2.0;
    let slant = match base.glyph.face {
        Face::Upright => 0.0,
        // The slope of the italic carries the top of a letter to the right of its middle.
        Face::Italic => 0.1 * f64::from(below.y_max),
    };
    let gap = DOT_GAP * dot.units_per_em();
    Some(PlacedGlyph {
        glyph: dot,
        x: base.x + base.scale * (middle(below) + slant - middle(above)),
        y: base.y - base.scale * (f64::from(below.y_max) + gap - f64::from(above.y_min)),
        scale: base.scale,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subscript_is_smaller_and_lower() {
        let text = Text::new("*J*_{max}", 8.0);
        assert_eq!(text.glyphs.len(), 4);
        assert_eq!(text.characters, "Jmax");
        let (base, script) = (text.glyphs[0], text.glyphs[1]);
        assert!(script.y > 0.0 && script.scale < base.scale && script.x > 0.0);
        assert_eq!(base.glyph.face, Face::Italic);
    }

    #[test]
    fn a_combining_dot_stands_above_its_letter_and_takes_no_room() {
        let (dotted, bare) = (Text::new("*ε\u{307}*", 8.0), Text::new("*ε*", 8.0));
        assert_eq!(dotted.width, bare.width);
        let dot = dotted.glyphs[1];
        assert!(dot.y < 0.0);
        let bottom = dot.y - dot.scale * f64::from(dot.glyph.ink().expect("ink").y_min);
        let letter = dotted.glyphs[0];
        let top = -letter.scale * f64::from(letter.glyph.ink().expect("ink").y_max);
        assert!(
            bottom < top,
            "the dot at {bottom} must be above the letter's top at {top}"
        );
    }

    #[test]
    fn the_signs_of_our_labels_are_in_the_font() {
        let missing = Face::Upright.glyph('漢');
        for character in "ετρλφμημπχξΔΣ×−±·≤≥≈√∞²³°–†*/()[]".chars()
        {
            for face in [Face::Upright, Face::Italic] {
                assert_ne!(face.glyph(character).index, missing.index, "{character}");
            }
        }
    }

    #[test]
    fn a_long_line_is_made_to_fit() {
        let text = Text::fitted("a rather long title for so small a figure", 8.0, 60.0);
        assert!((text.width - 60.0).abs() < 1e-9);
    }
}
