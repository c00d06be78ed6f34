//! The cases that take seconds, their verdicts, and that a wrong number would not pass.

use std::fs;

use peristalsis_reproduce::textbook::{
    CASES, Case, Check, Circumstances, Convergence, Extent, Finding, ValidateError, Validation,
    chosen,
};

/// Cases of a few seconds in all; the others are for `peristalsis validate`.
const FAST: [&str; 6] = [
    "normal-impact",
    "restitution",
    "viscoelastic",
    "spin",
    "slip-to-roll",
    "chain",
];

fn named(names: &[&str]) -> Vec<Case> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    chosen(CASES, &names).expect("they exist")
}

fn run(cases: &[Case]) -> Validation {
    Validation::run(Extent::Quick, cases, &|| false, &mut |_| ()).expect("nobody stops it")
}

#[test]
fn the_engine_agrees_with_the_textbook() {
    let validation = run(&named(&FAST));
    for examination in &validation.examinations {
        let name = examination.case.name;
        assert_eq!(examination.failure, None, "{name}");
        for check in &examination.finding.checks {
            assert!(check.passed, "{name}: {check:#?}");
            // A reference that is wrong by three tolerances is noticed.
            let is_relative = check.expected != 0.0
                && ((check.found - check.expected).abs() / check.expected.abs() - check.deviation)
                    .abs()
                    < 1e-12;
            let wrong = if is_relative {
                let expected = check.expected * (1.0 + 3.0 * check.tolerance);
                Check::relative("", "", expected, check.found, check.tolerance)
            } else {
                let expected = check.expected + 3.0 * check.tolerance;
                Check::absolute("", "", expected, check.found, check.tolerance)
            };
            assert!(!wrong.passed, "{name}: {wrong:#?}");
        }
        for convergence in &examination.finding.convergences {
            assert!(convergence.passed, "{name}: {convergence:#?}");
        }
        assert!(examination.passed(), "{name}");
        assert!(examination.finding.table.is_some() && !examination.finding.figures.is_empty());
        // Tolerances are narrow enough to mean something.
        let loosest = examination
            .finding
            .checks
            .iter()
            .map(|check| check.tolerance);
        assert!(loosest.fold(0.0, f64::max) < 0.1, "{name}");
    }
    assert!(validation.passed());
}

fn wrong(_: Circumstances<'_>) -> Result<Finding, ValidateError> {
    Ok(Finding {
        checks: vec![
            Check::relative("right", "", 1.0, 1.0, 1e-9),
            Check::relative("wrong", "", 1.0, 1.1, 1e-2).by("a wrong reference"),
        ],
        convergences: vec![Convergence::new(
            "error",
            "setting",
            "t_c",
            &[0.1, 0.05],
            &[0.1, 0.09],
            [1.8, 2.2],
        )],
        ..Finding::default()
    })
}

fn panics(_: Circumstances<'_>) -> Result<Finding, ValidateError> {
    panic!("on purpose")
}

fn right(_: Circumstances<'_>) -> Result<Finding, ValidateError> {
    Ok(Finding {
        checks: vec![Check::relative("right", "", 1.0, 1.0, 1e-9).by("a reference")],
        ..Finding::default()
    })
}

const MADE_UP: [Case; 3] = [
    Case {
        name: "right",
        title: "A case that passes",
        source: "nobody",
        examine: right,
    },
    Case {
        name: "wrong",
        title: "A case that fails",
        source: "nobody",
        examine: wrong,
    },
    Case {
        name: "panics",
        title: "A case that panics",
        source: "nobody",
        examine: panics,
    },
];

#[test]
fn a_wrong_number_and_a_panic_fail_their_own_case_only() {
    let validation = run(&MADE_UP);
    let passed: Vec<bool> = validation.examinations.iter().map(|e| e.passed()).collect();
    assert_eq!(passed, [true, false, false]);
    assert!(!validation.passed());
    let json = validation.json();
    assert!(json.contains("\"passed\": false") && json.contains("a wrong reference"));
    assert!(validation.examinations[2].failure.is_some());
}

#[test]
fn a_request_to_stop_is_heard() {
    let stopped = Validation::run(Extent::Full, &named(&["chain"]), &|| true, &mut |_| ());
    assert!(matches!(stopped, Err(ValidateError::Stopped)));
}

#[test]
fn an_unknown_case_is_named_with_those_that_exist() {
    match chosen(CASES, &["hertz".to_owned()]) {
        Err(ValidateError::NoSuchCase { asked, known }) => {
            assert_eq!(asked, "hertz");
            assert_eq!(known.len(), CASES.len());
        }
        other => panic!("{:?}", other.map(|cases| cases.len())),
    }
}

#[test]
fn results_are_written_into_their_places_and_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("VALIDATION.md");
    let text = "before\n<!-- validate summary -->\n<!-- /validate -->\n<!-- validate right -->\nold\n<!-- /validate -->\nafter\n";
    fs::write(&path, text).unwrap();
    let validation = run(&MADE_UP[..1]);
    validation.write_into(&path, &MADE_UP[..1]).unwrap();
    let found = fs::read_to_string(&path).unwrap();
    assert!(
        found.starts_with("before\n<!-- validate summary -->\n| case |"),
        "{found}"
    );
    assert!(found.ends_with("<!-- /validate -->\nafter\n") && !found.contains("old"));
    assert!(
        found.contains("| right |  | a reference | 1.00000 | 1.00000 | 0 | 1.0e-9 | passed |"),
        "{found}"
    );
    // Again: the same bytes.
    validation.write_into(&path, &MADE_UP[..1]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), found);

    let all = run(&MADE_UP);
    match all.write_into(&path, &MADE_UP) {
        Err(ValidateError::NoPlace { block, line, .. }) => {
            assert_eq!((&*block, &*line), ("wrong", "<!-- validate wrong -->"));
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        found,
        "nothing is changed"
    );
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
