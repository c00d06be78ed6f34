//! The units in SI, and the strain rate that a frequency in Hz is.

use super::Context;
use crate::configuration::{Contact, NormalLaw};
use crate::error::ProblemKind;
use crate::keys::UnitsKeys;
use crate::units::{Elasticity, Units};

/// Keys that make units, the contact's elasticity by its law.
const NEEDED: [&str; 2] = ["units.grain_diameter", "units.density"];

/// The units in SI, if any are given; `None` where some of what they need is missing, which is then reported.
pub(super) fn units(
    keys: &UnitsKeys,
    contact: &Contact,
    context: &mut Context<'_>,
) -> Option<Option<Units>> {
    let (elastic_key, elasticity) = match contact.normal {
        NormalLaw::Linear {
            normal_stiffness, ..
        } => (
            "units.stiffness",
            keys.stiffness.map(|stiffness| Elasticity::Stiffness {
                stiffness,
                normal_stiffness,
            }),
        ),
        NormalLaw::Hertz { young_modulus, .. } => (
            "units.young_modulus",
            keys.young_modulus.map(|value| Elasticity::YoungModulus {
                young_modulus: value,
                modulus: young_modulus,
            }),
        ),
    };
    if let (Some(grain_diameter), Some(density), Some(elasticity)) =
        (keys.grain_diameter, keys.density, elasticity)
    {
        let units = Units {
            grain_diameter,
            density,
            elasticity,
        };
        return Some(Some(units));
    }
    if *keys == UnitsKeys::default() {
        return Some(None);
    }
    let needed = [NEEDED[0], NEEDED[1], elastic_key];
    let given = |key: &&str| context.origin(key).is_some();
    let missing: Vec<&str> = needed.into_iter().filter(|key| !given(key)).collect();
    // The other law's key may have been given below the choice of this law, and was dropped.
    let instead = if missing == [elastic_key] {
        match contact.normal {
            NormalLaw::Linear { .. } => {
                ": contact.law = \"linear\" takes it in place of units.young_modulus, which is not used there"
            }
            NormalLaw::Hertz { .. } => {
                ": contact.law = \"hertz\" takes it in place of units.stiffness, which is not used there"
            }
        }
    } else {
        ""
    };
    let mut keys = needed.into_iter().chain(["units.wave_frequency"]);
    let blamed = keys.find(given).unwrap_or(NEEDED[0]);
    context.refuse(
        ProblemKind::Missing,
        &[blamed],
        format!("units in SI need {} as well{instead}", missing.join(" and ")),
        "length, mass and time follow from units.grain_diameter (m), units.density (kg/m^3) and units.stiffness (N/m; \
         contact.law = \"linear\") or units.young_modulus (Pa; \"hertz\"): give all three"
            .into(),
    );
    None
}

/// c/lambda \[t^-1\] of a wave of `frequency` \[Hz\].
pub(super) fn strain_rate(frequency: f64, units: &Units) -> f64 {
    frequency * units.time()
}
