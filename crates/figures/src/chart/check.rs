//! Whether the layers of a panel can be drawn, and what they span.

use super::layer::{Band, Bars, ChartLayer, Line, Place};
use super::look::{Look, Tint};
use super::panel::{ChartPanel, MARGIN};
use super::points::{Errors, Points};
use crate::axis::Scale;
use crate::error::{FigureError, finite};
use crate::series::extent;
use crate::text::Text;

/// What a panel's layers span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Checked {
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    /// Free space below and above, as fractions of the axis.
    pub(super) y_free: (f64, f64),
    /// Some points are lower limits, whose arrows need room.
    pub(super) has_limits: bool,
}

/// Collects the values of a panel's layers as it checks them.
struct Check {
    x_scale: Scale,
    y_scale: Scale,
    coloured: bool,
    x: Vec<f64>,
    y: Vec<f64>,
}

/// The series under check.
struct Named {
    series: String,
}

impl Checked {
    pub(super) fn new(panel: &ChartPanel, coloured: bool) -> Result<Self, FigureError> {
        let mut check = Check {
            x_scale: panel.x.scale,
            y_scale: panel.y.scale,
            coloured,
            x: Vec::new(),
            y: Vec::new(),
        };
        for layer in &panel.layers {
            check.layer(layer)?;
        }
        let has_bars = panel
            .layers
            .iter()
            .any(|layer| matches!(layer, ChartLayer::Bars(_)));
        let y = extent(check.y);
        // Bars stand on the axis; curves alone may run from side to side.
        let stands = has_bars && y.0 == 0.0;
        Ok(Self {
            x: extent(check.x),
            y,
            y_free: (if stands { 0.0 } else { MARGIN }, MARGIN),
            has_limits: panel.layers.iter().any(
                |layer| matches!(layer, ChartLayer::Points(points) if points.lower_limits.contains(&true)),
            ),
        })
    }
}

impl Check {
    fn layer(&mut self, layer: &ChartLayer) -> Result<(), FigureError> {
        match layer {
            ChartLayer::Points(points) => self.points(points),
            ChartLayer::Line(line) => self.line(line),
            ChartLayer::Band(band) => self.band(band),
            ChartLayer::Bars(bars) => self.bars(bars),
            ChartLayer::Reference(reference) => {
                let named = Named::new(&reference.label, "reference line");
                self.tint(&named, reference.tint)?;
                let value = finite("value of a reference line", reference.value)?;
                if reference.vertical {
                    self.push_x(&named, 0, value)
                } else {
                    self.push_y(&named, 0, value)
                }
            }
            ChartLayer::Window(window) => {
                let named = Named::new(&window.name, "window");
                self.tint(&named, window.tint)?;
                for value in [window.from, window.to] {
                    self.push_x(&named, 0, finite("end of a window", value)?)?;
                }
                Ok(())
            }
            ChartLayer::Note(note) => {
                let named = Named::new(&note.text, "note");
                self.tint(&named, note.tint)?;
                match note.place {
                    Place::At(x, y) => {
                        self.push_x(&named, 0, finite("place of a note", x)?)?;
                        self.push_y(&named, 0, finite("place of a note", y)?)
                    }
                    Place::In(_) => Ok(()),
                }
            }
        }
    }

    fn points(&mut self, points: &Points) -> Result<(), FigureError> {
        let named = Named::new(&points.name, "points");
        let length = points.x.len();
        self.look(&named, points.look)?;
        named.length("y", length, points.y.len())?;
        let columns = |errors: &Option<Errors>| {
            errors
                .as_ref()
                .map(|errors| [errors.below.len(), errors.above.len()])
        };
        for (column, lengths) in [
            ("errors of x", columns(&points.x_errors)),
            ("errors of y", columns(&points.y_errors)),
        ] {
            for found in lengths.into_iter().flatten() {
                named.length(column, length, found)?;
            }
        }
        if !points.lower_limits.is_empty() {
            named.length("lower limits", length, points.lower_limits.len())?;
        }
        let rows: Vec<usize> = (0..length)
            .filter(|&row| points.x[row].is_finite() && points.y[row].is_finite())
            .collect();
        for &row in &rows {
            let (x, y) = (points.x[row], points.y[row]);
            self.push_x(&named, row, x)?;
            self.push_y(&named, row, y)?;
            if let Some(errors) = &points.x_errors {
                let (low, high) = errors.ends(row, x);
                self.x.extend(seen(self.x_scale, [low, high]));
            }
            if let Some(errors) = &points.y_errors {
                let (low, high) = errors.ends(row, y);
                self.y.extend(seen(self.y_scale, [low, high]));
            }
        }
        named.some(rows.len(), length)
    }

    fn line(&mut self, line: &Line) -> Result<(), FigureError> {
        let named = Named::new(&line.name, "line");
        self.look(&named, line.look)?;
        crate::error::positive("weight of a line", line.weight)?;
        named.length("y", line.x.len(), line.y.len())?;
        let mut found = 0;
        for (row, (&x, &y)) in line.x.iter().zip(&line.y).enumerate() {
            if x.is_finite() && y.is_finite() {
                self.push_x(&named, row, x)?;
                self.push_y(&named, row, y)?;
                found += 1;
            }
        }
        named.some(found, line.x.len())
    }

    fn band(&mut self, band: &Band) -> Result<(), FigureError> {
        let named = Named::new(&band.name, "band");
        self.look(&named, band.look)?;
        named.length("lower curve", band.x.len(), band.lower.len())?;
        named.length("upper curve", band.x.len(), band.upper.len())?;
        let mut found = 0;
        for (row, &x) in band.x.iter().enumerate() {
            let (lower, upper) = (band.lower[row], band.upper[row]);
            if x.is_finite() && lower.is_finite() && upper.is_finite() {
                self.push_x(&named, row, x)?;
                self.push_y(&named, row, upper)?;
                self.y.extend(seen(self.y_scale, [lower]));
                found += 1;
            }
        }
        named.some(found, band.x.len())
    }

    fn bars(&mut self, bars: &Bars) -> Result<(), FigureError> {
        let named = Named::new(&bars.name, "bars");
        self.look(&named, bars.look)?;
        named.length("edges", bars.heights.len() + 1, bars.edges.len())?;
        for (row, &edge) in bars.edges.iter().enumerate() {
            self.push_x(&named, row, finite("edge of a bar", edge)?)?;
        }
        let mut found = 0;
        for (row, &height) in bars.heights.iter().enumerate() {
            if height.is_finite() {
                // An empty bar of a histogram has no height to draw, on either scale.
                if height != 0.0 || self.y_scale == Scale::Linear {
                    self.push_y(&named, row, height)?;
                }
                found += 1;
            }
        }
        self.y.extend(seen(self.y_scale, [0.0]));
        named.some(found, bars.heights.len())
    }

    fn look(&self, named: &Named, look: Look) -> Result<(), FigureError> {
        look.tint.map_or(Ok(()), |tint| self.tint(named, tint))
    }

    fn tint(&self, named: &Named, tint: Tint) -> Result<(), FigureError> {
        match tint {
            Tint::Value(_) if !self.coloured => Err(FigureError::NoColourScale {
                series: named.series.clone(),
            }),
            Tint::Value(value) => finite("value of a colour", value).map(|_| ()),
            _ => Ok(()),
        }
    }

    fn push_x(&mut self, named: &Named, row: usize, value: f64) -> Result<(), FigureError> {
        named.placed("x", self.x_scale, row, value)?;
        self.x.push(value);
        Ok(())
    }

    fn push_y(&mut self, named: &Named, row: usize, value: f64) -> Result<(), FigureError> {
        named.placed("y", self.y_scale, row, value)?;
        self.y.push(value);
        Ok(())
    }
}

impl Named {
    /// The name without markup, or what the layer is where it has none.
    fn new(name: &str, kind: &str) -> Self {
        let name = if name.is_empty() { kind } else { name };
        Self {
            series: Text::new(name, 1.0).characters,
        }
    }

    fn length(
        &self,
        column: &'static str,
        expected: usize,
        found: usize,
    ) -> Result<(), FigureError> {
        if expected == found {
            return Ok(());
        }
        Err(FigureError::LayerLengths {
            series: self.series.clone(),
            column,
            expected,
            found,
        })
    }

    fn some(&self, found: usize, length: usize) -> Result<(), FigureError> {
        if found > 0 {
            return Ok(());
        }
        Err(FigureError::EmptyLayer {
            series: self.series.clone(),
            length,
        })
    }

    fn placed(
        &self,
        axis: &'static str,
        scale: Scale,
        row: usize,
        value: f64,
    ) -> Result<(), FigureError> {
        if scale == Scale::Linear || value > 0.0 {
            return Ok(());
        }
        Err(FigureError::NotPositiveOnLogarithm {
            series: self.series.clone(),
            row,
            axis,
            value,
        })
    }
}

/// Those of some values that have a place on a scale.
fn seen<const N: usize>(scale: Scale, values: [f64; N]) -> impl Iterator<Item = f64> {
    values
        .into_iter()
        .filter(move |value| scale == Scale::Linear || *value > 0.0)
}
