//! From layers of keys to one resolved configuration.

mod drive;
mod grains;
mod run;
mod schedules;
mod tube;
mod units;

use serde::de::DeserializeOwned;

use crate::configuration::{Configuration, Contact, Friction, Initial, NormalLaw, Observe, Wall};
use crate::contract;
use crate::defaults;
use crate::document::{self, Table};
use crate::error::{ConfigurationError, Problem, ProblemKind, Problems};
use crate::keys::{ContactKeys, Keys, ObserveKeys};
use crate::layers::{self, ALTERNATIVES, list};
use crate::options::{ControlName, DissipationForm, InitialState, NormalLawName, Sliding};
use crate::presets::{PRESETS, preset};
use crate::source::{Origin, Source, SourceKind, Sources};
use crate::suggestion;

impl Configuration {
    /// Reads a preset, a file and overrides, checks them, and resolves what they leave open.
    ///
    /// Any text is safe to give: what is wrong with it becomes an error, never a panic.
    ///
    /// # Errors
    ///
    /// Everything found wrong, in the order of the texts: first what is wrong with single keys, and where all of these
    /// are right, what is wrong with their values together.
    pub fn from_sources(sources: &Sources<'_>) -> Result<Self, ConfigurationError> {
        Self::from_sources_and(sources, &[])
    }

    /// As [`Configuration::from_sources`], with more layers over them, the last one on top: tables of a document that
    /// states several configurations, such as a study.
    ///
    /// # Errors
    ///
    /// As [`Configuration::from_sources`].
    pub fn from_sources_and(
        sources: &Sources<'_>,
        above: &[Table],
    ) -> Result<Self, ConfigurationError> {
        let mut problems = Problems::default();
        let table = layered(sources, above, &mut problems);
        problems.check()?;
        layers::check_switches(&table, &mut problems);
        let keys: Option<Keys> = deserialised(&table, &mut problems);
        if let Some(keys) = &keys {
            check_given(keys, &table, sources, &mut problems);
        }
        problems.check()?;
        let keys = keys.expect("without problems the keys have been read");
        let mut context = Context {
            table: &table,
            problems: &mut problems,
        };
        let configuration = configuration(&keys, &mut context);
        problems.check()?;
        Ok(configuration.expect("without problems everything has been resolved"))
    }

    /// Reads one text that stands for itself, as `to_toml` writes it.
    ///
    /// # Errors
    ///
    /// As [`Configuration::from_sources`].
    pub fn from_toml(name: &str, text: &str) -> Result<Self, ConfigurationError> {
        let file = Some(crate::source::SourceFile { name, text });
        Self::from_sources(&Sources {
            file,
            preset: None,
            overrides: &[],
        })
    }
}

/// All layers, checked one by one and laid over one another.
fn layered(sources: &Sources<'_>, above: &[Table], problems: &mut Problems) -> Table {
    let file = sources.file.map(|file| {
        let source = Source::new(SourceKind::File, file.name, file.text);
        checked(document::parse(&source, problems), problems)
    });
    let overrides = sources
        .overrides
        .iter()
        .map(|text| document::parse_override(text, problems));
    let overrides = layers::join(overrides.collect());
    if let Some(entry) = overrides.get("preset") {
        let problem = Problem::new(
            ProblemKind::Preset,
            "a preset cannot be chosen by an override",
        )
        .key("preset")
        .at(&entry.key, "here")
        .help("name it with --preset, or in the file as preset = \"...\"");
        problems.push(Some(&entry.key), problem);
    }
    refuse_derived(&overrides, problems);
    let overrides = checked(overrides, problems);
    let mut table = Table::new();
    if let Some(name) = preset_name(sources.preset, file.as_ref(), problems)
        && let Some(preset) = preset(&name)
    {
        let source = Source::new(
            SourceKind::Preset,
            format!("preset {}", preset.name),
            preset.text,
        );
        table = checked(document::parse(&source, problems), problems);
    }
    let above = above.iter().map(|layer| {
        refuse_derived(layer, problems);
        checked(layer.clone(), problems)
    });
    let above: Vec<Table> = above.collect();
    for layer in file.into_iter().chain([overrides]).chain(above) {
        layers::lay_over(&mut table, layer, problems);
    }
    for aside in ["preset", "resolved"] {
        table.remove(aside);
    }
    table
}

/// Derived values are read with the record of a run that states them; to set one has no effect, and must not seem to.
fn refuse_derived(layer: &Table, problems: &mut Problems) {
    if let Some(entry) = layer.get("resolved") {
        let problem = Problem::new(
            ProblemKind::UnknownKey,
            "the values below `resolved` follow from the other keys and cannot be set",
        )
        .key("resolved")
        .at(&entry.key, "has no effect")
        .help("set the keys that they follow from; `peristalsis schema` lists them");
        problems.push(Some(&entry.key), problem);
    }
}

fn checked(layer: Table, problems: &mut Problems) -> Table {
    contract::check(&layer, problems);
    layer
}

/// The one preset that command line and file name.
fn preset_name(
    asked: Option<&str>,
    file: Option<&Table>,
    problems: &mut Problems,
) -> Option<String> {
    let written = file.and_then(|file| {
        Some((
            document::text(file, "preset")?,
            &document::entry(file, "preset")?.item.origin,
        ))
    });
    match (asked, written) {
        (None, None) => None,
        (None, Some((name, _))) => Some(name.to_owned()),
        (Some(name), written) => {
            if preset(name).is_none() {
                problems.push(None, unknown_preset(name));
            } else if let Some((other, origin)) = written
                && other != name
            {
                let message = format!("the file builds on preset {other:?}, --preset is {name:?}");
                let problem = Problem::new(ProblemKind::Preset, message)
                    .key("preset")
                    .at(origin, "the file's preset")
                    .help("leave out --preset, or the file's `preset`");
                problems.push(Some(origin), problem);
            }
            Some(name.to_owned())
        }
    }
}

fn unknown_preset(name: &str) -> Problem {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    let near = suggestion::nearest(name, names.iter().copied());
    let guess = near
        .map(|near| format!("did you mean {near}? "))
        .unwrap_or_default();
    Problem::new(ProblemKind::Preset, format!("there is no preset {name:?}"))
        .key("preset")
        .help(format!("{guess}presets: {}", names.join(", ")))
}

/// The keys by serde. The contract has refused what it cannot read, so a problem here is a gap in the contract; it is
/// reported with its place all the same.
fn deserialised<T: DeserializeOwned>(table: &Table, problems: &mut Problems) -> Option<T> {
    match serde_path_to_error::deserialize(document::to_toml(table)) {
        Ok(keys) => Some(keys),
        Err(error) => {
            let path = error.path().to_string();
            let origin = document::entry(table, &path).map(|entry| entry.item.origin.clone());
            let message = format!("{path}: {}", error.inner().message());
            let mut problem = Problem::new(ProblemKind::WrongType, message).key(path);
            if let Some(origin) = &origin {
                problem = problem.at(origin, "this value");
            }
            problems.push(origin.as_ref(), problem);
            None
        }
    }
}

/// Names every key that is needed and not given, in one problem.
fn check_given(keys: &Keys, table: &Table, sources: &Sources<'_>, problems: &mut Problems) {
    let given = |key: &str| document::entry(table, key).is_some();
    let mut missing: Vec<String> = Vec::new();
    let plain = [
        "contact.law",
        "tube.radius",
        "tube.wavelength",
        "tube.waves",
        "tube.spheres_per_ring",
        "tube.rings_per_wave",
        "drive.control",
    ];
    missing.extend(
        plain
            .iter()
            .filter(|key| !given(key))
            .map(ToString::to_string),
    );
    for group in ALTERNATIVES {
        let belongs = group[0] != "drive.width" || keys.drive.control == Some(ControlName::Strain);
        if belongs && !group.iter().any(|key| given(key)) {
            missing.push(list(group, "or"));
        }
    }
    if keys.drive.control == Some(ControlName::Stress) && !given("drive.force_amplitude") {
        missing.push("drive.force_amplitude".into());
    }
    let Some(first) = missing.first() else { return };
    let name = sources
        .file
        .map(|file| format!("{}: ", file.name))
        .unwrap_or_default();
    let message = match missing.as_slice() {
        [one] => format!("{name}{one} is missing"),
        several => format!("{name}these keys are missing: {}", several.join("; ")),
    };
    let key = first
        .split([',', ' '])
        .next()
        .unwrap_or_default()
        .to_owned();
    let mut problem = Problem::new(ProblemKind::Missing, message).key(&key);
    // A preset gives the tube: without one there is no preset.
    let with_preset = !missing.iter().any(|key| key.starts_with("tube."));
    problem = if missing.len() == 1 {
        problem.help(format!("{key}: {}", contract::allowed(schema_of(&key))))
    } else if with_preset {
        problem.help("give them in the file or with --set")
    } else {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        problem.help(format!(
            "give them, or build on a preset: `preset = \"{}\"` at the top of the file, or --preset (one of {})",
            names[0],
            names.join(", ")
        ))
    };
    let place = key
        .split_once('.')
        .and_then(|(table_name, _)| table.get(table_name))
        .map(|entry| entry.key.clone());
    if let Some(place) = &place {
        problem = problem.at(place, "would stand in this table");
    }
    problems.push(place.as_ref(), problem);
}

/// Schema of a key by its full name.
fn schema_of(key: &str) -> &'static serde_json::Value {
    let root = crate::schema::cached();
    key.split('.')
        .fold(root, |schema, name| &schema["properties"][name])
}

/// What the parts of the resolution share: where the keys stand, and the problems found.
struct Context<'a> {
    table: &'a Table,
    problems: &'a mut Problems,
}

impl Context<'_> {
    /// Where the value of a key was written.
    fn origin(&self, key: &str) -> Option<Origin> {
        document::entry(self.table, key).map(|entry| entry.item.origin.clone())
    }

    /// The key of the given ones that was written.
    fn written<'k>(&self, keys: &[&'k str]) -> &'k str {
        let found = keys
            .iter()
            .find(|key| document::entry(self.table, key).is_some());
        found.copied().unwrap_or(keys[0])
    }

    /// A problem with the values of some keys together, the first being to blame.
    fn refuse(&mut self, kind: ProblemKind, keys: &[&str], message: String, help: String) {
        let mut places: Vec<(&str, Origin)> = keys
            .iter()
            .filter_map(|key| Some((*key, self.origin(key)?)))
            .collect();
        // What a higher layer changed is nearer to the cause than what a preset states.
        places.sort_by_key(|(_, origin)| std::cmp::Reverse(origin.source.kind));
        let mut problem = Problem::new(kind, message).key(keys[0]).help(help);
        for (key, origin) in &places {
            problem = problem.at(origin, format!("{key} = {}", shown(origin)));
        }
        self.problems
            .push(places.first().map(|(_, origin)| origin), problem);
    }
}

/// A value as it was written, shortened where it is a long table.
fn shown(origin: &Origin) -> String {
    let text = origin.text();
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text.to_owned(),
    }
}

fn configuration(keys: &Keys, context: &mut Context<'_>) -> Option<Configuration> {
    let contact = contact(&keys.contact, context);
    let tube = tube::tube(keys, context);
    let sphere_diameter = keys.wall.sphere_diameter.unwrap_or(defaults::DIAMETER);
    let grains = tube.and_then(|tube| grains::grains(&keys.grains, &tube, context));
    if let (Some(tube), Some(grains)) = (&tube, &grains) {
        tube::check_length(tube, grains.diameter_max.max(sphere_diameter), context);
    }
    let units = contact.and_then(|contact| units::units(&keys.units, &contact, context));
    let drive = tube.and_then(|tube| drive::drive(keys, &tube, units.flatten().as_ref(), context));
    let observe = observe(&keys.observe);
    let run = match (&drive, &grains) {
        (Some(drive), Some(grains)) => run::run(&keys.run, drive, grains, &observe, context),
        _ => None,
    };
    let mut configuration = Configuration {
        grains: grains?,
        contact: contact?,
        tube: tube?,
        drive: drive?,
        wall: Wall { sphere_diameter },
        initial: Initial {
            state: keys.initial.state.unwrap_or(InitialState::Rest),
            axial_velocity: 0.0,
        },
        run: run?,
        observe,
        units: units?,
    };
    configuration.initial.axial_velocity = match keys.initial.axial_velocity {
        // One zero, not two.
        Some(velocity) => velocity + 0.0,
        None => configuration.natural_axial_velocity(),
    };
    Some(configuration)
}

fn contact(keys: &ContactKeys, context: &mut Context<'_>) -> Option<Contact> {
    let normal = match keys.law? {
        NormalLawName::Linear => NormalLaw::Linear {
            normal_stiffness: keys.normal_stiffness.unwrap_or(defaults::NORMAL_STIFFNESS),
            normal_damping: keys.normal_damping.unwrap_or(defaults::NORMAL_DAMPING),
        },
        NormalLawName::Hertz => NormalLaw::Hertz {
            young_modulus: keys.young_modulus.unwrap_or(defaults::YOUNG_MODULUS),
            poisson_ratio: keys.poisson_ratio.unwrap_or(defaults::POISSON_RATIO),
            dissipation_time: keys.dissipation_time.unwrap_or(defaults::DISSIPATION_TIME),
            dissipation_form: keys
                .dissipation_form
                .unwrap_or(DissipationForm::Viscoelastic),
        },
    };
    let static_friction = keys
        .static_friction
        .or(keys.kinetic_friction)
        .unwrap_or(0.0);
    let kinetic_friction = keys.kinetic_friction.unwrap_or(static_friction);
    if kinetic_friction > static_friction {
        context.refuse(
            ProblemKind::Inconsistent,
            &["contact.kinetic_friction", "contact.static_friction"],
            format!(
                "contact.kinetic_friction = {kinetic_friction} is above contact.static_friction = {static_friction}"
            ),
            format!(
                "kinetic friction is at most the static one: set contact.kinetic_friction to at most {static_friction} (both to 0 for frictionless grains)"
            ),
        );
        return None;
    }
    let friction = (static_friction > 0.0).then(|| Friction {
        tangential_stiffness: keys
            .tangential_stiffness
            .unwrap_or(defaults::TANGENTIAL_STIFFNESS),
        tangential_damping: keys
            .tangential_damping
            .unwrap_or(defaults::TANGENTIAL_DAMPING),
        static_friction,
        kinetic_friction,
        sliding: keys.sliding.unwrap_or(Sliding::Spring),
    });
    Some(Contact { normal, friction })
}

fn observe(keys: &ObserveKeys) -> Observe {
    Observe {
        samples_per_period: keys
            .samples_per_period
            .unwrap_or(defaults::SAMPLES_PER_PERIOD),
        profile_bins: keys.profile_bins.unwrap_or(defaults::PROFILE_BINS),
        late_fraction: keys.late_fraction.unwrap_or(defaults::LATE_FRACTION),
        transition_threshold: keys
            .transition_threshold
            .unwrap_or(defaults::TRANSITION_THRESHOLD),
    }
}
