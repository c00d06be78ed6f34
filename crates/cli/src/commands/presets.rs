//! `peristalsis presets`

use std::process::ExitCode;

use peristalsis_configuration::{PRESETS, preset};

use crate::arguments::PresetsArguments;
use crate::commands::{print, print_json};
use crate::failure::Failure;
use crate::sources::known_presets;

/// Lists the presets, or prints one.
pub(crate) fn presets(arguments: &PresetsArguments) -> Result<ExitCode, Failure> {
    if let Some(name) = &arguments.name {
        let Some(preset) = preset(name) else {
            return Err(Failure::usage(
                format!("there is no preset `{name}`"),
                known_presets(),
            ));
        };
        print(preset.text)?;
    } else if arguments.json {
        let list: Vec<_> = PRESETS
            .iter()
            .map(|preset| serde_json::json!({ "name": preset.name, "summary": preset.summary }))
            .collect();
        print_json(&list)?;
    } else {
        let width = PRESETS
            .iter()
            .map(|preset| preset.name.len())
            .max()
            .unwrap_or(0);
        for preset in PRESETS {
            print(&format!("{:width$}  {}\n", preset.name, preset.summary))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
