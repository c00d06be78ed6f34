//! Schedules of the drive: by name or as tables, each checked at all times.

use super::Context;
use crate::canonical;
use crate::configuration::{Control, Drive, Tube};
use crate::document;
use crate::error::{Problem, ProblemKind};
use crate::keys::{
    DriveKeys, ScheduleFormName, ScheduleKeys, ScheduleName, ScheduleTableKeys,
    ScheduledParameterName,
};
use crate::schedule::{Schedule, ScheduleForm, ScheduledParameter};

const KEY: &str = "drive.schedule";

/// Largest force amplitude, strain rate and wave speed, as for the keys of the drive.
const LARGEST: f64 = 1e6;

/// The schedules, in the order of their parameters; `None` after a problem.
pub(super) fn schedules(
    keys: &DriveKeys,
    drive: &Drive,
    tube: &Tube,
    context: &mut Context<'_>,
) -> Option<Vec<Schedule>> {
    if keys.ramp_periods.is_some() && keys.schedule.is_none() {
        return context.refuse(
            &["drive.ramp_periods"],
            "drive.ramp_periods is given without a ramp",
            "add drive.schedule = \"ramp\", or remove drive.ramp_periods",
        );
    }
    let tables = match keys.schedule.as_ref() {
        None | Some(ScheduleKeys::Named(ScheduleName::Sudden)) => return Some(Vec::new()),
        Some(ScheduleKeys::Named(ScheduleName::Ramp)) => vec![plain_ramp(keys, context)?],
        Some(ScheduleKeys::One(table)) => vec![table.clone()],
        Some(ScheduleKeys::Several(tables)) => tables.clone(),
    };
    let name = |index: usize| match &keys.schedule {
        Some(ScheduleKeys::Several(_)) => format!("{KEY}[{index}]"),
        _ => KEY.to_owned(),
    };
    if tables.is_empty() {
        return refuse(context, drive, &[KEY.into()], "the list is empty");
    }
    if drive.strain_rate == 0.0 {
        let message = "a schedule counts in wave periods, and a static wave has none";
        return refuse(context, drive, &[KEY.into()], message);
    }
    let mut schedules = Vec::with_capacity(tables.len());
    for (index, table) in tables.iter().enumerate() {
        match (Scope { drive, tube }).schedule(table) {
            Ok(schedule) => schedules.push((schedule, index)),
            Err(Refusal { part, message }) => {
                return refuse(context, drive, &[name(index) + &part], &message);
            }
        }
    }
    schedules.sort_by_key(|(schedule, _)| schedule.parameter);
    for pair in schedules.windows(2) {
        if pair[0].0.parameter == pair[1].0.parameter {
            let places = [name(pair[1].1), name(pair[0].1)];
            return refuse(context, drive, &places, "two schedules for one parameter");
        }
    }
    let schedules = schedules.into_iter().map(|(schedule, _)| schedule);
    Some(schedules.collect())
}

fn plain_ramp(keys: &DriveKeys, context: &mut Context<'_>) -> Option<ScheduleTableKeys> {
    let Some(end) = keys.ramp_periods else {
        return context.refuse_as(
            ProblemKind::Missing,
            &[KEY],
            "drive.schedule = \"ramp\" needs drive.ramp_periods",
            "drive.ramp_periods = 2 lets the amplitude grow from nothing within two periods",
        );
    };
    Some(ScheduleTableKeys {
        end: Some(end),
        ..ScheduleTableKeys::default()
    })
}

/// Reports a problem with parts of schedules, by their full names, the first being to blame; always `None`.
fn refuse<T>(
    context: &mut Context<'_>,
    drive: &Drive,
    parts: &[String],
    message: &str,
) -> Option<T> {
    let (parameter, from, to, end, values) = match drive.control {
        Control::Strain { .. } => ("width", "3.0", "2.6", 100, "2.9, 2.7"),
        Control::Stress { .. } => ("force_amplitude", "0.003", "0.006", 20, "0.003, 0.006"),
    };
    let example = format!(
        "for example drive.schedule = {{ form = \"ramp\", parameter = \"{parameter}\", from = {from}, to = {to}, start = 0, \
         end = {end} }} or {{ form = \"steps\", parameter = \"{parameter}\", at = [0, {end}], values = [{values}] }}; \
         drive.schedule = \"sudden\" keeps the drive constant"
    );
    let table = context.table;
    let (key, _) = document::written(table, &parts[0]);
    let mut problem = Problem::new(ProblemKind::Inconsistent, format!("{key}: {message}"))
        .key(key)
        .help(example);
    for part in parts {
        if let (key, Some(origin)) = document::written(table, part) {
            problem = problem.at(origin, key);
        }
    }
    context.problems.push(problem);
    None
}

/// Why a schedule is refused: the part at fault, such as `.values[1]`, and its fault in words.
struct Refusal {
    part: String,
    message: String,
}

fn refusal<T>(part: impl Into<String>, message: impl Into<String>) -> Result<T, Refusal> {
    let (part, message) = (part.into(), message.into());
    Err(Refusal { part, message })
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
    fn schedule(&self, keys: &ScheduleTableKeys) -> Result<Schedule, Refusal> {
        let target = self.target(keys)?;
        check_keys(keys)?;
        let form = match keys.form {
            ScheduleFormName::Ramp => self.ramp(keys, &target)?,
            ScheduleFormName::Steps => ScheduleForm::Steps(self.points(keys, &target)?),
            ScheduleFormName::Course => ScheduleForm::Course(self.points(keys, &target)?),
        };
        Ok(Schedule {
            parameter: target.resolved,
            form,
            before: target.own,
        })
    }

    fn target(&self, keys: &ScheduleTableKeys) -> Result<Target, Refusal> {
        use ScheduledParameterName as Name;
        let of_the_control = match self.drive.control {
            Control::Strain { .. } => Name::Width,
            Control::Stress { .. } => Name::ForceAmplitude,
        };
        let written = keys.parameter.unwrap_or(of_the_control);
        let (radius, diameter) = (self.tube.radius, 2.0 * self.tube.radius);
        let (resolved, nothing, most) = match written {
            Name::StrainRate | Name::WaveSpeed => (ScheduledParameter::StrainRate, 0.0, LARGEST),
            Name::ForceAmplitude => (ScheduledParameter::ForceAmplitude, 0.0, LARGEST),
            Name::Width => (ScheduledParameter::Width, diameter, diameter),
            Name::Amplitude => (ScheduledParameter::Width, diameter, radius),
        };
        let Some(own) = self.drive.own(resolved) else {
            let message = match resolved {
                ScheduledParameter::Width => "the width belongs to drive.control = \"strain\"",
                _ => "force_amplitude belongs to drive.control = \"stress\"",
            };
            return refusal(".parameter", message);
        };
        Ok(Target {
            written,
            resolved,
            nothing,
            own,
            most,
        })
    }

    /// A value as written, in the unit of the resolved parameter.
    fn resolved(&self, value: f64, part: &str, target: &Target) -> Result<f64, Refusal> {
        if value > target.most {
            let (name, most) = (canonical::word(target.written), target.most);
            return refusal(part, format!("{name} = {value} is above {most}"));
        }
        Ok(match target.written {
            ScheduledParameterName::Amplitude => 2.0 * (self.tube.radius - value),
            ScheduledParameterName::WaveSpeed => value / self.tube.wavelength,
            // One zero, not two.
            _ => value + 0.0,
        })
    }

    fn ramp(&self, keys: &ScheduleTableKeys, target: &Target) -> Result<ScheduleForm, Refusal> {
        let Some(end) = keys.end else {
            return refusal("", "a ramp needs its end, in wave periods");
        };
        let start = keys.start.unwrap_or(0.0) + 0.0;
        if end <= start {
            let message = format!("the ramp ends at {end}, not after its start at {start}");
            return refusal(".end", message);
        }
        let value = |part: &str, written: Option<f64>, otherwise: f64| match written {
            Some(value) => self.resolved(value, part, target),
            None => Ok(otherwise),
        };
        let from = value(".from", keys.from, target.nothing)?;
        let to = value(".to", keys.to, target.own)?;
        Ok(ScheduleForm::Ramp([(start, from), (end, to)]))
    }

    /// Times and values of steps or of a course.
    fn points(
        &self,
        keys: &ScheduleTableKeys,
        target: &Target,
    ) -> Result<Vec<(f64, f64)>, Refusal> {
        // A course jumps where it has two values at one time.
        let (needs, most, but) = match keys.form {
            ScheduleFormName::Course => ("a course needs", 2, " (two may be equal)"),
            _ => ("steps need", 1, ""),
        };
        let (Some(at), Some(values)) = (&keys.at, &keys.values) else {
            return refusal("", format!("{needs} both at and values"));
        };
        if at.len() != values.len() {
            let message = format!("{} times in at, but {} values", at.len(), values.len());
            return refusal(".values", message);
        }
        let mut points = Vec::with_capacity(at.len());
        for index in 1..at.len() {
            // Behind the one before, or behind as many equal ones as there may be.
            let is_equal = index >= most && at[index - most] == at[index];
            if at[index] < at[index - 1] || is_equal {
                let message = format!("the times in at do not ascend{but}");
                return refusal(format!(".at[{index}]"), message);
            }
        }
        for (index, (time, value)) in at.iter().zip(values).enumerate() {
            let value = self.resolved(*value, &format!(".values[{index}]"), target)?;
            points.push((time + 0.0, value));
        }
        Ok(points)
    }
}

/// Refuses keys that belong to another form.
fn check_keys(keys: &ScheduleTableKeys) -> Result<(), Refusal> {
    let takes = match keys.form {
        ScheduleFormName::Ramp => "a ramp takes from, to, start and end, not at and values",
        ScheduleFormName::Steps => "steps take at and values, not from, to, start or end",
        ScheduleFormName::Course => "a course takes at and values, not from, to, start or end",
    };
    let is_ramp = keys.form == ScheduleFormName::Ramp;
    let parts = [
        (".at", is_ramp && keys.at.is_some()),
        (".values", is_ramp && keys.values.is_some()),
        (".from", !is_ramp && keys.from.is_some()),
        (".to", !is_ramp && keys.to.is_some()),
        (".start", !is_ramp && keys.start.is_some()),
        (".end", !is_ramp && keys.end.is_some()),
    ];
    match parts.iter().find(|(_, is_foreign)| *is_foreign) {
        Some((part, _)) => refusal(*part, takes),
        None => Ok(()),
    }
}
