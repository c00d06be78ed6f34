//! All forces on the spheres: of the only section as they are found, of several shared out to threads.

use peristalsis_physics::contact::NormalLaw;

use super::book::{AddInTurn, AddRings, InTurn, add_contacts};
use super::contacts::PairForces;
use super::history::PackedHistory;
use super::network::{WallForces, mean_force};
use super::pairs::{Ended, Pairs};
use super::section::{BesideWall, Section, Shares};
use super::spheres::GrainsMut;
use super::{Listed, Scratch};
use crate::ledger::Tally;
use crate::wall::Wall;

impl<N: NormalLaw, T: PackedHistory> Listed<'_, N, T> {
    /// Adds all forces, one after the other.
    pub(super) fn add_forces(&mut self, wall: &Wall, complete: bool, tally: &mut Tally) {
        let (law, length) = (self.reference.law, self.reference.length);
        let time_step = self.reference.parameters.time_step;
        let Scratch {
            instructions,
            spheres,
            shares,
            ended,
            ..
        } = &mut *self.scratch;
        let (Some(section), Some([of_grains, of_wall])) =
            (shares.sections.first_mut(), shares.pairs.first_mut())
        else {
            return;
        };
        let (number, places) = (&spheres.number[..], &spheres.place[spheres.grains..]);
        let spheres = spheres.moving();
        let mut sums_of_wall = Tally::default();
        for (pairs, of_grains, tally) in [
            (&mut *of_grains, true, &mut *tally),
            (of_wall, false, &mut sums_of_wall),
        ] {
            instructions.run(PairForces {
                law,
                pairs,
                of_grains,
                spheres,
                number,
                forces: &mut section.forces,
                length,
                time_step,
                tally: Some(tally),
                complete,
            });
        }
        add_ended(&mut shares.pairs, ended, tally);
        // Contacts of wall spheres with each other are no contacts of grains.
        tally.contact_energy += sums_of_wall.contact_energy;
        tally.normal_dissipation += sums_of_wall.normal_dissipation;
        let Some(elastic) = wall.elastic() else {
            let mut grains = GrainsMut {
                moving: spheres,
                first: 0,
                forces: section.forces.of_grains(),
            };
            let memory = &mut self.reference.contacts.wall;
            wall.add_forces(law, &mut grains, memory, time_step, tally);
            return;
        };
        let [force, _] = section.forces.of_wall();
        instructions.run(WallForces {
            wall: elastic,
            rings: &mut section.rings,
            spheres,
            places,
            first: section.own.of_wall().start,
            force,
            tally: Some(tally),
            complete,
        });
        self.mean_wall_force = mean_force(elastic, core::iter::once(&section.rings), tally);
    }

    /// The same by several threads: for each section its contacts and then the forces of its wall, and when all are done the
    /// terms of the contacts in the order of the list.
    pub(super) fn share_forces(&mut self, wall: &Wall, complete: bool, tally: &mut Tally) {
        let (law, length) = (self.reference.law, self.reference.length);
        let time_step = self.reference.parameters.time_step;
        let Scratch {
            instructions,
            threads,
            spheres,
            shares,
            ended,
            ..
        } = &mut *self.scratch;
        let instructions = *instructions;
        let grains = spheres.grains;
        let (number, places) = (&spheres.number[..], &spheres.place[grains..]);
        let spheres = spheres.moving();
        let elastic = wall.elastic();
        let Shares {
            sections,
            pairs,
            runs,
            section_of,
            ..
        } = shares;
        let touch = |section: &mut Section, pairs: &mut [[Pairs; 2]]| {
            for [of_grains, of_wall] in pairs {
                for (pairs, of_grains) in [(of_grains, true), (of_wall, false)] {
                    instructions.run(PairForces {
                        law,
                        pairs,
                        of_grains,
                        spheres,
                        number,
                        forces: &mut section.forces,
                        length,
                        time_step,
                        tally: None,
                        complete,
                    });
                }
            }
        };
        if let Some(elastic) = elastic {
            threads.each(sections, &mut pairs[..], &|_| 1, &|section, pairs| {
                touch(section, pairs);
                let [force, _] = section.forces.of_wall();
                instructions.run(WallForces {
                    wall: elastic,
                    rings: &mut section.rings,
                    spheres,
                    places,
                    first: section.own.of_wall().start,
                    force,
                    tally: None,
                    complete,
                });
            });
        } else {
            let all = (&mut pairs[..], &mut self.beside_wall[..]);
            threads.each(sections, all, &|_| 1, &|section, (pairs, beside_wall)| {
                touch(section, pairs);
                let mut grains = GrainsMut {
                    moving: spheres,
                    first: section.own.start,
                    forces: section.forces.of_grains(),
                };
                for BesideWall { memory, sums } in beside_wall {
                    wall.add_forces(law, &mut grains, memory, time_step, sums);
                }
            });
        }
        let (pairs, runs) = (&pairs[..], &runs[..]);
        let mut lanes = InTurn::all();
        threads.each(&mut lanes, (), &|_| 0, &|lanes, ()| {
            instructions.run(AddInTurn {
                pairs,
                runs,
                lanes,
                complete,
            });
        });
        add_contacts(pairs, &lanes, tally);
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
        let rings = || sections.iter().map(|section| &section.rings);
        instructions.run(AddRings {
            sections: rings().map(|rings| &rings.terms),
            tally,
        });
        self.mean_wall_force = mean_force(elastic, rings(), tally);
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
