//! How the spheres of the wall stand.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the spheres of the wall stand on the tube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// In rings, every other ring turned by half a spacing.
    #[default]
    Staggered,
    /// In rings that are not turned: squares, where spacing and chord are equal; strain control.
    Aligned,
    /// At independent random places, as many as in rings; strain control.
    Random,
    /// At random places, the largest distance apart at which all find room one after another; strain control.
    Disordered,
    /// At the angles and places of a table; strain control.
    File,
    /// No spheres: the wall is the smooth surface that ever finer lattices approach; strain control.
    Smooth,
}

impl Arrangement {
    /// Every arrangement.
    pub const ALL: [Self; 6] = [
        Self::Staggered,
        Self::Aligned,
        Self::Random,
        Self::Disordered,
        Self::File,
        Self::Smooth,
    ];

    /// Whether the wall is made of spheres: as many as the rings of a lattice have.
    pub fn has_spheres(self) -> bool {
        self != Self::Smooth
    }

    /// Whether random numbers decide where the spheres stand.
    pub fn is_drawn(self) -> bool {
        matches!(self, Self::Random | Self::Disordered)
    }
}
