//! A run in progress.

mod mark;
mod steering;

use std::path::Path;
use std::time::Duration;

use peristalsis_configuration::Configuration;
use peristalsis_engine::initial::PackingReport;
use peristalsis_engine::{EngineError, Instructions, Simulation, Snapshot, SnapshotView};
use peristalsis_formats::FormatError;
use peristalsis_formats::checkpoint::{self, CheckpointIdentity};
use peristalsis_observe::Orientations;

use crate::assemble::{PlacedGrains, assemble, parameters, place, walls};
use crate::recorder::Recorder;
use crate::stopping::Stopping;
use crate::stopwatch::Stopwatch;
use crate::{PHYSICS_VERSION, RunError};

pub use self::mark::Mark;

/// Layout of [`RunState`] as a checkpoint holds it: raised whenever a field of it changes.
const STATE_LAYOUT: u32 = 19;
/// Steps between two updates of the orientations of grains. A contact takes tens of steps.
const STEPS_PER_TURN: u64 = 10;

/// A simulation together with what has been measured of it.
#[derive(Clone, Debug)]
pub struct Run {
    configuration: Configuration,
    simulation: Simulation,
    packing: PackingReport,
    recorder: Recorder,
    /// How the grains have turned, where a trajectory asks for it.
    orientations: Option<Orientations>,
    stopping: Option<Stopping>,
    /// Whether [`Run::drive_to`] has led the drive.
    steered: bool,
    /// Time spent in the engine and its observables, earlier parts of the run included.
    elapsed: Duration,
}

/// Everything that a run needs to go on with the same bits.
#[derive(Clone, Debug, serde::Deserialize)]
struct RunState {
    snapshot: Snapshot,
    packing: PackingReport,
    recorder: Recorder,
    orientations: Option<Orientations>,
    elapsed: Duration,
}

/// A [`RunState`] to be written down, which borrows from its run.
#[derive(Clone, Debug, serde::Serialize)]
struct RunStateView<'a> {
    snapshot: SnapshotView<'a>,
    packing: PackingReport,
    recorder: &'a Recorder,
    orientations: &'a Option<Orientations>,
    elapsed: Duration,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples taken.
    pub samples: u64,
    /// Samples of the whole run.
    pub samples_total: u64,
    /// Time since the start \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run.
    pub period: f64,
    /// J/Jmax of the last whole period, or of the last sample before there is one.
    pub flow_rate_ratio: f64,
    /// Time of the transition \[t\].
    pub transition_time: Option<f64>,
    /// Time spent.
    pub elapsed: Duration,
}

impl Progress {
    /// Part of the run that is done, from 0 to 1.
    pub fn part(&self) -> f64 {
        self.samples as f64 / self.samples_total.max(1) as f64
    }
}

impl Run {
    /// Packs the grains.
    ///
    /// # Errors
    /// [`RunError::Engine`] where they do not fit.
    pub fn new(configuration: Configuration) -> Result<Self, RunError> {
        Self::new_unless(configuration, &|| false)
    }

    /// As [`Run::new`], but `stop` is asked often whether to stop.
    ///
    /// # Errors
    /// As [`Run::new`]; [`EngineError::Stopped`] where it was asked to stop.
    pub fn new_unless(
        configuration: Configuration,
        stop: &dyn Fn() -> bool,
    ) -> Result<Self, RunError> {
        let (simulation, packing) = assemble(&configuration, stop)?;
        Ok(Self::beginning(configuration, simulation, packing))
    }

    /// A run of grains that stand where they are put.
    ///
    /// # Errors
    /// [`RunError::Placement`] where they cannot stand so.
    pub fn placed(configuration: Configuration, grains: PlacedGrains) -> Result<Self, RunError> {
        let simulation = place(&configuration, grains)?;
        Ok(Self::beginning(
            configuration,
            simulation,
            PackingReport::default(),
        ))
    }

    fn beginning(
        configuration: Configuration,
        simulation: Simulation,
        packing: PackingReport,
    ) -> Self {
        let recorder = Recorder::new(&configuration, &simulation);
        Self {
            configuration,
            simulation,
            packing,
            recorder,
            orientations: None,
            stopping: None,
            steered: false,
            elapsed: Duration::ZERO,
        }
    }

    /// Goes on from a state of the same configuration.
    fn resume(configuration: Configuration, state: RunState) -> Result<Self, RunError> {
        let (wall, parameters) = (walls(&configuration), parameters(&configuration));
        let simulation = Simulation::restore(state.snapshot, wall, parameters)?;
        let grains = simulation.bodies().grains;
        let turning = state.orientations.as_ref();
        if !state.recorder.fits(&configuration, &simulation)
            || turning.is_some_and(|orientations| !orientations.fit(grains))
        {
            return Err(mismatch());
        }
        Ok(Self {
            configuration,
            simulation,
            packing: state.packing,
            recorder: state.recorder,
            orientations: state.orientations,
            stopping: None,
            steered: false,
            elapsed: state.elapsed,
        })
    }

    /// Goes on, with the same bits, from what [`Run::to_snapshot`] or [`Run::write_checkpoint`] wrote.
    ///
    /// # Errors
    /// [`RunError::Format`] where the bytes are damaged, something else or of another version of the physics;
    /// [`RunError::Engine`] where the state does not fit its configuration.
    pub fn from_snapshot(bytes: &[u8]) -> Result<Self, RunError> {
        let identity = identity(checkpoint::physics_hash(bytes)?);
        let (text, state): (String, RunState) = checkpoint::decode(&identity, bytes)?;
        let configuration = Configuration::from_toml("snapshot", &text)?;
        require(&configuration, identity.physics_hash)?;
        Self::resume(configuration, state)
    }

    /// This run under a configuration of the same physics, which may have another length or late part.
    ///
    /// # Errors
    /// [`RunError::Format`] where the configuration is of other physics; [`RunError::Engine`] where what was measured does
    /// not fit it; [`RunError::TooShort`] where the run has gone further than it asks for.
    pub fn under(mut self, configuration: Configuration) -> Result<Self, RunError> {
        require(&configuration, self.configuration.physics_hash())?;
        if !self.recorder.fits(&configuration, &self.simulation) {
            return Err(mismatch());
        }
        let (step, steps) = (self.simulation.step(), configuration.run.steps());
        if step > steps && configuration.run.samples != self.configuration.run.samples {
            let in_time = (configuration.run.duration, "t");
            let (asked, unit) = configuration
                .run
                .periods
                .map_or(in_time, |it| (it, "periods"));
            let done = asked * step as f64 / steps as f64;
            return Err(RunError::TooShort { done, asked, unit });
        }
        self.configuration = configuration;
        Ok(self)
    }

    /// Configuration, state and measurements in one piece, from which [`Run::from_snapshot`] goes on anywhere.
    ///
    /// # Errors
    /// [`RunError::Format`] where the state is too large.
    pub fn to_snapshot(&self) -> Result<Vec<u8>, RunError> {
        let identity = identity(self.configuration.physics_hash());
        let whole = (self.configuration.to_toml(), self.state_view());
        Ok(checkpoint::encode(&identity, &whole)?)
    }

    /// Writes what [`Run::to_snapshot`] gives to a file, whole or not at all.
    ///
    /// # Errors
    /// [`RunError::Format`] where it is too large or cannot be written; an older file stays.
    pub fn write_checkpoint(&self, path: &Path) -> Result<(), RunError> {
        let identity = identity(self.configuration.physics_hash());
        let whole = (self.configuration.to_toml(), self.state_view());
        Ok(checkpoint::write(path, &identity, &whole)?)
    }

    /// Lets the run end before its time. The rule is no part of the state: give it again after a restart.
    pub fn stop_when(&mut self, stopping: Stopping) {
        self.stopping = Some(stopping);
    }

    /// The state, to be written down at once.
    fn state_view(&self) -> RunStateView<'_> {
        RunStateView {
            snapshot: self.simulation.snapshot_view(),
            packing: self.packing,
            recorder: &self.recorder,
            orientations: &self.orientations,
            elapsed: self.elapsed,
        }
    }

    /// Computes with the given instructions and threads from now on; neither changes a bit of the results.
    ///
    /// # Errors
    /// [`RunError::Engine`] where the system gives no more threads.
    pub fn compute_with(
        &mut self,
        instructions: Instructions,
        threads: usize,
    ) -> Result<(), RunError> {
        Ok(self.simulation.compute_with(instructions, threads)?)
    }

    /// Computes with the widest instructions and as many threads as pay on `processors` processors, from now on.
    ///
    /// # Errors
    /// [`RunError::Engine`] where the system gives no more threads.
    pub fn compute_with_threads_that_pay(&mut self, processors: usize) -> Result<(), RunError> {
        let threads = self.simulation.threads_that_pay(processors);
        self.compute_with(Instructions::widest(), threads)
    }

    /// Follows how the grains turn from now on, where there is friction to turn them.
    pub fn follow_orientations(&mut self) {
        if self.orientations.is_none() && self.configuration.contact.friction.is_some() {
            self.orientations = Some(Orientations::new(&self.simulation));
        }
    }

    /// How the grains have turned since [`Run::follow_orientations`].
    pub fn orientations(&self) -> Option<&Orientations> {
        self.orientations.as_ref()
    }

    /// Advances to the next sample and takes it.
    ///
    /// # Errors
    /// [`RunError::Engine`] where the simulation diverged; what was measured before stays.
    pub fn advance(&mut self) -> Result<(), RunError> {
        self.advance_at_most(u64::MAX)
    }

    /// Advances to the next sample and takes it, or only by `most` steps, at least one, where it is further away.
    ///
    /// # Errors
    /// As [`Run::advance`].
    pub fn advance_at_most(&mut self, most: u64) -> Result<(), RunError> {
        let start = Stopwatch::begin();
        self.last_to_next_sample();
        // A run that was stopped between two samples, where a trajectory has a frame, goes on to the next.
        let each = self.configuration.run.steps_per_sample;
        let to_sample = each - self.simulation.step() % each;
        let outcome = self.advance_engine(most.clamp(1, to_sample));
        if outcome.is_ok() && self.simulation.step().is_multiple_of(each) {
            self.recorder.record(&self.simulation);
        }
        self.elapsed += start.elapsed();
        Ok(outcome?)
    }

    fn advance_engine(&mut self, steps: u64) -> Result<(), EngineError> {
        let Some(orientations) = &mut self.orientations else {
            return self.simulation.advance(steps);
        };
        let mut left = steps;
        while left > 0 {
            let now = left.min(STEPS_PER_TURN);
            self.simulation.advance(now)?;
            orientations.follow(&self.simulation);
            left -= now;
        }
        Ok(())
    }

    /// Whether all samples have been taken, or the run may end before.
    pub fn is_complete(&self) -> bool {
        self.recorder.taken() >= self.configuration.run.samples || self.is_settled()
    }

    /// Whether the course of the drive is its user's: led by [`Run::drive_to`], or taken beyond the configured end.
    pub(crate) fn is_steered(&self) -> bool {
        self.steered || self.recorder.taken() > self.configuration.run.samples
    }

    /// Whether the run may end since its transition has been found and has settled.
    pub fn is_settled(&self) -> bool {
        self.stopping
            .is_some_and(|stopping| stopping.is_settled(&self.recorder))
    }

    /// Fraction of the measurements, at their end, over which late means are taken: as configured; in a run that
    /// [has settled](Self::is_settled) the second half of its settling periods.
    pub fn late_fraction(&self) -> f64 {
        match self.stopping {
            Some(stopping) if self.is_settled() => stopping.late_fraction(&self.recorder),
            _ => self.configuration.observe.late_fraction,
        }
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        let samples = self.recorder.samples();
        let last_sample = samples.last().map_or(f64::NAN, |it| it.flow_rate_ratio);
        let last_average = self.recorder.averages().last().copied();
        Progress {
            samples: self.recorder.taken(),
            samples_total: self.configuration.run.samples,
            time: self.simulation.time(),
            period: self.simulation.wall().cycles(),
            flow_rate_ratio: last_average.unwrap_or(last_sample),
            transition_time: self.recorder.transition_time(),
            elapsed: self.elapsed,
        }
    }

    /// The configuration; of a run that was steered, with the course that it has taken.
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The record of measurements.
    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    /// How the grains were packed.
    pub fn packing(&self) -> &PackingReport {
        &self.packing
    }

    /// Time spent.
    pub fn elapsed(&self) -> Duration {
        self.elapsed
    }
}

/// Header of the checkpoint of a run.
fn identity(physics_hash: [u8; 32]) -> CheckpointIdentity {
    CheckpointIdentity {
        kind: *b"run     ",
        layout_version: STATE_LAYOUT,
        physics_version: PHYSICS_VERSION,
        physics_hash,
    }
}

/// That a configuration is of the physics that a state was found in.
fn require(configuration: &Configuration, found: [u8; 32]) -> Result<(), RunError> {
    let expected = configuration.physics_hash();
    match found == expected {
        true => Ok(()),
        false => Err(FormatError::OtherPhysics { found, expected }.into()),
    }
}

fn mismatch() -> RunError {
    let reason = "what was measured is not of so many steps, grains or waves".to_owned();
    EngineError::SnapshotMismatch { reason }.into()
}
