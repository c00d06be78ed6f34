//! The drive of a run at any time, by its configuration, and the rows of its time series.

use peristalsis_configuration::{Configuration, ScheduledParameter};
use peristalsis_observe::Sample;
use peristalsis_run::Run;
use serde::Serialize;

use crate::message::Steered;

/// Rows that a client gets at first, at most.
const FIRST_ROWS: usize = 4000;
/// A period less what rounding may add, so that a mean takes no row of the period before.
const PERIOD: f64 = 0.999;

/// A row of the time series, for the charts.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Row {
    pub(crate) number: usize,
    /// Time in periods of the drive's own strain rate.
    pub(crate) clock: f64,
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    pub(crate) flow_rate_ratio: f64,
    /// Its mean over the period that ends here.
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    pub(crate) average: f64,
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    pub(crate) bottleneck: f64,
    /// Of an open tube.
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    pub(crate) discharge_rate: f64,
    /// Width or force amplitude.
    pub(crate) amplitude: Option<f64>,
    pub(crate) strain_rate: Option<f64>,
}

/// What belongs to each parameter that may have a slider; nothing for a parameter that cannot be changed.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Sliders<T> {
    pub(crate) width: Option<T>,
    pub(crate) force_amplitude: Option<T>,
    pub(crate) strain_rate: Option<T>,
    pub(crate) friction: Option<T>,
}

/// Present values of the driven parameters.
pub(crate) type Driven = Sliders<f64>;

impl Driven {
    pub(crate) fn of_mut(&mut self, parameter: Steered) -> &mut Option<f64> {
        match parameter {
            Steered::Width => &mut self.width,
            Steered::ForceAmplitude => &mut self.force_amplitude,
            Steered::StrainRate => &mut self.strain_rate,
            Steered::Friction => &mut self.friction,
        }
    }

    pub(crate) fn of(run: &Run) -> Self {
        Self::by(run.configuration(), |parameter| run.driven(parameter))
    }

    /// The values that the schedules lead to.
    pub(crate) fn by(
        configuration: &Configuration,
        value: impl Fn(ScheduledParameter) -> Option<f64>,
    ) -> Self {
        let friction = configuration.contact.friction;
        Self {
            width: value(ScheduledParameter::Width),
            force_amplitude: value(ScheduledParameter::ForceAmplitude),
            strain_rate: value(ScheduledParameter::StrainRate),
            friction: friction.map(|it| it.kinetic_friction),
        }
    }
}

/// The drive at any time, by a configuration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timeline<'a>(pub(crate) &'a Configuration);

impl Timeline<'_> {
    /// Duration of a period at the strain rate of the drive; 1 t where the wave stands.
    pub(crate) fn unit_period(self) -> f64 {
        self.0.drive.period().unwrap_or(1.0)
    }

    /// A time in periods.
    pub(crate) fn clock(self, time: f64) -> f64 {
        time / self.unit_period()
    }

    /// A row of the time series, of which only the drive is known.
    pub(crate) fn row(self, number: usize, time: f64) -> Row {
        let clock = self.clock(time);
        let driven = self.driven(clock);
        Row {
            number,
            clock,
            flow_rate_ratio: f64::NAN,
            average: f64::NAN,
            bottleneck: f64::NAN,
            discharge_rate: f64::NAN,
            amplitude: driven.width.or(driven.force_amplitude),
            strain_rate: driven.strain_rate,
        }
    }

    /// The row of a sample.
    pub(crate) fn row_of(self, number: usize, sample: &Sample) -> Row {
        Row {
            flow_rate_ratio: sample.flow_rate_ratio,
            bottleneck: sample.bottleneck,
            discharge_rate: sample.discharge_rate,
            ..self.row(number, sample.time)
        }
    }

    /// The driven parameters at a time in periods.
    pub(crate) fn driven(self, clock: f64) -> Driven {
        Driven::by(self.0, |parameter| {
            let own = self.0.drive.own(parameter)?;
            let schedule = self.0.drive.schedule(parameter);
            Some(schedule.map_or(own, |schedule| schedule.value(clock)))
        })
    }
}

/// Rows of the time series of a run from a kept sample on; the number of a row counts the samples before it, those that are
/// kept no more included.
pub(crate) fn rows(run: &Run, from: usize) -> Vec<Row> {
    let timeline = Timeline(run.configuration());
    let each = run.recorder().intervals() as usize;
    let samples = run.recorder().samples();
    // Those before are there for the means.
    let begin = samples.get(from).map_or(samples.len(), |first| {
        let begin = timeline.clock(first.time) - PERIOD;
        samples.partition_point(|sample| timeline.clock(sample.time) <= begin)
    });
    let rows = samples.iter().enumerate().skip(begin);
    let mut rows: Vec<Row> = rows
        .map(|(place, sample)| timeline.row_of(place * each, sample))
        .collect();
    average(&mut rows);
    rows.split_off(from.min(samples.len()) - begin)
}

/// Works out the means of rows in the order of time.
pub(crate) fn average(rows: &mut [Row]) {
    let mut first = 0;
    for last in 0..rows.len() {
        let begin = rows[last].clock - PERIOD;
        while rows[first].clock <= begin {
            first += 1;
        }
        let ratios = rows[first..=last].iter().map(|row| row.flow_rate_ratio);
        let known: Vec<f64> = ratios.filter(|ratio| !ratio.is_nan()).collect();
        rows[last].average = known.iter().sum::<f64>() / known.len() as f64;
    }
}

/// A whole time series, thinned; the last row stays.
pub(crate) fn history(mut rows: Vec<Row>) -> Vec<Row> {
    let last = rows.pop();
    thin(rows.into_iter()).into_iter().chain(last).collect()
}

/// Every n-th row, n a power of 2, as the page thins them further, so that at most [`FIRST_ROWS`] are left.
pub(crate) fn thin<T>(rows: impl Iterator<Item = T>) -> Vec<T> {
    let rows: Vec<T> = rows.collect();
    let each = rows.len().div_ceil(FIRST_ROWS).next_power_of_two();
    rows.into_iter().step_by(each).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_the_same_mean_wherever_rows_begin() {
        let settings = ["tube.waves=2", "drive.strain_rate=0.05"].map(str::to_owned);
        let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
        let mut run = Run::new(configuration).unwrap();
        for _ in 0..45 {
            run.advance().unwrap();
        }
        let told = |rows: &[Row]| -> Vec<_> {
            let of_row = |row: &Row| (row.number, row.average.to_bits());
            rows.iter().map(of_row).collect()
        };
        let all = rows(&run, 0);
        assert!(all[all.len() - 1].clock > 2.0);
        for from in [0, 1, all.len() / 2, all.len() - 1, all.len(), all.len() + 7] {
            let tail = &all[from.min(all.len())..];
            assert_eq!(told(&rows(&run, from)), told(tail), "{from}");
        }
    }

    #[test]
    fn a_long_history_is_thinned_evenly_with_the_means_of_all_its_rows() {
        let row = |number: usize| Row {
            number,
            clock: number as f64 / 20.0,
            flow_rate_ratio: (number % 20) as f64,
            average: f64::NAN,
            bottleneck: 0.0,
            discharge_rate: f64::NAN,
            amplitude: None,
            strain_rate: None,
        };
        let mut rows: Vec<Row> = (0..50_000).map(row).collect();
        average(&mut rows);
        let rows = history(rows);
        assert!(rows.len() > 2000 && rows.len() <= 4001, "{}", rows.len());
        let (last, thinned) = rows.split_last().unwrap();
        assert!(
            thinned
                .windows(2)
                .all(|two| two[1].number - two[0].number == 16)
        );
        assert_eq!(last.number, 49_999);
        let means = rows.iter().skip(2).map(|row| row.average);
        assert!(means.into_iter().all(|mean| (mean - 9.5).abs() < 1e-9));
    }
}
