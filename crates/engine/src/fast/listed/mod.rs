//! The fast kernel for everything that has a neighbour list: rotating grains, elastic walls, wide tubes.
//!
//! For as long as an advance lasts the spheres live in records ([`spheres`]); a step is one pass over the listed pairs
//! ([`pairs`]), one over the wall ([`network`]) and one over the spheres ([`motion`]).

mod history;
mod motion;
mod network;
mod pairs;
mod record;
mod spheres;

use peristalsis_physics::contact::NormalLaw;

use self::history::PackedHistory;
use self::motion::{Motion, Stage, Travel};
use self::network::{Rows, WallForces};
use self::pairs::{PairForces, Pairs, Prune};
use self::record::Record;
use self::spheres::Spheres;
use crate::fast::machine::Instructions;
use crate::forces::{Reference, evaluate};
use crate::integrate::{Past, Runaway};
use crate::ledger::Tally;
use crate::steps::{Course, Stepper};
use crate::wall::Wall;

/// Room to work in, kept from advance to advance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) instructions: Instructions,
    spheres: Spheres,
    pairs: Pairs,
    rows: Rows,
}

/// The list is made for so many skins.
const LISTED: f64 = 2.5;
/// Pairs within so many skins are chosen from it, again and again, and looked at in each step.
const CHOSEN: f64 = 0.5;

/// Advances by `steps` steps in place of the reference kernel.
pub(crate) fn advance<N: NormalLaw, T: PackedHistory>(
    reference: Reference<'_, N, T>,
    scratch: &mut Scratch,
    course: &mut Course,
    steps: u64,
) -> Result<(), Runaway> {
    if steps == 0 {
        return Ok(());
    }
    let Reference {
        contacts,
        bodies,
        past,
        ..
    } = &reference;
    scratch.spheres.load(bodies, past);
    scratch.pairs.load::<T>(&contacts.pairs, bodies);
    let mut listed = Listed {
        reference,
        scratch,
        stage: Stage::First,
        mean_wall_force: Record::ZERO,
        // The list may have been made long ago, and nothing is chosen from it yet.
        travelled: Travel {
            axial: f64::INFINITY,
            lateral: 0.0,
        },
    };
    let outcome = course.advance(&mut listed, steps);
    let Listed {
        reference, scratch, ..
    } = listed;
    scratch.pairs.store::<T>(&mut reference.contacts.pairs);
    scratch.spheres.store(reference.bodies, reference.past);
    outcome
}

/// The kernel for one advance.
struct Listed<'a, N, T: PackedHistory> {
    /// Its list of pairs serves; its spheres are brought up to date where it is made anew.
    reference: Reference<'a, N, T>,
    scratch: &'a mut Scratch,
    stage: Stage,
    /// Still to be taken off the force on each sphere of the wall.
    mean_wall_force: Record,
    /// Since pairs were last chosen from the list.
    travelled: Travel,
}

impl<N: NormalLaw, T: PackedHistory> Listed<'_, N, T> {
    fn pass(&mut self) -> Result<Travel, Runaway> {
        let parameters = self.reference.parameters;
        self.scratch.instructions.run(Motion {
            spheres: &mut self.scratch.spheres,
            integrator: parameters.integrator,
            stage: self.stage,
            mean_wall_force: self.mean_wall_force,
            rotates: T::ROTATES,
            body_force: parameters.body_force,
            time_step: parameters.time_step,
            limit: self.reference.limit,
            length: self.reference.length,
        })
    }

    /// Chooses the pairs that may touch in the steps to come; makes the list anew where it does not hold them all.
    fn choose_pairs(&mut self, wall: &Wall) {
        let (skin, length) = (self.reference.parameters.skin, self.reference.length);
        let (contacts, bodies) = (&mut *self.reference.contacts, &mut *self.reference.bodies);
        let (spheres, pairs) = (&self.scratch.spheres, &mut self.scratch.pairs);
        spheres.store_places(bodies);
        let (places, turns) = (&bodies.position, &bodies.turns);
        if !contacts.pairs.covers(places, turns, length, CHOSEN * skin) {
            pairs.store::<T>(&mut contacts.pairs);
            contacts.rebuild(bodies, wall, LISTED * skin);
            pairs.load::<T>(&contacts.pairs, bodies);
        }
        self.scratch.instructions.run(Prune {
            pairs,
            spheres,
            length,
            skin: CHOSEN * skin,
        });
        self.travelled = Travel::default();
    }
}

impl<N: NormalLaw, T: PackedHistory> Stepper for Listed<'_, N, T> {
    fn move_spheres(&mut self) -> Result<(), Runaway> {
        let travelled = self.pass()?;
        self.travelled.add(travelled);
        self.stage = Stage::Between;
        Ok(())
    }

    fn contact_energy(&mut self, wall: &Wall) -> f64 {
        let reference = &self.reference;
        let (mut bodies, mut contacts) = (reference.bodies.clone(), reference.contacts.clone());
        // With their velocities: contacts that slide store less.
        self.scratch
            .spheres
            .store(&mut bodies, &mut Past::default());
        self.scratch.pairs.store::<T>(&mut contacts.pairs);
        contacts.refresh(&bodies, wall, reference.parameters.skin);
        evaluate(reference.law, &mut bodies, wall, &mut contacts, 0.0).contact_energy
    }

    fn evaluate(&mut self, wall: &Wall, _complete: bool) -> Tally {
        if self
            .travelled
            .exceeds(CHOSEN * self.reference.parameters.skin)
        {
            self.choose_pairs(wall);
        }
        let (law, time_step) = (self.reference.law, self.reference.parameters.time_step);
        let Scratch {
            instructions,
            spheres,
            pairs,
            rows,
        } = &mut *self.scratch;
        let mut tally = Tally::default();
        instructions.run(PairForces {
            law,
            pairs,
            spheres,
            length: self.reference.length,
            time_step,
            tally: &mut tally,
        });
        let memory = &mut self.reference.contacts.wall;
        wall.add_forces(law, spheres, memory, time_step, &mut tally);
        if let Some(wall) = wall.elastic() {
            self.mean_wall_force = instructions.run(WallForces {
                wall,
                rows,
                spheres,
                tally: &mut tally,
            });
        }
        tally
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        self.stage = Stage::Last;
        self.pass().map(|_| ())
    }
}
