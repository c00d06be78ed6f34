//! Light on spheres: a sky that is bright all around and a wide lamp, both with the shadows of all that is opaque.
//!
//! The light comes from many fixed directions. For each a map holds how near the nearest sphere is as seen from there
//! (Tarini, Cignoni & Montani, IEEE Trans. Vis. Comput. Graph. 12, 1237 (2006)), so that a point's share of the sky and
//! of the lamp is a sum over the directions: ambient occlusion and soft shadows without noise, the same in every frame.

use glam::Vec3;
use rayon::prelude::*;

use crate::colour::Colour;
use crate::depth_map::{DepthMap, Disc};

/// Directions of the sky over the whole sphere.
const SKY_DIRECTIONS: u32 = 84;
/// Light from further behind the visible surface reaches no surface that faces the eye.
const FURTHEST_BEHIND: f32 = -0.5;
/// Light of the whole sky on an open surface.
const SKY: f32 = 0.74;
/// How much brighter the sky is above than at the horizon.
const SKY_GRADIENT: f32 = 0.28;
/// Directions of the lamp, and the sine of its angular radius.
const LAMP_DIRECTIONS: u32 = 14;
const LAMP_RADIUS: f32 = 0.26;
/// Light of the lamp at right angles.
const LAMP: f32 = 0.54;
/// Light mirrored by a surface, and how narrowly.
const GLOSS: f32 = 0.11;
const GLOSS_EXPONENT: i32 = 40;
/// Share of the light that bright neighbours give back to what they hide.
const BOUNCE: f32 = 0.15;
/// Light above which the brightest colours are bent so as not to be cut off.
const SHOULDER: f32 = 0.86;
/// Angle between successive points of a spiral that fills a disc or a sphere evenly.
const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// Direction to the lamp, for an eye that looks along -z: above, from the left, before the picture.
fn lamp() -> Vec3 {
    Vec3::new(-0.42, 0.66, 0.70).normalize()
}

/// A direction that light comes from, with what stands in its way.
#[derive(Debug)]
struct Source {
    towards: Vec3,
    weight: f32,
    map: DepthMap,
}

/// The light on a scene.
#[derive(Debug)]
pub(crate) struct Light {
    sky: Vec<Source>,
    lamp: Vec<Source>,
}

impl Light {
    /// The light among opaque discs, as the eye sees them, with shadows as fine as `fineness` \[d\].
    pub(crate) fn among(opaque: &[Disc], fineness: f32) -> Self {
        let source = |(towards, weight)| Source {
            towards,
            weight,
            map: DepthMap::new(towards, opaque, fineness),
        };
        let with_shadows =
            |directions: Vec<(Vec3, f32)>| directions.into_par_iter().map(source).collect();
        Self {
            sky: with_shadows(sky_directions()),
            lamp: with_shadows(lamp_directions()),
        }
    }

    /// The light from a point of a surface to the eye.
    pub(crate) fn shade(&self, point: Vec3, normal: Vec3, colour: Colour) -> Vec3 {
        let sum = |sources: &[Source]| -> f32 {
            let facing = |source: &Source| {
                let facing = normal.dot(source.towards);
                (facing > 0.0).then(|| source.weight * facing * source.map.visible(point, normal))
            };
            sources.iter().filter_map(facing).sum()
        };
        let (sky, lit) = (sum(&self.sky), sum(&self.lamp));
        let bounced = sky + BOUNCE * (SKY - sky).max(0.0);
        let half_way = (lamp() + Vec3::Z).normalize();
        let mirrored = GLOSS * normal.dot(half_way).max(0.0).powi(GLOSS_EXPONENT) * lit / LAMP;
        // A soft dark rim keeps spheres of one colour apart.
        let rim = (normal.z / 0.30).clamp(0.0, 1.0);
        let outline = 0.50 + 0.50 * rim * rim * (3.0 - 2.0 * rim);
        let light = colour.0 * ((bounced + lit) * outline) + Vec3::splat(mirrored);
        Vec3::from_array(light.to_array().map(bent))
    }
}

/// Brightness without a hard end: as it is up to the shoulder, then ever less, and never above 1.
fn bent(value: f32) -> f32 {
    if value <= SHOULDER {
        return value;
    }
    let room = 1.0 - SHOULDER;
    1.0 - room * room / (value - SHOULDER + room)
}

/// Directions all around with weights such that an open surface that faces the eye has light [`SKY`].
fn sky_directions() -> Vec<(Vec3, f32)> {
    let number = SKY_DIRECTIONS as f32;
    (0..SKY_DIRECTIONS)
        .map(|index| {
            let height = 1.0 - 2.0 * (index as f32 + 0.5) / number;
            let across = (1.0 - height * height).max(0.0).sqrt();
            let angle = GOLDEN_ANGLE * index as f32;
            let towards = Vec3::new(
                across * libm::cosf(angle),
                height,
                across * libm::sinf(angle),
            );
            // The mean of the cosine over all directions, those behind a surface as 0, is 1/4.
            let weight = 4.0 / number * SKY * (1.0 + SKY_GRADIENT * height);
            (towards, weight)
        })
        .filter(|(towards, _)| towards.z > FURTHEST_BEHIND)
        .collect()
}

/// Directions to a disc of light.
fn lamp_directions() -> Vec<(Vec3, f32)> {
    let middle = lamp();
    let (right, up) = middle.any_orthonormal_pair();
    (0..LAMP_DIRECTIONS)
        .map(|index| {
            let radius = LAMP_RADIUS * ((index as f32 + 0.5) / LAMP_DIRECTIONS as f32).sqrt();
            let angle = GOLDEN_ANGLE * index as f32;
            let beside = right * (radius * libm::cosf(angle)) + up * (radius * libm::sinf(angle));
            ((middle + beside).normalize(), LAMP / LAMP_DIRECTIONS as f32)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Colour = Colour(Vec3::splat(0.6));

    fn disc(centre: Vec3) -> Disc {
        Disc {
            centre,
            radius: 0.5,
            colour: WHITE,
        }
    }

    #[test]
    fn an_open_surface_has_the_light_of_the_whole_sky() {
        let total: f32 = sky_directions()
            .iter()
            .map(|(towards, weight)| weight * towards.z.max(0.0))
            .sum();
        assert!((total - SKY).abs() < 0.02 * SKY, "{total}");
        let facing: f32 = lamp_directions()
            .iter()
            .map(|(towards, weight)| weight * towards.dot(lamp()))
            .sum();
        assert!((facing - LAMP).abs() < 0.03 * LAMP, "{facing}");
    }

    #[test]
    fn what_is_hidden_is_darker_and_the_nearer_the_darker() {
        let brightness = |discs: &[Disc]| {
            let light = Light::among(discs, 0.02);
            light.shade(Vec3::new(0.0, 0.0, 0.5), Vec3::Z, WHITE).x
        };
        let own = disc(Vec3::ZERO);
        let free = brightness(&[own]);
        let beside = |x: f32| brightness(&[own, disc(Vec3::new(x, 0.0, 0.9))]);
        let (near, far) = (beside(0.8), beside(1.6));
        assert!(
            near < 0.95 * far && far < 0.995 * free,
            "{near} {far} {free}"
        );
        assert!(near > 0.2 * free);
        // What stands behind hides nothing.
        let behind = brightness(&[own, disc(Vec3::new(0.0, 0.0, -3.0))]);
        assert!((behind - free).abs() < 1e-3);
    }

    #[test]
    fn light_is_bent_without_a_step() {
        assert_eq!(bent(0.5), 0.5);
        assert!((bent(SHOULDER + 1e-4) - SHOULDER - 1e-4).abs() < 1e-5);
        assert!(bent(1.0) < 1.0 && bent(50.0) < 1.0 && bent(50.0) > 0.99);
    }
}
