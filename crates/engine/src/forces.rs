//! The reference kernel: every force on every sphere, plainly.
//!
//! Faster kernels are tested against this one. It is written once for all laws: the contact law is a type parameter,
//! chosen once per [`crate::Simulation::advance`].

use glam::DVec3;
use peristalsis_physics::contact::{ContactLaw, NormalLaw, TangentialLaw};

use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::integrate::{Past, Runaway, after_forces, before_forces};
use crate::ledger::Tally;
use crate::neighbours::{Neighbours, periodic};
use crate::parameters::Parameters;
use crate::steps::Stepper;
use crate::wall::Wall;

/// The reference kernel for one advance.
pub(crate) struct Reference<'a, N, T: TangentialLaw> {
    pub(crate) law: &'a ContactLaw<N, T>,
    pub(crate) contacts: &'a mut Contacts<T::History<f64>>,
    pub(crate) bodies: &'a mut Bodies,
    pub(crate) past: &'a mut Past,
    pub(crate) parameters: &'a Parameters,
    /// Longest displacement of a step \[d\].
    pub(crate) limit: f64,
    /// Period of the tube \[d\].
    pub(crate) length: f64,
    /// Sums of the last evaluation.
    pub(crate) sums: Tally,
}

impl<N: NormalLaw, T: TangentialLaw> Stepper for Reference<'_, N, T> {
    fn move_spheres(&mut self) -> Result<(), Runaway> {
        let (integrator, time_step) = (self.parameters.integrator, self.parameters.time_step);
        before_forces(integrator, self.bodies, self.past, time_step, self.limit)?;
        self.bodies.fold(self.length);
        Ok(())
    }

    fn tally(&mut self, wall: &Wall) -> Tally {
        let (mut bodies, mut contacts) = (self.bodies.clone(), self.contacts.clone());
        let (parameters, time_step) = (self.parameters, self.parameters.time_step);
        contacts.refresh(&bodies, wall, parameters.skin);
        evaluate(self.law, &mut bodies, wall, &mut contacts, time_step)
    }

    fn evaluate(&mut self, wall: &Wall, _complete: bool) {
        let (parameters, time_step) = (self.parameters, self.parameters.time_step);
        self.contacts.refresh(self.bodies, wall, parameters.skin);
        self.sums = evaluate(self.law, self.bodies, wall, self.contacts, time_step);
        add_body_force(self.bodies, parameters.body_force);
        after_forces(parameters.integrator, self.bodies, self.past, time_step);
    }

    fn sums(&mut self) -> Tally {
        self.sums
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        Ok(())
    }
}

/// Evaluates all accelerations at the present positions and velocities, at the end of a step of length `time_step`.
pub(crate) fn evaluate<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &mut Bodies,
    wall: &Wall,
    contacts: &mut Contacts<T::History<f64>>,
    time_step: f64,
) -> Tally {
    let mut tally = Tally::default();
    bodies.acceleration.fill(DVec3::ZERO);
    if T::ROTATES {
        bodies.angular_acceleration.fill(DVec3::ZERO);
    }
    let length = wall.length();
    let pairs = &mut contacts.pairs;
    add_pairs(law, bodies, pairs, length, time_step, &mut tally);
    wall.add_forces(law, bodies, &mut contacts.wall, time_step, &mut tally);
    if let Some(wall) = wall.elastic() {
        wall.add_forces(bodies, &mut tally);
    }
    // Until here the arrays held forces and torques.
    for (acceleration, mass) in bodies.acceleration.iter_mut().zip(&bodies.mass) {
        *acceleration /= *mass;
    }
    if T::ROTATES {
        for (acceleration, inertia) in bodies.angular_acceleration.iter_mut().zip(&bodies.inertia) {
            *acceleration /= *inertia;
        }
    }
    tally
}

/// Adds the body force, force over mass, to the accelerations of the grains.
pub(crate) fn add_body_force(bodies: &mut Bodies, body_force: DVec3) {
    // Nothing added leaves even the sign of a zero as it is.
    if body_force != DVec3::ZERO {
        for acceleration in &mut bodies.acceleration[..bodies.grains] {
            *acceleration += body_force;
        }
    }
}

/// Adds the forces and torques of contacts between moving spheres.
fn add_pairs<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &mut Bodies,
    pairs: &mut Neighbours<T::History<f64>>,
    length: f64,
    time_step: f64,
    tally: &mut Tally,
) {
    let grains = bodies.grains;
    for i in 0..bodies.number() {
        let (centre, diameter) = (bodies.position[i], bodies.diameter[i]);
        let mut force = bodies.acceleration[i];
        let (partners, histories) = pairs.row(i);
        for (&partner, history) in partners.iter().zip(histories) {
            let j = partner as usize;
            let separation = periodic(centre - bodies.position[j], length);
            let reach = 0.5 * (diameter + bodies.diameter[j]);
            let squared = separation.length_squared();
            let contact = || bodies.sphere(i).contact(&bodies.sphere(j), separation);
            // Walls do not cohere with themselves.
            let is_apart = match T::IS_GENERAL && i < grains {
                true => !law.acts(&contact(), history),
                false => squared >= reach * reach || squared == 0.0,
            };
            if is_apart {
                if T::ROTATES {
                    tally.history_reset += law.tangential.stored_energy(history);
                    tally.cohesion_lost += law.tangential.bond(history);
                    *history = T::History::<f64>::default();
                }
                continue;
            }
            let contact = contact();
            if i >= grains {
                // Wall against wall, across a closing throat: the same normal law, no friction.
                let answer = law.frictionless().force(&contact, &mut (), time_step);
                force += answer.force;
                bodies.acceleration[j] -= answer.force;
                tally.contact_energy += answer.energy;
                tally.normal_dissipation += answer.normal_dissipation;
                continue;
            }
            let answer = law.force(&contact, history, time_step);
            force += answer.force;
            bodies.acceleration[j] -= answer.force;
            if T::ROTATES {
                for sphere in [i, j] {
                    let arm = contact.arm(bodies.diameter[sphere]);
                    bodies.angular_acceleration[sphere] += arm * answer.torque_per_arm;
                }
            }
            if T::IS_GENERAL {
                bodies.angular_acceleration[i] += answer.rolling.couple;
                bodies.angular_acceleration[j] -= answer.rolling.couple;
                tally.rolling_lost += answer.rolling.lost;
            }
            tally.add_contact(&answer, contact.overlap);
            if j < grains {
                tally.grain_contacts += 1;
            } else {
                tally.wall_contacts += 1;
                tally.wall_axial_force += answer.force.z;
            }
        }
        bodies.acceleration[i] = force;
    }
}
