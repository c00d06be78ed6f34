//! Errors of a simulation.

/// Errors of the engine.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// A sphere moved further than its contacts can follow: the step is too long or the forces too strong.
    #[error(
        "diverged at step {step} (t = {time:.3}): {}{} moved {displacement:.3} in one step, more than the {limit:.3} that keeps \
         contacts from being passed over",
        sphere(*grain, *grains),
        if *outside { ", outside the tube," } else { "" }
    )]
    Diverged {
        /// Step at whose end it was found.
        step: u64,
        /// Time at the end of that step \[t\].
        time: f64,
        /// Number of the grain; from `grains` on it is a sphere of an elastic wall.
        grain: usize,
        /// How many grains there are.
        grains: usize,
        /// Whether it had left the tube before.
        outside: bool,
        /// How far it moved in that step \[d\]; not finite where its position is lost.
        displacement: f64,
        /// The bound \[d\].
        limit: f64,
    },
    /// The grains do not fit into the tube.
    #[error(
        "{grains} grains do not fit: {}",
        if mean_overlap > limit {
            format!("packed, they overlap by {mean_overlap:.3} d on average, and at most {limit:.3} d is allowed")
        } else {
            format!("packing presses {outside} of them out through the wall")
        }
    )]
    DoesNotFit {
        /// Number of grains.
        grains: usize,
        /// Mean overlap of the contacts after relaxation \[d\].
        mean_overlap: f64,
        /// Largest mean overlap that counts as fitting \[d\].
        limit: f64,
        /// Grains outside the wall.
        outside: usize,
    },
    /// Grains that should settle go on moving.
    #[error(
        "the grains do not settle: after {time:.3e} t their mean kinetic energy is {energy:.1e} m g d, and {limit:.0e} \
         counts as rest; nothing may hold them against the body force, or their contacts are too soft for it"
    )]
    NotSettled {
        /// How long they fell \[t\].
        time: f64,
        /// Mean kinetic energy of a grain, in units of m g d.
        energy: f64,
        /// That of grains at rest, in the same units.
        limit: f64,
    },
    /// A wall that cannot take the place of another.
    #[error("the drive cannot go on with this wall: {reason}")]
    OtherWall {
        /// The difference.
        reason: &'static str,
    },
    /// A snapshot does not belong to this simulation.
    #[error("the snapshot does not fit this simulation: {reason}")]
    SnapshotMismatch {
        /// The difference.
        reason: String,
    },
    /// A parameter outside its range.
    #[error("{parameter} = {value} is not possible: {allowed}")]
    InvalidParameter {
        /// Name in the vocabulary of the configuration.
        parameter: &'static str,
        /// The value given.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// It was asked to stop.
    #[error("stopped while the grains were packed")]
    Stopped,
    /// The system gives no more threads.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// The message of the system.
        reason: String,
    },
}

/// A moving sphere in words: grains come first, then spheres of an elastic wall, which count from 0 again.
fn sphere(number: usize, grains: usize) -> String {
    match number.checked_sub(grains) {
        None => format!("grain {number}"),
        Some(of_wall) => format!("wall sphere {of_wall}"),
    }
}
