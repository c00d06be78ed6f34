//! What a panel of a chart shows, one layer upon the other.

use super::key::Key;
use super::look::{Look, Tint};
use crate::drawing::Pattern;

/// Measured points, with errors where they are known.
///
/// A row with a coordinate that is not finite is left out; an error that is not finite is unknown and has no bar. Each
/// point takes some 60 bytes of an SVG, with its error bar 140: ten thousand are a file of a megabyte.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Points {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Below and above; empty where no errors are known, and so for y.
    pub(super) x_errors: Vec<[f64; 2]>,
    pub(super) y_errors: Vec<[f64; 2]>,
    pub(super) lower_limits: Vec<bool>,
    pub(super) limit_name: String,
    pub(super) look: Look,
    pub(super) open: bool,
    pub(super) joined: bool,
    pub(super) breaks: Vec<f64>,
}

/// A curve; rows that are not finite leave gaps.
///
/// It is thinned to what can be seen, so that a curve of any length takes a few dozen kilobytes of an SVG.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
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
#[must_use]
pub struct Band {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    pub(super) look: Look,
}

/// A histogram: bars between consecutive edges.
///
/// A height that is not finite leaves its bar out; one of 0 on a logarithmic axis has no bar.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Bars {
    pub(super) name: String,
    pub(super) edges: Vec<f64>,
    pub(super) heights: Vec<f64>,
    pub(super) look: Look,
}

/// A field on a grid of equal cells, coloured by the chart's scale: the flow rate of each wave of the tube against time.
///
/// Values that are not finite are missing and grey. Cells too narrow to be seen are averaged, so that the file stays
/// small however long the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    pub(super) values: Vec<f64>,
    pub(super) rows: usize,
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
}

/// Spheres of given sizes before each other, on axes with [equal scales](super::ChartFigure::equal_scales).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Spheres {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) diameter: Vec<f64>,
    /// On the chart's scale of colours; without values the spheres are faint discs.
    pub(crate) values: Vec<f64>,
}

/// A straight line from side to side at one value, with a label where it covers least.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Reference {
    pub(super) value: f64,
    pub(super) vertical: bool,
    pub(super) label: String,
    pub(super) pattern: Pattern,
    pub(super) look: Look,
}

/// A shaded interval of x, from the bottom to the top of the panel.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Window {
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) look: Look,
}

/// A line of text in a corner of the panel.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Note {
    pub(super) text: String,
    pub(super) corner: Corner,
    pub(super) look: Look,
}

/// A corner of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// At the top, on the left.
    TopLeft,
    /// At the bottom, on the left.
    BottomLeft,
}

/// Anything that a panel shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartLayer(pub(super) Kind);

/// The kinds of layers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Points(Points),
    Line(Line),
    Band(Band),
    Bars(Bars),
    Field(Field),
    Spheres(Spheres),
    Reference(Reference),
    Window(Window),
    Key(Key),
    Note(Note),
}

impl Points {
    /// Points of a series; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            x: x.to_vec(),
            y: y.to_vec(),
            ..Self::default()
        }
    }

    /// Errors of x, the same to both sides.
    pub fn x_errors(mut self, errors: &[f64]) -> Self {
        self.x_errors = errors.iter().map(|error| [*error; 2]).collect();
        self
    }

    /// Errors of y, the same to both sides.
    pub fn y_errors(mut self, errors: &[f64]) -> Self {
        self.y_errors = errors.iter().map(|error| [*error; 2]).collect();
        self
    }

    /// Errors of y downwards and upwards.
    pub fn y_sides(mut self, errors: &[[f64; 2]]) -> Self {
        self.y_errors = errors.to_vec();
        self
    }

    /// Which rows are lower limits only, such as transition times that were not seen: open, with an arrow upwards.
    pub fn lower_limits(mut self, limits: &[bool]) -> Self {
        self.lower_limits = limits.to_vec();
        self
    }

    /// What the legend says of the lower limits, in markup; nothing unless given.
    pub fn limit_name(mut self, name: &str) -> Self {
        name.clone_into(&mut self.limit_name);
        self
    }

    /// Markers with a white inside.
    pub fn open(mut self) -> Self {
        self.open = true;
        self
    }

    /// A thin line from point to point that guides the eye.
    pub fn joined(mut self) -> Self {
        self.joined = true;
        self
    }

    /// The line that joins them is only hinted at where it would pass this x: there is a jump.
    pub fn broken_at(mut self, x: f64) -> Self {
        self.breaks.push(x);
        self
    }

    /// Whether the way from one x to the next passes a jump.
    pub(super) fn jumps_between(&self, one: f64, next: f64) -> bool {
        let (least, largest) = (one.min(next), one.max(next));
        self.breaks
            .iter()
            .any(|place| (least..=largest).contains(place))
    }

    /// The rows with a place.
    pub(super) fn rows(&self) -> impl Iterator<Item = usize> {
        (0..self.x.len()).filter(|&row| self.x[row].is_finite() && self.y[row].is_finite())
    }

    pub(super) fn is_limit(&self, row: usize) -> bool {
        self.lower_limits.get(row).copied().unwrap_or(false)
    }
}

/// Ends of the error bar of a value in a row; the value itself where its error is unknown.
pub(super) fn error_ends(errors: &[[f64; 2]], row: usize, value: f64) -> [f64; 2] {
    let errors = errors.get(row).copied().unwrap_or_default();
    let known = |error: f64| if error.is_finite() { error.abs() } else { 0.0 };
    let [down, up] = errors.map(known);
    [value - down, value + up]
}

impl Line {
    /// A curve; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            x: x.to_vec(),
            y: y.to_vec(),
            weight: 1.0,
            ..Self::default()
        }
    }

    /// Each value holds until the next x, as in a survival curve.
    pub fn stepped(mut self) -> Self {
        self.stepped = true;
        self
    }

    /// Pattern of the line.
    pub fn pattern(mut self, pattern: Pattern) -> Self {
        self.pattern = pattern;
        self
    }

    /// Weight in points, 1 unless given; a heavy line below a light one keeps both readable where they coincide.
    pub fn weight(mut self, weight: f64) -> Self {
        self.weight = weight;
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
        }
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
        }
    }
}

impl Field {
    /// The field over ranges of x and y that the cells fill, row by row from the lowest, each from left to right.
    pub fn new(values: &[f64], rows: usize, x: (f64, f64), y: (f64, f64)) -> Self {
        Self {
            values: values.to_vec(),
            rows,
            x,
            y,
        }
    }
}

impl Spheres {
    /// Adds a sphere before all others.
    pub(crate) fn push(&mut self, x: f64, y: f64, diameter: f64) {
        self.x.push(x);
        self.y.push(y);
        self.diameter.push(diameter);
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
            look: Look::of(Tint::Black),
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
    pub fn label(mut self, label: &str) -> Self {
        label.clone_into(&mut self.label);
        self
    }

    /// Pattern of the line, dotted unless given.
    pub fn pattern(mut self, pattern: Pattern) -> Self {
        self.pattern = pattern;
        self
    }
}

impl Window {
    /// The interval; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, from: f64, to: f64) -> Self {
        Self {
            name: name.to_owned(),
            from,
            to,
            look: Look::of(Tint::Grey),
        }
    }
}

impl Note {
    /// A text, in markup, in a corner of the panel.
    pub fn corner(corner: Corner, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            corner,
            look: Look::of(Tint::Black),
        }
    }
}

/// What every coloured layer offers.
macro_rules! coloured {
    ($($kind:ident),*) => {
        $(impl $kind {
            /// Number of the series, which decides the colour, and the marker of points; without it, the layers of a
            /// panel are counted from 0.
            pub fn series(mut self, number: usize) -> Self {
                self.look.series = Some(number);
                self
            }

            /// A colour in place of the series' own.
            pub fn tint(mut self, tint: Tint) -> Self {
                self.look.tint = Some(tint);
                self
            }
        })*
    };
}

coloured!(Points, Line, Band, Bars, Reference, Window, Note);

macro_rules! layers {
    ($($kind:ident),*) => {
        $(impl From<$kind> for ChartLayer {
            fn from(layer: $kind) -> Self {
                Self(Kind::$kind(layer))
            }
        })*
    };
}

layers!(
    Points, Line, Band, Bars, Field, Spheres, Reference, Window, Key, Note
);

/// Interface between a chart and each of its layers.
pub(super) struct Facts<'a> {
    /// Which of the layers that are drawn upon each other comes first.
    pub(super) depth: usize,
    kind: &'static str,
    name: &'a str,
    /// What decides the layer's colour, where it has one.
    pub(super) look: Option<Look>,
}

impl ChartLayer {
    pub(super) fn facts(&self) -> Facts<'_> {
        let (depth, kind, name, look) = match &self.0 {
            Kind::Field(_) => (0, "field", "", None),
            Kind::Window(it) => (1, "window", &*it.name, Some(it.look)),
            Kind::Band(it) => (2, "band", &*it.name, Some(it.look)),
            Kind::Bars(it) => (3, "bars", &*it.name, Some(it.look)),
            Kind::Spheres(_) => (4, "spheres", "", None),
            Kind::Reference(it) => (5, "reference line", &*it.label, Some(it.look)),
            Kind::Line(it) => (6, "line", &*it.name, Some(it.look)),
            Kind::Points(it) => (7, "points", &*it.name, Some(it.look)),
            Kind::Key(it) => (8, "key", &*it.name, Some(it.look)),
            Kind::Note(it) => (9, "note", &*it.text, Some(it.look)),
        };
        Facts {
            depth,
            kind,
            name,
            look,
        }
    }

    /// Whether the layer is one of those that are counted for their colours.
    pub(super) fn is_series(&self) -> bool {
        matches!(
            self.0,
            Kind::Points(_) | Kind::Line(_) | Kind::Band(_) | Kind::Bars(_)
        )
    }

    /// Whether the chart's scale colours areas of the layer, which even its lightest colours set off.
    pub(super) fn is_coloured_area(&self) -> bool {
        match &self.0 {
            Kind::Field(_) => true,
            Kind::Spheres(spheres) => !spheres.values.is_empty(),
            _ => false,
        }
    }

    /// The value that decides the layer's colour on the chart's scale, where one does.
    pub(super) fn value_of_colour(&self) -> Option<f64> {
        self.facts().look?.value()
    }

    /// The value that decides the colour of points, where one does.
    pub(super) fn value_of_points(&self) -> Option<f64> {
        let is_points = matches!(self.0, Kind::Points(_));
        is_points.then(|| self.value_of_colour()).flatten()
    }

    /// The name without markup, or what the layer is where it has none.
    pub(super) fn name(&self) -> String {
        let Facts { kind, name, .. } = self.facts();
        crate::text::plain(if name.is_empty() { kind } else { name })
    }
}
