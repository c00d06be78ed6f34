//! The embedded typeface: Arimo, upright and italic.

use std::sync::LazyLock;

use ttf_parser::{GlyphId, Rect};

use crate::geometry::Path;

/// One of the two faces of the typeface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Face {
    Upright,
    Italic,
}

/// A glyph of a face, by its index in the font.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Glyph {
    pub(crate) face: Face,
    pub(crate) index: u16,
}

static UPRIGHT: LazyLock<ttf_parser::Face<'static>> =
    LazyLock::new(|| parse(include_bytes!("../../fonts/Arimo-Regular-subset.ttf")));
static ITALIC: LazyLock<ttf_parser::Face<'static>> =
    LazyLock::new(|| parse(include_bytes!("../../fonts/Arimo-Italic-subset.ttf")));

fn parse(bytes: &'static [u8]) -> ttf_parser::Face<'static> {
    ttf_parser::Face::parse(bytes, 0).expect("the embedded fonts are valid")
}

impl Face {
    pub(crate) fn of(is_italic: bool) -> Self {
        if is_italic {
            Self::Italic
        } else {
            Self::Upright
        }
    }

    fn font(self) -> &'static ttf_parser::Face<'static> {
        match self {
            Self::Upright => &UPRIGHT,
            Self::Italic => &ITALIC,
        }
    }

    /// The glyph of a character; the font's empty box for one that it lacks.
    pub(crate) fn glyph(self, character: char) -> Glyph {
        Glyph {
            face: self,
            index: self.font().glyph_index(character).unwrap_or(GlyphId(0)).0,
        }
    }
}

impl Glyph {
    /// Font units in one em.
    pub(crate) fn units_per_em(self) -> f64 {
        f64::from(self.face.font().units_per_em())
    }

    /// Distance from this glyph's origin to the next one's, in font units.
    pub(crate) fn advance(self) -> f64 {
        let advance = self.face.font().glyph_hor_advance(GlyphId(self.index));
        f64::from(advance.unwrap_or(0))
    }

    /// Box around the ink, in font units with y upwards; none for a space.
    pub(crate) fn ink(self) -> Option<Rect> {
        self.face.font().glyph_bounding_box(GlyphId(self.index))
    }

    /// The outline in font units with y downwards; empty for a space.
    pub(crate) fn outline(self) -> Path {
        let mut path = Path::default();
        let font = self.face.font();
        // A space has no outline, and nothing is drawn for it.
        let _ = font.outline_glyph(GlyphId(self.index), &mut path);
        path
    }
}
