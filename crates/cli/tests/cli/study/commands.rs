//! Each subcommand: exit code, words, JSON, and the files that it leaves.

use serde_json::Value;

use super::{STUDY, finished, place_of, quick, tables};
use crate::{Outcome, Place, words};

fn status(place: &Place) -> Value {
    place.does("study status store --json").json()
}

/// Identity of the first run of the status.
fn first(place: &Place) -> String {
    status(place)["runs"][0]["identity"]
        .as_str()
        .unwrap()
        .to_owned()
}

#[test]
fn an_export_says_in_how_many_runs_grains_escaped() {
    let place = place_of(
        r#"
name = "leaking"
preset = "frictionless"
[base]
grains.number = 20
tube.waves = 2
run.periods = 4
drive.width = 2.3
drive.strain_rate = 0.1
[[axes]]
key = "tube.spheres_per_ring"
values = [3, 24]
"#,
    );
    place.does("study run study.toml --store store");
    let exported = place.does("study export store --out tables");
    exported.says(&["grains escaped in 1 of 2 runs: see the column escaped_most"]);
}

#[test]
fn a_plan_counts_runs_steps_time_and_disk_and_makes_nothing() {
    let place = place_of(&format!(
        "{STUDY}[refine]\nkey = \"drive.width\"\ntolerance = 0.1\n"
    ));
    let before = place.inventory();
    let outcome = place.does("study plan study.toml --json");
    let plan = outcome.json();
    let estimate = &plan["estimate"];
    assert_eq!(estimate["points"], 4);
    assert_eq!(estimate["runs"], 12);
    // 0.5 in eighths has seven places between its ends, in two lines, by three replicates.
    assert_eq!(estimate["refinement_runs"], 7 * 2 * 3);
    // 70 periods of 10 in steps of 0.05.
    assert_eq!(estimate["steps"], 12 * 14_000);
    assert_eq!(estimate["grain_steps"], 12.0 * 14_000.0 * 100.0);
    assert!(estimate["processor_seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(plan["runs"].as_array().unwrap().len(), 12);
    place.does("study plan study.toml").shows(&[
        "12: 4 points, 3 replicates each",
        "42 runs more",
        "disk",
    ]);
    assert_eq!(place.inventory(), before);
}

#[test]
fn examples_are_studies() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/studies");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let plan = Place::new()
            .does(&format!("study plan {} --json", path.display()))
            .json();
        assert_eq!(plan["estimate"]["warnings"].as_array().unwrap().len(), 0);
        assert_eq!(plan["name"], path.file_stem().unwrap().to_str().unwrap());
    }
}

#[test]
fn the_disk_of_a_plan_is_about_that_of_the_store() {
    let place = finished();
    let plan = place
        .does("study plan study.toml --store store --json")
        .json();
    assert_eq!(plan["finished"], 4);
    let used: u64 = std::fs::read_dir(place.path("store/runs"))
        .unwrap()
        .flat_map(|run| std::fs::read_dir(run.unwrap().path()).unwrap())
        // Files fill whole blocks.
        .map(|file| {
            file.unwrap()
                .metadata()
                .unwrap()
                .len()
                .next_multiple_of(4096)
        })
        .sum();
    let ratio = plan["estimate"]["bytes"].as_f64().unwrap() / used as f64;
    assert!((0.5..2.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_study_runs_tells_and_exports() {
    let place = place_of(&quick());
    let outcome = place
        .does("study run study.toml")
        .shows(&["tested in stores/tested", "4 runs: 4 done; "])
        .says(&["4 of 4 runs done, 100 % of the work", "all runs are done"]);
    assert!(!outcome.stderr.contains('\r'));
    // The second time there is nothing to do.
    place
        .does("study run study.toml --json --quiet")
        .shows(&["\"done\": 4"]);
    let outcome = place.does("study export stores/tested --out out");
    assert_eq!(
        outcome.stdout,
        "out/tested.parquet\nout/tested.csv\nout/tested-timing.csv\n"
    );
    let csv = std::fs::read_to_string(place.path("out/tested.csv")).unwrap();
    let header = csv.lines().next().unwrap();
    for column in [
        "drive.width",
        "identity",
        "seed",
        "transition_time",
        "censored",
    ] {
        assert!(header.contains(column), "{column}");
    }
    assert!(!header.contains("seconds"));
    // Beside each run is what signac and row look for.
    for run in std::fs::read_dir(place.path("stores/tested/runs")).unwrap() {
        let path = run.unwrap().path().join("signac_statepoint.json");
        let statepoint = crate::read_json(&path);
        assert_eq!(statepoint["tube"]["waves"], 2);
        assert_eq!(statepoint["replicate"], 0);
    }
}

#[test]
fn what_is_wrong_with_a_study_is_said_with_its_place_and_nothing_is_made() {
    for (from, to, parts) in [
        (
            "values = [2.4, 2.9]",
            "values = [2.4, 3.9]",
            &["study.toml:16:16", "wider than the tube"][..],
        ),
        (
            "replicates = 1",
            "replicats = 1",
            &["study.toml:6:1", "did you mean replicates?"],
        ),
    ] {
        let place = place_of(&quick().replace(from, to));
        let before = place.inventory();
        for command in ["plan", "run"] {
            let outcome = place.refuses(&format!("study {command} study.toml"), parts);
            assert_eq!(outcome.stdout, "");
        }
        assert_eq!(place.inventory(), before);
    }
    let place = finished();
    place.refuses("study run missing.toml", &["cannot read missing.toml"]);
    // A store that `study run` would make is none to be refused; another folder is.
    place.does("study plan study.toml --store nowhere");
    place.refuses("study plan study.toml --store store/runs", &["no store"]);
    place.refuses("study status nowhere", &["no store", "study run"]);
    place.write("other.toml", quick().replace("\"tested\"", "\"other\""));
    place.refuses(
        "study run other.toml --store store",
        &["holds the study `tested`, not `other`", "--store"],
    );
    place.refuses("study run study.toml --for soon", &["such as 30m"]);
}

#[test]
fn why_says_what_has_become_of_a_run() {
    let place = finished();
    let run = first(&place);
    let why = |run: &str| place.call(&format!("study why store {run}"));
    why(&run[..8]).expect_code(0).shows(&[
        &run,
        "drive.width 2.4, from rest, replicate 0",
        "state       done",
        "store/runs",
    ]);
    why("").expect_code(2).says(&["4 runs of this store"]);
    why("zz").expect_code(2).says(&["0 runs of this store"]);
    // A study that has moved on no longer knows it.
    place.write("study.toml", quick().replace("[2.4, 2.9]", "[2.6]"));
    place
        .does("study run study.toml --store store")
        .shows(&["not part of the study as it stands: 4 finished runs"]);
    why(&run).expect_code(0).shows(&[
        "not part of the study as it stands",
        "nearest     drive.width 2.6, from rest, replicate 0",
        "changed     drive.width: 2.4, now 2.6\n",
        "done",
    ]);
    place.write(
        "study.toml",
        quick().replace("settled_periods = 30", "settled_periods = 5"),
    );
    place.does("study run study.toml --store store");
    why(&run).expect_code(0).shows(&[
        "nearest     drive.width 2.4",
        "changed     stop.settled_periods: 30, now 5\n",
    ]);
}

#[test]
fn damage_is_told_by_verify_and_mended_by_run() {
    let place = finished();
    let before = tables(&place, "store");
    let run = first(&place);
    let path = place.path("store/runs").join(&run).join("summary.json");
    std::fs::write(&path, "{}").unwrap();
    place.call("study verify store").expect_code(1).shows(&[
        &run,
        "summary.json has 2 bytes",
        "moved aside",
    ]);
    place.does(&format!("study why store {run}")).shows(&[
        "quarantined",
        "store/quarantine",
        "computed again",
    ]);
    let partial = place.does("study export store --out partial").stderr;
    assert!(partial.contains("not finished yet: 1 run\n"), "{partial}");
    place.does("study run study.toml --store store");
    assert!(tables(&place, "store") == before);
    place.does("study verify store");
    std::fs::remove_file(place.path("store/index.sqlite")).unwrap();
    place.does("study scan store").shows(&["4 finished runs"]);
}

#[test]
fn failed_runs_make_the_exit_code_and_can_be_retried() {
    // Grains that do not fit.
    let text = quick().replace("grains.number = 20", "grains.number = 3000");
    let place = place_of(&text.replace("2.9", "2.5"));
    let run = || place.call("study run study.toml --store store");
    run()
        .expect_code(1)
        .shows(&["4 failed", "failed"])
        .says(&["4 runs failed", "study why"]);
    assert_eq!(status(&place)["counts"]["failed"], 4);
    place
        .does("study retry store --failed")
        .shows(&["4 runs will be computed again"]);
    place
        .call(&format!("study retry store {}", first(&place)))
        .expect_code(1)
        .says(&["left as it is"]);
    run().expect_code(1);
}

#[test]
fn finished_runs_travel_by_table_and_by_archive() {
    let place = finished();
    let before = tables(&place, "store");
    place.refuses(
        "study pack store study.toml",
        &["study.toml is no name of an archive", ".tar"],
    );
    place
        .does("study pack store runs.tar")
        .shows(&["4 finished runs in runs.tar"]);
    place
        .does("study import packed runs.tar --study study.toml")
        .shows(&["4 of 4 runs taken"]);
    assert!(tables(&place, "packed") == before);
    place
        .does("study import rows store-tables/tested.csv --study study.toml")
        .shows(&["4 of 4 runs taken"]);
    place
        .does("study import rows store-tables/tested.csv")
        .shows(&["0 of 4 runs taken"]);
    place.does("study run study.toml --store rows");
    assert!(tables(&place, "rows")[..2] == before[..2]);
    place.call("study import rows study.toml").expect_code(2);
    // A table that was cut off in its head; what was made for it is taken away again.
    place.write("cut.csv", "identity,status\n");
    place.refuses(
        "study import cut cut.csv --study study.toml",
        &["nothing is taken from cut.csv"],
    );
    assert!(!place.path("cut").exists());
}

#[test]
fn the_schema_is_printed() {
    let schema = Place::new().does("study schema").json();
    jsonschema::meta::validate(&schema).unwrap();
    assert!(schema["properties"]["base"]["properties"]["drive"].is_object());
}

/// Starts a study that takes minutes, and sends a signal when a run has been saved.
#[cfg(unix)]
fn interrupted(place: &Place, signal: &str) -> Outcome {
    let child = place.start("study run study.toml --store store --checkpoint-every 20ms");
    let is_saved = || {
        let runs = std::fs::read_dir(place.path("store/runs"));
        let mut runs = runs.into_iter().flatten().flatten();
        runs.any(|run| run.path().join("state.checkpoint").is_file())
    };
    while !is_saved() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    crate::send(signal, &child);
    Outcome::of(child.wait_with_output().unwrap())
}

#[cfg(unix)]
#[test]
fn signals_stop_it_with_every_run_saved() {
    for (signal, code) in [("INT", 130), ("TERM", 143), ("USR1", 138)] {
        let place = place_of(&STUDY.replace("run.periods = 70", "run.periods = 100000"));
        let outcome = interrupted(&place, signal).expect_code(code).says(&[
            "stopped, every run is saved",
            "go on with: peristalsis study run",
        ]);
        assert!(
            outcome.stdout.contains("checkpointed"),
            "{}",
            outcome.stdout
        );
        let counts = &status(&place)["counts"];
        assert_eq!(counts["leased"], Value::Null, "{counts}");
    }
}

#[test]
fn time_that_is_up_stops_it_as_well() {
    let place = place_of(
        &STUDY
            .replace("run.periods = 70", "run.periods = 100000")
            .replace("[stop]\nsettled_periods = 30", ""),
    );
    place
        .does("study run study.toml --store store --for 300ms --workers 1")
        .says(&["time is up, every run is saved"])
        .shows(&["1 checkpointed", "11 pending"]);
}

#[test]
fn a_script_for_slurm_goes_to_the_cluster_and_runs_the_study() {
    let place = place_of(&quick());
    let mut call = words(
        "study submit study.toml --slurm --tasks 3 --processors 2 --time 90m --partition long",
    );
    call.extend(["--option=--mem=1G", "--store", "my store"]);
    let outcome = Outcome::of(place.command(call).output().unwrap()).expect_code(0);
    let name = outcome.stdout.split_whitespace().next().unwrap().to_owned();
    let script = std::fs::read_to_string(place.path(&name)).unwrap();
    for line in [
        "#!/bin/bash",
        "#SBATCH --array=1-3",
        "#SBATCH --cpus-per-task=2",
        "#SBATCH --time=0-01:30:00",
        "#SBATCH --signal=B:USR1@60",
        "#SBATCH --partition=long",
        "#SBATCH --mem=1G",
    ] {
        assert!(
            script.lines().any(|known| known == line),
            "{line}: {script}"
        );
    }
    // A shell is what a task is: the store is done, wherever it runs.
    let task = std::process::Command::new("bash")
        .arg(place.path(&name))
        .current_dir("/")
        .env("SLURM_CPUS_PER_TASK", "2")
        .output()
        .unwrap();
    let words = String::from_utf8_lossy(&task.stderr);
    assert!(
        task.status.success() && words.contains("all runs are done"),
        "{words}"
    );
    let status = place.command(["study", "status", "my store"]).output();
    Outcome::of(status.unwrap()).expect_code(0);
}

#[test]
fn a_script_that_could_not_work_is_not_written() {
    let place = place_of(&quick());
    for (options, message) in [
        (&["--time", "1m"][..], "too short to save"),
        (&["--time", "3m"], "give 240 s or more"),
        (&["--option=--mem=1G\nrm -rf /"], "not one option"),
        (&["--option=mem"], "not one option"),
        (&["--option=--array=1-9"], "give it as --tasks"),
        (&["--option=-t 5"], "give it as --time"),
        (&["--tasks", "0"], "1..=10000"),
    ] {
        let mut call = words("study submit study.toml --slurm --store store");
        call.extend(options);
        let refused = place.command(call).output().unwrap();
        Outcome::of(refused).expect_code(2).says(&[message]);
    }
    place.refuses("study submit study.toml", &["--slurm"]);
    let left = place.inventory();
    assert_eq!(left.len(), 1, "the study alone: {:?}", left.keys());
}
