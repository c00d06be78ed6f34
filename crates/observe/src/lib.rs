//! Observables: numbers read off a simulation without touching it.
//!
//! - A [`View`] is a simulation as it is, looked at once. [`Observer`] turns views into one [`Sample`] an interval.
//!   [`columns::COLUMNS`] is the table of what a sample holds, from which files and documentation follow.
//! - [`WaveFrameProfile`] averages density, velocity and temperature in the wave frame, [`WaveByWave`] the flow of each
//!   wave over each period.
//! - [`AxialDispersion`] says how grains drift apart, [`TubeShape`] the wall's radius, [`Orientations`] how grains turn,
//!   [`Load`] what they bear, [`ContactForces`] what may break them, [`Mixing`] and [`Segregation`] how grains of two kinds or
//!   of several sizes lie.

#![forbid(unsafe_code)]

pub mod columns;
mod contact_force;
mod diagnosis;
mod dispersion;
mod load;
mod mixing;
mod orientation;
mod profile;
mod quantity;
mod sample;
mod segregation;
mod series;
mod shape;
mod view;
mod waves;

pub use columns::{COLUMNS, Column, PROFILE, WAVES};
pub use contact_force::{ContactForce, ContactForces};
pub use diagnosis::{FaultKind, WallFault, note_wall_faults};
pub use dispersion::AxialDispersion;
pub use load::{GrainContact, Load, clear_volume, clear_volume_of_wave, grain_contacts};
pub use mixing::Mixing;
pub use orientation::Orientations;
pub use profile::{PartOfWave, ProfileBin, WaveFrameProfile, WavePart};
pub use quantity::{Quantity, Reading, Value};
pub use sample::{Observer, Sample, waves_passed};
pub use segregation::Segregation;
pub use series::{MOST_ROWS, Series};
pub use shape::TubeShape;
pub use view::View;
pub use waves::{WaveByWave, WaveFlow};
