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
    Quantity { name: "grain", unit: "", text: "whether it is a grain; otherwise a sphere of the wall", reading: Truth(|s| s.is_grain) },
    Quantity { name: "along", unit: "d", text: "place along the tube, the wave running towards larger ones", reading: Real(|s| s.sphere.along) },
    Quantity { name: "across", unit: "d", text: "place across the tube, from its axis", reading: Real(|s| s.sphere.across) },
    Quantity { name: "depth", unit: "d", text: "place across the tube and across that", reading: Real(|s| s.sphere.depth) },
    Quantity { name: "diameter", unit: "d", text: "diameter", reading: Real(|s| s.sphere.diameter) },
    Quantity { name: "axial_velocity", unit: "d/t", text: "axial velocity along the wave, laboratory frame", reading: Real(|s| s.axial_velocity) },
];

/// All grains, and the spheres of an elastic wall, as they stand.
pub(crate) fn seen_spheres(run: &Run) -> Vec<SeenSphere> {
    let simulation = run.simulation();
    let bodies = simulation.bodies();
    let tube = simulation.wall().lattice().length();
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
