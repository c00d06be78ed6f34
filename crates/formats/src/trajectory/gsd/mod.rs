//! Frames as General Simulation Data, in the HOOMD schema.
//!
//! - GSD's box is centred: z of the file is z - L/2, and `particles/image` counts the turns round the tube.
//! - `particles/types` are `grain` and `wall`; types and diameters are in the first frame and hold for all.
//! - Grains that turn have `particles/orientation` and, for the schema has no angular velocity in the laboratory's frame,
//!   `log/particles/angular_velocity`.
//! - `log/time` and the frame's other values are in 64 bits; all else in 32.
//!
//! [`GsdTrajectory`] writes, [`GsdReader`] reads.
//!
//! The container is our own: the published Rust library (`hoomd-gsd`) cannot cut a trajectory back to a
//! checkpoint, goes on writing after a full disk, and panics on a damaged index.

mod container;
mod reader;

use std::path::Path;

use self::container::{Chunk, Container, ENTRY_BYTES, Kind};
use super::{Frame, TrajectoryFile};
use crate::error::FormatError;

pub use self::reader::GsdReader;

/// Name of the file in a run's folder.
pub const FILE: &str = "trajectory.gsd";

/// Most arrays in a frame.
const MOST_CHUNKS: u64 = 20;
const STEP: &str = "configuration/step";
const BOX: &str = "configuration/box";
const NUMBER: &str = "particles/N";
const POSITION: &str = "particles/position";
const VELOCITY: &str = "particles/velocity";
const IMAGE: &str = "particles/image";
const ORIENTATION: &str = "particles/orientation";
const ANGULAR_VELOCITY: &str = "log/particles/angular_velocity";
const TYPES: &str = "particles/types";
const TYPE_NUMBERS: &str = "particles/typeid";
const DIAMETER: &str = "particles/diameter";
/// What names of logged values begin with.
const LOG: &str = "log/";
/// The logged time.
const TIME: &str = "time";
/// Types of spheres by name: grains, and the wall's.
const GRAIN: &str = "grain";
const WALL: &str = "wall";

/// A trajectory in GSD that is being written.
#[derive(Debug)]
pub struct GsdTrajectory(Container);

impl GsdTrajectory {
    /// An empty trajectory with room for so many frames.
    ///
    /// # Errors
    /// [`FormatError::Io`].
    pub fn create(path: &Path, frames: u64) -> Result<Self, FormatError> {
        Ok(Self(Container::create(
            path,
            frames.saturating_mul(MOST_CHUNKS),
        )?))
    }

    /// A trajectory to go on with, without its frames after `step`.
    ///
    /// # Errors
    /// [`FormatError::Io`]; [`FormatError::NotATrajectory`].
    pub fn resume(path: &Path, step: u64) -> Result<Self, FormatError> {
        Ok(Self(Container::resume(path, STEP, |found| found <= step)?))
    }
}

impl TrajectoryFile for GsdTrajectory {
    fn append(&mut self, frame: &Frame) -> Result<(), FormatError> {
        let mut chunks = every_frame(frame);
        if self.0.frames() == 0 {
            chunks.extend(first_frame(frame));
        }
        self.0.append(&chunks)
    }

    fn synchronize(&mut self) -> Result<(), FormatError> {
        self.0.synchronize()
    }

    fn frames(&self) -> u64 {
        self.0.frames()
    }

    fn bytes(&self) -> u64 {
        self.0.bytes()
    }
}

/// Bytes of a frame after the first.
pub(super) fn frame_bytes(frame: &Frame) -> u64 {
    let arrays = every_frame(frame)
        .iter()
        .map(|chunk| chunk.bytes.len() as u64)
        .sum::<u64>();
    arrays + MOST_CHUNKS * ENTRY_BYTES
}

/// What changes from frame to frame.
fn every_frame(frame: &Frame) -> Vec<Chunk> {
    let half = 0.5 * frame.length;
    let position = frame.position.iter().map(|&[x, y, z]| [x, y, z - half]);
    let image = frame.turns.iter().map(|&turns| [0, 0, turns]);
    let mut chunks = vec![
        chunk(STEP, Kind::U64, 1, frame.step.to_le_bytes()),
        chunk(
            BOX,
            Kind::F32,
            1,
            singles([[frame.width, frame.width, frame.length, 0.0, 0.0, 0.0]]),
        ),
        chunk(NUMBER, Kind::U32, 1, (frame.spheres() as u32).to_le_bytes()),
        chunk(POSITION, Kind::F32, 3, singles(position)),
        chunk(
            VELOCITY,
            Kind::F32,
            3,
            singles(frame.velocity.iter().copied()),
        ),
        chunk(
            IMAGE,
            Kind::I32,
            3,
            image.flatten().flat_map(i32::to_le_bytes),
        ),
    ];
    if let Some(rotation) = &frame.rotation {
        let orientation = frame.for_spheres(&rotation.orientation, [1.0, 0.0, 0.0, 0.0]);
        let angular_velocity = frame.for_spheres(&rotation.angular_velocity, [0.0; 3]);
        chunks.extend([
            chunk(ORIENTATION, Kind::F32, 4, singles(orientation)),
            chunk(ANGULAR_VELOCITY, Kind::F32, 3, singles(angular_velocity)),
        ]);
    }
    let values = frame.values.iter().map(|(name, value)| (&**name, *value));
    let logged = [(TIME, frame.time)].into_iter().chain(values);
    chunks
        .extend(logged.map(|(name, value)| {
            chunk(&format!("{LOG}{name}"), Kind::F64, 1, value.to_le_bytes())
        }));
    chunks
}

/// What holds for every frame.
fn first_frame(frame: &Frame) -> [Chunk; 3] {
    let kinds = (0..frame.spheres()).map(|sphere| u32::from(sphere >= frame.grains));
    [
        chunk(TYPES, Kind::I8, 6, *b"grain\0wall\0\0"),
        chunk(TYPE_NUMBERS, Kind::U32, 1, kinds.flat_map(u32::to_le_bytes)),
        chunk(
            DIAMETER,
            Kind::F32,
            1,
            singles(frame.diameter.iter().map(|&diameter| [diameter])),
        ),
    ]
}

fn chunk(name: &str, kind: Kind, columns: u32, bytes: impl IntoIterator<Item = u8>) -> Chunk {
    Chunk {
        name: name.to_owned(),
        kind,
        columns,
        bytes: bytes.into_iter().collect(),
    }
}

fn singles<const N: usize>(rows: impl IntoIterator<Item = [f64; N]>) -> impl Iterator<Item = u8> {
    rows.into_iter()
        .flatten()
        .flat_map(|value| (value as f32).to_le_bytes())
}
