//! One run: from a configuration to its record.
//!
//! [`Run`] makes the simulation of a [`Configuration`], advances it sample by sample and keeps what was measured;
//! [`Summary`] is the outcome in numbers; [`RunFolder`] writes tables, figures and state, each file whole or not at all;
//! [`Trajectory`] writes the spheres frame by frame. Nothing here prints or exits.

#![forbid(unsafe_code)]

mod assemble;
mod contacts;
mod error;
mod estimate;
pub mod files;
mod folder;
mod memory;
mod pace;
mod pictures;
mod recorder;
mod run;
mod scene;
mod si;
mod spheres;
mod stopping;
mod stopwatch;
mod summary;
mod tables;
mod trajectory;
mod warnings;

pub use assemble::{PlacedGrains, scheduled_wavelengths, walls};
pub use error::RunError;
pub use estimate::{Estimate, estimate, estimate_by, restitution_at_wave_speed, snapshot_numbers};
pub use folder::{RunFolder, next_folder, read_state, write_state};
pub use pace::Pace;
pub use peristalsis_configuration::Configuration;
pub use peristalsis_figures::{Drawing, Paper};
pub use peristalsis_formats::{Frame, TrajectoryFormat};
pub use peristalsis_observe::Value;
pub use peristalsis_render::{Film, FilmFormat, FilmPlan, Picture, RenderError};
pub use pictures::{flow_in_time, snapshot_stack, space_time, title};
pub use recorder::{Recorder, THRESHOLDS};
pub use run::{Mark, Progress, Run};
pub use scene::{Aspect, Eye, Field, Look, PictureScene, Place, WallLook, Writing, drawn};
pub use si::SiEstimate;
pub use stopping::Stopping;
pub use summary::{
    Discharge, MixedGrains, Pumping, RowColumn, SegregatedSizes, Status, Summary, SummaryKey, Wear,
    label, row_columns, set_by, summary_keys, summary_schema,
};
pub use tables::{
    contacts_table, gathered, profile_table, snapshot_table, timeseries_table, waves_table,
};
pub use trajectory::{
    FrameFile, FrameFormat, FrameSource, Span, Trajectory, TrajectoryEstimate, TrajectoryPlan,
    TrajectoryReport, TrajectoryRequest, Window,
};
pub use warnings::{
    Warning, longest_time_step, overlap_at_wave_speed, samples_that_meet, warnings,
};

/// Version of the physics that runs are computed with: raised whenever the same configuration and seed come to other
/// results, so that no old run is taken for a new one, and none goes on as another.
pub const PHYSICS_VERSION: u32 = 2;

/// Version of this program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Revision of the source that this program was built from; "unknown" outside a checkout.
pub const REVISION: &str = env!("PERISTALSIS_REVISION");
