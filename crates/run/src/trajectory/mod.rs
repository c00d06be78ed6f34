//! The trajectory of a run: frames in files beside its record, which change nothing of the run.

mod frame;
mod plan;
mod single;
mod source;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use peristalsis_configuration::Configuration;
use peristalsis_formats::{FormatError, TrajectoryFile, TrajectoryFormat, atomic};

use crate::RunError;
use crate::run::Run;

use self::frame::frame;
pub use self::plan::{Span, TrajectoryPlan, TrajectoryRequest, Window};
pub use self::single::{FrameFile, FrameFormat};
pub use self::source::FrameSource;

/// The plan, in a run's folder.
const PLAN: &str = "trajectory.toml";

/// A trajectory that is being written.
///
/// Frames after the last checkpoint are cut off when the run goes on from there, so that none is doubled and none is
/// missing: bring the frames to the disk ([`Trajectory::synchronize`]) before the state is saved.
#[derive(Debug)]
pub struct Trajectory {
    folder: PathBuf,
    plan: TrajectoryPlan,
    files: Vec<Box<dyn TrajectoryFile>>,
}

/// The part of a trajectory that was written.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
pub struct TrajectoryReport {
    /// The files that readers open; bytes of a name that are not Unicode are replaced by marks.
    #[serde(serialize_with = "as_text")]
    pub files: Vec<PathBuf>,
    /// Frames.
    pub frames: u64,
    /// Steps between two frames.
    pub interval_steps: u64,
    /// Bytes of all files.
    pub bytes: u64,
}

/// Paths as JSON can hold them.
fn as_text<S: serde::Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|path| path.to_string_lossy()))
}

/// Estimate of the files of a trajectory.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct TrajectoryEstimate {
    /// Frames.
    pub frames: u64,
    /// Steps between two frames.
    pub interval_steps: u64,
    /// Bytes by format, from a frame of a short trial.
    pub bytes: Vec<(TrajectoryFormat, u64)>,
}

impl Trajectory {
    /// Begins a trajectory in a folder that has none, with the run's present state if that is one of its frames.
    ///
    /// # Errors
    /// [`RunError::HoldsAnotherRun`] where there is one; [`RunError::Format`] where a file cannot be written.
    pub fn begin(folder: &Path, plan: TrajectoryPlan, run: &mut Run) -> Result<Self, RunError> {
        Self::check(folder)?;
        let formats = plan.formats.clone();
        let begun = Self::new_files(folder, plan).and_then(|mut trajectory| {
            run.follow_orientations();
            trajectory.observe(run)?;
            Ok(trajectory)
        });
        begun.inspect_err(|_| {
            // So that it can be begun again.
            let names = formats.iter().map(|format| format.file_name());
            for name in names.chain([PLAN]) {
                drop(std::fs::remove_file(folder.join(name)));
            }
        })
    }

    fn new_files(folder: &Path, plan: TrajectoryPlan) -> Result<Self, RunError> {
        let files = plan.formats.iter();
        let files = files.map(|format| format.create(folder, plan.frames()));
        let files = files.collect::<Result<_, _>>()?;
        write_plan(folder, &plan)?;
        Ok(Self {
            folder: folder.to_owned(),
            plan,
            files,
        })
    }

    /// Whether a folder is free for a trajectory; makes nothing.
    ///
    /// # Errors
    /// [`RunError::HoldsAnotherRun`] where one is there already.
    pub fn check(folder: &Path) -> Result<(), RunError> {
        RunError::if_one_is_in(folder, &Self::names().collect::<Vec<_>>())
    }

    /// Whether a run in this folder has a trajectory.
    pub fn is_in(folder: &Path) -> bool {
        folder.join(PLAN).exists()
    }

    /// The files of a trajectory in the folder of its run.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> {
        let formats = TrajectoryFormat::ALL.into_iter();
        formats.map(TrajectoryFormat::file_name).chain([PLAN])
    }

    /// Goes on with the trajectory in the folder of a run, without its frames after the run's present step, and up to the
    /// run's end, which may have changed; `None` where it has none.
    ///
    /// # Errors
    /// [`RunError::Format`] where a file cannot be read or written, or its frames are not the planned ones.
    pub fn resume(folder: &Path, run: &mut Run) -> Result<Option<Self>, RunError> {
        let path = folder.join(PLAN);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => {
                let operation = "read";
                return Err(FormatError::Io {
                    operation,
                    path,
                    source,
                }
                .into());
            }
        };
        let written: TrajectoryPlan = toml::from_str(&text).map_err(|error| {
            let reason = error.message().to_owned();
            FormatError::NotATrajectory { path, reason }
        })?;
        run.follow_orientations();
        let step = run.simulation().step();
        let plan = written.ending(run.configuration().run.steps());
        if plan != written {
            for format in &plan.formats {
                drop(format.resume(folder, step).map_err(if_missing)?);
                format.make_room(folder, plan.frames())?;
            }
            write_plan(folder, &plan)?;
        }
        let files = plan.formats.iter();
        let files = files.map(|format| format.resume(folder, step));
        let files = files.collect::<Result<_, _>>().map_err(if_missing)?;
        let mut trajectory = Self {
            folder: folder.to_owned(),
            plan,
            files,
        };
        trajectory.fill_in(run)?;
        Ok(Some(trajectory))
    }

    /// Writes the frame of the present state where a full disk or a kill kept it from its file.
    fn fill_in(&mut self, run: &Run) -> Result<(), RunError> {
        let step = run.simulation().step();
        let expected = self.plan.frames_through(step);
        let is_due = self.plan.is_due(step);
        for (format, file) in self.plan.formats.iter().zip(&mut self.files) {
            let found = file.frames();
            if found + 1 == expected && is_due {
                file.append(&frame(run, format.has_contacts()))?;
            } else if found != expected {
                let path = self.folder.join(format.file_name());
                let reason = format!(
                    "it holds {found} frames up to step {step}, and {expected} were written"
                );
                return Err(FormatError::NotATrajectory { path, reason }.into());
            }
        }
        Ok(())
    }

    /// Steps to the next frame, if there is one more.
    pub fn steps_to_next(&self, run: &Run) -> Option<u64> {
        self.plan.steps_to_next(run.simulation().step())
    }

    /// Writes the present state if it is one of the frames; to be asked after every advance, once.
    ///
    /// # Errors
    /// [`RunError::Format`]; the frames before stay.
    pub fn observe(&mut self, run: &Run) -> Result<(), RunError> {
        if !self.plan.is_due(run.simulation().step()) {
            return Ok(());
        }
        let with_contacts = self.plan.formats.iter().any(|format| format.has_contacts());
        let frame = frame(run, with_contacts);
        for file in &mut self.files {
            file.append(&frame)?;
        }
        Ok(())
    }

    /// Brings all frames to the disk.
    ///
    /// # Errors
    /// [`RunError::Format`].
    pub fn synchronize(&mut self) -> Result<(), RunError> {
        for file in &mut self.files {
            file.synchronize()?;
        }
        Ok(())
    }

    /// What has been written.
    pub fn report(&self) -> TrajectoryReport {
        let names = self.plan.formats.iter().map(|format| format.file_name());
        let frames = self.files.iter().map(|file| file.frames());
        TrajectoryReport {
            files: names.map(|name| self.folder.join(name)).collect(),
            frames: frames.max().unwrap_or(0),
            interval_steps: self.plan.interval,
            bytes: self.files.iter().map(|file| file.bytes()).sum(),
        }
    }
}

/// A missing file is told as a damaged trajectory, not as a fault of the disk.
fn if_missing(error: FormatError) -> FormatError {
    match error {
        FormatError::Io { path, source, .. } if source.kind() == ErrorKind::NotFound => {
            let reason = "it is missing".to_owned();
            FormatError::NotATrajectory { path, reason }
        }
        other => other,
    }
}

fn write_plan(folder: &Path, plan: &TrajectoryPlan) -> Result<(), RunError> {
    let text =
        toml::to_string(plan).expect("a plan is whole numbers and names, which always serialise");
    Ok(atomic::write(&folder.join(PLAN), text.as_bytes())?)
}

/// Estimate of the files of a whole run, from a frame of a run like it with `scale` times fewer spheres.
pub(crate) fn estimate(
    request: &TrajectoryRequest,
    configuration: &Configuration,
    like: &Run,
    scale: f64,
) -> Result<TrajectoryEstimate, RunError> {
    let plan = TrajectoryPlan::new(request, configuration, 0, configuration.run.steps())?;
    let frame = frame(like, true);
    let bytes = |format: &TrajectoryFormat| {
        let each = scale * format.frame_bytes(&frame) as f64;
        (*format, (each * plan.frames() as f64) as u64)
    };
    Ok(TrajectoryEstimate {
        frames: plan.frames(),
        interval_steps: plan.interval,
        bytes: plan.formats.iter().map(bytes).collect(),
    })
}
