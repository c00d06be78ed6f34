//! Frames as General Simulation Data, in the HOOMD schema.
//!
//! - GSD's box is centred: z of the file is z - L/2, and `particles/image` counts the turns round the tube.
//! - `particles/types` are `grain` and `wall`; types, diameters and masses are in the first frame and hold for all.
//! - Grains that turn have `particles/orientation` and, for the schema has no angular velocity in the laboratory's frame,
//!   `log/particles/angular_velocity`.
//! - `log/time` and the frame's other values are in 64 bits; all else in 32.
//!
//! The container is our own: the published Rust library (`hoomd-gsd`) cannot cut a trajectory back to a
//! checkpoint, goes on writing after a full disk, and panics on a damaged index.

mod container;
mod reader;

use std::path::Path;

use self::container::{Chunk, Container, ENTRY_BYTES};
use super::{Frame, TrajectoryFile};
use crate::error::FormatError;

pub use self::reader::GsdReader;

/// Name of the file in a run's folder.
pub(super) const FILE: &str = "trajectory.gsd";

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
const MASS: &str = "particles/mass";
/// Beginning of the names of logged values.
const LOG: &str = "log/";
/// The logged time.
const TIME: &str = "time";
/// Types of spheres by name: grains, and the wall's.
const GRAIN: &str = "grain";
const WALL: &str = "wall";

/// An empty trajectory with room for so many frames.
pub(super) fn create(path: &Path, frames: u64) -> Result<Container, FormatError> {
    Container::create(path, frames.saturating_mul(MOST_CHUNKS))
}

/// Gives a trajectory room for so many frames in all.
pub(super) fn make_room(path: &Path, frames: u64) -> Result<(), FormatError> {
    Container::make_room(path, frames.saturating_mul(MOST_CHUNKS))
}

/// A trajectory to go on with, without its frames after `step`.
pub(super) fn resume(path: &Path, step: u64) -> Result<Container, FormatError> {
    Container::resume(path, STEP, |found| found <= step)
}

impl TrajectoryFile for Container {
    fn append(&mut self, frame: &Frame) -> Result<(), FormatError> {
        let mut chunks = every_frame(frame);
        if self.frames == 0 {
            chunks.extend(first_frame(frame));
        }
        self.append_arrays(&chunks)
    }

    fn synchronize(&mut self) -> Result<(), FormatError> {
        self.file.synchronize()
    }

    fn frames(&self) -> u64 {
        self.frames
    }

    fn bytes(&self) -> u64 {
        self.file.end()
    }
}

/// Bytes of a frame after the first.
pub(super) fn frame_bytes(frame: &Frame) -> u64 {
    let chunks = every_frame(frame);
    let arrays = chunks.iter().map(|chunk| chunk.bytes.len() as u64);
    arrays.sum::<u64>() + MOST_CHUNKS * ENTRY_BYTES
}

/// What changes from frame to frame.
fn every_frame(frame: &Frame) -> Vec<Chunk> {
    let half = 0.5 * frame.length;
    let sides = [frame.width, frame.width, frame.length, 0.0, 0.0, 0.0];
    let position = frame.position.iter().map(|&[x, y, z]| [x, y, z - half]);
    let mut chunks = vec![
        Chunk::new(STEP, [[frame.step]]),
        Chunk::new(BOX, singles(sides.map(|side| [side]))),
        Chunk::new(NUMBER, [[frame.spheres() as u32]]),
        Chunk::new(POSITION, singles(position)),
        Chunk::new(VELOCITY, singles(frame.velocity.iter().copied())),
        Chunk::new(IMAGE, frame.turns.iter().map(|&turns| [0, 0, turns])),
    ];
    if let Some(rotation) = &frame.rotation {
        let orientation = frame.for_spheres(&rotation.orientation, [1.0, 0.0, 0.0, 0.0]);
        let angular_velocity = frame.for_spheres(&rotation.angular_velocity, [0.0; 3]);
        chunks.extend([
            Chunk::new(ORIENTATION, singles(orientation)),
            Chunk::new(ANGULAR_VELOCITY, singles(angular_velocity)),
        ]);
    }
    let values = frame.values.iter().map(|(name, value)| (&**name, *value));
    let logged = [(TIME, frame.time)].into_iter().chain(values);
    chunks.extend(logged.map(|(name, value)| Chunk::new(&format!("{LOG}{name}"), [[value]])));
    chunks
}

/// What holds for every frame.
fn first_frame(frame: &Frame) -> [Chunk; 4] {
    let types = [*b"grain\0", *b"wall\0\0"].map(|name| name.map(|letter| letter as i8));
    let kinds = (0..frame.spheres()).map(|sphere| [u32::from(sphere >= frame.grains)]);
    let [diameter, mass] =
        [&frame.diameter, &frame.mass].map(|all| singles(all.iter().map(|&one| [one])));
    [
        Chunk::new(TYPES, types),
        Chunk::new(TYPE_NUMBERS, kinds),
        Chunk::new(DIAMETER, diameter),
        Chunk::new(MASS, mass),
    ]
}

fn singles<const N: usize>(
    rows: impl IntoIterator<Item = [f64; N]>,
) -> impl Iterator<Item = [f32; N]> {
    rows.into_iter().map(|row| row.map(|value| value as f32))
}
