//! `peristalsis reproduce`: what it says, writes and takes over. That all studies come to their end is tested in `claims`.

use std::path::Path;

use peristalsis_formats::{Column, Table, Values, parquet, read_table};
use serde_json::Value;

use crate::{Outcome, Place, read_json};

/// A claim, its studies, and how long to work on them: nothing ends in so short a time.
const BRIEFLY: &str = "reproduce --quick --only F2 --for 1s";

fn claims(out: &Path) -> Vec<Value> {
    read_json(&out.join("claims.json"))["claims"]
        .as_array()
        .unwrap()
        .clone()
}

#[test]
fn a_report_is_written_from_what_there_is_and_the_next_call_goes_on() {
    let place = Place::new();
    let outcome = place
        .does(BRIEFLY)
        .says(&[
            "1 claim, quick design, in reproduction",
            "study 1 of",
            "% of all work",
            "F2 open (thin statistics):",
            "time is up, every run is saved",
        ])
        .shows(&["F2   open", "report: reproduction/report.html"]);
    assert!(!outcome.stderr.contains('\r'));
    let out = place.path("reproduction");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("id=\"claim-f2\"") && !page.contains("id=\"claim-f1\""));
    let found = claims(&out);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0]["verdict"], "open");
    let study = &found[0]["studies"][0];
    assert!(study["runs"].as_u64().unwrap() > study["done"].as_u64().unwrap());
    // What was begun is kept: some run has a checkpoint.
    let checkpoints = || -> usize {
        std::fs::read_dir(out.join("stores"))
            .unwrap()
            .flat_map(|store| std::fs::read_dir(store.unwrap().path().join("runs")).unwrap())
            .filter(|run| {
                let run = run.as_ref().unwrap().path();
                run.join("state.checkpoint").is_file() || run.join("done.json").is_file()
            })
            .count()
    };
    let before = checkpoints();
    assert!(before > 0);
    // As JSON, in the other size, without a word.
    let outcome = place.does("reproduce --fresh --only F2 --for 1s --json --quiet");
    assert_eq!(outcome.stderr, "");
    let printed: Value = outcome.json();
    assert_eq!(printed, read_json(&out.join("claims.json")));
    assert_eq!(printed["size"], "full");
    assert!(checkpoints() >= before);
}

/// A study of four runs that no claim has.
const FOREIGN: &str = r#"
name = "foreign"
preset = "frictionless"
replicates = 2
[base]
grains.number = 20
tube.waves = 2
run.periods = 4
[[axes]]
key = "drive.width"
values = [2.4, 2.9]
"#;

#[test]
fn tables_are_looked_through_for_runs_of_the_studies() {
    let place = Place::new();
    place.write("study.toml", FOREIGN);
    place.does("study run study.toml");
    place.does("study export stores/foreign --out tables");
    place.does(&format!("{BRIEFLY} --import tables")).says(&[
        "2 tables of finished runs",
        "tables/foreign-timing.csv is left out",
        "divergence-fine: 0 of",
    ]);
    // Named, it must be a table of runs.
    for (name, part) in [
        ("study.toml", "study.toml"),
        ("nowhere", "nowhere"),
        (
            "tables/foreign-timing.csv",
            "nothing is taken from tables/foreign-timing.csv: ",
        ),
    ] {
        place.refuses(&format!("{BRIEFLY} --import {name}"), &[part]);
    }
}

/// The shortest run among the published rows of a study, as a table with another value in one place.
fn shortest_published(place: &Place, name: &str, changed: Option<(&str, f64)>) {
    let published = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/results");
    let table = read_table(&published.join("wavelength.parquet")).unwrap();
    let steps = table.integers("steps").unwrap();
    let shortest = (0..table.rows()).min_by_key(|row| steps[*row]).unwrap();
    let columns = table.columns().iter().map(|column| {
        let values = match &column.values {
            Values::Real(values) => Values::Real(vec![match changed {
                Some((name, value)) if name == column.name => value,
                _ => values[shortest],
            }]),
            Values::Integer(values) => Values::Integer(vec![values[shortest]]),
            Values::Text(values) => Values::Text(vec![values[shortest].clone()]),
            Values::Boolean(values) => Values::Boolean(vec![values[shortest]]),
        };
        Column {
            values,
            ..column.clone()
        }
    });
    let one = Table::builder().columns(columns).build().unwrap();
    std::fs::create_dir_all(place.path(name)).unwrap();
    parquet::write(&place.path(name).join("wavelength.parquet"), &one).unwrap();
}

#[test]
fn published_rows_are_computed_again_and_one_that_was_changed_is_named() {
    let place = Place::new();
    // Found in a folder above.
    shortest_published(&place, "validation/results", None);
    let line = "reproduce --only Q3 --check 100% --check-seed 5";
    place
        .does(line)
        .says(&["wavelength: 1 of", "drawn with --check-seed 5"])
        .shows(&[
            "Q3   open",
            "Of 1 published rows 1, from 1 of 1 studies, were computed again, drawn with the seed 5: all came out the same",
        ]);
    place.refuses(
        "reproduce --only Q3 --fresh",
        &["holds published rows already"],
    );
    place.refuses("reproduce --only F8", &["none of these tables holds a row"]);
    shortest_published(&place, "changed", Some(("flow_rate_ratio", 0.5)));
    let line = "reproduce --only Q3 --check 100% --import changed --out other";
    place.call(line).expect_code(3).says(&[
        "a run computed again differs from its published row study wavelength, run ",
        "flow_rate_ratio: 0.5 in the table, 0.99",
        "its configuration: other/again/wavelength/runs/",
    ]);
    let rows = &read_json(&place.path("other/claims.json"))["published_rows"];
    assert_eq!(rows["studies"][0]["differing"], 1);
    assert_eq!(rows["differing"][0]["column"], "flow_rate_ratio");
    let page = std::fs::read_to_string(place.path("other/report.html")).unwrap();
    assert!(page.contains("id=\"rows\"") && page.contains("one came out different"));
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_made() {
    let place = Place::new();
    let before = place.inventory();
    place.refuses(
        "reproduce --only F2,F99",
        &["there is no claim \"F99\"", "claims: F1, F2,"],
    );
    for options in ["--quick --full", "--quick --check 1%", "--fresh --import x"] {
        place.refuses(&format!("reproduce {options}"), &["cannot be used with"]);
    }
    place.refuses("reproduce --check 2", &["a part such as 1%", "90s"]);
    place.refuses(
        "reproduce --only F2",
        &[
            "there is no folder validation/results",
            "--import",
            "--quick",
            "--fresh",
        ],
    );
    place.refuses("reproduce --for 30", &["such as 30m"]);
    assert_eq!(place.inventory(), before);
    place.write("file", "");
    place.refuses(
        &format!("{BRIEFLY} --out file/below"),
        &[
            "cannot write to file/below",
            "name another folder with --out",
        ],
    );
}

#[cfg(unix)]
#[test]
fn a_signal_stops_it_with_a_report() {
    use std::io::{BufRead, BufReader, Read};

    let place = Place::new();
    let mut child = place.start("reproduce --quick --only F2");
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut said = String::new();
    // The first line of progress: it works.
    while !said.contains("study 1 of") {
        assert!(errors.read_line(&mut said).unwrap() > 0, "{said}");
    }
    crate::send("TERM", &child);
    errors.read_to_string(&mut said).unwrap();
    let output = child.wait_with_output().unwrap();
    let outcome = Outcome {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: said,
    };
    outcome
        .expect_code(143)
        .says(&["stopped, every run is saved"])
        .shows(&["report: reproduction/report.html"]);
    assert_eq!(claims(&place.path("reproduction")).len(), 1);
}
