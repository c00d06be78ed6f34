//! `peristalsis reproduce`: what it says, writes and takes over. That all studies come to their end is tested in `claims`.

use std::path::Path;

use serde_json::Value;

use crate::{Outcome, Place, read_json};

/// A claim, its studies, and how long to work on them: nothing ends in so short a time.
const BRIEFLY: &str = "reproduce --only F2 --for 1s";

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
            "1 claim, quick design (--full has enough runs for verdicts), in reproduction",
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
    let outcome = place.does(&format!("{BRIEFLY} --full --json --quiet"));
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
            "holds no rows of finished runs",
        ),
    ] {
        place.refuses(&format!("{BRIEFLY} --import {name}"), &[part]);
    }
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_made() {
    let place = Place::new();
    let before = place.inventory();
    place.refuses(
        "reproduce --only F2,F99",
        &["there is no claim \"F99\"", "claims: F1, F2,"],
    );
    place.refuses("reproduce --quick --full", &["cannot be used with"]);
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
    let mut child = place.start("reproduce --only F2");
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
