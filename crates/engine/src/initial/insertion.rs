//! Random sequential insertion.

use core::f64::consts::TAU;

use glam::DVec3;
use peristalsis_physics::method::InitialState;
use peristalsis_physics::wall::{Contraction, RadiusWave};
use rand_chacha::ChaCha8Rng;

use super::packing::Packing;
use crate::error::EngineError;
use crate::neighbours::cells::Grid;
use crate::neighbours::periodic;
use crate::random::uniform;
use crate::wall::Wall;

/// Tries for each grain before insertion counts as stalled.
const TRIES: usize = 200;

/// Volume fraction, in the sense of N/(6 a^2 L), to which the bellies are filled in a jammed start.
const BELLY_FRACTION: f64 = 0.3;

/// Where centres may be put.
pub(super) struct Region<'a> {
    wall: &'a Wall,
    length: f64,
    /// Part of each wavelength around the belly that is filled, in (0, 1].
    filled: f64,
    /// Position of a belly's middle \[d\].
    belly: f64,
}

impl<'a> Region<'a> {
    pub(super) fn new(packing: &Packing, wall: &'a Wall) -> Self {
        let length = wall.length();
        let (filled, belly) = match (packing.state, wall.wave()) {
            (InitialState::Jammed, Some(wave)) => {
                let radius = wave.mean_radius;
                let fraction = packing.number as f64 / (6.0 * radius * radius * length);
                let filled = (fraction / BELLY_FRACTION).min(1.0);
                (filled, belly(wave, wall.cycles()))
            }
            // An elastic wall has no bellies before it is driven.
            _ => (1.0, 0.0),
        };
        Self {
            wall,
            length,
            filled,
            belly,
        }
    }

    /// Radius within which centres of spheres of this diameter are clear of the wall at z.
    fn clear_radius(&self, z: f64, diameter: f64) -> f64 {
        (self.wall.radius(z) - 0.5 * (diameter + self.wall.sphere_diameter())).max(0.0)
    }

    /// A random place, uniform in the volume that is clear of the wall (a narrow core where nothing is).
    fn place(&self, diameter: f64, random: &mut ChaCha8Rng) -> DVec3 {
        let (waves, wavelength) = (f64::from(self.wall.waves()), self.wall.wavelength());
        let widest = self.clear_radius(self.belly, diameter).max(
            // An elastic tube has the same radius everywhere.
            self.clear_radius(0.0, diameter),
        );
        for _ in 0..TRIES {
            let wave = (uniform(random) * waves).floor();
            let along = (uniform(random) - 0.5) * self.filled * wavelength;
            let z = (self.belly + wave * wavelength + along).rem_euclid(self.length);
            let clear = self.clear_radius(z, diameter);
            let accepted = uniform(random) * widest * widest < clear * clear;
            let (from_axis, angle) = (clear * uniform(random).sqrt(), TAU * uniform(random));
            if accepted {
                return DVec3::new(
                    from_axis * libm::cos(angle),
                    from_axis * libm::sin(angle),
                    if z < self.length { z } else { 0.0 },
                );
            }
        }
        // The tube is nowhere wide enough: a jittered place near the axis, for the relaxation to mend.
        let core = 0.1 * diameter;
        DVec3::new(
            core * (uniform(random) - 0.5),
            core * (uniform(random) - 0.5),
            (uniform(random) * self.length).min(self.length * (1.0 - f64::EPSILON)),
        )
    }
}

/// Axial position of the middle of the belly, to a thousandth of a wavelength.
fn belly(wave: &RadiusWave, cycles: f64) -> f64 {
    let wavelength = wave.wavelength;
    if wave.contraction.largest() == 0.0 && !matches!(wave.contraction, Contraction::Table(_)) {
        // Straight but for the squeeze: half way from throat to throat, at phase 1/4.
        let place = wave.heading * (cycles - 0.25);
        return (place - place.floor()) * wavelength;
    }
    let radius = |step: u32| wave.radius(f64::from(step) * wavelength / 1000.0, cycles);
    let best = (0..1000).fold(0, |best, step| {
        if radius(step) > radius(best) {
            step
        } else {
            best
        }
    });
    f64::from(best) * wavelength / 1000.0
}

/// Inserts grain by grain: at a random place without overlap, or, where none is found, at a random place. Answers the places
/// of all grains, and how many were placed without overlap.
///
/// # Errors
/// [`EngineError::Stopped`] where it was asked to stop.
pub(super) fn insert(
    diameter: &[f64],
    region: &Region<'_>,
    random: &mut ChaCha8Rng,
    stop: &dyn Fn() -> bool,
) -> Result<(Vec<DVec3>, usize), EngineError> {
    // Without grains any width of the cells will do.
    let largest = diameter.iter().copied().reduce(f64::max).unwrap_or(1.0);
    let mut bins = Bins::new(region, largest, diameter.len());
    let mut position: Vec<DVec3> = Vec::with_capacity(diameter.len());
    let mut without_overlap = 0;
    let mut stalled = 0_usize;
    for (grain, &size) in diameter.iter().enumerate() {
        if stop() {
            return Err(EngineError::Stopped);
        }
        // Once many grains in a row have stalled the tube is full: do not try as long for each of the others.
        let tries = if stalled > 20 { 1 } else { TRIES };
        let mut place = region.place(size, random);
        let mut free = bins.is_free(place, size, &position, diameter);
        for _ in 1..tries {
            if free {
                break;
            }
            place = region.place(size, random);
            free = bins.is_free(place, size, &position, diameter);
        }
        if free {
            without_overlap += 1;
        } else {
            stalled += 1;
        }
        bins.add(place, grain);
        position.push(place);
    }
    Ok((position, without_overlap))
}

/// Grains by cells of a rectangular grid.
struct Bins {
    grid: Grid,
    length: f64,
    members: Vec<Vec<u32>>,
}

impl Bins {
    /// Cells at least as wide as the largest grain.
    fn new(region: &Region<'_>, largest_diameter: f64, grains: usize) -> Self {
        let (half_width, length) = (region.wall.usual_radius(), region.length);
        let grid = Grid::new(half_width, largest_diameter, length, (8 * grains).max(4096));
        Self {
            grid,
            length,
            members: vec![Vec::new(); grid.cells()],
        }
    }

    fn add(&mut self, place: DVec3, grain: usize) {
        let index = self.grid.index(self.grid.cell(place));
        self.members[index].push(grain as u32);
    }

    fn is_free(&self, place: DVec3, size: f64, position: &[DVec3], diameter: &[f64]) -> bool {
        let [x, y, z] = self.grid.cell(place);
        let is_clear_of = |&other: &u32| {
            let other = other as usize;
            let reach = 0.5 * (size + diameter[other]);
            let separation = periodic(place - position[other], self.length);
            separation.length_squared() >= reach * reach
        };
        for z in self.grid.beside_along(z) {
            for y in self.grid.beside(y) {
                for x in self.grid.beside(x) {
                    let members = &self.members[self.grid.index([x, y, z])];
                    if !members.iter().all(is_clear_of) {
                        return false;
                    }
                }
            }
        }
        true
    }
}
