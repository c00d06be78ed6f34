//! Whether the layers of a panel can be drawn, and what they span.

use super::layer::{Bars, ChartLayer, Field, Kind, Points, error_ends};
use super::paint::ARROW;
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
}

/// The values on one axis, which layers are checked against.
struct Values {
    axis: &'static str,
    scale: Scale,
    found: Vec<f64>,
}

impl Checked {
    /// Checks a panel of a height on the page, of a chart that may have a scale of colours.
    pub(super) fn new(
        panel: &ChartPanel,
        height: f64,
        coloured: bool,
    ) -> Result<Self, FigureError> {
        let values = |axis, scale| Values {
            axis,
            scale,
            found: Vec::new(),
        };
        let mut check = Check {
            series: String::new(),
            x: values("x", panel.x.scale),
            y: values("y", panel.y.scale),
        };
        for layer in &panel.layers {
            let value = layer.value_of_colour();
            check.series = layer.name();
            if !coloured && (layer.is_coloured_area() || value.is_some()) {
                let series = check.series;
                return Err(FigureError::NoColourScale { series });
            }
            if let Some(value) = value {
                finite("value of a colour", value)?;
            }
            check.layer(layer)?;
        }
        let has = |is: fn(&Kind) -> bool| panel.layers.iter().any(|layer| is(&layer.0));
        let y = extent(check.y.found);
        // Bars stand on the axis, and cells fill it; curves alone may run from side to side.
        let stands = has(|kind| matches!(kind, Kind::Bars(_))) && y.0 == 0.0;
        let fills = has(|kind| matches!(kind, Kind::Field(_)));
        let free = if fills { 0.0 } else { MARGIN };
        // Arrows of lower limits need room.
        let mut above = free;
        if has(|kind| matches!(kind, Kind::Points(points) if points.lower_limits.contains(&true))) {
            above = free.max((ARROW + 3.0) / height).min(0.4);
        }
        Ok(Self {
            x: extent(check.x.found),
            y,
            x_free: free,
            y_free: (if stands { 0.0 } else { free }, above),
        })
    }
}

/// Collects the values of layers as it checks them.
struct Check {
    /// Name of the layer.
    series: String,
    x: Values,
    y: Values,
}

impl Check {
    fn layer(&mut self, layer: &ChartLayer) -> Result<(), FigureError> {
        match &layer.0 {
            Kind::Points(points) => self.points(points),
            Kind::Line(line) => {
                positive("weight of a line", line.weight)?;
                self.rows("y", &line.x, &line.y)
            }
            Kind::Band(band) => {
                self.length("lower curve", band.x.len(), band.lower.len())?;
                let [upper, _] = band.pairs();
                self.rows("upper curve", &band.x, &upper)?;
                let rows = band.x.iter().zip(&upper).zip(&band.lower);
                let rows = rows.filter(|((x, upper), _)| x.is_finite() && upper.is_finite());
                self.y.extend(rows.map(|(_, &lower)| lower));
                Ok(())
            }
            Kind::Bars(bars) => self.bars(bars),
            Kind::Field(field) => self.field(field),
            // What sets them upon its axes has checked them.
            Kind::Spheres(_) => Ok(()),
            Kind::Reference(reference) => {
                let value = finite("value of a reference line", reference.value)?;
                let is_vertical = reference.vertical;
                let axis = if is_vertical {
                    &mut self.x
                } else {
                    &mut self.y
                };
                axis.push(&self.series, 0, value)
            }
            Kind::Window(window) => [window.from, window.to].into_iter().try_for_each(|end| {
                let end = finite("end of a window", end)?;
                self.x.push(&self.series, 0, end)
            }),
            Kind::Key(_) | Kind::Note(_) => Ok(()),
        }
    }

    fn points(&mut self, points: &Points) -> Result<(), FigureError> {
        for (column, found) in [
            ("errors of x", points.x_errors.len()),
            ("errors of y", points.y_errors.len()),
            ("lower limits", points.lower_limits.len()),
        ] {
            if found > 0 {
                self.length(column, points.x.len(), found)?;
            }
        }
        self.rows("y", &points.x, &points.y)?;
        for row in points.rows() {
            let (x, y) = (points.x[row], points.y[row]);
            self.x.extend(error_ends(&points.x_errors, row, x));
            self.y.extend(error_ends(&points.y_errors, row, y));
        }
        Ok(())
    }

    fn bars(&mut self, bars: &Bars) -> Result<(), FigureError> {
        self.length("edges", bars.heights.len() + 1, bars.edges.len())?;
        for (row, &edge) in bars.edges.iter().enumerate() {
            let edge = finite("edge of a bar", edge)?;
            self.x.push(&self.series, row, edge)?;
        }
        let finite = |(_, height): &(usize, &f64)| height.is_finite();
        let heights = || bars.heights.iter().enumerate().filter(finite);
        for (row, &height) in heights() {
            // An empty bar of a histogram has no height to draw, on either scale.
            if height != 0.0 || self.y.scale != Scale::Logarithmic {
                self.y.push(&self.series, row, height)?;
            }
        }
        self.y.extend([0.0]);
        self.some(heights().count(), bars.heights.len())
    }

    fn field(&mut self, field: &Field) -> Result<(), FigureError> {
        let (columns, found) = (field.columns(), field.values.len());
        if found == 0 || columns * field.rows != found {
            let rows = field.rows;
            return Err(FigureError::GridSize {
                rows,
                columns,
                found,
            });
        }
        for (values, (least, largest)) in [(&mut self.x, field.x), (&mut self.y, field.y)] {
            if !(least.is_finite() && largest.is_finite() && least < largest) {
                return Err(FigureError::AxisRange {
                    axis: values.axis,
                    least,
                    largest,
                });
            }
            values.extend([least, largest]);
        }
        let finite = field.values.iter().filter(|value| value.is_finite());
        self.some(finite.count(), found)
    }

    /// Checks the rows of a curve whose second column has a name; at least one must have a place.
    fn rows(&mut self, column: &'static str, x: &[f64], y: &[f64]) -> Result<(), FigureError> {
        self.length(column, x.len(), y.len())?;
        let mut found = 0;
        for (row, (&x, &y)) in x.iter().zip(y).enumerate() {
            if x.is_finite() && y.is_finite() {
                self.x.push(&self.series, row, x)?;
                self.y.push(&self.series, row, y)?;
                found += 1;
            }
        }
        self.some(found, x.len())
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
        let series = self.series.clone();
        Err(FigureError::ColumnLengths {
            series,
            column,
            expected,
            found,
        })
    }

    fn some(&self, found: usize, length: usize) -> Result<(), FigureError> {
        if found > 0 {
            return Ok(());
        }
        let series = self.series.clone();
        Err(FigureError::EmptySeries { series, length })
    }
}

impl Values {
    /// A value of a row, which must have a place on the axis.
    fn push(&mut self, series: &str, row: usize, value: f64) -> Result<(), FigureError> {
        if !self.has_place(value) {
            return Err(FigureError::NotPositiveOnLogarithm {
                series: series.to_owned(),
                row,
                axis: self.axis,
                value,
            });
        }
        self.found.push(value);
        Ok(())
    }

    /// Values that the axis spans as well where they have a place on it.
    fn extend(&mut self, values: impl IntoIterator<Item = f64>) {
        for value in values {
            if self.has_place(value) {
                self.found.push(value);
            }
        }
    }

    fn has_place(&self, value: f64) -> bool {
        self.scale != Scale::Logarithmic || value > 0.0
    }
}
