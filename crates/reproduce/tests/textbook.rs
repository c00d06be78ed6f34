//! The cases that take seconds, their verdicts, and that a wrong number would not pass.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use std::fs;

use peristalsis_reproduce::textbook::{CASES, Case, Circumstances, Validation, chosen};
use peristalsis_reproduce::{Check, Convergence, Finding, Prose, ReproduceError, Size};

/// Cases of a few seconds in all; the others are for `peristalsis validate`.
const FAST: [&str; 9] = [
    "normal-impact",
    "restitution",
    "viscoelastic",
    "spin",
    "slip-to-roll",
    "gravity",
    "rolling",
    "cohesion",
    "chain",
];

fn named(names: &[&str]) -> Vec<Case> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    chosen(CASES, &names).unwrap()
}

fn run(cases: &[Case]) -> Validation {
    Validation::run(Size::Quick, cases, &|| false, &mut |_| ()).unwrap()
}

/// Whether a check would still pass if its expected value were wrong by three tolerances.
fn is_blind(check: &Check) -> bool {
    let difference = (check.found - check.expected).abs();
    let is_relative = check.expected != 0.0
        && (difference / check.expected.abs() - check.deviation).abs() < 1e-12;
    let wrong = if is_relative {
        Check::relative
    } else {
        Check::absolute
    };
    let scale = if is_relative { check.expected } else { 1.0 };
    let expected = check.expected + 3.0 * check.tolerance * scale;
    wrong("", "", expected, check.found, check.tolerance).passed
}

#[test]
fn the_engine_agrees_with_the_textbook() {
    let validation = run(&named(&FAST));
    for examination in &validation.examinations {
        let name = examination.experiment.name;
        let finding = &examination.finding;
        assert_eq!(examination.failure, None, "{name}");
        for check in &finding.checks {
            assert!(check.passed && !is_blind(check), "{name}: {check:#?}");
            // Tolerances are narrow enough to mean something.
            assert!(check.tolerance < 0.1, "{name}: {check:#?}");
        }
        for convergence in &finding.convergences {
            assert!(convergence.passed, "{name}: {convergence:#?}");
        }
        assert!(examination.passed(), "{name}");
        assert!(finding.data.is_some() && !finding.figures.is_empty());
    }
    assert!(validation.passed());
}

const fn case(
    name: &'static str,
    examine: fn(Circumstances<'_>) -> Result<Finding, ReproduceError>,
) -> Case {
    Case {
        name,
        prose: Prose::new("# A made-up case\n\nSource: nobody\n"),
        examine,
    }
}

/// Cases that pass, fail and panic.
const MADE_UP: [Case; 3] = [
    case("right", |_| {
        Ok(Finding {
            checks: vec![Check::relative("right", "here", 1.0, 1.0, 1e-9).by("a reference")],
            ..Finding::default()
        })
    }),
    case("wrong", |_| {
        let (steps, errors) = ([0.1, 0.05], [0.1, 0.09]);
        let order = Convergence::new("error", "setting", "t_c", &steps, &errors, [1.8, 2.2]);
        Ok(Finding {
            checks: vec![
                Check::relative("right", "", 1.0, 1.0, 1e-9),
                Check::relative("wrong", "", 1.0, 1.1, 1e-2).by("a wrong reference"),
            ],
            convergences: vec![order],
            ..Finding::default()
        })
    }),
    case("panics", |_| panic!("on purpose")),
];

#[test]
fn a_wrong_number_and_a_panic_fail_their_own_case_only() {
    let nothing = case("checks nothing", |_| Ok(Finding::default()));
    let validation = run(&[&MADE_UP[..], &[nothing]].concat());
    let passed: Vec<bool> = validation.examinations.iter().map(|e| e.passed()).collect();
    assert_eq!(passed, [true, false, false, false]);
    assert!(!validation.passed());
    let json = validation.json();
    assert!(json.contains("\"passed\": false") && json.contains("a wrong reference"));
    assert!(validation.examinations[2].failure.is_some());
}

#[test]
fn a_request_to_stop_is_heard() {
    let stopped = Validation::run(Size::Full, &named(&["chain"]), &|| true, &mut |_| ());
    assert!(matches!(stopped, Err(ReproduceError::Stopped)));
}

#[test]
fn an_unknown_case_is_named_with_those_that_exist() {
    match chosen(CASES, &["hertz".to_owned()]) {
        Err(ReproduceError::NoSuchExperiment { asked, known, .. }) => {
            assert_eq!((&*asked, known.len()), ("hertz", CASES.len()));
        }
        other => panic!("{:?}", other.map(|cases| cases.len())),
    }
}

#[test]
fn results_are_written_into_their_places_and_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("verification.md");
    let read = || fs::read_to_string(&path).unwrap();
    let text = "before\n<!-- validate summary -->\n<!-- /validate -->\n<!-- validate right -->\nold\n<!-- /validate -->\nafter\n";
    fs::write(&path, text).unwrap();
    let validation = run(&MADE_UP[..1]);
    validation.write_into(&path, &MADE_UP[..1]).unwrap();
    let found = read();
    for part in [
        "before\n<!-- validate summary -->\n| case | checks | largest deviation over what is allowed | orders | |\n|---|---|---|---|---|\n",
        "| right | 1 | 0.00 | – | passed |\n<!-- /validate -->\n",
        "| right | here | a reference | 1.00000 | 1.00000 | 0 | 1.0e-9 | passed |\n<!-- /validate -->\nafter\n",
    ] {
        assert!(found.contains(part), "{found}");
    }
    assert!(!found.contains("old"));
    // Again: the same bytes.
    validation.write_into(&path, &MADE_UP[..1]).unwrap();
    assert_eq!(read(), found);

    match run(&MADE_UP).write_into(&path, &MADE_UP) {
        Err(ReproduceError::NoPlace { block, line, .. }) => {
            assert_eq!((&*block, &*line), ("wrong", "<!-- validate wrong -->"));
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(read(), found, "nothing is changed");
    assert!(Validation::check_places(&path, &MADE_UP).is_err());
    assert!(Validation::check_places(&path, &MADE_UP[..1]).is_ok());
}

#[test]
fn a_folder_holds_everything() {
    let folder = tempfile::tempdir().unwrap();
    run(&named(&["slip-to-roll"])).write(folder.path()).unwrap();
    for file in [
        "validation.json",
        "slip-to-roll.md",
        "slip-to-roll.csv",
        "figures/slip-to-roll.svg",
        "figures/slip-to-roll.png",
    ] {
        let length = fs::metadata(folder.path().join(file)).unwrap().len();
        assert!(length > 500, "{file}: {length} bytes");
    }
}
