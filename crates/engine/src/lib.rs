//! The engine: state, neighbours, walls in motion, integrators and the kernels that bring grains forward in time.
//!
//! [`Simulation`] is the whole of it: made from [`Bodies`], a [`Wall`] and [`Parameters`], advanced by
//! [`Simulation::advance`], saved by [`Simulation::snapshot`]. [`initial`] makes the states that runs start from.

pub mod bodies;
pub mod error;
mod fast;
mod forces;
pub mod initial;
pub mod integrate;
pub mod ledger;
pub mod neighbours;
pub mod simulation;
pub mod snapshot;
pub mod touching;
pub mod wall;

pub use bodies::Bodies;
pub use error::EngineError;
pub use fast::machine::Instructions;
pub use integrate::Integrator;
pub use ledger::{Ledger, Tally};
pub use simulation::{Kernel, Parameters, Simulation};
pub use snapshot::{Snapshot, SnapshotView};
pub use touching::Touching;
pub use wall::Wall;
