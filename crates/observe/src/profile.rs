//! Profiles in the wave frame: density, axial velocity, temperature and the forces of the wall against
//! (z - c t)/lambda.

mod blocks;
mod part;

use core::f64::consts::TAU;

use glam::DVec3;
use peristalsis_engine::Simulation;
use peristalsis_physics::wall::{Contraction, RadiusWave, Waveform};

pub use part::{PartOfWave, WavePart};

use self::blocks::Blocks;
use crate::shape::{Slice, TubeShape};
use crate::view::{View, floor};

/// Sums over the grains seen in one bin.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Sums {
    number: f64,
    mass: f64,
    momentum: DVec3,
    twice_energy: f64,
    diameter: f64,
    radius: f64,
    least_radius: f64,
    largest_radius: f64,
    looks: f64,
    /// Those between the ends of the tube, part of a bin counted in part: all of a periodic one.
    in_tube: f64,
    wall: WallSums,
}

/// Sums over the contacts with the wall whose points lie in one bin.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct WallSums {
    /// Axial force on the grains along the normals of contacts, along the wave.
    normal: f64,
    /// Axial force on the grains by friction.
    tangential: f64,
    /// Radial force of the grains on the wall, outward.
    outward: f64,
    /// Power that sliding on the wall takes.
    sliding: f64,
    /// Axial velocity of the spheres of an elastic wall, along the wave.
    axial_velocity: f64,
    /// Such spheres.
    spheres: f64,
    /// Places looked at, samples times waves.
    looks: f64,
    /// Those between the ends of the tube.
    in_tube: f64,
}

impl WallSums {
    fn add(&mut self, other: &Self) {
        self.normal += other.normal;
        self.tangential += other.tangential;
        self.outward += other.outward;
        self.sliding += other.sliding;
        self.axial_velocity += other.axial_velocity;
        self.spheres += other.spheres;
        self.looks += other.looks;
        self.in_tube += other.in_tube;
    }

    /// Mean axial velocity of the wall's spheres; a prescribed wall has none.
    fn velocity(&self) -> f64 {
        if self.spheres > 0.0 {
            self.axial_velocity / self.spheres
        } else {
            0.0
        }
    }
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.number += other.number;
        self.mass += other.mass;
        self.momentum += other.momentum;
        self.twice_energy += other.twice_energy;
        self.diameter += other.diameter;
        let range = (other.least_radius, other.largest_radius);
        self.see(other.radius, range, other.looks);
        self.in_tube += other.in_tube;
        self.wall.add(&other.wall);
    }

    /// Adds a grain whose velocity is `velocity`, z along the wave.
    #[inline]
    fn add_grain(&mut self, (mass, diameter): (f64, f64), velocity: DVec3) {
        self.number += 1.0;
        self.mass += mass;
        self.momentum += mass * velocity;
        self.twice_energy += mass * velocity.length_squared();
        self.diameter += diameter;
    }

    /// Adds the tube at `places` places that are alike.
    #[inline]
    fn look_at(&mut self, slice: Slice, places: f64) {
        self.see(places * slice.mean, (slice.least, slice.largest), places);
    }

    /// Adds the sum, the least and the largest of the radii at so many places.
    #[inline]
    fn see(&mut self, sum: f64, (least, largest): (f64, f64), places: f64) {
        self.radius += sum;
        if places > 0.0 {
            if self.looks == 0.0 {
                self.least_radius = f64::INFINITY;
            }
            self.least_radius = self.least_radius.min(least);
            self.largest_radius = self.largest_radius.max(largest);
        }
        self.looks += places;
    }

    fn velocity(&self) -> f64 {
        self.momentum.z / self.mass
    }

    /// sum m |v - <v>|^2/(3 N), <v> the mean velocity of the bin; NaN without grains.
    fn temperature(&self) -> f64 {
        let about_mean = self.twice_energy - self.momentum.length_squared() / self.mass;
        // Rounding may leave a negative number.
        let about_mean = if about_mean < 0.0 { 0.0 } else { about_mean };
        about_mean / (3.0 * self.number)
    }
}

/// Averages in bins of the position in the wave frame, kept in blocks of time so that the late part of a run can be
/// taken at its end, with errors.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WaveFrameProfile {
    bins: usize,
    blocks: Blocks,
    #[serde(skip)]
    outline: Outline,
}

/// The waveform of a prescribed wall at the middles of the bins, where it stands still: worked out at the first look.
#[derive(Clone, Debug, Default)]
struct Outline(Vec<f64>);

impl PartialEq for Outline {
    /// It follows from the wall, and says nothing of what was seen.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Outline {
    /// The waveform's values in so many bins.
    fn of(&mut self, waveform: Waveform, bins: usize) -> &[f64] {
        if self.0.is_empty() {
            // The phase runs against the position in the wave frame.
            let value = |bin: usize| waveform.value(1.0 - (bin as f64 + 0.5) / bins as f64);
            self.0.extend((0..bins).map(value));
        }
        &self.0
    }
}

/// One bin of a profile; values are NaN where no grain was seen, and all but the radii and the velocity of the wall where the
/// tube has ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfileBin {
    /// Middle of the bin: (z - c t)/lambda folded to \[0, 1), z along the wave.
    pub position: f64,
    /// Grains per length of one tube \[1/d\], with its error.
    pub density: (f64, f64),
    /// Mean axial velocity along the wave, in the laboratory frame \[d/t\], with its error.
    pub axial_velocity: (f64, f64),
    /// Granular temperature about the velocity of the bin's centre of mass \[m d^2/t^2\], with its error.
    pub temperature: (f64, f64),
    /// Mean diameter of the grains, with its error \[d\].
    pub diameter: (f64, f64),
    /// Mean radius of the tube \[d\].
    pub radius: f64,
    /// Least radius seen \[d\].
    pub least_radius: f64,
    /// Largest radius seen \[d\].
    pub largest_radius: f64,
    /// Axial force of the wall on the grains along the normals of contacts, per length of tube \[m/t^2\], with its error.
    pub wall_normal_force: (f64, f64),
    /// Axial force of the wall on the grains by friction, per length of tube \[m/t^2\], with its error.
    pub wall_tangential_force: (f64, f64),
    /// Pressure on the wall: radial force per area 2 pi R dz, outward \[m/(d t^2)\], with its error. R reaches to the
    /// centres of the wall's spheres: the pressure on the clear bore is larger by the factor R/(R - d_w/2).
    pub wall_pressure: (f64, f64),
    /// Shear on the wall along the wave, with its error \[m/(d t^2)\]: the axial force on the wall per area 2 pi R dz
    /// without the force of the pressure on the inclined wall, tau = f_z/(2 pi R) + R' p with R' = dR/dz, z along the wave.
    pub wall_shear: (f64, f64),
    /// Power that grains lose where they slide on the wall, per area 2 pi R dz, with its error \[m/t^3\].
    pub wall_wear: (f64, f64),
    /// Mean axial velocity of the spheres of the wall, along the wave, with its error \[d/t\]; 0 for a prescribed wall.
    pub wall_axial_velocity: (f64, f64),
}

impl ProfileBin {
    /// Whether the tube was seen there: not where an open tube has ended at every look.
    pub fn is_in_tube(&self) -> bool {
        !self.density.0.is_nan()
    }
}

impl WaveFrameProfile {
    /// An empty profile with `bins` bins, of so many samples a period.
    pub fn new(bins: usize, samples_per_period: u64) -> Self {
        Self {
            bins: bins.max(1),
            blocks: Blocks::new(samples_per_period),
            outline: Outline::default(),
        }
    }

    /// Whether it can be a profile of `bins` bins, so many samples a period, and so many in all.
    pub fn fits(&self, bins: usize, samples_per_period: u64, samples: u64) -> bool {
        self.bins == bins.max(1) && self.blocks.fit(self.bins, samples_per_period, samples)
    }

    /// Adds the grains inside the tube, and its shape.
    pub fn add(&mut self, view: &View<'_>) {
        let bins = self.bins;
        let last = self.blocks.begin_sample(bins);
        let wall = view.simulation.wall();
        let (heading, cycles) = (wall.heading(), wall.cycles());
        let (waves, wavelength) = (wall.waves(), wall.wavelength());
        match &view.shape {
            TubeShape::Wave(
                wave @ RadiusWave {
                    contraction: Contraction::Wave(waveform),
                    ..
                },
                _,
            ) => {
                let outline = self.outline.of(*waveform, bins);
                for (sums, &value) in last.iter_mut().zip(outline) {
                    let radius = wave.mean_radius + wave.amplitude * value;
                    sums.look_at(Slice::round(radius), f64::from(waves));
                }
            }
            shape => {
                for wave in 0..waves {
                    for (bin, sums) in last.iter_mut().enumerate() {
                        let position = (bin as f64 + 0.5) / bins as f64 + f64::from(wave) + cycles;
                        let z = (heading * position * wavelength).rem_euclid(wall.length());
                        sums.look_at(shape.slice(z), 1.0);
                    }
                }
            }
        }
        for (bin, sums) in last.iter_mut().enumerate() {
            sums.in_tube += places_in_tube(view.simulation, bin, bins);
        }
        let bodies = view.simulation.bodies();
        let grains = bodies.position.iter().zip(&bodies.velocity);
        let sizes = bodies.mass.iter().zip(&bodies.diameter);
        let grains = grains.zip(sizes).zip(&view.inside);
        for (((place, &velocity), (&mass, &diameter)), &inside) in grains {
            if inside && is_in_tube(view.simulation, place.z) {
                let velocity = DVec3::new(velocity.x, velocity.y, heading * velocity.z);
                let position = heading * place.z / wavelength - cycles;
                last[bin_of(position, bins)].add_grain((mass, diameter), velocity);
            }
        }
    }

    /// Adds the forces between grains and wall and the axial motion of the wall as they are now, to the block of the last
    /// [`WaveFrameProfile::add`].
    ///
    /// Every contact has to be found again: do it at some samples only.
    pub fn add_wall_forces(&mut self, simulation: &Simulation) {
        let bins = self.bins;
        let Some(last) = self.blocks.last() else {
            return;
        };
        let wall = simulation.wall();
        let (heading, cycles) = (wall.heading(), wall.cycles());
        let wavelength = wall.wavelength();
        for (bin, sums) in last.iter_mut().enumerate() {
            sums.wall.looks += f64::from(wall.waves());
            sums.wall.in_tube += places_in_tube(simulation, bin, bins);
        }
        // The first piece goes on from the sums so far: where it is the only one, nothing is rounded once more.
        let so_far: Vec<WallSums> = last.iter().map(|sums| sums.wall).collect();
        let begin = |piece| match piece {
            0 => so_far.clone(),
            _ => vec![WallSums::default(); bins],
        };
        let of_pieces = simulation.add_up_wall_contacts(begin, |sums, contact| {
            let point = contact.point;
            if !is_in_tube(simulation, point.z) {
                return;
            }
            let bin = bin_of(heading * point.z / wavelength - cycles, bins);
            let from_axis = (point.x * point.x + point.y * point.y).sqrt();
            let force = contact.normal_force + contact.tangential_force;
            let sums = &mut sums[bin];
            sums.normal += heading * contact.normal_force.z;
            sums.tangential += heading * contact.tangential_force.z;
            sums.sliding += contact.sliding_power;
            if from_axis > 0.0 {
                sums.outward -= (force.x * point.x + force.y * point.y) / from_axis;
            }
        });
        let together = of_pieces.into_iter().reduce(|mut all, of_piece| {
            for (sums, of_piece) in all.iter_mut().zip(&of_piece) {
                sums.add(of_piece);
            }
            all
        });
        for (sums, wall) in last.iter_mut().zip(together.into_iter().flatten()) {
            sums.wall = wall;
        }
        let bodies = simulation.bodies();
        for sphere in bodies.grains..bodies.number() {
            let z = bodies.position[sphere].z;
            let bin = bin_of(heading * z / wavelength - cycles, bins);
            last[bin].wall.axial_velocity += heading * bodies.velocity[sphere].z;
            last[bin].wall.spheres += 1.0;
        }
    }

    /// The profile over the last part of what was added, of whole periods, at least one; `wavelength` in d.
    ///
    /// Errors are standard errors from up to ten groups of about equally many periods, NaN where there is only one. What was added
    /// since the last whole period counts in the means, not in the errors.
    pub fn late(&self, fraction: f64, wavelength: f64) -> Vec<ProfileBin> {
        let (groups, whole) = self.blocks.late(fraction);
        let totals: Vec<Sums> = (0..self.bins)
            .map(|bin| total(groups.iter().map(|group| &group[bin])))
            .collect();
        let bin_width = wavelength / self.bins as f64;
        let mean_radius = |bin: usize| totals[bin].radius / totals[bin].looks;
        (0..self.bins)
            .map(|bin| {
                let total = totals[bin];
                let with_error = |value: &dyn Fn(&Sums) -> f64| {
                    let groups = groups[..whole].iter().map(|group| value(&group[bin]));
                    (value(&total), standard_error(groups))
                };
                let per_length = |wall: &WallSums| 1.0 / (wall.in_tube * bin_width);
                let (before, after) = ((bin + self.bins - 1) % self.bins, (bin + 1) % self.bins);
                let radius = mean_radius(bin);
                let slope = (mean_radius(after) - mean_radius(before)) / (2.0 * bin_width);
                let per_area = |wall: &WallSums| per_length(wall) / (TAU * radius);
                let shear = |wall: &WallSums| {
                    (slope * wall.outward - wall.normal - wall.tangential) * per_area(wall)
                };
                ProfileBin {
                    position: (bin as f64 + 0.5) / self.bins as f64,
                    density: with_error(&|sums| sums.number / (sums.in_tube * bin_width)),
                    axial_velocity: with_error(&Sums::velocity),
                    temperature: with_error(&Sums::temperature),
                    diameter: with_error(&|sums| sums.diameter / sums.number),
                    radius: total.radius / total.looks,
                    least_radius: total.least_radius,
                    largest_radius: total.largest_radius,
                    wall_normal_force: with_error(&|it| it.wall.normal * per_length(&it.wall)),
                    wall_tangential_force: with_error(&|it| {
                        it.wall.tangential * per_length(&it.wall)
                    }),
                    wall_pressure: with_error(&|sums| sums.wall.outward * per_area(&sums.wall)),
                    wall_shear: with_error(&|sums| shear(&sums.wall)),
                    wall_wear: with_error(&|sums| sums.wall.sliding * per_area(&sums.wall)),
                    wall_axial_velocity: with_error(&|sums| sums.wall.velocity()),
                }
            })
            .collect()
    }
}

/// The bin of a position in the wave frame.
#[inline]
fn bin_of(position: f64, bins: usize) -> usize {
    let folded = position - floor(position);
    ((folded * bins as f64) as usize).min(bins - 1)
}

/// Places of a bin between the ends of the tube now, one a wave in a periodic one.
fn places_in_tube(simulation: &Simulation, bin: usize, bins: usize) -> f64 {
    let wall = simulation.wall();
    if simulation.ends().is_none() {
        return f64::from(wall.waves());
    }
    let (whole, width) = (wall.length(), wall.wavelength() / bins as f64);
    let of_wave = |wave: u32| {
        let position = bin as f64 / bins as f64 + f64::from(wave) + wall.cycles();
        // From the inlet to where the bin begins; it may reach round to the inlet again.
        let begin = (position * wall.wavelength()).rem_euclid(whole);
        let before_outlet = (simulation.length() - begin).clamp(0.0, width);
        (before_outlet + (begin + width - whole).max(0.0)) / width
    };
    (0..wall.waves()).map(of_wave).sum()
}

/// Whether a place lies between the ends of the tube: a grain that has just passed one is taken out at the next look only.
fn is_in_tube(simulation: &Simulation, z: f64) -> bool {
    let wall = simulation.wall();
    let from_inlet = || (wall.heading() * z).rem_euclid(wall.length());
    simulation.ends().is_none() || from_inlet() <= simulation.length()
}

/// Sums of sums.
fn total<'a>(sums: impl IntoIterator<Item = &'a Sums>) -> Sums {
    let mut total = Sums::default();
    for sums in sums {
        total.add(sums);
    }
    total
}

/// Standard error of the mean of the finite values; NaN below two.
fn standard_error(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    let number = values.len() as f64;
    if values.len() < 2 {
        return f64::NAN;
    }
    let mean = values.iter().sum::<f64>() / number;
    let squares = values.iter().map(|value| (value - mean) * (value - mean));
    let variance = squares.sum::<f64>() / (number - 1.0);
    (variance / number).sqrt()
}
