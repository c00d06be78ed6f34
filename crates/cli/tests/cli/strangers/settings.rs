//! Settings, warnings and what `check` says.

use std::io::Write;

use serde_json::Value;

use crate::{Outcome, Place, read_json, warnings, words};

/// Whether a report warns of a key.
fn warns(report: &Value, key: &str) -> bool {
    warnings(report).iter().any(|(of, _)| *of == key)
}

#[test]
fn thresholds_of_the_whole_range_that_the_schema_allows_run_from_either_start() {
    let place = Place::new();
    for (number, threshold) in [-2.0, -0.5, 0.0, 1.0, 1.5, 2.0].into_iter().enumerate() {
        for start in ["rest", "jammed"] {
            let settings =
                format!("observe.transition_threshold={threshold} initial.state={start}");
            let run = place.does(&format!(
                "run SMALL {settings} --out {start}-{number} --json"
            ));
            let at = run.json()["transition_threshold"].as_f64();
            assert!(at.is_none_or(|at| at == threshold), "{at:?}");
        }
    }
    place.does("check SMALL observe.transition_threshold=-1");
    place.refuses(
        "check SMALL observe.transition_threshold=2.5",
        &["at most 2", "-2 or more"],
    );
}

/// Back flow crosses a threshold below 0 on the way down.
#[test]
fn a_threshold_below_zero_is_crossed_by_back_flow() {
    let place = Place::new();
    let pushed = "drive.body_force=-0.01 observe.transition_threshold=-0.1 run.periods=6";
    for start in ["rest", "jammed"] {
        let run = place.does(&format!(
            "run SMALL {pushed} initial.state={start} --out {start} --json"
        ));
        let time = run.json()["transition_time"].as_f64();
        assert!(time.is_some_and(|time| time > 0.0), "{start}: {time:?}");
    }
}

#[test]
fn leaks_and_overlaps_are_the_same_warnings_in_run_and_summary_and_check_foretells_them() {
    let place = Place::new();
    let dense = "--preset frictionless grains.volume_fraction=0.99 tube.waves=2 run.periods=4";
    let checked = place.does(&format!("check {dense} --json")).json();
    assert!(warns(&checked, "grains.volume_fraction"), "{checked:#}");
    let run = place.does(&format!("run {dense} --out dense"));
    let summary = read_json(&place.path("dense/summary.json"));
    assert!(summary["escaped_most"].as_u64().unwrap() > 0);
    for key in ["grains.volume_fraction", "drive.strain_rate"] {
        assert!(warns(&summary, key), "{key}: {summary:#}");
    }
    let found = warnings(&summary);
    assert!(found.iter().any(|(_, it)| it.contains("the tube leaks")));
    // Each is said once, with the same words.
    for (key, message) in found {
        let said = format!("warning: {key}: {message}\n");
        assert_eq!(run.stderr.matches(&said).count(), 1, "{said}{}", run.stderr);
    }
}

/// Seeds side by side say it once.
#[test]
fn seeds_side_by_side_warn_once_of_a_kind() {
    let dense = "run --preset frictionless grains.volume_fraction=0.99 tube.waves=2 run.periods=1";
    let seeds = Place::new().does(&format!("{dense} --seeds 1..2"));
    let key = "warning: grains.volume_fraction: with seed 1 (1 more seed has such a warning) the grains already overlap";
    assert_eq!(seeds.stderr.matches(key).count(), 1, "{}", seeds.stderr);
}

#[test]
fn overlaps_without_units_are_warned_of() {
    let place = Place::new();
    let summary = place
        .does("run --preset frictionless tube.waves=2 run.periods=10 drive.width=2.4 --json")
        .json();
    assert!(summary["largest_overlap"].as_f64().unwrap() > 0.2);
    assert!(warns(&summary, "drive.strain_rate"), "{summary:#}");
}

/// Restitution, contact time, steps per contact, memory and packing time, in rounded numbers.
#[test]
fn check_tells_restitution_contacts_memory_and_packing_in_rounded_numbers() {
    let place = Place::new();
    let check = "check --preset frictional tube.waves=2 grains.number=50";
    place.does(check).shows(&[
        "4988 t: 20 periods of 249.4 t",
        "restitution       0.",
        "steps\n",
        "memory            at most some",
        "of packing",
    ]);
    let report = place.does(&format!("{check} --json")).json();
    for key in [
        "contact_time",
        "steps_per_contact",
        "memory_bytes",
        "packing_seconds",
    ] {
        assert!(report[key].as_f64().unwrap() > 0.0, "{key}");
    }
    let asked = place
        .does(&format!("{check} contact.restitution=0.8 --json"))
        .json();
    assert!((asked["restitution"].as_f64().unwrap() - 0.8).abs() < 1e-6);
}

/// Restitution as an input, with a record that repeats the run to the same bits.
#[test]
fn a_run_by_restitution_is_repeated_from_its_record() {
    let place = Place::new();
    place.does("run SMALL contact.restitution=0.7 --out first");
    place.does("run first/config.toml --out second");
    place.assert_same(["first", "second"], &["config.toml", "timeseries.parquet"]);
    place.refuses(
        "check SMALL contact.restitution=0.7 contact.normal_damping=0.1",
        &["contact.normal_damping and contact.restitution exclude one another"],
    );
}

/// `check -` from standard input.
#[test]
fn a_configuration_is_read_from_standard_input() {
    let place = Place::new();
    let piped = |line: &str, text: &str| {
        let mut command = place.command(words(line));
        let piped = std::process::Stdio::piped;
        let command = command.stdin(piped()).stdout(piped()).stderr(piped());
        let mut child = command.spawn().unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(text.as_bytes())
            .unwrap();
        Outcome::of(child.wait_with_output().unwrap())
    };
    let small = "preset = \"frictionless\"\ngrains.number = 20\ntube.waves = 2\nrun.periods = 1\n";
    piped("check -", small)
        .expect_code(0)
        .shows(&["grains            20"]);
    piped("run - --quiet", small).expect_code(0);
    assert!(place.path("runs/run-1/summary.json").exists());
    let wrong = piped("check -", "preset = \"frictionless\"\n[drive]\nwidht = 2\n");
    wrong
        .expect_code(2)
        .says(&["standard input:3:1", "drive.width"]);
}

#[test]
fn messages_say_one_thing_once_and_in_few_digits() {
    let place = Place::new();
    let refused = |line: &str, parts: &[&str]| place.refuses(line, parts).message();
    let wide = refused(
        "check SMALL drive.width=1e300",
        &["drive.width = 1e300 is wider"],
    );
    assert!(!wide.contains("000000"), "{wide}");
    refused(
        "check SMALL grains.number=1.5",
        &["grains.number = 1.5 is not a whole number"],
    );
    let large = refused(
        "check SMALL grains.number=1e9",
        &[
            "grains.number = 1000000000 is too large",
            "allowed: a whole number",
        ],
    );
    assert!(!large.contains("is not a whole number"), "{large}");
    refused("check SMALL grains.number=1e1", &["write 10"]);
    refused("check SMALL --set drive=3", &["drive = 3 is not a table"]);
    refused(
        "check SMALL contact.stiffness=2",
        &["did you mean contact.normal_stiffness?"],
    );
    let many = "check --preset frictionless grains.number=100000000";
    refused(many, &["100000000 grains do not fit"]);
    let still = "run --preset frictionless drive.strain_rate=0 grains.number=0 run.duration=10";
    let still = place.does(still).stdout;
    assert!(still.contains("J = 0.000 t^-1,"), "{still}");
    place.does("--help").shows(&["the time of --for is up"]);
    place.write("wrong.toml", "preset = \"frictionless\"\ndrive.widht = 3\n");
    let wrong = refused("check wrong.toml", &["wrong.toml:2:7"]);
    assert_eq!(wrong.matches("wrong.toml").count(), 1, "{wrong}");
}

#[test]
fn of_very_many_problems_the_first_are_shown() {
    let place = Place::new();
    let keys: String = (0..5000).map(|number| format!("k{number} = 1\n")).collect();
    place.write(
        "many.toml",
        format!("preset = \"frictionless\"\n[drive]\n{keys}"),
    );
    let refused = place.refuses("check many.toml", &["drive.k0", "and 4980 more problems"]);
    assert!(refused.stderr.len() < 20_000);
}

/// An empty study file and duplicate values name no line.
#[test]
fn faults_of_a_study_file_name_their_lines() {
    let place = Place::new();
    place.write("empty.toml", "");
    place.refuses(
        "study plan empty.toml",
        &["empty.toml:1:1", "name is missing"],
    );
    let axis = "name = \"s\"\npreset = \"frictionless\"\n[[axes]]\nkey = \"drive.width\"\nvalues = [2.5, 2.6,\n2.50]\n";
    place.write("twice.toml", axis);
    place.refuses(
        "study plan twice.toml",
        &["twice.toml:6:1", "the axis has 2.5 twice"],
    );
}

#[test]
fn wall_spheres_stand_where_a_table_says() {
    let place = Place::new();
    let radians = |step: f64| step * std::f64::consts::PI / 12.0;
    let spheres = (0..28 * 12).map(|sphere| (sphere / 12, sphere % 12));
    let lines = spheres.map(|(ring, at)| {
        let angle = radians(f64::from(2 * at + ring % 2));
        format!("{angle:?}, {:?}", f64::from(ring) * 10.0 / 14.0)
    });
    let lines: Vec<String> = lines.collect();
    let table = format!("# a lattice\nangle,place\n{}\n", lines.join("\n"));
    std::fs::create_dir(place.path("folder")).unwrap();
    place.write("folder/wall.csv", table);
    let text = "preset = \"frictionless\"\n[grains]\nnumber = 20\n[tube]\nwaves = 2\narrangement = \"file\"\nfile = \"wall.csv\"\n[run]\nperiods = 4\n";
    place.write("folder/run.toml", text);
    place.does("run folder/run.toml --out table");
    place.does("run SMALL --out lattice");
    // The same places: the same flow but for the rounding of sums.
    let [table, lattice] =
        ["table", "lattice"].map(|folder| read_json(&place.path(folder).join("summary.json")));
    let flow = |summary: &Value| summary["flow_rate_ratio"].as_f64().unwrap();
    assert!(
        (flow(&table) - flow(&lattice)).abs() < 1e-6,
        "{} {}",
        flow(&table),
        flow(&lattice)
    );
    // The record of the run holds the places, and needs the file no more.
    std::fs::remove_file(place.path("folder/wall.csv")).unwrap();
    place.does("run table/config.toml --out again");
    let [one, other] = ["table", "again"]
        .map(|folder| std::fs::read(place.path(folder).join("timeseries.parquet")).unwrap());
    assert!(one == other);
    place.refuses(
        "run folder/run.toml",
        &["tube.file", "wall.csv", "run.toml:7"],
    );
    place.write("folder/wall.csv", "angle,place\n0,0\n1,x\n");
    place.refuses("run folder/run.toml", &["line 3", "1,x", "two numbers"]);
    place.write("folder/wall.csv", "0,0\n");
    place.refuses("run folder/run.toml", &["first line", "angle,place"]);
    place.write("folder/wall.csv", "angle,place\n0,20\n");
    place.refuses("run folder/run.toml", &["0 <= z < L", "20"]);
}

/// A pump engineer: a median beyond the bounds was blamed on the form of the distribution.
#[test]
fn the_value_that_is_wrong_in_a_distribution_is_named() {
    let place = Place::new();
    let sizes = "[grains]\nsizes = \"lognormal\"\ndiameter_min = 0.5\ndiameter_max = 1.5\ndiameter_spread = 0.2\n\
                 diameter_median = 2.5\n";
    place.write("a.toml", format!("preset = \"frictionless\"\n{sizes}"));
    place.refuses(
        "check a.toml",
        &["a.toml:7:19", "diameter_median = 2.5", "0.5", "1.5"],
    );
    let table = "grains.sizes=table grains.diameters=[1,2] grains.fractions=[0,0]";
    place.refuses(
        &format!("check --preset frictionless {table}"),
        &["--set grains.fractions", "all fractions"],
    );
}

/// A pump engineer: what a material stands for was said to be missing beside its name.
#[test]
fn a_missing_key_is_not_looked_for_beside_a_material() {
    let place = Place::new();
    let text = "[units]\nmaterial = \"sand\"\ngrain_diameter = 1e-3\nstiffness = 100.0\nwave_frequency = 1.0\n";
    place.write("a.toml", text);
    let refused = place.refuses("check a.toml", &["contact.law"]);
    assert!(!refused.stderr.contains("material"), "{}", refused.stderr);
}
