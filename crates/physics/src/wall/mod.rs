//! The wall: spheres on staggered rings, and the waves that move them.

pub mod lattice;
pub mod schedule;
pub mod wave;

pub use lattice::{Lattice, WallSphere};
pub use schedule::Schedule;
pub use wave::{Direction, RadiusWave, Ring, Waveform};
