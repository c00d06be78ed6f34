//! The engine: state, neighbours, walls in motion, integrators and the kernels that bring grains forward in time.
//!
//! [`Simulation`] is the whole of it: made from [`Bodies`], a [`Wall`] and [`Parameters`], advanced by
//! [`Simulation::advance`], saved by [`Simulation::snapshot`]. [`initial`] makes the states that runs start from.

mod bodies;
mod contacts;
mod ends;
mod error;
mod fast;
mod forces;
pub mod initial;
mod integrate;
mod ledger;
mod neighbours;
mod parameters;
mod random;
mod simulation;
mod snapshot;
mod steps;
mod touching;
pub mod wall;
mod wall_contacts;

pub use bodies::{Bodies, Sphere};
pub use contacts::Remembered;
pub use ends::{Ends, OpenEnds, Passages, Passed, TransitTimes};
pub use error::EngineError;
pub use fast::machine::Instructions;
pub use fast::threads::{SPHERES_OF_A_THREAD, processors, threads_that_pay};
pub use integrate::Past;
pub use ledger::{Ledger, Tally};
pub use parameters::{Integrator, Kernel, Parameters};
pub use simulation::Simulation;
pub use snapshot::{Snapshot, SnapshotView, Sorting};
pub use touching::Touching;
pub use wall::Wall;
pub use wall_contacts::WallContact;
