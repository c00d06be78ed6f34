//! What goes to which stream, and streams that end early.

use std::io::Read;
use std::process::Stdio;

use crate::{Outcome, Place, SMALL, read_json};

fn plain(text: &str) -> bool {
    text.chars()
        .all(|character| character == '\n' || !character.is_control())
}

#[test]
fn progress_on_a_pipe_is_plain_lines_on_standard_error() {
    let place = Place::new();
    let outcome = place.run_small(&["--out", "results"]).expect_code(0);
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
    let outcome = place.run_small(&["--out", "results", "-q"]).expect_code(0);
    assert_eq!(outcome.stderr, "");
    let outcome = place.run_small(&["--out", "results", "-q"]).expect_code(2);
    assert!(plain(&outcome.stderr), "{:?}", outcome.stderr);
    outcome.says(&["holds another run"]);
    // A warning is no progress.
    let outcome = place
        .run_small(&["--out", "doubtful", "-q", "--set", "run.time_step=0.2"])
        .expect_code(0)
        .says(&["warning: run.time_step"]);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    let summary = read_json(&place.path("doubtful/summary.json"));
    assert_eq!(summary["warnings"][0]["key"], "run.time_step");
}

#[test]
fn readers_of_standard_output_may_go_away() {
    let place = Place::new();
    for arguments in [
        &["schema"][..],
        &["presets", "frictional"],
        &["check", "--preset", "frictionless"],
    ] {
        let mut child = place
            .command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    }
    let mut command = place.command(
        ["run"]
            .iter()
            .chain(SMALL)
            .chain(&["--out", "results", "--json"]),
    );
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    assert!(place.path("results/summary.json").is_file());
}

#[test]
fn readers_of_standard_error_may_go_away() {
    let place = Place::new();
    let mut command = place.command(
        ["run"]
            .iter()
            .chain(SMALL)
            .chain(&["--out", "results", "--json"]),
    );
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stderr.take());
    let outcome = Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    assert_eq!(outcome.json()["status"], "complete");
    // An error that nobody reads keeps its exit code.
    let mut child = place
        .command(["check"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
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
    let mut child = Place::new()
        .command(["schema"])
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{said}");
    assert!(said.contains("cannot write to standard output"), "{said}");
}
