//! From claims to findings, with studies of a few runs that take no time.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use peristalsis_reproduce::{
    Claim, Event, Evidence, Extent, Finding, ImportedRuns, Outcome, Prose, PublishedRows,
    ReproduceError, Reproduction, Sample, Size, Statistics, StudyFile, Verdict, chosen,
    published_in_words,
};
use peristalsis_study::{Effort, Ending, Store};

/// A study of two widths and `replicates` runs of each.
macro_rules! study {
    ($name:literal, $replicates:literal, $periods:literal) => {
        concat!(
            "name = \"",
            $name,
            "\"\npreset = \"frictionless\"\nreplicates = ",
            $replicates,
            "\n[base]\ngrains.number = 20\ntube.waves = 2\ndrive.strain_rate = 0.1\nrun.periods = ",
            $periods,
            "\n[[axes]]\nkey = \"drive.width\"\nvalues = [2.4, 2.9]\n"
        )
    };
}

const STUDIES: [StudyFile; 2] = [
    StudyFile::new(
        "long",
        "studies/long.toml",
        study!("long", 3, 40),
        "[long]\nreplicates = 1",
    ),
    StudyFile::new(
        "short",
        "studies/short.toml",
        study!("short", 2, 4),
        "[short]\nreplicates = 1",
    ),
];

fn count(evidence: &Evidence, study: &str) -> Result<Finding, ReproduceError> {
    let results = evidence.study(study)?;
    let statistics = Statistics {
        strain_rates: 4,
        widths: 8,
        replicates: results.rows().len(),
        runs: results.rows().len(),
    };
    Ok(Finding {
        verdict: Verdict::Reproduced,
        summary: format!("{} runs", results.rows().len()),
        statistics,
        ..Finding::default()
    })
}

const fn claim(
    id: &'static str,
    studies: &'static [&'static str],
    examine: fn(&Evidence) -> Result<Finding, ReproduceError>,
) -> Claim {
    Claim::new(id, Prose::new("# tested\n"), studies, examine).varying(
        "width",
        Statistics {
            replicates: 2,
            ..Statistics::FOR_A_VERDICT
        },
    )
}

const CLAIMS: [Claim; 4] = [
    claim("F1", &["long"], |evidence| count(evidence, "long")),
    claim("F2", &["short"], |evidence| count(evidence, "short")),
    claim("F3", &["short"], |_| {
        Err(ReproduceError::NoSuchStudy("elsewhere".to_owned()))
    }),
    claim("F4", &["short"], |evidence| {
        // A bug of an analysis.
        let rows = evidence.study("short")?.rows();
        count(evidence, rows[rows.len()].identity())
    }),
];

const EFFORT: Effort = Effort {
    workers: 2,
    checkpoint_interval: Duration::from_secs(60),
    limit: None,
};

fn prepared(folder: &Path, size: Size) -> Reproduction {
    Reproduction::prepare(folder, size, &CLAIMS, &STUDIES).unwrap()
}

/// Runs to the end, and answers the names of the claims in the order in which they were examined.
fn run(reproduction: &Reproduction) -> (Outcome, Vec<&'static str>) {
    let mut examined = Vec::new();
    let outcome = reproduction.run(EFFORT, &|| false, &mut |event| {
        if let Event::Examined(examination) = event {
            examined.push(examination.experiment.id);
        }
    });
    (outcome, examined)
}

fn summaries(outcome: &Outcome) -> Vec<&str> {
    outcome
        .examinations
        .iter()
        .map(|examination| &*examination.finding.summary)
        .collect()
}

#[test]
fn claims_are_examined_as_their_studies_end_and_one_that_fails_loses_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let (outcome, mut examined) = run(&prepared(folder.path(), Size::Full));
    assert_eq!(outcome.ending, Ending::Complete);
    // The short study comes first, though its claims come later. They are examined side by side.
    examined[..3].sort_unstable();
    assert_eq!(examined, ["F2", "F3", "F4", "F1"]);
    let ids: Vec<&str> = outcome
        .examinations
        .iter()
        .map(|examination| examination.experiment.id)
        .collect();
    assert_eq!(ids, ["F1", "F2", "F3", "F4"]);
    assert_eq!(summaries(&outcome)[..2], ["6 runs", "4 runs"]);
    assert_eq!(outcome.examinations[0].finding.verdict, Verdict::Reproduced);
    let failures: Vec<Option<&str>> = outcome
        .examinations
        .iter()
        .map(|examination| examination.failure.as_deref())
        .collect();
    assert_eq!(failures[..2], [None, None]);
    assert!(failures[2].unwrap().contains("elsewhere"));
    assert!(failures[3].unwrap().contains("panicked"));
    for failed in &outcome.examinations[2..] {
        assert_eq!(failed.finding.verdict, Verdict::Open);
        assert!(!failed.is_sufficient());
    }
    let counts: Vec<(usize, usize, usize)> = outcome
        .studies
        .iter()
        .map(|study| (study.runs, study.done, study.missing()))
        .collect();
    assert_eq!(counts, [(6, 6, 0), (4, 4, 0)]);
}

#[test]
fn sizes_share_their_runs_and_a_stop_keeps_what_is_finished() {
    let folder = tempfile::tempdir().unwrap();
    let (quick, _) = run(&prepared(folder.path(), Size::Quick));
    assert_eq!(quick.studies[0].done, 2);
    // Stopped before anything begins: the runs of the quick design are there already.
    let full = prepared(folder.path(), Size::Full);
    let stopped = full.run(EFFORT, &|| true, &mut |_| {});
    assert_eq!(stopped.ending, Ending::Stopped);
    assert_eq!(summaries(&stopped)[..2], ["2 runs", "2 runs"]);
    // No time at all.
    let effort = Effort {
        limit: Some(Duration::ZERO),
        ..EFFORT
    };
    let late = full.run(effort, &|| false, &mut |_| {});
    assert_eq!(late.ending, Ending::TimeUp);
    // Stopped in the midst of it, and gone on with.
    let looks = Cell::new(0);
    let stop = || {
        looks.set(looks.get() + 1);
        looks.get() > 3
    };
    let ending = full.run(EFFORT, &stop, &mut |_| {}).ending;
    assert!(matches!(ending, Ending::Stopped | Ending::Complete));
    let (outcome, _) = run(&full);
    assert_eq!(outcome.ending, Ending::Complete);
    assert_eq!(summaries(&outcome)[0], "6 runs");
    // A request to stop has no effect where nothing is left to do.
    assert_eq!(
        full.run(EFFORT, &|| true, &mut |_| {}).ending,
        Ending::Complete
    );
}

#[test]
fn progress_covers_all_studies_and_never_goes_back() {
    let folder = tempfile::tempdir().unwrap();
    let reproduction = prepared(folder.path(), Size::Quick);
    let (mut fractions, mut places) = (Vec::new(), Vec::new());
    reproduction.run(EFFORT, &|| false, &mut |event| {
        if let Event::Progress(stage) = event {
            fractions.push(stage.fraction);
            places.push((stage.number, stage.study.to_owned()));
            assert_eq!(stage.of, 2);
        }
    });
    assert!(fractions.is_sorted(), "{fractions:?}");
    assert_eq!(fractions.last(), Some(&1.0));
    places.dedup();
    assert_eq!(places, [(1, "short".to_owned()), (2, "long".to_owned())]);
}

#[test]
fn runs_in_tables_need_not_be_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = folder.path().join("first");
    run(&prepared(&first, Size::Full));
    let tables = folder.path().join("tables");
    for name in ["long", "short"] {
        let store = Store::open(&first.join("stores").join(name)).unwrap();
        store.export(&tables, false).unwrap();
    }
    fs::write(tables.join("notes.txt"), "no table").unwrap();
    let second = prepared(&folder.path().join("second"), Size::Full);
    let import = second.import(std::slice::from_ref(&tables)).unwrap();
    let found = |study: &str, found, runs| ImportedRuns {
        study: study.to_owned(),
        found,
        runs,
    };
    assert_eq!(import.studies, [found("long", 6, 6), found("short", 4, 4)]);
    // What each run took is a table, but none of rows.
    assert_eq!(import.tables, 4);
    assert_eq!(import.skipped.len(), 2);
    // Nothing is left to compute.
    let outcome = second.run(EFFORT, &|| true, &mut |_| {});
    assert_eq!(outcome.ending, Ending::Complete);
    assert_eq!(summaries(&outcome)[0], "6 runs");
    // Again, by name and into the other size: what it asks for is there.
    let quick = prepared(&folder.path().join("second"), Size::Quick);
    let import = quick.import(&[tables.join("long.csv")]).unwrap();
    assert_eq!(import.studies, [found("long", 2, 2), found("short", 0, 2)]);
    // A file that was named must be a table of runs.
    for name in ["long-timing.csv", "notes.txt", "none.csv"] {
        assert!(quick.import(&[tables.join(name)]).is_err(), "{name}");
    }
}

#[test]
fn imported_rows_count_and_products_that_claims_need_are_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let (first, tables) = (folder.path().join("first"), folder.path().join("tables"));
    run(&prepared(&first, Size::Full));
    let store = Store::open(&first.join("stores/short")).unwrap();
    store.export(&tables, false).unwrap();
    // Runs of two widths that have a time series in the end.
    for (study, expected) in [(STUDIES[1], 0), (STUDIES[1].needing_products(), 2)] {
        let with_series = |evidence: &Evidence| {
            let results = evidence.study("short")?;
            let mut number = 0;
            for row in results.rows() {
                number += usize::from(results.series(&row)?.is_some());
            }
            let mut finding = count(evidence, "short")?;
            finding.summary = format!("{number} of {}", results.rows().len());
            Ok(finding)
        };
        let claims = [claim("F2", &["short"], with_series)];
        let second = folder.path().join(expected.to_string());
        let prepared = Reproduction::prepare(&second, Size::Full, &claims, &[study]).unwrap();
        let import = prepared.import(std::slice::from_ref(&tables)).unwrap();
        assert_eq!(import.studies[0].found, 4);
        // A folder that an interrupted run left before its row was imported holds no products.
        let store = Store::open(&second.join("stores/short")).unwrap();
        for run in store.survey().unwrap().plan.runs() {
            fs::create_dir_all(store.run_folder(run.identity)).unwrap();
        }
        // Without any time the rows are enough for what needs no more.
        let stopped = prepared.run(EFFORT, &|| true, &mut |_| {});
        assert_eq!(summaries(&stopped), ["0 of 4"]);
        let mut fractions = Vec::new();
        let outcome = prepared.run(EFFORT, &|| false, &mut |event| {
            if let Event::Progress(stage) = event {
                fractions.push(stage.fraction);
            }
        });
        assert_eq!(outcome.ending, Ending::Complete);
        assert_eq!(summaries(&outcome), [format!("{expected} of 4")]);
        assert_eq!(outcome.studies[0].done, 4);
        assert!(fractions.is_sorted(), "{fractions:?}");
    }
}

/// Computes both studies in a folder and answers the folder of their tables.
fn tables_of_all(folder: &Path) -> PathBuf {
    let (first, tables) = (folder.join("first"), folder.join("tables"));
    run(&prepared(&first, Size::Full));
    for name in ["long", "short"] {
        let store = Store::open(&first.join("stores").join(name)).unwrap();
        store.export(&tables, false).unwrap();
        fs::remove_file(tables.join(format!("{name}.parquet"))).unwrap();
    }
    tables
}

fn sampled(reproduction: &Reproduction, extent: Extent, seed: u64) -> Vec<PublishedRows> {
    let sample = Sample { extent, seed };
    let mut fractions = Vec::new();
    let drawn = reproduction.sample(sample, EFFORT, &|| false, &mut |sampling| {
        fractions.push(sampling.board.fraction);
    });
    let drawn = drawn.unwrap();
    assert_eq!(drawn.ending, Ending::Complete);
    assert_eq!(drawn.within_reach, [("long", 6), ("short", 4)]);
    assert!(fractions.is_sorted(), "{fractions:?}");
    let outcome = reproduction.examine(&mut |_| {});
    assert_eq!(summaries(&outcome)[0], "6 runs");
    outcome.published
}

fn counts(published: &[PublishedRows]) -> Vec<[usize; 3]> {
    let counts = |it: &PublishedRows| [it.rows, it.checked, it.differing.len()];
    published.iter().map(counts).collect()
}

#[test]
fn published_rows_that_are_drawn_come_out_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let tables = tables_of_all(folder.path());
    let second = prepared(&folder.path().join("second"), Size::Full);
    assert!(!second.has_published_rows());
    second.import(std::slice::from_ref(&tables)).unwrap();
    assert!(second.has_published_rows());
    // Asked to stop at once, nothing is computed.
    let extent = Extent::Part(0.5);
    let stopped = second.sample(Sample { extent, seed: 7 }, EFFORT, &|| true, &mut |_| {});
    assert_eq!(stopped.unwrap().ending, Ending::Stopped);
    // Half of each, and with the same seed the same half, which is there already.
    for _ in 0..2 {
        assert_eq!(counts(&sampled(&second, extent, 7)), [[6, 3, 0], [4, 2, 0]]);
    }
    let other = prepared(&folder.path().join("third"), Size::Full);
    other.import(std::slice::from_ref(&tables)).unwrap();
    sampled(&other, extent, 7);
    let drawn = |name: &str| {
        let runs = folder.path().join(name).join("again/long/runs");
        let runs = fs::read_dir(runs).unwrap();
        let mut runs: Vec<_> = runs.map(|run| run.unwrap().file_name()).collect();
        runs.sort();
        runs
    };
    assert_eq!(drawn("second"), drawn("third"));
    // A time that is enough for all.
    let time = Extent::Time(Duration::from_secs(600));
    let published = sampled(&second, time, 8);
    assert_eq!(counts(&published), [[6, 6, 0], [4, 4, 0]]);
    let words = published_in_words(&published, None).unwrap();
    assert_eq!(
        words,
        "Of 10 published rows 10, from 2 of 2 studies, were computed again: all came out the same to the bit."
    );
}

#[test]
fn a_published_row_that_was_changed_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let tables = tables_of_all(folder.path());
    let path = tables.join("short.csv");
    let text = fs::read_to_string(&path).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut names = lines[0].split(',');
    let place = names.position(|name| name == "flow_rate_ratio").unwrap();
    let last = lines.last_mut().unwrap();
    let mut cells: Vec<&str> = last.split(',').collect();
    let true_value = cells[place].to_owned();
    cells[place] = "0.25";
    let identity = cells[1].trim_matches('"').to_owned();
    *last = cells.join(",");
    fs::write(&path, lines.join("\n") + "\n").unwrap();
    let second = prepared(&folder.path().join("second"), Size::Full);
    second.import(std::slice::from_ref(&tables)).unwrap();
    let published = sampled(&second, Extent::Part(1.0), 1);
    assert_eq!(counts(&published), [[6, 6, 0], [4, 4, 1]]);
    let found = &published[1].differing[0];
    assert_eq!(found.identity.to_string(), identity);
    assert!(found.configuration.is_file());
    assert_eq!(found.columns.len(), 1);
    assert_eq!(found.columns[0].column, "flow_rate_ratio");
    assert_eq!(found.columns[0].values, ["0.25".to_owned(), true_value]);
}

#[test]
fn a_store_that_cannot_be_used_costs_only_its_claims() {
    let folder = tempfile::tempdir().unwrap();
    let stores = folder.path().join("stores");
    fs::create_dir_all(stores.join("short")).unwrap();
    fs::write(stores.join("short/other.txt"), "not a store").unwrap();
    let reproduction = prepared(folder.path(), Size::Quick);
    assert_eq!(reproduction.import(&[]).unwrap().studies.len(), 1);
    let mut troubles = Vec::new();
    let outcome = reproduction.run(EFFORT, &|| false, &mut |event| {
        if let Event::Trouble { study, .. } = event {
            troubles.push(study.to_owned());
        }
    });
    assert_eq!(outcome.ending, Ending::Complete);
    assert_eq!(troubles, ["short"]);
    assert_eq!(summaries(&outcome)[0], "2 runs");
    let failure = outcome.examinations[1].failure.as_deref().unwrap();
    assert!(
        failure.contains("study short") && failure.contains("it holds other files"),
        "{failure}"
    );
    assert!(outcome.studies[1].failure.is_some());
}

#[test]
fn claims_are_chosen_by_name() {
    let names = |names: &[&str]| -> Result<Vec<&str>, ReproduceError> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        Ok(chosen(&CLAIMS, &names)?
            .iter()
            .map(|claim| claim.id)
            .collect())
    };
    assert_eq!(names(&["f3", " F1"]).unwrap(), ["F1", "F3"]);
    assert_eq!(names(&[]).unwrap(), ["F1", "F2", "F3", "F4"]);
    match names(&["F1", "F10"]) {
        Err(ReproduceError::NoSuchExperiment { asked, known, .. }) => {
            assert_eq!(asked, "F10");
            assert_eq!(known, ["F1", "F2", "F3", "F4"]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_missing_is_said_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let out = file.join("out");
    match Reproduction::prepare(&out, Size::Quick, &CLAIMS, &STUDIES) {
        Err(ReproduceError::Folder { path, .. }) => assert_eq!(path, out),
        other => panic!("{other:?}"),
    }
    assert!(matches!(
        Reproduction::prepare(folder.path(), Size::Quick, &CLAIMS, &STUDIES[..1]),
        Err(ReproduceError::NoSuchStudy(name)) if name == "short"
    ));
}
