//! What goes to which stream, and streams that end early.

use std::process::Stdio;

use crate::{Outcome, Place, read_json};

fn plain(text: &str) -> bool {
    text.chars()
        .all(|character| character == '\n' || !character.is_control())
}

#[test]
fn progress_on_a_pipe_is_plain_lines_on_standard_error() {
    let place = Place::new();
    let outcome = place.does("run SMALL --out results");
    assert!(plain(&outcome.stderr), "{:?}", outcome.stderr);
    assert!(plain(&outcome.stdout), "{:?}", outcome.stdout);
    let lines: Vec<&str> = outcome
        .stderr
        .lines()
        .filter(|line| line.contains(" %  t/T "))
        .collect();
    assert_eq!(lines.len(), 10, "{}", outcome.stderr);
    assert!(
        lines[9].starts_with("100 %  t/T 4.0  J/Jmax "),
        "{}",
        lines[9]
    );
    assert!(outcome.stderr.ends_with("written to results\n"));
    assert!(outcome.stdout.contains("20 grains, 0 escaped"));
}

#[test]
fn quiet_is_quiet_and_errors_are_not() {
    let place = Place::new();
    let outcome = place.does("run SMALL --out results -q");
    assert_eq!(outcome.stderr, "");
    let outcome = place.call("run SMALL --out results -q").expect_code(2);
    assert!(plain(&outcome.stderr), "{:?}", outcome.stderr);
    outcome.says(&["holds another run"]);
    // A warning is no progress.
    let outcome = place
        .does("run SMALL --out doubtful -q run.time_step=0.2")
        .says(&["warning: run.time_step"]);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    let summary = read_json(&place.path("doubtful/summary.json"));
    assert_eq!(summary["warnings"][0]["key"], "run.time_step");
}

#[test]
fn readers_of_standard_output_may_go_away() {
    let place = Place::new();
    for line in [
        "schema",
        "presets frictional",
        "check --preset frictionless",
        "run SMALL --out results --json",
    ] {
        let mut child = place.start(line);
        drop(child.stdout.take());
        Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    }
    assert!(place.path("results/summary.json").is_file());
}

#[test]
fn readers_of_standard_error_may_go_away() {
    let place = Place::new();
    let mut child = place.start("run SMALL --out results --json");
    drop(child.stderr.take());
    let outcome = Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    assert_eq!(outcome.json()["status"], "complete");
    // An error that nobody reads keeps its exit code.
    let mut child = place.start("check");
    drop(child.stderr.take());
    Outcome::of(child.wait_with_output().unwrap()).expect_code(2);
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_takes_nothing_is_a_failure() {
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let child = Place::new()
        .command(["schema"])
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    Outcome::of(child.wait_with_output().unwrap())
        .expect_code(1)
        .says(&["cannot write to standard output"]);
}
