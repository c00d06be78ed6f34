//! The reference kernel: every force on every sphere, plainly.
//!
//! Faster kernels are tested against this one. It is written once for all laws: the contact law is a type parameter,
//! chosen once per [`crate::Simulation::advance`].

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, Frictionless, NormalLaw, TangentialLaw};

use crate::bodies::Bodies;
use crate::ledger::Tally;
use crate::neighbours::{Neighbours, PairRule, periodic};
use crate::wall::Wall;
use crate::wall::memory::WallMemory;

/// What contacts remember, between moving spheres and with a prescribed wall.
#[derive(Clone, Debug)]
pub(crate) struct Contacts<H> {
    pub(crate) pairs: Neighbours<H>,
    pub(crate) wall: WallMemory<H>,
}

impl<H: Copy + Default + PartialEq> Contacts<H> {
    pub(crate) fn none() -> Self {
        Self {
            pairs: Neighbours::empty(),
            wall: WallMemory::default(),
        }
    }

    /// Makes the neighbour list anew where it no longer holds.
    pub(crate) fn refresh(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        let length = wall.lattice().length();
        if self
            .pairs
            .outdated(&bodies.position, &bodies.turns, length, skin)
        {
            self.rebuild(bodies, wall, skin);
        }
    }

    /// Makes the neighbour list anew.
    pub(crate) fn rebuild(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        let grains = bodies.grains;
        let rule = PairRule {
            diameter: &bodies.diameter,
            length: wall.lattice().length(),
            skin,
            half_width: wall.usual_radius(),
            admits_all_below: grains,
            admits: |i: usize, j: usize| match wall {
                Wall::Elastic(wall) => wall.may_touch(i - grains, j - grains),
                Wall::Prescribed(_) => true,
            },
        };
        self.pairs.rebuild(&bodies.position, &bodies.turns, &rule);
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
    let length = wall.lattice().length();
    add_pairs(
        law,
        bodies,
        &mut contacts.pairs,
        length,
        time_step,
        &mut tally,
    );
    match wall {
        Wall::Prescribed(wall) => {
            wall.add_forces(law, bodies, &mut contacts.wall, time_step, &mut tally);
        }
        Wall::Elastic(wall) => wall.add_forces(bodies, &mut tally),
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

/// Adds the body force, force over mass along +z, to the accelerations of the grains.
pub(crate) fn add_body_force(bodies: &mut Bodies, body_force: f64) {
    // Nothing added leaves even the sign of a zero as it is.
    if body_force != 0.0 {
        for acceleration in &mut bodies.acceleration[..bodies.grains] {
            acceleration.z += body_force;
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
        let (centre, velocity, diameter) =
            (bodies.position[i], bodies.velocity[i], bodies.diameter[i]);
        let mut force = bodies.acceleration[i];
        let (partners, histories) = pairs.row(i);
        for (&partner, history) in partners.iter().zip(histories) {
            let j = partner as usize;
            let separation = periodic(centre - bodies.position[j], length);
            let reach = 0.5 * (diameter + bodies.diameter[j]);
            let squared = separation.length_squared();
            if squared >= reach * reach || squared == 0.0 {
                if T::ROTATES {
                    tally.history_reset += law.tangential.stored_energy(history);
                    *history = T::History::<f64>::default();
                }
                continue;
            }
            let distance = squared.sqrt();
            let overlap = reach - distance;
            let arms = (
                0.5 * (diameter - overlap),
                0.5 * (bodies.diameter[j] - overlap),
            );
            let contact = Contact {
                overlap,
                distance,
                normal: separation * (1.0 / distance),
                relative_velocity: velocity - bodies.velocity[j],
                reduced_radius: diameter * bodies.diameter[j]
                    / (2.0 * (diameter + bodies.diameter[j])),
                spin: if T::ROTATES {
                    arms.0 * bodies.angular_velocity[i] + arms.1 * bodies.angular_velocity[j]
                } else {
                    DVec3::ZERO
                },
            };
            if i >= grains {
                // Wall against wall, across a closing throat: the same normal law, no friction.
                let smooth = ContactLaw {
                    normal: law.normal,
                    tangential: Frictionless,
                };
                let answer = smooth.force(&contact, &mut (), time_step);
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
                bodies.angular_acceleration[i] += arms.0 * answer.twist;
                bodies.angular_acceleration[j] += arms.1 * answer.twist;
            }
            tally.add_contact(&answer, overlap);
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
