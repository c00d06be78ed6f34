//! Two grains that meet in the engine part with the restitution that the configuration asks for.

mod common;

use common::configuration;
use glam::DVec3;
use peristalsis_engine::{Bodies, Simulation};
use peristalsis_run::{assemble, walls};

/// e of two grains of a diameter that meet along the axis at a speed, under the laws of a preset with settings.
fn measured(preset: &str, settings: &str, diameter: f64, speed: f64) -> f64 {
    let settings = format!(
        "{settings} grains.number=0 grains.diameter_min={diameter} grains.diameter_max={diameter} \
         contact.restitution_speed={speed} run.time_step=2e-3 tube.waves=2"
    );
    let configuration = configuration(preset, &settings);
    let (empty, _) = assemble(&configuration).expect("an empty tube");
    let axis = |z: f64| DVec3::new(0.0, 0.0, z);
    let places = vec![axis(8.0), axis(8.0 + 1.001 * diameter)];
    let mut bodies = Bodies::grains_at_rest(places, vec![diameter; 2]);
    bodies.velocity = vec![axis(0.5 * speed), axis(-0.5 * speed)];
    let mut pair = Simulation::new(bodies, walls(&configuration), *empty.parameters());
    let parting = |pair: &Simulation| pair.bodies().velocity[1].z - pair.bodies().velocity[0].z;
    let apart =
        |pair: &Simulation| pair.bodies().position[1].z - pair.bodies().position[0].z > diameter;
    while parting(&pair) <= 0.0 || !apart(&pair) {
        pair.advance(100).expect("two grains do not diverge");
    }
    parting(&pair) / speed
}

#[test]
fn two_grains_part_with_the_restitution_asked_for() {
    let wide = "drive.width=3 tube.radius=1.5";
    for (preset, law) in [
        ("frictionless", ""),
        ("frictionless", "contact.law=hertz"),
        (
            "frictionless",
            "contact.law=hertz contact.dissipation_form=printed",
        ),
    ] {
        for (diameter, speed) in [(1.0, 0.1), (0.7, 0.05)] {
            for wanted in [0.3, 0.7, 0.95, 1.0] {
                let settings = format!("{wide} {law} contact.restitution={wanted}");
                let found = measured(preset, &settings, diameter, speed);
                assert!(
                    (found - wanted).abs() < 1e-3,
                    "{law} d = {diameter}, v = {speed}: {found} for {wanted}"
                );
            }
        }
    }
}
