//! The shape of the tube: the wall's radius along the axis.

use peristalsis_engine::{Bodies, Simulation, Wall};
use peristalsis_physics::wall::{Lattice, RadiusWave};

/// Radius of the tube as a function of z, to the centres of the wall spheres.
#[derive(Clone, Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "a tube has one, and asks it by reference"
)]
pub enum TubeShape {
    /// A prescribed wall: its wave, and how many wavelengths it has run.
    Wave(RadiusWave, f64),
    /// An elastic wall: by slices of the tube.
    Slices(Vec<Slice>, f64),
}

/// Radii of the wall spheres in a slice of an elastic tube.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slice {
    /// Mean \[d\].
    pub mean: f64,
    /// Least \[d\].
    pub least: f64,
    /// Largest \[d\].
    pub largest: f64,
}

impl Slice {
    /// One radius all round.
    pub(crate) fn round(radius: f64) -> Self {
        Self {
            mean: radius,
            least: radius,
            largest: radius,
        }
    }
}

impl TubeShape {
    /// The shape now.
    pub fn of(simulation: &Simulation) -> Self {
        let wall = simulation.wall();
        match wall.wave() {
            Some(wave) => Self::Wave(*wave, wall.cycles()),
            None => Self::Slices(slices(simulation.bodies(), wall), wall.length()),
        }
    }

    /// Mean, least and largest radius at z in \[0, L) \[d\].
    pub fn slice(&self, z: f64) -> Slice {
        match self {
            Self::Wave(wave, cycles) => Slice::round(wave.radius(z, *cycles)),
            Self::Slices(slices, length) => {
                let index = (z / length * slices.len() as f64) as usize;
                slices[index.min(slices.len() - 1)]
            }
        }
    }

    /// Mean radius at z \[d\].
    pub fn radius(&self, z: f64) -> f64 {
        self.slice(z).mean
    }

    /// A radius that the tube has at least everywhere, known without looking \[d\].
    #[inline]
    pub(crate) fn least_radius(&self) -> f64 {
        match self {
            Self::Wave(wave, _) => wave.throat_radius().max(0.0),
            Self::Slices(..) => 0.0,
        }
    }

    /// Least radius anywhere \[d\]: twice it is the smallest bottleneck.
    pub fn narrowest(&self) -> f64 {
        match self {
            Self::Wave(wave, cycles) => wave.narrowest(*cycles),
            Self::Slices(slices, _) => slices
                .iter()
                .map(|slice| slice.mean)
                .fold(f64::INFINITY, f64::min),
        }
    }
}

/// Slices one ring's spacing thick; a slice that no sphere is in takes the reference radius.
fn slices(bodies: &Bodies, wall: &Wall) -> Vec<Slice> {
    let number = wall.lattice().map_or(1, Lattice::rings) as usize;
    let mut sums = vec![(0_u32, 0.0, f64::INFINITY, 0.0_f64); number];
    for position in &bodies.position[bodies.grains..] {
        let index = ((position.z / wall.length() * number as f64) as usize).min(number - 1);
        let radius = (position.x * position.x + position.y * position.y).sqrt();
        let (count, sum, least, largest) = &mut sums[index];
        *count += 1;
        *sum += radius;
        *least = least.min(radius);
        *largest = largest.max(radius);
    }
    let reference = wall.mean_radius();
    sums.into_iter()
        .map(|(count, sum, least, largest)| match count {
            0 => Slice::round(reference),
            _ => Slice {
                mean: sum / f64::from(count),
                least,
                largest,
            },
        })
        .collect()
}
