//! The moving spheres as records, for as long as an advance lasts.

use core::ops::Range;

use glam::DVec3;

use super::record::Record;
use crate::bodies::{Bodies, Sphere};
use crate::fast::threads::Cut;
use crate::integrate::Past;
use crate::wall::Grains;

/// The spheres of [`Bodies`] in records of four numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Spheres {
    pub(super) grains: usize,
    /// Place, and turns round the tube.
    pub(super) position: Vec<Record>,
    /// Velocity, and 0.
    pub(super) velocity: Vec<Record>,
    /// Angular velocity, and the diameter.
    pub(super) turning: Vec<Record>,
    /// Force, and 0; between advances the acceleration.
    pub(super) force: Vec<Record>,
    /// Torque, and 0; between advances the angular acceleration.
    pub(super) torque: Vec<Record>,
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

    pub(super) fn load(&mut self, bodies: &Bodies, past: &Past) {
        self.grains = bodies.grains;
        self.position.clear();
        let places = bodies.position.iter().zip(&bodies.turns);
        self.position
            .extend(places.map(|(&place, &turns)| Record::new(place, f64::from(turns))));
        self.turning.clear();
        let turnings = bodies.angular_velocity.iter().zip(&bodies.diameter);
        self.turning
            .extend(turnings.map(|(&turning, &diameter)| Record::new(turning, diameter)));
        for (records, vectors) in [
            (&mut self.velocity, &bodies.velocity),
            (&mut self.force, &bodies.acceleration),
            (&mut self.torque, &bodies.angular_acceleration),
            (&mut self.velocity_before, &past.velocity),
            (&mut self.turning_before, &past.angular_velocity),
            (&mut self.acceleration_before, &past.acceleration),
            (
                &mut self.angular_acceleration_before,
                &past.angular_acceleration,
            ),
        ] {
            records.clear();
            records.extend(vectors.iter().map(|&vector| Record::new(vector, 0.0)));
        }
        self.inverse_mass.clear();
        self.inverse_mass
            .extend(bodies.mass.iter().map(|mass| 1.0 / mass));
        self.inverse_inertia.clear();
        self.inverse_inertia
            .extend(bodies.inertia.iter().map(|inertia| 1.0 / inertia));
    }

    /// Writes the places back.
    pub(super) fn store_places(&self, bodies: &mut Bodies) {
        for ((place, turns), record) in bodies
            .position
            .iter_mut()
            .zip(&mut bodies.turns)
            .zip(&self.position)
        {
            *place = record.vector();
            *turns = record.0[3] as i32;
        }
    }

    /// Writes everything back; `force` and `torque` must hold accelerations.
    pub(super) fn store(&self, bodies: &mut Bodies, past: &mut Past) {
        self.store_places(bodies);
        for (vectors, records) in [
            (&mut bodies.velocity, &self.velocity),
            (&mut bodies.angular_velocity, &self.turning),
            (&mut bodies.acceleration, &self.force),
            (&mut bodies.angular_acceleration, &self.torque),
            (&mut past.velocity, &self.velocity_before),
            (&mut past.angular_velocity, &self.turning_before),
            (&mut past.acceleration, &self.acceleration_before),
            (
                &mut past.angular_acceleration,
                &self.angular_acceleration_before,
            ),
        ] {
            vectors.clear();
            vectors.extend(records.iter().map(|record| record.vector()));
        }
    }
}

impl Spheres {
    /// What contacts ask of the spheres, and the forces on all of them.
    pub(super) fn with_forces(&mut self) -> (Moving<'_>, ForcesMut<'_>) {
        let moving = Moving {
            grains: self.grains,
            position: &self.position,
            velocity: &self.velocity,
            turning: &self.turning,
        };
        let forces = ForcesMut {
            first: 0,
            force: &mut self.force,
            torque: &mut self.torque,
        };
        (moving, forces)
    }

    /// All of the spheres, to be moved.
    pub(super) fn all_mut(&mut self) -> SpheresMut<'_> {
        SpheresMut {
            first: 0,
            position: &mut self.position,
            line: Degrees {
                velocity: &mut self.velocity,
                force: &mut self.force,
                inverse: &self.inverse_mass,
                velocity_before: &mut self.velocity_before,
                acceleration_before: &mut self.acceleration_before,
            },
            spin: Degrees {
                velocity: &mut self.turning,
                force: &mut self.torque,
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
    pub(super) grains: usize,
    pub(super) position: &'a [Record],
    pub(super) velocity: &'a [Record],
    pub(super) turning: &'a [Record],
}

/// Forces and torques on a stretch of the spheres.
pub(super) struct ForcesMut<'a> {
    /// Number of its first sphere.
    pub(super) first: usize,
    pub(super) force: &'a mut [Record],
    pub(super) torque: &'a mut [Record],
}

impl ForcesMut<'_> {
    pub(super) fn reborrow(&mut self) -> ForcesMut<'_> {
        ForcesMut {
            first: self.first,
            force: self.force,
            torque: self.torque,
        }
    }
}

impl Cut for ForcesMut<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (force, force_behind) = self.force.split_at_mut(at);
        let (torque, torque_behind) = self.torque.split_at_mut(at);
        let before = Self {
            first: self.first,
            force,
            torque,
        };
        let behind = Self {
            first: self.first + at,
            force: force_behind,
            torque: torque_behind,
        };
        (before, behind)
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
    /// Force or torque.
    pub(super) force: &'a mut [Record],
    /// 1/mass or 1/moment of inertia.
    pub(super) inverse: &'a [f64],
    /// Of the step before; none where the integrator needs none.
    pub(super) velocity_before: &'a mut [Record],
    pub(super) acceleration_before: &'a mut [Record],
}

impl Cut for Degrees<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (velocity, velocity_behind) = self.velocity.split_at_mut(at);
        let (force, force_behind) = self.force.split_at_mut(at);
        let (inverse, inverse_behind) = self.inverse.split_at(at);
        let known = at.min(self.velocity_before.len());
        let (velocity_before, its_behind) = self.velocity_before.split_at_mut(known);
        let (acceleration_before, acceleration_behind) = self.acceleration_before.split_at_mut(at);
        let before = Self {
            velocity,
            force,
            inverse,
            velocity_before,
            acceleration_before,
        };
        let behind = Self {
            velocity: velocity_behind,
            force: force_behind,
            inverse: inverse_behind,
            velocity_before: its_behind,
            acceleration_before: acceleration_behind,
        };
        (before, behind)
    }
}

/// The grains of a stretch, with the forces and torques on them.
pub(super) struct GrainsMut<'a> {
    pub(super) moving: Moving<'a>,
    pub(super) forces: ForcesMut<'a>,
}

impl Grains for GrainsMut<'_> {
    fn grains(&self) -> Range<usize> {
        self.forces.first..self.forces.first + self.forces.force.len()
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
        let at = grain - self.forces.first;
        (
            self.forces.force[at].vector(),
            self.forces.torque[at].vector(),
        )
    }

    #[inline(always)]
    fn set_force(&mut self, grain: usize, force: DVec3, torque: DVec3) {
        let at = grain - self.forces.first;
        self.forces.force[at] = Record::new(force, 0.0);
        self.forces.torque[at] = Record::new(torque, 0.0);
    }
}
