//! The fast kernel for everything that has a neighbour list: rotating grains, elastic walls, wide tubes.
//!
//! For as long as an advance lasts the spheres live in records ([`spheres`]); a step is one pass over the listed pairs
//! ([`pairs`], [`contacts`]), one over the wall ([`network`]) and one over the spheres ([`motion`]).
//!
//! One thread adds forces as it finds them. Several work out the contacts of a stretch of the list each and keep the
//! answers ([`answers`]); then they add up the forces on a stretch of the spheres each. Every sphere adds in the order of
//! the list, and every sum has the order that one thread gives it ([`book`]): the bits are the same.

mod answers;
mod book;
mod contacts;
mod forces;
mod history;
mod motion;
mod network;
mod pairs;
mod record;
mod spheres;
mod stretch;

use peristalsis_physics::contact::NormalLaw;

use self::history::PackedHistory;
use self::motion::{Motion, Moved, Stage, Travel};
use self::pairs::{Pairs, Prune};
use self::record::Record;
use self::spheres::Spheres;
use self::stretch::{BesideWall, Stretch, share_out};
use crate::contacts::Contacts;
use crate::fast::machine::Instructions;
use crate::fast::threads::Threads;
use crate::forces::{Reference, evaluate};
use crate::integrate::{Past, Runaway};
use crate::ledger::Tally;
use crate::neighbours::{Drift, Neighbours};
use crate::steps::{Course, Stepper};
use crate::wall::Wall;
use crate::wall::memory::WallMemory;
use crate::wall::sums::Waiting;

/// Room to work in, kept from advance to advance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) instructions: Instructions,
    pub(crate) threads: Threads,
    spheres: Spheres,
    stretches: Vec<Stretch>,
    /// Which stretch each sphere is in.
    stretch_of: Vec<u16>,
    /// The listed pairs of each stretch.
    pairs: Vec<Pairs>,
    /// Places in the list of all that remember a contact.
    held: Vec<u32>,
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
    let threads = scratch.threads.clone();
    threads.install(|| {
        let mut listed = Listed::begin(reference, scratch, &course.wall);
        let outcome = course.advance(&mut listed, steps);
        let Reference { contacts, .. } = &mut listed.reference;
        listed
            .scratch
            .store_histories::<T>(contacts, &listed.beside_wall);
        let Reference { bodies, past, .. } = listed.reference;
        listed.scratch.spheres.store(bodies, past);
        outcome
    })
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
    /// The stretches of grains, where several threads serve a prescribed wall.
    beside_wall: Vec<BesideWall<T::History<f64>>>,
}

impl Scratch {
    /// Makes the flat lists from the rows, without histories.
    fn load_pairs<N, T: PackedHistory>(&mut self, reference: &Reference<'_, N, T>) {
        let (list, bodies) = (&reference.contacts.pairs, &*reference.bodies);
        self.threads
            .each(&mut self.pairs, (), &|_| 0, &|pairs, ()| {
                pairs.load::<T>(list, bodies);
            });
    }

    /// How far the spheres have gone since a list of them was made.
    fn drift<H: Copy + Default + PartialEq + Sync>(
        &mut self,
        list: &Neighbours<H>,
        length: f64,
    ) -> Drift {
        let position = &self.spheres.position[..];
        let stretches = &mut self.stretches[..];
        self.threads.each(stretches, (), &|_| 0, &|stretch, ()| {
            let places = position[stretch.spheres.clone()].iter();
            let unfolded = places.map(|place| place.unfolded(length));
            stretch.drift = list.drift(stretch.spheres.start, unfolded);
        });
        let drifts = self.stretches.iter().map(|stretch| stretch.drift);
        drifts.fold(Drift::NONE, Drift::and)
    }

    /// Writes the histories back to where they came from.
    fn store_histories<T: PackedHistory>(
        &self,
        contacts: &mut Contacts<T::History<f64>>,
        beside_wall: &[BesideWall<T::History<f64>>],
    ) {
        for pairs in &self.pairs {
            pairs.store::<T>(contacts.pairs.histories_mut());
        }
        if !beside_wall.is_empty() {
            contacts.wall = WallMemory::default();
            for stretch in beside_wall {
                contacts.wall.append(&stretch.memory);
            }
        }
    }
}

impl<'a, N: NormalLaw, T: PackedHistory> Listed<'a, N, T> {
    fn begin(reference: Reference<'a, N, T>, scratch: &'a mut Scratch, wall: &Wall) -> Self {
        let list = &reference.contacts.pairs;
        let Scratch {
            threads,
            spheres,
            stretches,
            stretch_of,
            pairs,
            ..
        } = &mut *scratch;
        spheres.load(reference.bodies, reference.past);
        share_out(stretches, spheres, list, wall, threads);
        pairs.resize_with(stretches.len(), Pairs::default);
        stretch_of.clear();
        for (number, (stretch, pairs)) in (0..).zip(stretches.iter().zip(pairs)) {
            stretch_of.resize(stretch.spheres.end, number);
            pairs.rows = stretch.spheres.clone();
        }
        let mut beside_wall = Vec::new();
        if threads.several() && wall.elastic().is_none() {
            let memory = &reference.contacts.wall;
            let stretches = stretches.iter().enumerate();
            beside_wall.extend(stretches.map(|(number, stretch)| BesideWall {
                stretch: number,
                grains: stretch.length(),
                memory: memory.part(stretch.spheres.clone()),
                sums: Waiting::default(),
            }));
        }
        scratch.load_pairs(&reference);
        for pairs in &mut scratch.pairs {
            pairs.take_up::<T>(reference.contacts.pairs.histories_mut());
        }
        Self {
            reference,
            scratch,
            stage: Stage::First,
            mean_wall_force: Record::ZERO,
            // The list may have been made long ago, and nothing is chosen from it yet.
            travelled: Travel {
                axial: f64::INFINITY,
                lateral: 0.0,
            },
            beside_wall,
        }
    }

    fn pass(&mut self) -> Result<Travel, Runaway> {
        let Scratch {
            instructions,
            threads,
            spheres,
            stretches,
            ..
        } = &mut *self.scratch;
        let parameters = self.reference.parameters;
        let (stage, mean_wall_force) = (self.stage, self.mean_wall_force);
        let (limit, length) = (self.reference.limit, self.reference.length);
        let integrator = spheres.prepare_to_move(parameters.integrator, stage);
        threads.each(
            stretches,
            spheres.all_mut(),
            &Stretch::length,
            &|stretch, spheres| {
                stretch.moved = instructions.run(Motion {
                    spheres,
                    of_grains: stretch.of_grains,
                    integrator,
                    stage,
                    mean_wall_force,
                    rotates: T::ROTATES,
                    body_force: parameters.body_force,
                    time_step: parameters.time_step,
                    limit,
                    length,
                });
            },
        );
        Moved::travel(stretches.iter().map(|stretch| stretch.moved))
    }

    /// Chooses the pairs that may touch in the steps to come; makes the list anew where it does not hold them all.
    fn choose_pairs(&mut self, wall: &Wall) {
        let (skin, length) = (self.reference.parameters.skin, self.reference.length);
        let Reference {
            contacts, bodies, ..
        } = &mut self.reference;
        let drift = self.scratch.drift(&contacts.pairs, length);
        if !contacts.pairs.covers(bodies.number(), drift, CHOSEN * skin) {
            self.scratch.spheres.store_places(bodies);
            let Scratch {
                threads,
                pairs,
                held,
                ..
            } = &mut *self.scratch;
            held.clear();
            pairs.iter_mut().for_each(|pairs| pairs.hand_over(held));
            contacts.rebuild(bodies, wall, LISTED * skin, Some(held), threads);
            self.scratch.load_pairs(&self.reference);
            let places = self.reference.contacts.pairs.moved();
            for pairs in &mut self.scratch.pairs {
                pairs.carry_on(places);
            }
        }
        let Scratch {
            instructions,
            threads,
            spheres,
            pairs,
            ..
        } = &mut *self.scratch;
        let position = &spheres.position[..];
        threads.each(pairs, (), &|_| 0, &|pairs, ()| {
            instructions.run(Prune {
                pairs,
                position,
                length,
                skin: CHOSEN * skin,
            });
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

    fn tally(&mut self, wall: &Wall) -> Tally {
        let reference = &self.reference;
        let (mut bodies, mut contacts) = (reference.bodies.clone(), reference.contacts.clone());
        // With their velocities: contacts that slide store less.
        let spheres = &self.scratch.spheres;
        spheres.store(&mut bodies, &mut Past::default());
        self.scratch
            .store_histories::<T>(&mut contacts, &self.beside_wall);
        let parameters = reference.parameters;
        contacts.refresh(&bodies, wall, parameters.skin);
        let time_step = parameters.time_step;
        evaluate(reference.law, &mut bodies, wall, &mut contacts, time_step)
    }

    fn evaluate(&mut self, wall: &Wall, _complete: bool) -> Tally {
        if self
            .travelled
            .exceeds(CHOSEN * self.reference.parameters.skin)
        {
            self.choose_pairs(wall);
        }
        let mut tally = Tally::default();
        match self.scratch.threads.several() {
            false => self.add_forces(wall, &mut tally),
            true => self.share_forces(wall, &mut tally),
        }
        tally
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        self.stage = Stage::Last;
        self.pass().map(|_| ())
    }
}
