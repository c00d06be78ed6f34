//! What is wrong with a configuration is said with key, line and what is allowed.

mod keys;
mod values;

use peristalsis_configuration::{
    Configuration, ConfigurationError, Problem, ProblemKind, SourceFile, Sources,
};

/// A whole file without a preset; the lines are counted below.
const FILE: &str = r#"[grains]
volume_fraction = 0.15
[contact]
law = "linear"
[tube]
radius = 1.5
wavelength = 10.0
waves = 10
spheres_per_ring = 12
rings_per_wave = 14
[drive]
control = "strain"
width = 2.75
strain_rate = 0.05
[run]
periods = 40
"#;

fn read(text: &str, overrides: &[&str]) -> Result<Configuration, ConfigurationError> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let file = Some(SourceFile {
        name: "tube.toml",
        text,
    });
    Configuration::from_sources(&Sources {
        file,
        preset: None,
        overrides: &overrides,
    })
}

fn only_problem(result: Result<Configuration, ConfigurationError>) -> Problem {
    let error = result.expect_err("this configuration is wrong");
    assert_eq!(error.problems().len(), 1, "{error}");
    error.problems()[0].clone()
}

/// The one problem of the file after replacing a text in it.
fn problem_with(from: &str, to: &str) -> Problem {
    assert!(FILE.contains(from), "{from}");
    only_problem(read(&FILE.replacen(from, to, 1), &[]))
}

/// Key, line of the first label, and a part of the help.
fn expect(problem: &Problem, kind: ProblemKind, key: &str, line: usize, help: &str) {
    assert_eq!(problem.kind, kind, "{problem}");
    assert_eq!(problem.key.as_deref(), Some(key), "{problem}");
    assert_eq!(problem.labels[0].line_and_column().0, line, "{problem}");
    let text = problem.help.as_deref().unwrap_or_default();
    assert!(text.contains(help), "{help:?} is not in {text:?}");
}

#[test]
fn the_file_itself_is_right() {
    let configuration = read(FILE, &[]).unwrap();
    assert_eq!(configuration.grains.number, 203);
    assert_eq!(configuration.run.time_step, 0.05);
    assert_eq!(configuration.run.steps(), 16_000);
}

#[test]
fn a_display_is_complete_in_itself() {
    let problem = problem_with("width = 2.75", "width = 3.2");
    let text = problem.to_string();
    assert!(text.starts_with("tube.toml:13:9: drive.width = 3.2 is wider than the tube, 2 a = 3"));
    assert!(text.contains("tube.toml:6:10: tube.radius = 1.5"), "{text}");
    assert!(
        text.contains("help: 0 <= drive.width <= 2 tube.radius = 3"),
        "{text}"
    );
}

#[test]
fn independent_problems_come_in_one_go_in_the_order_of_the_text() {
    let text = FILE
        .replace("law = \"linear\"", "law = \"linera\"")
        .replace("radius = 1.5", "radius = -1.5")
        .replace("width = 2.75", "widht = 2.75");
    let error = read(&text, &["run.seed=-1"]).unwrap_err();
    let keys: Vec<&str> = error
        .problems()
        .iter()
        .filter_map(|problem| problem.key.as_deref())
        .collect();
    assert_eq!(
        keys,
        ["contact.law", "tube.radius", "drive.widht", "run.seed"]
    );
    assert_eq!(error.to_string().matches("help:").count(), 4);
    let text = FILE
        .replace("width = 2.75", "width = 4")
        .replace("= 14", "= 15");
    let error = read(&text, &[]).unwrap_err();
    assert_eq!(error.problems().len(), 2, "{error}");
}
