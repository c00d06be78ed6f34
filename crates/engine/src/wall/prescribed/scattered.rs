//! Wall spheres that stand anywhere: each has an angle and a place of its own.

use core::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec3;
use peristalsis_physics::wall::{Lattice, RadiusWave, Ring};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

use super::Instant;
use crate::initial::uniform;

/// Purpose of these random numbers beside those of the grains, whatever the seeds.
const STREAM: u64 = 3;
/// Failures in a row after which spheres are let come nearer to each other, and by how much.
const PATIENCE: u32 = 20_000;
const NEARER: f64 = 0.99;
/// Distance \[d\] by which a first look at a sphere sees too far, so that rounding hides none.
const EDGE: f64 = 1e-6;
/// Part of a surface that discs cover where no more find room, when they come one after another: nobody has covered more.
const MOST_COVERED: f64 = 0.55;

/// Spheres that follow the wave, each at its own angle and z.
#[derive(Clone, Debug, PartialEq)]
pub struct Scattered {
    /// In the order of z, which is that of their numbers.
    places: Arc<[Place]>,
    /// The first sphere of each piece of the tube, and their number at the end.
    pieces: Arc<[usize]>,
    length: f64,
}

/// Where one of them stands.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    z: f64,
    /// cos and sin of its angle.
    direction: (f64, f64),
    /// cos and sin of 2 pi z/lambda, for a wave towards +z.
    phase: (f64, f64),
}

impl Scattered {
    /// Spheres of the diameter, and on the length, of a lattice, at the given angles \[rad\] and places z \[d\].
    pub fn at(lattice: &Lattice, places: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let length = lattice.length();
        let mut places: Vec<Place> = places
            .into_iter()
            .map(|(angle, z)| {
                let phase = TAU * z / lattice.wavelength;
                Place {
                    z,
                    direction: (libm::cos(angle), libm::sin(angle)),
                    phase: (libm::cos(phase), libm::sin(phase)),
                }
            })
            .collect();
        places.sort_by(|one, other| one.z.total_cmp(&other.z));
        let number = ((length / lattice.sphere_diameter) as usize).clamp(1, places.len().max(1));
        let begins = |piece: usize| {
            let z = length * piece as f64 / number as f64;
            places.partition_point(|place| place.z < z)
        };
        let pieces = (0..number).map(begins).chain([places.len()]).collect();
        Self {
            pieces,
            places: places.into(),
            length,
        }
    }

    /// As many spheres as a lattice has, at independent random places.
    pub fn random(lattice: &Lattice, seed: u64) -> Self {
        let mut random = random(seed);
        let length = lattice.length();
        let places = (0..lattice.spheres())
            .map(|_| (TAU * uniform(&mut random), length * uniform(&mut random)));
        Self::at(lattice, places)
    }

    /// As many spheres as a lattice has, at random places one after another. Each keeps a distance from those before it,
    /// measured in the straight tube of radius `radius`. The distance begins too large for all of them, and shrinks
    /// whenever one finds no room.
    pub fn disordered(lattice: &Lattice, radius: f64, seed: u64) -> Self {
        let mut random = random(seed);
        let (length, number) = (lattice.length(), lattice.spheres());
        let area = 2.0 * PI * radius * length;
        let mut apart = (4.0 * MOST_COVERED * area / (PI * number as f64)).sqrt();
        let mut strips: Vec<Vec<(f64, f64)>> = vec![Vec::new(); (length / apart).max(1.0) as usize];
        let count = strips.len();
        let (mut placed, mut failures) = (0, 0);
        while placed < number {
            let (angle, z) = (TAU * uniform(&mut random), length * uniform(&mut random));
            let strip = ((z / length * count as f64) as usize).min(count - 1);
            let is_near = |&(other, at): &(f64, f64)| {
                let along = (z - at).abs();
                let along = along.min(length - along);
                let across = 2.0 * radius * libm::sin(0.5 * (angle - other));
                along * along + across * across < apart * apart
            };
            let around = [strip, (strip + 1) % count, (strip + count - 1) % count];
            if around
                .iter()
                .any(|&strip| strips[strip].iter().any(is_near))
            {
                failures += 1;
                if failures == PATIENCE {
                    (apart, failures) = (apart * NEARER, 0);
                }
            } else {
                strips[strip].push((angle, z));
                (placed, failures) = (placed + 1, 0);
            }
        }
        Self::at(lattice, strips.into_iter().flatten())
    }

    /// How many there are.
    pub(super) fn spheres(&self) -> usize {
        self.places.len()
    }

    /// A sphere as it is now: cos and sin of its angle, the wall at its place, and z.
    pub(super) fn sphere(
        &self,
        index: usize,
        wave: &RadiusWave,
        now: &Instant,
    ) -> ((f64, f64), Ring, f64) {
        let place = &self.places[index];
        (place.direction, ring(place, wave, now), place.z)
    }

    /// Calls `touch` for each sphere whose centre is within `reach` of `centre`, with its number, the separation (centre
    /// minus wall sphere) and the wall's velocity. The tube is longer than twice the reach.
    #[inline(always)]
    pub(super) fn for_each_touching(
        &self,
        centre: DVec3,
        reach: f64,
        wave: &RadiusWave,
        now: &Instant,
        mut touch: impl FnMut(u32, DVec3, DVec3),
    ) {
        let from_axis = (centre.x * centre.x + centre.y * centre.y).sqrt();
        let narrowest = wave.mean_radius - wave.amplitude.abs();
        if from_axis + reach <= narrowest {
            return;
        }
        let number = self.pieces.len() - 1;
        let piece = |z: f64| (z / self.length * number as f64).floor() as i64;
        for unfolded in piece(centre.z - reach)..=piece(centre.z + reach) {
            let turns = unfolded.div_euclid(number as i64);
            let (piece, shift) = (unfolded.rem_euclid(number as i64) as usize, turns as f64);
            let z = centre.z - shift * self.length;
            for index in self.pieces[piece]..self.pieces[piece + 1] {
                let place = &self.places[index];
                let dz = z - place.z;
                let room = reach * reach - dz * dz;
                // How far the grain is from the line on which the sphere moves, and along it.
                let (cos, sin) = place.direction;
                let across = centre.x * sin - centre.y * cos;
                let along = centre.x * cos + centre.y * sin;
                if room <= 0.0 || across * across > room + EDGE || along + reach + EDGE < narrowest
                {
                    continue;
                }
                let Ring {
                    radius, velocity, ..
                } = ring(place, wave, now);
                let (dx, dy) = (centre.x - radius * cos, centre.y - radius * sin);
                if dx * dx + dy * dy < room {
                    let moving = DVec3::new(velocity * cos, velocity * sin, 0.0);
                    touch(index as u32, DVec3::new(dx, dy, dz), moving);
                }
            }
        }
    }
}

/// The wall at a place.
#[inline(always)]
fn ring(place: &Place, wave: &RadiusWave, now: &Instant) -> Ring {
    let (cos, sin) = place.phase;
    now.ring(wave, place.z, (cos, wave.heading * sin))
}

fn random(seed: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(STREAM);
    random
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATTICE: Lattice = Lattice {
        spheres_per_ring: 12,
        rings_per_wave: 14,
        waves: 3,
        wavelength: 10.0,
        sphere_diameter: 1.0,
        staggered: true,
    };

    /// The least distance of two spheres in the straight tube of radius 1.5.
    fn least_distance(scattered: &Scattered) -> f64 {
        let places = &scattered.places;
        let mut least = f64::INFINITY;
        for (number, one) in places.iter().enumerate() {
            for other in &places[..number] {
                let along = (one.z - other.z).abs();
                let along = along.min(LATTICE.length() - along);
                let (dx, dy) = (
                    1.5 * (one.direction.0 - other.direction.0),
                    1.5 * (one.direction.1 - other.direction.1),
                );
                least = least.min((along * along + dx * dx + dy * dy).sqrt());
            }
        }
        least
    }

    #[test]
    fn random_places_are_uniform_and_disordered_ones_keep_their_distance() {
        let random = Scattered::random(&LATTICE, 1);
        let disordered = Scattered::disordered(&LATTICE, 1.5, 1);
        for scattered in [&random, &disordered] {
            assert_eq!(scattered.spheres(), LATTICE.spheres());
            let places = &scattered.places;
            assert!(places.is_sorted_by(|one, other| one.z <= other.z));
            // Means of z/L, cos and sin over 504 spheres, five standard errors wide.
            let mean = |of: &dyn Fn(&Place) -> f64| {
                places.iter().map(of).sum::<f64>() / places.len() as f64
            };
            assert!((mean(&|place| place.z / LATTICE.length()) - 0.5).abs() < 0.065);
            assert!(mean(&|place| place.direction.0).abs() < 0.16);
            assert!(mean(&|place| place.direction.1).abs() < 0.16);
        }
        assert!(least_distance(&random) < 0.05);
        // Equal discs that come one after another cover half of a surface, not much more.
        let apart = least_distance(&disordered);
        let covered = LATTICE.spheres() as f64 * PI * apart * apart
            / (4.0 * 2.0 * PI * 1.5 * LATTICE.length());
        assert!((0.48..MOST_COVERED).contains(&covered), "{covered}");
        assert_eq!(disordered, Scattered::disordered(&LATTICE, 1.5, 1));
        assert_ne!(disordered, Scattered::disordered(&LATTICE, 1.5, 2));
    }
}
