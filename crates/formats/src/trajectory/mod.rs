//! Trajectories: spheres frame by frame, in files that other programs open.
//!
//! | format | files | precision | what it holds |
//! |---|---|---|---|
//! | [`gsd`] | `trajectory.gsd` | 32 bits | spheres and logged values; small and fast |
//! | `vtp` | `trajectory.pvd`, `contacts.pvd`, `trajectory/*.vtp` | 64 bits | spheres, and contacts with their forces |
//! | `lammps` | `trajectory.lammpstrj` | shortest text that reads back to the same 64 bits | spheres |
//!
//! After a kill a trajectory is readable up to its last whole frame: what a reader finds a frame by is written after the
//! frame. [`TrajectoryFile::synchronize`] makes frames outlast a power cut as well. A writer that failed leaves the frames
//! before as they were.

mod append;
pub mod gsd;
mod lammps;
mod vtp;

use std::borrow::Cow;
use std::path::Path;

use crate::atomic;
use crate::error::FormatError;

/// Spheres at one instant, grains first and then the wall, with what was logged of it.
///
/// All arrays but those of [`Rotation`] have an entry a sphere. Lengths in d, velocities in d/t.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Steps done.
    pub step: u64,
    /// Time since the start \[t\].
    pub time: f64,
    /// Period of the tube along z, L \[d\].
    pub length: f64,
    /// Side of a box about the axis that holds every sphere \[d\].
    pub width: f64,
    /// Number of grains.
    pub grains: usize,
    /// Centres, z in \[0, L) \[d\].
    pub position: Vec<[f64; 3]>,
    /// Times round the tube.
    pub turns: Vec<i32>,
    /// Velocities \[d/t\].
    pub velocity: Vec<[f64; 3]>,
    /// Diameters \[d\]; the same in every frame.
    pub diameter: Vec<f64>,
    /// Masses \[m\]; the same in every frame. Spheres that move as prescribed have none: 0.
    pub mass: Vec<f64>,
    /// How the grains turn; `None` where they do not.
    pub rotation: Option<Rotation>,
    /// Contacts; left empty where no format asks for them.
    pub contacts: Vec<FrameContact>,
    /// Other values of the instant by name; the same names in every frame.
    pub values: Vec<(Cow<'static, str>, f64)>,
}

/// How grains turn: an entry a grain, for the spheres of a wall do not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rotation {
    /// Angular velocities in the laboratory's frame \[1/t\].
    pub angular_velocity: Vec<[f64; 3]>,
    /// Orientations since the trajectory began, as unit quaternions (w, x, y, z) that turn the grain's frame into the
    /// laboratory's.
    pub orientation: Vec<[f64; 4]>,
}

/// Two spheres that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameContact {
    /// Numbers of the spheres.
    pub spheres: [usize; 2],
    /// r_first - r_second to the nearest image \[d\].
    pub separation: [f64; 3],
    /// Overlap \[d\].
    pub overlap: f64,
    /// Force along the line of centres, positive where it repels \[m d/t^2\].
    pub normal_force: f64,
    /// Size of the force in the plane of contact \[m d/t^2\].
    pub tangential_force: f64,
    /// Whether the contact slides.
    pub sliding: bool,
}

impl Frame {
    /// A value of the instant by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        let value = self.values.iter().find(|(known, _)| known == name);
        value.map(|(_, value)| *value)
    }

    /// Number of spheres, those of the wall included.
    pub fn spheres(&self) -> usize {
        self.position.len()
    }

    /// An entry a sphere of a quantity that grains have, `rest` for the wall.
    fn for_spheres<'a, const N: usize>(
        &self,
        of_grains: &'a [[f64; N]],
        rest: [f64; N],
    ) -> impl Iterator<Item = [f64; N]> + use<'a, N> {
        let wall = std::iter::repeat_n(rest, self.spheres() - self.grains);
        of_grains.iter().copied().chain(wall)
    }
}

/// A format of trajectories.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum TrajectoryFormat {
    /// General Simulation Data, the HOOMD schema: OVITO, freud, MDAnalysis, the Python package `gsd`.
    Gsd,
    /// VTK polydata with an index: ParaView, VTK, PyVista.
    Vtp,
    /// LAMMPS dump text: OVITO, VMD, MDAnalysis.
    Lammps,
}

impl TrajectoryFormat {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Gsd, Self::Vtp, Self::Lammps];

    /// The file in a folder that a reader opens. In VTP the file of the contacts stands beside it.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Gsd => gsd::FILE,
            Self::Vtp => vtp::SPHERES,
            Self::Lammps => lammps::FILE,
        }
    }

    /// Whether it holds contacts, which a frame must then have.
    pub fn has_contacts(self) -> bool {
        self == Self::Vtp
    }

    /// Begins a trajectory of about `frames` frames in a folder, over an older one.
    ///
    /// # Errors
    /// [`FormatError::Io`].
    pub fn create(
        self,
        folder: &Path,
        frames: u64,
    ) -> Result<Box<dyn TrajectoryFile>, FormatError> {
        let path = match self {
            Self::Vtp => folder.to_owned(),
            Self::Gsd | Self::Lammps => folder.join(self.file_name()),
        };
        self.create_at(&path, frames)
    }

    /// Begins a trajectory of about `frames` frames in a file of any name, over an older one; VTP takes a folder.
    ///
    /// # Errors
    /// [`FormatError::Io`].
    pub fn create_at(
        self,
        path: &Path,
        frames: u64,
    ) -> Result<Box<dyn TrajectoryFile>, FormatError> {
        Ok(match self {
            Self::Gsd => Box::new(gsd::create(path, frames)?),
            Self::Vtp => Box::new(vtp::VtpTrajectory::create(path)?),
            Self::Lammps => Box::new(lammps::LammpsTrajectory::create(path)?),
        })
    }

    /// Writes one frame to a file of its own, whole or not at all; in VTP the spheres without their contacts.
    ///
    /// # Errors
    /// [`FormatError::Io`]; an older file stays.
    pub fn write(self, path: &Path, frame: &Frame) -> Result<(), FormatError> {
        match self {
            Self::Vtp => atomic::write(path, &vtp::spheres(frame)),
            Self::Lammps => atomic::write(path, lammps::encode(frame).as_bytes()),
            Self::Gsd => {
                let pending = atomic::Pending::create(path)?;
                gsd::create(pending.partial_path(), 1)?.append(frame)?;
                pending.commit()
            }
        }
    }

    /// The format of files whose names end with `ending`, in letters of either case.
    pub fn by_ending(ending: &str) -> Option<Self> {
        match ending.to_ascii_lowercase().as_str() {
            "gsd" => Some(Self::Gsd),
            "vtp" => Some(Self::Vtp),
            "lammpstrj" | "lammpsdump" | "dump" => Some(Self::Lammps),
            _ => None,
        }
    }

    /// Opens the trajectory in a folder to go on with it, without its frames after `step`.
    ///
    /// # Errors
    /// [`FormatError::Io`]; [`FormatError::NotATrajectory`] where a file is not what was written.
    pub fn resume(self, folder: &Path, step: u64) -> Result<Box<dyn TrajectoryFile>, FormatError> {
        let path = folder.join(self.file_name());
        Ok(match self {
            Self::Gsd => Box::new(gsd::resume(&path, step)?),
            Self::Vtp => Box::new(vtp::VtpTrajectory::resume(folder, step)?),
            Self::Lammps => Box::new(lammps::LammpsTrajectory::resume(&path, step)?),
        })
    }

    /// Makes room for `frames` frames in all in the trajectory of a folder, to the same bytes as if it had been planned so.
    ///
    /// # Errors
    /// As [`TrajectoryFormat::resume`].
    pub fn make_room(self, folder: &Path, frames: u64) -> Result<(), FormatError> {
        match self {
            Self::Gsd => gsd::make_room(&folder.join(self.file_name()), frames),
            // They grow as they are written.
            Self::Vtp | Self::Lammps => Ok(()),
        }
    }

    /// Bytes that a frame like this takes on disk, but for the first, which may hold more.
    pub fn frame_bytes(self, frame: &Frame) -> u64 {
        match self {
            Self::Gsd => gsd::frame_bytes(frame),
            Self::Vtp => vtp::frame_bytes(frame),
            Self::Lammps => lammps::encode(frame).len() as u64,
        }
    }
}

/// A trajectory that is being written.
pub trait TrajectoryFile: std::fmt::Debug + Send {
    /// Writes one frame more.
    ///
    /// # Errors
    /// [`FormatError::Io`]; the frames before stay as they were, and the frame may be tried again.
    fn append(&mut self, frame: &Frame) -> Result<(), FormatError>;

    /// Brings all frames to the disk.
    ///
    /// # Errors
    /// [`FormatError::Io`].
    fn synchronize(&mut self) -> Result<(), FormatError>;

    /// Frames in it.
    fn frames(&self) -> u64;

    /// Bytes in its files.
    fn bytes(&self) -> u64;
}

#[cfg(test)]
mod tests;
