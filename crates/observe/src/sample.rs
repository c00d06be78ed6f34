//! One row of the time series: what a run looked like over one interval.

use glam::DVec3;
use peristalsis_engine::{Bodies, Ledger, Simulation};

use crate::shape::TubeShape;

/// Observables of one interval of time, in units of d, m, t; flow is positive along the wave.
///
/// Rates (flow, powers) are means over the interval; the others are values at its end. Fields without a suffix count the
/// grains that are inside the tube at the end of the interval, `_raw` all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    /// End of the interval \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run: time in periods.
    pub period: f64,
    /// J, from the displacements of the grains in the interval: sum of dz/dt over L \[1/t\].
    pub flow_rate: f64,
    /// J/Jmax, Jmax = N c/L; NaN for a static wave or without grains.
    pub flow_rate_ratio: f64,
    /// J of all grains.
    pub flow_rate_raw: f64,
    /// J/Jmax of all grains.
    pub flow_rate_ratio_raw: f64,
    /// J at the end of the interval, from the velocities.
    pub flow_rate_instantaneous: f64,
    /// sum m v^2/2 of the grains.
    pub kinetic_energy: f64,
    /// sum I omega^2/2 of the grains.
    pub rotational_energy: f64,
    /// `sum m |v - <v>|^2/(3 N)` of the grains, `<v>` their mean velocity.
    pub granular_temperature: f64,
    /// Mean number of contacts of a grain, wall included.
    pub contacts: f64,
    /// Part of the grains' contacts that slide; NaN without contacts.
    pub sliding_fraction: f64,
    /// Mean axial displacement of the grains since the start, along the wave \[d\].
    pub axial_displacement: f64,
    /// Variance of the axial displacements, `<(z - z_0 - <z - z_0>)^2>`: it grows as 2 D t where grains disperse \[d^2\].
    pub axial_displacement_variance: f64,
    /// Largest overlap at the end of the interval \[d\].
    pub largest_overlap: f64,
    /// Grains whose centre lies outside R + d/2.
    pub escaped: f64,
    /// Grains inside.
    pub inside: f64,
    /// Axial force of the wall on the grains, along the wave, at the end of the interval.
    pub wall_axial_force: f64,
    /// Mean power that wall or drive put in.
    pub wall_power: f64,
    /// Mean power of the body force on the grains: negative where they are pumped against it.
    pub body_power: f64,
    /// Mean power lost in contacts, drag and dashpots.
    pub dissipated_power: f64,
    /// Elastic energy of contacts, wall network and tethers.
    pub potential_energy: f64,
    /// Elastic energy of contacts.
    pub contact_energy: f64,
    /// |what the energy ledger misses| over the integral of |power that entered|.
    pub energy_residual: f64,
    /// Axial momentum of the grains along the wave.
    pub axial_momentum: f64,
    /// Angular momentum of the grains about the axis, spin included.
    pub angular_momentum: f64,
    /// Kinetic energy of an elastic wall.
    pub wall_kinetic_energy: f64,
    /// Elastic energy of an elastic wall's springs.
    pub network_energy: f64,
    /// Energy of an elastic wall's tethers and balancing force.
    pub keep_energy: f64,
    /// Smallest bottleneck: twice the least radius of the tube, to the centres; of an elastic wall the mean over a slice
    /// \[d\].
    pub bottleneck: f64,
    /// Mean axial displacement of an elastic wall from its reference, along the wave \[d\].
    pub wall_axial_displacement: f64,
    /// Root mean square axial displacement of an elastic wall \[d\].
    pub wall_axial_displacement_rms: f64,
    /// Root mean square azimuthal displacement of an elastic wall \[d\].
    pub wall_azimuthal_displacement_rms: f64,
    /// The energy ledger since the start.
    pub ledger: Ledger,
}

/// Makes samples of a simulation, one after another.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Observer {
    pub(crate) time: f64,
    pub(crate) cycles: f64,
    /// z of the grains, turns round the tube counted \[d\].
    pub(crate) unfolded: Vec<f64>,
    /// The same at the start of the run.
    start: Vec<f64>,
    ledger: Ledger,
}

impl Observer {
    /// Begins an interval now, and counts displacements from here.
    #[must_use]
    pub fn new(simulation: &Simulation) -> Self {
        let now = Self::at(simulation, Vec::new());
        Self {
            start: now.unfolded.clone(),
            ..now
        }
    }

    /// Begins an interval now; displacements count from `start`.
    fn at(simulation: &Simulation, start: Vec<f64>) -> Self {
        let length = simulation.wall().lattice().length();
        let bodies = simulation.bodies();
        Self {
            time: simulation.time(),
            cycles: simulation.wall().cycles(),
            unfolded: (0..bodies.grains)
                .map(|i| bodies.unfolded(i, length))
                .collect(),
            start,
            ledger: *simulation.ledger(),
        }
    }

    /// Ends the interval, begins the next, and answers what happened between.
    pub fn sample(&mut self, simulation: &Simulation) -> Sample {
        let now = Self::at(simulation, core::mem::take(&mut self.start));
        let before = core::mem::replace(self, now);
        let wall = simulation.wall();
        let bodies = simulation.bodies();
        let (tally, ledger) = (simulation.tally(), simulation.ledger());
        let heading = wall.heading();
        let length = wall.lattice().length();
        let interval = self.time - before.time;
        let grains = bodies.grains as f64;

        let shape = TubeShape::of(simulation);
        let (mut inside, mut flux, mut flux_raw, mut flux_now) = (0.0, 0.0, 0.0, 0.0);
        let (mut displaced, mut displaced_squared) = (0.0, 0.0);
        for grain in 0..bodies.grains {
            let moved = self.unfolded[grain] - before.unfolded[grain];
            flux_raw += moved;
            if !has_escaped(bodies, grain, &shape) {
                inside += 1.0;
                flux += moved;
                flux_now += bodies.velocity[grain].z;
                let since_start = heading * (self.unfolded[grain] - self.start[grain]);
                displaced += since_start;
                displaced_squared += since_start * since_start;
            }
        }
        let rate = |flux: f64| heading * flux / (length * interval);
        // Jmax = N c/L with the mean wave speed of the interval.
        let wave_run = (self.cycles - before.cycles) * wall.lattice().wavelength;
        let ratio = |flux: f64, number: f64| {
            if wave_run > 0.0 && number > 0.0 {
                heading * flux / (number * wave_run)
            } else {
                f64::NAN
            }
        };
        let contacts = (2 * tally.grain_contacts + tally.wall_contacts) as f64;
        let distinct_contacts = (tally.grain_contacts + tally.wall_contacts) as f64;
        let wall_motion = WallMotion::of(simulation);
        Sample {
            time: self.time,
            period: self.cycles,
            flow_rate: rate(flux),
            flow_rate_ratio: ratio(flux, inside),
            flow_rate_raw: rate(flux_raw),
            flow_rate_ratio_raw: ratio(flux_raw, grains),
            flow_rate_instantaneous: heading * flux_now / length,
            kinetic_energy: bodies.kinetic_energy(0..bodies.grains),
            rotational_energy: bodies.rotational_energy(),
            granular_temperature: granular_temperature(bodies),
            contacts: if grains > 0.0 { contacts / grains } else { 0.0 },
            sliding_fraction: tally.sliding_contacts as f64 / distinct_contacts,
            axial_displacement: displaced / inside,
            axial_displacement_variance: variance(inside, displaced, displaced_squared),
            largest_overlap: tally.largest_overlap,
            escaped: grains - inside,
            inside,
            wall_axial_force: heading * tally.wall_axial_force,
            wall_power: (ledger.input() - before.ledger.input()) / interval,
            body_power: (ledger.body_work - before.ledger.body_work) / interval,
            dissipated_power: (ledger.dissipated() - before.ledger.dissipated()) / interval,
            potential_energy: tally.potential_energy(),
            contact_energy: tally.contact_energy,
            energy_residual: simulation.energy_residual(),
            axial_momentum: heading * axial_momentum(bodies),
            angular_momentum: angular_momentum(bodies),
            wall_kinetic_energy: bodies.kinetic_energy(bodies.grains..bodies.number()),
            network_energy: tally.network_energy,
            keep_energy: tally.keep_energy,
            bottleneck: 2.0 * shape.narrowest(),
            wall_axial_displacement: heading * wall_motion.axial,
            wall_axial_displacement_rms: wall_motion.axial_rms,
            wall_azimuthal_displacement_rms: wall_motion.azimuthal_rms,
            ledger: *ledger,
        }
    }
}

/// J from the velocities of the grains inside the tube as they are, along the wave \[1/t\].
#[must_use]
pub fn instantaneous_flow_rate(simulation: &Simulation, shape: &TubeShape) -> f64 {
    let (bodies, wall) = (simulation.bodies(), simulation.wall());
    let flux: f64 = (0..bodies.grains)
        .filter(|&grain| !has_escaped(bodies, grain, shape))
        .map(|grain| bodies.velocity[grain].z)
        .sum();
    wall.heading() * flux / wall.lattice().length()
}

/// Whether a grain's centre lies outside R + d/2, R the wall's radius at its z and d its diameter.
#[must_use]
pub fn has_escaped(bodies: &Bodies, grain: usize, shape: &TubeShape) -> bool {
    let position = bodies.position[grain];
    let from_axis_squared = position.x * position.x + position.y * position.y;
    let beyond = |limit: f64| from_axis_squared > limit * limit;
    let half = 0.5 * bodies.diameter[grain];
    // Nearly all grains are within the throat's radius, and need no look at the wall where they are.
    beyond(shape.least_radius() + half) && beyond(shape.radius(position.z) + half)
}

/// Variance of so many numbers of which sum and sum of squares are known; NaN of none.
fn variance(number: f64, sum: f64, sum_of_squares: f64) -> f64 {
    let mean = sum / number;
    let variance = sum_of_squares / number - mean * mean;
    // Rounding may leave less than nothing.
    if variance < 0.0 { 0.0 } else { variance }
}

fn granular_temperature(bodies: &Bodies) -> f64 {
    let number = bodies.grains as f64;
    if bodies.grains == 0 {
        return 0.0;
    }
    let velocities = &bodies.velocity[..bodies.grains];
    let mean = velocities.iter().copied().sum::<DVec3>() / number;
    let sum: f64 = velocities
        .iter()
        .zip(&bodies.mass)
        .map(|(velocity, mass)| mass * (*velocity - mean).length_squared())
        .sum();
    sum / (3.0 * number)
}

fn axial_momentum(bodies: &Bodies) -> f64 {
    (0..bodies.grains)
        .map(|i| bodies.mass[i] * bodies.velocity[i].z)
        .sum()
}

fn angular_momentum(bodies: &Bodies) -> f64 {
    (0..bodies.grains)
        .map(|i| {
            let (position, velocity) = (bodies.position[i], bodies.velocity[i]);
            bodies.mass[i] * (position.x * velocity.y - position.y * velocity.x)
                + bodies.inertia[i] * bodies.angular_velocity[i].z
        })
        .sum()
}

/// How an elastic wall is displaced; zero for a prescribed one.
#[derive(Default)]
struct WallMotion {
    axial: f64,
    axial_rms: f64,
    azimuthal_rms: f64,
}

impl WallMotion {
    fn of(simulation: &Simulation) -> Self {
        let peristalsis_engine::Wall::Elastic(wall) = simulation.wall() else {
            return Self::default();
        };
        let spheres = wall.lattice().spheres();
        let (mut axial, mut axial_squared, mut azimuthal_squared) = (0.0, 0.0, 0.0);
        for sphere in 0..spheres {
            let away = wall.displacement(simulation.bodies(), sphere);
            axial += away.z;
            axial_squared += away.z * away.z;
            azimuthal_squared += away.y * away.y;
        }
        Self {
            axial: axial / spheres as f64,
            axial_rms: (axial_squared / spheres as f64).sqrt(),
            azimuthal_rms: (azimuthal_squared / spheres as f64).sqrt(),
        }
    }
}
