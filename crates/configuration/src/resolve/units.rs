//! The units in SI.

use peristalsis_physics::contact::{ContactModel, Elasticity, NormalLaw};

use super::Context;
use crate::document;
use crate::error::ProblemKind;
use crate::keys::UnitsKeys;
use crate::units::{self, Units};

/// Keys that make units, with the contact's elasticity.
const NEEDED: [&str; 2] = ["units.grain_diameter", "units.density"];

/// The units in SI, if any are given; `None` where some of what they need is missing, which is then reported.
pub(super) fn units(
    keys: &UnitsKeys,
    contact: &ContactModel,
    context: &mut Context<'_>,
) -> Option<Option<Units>> {
    let of_contact = contact.normal.elasticity();
    let stiffness = keys.stiffness.map(Elasticity::Stiffness);
    let young_modulus = keys.young_modulus.map(Elasticity::YoungModulus);
    let (elasticity, other) = match of_contact {
        Elasticity::Stiffness(_) => (stiffness, "units.young_modulus"),
        Elasticity::YoungModulus(_) => (young_modulus, "units.stiffness"),
    };
    if let (Some(grain_diameter), Some(density), Some(elasticity)) =
        (keys.grain_diameter, keys.density, elasticity)
    {
        return Some(Some(Units {
            grain_diameter,
            density,
            elasticity,
            contact_elasticity: of_contact.value(),
        }));
    }
    if *keys == UnitsKeys::default() {
        return Some(None);
    }
    let elastic_key = units::elasticity_key(of_contact);
    let needed = [NEEDED[0], NEEDED[1], elastic_key];
    let given = |key: &&str| context.given(key);
    let missing: Vec<&str> = needed.into_iter().filter(|key| !given(key)).collect();
    // The other law's key may have been given below the choice of this law, and was dropped.
    let instead = if missing == [elastic_key] {
        let law = document::text(context.table, "contact.law").unwrap_or_default();
        format!(": contact.law = \"{law}\" takes it in place of {other}, which is not used there")
    } else {
        String::new()
    };
    let mut keys = needed.into_iter().chain([
        "units.wave_frequency",
        "units.acceleration",
        "units.cohesion_force",
        "units.surface_energy",
        "units.feed_rate",
    ]);
    let blamed = keys.find(given).unwrap_or(NEEDED[0]);
    context.refuse_as(
        ProblemKind::Missing,
        &[blamed],
        format!("units in SI need {} as well{instead}", missing.join(" and ")),
        "length, mass and time follow from units.grain_diameter (m), units.density (kg/m^3) and units.stiffness (N/m; \
         contact.law = \"linear\") or units.young_modulus (Pa; \"hertz\"): give all three",
    )
}
