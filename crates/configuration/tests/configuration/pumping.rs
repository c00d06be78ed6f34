//! Body force, waveforms and units in SI: what they resolve to, and what is refused.

use std::f64::consts::PI;

use peristalsis_configuration::{Configuration, ProblemKind, ScheduledParameter, WaveformName};

use crate::{NO_OVERRIDES, only_problem, preset, read, record, refuses, schema_errors};

/// Hashes of the presets before body force, waveforms and units could be given.
#[test]
fn what_was_not_said_before_changes_no_identity() {
    let digits = |bytes: [u8; 32]| -> String {
        bytes[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    };
    for (name, physics) in [
        ("frictionless", "f53687c8dbba62c4"),
        ("frictional", "29ad96917d883ce0"),
    ] {
        let plain = preset(name, NO_OVERRIDES);
        assert_eq!(digits(plain.physics_hash()), physics, "{name}");
    }
}

#[test]
fn the_body_force_is_a_pressure_rise_over_a_wavelength() {
    let pushed = preset("frictionless", &["drive.body_force=-0.001"]);
    assert_eq!(pushed.drive.body_force, -0.001);
    // 203 grains of mass 1 along 100 d: 2.03 0.001 10/(pi 1.5^2).
    let expected = 0.0203 / (PI * 2.25);
    assert!((pushed.pressure_rise() - expected).abs() < 1e-15);
    let record: toml::Table = pushed.to_toml().parse().unwrap();
    assert_eq!(record["drive"]["body_force"].as_float(), Some(-0.001));
    assert_eq!(
        record["resolved"]["pressure_rise"].as_float(),
        Some(pushed.pressure_rise())
    );
    // Grains of several sizes count by their mean mass.
    let mixed = preset("frictional", &["drive.body_force=0.002"]);
    let mass = (0.8 + 1.0) * (0.64 + 1.0) / 4.0;
    let weight = mixed.grains.number as f64 * mass * 0.002;
    let rise = -weight * mixed.tube.wavelength / (mixed.tube.length() * PI * 3.5 * 3.5);
    assert!((mixed.pressure_rise() / rise - 1.0).abs() < 1e-12);
    assert!(mixed.pressure_rise() < 0.0);
    assert_eq!(preset("frictional", NO_OVERRIDES).pressure_rise(), 0.0);
}

#[test]
fn gravity_pushes_along_the_wave_as_the_body_force_does() {
    // The wave of the preset runs towards -z.
    let pushed = preset("frictionless", &["drive.body_force=-0.001"]);
    let heavy = preset("frictionless", &["body.gravity=[0.0, -0.002, 0.001]"]);
    assert_eq!(heavy.body.gravity, [0.0, -0.002, 0.001]);
    assert_eq!(heavy.axial_body_force(), -0.001);
    assert_eq!(heavy.pressure_rise(), pushed.pressure_rise());
    let turned = preset(
        "frictionless",
        &["body.gravity=[0, 0, 0.001]", "drive.direction=backward"],
    );
    assert_eq!(turned.axial_body_force(), 0.001);
    let stated = record(&heavy);
    assert!(
        stated.contains("[body]\ngravity = [0.0, -0.002, 0.001]"),
        "{stated}"
    );
    // What is not there is not stated, and a zero of either sign is the same run.
    let (plain, none) = (
        preset("frictionless", NO_OVERRIDES),
        preset("frictionless", &["body.gravity=[0.0, -0.0, 0]"]),
    );
    assert!(!plain.to_toml().contains("gravity"));
    assert_eq!(plain.run_hash(), none.run_hash());
    assert_ne!(plain.physics_hash(), heavy.physics_hash());
    assert!(!plain.has_body_force() && heavy.has_body_force());
}

#[test]
fn gravity_in_si() {
    let settings = [&BEADS[..], &["units.acceleration=[0, -9.81, 0]"]].concat();
    let earth = preset("frictionless", &settings);
    let units = earth.units.unwrap();
    let expected = -9.81 * units.time() * units.time() / units.length();
    let [x, y, z] = earth.body.gravity;
    assert!((y / expected - 1.0).abs() < 1e-14, "{y}");
    assert_eq!([x, z], [0.0; 2]);
    record(&earth);
}

#[test]
fn gravity_that_cannot_be() {
    refuses(
        "
frictionless | body.gravity=[0, -1] | body.gravity | OutOfRange | too short
frictionless | body.gravity=[0, 0, 0, 1] | body.gravity | OutOfRange | too long
frictionless | body.gravity=-0.1 | body.gravity | WrongType | not a list
frictionless | body.gravity=[0, 1e7, 0] | body.gravity[1] | OutOfRange | too large
frictionless | units.acceleration=[0, 0, -9.81] | units.acceleration | Missing | units in SI need
frictionless | units.grain_diameter=1e-3; units.density=2500; units.stiffness=1; units.acceleration=[0, 0, -9.81]; body.gravity=[0, 0, -1] | body.gravity | Conflict | exclude one another
",
    );
    // Of the units of hard grains so large that nothing could be said of them.
    let large = "units.grain_diameter=1e-3; units.density=2500; units.stiffness=1e-9; units.acceleration=[0, 1e6, 0]";
    refuses(&format!(
        "frictionless | {large} | units.acceleration | OutOfRange"
    ));
}

#[test]
fn grains_settle_under_gravity_in_a_wall_that_stands_still() {
    let settled = preset(
        "frictionless",
        &["body.gravity=[0, -0.001, 0]", "initial.state=settled"],
    );
    assert_eq!(settled.initial.axial_velocity, 0.0);
    let text = "preset = \"frictionless\"\n[initial]\nstate = \"settled\"\n";
    let weightless = only_problem(read(Some(text), None, NO_OVERRIDES));
    assert_eq!(weightless.key.as_deref(), Some("initial.state"));
    assert_eq!(weightless.labels[0].line_and_column().0, 3);
    assert!(
        weightless.message.contains("needs gravity"),
        "{weightless:?}"
    );
    let settings = ["body.gravity=[0, -0.001, 0]", "initial.state=settled"];
    let elastic = only_problem(read(None, Some("frictional"), &settings));
    assert!(elastic.message.contains("stands still"), "{elastic:?}");
    let text = "preset = \"frictionless\"\n[body]\ngravity = [0, -0.001, 0]\n[initial]\nstate = \"settled\"\ntemperature = 0.01\n";
    let hot = only_problem(read(Some(text), None, NO_OVERRIDES));
    assert_eq!(hot.key.as_deref(), Some("initial.temperature"));
    assert_eq!(hot.labels[0].line_and_column().0, 6);
}

#[test]
fn segments_and_what_is_no_cycle_of_them() {
    let segments = ["drive.waveform=segments"];
    let plain = preset("frictionless", &segments);
    let resolved = plain.drive.segments.clone().unwrap();
    assert_eq!(
        (resolved.segments, &resolved.order[..]),
        (4, &[1, 2, 3, 4][..])
    );
    assert!(record(&plain).contains("order = [1, 2, 3, 4]"));
    let same = preset("frictionless", &[segments[0], "drive.order=[1,2,3,4]"]);
    assert_eq!(same.physics_hash(), plain.physics_hash());
    for other in ["drive.order=[1,3,2,4]", "drive.duty=0.3", "drive.edge=0.1"] {
        let other = preset("frictionless", &[segments[0], other]);
        assert_ne!(other.physics_hash(), plain.physics_hash());
    }
    // Another waveform drops what belongs to segments.
    assert_eq!(preset("frictionless", NO_OVERRIDES).drive.segments, None);
    refuses(
        "
frictionless | drive.waveform=segments; drive.order=[1,2,3] | drive.order | Inconsistent | each of the 4
frictionless | drive.waveform=segments; drive.order=[1,2,3,3] | drive.order | Inconsistent | each of the 4
frictionless | drive.waveform=segments; drive.order=[0,1,2,3] | drive.order[0] | OutOfRange | too small
frictionless | drive.waveform=segments; drive.duty=0.7 | drive.duty | Inconsistent | 1.1000 periods
frictionless | drive.waveform=segments; drive.rise=0 | drive.rise | OutOfRange | too small
frictionless | drive.waveform=segments; drive.segments=8 | drive.segments | Inconsistent | two rings
frictionless | drive.waveform=segments; drive.segments=1 | drive.segments | OutOfRange | too small
frictional | drive.waveform=segments | drive.waveform | Inconsistent | under stress control
",
    );
    let text = "preset = \"frictionless\"\n[drive]\nduty = 0.3\n";
    let alone = only_problem(read(Some(text), None, NO_OVERRIDES));
    assert_eq!(alone.key.as_deref(), Some("drive.duty"));
    let said = alone.to_string();
    assert!(
        said.contains("waveform") && alone.labels[0].line_and_column().0 == 3,
        "{said}"
    );
}

#[test]
fn a_wave_from_a_table() {
    let folder = std::env::temp_dir().join(format!("peristalsis-table-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("shape.csv");
    std::fs::write(
        &file,
        // As a spreadsheet writes it, with a byte order mark.
        "\u{feff}# measured\nphase, radius\n0, 15\n0.25, 15\n0.5, 12\n0.75, 9\n",
    )
    .unwrap();
    let name = format!("drive.table={:?}", file.to_str().unwrap());
    let (waveform, lists) = (
        "drive.waveform=table",
        [
            "drive.phases=[0, 0.25, 0.5, 0.75]",
            "drive.radii=[15, 15, 12, 9]",
        ],
    );
    let read_in = preset("frictionless", &[waveform, &name]);
    let typed = preset("frictionless", &[waveform, lists[0], lists[1]]);
    // The numbers are the run's identity, and its record needs the file no more.
    assert_eq!(read_in.physics_hash(), typed.physics_hash());
    std::fs::remove_file(&file).unwrap();
    let record = Configuration::from_toml("record", &read_in.to_toml()).unwrap();
    assert_eq!(record.physics_hash(), read_in.physics_hash());
    let other = preset(
        "frictionless",
        &[waveform, lists[0], "drive.radii=[15, 15, 11, 9]"],
    );
    assert_ne!(other.physics_hash(), typed.physics_hash());
    refuses(&format!(
        "
frictionless | {waveform}; {name} | drive.table | Inconsistent | No such file
frictionless | {waveform} | drive.phases | Inconsistent | the table of the wave is missing
frictionless | {waveform}; {} | drive.phases | Inconsistent | 4 phases and 0 radii
frictionless | {waveform}; drive.phases=[0.5, 0, 0.7]; drive.radii=[1, 2, 1] | drive.phases | Inconsistent | this is no curve over a wavelength: phase 0 follows 0.5
frictionless | {} | drive.phases | Conflict | belongs to drive.waveform
",
        lists[0], lists[0]
    ));
    std::fs::write(&file, "phase,radius\n0, 15\n0.25\n").unwrap();
    let found = only_problem(read(None, Some("frictionless"), &[waveform, &name]));
    assert!(found.message.contains("line 3"), "{found:?}");
    std::fs::write(&file, "phase,radius\n0, 15\n# bad\n0.25, -15\n0.7, 9\n").unwrap();
    let found = only_problem(read(None, Some("frictionless"), &[waveform, &name]));
    assert_eq!(
        found.message, "drive.radii[1] = -15 is too small",
        "{found:?}"
    );
    let label = &found.labels[0];
    assert_eq!(*label.source_name, *file.to_string_lossy());
    assert_eq!(label.line_and_column(), (4, 7));
    // Both columns are of one file, which is named once, by its key.
    std::fs::write(&file, "phase,radius\n0, 15\n0.25, 15\n0.7, 15\n").unwrap();
    let found = only_problem(read(None, Some("frictionless"), &[waveform, &name]));
    // The file, and the waveform.
    assert_eq!(found.labels.len(), 2, "{found:?}");
    assert!(found.labels[0].message.starts_with("table = "), "{found:?}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn waveforms_by_name() {
    for (name, waveform) in [
        ("sine", WaveformName::Sine),
        ("bolus", WaveformName::Bolus),
        ("roller", WaveformName::Roller),
    ] {
        let setting = format!("drive.waveform={name}");
        assert_eq!(preset("frictional", &[&setting]).drive.waveform, waveform);
    }
}

const BEADS: [&str; 3] = [
    "units.grain_diameter=1e-3",
    "units.density=2500",
    "units.stiffness=1",
];

#[test]
fn a_frequency_in_hertz_is_a_strain_rate() {
    // t = sqrt(m/k) = 1.1441e-3 s by hand, and the frequency replaces the strain rate of the preset.
    let settings = [&BEADS[..], &["units.wave_frequency=10"]].concat();
    let beads = preset("frictionless", &settings);
    assert!((beads.drive.strain_rate - 1.1441e-2).abs() < 1e-6);
    let units = beads.units.unwrap();
    assert!((beads.drive.strain_rate / units.time() - 10.0).abs() < 1e-12);
    // The record states the strain rate, and reads back.
    let stated = record(&beads);
    assert!(!stated.contains("wave_frequency ="), "{stated}");
    let resolved: toml::Table = stated.parse().unwrap();
    let frequency = resolved["resolved"]["wave_frequency_hz"]
        .as_float()
        .unwrap();
    assert!((frequency - 10.0).abs() < 1e-12);
    // A Hertz contact takes a modulus: t = sqrt(m/(Y d)).
    let hertz = preset(
        "frictional",
        &[
            "units.grain_diameter=2e-3",
            "units.density=1000",
            "units.young_modulus=1e5",
            "units.wave_frequency=1",
        ],
    );
    let time = (PI / 6.0 * 1000.0 * 8e-9 / (1e5 * 2e-3)).sqrt();
    assert!((hertz.drive.strain_rate / time - 1.0).abs() < 1e-12);
}

#[test]
fn half_of_the_units_and_two_rates_are_refused() {
    let problem =
        |preset: &str, overrides: &[&str]| only_problem(read(None, Some(preset), overrides));
    let partial = problem("frictionless", &BEADS[..2]);
    assert_eq!(partial.kind, ProblemKind::Missing);
    assert!(partial.message.contains("units.stiffness"), "{partial:?}");
    // The stiffness goes with the law that it belongs to, and what takes its place is said.
    let text = "preset = \"frictionless\"\nunits.grain_diameter = 1e-3\nunits.density = 1e3\nunits.stiffness = 1.0\n";
    let error = read(Some(text), None, &["contact.law=hertz"])
        .expect_err("a stiffness under the Hertz law");
    let said = error.to_string();
    assert!(
        said.contains("need units.young_modulus as well")
            && said.contains("in place of units.stiffness, which is not used"),
        "{said}"
    );
    let alone = problem("frictionless", &["units.wave_frequency=1"]);
    assert_eq!(alone.key.as_deref(), Some("units.wave_frequency"));
    assert!(alone.message.contains("units.grain_diameter"), "{alone:?}");
    let other_law = problem("frictional", &BEADS);
    assert_eq!(other_law.kind, ProblemKind::Conflict);
    assert!(other_law.message.contains("contact.law"), "{other_law:?}");
    let text = "preset = \"frictionless\"\ndrive.strain_rate = 0.1\nunits.wave_frequency = 1\n\
                units.grain_diameter = 1e-3\nunits.density = 1e3\nunits.stiffness = 1.0\n";
    let error = Configuration::from_toml("two.toml", text).expect_err("two rates");
    assert_eq!(error.problems()[0].kind, ProblemKind::Conflict);
    assert!(!schema_errors(text).is_empty());
    let one_rate = text.replace("drive.strain_rate = 0.1\n", "");
    assert!(schema_errors(&one_rate).is_empty());
}

#[test]
fn the_hardest_drive_is_what_the_schedules_reach_within_the_run() {
    let schedules = "drive.schedule=[{form='ramp', parameter='width', from=3.0, to=2.0, end=20}, \
                     {form='steps', parameter='strain_rate', at=[0, 5, 50], values=[0.02, 0.1, 9.0]}]";
    let led = preset("frictionless", &["run.periods=10", schedules]);
    let hardest = led.at_its_hardest();
    assert!(hardest.drive.schedules.is_empty());
    // Half of the ramp, and the second of the steps.
    assert_eq!(hardest.drive.own(ScheduledParameter::Width), Some(2.5));
    assert_eq!(hardest.drive.strain_rate, 0.1);
    let plain = preset("frictional", NO_OVERRIDES);
    assert_eq!(plain.at_its_hardest(), plain);
    let pressed = "drive.schedule={form='ramp', from=0.002, to=0.005, end=2}";
    let hardest = preset("frictional", &[pressed]).at_its_hardest();
    let force = hardest.drive.own(ScheduledParameter::ForceAmplitude);
    assert_eq!(force, Some(0.005));
    assert_eq!(hardest.drive.own(ScheduledParameter::Width), None);
}
