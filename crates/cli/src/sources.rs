//! Reads a configuration as the command line names it.

use peristalsis_configuration::{Configuration, PRESETS, SourceFile, Sources};

use crate::arguments::ConfigurationArguments;
use crate::failure::Failure;

/// The configuration that the arguments describe.
pub(crate) fn configuration(arguments: &ConfigurationArguments) -> Result<Configuration, Failure> {
    if arguments.file.is_none() && arguments.preset.is_none() && arguments.overrides.is_empty() {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        return Err(Failure::Usage {
            message: "nothing to run: give a FILE or a --preset".to_owned(),
            help: Some(format!("presets: {}", names.join(", "))),
        });
    }
    let file = match &arguments.file {
        None => None,
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|source| Failure::Read {
                path: path.clone(),
                source,
            })?;
            Some((path.display().to_string(), text))
        }
    };
    Ok(Configuration::from_sources(&Sources {
        file: file.as_ref().map(|(name, text)| SourceFile { name, text }),
        preset: arguments.preset.as_deref(),
        overrides: &arguments.overrides,
    })?)
}

/// Short name for a run: its file's stem, or its preset.
pub(crate) fn name(arguments: &ConfigurationArguments) -> String {
    arguments
        .file
        .as_ref()
        .and_then(|file| file.file_stem())
        .map(|stem| stem.to_string_lossy().into_owned())
        .or_else(|| arguments.preset.clone())
        .unwrap_or_else(|| "run".to_owned())
}
