//! From layers of keys to one resolved configuration.

mod body;
mod contact;
mod damping;
mod drive;
mod grains;
mod inlet;
mod kernel;
mod run;
mod schedules;
mod spheres;
mod tube;
mod units;

use peristalsis_physics::method::InitialState;
pub use spheres::{file_keys, file_of};

use crate::configuration::{Configuration, Control, FIRST_SEED, Wall};
use crate::contract;
use crate::document::{self, Table};
use crate::error::{ConfigurationError, Problem, ProblemKind, Problems};
use crate::keys::{ALTERNATIVES, Keys};
use crate::layers::{self, list};
use crate::materials;
use crate::presets::{Preset, preset, preset_names};
use crate::schema;
use crate::source::{Origin, Source, SourceFile, SourceKind, Sources};
use crate::suggestion;

impl Configuration {
    /// Reads a preset, a file and overrides, checks them, and resolves what they leave open.
    ///
    /// Any text is safe to give: a fault becomes an error, never a panic.
    ///
    /// # Errors
    ///
    /// All faults, in the order of the texts: first the faults of single keys. Only where no single key is at fault, the
    /// faults of values that do not go together.
    pub fn from_sources(sources: &Sources<'_>) -> Result<Self, ConfigurationError> {
        Self::from_sources_and(sources, &[])
    }

    /// The configuration of a preset with settings over it, such as `drive.width=2.7`.
    ///
    /// # Errors
    ///
    /// As [`Configuration::from_sources`].
    pub fn from_preset(name: &str, settings: &[impl ToString]) -> Result<Self, ConfigurationError> {
        Self::from_sources(&Sources {
            preset: Some(name),
            overrides: &settings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            ..Sources::default()
        })
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
        let mut table = layered(sources, above, &mut problems);
        problems.check()?;
        layers::check_switches(&table, &mut problems);
        check_given(&table, sources, &mut problems);
        problems.check()?;
        spheres::read(&mut table, &mut problems);
        problems.check()?;
        if layers::is_smooth(&table) {
            tube::without_rings(&mut table);
        }
        let keys = deserialised(&table)?;
        let mut context = Context {
            table: &table,
            problems: &mut problems,
        };
        let configuration = configuration(keys, &mut context);
        problems.check()?;
        Ok(configuration.expect("without problems everything has been resolved"))
    }

    /// Reads one text that stands for itself, as `to_toml` writes it.
    ///
    /// # Errors
    ///
    /// As [`Configuration::from_sources`].
    pub fn from_toml(name: &str, text: &str) -> Result<Self, ConfigurationError> {
        let file = Some(SourceFile { name, text });
        Self::from_sources(&Sources {
            file,
            ..Sources::default()
        })
    }
}

/// All layers, checked one by one and laid over one another.
fn layered(sources: &Sources<'_>, above: &[Table], problems: &mut Problems) -> Table {
    let file = sources
        .file
        .map(|file| document::parse_file(file, problems));
    let overrides = sources.overrides.iter();
    let overrides = overrides.map(|text| document::parse_override(text, problems));
    let overrides = layers::join(overrides.collect());
    if let Some(entry) = overrides.get("preset") {
        let message = "a preset cannot be chosen by an override";
        let problem = Problem::new(ProblemKind::Preset, message)
            .key("preset")
            .at(&entry.key, "here")
            .help("name it with --preset, or in the file as preset = \"...\"");
        problems.push(problem);
    }
    for layer in above.iter().chain([&overrides]) {
        refuse_derived(layer, problems);
    }
    let mut table = Table::new();
    if let Some(name) = preset_name(sources.preset, file.as_ref(), problems)
        && let Some(Preset { name, text, .. }) = preset(&name)
    {
        let source = Source::new(SourceKind::Preset, format!("preset {name}"), text);
        let preset = document::parse(&source, problems);
        contract::check(&preset, problems);
        layers::lay_over(&mut table, preset, problems);
    }
    let above = above.iter().cloned();
    for mut layer in file.into_iter().chain([overrides]).chain(above) {
        layers::complete_schedule(&table, &mut layer);
        contract::check(&layer, problems);
        layers::lay_over(&mut table, layer, problems);
    }
    for aside in ["preset", "resolved"] {
        table.remove(aside);
    }
    materials::fill(&mut table);
    table
}

/// Derived values are read with the record of a run that states them; to set one has no effect, and must not seem to.
fn refuse_derived(layer: &Table, problems: &mut Problems) {
    if let Some(entry) = layer.get("resolved") {
        let message = "the values below `resolved` follow from the other keys and cannot be set";
        let problem = Problem::new(ProblemKind::UnknownKey, message)
            .key("resolved")
            .at(&entry.key, "has no effect")
            .help("set the keys that they follow from; `peristalsis schema` lists them");
        problems.push(problem);
    }
}

/// The one preset that command line and file name.
fn preset_name(
    asked: Option<&str>,
    file: Option<&Table>,
    problems: &mut Problems,
) -> Option<String> {
    let entry = file.and_then(|file| document::entry(file, "preset"));
    let written = file.and_then(|file| document::text(file, "preset"));
    let Some(name) = asked else {
        return written.map(str::to_owned);
    };
    if preset(name).is_none() {
        problems.push(unknown_preset(name));
    } else if let (Some(other), Some(entry)) = (written, entry)
        && other != name
    {
        let message = format!("the file builds on preset {other:?}, --preset is {name:?}");
        let problem = Problem::new(ProblemKind::Preset, message)
            .key("preset")
            .at(&entry.item.origin, "the file's preset")
            .help("leave out --preset, or the file's `preset`");
        problems.push(problem);
    }
    Some(name.to_owned())
}

fn unknown_preset(name: &str) -> Problem {
    let names = preset_names();
    let guess = match suggestion::nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean {near}? "),
        None => String::new(),
    };
    Problem::new(ProblemKind::Preset, format!("there is no preset {name:?}"))
        .key("preset")
        .help(format!("{guess}presets: {}", names.join(", ")))
}

/// The keys by serde. The contract has refused what it cannot read, so an error here is a gap in the contract; it is
/// reported with its place all the same.
fn deserialised(table: &Table) -> Result<Keys, Problem> {
    serde_path_to_error::deserialize(document::to_toml(table)).map_err(|error| {
        let path = error.path().to_string();
        let message = format!("{path}: {}", error.inner().message());
        let mut problem = Problem::new(ProblemKind::WrongType, message);
        if let (_, Some(origin)) = document::written(table, &path) {
            problem = problem.at(origin, "this value");
        }
        problem.key(path)
    })
}

/// Names every key that is needed and not given, in one problem.
fn check_given(table: &Table, sources: &Sources<'_>, problems: &mut Problems) {
    let missing = missing(table);
    let Some(first) = missing.first() else { return };
    let name = sources
        .file
        .map(|file| format!("{}: ", file.name))
        .unwrap_or_default();
    let message = match missing.as_slice() {
        [one] => format!("{name}{one} is missing"),
        several => format!("{name}these keys are missing: {}", several.join("; ")),
    };
    let key = first.split([',', ' ']).next().unwrap_or_default();
    // A preset gives the tube: without one there is no preset.
    let with_preset = !missing.iter().any(|key| key.starts_with("tube."));
    let help = if missing.len() == 1 {
        format!("{key}: {}", contract::allowed(schema_of(key)))
    } else if with_preset {
        "give them in the file or with --set".to_owned()
    } else {
        let names = preset_names();
        format!(
            "give them, or build on a preset: `preset = \"{}\"` at the top of the file, or --preset (one of {})",
            names[0],
            names.join(", ")
        )
    };
    let mut problem = Problem::new(ProblemKind::Missing, message)
        .key(key)
        .help(help);
    let place = key
        .split_once('.')
        .and_then(|(table_name, _)| Some((table_name, &table.get(table_name)?.key)))
        // What a material stands for is in tables that nobody wrote.
        .filter(|(table_name, place)| place.text() == *table_name)
        .map(|(_, place)| place);
    if let Some(place) = place {
        problem = problem.at(place, "would stand in this table");
    }
    problems.push(problem);
}

/// The keys that are needed and not given, alternatives as one.
fn missing(table: &Table) -> Vec<String> {
    let given = |key: &str| document::entry(table, key).is_some();
    let mut missing = schema::REQUIRED.to_vec();
    missing.retain(|key| !given(key) && layers::has_meaning(table, key));
    let groups = ALTERNATIVES.iter().filter(|group| {
        layers::has_meaning(table, group[0]) && !group.iter().any(|key| given(key))
    });
    missing.extend(groups.map(|group| list(group, "or")));
    for choice in &*schema::CHOICES {
        let chosen = document::text(table, &format!("{}.{}", choice.table, choice.key));
        let values = choice.values.iter();
        let needed = values
            .filter(|value| Some(value.name.as_str()) == chosen)
            .flat_map(|value| &value.required)
            .map(|key| format!("{}.{key}", choice.table));
        missing.extend(needed.filter(|key| !given(key)));
    }
    missing
}

/// Schema of a key by its full name.
fn schema_of(key: &str) -> &'static serde_json::Value {
    key.split('.')
        .fold(&schema::SCHEMA, |schema, name| &schema["properties"][name])
}

/// What the parts of the resolution share: where the keys stand, and the problems found.
struct Context<'a> {
    table: &'a Table,
    problems: &'a mut Problems,
}

impl Context<'_> {
    /// Whether a key was written.
    fn given(&self, key: &str) -> bool {
        document::entry(self.table, key).is_some()
    }

    /// The key of the given ones that was written.
    fn written<'k>(&self, keys: &[&'k str]) -> &'k str {
        let found = keys.iter().find(|key| self.given(key));
        found.copied().unwrap_or(keys[0])
    }

    /// Notes that the values of some keys do not go together, the first being to blame; always `None`.
    fn refuse<T>(
        &mut self,
        keys: &[&str],
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.refuse_as(ProblemKind::Inconsistent, keys, message, help)
    }

    /// The same with a problem of another kind.
    fn refuse_as<T>(
        &mut self,
        kind: ProblemKind,
        keys: &[&str],
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.report(kind, keys, message.into(), help.into());
        None
    }

    /// Notes such a problem.
    fn report(&mut self, kind: ProblemKind, keys: &[&str], message: String, help: String) {
        let mut places: Vec<(&str, Origin)> = Vec::new();
        for (place, key) in keys.iter().enumerate() {
            if !keys[..place].contains(key)
                && let Some(entry) = document::entry(self.table, key)
                // Two columns of one file stand at the same place.
                && !places.iter().any(|(_, origin)| origin.is_same(&entry.item.origin))
            {
                places.push((written_as(key, entry), entry.item.origin.clone()));
            }
        }
        // What a higher layer changed is nearer to the cause than what a preset states.
        places.sort_by_key(|(_, origin)| std::cmp::Reverse(origin.source.kind));
        let mut problem = Problem::new(kind, message).key(keys[0]).help(help);
        for (key, origin) in &places {
            problem = problem.at(origin, format!("{key} = {}", shown(origin)));
        }
        self.problems.push(problem);
    }
}

/// The name under which the value of a key was written: another key's where it follows from that, such as a material.
fn written_as<'k>(key: &'k str, entry: &'k document::Entry) -> &'k str {
    let [last, written] = [key, entry.key.text()].map(|name| name.rsplit('.').next());
    if last == written {
        key
    } else {
        entry.key.text()
    }
}

/// A number for a message to twelve digits, without the zeros of one that is very large or very small.
fn plain(value: f64) -> String {
    let value = format!("{value:.11e}").parse().unwrap_or(value);
    match value.abs() {
        1e-4..1e9 | 0.0 => value.to_string(),
        _ => format!("{value:e}"),
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

fn configuration(keys: Keys, context: &mut Context<'_>) -> Option<Configuration> {
    let contact = contact::contact(keys.contact, context);
    let mut tube = keys.tube.tube.clone();
    if !tube.arrangement.is_drawn() {
        tube.arrangement_seed = FIRST_SEED;
    }
    // Alone: what else is wrong follows from it.
    tube::check_radius(&tube, &keys.grains.grains, context)?;
    tube::check_lattice(&tube, &keys.drive.drive.control, context);
    tube::check_sphere_diameter(&tube, keys.wall.sphere_diameter, context);
    let grains = grains::grains(&keys.grains, &tube, context);
    if let Some(grains) = &grains {
        let reach = grains.diameter_max.max(keys.wall.sphere_diameter);
        tube::check_length(&tube, reach, context);
        tube::check_reach(&tube, reach, context);
    }
    let units = contact.and_then(|contact| units::units(&keys.units, &contact, context));
    let drive = drive::drive(&keys, units.flatten().as_ref(), context);
    let body = units.and_then(|units| body::body(&keys, units.as_ref(), context));
    let inlet = match (&grains, units) {
        (Some(grains), Some(units)) => inlet::inlet(&keys, grains, units.as_ref(), context),
        _ => None,
    };
    let run = match (&drive, &grains) {
        (Some(drive), Some(grains)) => run::run(keys.run, drive, grains, &keys.observe, context),
        _ => None,
    };
    let contact = match (contact, &units) {
        (Some(contact), Some(units)) => {
            contact::with_cohesion(contact, &keys, units.as_ref(), context)
        }
        _ => None,
    };
    let contact = match (contact, &drive, &grains) {
        (Some(contact), Some(drive), Some(grains)) => {
            damping::damped(contact, &keys, grains, drive, context)
        }
        _ => None,
    };
    let mut configuration = Configuration {
        grains: grains?,
        body: body?,
        contact: contact?,
        tube,
        drive: drive?,
        wall: wall(&keys, context),
        inlet: inlet?,
        initial: keys.initial,
        run: run?,
        observe: keys.observe,
        units: units?,
    };
    configuration.initial.axial_velocity = if context.given("initial.axial_velocity") {
        // One zero, not two.
        keys.initial.axial_velocity + 0.0
    } else {
        configuration.natural_axial_velocity(configuration.initial_wave_speed())
    };
    check_settling(&configuration, context);
    inlet::check_direction(&configuration, context);
    kernel::choose(&mut configuration, context);
    Some(configuration)
}

/// Refuses grains that are to settle where they cannot.
fn check_settling(configuration: &Configuration, context: &mut Context<'_>) {
    if configuration.initial.state != InitialState::Settled {
        return;
    }
    if let Control::Stress { .. } = configuration.drive.control {
        context.refuse::<()>(
            &["initial.state", "drive.control"],
            "grains settle in a wall that stands still, and an elastic one does not",
            "initial.state = \"rest\", or drive.control = \"strain\"",
        );
    } else if !configuration.has_body_force() {
        context.refuse::<()>(
            &["initial.state", "body.gravity"],
            "initial.state = \"settled\" needs gravity for the grains to settle under",
            "give body.gravity, such as [0, -0.001, 0] for a horizontal tube, or units.acceleration in SI; \
             or take initial.state = \"rest\"",
        );
    } else if configuration.initial.temperature != 0.0 {
        context.refuse::<()>(
            &["initial.temperature", "initial.state"],
            "grains that have settled are at rest",
            "initial.state = \"rest\", or no initial.temperature",
        );
    }
}

/// Natural length of a wall spring over the mean distance of lattice neighbours.
const NATURAL_LENGTH_RATIO: f64 = 0.7;

fn wall(keys: &Keys, context: &Context<'_>) -> Wall {
    let mut wall = keys.wall;
    match (&keys.drive.drive.control, &mut wall.elastic) {
        (Control::Strain { .. }, elastic) => *elastic = None,
        (Control::Stress { .. }, elastic) => {
            let elastic = elastic.get_or_insert_default();
            if !context.given("wall.natural_length") {
                elastic.natural_length =
                    NATURAL_LENGTH_RATIO * keys.tube.tube.mean_neighbour_distance();
            }
        }
    }
    wall
}
