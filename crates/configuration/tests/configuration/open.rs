//! Open tubes: what their keys resolve to, and what is refused.

use peristalsis_configuration::Ends;

use crate::{NO_OVERRIDES, preset, record, refuses};

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
    let record = record(&open);
    assert!(
        record.contains("ends = \"open\"") && record.contains("[inlet]"),
        "{record}"
    );
    // A periodic tube says nothing of its ends, and is the run that it was.
    let plain = preset("frictionless", NO_OVERRIDES);
    assert_eq!((plain.tube.ends, plain.inlet), (Ends::Periodic, None));
    assert!(!plain.to_toml().contains("inlet") && !plain.to_toml().contains("ends"));
    let said = preset("frictionless", &["tube.ends=periodic"]);
    assert_eq!(plain.run_hash(), said.run_hash());
    assert_ne!(plain.physics_hash(), open.physics_hash());
}

/// A pump engineer: the shorter the step, the more looks at the inlet, and the denser the filling, without end.
#[test]
fn an_inlet_fills_up_as_often_whatever_the_step() {
    let looks = |name: &str, settings: &[&str]| preset(name, settings).looks_per_feeding();
    // c = 0.2: 5 t, of looks 1, 0.5 and 0.25 t apart.
    let slow = ["tube.ends=open", "drive.strain_rate=0.02"];
    for (step, number) in [("0.05", 5), ("0.025", 10), ("0.0125", 20)] {
        let step = format!("run.time_step={step}");
        let settings: Vec<&str> = slow.iter().copied().chain([step.as_str()]).collect();
        assert_eq!(looks("frictionless", &settings), number);
    }
    assert_eq!(
        looks("frictionless", &["tube.ends=open", "drive.strain_rate=1"]),
        1
    );
    assert_eq!(looks("frictionless", NO_OVERRIDES), 1);
    // A wave that stands: 2 t.
    assert_eq!(looks("silo", NO_OVERRIDES), 1);
    assert_eq!(looks("silo", &["run.time_step=0.025"]), 4);
    assert_eq!(
        looks("silo", &["run.time_step=0.025", "inlet.feed_rate=1"]),
        1
    );
}

#[test]
fn a_feed_in_kilograms_an_hour() {
    let open = preset("silo", &["units.feed_rate=36"]);
    let (units, inlet) = (open.units.unwrap(), open.inlet.unwrap());
    let grains_a_second = inlet.feed_rate.unwrap() / units.time();
    let mass = open.mean_grain_mass() * units.mass();
    assert!((grains_a_second * mass / 0.01 - 1.0).abs() < 1e-12);
    record(&open);
}

#[test]
fn open_tubes_that_cannot_be() {
    refuses(
        "
frictional | tube.ends=open | tube.ends | Inconsistent | no ends
frictionless | inlet.head=9 | inlet.head | Conflict | tube.ends
frictionless | tube.ends=shut | tube.ends | WrongType | not
frictionless | tube.ends=open; tube.waves=1; tube.wavelength=6 | tube.wavelength | Inconsistent | above 7
frictionless | tube.ends=open; inlet.head=97 | inlet.head | Inconsistent | longer than
frictionless | tube.ends=open; inlet.head=5; inlet.length=6 | inlet.length | Inconsistent | longer than
frictionless | tube.ends=open; inlet.waiting=1000 | inlet.waiting | Inconsistent | wait outside
silo | drive.direction=backward | tube.ends | Inconsistent | no weight
silo | inlet.feed_rate=1; units.feed_rate=1 | inlet.feed_rate | Conflict | exclude one another
",
    );
}
