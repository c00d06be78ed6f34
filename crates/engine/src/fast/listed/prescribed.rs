//! Contacts of grains with a prescribed wall, from the records of the fast kernel.

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, NormalLaw, TangentialLaw};

use super::record::Record;
use super::spheres::Spheres;
use crate::ledger::Tally;
use crate::wall::PrescribedWall;
use crate::wall::memory::WallMemory;

/// Adds the forces and torques of the wall on the grains, as [`PrescribedWall::add_forces`] does.
pub(super) fn add_forces<N: NormalLaw, T: TangentialLaw>(
    wall: &PrescribedWall,
    law: &ContactLaw<N, T>,
    spheres: &mut Spheres,
    memory: &mut WallMemory<T::History<f64>>,
    time_step: f64,
    tally: &mut Tally,
) {
    if T::ROTATES {
        memory.begin();
    }
    let wall_diameter = wall.lattice().sphere_diameter;
    for grain in 0..spheres.grains {
        let centre = spheres.position[grain].vector();
        let velocity = spheres.velocity[grain].vector();
        let angular_velocity = spheres.spin[grain].vector();
        let diameter = spheres.spin[grain].0[3];
        let mut force = spheres.force[grain].vector();
        let mut torque = spheres.torque[grain].vector();
        let reach = 0.5 * (diameter + wall_diameter);
        let reduced_radius = diameter * wall_diameter / (2.0 * (diameter + wall_diameter));
        wall.for_each_touching(centre, diameter, |sphere, separation, wall_velocity| {
            let distance = separation.length();
            let overlap = reach - distance;
            if overlap <= 0.0 || distance == 0.0 {
                return;
            }
            let arm = 0.5 * (diameter - overlap);
            let contact = Contact {
                overlap,
                distance,
                normal: separation * (1.0 / distance),
                relative_velocity: velocity - wall_velocity,
                reduced_radius,
                spin: if T::ROTATES {
                    arm * angular_velocity
                } else {
                    DVec3::ZERO
                },
            };
            let mut history = T::History::<f64>::default();
            if T::ROTATES {
                history = memory.take(grain, sphere);
            }
            let answer = law.force(&contact, &mut history, time_step);
            if T::ROTATES {
                memory.put(sphere, history);
                torque += arm * answer.twist;
            }
            force += answer.force;
            tally.add_contact(&answer, overlap);
            tally.wall_contacts += 1;
            tally.wall_power += answer.force.dot(wall_velocity);
            tally.wall_axial_force += answer.force.z;
        });
        spheres.force[grain] = Record::new(force, 0.0);
        if T::ROTATES {
            spheres.torque[grain] = Record::new(torque, 0.0);
            for ended in memory.end_grain(grain) {
                tally.history_reset += law.tangential.stored_energy(ended);
            }
        }
    }
    if T::ROTATES {
        memory.end();
    }
}
