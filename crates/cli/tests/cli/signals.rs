//! A run that is asked to stop: it ends with what it has, says so, and goes on to the same bits.

use std::io::{BufRead, BufReader, Read};
use std::process::Child;

use crate::{Place, read_json, send};

/// A run of a second or two, of which a tenth is done when its first line of progress comes.
pub(crate) const LONG: &str =
    "run --preset frictionless-fine drive.width=2.6 drive.strain_rate=0.1 run.periods=150";

/// The same of half a minute, for who does not wait for its end.
pub(crate) fn longer() -> String {
    LONG.replace("periods=150", "periods=5000")
}

/// Starts a run, sends it a signal after its first line of progress, and answers exit code and standard error.
fn interrupted(place: &Place, line: &str, signal: &str) -> (Option<i32>, String) {
    stopped_by(place.start(line), &[signal])
}

/// The same with a program that was started, and several signals at once.
pub(crate) fn stopped_by(mut child: Child, signals: &[&str]) -> (Option<i32>, String) {
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut said = String::new();
    errors.read_line(&mut said).unwrap();
    assert!(said.contains("10 %"), "{said}");
    signals.iter().for_each(|signal| send(signal, &child));
    errors.read_to_string(&mut said).unwrap();
    (child.wait().unwrap().code(), said)
}

#[test]
fn an_interrupted_run_goes_on_to_the_same_bits() {
    let place = Place::new();
    let run = format!("{LONG} --trajectory gsd,vtp --trajectory-every 3.3 --csv --out");
    let (code, said) = interrupted(&place, &format!("{run} stopped"), "INT");
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("stopped after"), "{said}");
    assert!(
        said.contains("go on with: peristalsis run --resume stopped"),
        "{said}"
    );
    let summary = read_json(&place.path("stopped/summary.json"));
    assert_eq!(summary["status"], "interrupted");
    let periods = summary["periods"].as_f64().unwrap();
    assert!(periods > 14.0 && periods < 149.0, "{periods}");
    for name in [
        "timeseries.parquet",
        "timeseries.csv",
        "profile.parquet",
        "waves.parquet",
        "flow.svg",
        "flow.png",
        "state.checkpoint",
    ] {
        assert!(place.path("stopped").join(name).is_file(), "{name}");
    }
    let rows = |folder: &str| {
        let text = std::fs::read_to_string(place.path(folder).join("timeseries.csv")).unwrap();
        let data = text.lines().filter(|line| !line.starts_with('#')).count();
        data - 1
    };
    assert_eq!(rows("stopped"), (periods * 20.0).round() as usize);

    place.does("run --resume stopped --csv");
    place.does(&format!("{run} through"));
    assert_eq!(rows("stopped"), 150 * 20);
    place.assert_same(
        ["stopped", "through"],
        &[
            "timeseries.parquet",
            "timeseries.csv",
            "profile.parquet",
            "waves.parquet",
            "config.toml",
            "flow.svg",
            "trajectory.gsd",
            "trajectory.pvd",
            "contacts.pvd",
        ],
    );
    let [one, other] =
        ["stopped", "through"].map(|folder| read_json(&place.path(folder).join("summary.json")));
    for (key, value) in one.as_object().unwrap() {
        if !["seconds", "grain_steps_per_second", "trajectory"].contains(&key.as_str()) {
            assert_eq!(value, &other[key], "{key}");
        }
    }
}

#[test]
fn a_terminated_run_ends_as_well_and_so_does_one_whose_batch_system_warns_it() {
    for (signal, expected) in [("TERM", 143), ("USR1", 138)] {
        let place = Place::new();
        let (code, said) = interrupted(&place, &format!("{} --out stopped", longer()), signal);
        assert_eq!(code, Some(expected), "{said}");
        assert!(said.contains("stopped after"), "{said}");
        assert_eq!(
            read_json(&place.path("stopped/summary.json"))["status"],
            "interrupted"
        );
    }
}

#[test]
fn a_run_whose_next_sample_is_a_billion_steps_away_ends_at_once_all_the_same() {
    let place = Place::new();
    let slow = "SMALL run.periods=1 run.time_step=1e-9";
    let mut child = place.start(&format!("run --out stopped {slow}"));
    // The folder is made when signals are watched for.
    while !place.path("stopped/config.toml").is_file() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    // Twenty grains are packed long before: an end while they are leaves no state.
    std::thread::sleep(std::time::Duration::from_secs(2));
    send("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let summary = read_json(&place.path("stopped/summary.json"));
    assert_eq!(summary["status"], "interrupted");
    assert!(place.path("stopped/state.checkpoint").is_file());
    // And a trial of it does not wait for its first sample.
    place.does(&format!("check {slow}"));
}
