//! What the late part of a run says of pumping, residence and dispersion.

use peristalsis_analysis::mean_with_error;
use peristalsis_configuration::Configuration;
use peristalsis_observe::{AxialDispersion, Sample};

/// Standard error of the mean of a correlated series from block averages; NaN of a series too short.
pub(crate) fn error_of(series: impl Iterator<Item = f64>) -> f64 {
    let series: Vec<f64> = series.collect();
    mean_with_error(&series).map_or(f64::NAN, |estimate| estimate.error)
}

/// Pumping against a body force: late means, errors from block averages. Units: d, m, t.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Pumping {
    /// g, force over mass along the wave, negative where it is back pressure \[d/t^2\].
    pub body_force: f64,
    /// The pressure rise over a wavelength that it stands for, Dp = -N m g lambda/(L pi a^2) \[m/(d t^2)\], m the mean mass.
    pub pressure_rise: f64,
    /// Useful power: that of the flow against the body force, -g sum m v_z; negative where the grains go with it.
    pub useful_power: f64,
    /// Its standard error.
    pub useful_power_error: f64,
    /// Efficiency: useful power over that of wall or drive; NaN unless both are positive, for then nothing is pumped. Above 1
    /// stored energy was spent.
    pub efficiency: f64,
    /// Its standard error, that of (useful power) - (efficiency) (wall power) over the mean wall power.
    pub efficiency_error: f64,
}

impl Pumping {
    /// Of the late samples of a run; `None` without a body force.
    pub(crate) fn of(configuration: &Configuration, late: &[Sample]) -> Option<Self> {
        let body_force = configuration.drive.body_force;
        if body_force == 0.0 {
            return None;
        }
        let mean =
            |value: fn(&Sample) -> f64| late.iter().map(value).sum::<f64>() / late.len() as f64;
        let useful_power = -mean(|sample| sample.body_power);
        let wall_power = mean(|sample| sample.wall_power);
        let efficiency = if useful_power > 0.0 && wall_power > 0.0 {
            useful_power / wall_power
        } else {
            f64::NAN
        };
        let beyond = |sample: &Sample| -sample.body_power - efficiency * sample.wall_power;
        Some(Self {
            body_force,
            pressure_rise: configuration.pressure_rise(),
            useful_power,
            useful_power_error: error_of(late.iter().map(|sample| sample.body_power)),
            efficiency,
            efficiency_error: error_of(late.iter().map(beyond)) / wall_power,
        })
    }
}

/// Mean time that a grain takes through the length of the tube.
///
/// T = N/J (Little's law), N the grains inside and J their flow rate
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Residence {
    /// T \[t\].
    pub(crate) time: f64,
    /// Its standard error, that of N - T J over J.
    pub(crate) error: f64,
}

impl Residence {
    /// Of the late samples of a run; `None` unless the grains go along the wave.
    pub(crate) fn of(late: &[Sample]) -> Option<Self> {
        let number = late.len() as f64;
        let inside = late.iter().map(|sample| sample.inside).sum::<f64>() / number;
        let flow = late.iter().map(|sample| sample.flow_rate).sum::<f64>() / number;
        (flow > 0.0).then(|| {
            let time = inside / flow;
            let beyond = |sample: &Sample| sample.inside - time * sample.flow_rate;
            Self {
                time,
                error: error_of(late.iter().map(beyond)) / flow,
            }
        })
    }
}

/// Coefficient of axial dispersion, D = d var(z - <z>)/(2 dt), and its error \[d^2/t\]; NaN below two whole late periods.
///
/// The variance is that of the displacements since an origin in the late part of the run.
pub(crate) fn axial_dispersion(late: &[Sample], dispersion: &AxialDispersion) -> (f64, f64) {
    let start = late.first().map_or(0.0, |sample| sample.time);
    let rates = dispersion.rates_from(start);
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    (mean, error_of(rates.into_iter()))
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::Sources;

    use super::*;

    fn samples(value: impl Fn(f64) -> Sample) -> Vec<Sample> {
        (0..40_u32)
            .map(|step| value(0.5 * f64::from(step)))
            .collect()
    }

    #[test]
    fn only_a_pump_that_pumps_has_an_efficiency() {
        let overrides = ["drive.body_force=-0.001".to_owned()];
        let configuration = Configuration::from_sources(&Sources {
            file: None,
            preset: Some("frictionless"),
            overrides: &overrides,
        })
        .unwrap();
        let pumping = |useful_power: f64, wall_power: f64| {
            let late = samples(|_| Sample {
                body_power: -useful_power,
                wall_power,
                ..Sample::default()
            });
            Pumping::of(&configuration, &late).unwrap()
        };
        let pumped = pumping(0.2, 0.8);
        assert!((pumped.efficiency - 0.25).abs() < 1e-12);
        assert!(pumped.efficiency_error.abs() < 1e-12);
        // Of an assisting force, of grains driven back, of a wall that stands still or takes power out.
        for (useful_power, wall_power) in [(-0.2, 0.8), (0.2, 0.0), (0.2, -0.8), (-0.2, -0.8)] {
            let none = pumping(useful_power, wall_power);
            assert!(none.efficiency.is_nan() && none.efficiency_error.is_nan());
            assert!((none.useful_power - useful_power).abs() < 1e-12);
        }
    }

    #[test]
    fn grains_leave_as_fast_as_they_come() {
        // 20 grains, J alternating between 3 and 5: 20/4; N - T J alternates by 5 about 0.
        let late = samples(|time| Sample {
            inside: 20.0,
            flow_rate: if ((2.0 * time) as u32).is_multiple_of(2) {
                3.0
            } else {
                5.0
            },
            ..Sample::default()
        });
        let residence = Residence::of(&late).unwrap();
        assert!((residence.time - 5.0).abs() < 1e-12);
        assert!(residence.error >= 0.0 && residence.error < 0.3);
        let back = samples(|_| Sample {
            inside: 20.0,
            flow_rate: -1.0,
            ..Sample::default()
        });
        assert_eq!(Residence::of(&back), None);
    }
}
