//! The discharge of an open tube.

use core::f64::consts::PI;

use peristalsis_observe::clear_volume_of_wave;

use super::late::{Late, error_of_few, frequency};
use crate::run::Run;

/// The flow through an open tube: late means, each with its error from block averages. Units: d, m, t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discharge {
    /// Mass that leaves through the outlet, per time.
    pub rate: (f64, f64),
    /// Mass that leaves through the inlet, against the flow, per time.
    pub return_rate: (f64, f64),
    /// Mass between the ends.
    pub hold_up: (f64, f64),
    /// Mass that has left through the outlet since the start.
    pub discharged: f64,
    /// Mass that has left beside the tube since the start, also since the last sample: of grains that had gone through its
    /// wall.
    pub leaked: f64,
    /// Grains that have gone from the inlet to the outlet in the whole run.
    pub passed: u64,
    /// Mean transit time of these grains, and its error from blocks of grains that came one after another; NaN of too few.
    pub transit_time: (f64, f64),
    /// Variance of the transit time.
    pub transit_time_variance: f64,
    /// Volume of the grains discharged in a period over the clear volume of a wavelength; `None` of a static wave.
    pub refill_efficiency: Option<(f64, f64)>,
}

impl Discharge {
    /// Of the late samples of a run; `None` of a periodic tube.
    pub(super) fn of(run: &Run, late: &Late) -> Option<Self> {
        let simulation = run.simulation();
        let ends = simulation.ends()?;
        let times = ends.transit_times();
        let (passed, variance) = (times.number(), times.variance());
        let rate = late.measured(|sample| sample.discharge_rate);
        let frequency = frequency(run.recorder().samples(), late);
        let refill_efficiency = (frequency > 0.0).then(|| {
            // A grain of mass m has the volume pi m/6.
            let part = PI / 6.0 / (frequency * clear_volume_of_wave(simulation));
            (part * rate.0, part * rate.1)
        });
        Some(Self {
            rate,
            return_rate: late.measured(|sample| sample.return_rate),
            hold_up: late.measured(|sample| sample.hold_up),
            discharged: late.last().map_or(0.0, |sample| sample.discharged),
            leaked: ends.passages().leaked.mass,
            passed,
            transit_time: (times.mean(), error_of_few(&times.block_means())),
            transit_time_variance: variance,
            refill_efficiency,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peristalsis_configuration::Configuration;

    /// A checker: the same pump had three refill efficiencies, by the instant at which it was stopped.
    #[test]
    fn the_volume_of_segments_is_that_of_a_period() {
        let settings = "tube.waves=1 grains.number=5 drive.waveform=segments drive.width=0.6 drive.segments=3 \
                        drive.duty=0.2 run.periods=1";
        let settings: Vec<&str> = settings.split_whitespace().collect();
        let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
        let mut run = Run::new(configuration).unwrap();
        let first = clear_volume_of_wave(run.simulation());
        while !run.is_complete() {
            run.advance().unwrap();
            let volume = clear_volume_of_wave(run.simulation());
            assert!((volume / first - 1.0).abs() < 0.01, "{volume} {first}");
        }
    }
}
