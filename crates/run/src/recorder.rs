//! The measurements of a run so far.

use peristalsis_analysis::{Direction, Transition, TransitionDetector};
use peristalsis_configuration::{Configuration, InitialState};
use peristalsis_engine::Simulation;
use peristalsis_observe::{
    AxialDispersion, ContactForces, Observer, Sample, Series, View, WallFault, WaveByWave,
    WaveFlow, WaveFrameProfile, note_wall_faults,
};

/// Thresholds of J/Jmax at which every run notes its transition, besides the configured one. Which of them lies midway
/// between the branches of the flow is known only after many runs.
pub const THRESHOLDS: [f64; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

/// Samples, period averages, the search for the transition, the profile in the wave frame and the flow of each wave.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Recorder {
    observer: Observer,
    samples: Series<Sample>,
    samples_per_period: u64,
    /// Sum of J/Jmax over the samples of the period that is under way.
    ratios: f64,
    /// J/Jmax of each whole period.
    averages: Series<f64>,
    /// Most grains outside at any sample.
    escaped_most: f64,
    detector: Option<TransitionDetector>,
    /// A search at each of [`THRESHOLDS`]; none where there is no ratio of flow rates to watch.
    ladder: Vec<TransitionDetector>,
    profile: WaveFrameProfile,
    /// Samples from one look at the forces of the wall to the next.
    wall_interval: u64,
    waves: WaveByWave,
    dispersion: AxialDispersion,
    contact_forces: ContactForces,
    wall_faults: Vec<WallFault>,
}

/// The measurements that grow with a run: samples, averages of periods, flows of waves.
pub(crate) struct Measured(Series<Sample>, Series<f64>, Series<WaveFlow>);

/// How many they are.
pub(crate) type Lengths = [u64; 3];

impl Measured {
    pub(crate) fn lengths(&self) -> Lengths {
        [self.0.count(), self.1.count(), self.2.count()]
    }

    pub(crate) fn truncate(&mut self, [samples, averages, flows]: Lengths) {
        self.0.truncate(samples);
        self.1.truncate(averages);
        self.2.truncate(flows);
    }
}

impl Recorder {
    /// Begins with a simulation at time 0.
    pub(crate) fn new(configuration: &Configuration, simulation: &Simulation) -> Self {
        let samples_per_period = u64::from(configuration.observe.samples_per_period);
        let has_grains = configuration.grains.number > 0;
        let period = configuration.drive.period().filter(|_| has_grains);
        let start = initial_ratio(configuration, simulation);
        let detector_at = |threshold: f64| {
            let direction = direction(start, threshold);
            let detector = TransitionDetector::new(direction, threshold, period?);
            let detector =
                detector.expect("a validated configuration has a finite threshold and period");
            Some(detector.starting_at(start))
        };
        let bins = configuration.observe.profile_bins as usize;
        let observer = Observer::new(simulation);
        Self {
            dispersion: AxialDispersion::new(&observer),
            contact_forces: ContactForces::default(),
            observer,
            samples: Series::new(1),
            samples_per_period,
            ratios: -0.0,
            averages: Series::new(1),
            escaped_most: 0.0,
            detector: detector_at(configuration.observe.transition_threshold),
            ladder: THRESHOLDS.into_iter().filter_map(detector_at).collect(),
            profile: WaveFrameProfile::new(bins, samples_per_period),
            wall_interval: samples_between(
                STEPS_BETWEEN_LOOKS,
                configuration.run.steps_per_sample,
                samples_per_period,
            ),
            waves: WaveByWave::new(simulation, samples_per_period),
            wall_faults: Vec::new(),
        }
    }

    /// Whether this can be what was measured of a simulation up to its step: what a state holds besides spheres.
    pub(crate) fn fits(&self, configuration: &Configuration, simulation: &Simulation) -> bool {
        let grains = simulation.bodies().grains;
        let samples = self.samples.count();
        let samples_per_period = u64::from(configuration.observe.samples_per_period);
        let each = configuration.run.steps_per_sample;
        let waves = simulation.wall().waves() as usize;
        let bins = configuration.observe.profile_bins as usize;
        self.samples_per_period == samples_per_period
            && self.wall_interval == samples_between(STEPS_BETWEEN_LOOKS, each, samples_per_period)
            // A run that diverged has taken no sample since, however often it was tried again.
            && samples <= simulation.step() / each
            && self.averages.count() == samples / samples_per_period
            && self.samples.fits(1)
            && self.averages.fits(1)
            && self.ladder.len() <= THRESHOLDS.len()
            && self.observer.fits(grains)
            && self.dispersion.fits(grains)
            && self.contact_forces.fits()
            && self.waves.fits(waves, samples_per_period)
            && self.profile.fits(bins, samples_per_period, samples)
    }

    /// Takes a sample of the simulation.
    pub(crate) fn record(&mut self, simulation: &Simulation) {
        // Samples are each of so many steps, and this is the next.
        let each = simulation.step() / (self.samples.count() + 1);
        let apart = samples_between(STEPS_BETWEEN_CONTACTS, each, self.samples_per_period);
        self.contact_forces.look(simulation, apart * each);
        let view = View::of(simulation);
        let before = self.observer.end_interval(&view);
        let ends_period = (self.samples.count() + 1).is_multiple_of(self.samples_per_period);
        if ends_period {
            self.observer.end_period(&view);
        }
        let sample = Sample::of(&before, &self.observer, &view);
        self.ratios += sample.flow_rate_ratio;
        self.escaped_most = self.escaped_most.max(sample.escaped);
        self.samples.push([sample]);
        self.waves.add(&before, &self.observer, &view);
        self.profile.add(&view);
        if self.samples.count().is_multiple_of(self.wall_interval) {
            self.profile.add_wall_forces(simulation);
        }
        note_wall_faults(simulation, &mut self.wall_faults);
        if ends_period {
            let average = self.ratios / self.samples_per_period as f64;
            // What is added to it keeps its sign, even 0.
            self.ratios = -0.0;
            self.averages.push([average]);
            self.dispersion.end_period(&self.observer, &view);
            self.search(average);
        }
    }

    /// Looks for transitions in the average of one more period; there is none without grains inside, or where the wave stands.
    fn search(&mut self, average: f64) {
        for detector in self.ladder.iter_mut().chain(&mut self.detector) {
            if detector.push(average).is_err() {
                detector.skip();
            }
        }
    }

    /// Takes the series out, until they are given back.
    pub(crate) fn take_series(&mut self) -> Measured {
        let flows = self.waves.series().take();
        Measured(self.samples.take(), self.averages.take(), flows)
    }

    /// Gives the series back.
    pub(crate) fn give_series(&mut self, Measured(samples, averages, flows): Measured) {
        (self.samples, self.averages) = (samples, averages);
        *self.waves.series() = flows;
    }

    /// The samples so far; in a very long run each covers [several intervals](Self::intervals).
    pub fn samples(&self) -> &[Sample] {
        self.samples.rows()
    }

    /// Samples taken so far.
    pub fn taken(&self) -> u64 {
        self.samples.count()
    }

    /// Intervals that a kept sample covers: 1, or a power of 2 in a run of more than [`MOST_ROWS`](peristalsis_observe::MOST_ROWS)
    /// samples.
    pub fn intervals(&self) -> u64 {
        self.samples.each()
    }

    /// J/Jmax averaged over each whole period so far; in a very long run over several periods each.
    pub fn averages(&self) -> &[f64] {
        self.averages.rows()
    }

    /// Samples that are kept for each of [`averages`](Self::averages).
    pub(crate) fn samples_of_average(&self) -> f64 {
        let each = self.averages.each() * self.samples_per_period;
        each as f64 / self.samples.each() as f64
    }

    /// Whole periods so far.
    pub fn periods(&self) -> u64 {
        self.averages.count()
    }

    /// Averages of the last so many periods.
    pub(crate) fn late_averages(&self, periods: u64) -> &[f64] {
        let (averages, taken) = (self.averages.rows(), periods / self.averages.each());
        &averages[averages.len().saturating_sub(taken as usize)..]
    }

    /// Most grains outside the tube at any sample.
    pub(crate) fn escaped_most(&self) -> f64 {
        self.escaped_most
    }

    /// The profile in the wave frame.
    pub fn profile(&self) -> &WaveFrameProfile {
        &self.profile
    }

    /// The flow of each wave over each whole period, period by period.
    pub fn waves(&self) -> &[WaveFlow] {
        self.waves.flows()
    }

    /// How the grains disperse along the tube.
    pub fn dispersion(&self) -> &AxialDispersion {
        &self.dispersion
    }

    /// The forces at the contacts of the grains.
    pub(crate) fn contact_forces(&self) -> &ContactForces {
        &self.contact_forces
    }

    /// Faults of an elastic wall, the first of each kind.
    pub(crate) fn wall_faults(&self) -> &[WallFault] {
        &self.wall_faults
    }

    /// The transition, or how long none was seen; `None` where there is no ratio of flow rates to watch.
    pub fn transition(&self) -> Option<Transition> {
        Some(self.detector.as_ref()?.outcome())
    }

    /// Time of the transition \[t\], if it has been found.
    pub fn transition_time(&self) -> Option<f64> {
        self.transition()?.observed()
    }

    /// Time up to which a transition is found \[t\]: [`peristalsis_analysis::watched`].
    pub fn watched(&self) -> Option<f64> {
        Some(self.detector.as_ref()?.watched())
    }

    /// Time of the transition \[t\] at each of [`THRESHOLDS`], where it has been found.
    pub fn transition_times(&self) -> [Option<f64>; THRESHOLDS.len()] {
        core::array::from_fn(|place| self.ladder.get(place)?.outcome().observed())
    }

    /// The samples of the last part of what was measured, at least one.
    pub fn late(&self, fraction: f64) -> &[Sample] {
        let samples = self.samples.rows();
        let number = samples.len();
        let taken = ((number as f64 * fraction).round() as usize).clamp(1.min(number), number);
        &samples[number - taken..]
    }
}

/// J/Jmax at the start, <v_z>/c along the wave, with its speed c at the start: 0 at rest, 1 of grains that move with the
/// wave; 0 of none. Where the wave stands at first they are at rest: 0, or 1 of a jammed start.
fn initial_ratio(configuration: &Configuration, simulation: &Simulation) -> f64 {
    let speed = configuration.heading() * configuration.initial_wave_speed();
    let bodies = simulation.bodies();
    let present = (0..bodies.grains).filter(|&grain| simulation.is_present(grain));
    let (sum, number) = present.fold((0.0, 0.0), |(sum, number), grain| {
        (sum + bodies.velocity[grain].z / speed, number + 1.0)
    });
    if speed == 0.0 {
        match configuration.initial.state {
            InitialState::Jammed => 1.0,
            _ => 0.0,
        }
    } else if number > 0.0 {
        sum / number
    } else {
        0.0
    }
}

/// The way from J/Jmax at the start to a threshold. A run that starts at the threshold is watched upward, a jammed one
/// downward.
fn direction(start: f64, threshold: f64) -> Direction {
    // A mean over grains is rounded.
    let is_at = (start - threshold).abs() <= 1e-9;
    match start < threshold || is_at && start < 1.0 {
        true => Direction::Upward,
        false => Direction::Downward,
    }
}

/// Steps from one look at the forces of the wall to the next, at least: a look takes as long as some steps.
const STEPS_BETWEEN_LOOKS: u64 = 100;
/// The same for the forces of all contacts.
const STEPS_BETWEEN_CONTACTS: u64 = 2_000;

/// Samples from one look at forces to the next, at least so many steps: prime to those of a period, so that all phases between
/// wave and lattice have their turn.
fn samples_between(steps: u64, steps_per_sample: u64, samples_per_period: u64) -> u64 {
    let least = steps.div_ceil(steps_per_sample.max(1));
    (least..)
        .find(|&interval| greatest_common_divisor(interval, samples_per_period) == 1)
        .unwrap_or(least)
}

pub(crate) fn greatest_common_divisor(mut one: u64, mut other: u64) -> u64 {
    while other > 0 {
        (one, other) = (other, one % other);
    }
    one
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_at_forces_are_rare_and_meet_every_phase() {
        // A physicist: 100 samples of 20 steps were five periods, and all contacts were seen at one phase.
        assert_eq!(samples_between(STEPS_BETWEEN_CONTACTS, 20, 20), 101);
        assert_eq!(samples_between(STEPS_BETWEEN_LOOKS, 20, 20), 7);
        assert_eq!(samples_between(STEPS_BETWEEN_LOOKS, 10, 20), 11);
        assert_eq!(samples_between(STEPS_BETWEEN_LOOKS, 250, 20), 1);
        assert_eq!(samples_between(STEPS_BETWEEN_LOOKS, 100, 1), 1);
        assert_eq!(samples_between(STEPS_BETWEEN_LOOKS, 1, 30), 101);
    }
    #[test]
    fn a_run_that_starts_at_a_threshold_is_watched_upward() {
        // 0.2 of 0.5 with rounding.
        for start in [0.4, 0.4 + 1e-16, 0.4 - 1e-16, 0.399] {
            assert_eq!(direction(start, 0.4), Direction::Upward, "{start}");
        }
        assert_eq!(direction(0.401, 0.4), Direction::Downward);
        assert_eq!(direction(1.0, 1.0), Direction::Downward);
    }
}
