//! What is wrong with keys: unknown, of the wrong type, out of range, missing, excluding one another.

use peristalsis_configuration::{Configuration, ProblemKind, SourceFile, Sources};

use crate::{FILE, expect, only_problem, problem_with, read};

#[test]
fn unknown_keys_suggest_the_nearest() {
    let problem = problem_with("width = 2.75", "widht = 2.75\nwidth = 2.75");
    expect(
        &problem,
        ProblemKind::UnknownKey,
        "drive.widht",
        13,
        "did you mean drive.width?",
    );
    let problem = problem_with("[grains]", "width = 2.75\n[grains]");
    expect(
        &problem,
        ProblemKind::UnknownKey,
        "width",
        1,
        "did you mean drive.width?",
    );
    let problem = problem_with("[grains]", "[grain]\n[grains]");
    expect(
        &problem,
        ProblemKind::UnknownKey,
        "grain",
        1,
        "did you mean grains?",
    );
    let problem = problem_with("radius = 1.5", "radius = 1.5\ncolour = 1");
    expect(
        &problem,
        ProblemKind::UnknownKey,
        "tube.colour",
        7,
        "known here: radius",
    );
}

#[test]
fn two_alternatives_in_one_file_name_both_lines() {
    let cases = [
        (
            "volume_fraction = 0.15",
            "number = 200",
            "grains.volume_fraction",
            [2, 3],
        ),
        ("width = 2.75", "amplitude = 0.1", "drive.width", [13, 14]),
        (
            "strain_rate = 0.05",
            "wave_speed = 0.5",
            "drive.strain_rate",
            [14, 15],
        ),
        ("periods = 40", "duration = 800", "run.periods", [16, 17]),
    ];
    for (given, other, key, lines) in cases {
        let problem = problem_with(given, &format!("{given}\n{other}"));
        expect(
            &problem,
            ProblemKind::Conflict,
            key,
            lines[0],
            "keep one of",
        );
        assert_eq!(problem.labels[1].line_and_column().0, lines[1], "{problem}");
    }
}

#[test]
fn numbers_out_of_range_are_shown_with_their_line() {
    let cases = [
        (
            "radius = 1.5",
            "radius = 0",
            "tube.radius",
            6,
            "a number above 0",
        ),
        (
            "radius = 1.5",
            "radius = nan",
            "tube.radius",
            6,
            "a number above 0",
        ),
        (
            "wavelength = 10.0",
            "wavelength = 1e999",
            "tube.wavelength",
            7,
            "Unit: d",
        ),
        (
            "waves = 10",
            "waves = -3",
            "tube.waves",
            8,
            "a whole number, 1 or more",
        ),
        (
            "waves = 10",
            "waves = 99999999",
            "tube.waves",
            8,
            "at most 1e6",
        ),
    ];
    for (from, to, key, line, help) in cases {
        expect(
            &problem_with(from, to),
            ProblemKind::OutOfRange,
            key,
            line,
            help,
        );
    }
}

#[test]
fn wrong_types_and_names() {
    let cases = [
        (
            "radius = 1.5",
            "radius = \"wide\"",
            "tube.radius",
            6,
            "allowed: a number",
        ),
        (
            "waves = 10",
            "waves = 2.5",
            "tube.waves",
            8,
            "allowed: a whole number",
        ),
        (
            "waves = 10",
            "waves = 99999999999999999999",
            "tube.waves",
            8,
            "a whole number",
        ),
        (
            "law = \"linear\"",
            "law = \"linera\"",
            "contact.law",
            4,
            "did you mean \"linear\"?",
        ),
        (
            "law = \"linear\"",
            "law = 3",
            "contact.law",
            4,
            "\"linear\", \"hertz\"",
        ),
        (
            "periods = 40",
            "periods = 1979-05-27",
            "run.periods",
            16,
            "a number",
        ),
        (
            "width = 2.75",
            "width = 2.75\nwaveform = \"square\"",
            "drive.waveform",
            14,
            "\"sine\"",
        ),
    ];
    for (from, to, key, line, help) in cases {
        expect(
            &problem_with(from, to),
            ProblemKind::WrongType,
            key,
            line,
            help,
        );
    }
    let problem = only_problem(read("preset = \"frictionless\"\ntube = 3\n", &[]));
    expect(
        &problem,
        ProblemKind::WrongType,
        "tube",
        2,
        "a table of radius",
    );
}

#[test]
fn a_text_that_is_not_toml() {
    let problem = problem_with("waves = 10", "waves = = 10");
    assert_eq!(problem.kind, ProblemKind::Syntax);
    assert_eq!(problem.labels[0].line_and_column().0, 8);
    let problem = problem_with("waves = 10", "waves = 10\nwaves = 11");
    assert_eq!(problem.kind, ProblemKind::Syntax, "{problem}");
    assert!(problem.message.contains("duplicate key"), "{problem}");
    assert_eq!(problem.labels[0].line_and_column().0, 9);
}

#[test]
fn missing_keys_are_all_named() {
    let problem = only_problem(read("[tube]\nradius = 1.5\n", &[]));
    assert_eq!(problem.kind, ProblemKind::Missing);
    for part in [
        "tube.toml",
        "tube.wavelength",
        "drive.control",
        "run.periods or run.duration",
    ] {
        assert!(problem.message.contains(part), "{problem}");
    }
    assert!(!problem.message.contains("tube.radius"), "{problem}");
    assert!(
        problem
            .help
            .unwrap_or_default()
            .contains("preset = \"frictionless\"")
    );
    let problem = problem_with("width = 2.75", "#");
    expect(
        &problem,
        ProblemKind::Missing,
        "drive.width",
        11,
        "Width of the bottleneck",
    );
    assert!(
        only_problem(Configuration::from_sources(&Sources::default()))
            .labels
            .is_empty()
    );
}

#[test]
fn keys_of_the_other_control_and_the_other_law() {
    let problem = problem_with("width = 2.75", "width = 2.75\nforce_amplitude = 0.004");
    let help = "remove drive.force_amplitude, or set drive.control = \"stress\"";
    expect(
        &problem,
        ProblemKind::Conflict,
        "drive.force_amplitude",
        14,
        help,
    );
    assert_eq!(problem.labels[1].line_and_column().0, 12);
    let problem = problem_with("law = \"linear\"", "law = \"linear\"\nyoung_modulus = 2");
    expect(
        &problem,
        ProblemKind::Conflict,
        "contact.young_modulus",
        5,
        "contact.law = \"hertz\"",
    );
    let problem = problem_with("[run]", "[wall.keep]\naxial = 0.1\n[run]");
    expect(
        &problem,
        ProblemKind::Conflict,
        "wall.keep",
        15,
        "drive.control = \"stress\"",
    );
}

#[test]
fn presets_that_do_not_exist_or_differ() {
    let named = |text, preset| {
        let file = Some(SourceFile {
            name: "tube.toml",
            text,
        });
        Configuration::from_sources(&Sources {
            file,
            preset: Some(preset),
            overrides: &[],
        })
    };
    let problem = only_problem(named("", "frictionles"));
    assert_eq!(problem.kind, ProblemKind::Preset);
    assert!(
        problem
            .help
            .unwrap_or_default()
            .contains("did you mean frictionless?")
    );
    let problem = only_problem(named("preset = \"frictional\"\n", "frictionless"));
    expect(
        &problem,
        ProblemKind::Preset,
        "preset",
        1,
        "leave out --preset",
    );
    assert!(named("preset = \"frictionless\"\n", "frictionless").is_ok());
    let problem = only_problem(read("preset = \"fine\"\n", &[]));
    expect(
        &problem,
        ProblemKind::WrongType,
        "preset",
        1,
        "\"frictionless-fine\"",
    );
    let problem = only_problem(read(FILE, &["preset=frictional"]));
    assert_eq!(problem.kind, ProblemKind::Preset);
}

#[test]
fn overrides_are_their_own_place() {
    let problem = only_problem(read(FILE, &["drive.width=3.2"]));
    assert!(
        problem
            .to_string()
            .starts_with("--set drive.width=3.2: drive.width = 3.2 is wider")
    );
    assert_eq!(
        &problem.labels[0].source_text[problem.labels[0].span.clone()],
        "3.2"
    );
    let problem = only_problem(read(FILE, &["drive.widht=3.2"]));
    assert!(
        problem
            .help
            .unwrap_or_default()
            .contains("did you mean drive.width?")
    );
    let problem = only_problem(read(FILE, &["drive.width=2.5", "drive.amplitude=0.1"]));
    assert_eq!(problem.kind, ProblemKind::Conflict);
    assert_eq!(problem.labels.len(), 2);
}
