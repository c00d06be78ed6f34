//! The contacts of a simulation as they stand, one by one.

use peristalsis_physics::with_normal_law;

use super::Simulation;
use crate::contacts::{Memory, with_contact_law};
use crate::fast::threads::Threads;
use crate::parameters::Parameters;
use crate::touching::{Touching, for_each_touching};
use crate::wall_contacts::{WallContact, add_up_smooth_contacts, for_each_contact};

impl Simulation {
    /// Calls `visit` for each contact of a grain with the wall as all stands now, in a fixed order.
    ///
    /// The forces differ from the forces of the last step only by the velocities, which the integrator has corrected since.
    pub fn for_each_wall_contact(&self, visit: impl FnMut(WallContact)) {
        let Parameters {
            contact, time_step, ..
        } = self.parameters;
        with_contact_law!(contact.normal, &self.memory, |law, contacts| {
            for_each_contact(law, &self.bodies, self.wall(), contacts, time_step, visit);
        });
    }

    /// Sums over the contacts of grains with the wall, in the order of [`Simulation::for_each_wall_contact`], piece by piece
    /// of the grains: `begin` makes the sums of a piece, pieces counted from 0, and `add` adds a contact to them. There is
    /// one piece at least; pieces, and so all sums, are the same for any number of threads.
    pub fn add_up_wall_contacts<S: Send>(
        &self,
        begin: impl Fn(usize) -> S + Sync,
        add: impl Fn(&mut S, WallContact) + Sync,
    ) -> Vec<S> {
        if let (0, Memory::Smooth(_)) = (self.wall().mobile_spheres(), &self.memory) {
            let (alone, threads) = (Threads::default(), &self.scratch.threads);
            let threads = if threads.are_here() { threads } else { &alone };
            return with_normal_law!(self.parameters().contact.normal, law => {
                add_up_smooth_contacts(law, self.bodies(), self.wall(), threads, begin, add)
            });
        }
        let mut sums = begin(0);
        self.for_each_wall_contact(|contact| add(&mut sums, contact));
        vec![sums]
    }

    /// Calls `visit` for all contacts as they are now, with their forces; grain by grain.
    pub fn for_each_touching(&self, visit: &mut dyn FnMut(Touching)) {
        let normal = self.parameters().contact.normal;
        let (bodies, wall) = (self.bodies(), self.wall());
        with_contact_law!(normal, &self.memory, |law, contacts| for_each_touching(
            law, bodies, wall, contacts, visit
        ));
    }

    /// All contacts as they are now: see [`Simulation::for_each_touching`].
    pub fn touching(&self) -> Vec<Touching> {
        let mut found = Vec::new();
        self.for_each_touching(&mut |touching| found.push(touching));
        found
    }
}
