//! `peristalsis schema` and `peristalsis study schema`

use std::process::ExitCode;

use peristalsis_configuration::reference;
use serde_json::Value;

use crate::arguments::SchemaArguments;
use crate::commands::{print, print_json};
use crate::failure::Failure;

/// Prints the JSON schema of the configuration.
pub(crate) fn schema(arguments: SchemaArguments) -> Result<ExitCode, Failure> {
    show(arguments, &peristalsis_configuration::schema(), "resolved")
}

/// Prints the JSON schema of a study file.
pub(crate) fn study_schema(arguments: SchemaArguments) -> Result<ExitCode, Failure> {
    show(arguments, &peristalsis_study::schema(), "base")
}

/// `elsewhere` is a table that the tables of keys leave out.
fn show(arguments: SchemaArguments, schema: &Value, elsewhere: &str) -> Result<ExitCode, Failure> {
    if arguments.markdown {
        print(&reference(schema, &[elsewhere]))?;
    } else {
        print_json(schema)?;
    }
    Ok(ExitCode::SUCCESS)
}
