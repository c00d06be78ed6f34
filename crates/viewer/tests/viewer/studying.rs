//! Studies and their runs, as a page asks for them.

use std::path::PathBuf;
use std::time::Duration;

use peristalsis_formats::{Table, Values};
use peristalsis_study::{Effort, Ending, Specification, Store, work_on};
use peristalsis_viewer::{Figure, Study, Viewer, ViewerError};
use serde_json::Value;

use crate::client::Served;

/// Eight runs of some hundredths of a second each.
const SMALL: &str = r#"
name = "small-study"
title = "A *small* study"
preset = "frictionless"
states = ["rest", "jammed"]
replicates = 2

[base]
grains.number = 20
tube.waves = 2
drive.strain_rate = 0.1
run.periods = 4

[[axes]]
key = "drive.width"
values = [2.5, 2.8]
"#;

struct Place {
    folder: tempfile::TempDir,
    design: Specification,
}

impl Place {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            design: Specification::alone("study.toml", SMALL).unwrap(),
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("store")
    }

    fn store(&self) -> Store {
        Store::create(&self.path(), &self.design).unwrap()
    }

    fn complete(&self) {
        let effort = Effort {
            workers: 1,
            checkpoint_interval: Duration::from_secs(60),
            limit: None,
        };
        let ending = work_on(&self.store(), &self.design, effort, &|| false, &mut |_| {});
        assert_eq!(ending.unwrap(), Ending::Complete);
    }

    fn serve(self, studies: Vec<Study>, figures: Vec<Figure>) -> Served {
        let saves = self.folder.path().join("saves");
        let viewer = Viewer::exhibit(studies, figures, saves, 0).unwrap();
        Served::serve(viewer, self.folder)
    }
}

/// Status and body of an answer.
fn ask(served: &Served, path: &str, lines: &[&str]) -> (String, String) {
    let host = served.host();
    let lines: Vec<&str> = [host.as_str()]
        .into_iter()
        .chain(lines.iter().copied())
        .collect();
    let answer = served.get(&format!("{}{path}", served.base), &lines);
    let (head, body) = answer.split_once("\r\n\r\n").unwrap();
    let status = head.split(' ').nth(1).unwrap().to_owned();
    (status, body.to_owned())
}

fn json(served: &Served, path: &str) -> Value {
    let (status, body) = ask(served, path, &[]);
    assert_eq!(status, "200", "{path}: {body}");
    serde_json::from_str(&body).unwrap()
}

/// The values of a column.
fn column(study: &Value, name: &str) -> Vec<Value> {
    let columns = study["columns"].as_array().unwrap();
    let found = columns.iter().find(|column| column["name"] == name);
    let found = found.unwrap_or_else(|| panic!("there is no column {name}"));
    found["values"].as_array().unwrap().clone()
}

#[test]
fn a_study_is_shown_with_the_rows_of_its_runs() {
    let place = Place::new();
    place.complete();
    let rows = place.store().rows().unwrap();
    let study = Study::of_store(&place.path()).unwrap();
    let served = place.serve(vec![study], Vec::new());

    let list = json(&served, "list");
    assert_eq!(list["studies"][0]["title"], "A *small* study");
    assert_eq!(list["studies"][0]["rows"], 8);
    let study = json(&served, "study/0");
    assert_eq!(study["counts"]["done"], 8);
    assert_eq!(study["growing"], false);
    for name in ["drive.width", "flow_rate_ratio", "granular_temperature"] {
        let shown: Vec<f64> = column(&study, name)
            .iter()
            .map(|it| it.as_f64().unwrap())
            .collect();
        // Numbers in JSON may be read back one last digit away.
        for (shown, row) in shown.iter().zip(rows.reals(name).unwrap()) {
            assert!(
                (shown - row).abs() <= 1e-14 * row.abs(),
                "{name}: {shown}, {row}"
            );
        }
    }
    let starts = column(&study, "initial_state");
    assert_eq!(starts.iter().filter(|it| **it == "rest").count(), 4);
    // Every row has its run, and no two the same.
    let mut runs: Vec<u64> = study["runs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it.as_u64().unwrap())
        .collect();
    runs.sort_unstable();
    assert_eq!(runs, [0, 1, 2, 3, 4, 5, 6, 7]);
    // What a client has need not be sent again.
    let version = study["version"].as_u64().unwrap();
    let known = format!("If-None-Match: \"{version}\"");
    assert_eq!(ask(&served, "study/0", &[&known]).0, "304");
    let other = format!("If-None-Match: \"{}\"", version + 1);
    assert_eq!(ask(&served, "study/0", &[&other]).0, "200");
}

#[test]
fn a_run_of_a_study_is_watched_from_its_own_configuration() {
    let place = Place::new();
    place.complete();
    let rows = place.store().rows().unwrap();
    let study = Study::of_store(&place.path()).unwrap();
    let served = place.serve(vec![study], Vec::new());
    let shown = json(&served, "study/0");
    let jammed = column(&shown, "initial_state")
        .iter()
        .position(|it| *it == "jammed")
        .unwrap();
    let run = shown["runs"][jammed].as_u64().unwrap();
    let page = format!("study/0/run/{run}/");
    let (status, body) = ask(&served, &page, &[]);
    assert_eq!(status, "200");
    assert!(body.contains("viewer.js") && body.contains("id=\"stage\""));
    assert_eq!(ask(&served, &format!("{page}viewer.js"), &[]).0, "200");

    let mut client = served
        .upgrade(&format!("{}{page}live", served.base), None)
        .unwrap();
    let welcome = client.notice();
    assert_eq!(welcome["type"], "welcome", "{welcome}");
    assert_eq!(welcome["grains"], 20);
    let width = rows.reals("drive.width").unwrap()[jammed];
    assert_eq!(welcome["driven"]["width"].as_f64(), Some(width));
    assert_eq!(welcome["title"], format!("width {width}, from jammed"));
    // The course that it took when it was computed for the study, and the way back.
    assert!(
        welcome["record"].as_array().unwrap().len() > 10,
        "{}",
        welcome["record"]
    );
    assert_eq!(welcome["within"]["number"], run);
    assert_eq!(welcome["within"]["siblings"].as_array().unwrap().len(), 2);
    // Computed again it takes the same course.
    client.send(r#"{"type":"seek","period":2.0}"#);
    let frame = client.frame_with(|head| head["clock"].as_f64().unwrap() >= 2.0);
    let rows = frame.head["rows"].as_array().unwrap();
    let row = rows.last().unwrap();
    assert!(rows.len() > 10);
    let recorded = &welcome["record"][row["number"].as_u64().unwrap() as usize];
    assert_eq!(recorded[1], row["flow_rate_ratio"]);
    // A state that is saved is named after the study, but stays where states are saved.
    client.send(r#"{"type":"save"}"#);
    let saved = client.notice();
    let folder = PathBuf::from(saved["folder"].as_str().unwrap());
    assert_eq!(folder.parent(), Some(served.saves.as_path()), "{saved}");
    let name = folder.file_name().unwrap().to_str().unwrap();
    assert!(name.starts_with("small-study-"), "{name}");
}

#[test]
fn what_is_not_there_cannot_be_named() {
    let place = Place::new();
    let study = Study::of_store(place.store().path()).unwrap();
    let served = place.serve(vec![study], Vec::new());
    // Nothing is computed yet, but what is planned can be watched.
    assert_eq!(json(&served, "study/0")["growing"], true);
    assert_eq!(ask(&served, "study/0/run/7/", &[]).0, "200");
    for path in [
        "study/1",
        "study/-1",
        "study/0/",
        "study/x",
        "study/0/run/8/",
        "study/1/run/0/",
        "study/0/run/0/study.toml",
        "study/0/run/..%2f..%2fstudy.toml/",
        "study/0/run/0/..%2f..%2fconfig.toml",
        "study/18446744073709551616",
        "figure/0",
        "live",
        "store/study.toml",
    ] {
        let (status, body) = ask(&served, path, &[]);
        assert!(status == "404" || status == "400", "{path}: {status}");
        assert!(
            !body.contains("preset") && !body.contains("/tmp"),
            "{path}: {body}"
        );
    }
    for path in ["study/0/run/8/live", "study/3/run/0/live", "live"] {
        let refused = served
            .upgrade(&format!("{}{path}", served.base), None)
            .err();
        assert_eq!(refused, Some(404), "{path}");
    }
    let other = served.base.replace(|it: char| it.is_ascii_digit(), "f");
    for path in ["list", "study/0", "study/0/run/0/"] {
        let answer = served.get(&format!("{other}{path}"), &[&served.host()]);
        assert!(answer.starts_with("HTTP/1.1 404"), "{path}");
    }
    let refused = served.upgrade(
        &format!("{}study/0/run/0/live", served.base),
        Some("http://evil.example"),
    );
    assert_eq!(refused.err(), Some(403));
}

#[test]
fn new_rows_are_seen_and_runs_keep_their_numbers() {
    let place = Place::new();
    let study = Study::of_store(place.store().path()).unwrap();
    assert_eq!(study.rows(), 0);
    place.complete();
    let served = place.serve(vec![study], Vec::new());
    let begin = std::time::Instant::now();
    let shown = loop {
        let shown = json(&served, "study/0");
        if shown["counts"]["done"] == 8 || begin.elapsed() > Duration::from_secs(30) {
            break shown;
        }
        std::thread::sleep(Duration::from_millis(200));
    };
    assert_eq!(shown["version"], 2);
    assert_eq!(column(&shown, "drive.width").len(), 8);
    assert_eq!(shown["growing"], false);
}

#[test]
fn few_runs_stay_open_and_those_that_are_watched_do() {
    let place = Place::new();
    let study = Study::of_store(place.store().path()).unwrap();
    let served = place.serve(vec![study], Vec::new());
    let enter =
        |run: usize| served.upgrade(&format!("{}study/0/run/{run}/live", served.base), None);
    let mut open: Vec<_> = (0..4)
        .map(|run| {
            let mut client = enter(run).unwrap();
            assert_eq!(client.notice()["type"], "welcome");
            client
        })
        .collect();
    assert_eq!(enter(5).err(), Some(503));
    // A run that is watched is shared.
    assert_eq!(enter(0).unwrap().notice()["within"]["number"], 0);
    open.remove(1);
    let begin = std::time::Instant::now();
    while enter(5).is_err() {
        assert!(
            begin.elapsed() < Duration::from_secs(30),
            "no run was closed"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn rows_alone_are_shown_and_with_their_design_their_runs_are_watched() {
    let place = Place::new();
    place.complete();
    let rows = place.store().rows().unwrap();
    let alone = Study::of_table("rows", rows.clone(), None).unwrap();
    assert_eq!(
        (alone.name(), alone.rows(), alone.watchable()),
        ("small-study", 8, 0)
    );
    let designed = Study::of_table("rows", rows.clone(), Some(&place.design)).unwrap();
    assert_eq!(designed.watchable(), 8);
    // Of a design with more replicates than the table, nobody has computed the others.
    let more = SMALL.replace("replicates = 2", "replicates = 5");
    let more = Specification::alone("study.toml", &more).unwrap();
    let partly = Study::of_table("rows", rows, Some(&more)).unwrap();
    let served = place.serve(vec![alone, designed, partly], Vec::new());
    let page = format!("{}study/2/run/0/live", served.base);
    let welcome = served.upgrade(&page, None).unwrap().notice();
    assert_eq!(welcome["within"]["siblings"].as_array().unwrap().len(), 2);
    assert_eq!(json(&served, "study/0")["runs"][0], Value::Null);
    assert_eq!(ask(&served, "study/0/run/0/", &[]).0, "404");
    assert_eq!(ask(&served, "study/1/run/0/", &[]).0, "200");

    let other = Table::builder().column("identity", "", "", Values::Text(vec!["x".to_owned()]));
    let error = Study::of_table("rows", other.build().unwrap(), None).unwrap_err();
    assert!(matches!(error, ViewerError::NotRows { .. }), "{error}");
}

#[test]
fn figures_are_those_that_the_report_names_in_its_folder() {
    let place = Place::new();
    let folder = place.folder.path().to_owned();
    assert_eq!(Figure::of_report(&folder).unwrap().len(), 0);
    std::fs::create_dir(folder.join("figures")).unwrap();
    std::fs::write(folder.join("figures/one.svg"), "<svg/>").unwrap();
    std::fs::write(folder.join("secret.svg"), "secret").unwrap();
    let claims = r#"{"claims":[{"id":"F2","title":"*τ* diverges","verdict":"differs","studies":[{"name":"small"}],
        "figures":[{"file":"figures/one.svg","caption":"One"},{"file":"../secret.svg","caption":"Two"}]}]}"#;
    std::fs::write(folder.join("claims.json"), claims).unwrap();
    let figures = Figure::of_report(&folder).unwrap();
    let served = place.serve(Vec::new(), figures);
    let list = json(&served, "list");
    assert_eq!(list["figures"][0]["claim"], "F2");
    assert_eq!(list["figures"][0]["studies"][0], "small");
    assert!(list["figures"][0].get("path").is_none(), "{list}");
    assert_eq!(
        ask(&served, "figure/0", &[]),
        ("200".to_owned(), "<svg/>".to_owned())
    );
    assert_eq!(ask(&served, "figure/1", &[]).0, "404");

    std::fs::write(folder.join("claims.json"), "{").unwrap();
    let error = Figure::of_report(&folder).unwrap_err();
    assert!(matches!(error, ViewerError::Claims { .. }), "{error}");
}
