//! `peristalsis presets`

use std::process::ExitCode;

use peristalsis_configuration::{PRESETS, preset};

use crate::arguments::PresetsArguments;
use crate::commands::{print, print_json};
use crate::failure::Failure;
use crate::sources::known_presets;

pub(crate) fn presets(arguments: &PresetsArguments) -> Result<ExitCode, Failure> {
    if let Some(name) = &arguments.name {
        let Some(preset) = preset(name) else {
            let unknown = format!("there is no preset `{name}`");
            return Err(Failure::usage(unknown, known_presets()));
        };
        return print(preset.text);
    }
    if arguments.json {
        let list = PRESETS.iter();
        let list = list.map(|it| serde_json::json!({ "name": it.name, "summary": it.summary }));
        let list: Vec<_> = list.collect();
        return print_json(&list);
    }
    let width = PRESETS.iter().map(|preset| preset.name.len()).max();
    let width = width.unwrap_or(0);
    for preset in PRESETS {
        print(&format!("{:width$}  {}\n", preset.name, preset.summary))?;
    }
    Ok(ExitCode::SUCCESS)
}
