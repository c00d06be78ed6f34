//! Presets, files and overrides over one another; presets and examples against the schema.

use std::fs;
use std::path::Path;

use peristalsis_configuration::{
    Configuration, Control, InitialState, Normal, PRESETS, ScheduledParameter,
};

use crate::{NO_OVERRIDES, preset, read, schema_errors};

fn validate(name: &str, text: &str) {
    let errors = schema_errors(text);
    assert!(errors.is_empty(), "{name}: {errors:?}");
}

#[test]
fn presets_fit_the_schema_and_resolve() {
    assert!(!PRESETS.is_empty());
    for known in PRESETS {
        validate(known.name, known.text);
        let configuration = preset(known.name, NO_OVERRIDES);
        assert!(configuration.grains.number > 0);
        assert!(known.summary.ends_with('.'));
    }
}

#[test]
fn the_frictionless_preset_by_hand() {
    let coarse = preset("frictionless", NO_OVERRIDES);
    // 6 * 0.15 * 2.25 * 100 = 202.5
    assert_eq!(coarse.grains.number, 203);
    assert_eq!(coarse.tube.wall_spheres(), 12 * 14 * 10);
    assert_eq!(coarse.drive.control, Control::Strain { width: 2.75 });
    assert_eq!(coarse.amplitude(), Some(0.125));
    assert_eq!(coarse.wave_speed(), 0.5);
    assert_eq!(coarse.drive.period(), Some(20.0));
    assert_eq!(coarse.run.steps(), 16_000);
    assert_eq!(coarse.run.duration, 800.0);
    assert_eq!(coarse.contact.friction, None);
    let fine = preset("frictionless-fine", NO_OVERRIDES);
    assert_eq!(
        (fine.tube.spheres_per_ring, fine.tube.rings_per_wave),
        (24, 26)
    );
    let mut same_but_lattice = fine.clone();
    same_but_lattice.tube = coarse.tube.clone();
    assert_eq!(same_but_lattice, coarse);
}

#[test]
fn the_frictional_preset_by_hand() {
    let frictional = preset("frictional", NO_OVERRIDES);
    // 0.71 * pi * 12.25 * 40 = 1092.97
    assert_eq!(frictional.grains.number, 1093);
    assert_eq!(frictional.tube.wall_spheres(), 1012);
    let friction = frictional.contact.friction.unwrap();
    assert_eq!(
        (friction.static_friction, friction.kinetic_friction),
        (0.5, 0.4)
    );
    let force = frictional.drive.own(ScheduledParameter::ForceAmplitude);
    assert_eq!(force, Some(0.004));
    // The preset writes out what holds where nothing is written.
    assert_eq!(frictional.wall.elastic, Some(Default::default()));
    assert_eq!(frictional.initial.state, InitialState::Jammed);
    assert!((frictional.initial.axial_velocity - 0.0802).abs() < 1e-15);
    // The bonds of the settled lattice are 0.996 and 1.003 long.
    assert!((frictional.tube.mean_neighbour_distance() - 1.0004).abs() < 1e-3);
    // The largest step not above 0.05 that divides a twentieth of the period 249.4.
    assert!(frictional.run.time_step <= 0.05 && frictional.run.time_step > 0.0498);
    let step = frictional.run.time_step * frictional.run.steps_per_sample as f64 * 20.0;
    assert!((step - 1.0 / 4.01e-3).abs() < 1e-9);
}

#[test]
fn examples_fit_the_schema_and_resolve() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).unwrap();
        validate(&name, &text);
        let configuration = Configuration::from_toml(&name, &text)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let record = configuration.to_toml();
        validate(&name, &record);
        names.push(name);
    }
    for name in [
        "wide-tube",
        "jammed-start",
        "denser-grains",
        "frictional-elastic-tube",
    ] {
        assert!(names.contains(&format!("{name}.toml")), "{name}");
    }
}

#[test]
fn the_force_of_the_frictional_example_grows_from_nothing() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/frictional-elastic-tube.toml");
    let text = fs::read_to_string(path).unwrap();
    let configuration = Configuration::from_toml("example", &text).unwrap();
    let [ramp] = configuration.drive.schedules.as_slice() else {
        panic!("one schedule")
    };
    assert_eq!(ramp.parameter, ScheduledParameter::ForceAmplitude);
    assert_eq!(ramp.knots(), [(0.0, 0.0), (2.0, 0.002)]);
}

#[test]
fn every_law_runs_in_every_tube() {
    let linear = preset("frictional", &["contact.law=linear"]);
    assert_eq!(linear.contact.normal, Normal::Linear(Default::default()));
    assert!(linear.contact.friction.is_some());
    let hertz = preset("frictionless", &["contact.law=hertz"]);
    assert_eq!(hertz.contact.normal, Normal::Hertz(Default::default()));
    let rubbing = preset(
        "frictionless",
        &[
            "contact.static_friction=0.5",
            "contact.kinetic_friction=0.4",
        ],
    );
    assert_eq!(rubbing.contact.friction.unwrap().tangential_stiffness, 1.0);
    let elastic = preset(
        "frictionless",
        &["drive.control=stress", "drive.force_amplitude=0.004"],
    );
    let bond = elastic.tube.mean_neighbour_distance();
    let network = elastic.wall.elastic.unwrap();
    assert_eq!(network.natural_length, 0.7 * bond);
    assert!((bond - 0.78).abs() < 0.05, "{bond}");
    let prescribed = preset(
        "frictional",
        &[
            "drive.control=strain",
            "drive.width=5",
            "tube.rings_per_wave=24",
        ],
    );
    assert_eq!(prescribed.drive.control, Control::Strain { width: 5.0 });
    let smooth = preset(
        "frictional",
        &["contact.static_friction=0", "contact.kinetic_friction=0"],
    );
    assert_eq!(smooth.contact.friction, None);
    // One of the two frictions is enough, also over a record of a frictionless run.
    let one = preset("frictionless", &["contact.static_friction=0.3"]);
    assert_eq!(one.contact.friction.unwrap().kinetic_friction, 0.3);
    let record = preset("frictionless", NO_OVERRIDES).to_toml();
    let over = read(Some(&record), None, &["contact.static_friction=0.3"]);
    assert_eq!(over.unwrap().contact, one.contact);
}

#[test]
fn a_layer_replaces_the_choice_of_the_one_below() {
    let counted = preset("frictionless", &["grains.number=7"]);
    assert_eq!(counted.grains.number, 7);
    let dense = preset("frictionless", &["grains.number_density=0.71"]);
    // 0.71 * pi * 2.25 * 100 = 501.9
    assert_eq!(dense.grains.number, 502);
    let narrow = preset(
        "frictionless",
        &["drive.amplitude=0.25", "drive.wave_speed=1.0"],
    );
    assert_eq!(narrow.drive.control, Control::Strain { width: 2.5 });
    assert_eq!(narrow.drive.strain_rate, 0.1);
    let short = preset("frictionless", &["run.duration=100"]);
    assert_eq!(short.run.periods, Some(5.0));
    let last = preset("frictionless", &["drive.width=2.5", "drive.width=2.6"]);
    assert_eq!(last.drive.control, Control::Strain { width: 2.6 });
    let file = "preset = \"frictionless\"\n[drive]\namplitude = 0.2\n";
    let over = read(Some(file), None, &["drive.width=2.9"]).unwrap();
    assert_eq!(over.drive.control, Control::Strain { width: 2.9 });
}

#[test]
fn volume_fraction_counts_the_mean_cube_of_the_diameters() {
    let mixed = preset("frictionless", &["grains.diameter_min=0.8"]);
    // <d^3> = (1.8)(1.64)/4 = 0.738; 202.5/0.738 = 274.39
    assert_eq!(mixed.grains.number, 274);
    assert!((mixed.volume_fraction() - 0.15).abs() < 3e-4);
    // <d^6> = (1 - 0.8^7)/(7 0.2) = 0.564489: over <d^3>^2, less 1, 0.0364369.
    let scatter = mixed.volume_fraction_scatter().unwrap();
    assert!((scatter / mixed.volume_fraction() - (0.036_436_9_f64 / 274.0).sqrt()).abs() < 1e-7);
    assert_eq!(
        preset("frictionless", &[""; 0]).volume_fraction_scatter(),
        None
    );
}

#[test]
fn schedules_as_tables() {
    let table =
        "drive.schedule={form='ramp', parameter='amplitude', from=0.0, to=0.25, start=1, end=11}";
    let ramp = preset("frictionless", &[table]);
    assert_eq!(ramp.drive.schedules[0].parameter, ScheduledParameter::Width);
    assert_eq!(ramp.drive.schedules[0].knots(), [(1.0, 3.0), (11.0, 2.5)]);
    let parts = ["drive.schedule.form=ramp", "drive.schedule.end=3"];
    assert_eq!(
        preset("frictionless", &parts).drive.schedules[0].knots(),
        [(0.0, 3.0), (3.0, 2.75)]
    );
    let list = "drive.schedule=[{form='steps', parameter='wave_speed', at=[10], values=[1.0]}, {form='ramp', end=2}]";
    let both = preset("frictionless", &[list]);
    assert_eq!(both.drive.schedules.len(), 2);
    assert_eq!(both.drive.schedules[0].parameter, ScheduledParameter::Width);
    assert_eq!(both.drive.schedules[0].knots(), [(0.0, 3.0), (2.0, 2.75)]);
    assert_eq!(
        both.drive.schedules[1].parameter,
        ScheduledParameter::StrainRate
    );
    assert_eq!(both.drive.schedules[1].value(9.0), 0.05);
    assert_eq!(both.drive.schedules[1].value(10.0), 0.1);
}

#[test]
fn the_initial_velocity_follows_the_wave_unless_given() {
    let jammed = preset("frictionless", &["initial.state=jammed"]);
    assert_eq!(jammed.initial.axial_velocity, 0.5);
    let given = preset("frictionless", &["initial.axial_velocity=-0.25"]);
    assert_eq!(given.initial.axial_velocity, -0.25);
    let record = jammed.to_toml();
    let faster = read(Some(&record), None, &["drive.strain_rate=0.1"]).unwrap();
    assert_eq!(faster.initial.axial_velocity, 1.0);
}
