//! One coordinate system of a chart: its axes and what it shows.

use std::ops::{Bound, RangeBounds};

use super::layer::ChartLayer;
use crate::axis::{Axis, Scale};
use crate::error::FigureError;

/// A panel of a chart: two axes with their labels in markup, and layers.
///
/// Whatever the order in which layers are added, fields lie at the bottom, then windows, bands, bars, reference lines,
/// curves, points and notes, each kind in its order.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct ChartPanel {
    pub(super) title: String,
    pub(super) x: AxisWish,
    pub(super) y: AxisWish,
    pub(super) x_names: Vec<String>,
    pub(super) layers: Vec<ChartLayer>,
}

/// What is wanted of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct AxisWish {
    pub(super) label: String,
    pub(super) scale: Scale,
    pub(super) least: Option<f64>,
    pub(super) largest: Option<f64>,
}

/// Free space between data and frame, as a fraction of the axis.
pub(super) const MARGIN: f64 = 0.05;
/// Decades on either side of a single value on a logarithmic axis.
const LONE_DECADES: f64 = 0.3;
/// Part of a single value on either side of it on a linear axis.
const LONE_PART: f64 = 0.1;

impl ChartPanel {
    /// An empty panel with the labels of its axes, in markup; both are linear and as long as the data.
    pub fn new(x_label: &str, y_label: &str) -> Self {
        Self {
            title: String::new(),
            x: AxisWish::new(x_label),
            y: AxisWish::new(y_label),
            x_names: Vec::new(),
            layers: Vec::new(),
        }
    }

    /// A line above the panel, in markup.
    pub fn title(mut self, title: &str) -> Self {
        title.clone_into(&mut self.title);
        self
    }

    /// Scale of the horizontal axis.
    pub fn x_scale(mut self, scale: Scale) -> Self {
        self.x.scale = scale;
        self
    }

    /// Scale of the vertical axis.
    pub fn y_scale(mut self, scale: Scale) -> Self {
        self.y.scale = scale;
        self
    }

    /// Range of the horizontal axis; an end that is left open, as in `0.0..`, follows the data.
    pub fn x_range(mut self, range: impl RangeBounds<f64>) -> Self {
        self.x = self.x.within(&range);
        self
    }

    /// Range of the vertical axis; an end that is left open, as in `0.0..`, follows the data.
    pub fn y_range(mut self, range: impl RangeBounds<f64>) -> Self {
        self.y = self.y.within(&range);
        self
    }

    /// Names, in markup, of x = 1, 2, ... in place of numbers.
    pub fn x_names(mut self, names: &[String]) -> Self {
        self.x_names = names.to_vec();
        self
    }

    /// Adds a layer.
    pub fn with(mut self, layer: impl Into<ChartLayer>) -> Self {
        self.layers.push(layer.into());
        self
    }

    /// Adds layers one after the other.
    pub fn with_all(mut self, layers: impl IntoIterator<Item = impl Into<ChartLayer>>) -> Self {
        self.layers.extend(layers.into_iter().map(Into::into));
        self
    }
}

impl AxisWish {
    fn new(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            ..Self::default()
        }
    }

    fn within(self, range: &impl RangeBounds<f64>) -> Self {
        let end = |bound: Bound<&f64>| match bound {
            Bound::Included(&value) | Bound::Excluded(&value) => Some(value),
            Bound::Unbounded => None,
        };
        Self {
            least: end(range.start_bound()),
            largest: end(range.end_bound()),
            ..self
        }
    }

    /// The axis over a range of data, with free space, a fraction of the axis, below and above where the end was not
    /// asked for.
    pub(super) fn axis(
        &self,
        name: &'static str,
        data: (f64, f64),
        free: (f64, f64),
    ) -> Result<Axis, FigureError> {
        let logarithmic = self.scale == Scale::Logarithmic;
        let (least, largest) = (self.least.unwrap_or(data.0), self.largest.unwrap_or(data.1));
        let possible = least.is_finite()
            && largest.is_finite()
            && (!logarithmic || least > 0.0 && largest > 0.0);
        let chosen = self.least.is_some() && self.largest.is_some();
        if !possible || largest < least || chosen && largest <= least {
            return Err(FigureError::AxisRange {
                axis: name,
                least,
                largest,
            });
        }
        let forth = |value: f64| match self.scale {
            Scale::Linear | Scale::Counting => value,
            Scale::Logarithmic => libm::log10(value),
        };
        let back = |place: f64| match self.scale {
            Scale::Linear | Scale::Counting => place,
            Scale::Logarithmic => libm::pow(10.0, place),
        };
        let (mut low, mut high) = (forth(least), forth(largest));
        if low == high {
            let spread = match self.scale {
                Scale::Logarithmic => LONE_DECADES,
                Scale::Linear if low != 0.0 => LONE_PART * low.abs(),
                Scale::Linear | Scale::Counting => (LONE_PART * low.abs()).max(0.5),
            };
            (low, high) = (low - spread, high + spread);
        }
        let length = (high - low) / (1.0 - free.0 - free.1);
        let ends = (
            self.least.unwrap_or_else(|| back(low - free.0 * length)),
            self.largest.unwrap_or_else(|| back(high + free.1 * length)),
        );
        Ok(Axis::new(self.scale, ends))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_follows_the_data_where_it_is_not_told() {
        let wish = AxisWish::new("").within(&(0.0..));
        let axis = wish.axis("x", (2.0, 9.5), (0.0, 0.05)).expect("a range");
        assert_eq!(axis.range().0, 0.0);
        assert!((axis.range().1 - 10.0).abs() < 1e-12, "{:?}", axis.range());
        let nothing = wish.axis("x", (0.0, 0.0), (0.0, 0.05)).expect("a range");
        assert!(nothing.range().0 == 0.0 && nothing.range().1 > 0.0);
        let lone = AxisWish::new("").axis("x", (0.04, 0.04), (0.0, 0.0));
        let (low, high) = lone.expect("a range").range();
        assert!(0.03 < low && low < 0.04 && 0.04 < high && high < 0.05);
    }

    #[test]
    fn margins_of_a_logarithmic_axis_are_ratios() {
        let wish = AxisWish {
            scale: Scale::Logarithmic,
            ..AxisWish::new("")
        };
        let (least, largest) = wish
            .axis("x", (1.0, 100.0), (0.1, 0.1))
            .expect("a range")
            .range();
        assert!((least * largest - 100.0).abs() < 1e-9 && least < 1.0);
        let lone = wish.axis("x", (7.0, 7.0), (0.0, 0.0)).expect("a range");
        assert!((lone.fraction(7.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn an_impossible_range_is_refused() {
        let logarithmic = AxisWish {
            scale: Scale::Logarithmic,
            ..AxisWish::new("")
        };
        for wish in [
            logarithmic.within(&(0.0..)),
            AxisWish::new("").within(&(3.0..=1.0)),
            AxisWish::new("").within(&(f64::NAN..)),
            AxisWish::new("").within(&(20.0..)),
        ] {
            let error = wish.axis("y", (1.0, 10.0), (0.0, 0.0));
            assert!(
                matches!(error, Err(FigureError::AxisRange { axis: "y", .. })),
                "{error:?}"
            );
        }
    }
}
