//! Layers over one another: alternatives that exclude each other, and keys that a choice above makes meaningless.

use crate::document::{self, Entry, Node, Table};
use crate::error::{Problem, ProblemKind, Problems};

/// Keys of which exactly one is given; a choice in a higher layer replaces the one below.
pub(crate) const ALTERNATIVES: [&[&str]; 4] = [
    &[
        "grains.number",
        "grains.volume_fraction",
        "grains.number_density",
    ],
    &["drive.width", "drive.amplitude"],
    &[
        "drive.strain_rate",
        "drive.wave_speed",
        "units.wave_frequency",
    ],
    &["run.periods", "run.duration"],
];

/// A key whose value decides which other keys have a meaning.
pub(crate) struct Switch {
    pub(crate) key: &'static str,
    /// (value, keys that belong to it alone)
    pub(crate) owners: &'static [(&'static str, &'static [&'static str])],
    /// Keys that are dropped whenever a higher layer changes the switch.
    pub(crate) reset: &'static [&'static str],
}

/// Every switch of the vocabulary.
pub(crate) const SWITCHES: [Switch; 4] = [
    Switch {
        key: "drive.control",
        owners: &[
            ("strain", &["drive.width", "drive.amplitude"]),
            (
                "stress",
                &[
                    "drive.force_amplitude",
                    "drive.angle",
                    "wall.sphere_mass",
                    "wall.spring_stiffness",
                    "wall.natural_length",
                    "wall.contact_range",
                    "wall.drag",
                    "wall.spring_damping",
                    "wall.keep",
                ],
            ),
        ],
        reset: &["drive.schedule", "drive.ramp_periods"],
    },
    Switch {
        key: "contact.law",
        owners: &[
            (
                "linear",
                &[
                    "contact.normal_stiffness",
                    "contact.normal_damping",
                    "units.stiffness",
                ],
            ),
            (
                "hertz",
                &[
                    "contact.young_modulus",
                    "contact.poisson_ratio",
                    "contact.dissipation_time",
                    "contact.dissipation_form",
                    "units.young_modulus",
                ],
            ),
        ],
        reset: &[],
    },
    Switch {
        key: "initial.state",
        owners: &[],
        reset: &["initial.axial_velocity"],
    },
    Switch {
        key: "drive.schedule",
        owners: &[("ramp", &["drive.ramp_periods"])],
        reset: &["drive.ramp_periods"],
    },
];

/// Lays `layer` over `base`.
pub(crate) fn lay_over(base: &mut Table, layer: Table, problems: &mut Problems) {
    for group in ALTERNATIVES {
        let given: Vec<&str> = group
            .iter()
            .copied()
            .filter(|key| document::entry(&layer, key).is_some())
            .collect();
        if given.len() > 1 {
            refuse_two(&layer, &given, group, problems);
        }
        if !given.is_empty() {
            for key in group {
                document::remove(base, key);
            }
        }
    }
    for switch in &SWITCHES {
        drop_meaningless(base, &layer, switch);
    }
    // A schedule is one thing: half of an old one under half of a new one has no meaning.
    if document::entry(&layer, "drive.schedule").is_some() {
        document::remove(base, "drive.schedule");
    }
    merge(base, layer);
}

fn refuse_two(layer: &Table, given: &[&str], group: &[&str], problems: &mut Problems) {
    let mut entries: Vec<(&str, &Entry)> = given
        .iter()
        .filter_map(|key| Some((*key, document::entry(layer, key)?)))
        .collect();
    entries.sort_by_key(|(_, entry)| entry.key.span.start);
    let message = format!(
        "{} exclude one another; exactly one is given",
        list(given, "and")
    );
    let mut problem = Problem::new(ProblemKind::Conflict, message)
        .key(entries[0].0)
        .help(format!("keep one of {}", list(group, "or")));
    for (key, entry) in &entries {
        problem = problem.at(&entry.key, format!("{key} is given here"));
    }
    problems.push(Some(&entries[0].1.key), problem);
}

/// Takes out of `base` what a choice in `layer` leaves without meaning.
fn drop_meaningless(base: &mut Table, layer: &Table, switch: &Switch) {
    if document::entry(layer, switch.key).is_none() {
        return;
    }
    let chosen = document::text(layer, switch.key);
    for (value, keys) in switch.owners {
        if chosen != Some(value) {
            for key in *keys {
                document::remove(base, key);
            }
        }
    }
    if chosen.is_none() || chosen != document::text(base, switch.key) {
        for key in switch.reset {
            document::remove(base, key);
        }
    }
}

/// Tables are merged key by key, all other values replaced.
fn merge(base: &mut Table, layer: Table) {
    for (key, mut entry) in layer {
        if let Node::Table(above) = &mut entry.item.node
            && let Some(below) = base.get_mut(&key)
            && let Node::Table(table) = &mut below.item.node
        {
            merge(table, std::mem::take(above));
            below.key = entry.key;
            below.item.origin = entry.item.origin;
            continue;
        }
        base.insert(key, entry);
    }
}

/// Joins layers of settings into one; the last value of a key holds.
pub fn join(overrides: Vec<Table>) -> Table {
    let mut layer = Table::new();
    for table in overrides {
        merge(&mut layer, table);
    }
    layer
}

/// Refuses keys that belong to another value of a switch than the one chosen.
pub(crate) fn check_switches(table: &Table, problems: &mut Problems) {
    for switch in &SWITCHES {
        let Some(chosen_entry) = document::entry(table, switch.key) else {
            continue;
        };
        let chosen = document::text(table, switch.key);
        for (value, keys) in switch.owners {
            if chosen == Some(value) {
                continue;
            }
            for key in *keys {
                let Some(entry) = document::entry(table, key) else {
                    continue;
                };
                let message = format!(
                    "{key} belongs to {} = \"{value}\", but here it is {}",
                    switch.key,
                    chosen.map_or("a table".to_owned(), |name| format!("\"{name}\"")),
                );
                let problem = Problem::new(ProblemKind::Conflict, message)
                    .key(*key)
                    .at(
                        &entry.key,
                        format!("has no meaning under this {}", switch.key),
                    )
                    .at(
                        &chosen_entry.item.origin,
                        format!("{} is chosen here", switch.key),
                    )
                    .help(format!("remove {key}, or set {} = \"{value}\"", switch.key));
                problems.push(Some(&entry.key), problem);
            }
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
