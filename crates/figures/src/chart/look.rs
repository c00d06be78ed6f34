//! How the layers of a chart look: colours, markers and patterns of lines.

use crate::colour::{
    BLACK, BLUE, Colour, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION, sequential,
};
use crate::colour_scale::ColourScale;
use crate::drawing::{Dash, Outline, Point};

/// A colour of a layer: one of Okabe and Ito's, or that of a value on the chart's scale of colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tint {
    /// Blue, the first series.
    Blue,
    /// Vermillion, the second series.
    Vermillion,
    /// Bluish green, the third series.
    Green,
    /// Reddish purple, the fourth series.
    Purple,
    /// Orange, the fifth series.
    Orange,
    /// Sky blue, the sixth series.
    Sky,
    /// Black, the seventh series.
    Black,
    /// Grey, for what stands behind.
    Grey,
    /// The colour of this value on the scale of the chart.
    Value(f64),
}

/// Shape of the mark of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A disc, the first series.
    Circle,
    /// A square, the second series.
    Square,
    /// A triangle on its base, the third series.
    Triangle,
    /// A square on its corner, the fourth series.
    Diamond,
    /// A triangle on its corner, the fifth series.
    InvertedTriangle,
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

/// What decides the colour of a layer: its series, unless a tint is given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Look {
    pub(super) series: Option<usize>,
    pub(super) tint: Option<Tint>,
}

const TINTS: [Tint; 7] = [
    Tint::Blue,
    Tint::Vermillion,
    Tint::Green,
    Tint::Purple,
    Tint::Orange,
    Tint::Sky,
    Tint::Black,
];

const MARKERS: [Marker; 5] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::InvertedTriangle,
];

impl Look {
    /// Colour of the layer; `number` counts the layers of the panel.
    pub(super) fn colour(self, number: usize, scale: Option<&ColourScale>) -> Colour {
        let number = self.series.unwrap_or(number);
        match self.tint.unwrap_or(TINTS[number % TINTS.len()]) {
            Tint::Blue => BLUE,
            Tint::Vermillion => VERMILLION,
            Tint::Green => GREEN,
            Tint::Purple => PURPLE,
            Tint::Orange => ORANGE,
            Tint::Sky => SKY,
            Tint::Black => BLACK,
            Tint::Grey => GREY,
            Tint::Value(value) => scale.map_or(sequential(0.0), |scale| scale.colour(value)),
        }
    }

    /// Marker of the layer, unless one was chosen.
    pub(super) fn marker(self, number: usize) -> Marker {
        MARKERS[self.series.unwrap_or(number) % MARKERS.len()]
    }
}

impl Marker {
    /// Outline of a mark about as large as a disc of a radius, in points.
    pub(super) fn outline(self, radius: f64) -> Outline {
        let polygon = |corners: &[(f64, f64)]| {
            let corner = |&(x, y): &(f64, f64)| Point {
                x: x * radius,
                y: y * radius,
            };
            Outline::Polygon(corners.iter().map(corner).collect())
        };
        match self {
            Self::Circle => Outline::Circle { radius },
            Self::Square => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            Self::Triangle => polygon(&[(0.0, -1.35), (1.17, 0.68), (-1.17, 0.68)]),
            Self::Diamond => polygon(&[(0.0, -1.32), (1.32, 0.0), (0.0, 1.32), (-1.32, 0.0)]),
            Self::InvertedTriangle => polygon(&[(0.0, 1.35), (1.17, -0.68), (-1.17, -0.68)]),
        }
    }
}

impl Pattern {
    pub(super) fn dash(self) -> Dash {
        match self {
            Self::Solid => Dash::Solid,
            Self::Dashed => Dash::Dashed,
            Self::Dotted => Dash::Dotted,
            Self::DashDotted => Dash::Alternating,
        }
    }
}
