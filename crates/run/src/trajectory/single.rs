//! Frames in files of any name, each when the caller asks for one.

use std::path::{Path, PathBuf};

use peristalsis_formats::{TrajectoryFile, TrajectoryFormat, parquet};

use crate::RunError;
use crate::run::Run;
use crate::tables::grains_table;
use crate::trajectory::frame::frame;

/// Frames that a file has room for before its index moves.
const FRAMES: u64 = 1000;

/// What files of frames can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameFormat {
    /// A format of trajectories; VTP in a folder.
    Trajectory(TrajectoryFormat),
    /// A folder of Parquet tables of the grains, one a frame.
    Parquet,
}

impl FrameFormat {
    /// The format of a file by the ending of its name.
    ///
    /// # Errors
    /// [`RunError::Trajectory`] where none is known by it.
    pub fn of(path: &Path) -> Result<Self, RunError> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some(ending) if ending.eq_ignore_ascii_case("parquet") => Ok(Self::Parquet),
            ending => ending
                .and_then(TrajectoryFormat::by_ending)
                .map(Self::Trajectory)
                .ok_or_else(|| RunError::Trajectory {
                    reason: format!("{}: no format is known by this ending", path.display()),
                    help: "endings: .gsd, .vtp, .lammpstrj, .parquet",
                }),
        }
    }

    /// Writes the present state of a run to a file of its own, whole or not at all.
    ///
    /// # Errors
    /// [`RunError::Format`] where it cannot be written; an older file stays.
    pub fn write(self, path: &Path, run: &Run) -> Result<(), RunError> {
        match self {
            Self::Trajectory(format) => format.write(path, &frame(run, false))?,
            Self::Parquet => parquet::write(path, &grains_table(run)?)?,
        }
        Ok(())
    }
}

/// Frames of a run that are being written; after each the files are whole.
#[derive(Debug)]
pub struct FrameFile {
    path: PathBuf,
    /// `None` for Parquet, where each frame is a file.
    file: Option<(TrajectoryFormat, Box<dyn TrajectoryFile>)>,
    frames: u64,
}

/// The name of a frame's table.
fn table_name(step: u64) -> String {
    format!("frame-{step:012}.parquet")
}

/// Makes a folder of tables, or takes the tables of an older one away; other files stay.
fn empty_folder(path: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(path)?;
    for entry in std::fs::read_dir(path)? {
        let entry = entry?;
        let name = entry.file_name();
        let step = name.to_str().and_then(|name| name.strip_prefix("frame-"));
        let step = step.and_then(|rest| rest.strip_suffix(".parquet")?.parse().ok());
        if step.is_some_and(|step| name == *table_name(step)) {
            std::fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

impl FrameFile {
    /// Begins without a frame, over an older file.
    ///
    /// # Errors
    /// [`RunError::Format`] where it cannot be written.
    pub fn create(path: &Path, format: FrameFormat, run: &mut Run) -> Result<Self, RunError> {
        let file = match format {
            FrameFormat::Trajectory(format) => {
                run.follow_orientations();
                Some((format, format.create_at(path, FRAMES)?))
            }
            FrameFormat::Parquet => {
                empty_folder(path).map_err(|source| RunError::Folder {
                    folder: path.to_owned(),
                    source,
                })?;
                None
            }
        };
        Ok(Self {
            path: path.to_owned(),
            file,
            frames: 0,
        })
    }

    /// Writes the present state.
    ///
    /// # Errors
    /// [`RunError::Format`]; the frames before stay.
    pub fn append(&mut self, run: &Run) -> Result<(), RunError> {
        match &mut self.file {
            Some((format, file)) => file.append(&frame(run, format.has_contacts()))?,
            None => {
                let name = table_name(run.simulation().step());
                parquet::write(&self.path.join(name), &grains_table(run)?)?;
            }
        }
        self.frames += 1;
        Ok(())
    }

    /// Brings all frames to the disk.
    ///
    /// # Errors
    /// [`RunError::Format`].
    pub fn synchronize(&mut self) -> Result<(), RunError> {
        match &mut self.file {
            Some((_, file)) => Ok(file.synchronize()?),
            None => Ok(()),
        }
    }

    /// Frames written.
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
