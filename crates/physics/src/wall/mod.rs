//! The wall: spheres on staggered rings, and the waves that move them.

pub mod elastic;
pub mod lattice;
pub mod schedule;
pub mod wave;
pub mod waveform;

pub use elastic::{DriveAngle, ElasticNetwork, NetForce, Tethers};
pub use lattice::{Lattice, WallSphere};
pub use schedule::Schedule;
pub use wave::{RadiusWave, Ring, WaveDirection};
pub use waveform::Waveform;
