//! Whether an elastic wall can hold together.

use peristalsis_configuration::Configuration;

use super::warning::Warning;

/// The warnings of an elastic wall: walls of its kind were seen to fail in the tube of the preset `frictional`.
pub(super) fn warnings(configuration: &Configuration) -> Vec<Warning> {
    let Some(wall) = configuration.wall.elastic else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    let mut warn = |key, message| warnings.push(Warning { key, message });
    let distances = configuration.tube.neighbour_distances();
    let nearest = distances[0].min(distances[1]);
    let tension = wall.natural_length < nearest;
    if wall.spring_stiffness == 0.0 {
        warn(
            "wall.spring_stiffness",
            "without springs the tethers alone hold the wall's spheres, and grains get out between them".to_owned(),
        );
    } else if !tension {
        warn(
            "wall.natural_length",
            format!(
                "springs of natural length {} between neighbours {nearest:.3} apart are without tension, and the network \
                 buckles at once: take about {:.2}",
                wall.natural_length,
                0.7 * nearest
            ),
        );
    } else if !wall.tethers.balance && wall.tethers.radial == 0.0 {
        warn(
            "wall.keep.balance",
            "nothing balances the tension of the springs, and the tube closes: set it to true, or give wall.keep.radial"
                .to_owned(),
        );
    }
    if wall.tethers.azimuthal == 0.0 {
        warn(
            "wall.keep.azimuthal",
            "without an azimuthal tether nothing keeps the wall's spheres from going round the tube, and the network buckles: \
             0.1 was enough"
                .to_owned(),
        );
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warnings::warnings;

    #[test]
    fn walls_that_fail_are_warned_of_by_the_key_that_makes_them_fail() {
        for (setting, expected) in [
            ("wall.spring_damping=0", None),
            ("wall.natural_length=0.9", None),
            ("wall.natural_length=1", Some("wall.natural_length")),
            ("wall.keep.balance=false", Some("wall.keep.balance")),
            ("wall.spring_stiffness=0", Some("wall.spring_stiffness")),
            ("wall.keep.azimuthal=0", Some("wall.keep.azimuthal")),
        ] {
            let configuration = Configuration::from_preset("frictional", &[setting]).unwrap();
            let found = warnings(&configuration);
            let keys = found.iter().map(|warning| warning.key);
            assert!(keys.eq(expected), "{setting}: {found:?}");
        }
    }
}
