//! Contacts of grains with a prescribed wall, from the records of the fast kernel.

use peristalsis_physics::contact::{ContactLaw, NormalLaw, TangentialLaw};

use super::record::Record;
use super::spheres::Spheres;
use crate::ledger::Tally;
use crate::wall::PrescribedWall;
use crate::wall::memory::WallMemory;
use crate::wall::prescribed::GrainState;

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
    for grain in 0..spheres.grains {
        let state = GrainState {
            centre: spheres.position[grain].vector(),
            velocity: spheres.velocity[grain].vector(),
            angular_velocity: spheres.spin[grain].vector(),
            diameter: spheres.spin[grain].0[3],
        };
        let mut force = spheres.force[grain].vector();
        let mut torque = spheres.torque[grain].vector();
        wall.add_force(
            law,
            grain,
            &state,
            (&mut force, &mut torque),
            memory,
            time_step,
            tally,
        );
        spheres.force[grain] = Record::new(force, 0.0);
        if T::ROTATES {
            spheres.torque[grain] = Record::new(torque, 0.0);
        }
    }
    if T::ROTATES {
        memory.end();
    }
}
