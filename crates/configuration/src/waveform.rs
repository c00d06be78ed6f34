//! The names of the ways to squeeze a tube.

use peristalsis_physics::wall::Waveform;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the tube is squeezed, by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveformName {
    /// sin(2 pi phase): throats and bellies alike.
    #[default]
    Sine,
    /// One smooth squeeze, cos^2, over half of each wavelength; elsewhere the tube is straight, of radius a.
    Bolus,
    /// A round roller pressed into the tube over half of each wavelength; elsewhere the tube is straight, of radius a.
    Roller,
    /// A wave whose shape a table gives: drive.table, or drive.phases and drive.radii. Strain control.
    Table,
    /// Segments of finite length that close and open in turn; an open one is straight, of radius a. Strain control.
    Segments,
}

impl WaveformName {
    /// The wave of this name; `None` for one that is more than a name.
    pub fn travelling(self) -> Option<Waveform> {
        match self {
            Self::Sine => Some(Waveform::Sine),
            Self::Bolus => Some(Waveform::Bolus),
            Self::Roller => Some(Waveform::Roller),
            Self::Table | Self::Segments => None,
        }
    }
}
