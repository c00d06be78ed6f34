//! Measured points with their errors, some of them lower limits.

use super::look::{Look, Marker, Tint};

/// Measured points, with errors where they are known.
///
/// A row with a coordinate that is not finite is left out; an error that is not finite is unknown and has no bar. Each
/// point takes some 60 bytes of an SVG, with its error bar 140: ten thousand are a file of a megabyte.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) x_errors: Option<Errors>,
    pub(super) y_errors: Option<Errors>,
    pub(super) lower_limits: Vec<bool>,
    pub(super) limit_name: String,
    pub(super) look: Look,
    pub(super) marker: Option<Marker>,
    pub(super) open: bool,
    pub(super) joined: bool,
}

/// How far the bars of the errors reach below and above each value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Errors {
    pub(super) below: Vec<f64>,
    pub(super) above: Vec<f64>,
}

impl Points {
    /// Points of a series; its name, in markup, stands in the legend unless it is empty.
    pub fn new(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            x: x.to_vec(),
            y: y.to_vec(),
            x_errors: None,
            y_errors: None,
            lower_limits: Vec::new(),
            limit_name: String::new(),
            look: Look::default(),
            marker: None,
            open: false,
            joined: false,
        }
    }

    /// Errors of x, the same to both sides.
    #[must_use]
    pub fn x_errors(self, errors: &[f64]) -> Self {
        self.asymmetric_x_errors(errors, errors)
    }

    /// Errors of x: distances to the left and to the right.
    #[must_use]
    pub fn asymmetric_x_errors(self, below: &[f64], above: &[f64]) -> Self {
        Self {
            x_errors: Some(Errors::new(below, above)),
            ..self
        }
    }

    /// Errors of y, the same to both sides.
    #[must_use]
    pub fn y_errors(self, errors: &[f64]) -> Self {
        self.asymmetric_y_errors(errors, errors)
    }

    /// Errors of y: distances downwards and upwards.
    #[must_use]
    pub fn asymmetric_y_errors(self, below: &[f64], above: &[f64]) -> Self {
        Self {
            y_errors: Some(Errors::new(below, above)),
            ..self
        }
    }

    /// Which rows are lower limits only, such as transition times that were not seen: open, with an arrow upwards.
    #[must_use]
    pub fn lower_limits(self, limits: &[bool]) -> Self {
        Self {
            lower_limits: limits.to_vec(),
            ..self
        }
    }

    /// What the legend says of the lower limits, in markup; nothing unless given.
    #[must_use]
    pub fn limit_name(self, name: &str) -> Self {
        Self {
            limit_name: name.to_owned(),
            ..self
        }
    }

    /// Number of the series, which decides colour and marker; without it, the layers of a panel are counted from 0.
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

    /// Another marker than that of the series.
    #[must_use]
    pub fn marker(self, marker: Marker) -> Self {
        Self {
            marker: Some(marker),
            ..self
        }
    }

    /// Markers with a white inside.
    #[must_use]
    pub fn open(self) -> Self {
        Self { open: true, ..self }
    }

    /// A thin line from point to point that guides the eye.
    #[must_use]
    pub fn joined(self) -> Self {
        Self {
            joined: true,
            ..self
        }
    }
}

impl Errors {
    fn new(below: &[f64], above: &[f64]) -> Self {
        Self {
            below: below.to_vec(),
            above: above.to_vec(),
        }
    }

    /// Ends of the bar of a value, where its errors are known.
    pub(super) fn ends(&self, row: usize, value: f64) -> (f64, f64) {
        let known = |error: f64| if error.is_finite() { error.abs() } else { 0.0 };
        (
            value - known(self.below[row]),
            value + known(self.above[row]),
        )
    }
}
