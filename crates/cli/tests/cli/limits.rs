//! What is extreme but allowed, and what fails on the way: no grains, one grain, a diverging run, a full disk.

use serde_json::Value;

use crate::{Outcome, Place, SMALL, read_json};

#[test]
fn a_static_wave_has_no_ratio_and_no_figure_of_it() {
    let place = Place::new();
    let settings = ["drive.strain_rate=0", "run.duration=50", "grains.number=20"];
    let outcome = place
        .run_preset("frictionless", "results", &settings)
        .expect_code(0)
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
        (["grains.number=0", "tube.waves=2"], "none", false),
        (["grains.number=1", "tube.waves=2"], "grain", true),
        (["grains.number=20", "tube.waves=1"], "wave", true),
        (["grains.number=20", "run.periods=0.05"], "short", true),
    ] {
        let arguments = [&["run"], SMALL, &["--out", folder, "--json"]].concat();
        let outcome = place.call_with(&arguments, &settings).expect_code(0);
        let ratio = &outcome.json()["flow_rate_ratio"];
        assert_eq!(ratio.is_number(), has_ratio, "{folder}");
        let table = place.path(folder).join("timeseries.parquet");
        assert!(table.is_file(), "{folder}");
    }
    for folder in ["grain", "wave"] {
        assert!(place.path(folder).join("flow.svg").is_file(), "{folder}");
    }
    let summary = read_json(&place.path("short/summary.json"));
    assert_eq!(summary["transition_time"], Value::Null);
}

#[test]
fn a_diverging_run_names_step_and_grain_and_saves_its_state() {
    let place = Place::new();
    let settings = ["run.time_step=1", "run.periods=5"];
    let arguments = ["run", "--preset", "frictionless", "--out", "results"];
    let outcome: Outcome = place.call_with(&arguments, &settings).expect_code(1);
    let message = outcome.message();
    for part in [
        "diverged at step ",
        "grain ",
        "shorter run.time_step",
        "the state, are in results",
    ] {
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
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
    // From the saved state it cannot go on either, and says so again.
    place
        .call(["run", "--resume", "results"])
        .expect_code(1)
        .says(&["diverged at step "]);
}

#[test]
fn a_wall_that_buckles_is_a_diagnosis_not_a_crash() {
    let place = Place::new();
    // Springs without tension and no tethers.
    let settings = [
        "grains.number=20",
        "wall.natural_length=1",
        "wall.keep.azimuthal=0",
        "wall.keep.axial=0",
        "run.periods=0.2",
    ];
    let arguments = ["run", "--preset", "frictional", "--out", "results"];
    let outcome = place.call_with(&arguments, &settings).expect_code(0);
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
    assert!(
        outcome.stdout.contains("wall.natural_length"),
        "{}",
        outcome.stdout
    );
    assert!(outcome.stdout.contains("wall.keep."), "{}", outcome.stdout);
}

#[test]
fn a_sound_wall_has_no_diagnosis() {
    let settings = ["grains.number=20", "run.periods=0.05"];
    let outcome = Place::new().run_preset("frictional", "results", &settings);
    let summary = outcome.expect_code(0).json();
    assert_eq!(summary["wall_diagnosis"], Value::Array(Vec::new()));
}

#[cfg(target_os = "linux")]
#[test]
fn a_tube_for_which_there_is_no_memory_is_refused_in_words() {
    let place = Place::new();
    let limited = |arguments: &[&str]| {
        let mut command = std::process::Command::new("sh");
        command
            .args(["-c", "ulimit -v 4000000; exec \"$0\" \"$@\""])
            .arg(env!("CARGO_BIN_EXE_peristalsis"))
            .args(arguments)
            .current_dir(place.folder.path());
        Outcome::of(command.output().unwrap())
    };
    let large = [
        "--preset",
        "frictional",
        "--set",
        "tube.waves=1000000",
        "--set",
        "grains.number=5",
    ];
    for command in [&["run", "--out", "results"][..], &["check"]] {
        let command = [command, &large].concat();
        limited(&command).expect_code(2).says(&[
            "506000005 moving spheres take about 506.0 GB of memory",
            "tube.waves",
            "ulimit -v",
        ]);
    }
    // Small grains in a large tube take no more than they are.
    let small = [
        "grains.diameter_min=0.01",
        "grains.diameter_max=0.01",
        "tube.waves=200",
        "run.periods=0.05",
    ];
    let small = small.iter().flat_map(|setting| ["--set", setting]);
    let small: Vec<&str> = ["check"]
        .iter()
        .chain(SMALL)
        .copied()
        .chain(small)
        .collect();
    limited(&small).expect_code(0);
    assert!(!place.path("results").exists());
}

/// Runs the small tube in a shell that lets no file grow beyond a number of blocks of 512 bytes.
#[cfg(unix)]
fn run_with_small_files(place: &Place, blocks: u32, arguments: &[&str]) -> Outcome {
    let mut command = std::process::Command::new("sh");
    // The signal of a file too large would end the program before it can see the error.
    command
        .arg("-c")
        .arg(format!(
            "trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\""
        ))
        .arg(env!("CARGO_BIN_EXE_peristalsis"))
        .arg("run")
        .args(SMALL)
        .args(arguments)
        .current_dir(place.folder.path());
    Outcome::of(command.output().unwrap())
}

#[cfg(unix)]
#[test]
fn a_disk_that_is_full_from_the_start() {
    let place = Place::new();
    run_with_small_files(&place, 0, &["--out", "a/b"])
        .expect_code(2)
        .says(&["cannot write to a/b"]);
    assert!(place.inventory().is_empty());
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_while_results_are_written() {
    let place = Place::new();
    // Room for the configuration, not for the tables.
    let outcome = run_with_small_files(&place, 8, &["--out", "results"])
        .expect_code(1)
        .says(&["error:", "results"]);
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
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_with_a_trajectory_loses_nothing_else() {
    for format in ["gsd", "lammps"] {
        let place = Place::new();
        let frames = ["--trajectory", format, "--trajectory-every", "0.03"];
        // Room for each of the results, but not for the frames.
        let stopped = [&frames[..], &["--out", "stopped"]].concat();
        run_with_small_files(&place, 1024, &stopped)
            .expect_code(1)
            .says(&[
                "the run was stopped",
                "trajectory.",
                "File too large",
                "peristalsis run --resume stopped",
            ]);
        let summary = read_json(&place.path("stopped/summary.json"));
        assert_eq!(summary["status"], "interrupted");
        assert!(summary["trajectory"]["frames"].as_u64().unwrap() > 3);
        place
            .call(["run", "--resume", "stopped", "--trajectory", "gsd"])
            .expect_code(2)
            .says(&["leave out --trajectory"]);
        place.call(["run", "--resume", "stopped"]).expect_code(0);
        let through = [&frames[..], &["--out", "through"]].concat();
        place.run_small(&through).expect_code(0);
        let file = match format {
            "gsd" => "trajectory.gsd",
            _ => "trajectory.lammpstrj",
        };
        place.assert_same(
            ["stopped", "through"],
            &[file, "timeseries.parquet", "profile.parquet"],
        );
    }
}
