//! The tube as it looks: the scene of a run, for the renderer.

use glam::DVec3;
use peristalsis_engine::{Bodies, Wall};
use peristalsis_figures::{ColourScale, Palette};
use peristalsis_render::{
    Colour, Finish, Picture, RenderError, Scene, Sphere, View, render,
};

use crate::run::Run;

/// From where a tube is looked at; the wave always runs to the right, or towards the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aspect {
    /// From the side, the half of the wall before the axis of glass.
    Side,
    /// Along the axis, at the middle of the tube.
    Section,
}

/// Wavelengths that a side view shows at most.
const WAVES: f64 = 2.0;
/// Thickness of a section \[d\].
const SECTION: f64 = 2.5;
/// White round the tube, and how far beyond its usual radius it is looked for \[d\].
const MARGIN: f64 = 0.6;

/// A picture of a run as it is, so many pixels across.
///
/// Grains are coloured by axial velocity over the wave's speed: blue against the wave, white at rest, red along it.
///
/// # Errors
/// [`RenderError::Size`] where the picture would have no pixels, or too many.
pub fn picture(run: &Run, aspect: Aspect, width: u32) -> Result<Picture, RenderError> {
    let simulation = run.simulation();
    let (bodies, wall) = (simulation.bodies(), simulation.wall());
    let (length, heading) = (wall.lattice().length(), wall.heading());
    let radius = shown_radius(bodies, wall);
    let (view, shown) = match aspect {
        Aspect::Side => {
            let shown = length.min(WAVES * wall.lattice().wavelength);
            let scale = f64::from(width) / (shown + 2.0 * MARGIN);
            let view = View {
                middle: DVec3::new(0.0, 0.0, 0.5 * shown),
                right: heading * DVec3::Z,
                up: DVec3::X,
                width,
                height: (2.0 * (radius + MARGIN) * scale).round() as u32,
                scale,
            };
            (view, 0.0..shown)
        }
        Aspect::Section => {
            let scale = f64::from(width) / (2.0 * (radius + MARGIN));
            let middle = 0.5 * length;
            let view = View {
                middle: DVec3::new(0.0, 0.0, middle),
                right: DVec3::Y * -heading,
                up: DVec3::X,
                width,
                height: width,
                scale,
            };
            (view, middle - 0.5 * SECTION..middle + 0.5 * SECTION)
        }
    };
    let towards_eye = view.right.cross(view.up);
    // Where the wave stands still there is nothing to compare with, and grains are grey.
    let speed = match wall.frequency(simulation.time()) * wall.lattice().wavelength {
        0.0 => f64::NAN,
        speed => speed,
    };
    let stone = Colour::srgb(206, 200, 190);
    let mut spheres = Vec::new();
    for grain in 0..bodies.grains {
        spheres.push(Sphere {
            centre: bodies.position[grain],
            radius: 0.5 * bodies.diameter[grain],
            colour: diverging(heading * bodies.velocity[grain].z / speed),
            finish: Finish::Opaque,
        });
    }
    let wall_sphere = |centre: DVec3| Sphere {
        centre,
        radius: 0.5 * wall.lattice().sphere_diameter,
        colour: stone,
        finish: match aspect {
            Aspect::Side if centre.dot(towards_eye) > 0.0 => Finish::Glass,
            _ => Finish::Opaque,
        },
    };
    match wall {
        Wall::Prescribed(wall) => {
            spheres.extend(
                (0..wall.lattice().spheres()).map(|it| wall_sphere(wall.sphere_position(it))),
            );
        }
        Wall::Elastic(_) => {
            spheres.extend(
                bodies.position[bodies.grains..]
                    .iter()
                    .map(|it| wall_sphere(*it)),
            );
        }
    }
    spheres.retain(|sphere| shown.contains(&sphere.centre.z));
    let scene = Scene {
        spheres,
        background: Colour::srgb(255, 255, 255),
    };
    render(&scene, &view)
}

/// Distance from the axis that a picture shows: to the outer side of the widest wall.
fn shown_radius(bodies: &Bodies, wall: &Wall) -> f64 {
    let half = 0.5 * wall.lattice().sphere_diameter;
    match wall {
        Wall::Prescribed(_) => wall.usual_radius() + half,
        Wall::Elastic(_) => {
            let spheres = bodies.position[bodies.grains..].iter();
            half + spheres.map(|it| it.x.hypot(it.y)).fold(0.0, f64::max)
        }
    }
}
