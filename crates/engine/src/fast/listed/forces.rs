//! All forces on the spheres: added as they are found by one thread, or shared out to several.

use peristalsis_physics::contact::NormalLaw;

use super::answers::Gather;
use super::book::AddUp;
use super::contacts::PairForces;
use super::history::PackedHistory;
use super::network::{Rings, WallForces, mean_force};
use super::pairs::Pairs;
use super::spheres::{ForcesMut, GrainsMut};
use super::stretch::Stretch;
use super::{Listed, Scratch};
use crate::fast::machine::Instructions;
use crate::fast::threads::Cut;
use crate::ledger::Tally;
use crate::wall::Wall;

impl<N: NormalLaw, T: PackedHistory> Listed<'_, N, T> {
    /// Adds all forces, one after the other.
    pub(super) fn add_forces(&mut self, wall: &Wall, tally: &mut Tally) {
        let (law, length) = (self.reference.law, self.reference.length);
        let time_step = self.reference.parameters.time_step;
        let Scratch {
            instructions,
            spheres,
            stretches,
            pairs,
            ..
        } = &mut *self.scratch;
        let grains = spheres.grains;
        for pairs in pairs {
            let mut of_wall = Tally::default();
            let of_grains = pairs.rows.start < grains;
            let (spheres, forces) = spheres.with_forces();
            let tally_here = if of_grains { &mut *tally } else { &mut of_wall };
            instructions.run(PairForces {
                law,
                pairs,
                spheres,
                length,
                time_step,
                at_once: Some((forces, tally_here)),
            });
            add_ended(pairs, tally);
            add_of_wall(&of_wall, tally);
        }
        let (spheres, forces) = spheres.with_forces();
        let Some(elastic) = wall.elastic() else {
            let mut all = GrainsMut {
                moving: spheres,
                forces,
            };
            let memory = &mut self.reference.contacts.wall;
            wall.add_forces(law, &mut all, memory, time_step, tally);
            return;
        };
        if let [_, of_wall] = &mut stretches[..] {
            instructions.run(WallForces {
                wall: elastic,
                rings: &mut of_wall.rings,
                spheres,
                forces: forces.cut(grains).1,
                tally: Some(tally),
            });
        }
        self.mean_wall_force = mean_force(elastic, rings(stretches), tally);
    }

    /// The same by several threads: the contacts of each stretch of the list, then the spheres of each stretch.
    pub(super) fn share_forces(&mut self, wall: &Wall, tally: &mut Tally) {
        let (law, length) = (self.reference.law, self.reference.length);
        let time_step = self.reference.parameters.time_step;
        let Scratch {
            instructions,
            threads,
            spheres,
            stretches,
            stretch_of,
            pairs,
            ..
        } = &mut *self.scratch;
        let (instructions, grains, number) = (*instructions, spheres.grains, stretches.len());
        let (spheres, forces) = spheres.with_forces();
        threads.each(pairs, (), &|_| 0, &|pairs, ()| {
            instructions.run(PairForces {
                law,
                pairs,
                spheres,
                length,
                time_step,
                at_once: None,
            });
            pairs.answers.sort(stretch_of, number);
        });
        let pairs = &pairs[..];
        let gather = |stretch: usize, forces: &mut ForcesMut<'_>| {
            instructions.run(Gather {
                pairs: &pairs[..=stretch],
                forces: forces.reborrow(),
                // The spheres of a wall do not turn.
                rotates: T::ROTATES && pairs[stretch].rows.start < grains,
            });
        };
        let sums = || add_up(instructions, pairs, grains, tally);
        let Some(elastic) = wall.elastic() else {
            let beside_wall = &mut self.beside_wall[..];
            threads.each_beside(
                sums,
                beside_wall,
                forces,
                &|stretch| stretch.grains,
                &|stretch, mut forces| {
                    gather(stretch.stretch, &mut forces);
                    let mut grains = GrainsMut {
                        moving: spheres,
                        forces,
                    };
                    let (memory, sums) = (&mut stretch.memory, &mut stretch.sums);
                    wall.add_forces(law, &mut grains, memory, time_step, sums);
                },
            );
            for stretch in &mut self.beside_wall {
                stretch.sums.add_to(tally);
            }
            return;
        };
        threads.each_beside(
            sums,
            stretches,
            forces,
            &Stretch::length,
            &|stretch, mut forces| {
                gather(stretch.number, &mut forces);
                if !stretch.of_grains {
                    instructions.run(WallForces {
                        wall: elastic,
                        rings: &mut stretch.rings,
                        spheres,
                        forces,
                        tally: None,
                    });
                }
            },
        );
        instructions.run(AddUp {
            stretches: rings(stretches).map(|rings| &rings.terms),
            tally,
        });
        self.mean_wall_force = mean_force(elastic, rings(stretches), tally);
    }
}

fn rings(stretches: &[Stretch]) -> impl Iterator<Item = &Rings> {
    let of_wall = stretches.iter().filter(|stretch| !stretch.of_grains);
    of_wall.map(|stretch| &stretch.rings)
}

/// Adds up what the answers for all pairs have to add to the sums.
fn add_up(instructions: Instructions, pairs: &[Pairs], grains: usize, tally: &mut Tally) {
    let (of_grains, of_wall) =
        pairs.split_at(pairs.partition_point(|pairs| pairs.rows.start < grains));
    let add_up = |pairs: &[Pairs], tally: &mut Tally| {
        instructions.run(AddUp {
            stretches: pairs.iter().map(|pairs| &pairs.answers.terms),
            tally,
        });
    };
    add_up(of_grains, tally);
    for pairs in of_grains {
        add_ended(pairs, tally);
    }
    let mut sums = Tally::default();
    add_up(of_wall, &mut sums);
    add_of_wall(&sums, tally);
}

fn add_ended(pairs: &Pairs, tally: &mut Tally) {
    for energy in &pairs.ended {
        tally.history_reset += energy;
    }
}

/// Adds the contacts of wall spheres with each other, which are no contacts of grains.
fn add_of_wall(of_wall: &Tally, tally: &mut Tally) {
    tally.contact_energy += of_wall.contact_energy;
    tally.normal_dissipation += of_wall.normal_dissipation;
}
