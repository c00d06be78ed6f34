//! What is wrong with a configuration is said with key, line and what is allowed.

use peristalsis_configuration::{Configuration, ConfigurationError, Problem, ProblemKind, Sources};
use serde_json::Value;

use crate::{NO_OVERRIDES, only_problem, read, rows};

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

/// Changes of the file; kind, key and lines of what is then wrong; parts of its help and of its message.
///
/// A change replaces the text before the arrow, `&` in what comes after it, by a text in which `\n` begins a line.
const WRONG: &str = r#"
width = 2.75 -> widht = 2.75\n& | UnknownKey | drive.widht | 13 | did you mean drive.width?
[grains] -> width = 2.75\n& | UnknownKey | width | 1 | did you mean drive.width?
[grains] -> "drive.width" = 2.75\n& | UnknownKey | drive.width | 1 | write drive.width without them
[grains] -> [grain]\n& | UnknownKey | grain | 1 | did you mean grains?
waves = 10 -> &\narrangement = "random"\narrangement_seed = -1 | OutOfRange | tube.arrangement_seed | 10 | 0 or more
waves = 10 -> &\narrangement = "aligned"\narrangement_seed = 2 | Conflict | tube.arrangement_seed | 10 | arrangement = "random" or "disordered"
waves = 10 -> &\narrangement_seed = 2 | Conflict | tube.arrangement_seed | 9 | arrangement = "random" or "disordered" | here it is "staggered"
waves = 10 -> &\nplaces = [0] | Conflict | tube.places | 9 | arrangement = "file"
waves = 10 -> &\narrangement = "file" | Inconsistent | tube.places | 9 | give tube.file | no sphere
waves = 10 -> &\narrangement = "file"\nangles = [0]\nplaces = [0, 5] | Inconsistent | tube.places | 11 10 9 | one of both | 1 angles and 2 places
waves = 10 -> &\narrangement = "file"\nangles = [0, 1]\nplaces = [0, 100.0] | Inconsistent | tube.places | 11 10 9 | 0 <= z < L = waves * wavelength = 100 | wall sphere 2
waves = 10 -> &\narrangement = "file"\nangles = [0]\nplaces = [-1] | OutOfRange | tube.places[0] | 11 | 0 or more
waves = 10 -> &\narrangement = "file"\nfile = "no-such.csv" | Inconsistent | tube.file | 10 | angle,place | no-such.csv
waves = 10 -> &\narrangement = "file"\nfile = "a.csv"\nplaces = [0] | Conflict | tube.file | 10 11 | keep one of
waves = 10 -> &\nfile = "a.csv"\narrangement = "random" | Conflict | tube.file | 9 10 | arrangement = "file"
waves = 10 -> &\narrangement = "smooth"; rings_per_wave = 14 -> # none | Conflict | tube.spheres_per_ring | 10 9 | arrangement = "staggered", "aligned", "random", "disordered" or "file" | but here it is "smooth"
control = "strain" -> control = "stress"; width = 2.75 -> force_amplitude = 0.004; waves = 10 -> &\narrangement = "smooth"; spheres_per_ring = 12 -> # none; rings_per_wave = 14 -> # none | Inconsistent | tube.arrangement | 9 | leave tube.arrangement out
[run] -> [wall]\nsphere_diameter = 0\n[run] | OutOfRange | wall.sphere_diameter | 16 | tube.arrangement = "smooth" | needs spheres
waves = 10 -> &\narrangement = "hexagonal" | WrongType | tube.arrangement | 9 | "staggered", "aligned", "random", "disordered"
control = "strain" -> control = "stress"; width = 2.75 -> force_amplitude = 0.004; waves = 10 -> &\narrangement = "aligned" | Inconsistent | tube.arrangement | 9 | leave tube.arrangement out
radius = 1.5 -> &\ncolour = 1 | UnknownKey | tube.colour | 7 | known here: angles, arrangement

volume_fraction = 0.15 -> &\nnumber = 200 | Conflict | grains.volume_fraction | 2 3 | keep one of
width = 2.75 -> &\namplitude = 0.1 | Conflict | drive.width | 13 14 | keep one of
strain_rate = 0.05 -> &\nwave_speed = 0.5 | Conflict | drive.strain_rate | 14 15 | keep one of
periods = 40 -> &\nduration = 800 | Conflict | run.periods | 16 17 | keep one of

radius = 1.5 -> radius = 0 | OutOfRange | tube.radius | 6 | a number above 0
radius = 1.5 -> radius = nan | OutOfRange | tube.radius | 6 | a number above 0
wavelength = 10.0 -> wavelength = 1e999 | OutOfRange | tube.wavelength | 7 | Unit: d
waves = 10 -> waves = -3 | OutOfRange | tube.waves | 8 | a whole number, 1 or more
waves = 10 -> waves = 99999999 | OutOfRange | tube.waves | 8 | at most 1e6

radius = 1.5 -> radius = "wide" | WrongType | tube.radius | 6 | allowed: a number
waves = 10 -> waves = 2.5 | WrongType | tube.waves | 8 | allowed: a whole number
waves = 10 -> waves = 99999999999999999999 | OutOfRange | tube.waves | 8 | a whole number
waves = 10 -> waves = 0xffffffffffffffff | OutOfRange | tube.waves | 8 | a whole number | is too large
periods = 40 -> &\nseed = -1 | OutOfRange | run.seed | 17 | at most 9223372036854775807
law = "linear" -> law = "linera" | WrongType | contact.law | 4 | did you mean "linear"?
law = "linear" -> law = 3 | WrongType | contact.law | 4 | "linear", "hertz"
periods = 40 -> periods = 1979-05-27 | WrongType | run.periods | 16 | a number
width = 2.75 -> &\nwaveform = "square" | WrongType | drive.waveform | 14 | "sine"

waves = 10 -> waves = = 10 | Syntax | - | 8
waves = 10 -> &\nwaves = 11 | Syntax | - | 9 | | duplicate key

width = 2.75 -> # | Missing | drive.width | 11 | Width of the bottleneck

width = 2.75 -> &\nforce_amplitude = 0.004 | Conflict | drive.force_amplitude | 14 12 | remove drive.force_amplitude, or set drive.control = "stress"
law = "linear" -> &\nyoung_modulus = 2 | Conflict | contact.young_modulus | 5 | contact.law = "hertz"
[run] -> [wall.keep]\naxial = 0.1\n& | Conflict | wall.keep | 15 | drive.control = "stress"

radius = 1.5 -> radius = 7e-3; width = 2.75 -> width = 8e-3 | Inconsistent | tube.radius | 6 | tube.radius = 3.5 | no grain fits
width = 2.75 -> width = 3.0000001 | Inconsistent | drive.width | 13 | 2 tube.radius = 3
width = 2.75 -> amplitude = 1.6 | Inconsistent | drive.amplitude | 13 | tube.radius = 1.5

rings_per_wave = 14 -> rings_per_wave = 23 | Inconsistent | tube.rings_per_wave | 10 | take 22 or 24
control = "strain" -> control = "stress"; width = 2.75 -> force_amplitude = 0.004; rings_per_wave = 14 -> rings_per_wave = 23; waves = 10 -> waves = 3 | Inconsistent | tube.rings_per_wave | 10 8 | waves = 2 or 4, or tube.rings_per_wave = 22 or 24
wavelength = 10.0 -> wavelength = 2.0; waves = 10 -> waves = 1 | Inconsistent | tube.wavelength | 7 | L above 2 | a tube that closes on itself

volume_fraction = 0.15 -> number = 900000000000 | OutOfRange | grains.number | 2 | at most 1e8
radius = 1.5 -> radius = 1e5 | OutOfRange | grains.volume_fraction | 2 | 100000000 grains
volume_fraction = 0.15 -> number = 5; spheres_per_ring = 12 -> spheres_per_ring = 1000000; rings_per_wave = 14 -> rings_per_wave = 1000000 | OutOfRange | tube.waves | 8 | at most 1000000000

law = "linear" -> &\nstatic_friction = 0.3\nkinetic_friction = 0.4 | Inconsistent | contact.kinetic_friction | 6 | to at most 0.3
volume_fraction = 0.15 -> number = 9\ndiameter_min = 1.2 | Inconsistent | grains.diameter_min | 3 | give both

strain_rate = 0.05 -> strain_rate = 0 | Inconsistent | run.periods | 16 | run.duration
periods = 40 -> periods = 1e9 | OutOfRange | run.periods | 16 | 1e8 samples
periods = 40 -> &\ntime_step = 1e-300 | OutOfRange | run.periods | 16 | run.time_step
strain_rate = 0.05 -> strain_rate = 5e-324 | OutOfRange | run.periods | 16 | a shorter run

width = 2.75 -> &\nschedule = [{ form = 'ramp', end = 2 }, { form = 'ramp', parameter = 'amplitude', end = 3 }] | Inconsistent | drive.schedule[1] | 14 14 | for example | two schedules for one parameter
width = 2.75 -> &\nschedule = [] | Inconsistent | drive.schedule | 14 | "sudden" | the list is empty
width = 2.75 -> &\nschedule = "steps" | WrongType | drive.schedule | 14 | "sudden", "ramp"
width = 2.75 -> &\nschedule = { end = 2 } | Missing | drive.schedule.form | 14 | "ramp", "steps"
width = 2.75 -> &\nschedule = "ramp" | Missing | drive.schedule | 14 | drive.ramp_periods = 2
width = 2.75 -> &\nramp_periods = 2 | Inconsistent | drive.ramp_periods | 14 | schedule = "ramp"
width = 2.75 -> &\nschedule = { form = 'steps', at = [-1.0], values = [2.5] } | OutOfRange | drive.schedule.at[0] | 14 | 0 or more
[run] -> [drive.schedule]\nform = 'ramp'\nend = 5\nto = 3.6\n& | Inconsistent | drive.schedule.to | 18 | width
"#;

/// Schedules in a table of their own: keys; the one to blame, what stands there, and the message.
const WRONG_SCHEDULES: &str = r#"
form = 'ramp', to = 3.5, end = 2 | .to | 3.5 | width = 3.5 is above 3
form = 'ramp', parameter = 'amplitude', from = 1.6, end = 2 | .from | 1.6 | amplitude = 1.6 is above
form = 'ramp', start = 3, end = 3 | .end | 3 | not after its start at 3
form = 'ramp' | | { form | needs its end
form = 'ramp', at = [1], end = 2 | .at | [1] | not at and values
form = 'steps', at = [0, 1], values = [2.5] | .values | [2.5] | 2 times in at, but 1 values
form = 'steps', at = [0, 1, 1], values = [2.5, 2.6, 2.7] | .at[2] | 1 | do not ascend
form = 'steps', at = [1], values = [9.0] | .values[0] | 9.0 | width = 9 is above 3
form = 'steps', at = [1] | | { form | need both
form = 'course', parameter = 'width', at = [0, 1], values = [2.7, 3.2] | .values[1] | 3.2 | above
form = 'course', at = [0, 1], values = [2.7, 2.8], end = 2 | .end | 2 | a course takes at and values
form = 'course', at = [0, 1] | | { form | a course needs both
form = 'course', at = [1, 1, 1], values = [2.5, 2.6, 2.7] | .at[2] | 1 | do not ascend (two may be equal)
form = 'ramp', parameter = 'force_amplitude', end = 2 | .parameter | 'force_amplitude' | drive.control = "stress"
"#;

/// The file after some changes.
fn changed(changes: &str) -> String {
    let mut text = FILE.to_owned();
    for change in changes.split("; ") {
        let (from, to) = change.split_once(" -> ").expect("an arrow");
        assert!(text.contains(from), "{from}");
        let to = to.replace('&', from).replace("\\n", "\n");
        text = text.replacen(from, &to, 1);
    }
    text
}

fn over(text: &str, overrides: &[&str]) -> Result<Configuration, ConfigurationError> {
    read(Some(text), None, overrides)
}

/// The one problem of the file after some changes.
fn problem_with(changes: &str) -> Problem {
    only_problem(over(&changed(changes), &[]))
}

fn help(problem: &Problem) -> &str {
    problem.help.as_deref().unwrap_or_default()
}

/// Kind and key, lines of the first labels, and a part of the help.
fn expect(problem: &Problem, kind: &str, key: &str, lines: &[usize], part_of_help: &str) {
    assert_eq!(format!("{:?}", problem.kind), kind, "{problem}");
    assert_eq!(problem.key.as_deref().unwrap_or("-"), key, "{problem}");
    for (label, line) in problem.labels.iter().zip(lines) {
        assert_eq!(label.line_and_column().0, *line, "{problem}");
    }
    match lines.len() {
        0 | 1 => assert!(problem.labels.len() >= lines.len(), "{problem}"),
        several => assert_eq!(problem.labels.len(), several, "{problem}"),
    }
    assert!(help(problem).contains(part_of_help), "{problem}");
}

#[test]
fn the_file_itself_is_right() {
    let configuration = over(FILE, &[]).unwrap();
    assert_eq!(configuration.grains.number, 203);
    assert_eq!(configuration.run.time_step, 0.05);
    assert_eq!(configuration.run.steps(), 16_000);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    for [changes, kind, key, lines, help, message] in rows(WRONG) {
        let lines: Vec<usize> = lines.split(' ').map(|it| it.parse().unwrap()).collect();
        let problem = problem_with(changes);
        expect(&problem, kind, key, &lines, help);
        assert!(problem.message.contains(message), "{problem}");
    }
}

#[test]
fn what_is_at_the_limit_is_right() {
    for changes in [
        "width = 2.75 -> width = 3.0",
        "width = 2.75 -> width = 0",
        "volume_fraction = 0.15 -> number = 0",
        "control = \"strain\" -> control = \"stress\"; width = 2.75 -> force_amplitude = 0.004; \
         rings_per_wave = 14 -> rings_per_wave = 23",
    ] {
        let configuration = over(&changed(changes), &[]).unwrap();
        let has_grains = !changes.contains("number = 0");
        assert_eq!(configuration.grains.number > 0, has_grains, "{changes}");
    }
}

#[test]
fn a_display_is_complete_in_itself() {
    let text = problem_with("width = 2.75 -> width = 3.2").to_string();
    assert!(text.starts_with("tube.toml:13:9: drive.width = 3.2 is wider than the tube, 2 a = 3"));
    for part in [
        "tube.toml:6:10: tube.radius = 1.5",
        "help: 0 <= drive.width <= 2 tube.radius = 3",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn independent_problems_come_in_one_go_in_the_order_of_the_text() {
    let changes = "law = \"linear\" -> law = \"linera\"; radius = 1.5 -> radius = -1.5; width = 2.75 -> widht = 2.75";
    let error = over(&changed(changes), &["run.seed=-1"]).unwrap_err();
    let problems = error.problems().iter();
    let keys: Vec<&str> = problems.filter_map(|it| it.key.as_deref()).collect();
    assert_eq!(
        keys,
        ["contact.law", "tube.radius", "drive.widht", "run.seed"]
    );
    assert_eq!(error.to_string().matches("help:").count(), 4);
    let error = over(&changed("width = 2.75 -> width = 4; = 14 -> = 15"), &[]).unwrap_err();
    assert_eq!(error.problems().len(), 2, "{error}");
}

#[test]
fn missing_keys_are_all_named() {
    let problem = only_problem(over("[tube]\nradius = 1.5\n", &[]));
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
    assert!(help(&problem).contains("preset = \"frictionless\""));
    let nothing = only_problem(Configuration::from_sources(&Sources::default()));
    assert!(nothing.labels.is_empty());
}

#[test]
fn presets_that_do_not_exist_or_differ() {
    let named = |text, preset| read(Some(text), Some(preset), NO_OVERRIDES);
    let problem = only_problem(named("", "frictionles"));
    assert_eq!(problem.kind, ProblemKind::Preset);
    assert!(help(&problem).contains("did you mean frictionless?"));
    let problem = only_problem(named("preset = \"frictional\"\n", "frictionless"));
    expect(&problem, "Preset", "preset", &[1], "leave out --preset");
    assert!(named("preset = \"frictionless\"\n", "frictionless").is_ok());
    let problem = only_problem(over("preset = \"fine\"\n", &[]));
    let names = "\"frictionless-fine\"";
    expect(&problem, "WrongType", "preset", &[1], names);
    let problem = only_problem(over(FILE, &["preset=frictional"]));
    assert_eq!(problem.kind, ProblemKind::Preset);
    let problem = only_problem(over("preset = \"frictionless\"\ntube = 3\n", &[]));
    expect(
        &problem,
        "WrongType",
        "tube",
        &[2],
        "a table of angles, arrangement",
    );
}

#[test]
fn overrides_are_their_own_place() {
    let problem = only_problem(over(FILE, &["drive.width=3.2"]));
    let text = problem.to_string();
    assert!(text.starts_with("--set drive.width=3.2: drive.width = 3.2 is wider"));
    let label = &problem.labels[0];
    assert_eq!(&label.source_text[label.span.clone()], "3.2");
    let problem = only_problem(over(FILE, &["drive.widht=3.2"]));
    assert!(help(&problem).contains("did you mean drive.width?"));
    let problem = only_problem(over(FILE, &["drive.width=2.5", "drive.amplitude=0.1"]));
    assert_eq!(problem.kind, ProblemKind::Conflict);
    assert_eq!(problem.labels.len(), 2);
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
    leaves("", &peristalsis_configuration::schema(), &mut keys);
    assert!(keys.len() > 50);
    for (path, key) in keys {
        for value in refused_by(&key) {
            let setting = format!("{path}={value}");
            let problem = only_problem(read(None, Some("frictional"), &[&setting]));
            assert_eq!(problem.key.as_deref(), Some(path.as_str()), "{problem}");
            assert!(help(&problem).contains("allowed: "), "{setting}: {problem}");
        }
    }
}

#[test]
fn a_static_wave_is_as_long_as_its_duration_and_has_no_schedule() {
    let text = changed("strain_rate = 0.05 -> wave_speed = 0");
    let still = over(&text, &["run.duration=100"]).unwrap();
    assert_eq!((still.run.periods, still.run.duration), (None, 100.0));
    assert_eq!((still.run.samples, still.run.steps_per_sample), (200, 10));
    let ramp = "drive.schedule={form='ramp',end=2}";
    let problem = only_problem(over(&text, &["run.duration=100", ramp]));
    let message = "a static wave has none";
    assert!(problem.message.contains(message), "{problem}");
}

#[test]
fn schedules_are_checked_at_all_times() {
    for [table, key, there, message] in rows(WRONG_SCHEDULES) {
        let problem = problem_with(&format!("width = 2.75 -> &\\nschedule = {{ {table} }}"));
        let key = format!("drive.schedule{key}");
        let example = "for example drive.schedule = { form = \"ramp\", parameter = \"width\"";
        expect(&problem, "Inconsistent", &key, &[14], example);
        assert!(problem.message.contains(message), "{problem}");
        let label = &problem.labels[0];
        let text = &label.source_text[label.span.clone()];
        assert!(text.starts_with(there), "{there} is not at {text}");
    }
}

#[test]
fn a_schedule_of_its_own_table_is_pointed_at_by_its_key() {
    let tables = r"[[drive.schedule]]\nform = 'steps'\nparameter = 'strain_rate'\nat = [0, 5]\nvalues = [0.05, 0.1]\n[[drive.schedule]]\nform = 'steps'\nat = [0, 5, 3]\nvalues = [2.7, 2.8, 2.9]\n";
    let problem = problem_with(&format!("[run] -> {tables}&"));
    // The first of the two tables stands at line 15.
    let key = "drive.schedule[1].at[2]";
    expect(&problem, "Inconsistent", key, &[22], "for example");
    assert_eq!(problem.labels[0].line_and_column().1, 13);
}

#[test]
fn the_example_of_a_schedule_fits_the_control() {
    let schedule = "drive.schedule={form='ramp', parameter='width', end=2}";
    let problem = only_problem(read(None, Some("frictional"), &[schedule]));
    let help = help(&problem);
    assert!(help.contains("force_amplitude") && !help.contains("width"));
}
