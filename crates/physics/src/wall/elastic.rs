//! The parameters of an elastic wall: spheres joined by springs, held by tethers, driven by a travelling force.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The angle that fixes the direction of the driving force on a wall sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DriveAngle {
    /// The angle of the sphere's place in the lattice.
    #[default]
    Reference,
    /// The angle of the sphere where it is now.
    Current,
}

/// What is done with the mean force on the elastic wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NetForce {
    /// Nothing.
    Free,
    /// The mean over the whole wall is taken off each sphere, every step.
    #[default]
    Removed,
    /// The mean over each ring is taken off each sphere of the ring, every step.
    RemovedPerRing,
}

/// Forces that keep an elastic wall in place besides its springs; places and radii are those of the straight tube.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tethers {
    /// Whether a constant force on each wall sphere balances the springs in the straight tube.
    pub balance: bool,
    /// Stiffness of the radial tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub radial: f64,
    /// Stiffness of the azimuthal tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub azimuthal: f64,
    /// Stiffness of the axial tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub axial: f64,
    /// What is done with the mean force on the wall at each step.
    pub net_force: NetForce,
}

impl Default for Tethers {
    fn default() -> Self {
        Self {
            balance: true,
            radial: 0.0,
            azimuthal: 0.1,
            axial: 0.01,
            net_force: NetForce::Removed,
        }
    }
}

/// The spheres of an elastic wall and what acts on them besides the grains and the drive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct ElasticNetwork {
    /// Mass of a wall sphere; stress control.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub sphere_mass: f64,
    /// Stiffness k_w of the spring between lattice neighbours; stress control.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub spring_stiffness: f64,
    /// Natural length l of these springs; stress control. Default: 0.7 of the mean distance of lattice neighbours. An
    /// unstretched network buckles: keep it below the distance of neighbours.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1e6, "default" = null))]
    pub natural_length: f64,
    /// Wall spheres whose places in the straight tube are farther apart than this repel on contact, so that opposite
    /// sides of a throat do not pass through each other; stress control.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1e6))]
    pub contact_range: f64,
    /// Drag coefficient of a wall sphere against the laboratory, force -drag v; stress control.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12))]
    pub drag: f64,
    /// Damping of each spring along its length; stress control.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12))]
    pub spring_damping: f64,
    /// Forces that keep the elastic wall in place; stress control.
    #[serde(rename = "keep")]
    pub tethers: Tethers,
}

impl Default for ElasticNetwork {
    fn default() -> Self {
        Self {
            sphere_mass: 0.1,
            spring_stiffness: 0.018,
            natural_length: 0.7,
            contact_range: 3.0,
            drag: 0.0,
            spring_damping: 0.0,
            tethers: Tethers::default(),
        }
    }
}
