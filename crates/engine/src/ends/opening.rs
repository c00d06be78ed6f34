//! The stretch of an open tube where grains are put in.

use glam::DVec3;
use rand_chacha::ChaCha8Rng;

use crate::random::uniform;
use crate::wall::Wall;

/// Random places that are tried for a grain at a look.
const TRIES: usize = 40;
/// Places along the stretch at which its radius is looked at.
const SECTIONS: u32 = 8;

/// The stretch as it is at a look.
pub(super) struct Opening<'a> {
    wall: &'a Wall,
    /// z at its ends \[d\].
    ends: [f64; 2],
    /// Largest radius of the tube there, to the centres of its wall's spheres \[d\].
    radius: f64,
    /// Centres and diameters of the grains there and close by.
    near: Vec<(DVec3, f64)>,
}

impl<'a> Opening<'a> {
    /// From one z to another, with the centres and diameters of the grains there and close by.
    pub(super) fn new(wall: &'a Wall, ends: [f64; 2], near: Vec<(DVec3, f64)>) -> Self {
        let section = |number: u32| f64::from(number) / f64::from(SECTIONS);
        let radii = (0..=SECTIONS).map(|number| wall.radius(between(ends, section(number))));
        Self {
            wall,
            ends,
            radius: radii.fold(0.0, f64::max),
            near,
        }
    }

    /// Takes a place.
    pub(super) fn fill(&mut self, place: DVec3, diameter: f64) {
        self.near.push((place, diameter));
    }

    /// A random place for a sphere that touches neither another nor the wall; `None` where none is found.
    pub(super) fn place(&self, diameter: f64, random: &mut ChaCha8Rng) -> Option<DVec3> {
        let reach = 0.5 * (diameter + self.wall.sphere_diameter());
        let widest = (self.radius - reach).max(0.0);
        (0..TRIES).find_map(|_| {
            let z = between(self.ends, uniform(random));
            let from_axis = widest * uniform(random).sqrt();
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * uniform(random));
            // The end of the period is its beginning.
            let z = z.min(self.wall.length().next_down());
            let place = DVec3::new(from_axis * cos, from_axis * sin, z);
            let mut sections = [z - reach, z, z + reach].into_iter();
            let clear = sections.all(|z| from_axis + reach <= self.wall.radius(z));
            let free = |&(other, size): &(DVec3, f64)| {
                let apart = 0.5 * (diameter + size);
                other.distance_squared(place) >= apart * apart
            };
            (clear && self.near.iter().all(free)).then_some(place)
        })
    }
}

/// The number that lies at a part of the way from one to another.
fn between([from, to]: [f64; 2], part: f64) -> f64 {
    from + (to - from) * part
}
