//! The grains: their number from fraction or density.

use std::f64::consts::PI;

use super::{Context, plain};
use crate::configuration::Tube;
use crate::error::ProblemKind;
use crate::grains::Grains;
use crate::keys::{GrainsKeys, NUMBERS};
use crate::limits;

/// The grains in a given tube.
///
/// N = round(6 rho a^2 L/d^3), d^3 averaged over the diameters, or N = round(n pi a^2 L/d*^3), d* the largest one
pub(super) fn grains(keys: &GrainsKeys, tube: &Tube, context: &mut Context<'_>) -> Option<Grains> {
    let mut grains = keys.grains;
    let (least, most) = (grains.diameter_min, grains.diameter_max);
    if least > most {
        return context.refuse(
            ProblemKind::Inconsistent,
            &["grains.diameter_min", "grains.diameter_max"],
            format!(
                "grains.diameter_min = {} is above grains.diameter_max = {}",
                plain(least),
                plain(most)
            ),
            "diameters are uniform between diameter_min and diameter_max; give both (each is 1 if missing)"
                .into(),
        );
    }
    let square = tube.radius * tube.radius;
    let length = tube.length();
    let number = match (keys.volume_fraction, keys.number_density) {
        (None, None) => grains.number as f64,
        (Some(fraction), _) => {
            (6.0 * fraction * square * length / grains.mean_cubed_diameter()).round()
        }
        (None, Some(density)) => (density * PI * square * length / (most * most * most)).round(),
    };
    // Also refuses values that are infinite or NaN because a diameter cubed is 0.
    let within = number <= limits::MOST_GRAINS as f64;
    if !within {
        let key = context.written(NUMBERS);
        return context.refuse(
            ProblemKind::OutOfRange,
            &[key],
            format!(
                "{key} makes {} grains in this tube, which is beyond reach",
                plain(number)
            ),
            format!("at most {} grains", limits::MOST_GRAINS),
        );
    }
    grains.number = number as u64;
    Some(grains)
}
