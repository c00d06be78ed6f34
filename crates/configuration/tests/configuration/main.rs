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

/// What the schema says against a text.
fn schema_errors(text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().expect("TOML");
    let instance = serde_json::to_value(table).expect("TOML fits JSON");
    let validator = jsonschema::validator_for(&schema()).expect("the schema is a schema");
    let errors = validator.iter_errors(&instance);
    errors.map(|error| error.to_string()).collect()
}
