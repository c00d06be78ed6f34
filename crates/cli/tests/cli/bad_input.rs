//! Bad input: exit code 2, a message with the place and the allowed values, nothing on standard output, nothing made or
//! changed. What is wrong with which key is the matter of `configuration`.

use crate::{Outcome, Place};

/// Runs or checks a file that must be refused, and that leaves nothing behind.
#[track_caller]
fn refused(command: &str, text: &[u8], parts: &[&str]) {
    let place = Place::new();
    place.write("tube.toml", text);
    let before = place.inventory();
    let outcome = place.refuses(command, parts);
    assert_eq!(outcome.stdout, "");
    assert_eq!(place.inventory(), before);
}

const RUN: &str = "run tube.toml --out new/results";
const CHECK: &str = "check tube.toml";

#[test]
fn a_wrong_value_is_shown_with_its_line_and_what_is_allowed() {
    let text = b"preset = \"frictionless\"\n[drive]\nwidth = 3.01\n";
    let parts = ["tube.toml:3:9", "drive.width = 3.01", "2 tube.radius = 3"];
    for command in [RUN, CHECK] {
        refused(command, text, &parts);
    }
}

#[test]
fn a_wrong_override_is_its_own_place() {
    let place = Place::new();
    for (setting, part) in [
        ("drive.widht=2", "did you mean drive.width?"),
        ("tube.wave=2", "did you mean tube.waves?"),
        ("a.b.c=2", "known here: "),
        ("drive.width", "key=value"),
    ] {
        let call = format!("run SMALL --out results --set={setting}");
        place.refuses(&call, &[&format!("--set {setting}"), part]);
    }
    place.refuses(
        "check --preset frictionless grains.diameter_max=1000",
        &["--set grains.diameter_max=1000", "or smaller grains"],
    );
    assert!(place.inventory().is_empty());
}

#[test]
fn grains_that_do_not_fit() {
    let place = Place::new();
    for (number, reason) in [
        ("1000", "packing presses"),
        ("4_000_000", "packing is not tried"),
    ] {
        let parts = [
            "grains do not fit: ",
            reason,
            "take fewer grains",
            "grains.number",
        ];
        for command in ["run --out new/results", "check"] {
            let line = format!("{command} SMALL grains.number={number}");
            assert_eq!(place.refuses(&line, &parts).stdout, "");
        }
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn files_that_are_not_toml_or_not_text_or_not_there() {
    refused(
        RUN,
        b"hello world\n",
        &["tube.toml:1:", "this is not TOML", "key = value"],
    );
    refused(
        RUN,
        b"\x89PNG\r\n\x1a\n\xff\xfe",
        &["tube.toml", "line 1 is not text in UTF-8"],
    );
    let missing = ["tube.toml", "these keys are missing", "tube.radius"];
    refused(CHECK, b"", &missing);
    let place = Place::new();
    for command in ["run", "check"] {
        for (arguments, parts) in [
            (" absent.toml", &["absent.toml", "No such file"][..]),
            (" .", &["cannot read .", "TOML"]),
            ("", &["FILE", "--preset", "frictionless-fine"]),
        ] {
            place.refuses(&format!("{command}{arguments}"), parts);
        }
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn presets_and_arguments_that_do_not_exist() {
    let place = Place::new();
    place.refuses(
        "run --preset frictionles",
        &["frictionles", "a similar value exists", "'frictionless'"],
    );
    place.refuses(
        "presets nothing",
        &["no preset `nothing`", "frictionless-fine"],
    );
    for line in [
        "run --no-such-flag",
        "walk",
        "run a.toml b.toml",
        "run --resume a --out b",
        "presets frictional --json",
    ] {
        place.refuses(line, &[]);
    }
    let without_words = place.command([""; 0]).output().unwrap();
    Outcome::of(without_words).expect_code(2);
    assert!(place.inventory().is_empty());
}
