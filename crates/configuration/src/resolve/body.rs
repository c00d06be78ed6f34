//! Forces on all grains: gravity in our units.

use super::{Context, plain};
use crate::error::ProblemKind;
use crate::grains::Body;
use crate::keys::Keys;
use crate::units::Units;

/// Largest size of a component of body.gravity, which its schema states.
const LARGEST: f64 = 1e6;

/// Gravity as it is given, or from its value in SI.
pub(super) fn body(keys: &Keys, units: Option<&Units>, context: &mut Context<'_>) -> Option<Body> {
    let gravity = match (keys.units.acceleration, units) {
        (Some(gravity), Some(units)) => {
            // d t^-2 in m s^-2
            let unit = units.velocity() / units.time();
            gravity.map(|component| component / unit)
        }
        _ => keys.body.gravity,
    };
    if let Some(largest) = gravity.into_iter().find(|it| it.abs() > LARGEST) {
        return context.refuse_as(
            ProblemKind::OutOfRange,
            &["units.acceleration"],
            format!(
                "units.acceleration is {} d/t^2 in the units of this run",
                plain(largest)
            ),
            format!("at most {LARGEST:e} d/t^2: larger or harder grains have other units"),
        );
    }
    Some(Body {
        // One zero, not two.
        gravity: gravity.map(|component| component + 0.0),
    })
}
