//! A run that is watched and driven: advances, changes, and says what it looks like.

use std::path::PathBuf;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use peristalsis_configuration::{Configuration, ScheduledParameter};
use peristalsis_run::{Run, RunError, RunFolder, Warning};

use crate::frame::{Head, of_run, of_wall};
use crate::message::{self, Command, Notice, Steered};
use crate::timeline::{Driven, Row, Timeline, thin};
use crate::welcome::Welcome;
use crate::within::Within;

/// Seconds from frame to frame.
pub(crate) const FRAME: f64 = 0.033;
/// Seconds after which a frame looks whether its time is over, at the latest.
const PATIENCE: f64 = 0.004;
/// Periods within which a parameter reaches the value of its slider, so that no wall jumps.
const RAMP: f64 = 0.25;
/// Largest speed, in periods a second.
const FASTEST: f64 = 1e6;
/// Rows of the time series in each frame: a client that missed more sees a gap.
const ROWS: usize = 256;
/// States kept to come back to.
const MARKS: usize = 24;
/// Saved states that are looked through for a free name.
const SAVES: u32 = 9999;

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
    /// Notices that no client has got yet.
    notices: Vec<String>,
    playing: bool,
    ended: bool,
    /// Periods a second, at most.
    speed: Option<f64>,
    /// Part of a step that earlier frames left over.
    due: f64,
    /// Computing time of a step in seconds.
    step_seconds: f64,
    /// Values of sliders that the run has not been led to yet.
    wanted: [(Steered, Option<f64>); 4],
    /// Step up to which the run is computed before it stops.
    seeking: Option<u64>,
    epoch: u64,
    /// Earlier states in the order of time, the first of all at least.
    marks: Vec<Run>,
    /// Steps at which the run was steered.
    steered: Vec<u64>,
    /// The warnings of the run as they were after so many periods, jumps and changes of the drive.
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

    pub(crate) fn new(run: Run, labels: Labels, clock: fn() -> f64) -> Self {
        use Steered::{ForceAmplitude, Friction, StrainRate, Width};
        Self {
            marks: vec![run.clone()],
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
            wanted: [Width, ForceAmplitude, StrainRate, Friction].map(|it| (it, None)),
            seeking: None,
            epoch: 0,
            steered: Vec::new(),
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
        welcome.rows = thin(self.rows(0));
        welcome.to_json()
    }

    /// Carries out a command of a page; an error becomes a notice.
    pub(crate) fn execute(&mut self, command: Command) {
        if let Err(error) = self.try_execute(command) {
            self.tell(&error.to_string());
        }
    }

    /// The notices since the last call, in JSON.
    pub(crate) fn notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    fn tell(&mut self, problem: &str) {
        self.notices.push(message::problem(problem));
    }

    fn try_execute(&mut self, command: Command) -> Result<(), RunError> {
        match command {
            Command::Play { playing } => {
                self.playing = playing && !self.ended;
                self.seeking = None;
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
                let known = self.wanted.iter_mut().find(|(it, _)| *it == parameter);
                if let Some((_, wanted)) = known {
                    *wanted = Some(value);
                }
                if !self.playing {
                    self.steer()?;
                }
            }
            Command::Seek { period } => self.seek(period),
            Command::Save {} => self.save()?,
            // Answered to who asked.
            Command::Frame { .. } => {}
        }
        Ok(())
    }

    /// Leads parameters that are at rest to the values of their sliders.
    fn steer(&mut self) -> Result<(), RunError> {
        let mut outcome = Ok(());
        for index in 0..self.wanted.len() {
            let (parameter, Some(value)) = self.wanted[index] else {
                continue;
            };
            let scheduled = match parameter {
                Steered::Width => Some(ScheduledParameter::Width),
                Steered::ForceAmplitude => Some(ScheduledParameter::ForceAmplitude),
                Steered::StrainRate => Some(ScheduledParameter::StrainRate),
                Steered::Friction => None,
            };
            let steered = match scheduled {
                Some(scheduled) if !self.run.is_at_rest(scheduled) => continue,
                Some(scheduled) => self.run.drive_to(scheduled, value, RAMP),
                None => self.run.set_friction(value),
            };
            self.wanted[index].1 = None;
            if steered.is_ok() {
                self.steered.push(self.run.simulation().step());
                self.mark();
            }
            outcome = outcome.and(steered);
        }
        outcome
    }

    /// Advances for the time between two frames, or by fewer steps at a given speed.
    pub(crate) fn advance_by_a_frame(&mut self) {
        let begin = (self.clock)();
        let most = self.steps_of_a_frame();
        let mut done = 0;
        while done < most && (self.clock)() - begin < FRAME && !self.ended {
            if let Err(error) = self.steer() {
                self.tell(&error.to_string());
            }
            // NaN, before a step was timed, becomes one step.
            let patient = (PATIENCE / self.step_seconds).max(1.0) as u64;
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
            self.mark_now_and_then();
        }
        let step = self.run.simulation().step();
        self.seeking = self.seeking.filter(|target| step < *target);
        let periods = self.run.recorder().averages().len();
        let now = (periods, self.epoch, self.steered.len());
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
        if target < self.run.simulation().step() {
            let is_known = |mark: &Run| mark.simulation().step() <= target;
            let index = self.marks.partition_point(is_known).saturating_sub(1);
            self.marks.truncate(index + 1);
            let mark = self.marks[index].clone();
            let reached = mark.simulation().step();
            target = target.max(reached);
            // Steering after the kept state is lost with it: the run ends before the first such step.
            if let Some(&steered) = self.steered.iter().find(|&&step| step > reached) {
                target = target.min(steered);
            }
            self.steered.retain(|&step| step <= reached);
            self.run = mark;
            self.ended = false;
            self.epoch += 1;
            self.due = 0.0;
            self.wanted = self.wanted.map(|(parameter, _)| (parameter, None));
        }
        self.seeking = Some(target);
    }

    fn mark_now_and_then(&mut self) {
        let step = self.run.simulation().step();
        let last = self.marks.last().map_or(0, |it| it.simulation().step());
        let first = self.marks.first().map_or(0, |it| it.simulation().step());
        // The longer the run, the further apart.
        let each = self.run.configuration().run.steps_per_sample;
        if step >= last + (20 * each).max((step - first) / (MARKS as u64 / 2)) {
            self.mark();
        }
    }

    fn mark(&mut self) {
        let step = |run: &Run| run.simulation().step();
        let now = step(&self.run);
        self.marks.retain(|mark| step(mark) < now);
        self.marks.push(self.run.clone());
        if self.marks.len() > MARKS {
            // Drops the state whose neighbours are nearest to each other.
            let gaps = self.marks.windows(3).map(|it| step(&it[2]) - step(&it[0]));
            if let Some((index, _)) = gaps.enumerate().min_by_key(|(_, gap)| *gap) {
                self.marks.remove(index + 1);
            }
        }
    }

    /// The configuration with a duration beyond the present state, so that the saved run can go on.
    fn longer(&self) -> Configuration {
        let mut configuration = self.run.configuration().clone();
        // A static wave has no periods that could be added.
        if configuration.run.periods.is_some() {
            let each = u64::from(configuration.observe.samples_per_period);
            let taken = self.run.recorder().samples().len() as u64;
            let samples = configuration.run.samples.max(taken + 10 * each);
            let periods = samples as f64 / each as f64;
            configuration.run.duration *= samples as f64 / configuration.run.samples as f64;
            configuration.run.samples = samples;
            configuration.run.periods = Some(periods);
        }
        configuration
    }

    fn save(&mut self) -> Result<(), RunError> {
        let configuration = self.longer();
        let toml = configuration.to_toml();
        let run = self.run.clone().under(configuration)?;
        let (folder, state) = match &self.labels.saves {
            Saves::Page => (None, Some(STANDARD.encode(run.to_snapshot()?))),
            Saves::Folders { inside, stem } => {
                let mut names = (1..=SAVES).map(|number| inside.join(format!("{stem}-{number}")));
                let Some(path) = names.find(|path| path.symlink_metadata().is_err()) else {
                    return Err(RunError::Folder {
                        folder: inside.clone(),
                        source: std::io::ErrorKind::AlreadyExists.into(),
                    });
                };
                let folder = RunFolder::create(&path, run.configuration())?;
                folder.save_state(&run)?;
                (Some(path.display().to_string()), None)
            }
        };
        let place = folder.as_deref().unwrap_or("FOLDER");
        let saved = Notice::Saved {
            command: format!("peristalsis run --resume {place}"),
            folder,
            toml,
            state,
            period: self.clock_now(),
        };
        self.notices.push(saved.to_json());
        Ok(())
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

    /// Rows of the time series from a number on.
    fn rows(&self, from: usize) -> impl Iterator<Item = Row> {
        let samples = self.run.recorder().samples().iter().enumerate().skip(from);
        let timeline = self.timeline();
        samples.map(move |(number, sample)| timeline.row_of(number, sample))
    }

    /// The bytes of a message with the present frame; `frame.rs` describes them.
    pub(crate) fn frame(&self) -> Vec<u8> {
        let simulation = self.run.simulation();
        let (bodies, wall) = (simulation.bodies(), simulation.wall());
        let samples = self.run.recorder().samples();
        let (wall_spheres, rings) = of_wall(wall);
        let head = Head {
            number: None,
            epoch: self.epoch,
            playing: self.playing,
            ended: self.ended,
            speed: self.speed,
            pace: self.run.configuration().run.time_step / (self.step_seconds * self.unit_period()),
            step: simulation.step(),
            time: simulation.time(),
            clock: self.clock_now(),
            period: wall.cycles(),
            wave_speed: wall.frequency(simulation.time()) * wall.wavelength(),
            grains: bodies.grains,
            wall_spheres,
            rings,
            turning: self.run.configuration().contact.friction.is_some(),
            driven: Driven::of(&self.run),
            rows: self.rows(samples.len().saturating_sub(ROWS)).collect(),
            sample: samples.last().map(Into::into),
            warnings: self.warned.1.clone(),
        };
        of_run(&head, &self.run)
    }
}
