//! Layers over one another: alternatives that exclude each other, and keys that a choice above makes meaningless.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::ends::Ends;
use peristalsis_physics::sizes::SizeForm;
use peristalsis_physics::wall::{Arrangement, ElasticNetwork, SegmentDrive};

use crate::document::{self, Entry, Node, Table};
use crate::error::{Problem, ProblemKind, Problems};
use crate::keys::{DAMPINGS, OPEN, RINGS, exclusive_groups};
use crate::materials::{self, MATERIAL};
use crate::schema::{self, Choice};
use crate::source::SourceFile;
use crate::units;
use crate::waveform::WaveformName;
use crate::word;

/// A key whose value decides which other keys have a meaning.
#[derive(Default)]
struct Switch {
    key: String,
    /// Its value where it is not given.
    default: Option<String>,
    /// Keys that belong to some of its values, with these values.
    owned: BTreeMap<String, Vec<String>>,
    /// Keys that are dropped whenever a higher layer changes the switch.
    reset: &'static [&'static str],
}

impl Switch {
    fn new(key: impl Into<String>, reset: &'static [&'static str]) -> Self {
        let key = key.into();
        Self {
            key,
            reset,
            ..Self::default()
        }
    }

    /// A switch that has a value where it is not given.
    fn by_default(key: &str, default: impl Into<String>) -> Self {
        Self {
            default: Some(default.into()),
            ..Self::new(key, &[])
        }
    }

    /// Its value in a table.
    fn chosen<'a>(&'a self, table: &'a Table) -> Option<&'a str> {
        match document::entry(table, &self.key) {
            Some(_) => document::text(table, &self.key),
            None => self.default.as_deref(),
        }
    }

    /// Notes that a key belongs to a value.
    fn owns(&mut self, value: &str, key: impl Into<String>) {
        let values = self.owned.entry(key.into()).or_default();
        values.push(value.to_owned());
    }

    /// Keys, each with the values that it belongs to, that have no meaning under a choice.
    fn meaningless(&self, chosen: Option<&str>) -> impl Iterator<Item = (&String, &Vec<String>)> {
        let has_chosen = move |values: &[String]| values.iter().any(|it| Some(&**it) == chosen);
        let owned = self.owned.iter();
        owned.filter(move |(_, values)| !has_chosen(values))
    }
}

/// Every switch of the vocabulary.
static SWITCHES: LazyLock<Vec<Switch>> = LazyLock::new(|| {
    let mut switches: Vec<Switch> = schema::CHOICES.iter().map(switch_of).collect();
    switches.push(Switch::new("initial.state", &["initial.axial_velocity"]));
    let mut schedule = Switch::new("drive.schedule", &["drive.ramp_periods"]);
    schedule.owns("ramp", "drive.ramp_periods");
    switches.push(schedule);
    let mut arrangement = Switch::by_default("tube.arrangement", word(Arrangement::default()));
    arrangement.reset = &["tube.arrangement_seed"];
    for one in Arrangement::ALL {
        let name = word(one);
        if one.is_drawn() {
            arrangement.owns(&name, "tube.arrangement_seed");
        }
        if one.has_spheres() {
            for key in RINGS {
                arrangement.owns(&name, key);
            }
        }
    }
    for key in ["tube.file", "tube.angles", "tube.places"] {
        arrangement.owns(&word(Arrangement::File), key);
    }
    switches.push(arrangement);
    let mut sizes = Switch::by_default("grains.sizes", word(SizeForm::default()));
    for (form, keys) in [
        (
            SizeForm::Lognormal,
            &["diameter_median", "diameter_spread"][..],
        ),
        (SizeForm::Two, &["large_fraction", "large_volume_fraction"]),
        (SizeForm::Table, &["file", "diameters", "fractions"]),
    ] {
        for key in keys {
            sizes.owns(&word(form), format!("grains.{key}"));
        }
    }
    switches.push(sizes);
    let mut ends = Switch::by_default("tube.ends", word(Ends::default()));
    for key in OPEN {
        ends.owns(&word(Ends::Open), key);
    }
    switches.push(ends);
    let mut waveform = Switch::by_default("drive.waveform", word(WaveformName::default()));
    let segments = schema::of::<SegmentDrive>();
    for (name, _) in segments["properties"].as_object().into_iter().flatten() {
        waveform.owns(&word(WaveformName::Segments), format!("drive.{name}"));
    }
    for name in ["table", "phases", "radii"] {
        waveform.owns(&word(WaveformName::Table), format!("drive.{name}"));
    }
    switches.push(waveform);
    switches
});

/// The switch of a choice: the keys of its values, the alternatives to them, and what goes with them in other tables.
fn switch_of(choice: &Choice) -> Switch {
    let reset: &[&str] = match choice.table {
        "drive" => &["drive.schedule", "drive.ramp_periods"],
        _ => &[],
    };
    let mut switch = Switch::new(format!("{}.{}", choice.table, choice.key), reset);
    for value in &choice.values {
        for name in value.keys.keys() {
            let key = format!("{}.{name}", choice.table);
            let mut groups = exclusive_groups();
            match groups.find(|group| group.contains(&key.as_str())) {
                Some(group) => group.iter().for_each(|key| switch.owns(&value.name, *key)),
                None => switch.owns(&value.name, key),
            }
        }
        match switch.key.as_str() {
            "contact.law" => {
                if let Some(law) = schema::law_of(&value.name) {
                    switch.owns(&value.name, units::elasticity_key(law.elasticity()));
                }
            }
            "drive.control" if value.name == "stress" => {
                let network = schema::of::<ElasticNetwork>();
                for (name, _) in network["properties"].as_object().into_iter().flatten() {
                    switch.owns(&value.name, format!("wall.{name}"));
                }
            }
            _ => {}
        }
    }
    switch
}

/// Whether the wall of a table is smooth, so that it has no rings.
pub(crate) fn is_smooth(table: &Table) -> bool {
    document::text(table, "tube.arrangement") == Some("smooth")
}

/// Whether a key has a meaning where the switches stand as they do in a table.
pub(crate) fn has_meaning(table: &Table, key: &str) -> bool {
    let lacks_it = |switch: &Switch| {
        let mut without = switch.meaningless(switch.chosen(table));
        without.any(|(owned, _)| owned == key)
    };
    !SWITCHES.iter().any(lacks_it)
}

const SCHEDULE: &str = "drive.schedule";

/// Where `layer` gives keys of a schedule without its form, they change the schedule of `base`: its other keys are added.
pub(crate) fn complete_schedule(base: &Table, layer: &mut Table) {
    let below = document::entry(base, SCHEDULE).map(|entry| &entry.item.node);
    if let Some(Node::Table(below)) = below
        && let Some(above) = document::table_mut(layer, SCHEDULE)
        && !above.contains_key("form")
    {
        for (key, entry) in below {
            above.entry(key.clone()).or_insert_with(|| entry.clone());
        }
    }
}

/// Lays `layer` over `base`.
pub(crate) fn lay_over(base: &mut Table, layer: Table, problems: &mut Problems) {
    for group in exclusive_groups() {
        let given = group.iter().copied();
        let given = given.filter_map(|key| Some((key, document::entry(&layer, key)?)));
        let given: Vec<(&str, &Entry)> = given.collect();
        if given.is_empty() {
            continue;
        }
        if given.len() > 1 {
            problems.push(conflict(&given, group));
        }
        for key in group {
            document::remove(base, key);
        }
    }
    if document::entry(&layer, MATERIAL).is_some() {
        materials::replace(base);
    }
    // A damping takes the place of a restitution with its speed.
    if DAMPINGS
        .iter()
        .any(|[damping, _]| document::entry(&layer, damping).is_some())
    {
        document::remove(base, "contact.restitution_speed");
    }
    for switch in &*SWITCHES {
        drop_meaningless(base, &layer, switch);
    }
    // A schedule is one thing: half of an old one under half of a new one has no meaning.
    if document::entry(&layer, SCHEDULE).is_some() {
        document::remove(base, SCHEDULE);
    }
    document::merge(base, layer);
}

/// The problem of several keys of a group of alternatives.
fn conflict(given: &[(&str, &Entry)], group: &[&str]) -> Problem {
    let names: Vec<&str> = given.iter().map(|(key, _)| *key).collect();
    let names = list(&names, "and");
    let message = format!("{names} exclude one another; only one of them can be given");
    let mut given = given.to_vec();
    given.sort_by_key(|(_, entry)| entry.key.span.start);
    let mut problem = Problem::new(ProblemKind::Conflict, message)
        .key(given[0].0)
        .help(format!("keep one of {}", list(group, "or")));
    for (key, entry) in given {
        problem = problem.at(&entry.key, format!("{key} is given here"));
    }
    problem
}

/// Takes out of `base` what a choice in `layer` leaves without meaning.
fn drop_meaningless(base: &mut Table, layer: &Table, switch: &Switch) {
    if document::entry(layer, &switch.key).is_none() {
        return;
    }
    let chosen = document::text(layer, &switch.key);
    for (key, _) in switch.meaningless(chosen) {
        document::remove(base, key);
    }
    if chosen.is_none() || chosen != document::text(base, &switch.key) {
        for key in switch.reset {
            document::remove(base, key);
        }
    }
}

/// Parses a file with settings over it, a document of another kind that someone else checks and resolves.
pub fn file_with_overrides(
    file: SourceFile<'_>,
    overrides: &[String],
    problems: &mut Problems,
) -> Table {
    let mut table = document::parse_file(file, problems);
    for text in overrides {
        document::merge(&mut table, document::parse_override(text, problems));
    }
    table
}

/// Joins layers of settings into one; the last value of a key holds.
pub fn join(overrides: Vec<Table>) -> Table {
    let mut layer = Table::new();
    for table in overrides {
        document::merge(&mut layer, table);
    }
    layer
}

/// Refuses keys that belong to another value of a switch than the one chosen.
pub(crate) fn check_switches(table: &Table, problems: &mut Problems) {
    for switch in &*SWITCHES {
        let choice = document::entry(table, &switch.key);
        if choice.is_none() && switch.default.is_none() {
            continue;
        }
        let (name, chosen) = (&switch.key, switch.chosen(table));
        let here = chosen.map_or("a table".to_owned(), |chosen| format!("\"{chosen}\""));
        for (key, values) in switch.meaningless(chosen) {
            let Some(entry) = document::entry(table, key) else {
                continue;
            };
            let values: Vec<String> = values.iter().map(|value| format!("\"{value}\"")).collect();
            let values: Vec<&str> = values.iter().map(String::as_str).collect();
            let owner = format!("{name} = {}", list(&values, "or"));
            let message = format!("{key} belongs to {owner}, but here it is {here}");
            let mut problem = Problem::new(ProblemKind::Conflict, message)
                .key(key)
                .at(&entry.key, format!("has no meaning under this {name}"))
                .help(format!("remove {key}, or set {owner}"));
            if let Some(choice) = choice {
                problem = problem.at(&choice.item.origin, format!("{name} is chosen here"));
            }
            problems.push(problem);
        }
    }
}

/// `a`, `a or b`, `a, b or c`.
pub(crate) fn list(words: &[&str], last: &str) -> String {
    match words {
        [] => String::new(),
        [word] => (*word).to_owned(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}
