//! The largest sizes that are accepted.

/// Largest number of grains.
pub const MOST_GRAINS: u64 = 100_000_000;
/// Largest number of wall spheres.
pub(crate) const MOST_WALL_SPHERES: u64 = 1_000_000_000;
/// Largest number of wall spheres that a grain meets at once.
pub(crate) const MOST_WALL_SPHERES_IN_REACH: f64 = 100_000.0;
/// Largest number of samples in a run.
pub(crate) const MOST_SAMPLES: u64 = 100_000_000;
/// Largest number of time steps in a run.
pub(crate) const MOST_STEPS: u64 = 1_000_000_000_000;
