//! The spheres of an instant at their places before the eye.

use glam::DVec3;
use peristalsis_formats::Frame;
use peristalsis_formats::trajectory::FrameContact;
use peristalsis_render::{Colour, Finish, Sphere};

use super::caption::cycles;
use super::{Aspect, Eye, PictureScene, Place, SECTION, WallLook};

/// Colour of the wall.
const STONE: [u8; 3] = [207, 202, 193];

/// Grains so many radii from the axis have left the picture, or wait at the inlet of an open tube.
const FAR: f64 = 2.75;
/// Part of their size at which grains are drawn among the forces between them.
const SHRUNK: f64 = 0.32;
/// Part of the contacts whose force lies within the colours.
const COVERED: f64 = 0.97;
/// From one sphere of a rod to the next: a part of its radius, which nobody sees, but not less than so much \[d\].
const SPACING: (f64, f64) = (0.1, 0.008);
/// Normal forces from weak to strong, as in the viewer.
const FORCES: [[f64; 3]; 5] = [
    [70.0, 60.0, 110.0],
    [150.0, 50.0, 120.0],
    [225.0, 80.0, 60.0],
    [255.0, 170.0, 50.0],
    [255.0, 250.0, 190.0],
];

/// The colour of a force, from 0 to 1 of the largest.
fn force_colour(part: f64) -> Colour {
    let place = part.clamp(0.0, 1.0) * (FORCES.len() - 1) as f64;
    let below = (place as usize).min(FORCES.len() - 2);
    let mix = place - below as f64;
    let [red, green, blue] = std::array::from_fn(|k| {
        (FORCES[below][k] + mix * (FORCES[below + 1][k] - FORCES[below][k])).round() as u8
    });
    Colour::srgb(red, green, blue)
}

impl PictureScene {
    /// The contacts of the grains as rods of spheres, as thick as their normal force.
    fn rods(&self, frame: &Frame) -> Vec<Sphere> {
        let repels = |contact: &&FrameContact| {
            contact.normal_force > 0.0 && contact.spheres[0] < frame.grains
        };
        let contacts: Vec<&FrameContact> = frame.contacts.iter().filter(repels).collect();
        let mut forces: Vec<f64> = contacts.iter().map(|it| it.normal_force).collect();
        forces.sort_unstable_by(f64::total_cmp);
        let Some(&largest) = forces.get((COVERED * forces.len().saturating_sub(1) as f64) as usize)
        else {
            return Vec::new();
        };
        let length = self.wall.length();
        let shift = self.shift(cycles(frame));
        let mut rods = Vec::new();
        for contact in contacts {
            let [first, second] = contact.spheres;
            let [x, y, z] = frame.position[first];
            let begin = DVec3::new(x, y, (z - shift).rem_euclid(length));
            if self.look.aspect == Aspect::Side && begin.z > self.shown {
                continue;
            }
            // To the centre of a grain, or to where the wall is touched.
            let separation = DVec3::from_array(contact.separation);
            let way = match second < frame.grains {
                true => -separation,
                false => -0.5 * frame.diameter[first] * separation.normalize(),
            };
            let part = (contact.normal_force / largest).min(1.0);
            let radius = 0.02 + 0.11 * part;
            let pieces = (way.length() / (SPACING.0 * radius).max(SPACING.1)).ceil();
            rods.extend((0..=pieces as u32).map(|piece| Sphere {
                centre: begin + f64::from(piece) / pieces * way,
                radius,
                colour: force_colour(part),
                finish: Finish::Opaque,
            }));
        }
        rods
    }

    /// z of the tube minus z of the picture \[d\], up to whole lengths.
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
        let places = match self.look.aspect {
            Aspect::Side => 0.0..self.shown,
            Aspect::Section(_) => {
                let thickness = self.wall.sphere_diameter();
                // A smooth wall may have none.
                let half = 0.5 * SECTION * if thickness > 0.0 { thickness } else { 1.0 };
                0.5 * length - half..0.5 * length + half
            }
        };
        let view = self.view();
        let towards_eye = view.right.cross(view.up);
        let [red, green, blue] = STONE;
        let stone = Colour::srgb(red, green, blue);
        let spheres = frame.position.iter().zip(&frame.diameter).enumerate();
        let far = FAR * self.wall.usual_radius();
        let size = if self.look.contacts { SHRUNK } else { 1.0 };
        let of_wall = |centre: DVec3, radius: f64| {
            let is_before = centre.dot(towards_eye) > 0.0;
            Some(Sphere {
                centre,
                radius,
                colour: stone,
                finish: self.wall_finish(is_before)?,
            })
        };
        let seen = |z: f64| {
            let z = (z - shift).rem_euclid(length);
            places.contains(&z).then_some(z)
        };
        let mut shown: Vec<Sphere> = spheres
            .filter_map(|(index, (&[x, y, z], diameter))| {
                let centre = DVec3::new(x, y, seen(z)?);
                if index >= frame.grains {
                    return of_wall(centre, 0.5 * diameter);
                }
                if x.hypot(y) > far {
                    return None;
                }
                let [red, green, blue] = self.scale.srgb(values[index]);
                Some(Sphere {
                    centre,
                    radius: 0.5 * size * diameter,
                    colour: Colour::srgb(red, green, blue),
                    finish: Finish::Opaque,
                })
            })
            .collect();
        if let Some(drawn) = self.wall.drawn(frame.time) {
            shown.extend(drawn.prescribed_spheres().filter_map(|bead| {
                let centre = bead.position.with_z(seen(bead.position.z)?);
                of_wall(centre, 0.5 * bead.diameter)
            }));
        }
        if self.look.contacts {
            shown.extend(self.rods(frame));
        }
        shown
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
