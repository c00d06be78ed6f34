//! A change of the drive while a run is under way, written down as a schedule.

use crate::configuration::{Configuration, Control};
use crate::error::{ConfigurationError, Problem, ProblemKind};
use crate::schedule::{Schedule, ScheduleForm, ScheduledParameter};
use crate::source::{SourceFile, Sources};

impl Configuration {
    /// The value of a parameter of the drive at a time in periods; `None` where this drive has no such parameter.
    #[must_use]
    pub fn drive_value(&self, parameter: ScheduledParameter, periods: f64) -> Option<f64> {
        let own = match (parameter, self.drive.control) {
            (ScheduledParameter::StrainRate, _) => self.drive.strain_rate,
            (ScheduledParameter::Width, Control::Strain { width }) => width,
            (
                ScheduledParameter::ForceAmplitude,
                Control::Stress {
                    force_amplitude, ..
                },
            ) => force_amplitude,
            _ => return None,
        };
        let scheduled = self
            .drive
            .schedules
            .iter()
            .find(|schedule| schedule.parameter == parameter);
        Some(scheduled.map_or(own, |schedule| schedule.value(periods)))
    }

    /// The same configuration, but that a parameter of the drive has a new value from a time in periods on.
    ///
    /// What was changed becomes a schedule of steps, so that the answer, run from the start, is the run that was changed
    /// on its way. Steps that were planned for later are dropped; the value that the parameter has already changes
    /// nothing.
    ///
    /// # Errors
    /// A value out of range, a parameter that this drive does not have, one that follows a ramp, a static wave.
    pub fn with_drive_step(
        &self,
        parameter: ScheduledParameter,
        periods: f64,
        value: f64,
    ) -> Result<Self, ConfigurationError> {
        let name = match parameter {
            ScheduledParameter::Width => "drive.width",
            ScheduledParameter::ForceAmplitude => "drive.force_amplitude",
            ScheduledParameter::StrainRate => "drive.strain_rate",
        };
        let refused = |message: String, help: &str| {
            let problem = Problem::new(ProblemKind::Inconsistent, message);
            Err(ConfigurationError::new(vec![problem.key(name).help(help)]))
        };
        let Some(before) = self.drive_value(parameter, periods) else {
            return refused(
                format!("{name} is no parameter of this drive"),
                "drive.width belongs to drive.control = \"strain\", drive.force_amplitude to \"stress\"",
            );
        };
        let mut changed = self.clone();
        let schedules = &mut changed.drive.schedules;
        let place = schedules
            .iter()
            .position(|schedule| schedule.parameter == parameter);
        match place.map(|place| &mut schedules[place].form) {
            Some(ScheduleForm::Ramp { .. }) => {
                return refused(
                    format!("{name} follows a ramp, and cannot be changed as well"),
                    "leave the ramp out, or let it end the changes",
                );
            }
            _ if value == before => return Ok(changed),
            Some(ScheduleForm::Steps { steps }) => {
                steps.retain(|step| step.0 < periods);
                steps.push((periods, value));
            }
            None => {
                schedules.push(Schedule {
                    parameter,
                    form: ScheduleForm::Steps {
                        steps: vec![(periods, value)],
                    },
                    before,
                });
                schedules.sort_by_key(|schedule| schedule.parameter);
            }
        }
        if !value.is_finite() || value < 0.0 {
            return refused(
                format!("{name} = {value} is not a number from 0 on"),
                "give a number that is 0 or more",
            );
        }
        // What is read is checked as a whole.
        Self::from_sources(&Sources {
            file: Some(SourceFile {
                name: "the changed drive",
                text: &changed.to_toml(),
            }),
            preset: None,
            overrides: &[],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn narrow(overrides: &[&str]) -> Configuration {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        Configuration::from_sources(&Sources {
            file: None,
            preset: Some("frictionless"),
            overrides: &overrides,
        })
        .unwrap()
    }

    #[test]
    fn changes_become_the_steps_that_could_have_been_configured() {
        let changed = narrow(&["drive.width=2.7"])
            .with_drive_step(ScheduledParameter::Width, 1.5, 2.8)
            .unwrap()
            .with_drive_step(ScheduledParameter::Width, 3.0, 2.6)
            .unwrap();
        let configured = narrow(&[
            "drive.width=2.7",
            "drive.schedule={form=\"steps\", parameter=\"width\", at=[1.5, 3.0], values=[2.8, 2.6]}",
        ]);
        assert_eq!(changed, configured);
        let width = |periods| changed.drive_value(ScheduledParameter::Width, periods);
        assert_eq!(
            [width(1.0), width(2.0), width(4.0)],
            [Some(2.7), Some(2.8), Some(2.6)]
        );
    }

    #[test]
    fn what_is_later_is_replaced_and_what_is_the_same_is_nothing() {
        let plain = narrow(&["drive.width=2.7"]);
        let same = plain.with_drive_step(ScheduledParameter::Width, 1.0, 2.7);
        assert_eq!(same.unwrap(), plain);
        let early = plain
            .with_drive_step(ScheduledParameter::Width, 4.0, 2.9)
            .unwrap()
            .with_drive_step(ScheduledParameter::Width, 2.0, 2.8)
            .unwrap();
        assert_eq!(early.drive_value(ScheduledParameter::Width, 9.0), Some(2.8));
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        let plain = narrow(&["drive.width=2.7"]);
        let message = |parameter, value| {
            let refused = plain.with_drive_step(parameter, 1.0, value);
            refused.unwrap_err().to_string()
        };
        assert!(message(ScheduledParameter::Width, 3.2).contains("width = 3.2 is above 3"));
        assert!(message(ScheduledParameter::Width, -1.0).contains("drive.width = -1"));
        assert!(message(ScheduledParameter::Width, f64::NAN).contains("drive.width = NaN"));
        assert!(message(ScheduledParameter::ForceAmplitude, 0.1).contains("drive.force_amplitude"));
        let ramp = narrow(&[
            "drive.schedule={form=\"ramp\", parameter=\"width\", from=3.0, to=2.6, end=5}",
        ]);
        let refused = ramp.with_drive_step(ScheduledParameter::Width, 1.0, 2.8);
        assert!(refused.unwrap_err().to_string().contains("follows a ramp"));
    }
}
