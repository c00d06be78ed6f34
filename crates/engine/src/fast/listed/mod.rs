//! The fast kernel for everything that has a neighbour list: rotating grains, elastic walls, wide tubes.
//!
//! For as long as an advance lasts the spheres live in records ([`spheres`]); a step is one pass over the listed pairs
//! ([`pairs`], [`contacts`]), one over the wall ([`network`]) and one over the spheres ([`motion`]).
//!
//! Several threads share out sections of the tube ([`section`]), each with every contact of its spheres. Every sphere adds
//! in the order of the list, and every sum has the order that one section gives it ([`book`]): the bits are the same.

mod beside_wall;
mod book;
mod contacts;
mod forces;
mod history;
mod motion;
mod network;
mod pairs;
mod record;
mod section;
mod spheres;
mod terms;

use core::ops::Range;

use peristalsis_physics::contact::NormalLaw;

use self::beside_wall::BesideWall;
use self::book::{Adding, Leg};
use self::history::PackedHistory;
use self::motion::{Motion, Moved, Stage};
use self::pairs::{Ended, Prune};
use self::record::Record;
use self::section::{Section, Shares};
use self::spheres::Spheres;
use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::fast::machine::Instructions;
use crate::fast::threads::{Chains, Cut, Threads};
use crate::forces::{Reference, evaluate};
use crate::integrate::{Past, Runaway};
use crate::ledger::Tally;
use crate::neighbours::{Drift, Neighbours, are_within, skin_shares, time_within};
use crate::steps::{Course, Stepper};
use crate::wall::Wall;

/// Room to work in, kept from advance to advance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) instructions: Instructions,
    pub(crate) threads: Threads,
    spheres: Spheres,
    shares: Shares,
    /// Room: contacts of all sections that have ended.
    ended: Vec<Ended>,
}

/// The list is made for so many skins.
const LISTED: f64 = 2.5;
/// Pairs within so many skins are chosen from it, again and again, and looked at in each step.
const CHOSEN: f64 = 0.5;
/// The list is made for where the spheres will be after so much of the time that it serves at least: it then serves on
/// both sides of that, longer than one made for where they are.
const LISTED_AHEAD: f64 = 0.7;

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
        let Reference {
            bodies,
            past,
            contacts,
            ..
        } = &mut listed.reference;
        listed
            .scratch
            .store_histories::<T>(contacts, &listed.beside_wall);
        listed.scratch.store_spheres(bodies, past);
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
    /// Sums of the last evaluation.
    sums: Tally,
    /// Where terms of them are still to be added: whether all are wanted.
    owed: Option<bool>,
    /// The parts that a grain and a sphere of the wall have in the skin of a pair.
    skin_shares: [f64; 2],
    /// How far grains and spheres of the wall have moved since pairs were last chosen from the list.
    travelled: [Drift; 2],
    /// The sections' contacts with a prescribed wall, where several threads serve it.
    beside_wall: Vec<BesideWall<T::History<f64>>>,
}

impl Scratch {
    /// Shares the spheres out to sections, and takes them up.
    fn share_out<N, T: PackedHistory>(&mut self, reference: &Reference<'_, N, T>, wall: &Wall) {
        let Self {
            threads,
            spheres,
            shares,
            ..
        } = self;
        let (bodies, list) = (&*reference.bodies, &reference.contacts.pairs);
        shares.share_out(bodies, list, wall, threads, &mut spheres.number);
        spheres.load(bodies, reference.past);
        let number = &spheres.number[..];
        threads.each(&mut shares.sections, (), &|_| 0, &|section, ()| {
            section.forces.load(section.own, bodies, number);
        });
    }

    /// Takes up spheres and contacts of the reference kernel, whose histories are fresh then; answers the sections' contacts
    /// with a prescribed wall.
    fn take_up<N, T: PackedHistory>(
        &mut self,
        reference: &mut Reference<'_, N, T>,
        wall: &Wall,
    ) -> Vec<BesideWall<T::History<f64>>> {
        self.share_out(reference, wall);
        let beside_wall = self.beside_wall(reference, wall);
        self.load_pairs(reference);
        let list = &mut reference.contacts.pairs;
        let (pairs, histories) = (&mut self.shares.pairs[..], list.histories());
        self.threads.each(pairs, (), &|_| 0, &|[of_grains, _], ()| {
            of_grains.take_up::<T>(histories);
        });
        for [of_grains, _] in &self.shares.pairs {
            of_grains.freshen(list.histories_mut());
        }
        beside_wall
    }

    /// The sections write down which pairs of spheres they remember, before the list is made anew.
    fn note_pairs(&mut self) {
        let number = &self.spheres.number[..];
        let pairs = &mut self.shares.pairs[..];
        self.threads.each(pairs, (), &|_| 0, &|[of_grains, _], ()| {
            of_grains.note(number);
        });
    }

    /// The sections find these pairs in their new lists.
    fn find_pairs_again<T: PackedHistory>(&mut self, list: &Neighbours<T::History<f64>>, law: &T) {
        let place = &self.spheres.place[..];
        let Shares {
            sections, pairs, ..
        } = &mut self.shares;
        let sections = &sections[..];
        self.threads
            .each(pairs, sections, &|_| 1, &|[of_grains, _], sections| {
                for section in sections {
                    of_grains.find_again(list, law, place, section.own);
                }
            });
    }

    fn store_spheres(&self, bodies: &mut Bodies, past: &mut Past) {
        self.spheres.store(bodies, past);
        for section in &self.shares.sections {
            section.forces.store(bodies, &self.spheres.number);
        }
    }

    /// Makes the lists of the sections from that of all; what they remember they find again with
    /// [`Pairs::find_again`](pairs::Pairs::find_again).
    fn load_pairs<N, T: PackedHistory>(&mut self, reference: &Reference<'_, N, T>) {
        let list = &reference.contacts.pairs;
        let Self {
            threads,
            spheres,
            shares,
            ..
        } = self;
        let Shares {
            sections,
            pairs,
            offers,
            section_of,
            ..
        } = shares;
        let (spheres, sections, section_of) = (&*spheres, &sections[..], &section_of[..]);
        if sections.len() > 1 {
            threads.each(offers, sections, &|_| 1, &|offer, sections| {
                for section in sections {
                    offer.find_borders(section, list, spheres, section_of);
                }
            });
        }
        let offers = &offers[..];
        threads.each(pairs, sections, &|_| 1, &|pairs, sections| {
            for section in sections {
                section.load_pairs(pairs, list, spheres, offers);
            }
        });
        self.shares.count_borders();
    }

    /// How far the spheres are from the places for which the list of all was made.
    fn drifts<H: Copy + Default + PartialEq + Sync>(
        &mut self,
        list: &Neighbours<H>,
        length: f64,
    ) -> [Drift; 2] {
        self.bounds(|spheres, places| {
            let numbers = spheres.number[places.clone()].iter();
            let places = spheres.position[places].iter();
            let unfolded = places.map(|place| place.unfolded(length));
            list.drift(unfolded.zip(numbers.map(|&number| number as usize)))
        })
    }

    /// How fast they are.
    fn velocities(&mut self) -> [Drift; 2] {
        self.bounds(|spheres, places| {
            Drift::of(spheres.velocity[places].iter().map(|v| v.vector()))
        })
    }

    /// Bounds, over all grains and over all spheres of the wall, of what `of` bounds for those at some places.
    fn bounds(&mut self, of: impl Fn(&Spheres, Range<usize>) -> Drift + Sync) -> [Drift; 2] {
        let spheres = &self.spheres;
        let sections = &mut self.shares.sections[..];
        self.threads.each(sections, (), &|_| 0, &|section, ()| {
            let kinds = [section.own.of_grains(), section.own.of_wall()];
            section.drifts = kinds.map(|places| of(spheres, places));
        });
        let drifts = self.shares.sections.iter().map(|section| section.drifts);
        drifts.fold([Drift::NONE; 2], |[grains, wall], [more, of_wall]| {
            [grains.and(more), wall.and(of_wall)]
        })
    }

    /// Writes the histories back to where they came from.
    fn store_histories<T: PackedHistory>(
        &self,
        contacts: &mut Contacts<T::History<f64>>,
        beside_wall: &[BesideWall<T::History<f64>>],
    ) {
        let Shares {
            sections, pairs, ..
        } = &self.shares;
        for (section, [of_grains, _]) in sections.iter().zip(pairs) {
            of_grains.store::<T>(section.own, contacts.pairs.histories_mut());
        }
        self.store_wall_memory::<T>(contacts, beside_wall);
    }
}

impl<'a, N: NormalLaw, T: PackedHistory> Listed<'a, N, T> {
    fn begin(mut reference: Reference<'a, N, T>, scratch: &'a mut Scratch, wall: &Wall) -> Self {
        let beside_wall = scratch.take_up(&mut reference, wall);
        Self {
            reference,
            scratch,
            stage: Stage::First,
            mean_wall_force: Record::ZERO,
            sums: Tally::default(),
            owed: None,
            skin_shares: [0.5; 2],
            // The list may have been made long ago, and nothing is chosen from it yet.
            travelled: [Drift::UNBOUNDED; 2],
            beside_wall,
        }
    }

    /// Moves the spheres, and meanwhile adds up the sums of the last evaluation.
    fn pass(&mut self) -> Result<[Drift; 2], Runaway> {
        let Scratch {
            instructions,
            threads,
            spheres,
            shares,
            ..
        } = &mut *self.scratch;
        let instructions = *instructions;
        let (sections, terms) = shares.with_terms();
        let adding = (self.owed.take()).map(|all| Adding::new(instructions, terms, all));
        let chains = Chains {
            legs: adding.as_ref().map_or([&[], &[]], Adding::chains),
            stretch: &|leg: &Leg| leg.section,
            work: &|leg| adding.iter().for_each(|adding| adding.add(leg)),
        };
        let parameters = self.reference.parameters;
        let (stage, mean_wall_force) = (self.stage, self.mean_wall_force);
        let (limit, length) = (self.reference.limit, self.reference.length);
        let integrator = spheres.prepare_to_move(parameters.integrator, stage);
        let number = core::mem::take(&mut spheres.number);
        threads.each_beside(
            sections,
            spheres.all_mut(),
            &Section::length,
            &|section, spheres| {
                let (of_grains, of_wall) = spheres.cut(section.own.grains);
                section.moved =
                    [(of_grains, true), (of_wall, false)].map(|(spheres, are_grains)| {
                        let forces = match are_grains {
                            true => section.forces.of_grains(),
                            false => section.forces.of_wall(),
                        };
                        let mut moved = instructions.run(Motion {
                            spheres,
                            forces,
                            of_grains: are_grains,
                            integrator,
                            stage,
                            mean_wall_force,
                            rotates: T::ROTATES,
                            body_force: parameters.body_force,
                            time_step: parameters.time_step,
                            limit,
                            length,
                        });
                        if let Some(runaway) = &mut moved.runaway {
                            runaway.body = number[runaway.body] as usize;
                        }
                        moved
                    });
            },
            &chains,
        );
        spheres.number = number;
        let moved = sections.iter().map(|section| section.moved);
        let [grains, of_wall] = moved.fold(<[Moved; 2]>::default(), |[a, b], [more, of_wall]| {
            [a.and(more), b.and(of_wall)]
        });
        if let Some(adding) = adding {
            adding.finish(&mut self.sums);
            self.add_beside_wall();
        }
        match grains.and(of_wall).runaway {
            Some(runaway) => Err(runaway),
            None => Ok([grains.drift(), of_wall.drift()]),
        }
    }

    /// So many skins, for a grain and for a sphere of the wall.
    fn skins(&self, skins: f64) -> [f64; 2] {
        self.skin_shares
            .map(|share| share * skins * self.reference.parameters.skin)
    }

    /// Chooses the pairs that may touch in the steps to come; makes the list anew where it does not hold them all.
    fn choose_pairs(&mut self, wall: &Wall) {
        let length = self.reference.length;
        let drifts = self.scratch.drifts(&self.reference.contacts.pairs, length);
        let number = self.reference.bodies.number();
        let list = &self.reference.contacts.pairs;
        if !list.covers(number, &drifts, self.skins(CHOSEN)) {
            self.list_anew(wall);
        }
        let [of_grain, of_wall] = self.skins(CHOSEN);
        let Scratch {
            instructions,
            threads,
            spheres,
            shares,
            ..
        } = &mut *self.scratch;
        let position = &spheres.position[..];
        threads.each(&mut shares.pairs, (), &|_| 0, &|of_section, ()| {
            for (pairs, first) in of_section.iter_mut().zip([of_grain, of_wall]) {
                instructions.run(Prune {
                    pairs,
                    position,
                    length,
                    skins: [of_grain, of_wall].map(|second| first + second),
                });
            }
        });
        self.travelled = Default::default();
    }

    fn list_anew(&mut self, wall: &Wall) {
        let velocities = self.scratch.velocities();
        self.skin_shares = skin_shares(&velocities);
        let skins = self.skins(LISTED);
        let time = time_within(&velocities, self.skins(LISTED - CHOSEN));
        let Self {
            reference, scratch, ..
        } = self;
        let Reference {
            bodies,
            past,
            contacts,
            ..
        } = reference;
        if scratch.shares.are_worn() {
            scratch.store_spheres(bodies, past);
            scratch.store_histories::<T>(contacts, &self.beside_wall);
            contacts.rebuild(bodies, wall, skins, &scratch.threads);
            self.beside_wall = scratch.take_up(reference, wall);
            return;
        }
        let spheres = &scratch.spheres;
        spheres.store_places_ahead(bodies, LISTED_AHEAD * time, reference.length);
        scratch.note_pairs();
        contacts.rebuild_fresh(bodies, wall, skins, &scratch.threads);
        scratch.load_pairs(reference);
        scratch.find_pairs_again(&reference.contacts.pairs, &reference.law.tangential);
    }
}

impl<N: NormalLaw, T: PackedHistory> Stepper for Listed<'_, N, T> {
    fn move_spheres(&mut self) -> Result<(), Runaway> {
        let travelled = self.pass()?;
        for (so_far, more) in self.travelled.iter_mut().zip(travelled) {
            *so_far = so_far.then(more);
        }
        self.stage = Stage::Between;
        Ok(())
    }

    fn tally(&mut self, wall: &Wall) -> Tally {
        let reference = &self.reference;
        let (mut bodies, mut contacts) = (reference.bodies.clone(), reference.contacts.clone());
        // With their velocities: contacts that slide store less.
        self.scratch
            .store_spheres(&mut bodies, &mut Past::default());
        self.scratch
            .store_histories::<T>(&mut contacts, &self.beside_wall);
        let parameters = reference.parameters;
        contacts.refresh(&bodies, wall, parameters.skin);
        let time_step = parameters.time_step;
        evaluate(reference.law, &mut bodies, wall, &mut contacts, time_step)
    }

    fn evaluate(&mut self, wall: &Wall, complete: bool) {
        if !are_within(&self.travelled, self.skins(CHOSEN)) {
            self.choose_pairs(wall);
        }
        let mut tally = Tally::default();
        match self.scratch.threads.several() {
            false => self.add_forces(wall, complete, &mut tally),
            true => self.share_forces(wall, complete, &mut tally),
        }
        self.sums = tally;
    }

    fn sums(&mut self) -> Tally {
        self.add_owed();
        self.sums
    }

    fn finish(&mut self) -> Result<(), Runaway> {
        self.stage = Stage::Last;
        self.pass().map(|_| ())
    }
}
