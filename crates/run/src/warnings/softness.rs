//! Whether grains as soft, or as hard, as the units in SI make them can be what was meant.

use peristalsis_analysis::number::significant;
use peristalsis_configuration::{
    Body, Configuration, Control, Elasticity, ScheduledParameter, Units, elasticity_key,
};
use peristalsis_physics::contact::{Impact, NormalLaw, reduced_radius};

use super::warning::Warning;

/// Overlap over diameter up to which a soft sphere passes for a solid grain.
pub(super) const LARGEST_OVERLAP: f64 = 0.1;
/// Overlap over diameter below which the flow of hard grains hardly depends on their stiffness.
const SMALL_OVERLAP: f64 = 0.01;
/// Steps of a wave period that are beyond what one waits for.
const MOST_STEPS_PER_PERIOD: f64 = 1e6;

/// Overlap over diameter of two of the largest grains that meet at the speed c of the wave, without damping.
///
/// The kinetic energy of the relative motion, (m/2) c^2/2, is stored at the turning point.
pub fn overlap_at_wave_speed(configuration: &Configuration) -> f64 {
    let diameter = configuration.grains.diameter_max;
    let impact = Impact::of_twins(diameter, configuration.wave_speed());
    configuration.contact.normal.impact_overlap(impact) / diameter
}

/// Warnings about grains that are too soft for the fastest wave, with units in SI.
///
/// Advice keeps the wave's frequency: without `units.wave_frequency` the wave in SI follows the elasticity, so that the
/// overlap, which is a function of the strain rate alone, and the steps of a period would stay as they are.
pub(super) fn warning(configuration: &Configuration, units: &Units) -> Option<Warning> {
    let hardest = configuration.at_its_hardest();
    let overlap = overlap_at_wave_speed(&hardest);
    let material = Material::of(units);
    let (key, value, name) = (material.key, material.value, material.name);
    let (unit, per_speed) = (material.unit, material.per_speed);
    let strain_rate = hardest.drive.strain_rate;
    // A schedule's strain rates follow the elasticity in any case.
    let led = configuration.drive.schedule(ScheduledParameter::StrainRate);
    let is_led = led.is_some();
    // The advice must hold as printed, with three digits: so the frequency is rounded up.
    let frequency = three_digits(strain_rate / units.time(), f64::ceil);
    let faster = frequency * units.time() / strain_rate;
    // xi ~ (k^(-1/2) c) under the linear law, (Y^(-1/2) c)^(4/5) under the Hertz law.
    let value_for =
        |wanted: f64| value * libm::pow(overlap / wanted, 2.0 / per_speed) * faster * faster;
    if overlap > LARGEST_OVERLAP {
        let speed = hardest.wave_speed() * units.velocity();
        let slower = libm::pow(LARGEST_OVERLAP / overlap, 1.0 / per_speed) * strain_rate;
        let slower = significant(three_digits(slower, f64::floor), 3);
        let harder = three_digits(value_for(LARGEST_OVERLAP), f64::ceil);
        let what = if is_led {
            format!("strain rates of {slower} or less in drive.schedule")
        } else {
            format!(
                "drive.strain_rate = {slower} or less; or a {name} of {} {unit} or more together with units.wave_frequency = {} \
                 (without it a larger {name} makes the wave faster, and the overlap stays){}",
                significant(harder, 3),
                significant(frequency, 3),
                scaled_with(configuration, name, Some(value / harder))
            )
        };
        let message = format!(
            "two grains that meet at the wave's speed, {} m/s, overlap by {:.0} % of a diameter, which no solid grain does: for at \
                 most {:.0} % take {what}",
            significant(speed, 4),
            100.0 * overlap,
            100.0 * LARGEST_OVERLAP,
        );
        return Some(Warning { key, message });
    }
    let steps = configuration.drive.period()? / configuration.run.time_step;
    if steps > MOST_STEPS_PER_PERIOD && overlap < SMALL_OVERLAP && !is_led {
        let of_load = value * load(&hardest) / force_at(&hardest, SMALL_OVERLAP);
        let softer = three_digits(value_for(SMALL_OVERLAP).max(of_load), f64::ceil);
        // What parts grains that cohere takes more energy where they are softer: they would stick.
        if softer >= value || configuration.contact.cohesion.is_some() {
            return None;
        }
        // The unit of time grows as elasticity^(-1/2).
        let fewer = steps * (softer / value).sqrt();
        let message = format!(
            "at this {name} a period of the wave takes {} steps. The flow of hard grains hardly depends on their {name} while \
                 overlaps stay small: {} {unit}, with units.wave_frequency = {}, still keeps those of grains that meet at the \
                 wave's speed, or bear weight and back pressure, at {:.0} % of a diameter, and takes {} steps per period \
                 (check with a harder run){}",
            significant(steps, 2),
            significant(softer, 3),
            significant(frequency, 3),
            100.0 * SMALL_OVERLAP,
            significant(fewer, 2),
            scaled_with(configuration, name, Some(value / softer))
        );
        return Some(Warning { key, message });
    }
    None
}

/// Force on a grain of the largest under what bears on it: the pressure rise over a wavelength along the tube, and a column
/// of grains as high as the tube is wide across it.
fn load(configuration: &Configuration) -> f64 {
    let [x, y, _] = configuration.body.gravity;
    let diameter = configuration.grains.diameter_max;
    let column = 2.0 * configuration.tube.radius / diameter;
    let weight = diameter * diameter * diameter * x.hypot(y);
    configuration.pressure_rise().abs() * diameter * diameter + weight * column
}

/// Force between two of the largest grains at rest that overlap by a part of their diameter.
fn force_at(configuration: &Configuration, overlap: f64) -> f64 {
    let diameter = configuration.grains.diameter_max;
    let radius = reduced_radius(diameter, diameter);
    let law = &configuration.contact.normal;
    law.force(overlap * diameter, 0.0, radius).force
}

/// The elasticity of the grains that the units give.
pub(super) struct Material {
    pub(super) key: &'static str,
    /// In SI.
    value: f64,
    pub(super) name: &'static str,
    unit: &'static str,
    /// Power with which the overlap grows with the speed.
    per_speed: f64,
}

impl Material {
    pub(super) fn of(units: &Units) -> Self {
        let (name, unit, per_speed) = match units.elasticity {
            Elasticity::Stiffness(_) => ("stiffness", "N/m", 1.0),
            Elasticity::YoungModulus(_) => ("modulus", "Pa", 0.8),
        };
        Self {
            key: elasticity_key(units.elasticity),
            value: units.elasticity.value(),
            name,
            unit,
            per_speed,
        }
    }
}

/// Says that forces and rates in our units are others in SI when the elasticity changes; nothing without such. `factor` is the
/// elasticity over the new one, where that is known.
pub(super) fn scaled_with(
    configuration: &Configuration,
    name: &str,
    factor: Option<f64>,
) -> String {
    let (mut keys, mut rates) = (Vec::new(), Vec::new());
    if configuration.body != Body::default() {
        keys.push("body.gravity (unless units.acceleration gives it)");
    }
    if configuration.drive.body_force != 0.0 {
        keys.push("drive.body_force");
    }
    if let Control::Stress { .. } = configuration.drive.control {
        keys.push("drive.force_amplitude");
    }
    let is_led = |parameter| configuration.drive.schedule(parameter).is_some();
    if is_led(ScheduledParameter::ForceAmplitude) {
        keys.push("force amplitudes of drive.schedule");
    }
    if let Some(wall) = configuration.wall.elastic {
        keys.extend(["wall.spring_stiffness", "the tethers of wall.keep"]);
        rates.extend((wall.drag != 0.0).then_some("wall.drag"));
        rates.extend((wall.spring_damping != 0.0).then_some("wall.spring_damping"));
    }
    if configuration.initial.temperature != 0.0 {
        keys.push("initial.temperature");
    }
    let begins_at = configuration.initial.axial_velocity;
    if begins_at != configuration.natural_axial_velocity(configuration.initial_wave_speed()) {
        rates.push("initial.axial_velocity");
    }
    match configuration.contact.cohesion.map(|it| it.surface_energy) {
        Some(energy) if energy > 0.0 => {
            keys.push("contact.surface_energy (unless units.surface_energy gives it)");
        }
        Some(_) => keys.push("contact.cohesion_force (unless units.cohesion_force gives it)"),
        None => {}
    }
    if let Some(inlet) = configuration.inlet {
        rates.push("inlet.velocity");
        rates.extend(inlet.feed_rate.map(|_| "inlet.feed_rate"));
    }
    if is_led(ScheduledParameter::StrainRate) {
        rates.push("strain rates of drive.schedule");
    }
    let by = |keys: &[&str], power: f64, of: &str| {
        let factor = factor.map(|factor| significant(libm::pow(factor, power), 4));
        let factor = factor.unwrap_or_else(|| format!("{of}the old value over the new"));
        (!keys.is_empty()).then(|| format!("{} by {factor}", keys.join(", ")))
    };
    let parts = [by(&keys, 1.0, ""), by(&rates, 0.5, "the root of ")];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() {
        return String::new();
    }
    format!(
        ". With that {name} multiply {}, so that they stay the same in SI",
        parts.join(", and ")
    )
}

/// A positive number with three significant digits, as `towards` rounds whole numbers.
fn three_digits(value: f64, towards: fn(f64) -> f64) -> f64 {
    let unit = libm::pow(10.0, value.log10().floor() - 2.0);
    let digits = towards(value / unit);
    // A neighbour by rounding of the quotient alone is the number itself.
    let nearest = (value / unit).round();
    let near = (value / unit - nearest).abs() < 1e-9 * nearest;
    (if near { nearest } else { digits }) * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warnings::warnings;

    fn configuration(preset: &str, settings: &str) -> Configuration {
        let words: Vec<&str> = settings.split_whitespace().collect();
        Configuration::from_preset(preset, &words).unwrap()
    }

    fn said(preset: &str, settings: &str) -> Option<String> {
        warnings(&configuration(preset, settings))
            .into_iter()
            .find(|warning| warning.key.starts_with("units."))
            .map(|warning| warning.message)
    }

    /// The number that follows `words` in a text.
    fn number_after(text: &str, words: &str) -> String {
        let (_, rest) = text.split_once(words).unwrap_or_else(|| panic!("{text}"));
        rest.split([' ', ',', ';']).next().unwrap().to_owned()
    }

    #[test]
    fn who_follows_the_advice_is_rid_of_the_warning() {
        for (preset, key, value, words) in [
            ("frictional", "units.young_modulus", "1e6", "modulus of "),
            ("frictionless", "units.stiffness", "1", "stiffness of "),
        ] {
            let beads = format!("units.grain_diameter=2e-3 units.density=1200 {key}={value}");
            let soft = said(preset, &beads).expect(preset);
            let strain_rate = number_after(&soft, "drive.strain_rate = ");
            let slow = format!("{beads} drive.strain_rate={strain_rate}");
            assert_eq!(said(preset, &slow), None);
            let harder = number_after(&soft, words);
            let frequency = number_after(&soft, "units.wave_frequency = ");
            let hard = format!("{beads} {key}={harder} units.wave_frequency={frequency}");
            assert_eq!(said(preset, &hard), None);
            // Hardly harder than needed.
            let overlap = overlap_at_wave_speed(&configuration(preset, &hard));
            assert!(overlap > 0.98 * LARGEST_OVERLAP, "{overlap}");
        }
        assert_eq!(three_digits(0.1, f64::floor), 0.1);
        assert!((three_digits(2.8567e6, f64::ceil) - 2.86e6).abs() < 1.0);
    }

    #[test]
    fn a_softer_modulus_takes_the_forces_of_the_drive_with_it() {
        let glass = "units.grain_diameter=1e-3 units.density=2500 units.young_modulus=6e10 units.wave_frequency=1 \
                     drive.force_amplitude=1e-9 grains.number=2";
        let said = said("frictional", glass).unwrap();
        let softer: f64 = number_after(&said, "overlaps stay small: ")
            .parse()
            .unwrap();
        let factor: f64 = number_after(&said, "wall.keep by ").parse().unwrap();
        assert!((factor * softer / 6e10 - 1.0).abs() < 1e-3, "{said}");
        assert!(said.contains("drive.force_amplitude"), "{said}");
    }

    /// A newcomer with a powder: who followed the advice had grains that stuck, and a hundredth of the flow.
    #[test]
    fn grains_that_cohere_are_not_advised_to_be_softer() {
        let hard = "units.grain_diameter=1e-3 units.density=2500 units.stiffness=1e9 units.wave_frequency=1";
        assert!(said("frictionless", hard).is_some());
        assert_eq!(
            said(
                "frictionless",
                &format!("{hard} contact.cohesion_force=1e-9")
            ),
            None
        );
    }

    #[test]
    fn what_is_per_time_changes_with_the_root() {
        let open = "tube.ends=open inlet.feed_rate=0.1 inlet.waiting=5";
        let open = scaled_with(
            &configuration("frictionless", open),
            "stiffness",
            Some(0.25),
        );
        let expected = ". With that stiffness multiply inlet.velocity, inlet.feed_rate by 0.5000, so that they stay the same in SI";
        assert_eq!(open, expected);
        let elastic = "wall.drag=0.01 wall.spring_damping=0.01 initial.axial_velocity=0.01";
        let elastic = scaled_with(&configuration("frictional", elastic), "modulus", Some(0.25));
        let rates = "and wall.drag, wall.spring_damping, initial.axial_velocity by 0.5000";
        assert!(elastic.contains(rates), "{elastic}");
    }

    #[test]
    fn the_fastest_wave_of_a_schedule_counts() {
        let beads =
            "units.grain_diameter=1e-3 units.density=2500 units.stiffness=1 drive.strain_rate=0.01";
        assert_eq!(said("frictionless", beads), None);
        let course = "{form='ramp',parameter='strain_rate',from=0.01,to=0.05,end=10}";
        let led = format!("{beads} drive.schedule={course}");
        let said = said("frictionless", &led).unwrap();
        assert!(
            said.contains("35 %") && said.contains("drive.schedule"),
            "{said}"
        );
    }
}
