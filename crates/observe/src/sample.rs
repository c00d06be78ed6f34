//! One row of the time series: what a run looked like over one interval.

use glam::DVec3;
use peristalsis_engine::{Ends, Ledger, Passages, Passed, Simulation};

use crate::mixing::{Kinds, Mixing};
use crate::segregation::Segregation;
use crate::series::{Join, joined};
use crate::view::View;

/// Observables of one interval of time, in units of d, m, t; flow is positive along the wave.
///
/// Rates (flow, powers) are means over the interval; the others are values at its end. Flow, displacements, momentum and the
/// power of the body force are those of the grains inside the tube at the end of the interval, `_raw` those of all. Flow also
/// counts the last way of grains that have left an open tube through an end.
/// Energies, temperature and contacts are those of all: escaped grains belong to the balance of energy. Grains that wait
/// outside an open tube count nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    /// End of the interval \[t\].
    pub time: f64,
    /// Wavelengths that the wave has run: time in periods.
    pub period: f64,
    /// J, from the displacements of the grains in the interval: sum of dz/dt over L \[1/t\].
    pub flow_rate: f64,
    /// Mass that flows: sum of m dz/dt over L \[m/t\].
    pub mass_flow_rate: f64,
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
    /// `sum m |v - <v>|^2/(3 N)` of the grains, escaped ones too, `<v>` the mean of their velocities, whatever their masses.
    pub granular_temperature: f64,
    /// Mean number of contacts of a grain, escaped ones too, wall included.
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
    /// Mean power of the body force on the grains inside: negative where they are pumped against it. The work of
    /// the body force across the tube on escaped grains is estimated from their velocities at the end of the interval.
    pub body_power: f64,
    /// Mean power lost in contacts, drag and dashpots.
    pub dissipated_power: f64,
    /// Elastic energy of contacts, wall network and tethers.
    pub potential_energy: f64,
    /// Elastic energy of contacts.
    pub contact_energy: f64,
    /// |what the energy ledger misses| over what entered, see [`Ledger::relative_residual`].
    pub energy_residual: f64,
    /// Axial momentum of the grains inside, along the wave.
    pub axial_momentum: f64,
    /// Angular momentum of the grains inside about the axis, spin included.
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
    /// Mass that leaves an open tube through the outlet, per time, mean over the interval.
    pub discharge_rate: f64,
    /// Mass that leaves it through the inlet, per time, mean over the interval.
    pub return_rate: f64,
    /// Mass that is put in at the inlet, per time, mean over the interval.
    pub feed_rate: f64,
    /// Mass that has left through the outlet since the start.
    pub discharged: f64,
    /// Mass between the ends.
    pub hold_up: f64,
    /// How the grains were mixed at the end of the last whole period, where that can be said.
    pub mixing: Option<Mixing>,
    /// How the sizes were segregated then.
    pub segregation: Segregation,
    /// The energy ledger since the start.
    pub ledger: Ledger,
}

/// The sample of two intervals that follow each other.
impl Join for Sample {
    fn join(&mut self, own: u64, next: &Self, others: u64) {
        let mean = |rate: fn(&Self) -> f64| joined(rate(self), own, rate(next), others);
        *self = Self {
            flow_rate: mean(|it| it.flow_rate),
            mass_flow_rate: mean(|it| it.mass_flow_rate),
            flow_rate_ratio: mean(|it| it.flow_rate_ratio),
            flow_rate_raw: mean(|it| it.flow_rate_raw),
            flow_rate_ratio_raw: mean(|it| it.flow_rate_ratio_raw),
            wall_power: mean(|it| it.wall_power),
            body_power: mean(|it| it.body_power),
            dissipated_power: mean(|it| it.dissipated_power),
            discharge_rate: mean(|it| it.discharge_rate),
            return_rate: mean(|it| it.return_rate),
            feed_rate: mean(|it| it.feed_rate),
            ..*next
        };
    }
}

/// Makes samples of a simulation, one after another.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Observer {
    pub(crate) time: f64,
    pub(crate) cycles: f64,
    /// z of the grains as they have moved, turns round the tube counted \[d\].
    pub(crate) unfolded: Vec<f64>,
    /// The same at the start of the run.
    pub(crate) start: Vec<f64>,
    /// How the grains lay at the start of the run.
    pub(crate) kinds: Kinds,
    mixing: Option<Mixing>,
    segregation: Segregation,
    ledger: Ledger,
    passages: Passages,
}

impl Observer {
    /// Begins an interval now, and counts displacements from here.
    pub fn new(simulation: &Simulation) -> Self {
        let now = Self::at(simulation, (Vec::new(), Kinds::new(simulation)));
        let mut observer = Self {
            start: now.unfolded.clone(),
            ..now
        };
        observer.end_period(&View::of(simulation));
        observer
    }

    /// Begins an interval now; displacements count from `start`.
    fn at(simulation: &Simulation, (start, kinds): (Vec<f64>, Kinds)) -> Self {
        let grains = simulation.bodies().grains;
        Self {
            time: simulation.time(),
            cycles: simulation.wall().cycles(),
            unfolded: (0..grains).map(|i| simulation.travelled(i)).collect(),
            start,
            kinds,
            mixing: None,
            segregation: Segregation::default(),
            ledger: *simulation.ledger(),
            passages: simulation
                .ends()
                .map(|ends| *ends.passages())
                .unwrap_or_default(),
        }
    }

    /// Whether it is the observer of `grains` grains.
    pub fn fits(&self, grains: usize) -> bool {
        [self.unfolded.len(), self.start.len()] == [grains; 2] && self.kinds.fits(grains)
    }

    /// Ends the interval and begins the next; answers the observer as it stood when the ended interval began.
    pub fn end_interval(&mut self, view: &View<'_>) -> Self {
        let start = core::mem::take(&mut self.start);
        let kinds = core::mem::take(&mut self.kinds);
        let now = Self {
            mixing: self.mixing,
            segregation: self.segregation,
            ..Self::at(view.simulation, (start, kinds))
        };
        core::mem::replace(self, now)
    }

    /// Ends a period together with the last interval: looks how the grains lie, which takes as long as a few steps.
    pub fn end_period(&mut self, view: &View<'_>) {
        self.mixing = Mixing::of(&self.kinds, &self.start, &self.unfolded, view);
        self.segregation = Segregation::of(view);
    }
}

impl Sample {
    /// The interval between two states of an observer, seen from its end.
    pub fn of(before: &Observer, after: &Observer, view: &View<'_>) -> Self {
        let View {
            simulation, shape, ..
        } = view;
        let wall = simulation.wall();
        let bodies = simulation.bodies();
        let (tally, ledger) = (simulation.tally(), simulation.ledger());
        let heading = wall.heading();
        let length = simulation.length();
        let interval = after.time - before.time;
        let waiting = simulation.ends().map_or(0, Ends::waiting);
        let grains = (bodies.grains - waiting) as f64;
        let (passed, passed_before) = (&after.passages, &before.passages);
        let mass_rate =
            |of: fn(&Passages) -> &Passed| (of(passed).mass - of(passed_before).mass) / interval;

        let sums = GrainSums::of(before, after, view);
        let inside = sums.inside;
        let rate = |flux: f64| heading * flux / (length * interval);
        // Jmax = N c/L with the mean wave speed of the interval.
        let wave_run = waves_passed(before.cycles, after.cycles) * wall.wavelength();
        let ratio = |flux: f64, number: f64| {
            if wave_run > 0.0 && number > 0.0 {
                heading * flux / (number * wave_run)
            } else {
                f64::NAN
            }
        };
        let contacts = (2 * tally.grain_contacts + tally.wall_contacts) as f64;
        let distinct_contacts = (tally.grain_contacts + tally.wall_contacts) as f64;
        let (kinetic_energy, rotational_energy) = (sums.kinetic_energy, sums.rotational_energy);
        let of_wall = bodies.grains..bodies.number();
        let all_kinetic_energy = of_wall.clone().fold(kinetic_energy, |sum, sphere| {
            sum + bodies.kinetic_energy(sphere..sphere + 1)
        });
        let energy = all_kinetic_energy + rotational_energy + tally.potential_energy();
        let wall_motion = WallMotion::of(simulation);
        Self {
            time: after.time,
            period: after.cycles,
            flow_rate: rate(sums.moved),
            mass_flow_rate: rate(sums.mass_moved),
            flow_rate_ratio: ratio(sums.moved, inside),
            flow_rate_raw: rate(sums.moved_raw),
            flow_rate_ratio_raw: ratio(sums.moved_raw, grains),
            flow_rate_instantaneous: heading * sums.axial_velocity / length,
            kinetic_energy,
            rotational_energy,
            granular_temperature: granular_temperature(simulation, sums.velocity / grains),
            contacts: if grains > 0.0 { contacts / grains } else { 0.0 },
            sliding_fraction: tally.sliding_contacts as f64 / distinct_contacts,
            axial_displacement: sums.displaced / inside,
            axial_displacement_variance: variance(inside, sums.displaced, sums.displaced_squared),
            largest_overlap: tally.largest_overlap,
            escaped: grains - inside,
            inside,
            wall_axial_force: heading * tally.wall_axial_force,
            wall_power: (ledger.input() - before.ledger.input()) / interval,
            body_power: (ledger.body_work
                - before.ledger.body_work
                - sums.escaped_work(view, interval))
                / interval,
            dissipated_power: (ledger.dissipated() - before.ledger.dissipated()) / interval,
            potential_energy: tally.potential_energy(),
            contact_energy: tally.contact_energy,
            energy_residual: ledger.relative_residual(energy),
            axial_momentum: heading * sums.axial_momentum,
            angular_momentum: sums.angular_momentum,
            wall_kinetic_energy: bodies.kinetic_energy(of_wall),
            network_energy: tally.network_energy,
            keep_energy: tally.keep_energy,
            bottleneck: 2.0 * shape.narrowest(),
            wall_axial_displacement: heading * wall_motion.axial,
            wall_axial_displacement_rms: wall_motion.axial_rms,
            wall_azimuthal_displacement_rms: wall_motion.azimuthal_rms,
            discharge_rate: mass_rate(|passed| &passed.discharged),
            return_rate: mass_rate(|passed| &passed.returned),
            feed_rate: mass_rate(|passed| &passed.fed),
            discharged: passed.discharged.mass,
            hold_up: hold_up(simulation),
            mixing: after.mixing,
            segregation: after.segregation,
            ledger: *ledger,
        }
    }
}

/// Sums over the grains, in one pass: each waits for its own last addition only, so that all take hardly longer than one.
///
/// Along +z unless said otherwise.
#[derive(Default)]
struct GrainSums {
    inside: f64,
    /// Displacements in the interval, and these times the masses.
    moved: f64,
    mass_moved: f64,
    axial_velocity: f64,
    /// Displacements since the start along the wave, and their squares.
    displaced: f64,
    displaced_squared: f64,
    axial_momentum: f64,
    angular_momentum: f64,
    /// Mass times displacement in the interval and momentum of the grains that have escaped.
    escaped_moved: f64,
    escaped_momentum: DVec3,
    /// Displacements of all grains.
    moved_raw: f64,
    /// From here on of those inside and those that have escaped.
    kinetic_energy: f64,
    rotational_energy: f64,
    velocity: DVec3,
}

impl GrainSums {
    fn of(before: &Observer, after: &Observer, view: &View<'_>) -> Self {
        let bodies = view.simulation.bodies();
        let heading = view.simulation.wall().heading();
        // Equal lengths are checked here and not for every grain.
        let grains = view.inside.len();
        let (positions, velocities) = (&bodies.position[..grains], &bodies.velocity[..grains]);
        let (masses, inertias) = (&bodies.mass[..grains], &bodies.inertia[..grains]);
        let spins = &bodies.angular_velocity[..grains];
        let starts = &after.start[..grains];
        let (from, to) = (&before.unfolded[..grains], &after.unfolded[..grains]);
        let mut sums = Self::default();
        for (grain, &inside) in view.inside.iter().enumerate() {
            let (position, velocity) = (positions[grain], velocities[grain]);
            let (mass, inertia, spin) = (masses[grain], inertias[grain], spins[grain]);
            let moved = to[grain] - from[grain];
            sums.moved_raw += moved;
            let is_present = view.simulation.is_present(grain);
            if inside || !is_present {
                sums.moved += moved;
                sums.mass_moved += mass * moved;
            }
            if inside {
                sums.inside += 1.0;
                sums.axial_velocity += velocity.z;
                let since_start = heading * (to[grain] - starts[grain]);
                sums.displaced += since_start;
                sums.displaced_squared += since_start * since_start;
                sums.axial_momentum += mass * velocity.z;
                sums.angular_momentum +=
                    mass * (position.x * velocity.y - position.y * velocity.x) + inertia * spin.z;
            } else if is_present {
                sums.escaped_moved += mass * moved;
                sums.escaped_momentum += mass * velocity;
            } else {
                continue;
            }
            sums.kinetic_energy += 0.5 * mass * velocity.length_squared();
            sums.rotational_energy += 0.5 * inertia * spin.length_squared();
            sums.velocity += velocity;
        }
        sums
    }

    /// Work of the body force on the grains that have escaped, in an interval of this length.
    fn escaped_work(&self, view: &View<'_>, interval: f64) -> f64 {
        let body_force = view.simulation.parameters().body_force;
        let moved = (interval * self.escaped_momentum).with_z(self.escaped_moved);
        body_force.dot(moved)
    }
}

/// Variance from the number of values, their sum and their sum of squares; NaN without values.
fn variance(number: f64, sum: f64, sum_of_squares: f64) -> f64 {
    let mean = sum / number;
    let variance = sum_of_squares / number - mean * mean;
    // Rounding may leave a negative number.
    if variance < 0.0 { 0.0 } else { variance }
}

/// Rounding of the wavelengths that a wave has run, as a part of them.
const ROUNDING: f64 = 1e-12;

/// Wavelengths that a wave has run between two moments, from those that it had run by each; 0 where they differ by rounding.
pub fn waves_passed(before: f64, after: f64) -> f64 {
    let passed = after - before;
    if passed > ROUNDING * after.abs() {
        passed
    } else {
        0.0
    }
}

/// Mass of the grains between the ends of an open tube, of all grains of a periodic one \[m\].
fn hold_up(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    let present = (0..bodies.grains).filter(|&grain| simulation.is_present(grain));
    present.map(|grain| bodies.mass[grain]).sum()
}

/// `sum m |v - <v>|^2/(3 N)` for the mean velocity `<v>`; 0 without grains.
fn granular_temperature(simulation: &Simulation, mean: DVec3) -> f64 {
    let bodies = simulation.bodies();
    let number = bodies.grains - simulation.ends().map_or(0, Ends::waiting);
    if number == 0 {
        return 0.0;
    }
    let sum: f64 = bodies.velocity[..bodies.grains]
        .iter()
        .zip(&bodies.mass)
        .enumerate()
        .filter(|(grain, _)| simulation.is_present(*grain))
        .map(|(_, (velocity, mass))| mass * (*velocity - mean).length_squared())
        .sum();
    sum / (3.0 * number as f64)
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
        let spheres = simulation.wall().mobile_spheres();
        if spheres == 0 {
            return Self::default();
        }
        let (mut axial, mut axial_squared, mut azimuthal_squared) = (0.0, 0.0, 0.0);
        for away in simulation.wall().displacements(simulation.bodies()) {
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
