//! Which frames a trajectory has.

use std::fmt;
use std::str::FromStr;

use peristalsis_configuration::Configuration;
use peristalsis_formats::TrajectoryFormat;

use crate::RunError;

/// Frames in a period, unless asked for otherwise.
const FRAMES_PER_PERIOD: f64 = 10.0;
/// Frames of a run whose wave stands still, unless asked for otherwise.
const FRAMES_OF_A_STATIC_RUN: u64 = 100;
/// Most spheres of a frame, which is made in memory: some 2 GB.
const MOST_SPHERES: u64 = 20_000_000;
/// Most frames of a trajectory.
const MOST_FRAMES: u64 = 10_000_000;
/// How times are given, for a time or a window that holds no frame.
pub(super) const WINDOW_HELP: &str = "times are in periods of the run, or in time with a t: 20, 400t; a window is FROM:TO: 20:25, 5t:10t";

/// A length of time in a run, or a time in it, as a person gives it: `0.1` in periods, `2.5t` in units of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// In wave periods.
    Periods(f64),
    /// In units of time \[t\].
    Time(f64),
}

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, span): (_, fn(f64) -> Self) = match text.trim().strip_suffix('t') {
            Some(time) => (time, Self::Time),
            None => (text, Self::Periods),
        };
        number
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite() && *value >= 0.0)
            .map(span)
            .ok_or_else(|| {
                "a number of periods from 0 on, such as 0.1, or a time, such as 2.5t".to_owned()
            })
    }
}

impl fmt::Display for Span {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Periods(periods) => write!(formatter, "{periods} periods"),
            Self::Time(time) => write!(formatter, "{time} t"),
        }
    }
}

impl Span {
    /// The same in units of time of a run \[t\].
    pub(super) fn time(self, configuration: &Configuration) -> Result<f64, RunError> {
        match self {
            Self::Time(time) => Ok(time),
            Self::Periods(periods) => match configuration.drive.period() {
                Some(period) => Ok(periods * period),
                None if periods == 0.0 => Ok(0.0),
                None => {
                    let reason = format!("the wave stands still, and {self} last for ever");
                    let help = "give times instead, such as 2.5t";
                    Err(RunError::Trajectory { reason, help })
                }
            },
        }
    }

    /// The same in steps of a run.
    fn steps(self, configuration: &Configuration) -> Result<f64, RunError> {
        Ok(self.time(configuration)? / configuration.run.time_step)
    }
}

/// A window of time in a run: `20:25`, `100:` to the end, `:5t` from the start; the whole of it by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Window {
    /// Its beginning; `None`: where the run begins.
    pub from: Option<Span>,
    /// Its end; `None`: where the run ends.
    pub to: Option<Span>,
}

impl FromStr for Window {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "FROM:TO, such as 20:25 in periods, 100: to the end, or 5t:10t in time";
        let (from, to) = text.split_once(':').ok_or(expected)?;
        let end = |text: &str| match text.trim() {
            "" => Ok(None),
            text => text.parse().map(Some).map_err(|_| expected.to_owned()),
        };
        Ok(Self {
            from: end(from)?,
            to: end(to)?,
        })
    }
}

/// A request for a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryRequest {
    /// In which formats.
    pub formats: Vec<TrajectoryFormat>,
    /// Time between two frames; `None`: a tenth of a period.
    pub every: Option<Span>,
    /// When.
    pub window: Window,
}

/// Which frames a trajectory has: steps `first`, `first + interval`, ..., at most `last`, the end of the run unless its
/// window ends before, with step `until`.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrajectoryPlan {
    pub(super) formats: Vec<TrajectoryFormat>,
    pub(super) interval: u64,
    pub(super) first: u64,
    pub(super) last: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) until: Option<u64>,
}

impl TrajectoryPlan {
    /// The frames of a run that stands at step `now` and ends with step `end`, in its window; the interval is rounded
    /// down to whole steps.
    ///
    /// # Errors
    /// [`RunError::Trajectory`] where the interval is less than a step or the window holds no step of the run.
    pub fn new(
        request: &TrajectoryRequest,
        configuration: &Configuration,
        now: u64,
        end: u64,
    ) -> Result<Self, RunError> {
        let spheres = configuration.grains.number + configuration.tube.wall_spheres();
        if spheres > MOST_SPHERES {
            let reason = format!(
                "a frame of {spheres} spheres, those of the wall among them, is beyond reach: at most {MOST_SPHERES}"
            );
            let help = "take fewer waves (tube.waves) or grains (grains.number)";
            return Err(RunError::Trajectory { reason, help });
        }
        let interval = interval(request.every, configuration)?;
        let place = |span: Option<Span>| {
            let steps = span.map(|span| span.steps(configuration)).transpose();
            Ok::<_, RunError>(steps?.map(|steps| steps.round() as u64))
        };
        let from = place(request.window.from)?.unwrap_or(0);
        let until = place(request.window.to)?;
        let time = |step| step as f64 * configuration.run.time_step;
        if let Some(until) = until.filter(|until| *until < from) {
            let reason = format!(
                "the window is reversed: it begins at t = {}, and ends before, at t = {}",
                time(from),
                time(until)
            );
            let help = WINDOW_HELP;
            return Err(RunError::Trajectory { reason, help });
        }
        let to = until.map_or(end, |until| until.min(end));
        // A trajectory that begins in the middle of a run keeps to the frames that it would have had from the start.
        let first = from + now.saturating_sub(from).div_ceil(interval) * interval;
        if first > to {
            let periods = |step| time(step) * configuration.drive.strain_rate;
            let reason = format!(
                "no frame lies there: the run goes from t = {} to t = {} ({} periods), and what was asked for begins at t = {}",
                time(now),
                time(end),
                periods(end),
                time(from)
            );
            let help = WINDOW_HELP;
            return Err(RunError::Trajectory { reason, help });
        }
        let mut formats = request.formats.clone();
        formats.sort_unstable();
        formats.dedup();
        let plan = Self {
            formats,
            interval,
            first,
            last: to,
            until,
        };
        let frames = plan.frames();
        if frames > MOST_FRAMES {
            let reason = format!("{frames} frames are beyond reach: at most {MOST_FRAMES}");
            let help = "take a longer interval or a shorter window";
            return Err(RunError::Trajectory { reason, help });
        }
        Ok(plan)
    }

    /// The frames from step `now` on, included, over `duration`.
    ///
    /// # Errors
    /// As [`TrajectoryPlan::new`].
    pub fn onward(
        request: &TrajectoryRequest,
        configuration: &Configuration,
        now: u64,
        duration: Span,
    ) -> Result<Self, RunError> {
        let steps = duration.steps(configuration)?.round() as u64;
        let on = Self::new(request, configuration, 0, steps)?;
        Ok(Self {
            first: now,
            last: now.saturating_add(steps),
            ..on
        })
    }

    /// The same of a run that ends with step `end`.
    pub(super) fn ending(&self, end: u64) -> Self {
        let last = self.until.map_or(end, |until| until.min(end));
        Self {
            last,
            ..self.clone()
        }
    }

    /// Steps between two frames.
    pub fn interval(&self) -> u64 {
        self.interval
    }

    /// Frames in all.
    pub fn frames(&self) -> u64 {
        self.frames_through(u64::MAX)
    }

    /// Frames at or before a step.
    pub(super) fn frames_through(&self, step: u64) -> u64 {
        let steps = step.min(self.last).checked_sub(self.first);
        steps.map_or(0, |steps| steps / self.interval.max(1) + 1)
    }

    /// Whether there is a frame at a step.
    pub(super) fn is_due(&self, step: u64) -> bool {
        let is_on_grid = |steps: u64| steps.is_multiple_of(self.interval.max(1));
        step <= self.last && step.checked_sub(self.first).is_some_and(is_on_grid)
    }

    /// Steps from a step to the next frame after it.
    pub(super) fn steps_to_next(&self, step: u64) -> Option<u64> {
        let next = self.first + self.frames_through(step) * self.interval;
        (next <= self.last).then(|| next - step)
    }
}

/// Steps between two frames.
fn interval(every: Option<Span>, configuration: &Configuration) -> Result<u64, RunError> {
    let steps = match (every, configuration.drive.period()) {
        (Some(span), _) => span.steps(configuration)?,
        (None, Some(period)) => period / FRAMES_PER_PERIOD / configuration.run.time_step,
        (None, None) => (configuration.run.steps() / FRAMES_OF_A_STATIC_RUN) as f64,
    };
    // Down, so that the last frame is not one step behind the end; whole steps are whole up to rounding.
    let whole = (steps * (1.0 + 1e-9)).floor();
    if let Some(span) = every
        && whole < 1.0
    {
        let step = configuration.run.time_step;
        let reason =
            format!("frames every {span}, which is {steps:.3} times a step of {step:.4} t");
        let help = "take a longer interval, or a shorter run.time_step";
        return Err(RunError::Trajectory { reason, help });
    }
    Ok((whole as u64).max(1))
}
