//! What to run: TOML, presets and overrides in, one validated and resolved [`Configuration`] out.
//!
//! Three layers lie over one another: a preset, a file, `key=value` overrides. Each value remembers where it was
//! written, so that every error names its key and points at source, line and column ([`ConfigurationError`]). Of
//! alternatives (say width or amplitude) a layer gives one, which replaces the choice of the layers below; keys that a
//! higher layer's choice has made meaningless (a width, once the tube is stress-controlled) are dropped.
//!
//! A key is stated once, as a field of [`Configuration`], of a parameter type of `physics`, or in `keys.rs` where it
//! stands for another: its documentation, unit, default and range become the JSON [`schema`], and the reader refuses what
//! the schema refuses before it looks at what keys mean together.
//!
//! ```
//! use peristalsis_configuration::{Configuration, Sources};
//!
//! let configuration = Configuration::from_sources(&Sources {
//!     file: None,
//!     preset: Some("frictionless"),
//!     overrides: &["drive.width=2.7".into(), "initial.state=jammed".into()],
//! })?;
//! // rho = N/(6 a^2 L): N = round(6 * 0.15 * 1.5^2 * 100)
//! assert_eq!(configuration.grains.number, 203);
//! # Ok::<(), peristalsis_configuration::ConfigurationError>(())
//! ```

#![forbid(unsafe_code)]

mod canonical;
mod configuration;
mod contract;
pub mod document;
mod error;
mod grains;
mod keys;
mod layers;
mod limits;
mod materials;
mod presets;
mod reference;
mod resolve;
mod schedule;
mod schema;
mod source;
mod suggestion;
mod units;
mod waveform;

pub use canonical::word;
pub use configuration::{Configuration, Control, Drive, Initial, Observe, Run, Tube, Wall};
pub use contract::check_against;
pub use error::{ConfigurationError, Label, Problem, ProblemKind, Problems};
pub use grains::{Body, Grains};
pub use layers::{file_with_overrides, join};
pub use limits::MOST_GRAINS;
pub use materials::{MATERIALS, Material, material};
pub use peristalsis_physics::contact::{
    Cohesion, ContactModel, CundallStrack, DissipationForm, Elasticity, Normal, PullOff,
    RollingResistance, Sliding,
};
pub use peristalsis_physics::ends::{Ends, Inlet};
pub use peristalsis_physics::method::{InitialState, Integrator, Kernel};
pub use peristalsis_physics::sizes::{SizeForm, Sizes};
pub use peristalsis_physics::wall::{
    Arrangement, DriveAngle, ElasticNetwork, NetForce, SegmentDrive, Tethers, WaveDirection,
};
pub use presets::{PRESETS, Preset, preset, preset_names};
pub use reference::reference;
pub use resolve::{file_keys, file_of};
pub use schedule::{Schedule, ScheduledParameter};
pub use schema::{schema, schema_of, takes_whole_numbers, unit_of};
pub use source::{Origin, SourceFile, Sources};
pub use units::{HOUR, Units, elasticity_key, grain_mass};
pub use waveform::WaveformName;
