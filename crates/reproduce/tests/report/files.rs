//! What is written into a folder.

use std::fs;
use std::path::Path;

use peristalsis_reproduce::ReproduceError;

use crate::{hostile, specimen};

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn page_json_figures_and_tables_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/report");
    let report = specimen().unwrap();
    assert_eq!(report.write(&out).unwrap(), out.join("report.html"));
    assert_eq!(
        names(&out),
        [
            "claims.json",
            "figures",
            "report.html",
            "report.md",
            "tables"
        ]
    );
    assert_eq!(
        names(&out.join("figures")),
        [
            "transition-times-long.png",
            "transition-times-long.svg",
            "transition-times.png",
            "transition-times.svg",
            "two-kinds.png",
            "two-kinds.svg"
        ]
    );
    assert_eq!(names(&out.join("tables")), ["f2-1.csv", "quantities.csv"]);
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read("report.html"), report.html());
    assert_eq!(read("claims.json"), report.json());
    let table = read("tables/f2-1.csv");
    assert!(table.starts_with("\"w/d\",\"ε\u{307} = 0.05\","), "{table}");
    assert!(table.contains("\"2.850\",\"1210 ± 90\""), "{table}");
    let quantities = read("tables/quantities.csv");
    let slope = quantities.lines().last().unwrap();
    assert!(slope.starts_with("\"F7\",\"slope, fine lattice\","));
    assert!(slope.contains(",-3.75,-2.21,0.06,"), "{slope}");
    // A second time it is the same.
    report.write(&out).unwrap();
    assert_eq!(names(&out).len(), 5);
}

#[test]
fn figures_of_one_name_are_two_files_unless_they_are_one_figure() {
    let folder = tempfile::tempdir().unwrap();
    let mut report = specimen().unwrap();
    let mut second = report.examinations[1].finding.figures[0].clone();
    let same = second.clone();
    second.drawing = report.examinations[0].finding.figures[0].drawing.clone();
    report.examinations[2].finding.figures = vec![second, same];
    report.write(folder.path()).unwrap();
    let figures = names(&folder.path().join("figures"));
    assert_eq!(figures.len(), 2 * 4);
    assert!(figures.contains(&"transition-times-2.svg".to_owned()));
    let json: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
    let files = &json["claims"][2]["figures"];
    assert_eq!(files[0]["file"], "figures/transition-times-2.svg");
    assert_eq!(files[1]["file"], "figures/transition-times.svg");
}

#[test]
fn names_lead_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a/b/c");
    hostile().write(&out).unwrap();
    assert_eq!(names(folder.path()), ["a"]);
    assert_eq!(names(&folder.path().join("a/b")), ["c"]);
    assert_eq!(names(&out.join("figures")).len(), 6);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    match specimen().unwrap().write(&file.join("below")) {
        Err(ReproduceError::Folder { path, .. }) => assert_eq!(path, file.join("below")),
        other => panic!("{other:?}"),
    }
}
