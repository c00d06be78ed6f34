//! The lattice of the wall: rings of spheres along a periodic tube.

use core::f64::consts::PI;

use crate::real::Real;

/// Rings of M spheres, an axial distance s apart; staggered ones are turned by pi/M in turn, aligned ones are not.
///
/// Ring k stands at zeta_k = k s, s = lambda/(rings per wavelength); sphere i of it at the angle (2 i + (k mod 2)) pi/M,
/// 2 i pi/M where they are aligned. The number of staggered rings in the whole tube is even, so that the pattern closes
/// at the seam.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lattice {
    /// M
    pub spheres_per_ring: u32,
    /// Rings in one wavelength.
    pub rings_per_wave: u32,
    /// Wavelengths in the tube.
    pub waves: u32,
    /// lambda \[d\]
    pub wavelength: f64,
    /// Diameter of a wall sphere \[d\].
    pub sphere_diameter: f64,
    /// Whether every other ring is turned by half a spacing.
    pub staggered: bool,
}

/// A sphere of the wall, by its place in the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WallSphere {
    /// k, from 0 to the number of rings - 1.
    pub ring: u32,
    /// i, from 0 to M - 1.
    pub place: u32,
}

impl Lattice {
    /// L, the period of the tube \[d\].
    pub fn length(&self) -> f64 {
        self.wavelength * f64::from(self.waves)
    }

    /// Rings in the whole tube.
    pub fn rings(&self) -> u32 {
        self.rings_per_wave * self.waves
    }

    /// Spheres in the whole tube.
    pub fn spheres(&self) -> usize {
        self.rings() as usize * self.spheres_per_ring as usize
    }

    /// s, the axial distance of neighbouring rings \[d\].
    pub fn spacing(&self) -> f64 {
        self.wavelength / f64::from(self.rings_per_wave)
    }

    /// Number of a sphere: ring by ring.
    pub fn index(&self, sphere: WallSphere) -> usize {
        sphere.ring as usize * self.spheres_per_ring as usize + sphere.place as usize
    }

    /// The sphere of a number.
    pub fn sphere(&self, index: usize) -> WallSphere {
        let per_ring = self.spheres_per_ring as usize;
        WallSphere {
            ring: (index / per_ring) as u32,
            place: (index % per_ring) as u32,
        }
    }

    /// zeta_k \[d\].
    pub fn axial_position(&self, ring: u32) -> f64 {
        f64::from(ring) * self.spacing()
    }

    /// Angle of a sphere in units of pi/M, from 0 to 2M - 1.
    pub fn half_steps(&self, sphere: WallSphere) -> u32 {
        2 * sphere.place + u32::from(self.staggered) * (sphere.ring % 2)
    }

    /// Angle of a sphere \[rad\].
    pub fn angle(&self, sphere: WallSphere) -> f64 {
        f64::from(self.half_steps(sphere)) * PI / f64::from(self.spheres_per_ring)
    }

    /// The six lattice neighbours of a sphere of a staggered lattice: two on its ring, two on each ring beside it.
    pub fn neighbours(&self, sphere: WallSphere) -> [WallSphere; 6] {
        let (rings, per_ring) = (self.rings(), self.spheres_per_ring);
        let WallSphere { ring, place } = sphere;
        let (above, below) = ((ring + 1) % rings, (ring + rings - 1) % rings);
        // A sphere of an even ring lies half a step before place i of the odd rings beside it, half a step after i - 1.
        let (first, second) = if ring % 2 == 0 {
            ((place + per_ring - 1) % per_ring, place)
        } else {
            (place, (place + 1) % per_ring)
        };
        let at = |ring, place| WallSphere { ring, place };
        [
            at(ring, (place + per_ring - 1) % per_ring),
            at(ring, (place + 1) % per_ring),
            at(below, first),
            at(below, second),
            at(above, first),
            at(above, second),
        ]
    }

    /// Widest gap of the straight tube: the radius of the largest sphere that could pass between three (aligned: four)
    /// neighbouring wall spheres of a tube of radius `radius` \[d\]. Soft grains pass through smaller gaps.
    ///
    /// The circumradius of the lattice triangle (rectangle) minus the wall spheres' radius; a grain of larger radius cannot
    /// leave without overlapping the wall.
    pub fn largest_passing_radius(&self, radius: f64) -> f64 {
        let chord = 2.0 * radius * libm::sin(PI / f64::from(self.spheres_per_ring));
        let half_turn = 2.0 * radius * libm::sin(0.5 * PI / f64::from(self.spheres_per_ring));
        let spacing = self.spacing();
        if !self.staggered {
            return 0.5 * (chord * chord + spacing * spacing).sqrt() - 0.5 * self.sphere_diameter;
        }
        let oblique = (spacing * spacing + half_turn * half_turn).sqrt();
        // Isosceles triangle with base `chord` and legs `oblique`: circumradius = leg^2/(2 height).
        let height = (oblique * oblique - 0.25 * chord * chord).max(0.0).sqrt();
        let circumradius = if height > 0.0 && oblique > chord / core::f64::consts::SQRT_2 {
            oblique * oblique / (2.0 * height)
        } else {
            0.5 * chord
        };
        circumradius - 0.5 * self.sphere_diameter
    }
}

/// Angle of a point about the axis, from 0 to 2 pi, good to 2e-5 rad.
///
/// Enough to find the nearest sphere of a ring, whose contacts are then found exactly. A polynomial, so that the same
/// bits come out on every platform; after Abramowitz & Stegun 4.4.49.
#[inline(always)]
pub fn approximate_angle<R: Real>(x: R, y: R) -> R {
    let zero = R::splat(0.0);
    let (abs_x, abs_y) = (x.abs(), y.abs());
    let (across, along) = (abs_x.min(abs_y), abs_x.max(abs_y));
    // On the axis any angle will do.
    let q = across / along.max(R::splat(f64::MIN_POSITIVE));
    let s = q * q;
    let mut series = R::splat(0.020_835_1);
    for coefficient in [-0.085_133_0, 0.180_141_0, -0.330_299_5, 0.999_866_0] {
        series = series * s + R::splat(coefficient);
    }
    let octant = q * series;
    let quadrant = R::select(abs_x.less(abs_y), R::splat(0.5 * PI) - octant, octant);
    let half = R::select(x.less(zero), R::splat(PI) - quadrant, quadrant);
    R::select(y.less(zero), R::splat(2.0 * PI) - half, half)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COARSE: Lattice = Lattice {
        spheres_per_ring: 12,
        rings_per_wave: 14,
        waves: 10,
        wavelength: 10.0,
        sphere_diameter: 1.0,
        staggered: true,
    };

    const FRICTIONAL: Lattice = Lattice {
        spheres_per_ring: 22,
        rings_per_wave: 23,
        waves: 2,
        wavelength: 20.0,
        sphere_diameter: 1.0,
        staggered: true,
    };

    fn position(lattice: &Lattice, sphere: WallSphere, radius: f64) -> [f64; 3] {
        let angle = lattice.angle(sphere);
        [
            radius * angle.cos(),
            radius * angle.sin(),
            lattice.axial_position(sphere.ring),
        ]
    }

    #[test]
    fn the_neighbours_are_the_six_nearest_spheres() {
        let lattice = FRICTIONAL;
        let length = lattice.length();
        for index in 0..lattice.spheres() {
            let centre = position(&lattice, lattice.sphere(index), 3.5);
            let mut nearest: Vec<(f64, usize)> = (0..lattice.spheres())
                .filter(|&other| other != index)
                .map(|other| {
                    let there = position(&lattice, lattice.sphere(other), 3.5);
                    let mut dz = (there[2] - centre[2]).abs();
                    dz = dz.min(length - dz);
                    let squared =
                        (there[0] - centre[0]).powi(2) + (there[1] - centre[1]).powi(2) + dz * dz;
                    (squared, other)
                })
                .collect();
            nearest.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let mut expected: Vec<usize> = nearest[..6].iter().map(|&(_, other)| other).collect();
            expected.sort_unstable();
            let mut found: Vec<usize> = lattice
                .neighbours(lattice.sphere(index))
                .iter()
                .map(|&sphere| lattice.index(sphere))
                .collect();
            found.sort_unstable();
            assert_eq!(found, expected, "sphere {index}");
        }
    }

    #[test]
    fn bond_lengths_of_the_frictional_preset_are_close_to_one_diameter() {
        let lattice = FRICTIONAL;
        let chord = 2.0 * 3.5 * (PI / 22.0).sin();
        assert!((chord - 0.9962).abs() < 1e-4);
        let half_turn = 2.0 * 3.5 * (PI / 44.0).sin();
        let oblique = (lattice.spacing().powi(2) + half_turn * half_turn).sqrt();
        assert!((oblique - 1.0028).abs() < 1e-4, "{oblique}");
        assert_eq!(lattice.spheres(), 2 * 506);
    }

    #[test]
    fn the_coarse_lattice_is_tight_and_the_leaking_one_is_found_looser() {
        let leaking = Lattice {
            spheres_per_ring: 10,
            rings_per_wave: 10,
            ..COARSE
        };
        let (tight, loose) = (
            COARSE.largest_passing_radius(1.5),
            leaking.largest_passing_radius(1.5),
        );
        assert!(tight > -0.05 && tight < 0.05, "{tight}");
        assert!(loose > tight + 0.05, "{loose} against {tight}");
    }

    #[test]
    fn the_approximate_angle_is_good_to_two_hundred_thousandths() {
        for step in 0..10_000 {
            let angle = f64::from(step) * 2.0 * PI / 10_000.0;
            let (x, y) = (0.7 * angle.cos(), 0.7 * angle.sin());
            let found = approximate_angle(x, y);
            let mut error = (found - angle).abs();
            error = error.min(2.0 * PI - error);
            assert!(error < 2e-5, "{angle}: {error}");
        }
        assert_eq!(approximate_angle(0.0, 0.0), 0.0);
    }
}
