//! Trajectories: asked for beside a run, foretold by `check`, gone on with, and written from a saved state.

use crate::{Place, read_json};

#[test]
fn a_run_says_what_it_wrote() {
    let place = Place::new();
    let outcome = place
        .does("run SMALL --out results --json --trajectory gsd,vtp --trajectory lammps")
        .says(&[
            "trajectory: 41 frames, one every 40 steps",
            "results/trajectory.gsd",
        ]);
    let report = &outcome.json()["trajectory"];
    assert_eq!(report["frames"], 41);
    assert_eq!(report["interval_steps"], 40);
    let files = report["files"].as_array().unwrap();
    assert_eq!(files.len(), 3);
    for file in files {
        assert!(place.path(file.as_str().unwrap()).is_file(), "{file}");
    }
    let frames = std::fs::read_dir(place.path("results/trajectory")).unwrap();
    let written: u64 = frames
        .map(|entry| entry.unwrap().metadata().unwrap().len())
        .chain(["gsd", "lammpstrj"].map(|ending| {
            let path = place.path(&format!("results/trajectory.{ending}"));
            path.metadata().unwrap().len()
        }))
        .sum();
    assert_eq!(report["bytes"], written);
    assert_eq!(
        &read_json(&place.path("results/summary.json"))["trajectory"],
        report
    );

    // Whether there is a trajectory changes nothing else.
    let plain = place.does("run SMALL --out plain --json");
    assert!(plain.json().get("trajectory").is_none());
    place.assert_same(
        ["results", "plain"],
        &["config.toml", "timeseries.parquet", "profile.parquet"],
    );
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_made() {
    let place = Place::new();
    for (options, says) in [
        ("--trajectory xyz", "gsd, vtp, lammps"),
        ("--trajectory-every 1", "add --trajectory gsd"),
        ("--trajectory-window 1:2", "add --trajectory gsd"),
        ("--trajectory gsd --trajectory-every -1", "from 0 on"),
        ("--trajectory gsd --trajectory-every often", "such as 0.1"),
        ("--trajectory gsd --trajectory-every 0", "a longer interval"),
        ("--trajectory gsd --trajectory-window 3", "FROM:TO"),
        ("--trajectory gsd --trajectory-window 2:1", "reversed"),
        (
            "--trajectory gsd --trajectory-window 7:9",
            "no frame lies there",
        ),
    ] {
        place.refuses(&format!("run SMALL {options}"), &[says]);
    }
    assert!(place.inventory().is_empty());
    place.write("trajectory.gsd", "another's");
    place.refuses(
        "run SMALL --out .",
        &["holds another run", "trajectory.gsd"],
    );
}

#[test]
fn check_foretells_the_size() {
    let place = Place::new();
    let small = "SMALL --trajectory gsd,lammps --trajectory-every 0.05";
    place.does(&format!("check {small}")).shows(&[
        "trajectory.gsd of 81 frames, one every 20 steps: about",
        " MB",
    ]);
    let foretold = place.does(&format!("check {small} --json")).json();
    assert_eq!(foretold["trajectory"]["frames"], 81);
    let bytes = foretold["trajectory"]["bytes"].as_array().unwrap();
    assert_eq!(bytes[0][0], "gsd");
    place.does(&format!("run {small} --out results"));
    for (entry, file) in bytes.iter().zip(["trajectory.gsd", "trajectory.lammpstrj"]) {
        let found = place.path("results").join(file).metadata().unwrap().len() as f64;
        let ratio = found / entry[1].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 0.1, "{file}: {ratio}");
    }
}

#[test]
fn frames_from_the_state_of_a_finished_run() {
    let place = Place::new();
    place.does("run SMALL --out results");
    let before = place.inventory();
    place
        .does("trajectory results --format gsd,lammps --out state")
        .shows(&["1 frame,", "state/trajectory.gsd"]);
    let lammps = |folder: &str| {
        std::fs::read_to_string(place.path(folder).join("trajectory.lammpstrj")).unwrap()
    };
    let state = lammps("state");
    assert!(state.contains("ITEM: TIMESTEP\n1600\n"), "{}", &state[..80]);
    let report = place
        .does("trajectory results --format lammps --duration 0.5 --every 2t --out on --json")
        .json();
    assert_eq!(report["frames"], 6);
    assert_eq!(report["interval_steps"], 40);
    let on = lammps("on");
    assert!(on.starts_with(&state) && on.contains("ITEM: TIMESTEP\n1800\n"));
    // They are the frames that a longer run has there.
    place.does("run SMALL run.periods=4.5 --out longer --trajectory lammps");
    let whole = lammps("longer");
    let from = whole.find("ITEM: TIMESTEP\n1600\n").unwrap();
    assert!(on.ends_with(&whole[from..]));
    for (name, content) in before {
        assert_eq!(place.inventory()[&name], content, "{}", name.display());
    }

    let again = place.refuses(
        "trajectory results --out on",
        &["holds another run", "--out"],
    );
    assert!(!again.message().contains("--resume"), "{}", again.message());
    place.refuses("trajectory nowhere", &["nowhere holds no run"]);
}

#[test]
fn the_state_alone_of_a_wave_that_stands_still() {
    let place = Place::new();
    place.does(
        "run --preset frictionless --out still drive.strain_rate=0 run.duration=5 grains.number=20",
    );
    place
        .does("trajectory still")
        .shows(&["1 frame", "from-state/trajectory.gsd"]);
    place.refuses(
        "trajectory still --duration 1 --out more",
        &["the wave stands still"],
    );
}
