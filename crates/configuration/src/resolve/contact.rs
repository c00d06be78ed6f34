//! The contact of two spheres: friction, rolling resistance and cohesion.

use peristalsis_physics::contact::{Cohesion, ContactModel, Normal, NormalLaw, PullOff};

use super::{Context, plain};
use crate::error::ProblemKind;
use crate::keys::{ContactKeys, Keys};
use crate::units::Units;

/// The contact of the keys, without cohesion.
pub(super) fn contact(keys: ContactKeys, context: &mut Context<'_>) -> Option<ContactModel> {
    let (normal, mut friction) = (keys.normal, keys.friction);
    // Of the two coefficients one stands for both.
    if !context.given("contact.static_friction") {
        friction.static_friction = friction.kinetic_friction;
    } else if !context.given("contact.kinetic_friction") {
        friction.kinetic_friction = friction.static_friction;
    }
    let (kinetic_friction, static_friction) = (friction.kinetic_friction, friction.static_friction);
    if kinetic_friction > static_friction {
        let keys = ["contact.kinetic_friction", "contact.static_friction"];
        let message = format!(
            "{} = {kinetic_friction} is above {} = {static_friction}",
            keys[0], keys[1]
        );
        let help = format!(
            "kinetic friction is at most the static one: set contact.kinetic_friction to at most {static_friction} (both to 0 for frictionless grains)"
        );
        return context.refuse(&keys, message, help);
    }
    let friction = (static_friction > 0.0).then_some(friction);
    let rolling = (keys.rolling.rolling_friction > 0.0).then_some(keys.rolling);
    if friction.is_none() && rolling.is_some() {
        return context.refuse(
            &["contact.rolling_friction", "contact.static_friction"],
            "contact.rolling_friction needs friction: frictionless grains do not rotate",
            "give contact.static_friction, or contact.rolling_friction = 0",
        );
    }
    Some(ContactModel {
        normal,
        friction,
        rolling,
        cohesion: None,
    })
}

const COHESION_FORCE: &str = "contact.cohesion_force";
const SURFACE_ENERGY: &str = "contact.surface_energy";
/// Least surface energy over the stiffness of a contact. Necks of JKR contacts are about this to the power 2/3 long in d: next
/// to places along a tube, numbers do not resolve them, and powers of them come to 0.
const LEAST_SURFACE_ENERGY: f64 = 1e-20;

/// The same contact with the cohesion of its keys or of those in SI; refuses what no law has.
pub(super) fn with_cohesion(
    contact: ContactModel,
    keys: &Keys,
    units: Option<&Units>,
    context: &mut Context<'_>,
) -> Option<ContactModel> {
    let mut cohesion = keys.contact.cohesion;
    if let (Some(force), Some(units)) = (keys.units.cohesion_force, units) {
        cohesion.cohesion_force = force / units.force();
    }
    if let (Some(energy), Some(units)) = (keys.units.surface_energy, units) {
        // m t^-2 in J m^-2
        cohesion.surface_energy = energy * units.length() / units.force();
    }
    let Cohesion {
        cohesion_force,
        cohesion_range,
        surface_energy,
        pull_off,
    } = cohesion;
    let keys = [
        SURFACE_ENERGY,
        "units.surface_energy",
        COHESION_FORCE,
        "units.cohesion_force",
    ];
    if surface_energy > 0.0 && cohesion_force > 0.0 {
        let message = "linear cohesion and JKR cohesion are both given".to_owned();
        let help =
            format!("keep one of {COHESION_FORCE} and {SURFACE_ENERGY}, and set the other to 0");
        return context.refuse(&keys, message, help);
    }
    if surface_energy > 0.0 && !matches!(contact.normal, Normal::Hertz(_)) {
        let keys = [SURFACE_ENERGY, "units.surface_energy", "contact.law"];
        let message = format!("{SURFACE_ENERGY} gives JKR cohesion, which goes with the Hertz law");
        let help = format!("contact.law = \"hertz\", or {COHESION_FORCE} for any law");
        return context.refuse(&keys, message, help);
    }
    let least = LEAST_SURFACE_ENERGY * contact.normal.stiffness(1.0, 1.0);
    if surface_energy > 0.0 && surface_energy < least {
        let (keys, shown) = (&keys[..2], plain(surface_energy));
        let message = format!(
            "{SURFACE_ENERGY} = {shown} m/t^2 is next to none beside the stiffness of the grains: the necks of such contacts are too \
             short for numbers"
        );
        let help = format!("0, or at least {} m/t^2", plain(least));
        return context.refuse_as(ProblemKind::OutOfRange, keys, message, help);
    }
    if cohesion_range > 0.0 && cohesion_force == 0.0 {
        let keys = ["contact.cohesion_range"];
        let message =
            format!("contact.cohesion_range is the reach of {COHESION_FORCE}, which is 0");
        let help = format!("give {COHESION_FORCE}, or leave contact.cohesion_range out");
        return context.refuse(&keys, message, help);
    }
    if pull_off != PullOff::default() && surface_energy == 0.0 {
        let keys = ["contact.pull_off"];
        let message =
            format!("contact.pull_off says where a JKR contact breaks, and {SURFACE_ENERGY} is 0");
        let help = format!("give {SURFACE_ENERGY}, or leave contact.pull_off out");
        return context.refuse(&keys, message, help);
    }
    Some(ContactModel {
        cohesion: cohesion.given(),
        ..contact
    })
}
