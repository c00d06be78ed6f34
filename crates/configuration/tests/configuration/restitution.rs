//! Restitution as an input, instead of the damping of either law.

use peristalsis_configuration::{Configuration, ProblemKind};
use peristalsis_physics::contact::{Impact, NormalLaw};

use crate::{only_problem, preset, read, record, refuses, schema_errors};

/// e of two grains of a configuration that meet at a speed.
fn restitution(configuration: &Configuration, speed: f64) -> f64 {
    let grains = &configuration.grains;
    let diameter = 0.5 * (grains.diameter_min + grains.diameter_max);
    let impact = Impact::of_twins(diameter, speed);
    configuration.contact.normal.impact_restitution(impact)
}

#[test]
fn restitution_stands_for_the_damping_of_either_law() {
    for (name, law, speed) in [
        ("frictionless", "contact.law=linear", 0.5),
        ("frictional", "contact.law=hertz", 20.0 * 4.01e-3),
        (
            "frictional",
            "contact.dissipation_form=printed",
            20.0 * 4.01e-3,
        ),
    ] {
        for wanted in [0.2, 0.75, 1.0] {
            let given = format!("contact.restitution={wanted}");
            // At the speed of the wave, unless another is given.
            let found = restitution(&preset(name, &[law, &given]), speed);
            assert!((found - wanted).abs() < 1e-8, "{law} {wanted}: {found}");
            let slow = preset(name, &[law, &given, "contact.restitution_speed=0.01"]);
            let found = restitution(&slow, 0.01);
            assert!((found - wanted).abs() < 1e-8, "{law} {wanted}: {found}");
        }
    }
}

#[test]
fn what_is_resolved_is_the_damping_with_its_bits_and_its_identity() {
    for (name, key) in [
        ("frictionless", "normal_damping"),
        ("frictional", "dissipation_time"),
    ] {
        let found = preset(name, &["contact.restitution=0.6"]);
        let text = record(&found);
        assert!(
            text.contains(&format!("\n{key} = ")) && !text.contains("restitution"),
            "{text}"
        );
        let line = text.lines().find(|line| line.starts_with(key)).unwrap();
        let direct = preset(name, &[format!("contact.{}", line.replace(' ', ""))]);
        assert_eq!(direct.physics_hash(), found.physics_hash());
    }
}

#[test]
fn damping_and_restitution_together_are_refused_at_their_lines() {
    for (law, damping) in [("linear", "normal_damping"), ("hertz", "dissipation_time")] {
        let text = format!("[contact]\nlaw = \"{law}\"\n{damping} = 0.1\nrestitution = 0.9\n");
        let problem = only_problem(read(Some(&text), Some("frictionless"), crate::NO_OVERRIDES));
        assert_eq!(problem.kind, ProblemKind::Conflict);
        let places: Vec<_> = problem
            .labels
            .iter()
            .map(|label| label.line_and_column().0)
            .collect();
        assert_eq!(places, [3, 4]);
        assert!(
            problem
                .to_string()
                .contains("contact.restitution exclude one another")
        );
        assert!(!schema_errors(&text).is_empty());
    }
}

#[test]
fn a_higher_layer_replaces_one_by_the_other() {
    let file = "preset = \"frictionless\"\n[contact]\nrestitution = 0.9\nrestitution_speed = 0.1\n";
    let damped = read(Some(file), None, &["contact.normal_damping=0.25"]).unwrap();
    assert_eq!(
        damped,
        preset("frictionless", &["contact.normal_damping=0.25"])
    );
    let other = read(Some(file), None, &["contact.restitution=0.5"]).unwrap();
    assert!((restitution(&other, 0.1) - 0.5).abs() < 1e-8);
}

#[test]
fn what_no_restitution_can_be_made_of_is_refused_by_its_key() {
    let still = [
        "drive.strain_rate=0",
        "run.duration=1",
        "contact.restitution=0.9",
    ];
    // The linear law has the same at any speed.
    preset("frictionless", &still);
    refuses(
        "
frictional | drive.strain_rate=0; run.duration=1; contact.restitution=0.9 | contact.restitution | Inconsistent | contact.restitution_speed
frictionless | contact.restitution_speed=1 | contact.restitution_speed | Inconsistent | without contact.restitution
frictionless | contact.restitution=0 | contact.restitution | OutOfRange | 0.001 or more, at most 1
frictionless | contact.restitution=1.01 | contact.restitution | OutOfRange | at most 1
frictionless | contact.restitution=0.1; contact.normal_stiffness=1e12; grains.number=4; grains.diameter_max=1e5; grains.diameter_min=1e5; tube.radius=1e5; tube.wavelength=1e6; tube.waves=4 | contact.restitution | OutOfRange | contact.normal_damping
",
    );
}
