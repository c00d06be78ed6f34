//! What a panel of a chart shows, one layer upon the other.

use super::look::{Look, Pattern, Tint};
use super::points::Points;

/// A curve; rows that are not finite leave gaps.
///
/// It is thinned to what can be seen, so that a curve of any length takes a few dozen kilobytes of an SVG.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) look: Look,
    pub(super) pattern: Pattern,
    pub(super) weight: f64,
    pub(super) stepped: bool,
}

/// The area between two curves over the same x; rows that are not finite leave gaps.
///
/// On a logarithmic axis a lower curve at or below 0 is drawn to the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    pub(super) look: Look,
    pub(super) stepped: bool,
}

/// A histogram: bars between consecutive edges.
///
/// A height that is not finite leaves its bar out; one of 0 on a logarithmic axis has no bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    pub(super) name: String,
    pub(super) edges: Vec<f64>,
    pub(super) heights: Vec<f64>,
    pub(super) look: Look,
    pub(super) outlined: bool,
}

/// A straight line from side to side at one value, with a label where it covers least.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    pub(super) value: f64,
    pub(super) vertical: bool,
    pub(super) label: String,
    pub(super) pattern: Pattern,
    pub(super) tint: Tint,
}

/// A shaded interval of x, from the bottom to the top of the panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) tint: Tint,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    pub(super) text: String,
    pub(super) place: Place,
    pub(super) tint: Tint,
}

/// Where a note stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    At(f64, f64),
    In(Corner),
}

/// A corner of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// At the top, on the left.
    TopLeft,
    /// At the top, on the right.
    TopRight,
    /// At the bottom, on the left.
    BottomLeft,
    /// At the bottom, on the right.
    BottomRight,
}

/// Anything that a panel shows.
#[derive(Clone, Debug, PartialEq)]
pub enum ChartLayer {
    /// Points with errors.
    Points(Points),
    /// A curve.
    Line(Line),
    /// An area between curves.
    Band(Band),
    /// A histogram.
    Bars(Bars),
    /// A line at one value.
    Reference(Reference),
    /// A shaded interval.
    Window(Window),
    /// A text.
    Note(Note),
}

impl Line {
    /// A curve; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            x: x.to_vec(),
            y: y.to_vec(),
            look: Look::default(),
            pattern: Pattern::Solid,
            weight: 1.0,
            stepped: false,
        }
    }

    /// Each value holds until the next x, as in a survival curve.
    #[must_use]
    pub fn stepped(self) -> Self {
        Self {
            stepped: true,
            ..self
        }
    }

    /// Pattern of the line.
    #[must_use]
    pub fn pattern(self, pattern: Pattern) -> Self {
        Self { pattern, ..self }
    }

    /// Weight in points, 1 unless given; a heavy line below a light one keeps both readable where they coincide.
    #[must_use]
    pub fn weight(self, weight: f64) -> Self {
        Self { weight, ..self }
    }

    /// Number of the series, which decides the colour.
    #[must_use]
    pub fn series(mut self, number: usize) -> Self {
        self.look.series = Some(number);
        self
    }

    /// Another colour than that of the series.
    #[must_use]
    pub fn tint(mut self, tint: Tint) -> Self {
        self.look.tint = Some(tint);
        self
    }
}

impl Band {
    /// The area between a lower and an upper curve; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, x: &[f64], lower: &[f64], upper: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            x: x.to_vec(),
            lower: lower.to_vec(),
            upper: upper.to_vec(),
            look: Look::default(),
            stepped: false,
        }
    }

    /// Each pair of values holds until the next x.
    #[must_use]
    pub fn stepped(self) -> Self {
        Self {
            stepped: true,
            ..self
        }
    }

    /// Number of the series, which decides the colour.
    #[must_use]
    pub fn series(mut self, number: usize) -> Self {
        self.look.series = Some(number);
        self
    }

    /// Another colour than that of the series.
    #[must_use]
    pub fn tint(mut self, tint: Tint) -> Self {
        self.look.tint = Some(tint);
        self
    }
}

impl Bars {
    /// Bars over intervals: one more edge than heights. The name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, edges: &[f64], heights: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            edges: edges.to_vec(),
            heights: heights.to_vec(),
            look: Look::default(),
            outlined: false,
        }
    }

    /// Only the outline, so that several histograms can lie over each other.
    #[must_use]
    pub fn outlined(self) -> Self {
        Self {
            outlined: true,
            ..self
        }
    }

    /// Number of the series, which decides the colour.
    #[must_use]
    pub fn series(mut self, number: usize) -> Self {
        self.look.series = Some(number);
        self
    }

    /// Another colour than that of the series.
    #[must_use]
    pub fn tint(mut self, tint: Tint) -> Self {
        self.look.tint = Some(tint);
        self
    }
}

impl Reference {
    /// A line from left to right at a value of y.
    pub fn horizontal(y: f64) -> Self {
        Self {
            value: y,
            vertical: false,
            label: String::new(),
            pattern: Pattern::Dotted,
            tint: Tint::Black,
        }
    }

    /// A line from the bottom to the top at a value of x.
    pub fn vertical(x: f64) -> Self {
        Self {
            vertical: true,
            ..Self::horizontal(x)
        }
    }

    /// What is written along the line, in markup.
    #[must_use]
    pub fn label(self, label: &str) -> Self {
        Self {
            label: label.to_owned(),
            ..self
        }
    }

    /// Pattern of the line, dotted unless given.
    #[must_use]
    pub fn pattern(self, pattern: Pattern) -> Self {
        Self { pattern, ..self }
    }

    /// Colour of line and label, black unless given.
    #[must_use]
    pub fn tint(self, tint: Tint) -> Self {
        Self { tint, ..self }
    }
}

impl Window {
    /// The interval; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, from: f64, to: f64) -> Self {
        Self {
            name: name.to_owned(),
            from,
            to,
            tint: Tint::Grey,
        }
    }

    /// Its colour, grey unless given.
    #[must_use]
    pub fn tint(self, tint: Tint) -> Self {
        Self { tint, ..self }
    }
}

impl Note {
    /// A text, in markup, that starts at a place of the axes, moved into the panel where it would leave it.
    pub fn at(x: f64, y: f64, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            place: Place::At(x, y),
            tint: Tint::Black,
        }
    }

    /// A text, in markup, in a corner of the panel.
    pub fn corner(corner: Corner, text: &str) -> Self {
        Self {
            place: Place::In(corner),
            ..Self::at(0.0, 0.0, text)
        }
    }

    /// Its colour, black unless given.
    #[must_use]
    pub fn tint(self, tint: Tint) -> Self {
        Self { tint, ..self }
    }
}

macro_rules! layers {
    ($($kind:ident),*) => {
        $(impl From<$kind> for ChartLayer {
            fn from(layer: $kind) -> Self {
                Self::$kind(layer)
            }
        })*
    };
}

layers!(Points, Line, Band, Bars, Reference, Window, Note);
