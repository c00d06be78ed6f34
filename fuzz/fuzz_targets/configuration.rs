//! No text and no settings make the configuration reader panic, and what it accepts it writes so that it reads back.
//!
//! The input is a text; what follows a line `---` are settings, one a line. A first line `preset NAME` names a preset.
#![no_main]

use libfuzzer_sys::fuzz_target;
use peristalsis_configuration::{Configuration, SourceFile, Sources};

fuzz_target!(|input: &str| {
    let (preset, input) = match input.strip_prefix("preset ").and_then(|rest| rest.split_once('\n')) {
        Some((name, rest)) => (Some(name), rest),
        None => (None, input),
    };
    let (text, settings) = input.split_once("\n---\n").unwrap_or((input, ""));
    let overrides: Vec<String> = settings.lines().map(str::to_owned).collect();
    let name = "fuzz.toml";
    match Configuration::from_sources(&Sources {
        file: Some(SourceFile { name, text }),
        preset,
        overrides: &overrides,
    }) {
        Err(error) => {
            // Every place lies within its text, on the border of characters.
            assert!(!error.problems().is_empty());
            for label in error.problems().iter().flat_map(|problem| &problem.labels) {
                assert!(label.source_text.get(label.span.clone()).is_some());
            }
            assert!(!error.to_string().is_empty());
        }
        Ok(configuration) => {
            let record = configuration.to_toml();
            let again = Configuration::from_sources(&Sources {
                file: Some(SourceFile { name, text: &record }),
                preset: None,
                overrides: &[],
            })
            .unwrap_or_else(|error| panic!("the record does not read back: {error}\n{record}"));
            assert_eq!(again.to_toml(), record);
        }
    }
});
