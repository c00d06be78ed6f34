//! Reads a configuration as the command line names it.

use std::path::Path;
use std::sync::OnceLock;

use peristalsis_configuration::{Configuration, SourceFile, Sources, preset, preset_names};
use peristalsis_engine::EngineError;
use peristalsis_formats::{checkpoint, shell_word};
use peristalsis_reproduce::design::is_design;
use peristalsis_run::{RunError, files};
use peristalsis_study::{STUDY, Specification};

use crate::arguments::ConfigurationArguments;
use crate::failure::Failure;

/// The configuration that the arguments describe.
pub(crate) fn configuration(arguments: &ConfigurationArguments) -> Result<Configuration, Failure> {
    if arguments.file.is_none() && arguments.preset.is_none() && arguments.overrides.is_empty() {
        let reason = "no configuration: give a FILE or a --preset";
        return Err(Failure::usage(reason, known_presets()));
    }
    let file = name_and_text(arguments)?;
    if let Some((name, text)) = &file
        && let Some((reason, help)) = not_of_one_run(name, text)
    {
        return Err(Failure::usage(reason, help));
    }
    let overrides = arguments.overrides.iter().cloned();
    let overrides: Vec<String> = overrides.chain(arguments.length()).collect();
    Ok(Configuration::from_sources(&Sources {
        file: file.as_ref().map(|(name, text)| SourceFile { name, text }),
        preset: arguments.preset.as_deref(),
        overrides: &overrides,
    })?)
}

/// Of the text of a study or of a design: that it is not the configuration of one run, and what to do with it.
pub fn not_of_one_run(name: &str, text: &str) -> Option<(String, String)> {
    let word = shell_word(name.as_ref());
    let (is, command) = if is_a_study(text) {
        ("a study", format!("study run {word}, or study plan {word}"))
    } else if is_design(text) {
        (
            "a design",
            format!("design {word} --write FILE, then run FILE"),
        )
    } else {
        return None;
    };
    let reason = format!("{name} is {is}, not the configuration of one run");
    Some((reason, format!("use: peristalsis {command}")))
}

/// Name and text of the file that the arguments name, if they name one.
pub(crate) fn name_and_text(
    arguments: &ConfigurationArguments,
) -> Result<Option<(String, String)>, Failure> {
    let Some(path) = &arguments.file else {
        return Ok(None);
    };
    let text = text_of(path).map_err(|error| {
        let of_a_run = of_a_run(path, "a configuration");
        of_a_run.unwrap_or_else(|| no_file(path, error, &arguments.overrides))
    })?;
    let name = match is_standard_input(path) {
        true => "standard input".to_owned(),
        false => path.display().to_string(),
    };
    Ok(Some((name, text)))
}

/// That the folder of a run, or its saved state, is not what was asked for, and how to go on from it.
fn of_a_run(path: &Path, asked_for: &str) -> Option<Failure> {
    let refused = |is: &str, help| {
        let message = format!("{} is {is} of a run, not {asked_for}", path.display());
        Some(Failure::usage(message, help))
    };
    let configuration = path.join(files::CONFIGURATION);
    if configuration.is_file() {
        let [folder, configuration] = [path, &configuration].map(shell_word);
        let help = format!(
            "go on with it: peristalsis run --resume {folder}; or begin one like it: peristalsis run {configuration}"
        );
        return refused("the folder", help);
    }
    let bytes = std::fs::read(path).ok()?;
    checkpoint::physics_hash(&bytes).ok()?;
    refused("the saved state", how_to_go_on(path))
}

/// How to go on from a saved state.
fn how_to_go_on(state: &Path) -> String {
    let folder = state.parent();
    let folder = folder.filter(|it| it.join(files::CONFIGURATION).exists());
    match folder {
        Some(folder) if !folder.as_os_str().is_empty() => {
            let folder = shell_word(folder);
            format!(
                "go on with its run: peristalsis run --resume {folder}; or on a page: peristalsis view {folder} --from-state"
            )
        }
        _ => format!(
            "go on from it: peristalsis run --resume {}",
            shell_word(state)
        ),
    }
}

/// That a file cannot be read, which may be the name of a preset.
fn no_file(path: &Path, error: std::io::Error, overrides: &[String]) -> Failure {
    if let Some(key) = overrides.iter().find(|it| !it.contains('=')) {
        let reason = format!("cannot read {}: {error}", path.display());
        let help = format!(
            "a key and its value are one word: --set {key}={}",
            path.display()
        );
        return Failure::usage(reason, help);
    }
    match preset(&path.to_string_lossy()) {
        Some(preset) => Failure::usage(
            format!("cannot read {}: {error}", path.display()),
            format!("a preset is named with --preset {}", preset.name),
        ),
        None => Failure::read(path)(error),
    }
}

/// Whether a text is a study file: its tables are no tables of a configuration.
fn is_a_study(text: &str) -> bool {
    let begins = |line: &str| {
        ["[base]", "[[axes]]"].contains(&line.split('#').next().unwrap_or_default().trim())
    };
    text.lines().any(begins)
}

/// The study that a file describes.
pub(crate) fn study(path: &Path) -> Result<Specification, Failure> {
    let of_store = path.join(STUDY);
    if of_store.is_file() {
        let (file, store) = (shell_word(&of_store), shell_word(path));
        return Err(Failure::usage(
            format!("{} is a store, not the file of a study", path.display()),
            format!(
                "the file is {file}; study run takes the store with it: peristalsis study run {file} --store {store}"
            ),
        ));
    }
    let of_one_run = |text: &str| {
        let tables = ["[drive]", "[tube]", "[grains]", "[run]"];
        !is_a_study(text) && text.lines().any(|line| tables.contains(&line.trim()))
    };
    Specification::read(path).map_err(|error| {
        if let Some(of_a_run) = of_a_run(path, "the file of a study") {
            return of_a_run;
        }
        if !std::fs::read_to_string(path).is_ok_and(|text| of_one_run(&text)) {
            return error.into();
        }
        let name = path.display();
        Failure::usage(
            format!("{name} is the configuration of one run, not a study"),
            format!("use: peristalsis run {name}"),
        )
    })
}

/// Whether a path is `-`, which stands for standard input.
fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The text of a file, or of standard input, which can be read once only and is kept.
fn text_of(path: &Path) -> std::io::Result<String> {
    static STANDARD_INPUT: OnceLock<String> = OnceLock::new();
    if !is_standard_input(path) {
        let text = std::fs::read(path)?;
        return String::from_utf8(text).map_err(|error| {
            let (text, before) = (error.as_bytes(), error.utf8_error().valid_up_to());
            let line = 1 + text[..before].iter().filter(|byte| **byte == b'\n').count();
            let message = format!("line {line} is not text in UTF-8");
            std::io::Error::new(std::io::ErrorKind::InvalidData, message)
        });
    }
    if let Some(text) = STANDARD_INPUT.get() {
        return Ok(text.clone());
    }
    let text = std::io::read_to_string(std::io::stdin())?;
    Ok(STANDARD_INPUT.get_or_init(|| text).clone())
}

/// The names of all presets, as help.
pub(crate) fn known_presets() -> String {
    format!("presets: {}", preset_names().join(", "))
}

/// Keys that say how many grains there are.
const NUMBER_KEYS: [&str; 3] = ["number", "volume_fraction", "number_density"];

/// Puts the place where a key is given beside the error that a run cannot begin with it: more grains than fit, or grains that
/// only a program can place.
pub(crate) fn locate(error: RunError, arguments: &ConfigurationArguments) -> Failure {
    let (table, keys): (&str, &[&str]) = match error {
        RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. }) => {
            ("grains.", &NUMBER_KEYS)
        }
        RunError::NotPlaced => ("initial.", &["state"]),
        _ => return error.into(),
    };
    let is_one = |text: &&String| {
        let key = text.trim_start().strip_prefix(table);
        key.is_some_and(|key| keys.iter().any(|known| key.starts_with(known)))
    };
    let of_override = arguments.overrides.iter().rfind(is_one);
    let place = of_override.map(|text| format!("--set {text}"));
    let place = place.or_else(|| {
        let path = arguments.file.as_ref()?;
        let text = text_of(path).ok()?;
        let (index, line) = text.lines().enumerate().find(|(_, line)| {
            let line = line.trim_start();
            let line = line.strip_prefix(table).unwrap_or(line);
            let key = line.split_once('=').map(|(key, _)| key.trim_end());
            key.is_some_and(|key| keys.contains(&key))
        })?;
        Some(format!("{}:{}: {}", path.display(), index + 1, line.trim()))
    });
    match place {
        Some(place) => Failure::CannotBegin { place, error },
        None => error.into(),
    }
}

/// Short name for a run: its file's stem, or its preset.
pub(crate) fn name(arguments: &ConfigurationArguments) -> String {
    let file = arguments.file.as_ref();
    let file = file.filter(|file| !is_standard_input(file));
    let stem = file.and_then(|file| file.file_stem());
    let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
    let name = stem.or_else(|| arguments.preset.clone());
    name.unwrap_or_else(|| "run".to_owned())
}
