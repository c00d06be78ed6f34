//! The grains, and what acts on every one of them.

use peristalsis_physics::sizes::{SizeForm, Sizes};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits;

/// The grains: how many and how large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Grains {
    /// Number of grains N in the whole tube.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = limits::MOST_GRAINS, "default" = null))]
    pub number: u64,
    /// Smallest grain diameter. The mass of a grain is its diameter cubed. Of a table its least.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub diameter_min: f64,
    /// Largest grain diameter, not below diameter_min. Of a table its largest.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub diameter_max: f64,
    /// How diameters are distributed, by number, from diameter_min to diameter_max.
    #[serde(skip_serializing_if = "SizeForm::is_uniform")]
    pub sizes: SizeForm,
    /// Median of lognormal diameters. Default: the geometric mean of diameter_min and diameter_max.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub diameter_median: Option<f64>,
    /// Standard deviation of ln d of lognormal diameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0, "maximum" = 10))]
    pub diameter_spread: Option<f64>,
    /// Part of the grains, by number, that have diameter_max under sizes = "two"; the others have diameter_min.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1))]
    pub large_fraction: Option<f64>,
    /// Diameters under sizes = "table".
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "d", "items" = {"type": "number", "exclusiveMinimum": 0, "maximum": 1e6}))]
    pub diameters: Vec<f64>,
    /// Part of the grains, by number, of each of the diameters; they need not add up to 1.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "1", "items" = {"type": "number", "minimum": 0, "maximum": 1e12}))]
    pub fractions: Vec<f64>,
}

impl Default for Grains {
    fn default() -> Self {
        Self {
            number: 0,
            diameter_min: 1.0,
            diameter_max: 1.0,
            sizes: SizeForm::Uniform,
            diameter_median: None,
            diameter_spread: None,
            large_fraction: None,
            diameters: Vec::new(),
            fractions: Vec::new(),
        }
    }
}

impl Grains {
    /// How the diameters are distributed.
    pub fn distribution(&self) -> Sizes {
        let bounds @ [least, largest] = [self.diameter_min, self.diameter_max];
        let classes = match self.sizes {
            SizeForm::Lognormal => {
                return Sizes::Lognormal {
                    bounds,
                    median: self.diameter_median.unwrap_or((least * largest).sqrt()),
                    spread: self.diameter_spread.unwrap_or(1.0),
                };
            }
            SizeForm::Uniform => None,
            SizeForm::Two => {
                let large = self.large_fraction.unwrap_or(0.5);
                Sizes::classes(vec![(least, 1.0 - large), (largest, large)])
            }
            SizeForm::Table => {
                let fractions = self.fractions.iter().copied();
                Sizes::classes(self.diameters.iter().copied().zip(fractions).collect())
            }
        };
        classes.unwrap_or(Sizes::Uniform(bounds))
    }

    /// Mean of the cubed diameter over the grains \[d^3\].
    pub fn mean_cubed_diameter(&self) -> f64 {
        self.distribution().mean(3)
    }
}

/// Forces on all grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Body {
    /// Gravity [x, y, z] on the grains. z is the tube's axis, whichever way the wave runs; x and y lie across it:
    /// [0, -0.001, 0] is a horizontal tube, [0, 0, -0.001] an upright one. The wall has no weight. drive.body_force adds
    /// to it; units.acceleration gives it in SI.
    #[schemars(extend("x-unit" = "d t^-2", "items" = {"type": "number", "minimum": -1e6, "maximum": 1e6}))]
    pub gravity: [f64; 3],
}
