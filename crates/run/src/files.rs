//! Names of the files that a run leaves, in a folder of its own or in a store.

/// What is computed.
pub const CONFIGURATION: &str = "config.toml";
/// The outcome in numbers.
pub const SUMMARY: &str = "summary.json";
/// A row a sample.
pub const TIMESERIES: &str = "timeseries.parquet";
/// Late means in the wave's frame.
pub const PROFILE: &str = "profile.parquet";
/// The flow of each wave over each period.
pub const WAVES: &str = "waves.parquet";
/// The spheres at the end.
pub const SNAPSHOT: &str = "snapshot.parquet";
/// The state from which it goes on.
pub const STATE: &str = "state.checkpoint";
