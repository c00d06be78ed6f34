//! `peristalsis design`

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use peristalsis_configuration::{Configuration, SourceFile};
use peristalsis_reproduce::design::{
    DISTANCES, Design, NEAR, configuration_text, is_design, page, schema,
};
use peristalsis_run::{estimate, warnings};

use crate::arguments::ConfigurationArguments;
use crate::commands::check::in_words as estimate_in_words;
use crate::commands::schema::{SchemaArguments, show};
use crate::commands::{packing, print_report, refuse_loss, rounded, say_if_replaced, significant};
use crate::failure::{Failure, say};
use crate::sources::{configuration, locate, name_and_text};
use crate::stop::Stop;

#[derive(Debug, Args)]
#[command(
    after_help = "FILE gives grain, tube and drive in SI (--keys lists the keys), or is a configuration. The report names what lies outside the published runs, and foretells nothing there."
)]
pub(crate) struct DesignArguments {
    #[command(flatten)]
    pub(crate) configuration: ConfigurationArguments,
    /// Write the configuration of the pump to this file, for `run` to compute.
    #[arg(long, value_name = "FILE")]
    pub(crate) write: Option<PathBuf>,
    /// Write the report as a page to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Print as JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print the keys of a design as JSON schema, or with --markdown as tables; reads nothing.
    #[arg(long)]
    pub(crate) keys: bool,
    #[command(flatten)]
    pub(crate) schema: SchemaArguments,
}

pub(crate) fn design(arguments: &DesignArguments) -> Result<ExitCode, Failure> {
    if arguments.keys {
        return show(arguments.schema, &schema(), "", &[]);
    }
    if arguments.schema.markdown {
        return Err(Failure::usage(
            "--markdown is for the keys of a design",
            "add --keys",
        ));
    }
    let _stop = Stop::watch()?;
    let sources = &arguments.configuration;
    for path in arguments.write.iter().chain(&arguments.html) {
        refuse_loss(path, sources.file.clone())?;
    }
    let text = text_of_design(sources)?;
    let configuration = match &text {
        Some(text) => Configuration::from_toml("design", text)?,
        None => configuration(sources)?,
    };
    // Before anything is tried or written.
    if !Design::serves(&configuration) {
        return Err(no_design());
    }
    if let Some(path) = &arguments.write {
        write(path, &text.unwrap_or_else(|| configuration.to_toml()))?;
    }
    let estimate = packing(&configuration, &warnings(&configuration), || {
        estimate(&configuration, None)
    })
    .map_err(|error| locate(error, sources))?;
    let design = Design::of(&configuration, estimate).ok_or_else(no_design)?;
    if let Some(path) = &arguments.html {
        let name = crate::sources::name(sources);
        let cost = estimate_in_words(&design.estimate);
        write(path, &page(&design, &name, &cost))?;
    }
    print_report(arguments.json, || &design, || in_words(&design))
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    say_if_replaced(path);
    fs::write(path, text).map_err(Failure::write(path))?;
    say(&format!("written to {}", path.display()));
    Ok(())
}

fn no_design() -> Failure {
    Failure::usage(
        "a design is of a wave that moves in a prescribed wall",
        "drive.control = \"strain\" with a drive.strain_rate above 0",
    )
}

/// The configuration of the file of a design; `None` where the file is a configuration itself.
fn text_of_design(sources: &ConfigurationArguments) -> Result<Option<String>, Failure> {
    let Some((name, text)) = name_and_text(sources)? else {
        return Ok(None);
    };
    if sources.preset.is_some() || !is_design(&text) {
        return Ok(None);
    }
    if sources.duration.is_some() {
        return Err(Failure::usage(
            "--duration is in the unit of time of a configuration, which a design does not have",
            "use --periods",
        ));
    }
    let mut overrides = sources.overrides.clone();
    if let Some(periods) = sources.periods {
        overrides.push(format!("drive.periods={periods:?}"));
    }
    let file = SourceFile {
        name: &name,
        text: &text,
    };
    Ok(Some(configuration_text(file, &overrides)?))
}

fn in_words(design: &Design) -> String {
    let mut lines = vec![format!("{:<76}{:>9}   published", "group", "here")];
    for group in &design.groups {
        let [least, most] = group.published.map(rounded);
        let line = format!(
            "{:<76}{:>9}   {least} to {most}   {}",
            group.meaning,
            rounded(group.value),
            group.place()
        );
        lines.push(line.trim_end().to_owned());
    }
    if design.groups.iter().any(|group| group.place() == "near") {
        lines.push(NEAR.to_owned());
    }
    lines.push(String::new());
    lines.push(format!("regime            {}", design.regime));
    if let Some(wall) = design.wall {
        lines.push(format!("rough wall        {wall}"));
    }
    for flow in &design.expected {
        let expected = &flow.expectation;
        let mut line = format!(
            "from {:<13}J/Jmax = {:.2} ± {:.2}",
            flow.start, expected.flow_rate_ratio, expected.error
        );
        if let (Some(rate), Some(error)) = (
            flow.mass_flow_rate_kg_per_h,
            flow.mass_flow_rate_error_kg_per_h,
        ) {
            line += &format!(
                ", {} ± {} kg/h",
                significant(rate, 3),
                significant(error, 2)
            );
        }
        let [least, most] = expected.range;
        line += &format!(
            "; {} published points between {least:.2} and {most:.2}, the nearest at a distance of {:.1} ({DISTANCES}): {}",
            expected.points,
            expected.distance,
            expected.studies.join(", ")
        );
        lines.push(line);
    }
    if let Some(largest) = design.largest_mass_flow_rate_kg_per_h {
        let largest = significant(largest, 3);
        lines.push(format!(
            "no slip           {largest} kg/h, all grains with the wave"
        ));
    }
    for line in &design.outside {
        lines.push(format!("outside the data  {line}"));
    }
    if design.expected.is_empty() {
        let advice = "published runs say nothing of this tube; --write FILE writes its configuration, and run computes it";
        lines.push(format!("expected          {advice}"));
    }
    lines.push(String::new());
    lines.join("\n") + "\n" + &estimate_in_words(&design.estimate)
}
