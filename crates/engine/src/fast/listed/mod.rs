//! The fast kernel for everything that has a neighbour list: rotating grains, elastic walls, wide tubes.
//!
//! For as long as an advance lasts the spheres live in records ([`spheres`]); a step is one pass over the listed pairs
//! ([`pairs`]), one over the wall ([`network`], [`prescribed`]) and one over the spheres ([`motion`]).

mod history;
mod motion;
mod network;
mod pairs;
mod prescribed;
mod record;
mod spheres;
mod waveform;

use peristalsis_physics::contact::{ContactLaw, NormalLaw};

pub(crate) use self::history::Remember;
use self::motion::{Motion, Stage, Travel};
use self::network::{Rows, WallForces};
use self::pairs::{PairForces, Pairs, Prune};
use self::record::Record;
use self::spheres::Spheres;
use crate::bodies::Bodies;
use crate::fast::machine::Instructions;
use crate::forces::{Contacts, evaluate};
use crate::integrate::{Past, Runaway};
use crate::ledger::{Ledger, Tally};
use crate::simulation::Parameters;
use crate::wall::Wall;

/// Room to work in, kept from advance to advance.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    pub(crate) instructions: Instructions,
    spheres: Spheres,
    pairs: Pairs,
    rows: Rows,
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            instructions: Instructions::widest(),
            spheres: Spheres::default(),
            pairs: Pairs::default(),
            rows: Rows::default(),
        }
    }
}

/// The list is made for so many skins.
const LISTED: f64 = 2.5;
/// What comes within so many is chosen from it, again and again, and looked at in each step.
const CHOSEN: f64 = 0.5;

/// What an advance moves.
pub(crate) struct Course<'a> {
    pub(crate) bodies: &'a mut Bodies,
    pub(crate) wall: &'a mut Wall,
    pub(crate) past: &'a mut Past,
    pub(crate) tally: &'a mut Tally,
    pub(crate) ledger: &'a mut Ledger,
    pub(crate) step: &'a mut u64,
    pub(crate) parameters: Parameters,
    pub(crate) limit: f64,
}

/// Advances by `steps` steps, as the reference does.
pub(crate) fn advance<N: NormalLaw, T: Remember>(
    law: &ContactLaw<N, T>,
    mut course: Course<'_>,
    contacts: &mut Contacts<T::History<f64>>,
    scratch: &mut Scratch,
    steps: u64,
) -> Result<(), Runaway> {
    if steps == 0 {
        return Ok(());
    }
    scratch.spheres.load(course.bodies, course.past);
    scratch.pairs.load::<T>(&contacts.pairs, course.bodies);
    let moved = move_through(law, &mut course, contacts, scratch, steps);
    scratch.pairs.store::<T>(&mut contacts.pairs);
    scratch.spheres.store(course.bodies, course.past);
    moved
}

fn move_through<N: NormalLaw, T: Remember>(
    law: &ContactLaw<N, T>,
    course: &mut Course<'_>,
    contacts: &mut Contacts<T::History<f64>>,
    scratch: &mut Scratch,
    steps: u64,
) -> Result<(), Runaway> {
    let Scratch {
        instructions,
        spheres,
        pairs,
        rows,
    } = scratch;
    let Parameters {
        integrator,
        time_step,
        skin,
        body_force,
        ..
    } = course.parameters;
    let (limit, length) = (course.limit, course.wall.lattice().length());
    let pass = |spheres: &mut Spheres, stage: Stage, mean_wall_force: Record| {
        instructions.run(Motion {
            spheres,
            integrator,
            stage,
            mean_wall_force,
            rotates: T::ROTATES,
            body_force,
            time_step,
            limit,
            length,
        })
    };
    let (mut stage, mut mean_wall_force) = (Stage::First, Record::ZERO);
    // The list may have been made long ago, and nothing is chosen from it yet.
    let mut travelled = Travel {
        axial: f64::INFINITY,
        lateral: 0.0,
    };
    for _ in 0..steps {
        *course.step += 1;
        let time = *course.step as f64 * time_step;
        travelled.add(pass(spheres, stage, mean_wall_force)?);
        stage = Stage::Between;

        // A wall that jumps does work on the contacts that it finds: what they store after the jump but not before.
        let jumped = course.wall.move_without_jump(time - time_step, time);
        let stored_before_jump = jumped.then(|| {
            let (mut bodies, mut contacts) = (course.bodies.clone(), contacts.clone());
            // With their velocities: what slides stores less.
            spheres.store(&mut bodies, &mut Past::default());
            pairs.store::<T>(&mut contacts.pairs);
            contacts.refresh(&bodies, course.wall, skin);
            evaluate(law, &mut bodies, course.wall, &mut contacts, 0.0).contact_energy
        });
        course.wall.move_to(time);
        if travelled.exceeds(CHOSEN * skin) {
            spheres.store_places(course.bodies);
            let (places, turns) = (&course.bodies.position, &course.bodies.turns);
            if !contacts.pairs.covers(places, turns, length, CHOSEN * skin) {
                pairs.store::<T>(&mut contacts.pairs);
                contacts.rebuild(course.bodies, course.wall, LISTED * skin);
                pairs.load::<T>(&contacts.pairs, course.bodies);
            }
            instructions.run(Prune {
                pairs,
                spheres,
                length,
                skin: CHOSEN * skin,
            });
            travelled = Travel::default();
        }

        let mut after = Tally::default();
        instructions.run(PairForces {
            law,
            pairs,
            spheres,
            length,
            time_step,
            tally: &mut after,
        });
        match course.wall {
            Wall::Elastic(wall) => {
                mean_wall_force = instructions.run(WallForces {
                    wall,
                    rows,
                    spheres,
                    tally: &mut after,
                });
            }
            Wall::Prescribed(wall) => prescribed::add_forces(
                wall,
                law,
                spheres,
                &mut contacts.wall,
                time_step,
                &mut after,
            ),
        }
        if let Some(stored) = stored_before_jump {
            course.ledger.add_jump(after.contact_energy - stored);
        }
        course.ledger.add_step(course.tally, &after, time_step);
        *course.tally = after;
    }
    pass(spheres, Stage::Last, mean_wall_force).map(|_| ())
}
