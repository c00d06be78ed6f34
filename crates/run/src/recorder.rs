//! The measurements of a run so far.

use peristalsis_analysis::{Direction, Transition, TransitionDetector};
use peristalsis_configuration::{Configuration, InitialState};
use peristalsis_engine::Simulation;
use peristalsis_observe::{
    AxialDispersion, Observer, Sample, View, WallFault, WaveByWave, WaveFlow, WaveFrameProfile,
    note_wall_faults,
};

/// Thresholds of J/Jmax at which every run notes its transition besides the configured one: which of them lies midway
/// between the branches of the flow is known only when many runs have ended.
pub const THRESHOLDS: [f64; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

/// Samples, period averages, the search for the transition, the profile in the wave's frame and the flow of each wave.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Recorder {
    observer: Observer,
    samples: Vec<Sample>,
    samples_per_period: u64,
    /// J/Jmax of each whole period.
    averages: Vec<f64>,
    detector: Option<TransitionDetector>,
    /// A search at each of [`THRESHOLDS`]; none where there is no ratio of flow rates to watch.
    ladder: Vec<TransitionDetector>,
    profile: WaveFrameProfile,
    /// Samples from one look at the forces of the wall to the next.
    wall_interval: u64,
    waves: WaveByWave,
    dispersion: AxialDispersion,
    wall_faults: Vec<WallFault>,
}

/// The measurements that grow with a run: samples, averages of periods, flows of waves.
pub(crate) struct Series(Vec<Sample>, Vec<f64>, Vec<WaveFlow>);

/// How long they are.
pub(crate) type Lengths = [usize; 3];

impl Series {
    pub(crate) fn lengths(&self) -> Lengths {
        [self.0.len(), self.1.len(), self.2.len()]
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
        let detector_at = |threshold: f64| {
            let (start, direction) = start_and_direction(configuration.initial.state, threshold);
            let detector = TransitionDetector::new(direction, threshold, period?);
            let detector =
                detector.expect("a validated configuration has a finite threshold and period");
            Some(detector.starting_at(start))
        };
        let bins = configuration.observe.profile_bins as usize;
        let observer = Observer::new(simulation);
        Self {
            dispersion: AxialDispersion::new(&observer),
            observer,
            samples: Vec::new(),
            samples_per_period,
            averages: Vec::new(),
            detector: detector_at(configuration.observe.transition_threshold),
            ladder: THRESHOLDS.into_iter().filter_map(detector_at).collect(),
            profile: WaveFrameProfile::new(bins, samples_per_period),
            wall_interval: wall_interval(configuration.run.steps_per_sample, samples_per_period),
            waves: WaveByWave::new(simulation, samples_per_period),
            wall_faults: Vec::new(),
        }
    }

    /// Whether this can be what was measured of a simulation up to its step: what a state holds besides spheres.
    pub(crate) fn fits(&self, configuration: &Configuration, simulation: &Simulation) -> bool {
        let grains = simulation.bodies().grains;
        let samples = self.samples.len() as u64;
        let samples_per_period = u64::from(configuration.observe.samples_per_period);
        let each = configuration.run.steps_per_sample;
        let waves = simulation.wall().waves() as usize;
        let bins = configuration.observe.profile_bins as usize;
        self.samples_per_period == samples_per_period
            && self.wall_interval == wall_interval(each, samples_per_period)
            // A run that diverged may have come to the end of an interval, and taken no sample there.
            && (samples..=samples + 1).contains(&(simulation.step() / each))
            && self.averages.len() as u64 == samples / samples_per_period
            && self.ladder.len() <= THRESHOLDS.len()
            && self.observer.fits(grains)
            && self.dispersion.fits(grains)
            && self.waves.fits(waves, samples_per_period)
            && self.profile.fits(bins, samples_per_period)
    }

    /// Takes a sample of the simulation.
    pub(crate) fn record(&mut self, simulation: &Simulation) {
        let view = View::of(simulation);
        let before = self.observer.end_interval(&view);
        self.samples
            .push(Sample::of(&before, &self.observer, &view));
        self.waves.add(&before, &self.observer, &view);
        self.profile.add(&view);
        if (self.samples.len() as u64).is_multiple_of(self.wall_interval) {
            self.profile.add_wall_forces(simulation);
        }
        note_wall_faults(simulation, &mut self.wall_faults);
        if (self.samples.len() as u64).is_multiple_of(self.samples_per_period) {
            let first = self.samples.len() - self.samples_per_period as usize;
            let ratios = self.samples[first..].iter().map(|it| it.flow_rate_ratio);
            let average = ratios.sum::<f64>() / self.samples_per_period as f64;
            self.averages.push(average);
            self.dispersion.end_period(&self.observer, &view);
            // Without grains inside there is no ratio, and the search ends.
            if !average.is_finite() || self.push(average).is_none() {
                self.detector = None;
                self.ladder.clear();
            }
        }
    }

    fn push(&mut self, average: f64) -> Option<()> {
        for detector in &mut self.ladder {
            detector.push(average).ok()?;
        }
        self.detector.as_mut()?.push(average).ok().map(|_| ())
    }

    /// Takes the series out, until they are given back.
    pub(crate) fn take_series(&mut self) -> Series {
        let (samples, averages) = (&mut self.samples, &mut self.averages);
        let (samples, averages) = (std::mem::take(samples), std::mem::take(averages));
        Series(samples, averages, self.waves.replace_flows(Vec::new()))
    }

    /// Gives the series back.
    pub(crate) fn give_series(&mut self, Series(samples, averages, flows): Series) {
        (self.samples, self.averages) = (samples, averages);
        self.waves.replace_flows(flows);
    }

    /// The samples so far.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// J/Jmax averaged over each whole period so far.
    pub fn averages(&self) -> &[f64] {
        &self.averages
    }

    /// The profile in the wave's frame.
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

    /// What went wrong with an elastic wall, the first of each kind.
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

    /// Time of the transition \[t\] at each of [`THRESHOLDS`], where it has been found.
    pub fn transition_times(&self) -> [Option<f64>; THRESHOLDS.len()] {
        core::array::from_fn(|place| self.ladder.get(place)?.outcome().observed())
    }

    /// The samples of the last part of what was measured, at least one.
    pub fn late(&self, fraction: f64) -> &[Sample] {
        let number = self.samples.len();
        let taken = ((number as f64 * fraction).round() as usize).clamp(1.min(number), number);
        &self.samples[number - taken..]
    }
}

/// J/Jmax at the start, and the way from there to a threshold: upward from rest, downward from jammed flow, but downward
/// to back flow from either, and upward to more than jammed flow.
fn start_and_direction(state: InitialState, threshold: f64) -> (f64, Direction) {
    match state {
        InitialState::Rest | InitialState::Placed if threshold < 0.0 => (0.0, Direction::Downward),
        InitialState::Rest | InitialState::Placed => (0.0, Direction::Upward),
        InitialState::Jammed if threshold > 1.0 => (1.0, Direction::Upward),
        InitialState::Jammed => (1.0, Direction::Downward),
    }
}

/// Steps from one look at the forces of the wall to the next, at least: a look takes as long as some steps.
const STEPS_BETWEEN_LOOKS: u64 = 100;

/// Samples from one look at the forces of the wall to the next: prime to those of a period, so that all phases between
/// wave and lattice have their turn.
fn wall_interval(steps_per_sample: u64, samples_per_period: u64) -> u64 {
    let least = STEPS_BETWEEN_LOOKS.div_ceil(steps_per_sample.max(1));
    (least..)
        .find(|&interval| greatest_common_divisor(interval, samples_per_period) == 1)
        .unwrap_or(least)
}

fn greatest_common_divisor(mut one: u64, mut other: u64) -> u64 {
    while other > 0 {
        (one, other) = (other, one % other);
    }
    one
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_at_the_wall_are_rare_and_meet_every_phase() {
        assert_eq!(wall_interval(20, 20), 7);
        assert_eq!(wall_interval(10, 20), 11);
        assert_eq!(wall_interval(250, 20), 1);
        assert_eq!(wall_interval(100, 1), 1);
        assert_eq!(wall_interval(1, 30), 101);
    }
}
