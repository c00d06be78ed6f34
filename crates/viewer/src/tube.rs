//! A run that is watched and driven: advances, changes, and says what it looks like.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use peristalsis_configuration::Configuration;
use peristalsis_formats::shell_word;
use peristalsis_observe::MOST_ROWS;
use peristalsis_run::{Run, RunError, RunFolder, Warning};

use crate::course::Course;
use crate::frame::{Head, contacts_of, of_run};
use crate::message::{self, Command, Notice, Steered, Turn};
use crate::steering::Steering;
use crate::timeline::{Driven, Timeline, history, rows, thin};
use crate::welcome::Welcome;
use crate::within::Within;

/// Seconds from frame to frame.
pub(crate) const FRAME: f64 = 0.033;
/// Seconds after which a frame looks whether its time is over, at the latest.
const PATIENCE: f64 = 0.004;
/// Largest speed, in periods per second.
const FASTEST: f64 = 1e6;
/// Rows of the time series in each frame: a client that missed more sees a gap.
const ROWS: usize = 256;

/// The title of a tube, the place of its saved states, and its time series from an earlier computation.
#[derive(Clone, Debug)]
pub(crate) struct Labels {
    pub(crate) title: String,
    pub(crate) saves: Saves,
    /// Time and J/Jmax of the same run from before.
    pub(crate) record: Vec<(f64, f64)>,
    pub(crate) within: Option<Within>,
}

/// The place of saved states.
#[derive(Clone, Debug)]
pub(crate) enum Saves {
    /// A new folder for each, inside this one, whose name begins with the stem.
    #[cfg_attr(
        not(feature = "server"),
        expect(dead_code, reason = "a page has no folders")
    )]
    Folders { inside: PathBuf, stem: String },
    /// The page, as bytes.
    Page,
}

/// A run that is watched and driven.
#[derive(Debug)]
pub(crate) struct Tube {
    run: Run,
    labels: Labels,
    /// Seconds since any instant.
    clock: fn() -> f64,
    /// Notices to all clients that none has got yet.
    notices: Vec<String>,
    playing: bool,
    ended: bool,
    /// Periods a second, at most.
    speed: Option<f64>,
    /// Part of a step that earlier frames left over.
    due: f64,
    /// Computing time of a step in seconds.
    step_seconds: f64,
    steering: Steering,
    /// Step up to which the run is computed before it stops.
    seeking: Option<u64>,
    epoch: u64,
    course: Course,
    /// Whether frames hold the contacts of the grains.
    contacts: bool,
    /// Rows that the page has got; of several clients each may lack others.
    told: Cell<usize>,
    /// The warnings of the run as they were after so many periods and samples of the first period, jumps and changes of the
    /// drive.
    warned: ((usize, u64, usize), Vec<Warning>),
}

impl Tube {
    /// A run at rest whose saved states are given to the page; `clock` answers seconds since any instant.
    pub(crate) fn for_page(run: Run, title: String, clock: fn() -> f64) -> Self {
        let labels = Labels {
            title,
            saves: Saves::Page,
            record: Vec::new(),
            within: None,
        };
        Self::new(run, labels, clock)
    }

    pub(crate) fn new(mut run: Run, labels: Labels, clock: fn() -> f64) -> Self {
        Self {
            course: Course::begin(&mut run),
            warned: ((0, 0, 0), run.warnings()),
            run,
            labels,
            clock,
            notices: Vec::new(),
            playing: false,
            ended: false,
            speed: Some(1.0),
            due: 0.0,
            step_seconds: f64::NAN,
            steering: Steering::default(),
            seeking: None,
            epoch: 0,
            contacts: false,
            told: Cell::new(0),
        }
    }

    /// Whether there is anything to compute.
    pub(crate) fn is_going(&self) -> bool {
        !self.ended && (self.playing || self.seeking.is_some())
    }

    /// The first message to a page, in JSON.
    pub(crate) fn welcome(&self) -> String {
        let timeline = self.timeline();
        let (configuration, simulation) = (self.run.configuration(), self.run.simulation());
        let grains = simulation.bodies().grains;
        let title = &self.labels.title;
        let mut welcome = Welcome::of(configuration, simulation.wall(), grains, title);
        let record = self.labels.record.iter();
        welcome.driven = Driven::of(&self.run);
        welcome.record = thin(record.map(|&(time, ratio)| (timeline.clock(time), ratio)));
        welcome.within = self.labels.within.clone();
        let begin = self.course.first_step() as f64 * configuration.run.time_step;
        welcome.begin = timeline.clock(begin);
        welcome.rows = history(rows(&self.run, 0));
        welcome.to_json()
    }

    /// Carries out a command of a page; answers what to tell this page, an error too.
    pub(crate) fn execute(&mut self, command: Command) -> Option<String> {
        self.try_execute(command)
            .unwrap_or_else(|error| Some(message::problem(&error.to_string())))
    }

    /// The notices since the last call, in JSON.
    pub(crate) fn notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    fn tell(&mut self, problem: &str) {
        self.notices.push(message::problem(problem));
    }

    fn try_execute(&mut self, command: Command) -> Result<Option<String>, RunError> {
        match command {
            Command::Play { playing } => {
                self.playing = playing && !self.ended;
                // What goes on comes to its place first.
                if !self.playing {
                    self.seeking = None;
                    self.course.leave();
                }
            }
            Command::Speed { periods_per_second } => {
                self.speed = periods_per_second.map(|speed| speed.min(FASTEST));
            }
            Command::Step {} => {
                self.playing = false;
                let each = self.run.configuration().run.steps_per_sample;
                let step = self.run.simulation().step();
                self.seeking = Some((step / each + 1) * each);
            }
            Command::Steer { parameter, value } => {
                self.steering.want(&self.run, parameter, value)?;
                self.course.leave();
                if !self.playing {
                    self.steer()?;
                }
            }
            Command::Seek { period } => self.seek(period),
            Command::Save {} => return self.save().map(Some),
            Command::Course {} => {
                let turns = self.course.turns().to_vec();
                let step = self.step();
                return Ok(Some(Notice::Course { turns, step }.to_json()));
            }
            Command::Follow { turns, step } => {
                self.go_back(0);
                self.course.follow(&mut self.run, turns);
                (self.playing, self.seeking) = (false, Some(step));
            }
            Command::Contacts { shown } => self.contacts = shown,
            // Answered by the server.
            Command::Frame { .. } => {}
        }
        Ok(None)
    }

    /// Leads parameters that are at rest to the values of their sliders.
    fn steer(&mut self) -> Result<(), RunError> {
        let mut outcome = Ok(());
        while let Some((parameter, value)) = self.steering.next(&self.run) {
            let steered = self.lead(parameter, value);
            outcome = outcome.and(steered);
        }
        outcome
    }

    /// Leads a parameter to a value from the present step on.
    fn lead(&mut self, parameter: Steered, value: f64) -> Result<(), RunError> {
        self.steering.lead(&mut self.run, parameter, value)?;
        self.course.turn(&mut self.run, parameter, value);
        Ok(())
    }

    /// Does again what was done at this step, on the way back to where the run had come.
    fn follow(&mut self) -> Result<(), RunError> {
        while let Some(Turn {
            parameter, value, ..
        }) = self.course.due(&self.run)
        {
            self.lead(parameter, value)?;
        }
        Ok(())
    }

    /// Advances for the time between two frames, or by fewer steps at a given speed.
    pub(crate) fn advance_by_a_frame(&mut self) {
        let begin = (self.clock)();
        let most = self.steps_of_a_frame();
        let mut done = 0;
        while done < most && (self.clock)() - begin < FRAME && !self.ended {
            if let Err(error) = self.follow().and_then(|()| self.steer()) {
                self.tell(&error.to_string());
            }
            // NaN, before a step was timed, becomes one step.
            let patient = (PATIENCE / self.step_seconds).max(1.0) as u64;
            let patient = self.course.steps_to_next(&self.run, patient);
            let before = self.run.simulation().step();
            let chunk = (self.clock)();
            if let Err(error) = self.run.advance_at_most(patient.min(most - done)) {
                self.ended = true;
                self.playing = false;
                self.tell(&error.to_string());
            }
            let steps = self.run.simulation().step() - before;
            done += steps;
            let seconds = ((self.clock)() - chunk) / steps.max(1) as f64;
            self.step_seconds = if self.step_seconds.is_nan() {
                seconds
            } else {
                0.9 * self.step_seconds + 0.1 * seconds
            };
            self.course.mark_now_and_then(&mut self.run);
            if self.run.recorder().samples().len() >= MOST_ROWS {
                (self.ended, self.playing) = (true, false);
                self.tell(&format!(
                    "{MOST_ROWS} samples are as many as a watched run keeps: save this state and go on with \
                     `peristalsis run --resume`, or go back in time"
                ));
            }
        }
        if self.seeking.is_some_and(|target| self.step() >= target) {
            self.seeking = None;
            if let Err(error) = self.follow() {
                self.tell(&error.to_string());
            }
        }
        let recorder = self.run.recorder();
        let periods = recorder.averages().len();
        // A tube that leaks does so from the start, and periods may last.
        let of_first_period = self.run.configuration().observe.samples_per_period as usize;
        let samples = recorder.samples().len().min(of_first_period);
        let now = (periods + samples, self.epoch, self.course.turns().len());
        if self.warned.0 != now {
            self.warned = (now, self.run.warnings());
        }
    }

    fn steps_of_a_frame(&mut self) -> u64 {
        if let Some(target) = self.seeking {
            return target.saturating_sub(self.run.simulation().step());
        }
        let Some(speed) = self.speed else {
            return u64::MAX;
        };
        let steps_per_period = self.unit_period() / self.run.configuration().run.time_step;
        self.due += speed * steps_per_period * FRAME;
        let whole = self.due.floor();
        self.due -= whole;
        whole as u64
    }

    fn seek(&mut self, period: f64) {
        self.playing = false;
        let time_step = self.run.configuration().run.time_step;
        let mut target = (period * self.unit_period() / time_step).round() as u64;
        if target < self.step() {
            self.go_back(target);
            target = target.max(self.step());
        }
        self.seeking = Some(target);
    }

    /// Takes the run back to a mark before a step; what lies up to the step is to be done again.
    fn go_back(&mut self, target: u64) {
        self.course.back(&mut self.run, target);
        self.ended = false;
        self.epoch += 1;
        self.due = 0.0;
        self.steering = Steering::default();
        for turn in self.course.turns() {
            self.steering.aim(turn.parameter, turn.value);
        }
    }

    /// The configuration with a duration beyond the present state, so that the saved run can go on.
    fn longer(&self) -> Configuration {
        let mut configuration = self.run.configuration().clone();
        // A static wave has no periods that could be added.
        if configuration.run.periods.is_some() {
            let each = u64::from(configuration.observe.samples_per_period);
            let taken = self.run.recorder().taken();
            let samples = configuration.run.samples.max(taken + 10 * each);
            let periods = samples as f64 / each as f64;
            configuration.run.duration *= samples as f64 / configuration.run.samples as f64;
            configuration.run.samples = samples;
            configuration.run.periods = Some(periods);
        }
        configuration
    }

    fn save(&self) -> Result<String, RunError> {
        let configuration = self.longer();
        let toml = configuration.to_toml();
        let run = self.run.clone().under(configuration)?;
        let (folder, state) = match &self.labels.saves {
            Saves::Page => (None, Some(STANDARD.encode(run.to_snapshot()?))),
            Saves::Folders { inside, stem } => {
                let folder = RunFolder::create_next(inside, stem, run.configuration())?;
                folder.save_state(&run)?;
                (Some(folder.path().to_owned()), None)
            }
        };
        let place = folder.as_deref().unwrap_or(Path::new("FOLDER"));
        let length = &self.run.configuration().run;
        // A run that has reached its end needs a new one: `longer` gives it one, but to a standing wave.
        let has_ended = length.periods.is_none() && self.step() >= length.steps();
        let longer = match has_ended {
            true => format!(" --duration {}", 2.0 * self.run.simulation().time().ceil()),
            false => String::new(),
        };
        let saved = Notice::Saved {
            command: format!("peristalsis run --resume {}{longer}", shell_word(place)),
            folder: folder.map(|folder| folder.display().to_string()),
            toml,
            repeats: (self.course.turns().iter()).all(|turn| turn.parameter != Steered::Friction),
            state,
            period: self.clock_now(),
        };
        Ok(saved.to_json())
    }

    /// Number of steps that the run has taken.
    pub(crate) fn step(&self) -> u64 {
        self.run.simulation().step()
    }

    fn timeline(&self) -> Timeline<'_> {
        Timeline(self.run.configuration())
    }

    fn unit_period(&self) -> f64 {
        self.timeline().unit_period()
    }

    /// Time in periods.
    fn clock_now(&self) -> f64 {
        self.timeline().clock(self.run.simulation().time())
    }

    /// The bytes of a message with the present frame; `frame.rs` describes them. One that is kept for those who come later
    /// is marked as `past`.
    pub(crate) fn frame(&self, past: bool) -> Vec<u8> {
        let samples = self.run.recorder().samples().len();
        let contacts = if self.contacts && !past {
            contacts_of(&self.run)
        } else {
            Vec::new()
        };
        let recent = samples.saturating_sub(ROWS);
        let first = match self.labels.saves {
            _ if past => samples,
            Saves::Page => self.told.replace(samples).min(recent),
            Saves::Folders { .. } => recent,
        };
        let head = Head {
            past,
            epoch: self.epoch,
            playing: self.playing,
            ended: self.ended,
            speed: self.speed,
            aims: self.steering.aims(&self.run),
            rows: rows(&self.run, first),
            warnings: self.warned.1.clone(),
            ..Head::of(&self.run, &contacts)
        };
        of_run(&head, &self.run, &contacts)
    }
}
