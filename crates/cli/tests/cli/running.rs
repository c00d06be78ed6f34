//! `peristalsis run`: the summary, what `--set` means, and that a record runs again to the same bits.

use serde_json::Value;

use crate::{Place, read_json, warnings};

/// Glass beads of 1 mm on springs of 1 N/m.
const BEADS: &str = "units.grain_diameter=1e-3 units.density=2500 units.stiffness=1";
const TABLES: &[&str] = &["timeseries.parquet", "profile.parquet", "waves.parquet"];

#[test]
fn the_summary_alone_is_on_standard_output() {
    let place = Place::new();
    let outcome = place.does("run SMALL --out results --json run.seed=7");
    let summary = outcome.json();
    assert_eq!(summary, read_json(&place.path("results/summary.json")));
    assert_eq!(summary["grains"], 20);
    assert_eq!(summary["wall_spheres"], 12 * 14 * 2);
    assert_eq!(summary["steps"], 4 * 400);
    assert_eq!(summary["seed"], 7);
    assert_eq!(summary["escaped"], 0);
    assert_eq!(summary["status"], "complete");
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["transition_time"], Value::Null);
    assert_eq!(summary["censored"], true);
    assert!(!summary["revision"].as_str().unwrap().is_empty());
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    assert!(number("flow_rate_ratio").abs() < 1.5);
    assert!(number("flow_rate_ratio_error") >= 0.0);
    assert!(number("largest_overlap") > 0.0 && number("largest_overlap") < 1.0);
    assert!(number("energy_residual") > 0.0 && number("energy_residual") < 0.05);
    assert!(number("grain_steps_per_second") > 1e4);
    assert!((number("time") - 80.0).abs() < 1e-9);
    assert!((number("periods") - 4.0).abs() < 1e-9);
}

#[test]
fn instructions_that_the_machine_lacks_are_refused_before_a_folder_is_made() {
    let place = Place::new();
    for call in ["run SMALL --out made", "run SMALL --seeds 1,2 --out made"] {
        // Those of WebAssembly no machine has.
        let call = format!("{call} --instructions simd128");
        place.refuses(&call, &["does not have the instructions"]);
    }
    assert!(!place.path("made").exists());
}

#[test]
fn a_transition_is_a_number() {
    let place = Place::new();
    let settings = "drive.width=2.5 drive.strain_rate=0.1 tube.waves=2 run.periods=30";
    let run = format!("run --preset frictionless-fine --out results --json {settings}");
    let summary = place.does(&run).json();
    let time = summary["transition_time"].as_f64().unwrap();
    assert!(time > 20.0 && time < 200.0, "{time}");
    assert_eq!(summary["censored"], false);
    assert!(summary["flow_rate_ratio"].as_f64().unwrap() > 0.8);
}

#[test]
fn a_setting_replaces_the_alternative_of_preset_and_file() {
    let place = Place::new();
    place.write(
        "tube.toml",
        "preset = \"frictionless\"\ngrains.volume_fraction = 0.1\nrun.periods = 1\n",
    );
    for (setting, key, value) in [
        ("grains.number=12", "grains.number", 12.0),
        ("drive.amplitude=0.1", "drive.width", 2.8),
        ("drive.wave_speed=0.2", "drive.strain_rate", 0.02),
        ("run.duration=40", "run.periods", 2.0),
    ] {
        let folder = key.replace('.', "-");
        place.does(&format!("run tube.toml {setting} --out {folder}"));
        let record = std::fs::read_to_string(place.path(&folder).join("config.toml")).unwrap();
        let record: toml::Table = toml::from_str(&record).unwrap();
        let (table, name) = key.split_once('.').unwrap();
        let found = match &record[table][name] {
            toml::Value::Integer(number) => *number as f64,
            other => other.as_float().unwrap(),
        };
        assert!(
            (found - value).abs() < 1e-12,
            "{key} = {found}, not {value}"
        );
        for alternative in ["volume_fraction", "amplitude", "wave_speed", "duration"] {
            assert!(
                !record[table].as_table().unwrap().contains_key(alternative),
                "{alternative}"
            );
        }
    }
}

#[test]
fn the_record_of_a_run_runs_again_to_the_same_bits() {
    let place = Place::new();
    for (preset, settings) in [
        (
            "frictionless",
            "grains.number=20 tube.waves=2 run.periods=4 initial.state=jammed drive.wave_speed=0.7 \
             grains.diameter_min=0.9",
        ),
        (
            "frictional",
            "grains.number=50 run.periods=0.2 run.integrator=adams_bashforth run.seed=4",
        ),
    ] {
        let again = format!("{preset}-again");
        place.does(&format!("run --preset {preset} --out {preset} {settings}"));
        place.does(&format!("run {preset}/config.toml --out {again}"));
        place.assert_same([preset, &again], TABLES);
    }
}

#[test]
fn another_seed_is_another_run() {
    let place = Place::new();
    for (folder, seed) in [("one", "run.seed=1"), ("two", "run.seed=2")] {
        place.does(&format!("run SMALL --out {folder} {seed}"));
    }
    let [one, two] =
        ["one", "two"].map(|folder| read_json(&place.path(folder).join("summary.json")));
    assert_ne!(one["flow_rate_ratio"], two["flow_rate_ratio"]);
}

#[test]
fn flow_is_positive_along_the_wave_whichever_way_it_runs() {
    let place = Place::new();
    for (preset, periods) in [("frictionless", "4"), ("frictional", "0.2")] {
        for direction in ["forward", "backward"] {
            let folder = format!("{preset}-{direction}");
            let outcome = place.does(&format!(
                "run --preset {preset} --out {folder} --json initial.state=jammed grains.number=40 tube.waves=2 \
                 run.periods={periods} drive.direction={direction}"
            ));
            let ratio = outcome.json()["flow_rate_ratio"].as_f64().unwrap();
            assert!(ratio > 0.5, "{folder}: {ratio}");
        }
    }
}

#[test]
fn pumping_and_si_are_in_the_summary() {
    let place = Place::new();
    let pumping = "drive.body_force=-0.001 drive.width=2.4 initial.state=jammed";
    let run = format!("run SMALL --out results --json {pumping} {BEADS}");
    let summary = place.does(&run).json();
    let number = |pointer: &str| {
        summary
            .pointer(pointer)
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("{pointer} in {summary:#}"))
    };
    // Useful power is that of the flow against the force: -g J L, grains of mass 1 in a tube of 20 d.
    let useful = 0.001 * number("/flow_rate") * 20.0;
    assert!(
        (number("/pumping/useful_power") / useful - 1.0).abs() < 1e-6,
        "{useful}"
    );
    let efficiency = number("/pumping/useful_power") / number("/wall_power");
    assert!((number("/pumping/efficiency") - efficiency).abs() < 1e-12);
    assert!(number("/pumping/efficiency_error") >= 0.0);
    let mass = std::f64::consts::PI / 6.0 * 2500.0 * 1e-9;
    let close = |one: f64, other: f64| assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    close(
        number("/si/mass_flow_rate_kg_per_s"),
        number("/flow_rate") * mass.sqrt(),
    );
    close(number("/si/time_s"), 80.0 * mass.sqrt());
    close(
        number("/si/wall_pressure_pa"),
        1000.0 * number("/wall_pressure"),
    );
    close(
        number("/si/pressure_rise_pa"),
        20.0 * 0.001 * 10.0 / (20.0 * std::f64::consts::PI * 2.25) * 1000.0,
    );
    assert!(
        number("/wall_pressure") > 0.0
            && number("/wall_pressure_largest") >= number("/wall_pressure")
    );
}

#[test]
fn softness_that_the_run_shows_and_how_pressures_are_averaged_are_said() {
    let place = Place::new();
    let run = format!("run SMALL --out results drive.body_force=-0.01 {BEADS}");
    place
        .does(&run)
        .says(&["warning: units.stiffness: grains overlapped by up to"])
        .shows(&[
            "averaged over 1/50 of a wavelength",
            "(a Newtonian fluid without load: ",
        ]);
    let summary = read_json(&place.path("results/summary.json"));
    let found = warnings(&summary);
    let softness = "grains overlapped by up to";
    assert!(found.iter().any(|(_, it)| it.starts_with(softness)));
}

#[test]
fn an_efficiency_is_null_where_nothing_is_pumped() {
    let place = Place::new();
    let settings =
        "drive.body_force=-0.01 drive.wave_speed=0 run.duration=20 grains.number=20 tube.waves=2";
    place
        .does(&format!("run --preset frictionless --out still {settings}"))
        .shows(&["efficiency – ("]);
    place
        .does("run SMALL --out helped drive.body_force=0.01")
        .shows(&["the grains do not go against the body force"]);
    for folder in ["still", "helped"] {
        let summary = read_json(&place.path(folder).join("summary.json"));
        assert_eq!(summary["pumping"]["efficiency"], Value::Null, "{folder}");
        assert_eq!(summary["pumping"]["efficiency_error"], Value::Null);
    }
}

#[test]
fn a_wall_that_diverges_is_named_as_the_wall() {
    let place = Place::new();
    place
        .call("run --preset frictional --out results wall.drag=1e3 tube.waves=2 grains.number=100")
        .expect_code(1)
        .says(&["wall sphere ", "wall.drag", "wall.sphere_mass"]);
}
