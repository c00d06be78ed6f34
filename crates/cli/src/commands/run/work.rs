//! The work of a run: to its end or to a signal, with everything saved.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peristalsis_run::{
    Pace, Progress, Run, RunError, RunFolder, Status, Summary, Trajectory, TrajectoryPlan,
};

use crate::arguments::RunArguments;
use crate::commands::say;
use crate::commands::trajectory::request;
use crate::failure::Failure;
use crate::stop::Stop;

/// How the advance of a run ended.
pub(super) enum Ending {
    Complete,
    /// By a signal, with its exit code.
    Stopped(u8),
    /// Since its trajectory could not be written.
    Unwritten(RunError),
    Failed(RunError),
}

/// How a run ended.
pub(super) struct Outcome {
    pub(super) ending: Ending,
    pub(super) summary: Summary,
    /// The figures, if its results could be written.
    pub(super) finished: Result<Vec<PathBuf>, RunError>,
}

/// A run and where it leaves what it finds.
pub(super) struct Work {
    pub(super) run: Run,
    pub(super) folder: RunFolder,
    trajectory: Option<Trajectory>,
    save_every: Duration,
}

impl Work {
    /// Opens the trajectory, goes on with it or begins it, and saves the state of a run that is new: from here on nothing
    /// is lost. The state comes last, for what goes on from it goes on with the files that are there.
    pub(super) fn begin(
        arguments: &RunArguments,
        folder: RunFolder,
        mut run: Run,
    ) -> Result<Self, Failure> {
        let trajectory = open_trajectory(arguments, folder.path(), &mut run)?;
        if let Err(error) = Self::save_first(arguments, &folder, &run) {
            // A new run that left nothing blocks no folder.
            let is_one = arguments.resume.is_none() && arguments.seeds.is_none();
            if is_one && trajectory.is_none() && !folder.has_state() {
                folder.abandon();
            }
            return Err(error.into());
        }
        Ok(Self {
            run,
            folder,
            trajectory,
            save_every: arguments.checkpoint_every,
        })
    }

    fn save_first(arguments: &RunArguments, folder: &RunFolder, run: &Run) -> Result<(), RunError> {
        // Not before: a trajectory that cannot go on leaves the run as it is.
        if arguments.resume.is_some() && arguments.configuration.length().is_some() {
            folder.change_length(run)?;
        }
        if arguments.csv {
            // From here on it is renewed whenever the tables are, also where the run is gone on with after a kill.
            folder.write_csv(run)?;
        }
        if !folder.has_state() {
            folder.save_state(run)?;
        }
        Ok(())
    }

    /// Advances to the end or to a signal, and writes what there is.
    pub(super) fn finish(
        mut self,
        stop: &Stop,
        show: &mut dyn FnMut(&Progress),
    ) -> (Self, Outcome) {
        let ending = self.advance(stop, show);
        let (ending, report) = match (ending, self.synchronize()) {
            (Ending::Complete | Ending::Stopped(_), Err(error)) => (Ending::Unwritten(error), None),
            (ending, _) => (ending, self.trajectory.as_ref().map(Trajectory::report)),
        };
        let (status, message) = match &ending {
            Ending::Complete => (Status::Complete, None),
            Ending::Stopped(_) => (Status::Interrupted, None),
            Ending::Unwritten(error) => (Status::Interrupted, Some(error.to_string())),
            Ending::Failed(error) => (Status::Diverged, Some(error.to_string())),
        };
        let mut summary = Summary::of(&self.run, status, message);
        summary.trajectory = report;
        let finished = self.folder.finish(&self.run, &summary);
        let outcome = Outcome {
            ending,
            summary,
            finished,
        };
        (self, outcome)
    }

    fn advance(&mut self, stop: &Stop, show: &mut dyn FnMut(&Progress)) -> Ending {
        let (mut saved, mut pace) = (Instant::now(), Pace::default());
        while !self.run.is_complete() {
            if let Some(code) = stop.requested() {
                return Ending::Stopped(code);
            }
            let most = self.steps_to_next();
            if let Err(error) = pace.advance(&mut self.run, most) {
                return Ending::Failed(error);
            }
            if let Err(error) = self.observe() {
                return Ending::Unwritten(error);
            }
            show(&self.run.progress());
            if saved.elapsed() > self.save_every {
                // The run can go on without this state; the final save reports the disk's fault.
                if let Err(error) = self.save_state() {
                    say(&error.to_string());
                }
                saved = Instant::now();
            }
        }
        Ending::Complete
    }

    /// Saves the state, after the frames that led to it.
    fn save_state(&mut self) -> Result<(), RunError> {
        self.synchronize()?;
        self.folder.save_state(&self.run)
    }

    fn synchronize(&mut self) -> Result<(), RunError> {
        let mut trajectory = self.trajectory.iter_mut();
        trajectory.try_for_each(Trajectory::synchronize)
    }

    fn observe(&mut self) -> Result<(), RunError> {
        let mut trajectory = self.trajectory.iter_mut();
        trajectory.try_for_each(|trajectory| trajectory.observe(&self.run))
    }

    /// Steps after which a frame is due.
    fn steps_to_next(&self) -> u64 {
        let trajectory = self.trajectory.as_ref();
        let steps = trajectory.and_then(|trajectory| trajectory.steps_to_next(&self.run));
        steps.unwrap_or(u64::MAX)
    }
}

/// The trajectory that a run goes on with or begins, if it is to have one.
fn open_trajectory(
    arguments: &RunArguments,
    folder: &Path,
    run: &mut Run,
) -> Result<Option<Trajectory>, Failure> {
    let request = request(&arguments.frames)?;
    let there = Trajectory::resume(folder, run)?;
    match (there, request) {
        (Some(_), Some(_)) => Err(goes_on_as_begun(folder)),
        (None, Some(request)) => {
            let (now, end) = (run.simulation().step(), run.configuration().run.steps());
            let plan = TrajectoryPlan::new(&request, run.configuration(), now, end)?;
            Ok(Some(Trajectory::begin(folder, plan, run)?))
        }
        (there, None) => Ok(there),
    }
}

/// A trajectory that is asked for of a run that has one.
pub(super) fn goes_on_as_begun(folder: &Path) -> Failure {
    let folder = folder.display();
    Failure::usage(
        format!("{folder} has a trajectory, which goes on as it was begun"),
        "leave out --trajectory, --trajectory-every and --trajectory-window",
    )
}
