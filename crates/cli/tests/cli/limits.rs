//! What is extreme but allowed, and what fails on the way: no grains, one grain, a diverging run, a full disk.

use serde_json::Value;

use crate::{Outcome, Place, read_json, words};

#[test]
fn a_static_wave_has_no_ratio_and_no_figure_of_it() {
    let place = Place::new();
    let settings = "drive.strain_rate=0 run.duration=50 grains.number=20";
    let outcome = place
        .does(&format!(
            "run --preset frictionless --out results --json {settings}"
        ))
        .says(&["100 % t 50.0"]);
    let summary = outcome.json();
    for key in [
        "flow_rate_ratio",
        "flow_rate_ratio_error",
        "flow_rate_ratio_raw",
        "transition_time",
    ] {
        assert_eq!(summary[key], Value::Null, "{key}");
    }
    assert_eq!(summary["censored"], true);
    assert_eq!(summary["periods"], 0.0);
    // Nothing drives the grains: what moves them is the little that packing left overlapping.
    assert!(summary["flow_rate"].as_f64().unwrap().abs() < 1e-6);
    assert_eq!(summary["wall_power"].as_f64().unwrap(), 0.0);
    assert!(!place.path("results/flow.svg").exists());
    assert!(place.path("results/timeseries.parquet").is_file());
}

#[test]
fn no_grains_one_grain_one_wave_and_less_than_a_period() {
    let place = Place::new();
    for (settings, folder, has_ratio) in [
        ("grains.number=0", "none", false),
        ("grains.number=1", "grain", true),
        ("tube.waves=1", "wave", true),
        ("run.periods=0.05", "short", true),
    ] {
        let outcome = place.does(&format!("run SMALL --out {folder} --json {settings}"));
        let ratio = &outcome.json()["flow_rate_ratio"];
        assert_eq!(ratio.is_number(), has_ratio, "{folder}");
        let table = place.path(folder).join("timeseries.parquet");
        assert!(table.is_file(), "{folder}");
    }
    place
        .does("run SMALL --out bare grains.number=0")
        .says(&["no grains to draw: the run has no figures"]);
    for folder in ["grain", "wave"] {
        assert!(place.path(folder).join("flow.svg").is_file(), "{folder}");
    }
    let summary = read_json(&place.path("short/summary.json"));
    assert_eq!(summary["transition_time"], Value::Null);
}

#[test]
fn a_diverging_run_names_step_and_grain_and_saves_its_state() {
    let place = Place::new();
    let message = place
        .call("run --preset frictionless --out results run.time_step=1 run.periods=5")
        .expect_code(1)
        .says(&[
            "diverged at step ",
            "grain ",
            "shorter run.time_step",
            "the state, are in results",
        ])
        .message();
    let summary = read_json(&place.path("results/summary.json"));
    assert_eq!(summary["status"], "diverged");
    let said = summary["message"].as_str().unwrap();
    assert!(message.contains(said), "{said:?} is not in {message:?}");
    let step = summary["steps"].as_u64().unwrap();
    assert!(said.contains(&format!("at step {step} ")), "{said}");
    for name in [
        "state.checkpoint",
        "timeseries.parquet",
        "profile.parquet",
        "config.toml",
    ] {
        assert!(place.path("results").join(name).is_file(), "{name}");
    }
    // It would diverge again: that is said, and the state stays.
    let before = place.inventory();
    place
        .call("run --resume results")
        .expect_code(2)
        .says(&["holds no run that can be continued", "diverged at step "]);
    assert!(place.inventory() == before);
}

#[test]
fn a_wall_that_buckles_is_a_diagnosis_not_a_crash() {
    let place = Place::new();
    // Springs without tension and no tethers.
    let limp = "wall.natural_length=1 wall.keep.azimuthal=0 wall.keep.axial=0";
    let run = "run --preset frictional --out results grains.number=20 run.periods=0.2";
    let outcome = place
        .does(&format!("{run} {limp}"))
        .shows(&["wall.natural_length", "wall.keep."]);
    let summary = read_json(&place.path("results/summary.json"));
    let diagnoses = summary["wall_diagnosis"].as_array().unwrap();
    assert!(!diagnoses.is_empty());
    for diagnosis in diagnoses {
        let diagnosis = diagnosis.as_str().unwrap();
        assert!(outcome.stdout.contains(diagnosis), "{}", outcome.stdout);
        for part in ["at t = ", "wall sphere ", "z = "] {
            assert!(diagnosis.contains(part), "{diagnosis}");
        }
    }
}

#[test]
fn a_sound_wall_has_no_diagnosis() {
    let run = "run --preset frictional --out results --json grains.number=20 run.periods=0.05";
    let summary = Place::new().does(run).json();
    assert_eq!(summary["wall_diagnosis"], Value::Array(Vec::new()));
}

#[cfg(target_os = "linux")]
#[test]
fn a_tube_for_which_there_is_no_memory_is_refused_in_words() {
    let place = Place::new();
    let limited = |line: &str| limited(&place, "ulimit -v 4000000", line);
    let large = "--preset frictional tube.waves=1000000 grains.number=5";
    for command in ["run --out results", "check"] {
        limited(&format!("{command} {large}"))
            .expect_code(2)
            .says(&[
                "a run of 506000005 moving spheres takes up to some 1.5 TB of memory",
                "tube.waves",
                "ulimit -v",
            ]);
    }
    // Small grains in a large tube take no more than they are.
    let small = "grains.diameter_min=0.01 grains.diameter_max=0.01 tube.waves=200 run.periods=0.05";
    limited(&format!("check SMALL {small}")).expect_code(0);
    assert!(!place.path("results").exists());
}

/// Calls the program in a shell that has done something before.
#[cfg(unix)]
pub(crate) fn limited(place: &Place, before: &str, line: &str) -> Outcome {
    let mut command = std::process::Command::new("sh");
    command
        .args(["-c", &format!("{before}; exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_peristalsis"))
        .args(words(line))
        .current_dir(place.folder.path());
    Outcome::of(command.output().unwrap())
}

/// Calls the program where no file may grow beyond a number of blocks of 512 bytes: then a write fails as on a full disk.
#[cfg(unix)]
pub(crate) fn with_small_files(place: &Place, blocks: u32, line: &str) -> Outcome {
    limited(place, &format!("ulimit -f {blocks}"), line)
}

#[cfg(unix)]
#[test]
fn a_disk_that_is_full_from_the_start() {
    let place = Place::new();
    with_small_files(&place, 0, "run SMALL --out a/b")
        .expect_code(2)
        .says(&["cannot write to a/b"]);
    assert!(place.inventory().is_empty());
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_while_results_are_written() {
    let place = Place::new();
    // Room for the configuration, not for the tables.
    let outcome = with_small_files(&place, 8, "run SMALL --out results")
        .expect_code(1)
        .says(&["error:", "results", "make room", "run --resume results"]);
    assert!(!outcome.message().contains("written to"));
    let left: Vec<_> = place.inventory().into_keys().collect();
    // Whole files or none: no summary says that there are tables, nothing partial is left.
    assert!(!place.path("results/summary.json").exists(), "{left:?}");
    assert!(
        left.iter()
            .all(|name| !name.to_string_lossy().contains("partial")),
        "{left:?}"
    );
    assert!(place.path("results/config.toml").is_file());
    place.does("run --resume results");
    assert!(place.path("results/summary.json").is_file());
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_with_a_trajectory_loses_nothing_else() {
    // Room for each of the results, but not for the frames; the last disk is full before the first sample, and has no room for
    // some pictures either.
    for (format, every, blocks, fewest) in [
        ("gsd", "0.03", 1024, 4),
        ("lammps", "0.03", 1024, 4),
        ("lammps", "0.01 --checkpoint-every 1h", 256, 3),
    ] {
        let place = Place::new();
        let run = format!("run SMALL --trajectory {format} --trajectory-every {every}");
        with_small_files(&place, blocks, &format!("{run} --out stopped"))
            .expect_code(1)
            .says(&[
                "the run was stopped",
                "trajectory.",
                "File too large",
                "peristalsis run --resume stopped",
            ]);
        let summary = read_json(&place.path("stopped/summary.json"));
        assert_eq!(summary["status"], "interrupted");
        assert!(summary["trajectory"]["frames"].as_u64().unwrap() >= fewest);
        place.refuses(
            "run --resume stopped --trajectory gsd",
            &["leave out --trajectory, --trajectory-every"],
        );
        place.does("run --resume stopped");
        place.does(&format!("{run} --out through"));
        let file = match format {
            "gsd" => "trajectory.gsd",
            _ => "trajectory.lammpstrj",
        };
        place.assert_same(["stopped", "through"], &[file]);
        place.assert_same_run(["stopped", "through"]);
    }
}
