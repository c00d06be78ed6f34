//! The drive of a run at any time, by its configuration, and the rows of its time series.

use peristalsis_configuration::{Configuration, Control, ScheduledParameter};
use peristalsis_observe::Sample;
use peristalsis_run::Run;
use serde::Serialize;

/// Rows that a client gets at first, at most.
const FIRST_ROWS: usize = 4000;

/// A row of the time series, for the charts.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) number: usize,
    pub(crate) clock: f64,
    pub(crate) flow_rate_ratio: f64,
    pub(crate) bottleneck: f64,
    /// Width or force amplitude.
    pub(crate) amplitude: f64,
    pub(crate) strain_rate: f64,
}

/// Present values of the driven parameters.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Driven {
    pub(crate) width: Option<f64>,
    pub(crate) force_amplitude: Option<f64>,
    pub(crate) strain_rate: Option<f64>,
    pub(crate) friction: Option<f64>,
}

impl Driven {
    pub(crate) fn of(run: &Run) -> Self {
        Self {
            width: run.driven(ScheduledParameter::Width),
            force_amplitude: run.driven(ScheduledParameter::ForceAmplitude),
            strain_rate: run.driven(ScheduledParameter::StrainRate),
            friction: run
                .configuration()
                .contact
                .friction
                .map(|it| it.kinetic_friction),
        }
    }
}

/// The drive at any time, by a configuration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timeline<'a>(pub(crate) &'a Configuration);

impl Timeline<'_> {
    /// Duration of a period at the strain rate of the drive.
    pub(crate) fn unit_period(self) -> f64 {
        self.0.drive.period().unwrap_or(1.0)
    }

    /// A time in periods.
    pub(crate) fn clock(self, time: f64) -> f64 {
        time / self.unit_period()
    }

    /// A row of the time series.
    pub(crate) fn row(
        self,
        number: usize,
        time: f64,
        flow_rate_ratio: f64,
        bottleneck: f64,
    ) -> Row {
        let clock = self.clock(time);
        let amplitude = match self.0.drive.control {
            Control::Strain { width } => self.value(ScheduledParameter::Width, width, clock),
            Control::Stress {
                force_amplitude, ..
            } => self.value(ScheduledParameter::ForceAmplitude, force_amplitude, clock),
        };
        Row {
            number,
            clock,
            flow_rate_ratio,
            bottleneck,
            amplitude,
            strain_rate: self.strain_rate(clock),
        }
    }

    /// The row of a sample.
    pub(crate) fn row_of(self, number: usize, sample: &Sample) -> Row {
        self.row(
            number,
            sample.time,
            sample.flow_rate_ratio,
            sample.bottleneck,
        )
    }

    /// The driven parameters at a time in periods.
    pub(crate) fn driven(self, clock: f64) -> Driven {
        let (width, force_amplitude) = match self.0.drive.control {
            Control::Strain { width } => (
                Some(self.value(ScheduledParameter::Width, width, clock)),
                None,
            ),
            Control::Stress {
                force_amplitude, ..
            } => (
                None,
                Some(self.value(ScheduledParameter::ForceAmplitude, force_amplitude, clock)),
            ),
        };
        Driven {
            width,
            force_amplitude,
            strain_rate: Some(self.strain_rate(clock)),
            friction: self.0.contact.friction.map(|it| it.kinetic_friction),
        }
    }

    fn strain_rate(self, clock: f64) -> f64 {
        let constant = self.0.drive.strain_rate;
        self.value(ScheduledParameter::StrainRate, constant, clock)
    }

    fn value(self, parameter: ScheduledParameter, constant: f64, clock: f64) -> f64 {
        let mut schedules = self.0.drive.schedules.iter();
        let known = schedules.find(|it| it.parameter == parameter);
        known.map_or(constant, |schedule| schedule.value(clock))
    }
}

/// Every n-th row, n so that at most [`FIRST_ROWS`] are left.
pub(crate) fn thin<T>(rows: impl Iterator<Item = T>) -> Vec<T> {
    let rows: Vec<T> = rows.collect();
    let each = rows.len().div_ceil(FIRST_ROWS).max(1);
    rows.into_iter().step_by(each).collect()
}
