//! Pumping, residence and dispersion in the late part of a run.

use core::f64::consts::TAU;
use core::ops::Deref;

use peristalsis_analysis::{mean_with_error, variance};
use peristalsis_configuration::{Configuration, ScheduledParameter};
use peristalsis_observe::{
    AxialDispersion, ContactForces, PartOfWave, ProfileBin, Sample, waves_passed,
};

use super::mean_of;
use crate::recorder::{Recorder, greatest_common_divisor};
use crate::run::Run;

/// The late samples of a run, the last of all.
///
/// Where the flow pulses with the wave, a part of a period would count as more or less flow, and the pulse as noise. From one
/// whole late period on they are therefore whole periods, and errors are from the averages of these, of two at least.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Late {
    samples: Vec<Sample>,
    /// Samples whose average counts as one number in errors.
    block: usize,
}

impl Late {
    /// Those of the last part of a record.
    pub(super) fn of(configuration: &Configuration, recorder: &Recorder, fraction: f64) -> Self {
        let samples_per_period = u64::from(configuration.observe.samples_per_period);
        let common = greatest_common_divisor(samples_per_period, recorder.intervals());
        let block = match pulses(configuration) {
            // The fewest samples that make whole periods.
            true => (samples_per_period / common) as usize,
            false => 1,
        };
        let (all, mut late) = (recorder.samples(), recorder.late(fraction));
        if late.len() < block && all.len() >= block {
            // The last whole period at least.
            late = &all[all.len() - block..];
        }
        Self::in_blocks(late, block)
    }

    fn in_blocks(late: &[Sample], block: usize) -> Self {
        let (samples, block) = match late.len() / block {
            // Part of a period.
            0 => (late, late.len().max(1)),
            whole => (&late[late.len() - whole * block..], block),
        };
        Self {
            samples: samples.to_vec(),
            block,
        }
    }

    /// Mean of a number of each sample, and its error.
    pub(super) fn measured(&self, value: impl Fn(&Sample) -> f64) -> (f64, f64) {
        let values: Vec<f64> = self.iter().map(value).collect();
        (super::mean(&values), self.error_of(&values))
    }

    /// Standard error of the mean of a number of each sample.
    pub(super) fn error_of(&self, values: &[f64]) -> f64 {
        let averages: Vec<f64> = values.chunks(self.block).map(super::mean).collect();
        match self.block {
            1 => error_of(averages.into_iter()),
            _ => error_of_few(&averages),
        }
    }

    /// A number of each sample in the first half and in the second, of whole blocks.
    pub(super) fn halves<'a>(&self, values: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        let blocks = values.len() / self.block;
        values.split_at(blocks / 2 * self.block)
    }
}

impl Deref for Late {
    type Target = [Sample];

    fn deref(&self) -> &[Sample] {
        &self.samples
    }
}

/// Whether the mean flow along the tube pulses with the wave: where the wave passes ends, or segments close in turn. A wave
/// that changes its speed has no period.
fn pulses(configuration: &Configuration) -> bool {
    let drive = &configuration.drive;
    let is_steady =
        drive.strain_rate > 0.0 && drive.schedule(ScheduledParameter::StrainRate).is_none();
    is_steady && (configuration.inlet.is_some() || drive.segments.is_some())
}

/// Standard error of the mean of a correlated series from block averages; NaN of a series too short.
pub(super) fn error_of(series: impl Iterator<Item = f64>) -> f64 {
    let series: Vec<f64> = series.collect();
    mean_with_error(&series).map_or(f64::NAN, |estimate| estimate.error)
}

/// The same of averages, of two at least.
pub(super) fn error_of_few(averages: &[f64]) -> f64 {
    match averages.len() {
        number @ 2..4 => (variance(averages) / number as f64).sqrt(),
        _ => error_of(averages.iter().copied()),
    }
}

/// J/Jmax of each late sample, of the grains inside and of all.
///
/// Of a wave that changes its speed, and where a sample has none, it is J over the mean of Jmax = N c/L, with c the mean
/// speed: while the wave hardly moves, J/Jmax can be anything. Flow while it stands counts. NaN where it stands all the time.
/// `length` is L, between the ends of an open tube \[lambda\].
pub(super) fn flow_rate_ratios(
    samples: &[Sample],
    late: &[Sample],
    length: f64,
    changes_speed: bool,
) -> [Vec<f64>; 2] {
    let frequency = frequency(samples, late);
    let has_gap = late.iter().any(|sample| sample.flow_rate_ratio.is_nan());
    if !(changes_speed || has_gap) || frequency <= 0.0 {
        let [inside, raw] = [
            |sample: &Sample| sample.flow_rate_ratio,
            |sample: &Sample| sample.flow_rate_ratio_raw,
        ];
        return [
            late.iter().map(inside).collect(),
            late.iter().map(raw).collect(),
        ];
    }
    let over_mean = |flow: fn(&Sample) -> f64, number: fn(&Sample) -> f64| {
        let most = frequency * mean_of(late, number) / length;
        late.iter().map(|sample| flow(sample) / most).collect()
    };
    [
        over_mean(|sample| sample.flow_rate, |sample| sample.inside),
        over_mean(
            |sample| sample.flow_rate_raw,
            |sample| sample.inside + sample.escaped,
        ),
    ]
}

/// Mean frequency at which waves passed in the time of the late samples \[1/t\].
pub(super) fn frequency(samples: &[Sample], late: &[Sample]) -> f64 {
    let early = &samples[..samples.len() - late.len()];
    let of = |sample: Option<&Sample>| sample.map_or((0.0, 0.0), |it| (it.period, it.time));
    let (before, after) = (of(early.last()), of(late.last()));
    waves_passed(before.0, after.0) / (after.1 - before.1)
}

/// Mean speed of the wave in the late part of a run \[d/t\].
pub(crate) fn late_wave_speed(run: &Run) -> f64 {
    let (configuration, recorder) = (run.configuration(), run.recorder());
    let schedule = configuration.drive.schedule(ScheduledParameter::StrainRate);
    match schedule {
        Some(_) => {
            let late = recorder.late(run.late_fraction());
            frequency(recorder.samples(), late) * configuration.tube.wavelength
        }
        None => configuration.wave_speed(),
    }
}

/// Late mean of what flows against the wave: of -J where J < 0 and else 0, each J over the time of a sample \[1/t\].
pub(super) fn back_flow(late: &Late) -> (f64, f64) {
    late.measured(|sample| (-sample.flow_rate).max(0.0))
}

/// Overlap from which on a grain counts as pressed \[d\]: below a tenth, soft grains pass for solid ones.
const PRESSED: f64 = 0.1;

/// Part of the late samples at which a contact of a grain overlaps by more than a tenth of d.
pub(super) fn pressed(late: &[Sample]) -> f64 {
    let is_pressed = |sample: &&Sample| sample.largest_overlap > PRESSED;
    late.iter().filter(is_pressed).count() as f64 / late.len() as f64
}

/// Pumping against a body force: late means, each power with its error from block averages. Units: d, m, t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pumping {
    /// The pressure rise over a wavelength that it stands for, Dp = -N m g lambda/(L pi a^2) \[m/(d t^2)\], m the mean mass of
    /// the distribution of sizes: the same for all seeds.
    pub pressure_rise: f64,
    /// Useful power of the flow against the body force, -g sum m v_z over the grains inside; negative where they go with it.
    pub useful_power: (f64, f64),
    /// Efficiency: useful power over the power of wall or drive; NaN unless both are positive, for then nothing is pumped. Above 1
    /// stored energy was spent.
    /// Its error is that of (useful power) - (efficiency) (wall power), over the mean wall power.
    pub efficiency: (f64, f64),
}

impl Pumping {
    /// Of the late samples of a run in a tube of this length, of an open one that between its ends; `None` without a body force
    /// along the wave.
    pub(super) fn of(configuration: &Configuration, length: f64, late: &Late) -> Option<Self> {
        let force = configuration.axial_body_force();
        if force == 0.0 {
            return None;
        }
        let [across, up, _] = configuration.body.gravity;
        let power = |sample: &Sample| match (across, up) {
            (0.0, 0.0) => sample.body_power,
            // That of the rest of gravity is not pumping.
            _ => force * sample.mass_flow_rate * length,
        };
        let (power_in, power_error) = late.measured(power);
        let useful_power = -power_in;
        let wall_power = mean_of(late, |sample| sample.wall_power);
        let efficiency = if useful_power > 0.0 && wall_power > 0.0 {
            useful_power / wall_power
        } else {
            f64::NAN
        };
        let beyond = |sample: &Sample| -power(sample) - efficiency * sample.wall_power;
        let in_tube = match configuration.inlet {
            // Grains come and go: those that are there count.
            Some(_) => mean_of(late, |sample| sample.hold_up) / total_mass(configuration),
            None => 1.0,
        };
        let crowded = in_tube * configuration.tube.length() / length;
        Some(Self {
            pressure_rise: crowded * configuration.pressure_rise(),
            useful_power: (useful_power, power_error),
            efficiency: (efficiency, late.measured(beyond).1 / wall_power),
        })
    }
}

/// Mass of all grains of a configuration \[m\].
fn total_mass(configuration: &Configuration) -> f64 {
    configuration.grains.number as f64 * configuration.mean_grain_mass()
}

/// Normal forces at the contacts of the grains in the late part of a run \[m d/t^2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ForceOfContacts {
    /// Largest.
    pub(super) largest: f64,
    /// Mean of the force that 99 % of them do not exceed, and its error.
    pub(super) high: (f64, f64),
    /// At so many moments.
    pub(super) moments: usize,
}

impl ForceOfContacts {
    /// `None` where none was looked at so late.
    pub(super) fn of(late: &[Sample], forces: &ContactForces) -> Option<Self> {
        let looks = forces.late(late.first()?.time);
        let high = || looks.iter().map(|look| look.high);
        let largest = looks.iter().map(|look| look.largest).reduce(f64::max)?;
        let mean = high().sum::<f64>() / looks.len() as f64;
        Some(Self {
            largest,
            high: (mean, error_of(high())),
            moments: looks.len(),
        })
    }
}

/// Sliding of the grains on the wall: late means, each with its error. Units: d, m, t.
///
/// By Archard's law the volume that a wall loses is its coefficient of wear, over hardness and friction, times this work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wear {
    /// Power that grains lose where they slide on the wall, without what tangential springs take up and give back.
    pub power: (f64, f64),
    /// The power per area 2 pi R dz of the wall, between its ends. Every place of a periodic tube sees the whole wave, and
    /// bears this on average.
    pub power_per_area: (f64, f64),
}

impl Wear {
    /// From a wavelength's profile of a tube of this length \[d\]; `None` without friction.
    pub(super) fn of(
        configuration: &Configuration,
        length: f64,
        whole: &PartOfWave,
        profile: &[ProfileBin],
    ) -> Option<Self> {
        configuration.contact.friction?;
        let waves = f64::from(configuration.tube.waves);
        let (power, error) = (waves * whole.sliding_power.0, waves * whole.sliding_power.1);
        let in_tube = profile.iter().filter(|bin| bin.is_in_tube());
        let radius = super::mean(&in_tube.map(|bin| bin.radius).collect::<Vec<f64>>());
        let area = TAU * radius * length;
        Some(Self {
            power: (power, error),
            power_per_area: (power / area, error / area),
        })
    }
}

/// P/(2 pi f) for the late mean power P of the wall or drive and the mean frequency f at which waves passed then, and its
/// error \[m d^2/t^2\]; `None` of a wave that stood.
pub(super) fn wall_torque(samples: &[Sample], late: &Late) -> Option<(f64, f64)> {
    let frequency = frequency(samples, late);
    let per_power = 1.0 / (TAU * frequency);
    let (power, error) = late.measured(|sample| sample.wall_power);
    (frequency > 0.0).then_some((per_power * power, per_power * error))
}

/// Mean time that a grain takes through the length of the tube, and its standard error \[t\]; `None` unless the grains go
/// along the wave.
///
/// T = N/J (Little's law), N the grains inside and J their flow rate; the error is that of N - T J over J
pub(super) fn residence_time(late: &Late) -> Option<(f64, f64)> {
    let inside = mean_of(late, |sample| sample.inside);
    let flow = mean_of(late, |sample| sample.flow_rate);
    (flow > 0.0).then(|| {
        let time = inside / flow;
        let beyond = |sample: &Sample| sample.inside - time * sample.flow_rate;
        (time, late.measured(beyond).1 / flow)
    })
}

/// Coefficient of axial dispersion, D = d var(z - <z>)/(2 dt), and its error \[d^2/t\]; NaN without a whole late period.
///
/// The variance is that of the displacements since an origin in the late part of the run, from one period after it on.
pub(super) fn axial_dispersion(
    samples: &[Sample],
    late: &[Sample],
    dispersion: &AxialDispersion,
) -> (f64, f64) {
    // A sample's time is its end.
    let before = samples[..samples.len() - late.len()].last();
    let start = before.map_or(0.0, |sample| sample.time);
    let rates = dispersion.rates_from(start);
    (super::mean(&rates), error_of(rates.into_iter()))
}

#[cfg(test)]
mod tests;
