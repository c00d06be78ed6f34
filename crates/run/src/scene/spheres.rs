//! The spheres of an instant at their places before the eye.

use glam::DVec3;
use peristalsis_figures::{ColourScale, Palette, Units};
use peristalsis_formats::Frame;
use peristalsis_formats::trajectory::FrameContact;
use peristalsis_render::{Colour, Finish, Sphere};

use super::caption::cycles;
use super::drawn::{FORCES_COVERED, ROD, SHRUNK, STONE};
use super::{Aspect, Eye, PictureScene, Place, SECTION, WallLook};

/// Grains so many radii from the axis have left the picture, or wait at the inlet of an open tube.
const FAR: f64 = 2.75;
/// From one sphere of a rod to the next: a part of its radius, which nobody sees, but not less than so much \[d\].
const SPACING: (f64, f64) = (0.1, 0.008);
/// The largest normal force within the colours where none is known, with linear and with Hertz contacts.
const USUAL_FORCES: [f64; 2] = [0.1, 0.01];

/// The contacts of an instant in which grains repel.
fn repelling(frame: &Frame) -> impl Iterator<Item = &FrameContact> {
    let repels =
        |contact: &&FrameContact| contact.normal_force > 0.0 && contact.spheres[0] < frame.grains;
    frame.contacts.iter().filter(repels)
}

/// The colours of the normal forces, by those at these instants. At the start of a run they are of its packing only.
pub(super) fn force_scale(samples: &[Frame], units: Units) -> ColourScale {
    let samples = samples.iter().filter(|frame| frame.time > 0.0);
    let contacts = samples.flat_map(repelling);
    let mut forces: Vec<f64> = contacts.map(|contact| contact.normal_force).collect();
    forces.sort_unstable_by(f64::total_cmp);
    let largest = match (forces.len().checked_sub(1), units) {
        (Some(last), _) => forces[(FORCES_COVERED * last as f64) as usize],
        (None, Units::Linear) => USUAL_FORCES[0],
        (None, Units::Hertz) => USUAL_FORCES[1],
    };
    let label = format!("normal force, *f*_{{n}}/{}", units.force());
    let scale = ColourScale::new(&label, 0.0, largest).palette(Palette::Force);
    // Some are larger, now or in a later picture.
    scale.found(0.0, f64::INFINITY)
}

impl PictureScene {
    /// The contacts of the grains as rods of spheres, as thick as their normal force.
    fn rods(&self, frame: &Frame) -> Vec<Sphere> {
        let Some(scale) = &self.forces else {
            return Vec::new();
        };
        let seen = self.seen(frame);
        let mut rods = Vec::new();
        for contact in repelling(frame) {
            let [first, second] = contact.spheres;
            let [x, y, z] = frame.position[first];
            let Some(z) = seen(z) else {
                continue;
            };
            let begin = DVec3::new(x, y, z);
            // To the centre of a grain, or to where the wall is touched.
            let separation = DVec3::from_array(contact.separation);
            let way = match second < frame.grains {
                true => -separation,
                false => -0.5 * frame.diameter[first] * separation.normalize(),
            };
            let radius = ROD[0] + ROD[1] * scale.part(contact.normal_force);
            let [red, green, blue] = scale.srgb(contact.normal_force);
            let pieces = (way.length() / (SPACING.0 * radius).max(SPACING.1)).ceil();
            rods.extend((0..=pieces as u32).map(|piece| Sphere {
                centre: begin + f64::from(piece) / pieces * way,
                radius,
                colour: Colour::srgb(red, green, blue),
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
            (Aspect::Section(Place::Position(position)), _) => wave * (position + cycles) - middle,
        }
    }

    /// z of the picture for z of the tube, where that is shown.
    fn seen(&self, frame: &Frame) -> impl Fn(f64) -> Option<f64> {
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
        move |z| {
            let z = (z - shift).rem_euclid(length);
            places.contains(&z).then_some(z)
        }
    }

    /// The spheres that are shown, grains in the colours of their values.
    pub(super) fn spheres(&self, frame: &Frame, values: &[f64]) -> Vec<Sphere> {
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
        let seen = self.seen(frame);
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
        shown.extend(self.rods(frame));
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
