//! `peristalsis schema` and `peristalsis study schema`

use std::process::ExitCode;

use clap::Args;
use peristalsis_configuration::{PRESETS, Preset, reference};
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
    show(
        arguments,
        &peristalsis_configuration::schema(),
        "resolved",
        PRESETS,
    )
}

pub(crate) fn study_schema(arguments: SchemaArguments) -> Result<ExitCode, Failure> {
    show(arguments, &peristalsis_study::schema(), "base", &[])
}

/// `elsewhere` is a table that the tables of keys leave out; `presets` are those of such files.
pub(super) fn show(
    arguments: SchemaArguments,
    schema: &Value,
    elsewhere: &str,
    presets: &[Preset],
) -> Result<ExitCode, Failure> {
    print_report(
        !arguments.markdown,
        || schema,
        || reference(schema, &[elsewhere], presets),
    )
}
