//! The moving spheres as records, for as long as an advance lasts.

use glam::DVec3;

use super::record::Record;
use crate::bodies::{Bodies, Sphere};
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

impl Grains for Spheres {
    fn grains(&self) -> usize {
        self.grains
    }

    #[inline(always)]
    fn sphere(&self, grain: usize) -> Sphere {
        let turning = self.turning[grain];
        Sphere {
            position: self.position[grain].vector(),
            velocity: self.velocity[grain].vector(),
            angular_velocity: turning.vector(),
            diameter: turning.0[3],
        }
    }

    #[inline(always)]
    fn force(&self, grain: usize) -> (DVec3, DVec3) {
        (self.force[grain].vector(), self.torque[grain].vector())
    }

    #[inline(always)]
    fn set_force(&mut self, grain: usize, force: DVec3, torque: DVec3) {
        self.force[grain] = Record::new(force, 0.0);
        self.torque[grain] = Record::new(torque, 0.0);
    }
}
