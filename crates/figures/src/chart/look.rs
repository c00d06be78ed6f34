//! How the layers of a chart look: colours and markers.

use crate::colour::{BLACK, Colour, GREY};
use crate::colour_scale::ColourScale;
use crate::geometry::{Path, Point};

/// A colour of a layer: one of Okabe and Ito's, a direction's, or a value's on the chart's scale of colours.
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
    /// Red, for motion along the wave.
    Along,
    /// Blue, for motion against the wave.
    Against,
    /// The colour of this value on the scale of the chart.
    Value(f64),
}

/// What decides the colour of a layer, and the marker of points: its series, unless a tint is given.
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

/// Outlines of markers about as large as a disc of radius 1: a square, a triangle on its base, a square on its corner, a
/// triangle on its corner; before them all the disc itself.
const POLYGONS: [&[(f64, f64)]; 4] = [
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.35), (1.17, 0.68), (-1.17, 0.68)],
    &[(0.0, -1.32), (1.32, 0.0), (0.0, 1.32), (-1.32, 0.0)],
    &[(0.0, 1.35), (1.17, -0.68), (-1.17, -0.68)],
];

impl Look {
    pub(super) fn of(tint: Tint) -> Self {
        let tint = Some(tint);
        Self { series: None, tint }
    }

    /// The value that decides the colour, where one does.
    pub(super) fn value(self) -> Option<f64> {
        match self.tint? {
            Tint::Value(value) => Some(value),
            _ => None,
        }
    }

    /// Colour of the layer; `number` counts the layers of the panel.
    pub(super) fn colour(self, number: usize, scale: Option<&ColourScale>) -> Colour {
        let number = self.series.unwrap_or(number);
        match self.tint.unwrap_or(TINTS[number % TINTS.len()]) {
            Tint::Blue => Colour::new(0, 114, 178),
            Tint::Vermillion => Colour::new(213, 94, 0),
            Tint::Green => Colour::new(0, 158, 115),
            Tint::Purple => Colour::new(204, 121, 167),
            Tint::Orange => Colour::new(230, 159, 0),
            Tint::Sky => Colour::new(86, 180, 233),
            Tint::Black => BLACK,
            Tint::Grey => GREY,
            Tint::Along => Colour::new(178, 24, 43),
            Tint::Against => Colour::new(33, 102, 172),
            Tint::Value(value) => scale.map_or(GREY, |scale| scale.colour(value)),
        }
    }
}

/// Outline of the marker of a number around the origin, about as large as a disc of a radius in points.
pub(super) fn marker(number: usize, radius: f64) -> Path {
    let origin = Point::new(0.0, 0.0);
    match number % (POLYGONS.len() + 1) {
        0 => Path::circle(origin, radius),
        shape => {
            let corners = POLYGONS[shape - 1].iter();
            Path::polygon(corners.map(|(x, y)| Point::new(x * radius, y * radius)))
        }
    }
}
