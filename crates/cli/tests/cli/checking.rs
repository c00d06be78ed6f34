//! `peristalsis check`: the numbers of what would run, and warnings where they are due.

use std::f64::consts::PI;

use serde_json::Value;

use crate::Place;

fn check(arguments: &[&str]) -> Value {
    let place = Place::new();
    let outcome = place
        .call(["check", "--json"].iter().chain(arguments))
        .expect_code(0);
    assert!(place.inventory().is_empty());
    outcome.json()
}

fn warned(estimate: &Value) -> Vec<&str> {
    let warnings = estimate["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|warning| {
            assert!(!warning["message"].as_str().unwrap().is_empty());
            warning["key"].as_str().unwrap()
        })
        .collect()
}

#[track_caller]
fn close(value: &Value, expected: f64) {
    let value = value.as_f64().unwrap();
    assert!(
        (value / expected - 1.0).abs() < 1e-12,
        "{value} is not {expected}"
    );
}

#[test]
fn the_numbers_are_those_of_the_tube() {
    let estimate = check(&["--preset", "frictionless"]);
    // N = round(6 * 0.15 * 1.5^2 * 100) = round(202.5)
    assert_eq!(estimate["grains"], 203);
    assert_eq!(estimate["wall_spheres"], 12 * 14 * 10);
    close(&estimate["volume_fraction"], 203.0 / (6.0 * 2.25 * 100.0));
    close(&estimate["number_density"], 203.0 / (PI * 2.25 * 100.0));
    close(&estimate["length"], 100.0);
    close(&estimate["period"], 20.0);
    close(&estimate["periods"], 40.0);
    close(&estimate["duration"], 800.0);
    close(&estimate["time_step"], 0.05);
    assert_eq!(estimate["steps"], 16_000);
    // Two grains of mass 1 on a spring of stiffness 1: half a period is pi/sqrt(2).
    close(&estimate["contact_time"], PI / 2.0_f64.sqrt());
    // phi = 1 - 2.75/3 = 1/12, J/Jmax = phi^2 (16 - phi^2)/(2 (2 + 3 phi^2) (1 + phi^2/2))
    let square = 1.0 / 144.0;
    let fluid = square * (16.0 - square) / (2.0 * (2.0 + 3.0 * square) * (1.0 + 0.5 * square));
    close(&estimate["newtonian_flow_rate_ratio"], fluid);
    assert!(estimate["expected_seconds"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_numbers_of_the_elastic_tube() {
    let estimate = check(&["--preset", "frictional"]);
    assert_eq!(estimate["grains"], 1093);
    assert_eq!(estimate["wall_spheres"], 22 * 23 * 2);
    close(&estimate["number_density"], 1093.0 / (PI * 12.25 * 40.0));
    close(&estimate["period"], 1.0 / 4.01e-3);
    assert_eq!(estimate["newtonian_flow_rate_ratio"], Value::Null);
}

#[test]
fn a_person_reads_the_same_numbers() {
    let outcome = Place::new()
        .call(["check", "--preset", "frictionless"])
        .expect_code(0);
    for part in [
        "203",
        "0.1504",
        "1680 spheres",
        "40 periods of 20 t",
        "16000 of 0.05",
        "expected time",
    ] {
        assert!(
            outcome.stdout.contains(part),
            "{part:?} is not in {}",
            outcome.stdout
        );
    }
    assert_eq!(outcome.stderr, "");
}

#[test]
fn presets_and_examples_give_no_warning() {
    for preset in ["frictionless", "frictionless-fine", "frictional"] {
        assert!(warned(&check(&["--preset", preset])).is_empty(), "{preset}");
    }
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    for entry in std::fs::read_dir(examples).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let estimate = check(&[path.to_str().unwrap()]);
            assert!(warned(&estimate).is_empty(), "{}", path.display());
        }
    }
}

#[test]
fn each_warning_comes_when_it_is_due_and_alone() {
    for (setting, nearly, key) in [
        // A contact lasts 2.22, a fifteenth of it is 0.148; a run of 20 samples a period halves steps of 0.3 and 0.25.
        (
            &["run.time_step=0.2"][..],
            "run.time_step=0.125",
            "run.time_step",
        ),
        (
            &["tube.rings_per_wave=10"][..],
            "tube.rings_per_wave=16",
            "tube.rings_per_wave",
        ),
        (
            &["drive.width=0.99", "grains.number=5"][..],
            "drive.width=1.01",
            "drive.width",
        ),
    ] {
        // The fine lattice stays tight also where the wave opens the tube wide.
        let preset = if key == "drive.width" {
            "frictionless-fine"
        } else {
            "frictionless"
        };
        let with = |settings: &[&str]| {
            let mut arguments = vec!["--preset", preset];
            for setting in settings {
                arguments.extend(["--set", setting]);
            }
            check(&arguments)
        };
        assert_eq!(warned(&with(setting)), [key]);
        let mut harmless = setting.to_vec();
        harmless[0] = nearly;
        assert!(warned(&with(&harmless)).is_empty(), "{nearly}");
    }
}

#[test]
fn a_step_so_long_that_the_trial_diverges_is_a_warning_not_a_failure() {
    let estimate = check(&["--preset", "frictionless", "--set", "run.time_step=1"]);
    assert!(warned(&estimate).contains(&"run.time_step"));
    assert_eq!(estimate["steps"], 800);
}

#[test]
fn a_run_repeats_the_warnings() {
    let place = Place::new();
    place
        .run_small(&["--out", "results", "--set", "run.time_step=0.2"])
        .expect_code(0)
        .says(&["warning: run.time_step", "too long for a contact"]);
}

#[test]
fn a_static_wave_has_no_period() {
    let estimate = check(&[
        "--preset",
        "frictionless",
        "--set",
        "drive.strain_rate=0",
        "--set",
        "run.duration=50",
    ]);
    assert_eq!(estimate["period"], Value::Null);
    close(&estimate["duration"], 50.0);
    assert_eq!(estimate["steps"], 1000);
}
