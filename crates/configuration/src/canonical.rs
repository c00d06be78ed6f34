//! The canonical written form of a configuration: the record of a run, and its hashes.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::configuration::Configuration;
use crate::entries::{Entry, Role, Value};
use crate::schedule::{Schedule, ScheduleForm, ScheduledParameter};

impl Configuration {
    /// Every resolved value as TOML that reads back as the same configuration, bit for bit.
    ///
    /// Of alternatives it states number, width, strain_rate and periods (duration for a static wave); the others and
    /// all derived values stand in the table `[resolved]`, which the reader ignores.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = String::from(
            "# The configuration of a run with every value resolved. It can be run again as it stands.\n",
        );
        let mut table = "";
        for entry in self.entries().0 {
            if entry.table != table {
                if table == "drive" {
                    self.write_schedules(&mut text);
                }
                table = entry.table;
                append(&mut text, format_args!("\n[{table}]\n"));
            }
            append(
                &mut text,
                format_args!("{} = {}\n", entry.key, entry.value.toml()),
            );
        }
        text.push_str("\n# Derived from the keys above; read and ignored.\n[resolved]\n");
        for (key, value) in self.derived() {
            append(&mut text, format_args!("{key} = {}\n", value.toml()));
        }
        text
    }

    /// SHA-256 of everything that determines the trajectory: grains, contact, tube, drive, wall, initial state, time
    /// step, integrator, kernel, skin of the neighbour search (the last two by rounding only) and seed.
    ///
    /// The same for configurations that differ in the length of the run, in what is measured, in the order of keys, or in
    /// the alternative given where it resolves to the same bits.
    #[must_use]
    pub fn physics_hash(&self) -> [u8; 32] {
        self.hash("peristalsis physics 1\n", |role| role == Role::Physics)
    }

    /// SHA-256 of every resolved value: that of [`Configuration::physics_hash`] with the length of the run and what is
    /// measured.
    #[must_use]
    pub fn run_hash(&self) -> [u8; 32] {
        self.hash("peristalsis run 1\n", |_| true)
    }

    fn hash(&self, heading: &str, counts: impl Fn(Role) -> bool) -> [u8; 32] {
        let mut text = heading.to_owned();
        for entry in self.entries().0.iter().filter(|entry| counts(entry.role)) {
            let Entry {
                table, key, value, ..
            } = entry;
            append(&mut text, format_args!("{table}.{key}={}\n", value.bits()));
        }
        for schedule in &self.drive.schedules {
            append(
                &mut text,
                format_args!("{}:", parameter_name(schedule.parameter)),
            );
            for (time, value) in schedule.knots() {
                let (time, value) = (Value::Number(time).bits(), Value::Number(value).bits());
                append(&mut text, format_args!("{time},{value};"));
            }
            text.push('\n');
        }
        Sha256::digest(text.as_bytes()).into()
    }

    fn write_schedules(&self, text: &mut String) {
        for schedule in &self.drive.schedules {
            text.push_str("\n[[drive.schedule]]\n");
            write_schedule(schedule, text);
        }
    }
}

fn parameter_name(parameter: ScheduledParameter) -> &'static str {
    match parameter {
        ScheduledParameter::Width => "width",
        ScheduledParameter::ForceAmplitude => "force_amplitude",
        ScheduledParameter::StrainRate => "strain_rate",
    }
}

fn write_schedule(schedule: &Schedule, text: &mut String) {
    let list = |numbers: &mut dyn Iterator<Item = f64>| {
        numbers
            .map(|number| Value::Number(number).toml())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let parameter = parameter_name(schedule.parameter);
    match &schedule.form {
        ScheduleForm::Ramp {
            from,
            to,
            start,
            end,
        } => {
            append(
                text,
                format_args!("form = \"ramp\"\nparameter = \"{parameter}\"\n"),
            );
            append(text, format_args!("from = {from:?}\nto = {to:?}\n"));
            append(text, format_args!("start = {start:?}\nend = {end:?}\n"));
        }
        ScheduleForm::Steps { steps: points } | ScheduleForm::Course { knots: points } => {
            let form = match &schedule.form {
                ScheduleForm::Course { .. } => "course",
                _ => "steps",
            };
            append(
                text,
                format_args!("form = \"{form}\"\nparameter = \"{parameter}\"\n"),
            );
            let times = list(&mut points.iter().map(|(time, _)| *time));
            let values = list(&mut points.iter().map(|(_, value)| *value));
            append(text, format_args!("at = [{times}]\nvalues = [{values}]\n"));
        }
    }
}

fn append(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    text.write_fmt(arguments)
        .expect("writing to a string cannot fail");
}
