//! Profiles in the frame of the wave: density, axial velocity and temperature against (z - c t)/lambda.

use glam::DVec3;
use peristalsis_engine::Simulation;

use crate::sample::has_escaped;
use crate::shape::TubeShape;

/// Blocks kept at most; when there are more, neighbours are merged.
const MOST_BLOCKS: usize = 64;

/// Sums over the grains seen in one bin.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Sums {
    number: f64,
    mass: f64,
    momentum: DVec3,
    twice_energy: f64,
    radius: f64,
    least_radius: f64,
    largest_radius: f64,
    looks: f64,
}

impl Sums {
    fn add(&mut self, other: &Self) {
        let seen = self.looks > 0.0;
        self.number += other.number;
        self.mass += other.mass;
        self.momentum += other.momentum;
        self.twice_energy += other.twice_energy;
        self.radius += other.radius;
        if other.looks > 0.0 {
            self.least_radius = if seen {
                self.least_radius.min(other.least_radius)
            } else {
                other.least_radius
            };
            self.largest_radius = self.largest_radius.max(other.largest_radius);
        }
        self.looks += other.looks;
    }

    /// Adds what is seen of the tube at `places` places that are alike.
    fn look_at(&mut self, slice: crate::shape::Slice, places: f64) {
        self.add(&Self {
            radius: places * slice.mean,
            least_radius: slice.least,
            largest_radius: slice.largest,
            looks: places,
            ..Self::default()
        });
    }

    fn velocity(&self) -> f64 {
        self.momentum.z / self.mass
    }

    /// sum m |v - <v>|^2/(3 N), <v> the mean velocity of the bin.
    fn temperature(&self) -> f64 {
        ((self.twice_energy - self.momentum.length_squared() / self.mass) / (3.0 * self.number))
            .max(0.0)
    }
}

/// Averages in bins of the position in the wave's frame, kept in blocks of time so that the late part of a run can be
/// taken at its end, with errors.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WaveFrameProfile {
    bins: usize,
    /// Samples in a full block.
    block: u64,
    /// Samples in the last block.
    in_last: u64,
    blocks: Vec<Vec<Sums>>,
}

/// One bin of a profile; values are NaN where no grain was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileBin {
    /// Middle of the bin: (z - c t)/lambda folded to \[0, 1), z along the wave.
    pub position: f64,
    /// Grains per length of one tube \[1/d\], with its error.
    pub density: (f64, f64),
    /// Mean axial velocity along the wave, in the laboratory frame \[d/t\], with its error.
    pub axial_velocity: (f64, f64),
    /// Granular temperature about the bin's mean velocity \[m d^2/t^2\], with its error.
    pub temperature: (f64, f64),
    /// Mean radius of the tube \[d\].
    pub radius: f64,
    /// Least radius seen \[d\].
    pub least_radius: f64,
    /// Largest radius seen \[d\].
    pub largest_radius: f64,
}

impl WaveFrameProfile {
    /// An empty profile with `bins` bins; a block begins with `samples_per_block` samples, a wave period for instance.
    #[must_use]
    pub fn new(bins: usize, samples_per_block: u64) -> Self {
        Self {
            bins: bins.max(1),
            block: samples_per_block.max(1),
            in_last: 0,
            blocks: Vec::new(),
        }
    }

    /// Adds the grains inside the tube as they are now.
    pub fn add(&mut self, simulation: &Simulation) {
        if self.blocks.is_empty() || self.in_last == self.block {
            self.begin_block();
        }
        self.in_last += 1;
        let bins = self.bins;
        let Some(last) = self.blocks.last_mut() else {
            return;
        };
        let wall = simulation.wall();
        let lattice = wall.lattice();
        let (heading, cycles) = (wall.heading(), wall.cycles());
        let shape = TubeShape::of(simulation);
        let bin_of = |z: f64| {
            let position = heading * z / lattice.wavelength - cycles;
            let folded = position - position.floor();
            ((folded * bins as f64) as usize).min(bins - 1)
        };
        let (different_waves, alike) = if shape.is_periodic() {
            (1, lattice.waves)
        } else {
            (lattice.waves, 1)
        };
        for wave in 0..different_waves {
            for (bin, sums) in last.iter_mut().enumerate() {
                let position = (bin as f64 + 0.5) / bins as f64 + f64::from(wave) + cycles;
                let z = (heading * position * lattice.wavelength).rem_euclid(lattice.length());
                sums.look_at(shape.slice(z), f64::from(alike));
            }
        }
        let bodies = simulation.bodies();
        for grain in 0..bodies.grains {
            if has_escaped(bodies, grain, &shape) {
                continue;
            }
            let (mass, mut velocity) = (bodies.mass[grain], bodies.velocity[grain]);
            velocity.z *= heading;
            last[bin_of(bodies.position[grain].z)].add(&Sums {
                number: 1.0,
                mass,
                momentum: mass * velocity,
                twice_energy: mass * velocity.length_squared(),
                ..Sums::default()
            });
        }
    }

    fn begin_block(&mut self) {
        if self.blocks.len() == MOST_BLOCKS {
            let merged = self
                .blocks
                .chunks(2)
                .map(|pair| {
                    let mut sum = pair[0].clone();
                    for other in &pair[1..] {
                        for (into, from) in sum.iter_mut().zip(other) {
                            into.add(from);
                        }
                    }
                    sum
                })
                .collect();
            self.blocks = merged;
            self.block *= 2;
        }
        self.blocks.push(vec![Sums::default(); self.bins]);
        self.in_last = 0;
    }

    /// The profile over the last part of what was added, at least one block; `wavelength` in d.
    ///
    /// Errors are standard errors from up to ten equal groups of blocks, NaN where there is only one.
    #[must_use]
    pub fn late(&self, fraction: f64, wavelength: f64) -> Vec<ProfileBin> {
        let blocks = self.blocks.len();
        let taken = ((blocks as f64 * fraction).round() as usize).clamp(1.min(blocks), blocks);
        let late = &self.blocks[blocks - taken..];
        let groups: Vec<Vec<Sums>> = late
            .chunks(late.len().div_ceil(10).max(1))
            .map(|group| {
                let mut sums = vec![Sums::default(); self.bins];
                for block in group {
                    for (into, from) in sums.iter_mut().zip(block) {
                        into.add(from);
                    }
                }
                sums
            })
            .collect();
        (0..self.bins)
            .map(|bin| {
                let mut total = Sums::default();
                for group in &groups {
                    total.add(&group[bin]);
                }
                let bin_width = wavelength / self.bins as f64;
                let with_error = |value: &dyn Fn(&Sums) -> f64| {
                    let values: Vec<f64> = groups
                        .iter()
                        .map(|group| value(&group[bin]))
                        .filter(|value| value.is_finite())
                        .collect();
                    (value(&total), standard_error(&values))
                };
                ProfileBin {
                    position: (bin as f64 + 0.5) / self.bins as f64,
                    density: with_error(&|sums| sums.number / (sums.looks * bin_width)),
                    axial_velocity: with_error(&Sums::velocity),
                    temperature: with_error(&Sums::temperature),
                    radius: total.radius / total.looks,
                    least_radius: total.least_radius,
                    largest_radius: total.largest_radius,
                }
            })
            .collect()
    }
}

fn standard_error(values: &[f64]) -> f64 {
    let number = values.len() as f64;
    if values.len() < 2 {
        return f64::NAN;
    }
    let mean = values.iter().sum::<f64>() / number;
    let variance = values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum::<f64>()
        / (number - 1.0);
    (variance / number).sqrt()
}
