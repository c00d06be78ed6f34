//! Whether the spheres of a prescribed wall, in a lattice or from a table, keep soft grains in.

use peristalsis_analysis::number::rounded;
use peristalsis_configuration::Configuration;
use peristalsis_physics::contact::{NormalLaw, reduced_radius};
use peristalsis_physics::wall::{Arrangement, Lattice, RadiusWave};

use super::warning::Warning;

/// Radius of a sphere that passes the wall without overlap above which grains will leak \[d\].
const LEAKING_RADIUS: f64 = 0.02;
/// Part of the energy at which the lattice gives way above which grains as fast as the wave were seen to leave the tube.
///
/// Most grains outside at the end of single runs (`validation/results`, widths from 2.4): at 0.3 of it 2 %, 0.5 6 %,
/// 0.6 15 % and 1.3 47 % on the coarse lattice, at 0.6 0.5 % and 1.4 9 % on the fine one.
const LEAKING_ENERGY: f64 = 0.6;
/// More wall spheres than this within a grain's reach let nothing through.
const DENSE: f64 = 10_000.0;

/// The warning of the wall's lattice.
pub(super) fn warning(
    configuration: &Configuration,
    wave: &RadiusWave,
    lattice: &Lattice,
) -> Option<Warning> {
    let widest = wave.belly_radius();
    let key = "tube.rings_per_wave";
    let passing = lattice.largest_passing_radius(widest);
    if passing > LEAKING_RADIUS {
        let message = format!(
            "the lattice leaks where the tube is widest (R = {widest:.2}): a sphere of radius {passing:.3} passes between \
             its spheres, and soft grains squeeze through; take more spheres per ring or more rings per wave"
        );
        return Some(Warning { key, message });
    }
    let speed = configuration.wave_speed();
    let (normal, grains) = (configuration.contact.normal, &configuration.grains);
    let parts = [grains.diameter_min, grains.diameter_max].map(|diameter| {
        let kinetic = 0.5 * diameter * diameter * diameter * speed * speed;
        kinetic / energy_to_pass(normal, lattice, widest, diameter)
    });
    let part = parts.into_iter().fold(0.0, f64::max);
    let message = format!(
        "a grain as fast as the wave has {} times the energy to pass between the wall's spheres where the tube is \
         widest: from about {LEAKING_ENERGY} times on grains escape (`escaped` counts them); take more spheres \
         per ring and more rings per wave, or a lower drive.strain_rate",
        rounded(part, 2)
    );
    (part > LEAKING_ENERGY).then_some(Warning { key, message })
}

/// That a table of wall spheres leaves a stretch of the tube without any.
pub(super) fn bare_stretch(configuration: &Configuration) -> Option<Warning> {
    let (tube, length) = (&configuration.tube, configuration.tube.length());
    if tube.arrangement != Arrangement::File {
        return None;
    }
    let mut places = tube.places.clone();
    places.sort_by(f64::total_cmp);
    // The tube is periodic: behind the last place comes the first.
    let next = places.iter().skip(1).copied();
    let next = next.chain(places.first().map(|first| first + length));
    let stretches = places.iter().copied().zip(next);
    let (from, to) =
        stretches.max_by(|one, other| (one.1 - one.0).total_cmp(&(other.1 - other.0)))?;
    let bare = to - from;
    let message = format!(
        "no wall sphere stands for {bare:.1} d from {from:.1} d on along the tube, and grains leave it there: the table must \
         cover the whole length of {length} d (tube.waves x tube.wavelength), since it is not repeated"
    );
    let passing = configuration.wall.sphere_diameter + configuration.grains.diameter_min;
    (bare > passing).then_some(Warning {
        key: "tube.places",
        message,
    })
}

/// The elastic energy of a grain whose centre is in the widest gap of the lattice: what it must have to pass.
///
/// The wall is taken as flat there, unrolled from a tube of this radius.
fn energy_to_pass(law: impl NormalLaw, lattice: &Lattice, radius: f64, diameter: f64) -> f64 {
    let chord =
        2.0 * radius * libm::sin(core::f64::consts::PI / f64::from(lattice.spheres_per_ring));
    let spacing = lattice.spacing();
    let circumradius = lattice.largest_passing_radius(radius) + 0.5 * lattice.sphere_diameter;
    let reach = 0.5 * (diameter + lattice.sphere_diameter);
    let rows = (reach / spacing).ceil() + 1.0;
    let places = (reach / chord).ceil() + 1.0;
    if 4.0 * rows * places > DENSE {
        return f64::INFINITY;
    }
    let reduced_radius = reduced_radius(diameter, lattice.sphere_diameter);
    // A ring through the base of the triangle (square), and the gap above the middle of two of its spheres.
    let height = match lattice.staggered {
        true => (spacing - circumradius).max(0.0),
        false => 0.5 * spacing,
    };
    let (rows, places) = (rows as i32, places as i32);
    let mut energy = 0.0;
    for row in -rows..=rows {
        let is_turned = row % 2 != 0 && lattice.staggered;
        let turned = if is_turned { 0.0 } else { 0.5 };
        for place in -places..=places {
            let across = (f64::from(place) + turned) * chord;
            let along = f64::from(row) * spacing - height;
            let overlap = reach - (across * across + along * along).sqrt();
            if overlap > 0.0 {
                energy += law.force(overlap, 0.0, reduced_radius).energy;
            }
        }
    }
    energy
}

#[cfg(test)]
mod tests {
    use peristalsis_physics::contact::LinearSpringDashpot;

    use super::*;
    use crate::warnings::warnings;

    fn lattice(spheres_per_ring: u32, rings_per_wave: u32) -> Lattice {
        Lattice {
            spheres_per_ring,
            rings_per_wave,
            waves: 10,
            wavelength: 10.0,
            sphere_diameter: 1.0,
            staggered: true,
        }
    }

    #[test]
    fn the_energy_to_pass_is_that_of_the_overlaps_with_the_spheres_around() {
        let law = LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: 0.1,
        };
        // The triangle of the coarse lattice at R = 1.5 holds 3/8 by three contacts, and a little by the next four.
        let coarse = energy_to_pass(law, &lattice(12, 14), 1.5, 1.0);
        let circumradius = lattice(12, 14).largest_passing_radius(1.5) + 0.5;
        let of_three = 1.5 * (1.0 - circumradius).powi(2);
        assert!(
            (coarse - of_three).abs() < 0.05 * of_three,
            "{coarse}, {of_three}"
        );
        assert!(energy_to_pass(law, &lattice(24, 26), 1.5, 1.0) > 3.0 * coarse);
        // A grain that meets nothing needs nothing; a wall without gaps lets nothing through.
        assert_eq!(energy_to_pass(law, &lattice(4, 4), 1.5, 0.01), 0.0);
        let tight = energy_to_pass(law, &lattice(1_000_000, 1_000_000), 1.5, 1.0);
        assert_eq!(tight, f64::INFINITY);
    }

    #[test]
    fn a_table_that_ends_before_the_tube_is_warned_of() {
        let bare = |waves: u32| {
            let places: Vec<String> = (0..40)
                .map(|k| format!("{:.1}", 0.5 * f64::from(k)))
                .collect();
            let angles: Vec<String> = (0..40)
                .map(|k| format!("{:.1}", 2.4 * f64::from(k)))
                .collect();
            let text = format!(
                "preset = \"frictionless\"\ntube.waves = {waves}\ntube.arrangement = \"file\"\n\
                 tube.places = [{}]\ntube.angles = [{}]\n",
                places.join(", "),
                angles.join(", ")
            );
            let configuration = Configuration::from_toml("helix.toml", &text).unwrap();
            bare_stretch(&configuration).map(|warning| warning.message)
        };
        assert_eq!(bare(2), None);
        let message = bare(10).unwrap();
        assert!(
            message.starts_with("no wall sphere stands for 80.5 d from 19.5 d on"),
            "{message}"
        );
    }

    #[test]
    fn the_lattices_are_said_to_leak_at_the_strain_rates_at_which_they_do() {
        for (preset, strain_rate, leaks) in [
            ("frictionless", 0.03, false),
            ("frictionless", 0.05, false),
            ("frictionless", 0.07, true),
            ("frictionless", 0.1, true),
            ("frictionless-fine", 0.1, false),
            ("frictionless-fine", 0.2, true),
        ] {
            let settings = [format!("drive.strain_rate={strain_rate}")];
            let configuration = Configuration::from_preset(preset, &settings).unwrap();
            let found = warnings(&configuration)
                .into_iter()
                .any(|warning| warning.message.contains("grains escape"));
            assert_eq!(found, leaks, "{preset} at {strain_rate}");
        }
    }
}
