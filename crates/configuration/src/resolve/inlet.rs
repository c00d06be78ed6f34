//! The inlet of an open tube.

use peristalsis_physics::ends::{Ends, Inlet, gap};

use super::{Context, plain};
use crate::configuration::{Configuration, Control};
use crate::grains::Grains;
use crate::keys::Keys;
use crate::units::{HOUR, Units};

/// Length of the stretch where grains are put in, unless it is given, in largest diameters.
const USUAL_LENGTH: f64 = 3.0;

/// The inlet, with what follows from other keys; `Some(None)` for a periodic tube.
pub(super) fn inlet(
    keys: &Keys,
    grains: &Grains,
    units: Option<&Units>,
    context: &mut Context<'_>,
) -> Option<Option<Inlet>> {
    let tube = &keys.tube.tube;
    if tube.ends == Ends::Periodic {
        return Some(None);
    }
    if let Control::Stress { .. } = keys.drive.drive.control {
        return context.refuse(
            &["tube.ends", "drive.control"],
            "an elastic wall has no ends: its springs and its waves go round the period",
            "drive.control = \"strain\", or leave tube.ends out",
        );
    }
    let (gap, usual) = (gap(grains.diameter_max), USUAL_LENGTH * grains.diameter_max);
    let length = tube.length() - gap;
    let least = plain(gap + usual);
    if length <= usual {
        return context.refuse(
            &["tube.wavelength", "tube.waves", "tube.ends"],
            format!(
                "an open tube needs a length above {least}: {} between its ends, and {} for the inlet; waves * wavelength is {}",
                plain(gap),
                plain(usual),
                plain(tube.length())
            ),
            format!("waves * wavelength is above {least}"),
        );
    }
    let mut inlet = keys.inlet;
    if !context.given("inlet.head") {
        inlet.head = length;
    }
    if !context.given("inlet.length") {
        inlet.length = usual.min(inlet.head);
    }
    for (key, value, most, of) in [
        (
            "inlet.head",
            inlet.head,
            length,
            "the tube between its ends",
        ),
        ("inlet.length", inlet.length, inlet.head, "the head"),
    ] {
        if value > most {
            let most = plain(most);
            return context.refuse(
                &[key, "tube.wavelength", "tube.waves", "inlet.head"],
                format!("{key} = {} is longer than {of}, {most}", plain(value)),
                format!("{key} is at most {most} (waves * wavelength less {gap} between the ends)"),
            );
        }
    }
    if inlet.waiting > grains.number {
        return context.refuse(
            &["inlet.waiting", "grains.number"],
            format!(
                "{} grains wait outside, and there are {}",
                inlet.waiting, grains.number
            ),
            "grains.number counts all grains, those that wait with them",
        );
    }
    if let (Some(rate), Some(units)) = (keys.units.feed_rate, units) {
        let in_ours = rate / HOUR / units.mass_flow();
        inlet.feed_rate = Some(in_ours / grains.mean_cubed_diameter());
    }
    Some(Some(inlet))
}

/// Refuses open ends between which nothing drives the grains.
pub(super) fn check_direction(configuration: &Configuration, context: &mut Context<'_>) {
    let stands = configuration.drive.period().is_none();
    if configuration.inlet.is_some() && stands && configuration.axial_body_force() <= 0.0 {
        context.refuse::<()>(
            &["tube.ends", "body.gravity", "drive.direction", "drive.body_force"],
            "the wave stands, and no weight carries the grains to the outlet, which is the end that the wave would run to: \
             -z, or +z where drive.direction = \"backward\"",
            "give body.gravity towards that end, such as [0, 0, -0.001], or a wave that runs",
        );
    }
}
