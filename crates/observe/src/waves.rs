//! Flow wave by wave: how the grains that travel with each wave of the tube flow, period after period.

use peristalsis_engine::Simulation;

use crate::sample::{Observer, waves_passed};
use crate::series::{Join, Series, joined};
use crate::view::{View, floor};

/// The grains in one wave over one period.
///
/// A wave is the stretch from one throat to the next and moves with the throats; grains come and go through them.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WaveFlow {
    /// End of the period \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run by then.
    pub period: f64,
    /// Number of the wave, ascending along the wave from 0: the one whose rear throat is the first at z >= 0 at t = 0.
    pub wave: u32,
    /// Mean number of grains inside it.
    pub grains: f64,
    /// J of these grains along the wave, sum of dz/dt over lambda \[1/t\].
    pub flow_rate: f64,
    /// J/Jmax, Jmax = (grains) c/lambda; NaN for a static wave or without grains.
    pub flow_rate_ratio: f64,
}

/// The flow of periods that follow each other.
impl Join for WaveFlow {
    fn join(&mut self, own: u64, next: &Self, others: u64) {
        let grains = joined(self.grains, own, next.grains, others);
        let carried = |flow: &Self| match flow.grains > 0.0 {
            true => flow.grains * flow.flow_rate_ratio,
            false => 0.0,
        };
        *self = Self {
            grains,
            flow_rate: joined(self.flow_rate, own, next.flow_rate, others),
            flow_rate_ratio: joined(carried(self), own, carried(next), others) / grains,
            ..*next
        };
    }
}

/// Sums over the samples of the period that is under way.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Sums {
    /// Grains times samples.
    grains: f64,
    /// Displacements along the wave \[d\].
    moved: f64,
    /// Grains times the displacement of the wave \[d\].
    carried: f64,
}

/// Adds up the flow of each wave; a grain counts for the wave that it is in half way through an interval between samples.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WaveByWave {
    samples_per_period: u64,
    samples: u64,
    duration: f64,
    sums: Vec<Sums>,
    flows: Series<WaveFlow>,
}

impl WaveByWave {
    /// Begins a period of `samples_per_period` samples.
    pub fn new(simulation: &Simulation, samples_per_period: u64) -> Self {
        let waves = simulation.wall().waves() as usize;
        Self {
            samples_per_period: samples_per_period.max(1),
            samples: 0,
            duration: 0.0,
            sums: vec![Sums::default(); waves],
            flows: Series::new(waves),
        }
    }

    /// Whether it is of `waves` waves, with `samples_per_period` samples.
    pub fn fits(&self, waves: usize, samples_per_period: u64) -> bool {
        self.sums.len() == waves
            && self.samples_per_period == samples_per_period.max(1)
            && self.samples < self.samples_per_period
            && self.flows.fits(waves)
    }

    /// Adds the interval between two states of the observer, seen from its end.
    pub fn add(&mut self, before: &Observer, after: &Observer, view: &View<'_>) {
        let wall = view.simulation.wall();
        let (heading, throat) = (wall.heading(), wall.throat());
        let wavelength = wall.wavelength();
        let waves = self.sums.len();
        let half_way = 0.5 * (before.cycles + after.cycles) + throat;
        let wave_run = waves_passed(before.cycles, after.cycles) * wavelength;
        let grains = before.unfolded.iter().zip(&after.unfolded);
        let ends = view.simulation.ends();
        for (grain, ((start, end), &inside)) in grains.zip(&view.inside).enumerate() {
            if !inside {
                continue;
            }
            // Where it is in the tube, whatever it has travelled.
            let carried = ends.map_or(0.0, |ends| ends.carried(grain));
            let along = (0.5 * heading * (start + end) + heading * carried) / wavelength - half_way;
            let wave = (floor(along) as i64).rem_euclid(waves as i64);
            let sums = &mut self.sums[wave as usize];
            sums.grains += 1.0;
            sums.moved += heading * (end - start);
            sums.carried += wave_run;
        }
        self.samples += 1;
        self.duration += after.time - before.time;
        if self.samples == self.samples_per_period {
            self.end_period(after, wavelength);
        }
    }

    fn end_period(&mut self, now: &Observer, wavelength: f64) {
        let samples = self.samples as f64;
        let duration = self.duration;
        let flows = self.sums.iter().enumerate().map(|(wave, sums)| WaveFlow {
            time: now.time,
            period: now.cycles,
            wave: wave as u32,
            grains: sums.grains / samples,
            flow_rate: sums.moved / (wavelength * duration),
            flow_rate_ratio: if sums.carried > 0.0 {
                sums.moved / sums.carried
            } else {
                f64::NAN
            },
        });
        self.flows.push(flows);
        self.sums.fill(Sums::default());
        (self.samples, self.duration) = (0, 0.0);
    }

    /// The series of flows, to be taken out and given back.
    pub fn series(&mut self) -> &mut Series<WaveFlow> {
        &mut self.flows
    }

    /// Every wave of every whole period so far, period by period.
    pub fn flows(&self) -> &[WaveFlow] {
        self.flows.rows()
    }
}
