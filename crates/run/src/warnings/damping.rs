//! Dashpots that are too strong for the step.

use peristalsis_configuration::{Configuration, Control};
use peristalsis_physics::contact::{Normal, NormalLaw};

use super::{USUAL_OVERLAP, Warning, span};

/// 1/m of grains in a crowd over that of two. Measured: with a step of 0.05 normal_damping = 3 holds in the preset
/// frictionless, and energy grows at 4.
const CROWD: f64 = 3.0;
/// 1/m of slip over 1/m of the approach of two solid spheres: 1 + 5/2, since slip turns them as well.
const SLIP: f64 = 3.5;
/// 1/m of rolling over that, of equal spheres: 2 R_ij^2/I with R_ij = d/4 and I = m d^2/10.
const ROLLING: f64 = 0.625;
/// 1/m of the fastest motion of a lattice over 1/m of a sphere. Six springs that are alike would give 6. Measured: with a
/// step of 0.05 the wall of the preset frictional holds at 0.2, and gains energy at 0.3; 8 lies between.
const LATTICE: f64 = 8.0;

/// Each dashpot that takes its whole velocity in a step, by rough measure: h eta/m > 1 for its own mass m. The step brings
/// velocities forward explicitly, and with such a dashpot they grow.
pub(super) fn warnings(configuration: &Configuration) -> Vec<Warning> {
    let step = configuration.run.time_step;
    let too_strong = dashpots(configuration).into_iter();
    let too_strong = too_strong.filter(|(_, damping, per_mass)| step * damping * per_mass > 1.0);
    let warning = |(key, damping, per_mass): (&'static str, f64, f64)| {
        let time = 1.0 / (damping * per_mass);
        let message = format!(
            "its damping stops a motion within {}, too fast for a step of {}, and energy can grow of itself: \
             take a shorter run.time_step or less damping",
            span(time),
            span(step)
        );
        Warning { key, message }
    };
    too_strong.map(warning).collect()
}

/// Key, damping and 1/m of each dashpot.
fn dashpots(configuration: &Configuration) -> Vec<(&'static str, f64, f64)> {
    let model = configuration.contact;
    let diameter = configuration.grains.diameter_min;
    let grain = diameter * diameter * diameter;
    let network = configuration.wall.elastic;
    let per_mass = match (configuration.drive.control, network) {
        (Control::Stress { .. }, Some(wall)) => 1.0 / grain + 1.0 / grain.min(wall.sphere_mass),
        _ => 2.0 / grain,
    };
    let (key, _) = model.normal.damping();
    let mut found = vec![(
        key,
        normal_damping(model.normal, diameter),
        CROWD * per_mass,
    )];
    if let Some(friction) = model.friction {
        let damping = friction.tangential_damping;
        found.push(("contact.tangential_damping", damping, SLIP * per_mass));
    }
    if let Some(rolling) = model.rolling {
        let damping = rolling.rolling_damping;
        found.push(("contact.rolling_damping", damping, ROLLING * per_mass));
    }
    if let Some(wall) = network {
        let of_spring = LATTICE / wall.sphere_mass;
        found.push(("wall.spring_damping", wall.spring_damping, of_spring));
        found.push(("wall.drag", wall.drag, 1.0 / wall.sphere_mass));
    }
    found
}

/// What the normal force gains with the speed of an approach at the usual overlap.
fn normal_damping(normal: Normal, diameter: f64) -> f64 {
    let at = |speed: f64| {
        let (overlap, radius) = (USUAL_OVERLAP * diameter, 0.25 * diameter);
        normal.force(overlap, -speed, radius).force
    };
    at(1.0) - at(0.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use peristalsis_configuration::PRESETS;

    use super::*;

    #[test]
    fn only_a_dashpot_that_stops_a_motion_within_a_step_is_warned_of() {
        let keys = |preset: &str, settings: &str| {
            let settings: Vec<&str> = settings.split_whitespace().collect();
            let configuration = Configuration::from_preset(preset, &settings).unwrap();
            let found = warnings(&configuration).into_iter().map(|it| it.key);
            found.collect::<Vec<_>>()
        };
        for preset in PRESETS {
            assert_eq!(keys(preset.name, ""), [""; 0], "{}", preset.name);
        }
        for (preset, settings, key) in [
            (
                "frictionless",
                "contact.normal_damping=4",
                "contact.normal_damping",
            ),
            (
                "frictionless",
                "contact.static_friction=0.5 contact.tangential_damping=3",
                "contact.tangential_damping",
            ),
            (
                "frictionless",
                "contact.static_friction=0.5 contact.rolling_friction=0.2 contact.rolling_damping=20",
                "contact.rolling_damping",
            ),
            (
                "frictional",
                "wall.spring_damping=0.3",
                "wall.spring_damping",
            ),
            ("frictional", "wall.drag=10", "wall.drag"),
        ] {
            assert_eq!(keys(preset, settings), [key], "{settings}");
        }
        // Fifty times as many steps.
        assert_eq!(
            keys("frictional", "wall.drag=10 run.time_step=0.001"),
            [""; 0]
        );
    }
}
