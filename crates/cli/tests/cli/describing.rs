//! `peristalsis presets`, `schema`, `completions`, `--help` and `--version`.

use crate::Place;

const PRESETS: [&str; 8] = [
    "frictionless",
    "frictionless-source",
    "frictionless-fine",
    "frictional",
    "sand-pump",
    "soft-robot",
    "silo",
    "oesophagus",
];

#[test]
fn the_schema_is_one_and_refuses_what_the_program_refuses() {
    let place = Place::new();
    let outcome = place.does("schema");
    assert_eq!(outcome.stderr, "");
    jsonschema::meta::validate(&outcome.json()).expect("it follows the schema of schemas");
    let schema = jsonschema::validator_for(&outcome.json()).unwrap();
    for (text, is_right) in [
        ("[drive]\nwidth = 2.7", true),
        ("[drive]\nwidht = 2.7", false),
    ] {
        let instance = toml::from_str::<toml::Table>(text).unwrap();
        assert_eq!(
            schema.is_valid(&serde_json::to_value(instance).unwrap()),
            is_right
        );
        place.write("tube.toml", format!("preset = \"frictionless\"\n{text}"));
        place
            .call("check tube.toml")
            .expect_code(if is_right { 0 } else { 2 });
    }
}

#[test]
fn presets_are_listed_and_printed() {
    let place = Place::new();
    let listed = place.does("presets").stdout;
    let names: Vec<&str> = listed
        .lines()
        .map(|line| line.split_whitespace().next().unwrap())
        .collect();
    assert_eq!(names, PRESETS);
    let json = place.does("presets --json").json();
    for (entry, name) in json.as_array().unwrap().iter().zip(PRESETS) {
        assert_eq!(entry["name"], name);
        assert!(entry["summary"].as_str().unwrap().ends_with('.'));
    }
    for name in PRESETS {
        let text = place.does(&format!("presets {name}")).stdout;
        place.write("copy.toml", &text);
        let of = |source: &str| place.does(&format!("check --json {source}")).json();
        let (copy, preset) = (of("copy.toml"), of(&format!("--preset {name}")));
        for key in ["grains", "wall_spheres", "steps", "duration"] {
            assert_eq!(copy[key], preset[key], "{name}: {key}");
        }
    }
}

#[test]
fn help_version_and_completions() {
    let place = Place::new();
    let help = place.does("--help").stdout;
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
    let version = place.does("--version").stdout;
    assert_eq!(
        version,
        format!("peristalsis {}\n", env!("CARGO_PKG_VERSION"))
    );
    for shell in ["bash", "zsh", "fish"] {
        let script = place.does(&format!("completions {shell}")).stdout;
        assert!(script.contains("preset"), "{shell}");
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn the_newtonian_fluid() {
    let place = Place::new();
    let report = place.does("newtonian --width 2 --json").json();
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
        .does("newtonian --width 2")
        .shows(&["0.35840", "a bolus on the axis"]);
    // A tube that closes.
    place
        .does("newtonian --width 0")
        .shows(&["(no pressure stops the flow)"]);
    for width in ["4", "-1", "nan"] {
        let call = format!("newtonian --width={width}");
        place.refuses(&call, &["width", "0 <= width <= 2 radius"]);
    }
}
