//! The study file: valid and invalid ones; errors with place and help.

use peristalsis_study::{SettingValue, Specification, schema};

use crate::{SMALL, plan, read};

/// Refused with all of these parts in the message.
#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    let message = read(text).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in {message}");
    }
}

#[track_caller]
fn refused_with(from: &str, to: &str, parts: &[&str]) {
    assert_eq!(SMALL.matches(from).count(), 1, "{from:?}");
    refused(&SMALL.replace(from, to), parts);
}

fn widths(text: &str) -> Vec<f64> {
    plan(text)
        .points()
        .iter()
        .map(|point| point.settings[0].value.number().unwrap())
        .collect()
}

#[test]
fn lists_and_ranges_have_the_values_that_a_person_means() {
    assert_eq!(widths(SMALL), [2.5, 2.8]);
    let range = |keys: &str| SMALL.replace("values = [2.5, 2.8]", keys);
    // 2.6 + 0.1 is not 2.7 in binary, but 2.7 is meant.
    assert_eq!(
        widths(&range("from = 2.6\nto = 2.9\nstep = 0.1")),
        [2.6, 2.7, 2.8, 2.9]
    );
    assert_eq!(
        widths(&range("from = 2.9\nto = 2.6\ncount = 3")),
        [2.9, 2.75, 2.6]
    );
    assert_eq!(
        widths(&range("from = 2.6\nto = 2.605\nstep = 0.001")),
        [2.6, 2.601, 2.602, 2.603, 2.604, 2.605]
    );
}

#[test]
fn a_range_reaches_keys_that_take_whole_numbers() {
    let range = |keys: &str| {
        let text = SMALL.replace("key = \"drive.width\"", "key = \"grains.number\"");
        text.replace("values = [2.5, 2.8]", keys)
    };
    for keys in [
        "from = 10\nto = 30\nstep = 10",
        "from = 10\nto = 30\ncount = 3",
    ] {
        let plan = plan(&range(keys));
        let numbers = plan.points().iter().map(|point| &point.settings[0].value);
        let expected = [10, 20, 30].map(SettingValue::Whole);
        assert!(numbers.eq(&expected), "{keys}");
    }
    refused(
        &range("from = 10\nto = 11\ncount = 3"),
        &["grains.number = 10.5 is not a whole number"],
    );
}

#[test]
fn axes_multiply_and_rows_vary_together() {
    let text = format!(
        "{SMALL}
[[axes]]
keys = [\"tube.spheres_per_ring\", \"tube.rings_per_wave\"]
rows = [[12, 14], [24, 26]]
"
    )
    .replace(
        "replicates = 3",
        "replicates = 3\nstates = [\"rest\", \"jammed\"]",
    );
    let plan = plan(&text);
    assert_eq!(plan.points().len(), 2 * 2 * 2);
    assert_eq!(plan.runs().len(), 24);
    // The first replicate of every point comes before the second of any.
    assert!(plan.runs()[..8].iter().all(|run| run.replicate == 0));
    let last = plan.points().last().unwrap();
    assert_eq!(
        last.in_words(),
        "drive.width 2.8, tube.spheres_per_ring 24, tube.rings_per_wave 26, from jammed"
    );
    assert_eq!(last.settings[1].value, SettingValue::Whole(24));
    assert_eq!(last.configuration.tube.rings_per_wave, 26);
    // From jammed, grains move with the wave: the state brings its velocity along.
    assert_eq!(last.configuration.initial.axial_velocity, 1.0);
}

#[test]
fn a_study_without_axes_is_one_point() {
    let plan = plan("name = \"one\"\npreset = \"frictionless\"\n");
    assert_eq!(plan.runs().len(), 1);
    assert_eq!(plan.points()[0].in_words(), "from rest");
}

#[test]
fn a_configuration_file_can_be_the_base() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "tube.toml",
        "preset = \"frictionless\"\n[run]\nseed = 7\nperiods = 5\n",
    );
    write("study.toml", "name = \"of-file\"\nfile = \"tube.toml\"\n");
    let study = Specification::read(&folder.path().join("study.toml")).unwrap();
    let plan = study.plan();
    let configuration = plan.configuration(&plan.runs()[0]);
    assert_eq!(configuration.run.periods, Some(5.0));
    assert_ne!(configuration.run.seed, 7);
    // A store has a copy of both, and reads them without the originals.
    let store = peristalsis_study::Store::create(&folder.path().join("store"), &study).unwrap();
    write("tube.toml", "not toml");
    let copy = store.specification().unwrap();
    assert_eq!(copy.plan().runs(), study.plan().runs());
    // What is wrong in the base is found in the base.
    write(
        "tube.toml",
        "preset = \"frictionless\"\n[run]\nperiods = -1\n",
    );
    let message = Specification::read(&folder.path().join("study.toml"))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("tube.toml:3:11: run.periods = -1"),
        "{message}"
    );
}

#[test]
fn a_store_keeps_the_tables_that_a_study_names() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("sizes \"a\".csv", "diameter,fraction\n0.9,0.5\n1.1,0.5\n");
    write("b.csv", "diameter,fraction\n0.8,0.5\n1.2,0.5\n");
    write(
        "tube.toml",
        "preset = \"frictionless\"\n[grains]\nsizes = \"table\"\nfile = 'sizes \"a\".csv'\n",
    );
    write(
        "study.toml",
        "name = \"tables\"\nfile = \"tube.toml\"\n[[axes]]\nkey = \"grains.file\"\nvalues = ['sizes \"a\".csv', \"b.csv\"]\n",
    );
    let study = Specification::read(&folder.path().join("study.toml")).unwrap();
    let path = folder.path().join("store");
    let create = |study| peristalsis_study::Store::create(&path, study).unwrap();
    create(&study);
    for name in ["sizes \"a\".csv", "b.csv"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    let text = || std::fs::read_to_string(path.join("study.toml")).unwrap();
    let (before, store) = (text(), peristalsis_study::Store::open(&path).unwrap());
    let copy = store.specification().unwrap();
    let identities = |study: &Specification| -> Vec<_> {
        let runs = study.plan().runs().iter();
        runs.map(|run| run.identity).collect()
    };
    assert_eq!(identities(&copy), identities(&study));
    // A copy of a copy is the same.
    create(&copy);
    assert_eq!(text(), before);
    assert_eq!(path.join("tables").read_dir().unwrap().count(), 2);
}

#[test]
fn keys_of_the_study_are_checked_like_those_of_a_configuration() {
    refused_with(
        "replicates",
        "replicate",
        &[
            "study.toml:4:1",
            "no key replicate",
            "did you mean replicates?",
        ],
    );
    refused_with(
        "replicates = 3",
        "replicates = 0",
        &["study.toml:4:14", "too small", "1 or more"],
    );
    refused_with(
        "name = \"small\"\n",
        "",
        &["name is missing", "exported files"],
    );
    refused_with(
        "\"small\"",
        "\"../small\"",
        &["study.toml:2:8", "letters a to z"],
    );
    refused_with(
        "\"frictionless\"",
        "\"frictionles\"",
        &["study.toml:3:10", "did you mean \"frictionless\"?"],
    );
    refused_with(
        "replicates = 3",
        "states = [\"rest\", \"jamed\"]",
        &["study.toml:4:19", "did you mean \"jammed\"?"],
    );
    refused_with(
        "replicates = 3",
        "states = [\"rest\", \"jammed\", \"rest\"]",
        &["study.toml:4:29", "states has \"rest\" twice"],
    );
    refused_with("[[axes]]", "[[axes]", &["study.toml:12", "not TOML"]);
}

#[test]
fn every_configuration_is_checked_and_the_value_of_the_axis_is_pointed_at() {
    refused_with(
        "2.8",
        "3.5",
        &["study.toml:14:16: drive.width = 3.5 is wider than the tube"],
    );
    refused_with(
        "[2.5, 2.8]",
        "[2.5, \"wide\"]",
        &["study.toml:14:16: drive.width is a text"],
    );
    refused_with(
        "drive.width",
        "drive.widht",
        &[
            "study.toml:13:7",
            "no key drive.widht",
            "did you mean drive.width?",
        ],
    );
    refused_with(
        "grains.number = 20",
        "grains.nummer = 20",
        &["study.toml:7", "base.grains.number"],
    );
    refused_with(
        "run.periods = 12",
        "run.periods = 12\nrun.time_step = 1e-300",
        &["beyond reach"],
    );
}

#[test]
fn what_contradicts_itself_is_refused() {
    refused_with(
        "values = [2.5, 2.8]",
        "values = [2.5, 2.8]\ncount = 2",
        &["study.toml:12:1", "do not make an axis", "key and values"],
    );
    refused_with(
        "values = [2.5, 2.8]",
        "from = 2.5\nto = 2.8\nstep = 0.2",
        &["study.toml:16:8", "whole steps"],
    );
    let axes = |more: &str| format!("{SMALL}[[axes]]\n{more}\n");
    refused(
        &axes("key = \"drive.width\"\nvalues = [2.6]"),
        &["study.toml:16:7", "varied twice"],
    );
    refused(
        &axes("key = \"drive.amplitude\"\nvalues = [0.2]"),
        &["exclude one another", "study.toml:16:7", "study.toml:13:7"],
    );
    refused(
        &axes("key = \"run.seed\"\nvalues = [1, 2]"),
        &["study.toml:16:7", "replicates"],
    );
    refused(
        &axes("keys = [\"tube.waves\", \"tube.radius\"]\nrows = [[2, 1.5], [3]]"),
        &["study.toml:17:19", "a row of 1 values for 2 keys"],
    );
    refused(
        &axes("key = \"run.periods\"\nvalues = [12, 12.0]"),
        &["study.toml:17:15", "12 twice", "study.toml:17:11"],
    );
    refused(
        &format!("{SMALL}[refine]\nkey = \"drive.strain_rate\"\ntolerance = 0.1\n"),
        &["study.toml:16:7", "axes that can be: drive.width"],
    );
    refused_with(
        "grains.number = 20",
        "run.seed = 5",
        &["study.toml:7:5", "replicates"],
    );
    refused(
        &axes("key = \"run.periods\"\nfrom = 1\nto = 100000\ncount = 100000")
            .replace("replicates = 3", "replicates = 100"),
        &["beyond reach", "study.toml:12:3"],
    );
}

#[test]
fn any_text_is_safe_to_read() {
    proptest::proptest!(|(text in ".*")| {
        drop(read(&text));
    });
    proptest::proptest!(|(axis in "(key|keys|values|rows|from|to|step|count) = (1|\"drive.width\"|\\[\\]|\\[1\\]|\\[\\[1\\]\\])", number in 0..4_usize)| {
        drop(read(&format!("name = \"x\"\npreset = \"frictionless\"\n[[axes]]\n{}", format!("{axis}\n").repeat(number))));
        drop(read(&SMALL.replace("values = [2.5, 2.8]", &axis)));
    });
}

#[test]
fn the_schema_takes_what_the_reader_takes() {
    let schema = schema();
    jsonschema::meta::validate(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let valid = |text: &str| {
        let table: toml::Table = toml::from_str(text).unwrap();
        validator.is_valid(&serde_json::to_value(table).unwrap())
    };
    let all = format!(
        "{}\n[refine]\nkey = \"drive.width\"\ntolerance = 0.1\n[stop]\nsettled_periods = 10\n\
         [record]\ncolumns = [\"time\"]\nprofile = false\nwaves = true\nsnapshot = true\n",
        SMALL.replace("replicates = 3", "states = [\"rest\"]\ntitle = \"x\"")
    );
    for text in [SMALL, &all] {
        assert!(read(text).is_ok());
        assert!(valid(text), "{text}");
    }
    for (from, to) in [
        ("replicates = 3", "replicates = 0"),
        ("name", "nome"),
        ("grains.number = 20", "grains.number = -1"),
        ("grains.number = 20", "preset = \"frictionless\""),
    ] {
        let text = SMALL.replace(from, to);
        assert!(read(&text).is_err(), "{text}");
        assert!(!valid(&text), "{text}");
    }
}
