//! The damping of the contacts: as given, or from the restitution of an impact.

use peristalsis_physics::contact::{ContactModel, Impact, NormalLaw};

use super::{Context, schema_of};
use crate::configuration::Drive;
use crate::error::ProblemKind;
use crate::grains::Grains;
use crate::keys::{Keys, RESTITUTION};

const SPEED: &str = "contact.restitution_speed";

/// Contacts with the damping of contact.restitution, where that is given.
pub(super) fn damped(
    contact: ContactModel,
    keys: &Keys,
    grains: &Grains,
    drive: &Drive,
    context: &mut Context<'_>,
) -> Option<ContactModel> {
    let Some(restitution) = keys.contact.restitution else {
        if context.given(SPEED) {
            let message = format!("{SPEED} is given without {RESTITUTION}");
            let help = format!("give {RESTITUTION} as well, or leave {SPEED} out");
            return context.refuse(&[SPEED], message, help);
        }
        return Some(contact);
    };
    let wave_speed = drive.strain_rate * keys.tube.tube.wavelength;
    let speed = keys.contact.restitution_speed.unwrap_or(wave_speed);
    let diameter = grains.distribution().mean(1);
    let normal = contact
        .normal
        .with_restitution(restitution, Impact::of_twins(diameter, speed));
    let (key, damping) = normal.damping();
    if damping.is_nan() && speed == 0.0 {
        let message = format!("{RESTITUTION} holds at the speed of the wave, which stands still");
        let help = format!("give the speed of the impact that is meant as {SPEED}");
        return context.refuse(&[RESTITUTION], message, help);
    }
    let most = schema_of(key)["maximum"].as_f64();
    // Also false where extreme values come to no number.
    if !most.is_some_and(|most| damping <= most) {
        let message = format!("{RESTITUTION} = {restitution} asks for {key} = {damping:e}");
        let help = format!("{key} is at most {:e}", most.unwrap_or(f64::INFINITY));
        return context.refuse_as(ProblemKind::OutOfRange, &[RESTITUTION], message, help);
    }
    Some(ContactModel { normal, ..contact })
}
