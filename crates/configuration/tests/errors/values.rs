//! What is wrong with values together: widths, lattices, sizes, times, schedules.

use peristalsis_configuration::{Configuration, ProblemKind, Sources, schema};
use serde_json::Value;

use crate::{FILE, expect, only_problem, problem_with, read};

#[test]
fn a_width_beyond_the_tube() {
    let problem = problem_with("width = 2.75", "width = 3.0000001");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "drive.width",
        13,
        "2 tube.radius = 3",
    );
    assert!(read(&FILE.replace("width = 2.75", "width = 3.0"), &[]).is_ok());
    assert!(read(&FILE.replace("width = 2.75", "width = 0"), &[]).is_ok());
    let problem = problem_with("width = 2.75", "amplitude = 1.6");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "drive.amplitude",
        13,
        "tube.radius = 1.5",
    );
}

#[test]
fn an_odd_number_of_rings_names_its_neighbours() {
    let problem = problem_with("rings_per_wave = 14", "rings_per_wave = 23");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "tube.rings_per_wave",
        10,
        "take 22 or 24",
    );
    let stress = FILE
        .replace("control = \"strain\"", "control = \"stress\"")
        .replace("width = 2.75", "force_amplitude = 0.004")
        .replace("rings_per_wave = 14", "rings_per_wave = 23");
    assert!(read(&stress, &[]).is_ok());
    let problem = only_problem(read(&stress.replace("waves = 10", "waves = 3"), &[]));
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "tube.rings_per_wave",
        10,
        "waves = 2 or 4",
    );
    assert!(
        problem
            .help
            .unwrap_or_default()
            .contains("rings_per_wave = 22 or 24")
    );
    assert_eq!(problem.labels[1].line_and_column().0, 8);
}

#[test]
fn numbers_of_grains_and_wall_spheres_beyond_reach() {
    let problem = problem_with("volume_fraction = 0.15", "number = 900000000000");
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "grains.number",
        2,
        "at most 1e8",
    );
    let huge = FILE.replace("radius = 1.5", "radius = 1e5");
    let problem = only_problem(read(&huge, &[]));
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "grains.volume_fraction",
        2,
        "100000000 grains",
    );
    let problem = only_problem(read(
        &FILE
            .replace("volume_fraction = 0.15", "number = 5")
            .replace("spheres_per_ring = 12", "spheres_per_ring = 1000000")
            .replace("rings_per_wave = 14", "rings_per_wave = 1000000"),
        &[],
    ));
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "tube.waves",
        8,
        "at most 1000000000",
    );
    let none = read(&FILE.replace("volume_fraction = 0.15", "number = 0"), &[]).unwrap();
    assert_eq!(none.grains.number, 0);
}

#[test]
fn friction_and_diameters_in_the_wrong_order() {
    let problem = problem_with(
        "law = \"linear\"",
        "law = \"linear\"\nstatic_friction = 0.3\nkinetic_friction = 0.4",
    );
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "contact.kinetic_friction",
        6,
        "to at most 0.3",
    );
    let problem = problem_with("volume_fraction = 0.15", "number = 9\ndiameter_min = 1.2");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "grains.diameter_min",
        3,
        "give both",
    );
}

/// Every key that holds one value, with its schema.
fn leaves(path: &str, schema: &Value, found: &mut Vec<(String, Value)>) {
    for (name, key) in schema["properties"].as_object().into_iter().flatten() {
        let path = format!("{path}{name}");
        match key.get("properties") {
            Some(_) => leaves(&format!("{path}."), key, found),
            None => found.push((path, key.clone())),
        }
    }
}

/// Values that a key refuses: on the wrong side of its limits, no numbers, no names of its own.
fn refused_by(key: &Value) -> Vec<String> {
    let limit = |name: &str| key[name].as_f64();
    let beyond = [
        limit("minimum").map(|least| least - 1.0),
        limit("exclusiveMinimum"),
        limit("maximum").map(|most| 2.0 * most.abs() + 1.0),
    ];
    let beyond = beyond.into_iter().flatten();
    match key["type"].as_str() {
        Some("integer") => beyond.map(|value| format!("{value:.0}")).collect(),
        Some("number") => {
            let numbers = beyond.map(|value| format!("{value:?}"));
            numbers.chain(["nan", "inf"].map(str::to_owned)).collect()
        }
        Some("boolean") => vec!["1".to_owned()],
        _ if key.get("oneOf").is_some() => vec!["nonsense".to_owned()],
        _ => Vec::new(),
    }
}

#[test]
fn every_key_refuses_what_is_out_of_its_range() {
    let mut keys = Vec::new();
    leaves("", &schema(), &mut keys);
    assert!(keys.len() > 50);
    for (path, key) in keys {
        for value in refused_by(&key) {
            let overrides = [format!("{path}={value}")];
            let problem = only_problem(Configuration::from_sources(&Sources {
                file: None,
                preset: Some("frictional"),
                overrides: &overrides,
            }));
            assert_eq!(problem.key.as_deref(), Some(path.as_str()), "{problem}");
            let help = problem.help.unwrap_or_default();
            assert!(help.contains("allowed: "), "{overrides:?}: {help}");
        }
    }
}

#[test]
fn a_tube_that_closes_on_itself() {
    let text = FILE
        .replace("wavelength = 10.0", "wavelength = 2.0")
        .replace("waves = 10", "waves = 1");
    let problem = only_problem(read(&text, &[]));
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "tube.wavelength",
        7,
        "L above 2",
    );
    assert!(problem.message.contains("a tube that closes on itself"));
}

#[test]
fn a_static_wave_needs_a_duration() {
    let problem = problem_with("strain_rate = 0.05", "strain_rate = 0");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "run.periods",
        16,
        "run.duration",
    );
    let text = FILE.replace("strain_rate = 0.05", "wave_speed = 0");
    let still = read(&text, &["run.duration=100"]).unwrap();
    assert_eq!((still.run.periods, still.run.duration), (None, 100.0));
    assert_eq!((still.run.samples, still.run.steps_per_sample), (200, 10));
    let problem = only_problem(read(
        &text,
        &["run.duration=100", "drive.schedule={form='ramp',end=2}"],
    ));
    assert!(
        problem.message.contains("a static wave has none"),
        "{problem}"
    );
}

#[test]
fn runs_beyond_reach() {
    let problem = problem_with("periods = 40", "periods = 1e9");
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "run.periods",
        16,
        "1e8 samples",
    );
    let problem = problem_with("periods = 40", "periods = 40\ntime_step = 1e-300");
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "run.periods",
        16,
        "run.time_step",
    );
    let problem = problem_with("strain_rate = 0.05", "strain_rate = 5e-324");
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "run.periods",
        16,
        "a shorter run",
    );
}

#[test]
fn schedules_are_checked_at_all_times() {
    // The table, the key to blame, what stands there, and the message.
    let cases = [
        (
            "form = 'ramp', to = 3.5, end = 2",
            ".to",
            "3.5",
            "width = 3.5 is above 3",
        ),
        (
            "form = 'ramp', parameter = 'amplitude', from = 1.6, end = 2",
            ".from",
            "1.6",
            "amplitude = 1.6 is above",
        ),
        (
            "form = 'ramp', start = 3, end = 3",
            ".end",
            "3",
            "not after its start at 3",
        ),
        ("form = 'ramp'", "", "{ form", "needs its end"),
        (
            "form = 'ramp', at = [1], end = 2",
            ".at",
            "[1]",
            "not at and values",
        ),
        (
            "form = 'steps', at = [0, 1], values = [2.5]",
            ".values",
            "[2.5]",
            "2 times in at, but 1 values",
        ),
        (
            "form = 'steps', at = [0, 1, 1], values = [2.5, 2.6, 2.7]",
            ".at[2]",
            "1",
            "do not ascend",
        ),
        (
            "form = 'steps', at = [1], values = [9.0]",
            ".values[0]",
            "9.0",
            "width = 9 is above 3",
        ),
        ("form = 'steps', at = [1]", "", "{ form", "need both"),
        (
            "form = 'course', parameter = 'width', at = [0, 1], values = [2.7, 3.2]",
            ".values[1]",
            "3.2",
            "above",
        ),
        (
            "form = 'course', at = [0, 1], values = [2.7, 2.8], end = 2",
            ".end",
            "2",
            "a course takes at and values",
        ),
        (
            "form = 'course', at = [0, 1]",
            "",
            "{ form",
            "a course needs both",
        ),
        (
            "form = 'course', at = [1, 1, 1], values = [2.5, 2.6, 2.7]",
            ".at[2]",
            "1",
            "do not ascend (two may be equal)",
        ),
        (
            "form = 'ramp', parameter = 'force_amplitude', end = 2",
            ".parameter",
            "'force_amplitude'",
            "drive.control = \"stress\"",
        ),
    ];
    for (table, key, there, message) in cases {
        let schedule = format!("width = 2.75\nschedule = {{ {table} }}");
        let problem = problem_with("width = 2.75", &schedule);
        expect(
            &problem,
            ProblemKind::Inconsistent,
            &format!("drive.schedule{key}"),
            14,
            "for example drive.schedule = { form = \"ramp\", parameter = \"width\"",
        );
        assert!(problem.message.contains(message), "{problem}");
        let label = &problem.labels[0];
        let text = &label.source_text[label.span.clone()];
        assert!(text.starts_with(there), "{there} is not at {text}");
    }
    let twice = "width = 2.75\nschedule = [{ form = 'ramp', end = 2 }, { form = 'ramp', parameter = 'amplitude', end = 3 }]";
    let problem = problem_with("width = 2.75", twice);
    assert!(
        problem.message.contains("two schedules for one parameter"),
        "{problem}"
    );
    assert_eq!(problem.key.as_deref(), Some("drive.schedule[1]"));
    assert_eq!(problem.labels.len(), 2);
    let problem = problem_with("width = 2.75", "width = 2.75\nschedule = []");
    assert!(problem.message.contains("the list is empty"), "{problem}");
    assert!(problem.help.unwrap().contains("\"sudden\""));
    let problem = problem_with("width = 2.75", "width = 2.75\nschedule = \"steps\"");
    expect(
        &problem,
        ProblemKind::WrongType,
        "drive.schedule",
        14,
        "\"sudden\", \"ramp\"",
    );
    let problem = problem_with("width = 2.75", "width = 2.75\nschedule = { end = 2 }");
    expect(
        &problem,
        ProblemKind::Missing,
        "drive.schedule.form",
        14,
        "\"ramp\", \"steps\"",
    );
    let problem = problem_with("width = 2.75", "width = 2.75\nschedule = \"ramp\"");
    expect(
        &problem,
        ProblemKind::Missing,
        "drive.schedule",
        14,
        "drive.ramp_periods = 2",
    );
    let problem = problem_with("width = 2.75", "width = 2.75\nramp_periods = 2");
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "drive.ramp_periods",
        14,
        "schedule = \"ramp\"",
    );
    let items = "width = 2.75\nschedule = { form = 'steps', at = [-1.0], values = [2.5] }";
    let problem = problem_with("width = 2.75", items);
    expect(
        &problem,
        ProblemKind::OutOfRange,
        "drive.schedule.at[0]",
        14,
        "0 or more",
    );
}

#[test]
fn a_schedule_of_its_own_table_is_pointed_at_by_its_key() {
    let tables = "[[drive.schedule]]\nform = 'steps'\nparameter = 'strain_rate'\nat = [0, 5]\nvalues = [0.05, 0.1]\n\
                  [[drive.schedule]]\nform = 'steps'\nat = [0, 5, 3]\nvalues = [2.7, 2.8, 2.9]\n[run]";
    let problem = problem_with("[run]", tables);
    // The first of the two tables stands at line 15.
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "drive.schedule[1].at[2]",
        22,
        "for example",
    );
    assert_eq!(problem.labels[0].line_and_column().1, 13);
    let table = "[drive.schedule]\nform = 'ramp'\nend = 5\nto = 3.6\n[run]";
    let problem = problem_with("[run]", table);
    expect(
        &problem,
        ProblemKind::Inconsistent,
        "drive.schedule.to",
        18,
        "width",
    );
}

#[test]
fn the_example_of_a_schedule_fits_the_control() {
    let overrides = ["drive.schedule={form='ramp', parameter='width', end=2}".to_owned()];
    let problem = only_problem(Configuration::from_sources(&Sources {
        file: None,
        preset: Some("frictional"),
        overrides: &overrides,
    }));
    let help = problem.help.unwrap();
    assert!(
        help.contains("force_amplitude") && !help.contains("width"),
        "{help}"
    );
}
