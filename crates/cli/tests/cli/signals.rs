//! A run that is asked to stop: it ends with what it has, says so, and goes on to the same bits.

use std::io::{BufRead, BufReader, Read};
use std::process::Child;

use crate::{Place, read_json, send};

/// A run of a second or two, of which a tenth is done when its first line of progress comes.
pub(crate) const LONG: &str =
    "run --preset frictionless-fine drive.width=2.6 drive.strain_rate=0.1 run.periods=150";

/// Sends a run these signals at once after its first line of progress, and answers exit code and standard error.
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
    let (code, said) = stopped_by(place.start(&format!("{run} stopped")), &["INT"]);
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
    place.assert_same_run(["stopped", "through"]);
    place.assert_same(
        ["stopped", "through"],
        &[
            "timeseries.csv",
            "trajectory.gsd",
            "trajectory.pvd",
            "contacts.pvd",
        ],
    );
}

/// A batch system warns with USR1, GNU `timeout` signals the program and then its group, and a lost connection is HUP.
#[test]
fn each_signal_ends_a_run_with_its_state_also_where_it_comes_twice() {
    for (signals, codes) in [
        (&["TERM"][..], &[143][..]),
        (&["USR1"], &[138]),
        (&["TERM", "TERM"], &[143]),
        (&["INT", "TERM"], &[143, 130]),
        (&["HUP", "HUP"], &[129]),
    ] {
        let place = Place::new();
        // Half a minute, if nothing ended it.
        let run = LONG.replace("periods=150", "periods=5000");
        let child = place.start(&format!("{run} --out stopped"));
        let (code, said) = stopped_by(child, signals);
        let is_told = code.is_some_and(|code| codes.contains(&code));
        assert!(is_told, "{signals:?} {code:?} {said}");
        assert!(said.contains("stopped after"), "{said}");
        let summary = read_json(&place.path("stopped/summary.json"));
        assert_eq!(summary["status"], "interrupted");
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
