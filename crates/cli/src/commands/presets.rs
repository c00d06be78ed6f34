//! `peristalsis presets`

use std::process::ExitCode;

use peristalsis_configuration::{PRESETS, preset};

use crate::arguments::PresetsArguments;
use crate::commands::print;
use crate::failure::Failure;

/// Lists the presets, or prints one.
pub(crate) fn presets(arguments: &PresetsArguments) -> Result<ExitCode, Failure> {
    if let Some(name) = &arguments.name {
        let Some(preset) = preset(name) else {
            let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
            return Err(Failure::Usage {
                message: format!("there is no preset `{name}`"),
                help: Some(format!("presets: {}", names.join(", "))),
            });
        };
        print(preset.text)?;
    } else if arguments.json {
        let list: Vec<_> = PRESETS
            .iter()
            .map(|preset| serde_json::json!({ "name": preset.name, "summary": preset.summary }))
            .collect();
        print(&format!("{:#}\n", serde_json::Value::from(list)))?;
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
