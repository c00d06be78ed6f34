//! The wall: spheres in rings or anywhere, and the waves that move them.

pub mod arrangement;
pub mod elastic;
pub mod lattice;
pub mod schedule;
pub mod segments;
pub mod table;
pub mod wave;
pub mod waveform;

pub use arrangement::Arrangement;
pub use elastic::{DriveAngle, ElasticNetwork, NetForce, Tethers};
pub use lattice::{Lattice, WallSphere};
pub use schedule::Schedule;
pub use segments::{LONGEST_CYCLE, SegmentDrive, Segments, Squeeze};
pub use table::RadiusTable;
pub use wave::{Contraction, RadiusWave, Ring, WaveDirection};
pub use waveform::Waveform;
