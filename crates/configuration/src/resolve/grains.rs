//! The grains: their number from fraction or density.

use std::f64::consts::PI;

use peristalsis_physics::sizes::{SizeForm, Sizes};

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
    let mut grains = keys.grains.clone();
    sizes(&mut grains, keys.large_volume_fraction, context)?;
    let (least, most) = (grains.diameter_min, grains.diameter_max);
    if least > most {
        return context.refuse(
            &["grains.diameter_min", "grains.diameter_max"],
            format!(
                "grains.diameter_min = {} is above grains.diameter_max = {}",
                plain(least),
                plain(most)
            ),
            "diameters lie between diameter_min and diameter_max; give both (each is 1 if missing)",
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
        return context.refuse_as(
            ProblemKind::OutOfRange,
            &[key],
            format!(
                "{key} makes {} grains in this tube, which is beyond reach",
                plain(number)
            ),
            format!("at most {} grains", limits::MOST_GRAINS),
        );
    }
    let asked = keys.volume_fraction.or(keys.number_density);
    if number == 0.0 && asked.is_some_and(|asked| asked > 0.0) {
        let key = context.written(NUMBERS);
        return context.refuse_as(
            ProblemKind::OutOfRange,
            &[key, "grains.diameter_max"],
            format!("{key} is less than half a grain in this tube"),
            "take more, a longer tube (tube.waves) or smaller grains; an empty tube has grains.number = 0",
        );
    }
    grains.number = number as u64;
    Some(grains)
}

/// Checks how diameters are distributed, and puts bounds and numbers where they follow from other keys.
fn sizes(grains: &mut Grains, by_volume: Option<f64>, context: &mut Context<'_>) -> Option<()> {
    let bounds @ [least, largest] = [grains.diameter_min, grains.diameter_max];
    let no_spread = least == largest;
    let message = match grains.sizes {
        SizeForm::Uniform => return Some(()),
        SizeForm::Lognormal if grains.diameter_spread.is_none() => {
            "lognormal diameters need grains.diameter_spread"
        }
        SizeForm::Lognormal if no_spread => "lognormal diameters need two bounds that differ",
        SizeForm::Two if by_volume.or(grains.large_fraction).is_none() => {
            "two sizes need grains.large_fraction or grains.large_volume_fraction"
        }
        SizeForm::Two if no_spread => "two sizes need two diameters that differ",
        SizeForm::Table if grains.diameters.len() != grains.fractions.len() => {
            "a table of sizes needs as many grains.fractions as grains.diameters"
        }
        SizeForm::Table if !grains.fractions.iter().any(|it| *it > 0.0) => {
            return context.refuse(
                &["grains.fractions", "grains.sizes"],
                "all fractions of the table of sizes are 0",
                "a table of sizes needs a diameter with a fraction above 0",
            );
        }
        SizeForm::Lognormal => {
            let median = grains
                .diameter_median
                .get_or_insert((least * largest).sqrt());
            if (least..=largest).contains(median) {
                return Some(());
            }
            return context.refuse(
                &["grains.diameter_median"],
                format!(
                    "grains.diameter_median = {median} is not between the bounds of the diameters"
                ),
                format!("from {least} (grains.diameter_min) to {largest} (grains.diameter_max)"),
            );
        }
        SizeForm::Two => {
            let by_volume = by_volume.map(|part| Sizes::number_of_volume(bounds, part));
            grains.large_fraction = by_volume.or(grains.large_fraction);
            return Some(());
        }
        SizeForm::Table => {
            let classes = grains.diameters.iter().zip(&grains.fractions);
            let used = classes
                .filter(|(_, part)| **part > 0.0)
                .map(|(diameter, _)| *diameter);
            grains.diameter_min = used.clone().fold(f64::INFINITY, f64::min);
            grains.diameter_max = used.fold(0.0, f64::max);
            return Some(());
        }
    };
    let help = "uniform: grains.diameter_min and grains.diameter_max. lognormal: both, grains.diameter_spread and \
                grains.diameter_median. two: both and grains.large_fraction or grains.large_volume_fraction. table: grains.file, \
                or grains.diameters and grains.fractions";
    context.refuse(&["grains.sizes"], message, help)
}
