//! A smooth wall: the surface of revolution that the radius of the wave makes.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};
use peristalsis_physics::contact::Contact;
use peristalsis_physics::wall::{Lattice, RadiusWave, Ring};

use super::Instant;
use crate::bodies::Sphere;

/// Diameter of the beads as which a smooth wall is drawn \[d\].
pub(super) const BEAD: f64 = 0.4;
/// Distance of neighbouring beads, over their diameter.
const BESIDE: f64 = 0.9;

/// Most contacts of a grain on one side of the axis.
const MOST_FEET: usize = 4;
/// Most pieces in which the neighbourhood of a grain is searched for the nearest places of the wall.
const MOST_PIECES: f64 = 256.0;
/// Fewest of them.
const FEWEST_PIECES: f64 = 4.0;
/// A slope of D^2/2 that is as good as none \[d\].
const SLIGHT: f64 = 1e-14;
/// Steps in which a nearest place is narrowed down, at most.
const MOST_STEPS: u32 = 100;

/// The surface, found by search: nothing of it is stored.
///
/// In a plane through the axis the radius is a curve r = R(z, t). The wall's surface is the curve that runs half a wall
/// sphere's diameter d_w inside it, measured along the normal: where an ever finer lattice of spheres would touch. A
/// grain of diameter d touches where it is nearest to the curve,
///
/// xi = (d + d_w)/2 - D, D = |r - r_0|, (R - rho) R' + z_0 - z = 0 and D least there,
///
/// rho the distance of its centre from the axis, r_0 = (R, z_0) its foot on the curve. D counts as negative for a centre
/// beyond the curve, so that the wall pushes it back. n leads from the foot to the centre; the reduced radius is that of
/// a sphere on a plane, d/2; the material of the wall moves as its spheres do, radially with dR/dt.
///
/// The other side of the axis is touched as well, where the tube is narrow enough: its curve is r = -R. With both sides the
/// force has no jump at the axis. A bend that is narrower than the grain is touched on both of its flanks.
#[derive(Clone, Debug)]
pub(super) struct Smooth {
    /// Length along the tube in which the curve does not bend twice \[d\].
    piece: f64,
    /// Largest |R'| over the amplitude \[1/d\].
    steepest: f64,
}

/// A place of the curve nearest to a grain, in the plane through the axis and the grain's centre.
#[derive(Clone, Copy, Debug, Default)]
struct Foot {
    /// From the grain's centre along the tube.
    along: f64,
    ring: Ring,
}

impl Smooth {
    pub(super) fn new(wave: &RadiusWave) -> Self {
        Self {
            piece: 0.25 * wave.contraction.finest() * wave.wavelength,
            steepest: wave.contraction.steepest() / wave.wavelength,
        }
    }

    /// Calls `touch` for each contact of a grain, or each gap up to `range`, with the surface that lies `half` inside the radius
    /// of a wave at an instant: with the number of the
    /// contact, the contact (the grain not rotating) and the velocity of the wall there.
    ///
    /// The nearer side of the axis has an even number, the other an odd one: 0 and 1, or, where a side is touched more than
    /// once, 2 and 3, 4 and 5 and so on in the order of z.
    pub(super) fn for_each_contact(
        &self,
        grain: &Sphere,
        half: f64,
        range: f64,
        (wave, now): (&RadiusWave, &Instant),
        mut touch: impl FnMut(u32, Contact, DVec3),
    ) {
        let Sphere {
            position,
            velocity,
            diameter,
            ..
        } = *grain;
        let overlaps = 0.5 * diameter + half;
        let reach = overlaps + range;
        let from_axis = position.truncate().length();
        let narrowest = wave.throat_radius();
        if from_axis + reach <= narrowest {
            return;
        }
        let outward = if from_axis > 0.0 {
            DVec3::new(position.x / from_axis, position.y / from_axis, 0.0)
        } else {
            DVec3::X
        };
        for (side, offset, outward) in [(0, from_axis, outward), (1, -from_axis, -outward)] {
            if offset + reach <= narrowest {
                continue;
            }
            let ring = |along: f64| {
                let (frequency, rate) = (now.frequency, now.amplitude_rate);
                wave.ring(position.z + along, now.cycles, frequency, rate)
            };
            let here = ring(0.0);
            // A curve that is nowhere steeper cannot come nearer from as far.
            let steepest = self.steepest * wave.amplitude;
            let gap = here.radius - offset;
            if gap > 0.0 && gap * gap > reach * reach * (1.0 + steepest * steepest) {
                continue;
            }
            let (feet, number) = self.feet(offset, reach, gap >= 0.0, ring);
            for (place, (foot, apart)) in (1..).zip(&feet[..number]) {
                let Ring {
                    velocity: speed, ..
                } = foot.ring;
                let inward = foot.normal(offset, *apart);
                let wall_velocity = speed * outward;
                let overlap = overlaps - apart;
                let contact = Contact {
                    overlap,
                    // To a sphere like the grain that overlaps as much.
                    distance: diameter - overlap,
                    normal: inward.x * outward + inward.y * DVec3::Z,
                    relative_velocity: velocity - wall_velocity,
                    reduced_radius: 0.5 * diameter,
                    rotation: DVec3::ZERO,
                    spin: DVec3::ZERO,
                };
                let several = if number > 1 { 2 * place } else { 0 };
                touch(side + several, contact, wall_velocity);
            }
        }
    }

    /// The feet of a grain within its reach, in the order of z, with their distances; `offset` is its place across the axis,
    /// positive on the side of the curve, and `ring` the curve at a place along the tube, counted from the grain.
    fn feet(
        &self,
        offset: f64,
        reach: f64,
        is_inside: bool,
        ring: impl Fn(f64) -> Ring,
    ) -> ([(Foot, f64); MOST_FEET], usize) {
        let at = |along: f64| {
            let foot = Foot {
                along,
                ring: ring(along),
            };
            (foot, foot.slope(offset))
        };
        let pieces = (2.0 * reach / self.piece).ceil();
        // An even number, so that one border is at the grain: there is the foot in a straight tube.
        let half_pieces = (0.5 * pieces.clamp(FEWEST_PIECES, MOST_PIECES)).ceil();
        let (mut feet, mut number) = ([(Foot::default(), 0.0); MOST_FEET], 0);
        let mut before = at(-reach);
        for border in 1..=2 * half_pieces as i32 {
            let after = at(reach * (f64::from(border) / half_pieces - 1.0));
            if before.1 < 0.0 && after.1 >= 0.0 && number < MOST_FEET {
                let foot = narrowed(before, after, at);
                if let Some(apart) = foot.apart(offset, is_inside)
                    && apart.abs() < reach
                {
                    feet[number] = (foot, apart);
                    number += 1;
                }
            }
            before = after;
        }
        (feet, number)
    }
}

impl Foot {
    /// From here to the grain's centre: across the axis, away from the curve's side where positive, and along it.
    fn separation(&self, offset: f64) -> DVec2 {
        DVec2::new(offset - self.ring.radius, -self.along)
    }

    /// d(D^2/2)/dz of the distance D from the grain's centre.
    fn slope(&self, offset: f64) -> f64 {
        (self.ring.radius - offset) * self.ring.slope + self.along
    }

    /// Distance from the curve, negative outside; `None` for the back of a thin ridge, which the grain cannot touch.
    fn apart(&self, offset: f64, is_inside: bool) -> Option<f64> {
        let separation = self.separation(offset);
        let distance = separation.length();
        let faces_it = separation.dot(self.inward()) >= 0.0;
        let touched = faces_it == is_inside || distance < NEAR;
        touched.then_some(if is_inside { distance } else { -distance })
    }

    /// The normal of the curve here, towards the axis.
    fn inward(&self) -> DVec2 {
        DVec2::new(-1.0, self.ring.slope).normalize()
    }

    /// n at the signed distance `apart`.
    fn normal(&self, offset: f64, apart: f64) -> DVec2 {
        if apart.abs() < NEAR {
            return self.inward();
        }
        self.separation(offset) / apart
    }
}

/// Below this distance \[d\] the direction to the curve is the normal of the curve.
const NEAR: f64 = 1e-9;

/// The place between two where the slope goes from below 0 to above, by the Illinois form of the rule of false position.
fn narrowed(
    (mut below, mut low): (Foot, f64),
    (mut above, mut high): (Foot, f64),
    at: impl Fn(f64) -> (Foot, f64),
) -> Foot {
    let mut last_was_low = None;
    for _ in 0..MOST_STEPS {
        let width = above.along - below.along;
        if high == 0.0 || width <= f64::EPSILON {
            break;
        }
        let along = below.along - low * width / (high - low);
        let (foot, slope) = at(along.clamp(below.along, above.along));
        if slope.abs() <= SLIGHT || along <= below.along || along >= above.along {
            return foot;
        }
        let is_low = slope < 0.0;
        // The same end twice in a row: the other one counts for half.
        let repeated = last_was_low == Some(is_low);
        if is_low {
            (below, low) = (foot, slope);
            high *= if repeated { 0.5 } else { 1.0 };
        } else {
            (above, high) = (foot, slope);
            low *= if repeated { 0.5 } else { 1.0 };
        }
        last_was_low = Some(is_low);
    }
    above
}

/// The lattice of beads as which a wall of this wave is drawn.
pub(super) fn beads(wave: &RadiusWave, waves: u32) -> Lattice {
    let many = |length: f64| (length / (BESIDE * BEAD)).ceil().clamp(6.0, 4096.0) as u32;
    Lattice {
        spheres_per_ring: many(TAU * wave.belly_radius()),
        rings_per_wave: many(wave.wavelength).next_multiple_of(2),
        waves,
        wavelength: wave.wavelength,
        sphere_diameter: BEAD,
        staggered: true,
    }
}
