//! How far two simulations of one system are apart.

use super::longest;
use glam::DVec3;
use peristalsis_engine::{Ledger, Simulation, Tally};
use peristalsis_physics::contact::TangentialHistory;
use serde::Serialize;
use serde_json::Value;

/// Largest differences of each kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Apart {
    /// \[d\]
    pub(crate) places: f64,
    /// In units of the largest velocity.
    pub(crate) velocities: f64,
    /// In units of the largest spin.
    pub(crate) spins: f64,
    /// In units of the largest force, or of the largest overlap where forces cancel.
    pub(crate) forces: f64,
    /// In units of the largest torque, or of the largest overlap where torques cancel.
    pub(crate) torques: f64,
    /// Of all numbers that contacts remember; in units of those above 1.
    pub(crate) histories: f64,
    /// Of the fields of [`Tally`], each in units of its value, or of what adds up to it where terms cancel.
    pub(crate) tally: f64,
    /// Of the fields of [`Ledger`], likewise.
    pub(crate) ledger: f64,
}

impl Apart {
    /// Panics where they differ in anything that is counted: steps, turns, contacts, which of them slide.
    pub(crate) fn between(expected: &Simulation, found: &Simulation) -> Self {
        let (one, other) = (expected.bodies(), found.bodies());
        assert_eq!(expected.step(), found.step());
        assert_eq!(one.turns, other.turns);
        let forces = times(&one.acceleration, &one.mass);
        let torques = times(&one.angular_acceleration, &one.inertia);
        let totals = Totals::of(expected, &forces);
        Self {
            places: difference(&one.position, &other.position),
            velocities: relative(&one.velocity, &other.velocity, 0.0),
            spins: relative(&one.angular_velocity, &other.angular_velocity, 0.0),
            forces: relative(
                &forces,
                &times(&other.acceleration, &other.mass),
                totals.largest_overlap,
            ),
            torques: relative(
                &torques,
                &times(&other.angular_acceleration, &other.inertia),
                totals.largest_overlap,
            ),
            histories: histories(expected, found),
            tally: tallies(expected.tally(), found.tally(), &totals),
            ledger: ledgers(expected.ledger(), found.ledger(), &totals),
        }
    }

    /// Panics where anything is further apart than in `most`.
    pub(crate) fn assert_within(&self, most: &Self) {
        let pairs = [
            (self.places, most.places),
            (self.velocities, most.velocities),
            (self.spins, most.spins),
            (self.forces, most.forces),
            (self.torques, most.torques),
            (self.histories, most.histories),
            (self.tally, most.tally),
            (self.ledger, most.ledger),
        ];
        assert!(
            pairs.iter().all(|(apart, most)| apart <= most),
            "{self:?} where at most {most:?}"
        );
    }
}

/// What adds up to sums that may come to nothing: forces, times lengths of 1, times velocities.
struct Totals {
    largest_overlap: f64,
    force: f64,
    energy: f64,
    power: f64,
}

impl Totals {
    fn of(simulation: &Simulation, forces: &[DVec3]) -> Self {
        let tally = simulation.tally();
        let force = forces.iter().map(|force| force.length()).sum::<f64>() + tally.total_overlap;
        let fastest = longest(&simulation.bodies().velocity);
        Self {
            largest_overlap: tally.largest_overlap,
            force,
            energy: force + tally.contact_energy + tally.network_energy,
            power: force * (1.0 + fastest),
        }
    }
}

/// Wall spheres do not rotate: 0 times infinity is 0 here.
fn times(vectors: &[DVec3], factors: &[f64]) -> Vec<DVec3> {
    let all = vectors.iter().zip(factors);
    all.map(|(&vector, &factor)| {
        if vector == DVec3::ZERO {
            vector
        } else {
            vector * factor
        }
    })
    .collect()
}

fn difference(one: &[DVec3], other: &[DVec3]) -> f64 {
    assert_eq!(one.len(), other.len());
    most(one.iter().zip(other).map(|(a, b)| (*a - *b).length()))
}

/// The largest; NaN counts as larger than any number.
fn most(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| {
        if number <= most || most.is_nan() {
            most
        } else {
            number
        }
    })
}

fn relative(one: &[DVec3], other: &[DVec3], scale: f64) -> f64 {
    share(difference(one, other), longest(one).max(scale))
}

/// A difference in units of a scale, 0 where there is no difference.
fn share(difference: f64, scale: f64) -> f64 {
    if difference == 0.0 {
        0.0
    } else {
        difference / scale
    }
}

fn histories(expected: &Simulation, found: &Simulation) -> f64 {
    let (one, other) = (expected.snapshot(), found.snapshot());
    let remembered = one.pair_histories.iter().chain(&one.wall_histories);
    let found = other.pair_histories.iter().chain(&other.wall_histories);
    assert_eq!(one.pair_histories.len(), other.pair_histories.len());
    assert_eq!(one.wall_histories.len(), other.wall_histories.len());
    let numbers = |history: TangentialHistory| {
        let [x, y, z] = history.displacement.to_array();
        let [vx, vy, vz] = history.rate.to_array();
        [x, y, z, vx, vy, vz, history.power]
    };
    let apart = remembered.zip(found).flat_map(|(&one, &other)| {
        assert_eq!(
            (one.0, one.1, one.2.sliding),
            (other.0, other.1, other.2.sliding)
        );
        let pairs = numbers(one.2).into_iter().zip(numbers(other.2));
        pairs.map(|(a, b)| (a - b).abs() / a.abs().max(1.0))
    });
    most(apart)
}

/// Largest difference of the fields of two structs, each in units of its value, or of the scale of a field whose terms
/// cancel. Panics where whole numbers differ.
fn fields<T: Serialize>(one: &T, other: &T, scale: impl Fn(&str) -> f64) -> f64 {
    let [one, other] = [one, other].map(|it| serde_json::to_value(it).expect("numbers"));
    let fields = one.as_object().expect("a struct").iter();
    most(fields.map(|(name, one)| {
        let other = &other[name];
        assert!(!one.is_u64() || one == other, "{name}: {one} and {other}");
        let apart = |(one, other): (&Value, &Value)| match (one.as_f64(), other.as_f64()) {
            (Some(one), Some(other)) => share((one - other).abs(), one.abs().max(scale(name))),
            // No number is written as null.
            _ => f64::NAN,
        };
        match (one.as_array(), other.as_array()) {
            (Some(one), Some(other)) => most(one.iter().zip(other).map(apart)),
            _ => apart((one, other)),
        }
    }))
}

fn tallies(one: &Tally, other: &Tally, totals: &Totals) -> f64 {
    fields(one, other, |name| match name {
        "keep_energy" | "tangential_lost" | "sliding_lost" => totals.energy,
        "wall_power" | "drive_power" | "keep_power" => totals.power,
        "wall_axial_force" => totals.force,
        _ => 0.0,
    })
}

fn ledgers(one: &Ledger, other: &Ledger, totals: &Totals) -> f64 {
    fields(one, other, |name| match name {
        "wall_work" | "drive_work" | "keep_work" | "body_work" | "gross_work" => totals.energy,
        "tangential_dissipated" | "sliding_dissipated" => totals.energy,
        _ => 0.0,
    })
}
