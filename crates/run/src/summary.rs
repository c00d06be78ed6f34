//! The outcome of a run in numbers.

use peristalsis_analysis::mean_with_error;
use peristalsis_observe::{Sample, WallFault, WavePart};

use crate::assemble::newtonian_reference;
use crate::estimate::{Warning, warnings};
use crate::late::{Pumping, Residence, axial_dispersion, error_of};
use crate::local_flow::LocalFlow;
use crate::recorder::THRESHOLDS;
use crate::run::Run;
use crate::si::SiSummary;
use crate::softness::overlap_warning;
use crate::trajectory::TrajectoryReport;
use crate::{REVISION, VERSION};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// As long as it was meant to.
    Complete,
    /// Ended before by its own rule, the transition having been found and having settled.
    Settled,
    /// Stopped before.
    Interrupted,
    /// A grain moved too far in one step.
    Diverged,
}

/// The transition as another threshold sees it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ThresholdTime {
    /// J/Jmax whose crossing counts.
    pub threshold: f64,
    /// tau \[t\], where there was a transition.
    pub time: Option<f64>,
}

/// The outcome of a run; missing numbers are `null` in JSON.
///
/// "Late" is the last part of the run, a quarter unless configured otherwise ([`Run::late_fraction`]). Units: d, m, t.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Summary {
    /// How it ended.
    pub status: Status,
    /// What went wrong, where it diverged.
    pub message: Option<String>,
    /// Grains.
    pub grains: u64,
    /// Late mean of J/Jmax of the grains inside.
    pub flow_rate_ratio: f64,
    /// Its standard error from block averages.
    pub flow_rate_ratio_error: f64,
    /// Mean of J/Jmax in the second half of the late part less that in the first: a run that is not yet stationary drifts.
    pub flow_rate_ratio_drift: f64,
    /// Variance of the late averages of J/Jmax over a period each; NaN below two whole late periods.
    pub flow_rate_ratio_variance: f64,
    /// Late mean of J/Jmax of all grains.
    pub flow_rate_ratio_raw: f64,
    /// Late mean of J \[1/t\].
    pub flow_rate: f64,
    /// tau \[t\].
    pub transition_time: Option<f64>,
    /// Whether the run ended before a transition.
    pub censored: bool,
    /// J/Jmax whose crossing counts as the transition.
    pub transition_threshold: f64,
    /// tau \[t\] at other thresholds.
    pub transition_times: Vec<ThresholdTime>,
    /// J/Jmax of a Newtonian fluid in this tube, phi = b/a, without load whatever the body force.
    pub newtonian_flow_rate_ratio: Option<f64>,
    /// The same for the clear bore, phi = b/(a - d/2).
    pub newtonian_flow_rate_ratio_clear_bore: Option<f64>,
    /// Grains outside the tube at the end.
    pub escaped: u64,
    /// Most grains outside the tube at any sample.
    pub escaped_most: u64,
    /// Largest overlap of a grain's contact at any step \[d\].
    pub largest_overlap: f64,
    /// |what the energy ledger misses| over the integral of |power that entered|.
    pub energy_residual: f64,
    /// Late mean of the granular temperature.
    pub granular_temperature: f64,
    /// Late mean number of contacts of a grain.
    pub contacts: f64,
    /// Late mean power that wall or drive put in.
    pub wall_power: f64,
    /// Its standard error.
    pub wall_power_error: f64,
    /// What is known of pumping against a body force, where there is one.
    pub pumping: Option<Pumping>,
    /// Axial force of the wall on the grains of one wavelength along the normals of contacts, along the wave: late mean.
    pub wall_normal_force: f64,
    /// Its standard error.
    pub wall_normal_force_error: f64,
    /// The same by friction.
    pub wall_tangential_force: f64,
    /// Its standard error.
    pub wall_tangential_force_error: f64,
    /// The part of wall_normal_force that acts where the tube is narrower than on its mean.
    pub narrow_normal_force: f64,
    /// Its standard error.
    pub narrow_normal_force_error: f64,
    /// The part of wall_tangential_force that acts there.
    pub narrow_tangential_force: f64,
    /// Its standard error.
    pub narrow_tangential_force_error: f64,
    /// Late mean axial velocity of the grains there, laboratory frame, along the wave \[d/t\].
    pub narrow_axial_velocity: f64,
    /// Its standard error.
    pub narrow_axial_velocity_error: f64,
    /// Late mean axial velocity of the wall's spheres there; 0 for a prescribed wall \[d/t\].
    pub narrow_wall_velocity: f64,
    /// Its standard error.
    pub narrow_wall_velocity_error: f64,
    /// The part of wall_normal_force that acts in the front of the wave, from its narrowest place to the widest one ahead.
    pub front_normal_force: f64,
    /// Its standard error.
    pub front_normal_force_error: f64,
    /// The part of wall_tangential_force that acts in the front of the wave.
    pub front_tangential_force: f64,
    /// Its standard error.
    pub front_tangential_force_error: f64,
    /// Late mean of the pressure on the wall \[m/(d t^2)\].
    pub wall_pressure: f64,
    /// Largest late mean of it over the phases of the wave, each a bin of the profile wide (`observe.profile_bins`).
    pub wall_pressure_largest: f64,
    /// Mean time that a grain takes through the tube's length, N/J of the late means (Little's law) \[t\]; missing where
    /// the flow does not go along the wave.
    pub residence_time: Option<f64>,
    /// Its standard error.
    pub residence_time_error: Option<f64>,
    /// D, coefficient of axial dispersion: half the rate at which the variance of axial displacements since an origin in
    /// the late part grows from period to period \[d^2/t\].
    pub axial_dispersion: f64,
    /// Its standard error.
    pub axial_dispersion_error: f64,
    /// Late mean power lost.
    pub dissipated_power: f64,
    /// Late mean of the smallest bottleneck, between centres of wall spheres \[d\].
    pub bottleneck: f64,
    /// The flow where the tube is narrowest.
    pub throat: LocalFlow,
    /// The flow where it is widest; where it is that over a flat stretch, in the middle of it.
    pub belly: LocalFlow,
    /// Periods that late means are over.
    pub late_periods: f64,
    /// Steps done.
    pub steps: u64,
    /// Length of a step \[t\].
    pub time_step: f64,
    /// Time reached \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run.
    pub periods: f64,
    /// Spheres of the wall.
    pub wall_spheres: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// How the grains were packed.
    pub packing: peristalsis_engine::initial::PackingReport,
    /// Grains times steps over the seconds that engine and observables took.
    pub grain_steps_per_second: f64,
    /// Seconds that engine and observables took.
    pub seconds: f64,
    /// The same in SI, where the units were said.
    pub si: Option<SiSummary>,
    /// What went wrong with an elastic wall: when, where, and the likely cause.
    pub wall_diagnosis: Vec<String>,
    /// What looks doubtful in the configuration, and in what came of it.
    pub warnings: Vec<Warning>,
    /// What was written of its trajectory, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<TrajectoryReport>,
    /// Version of the program.
    pub version: &'static str,
    /// Revision of its source.
    pub revision: &'static str,
}

impl Summary {
    /// The outcome of a run so far.
    #[must_use]
    pub fn of(run: &Run, status: Status, message: Option<String>) -> Self {
        let configuration = run.configuration();
        let recorder = run.recorder();
        let samples = recorder.samples();
        let late = recorder.late(run.late_fraction());
        let last = samples.last();
        let ratios: Vec<f64> = late.iter().map(|sample| sample.flow_rate_ratio).collect();
        let estimate = mean_with_error(&ratios).ok();
        let mean =
            |value: fn(&Sample) -> f64| late.iter().map(value).sum::<f64>() / late.len() as f64;
        let error = |value: fn(&Sample) -> f64| error_of(late.iter().map(value));
        let profile = recorder
            .profile()
            .late(run.late_fraction(), configuration.tube.wavelength);
        let wall_force = recorder.profile().late_wall_force(run.late_fraction());
        let part = |part| recorder.profile().late_part(run.late_fraction(), part);
        let (narrow, front) = (part(WavePart::Narrow), part(WavePart::Front));
        let pressures = || profile.iter().map(|bin| bin.wall_pressure.0);
        let residence = Residence::of(late);
        let (axial_dispersion, axial_dispersion_error) =
            axial_dispersion(late, recorder.dispersion());
        let newtonian = newtonian_reference(configuration);
        let simulation = run.simulation();
        let seconds = run.elapsed().as_secs_f64();
        let grain_steps = configuration.grains.number as f64 * simulation.step() as f64;
        let transition_time = recorder.transition_time();
        let mut summary = Self {
            status,
            message,
            grains: configuration.grains.number,
            flow_rate_ratio: estimate.map_or_else(
                || mean(|sample| sample.flow_rate_ratio),
                |estimate| estimate.mean,
            ),
            flow_rate_ratio_error: estimate.map_or(f64::NAN, |estimate| estimate.error),
            flow_rate_ratio_drift: drift(&ratios),
            flow_rate_ratio_variance: variance_of_periods(
                &ratios,
                configuration.observe.samples_per_period as usize,
            ),
            flow_rate_ratio_raw: mean(|sample| sample.flow_rate_ratio_raw),
            flow_rate: mean(|sample| sample.flow_rate),
            transition_time,
            censored: transition_time.is_none(),
            transition_threshold: configuration.observe.transition_threshold,
            transition_times: THRESHOLDS
                .into_iter()
                .zip(recorder.transition_times())
                .map(|(threshold, time)| ThresholdTime { threshold, time })
                .collect(),
            newtonian_flow_rate_ratio: newtonian.map(|reference| reference.0),
            newtonian_flow_rate_ratio_clear_bore: newtonian.and_then(|reference| reference.1),
            escaped: last.map_or(0, |sample| sample.escaped as u64),
            escaped_most: samples
                .iter()
                .map(|sample| sample.escaped as u64)
                .max()
                .unwrap_or(0),
            largest_overlap: simulation.ledger().largest_overlap,
            energy_residual: simulation.energy_residual(),
            granular_temperature: mean(|sample| sample.granular_temperature),
            contacts: mean(|sample| sample.contacts),
            wall_power: mean(|sample| sample.wall_power),
            wall_power_error: error(|sample| sample.wall_power),
            pumping: Pumping::of(configuration, late),
            wall_normal_force: wall_force.normal.0,
            wall_normal_force_error: wall_force.normal.1,
            wall_tangential_force: wall_force.tangential.0,
            wall_tangential_force_error: wall_force.tangential.1,
            narrow_normal_force: narrow.normal_force.0,
            narrow_normal_force_error: narrow.normal_force.1,
            narrow_tangential_force: narrow.tangential_force.0,
            narrow_tangential_force_error: narrow.tangential_force.1,
            narrow_axial_velocity: narrow.axial_velocity.0,
            narrow_axial_velocity_error: narrow.axial_velocity.1,
            narrow_wall_velocity: narrow.wall_velocity.0,
            narrow_wall_velocity_error: narrow.wall_velocity.1,
            front_normal_force: front.normal_force.0,
            front_normal_force_error: front.normal_force.1,
            front_tangential_force: front.tangential_force.0,
            front_tangential_force_error: front.tangential_force.1,
            wall_pressure: pressures().sum::<f64>() / profile.len() as f64,
            wall_pressure_largest: pressures().fold(f64::NAN, f64::max),
            residence_time: residence.map(|residence| residence.time),
            residence_time_error: residence.map(|residence| residence.error),
            axial_dispersion,
            axial_dispersion_error,
            dissipated_power: mean(|sample| sample.dissipated_power),
            bottleneck: mean(|sample| sample.bottleneck),
            throat: LocalFlow::throat(&profile),
            belly: LocalFlow::belly(&profile),
            late_periods: late.len() as f64 / f64::from(configuration.observe.samples_per_period),
            steps: simulation.step(),
            time_step: configuration.run.time_step,
            time: simulation.time(),
            periods: simulation.wall().cycles(),
            wall_spheres: configuration.tube.wall_spheres(),
            seed: configuration.run.seed,
            packing: *run.packing(),
            grain_steps_per_second: if seconds > 0.0 {
                grain_steps / seconds
            } else {
                0.0
            },
            seconds,
            wall_diagnosis: recorder
                .wall_faults()
                .iter()
                .map(WallFault::in_words)
                .collect(),
            warnings: warnings(configuration)
                .into_iter()
                .chain(overlap_warning(run))
                .collect(),
            si: None,
            trajectory: None,
            version: VERSION,
            revision: REVISION,
        };
        summary.si = configuration
            .units
            .as_ref()
            .map(|units| SiSummary::of(&summary, configuration, units));
        summary
    }
}

/// Mean of the second half of a series less that of the first; NaN below two values.
fn drift(series: &[f64]) -> f64 {
    let (first, second) = series.split_at(series.len() / 2);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    if first.is_empty() {
        return f64::NAN;
    }
    mean(second) - mean(first)
}

/// Variance of the averages over each whole period, counted from the end; NaN below two.
fn variance_of_periods(series: &[f64], samples_per_period: usize) -> f64 {
    let averages: Vec<f64> = series
        .rchunks_exact(samples_per_period.max(1))
        .map(|period| period.iter().sum::<f64>() / period.len() as f64)
        .collect();
    let number = averages.len() as f64;
    if averages.len() < 2 {
        return f64::NAN;
    }
    let mean = averages.iter().sum::<f64>() / number;
    let squares: f64 = averages.iter().map(|one| (one - mean) * (one - mean)).sum();
    squares / (number - 1.0)
}

impl Summary {
    /// As JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self)
            .expect("a summary is plain numbers and text, which always serialise");
        text.push('\n');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_differs_from_period_to_period_counts_as_fluctuation() {
        // Half a period, then three whole ones of means 1, 2, 3, whatever goes on within them.
        let series = [9.0, 0.5, 1.5, 0.0, 4.0, 3.0, 3.0];
        assert!((variance_of_periods(&series, 2) - 1.0).abs() < 1e-12);
        assert!(variance_of_periods(&series[..3], 2).is_nan());
    }
}
