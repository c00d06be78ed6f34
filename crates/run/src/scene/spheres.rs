//! The spheres of an instant at their places before the eye.

use glam::DVec3;
use peristalsis_formats::Frame;
use peristalsis_render::{Colour, Finish, Sphere};

use super::caption::cycles;
use super::{Aspect, Eye, PictureScene, Place, SECTION, WallLook};

/// Colour of the wall.
const STONE: [u8; 3] = [207, 202, 193];

impl PictureScene {
    /// What z of a picture is less than z of the tube \[d\], up to whole lengths.
    pub(super) fn shift(&self, cycles: f64) -> f64 {
        let middle = 0.5 * self.wall.length();
        let wave = self.wall.heading() * self.wall.wavelength();
        match (self.look.aspect, self.look.eye) {
            (Aspect::Side, Eye::Laboratory) => 0.0,
            (Aspect::Side, Eye::Wave) => wave * cycles,
            (Aspect::Section(Place::At(z)), _) => z - middle,
            (Aspect::Section(Place::Phase(phase)), _) => wave * (phase + cycles) - middle,
        }
    }

    /// The spheres that are shown, grains in the colours of their values.
    pub(super) fn spheres(&self, frame: &Frame, values: &[f64]) -> Vec<Sphere> {
        let length = self.wall.length();
        let shift = self.shift(cycles(frame));
        let shown = match self.look.aspect {
            Aspect::Side => 0.0..self.shown,
            Aspect::Section(_) => {
                let half = 0.5 * SECTION * self.wall.sphere_diameter();
                0.5 * length - half..0.5 * length + half
            }
        };
        let view = self.view();
        let towards_eye = view.right.cross(view.up);
        let [red, green, blue] = STONE;
        let stone = Colour::srgb(red, green, blue);
        let spheres = frame.position.iter().zip(&frame.diameter).enumerate();
        spheres
            .filter_map(|(index, (&[x, y, z], diameter))| {
                let centre = DVec3::new(x, y, (z - shift).rem_euclid(length));
                if !shown.contains(&centre.z) {
                    return None;
                }
                let (colour, finish) = if index < frame.grains {
                    let [red, green, blue] = self.scale.srgb(values[index]);
                    (Colour::srgb(red, green, blue), Finish::Opaque)
                } else {
                    let is_before = centre.dot(towards_eye) > 0.0;
                    (stone, self.wall_finish(is_before)?)
                };
                Some(Sphere {
                    centre,
                    radius: 0.5 * diameter,
                    colour,
                    finish,
                })
            })
            .collect()
    }

    /// How a sphere of the wall looks; not at all where it is taken away.
    fn wall_finish(&self, is_before_axis: bool) -> Option<Finish> {
        match (self.look.wall, self.look.aspect) {
            (WallLook::Hidden, _) => None,
            (WallLook::Cut, Aspect::Side) if is_before_axis => None,
            (WallLook::Glass, Aspect::Side) if is_before_axis => Some(Finish::Glass),
            _ => Some(Finish::Opaque),
        }
    }
}
