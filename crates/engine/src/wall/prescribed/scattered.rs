//! Wall spheres that stand anywhere: each has an angle and a place of its own.

use core::f64::consts::{PI, TAU};
use core::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use peristalsis_physics::real::Real;
use peristalsis_physics::wall::{Lattice, RadiusWave, Ring};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

use super::Instant;
use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, Lanes, Mask};
use crate::fast::machine::{Instructions, Machine, Work};
use crate::random::uniform;

/// Stream of these random numbers. It differs from the streams of the grains, so that equal seeds do no harm.
const STREAM: u64 = 3;
/// Failures in a row after which the least distance of two spheres is lowered, and the factor of this.
const PATIENCE: u32 = 20_000;
const NEARER: f64 = 0.99;
/// Margin of the first test of a sphere, as a distance \[d\] or the square of one, so that rounding hides no contact.
const EDGE: f64 = 1e-6;
/// Part of a surface that discs at random places cover when no further disc finds room.
const MOST_COVERED: f64 = 0.55;

/// Spheres that follow the wave, each at its own angle and z.
#[derive(Clone, Debug, PartialEq)]
pub struct Scattered {
    /// cos and sin of the angle of each sphere, and its z. The spheres are numbered in the order of z. Room for eight more.
    places: Arc<Columns>,
    /// cos and sin of 2 pi z/lambda of each, for a wave towards +z.
    phases: Arc<[(f64, f64)]>,
    /// The first sphere of each piece of the tube, and their number at the end.
    pieces: Arc<[usize]>,
    length: f64,
}

impl Scattered {
    /// Spheres of the diameter, and on the length, of a lattice, at the given angles \[rad\] and places z \[d\].
    pub fn at(lattice: &Lattice, mut places: Vec<(f64, f64)>) -> Self {
        let length = lattice.length();
        places.sort_by(|one, other| one.1.total_cmp(&other.1));
        let sorted = places;
        let number = ((length / lattice.sphere_diameter) as usize).clamp(1, sorted.len().max(1));
        let begins = |piece: usize| {
            let begin = length * piece as f64 / number as f64;
            sorted.partition_point(|&(_, z)| z < begin)
        };
        let pieces = (0..number).map(begins).chain([sorted.len()]).collect();
        let mut places = Columns::default();
        places.clear(sorted.len() + LANES);
        for (index, &(angle, z)) in sorted.iter().enumerate() {
            places.set(index, DVec3::new(libm::cos(angle), libm::sin(angle), z));
        }
        let phases = sorted.iter().map(|&(_, z)| TAU * z / lattice.wavelength);
        Self {
            places: Arc::new(places),
            phases: phases.map(|it| (libm::cos(it), libm::sin(it))).collect(),
            pieces,
            length,
        }
    }

    /// As many spheres as a lattice has, at independent random places.
    pub fn random(lattice: &Lattice, seed: u64) -> Self {
        let mut random = random(seed);
        let length = lattice.length();
        let places = (0..lattice.spheres())
            .map(|_| (TAU * uniform(&mut random), length * uniform(&mut random)));
        Self::at(lattice, places.collect())
    }

    /// As many spheres as a lattice has, at random places one after another. Each keeps a distance from those before it,
    /// measured in the straight tube of radius `radius`. The distance begins too large for all of them, and shrinks
    /// whenever one finds no room.
    pub fn disordered(lattice: &Lattice, radius: f64, seed: u64) -> Self {
        let mut random = random(seed);
        let (length, number) = (lattice.length(), lattice.spheres());
        let area = 2.0 * PI * radius * length;
        let mut apart = (4.0 * MOST_COVERED * area / (PI * number as f64)).sqrt();
        // Angle, z, and cos and sin of the angle of those placed.
        let mut strips: Vec<Vec<[f64; 4]>> = vec![Vec::new(); (length / apart).max(1.0) as usize];
        let count = strips.len();
        let (mut placed, mut failures) = (0, 0);
        while placed < number {
            let (angle, z) = (TAU * uniform(&mut random), length * uniform(&mut random));
            let strip = ((z / length * count as f64) as usize).min(count - 1);
            let (sin, cos) = libm::sincos(angle);
            let is_near = |&[other, at, its_cos, its_sin]: &[f64; 4]| {
                let along = (z - at).abs();
                let along = along.min(length - along);
                let chord = 2.0 * radius * radius * (1.0 - (cos * its_cos + sin * its_sin));
                let room = apart * apart - along * along;
                if (room - chord).abs() > EDGE {
                    return chord < room;
                }
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
                strips[strip].push([angle, z, cos, sin]);
                (placed, failures) = (placed + 1, 0);
            }
        }
        let placed = strips.iter().flatten();
        Self::at(lattice, placed.map(|&[angle, z, ..]| (angle, z)).collect())
    }

    /// How many there are.
    pub(super) fn spheres(&self) -> usize {
        self.phases.len()
    }

    /// A sphere as it is now: cos and sin of its angle, the wall at its place, and z.
    pub(super) fn sphere(
        &self,
        index: usize,
        wave: &RadiusWave,
        now: &Instant,
    ) -> ((f64, f64), Ring, f64) {
        let place = self.places.get(index);
        ((place.x, place.y), self.ring(index, wave, now), place.z)
    }

    /// The wall at the place of a sphere.
    #[inline(always)]
    fn ring(&self, index: usize, wave: &RadiusWave, now: &Instant) -> Ring {
        let (cos, sin) = self.phases[index];
        now.ring(wave, self.places.z[index], (cos, wave.heading * sin))
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
        let narrowest = wave.throat_radius();
        if from_axis + reach <= narrowest {
            return;
        }
        let number = self.pieces.len() - 1;
        let piece = |z: f64| (z / self.length * number as f64).floor() as i64;
        for unfolded in piece(centre.z - reach)..=piece(centre.z + reach) {
            let turns = unfolded.div_euclid(number as i64);
            let (piece, shift) = (unfolded.rem_euclid(number as i64) as usize, turns as f64);
            let z = centre.z - shift * self.length;
            let (begin, end) = (self.pieces[piece], self.pieces[piece + 1]);
            for begin in (begin..end).step_by(u64::BITS as usize) {
                let mut seen = Instructions::widest().run(Look {
                    places: &self.places,
                    centre: centre.with_z(z),
                    reach,
                    narrowest,
                    spheres: begin..end,
                });
                while seen != 0 {
                    let index = begin + seen.trailing_zeros() as usize;
                    seen &= seen - 1;
                    let place = self.places.get(index);
                    let (cos, sin, dz) = (place.x, place.y, z - place.z);
                    let room = reach * reach - dz * dz;
                    let Ring {
                        radius, velocity, ..
                    } = self.ring(index, wave, now);
                    let (dx, dy) = (centre.x - radius * cos, centre.y - radius * sin);
                    if dx * dx + dy * dy < room {
                        let moving = DVec3::new(velocity * cos, velocity * sin, 0.0);
                        touch(index as u32, DVec3::new(dx, dy, dz), moving);
                    }
                }
            }
        }
    }
}

/// A first look at the spheres about a grain, wherever the wave has them: which may be within `reach` of it.
struct Look<'a> {
    places: &'a Columns,
    centre: DVec3,
    reach: f64,
    /// The least distance from the axis that the wave gives a sphere.
    narrowest: f64,
    /// The spheres to be looked at; the answer has a bit for each of the first 64.
    spheres: Range<usize>,
}

impl Work for Look<'_> {
    type Answer = u64;

    #[inline(always)]
    fn run<M: Machine>(self) -> u64 {
        let [x, y, z] = self.centre.to_array().map(Lanes::<M>::splat);
        let squared = Lanes::splat(self.reach * self.reach);
        let least = Lanes::splat(self.narrowest - self.reach - EDGE);
        let mut seen = 0;
        for block in 0..(u64::BITS as usize / LANES).min(self.spheres.len().div_ceil(LANES)) {
            let begin = self.spheres.start + block * LANES;
            let place = self.places.load::<M>(begin);
            let (cos, sin, dz) = (place.x, place.y, z - place.z);
            let room = squared - dz * dz;
            // How far the grain is from the line on which the sphere moves, and along it.
            let (across, along) = (x * sin - y * cos, x * cos + y * sin);
            let near = Lanes::splat(0.0).less(room)
                & (across * across).at_most(room + Lanes::splat(EDGE))
                & least.at_most(along)
                & Mask::first(self.spheres.end - begin);
            seen |= u64::from(near.to_bits()) << (block * LANES);
        }
        seen
    }
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

    /// cos and sin of the angle of each sphere, and its z.
    fn places(scattered: &Scattered) -> Vec<DVec3> {
        let numbers = 0..scattered.spheres();
        numbers.map(|index| scattered.places.get(index)).collect()
    }

    /// The least distance of two spheres in the straight tube of radius 1.5.
    fn least_distance(scattered: &Scattered) -> f64 {
        let places = places(scattered);
        let mut least = f64::INFINITY;
        for (number, one) in places.iter().enumerate() {
            for other in &places[..number] {
                let along = (one.z - other.z).abs();
                let along = along.min(LATTICE.length() - along);
                let (dx, dy) = (1.5 * (one.x - other.x), 1.5 * (one.y - other.y));
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
            let places = places(scattered);
            assert!(places.is_sorted_by(|one, other| one.z <= other.z));
            // Means of z/L, cos and sin over 504 spheres, five standard errors wide.
            let mean = |of: &dyn Fn(&DVec3) -> f64| {
                places.iter().map(of).sum::<f64>() / places.len() as f64
            };
            assert!((mean(&|place| place.z / LATTICE.length()) - 0.5).abs() < 0.065);
            assert!(mean(&|place| place.x).abs() < 0.16);
            assert!(mean(&|place| place.y).abs() < 0.16);
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
