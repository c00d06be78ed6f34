//! How runs begin: their length, sizes that are beyond reach, packing that is stopped, folders that are taken.

use std::io::{BufRead, BufReader, Read};
use std::process::Child;
use std::time::{Duration, Instant};

use crate::{Place, read_json};

/// The first guess of how to say the length of a run.
#[test]
fn the_length_of_a_run_is_an_option_of_its_own() {
    let place = Place::new();
    let tube = "--preset frictionless grains.number=20 tube.waves=2";
    place.does(&format!("run {tube} run.periods=2 --out set"));
    place.does(&format!("run {tube} --periods 2 --out asked"));
    place.assert_same(["set", "asked"], &["config.toml", "timeseries.parquet"]);
    place.does(&format!("run {tube} --seeds 1..2 --periods 2 --out seeds"));
    place.assert_same(["set", "seeds/seed-1"], &["config.toml"]);
    let checked = place.does(&format!("check {tube} --duration 30 --json"));
    assert_eq!(checked.json()["duration"].as_f64(), Some(30.0));
    place.refuses(
        &format!("run {tube} --periods 0"),
        &["--periods", "above 0"],
    );
    place.refuses("run --periods 3", &["give a FILE or a --preset"]);
}

/// Sizes that took a minute, or all memory, before they were refused.
#[test]
fn sizes_beyond_reach_are_refused_before_anything_is_made() {
    let place = Place::new();
    let begin = Instant::now();
    for command in ["check", "run"] {
        let tube = format!("{command} --preset frictionless");
        place.refuses(
            &format!("{tube} tube.rings_per_wave=1000000"),
            &[
                "tube.rings_per_wave=1000000",
                "wall so dense",
                "at most 100000",
            ],
        );
        let many = "grains.number=12 run.periods=1 tube.waves=1000000 --trajectory gsd";
        place.refuses(
            &format!("{tube} {many}"),
            &["168000012 spheres", "tube.waves"],
        );
    }
    assert!(begin.elapsed() < Duration::from_secs(20));
    assert!(place.inventory().is_empty());
}

/// `check` of a tube of very many grains took minutes.
#[test]
fn a_wide_tube_is_tried_in_a_narrower_one() {
    let place = Place::new();
    let wide = "check --preset frictionless tube.radius=300 --json";
    let report = place.does(wide).json();
    assert!(report["grains"].as_u64().unwrap() > 1_000_000);
    let packing = report["packing_seconds"].as_f64().unwrap();
    assert!(packing > 1.0, "{packing}");
}

/// Sends Ctrl-C when a program says that it packs, and answers its exit code and what it said.
fn stopped_while_packing(mut child: Child) -> (Option<i32>, String) {
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut said = String::new();
    while !said.contains("packing") {
        assert!(errors.read_line(&mut said).unwrap() > 0, "{said}");
    }
    std::thread::sleep(Duration::from_millis(300));
    crate::send("INT", &child);
    let begin = Instant::now();
    errors.read_to_string(&mut said).unwrap();
    let code = child.wait().unwrap().code();
    assert!(begin.elapsed() < Duration::from_secs(10), "{said}");
    (code, said)
}

/// Grains whose packing takes many seconds.
const MANY: &str = "--preset frictionless grains.number=400000 tube.waves=20000";

/// Ctrl-C while a million grains were packed printed nothing.
#[cfg(unix)]
#[test]
fn packing_that_is_stopped_says_so_and_leaves_nothing() {
    let place = Place::new();
    let child = place.start(&format!("run {MANY} --out big"));
    let (code, said) = stopped_while_packing(child);
    assert_eq!(code, Some(130), "{said}");
    assert!(
        said.contains("stopped before there was any result"),
        "{said}"
    );
    assert!(place.inventory().is_empty());

    let child = place.start(&format!("run {MANY} --seeds 1..2 --out many"));
    let (code, said) = stopped_while_packing(child);
    assert_eq!(code, Some(130), "{said}");
    for part in ["0 seeds complete", "run --resume many"] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!place.path("many/seed-1/state.checkpoint").exists());
}

/// A signal is how `view` ends, before its page is there too.
#[cfg(unix)]
#[test]
fn view_says_that_it_packs_and_ends_well_while_it_does() {
    let place = Place::new();
    let (_, settings) = MANY.split_once("frictionless").unwrap();
    let child = place.start(&format!("view frictionless{settings}"));
    let (code, said) = stopped_while_packing(child);
    assert_eq!(code, Some(0), "{said}");
}

#[cfg(unix)]
#[test]
fn a_study_that_is_stopped_while_it_packs_ends_soon() {
    let place = Place::new();
    let study = "name = \"big\"\npreset = \"frictionless\"\n[base]\ngrains.number = 400000\ntube.waves = 20000\n";
    place.write("study.toml", study);
    let mut child = place.start("study run study.toml --store kept");
    while !place.path("kept/runs").is_dir() {
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_secs(1));
    crate::send("INT", &child);
    let begin = Instant::now();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(begin.elapsed() < Duration::from_secs(10));
    place.does("study status kept").shows(&["1 run: 1 pending"]);
}

/// Two programs went on with one folder at once.
#[cfg(unix)]
#[test]
fn a_run_that_is_worked_on_is_not_gone_on_with_by_another_program() {
    let place = Place::new();
    let slow = "SMALL run.periods=1 run.time_step=1e-9";
    let mut alone = place.start(&format!("run {slow} --out one"));
    let mut seeds = place.start(&format!("run {slow} --seeds 1..2 --out many"));
    for name in ["one", "many/seed-1", "many/seed-2"] {
        while !place.path(name).join("state.checkpoint").is_file() {
            std::thread::sleep(Duration::from_millis(10));
        }
    }
    let taken = "is being worked on by another program";
    for name in ["one", "many", "many/seed-2"] {
        place.refuses(&format!("run --resume {name} --quiet"), &[name, taken]);
    }
    // Others may read it.
    place.does("figures one");
    for child in [&mut alone, &mut seeds] {
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let mut again = place.start("run --resume one");
    std::thread::sleep(Duration::from_secs(2));
    crate::send("INT", &again);
    assert_eq!(again.wait().unwrap().code(), Some(130));
    let left = std::fs::read_dir(place.path("one")).unwrap();
    let names = left.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(names.into_iter().all(|name| !name.contains("lock")));
}

/// Replicates that are complete are left as they are.
#[test]
fn complete_replicates_that_are_gone_on_with_are_not_written_again() {
    let place = Place::new();
    place.does("run SMALL --seeds 1..2 --out many");
    let before = place.inventory();
    place
        .does("run --resume many")
        .shows(&["seed 2: J/Jmax = ", "mean of 2 seeds"]);
    place.does("run --resume many --periods 4");
    assert!(place.inventory() == before);
    place.does("run --resume many --csv");
    assert!(place.path("many/seed-1/timeseries.csv").is_file());
}

/// Pictures of a tube of extreme shape took minutes, or all memory.
#[test]
fn pictures_of_extreme_tubes_are_of_usual_size() {
    let place = Place::new();
    for (name, shape) in [
        ("long", "tube.wavelength=300000 tube.waves=2"),
        ("wide", "tube.radius=267356 tube.waves=2"),
    ] {
        let tube = format!("--preset frictionless grains.number=12 {shape}");
        place.does(&format!("run {tube} run.periods=0.02 --out {name}"));
        for file in ["snapshot.svg", "snapshot.png"] {
            let size = place.path(name).join(file).metadata().unwrap().len();
            assert!(size < 3_000_000, "{name}/{file}: {size} bytes");
        }
        assert_eq!(
            read_json(&place.path(name).join("summary.json"))["status"],
            "complete"
        );
    }
}
