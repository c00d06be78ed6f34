//! Configurations read from presets, files and overrides.

mod errors;
mod general;
mod layers;
mod materials;
mod open;
mod pumping;
mod restitution;
mod round_trip;

use peristalsis_configuration::{
    Configuration, ConfigurationError, Problem, SourceFile, Sources, schema,
};

const NO_OVERRIDES: &[&str] = &[];

/// Reads a file named `tube.toml`, a preset and overrides.
fn read(
    text: Option<&str>,
    preset: Option<&str>,
    overrides: &[impl ToString],
) -> Result<Configuration, ConfigurationError> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let name = "tube.toml";
    Configuration::from_sources(&Sources {
        file: text.map(|text| SourceFile { name, text }),
        preset,
        overrides: &overrides,
    })
}

fn preset(name: &str, overrides: &[impl ToString]) -> Configuration {
    read(None, Some(name), overrides).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn only_problem(result: Result<Configuration, ConfigurationError>) -> Problem {
    let error = result.expect_err("this configuration is wrong");
    assert_eq!(error.problems().len(), 1, "{error}");
    error.problems()[0].clone()
}

/// The record of a configuration, which fits the schema and reads back to the same bits.
#[track_caller]
fn record(configuration: &Configuration) -> String {
    let record = configuration.to_toml();
    assert!(schema_errors(&record).is_empty(), "{record}");
    let again = Configuration::from_toml("record", &record).expect("a record reads back");
    assert_eq!(&again, configuration);
    record
}

/// The rows of a table, each with its cells; cells that are left out are empty.
fn rows<const COLUMNS: usize>(table: &str) -> impl Iterator<Item = [&str; COLUMNS]> {
    let lines = table.lines().filter(|line| !line.is_empty());
    lines.map(|line| {
        let mut cells = line.split('|').map(str::trim);
        let row = [(); COLUMNS].map(|()| cells.next().unwrap_or_default());
        assert_eq!(cells.next(), None, "{line}");
        row
    })
}

/// Each row of a table is refused: a preset, settings with `; ` between them, the key to blame, the kind of the problem, and a
/// part of what is said.
#[track_caller]
fn refuses(table: &str) {
    for [name, settings, key, kind, said] in rows(table) {
        let settings: Vec<&str> = settings.split("; ").collect();
        let problem = only_problem(read(None, Some(name), &settings));
        assert_eq!(problem.key.as_deref(), Some(key), "{problem}");
        assert_eq!(format!("{:?}", problem.kind), kind, "{problem}");
        assert!(problem.to_string().contains(said), "{problem}");
    }
}

/// What the schema says against a text.
fn schema_errors(text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().expect("TOML");
    let instance = serde_json::to_value(table).expect("TOML fits JSON");
    let validator = jsonschema::validator_for(&schema()).expect("the schema is a schema");
    let errors = validator.iter_errors(&instance);
    errors.map(|error| error.to_string()).collect()
}
