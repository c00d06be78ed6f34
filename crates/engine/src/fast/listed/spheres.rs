//! The moving spheres as records, for as long as an advance lasts.

use core::ops::Range;

use glam::DVec3;

use super::record::Record;
use crate::bodies::{Bodies, Sphere, fold};
use crate::fast::lanes::LANES;
use crate::fast::threads::Cut;
use crate::integrate::Past;
use crate::wall::Grains;

/// The spheres of [`Bodies`] in records of four numbers, section after section: its grains, then its spheres of the wall.
#[derive(Clone, Debug, Default)]
pub(super) struct Spheres {
    pub(super) grains: usize,
    /// The number of the sphere at each place, and the place of each sphere.
    pub(super) number: Vec<u32>,
    pub(super) place: Vec<u32>,
    /// Where it is, and turns round the tube.
    pub(super) position: Vec<Record>,
    /// Velocity, and 0.
    pub(super) velocity: Vec<Record>,
    /// Angular velocity, and the diameter, with a minus for spheres of the wall.
    pub(super) turning: Vec<Record>,
    /// Of the step before, as the integrator's [`Past`] has them.
    pub(super) velocity_before: Vec<Record>,
    pub(super) turning_before: Vec<Record>,
    pub(super) acceleration_before: Vec<Record>,
    pub(super) angular_acceleration_before: Vec<Record>,
    pub(super) inverse_mass: Vec<f64>,
    pub(super) inverse_inertia: Vec<f64>,
}

impl Spheres {
    pub(super) fn number(&self) -> usize {
        self.position.len()
    }

    /// Takes the spheres up, each at its place by `self.number`.
    pub(super) fn load(&mut self, bodies: &Bodies, past: &Past) {
        self.grains = bodies.grains;
        let numbers = self.number.iter().map(|&number| number as usize);
        self.place.resize(self.number.len(), 0);
        for (place, number) in (0..).zip(numbers.clone()) {
            self.place[number] = place;
        }
        self.position.clear();
        let record = |i: usize| Record::new(bodies.position[i], f64::from(bodies.turns[i]));
        self.position.extend(numbers.clone().map(record));
        self.turning.clear();
        let record = |i: usize| {
            let diameter = bodies.diameter[i];
            let signed = if i < bodies.grains {
                diameter
            } else {
                -diameter
            };
            Record::new(bodies.angular_velocity[i], signed)
        };
        self.turning.extend(numbers.clone().map(record));
        for (records, vectors) in [
            (&mut self.velocity, &bodies.velocity),
            (&mut self.velocity_before, &past.velocity),
            (&mut self.turning_before, &past.angular_velocity),
            (&mut self.acceleration_before, &past.acceleration),
            (
                &mut self.angular_acceleration_before,
                &past.angular_acceleration,
            ),
        ] {
            records.clear();
            // The past of a first step is empty.
            if !vectors.is_empty() {
                records.extend(numbers.clone().map(|i| Record::new(vectors[i], 0.0)));
            }
        }
        self.inverse_mass.clear();
        self.inverse_mass
            .extend(numbers.clone().map(|i| 1.0 / bodies.mass[i]));
        self.inverse_inertia.clear();
        self.inverse_inertia
            .extend(numbers.map(|i| 1.0 / bodies.inertia[i]));
    }

    /// Writes the places back.
    fn store_places(&self, bodies: &mut Bodies) {
        for (&number, record) in self.number.iter().zip(&self.position) {
            bodies.position[number as usize] = record.vector();
            bodies.turns[number as usize] = record.0[3] as i32;
        }
    }

    /// Writes down where the spheres would be `time` later if their velocities stayed as they are.
    pub(super) fn store_places_ahead(&self, bodies: &mut Bodies, time: f64, length: f64) {
        let spheres = self.position.iter().zip(&self.velocity);
        for (&number, (position, velocity)) in self.number.iter().zip(spheres) {
            let mut place = position.vector() + velocity.vector() * time;
            let more;
            (place.z, more) = fold(place.z, length);
            bodies.position[number as usize] = place;
            bodies.turns[number as usize] = position.0[3] as i32 + more;
        }
    }

    /// Writes everything back but forces and torques.
    pub(super) fn store(&self, bodies: &mut Bodies, past: &mut Past) {
        self.store_places(bodies);
        for (vectors, records) in [
            (&mut bodies.velocity, &self.velocity),
            (&mut bodies.angular_velocity, &self.turning),
            (&mut past.velocity, &self.velocity_before),
            (&mut past.angular_velocity, &self.turning_before),
            (&mut past.acceleration, &self.acceleration_before),
            (
                &mut past.angular_acceleration,
                &self.angular_acceleration_before,
            ),
        ] {
            vectors.resize(records.len(), DVec3::ZERO);
            for (&number, record) in self.number.iter().zip(records) {
                vectors[number as usize] = record.vector();
            }
        }
    }

    /// What contacts ask of the spheres.
    pub(super) fn moving(&self) -> Moving<'_> {
        Moving {
            position: &self.position,
            velocity: &self.velocity,
            turning: &self.turning,
        }
    }

    /// All of the spheres, to be moved.
    pub(super) fn all_mut(&mut self) -> SpheresMut<'_> {
        SpheresMut {
            first: 0,
            position: &mut self.position,
            line: Degrees {
                velocity: &mut self.velocity,
                inverse: &self.inverse_mass,
                velocity_before: &mut self.velocity_before,
                acceleration_before: &mut self.acceleration_before,
            },
            spin: Degrees {
                velocity: &mut self.turning,
                inverse: &self.inverse_inertia,
                velocity_before: &mut self.turning_before,
                acceleration_before: &mut self.angular_acceleration_before,
            },
        }
    }
}

/// Where the spheres are and how they move.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    pub(super) position: &'a [Record],
    pub(super) velocity: &'a [Record],
    pub(super) turning: &'a [Record],
}

/// Forces and torques on the spheres of a section: its grains, its spheres of the wall, and behind them one place for all
/// spheres of other sections, where nobody reads. Between advances, accelerations.
#[derive(Clone, Debug, Default)]
pub(super) struct Forces {
    pub(super) force: Vec<Record>,
    pub(super) torque: Vec<Record>,
    pub(super) own: Own,
}

/// The places of the spheres of a section.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Own {
    pub(super) start: usize,
    /// How many of its spheres are grains; they come first.
    pub(super) grains: usize,
    pub(super) number: usize,
}

impl Own {
    /// Where the forces on the spheres at these places are added up.
    #[inline(always)]
    pub(super) fn at(self, places: &[u32; LANES]) -> [u32; LANES] {
        let (start, number) = (self.start as u32, self.number as u32);
        places.map(|place| place.wrapping_sub(start).min(number))
    }

    /// Whether the sphere at a place belongs to the section.
    #[inline(always)]
    pub(super) fn holds(self, place: usize) -> bool {
        place.wrapping_sub(self.start) < self.number
    }

    pub(super) fn all(self) -> Range<usize> {
        self.start..self.start + self.number
    }

    pub(super) fn of_grains(self) -> Range<usize> {
        self.start..self.start + self.grains
    }

    pub(super) fn of_wall(self) -> Range<usize> {
        self.start + self.grains..self.start + self.number
    }
}

impl Forces {
    /// Takes the accelerations of the spheres up that belong to the section.
    pub(super) fn load(&mut self, own: Own, bodies: &Bodies, numbers: &[u32]) {
        self.own = own;
        for (records, vectors) in [
            (&mut self.force, &bodies.acceleration),
            (&mut self.torque, &bodies.angular_acceleration),
        ] {
            records.clear();
            let numbers = numbers[own.all()].iter();
            records.extend(numbers.map(|&number| Record::new(vectors[number as usize], 0.0)));
            records.push(Record::ZERO);
        }
    }

    /// Writes the accelerations back.
    pub(super) fn store(&self, bodies: &mut Bodies, numbers: &[u32]) {
        for (vectors, records) in [
            (&mut bodies.acceleration, &self.force),
            (&mut bodies.angular_acceleration, &self.torque),
        ] {
            for (&number, record) in numbers[self.own.all()].iter().zip(records) {
                vectors[number as usize] = record.vector();
            }
        }
    }

    pub(super) fn of_grains(&mut self) -> [&mut [Record]; 2] {
        let grains = self.own.grains;
        [&mut self.force[..grains], &mut self.torque[..grains]]
    }

    pub(super) fn of_wall(&mut self) -> [&mut [Record]; 2] {
        let wall = self.own.grains..self.own.number;
        [&mut self.force[wall.clone()], &mut self.torque[wall]]
    }
}

/// A stretch of the spheres.
pub(super) struct SpheresMut<'a> {
    /// Number of its first sphere.
    pub(super) first: usize,
    pub(super) position: &'a mut [Record],
    pub(super) line: Degrees<'a>,
    pub(super) spin: Degrees<'a>,
}

impl Cut for SpheresMut<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (position, position_behind) = self.position.split_at_mut(at);
        let (line, line_behind) = self.line.cut(at);
        let (spin, spin_behind) = self.spin.cut(at);
        let before = Self {
            first: self.first,
            position,
            line,
            spin,
        };
        let behind = Self {
            first: self.first + at,
            position: position_behind,
            line: line_behind,
            spin: spin_behind,
        };
        (before, behind)
    }
}

/// Motion along lines, or spin, of a stretch of the spheres.
pub(super) struct Degrees<'a> {
    pub(super) velocity: &'a mut [Record],
    /// 1/mass or 1/moment of inertia.
    pub(super) inverse: &'a [f64],
    /// Of the step before; none where the integrator needs none.
    pub(super) velocity_before: &'a mut [Record],
    pub(super) acceleration_before: &'a mut [Record],
}

impl Cut for Degrees<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (velocity, velocity_behind) = self.velocity.split_at_mut(at);
        let (inverse, inverse_behind) = self.inverse.split_at(at);
        let known = at.min(self.velocity_before.len());
        let (velocity_before, its_behind) = self.velocity_before.split_at_mut(known);
        let (acceleration_before, acceleration_behind) = self.acceleration_before.split_at_mut(at);
        let before = Self {
            velocity,
            inverse,
            velocity_before,
            acceleration_before,
        };
        let behind = Self {
            velocity: velocity_behind,
            inverse: inverse_behind,
            velocity_before: its_behind,
            acceleration_before: acceleration_behind,
        };
        (before, behind)
    }
}

/// The grains of a section, with the forces and torques on them.
pub(super) struct GrainsMut<'a> {
    pub(super) moving: Moving<'a>,
    /// Place of the first.
    pub(super) first: usize,
    pub(super) forces: [&'a mut [Record]; 2],
}

impl Grains for GrainsMut<'_> {
    fn grains(&self) -> Range<usize> {
        self.first..self.first + self.forces[0].len()
    }

    #[inline(always)]
    fn sphere(&self, grain: usize) -> Sphere {
        let turning = self.moving.turning[grain];
        Sphere {
            position: self.moving.position[grain].vector(),
            velocity: self.moving.velocity[grain].vector(),
            angular_velocity: turning.vector(),
            diameter: turning.0[3],
        }
    }

    #[inline(always)]
    fn force(&self, grain: usize) -> (DVec3, DVec3) {
        let [force, torque] = &self.forces;
        let at = grain - self.first;
        (force[at].vector(), torque[at].vector())
    }

    #[inline(always)]
    fn set_force(&mut self, grain: usize, force: DVec3, torque: DVec3) {
        let at = grain - self.first;
        self.forces[0][at] = Record::new(force, 0.0);
        self.forces[1][at] = Record::new(torque, 0.0);
    }
}
