//! `peristalsis schema` and `peristalsis study schema`

use std::process::ExitCode;

use clap::Args;
use peristalsis_configuration::reference;
use serde_json::Value;

use crate::commands::print_report;
use crate::failure::Failure;

/// How a schema is printed.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct SchemaArguments {
    /// Print all keys as tables in Markdown, for people.
    #[arg(long)]
    pub(crate) markdown: bool,
}

pub(crate) fn schema(arguments: SchemaArguments) -> Result<ExitCode, Failure> {
    show(arguments, &peristalsis_configuration::schema(), "resolved")
}

pub(crate) fn study_schema(arguments: SchemaArguments) -> Result<ExitCode, Failure> {
    show(arguments, &peristalsis_study::schema(), "base")
}

/// `elsewhere` is a table that the tables of keys leave out.
pub(super) fn show(
    arguments: SchemaArguments,
    schema: &Value,
    elsewhere: &str,
) -> Result<ExitCode, Failure> {
    print_report(
        !arguments.markdown,
        || schema,
        || reference(schema, &[elsewhere]),
    )
}
