//! Contacts of grains with a prescribed wall, from the records of the fast kernel.

use peristalsis_physics::contact::{ContactLaw, NormalLaw, TangentialLaw};

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
    for grain in 0..spheres.grains {
        let sphere = spheres.sphere(grain);
        let mut force = spheres.force[grain].vector();
        let mut torque = spheres.torque[grain].vector();
        let on_grain = (&mut force, &mut torque);
        wall.add_force(law, (grain, &sphere), on_grain, memory, time_step, tally);
        spheres.force[grain] = Record::new(force, 0.0);
        if T::ROTATES {
            spheres.torque[grain] = Record::new(torque, 0.0);
        }
    }
    if T::ROTATES {
        memory.end();
    }
}
