//! The tube and its lattice.

use super::Context;
use crate::configuration::{Control, Tube};
use crate::error::ProblemKind;
use crate::limits;

/// Whether the lattice closes and its size is sane.
pub(super) fn check_lattice(tube: &Tube, control: &Control, context: &mut Context<'_>) {
    check_rings(tube, control, context);
    // Three factors below 2^20 each: no overflow in 64 bits.
    let spheres = tube.wall_spheres();
    if spheres > limits::MOST_WALL_SPHERES {
        context.refuse::<()>(
            ProblemKind::OutOfRange,
            &["tube.waves", "tube.rings_per_wave", "tube.spheres_per_ring"],
            format!("a tube of {spheres} wall spheres is beyond reach"),
            format!(
                "spheres_per_ring * rings_per_wave * waves is at most {}",
                limits::MOST_WALL_SPHERES
            ),
        );
    }
}

/// Alternate rings are turned: the pattern closes at the seam of an even number of rings.
fn check_rings(tube: &Tube, control: &Control, context: &mut Context<'_>) -> Option<()> {
    let rings = tube.rings_per_wave;
    if rings.is_multiple_of(2) {
        return Some(());
    }
    let neighbours = |number: u32| match number {
        1 => "2".to_owned(),
        number => format!("{} or {}", number - 1, number + 1),
    };
    match control {
        Control::Strain { .. } => context.refuse(
            ProblemKind::Inconsistent,
            &["tube.rings_per_wave"],
            format!(
                "tube.rings_per_wave = {rings} is odd: alternate rings are turned by half a spacing, so that a shift by one wavelength would not map the wall on itself"
            ),
            format!("take {}", neighbours(rings)),
        ),
        Control::Stress { .. } if !tube.waves.is_multiple_of(2) => context.refuse(
            ProblemKind::Inconsistent,
            &["tube.rings_per_wave", "tube.waves"],
            format!(
                "an odd number of rings a wave ({rings}) in an odd number of waves ({}): alternate rings are turned by half a spacing, and this lattice does not close at the seam",
                tube.waves
            ),
            format!(
                "take tube.waves = {}, or tube.rings_per_wave = {}",
                neighbours(tube.waves),
                neighbours(rings)
            ),
        ),
        Control::Stress { .. } => Some(()),
    }
}

/// A sphere must not meet its own periodic image, nor one partner from both sides.
pub(super) fn check_length(tube: &Tube, reach: f64, context: &mut Context<'_>) {
    let length = tube.length();
    if length > 2.0 * reach {
        return;
    }
    context.refuse::<()>(
        ProblemKind::Inconsistent,
        &["tube.wavelength", "tube.waves"],
        format!(
            "a tube that closes on itself: its length L = waves * wavelength = {length} is not above twice the reach of a contact, {}",
            2.0 * reach
        ),
        format!("more waves or a longer wavelength: L above {}", 2.0 * reach),
    );
}
