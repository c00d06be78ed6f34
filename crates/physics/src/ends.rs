//! The ends of the tube: joined to each other, or open.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the tube ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ends {
    /// Joined: what leaves the tube at one end comes in at the other.
    #[default]
    Periodic,
    /// Open: the wave or the weight of the grains carries them from the inlet to the outlet, where they leave; the table
    /// inlet says how others come in. Strain control only.
    Open,
}

impl Ends {
    /// Whether they are joined.
    pub fn is_periodic(&self) -> bool {
        *self == Self::Periodic
    }
}

/// Length that open ends take from the tube, in largest grain diameters: it keeps the grains at the outlet from those at the
/// inlet.
const GAP: f64 = 4.0;

/// Length of the gap between the ends of an open tube, for the largest grain diameter \[d\].
pub fn gap(largest_diameter: f64) -> f64 {
    GAP * largest_diameter
}

/// Steps from one look at the ends of an open tube to the next.
pub const STEPS_PER_LOOK: u64 = 20;

/// The inlet of an open tube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Inlet {
    /// Length of the tube before the outlet that the inlet keeps filled: grains are put in at its far end, as soon as there is
    /// place. Default: the whole tube.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e9, "default" = null))]
    pub head: f64,
    /// Length of the stretch in which grains are put in, at the end of the head that is farther from the outlet. Default: 3 largest diameters.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e9, "default" = null))]
    pub length: f64,
    /// Grains put in per time, as far as there is place for them. Default: as many as find a place each time that the wave has
    /// run one d, or every 2 t where it stands.
    #[schemars(extend("x-unit" = "t^-1", "minimum" = 0, "maximum" = 1e9))]
    pub feed_rate: Option<f64>,
    /// Velocity towards the outlet with which grains are put in.
    #[schemars(extend("x-unit" = "d t^-1", "minimum" = 0, "maximum" = 1e6))]
    pub velocity: f64,
    /// How many of the grains wait outside at t = 0. Those that are packed into the gap of 4 diameters between the ends wait
    /// as well.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 100_000_000))]
    pub waiting: u64,
}
