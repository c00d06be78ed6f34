//! Frames one after the other, from a file or as they are computed.

use std::path::{Path, PathBuf};

use peristalsis_configuration::Configuration;
use peristalsis_formats::trajectory::gsd::GsdReader;
use peristalsis_formats::{Frame, TrajectoryFormat};

use super::frame::frame;
use super::plan::{Span, TrajectoryPlan, WINDOW_HELP, Window};
use crate::error::RunError;
use crate::run::Run;

/// Part of a period by which a frame may come too early: times are rounded.
const TOLERANCE: f64 = 1e-6;

/// Frames of a run, one after the other.
#[derive(Debug)]
pub struct FrameSource {
    from: From,
    frames: usize,
    next: usize,
}

#[derive(Debug)]
enum From {
    /// A trajectory, and which of its frames.
    File(Box<GsdReader>, Vec<usize>),
    /// A run that goes on.
    Computed {
        run: Box<Run>,
        plan: TrajectoryPlan,
        with_contacts: bool,
    },
}

impl FrameSource {
    /// The frames of a GSD trajectory of a run within a window, at least `every` apart.
    ///
    /// # Errors
    /// [`RunError::Format`] where it cannot be read; [`RunError::Trajectory`] where the window holds none of its frames, or
    /// is in periods of a wave that stands still.
    pub fn of_file(
        path: &Path,
        configuration: &Configuration,
        every: Option<Span>,
        window: Window,
    ) -> Result<Self, RunError> {
        let time = |span: Option<Span>| span.map(|span| span.time(configuration)).transpose();
        let (interval, from, to) = (
            time(every)?.unwrap_or(0.0),
            time(window.from)?,
            time(window.to)?,
        );
        let tolerance = TOLERANCE * configuration.drive.period().unwrap_or(1.0);
        let mut reader = GsdReader::open(path)?;
        let mut chosen = Vec::new();
        let mut due = f64::NEG_INFINITY;
        let (mut first, mut last) = (f64::NAN, f64::NAN);
        for number in 0..reader.frames() {
            let time = reader.value(number, "time")?.unwrap_or(f64::NAN);
            if number == 0 {
                first = time;
            }
            last = time;
            if from.is_none_or(|from| time >= from - tolerance)
                && to.is_none_or(|to| time <= to + tolerance)
                && time >= due - tolerance
            {
                chosen.push(number);
                // On the grid of intervals, so that uneven frames do not drift.
                let grid = if due.is_finite() { due } else { time };
                due = grid.max(time - interval) + interval;
            }
        }
        if chosen.is_empty() {
            let (frames, path, help) = (reader.frames(), path.display(), WINDOW_HELP);
            let reason = format!(
                "the window holds none of the {frames} frames of {path}, which are from {}",
                extent(configuration, first, last)
            );
            return Err(RunError::Trajectory { reason, help });
        }
        Ok(Self {
            frames: chosen.len(),
            from: From::File(Box::new(reader), chosen),
            next: 0,
        })
    }

    /// The GSD trajectory in the folder of a run.
    ///
    /// # Errors
    /// [`RunError::Trajectory`] where there is none.
    pub fn in_folder(folder: &Path) -> Result<PathBuf, RunError> {
        let name = TrajectoryFormat::Gsd.file_name();
        let path = folder.join(name);
        if path.is_file() {
            return Ok(path);
        }
        Err(RunError::Trajectory {
            reason: format!("{} holds no {name}", folder.display()),
            help: "write one with run --trajectory gsd, name one with --trajectory FILE, or let the frames be computed: \
                   --from state, --from start",
        })
    }

    /// The frames that a run goes through on a plan, which must not begin before its present state.
    pub fn of_run(mut run: Run, plan: TrajectoryPlan, with_contacts: bool) -> Self {
        run.follow_orientations();
        Self {
            frames: plan.frames() as usize,
            from: From::Computed {
                run: Box::new(run),
                plan,
                with_contacts,
            },
            next: 0,
        }
    }

    /// The frame of a GSD trajectory of a run nearest to an instant, or the last where none is asked for; and the first.
    ///
    /// # Errors
    /// [`RunError::Format`] where it cannot be read; [`RunError::Trajectory`] where none of its frames is near the instant,
    /// or it is in periods of a wave that stands still.
    pub fn nearest(
        path: &Path,
        configuration: &Configuration,
        at: Option<Span>,
    ) -> Result<[Frame; 2], RunError> {
        let mut reader = GsdReader::open(path)?;
        let mut found = (reader.frames() - 1, f64::INFINITY);
        if let Some(span) = at {
            let at = span.time(configuration)?;
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for number in 0..reader.frames() {
                let Some(time) = reader.value(number, "time")? else {
                    continue;
                };
                (first, last) = (first.min(time), last.max(time));
                let away = (time - at).abs();
                if away < found.1 {
                    found = (number, away);
                }
            }
            let between = (last - first) / (reader.frames().max(2) - 1) as f64;
            if !(first - between..=last + between).contains(&at) && found.1.is_finite() {
                let (path, frames, help) = (path.display(), reader.frames(), WINDOW_HELP);
                let extent = extent(configuration, first, last);
                let reason = format!(
                    "no frame of {path} is near {span}: its {frames} frames are from {extent}"
                );
                return Err(RunError::Trajectory { reason, help });
            }
        }
        Ok([reader.frame(0)?, reader.frame(found.0)?])
    }

    /// The present state of a run, as a frame.
    pub fn now(run: &Run, with_contacts: bool) -> Frame {
        frame(run, with_contacts)
    }

    /// Frames in all.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Frames of the file that a kill or a full disk left in parts.
    pub fn lost_frames(&self) -> u64 {
        match &self.from {
            From::File(reader, _) => reader.lost_frames(),
            From::Computed { .. } => 0,
        }
    }

    /// Instants from which room and colours of all frames follow: the first, and the last where it is known.
    ///
    /// # Errors
    /// As [`FrameSource::step`].
    pub fn samples(&mut self) -> Result<Vec<Frame>, RunError> {
        match &mut self.from {
            From::File(reader, chosen) => {
                let places = [0, chosen.len() / 2, chosen.len() - 1];
                let mut numbers = places.map(|place| chosen[place]).to_vec();
                numbers.dedup();
                let frames = numbers.into_iter().map(|number| Ok(reader.frame(number)?));
                frames.collect()
            }
            From::Computed {
                run, with_contacts, ..
            } => Ok(vec![frame(run, *with_contacts)]),
        }
    }

    /// The next frame; or, where many steps lead to it, `None` on the way. Ask again until [`FrameSource::is_over`].
    ///
    /// # Errors
    /// [`RunError::Format`] where the file cannot be read; [`RunError::Engine`] where the run diverges.
    pub fn step(&mut self) -> Result<Option<Frame>, RunError> {
        if self.is_over() {
            return Ok(None);
        }
        let found = match &mut self.from {
            From::File(reader, chosen) => Some(reader.frame(chosen[self.next])?),
            From::Computed {
                run,
                plan,
                with_contacts,
            } => {
                let step = run.simulation().step();
                let is_new = plan.is_due(step) && plan.frames_through(step) as usize > self.next;
                if !is_new {
                    let steps = plan.steps_to_next(step);
                    let steps = steps.expect("not all frames have been made, so one is ahead");
                    run.advance_at_most(steps)?;
                }
                is_new.then(|| frame(run, *with_contacts))
            }
        };
        self.next += usize::from(found.is_some());
        Ok(found)
    }

    /// Whether there are no more frames.
    pub fn is_over(&self) -> bool {
        self.next >= self.frames
    }
}

/// From which time to which frames are, for an error.
fn extent(configuration: &Configuration, first: f64, last: f64) -> String {
    let times = format!("t = {first:.1} to {last:.1}");
    match configuration.drive.period() {
        Some(period) => format!(
            "period {:.2} to {:.2} ({times})",
            first / period,
            last / period
        ),
        None => times,
    }
}
