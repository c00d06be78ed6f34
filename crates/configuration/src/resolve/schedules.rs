//! Schedules of the drive: by name or as tables, each checked at all times.

use super::Context;
use crate::canonical::name;
use crate::configuration::{Control, Drive, Tube};
use crate::document::{self, Item, Node};
use crate::error::{Problem, ProblemKind};
use crate::keys::{
    DriveKeys, ScheduleFormName, ScheduleKeys, ScheduleName, ScheduleTableKeys,
    ScheduledParameterName,
};
use crate::schedule::{Schedule, ScheduleForm, ScheduledParameter};
use crate::source::Origin;

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
    let whole = Written {
        item: document::entry(context.table, KEY).map(|entry| &entry.item),
        index: None,
    };
    if tables.is_empty() {
        let message = "the list is empty".to_owned();
        return refuse(context, drive, &[(whole, Part::Whole)], message);
    }
    if drive.strain_rate == 0.0 {
        let message = "a schedule counts in wave periods, and a static wave has none".to_owned();
        return refuse(context, drive, &[(whole, Part::Whole)], message);
    }
    let schedules: Option<Vec<(Schedule, Written<'_>)>> = tables
        .iter()
        .enumerate()
        .map(|(index, keys)| {
            let scope = Scope {
                drive,
                tube,
                written: whole.nth(index),
            };
            Some((scope.schedule(keys, context)?, scope.written))
        })
        .collect();
    let mut schedules = schedules?;
    schedules.sort_by_key(|(schedule, _)| schedule.parameter);
    let twice = schedules
        .windows(2)
        .find(|pair| pair[0].0.parameter == pair[1].0.parameter);
    if let Some([(_, first), (_, second)]) = twice {
        let message = "two schedules for one parameter".to_owned();
        let places = [(*second, Part::Whole), (*first, Part::Whole)];
        return refuse(context, drive, &places, message);
    }
    Some(
        schedules
            .into_iter()
            .map(|(schedule, _)| schedule)
            .collect(),
    )
}

/// A schedule as it is written: by name, as a table, or as one of a list.
#[derive(Clone, Copy)]
struct Written<'a> {
    item: Option<&'a Item>,
    index: Option<usize>,
}

/// A part of a schedule as it is written.
#[derive(Clone, Copy)]
enum Part {
    Whole,
    Key(&'static str),
    /// One of the values of a key, from 0 on.
    Of(&'static str, usize),
}

impl<'a> Written<'a> {
    /// The schedule of that number in a list; a single table is the whole list.
    fn nth(self, index: usize) -> Self {
        match self.item.map(|item| &item.node) {
            Some(Node::Array(items)) => Self {
                item: items.get(index).or(self.item),
                index: Some(index),
            },
            _ => self,
        }
    }

    /// Full name of a part, and where it stands; that of the whole where the part is not written.
    fn place(self, part: Part) -> (String, Option<&'a Origin>) {
        let path = match self.index {
            Some(index) => format!("{KEY}[{index}]"),
            None => KEY.to_owned(),
        };
        let (key, index) = match part {
            Part::Whole => ("", None),
            Part::Key(key) => (key, None),
            Part::Of(key, index) => (key, Some(index)),
        };
        let value = match self.item.map(|item| &item.node) {
            Some(Node::Table(table)) => table.get(key).map(|entry| &entry.item),
            _ => None,
        };
        let Some(value) = value else {
            return (path, self.item.map(|item| &item.origin));
        };
        match (&value.node, index) {
            (Node::Array(items), Some(index)) if index < items.len() => {
                (format!("{path}.{key}[{index}]"), Some(&items[index].origin))
            }
            _ => (format!("{path}.{key}"), Some(&value.origin)),
        }
    }
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

/// Reports a problem with parts of schedules, the first being to blame; always `None`.
fn refuse<T>(
    context: &mut Context<'_>,
    drive: &Drive,
    parts: &[(Written<'_>, Part)],
    message: String,
) -> Option<T> {
    let example = match drive.control {
        Control::Strain { .. } => {
            "for example drive.schedule = { form = \"ramp\", parameter = \"width\", from = 3.0, to = 2.6, start = 0, end = 100 } \
             or { form = \"steps\", parameter = \"width\", at = [0, 100], values = [2.9, 2.7] }; drive.schedule = \"sudden\" \
             keeps the drive constant"
        }
        Control::Stress { .. } => {
            "for example drive.schedule = { form = \"ramp\", parameter = \"force_amplitude\", from = 0.003, to = 0.006, start = \
             0, end = 20 } or { form = \"steps\", parameter = \"force_amplitude\", at = [0, 20], values = [0.003, 0.006] }; \
             drive.schedule = \"sudden\" keeps the drive constant"
        }
    };
    let places: Vec<(String, Option<&Origin>)> = parts
        .iter()
        .map(|(written, part)| written.place(*part))
        .collect();
    let key = &places[0].0;
    let mut problem = Problem::new(ProblemKind::Inconsistent, format!("{key}: {message}"))
        .key(key)
        .help(example);
    for (key, origin) in &places {
        if let Some(origin) = origin {
            problem = problem.at(origin, key);
        }
    }
    context.problems.push(places[0].1, problem);
    None
}

/// What a schedule is resolved against.
struct Scope<'a> {
    drive: &'a Drive,
    tube: &'a Tube,
    written: Written<'a>,
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
    /// Reports a problem with a part of this schedule; always `None`.
    fn refuse<T>(
        &self,
        context: &mut Context<'_>,
        part: Part,
        message: impl Into<String>,
    ) -> Option<T> {
        refuse(context, self.drive, &[(self.written, part)], message.into())
    }

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
                let message = "force_amplitude belongs to drive.control = \"stress\"";
                return self.refuse(context, Part::Key("parameter"), message);
            }
            (Name::Width | Name::Amplitude, Control::Stress { .. }) => {
                let message = "the width belongs to drive.control = \"strain\"";
                return self.refuse(context, Part::Key("parameter"), message);
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
    fn resolved(
        &self,
        value: f64,
        part: Part,
        target: &Target,
        context: &mut Context<'_>,
    ) -> Option<f64> {
        if value > target.most {
            let (name, most) = (name(target.written), target.most);
            return self.refuse(context, part, format!("{name} = {value} is above {most}"));
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
        let of_points = [("at", &keys.at), ("values", &keys.values)];
        if let Some((key, _)) = of_points.iter().find(|(_, given)| given.is_some()) {
            let message = "a ramp takes from, to, start and end, not at and values";
            return self.refuse(context, Part::Key(key), message);
        }
        let Some(end) = keys.end else {
            let message = "a ramp needs its end, in wave periods";
            return self.refuse(context, Part::Whole, message);
        };
        let start = keys.start.unwrap_or(0.0) + 0.0;
        if end <= start {
            let message = format!("the ramp ends at {end}, not after its start at {start}");
            return self.refuse(context, Part::Key("end"), message);
        }
        let from = match keys.from {
            Some(value) => self.resolved(value, Part::Key("from"), target, context)?,
            None => target.nothing,
        };
        let to = match keys.to {
            Some(value) => self.resolved(value, Part::Key("to"), target, context)?,
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
        let of_a_ramp = [
            ("from", keys.from),
            ("to", keys.to),
            ("start", keys.start),
            ("end", keys.end),
        ];
        if let Some((key, _)) = of_a_ramp.iter().find(|(_, given)| given.is_some()) {
            let message = format!("{takes} at and values, not from, to, start or end");
            return self.refuse(context, Part::Key(key), message);
        }
        let (Some(at), Some(values)) = (&keys.at, &keys.values) else {
            let message = format!("{needs} both at and values");
            return self.refuse(context, Part::Whole, message);
        };
        if at.len() != values.len() {
            let message = format!("{} times in at, but {} values", at.len(), values.len());
            return self.refuse(context, Part::Key("values"), message);
        }
        // Behind the one before, or behind as many equal ones as there may be.
        let behind = |index: usize| {
            at[index] < at[index - 1] || index >= most && at[index - most] == at[index]
        };
        if let Some(index) = (1..at.len()).find(|&index| behind(index)) {
            let message = format!("the times in at do not ascend{but}");
            return self.refuse(context, Part::Of("at", index), message);
        }
        let values: Option<Vec<f64>> = values
            .iter()
            .enumerate()
            .map(|(index, value)| self.resolved(*value, Part::Of("values", index), target, context))
            .collect();
        Some(at.iter().map(|time| time + 0.0).zip(values?).collect())
    }
}
