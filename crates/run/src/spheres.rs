//! The spheres of a run as one sees them from the side.

use peristalsis_figures::SnapshotSphere;
use peristalsis_observe::Quantity;
use peristalsis_observe::Reading::{Real, Truth};

use crate::run::Run;

/// A sphere with the wave running to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenSphere {
    /// Whether it is a grain; otherwise it is one of an elastic wall.
    pub(crate) is_grain: bool,
    /// Place and size \[d\].
    pub(crate) sphere: SnapshotSphere,
    /// Along the wave \[d/t\].
    pub(crate) axial_velocity: f64,
}

/// The columns of a table of spheres, in order.
#[rustfmt::skip]
pub(crate) const SPHERE: &[Quantity<SeenSphere>] = &[
    Quantity::new("grain", "", "whether it is a grain; otherwise a sphere of the wall", Truth(|s| s.is_grain)),
    Quantity::new("along", "d", "place along the tube, the wave running towards larger ones", Real(|s| s.sphere.along)),
    Quantity::new("across", "d", "place across the tube, from its axis", Real(|s| s.sphere.across)),
    Quantity::new("depth", "d", "place across the tube and across that", Real(|s| s.sphere.depth)),
    Quantity::new("diameter", "d", "diameter", Real(|s| s.sphere.diameter)),
    Quantity::new("axial_velocity", "d/t", "axial velocity along the wave, laboratory frame", Real(|s| s.axial_velocity)),
];

/// All grains, and the spheres of an elastic wall, as they stand.
pub(crate) fn seen_spheres(run: &Run) -> Vec<SeenSphere> {
    let simulation = run.simulation();
    let bodies = simulation.bodies();
    let tube = simulation.wall().length();
    let heading = simulation.wall().heading();
    (0..bodies.number())
        .map(|body| {
            let position = bodies.position[body];
            SeenSphere {
                is_grain: body < bodies.grains,
                sphere: SnapshotSphere {
                    along: if heading > 0.0 {
                        position.z
                    } else {
                        tube - position.z
                    },
                    across: position.y,
                    depth: position.x,
                    diameter: bodies.diameter[body],
                },
                axial_velocity: heading * bodies.velocity[body].z,
            }
        })
        .collect()
}
