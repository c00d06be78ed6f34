//! `peristalsis design`

use crate::Place;

const HOSE: &str = "[grain]\nmaterial = \"sand\"\ndiameter = 2e-3\n\n\
                    [tube]\ndiameter = 6e-3\nwavelength = 20e-3\nocclusion = 0.3\nfill = 0.1\n\n\
                    [drive]\nfrequency = 20.0\nperiods = 1\n";

#[test]
fn a_design_is_told_written_and_computed() {
    let place = Place::new();
    place.write("hose.toml", HOSE);
    let outcome = place.does("design hose.toml --write computed.toml --html hose.html");
    assert!(outcome.stderr.contains("written to computed.toml"));
    let told = outcome.stdout;
    for words in [
        "clear bore over grain diameter",
        "regime            ",
        "outside the data  gravity across the tube",
        "kg/h, all grains with the wave",
        "expected time",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let page = std::fs::read_to_string(place.path("hose.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("Design of hose"));
    // Each fact once, and no line beyond the page.
    assert_eq!(page.matches("clear bore over grain diameter").count(), 1);
    assert!(page.contains("kg/h, all grains with the wave") && page.contains("expected time"));
    assert!(page.contains("pre-wrap"), "{page}");
    let json = place
        .does("design hose.toml --json --set gravity=0 tube.occlusion=0.5")
        .json();
    let near = place.does("design hose.toml tube.occlusion=0.69").stdout;
    assert!(
        near.contains("0.667   near\n") && near.contains("\nnear: "),
        "{near}"
    );
    assert_eq!(json["groups"][1]["name"], "occlusion");
    assert_eq!(json["groups"][1]["value"], 0.5);
    assert!(json["estimate"]["expected_seconds"].is_number());
    let run = place
        .does("run computed.toml --json --quiet --out hose")
        .json();
    assert_eq!(run["grains"], json["estimate"]["grains"]);
    assert!(run["si"]["mass_flow_rate_kg_per_s"].is_number());
    // Upright, the load and the power against it are told in SI.
    place.does("design hose.toml tube.incline=90 --write up.toml");
    let up = place.does("run up.toml --quiet --out up").stdout;
    assert!(
        up.contains("Pa over a wavelength: useful power") && up.contains(" W, efficiency"),
        "{up}"
    );
    // A configuration in SI, too; and the keys of a design.
    let preset = place.does("design --preset frictionless --json").json();
    assert_eq!(
        preset["largest_mass_flow_rate_kg_per_h"],
        serde_json::Value::Null
    );
    for call in ["design --markdown", "design hose.toml --markdown"] {
        place.refuses(call, &["--markdown is for the keys", "add --keys"]);
    }
    let keys = place.does("design --keys --markdown").stdout;
    assert!(
        keys.contains("## [tube]") && keys.contains("`occlusion`"),
        "{keys}"
    );
}

#[test]
fn a_design_that_is_wrong_is_refused_with_its_line_and_is_no_configuration() {
    let place = Place::new();
    place.write("hose.toml", HOSE.replace("occlusion", "oclusion"));
    place.refuses("design hose.toml", &["hose.toml:8", "tube.occlusion"]);
    place.refuses(
        "run hose.toml",
        &["is a design", "design hose.toml --write"],
    );
    place.write("hose.toml", HOSE);
    place.refuses("design hose.toml --duration 3", &["use --periods"]);
    place.refuses("design --preset frictional", &["prescribed wall"]);
    place.refuses(
        "design hose.toml tube.occlusion=0",
        &["tube.occlusion = 0 is too small"],
    );
    for option in ["--write", "--html"] {
        let call = format!("design hose.toml {option} hose.toml");
        place.refuses(&call, &["hose.toml", "would be lost"]);
    }
    assert_eq!(
        std::fs::read_to_string(place.path("hose.toml")).unwrap(),
        HOSE
    );
}

#[test]
fn grains_that_the_back_pressure_would_push_away_do_not_settle() {
    let place = Place::new();
    place.write("hose.toml", HOSE);
    for (pressure, state) in [(0, "settled"), (500, "rest")] {
        let name = format!("pressed-{pressure}.toml");
        let call = format!("design hose.toml drive.back_pressure={pressure} --write {name}");
        place.does(&call);
        let written = std::fs::read_to_string(place.path(&name)).unwrap();
        assert!(
            written.contains(&format!("state = \"{state}\"")),
            "{written}"
        );
    }
}

/// A pump engineer: the error named a key of the computation that no design has; and a warning praised a stiffness of 10 N/m
/// under a back pressure for which 40000 had been chosen.
#[test]
fn grains_that_the_back_pressure_would_crush_are_refused_and_not_advised() {
    let place = Place::new();
    let hose = HOSE.replace("frequency = 20.0", "frequency = 1.0");
    place.write("hose.toml", hose);
    let soft = "design hose.toml grain.stiffness=1e-4 drive.back_pressure=1e6";
    place.refuses(
        soft,
        &["--set grain.stiffness", "drive.back_pressure", "at least"],
    );
    let hard = place.does("design hose.toml drive.back_pressure=2e5");
    let all = hard.stdout + &hard.stderr;
    assert!(!all.contains("steps per period"), "{all}");
}
