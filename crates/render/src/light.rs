//! Light on a point among spheres: from all sides, less what the spheres around hide, and from a lamp with soft shadows.

use glam::Vec3;

use crate::colour::Colour;

/// Light that comes from all sides.
const AMBIENT: f32 = 0.60;
/// Light of the lamp at right angles.
const LAMP: f32 = 0.52;
/// Mirrored light of the lamp.
const GLOSS: f32 = 0.10;
const GLOSS_EXPONENT: f32 = 40.0;
/// Inverse of the lamp's angular radius: how sharp its shadows are.
const SHARPNESS: f32 = 5.0;
/// How far spheres are looked for that hide light \[radii and gaps of the two\].
pub(crate) const REACH: f32 = 2.2;

/// Direction to the lamp, for an eye that looks along -z: above, from the left, before the picture.
fn lamp() -> Vec3 {
    Vec3::new(-0.42, 0.66, 0.62).normalize()
}

/// A sphere that may hide light, as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occluder {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
}

/// Part of a point's hemisphere about `normal` that a sphere hides, weighted by the cosine.
///
/// cos(theta) r^2/D^2 while the sphere is wholly above the horizon, for a sphere of radius r whose centre lies in
/// direction theta from the normal at distance D; through the horizon it falls to 0 smoothly as
/// ((cos(theta) D/r + 1) r^2/(2 D^2))^(3/2).
fn hidden_part(towards: Vec3, radius: f32, normal: Vec3) -> f32 {
    let distance = towards.length().max(radius);
    let cosine = normal.dot(towards) / distance;
    let ratio = distance / radius;
    let inverse_square = 1.0 / (ratio * ratio);
    if cosine * ratio >= 1.0 {
        cosine * inverse_square
    } else {
        let part = 0.5 * (cosine * ratio + 1.0) * inverse_square;
        let part = part.max(0.0);
        part * part.sqrt()
    }
}

/// Part of the lamp that a sphere leaves visible, 0 to 1.
fn lamp_part(towards: Vec3, radius: f32) -> f32 {
    let along = towards.dot(lamp());
    if along <= 0.0 {
        return 1.0;
    }
    let beside = (towards.length_squared() - along * along).max(0.0).sqrt() - radius;
    let part = (0.5 + 0.5 * SHARPNESS * beside / along).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

/// The light from a point of a surface to the eye.
pub(crate) fn shade<'a>(
    point: Vec3,
    normal: Vec3,
    colour: Colour,
    around: impl Iterator<Item = &'a Occluder>,
) -> Vec3 {
    let (mut open, mut lit) = (1.0_f32, 1.0_f32);
    for sphere in around {
        let towards = sphere.centre - point;
        open *= 1.0 - hidden_part(towards, sphere.radius, normal).min(1.0);
        lit *= lamp_part(towards, sphere.radius);
    }
    let lamp = lamp();
    let facing = normal.dot(lamp).max(0.0);
    // Light that bounces between bright surfaces fills their gaps again.
    let bounced = open * (1.0 + 0.15 * (1.0 - open));
    let half_way = (lamp + Vec3::Z).normalize();
    let mirrored = libm::powf(normal.dot(half_way).max(0.0), GLOSS_EXPONENT);
    let rim = (normal.z / 0.22).clamp(0.0, 1.0);
    let outline = 0.35 + 0.65 * rim * rim * (3.0 - 2.0 * rim);
    (colour.0 * (AMBIENT * bounced + LAMP * facing * lit) + Vec3::splat(GLOSS * mirrored * lit))
        * outline
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_overhead_hides_its_solid_angle_and_one_below_nothing() {
        let above = hidden_part(Vec3::Z * 3.0, 1.0, Vec3::Z);
        assert!((above - 1.0 / 9.0).abs() < 1e-6);
        assert_eq!(hidden_part(Vec3::NEG_Z * 3.0, 1.0, Vec3::Z), 0.0);
        // The two forms meet where the sphere touches the horizon: cos(theta) = r/D.
        let touching = |cosine: f32| {
            let towards = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine) * 2.0;
            hidden_part(towards, 1.0, Vec3::Z)
        };
        assert!((touching(0.5001) - touching(0.4999)).abs() < 1e-3);
    }

    #[test]
    fn the_lamp_is_hidden_behind_a_sphere_only() {
        let behind = lamp() * 4.0;
        assert_eq!(lamp_part(behind, 1.0), 0.0);
        assert_eq!(lamp_part(-behind, 1.0), 1.0);
        assert_eq!(lamp_part(behind + Vec3::new(0.0, -5.0, 5.0), 1.0), 1.0);
    }

    #[test]
    fn what_is_hidden_is_darker() {
        let white = Colour::srgb(255, 255, 255);
        let free = shade(Vec3::ZERO, Vec3::Z, white, [].iter());
        let near = Occluder {
            centre: Vec3::new(0.9, 0.0, 0.7),
            radius: 0.5,
        };
        let hidden = shade(Vec3::ZERO, Vec3::Z, white, [near].iter());
        assert!(
            hidden.x < 0.95 * free.x && hidden.x > 0.1 * free.x,
            "{hidden} {free}"
        );
    }
}
