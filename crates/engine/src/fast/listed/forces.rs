//! All forces on the spheres: of the only section as they are found, of several shared out to threads.

use std::sync::{Mutex, PoisonError};

use peristalsis_physics::contact::{ContactLaw, NormalLaw};

use super::book::{AddAll, AddContacts, AddRings, MeanForce, OfContacts, OfRings};
use super::contacts::PairForces;
use super::history::PackedHistory;
use super::network::WallForces;
use super::pairs::{Ended, Pairs};
use super::section::{BesideWall, Section, Shares};
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
    fn push(&self, wall: &ElasticWall, section: &mut Section, tally: Option<&mut Tally>) {
        let [force, _] = section.forces.of_wall();
        self.instructions.run(WallForces {
            wall,
            rings: &mut section.rings,
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
        evaluation.push(elastic, section, Some(tally));
        let mut mean_force = MeanForce::default();
        mean_force.add(elastic, &section.rings);
        self.mean_wall_force = mean_force.finish(elastic, tally);
    }

    /// The same by several threads: for each section its contacts and then the forces of its wall, and when all are done the
    /// terms of the contacts in the order of the list.
    pub(super) fn share_forces(&mut self, wall: &Wall, complete: bool, tally: &mut Tally) {
        let Scratch {
            instructions,
            threads,
            spheres,
            shares,
            ended,
            ..
        } = &mut *self.scratch;
        let (instructions, grains) = (*instructions, spheres.grains);
        let evaluation = Evaluation::new(&self.reference, spheres, instructions, complete);
        let elastic = wall.elastic();
        let Shares {
            sections,
            pairs,
            runs,
            legs,
            section_of,
            ..
        } = shares;
        if let Some(elastic) = elastic {
            threads.each(sections, &mut pairs[..], &|_| 1, &|section, pairs| {
                for pairs in pairs {
                    evaluation.touch(section, pairs, [None, None]);
                }
                evaluation.push(elastic, section, None);
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
        let (pairs, runs) = (&pairs[..], &runs[..]);
        let (of_grains, with_rings) = legs.split_at(legs.partition_point(|leg| !leg.of_rings));
        let of_contacts = Mutex::new(OfContacts::default());
        let of_rings = Mutex::new(OfRings::default());
        let chains = [of_grains, with_rings];
        threads.in_turn(
            chains,
            sections.len(),
            &|leg| leg.section,
            &|leg| match elastic {
                Some(wall) if leg.of_rings => instructions.run(AddRings {
                    wall,
                    rings: &sections[leg.section].rings,
                    sums: &mut of_rings.lock().unwrap_or_else(PoisonError::into_inner),
                }),
                _ => instructions.run(AddContacts {
                    leg,
                    pairs,
                    runs,
                    sums: &mut of_contacts.lock().unwrap_or_else(PoisonError::into_inner),
                    complete,
                }),
            },
        );
        let of_rings = of_rings.into_inner();
        let of_rings = of_rings.unwrap_or_else(PoisonError::into_inner);
        let of_contacts = of_contacts.into_inner();
        let mean_force = of_rings.mean_force;
        instructions.run(AddAll {
            of_contacts: of_contacts.unwrap_or_else(PoisonError::into_inner),
            of_rings,
            pairs,
            tally,
        });
        add_ended(&mut shares.pairs, ended, tally);
        let Some(elastic) = elastic else {
            for &section in &section_of[..grains] {
                self.beside_wall[section as usize].sums.add_row(tally);
            }
            for BesideWall { sums, .. } in &mut self.beside_wall {
                sums.clear();
            }
            return;
        };
        self.mean_wall_force = mean_force.finish(elastic, tally);
    }
}

/// Adds what contacts that ended have left, in the order of the list, and forgets them.
fn add_ended(pairs: &mut [[Pairs; 2]], room: &mut Vec<Ended>, tally: &mut Tally) {
    room.clear();
    for [of_grains, _] in pairs {
        room.append(&mut of_grains.ended);
    }
    room.sort_unstable_by_key(|ended| ended.spheres);
    for ended in &*room {
        tally.history_reset += ended.energy;
    }
}
