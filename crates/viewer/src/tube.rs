//! The thread that owns the run: advances it, changes it, and says what it looks like.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use peristalsis_configuration::ScheduledParameter;
use peristalsis_observe::Sample;
use peristalsis_run::{Run, RunError, RunFolder};
use tokio::sync::{broadcast, oneshot, watch};

use crate::course::{Course, thin};
use crate::frame::{Head, Row, of_run};
use crate::message::{Command, Notice, Steered};
use crate::welcome::{Driven, Welcome};

/// Time from frame to frame.
const FRAME: Duration = Duration::from_millis(33);
/// Time after which the thread looks for commands, at the latest.
const PATIENCE: Duration = Duration::from_millis(4);
/// Periods within which a parameter goes to where its slider was put: no wall jumps.
const RAMP: f64 = 0.25;
/// Periods a second beyond which nobody asks for a speed.
const FASTEST: f64 = 1e6;
/// Rows of the time series in each frame: a client that missed more sees a gap.
const ROWS: usize = 256;
/// States kept to come back to.
const MARKS: usize = 24;
/// Saved states that are looked through for a free name.
const SAVES: u32 = 9999;

/// What the thread is asked.
#[derive(Debug)]
pub(crate) enum Request {
    /// To do something.
    Command(Command),
    /// What a new client must know first.
    Welcome(oneshot::Sender<String>),
    /// A frame of a recording; else why it cannot be had.
    Frame(usize, oneshot::Sender<Result<Vec<u8>, String>>),
}

/// What clients listen to.
#[derive(Clone, Debug)]
pub(crate) struct Voices {
    pub(crate) frames: watch::Sender<Arc<Vec<u8>>>,
    pub(crate) notices: broadcast::Sender<String>,
}

impl Voices {
    /// Tells everyone; with nobody there, nobody is told.
    pub(crate) fn say(&self, notice: &Notice) {
        drop(self.notices.send(notice.to_json()));
    }
}

/// What a tube is called, where it is saved, and what is known of it from before.
#[derive(Clone, Debug)]
pub(crate) struct Labels {
    pub(crate) title: String,
    pub(crate) saves: PathBuf,
    pub(crate) record: Vec<Sample>,
}

/// A run in the hands of its viewers.
#[derive(Debug)]
pub(crate) struct Tube {
    run: Run,
    labels: Labels,
    voices: Voices,
    playing: bool,
    ended: bool,
    /// Periods a second, at most.
    speed: Option<f64>,
    /// Steps due from frames before, less than one.
    due: f64,
    /// Seconds that a step takes.
    step_seconds: f64,
    /// Values that sliders were put to and that parameters have not reached.
    wanted: [(Steered, Option<f64>); 4],
    /// Step that is being gone to.
    seeking: Option<u64>,
    epoch: u64,
    /// Earlier states in the order of time, the first of all at least.
    marks: Vec<Run>,
    /// Steps at which the run was steered.
    steered: Vec<u64>,
}

impl Tube {
    pub(crate) fn new(run: Run, labels: Labels, voices: Voices) -> Self {
        use Steered::{ForceAmplitude, Friction, StrainRate, Width};
        Self {
            marks: vec![run.clone()],
            run,
            labels,
            voices,
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

    /// Works until nobody is left who could ask for anything.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        self.publish();
        let mut next = Instant::now();
        loop {
            let busy = self.is_busy();
            let patience = if busy {
                next.saturating_duration_since(Instant::now())
            } else {
                FRAME
            };
            match requests.recv_timeout(patience) {
                Ok(request) => {
                    self.answer(request);
                    continue;
                }
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {}
            }
            if busy {
                next = Instant::now() + FRAME;
                self.advance_by_a_frame();
                self.publish();
            }
        }
    }

    fn is_busy(&self) -> bool {
        let watched = self.voices.frames.receiver_count() > 0;
        !self.ended && watched && (self.playing || self.seeking.is_some())
    }

    fn answer(&mut self, request: Request) {
        match request {
            Request::Welcome(reply) => {
                let course = self.course();
                let record = self.labels.record.iter();
                let (configuration, simulation) = (self.run.configuration(), self.run.simulation());
                let grains = simulation.bodies().grains;
                let title = &self.labels.title;
                let mut welcome = Welcome::of(configuration, simulation.wall(), grains, title);
                welcome.driven = Driven::of(&self.run);
                welcome.record = thin(record.map(|it| (course.clock(it.time), it.flow_rate_ratio)));
                welcome.rows = thin(self.rows(0));
                // A client that has left meanwhile needs no answer.
                drop(reply.send(welcome.to_json()));
            }
            Request::Frame(_, reply) => {
                let reason = "this run is computed as it is watched; it has no recorded frames";
                drop(reply.send(Err(reason.to_owned())));
            }
            Request::Command(command) => {
                if let Err(error) = self.obey(command) {
                    let message = error.to_string();
                    self.voices.say(&Notice::Problem { message });
                }
                self.publish();
            }
        }
    }

    fn obey(&mut self, command: Command) -> Result<(), RunError> {
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

    /// Leads what is at rest to where its slider was put.
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

    fn advance_by_a_frame(&mut self) {
        let begin = Instant::now();
        let most = self.steps_of_a_frame();
        let mut done = 0;
        while done < most && begin.elapsed() < FRAME && !self.ended {
            if let Err(error) = self.steer() {
                let message = error.to_string();
                self.voices.say(&Notice::Problem { message });
            }
            // NaN, before a step was timed, becomes one step.
            let patient = (PATIENCE.as_secs_f64() / self.step_seconds).max(1.0) as u64;
            let before = self.run.simulation().step();
            let chunk = Instant::now();
            if let Err(error) = self.run.advance_at_most(patient.min(most - done)) {
                self.ended = true;
                self.playing = false;
                let message = error.to_string();
                self.voices.say(&Notice::Problem { message });
            }
            let steps = self.run.simulation().step() - before;
            done += steps;
            let seconds = chunk.elapsed().as_secs_f64() / steps.max(1) as f64;
            self.step_seconds = if self.step_seconds.is_nan() {
                seconds
            } else {
                0.9 * self.step_seconds + 0.1 * seconds
            };
            self.mark_now_and_then();
        }
        if self
            .seeking
            .is_some_and(|target| self.run.simulation().step() >= target)
        {
            self.seeking = None;
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
        self.due += speed * steps_per_period * FRAME.as_secs_f64();
        let whole = self.due.floor();
        self.due -= whole;
        whole as u64
    }

    fn seek(&mut self, period: f64) {
        self.playing = false;
        let time_step = self.run.configuration().run.time_step;
        let mut target = (period * self.unit_period() / time_step).round() as u64;
        if target < self.run.simulation().step() {
            let known = self
                .marks
                .partition_point(|mark| mark.simulation().step() <= target);
            let index = known.saturating_sub(1);
            self.marks.truncate(index + 1);
            let mark = self.marks[index].clone();
            let reached = mark.simulation().step();
            target = target.max(reached);
            // A course that was steered later, and of which no state is left, is not taken again.
            if let Some(&steered) = self.steered.iter().find(|&&step| step > reached) {
                target = target.min(steered);
            }
            self.steered.retain(|&step| step <= reached);
            self.run = mark;
            self.ended = false;
            self.epoch += 1;
            self.due = 0.0;
            for (_, wanted) in &mut self.wanted {
                *wanted = None;
            }
        }
        self.seeking = Some(target);
    }

    fn mark_now_and_then(&mut self) {
        let step = self.run.simulation().step();
        let last = self.marks.last().map_or(0, |it| it.simulation().step());
        let first = self.marks.first().map_or(0, |it| it.simulation().step());
        // The more there is behind, the further apart.
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
            // The one whose neighbours are nearest to each other is missed least.
            let gaps = self.marks.windows(3).map(|it| step(&it[2]) - step(&it[0]));
            if let Some((index, _)) = gaps.enumerate().min_by_key(|(_, gap)| *gap) {
                self.marks.remove(index + 1);
            }
        }
    }

    fn save(&self) -> Result<(), RunError> {
        let mut configuration = self.run.configuration().clone();
        // So that there is something to go on with.
        let taken = self.run.recorder().samples().len() as u64;
        let more = 10 * u64::from(configuration.observe.samples_per_period);
        configuration.run.samples = configuration.run.samples.max(taken + more);
        let Labels { saves, title, .. } = &self.labels;
        let mut folders = (1..=SAVES).map(|number| saves.join(format!("{title}-{number}")));
        let Some(path) = folders.find(|path| path.symlink_metadata().is_err()) else {
            return Err(RunError::Folder {
                folder: saves.clone(),
                source: std::io::ErrorKind::AlreadyExists.into(),
            });
        };
        let folder = RunFolder::create(&path, &configuration)?;
        folder.save_state(&self.run)?;
        self.voices.say(&Notice::Saved {
            folder: path.display().to_string(),
            command: format!("peristalsis run --resume {}", path.display()),
            toml: configuration.to_toml(),
            period: self.clock(),
        });
        Ok(())
    }

    fn course(&self) -> Course<'_> {
        Course(self.run.configuration())
    }

    fn unit_period(&self) -> f64 {
        self.course().unit_period()
    }

    fn clock(&self) -> f64 {
        self.course().clock(self.run.simulation().time())
    }

    /// Rows of the time series from a number on.
    fn rows(&self, from: usize) -> impl Iterator<Item = Row> {
        let samples = self.run.recorder().samples().iter().enumerate().skip(from);
        let course = self.course();
        samples.map(move |(number, sample)| course.row_of(number, sample))
    }

    fn publish(&self) {
        let simulation = self.run.simulation();
        let (bodies, wall) = (simulation.bodies(), simulation.wall());
        let samples = self.run.recorder().samples();
        let prescribed = bodies.number() == bodies.grains;
        let head = Head {
            number: None,
            epoch: self.epoch,
            playing: self.playing,
            ended: self.ended,
            speed: self.speed,
            pace: self.run.configuration().run.time_step / (self.step_seconds * self.unit_period()),
            step: simulation.step(),
            time: simulation.time(),
            clock: self.clock(),
            period: wall.cycles(),
            wave_speed: wall.frequency(simulation.time()) * wall.lattice().wavelength,
            grains: bodies.grains,
            wall_spheres: bodies.number() - bodies.grains,
            rings: if prescribed {
                wall.lattice().rings_per_wave as usize
            } else {
                0
            },
            turning: self.run.configuration().contact.friction.is_some(),
            driven: Driven::of(&self.run),
            rows: self.rows(samples.len().saturating_sub(ROWS)).collect(),
            sample: samples.last().map(Into::into),
        };
        let frame = of_run(&head, &self.run);
        self.voices.frames.send_replace(Arc::new(frame));
    }
}
