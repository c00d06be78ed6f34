//! The grains, and what acts on every one of them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits;

/// The grains: how many and how large.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Grains {
    /// Number of grains N in the whole tube.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = limits::MOST_GRAINS, "default" = null))]
    pub number: u64,
    /// Smallest grain diameter; diameters are uniformly distributed and the mass of a grain is its diameter cubed.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub diameter_min: f64,
    /// Largest grain diameter, not below diameter_min.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub diameter_max: f64,
}

impl Default for Grains {
    fn default() -> Self {
        Self {
            number: 0,
            diameter_min: 1.0,
            diameter_max: 1.0,
        }
    }
}

impl Grains {
    /// Mean of the cubed diameter over uniformly distributed diameters \[d^3\]:
    /// (d_min + d_max) (d_min^2 + d_max^2)/4
    pub fn mean_cubed_diameter(&self) -> f64 {
        let (least, most) = (self.diameter_min, self.diameter_max);
        (least + most) * (least * least + most * most) / 4.0
    }
}

/// What acts on every grain, wherever it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Body {
    /// Gravity [x, y, z] on the grains. z is the tube's axis, whichever way the wave runs; x and y lie across it:
    /// [0, -0.001, 0] is a horizontal tube, [0, 0, -0.001] an upright one. The wall has no weight. drive.body_force adds
    /// to it; units.acceleration gives it in SI.
    #[schemars(extend("x-unit" = "d t^-2", "items" = {"type": "number", "minimum": -1e6, "maximum": 1e6}))]
    pub gravity: [f64; 3],
}
