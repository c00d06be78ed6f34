//! The tube and its lattice.

use peristalsis_physics::wall::Arrangement;

use super::{Context, plain, spheres};
use crate::configuration::{Control, Tube};
use crate::document::{self, Item, Node, Table};
use crate::error::ProblemKind;
use crate::grains::Grains;
use crate::keys::RINGS;
use crate::limits;

/// Whether the lattice closes and its size is sane.
pub(super) fn check_lattice(tube: &Tube, control: &Control, context: &mut Context<'_>) {
    if let Control::Stress { .. } = control
        && tube.arrangement != Arrangement::Staggered
    {
        let keys = ["tube.arrangement"];
        let message = "tube.arrangement is \"staggered\" under stress control: an elastic wall is a net of springs between staggered rings".to_owned();
        let help = "leave tube.arrangement out, or take drive.control = \"strain\"".to_owned();
        context.refuse::<()>(&keys, message, help);
    }
    if tube.arrangement == Arrangement::Staggered {
        check_rings(tube, control, context);
    }
    if tube.arrangement == Arrangement::File {
        spheres::check(tube, context);
    }
    // Three factors below 2^20 each: no overflow in 64 bits.
    let (spheres, most) = (tube.wall_spheres(), limits::MOST_WALL_SPHERES);
    if spheres > most {
        let keys = ["tube.waves", "tube.rings_per_wave", "tube.spheres_per_ring"];
        let message = format!("a tube of {spheres} wall spheres is beyond reach");
        let help = format!("spheres_per_ring * rings_per_wave * waves is at most {most}");
        context.refuse_as::<()>(ProblemKind::OutOfRange, &keys, message, help);
    }
}

/// A tube in which no grain fits: one whose lengths were given in metres as a rule.
pub(super) fn check_radius(tube: &Tube, grains: &Grains, context: &mut Context<'_>) -> Option<()> {
    let diameters = grains.diameters.iter().copied();
    let (radius, least) = (tube.radius, diameters.fold(grains.diameter_min, f64::min));
    if radius >= 0.5 * least {
        return Some(());
    }
    let (radius, least) = (plain(radius), plain(least));
    context.refuse(
        &["tube.radius", "grains.diameter_min"],
        format!(
            "tube.radius = {radius} is less than half the smallest grain, {least}: no grain fits into the tube"
        ),
        "lengths of the tube, the drive and the grains are in units of d, a grain of diameter 1, also where units.grain_diameter \
         gives d in metres: a radius of 7 mm with grains of 2 mm is tube.radius = 3.5",
    )
}

/// Notes that a smooth wall has no rings of spheres.
pub(super) fn without_rings(table: &mut Table) {
    let Some(origin) = document::entry(table, "tube.arrangement").map(|it| it.item.origin.clone())
    else {
        return;
    };
    for key in RINGS {
        let item = Item {
            origin: origin.clone(),
            node: Node::Integer(0),
        };
        document::merge(table, document::setting(key, &origin, item));
    }
}

/// Spheres have a size; only the surface of a smooth wall may lie in its radius.
pub(super) fn check_sphere_diameter(tube: &Tube, diameter: f64, context: &mut Context<'_>) {
    if diameter > 0.0 || tube.arrangement == Arrangement::Smooth {
        return;
    }
    context.refuse_as::<()>(
        ProblemKind::OutOfRange,
        &["wall.sphere_diameter", "tube.arrangement"],
        "wall.sphere_diameter = 0: a wall of spheres needs spheres",
        "a number above 0, or tube.arrangement = \"smooth\"",
    );
}

/// Alternate rings are turned: the pattern closes at the seam of an even number of rings.
fn check_rings(tube: &Tube, control: &Control, context: &mut Context<'_>) {
    let (rings, waves) = (tube.rings_per_wave, tube.waves);
    let neighbours = |number: u32| match number {
        1 => "2".to_owned(),
        number => format!("{} or {}", number - 1, number + 1),
    };
    let keys = ["tube.rings_per_wave", "tube.waves"];
    let (keys, message, help) = match control {
        _ if rings.is_multiple_of(2) => return,
        Control::Strain { .. } => (
            &keys[..1],
            format!(
                "tube.rings_per_wave = {rings} is odd: alternate rings are turned by half a spacing, so that a shift by one wavelength would not map the wall on itself"
            ),
            format!("take {}", neighbours(rings)),
        ),
        Control::Stress { .. } if waves.is_multiple_of(2) => return,
        Control::Stress { .. } => {
            let [rings_help, waves_help] = [rings, waves].map(neighbours);
            (
                &keys[..],
                format!(
                    "an odd number of rings per wave ({rings}) in an odd number of waves ({waves}): alternate rings are turned by half a spacing, and this lattice does not close at the seam"
                ),
                format!("take tube.waves = {waves_help}, or tube.rings_per_wave = {rings_help}"),
            )
        }
    };
    context.refuse::<()>(keys, message, help);
}

/// A grain meets each wall sphere within its reach at every step: there must not be more than can be gone through. Walls of too
/// many spheres are refused already.
pub(super) fn check_reach(tube: &Tube, reach: f64, context: &mut Context<'_>) {
    if tube.arrangement == Arrangement::Smooth {
        return;
    }
    let (met, most) = (
        tube.wall_spheres_within(reach),
        limits::MOST_WALL_SPHERES_IN_REACH,
    );
    if met > most && tube.wall_spheres() <= limits::MOST_WALL_SPHERES {
        context.refuse_as::<()>(
            ProblemKind::OutOfRange,
            &["tube.rings_per_wave", "tube.spheres_per_ring"],
            format!("a wall so dense that a grain meets {met:.0} of its spheres at once"),
            format!("at most {most}: take fewer rings per wave or spheres per ring"),
        );
    }
}

/// A sphere must not meet its own periodic image, nor one partner from both sides.
pub(super) fn check_length(tube: &Tube, reach: f64, context: &mut Context<'_>) {
    let (length, least) = (tube.length(), 2.0 * reach);
    if length > least {
        return;
    }
    context.refuse::<()>(
        &["tube.wavelength", "tube.waves", "grains.diameter_max"],
        format!(
            "a tube that closes on itself: its length L = waves * wavelength = {length} is not above twice the reach of a contact, {least}"
        ),
        format!("more waves or a longer wavelength, L above {least}; or smaller grains"),
    );
}
