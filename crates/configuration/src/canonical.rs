//! The canonical written form of a configuration: the record of a run, and its hashes.

use std::fmt::Display;

use peristalsis_physics::wall::Arrangement;
use serde::Serialize;
use sha2::{Digest, Sha256};
use toml::Value;

use crate::configuration::{Configuration, Control};
use crate::grains::Body;
use crate::keys::{ALTERNATIVES, RINGS};
use crate::schedule::{Schedule, ScheduleForm};

/// Tables and keys that do not change the trajectory: its length, the measurements, the units of the output.
const EXTENT: [&str; 4] = ["run.periods", "run.duration", "observe", "units"];

/// A key with its resolved value.
struct Entry {
    table: String,
    key: String,
    value: Value,
}

impl Entry {
    fn path(&self) -> String {
        format!("{}.{}", self.table, self.key)
    }

    fn determines_the_trajectory(&self) -> bool {
        !EXTENT.contains(&self.table.as_str()) && !EXTENT.contains(&self.path().as_str())
    }
}

impl Configuration {
    /// Every resolved value as TOML that reads back as the same configuration, bit for bit.
    ///
    /// Of alternatives it states number, width, strain_rate and periods (duration for a static wave); the others and
    /// all derived values stand in the table `[resolved]`, which the reader ignores.
    pub fn to_toml(&self) -> String {
        let mut text = String::from(
            "# The configuration of a run with every value resolved. It can be run again as it stands.\n",
        );
        let mut table = String::new();
        for entry in self.entries(self.initial_wave_speed()) {
            if entry.table != table {
                if table == "drive" {
                    for schedule in &self.drive.schedules {
                        text += "\n[[drive.schedule]]\n";
                        text += &lines(keys_of(schedule));
                    }
                }
                text += &format!("\n[{}]\n", entry.table);
                table = entry.table;
            }
            text += &lines([(entry.key, entry.value)]);
        }
        text += "\n# Derived from the keys above; read and ignored.\n[resolved]\n";
        text + &lines(self.derived())
    }

    /// SHA-256 of everything that determines the trajectory: grains, gravity, contact, tube, drive, wall, initial state, time
    /// step, integrator, kernel, skin of the neighbour search (the last two by rounding only) and seed.
    ///
    /// Two configurations have the same hash if they differ only in the length of the run, in the measurements, in the
    /// order of keys, or in the choice among alternative keys that resolve to the same bits.
    pub fn physics_hash(&self) -> [u8; 32] {
        self.hash("peristalsis physics 1\n", Entry::determines_the_trajectory)
    }

    /// SHA-256 of every resolved value: all that [`Configuration::physics_hash`] covers, the length of the run, and the
    /// measurements.
    pub fn run_hash(&self) -> [u8; 32] {
        self.hash("peristalsis run 1\n", |_| true)
    }

    fn hash(&self, heading: &str, counts: impl Fn(&Entry) -> bool) -> [u8; 32] {
        let mut text = heading.to_owned();
        // Hashes take the velocity of jammed grains over that of drive.strain_rate, whatever the schedule, as they did at first.
        for entry in self
            .entries(self.wave_speed())
            .iter()
            .filter(|entry| counts(entry))
        {
            let (path, value) = (entry.path(), bits(&entry.value));
            text += &format!("{path}={value}\n");
        }
        // An inlet that fills up at every look, as all did at first, adds nothing.
        let looks = self.looks_per_feeding();
        if looks > 1 {
            text += &format!("inlet.looks_per_feeding={looks}\n");
        }
        for schedule in &self.drive.schedules {
            text += &format!("{}:", word(schedule.parameter));
            for (time, value) in schedule.knots() {
                let (time, value) = (bits(&time.into()), bits(&value.into()));
                text += &format!("{time},{value};");
            }
            text.push('\n');
        }
        Sha256::digest(text.as_bytes()).into()
    }

    /// Every key with its resolved value, in the order of the types that hold them.
    ///
    /// What is not there is not listed: neither friction, units, an inlet, gravity or a body force that the run does without, nor a staggered
    /// arrangement, nor an initial velocity that the initial state has of itself in a wave of this speed, and of alternatives only the first.
    fn entries(&self, wave_speed: f64) -> Vec<Entry> {
        let mut tables =
            toml::Table::try_from(self).expect("a configuration consists of what TOML can hold");
        if self.contact.friction.is_none() {
            set(&mut tables, "contact", "static_friction", 0.0.into());
        }
        if self.drive.schedules.is_empty() {
            set(&mut tables, "drive", "schedule", "sudden".into());
        }
        let holds = |path: &&str| {
            let (table, key) = path.split_once('.').unwrap_or_default();
            tables
                .get(table)
                .is_some_and(|keys| keys.get(key).is_some())
        };
        let mut absent: Vec<&str> = Vec::new();
        for group in ALTERNATIVES {
            absent.extend(group.iter().copied().filter(holds).skip(1));
        }
        let mut entries = Vec::new();
        for (table, keys) in &tables {
            if let Value::Table(keys) = keys {
                list(table, keys, &mut entries);
            }
        }
        let natural = self.natural_axial_velocity(wave_speed);
        entries.retain(|entry| match entry.path().as_str() {
            "body.gravity" => self.body != Body::default(),
            "drive.body_force" => self.drive.body_force != 0.0,
            "tube.arrangement" => self.tube.arrangement != Arrangement::default(),
            "tube.arrangement_seed" => self.tube.arrangement.is_drawn(),
            path if RINGS.contains(&path) => self.tube.arrangement.has_spheres(),
            "initial.axial_velocity" => self.initial.axial_velocity.to_bits() != natural.to_bits(),
            "initial.temperature" => self.initial.temperature != 0.0,
            path => !absent.contains(&path),
        });
        entries
    }

    /// Values that follow from the keys.
    fn derived(&self) -> Vec<(&'static str, Value)> {
        let count = |number: u64| Value::Integer(number as i64);
        let mut derived: Vec<(&'static str, Value)> = vec![
            ("number", count(self.grains.number)),
            ("volume_fraction", self.volume_fraction().into()),
            ("number_density", self.number_density().into()),
            ("length", self.tube.length().into()),
            ("wall_spheres", count(self.tube.wall_spheres())),
            ("strain_rate", self.drive.strain_rate.into()),
            ("wave_speed", self.wave_speed().into()),
        ];
        if self.contact.friction.is_none() {
            derived.push(("kinetic_friction", 0.0.into()));
        }
        if let (Control::Strain { width }, Some(amplitude)) = (self.drive.control, self.amplitude())
        {
            derived.push(("width", width.into()));
            derived.push(("amplitude", amplitude.into()));
        }
        if let (Some(period), Some(periods)) = (self.drive.period(), self.run.periods) {
            derived.push(("period", period.into()));
            derived.push(("periods", periods.into()));
        }
        if self.axial_body_force() != 0.0 {
            derived.push(("pressure_rise", self.pressure_rise().into()));
        }
        if let Some(units) = &self.units {
            let frequency = self.drive.strain_rate / units.time();
            derived.extend([
                ("unit_mass_kg", units.mass().into()),
                ("unit_length_m", units.length().into()),
                ("unit_time_s", units.time().into()),
                ("wave_frequency_hz", frequency.into()),
            ]);
        }
        let hash = self.physics_hash().map(|byte| format!("{byte:02x}"));
        derived.extend([
            ("duration", self.run.duration.into()),
            ("time_step", self.run.time_step.into()),
            ("steps", count(self.run.steps())),
            ("steps_per_sample", count(self.run.steps_per_sample)),
            ("samples", count(self.run.samples)),
            ("axial_velocity", self.initial.axial_velocity.into()),
            ("physics_hash", hash.concat().into()),
        ]);
        derived
    }
}

fn set(tables: &mut toml::Table, table: &str, key: &str, value: Value) {
    if let Some(Value::Table(keys)) = tables.get_mut(table) {
        keys.insert(key.to_owned(), value);
    }
}

/// The keys of a table, then those of the tables in it.
fn list(table: &str, keys: &toml::Table, entries: &mut Vec<Entry>) {
    for (key, value) in keys.iter().filter(|(_, value)| !value.is_table()) {
        entries.push(Entry {
            table: table.to_owned(),
            key: key.clone(),
            value: value.clone(),
        });
    }
    for (key, value) in keys {
        if let Value::Table(inner) = value {
            list(&format!("{table}.{key}"), inner, entries);
        }
    }
}

/// Keys with their values, one a line.
fn lines<Key: Display>(keys: impl IntoIterator<Item = (Key, Value)>) -> String {
    let line = |(key, value): (Key, Value)| format!("{key} = {}\n", written(&value));
    keys.into_iter().map(line).collect()
}

/// As TOML; numbers with the fewest digits that read back as the same bits.
fn written(value: &Value) -> String {
    match value {
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(written).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Float(number) => format!("{number:?}"),
        Value::String(name) => format!("\"{name}\""),
        other => other.to_string(),
    }
}

/// For a hash: numbers by their bits, with one zero.
fn bits(value: &Value) -> String {
    match value {
        Value::Float(number) => format!("{:016x}", (number + 0.0).to_bits()),
        other => written(other),
    }
}

/// A choice in the word that it has in a configuration and in results.
pub fn word(choice: impl Serialize) -> String {
    match Value::try_from(choice) {
        Ok(Value::String(name)) => name,
        other => unreachable!("a choice is a name, not {other:?}"),
    }
}

/// The keys of a schedule in a table of its own.
fn keys_of(schedule: &Schedule) -> Vec<(&'static str, Value)> {
    let (form, keys) = match &schedule.form {
        ScheduleForm::Ramp([(start, from), (end, to)]) => {
            let keys = [("from", from), ("to", to), ("start", start), ("end", end)];
            let keys = keys.map(|(key, value)| (key, Value::from(*value)));
            ("ramp", keys.to_vec())
        }
        ScheduleForm::Steps(steps) => ("steps", keys_of_points(steps)),
        ScheduleForm::Course(knots) => ("course", keys_of_points(knots)),
    };
    let parameter = word(schedule.parameter);
    let names = [("form", form.into()), ("parameter", parameter.into())];
    names.into_iter().chain(keys).collect()
}

fn keys_of_points(points: &[(f64, f64)]) -> Vec<(&'static str, Value)> {
    let (times, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    vec![("at", times.into()), ("values", values.into())]
}
