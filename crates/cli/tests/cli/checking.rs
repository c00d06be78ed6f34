//! `peristalsis check`: the numbers of what would run, and warnings where they are due.

use std::f64::consts::PI;

use serde_json::Value;

use crate::{Place, warnings};

/// What `check --json` with these words answers.
fn check(words: &str) -> Value {
    let place = Place::new();
    let outcome = place.does(&format!("check --json {words}"));
    assert!(place.inventory().is_empty());
    outcome.json()
}

/// The keys of the warnings besides what a trial saw.
fn warned(estimate: &Value) -> Vec<&str> {
    let keys = warnings(estimate).into_iter().filter_map(|(key, message)| {
        assert!(!message.is_empty());
        (!message.starts_with("in a short trial")).then_some(key)
    });
    keys.collect()
}

#[track_caller]
fn close(value: &Value, expected: f64) {
    let value = value.as_f64().unwrap();
    assert!(
        (value / expected - 1.0).abs() < 1e-12,
        "{value} is not {expected}"
    );
}

#[test]
fn the_numbers_are_those_of_the_tube() {
    let estimate = check("--preset frictionless");
    // N = round(6 * 0.15 * 1.5^2 * 100) = round(202.5)
    assert_eq!(estimate["grains"], 203);
    assert_eq!(estimate["wall_spheres"], 12 * 14 * 10);
    close(&estimate["volume_fraction"], 203.0 / (6.0 * 2.25 * 100.0));
    close(&estimate["number_density"], 203.0 / (PI * 2.25 * 100.0));
    close(&estimate["length"], 100.0);
    close(&estimate["period"], 20.0);
    close(&estimate["periods"], 40.0);
    close(&estimate["duration"], 800.0);
    close(&estimate["time_step"], 0.05);
    assert_eq!(estimate["steps"], 16_000);
    // Two grains of mass 1 on a spring of stiffness 1: half a period is pi/sqrt(2).
    close(&estimate["contact_time"], PI / 2.0_f64.sqrt());
    // phi = 1 - 2.75/3 = 1/12, J/Jmax = phi^2 (16 - phi^2)/(2 (2 + 3 phi^2) (1 + phi^2/2))
    let square = 1.0 / 144.0;
    let fluid = square * (16.0 - square) / (2.0 * (2.0 + 3.0 * square) * (1.0 + 0.5 * square));
    close(&estimate["newtonian_flow_rate_ratio"], fluid);
    assert!(estimate["expected_seconds"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_numbers_of_the_elastic_tube() {
    let estimate = check("--preset frictional");
    assert_eq!(estimate["grains"], 1093);
    assert_eq!(estimate["wall_spheres"], 22 * 23 * 2);
    close(&estimate["number_density"], 1093.0 / (PI * 12.25 * 40.0));
    close(&estimate["period"], 1.0 / 4.01e-3);
    assert_eq!(estimate["newtonian_flow_rate_ratio"], Value::Null);
}

#[test]
fn a_person_reads_the_same_numbers() {
    let outcome = Place::new().does("check --preset frictionless").shows(&[
        "203",
        "1680 spheres",
        "40 periods of 20 t",
        "expected time",
    ]);
    assert_eq!(outcome.stderr, "");
}

#[test]
fn presets_and_examples_give_no_warning() {
    for preset in [
        "frictionless",
        "frictionless-source",
        "frictionless-fine",
        "frictional",
    ] {
        assert!(
            warned(&check(&format!("--preset {preset}"))).is_empty(),
            "{preset}"
        );
    }
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    for entry in std::fs::read_dir(examples).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let estimate = check(path.to_str().unwrap());
            assert!(warned(&estimate).is_empty(), "{}", path.display());
        }
    }
}

#[test]
fn each_warning_comes_when_it_is_due_and_alone() {
    // A contact lasts 2.22, a fifteenth of it is 0.148; a run of 20 samples per period halves steps of 0.3 and 0.25. The fine
    // lattice stays tight also where the wave opens the tube wide.
    for (preset, doubtful, nearly, key) in [
        (
            "frictionless",
            "run.time_step=0.2",
            "run.time_step=0.125",
            "run.time_step",
        ),
        (
            "frictionless",
            "tube.rings_per_wave=10 observe.profile_bins=10",
            "tube.rings_per_wave=16",
            "tube.rings_per_wave",
        ),
        (
            "frictionless-fine",
            "grains.number=5 drive.width=0.99",
            "grains.number=5 drive.width=1.01",
            "drive.width",
        ),
    ] {
        let with = |settings: &str| check(&format!("--preset {preset} {settings}"));
        assert_eq!(warned(&with(doubtful)), [key]);
        assert!(warned(&with(nearly)).is_empty(), "{nearly}");
    }
}

#[test]
fn a_step_so_long_that_the_trial_diverges_is_a_warning_not_a_failure() {
    let estimate = check("--preset frictionless run.time_step=1");
    assert!(warned(&estimate).contains(&"run.time_step"));
    assert_eq!(estimate["steps"], 800);
}

#[test]
fn a_run_repeats_the_warnings() {
    let place = Place::new();
    place
        .does("run SMALL --out results run.time_step=0.2")
        .says(&["warning: run.time_step", "too long for a contact"]);
}

#[test]
fn a_static_wave_has_no_period() {
    let estimate = check("--preset frictionless drive.strain_rate=0 run.duration=50");
    assert_eq!(estimate["period"], Value::Null);
    close(&estimate["duration"], 50.0);
    assert_eq!(estimate["steps"], 1000);
}

/// Glass beads of 1 mm on springs of 1 N/m: m = 1.309e-6 kg, t = 1.1441 ms.
const BEADS: &str = "units.grain_diameter=1e-3 units.density=2500 units.stiffness=1";

#[test]
fn units_in_si_are_told_and_the_words_say_them_too() {
    let mass = PI / 6.0 * 2500.0 * 1e-9;
    let time = mass.sqrt();
    let words = format!("--preset frictionless drive.body_force=-0.002 {BEADS}");
    let si = &check(&words)["si"];
    close(&si["unit_mass_kg"], mass);
    close(&si["unit_time_s"], time);
    close(&si["unit_pressure_pa"], 1000.0);
    close(&si["wave_frequency_hz"], 0.05 / time);
    close(&si["wave_speed_m_per_s"], 0.5e-3 / time);
    close(&si["duration_s"], 800.0 * time);
    // Jmax = N c/L
    close(
        &si["largest_mass_flow_rate_kg_per_s"],
        2.03 * 0.5 * mass / time,
    );
    close(&si["body_force_m_per_s2"], -0.002 * 1e-3 / (time * time));
    close(
        &si["pressure_rise_pa"],
        203.0 * 0.002 * 10.0 / (100.0 * PI * 2.25) * 1000.0,
    );
    let told = Place::new().does(&format!("check {words}"));
    told.shows(&["in SI", "Pa"]);
    assert_eq!(check("--preset frictionless")["si"], Value::Null);
}

#[test]
fn unphysical_softness_is_warned_of_with_what_to_do() {
    let message = |settings: &str| {
        let estimate = check(&format!("--preset frictionless {settings}{BEADS}"));
        warnings(&estimate)
            .into_iter()
            .filter(|(key, _)| *key == "units.stiffness")
            .map(|(_, message)| message.to_owned())
            .find(|message| !message.contains("in a short trial"))
    };
    // c = 0.5: xi = 0.5/sqrt(2), far above a tenth; k (0.3536/0.1)^2 = 12.5 N/m would do at 43.70 Hz, and 12.56 at 43.8.
    let soft = message("").unwrap();
    for part in [
        "35 %",
        "12.6 N/m",
        "units.wave_frequency = 43.8",
        "drive.strain_rate = 0.0141",
    ] {
        assert!(soft.contains(part), "{part} is not in {soft}");
    }
    // c = 0.1: xi = 0.0707.
    assert_eq!(message("drive.strain_rate=0.01 "), None);
    // A thousandth of a Hertz: 1e3/(1.144e-3 0.05) steps, and xi = 1.144e-6 10/sqrt(2) d: (8.0901e-6/0.01)^2 = 6.545e-7
    // N/m.
    let slow = "units.wave_frequency=1e-3 observe.samples_per_period=100000 grains.number=5 ";
    let hard = message(slow).unwrap();
    assert!(
        hard.contains("1.7e7 steps") && hard.contains("6.55e-7 N/m"),
        "{hard}"
    );
}

#[test]
fn a_schedule_is_warned_of_for_what_it_leads_to() {
    let doubtful = "
frictionless-fine drive.schedule={form='ramp',from=2.75,to=0.99,end=2} grains.number=5 | drive.schedule | closes on itself
frictionless-fine drive.schedule={form='ramp',parameter='strain_rate',from=0.05,to=0.2,end=2} | tube.rings_per_wave | as fast as the wave
frictional drive.schedule={form='ramp',from=0.004,to=50,end=2} tube.waves=2 | run.time_step | diverged
frictionless drive.schedule=ramp drive.ramp_periods=100 run.periods=10 | drive.schedule | until 100 periods, and the run ends after 10
";
    for line in doubtful.trim().lines() {
        let cells: Vec<&str> = line.split(" | ").collect();
        let [words, key, part] = cells[..] else {
            panic!("{line}")
        };
        let estimate = check(&format!("--preset {words}"));
        let found = warnings(&estimate);
        let is_found = found
            .iter()
            .any(|(of, message)| *of == key && message.contains(part));
        assert!(is_found, "{words}: {found:?}");
    }
}

/// A pump engineer: of an open tube the flow "at most" was that along all of its waves, less than all grains inside can have.
#[test]
fn the_largest_flow_of_an_open_tube_is_that_between_its_ends() {
    let si = &check(&format!("--preset frictionless tube.ends=open {BEADS}"))["si"];
    let mass = PI / 6.0 * 2500.0 * 1e-9;
    let expected = 203.0 / 96.0 * 0.5 * mass / mass.sqrt();
    close(&si["largest_mass_flow_rate_kg_per_s"], expected);
}

/// A pump engineer: grains of the Hertz law were said to have the restitution 1 in a silo, "at the speed of the wave".
#[test]
fn a_static_wave_has_no_speed_that_a_restitution_holds_at() {
    let silo = "check --preset silo run.duration=1";
    Place::new()
        .does(silo)
        .shows(&["0.970 of two grains that meet at any speed"]);
    let hertz = "contact.law=hertz units.young_modulus=1e6 contact.restitution_speed=0.01";
    let told = Place::new().does(&format!("{silo} {hertz}"));
    assert!(!told.stdout.contains("restitution"), "{}", told.stdout);
    let json = check(&format!("--preset silo run.duration=1 {hertz}"));
    assert_eq!(json["restitution"], Value::Null);
}

#[test]
fn the_fastest_wave_of_a_schedule_is_the_one_in_si() {
    let led = "drive.schedule={form='ramp',parameter='strain_rate',from=0.01,to=0.1,end=4}";
    let si = &check(&format!("--preset frictionless {led} {BEADS}"))["si"];
    let time = (PI / 6.0 * 2500.0 * 1e-9).sqrt();
    close(&si["wave_frequency_hz"], 0.05 / time);
    close(&si["fastest_wave_frequency_hz"], 0.1 / time);
    // Jmax = N c/L with c = 1.
    close(&si["largest_mass_flow_rate_kg_per_s"], 2.03 * time);
    close(&si["overlap_at_wave_speed"], 0.5_f64.sqrt());
}

#[test]
fn small_numbers_in_si_keep_their_digits() {
    let slow = "check --preset frictionless drive.strain_rate=1e-6 run.periods=1 run.time_step=1";
    let units = "units.grain_diameter=1e-3 units.density=2500 units.stiffness=1e-4";
    let told = Place::new().does(&format!("{slow} {units}"));
    // 1e-6/(0.11441 s)
    told.shows(&["a wave of 8.740e-6 Hz"]);
}

#[test]
fn a_tube_that_is_overfilled_is_warned_of_by_the_overlaps_that_a_trial_shows() {
    let settings = "grains.volume_fraction=0.5 drive.strain_rate=0.001 tube.waves=2";
    let estimate = check(&format!("--preset frictionless {settings} {BEADS}"));
    let found = warnings(&estimate);
    let is_packed = |(key, message): &(&str, &str)| {
        *key == "grains.volume_fraction"
            && message.starts_with("in a short trial the grains already overlap by up to")
    };
    assert!(found.iter().any(is_packed), "{found:?}");
}
