//! Reads a configuration as the command line names it.

use peristalsis_configuration::{Configuration, PRESETS, SourceFile, Sources};
use peristalsis_engine::EngineError;
use peristalsis_run::RunError;

use crate::arguments::ConfigurationArguments;
use crate::failure::Failure;

/// The configuration that the arguments describe.
pub(crate) fn configuration(arguments: &ConfigurationArguments) -> Result<Configuration, Failure> {
    if arguments.file.is_none() && arguments.preset.is_none() && arguments.overrides.is_empty() {
        return Err(Failure::usage(
            "nothing to run: give a FILE or a --preset",
            known_presets(),
        ));
    }
    let file = match &arguments.file {
        None => None,
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(Failure::read(path))?;
            Some((path.display().to_string(), text))
        }
    };
    Ok(Configuration::from_sources(&Sources {
        file: file.as_ref().map(|(name, text)| SourceFile { name, text }),
        preset: arguments.preset.as_deref(),
        overrides: &arguments.overrides,
    })?)
}

/// The names of all presets, as help.
pub(crate) fn known_presets() -> String {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    format!("presets: {}", names.join(", "))
}

/// Keys that say how many grains there are.
const NUMBER_KEYS: [&str; 3] = ["number", "volume_fraction", "number_density"];

/// Puts the place where the number of grains is given beside the error that they do not fit.
pub(crate) fn locate(error: RunError, arguments: &ConfigurationArguments) -> Failure {
    if !matches!(
        error,
        RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. })
    ) {
        return error.into();
    }
    let of_override = arguments
        .overrides
        .iter()
        .rev()
        .find(|text| {
            NUMBER_KEYS
                .iter()
                .any(|key| text.trim_start().starts_with(&format!("grains.{key}")))
        })
        .map(|text| format!("--set {text}"));
    let place = of_override.or_else(|| {
        let path = arguments.file.as_ref()?;
        let text = std::fs::read_to_string(path).ok()?;
        let line = text.lines().position(|line| {
            let line = line.trim_start();
            let line = line.strip_prefix("grains.").unwrap_or(line);
            NUMBER_KEYS.iter().any(|key| {
                line.strip_prefix(key)
                    .is_some_and(|rest| rest.trim_start().starts_with('='))
            })
        })?;
        let written = text.lines().nth(line)?.trim();
        Some(format!("{}:{}: {written}", path.display(), line + 1))
    });
    match place {
        Some(place) => Failure::DoesNotFit { place, error },
        None => error.into(),
    }
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
