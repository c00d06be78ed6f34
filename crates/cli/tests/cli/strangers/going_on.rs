//! Lengths of runs, how far they are, and what a killed one leaves.

use crate::{Place, read_json, warnings};

/// The files of killed programs below a folder.
#[cfg(unix)]
fn partials(place: &Place) -> Vec<std::path::PathBuf> {
    let files = place.inventory().into_keys();
    files
        .filter(|name| name.extension().is_some_and(|it| it == "partial"))
        .collect()
}

/// `run --resume --periods` after a change of the wave's rate: the periods of the first rate were taken for those of the
/// wave.
#[test]
fn a_wave_whose_rate_changes_says_which_periods_its_run_counts() {
    let place = Place::new();
    let faster = "drive.strain_rate=0.1 drive.schedule={form=\"steps\",parameter=\"strain_rate\",at=[2],values=[0.2]}";
    let said = |periods: u32, wavelengths: u32| {
        format!(
            "run.periods counts periods of drive.strain_rate: {periods} periods of 10 t, in which drive.schedule lets the \
             wave run {wavelengths} wavelengths"
        )
    };
    let line = format!("check SMALL {faster}");
    place.does(&line).shows(&[
        "40 t: 4 periods of 10 t as drive.strain_rate has them; led by drive.schedule, the wave runs 6 wavelengths",
    ]);
    let run = place.does(&format!("run SMALL {faster} --out r"));
    run.says(&[&said(4, 6)])
        .shows(&["no transition within 4.0 periods"]);
    place
        .does("run --resume r --periods 6")
        .says(&[&said(6, 10)]);
    let periods = read_json(&place.path("r/summary.json"))["periods"].as_f64();
    assert!((periods.unwrap() - 10.0).abs() < 1e-9, "{periods:?}");
    place.does("runs r").shows(&["6 of 6"]);
    place.refuses("run --resume r --periods 5", &["has done 6 periods"]);
    let help = place.does("run --help").stdout;
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("in periods of drive.strain_rate"));
    // A wave of one rate has one kind of period.
    let constant = place.does("run SMALL --out constant");
    assert!(!constant.stderr.contains("run.periods counts"));
}

/// `runs` did not say how far an unfinished run is; `.partial` files of a killed one stayed.
#[cfg(unix)]
#[test]
fn an_unfinished_run_says_how_far_it_is_and_goes_on_without_remains() {
    use crate::send;
    use std::time::Duration;
    let place = Place::new();
    let reached = || {
        let runs = place.does("runs all --json").json();
        (
            runs[0]["periods_done"].as_f64(),
            runs[0]["status"].as_str().map(str::to_owned),
        )
    };
    let mut child = place
        .start("run SMALL --periods 1e6 --seeds 1..2 --out all --checkpoint-every 1s --threads 1");
    let is_on = || place.path("all").is_dir() && reached().0.is_some_and(|periods| periods > 0.0);
    while !is_on() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(200));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let (periods, status) = reached();
    assert!(periods.unwrap() > 0.0 && status.as_deref() == Some("unfinished"));
    let there = place.does("runs all").stdout;
    assert!(!there.contains("– of 1000000"), "{there}");
    for folder in ["all", "all/seed-1"] {
        place.write(&format!("{folder}/.aB3xYz.partial"), "half of a checkpoint");
    }
    let mut child = place.start("run --resume all --quiet");
    while !partials(&place).is_empty() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(50));
    }
    send("TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(143));
    assert!(partials(&place).is_empty());
}

/// Configurations of placed grains ended with exit code 1, and named no line.
#[test]
fn grains_that_only_a_program_can_place_are_bad_input_with_their_line() {
    let place = Place::new();
    let text = "preset = \"frictionless\"\n[initial]\nstate = \"placed\"\n";
    place.write("placed.toml", text);
    for line in [
        "run placed.toml",
        "check placed.toml",
        "run placed.toml --seeds 1..2",
    ] {
        let parts = ["placed.toml:3: state = \"placed\"", "initial.state", "rest"];
        place.refuses(line, &parts);
    }
    place.refuses(
        "run SMALL initial.state=placed",
        &["--set initial.state=placed", "checkpoint"],
    );
    place.refuses("view placed.toml", &["initial.state"]);
    assert!(!place.path("runs").exists());
}

/// `--periods -1` was an unknown option, `1e300` printed 300 zeros.
#[test]
fn lengths_that_cannot_be_are_refused_in_words() {
    let place = Place::new();
    for length in [
        "--periods -1",
        "--duration -2.5",
        "--periods 0",
        "--periods nan",
    ] {
        place.refuses(&format!("run SMALL {length}"), &["a number above 0"]);
    }
    let refused = place.refuses("run SMALL --periods 1e300", &["at most 1e9"]);
    assert!(!refused.stderr.contains("0000000000"), "{}", refused.stderr);
}

/// A flow near zero was printed as -0.0000, and its error as 0.0000.
#[test]
fn a_flow_near_zero_keeps_its_digits() {
    let place = Place::new();
    let still = "--preset frictionless tube.waves=2 grains.number=4 drive.width=3 run.periods=4";
    for line in [
        format!("run {still} drive.body_force=-1e-9 --out still"),
        format!("run {still} drive.body_force=-1e-9 --seeds 1..3 --out stills"),
        "runs still stills".to_owned(),
    ] {
        let outcome = place.does(&line);
        let all = outcome.stdout + &outcome.stderr;
        assert!(
            all.contains(" × 10^-7") && !all.contains("0.0000 "),
            "{all}"
        );
    }
}

/// `figures` of a folder without a run spoke of going on.
#[test]
fn figures_of_no_run_say_what_is_missing() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    for folder in ["empty", "none"] {
        let parts = [
            "holds no run that is whole: config.toml",
            "peristalsis runs DIR",
        ];
        place.refuses(&format!("figures {folder}"), &parts);
    }
}

/// Thresholds that nothing can cross were taken without a word.
#[test]
fn thresholds_that_no_flow_crosses_are_warned_of_by_check_run_and_summary() {
    let place = Place::new();
    let key = "observe.transition_threshold";
    let warned = |settings: &str| {
        let report = place.does(&format!("check SMALL {settings} --json")).json();
        let of_key = warnings(&report).into_iter().filter(|(of, _)| *of == key);
        of_key.count()
    };
    for threshold in ["-1", "0.005", "-0.004", "0.999", "1.5", "0"] {
        assert_eq!(warned(&format!("{key}={threshold}")), 1, "{threshold}");
    }
    for jammed in ["0.995", "0.004", "-0.9", "1.0"] {
        let settings = format!("{key}={jammed} initial.state=jammed");
        assert_eq!(warned(&settings), 1, "{jammed}, jammed");
    }
    // Back flow comes to -0.1 by friction, and to anything where the grains are pushed; a jam reaches 0.98.
    for possible in [
        "-0.1",
        "0.1",
        "0.98",
        "-0.9 drive.body_force=-0.01",
        "1.2 drive.body_force=0.01",
    ] {
        assert_eq!(warned(&format!("{key}={possible}")), 0, "{possible}");
    }
    let run = place.does(&format!("run SMALL {key}=0.999 --out r --quiet"));
    run.says(&["warning: observe.transition_threshold: J/Jmax = 0.999 is"]);
    let summary = read_json(&place.path("r/summary.json"));
    assert_eq!(summary["warnings"][0]["key"], key);
}
