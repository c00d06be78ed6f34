//! Schedules of the drive: by name or as tables, each checked at all times.

use super::{Context, is_table};
use crate::configuration::{Control, Drive, Tube};
use crate::error::ProblemKind;
use crate::keys::{DriveKeys, ScheduleKeys, ScheduleTableKeys};
use crate::options::{ScheduleFormName, ScheduleName, ScheduledParameterName};
use crate::schedule::{Schedule, ScheduleForm, ScheduledParameter};

const KEY: &str = "drive.schedule";

/// Largest force amplitude, strain rate and wave speed, as for the keys of the drive.
const LARGEST: f64 = 1e6;

/// The name of a parameter in TOML.
fn word(parameter: ScheduledParameterName) -> &'static str {
    match parameter {
        ScheduledParameterName::Width => "width",
        ScheduledParameterName::Amplitude => "amplitude",
        ScheduledParameterName::ForceAmplitude => "force_amplitude",
        ScheduledParameterName::StrainRate => "strain_rate",
        ScheduledParameterName::WaveSpeed => "wave_speed",
    }
}

/// The schedules, in the order of their parameters; `None` after a problem.
pub(super) fn schedules(
    keys: &DriveKeys,
    drive: &Drive,
    tube: &Tube,
    context: &mut Context<'_>,
) -> Option<Vec<Schedule>> {
    if keys.ramp_periods.is_some() && keys.schedule.is_none() {
        context.refuse(
            ProblemKind::Inconsistent,
            &["drive.ramp_periods"],
            "drive.ramp_periods is given without a ramp".into(),
            "add drive.schedule = \"ramp\", or remove drive.ramp_periods".into(),
        );
        return None;
    }
    let tables = match keys.schedule.as_ref() {
        None | Some(ScheduleKeys::Named(ScheduleName::Sudden)) => return Some(Vec::new()),
        Some(ScheduleKeys::Named(ScheduleName::Ramp)) => vec![plain_ramp(keys, context)?],
        Some(ScheduleKeys::One(table)) => vec![table.clone()],
        Some(ScheduleKeys::Several(tables)) => tables.clone(),
    };
    if drive.strain_rate == 0.0 && !tables.is_empty() {
        refuse(
            context,
            "a schedule counts in wave periods, and a static wave has none".into(),
        );
        return None;
    }
    let scope = Scope { drive, tube };
    let schedules: Option<Vec<Schedule>> = tables
        .iter()
        .map(|table| scope.schedule(table, context))
        .collect();
    let mut schedules = schedules?;
    schedules.sort_by_key(|schedule| schedule.parameter);
    if schedules
        .windows(2)
        .any(|pair| pair[0].parameter == pair[1].parameter)
    {
        refuse(context, "two schedules for one parameter".into());
        return None;
    }
    Some(schedules)
}

fn plain_ramp(keys: &DriveKeys, context: &mut Context<'_>) -> Option<ScheduleTableKeys> {
    if keys.ramp_periods.is_none() {
        context.refuse(
            ProblemKind::Missing,
            &[KEY],
            "drive.schedule = \"ramp\" needs drive.ramp_periods".into(),
            "drive.ramp_periods = 2 lets the amplitude grow from nothing within two periods".into(),
        );
    }
    Some(ScheduleTableKeys {
        form: ScheduleFormName::Ramp,
        parameter: None,
        from: None,
        to: None,
        start: None,
        end: Some(keys.ramp_periods?),
        at: None,
        values: None,
    })
}

fn refuse(context: &mut Context<'_>, message: String) {
    let example = if is_table(context, KEY) {
        "for example drive.schedule = { form = \"ramp\", parameter = \"width\", from = 3.0, to = 2.6, start = 0, end = 100 } or { form = \"steps\", parameter = \"width\", at = [0, 100], values = [2.9, 2.7] }"
    } else {
        "drive.schedule = \"sudden\" keeps the drive constant"
    };
    context.refuse(
        ProblemKind::Inconsistent,
        &[KEY],
        format!("{KEY}: {message}"),
        example.into(),
    );
}

/// What a schedule is resolved against.
struct Scope<'a> {
    drive: &'a Drive,
    tube: &'a Tube,
}

/// A scheduled parameter as it is written, and what it resolves to.
struct Target {
    written: ScheduledParameterName,
    resolved: ScheduledParameter,
    /// Value without drive, in the resolved unit.
    nothing: f64,
    /// Value of the drive, in the resolved unit.
    own: f64,
    /// Largest value as written.
    most: f64,
}

impl Scope<'_> {
    fn schedule(&self, keys: &ScheduleTableKeys, context: &mut Context<'_>) -> Option<Schedule> {
        let target = self.target(keys, context)?;
        let form = match keys.form {
            ScheduleFormName::Ramp => self.ramp(keys, &target, context)?,
            ScheduleFormName::Steps => ScheduleForm::Steps {
                steps: self.points(keys, &target, context)?,
            },
            ScheduleFormName::Course => ScheduleForm::Course {
                knots: self.points(keys, &target, context)?,
            },
        };
        Some(Schedule {
            parameter: target.resolved,
            form,
            before: target.own,
        })
    }

    fn target(&self, keys: &ScheduleTableKeys, context: &mut Context<'_>) -> Option<Target> {
        use ScheduledParameterName as Name;
        let of_the_control = match self.drive.control {
            Control::Strain { .. } => Name::Width,
            Control::Stress { .. } => Name::ForceAmplitude,
        };
        let written = keys.parameter.unwrap_or(of_the_control);
        let diameter = 2.0 * self.tube.radius;
        let (resolved, nothing, own, most) = match (written, self.drive.control) {
            (Name::StrainRate | Name::WaveSpeed, _) => (
                ScheduledParameter::StrainRate,
                0.0,
                self.drive.strain_rate,
                LARGEST,
            ),
            (Name::Width, Control::Strain { width }) => {
                (ScheduledParameter::Width, diameter, width, diameter)
            }
            (Name::Amplitude, Control::Strain { width }) => {
                (ScheduledParameter::Width, diameter, width, self.tube.radius)
            }
            (
                Name::ForceAmplitude,
                Control::Stress {
                    force_amplitude, ..
                },
            ) => (
                ScheduledParameter::ForceAmplitude,
                0.0,
                force_amplitude,
                LARGEST,
            ),
            (Name::ForceAmplitude, Control::Strain { .. }) => {
                refuse(
                    context,
                    "force_amplitude belongs to drive.control = \"stress\"".into(),
                );
                return None;
            }
            (Name::Width | Name::Amplitude, Control::Stress { .. }) => {
                refuse(
                    context,
                    "the width belongs to drive.control = \"strain\"".into(),
                );
                return None;
            }
        };
        Some(Target {
            written,
            resolved,
            nothing,
            own,
            most,
        })
    }

    /// A value as written, in the unit of the resolved parameter.
    fn resolved(&self, value: f64, target: &Target, context: &mut Context<'_>) -> Option<f64> {
        if value > target.most {
            let (name, most) = (word(target.written), target.most);
            refuse(context, format!("{name} = {value} is above {most}"));
            return None;
        }
        Some(match target.written {
            ScheduledParameterName::Amplitude => 2.0 * (self.tube.radius - value),
            ScheduledParameterName::WaveSpeed => value / self.tube.wavelength,
            // One zero, not two.
            _ => value + 0.0,
        })
    }

    fn ramp(
        &self,
        keys: &ScheduleTableKeys,
        target: &Target,
        context: &mut Context<'_>,
    ) -> Option<ScheduleForm> {
        if keys.at.is_some() || keys.values.is_some() {
            refuse(
                context,
                "a ramp takes from, to, start and end, not at and values".into(),
            );
            return None;
        }
        let Some(end) = keys.end else {
            refuse(context, "a ramp needs its end, in wave periods".into());
            return None;
        };
        let start = keys.start.unwrap_or(0.0) + 0.0;
        if end <= start {
            refuse(
                context,
                format!("the ramp ends at {end}, not after its start at {start}"),
            );
            return None;
        }
        let from = match keys.from {
            Some(value) => self.resolved(value, target, context)?,
            None => target.nothing,
        };
        let to = match keys.to {
            Some(value) => self.resolved(value, target, context)?,
            None => target.own,
        };
        Some(ScheduleForm::Ramp {
            from,
            to,
            start,
            end,
        })
    }

    /// Times and values of steps or of a course.
    fn points(
        &self,
        keys: &ScheduleTableKeys,
        target: &Target,
        context: &mut Context<'_>,
    ) -> Option<Vec<(f64, f64)>> {
        // A course jumps where it has two values at one time.
        let (takes, needs, most, but) = match keys.form {
            ScheduleFormName::Course => {
                ("a course takes", "a course needs", 2, " (two may be equal)")
            }
            _ => ("steps take", "steps need", 1, ""),
        };
        let all_equal = |times: &[f64]| times.iter().all(|time| *time == times[0]);
        let of_a_ramp = [keys.from, keys.to, keys.start, keys.end];
        if of_a_ramp.iter().any(Option::is_some) {
            refuse(
                context,
                format!("{takes} at and values, not from, to, start or end"),
            );
            return None;
        }
        let (Some(at), Some(values)) = (&keys.at, &keys.values) else {
            refuse(context, format!("{needs} both at and values"));
            return None;
        };
        if at.len() != values.len() {
            let (times, values) = (at.len(), values.len());
            refuse(context, format!("{times} times in at, but {values} values"));
            return None;
        }
        if at.windows(2).any(|pair| pair[0] > pair[1]) || at.windows(most + 1).any(all_equal) {
            refuse(context, format!("the times in at do not ascend{but}"));
            return None;
        }
        let values: Option<Vec<f64>> = values
            .iter()
            .map(|value| self.resolved(*value, target, context))
            .collect();
        Some(at.iter().map(|time| time + 0.0).zip(values?).collect())
    }
}
