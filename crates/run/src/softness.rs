//! Whether grains as soft, or as hard, as the units in SI make them can be what was meant.

use peristalsis_configuration::{Configuration, Elasticity, NormalLaw, Units};

use crate::estimate::Warning;

/// Overlap over diameter up to which a soft sphere passes for a solid grain.
const LARGEST_OVERLAP: f64 = 0.1;
/// Overlap over diameter below which the flow of hard grains hardly depends on their stiffness.
const SMALL_OVERLAP: f64 = 0.01;
/// Steps of a wave period that are beyond what one waits for.
const MOST_STEPS_PER_PERIOD: f64 = 1e6;

/// Overlap over diameter of two of the largest grains that meet at the speed c of the wave, without damping.
///
/// The kinetic energy of the relative motion, (m/2) c^2/2, is stored at the turning point: xi = c (m/(2 k))^(1/2) under
/// the linear law; xi = (5 m c^2/(8 K))^(2/5), K = 2 Y R^(1/2)/(3 (1 - nu^2)), R = d/4, under the Hertz law.
pub(crate) fn overlap_at_wave_speed(configuration: &Configuration) -> f64 {
    let diameter = configuration.grains.diameter_max;
    let mass = diameter * diameter * diameter;
    let speed = configuration.wave_speed();
    let overlap = match configuration.contact.normal {
        NormalLaw::Linear {
            normal_stiffness, ..
        } => speed * (0.5 * mass / normal_stiffness).sqrt(),
        NormalLaw::Hertz {
            young_modulus,
            poisson_ratio,
            ..
        } => {
            let stiffness = 2.0 * young_modulus * (0.25 * diameter).sqrt()
                / (3.0 * (1.0 - poisson_ratio * poisson_ratio));
            libm::pow(0.625 * mass * speed * speed / stiffness, 0.4)
        }
    };
    overlap / diameter
}

/// What looks doubtful in the softness that units in SI make.
pub(crate) fn warning(configuration: &Configuration, units: &Units) -> Option<Warning> {
    let overlap = overlap_at_wave_speed(configuration);
    let (key, elasticity, name, unit) = match units.elasticity {
        Elasticity::Stiffness { stiffness, .. } => {
            ("units.stiffness", stiffness, "stiffness", "N/m")
        }
        Elasticity::YoungModulus { young_modulus, .. } => {
            ("units.young_modulus", young_modulus, "modulus", "Pa")
        }
    };
    // How the overlap falls with elasticity and grows with speed: xi ~ k^(-1/2) c, xi ~ Y^(-2/5) c^(4/5).
    let (per_elasticity, per_speed) = match units.elasticity {
        Elasticity::Stiffness { .. } => (0.5, 1.0),
        Elasticity::YoungModulus { .. } => (0.4, 0.8),
    };
    let elasticity_for =
        |wanted: f64| elasticity * libm::pow(overlap / wanted, 1.0 / per_elasticity);
    let frequency = configuration.drive.strain_rate / units.time();
    let speed = configuration.wave_speed() * units.velocity();
    if overlap > LARGEST_OVERLAP {
        return Some(Warning {
            key,
            message: format!(
                "two grains that meet at the wave's speed, {speed:.3e} m/s, overlap by {:.0} % of a diameter, which no solid \
                 grain does: take a {name} of {:.2e} {unit} or more, or a wave of {:.2e} Hz or less, for at most {:.0} %",
                100.0 * overlap,
                elasticity_for(LARGEST_OVERLAP),
                frequency * libm::pow(LARGEST_OVERLAP / overlap, 1.0 / per_speed),
                100.0 * LARGEST_OVERLAP,
            ),
        });
    }
    let steps = configuration.drive.period()? / configuration.run.time_step;
    if steps > MOST_STEPS_PER_PERIOD && overlap < SMALL_OVERLAP {
        let softer = elasticity_for(SMALL_OVERLAP);
        // The unit of time grows as elasticity^(-1/2).
        let fewer = steps * (softer / elasticity).sqrt();
        return Some(Warning {
            key,
            message: format!(
                "at this {name} a period of the wave takes {steps:.1e} steps. The flow of hard grains hardly depends on \
                 their {name} while overlaps stay small: {softer:.2e} {unit} still keeps that of two grains that meet at the \
                 wave's speed at {:.0} % of a diameter, and takes {fewer:.1e} steps a period (check with a harder run)",
                100.0 * SMALL_OVERLAP,
            ),
        });
    }
    None
}
