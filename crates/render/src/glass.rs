//! Spheres seen through glass.

use glam::Vec3;

use crate::colour::Colour;

/// Opacity of a wall of glass where it faces the eye, and at its rim.
const VEIL: f32 = 0.02;
const RIM: f32 = 0.60;
/// The mirrored lamp.
const GLOSS: f32 = 0.10;
const GLOSS_EXPONENT: i32 = 24;
/// Half way between lamp and eye.
const HALF_WAY: Vec3 = Vec3::new(-0.22, 0.35, 0.91);

/// A colour seen through glass whose surface has a normal.
///
/// Only the surface next to the eye counts: a wall of spheres that overlap is then one skin, not a net of rims.
pub(crate) fn before(behind: Vec3, normal: Vec3, colour: Colour) -> Vec3 {
    let slope = 1.0 - normal.z.clamp(0.0, 1.0);
    let hides = VEIL + RIM * slope.powi(3);
    // Glass is lighter than what it is made of: grey before the grains would be dirt on them.
    let shaded = colour.0.lerp(Vec3::ONE, 0.4) * (0.85 + 0.15 * normal.y.max(0.0));
    let mirrored = normal
        .dot(HALF_WAY.normalize())
        .max(0.0)
        .powi(GLOSS_EXPONENT);
    (behind.lerp(shaded, hides) + GLOSS * mirrored).min(Vec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `--wall glass` was murky.
    #[test]
    fn glass_hides_little_before_the_eye_and_more_at_its_rim() {
        let black = Vec3::ZERO;
        let grey = Colour(Vec3::splat(0.5));
        let facing = before(black, Vec3::Z, grey).x;
        let rim = before(black, Vec3::new(0.0, -0.99, 0.14).normalize(), grey).x;
        assert!(
            facing > 0.0 && facing < 0.05 && rim > 4.0 * facing,
            "{facing} {rim}"
        );
    }
}
