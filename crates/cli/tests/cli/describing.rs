//! `peristalsis presets`, `schema`, `completions`, `--help` and `--version`.

use serde_json::Value;

use crate::Place;

const PRESETS: [&str; 3] = ["frictionless", "frictionless-fine", "frictional"];

fn schema() -> jsonschema::Validator {
    let outcome = Place::new().call(["schema"]).expect_code(0);
    assert_eq!(outcome.stderr, "");
    let schema = outcome.json();
    jsonschema::meta::validate(&schema).expect("the schema follows the schema of schemas");
    jsonschema::validator_for(&schema).unwrap()
}

fn as_json(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

#[track_caller]
fn valid(schema: &jsonschema::Validator, text: &str) {
    if let Err(error) = schema.validate(&as_json(text)) {
        panic!("{error} at {}\n{text}", error.instance_path());
    }
}

#[test]
fn presets_and_examples_follow_the_schema() {
    let schema = schema();
    for preset in PRESETS {
        valid(
            &schema,
            &Place::new().call(["presets", preset]).expect_code(0).stdout,
        );
    }
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut number = 0;
    for entry in std::fs::read_dir(examples).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            valid(&schema, &std::fs::read_to_string(&path).unwrap());
            number += 1;
        }
    }
    assert!(number >= 4, "{number} examples");
}

#[test]
fn the_record_of_a_run_follows_the_schema() {
    let schema = schema();
    let place = Place::new();
    place.run_small(&["--out", "strain"]).expect_code(0);
    let stress = [
        "grains.number=20",
        "run.periods=0.05",
        "drive.schedule={form='ramp', end=1}",
    ];
    let settings = stress.iter().flat_map(|setting| ["--set", setting]);
    place
        .call(
            ["run", "--preset", "frictional", "--out", "stress"]
                .into_iter()
                .chain(settings),
        )
        .expect_code(0);
    for folder in ["strain", "stress"] {
        let text = std::fs::read_to_string(place.path(folder).join("config.toml")).unwrap();
        valid(&schema, &text);
    }
}

#[test]
fn the_schema_refuses_what_the_program_refuses() {
    let schema = schema();
    for text in [
        "widht = 2.7",
        "[drive]\nwidht = 2.7",
        "[drive]\nwidth = -2.7",
        "[drive]\nwidth = 2.7\namplitude = 0.1",
        "[drive]\nwidth = \"wide\"",
        "[contact]\nlaw = \"linera\"",
        "[wall.keep]\nnet_force = \"none\"",
        "[run]\nseed = -1",
        "preset = \"nothing\"",
    ] {
        assert!(!schema.is_valid(&as_json(text)), "{text}");
        let place = Place::new();
        let file = place.write("tube.toml", text);
        let file = file.to_str().unwrap();
        place
            .call(["check", "--preset", "frictionless", file])
            .expect_code(2);
    }
}

#[test]
fn presets_are_listed_and_printed() {
    let place = Place::new();
    let listed = place.call(["presets"]).expect_code(0).stdout;
    let names: Vec<&str> = listed
        .lines()
        .map(|line| line.split_whitespace().next().unwrap())
        .collect();
    assert_eq!(names, PRESETS);
    let json = place.call(["presets", "--json"]).expect_code(0).json();
    for (entry, name) in json.as_array().unwrap().iter().zip(PRESETS) {
        assert_eq!(entry["name"], name);
        assert!(entry["summary"].as_str().unwrap().ends_with('.'));
    }
    for name in PRESETS {
        let text = place.call(["presets", name]).expect_code(0).stdout;
        place.write("copy.toml", &text);
        let of_the_copy = place
            .call(["check", "--json", "copy.toml"])
            .expect_code(0)
            .json();
        let of_the_preset = place
            .call(["check", "--json", "--preset", name])
            .expect_code(0)
            .json();
        for key in ["grains", "wall_spheres", "steps", "time_step", "duration"] {
            assert_eq!(of_the_copy[key], of_the_preset[key], "{name}: {key}");
        }
    }
}

#[test]
fn help_version_and_completions() {
    let place = Place::new();
    let help = place.call(["--help"]).expect_code(0).stdout;
    for word in [
        "run",
        "check",
        "presets",
        "schema",
        "completions",
        "Exit codes",
    ] {
        assert!(help.contains(word), "{word}");
    }
    let version = place.call(["--version"]).expect_code(0).stdout;
    assert_eq!(
        version,
        format!("peristalsis {}\n", env!("CARGO_PKG_VERSION"))
    );
    for shell in ["bash", "zsh", "fish"] {
        let script = place.call(["completions", shell]).expect_code(0).stdout;
        assert!(script.contains("preset"), "{shell}");
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn the_newtonian_fluid() {
    let place = Place::new();
    let report = place
        .call(["newtonian", "--width", "2", "--json"])
        .expect_code(0)
        .json();
    // phi = 1/3, phi^2 = 1/9: Q = phi^2 (16 - phi^2)/(2 (2 + 3 phi^2)) pi a^2 c; J/Jmax = Q/(1 + phi^2/2)
    let square = 1.0 / 9.0;
    let flow_rate = square * (16.0 - square) / (2.0 * (2.0 + 3.0 * square));
    for (key, value) in [
        ("amplitude_ratio", 1.0 / 3.0),
        ("flow_rate", flow_rate),
        ("flow_rate_ratio", flow_rate / (1.0 + 0.5 * square)),
    ] {
        assert!(
            (report[key].as_f64().unwrap() - value).abs() < 1e-12,
            "{key}"
        );
    }
    // Trapping begins at phi = 4 - sqrt(14) = 0.258.
    assert!(report["trapped_volume_fraction"].as_f64().unwrap() > 0.0);
    place
        .call(["newtonian", "--width", "2"])
        .expect_code(0)
        .shows(&["0.35840", "a bolus on the axis"]);
    for width in ["4", "-1", "nan"] {
        place
            .call(["newtonian", &format!("--width={width}")])
            .expect_code(2)
            .says(&["width", "0 <= width <= 2 radius"]);
    }
}
