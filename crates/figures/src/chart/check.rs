//! Whether the layers of a panel can be drawn, and what they span.

use super::layer::{ChartLayer, Kind, error_ends};
use super::look::Tint;
use super::panel::{ChartPanel, MARGIN};
use crate::axis::{Scale, extent};
use crate::error::{FigureError, finite, positive};

/// What a panel's layers span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Checked {
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    /// Free space at both ends of the horizontal axis, and below and above, as fractions of the axes.
    pub(super) x_free: f64,
    pub(super) y_free: (f64, f64),
    /// Some points are lower limits, whose arrows need room.
    pub(super) has_limits: bool,
}

/// Collects the values of a panel's layers as it checks them.
struct Check<'a> {
    panel: &'a ChartPanel,
    x: Vec<f64>,
    y: Vec<f64>,
}

/// A layer under check, by its name.
struct Named(String);

impl Checked {
    /// Checks a panel of a chart, which may have a scale of colours.
    pub(super) fn new(panel: &ChartPanel, coloured: bool) -> Result<Self, FigureError> {
        let mut check = Check {
            panel,
            x: Vec::new(),
            y: Vec::new(),
        };
        for layer in &panel.layers {
            if layer.needs_scale() && !coloured {
                let series = layer.name();
                return Err(FigureError::NoColourScale { series });
            }
            check.layer(layer)?;
        }
        let has = |is: fn(&Kind) -> bool| panel.layers.iter().any(|layer| is(&layer.0));
        let y = extent(check.y);
        // Bars stand on the axis, and cells fill it; curves alone may run from side to side.
        let stands = has(|kind| matches!(kind, Kind::Bars(_))) && y.0 == 0.0;
        let fills = has(|kind| matches!(kind, Kind::Field(_)));
        let free = if fills { 0.0 } else { MARGIN };
        Ok(Self {
            x: extent(check.x),
            y,
            x_free: free,
            y_free: (if stands { 0.0 } else { free }, free),
            has_limits: has(
                |kind| matches!(kind, Kind::Points(points) if points.lower_limits.contains(&true)),
            ),
        })
    }
}

impl Check<'_> {
    fn layer(&mut self, layer: &ChartLayer) -> Result<(), FigureError> {
        let named = Named(layer.name());
        if let Some(Tint::Value(value)) = layer.look().and_then(|look| look.tint) {
            finite("value of a colour", value)?;
        }
        match &layer.0 {
            Kind::Points(points) => {
                let length = points.x.len();
                for (column, found) in [
                    ("errors of x", points.x_errors.len()),
                    ("errors of y", points.y_errors.len()),
                    ("lower limits", points.lower_limits.len()),
                ] {
                    if found > 0 {
                        named.length(column, length, found)?;
                    }
                }
                self.rows(&named, ("y", &points.x, &points.y))?;
                for row in points.rows() {
                    self.extend(
                        error_ends(&points.x_errors, row, points.x[row]),
                        error_ends(&points.y_errors, row, points.y[row]),
                    );
                }
                Ok(())
            }
            Kind::Line(line) => {
                positive("weight of a line", line.weight)?;
                self.rows(&named, ("y", &line.x, &line.y))
            }
            Kind::Band(band) => {
                named.length("lower curve", band.x.len(), band.lower.len())?;
                let upper = band.upper_of_pairs();
                self.rows(&named, ("upper curve", &band.x, &upper))?;
                let rows = band.x.iter().zip(&upper).zip(&band.lower);
                for (_, &lower) in rows.filter(|((x, upper), _)| x.is_finite() && upper.is_finite())
                {
                    self.extend([], [lower]);
                }
                Ok(())
            }
            Kind::Bars(bars) => {
                named.length("edges", bars.heights.len() + 1, bars.edges.len())?;
                for (row, &edge) in bars.edges.iter().enumerate() {
                    self.push_x(&named, row, finite("edge of a bar", edge)?)?;
                }
                let finite = |(_, height): &(usize, &f64)| height.is_finite();
                let heights = || bars.heights.iter().enumerate().filter(finite);
                for (row, &height) in heights() {
                    // An empty bar of a histogram has no height to draw, on either scale.
                    if height != 0.0 || self.panel.y.scale == Scale::Linear {
                        self.push_y(&named, row, height)?;
                    }
                }
                self.extend([], [0.0]);
                named.some(heights().count(), bars.heights.len())
            }
            Kind::Field(field) => {
                let columns = field.columns();
                if field.values.is_empty() || columns * field.rows != field.values.len() {
                    return Err(FigureError::GridSize {
                        rows: field.rows,
                        columns,
                        found: field.values.len(),
                    });
                }
                for (axis, (least, largest)) in [("x", field.x), ("y", field.y)] {
                    if !(least.is_finite() && largest.is_finite() && least < largest) {
                        return Err(FigureError::AxisRange {
                            axis,
                            least,
                            largest,
                        });
                    }
                }
                self.extend([field.x.0, field.x.1], [field.y.0, field.y.1]);
                let finite = field.values.iter().filter(|value| value.is_finite());
                named.some(finite.count(), field.values.len())
            }
            // What sets them upon its axes has checked them.
            Kind::Spheres(_) => Ok(()),
            Kind::Reference(reference) => {
                let value = finite("value of a reference line", reference.value)?;
                if reference.vertical {
                    self.push_x(&named, 0, value)
                } else {
                    self.push_y(&named, 0, value)
                }
            }
            Kind::Window(window) => [window.from, window.to]
                .into_iter()
                .try_for_each(|end| self.push_x(&named, 0, finite("end of a window", end)?)),
            Kind::Note(_) => Ok(()),
        }
    }

    /// Checks the rows of a curve whose second column has a name; at least one must have a place.
    fn rows(
        &mut self,
        named: &Named,
        (column, x, y): (&'static str, &[f64], &[f64]),
    ) -> Result<(), FigureError> {
        named.length(column, x.len(), y.len())?;
        let mut found = 0;
        for (row, (&x, &y)) in x.iter().zip(y).enumerate() {
            if x.is_finite() && y.is_finite() {
                self.push_x(named, row, x)?;
                self.push_y(named, row, y)?;
                found += 1;
            }
        }
        named.some(found, x.len())
    }

    fn push_x(&mut self, named: &Named, row: usize, value: f64) -> Result<(), FigureError> {
        named.placed("x", self.panel.x.scale, row, value)?;
        self.x.push(value);
        Ok(())
    }

    fn push_y(&mut self, named: &Named, row: usize, value: f64) -> Result<(), FigureError> {
        named.placed("y", self.panel.y.scale, row, value)?;
        self.y.push(value);
        Ok(())
    }

    /// Values that the axes span as well where they have a place on them.
    fn extend<const X: usize, const Y: usize>(&mut self, x: [f64; X], y: [f64; Y]) {
        let seen = |scale| move |value: &f64| scale == Scale::Linear || *value > 0.0;
        self.x
            .extend(x.into_iter().filter(seen(self.panel.x.scale)));
        self.y
            .extend(y.into_iter().filter(seen(self.panel.y.scale)));
    }
}

impl Named {
    fn length(
        &self,
        column: &'static str,
        expected: usize,
        found: usize,
    ) -> Result<(), FigureError> {
        if expected == found {
            return Ok(());
        }
        Err(FigureError::ColumnLengths {
            series: self.0.clone(),
            column,
            expected,
            found,
        })
    }

    fn some(&self, found: usize, length: usize) -> Result<(), FigureError> {
        if found > 0 {
            return Ok(());
        }
        Err(FigureError::EmptySeries {
            series: self.0.clone(),
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
            series: self.0.clone(),
            row,
            axis,
            value,
        })
    }
}
