//! `peristalsis trajectory`, and what `run` and `check` say of trajectories.

use std::process::ExitCode;

use peristalsis_analysis::number::bytes;
use peristalsis_run::{
    Run, RunError, RunFolder, Trajectory, TrajectoryPlan, TrajectoryReport, TrajectoryRequest,
    Window,
};

use crate::arguments::{FrameArguments, TrajectoryArguments};
use crate::commands::{counted, print_report};
use crate::failure::Failure;
use crate::stop::Stop;

/// Folder for frames from a saved state, in the folder of their run.
const FROM_STATE: &str = "from-state";

pub(crate) fn trajectory(arguments: &TrajectoryArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let (folder, mut run) = RunFolder::open(&arguments.folder)?;
    let request = TrajectoryRequest {
        formats: arguments.formats.clone(),
        every: arguments.every,
        window: Window::default(),
    };
    let now = run.simulation().step();
    let plan = TrajectoryPlan::onward(&request, run.configuration(), now, arguments.duration)?;
    let usual = || folder.path().join(FROM_STATE);
    let out = arguments.out.clone().unwrap_or_else(usual);
    RunFolder::check(&out).map_err(not_into)?;
    std::fs::create_dir_all(&out).map_err(|source| {
        let folder = out.clone();
        RunError::Folder { folder, source }
    })?;
    let mut frames = Trajectory::begin(&out, plan, &mut run)?;
    stop.keep_results();
    let ending = go_on(&mut run, &mut frames, &stop);
    frames.synchronize()?;
    let report = frames.report();
    print_report(arguments.json, || &report, || in_words(&report) + "\n")?;
    ending
}

/// A folder that is not free for frames: nothing goes on with those in it.
fn not_into(error: RunError) -> Failure {
    match error {
        RunError::HoldsAnotherRun { .. } => {
            Failure::usage(error.to_string(), "name another folder with --out")
        }
        other => other.into(),
    }
}

/// Advances from frame to frame.
fn go_on(run: &mut Run, frames: &mut Trajectory, stop: &Stop) -> Result<ExitCode, Failure> {
    while let Some(steps) = frames.steps_to_next(run) {
        if let Some(code) = stop.requested() {
            return Ok(ExitCode::from(code));
        }
        run.advance_at_most(steps)?;
        frames.observe(run)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What the options ask for, if they ask for a trajectory.
pub(crate) fn request(arguments: &FrameArguments) -> Result<Option<TrajectoryRequest>, Failure> {
    if !arguments.trajectory.is_empty() {
        return Ok(Some(TrajectoryRequest {
            formats: arguments.trajectory.clone(),
            every: arguments.trajectory_every,
            window: arguments.trajectory_window.unwrap_or_default(),
        }));
    }
    match arguments.asks() {
        true => Err(Failure::usage(
            "--trajectory-every and --trajectory-window say which frames a trajectory has",
            "add --trajectory gsd",
        )),
        false => Ok(None),
    }
}

/// What was written, in a line.
pub(crate) fn in_words(report: &TrajectoryReport) -> String {
    let files = report.files.iter().map(|file| file.display().to_string());
    let (files, size) = (
        files.collect::<Vec<_>>().join(", "),
        bytes(report.bytes as f64),
    );
    let frames = counted(report.frames, "frame");
    let interval = counted(report.interval_steps, "step");
    format!("{frames}, one every {interval}, {size}: {files}")
}
