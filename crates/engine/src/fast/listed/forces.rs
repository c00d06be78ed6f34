//! All forces on the spheres: of the only section as they are found, of several shared out to threads.

use peristalsis_physics::contact::{ContactLaw, NormalLaw};

use super::beside_wall::BesideWall;
use super::book::{Adding, MeanForce};
use super::contacts::PairForces;
use super::history::PackedHistory;
use super::network::{Rings, WallForces};
use super::pairs::{Ended, Pairs};
use super::section::{Section, Shares};
use super::spheres::{GrainsMut, Moving, Spheres};
use super::{Listed, Scratch};
use crate::fast::machine::Instructions;
use crate::forces::Reference;
use crate::ledger::Tally;
use crate::wall::{ElasticWall, Wall};

/// An evaluation of the forces, section by section.
struct Evaluation<'a, N, T: PackedHistory> {
    law: &'a ContactLaw<N, T>,
    instructions: Instructions,
    spheres: Moving<'a>,
    /// The number of the sphere at each place, and the places of the spheres of the wall.
    number: &'a [u32],
    places: &'a [u32],
    length: f64,
    time_step: f64,
    /// Whether all sums are wanted.
    complete: bool,
}

impl<'a, N: NormalLaw, T: PackedHistory> Evaluation<'a, N, T> {
    fn new(
        reference: &Reference<'a, N, T>,
        spheres: &'a Spheres,
        instructions: Instructions,
        complete: bool,
    ) -> Self {
        Self {
            law: reference.law,
            instructions,
            spheres: spheres.moving(),
            number: &spheres.number,
            places: &spheres.place[spheres.grains..],
            length: reference.length,
            time_step: reference.parameters.time_step,
            complete,
        }
    }

    /// Contacts of a section's grains, and of its wall with itself. Their sums go to the tallies, or become terms.
    fn touch(
        &self,
        section: &mut Section,
        [of_grains, of_wall]: &mut [Pairs; 2],
        [tally, of_wall_tally]: [Option<&mut Tally>; 2],
    ) {
        for (pairs, of_grains, tally) in [(of_grains, true, tally), (of_wall, false, of_wall_tally)]
        {
            self.instructions.run(PairForces {
                law: self.law,
                pairs,
                of_grains,
                spheres: self.spheres,
                number: self.number,
                forces: &mut section.forces,
                length: self.length,
                time_step: self.time_step,
                tally,
                complete: self.complete,
            });
        }
    }

    /// Forces of a section's elastic wall; sums likewise.
    fn push(
        &self,
        wall: &ElasticWall,
        section: &mut Section,
        rings: &mut Rings,
        tally: Option<&mut Tally>,
    ) {
        let [force, _] = section.forces.of_wall();
        self.instructions.run(WallForces {
            wall,
            rings,
            spheres: self.spheres,
            places: self.places,
            first: section.own.of_wall().start,
            force,
            tally,
            complete: self.complete,
        });
    }

    fn grains<'b>(&'b self, section: &'b mut Section) -> GrainsMut<'b> {
        GrainsMut {
            moving: self.spheres,
            first: section.own.start,
            forces: section.forces.of_grains(),
        }
    }
}

impl<N: NormalLaw, T: PackedHistory> Listed<'_, N, T> {
    /// Adds all forces, one after the other.
    pub(super) fn add_forces(&mut self, wall: &Wall, complete: bool, tally: &mut Tally) {
        let Scratch {
            instructions,
            spheres,
            shares,
            ended,
            ..
        } = &mut *self.scratch;
        let evaluation = Evaluation::new(&self.reference, spheres, *instructions, complete);
        let (Some(section), Some(pairs)) = (shares.sections.first_mut(), shares.pairs.first_mut())
        else {
            return;
        };
        let mut sums_of_wall = Tally::default();
        let tallies = [Some(&mut *tally), Some(&mut sums_of_wall)];
        evaluation.touch(section, pairs, tallies);
        add_ended(&mut shares.pairs, ended, tally);
        // Contacts of wall spheres with each other are no contacts of grains.
        tally.contact_energy += sums_of_wall.contact_energy;
        tally.normal_dissipation += sums_of_wall.normal_dissipation;
        let Some(elastic) = wall.elastic() else {
            let (law, time_step) = (evaluation.law, evaluation.time_step);
            let mut grains = evaluation.grains(section);
            let memory = &mut self.reference.contacts.wall;
            wall.add_forces(law, &mut grains, memory, time_step, tally);
            return;
        };
        evaluation.push(elastic, section, &mut shares.rings[0], Some(tally));
        self.mean_wall_force = MeanForce::of(elastic, &shares.rings, tally);
    }

    /// The same by several threads: for each section its contacts and then the forces of its wall. The terms of most sums are
    /// owed, still to be added.
    pub(super) fn share_forces(&mut self, wall: &Wall, complete: bool, tally: &mut Tally) {
        let Scratch {
            instructions,
            threads,
            spheres,
            shares,
            ended,
            ..
        } = &mut *self.scratch;
        let evaluation = Evaluation::new(&self.reference, spheres, *instructions, complete);
        let elastic = wall.elastic();
        let Shares {
            sections,
            pairs,
            rings,
            ..
        } = shares;
        if let Some(elastic) = elastic {
            let all = (&mut pairs[..], &mut rings[..]);
            threads.each(sections, all, &|_| 1, &|section, (pairs, rings)| {
                for (pairs, rings) in pairs.iter_mut().zip(rings) {
                    evaluation.touch(section, pairs, [None, None]);
                    evaluation.push(elastic, section, rings, None);
                }
            });
        } else {
            let all = (&mut pairs[..], &mut self.beside_wall[..]);
            threads.each(sections, all, &|_| 1, &|section, (pairs, beside_wall)| {
                for pairs in pairs {
                    evaluation.touch(section, pairs, [None, None]);
                }
                let (law, time_step) = (evaluation.law, evaluation.time_step);
                let mut grains = evaluation.grains(section);
                for BesideWall { memory, sums } in beside_wall {
                    wall.add_forces(law, &mut grains, memory, time_step, sums);
                }
            });
        }
        add_ended(&mut shares.pairs, ended, tally);
        if let Some(elastic) = elastic {
            self.mean_wall_force = MeanForce::of(elastic, rings, tally);
        }
        self.owed = Some(complete);
    }

    /// Adds up what is still owed, if any, here and now.
    pub(super) fn add_owed(&mut self) {
        let Some(complete) = self.owed.take() else {
            return;
        };
        let Scratch {
            instructions,
            shares,
            ..
        } = &mut *self.scratch;
        let (_, terms) = shares.with_terms();
        let adding = Adding::new(*instructions, terms, complete);
        let legs = adding.chains().into_iter().flatten();
        legs.for_each(|leg| adding.add(leg));
        adding.finish(&mut self.sums);
        self.add_beside_wall();
    }
}

/// Adds what contacts that ended have left, in the order of the list, and forgets them.
fn add_ended(pairs: &mut [[Pairs; 2]], room: &mut Vec<Ended>, tally: &mut Tally) {
    room.clear();
    for [of_grains, _] in pairs {
        // Where none has ended nothing is written, for which another core would wait.
        if !of_grains.ended.is_empty() {
            room.append(&mut of_grains.ended);
        }
    }
    room.sort_unstable_by_key(|ended| ended.spheres);
    for ended in &*room {
        tally.history_reset += ended.energy;
    }
}
