//! Open tubes: what their keys resolve to, and what is refused.

use peristalsis_configuration::{Configuration, Ends, ProblemKind};

use crate::{NO_OVERRIDES, only_problem, preset, read};

#[test]
fn an_open_tube_has_an_inlet_that_fills_it() {
    let open = preset("frictionless", &["tube.ends=open", "inlet.waiting=3"]);
    let inlet = open.inlet.unwrap();
    // 100 d less the gap of 4 largest diameters.
    assert_eq!((inlet.head, inlet.length), (96.0, 3.0));
    assert_eq!(
        (inlet.feed_rate, inlet.velocity, inlet.waiting),
        (None, 0.0, 3)
    );
    let record = open.to_toml();
    assert!(
        record.contains("ends = \"open\"") && record.contains("[inlet]"),
        "{record}"
    );
    assert_eq!(Configuration::from_toml("record", &record).unwrap(), open);
    // A periodic tube says nothing of its ends, and is the run that it was.
    let plain = preset("frictionless", NO_OVERRIDES);
    assert_eq!((plain.tube.ends, plain.inlet), (Ends::Periodic, None));
    assert!(!plain.to_toml().contains("inlet") && !plain.to_toml().contains("ends"));
    let said = preset("frictionless", &["tube.ends=periodic"]);
    assert_eq!(plain.run_hash(), said.run_hash());
    assert_ne!(plain.physics_hash(), open.physics_hash());
}

#[test]
fn a_feed_in_kilograms_an_hour() {
    let open = preset("silo", &["units.feed_rate=36"]);
    let (units, inlet) = (open.units.unwrap(), open.inlet.unwrap());
    let grains_a_second = inlet.feed_rate.unwrap() / units.time();
    let mass = open.mean_grain_mass() * units.mass();
    assert!((grains_a_second * mass / 0.01 - 1.0).abs() < 1e-12);
    let again = Configuration::from_toml("record", &open.to_toml()).unwrap();
    assert_eq!(again, open);
}

#[test]
fn open_tubes_that_cannot_be() {
    let cases: [(&str, &[&str], &str, &str); 9] = [
        ("frictional", &["tube.ends=open"], "tube.ends", "no ends"),
        ("frictionless", &["inlet.head=9"], "inlet.head", "tube.ends"),
        ("frictionless", &["tube.ends=shut"], "tube.ends", "not"),
        (
            "frictionless",
            &["tube.ends=open", "tube.waves=1", "tube.wavelength=6"],
            "tube.wavelength",
            "above 7",
        ),
        (
            "frictionless",
            &["tube.ends=open", "inlet.head=97"],
            "inlet.head",
            "longer than",
        ),
        (
            "frictionless",
            &["tube.ends=open", "inlet.head=5", "inlet.length=6"],
            "inlet.length",
            "longer than",
        ),
        (
            "frictionless",
            &["tube.ends=open", "inlet.waiting=1000"],
            "inlet.waiting",
            "wait outside",
        ),
        (
            "silo",
            &["drive.direction=backward"],
            "tube.ends",
            "no weight",
        ),
        (
            "silo",
            &["inlet.feed_rate=1", "units.feed_rate=1"],
            "inlet.feed_rate",
            "exclude one another",
        ),
    ];
    for (preset, settings, key, message) in cases {
        let found = only_problem(read(None, Some(preset), settings));
        assert_eq!(found.key.as_deref(), Some(key), "{found:?}");
        let text = format!("{} {:?}", found.message, found.help);
        assert!(text.contains(message), "{found:?}");
    }
    let found = only_problem(read(None, Some("frictional"), &["tube.ends=open"]));
    assert_eq!(found.kind, ProblemKind::Inconsistent);
}
