//! The outcome of a run in numbers.

mod arrangement;
mod discharge;
mod label;
mod late;
mod local_flow;
mod table;
mod written;

use peristalsis_analysis::number::known_error;
use peristalsis_analysis::variance;
use peristalsis_configuration::{Configuration, ScheduledParameter, Units};
use peristalsis_engine::initial::PackingReport;
use peristalsis_observe::{PartOfWave, Sample, WallFault, WavePart};

pub use arrangement::{MixedGrains, SegregatedSizes};
pub use discharge::Discharge;
pub use label::label;
pub(crate) use late::late_wave_speed;
use late::{ForceOfContacts, Late, axial_dispersion, residence_time, wall_torque};
pub use late::{Pumping, Wear};
use local_flow::LocalFlow;
pub use written::{RowColumn, SummaryKey, row_columns, set_by, summary_keys, summary_schema};

use crate::assemble::newtonian_reference;
use crate::recorder::THRESHOLDS;
use crate::run::Run;
use crate::tables::late_profile;
use crate::trajectory::TrajectoryReport;
use crate::warnings::Warning;

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

/// The outcome of a run. Written down it has the names, units and words of the table of quantities.
///
/// "Late" is the last part of the run, a quarter unless configured otherwise ([`Run::late_fraction`]). A pair is a number
/// and its standard error, NaN where the late part is too short for one. Units: d, m, t.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How it ended.
    pub status: Status,
    /// Why it diverged, where it did.
    pub message: Option<String>,
    /// Late mean of J/Jmax of the grains inside, its error from block averages; of a wave that changes its
    /// speed the mean of J over that of Jmax.
    pub flow_rate_ratio: (f64, f64),
    /// tau \[t\]; `None` where the run ended before a transition.
    pub transition_time: Option<f64>,
    /// Time up to which a transition is found \[t\]; `None` where none can be told.
    pub watched: Option<f64>,
    /// tau \[t\] at each of [`THRESHOLDS`].
    transition_times: [Option<f64>; THRESHOLDS.len()],
    /// J/Jmax of a Newtonian fluid in this tube without load: phi = b/a, and phi = b/(a - d_w/2) of the clear bore.
    pub newtonian: Option<(f64, Option<f64>)>,
    /// Grains outside the tube at the end.
    pub escaped: u64,
    /// Most grains outside the tube at any sample.
    pub escaped_most: u64,
    /// Largest overlap of a grain's contact at any step \[d\].
    pub largest_overlap: f64,
    /// |energy that the ledger misses| over what entered: `Ledger::relative_residual` of the engine.
    pub energy_residual: f64,
    /// Pumping against a body force, where there is one.
    pub pumping: Option<Pumping>,
    /// Discharge of an open tube; `None` for a periodic tube.
    pub discharge: Option<Discharge>,
    /// Late mean of the pressure on the wall, each bin of the profile alike \[m/(d t^2)\].
    pub wall_pressure: f64,
    /// Late mean of the pressure on the wall in the bin of the profile where it is largest \[m/(d t^2)\].
    pub wall_pressure_largest: f64,
    /// Sliding of the grains on the wall, where there is friction.
    pub wear: Option<Wear>,
    /// W/(2 pi) for the late mean work W of the wall or drive in a period, and its error: the torque of a shaft that makes one
    /// wave a turn \[m d^2/t^2\]; `None` of a static wave.
    pub wall_torque: Option<(f64, f64)>,
    /// How the grains mixed; nothing is known below 20 grains, or of an open tube.
    pub mixed: MixedGrains,
    /// Where grains of several sizes gathered.
    pub segregated: SegregatedSizes,
    /// Steps done.
    pub steps: u64,
    /// Time reached \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run.
    pub periods: f64,
    /// Seconds that engine and observables took.
    pub seconds: f64,
    /// Faults of an elastic wall: when, where, and the likely cause.
    pub wall_diagnosis: Vec<String>,
    /// [`Run::warnings`] at the end.
    pub warnings: Vec<Warning>,
    /// The trajectory that was written, if there is one.
    pub trajectory: Option<TrajectoryReport>,
    configuration: Configuration,
    late: Late,
    /// J/Jmax of each late sample.
    late_ratios: Vec<f64>,
    flow_rate_ratio_raw: f64,
    /// Intervals between samples in it.
    late_intervals: u64,
    /// J/Jmax of each whole late period.
    late_averages: Vec<f64>,
    whole: PartOfWave,
    narrow: PartOfWave,
    front: PartOfWave,
    throat: LocalFlow,
    belly: LocalFlow,
    contact_force: Option<ForceOfContacts>,
    residence_time: Option<(f64, f64)>,
    axial_dispersion: (f64, f64),
    packing: PackingReport,
}

/// Errors of the mean by which its halves differ at least where the flow still changes. Those of a steady flow differ by
/// two errors, as a standard deviation.
const DRIFT: f64 = 5.0;

impl Summary {
    /// The outcome of a run so far.
    pub fn of(run: &Run, status: Status, message: Option<String>) -> Self {
        let configuration = run.configuration();
        let recorder = run.recorder();
        let simulation = run.simulation();
        let (samples, fraction) = (recorder.samples(), run.late_fraction());
        let late = Late::of(configuration, recorder, fraction);
        let late_intervals = late.len() as u64 * recorder.intervals();
        let samples_per_period = u64::from(configuration.observe.samples_per_period);
        let of_period = (samples_per_period / recorder.intervals()).max(1) as usize;
        let ends = arrangement::ends_of_periods(samples, &late, of_period);
        let length = simulation.length();
        let in_waves = length / configuration.tube.wavelength;
        let changes_speed = configuration
            .drive
            .schedule(ScheduledParameter::StrainRate)
            .is_some();
        let [ratios, raw_ratios] = late::flow_rate_ratios(samples, &late, in_waves, changes_speed);
        let profile = late_profile(run);
        let part = |part| {
            let profile = recorder.profile();
            profile.late_part(fraction, part)
        };
        let whole = part(WavePart::Whole);
        let pressures = profile.iter().map(|bin| bin.wall_pressure.0);
        // Beyond an end there is no wall that they could press on.
        let pressures: Vec<f64> = pressures.filter(|it| !it.is_nan()).collect();
        let escaped = |sample: &Sample| sample.escaped as u64;
        let faults = recorder.wall_faults().iter();
        Self {
            status,
            message,
            flow_rate_ratio: (mean(&ratios), late.error_of(&ratios)),
            late_ratios: ratios,
            flow_rate_ratio_raw: mean(&raw_ratios),
            transition_time: recorder.transition_time(),
            watched: recorder.watched(),
            transition_times: recorder.transition_times(),
            newtonian: newtonian_reference(configuration),
            escaped: samples.last().map_or(0, escaped),
            escaped_most: recorder.escaped_most() as u64,
            largest_overlap: simulation.ledger().largest_overlap,
            energy_residual: simulation.energy_residual(),
            pumping: Pumping::of(configuration, length, &late),
            discharge: Discharge::of(run, &late),
            wall_pressure: mean(&pressures),
            wall_pressure_largest: pressures.into_iter().fold(f64::NAN, f64::max),
            wear: Wear::of(configuration, length, &whole, &profile),
            wall_torque: wall_torque(samples, &late),
            mixed: MixedGrains::of(samples, &ends),
            segregated: SegregatedSizes::of(&ends),
            steps: simulation.step(),
            time: simulation.time(),
            periods: simulation.wall().cycles(),
            seconds: run.elapsed().as_secs_f64(),
            wall_diagnosis: faults.map(WallFault::in_words).collect(),
            warnings: run.warnings(),
            trajectory: None,
            configuration: configuration.clone(),
            late_averages: recorder
                .late_averages(late_intervals / samples_per_period)
                .to_vec(),
            late_intervals,
            whole,
            narrow: part(WavePart::Narrow),
            front: part(WavePart::Front),
            throat: LocalFlow::throat(&profile),
            belly: LocalFlow::belly(&profile),
            contact_force: ForceOfContacts::of(&late, recorder.contact_forces()),
            // In an open tube grains fill a part of the length that J is of: transit times tell how long they take.
            residence_time: match simulation.ends() {
                Some(_) => None,
                None => residence_time(&late),
            },
            axial_dispersion: axial_dispersion(samples, &late, recorder.dispersion()),
            late,
            packing: *run.packing(),
        }
    }

    /// Late mean of J \[1/t\].
    pub fn flow_rate(&self) -> f64 {
        // No flow has no sign.
        self.mean(|sample| sample.flow_rate) + 0.0
    }

    /// Late mean of -J where J < 0, and its error \[1/t\].
    pub fn back_flow(&self) -> (f64, f64) {
        late::back_flow(&self.late)
    }

    /// Part of the late samples at which a contact of a grain overlaps by more than a tenth of d.
    pub fn pressed(&self) -> f64 {
        late::pressed(&self.late)
    }

    /// Late mean power that wall or drive put into the whole tube \[m d^2/t^3\].
    pub fn wall_power(&self) -> f64 {
        self.mean(|sample| sample.wall_power)
    }

    /// Grains times steps over the seconds that engine and observables took.
    pub fn grain_steps_per_second(&self) -> f64 {
        let grain_steps = self.configuration.grains.number as f64 * self.steps as f64;
        if self.seconds > 0.0 {
            grain_steps / self.seconds
        } else {
            0.0
        }
    }

    /// A number in SI, by the SI value of its unit; `None` where the configuration does not say its units.
    pub fn in_si(&self, value: f64, unit: fn(&Units) -> f64) -> Option<f64> {
        Some(value * unit(self.configuration.units.as_ref()?))
    }

    /// The same of a number and its error.
    pub fn measured_in_si(
        &self,
        (value, error): (f64, f64),
        unit: fn(&Units) -> f64,
    ) -> Option<(f64, f64)> {
        Some((self.in_si(value, unit)?, self.in_si(error, unit)?))
    }

    /// Late mean of the mass that flows and its error \[m/t\].
    pub fn mass_flow_rate(&self) -> (f64, f64) {
        let (rate, error) = self.late.measured(|sample| sample.mass_flow_rate);
        // No flow has no sign.
        (rate + 0.0, error)
    }

    /// The same \[kg/s\]; `None` where the configuration does not say its units.
    pub fn mass_flow_rate_in_si(&self) -> Option<(f64, f64)> {
        self.measured_in_si(self.mass_flow_rate(), Units::mass_flow)
    }

    /// Late mean of the normal force that 99 % of the contacts of grains do not exceed, and the largest
    /// \[m d/t^2\], at how many moments; `None` where none was looked at so late.
    pub fn contact_force(&self) -> Option<(f64, f64, usize)> {
        self.contact_force
            .map(|force| (force.high.0, force.largest, force.moments))
    }

    /// Late J/Jmax, mean of its second half less that of its first; NaN below two samples.
    pub fn flow_rate_ratio_drift(&self) -> f64 {
        let (first, second) = self.late.halves(&self.late_ratios);
        if first.is_empty() {
            return f64::NAN;
        }
        mean(second) - mean(first)
    }

    /// Whether that is more than the error of J/Jmax lets expect of a flow that no longer changes.
    pub fn is_still_changing(&self) -> bool {
        let (ratio, error) = self.flow_rate_ratio;
        known_error(ratio, error)
            .is_some_and(|error| self.flow_rate_ratio_drift().abs() > DRIFT * error)
    }

    fn mean(&self, value: fn(&Sample) -> f64) -> f64 {
        mean_of(&self.late, value)
    }

    /// Part of so many samples of the whole run that late means are over.
    pub fn late_part(&self, samples: usize) -> f64 {
        self.late.len() as f64 / samples.max(1) as f64
    }

    /// Periods that late means are over.
    fn late_periods(&self) -> f64 {
        self.late_intervals as f64 / f64::from(self.configuration.observe.samples_per_period)
    }

    /// Length of the run in periods of `drive.strain_rate`.
    pub fn periods_of_drive(&self) -> f64 {
        self.time * self.configuration.drive.strain_rate
    }

    /// Variance of the late averages of J/Jmax over a period each; NaN below two whole late periods.
    fn flow_rate_ratio_variance(&self) -> f64 {
        variance(&self.late_averages)
    }
}

/// Mean; NaN of nothing.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Late mean.
pub(crate) fn mean_of(late: &[Sample], value: impl Fn(&Sample) -> f64) -> f64 {
    late.iter().map(value).sum::<f64>() / late.len() as f64
}
