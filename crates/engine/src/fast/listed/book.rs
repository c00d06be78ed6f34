//! What is added up over contacts and over the spheres of a wall, at once or later.
//!
//! Sums have one order, whichever threads worked out their terms. One section adds them up as it goes. Of several, each
//! writes down the terms of its contacts and rings, and those of its own rows are added in the order of the list while the
//! spheres move for the next step: by the thread that wrote them, which hands the sums on, so that few terms go from core to
//! core.

use core::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::network::Rings;
use super::pairs::Pairs;
use super::record::Record;
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Instructions, Machine, Work};
use crate::ledger::Tally;
use crate::wall::{ElasticWall, NetForce};

/// Rows of the list that follow each other there and, in one section, in their places too: so do the terms of their contacts.
#[derive(Clone, Debug, Default)]
pub(super) struct Run {
    pub(super) section: usize,
    /// Which of the section's runs.
    pub(super) number: usize,
    pub(super) rows: usize,
}

/// Terms that one thread adds up before another goes on: those of rows of grains, or of the rings of a section.
#[derive(Clone, Debug)]
pub(super) struct Leg {
    /// Most of them belong to it.
    pub(super) section: usize,
    /// Of grains.
    runs: Range<usize>,
    pub(super) of_rings: bool,
}

/// A run of fewer rows is added up by the thread that has its sums: to hand them on costs more than to fetch its terms.
const SHORT: usize = 32;

impl Leg {
    /// All legs, in the order in which terms are added; so many sections have rings.
    pub(super) fn of(runs: &[Run], with_rings: usize, legs: &mut Vec<Self>) {
        legs.clear();
        for (number, run) in runs.iter().enumerate() {
            let section = run.section;
            match legs.last_mut() {
                Some(leg) if leg.section == section || run.rows < SHORT => {
                    leg.runs.end = number + 1;
                }
                _ => legs.push(Self {
                    section,
                    runs: number..number + 1,
                    of_rings: false,
                }),
            }
        }
        legs.extend((0..with_rings).map(|section| Self {
            section,
            runs: 0..0,
            of_rings: true,
        }));
    }
}

/// Sums over the terms of contacts, which take the lanes in turn.
#[derive(Clone, Copy, Debug, Default)]
struct InTurn {
    lanes: [Record; LANES],
    /// Contacts so far.
    contacts: usize,
}

impl InTurn {
    #[inline(always)]
    fn add<M: Machine>(&mut self, terms: &[Record]) {
        // In registers, the lane of the next contact first.
        let next = |lane: usize| (self.contacts + lane) % LANES;
        let mut lanes = [Quad::<M>::splat(0.0); LANES];
        for (lane, sum) in lanes.iter_mut().enumerate() {
            *sum = self.lanes[next(lane)].quad();
        }
        let (eights, rest) = terms.as_chunks::<LANES>();
        for eight in eights {
            for lane in 0..LANES {
                lanes[lane] = lanes[lane] + eight[lane].quad();
            }
        }
        for (lane, sum) in lanes.into_iter().enumerate() {
            self.lanes[next(lane)] = match rest.get(lane) {
                Some(terms) => (sum + terms.quad()).record(),
                None => sum.record(),
            };
        }
        self.contacts += terms.len();
    }

    /// The sums over the lanes, as [`Lanes::sum`] adds them.
    fn sum(&self) -> [f64; 4] {
        core::array::from_fn(|number| {
            let [a, b, c, d, e, f, g, h] = self.lanes.map(|lane| lane.0[number]);
            ((a + e) + (c + g)) + ((b + f) + (d + h))
        })
    }
}

/// Sums over the contacts of grains, on their way from thread to thread.
#[derive(Debug, Default)]
struct OfContacts {
    losses: InTurn,
    rest: InTurn,
}

/// The mean force that is taken off the spheres of the wall.
#[derive(Debug, Default)]
pub(super) struct MeanForce {
    /// Sums of the forces on the spheres of all rings so far, and of their velocities.
    total: [Record; 2],
    /// Power of what was taken off ring by ring, with its sign turned.
    taken_off: f64,
}

impl MeanForce {
    /// The mean force that each sphere of these rings, which are all of the wall, has still to lose; its power goes to the
    /// tally.
    pub(super) fn of(wall: &ElasticWall, rings: &[Rings], tally: &mut Tally) -> Record {
        let mut mean_force = Self::default();
        rings.iter().for_each(|rings| mean_force.add(wall, rings));
        mean_force.finish(wall, tally)
    }

    /// Adds the rings of a section.
    fn add(&mut self, wall: &ElasticWall, rings: &Rings) {
        let per_ring = wall.lattice().spheres_per_ring as usize;
        let network = &wall.parameters().network;
        for [force, velocity] in &rings.of_rings {
            if network.tethers.net_force == NetForce::RemovedPerRing {
                self.taken_off += power_of_mean(force, velocity, per_ring);
                continue;
            }
            for (total, of_ring) in self.total.iter_mut().zip([force, velocity]) {
                for (total, of_ring) in total.0.iter_mut().zip(of_ring.0) {
                    *total += of_ring;
                }
            }
        }
    }

    fn finish(self, wall: &ElasticWall, tally: &mut Tally) -> Record {
        match wall.parameters().network.tethers.net_force {
            NetForce::Free => Record::ZERO,
            NetForce::RemovedPerRing => {
                tally.keep_power -= self.taken_off;
                Record::ZERO
            }
            NetForce::Removed => {
                let [force, velocity] = &self.total;
                let spheres = wall.lattice().spheres();
                tally.keep_power -= power_of_mean(force, velocity, spheres);
                mean(force, spheres)
            }
        }
    }
}

fn mean(force: &Record, spheres: usize) -> Record {
    Record(force.0.map(|force| force * (1.0 / spheres as f64)))
}

/// Power of the mean force on so many spheres, of the sums of forces and velocities.
fn power_of_mean(force: &Record, velocity: &Record, spheres: usize) -> f64 {
    mean(force, spheres).vector().dot(velocity.vector())
}

/// Sums over the rings of the wall, likewise: energy and dissipation of bonds, power of the drive, energy of tethers and
/// dissipation by drag.
type OfRings = [[f64; LANES]; 5];

/// An evaluation whose sums are being added up.
pub(super) struct Adding<'a> {
    instructions: Instructions,
    terms: AllTerms<'a>,
    /// Whether all sums are wanted.
    complete: bool,
    of_contacts: Mutex<OfContacts>,
    of_rings: Mutex<OfRings>,
}

/// Where the terms are, and in which order they are added.
#[derive(Clone, Copy)]
pub(super) struct AllTerms<'a> {
    pub(super) pairs: &'a [[Pairs; 2]],
    pub(super) rings: &'a [Rings],
    /// All rows, in the order of the list.
    pub(super) runs: &'a [Run],
    pub(super) legs: &'a [Leg],
}

impl<'a> Adding<'a> {
    pub(super) fn new(instructions: Instructions, terms: AllTerms<'a>, complete: bool) -> Self {
        Self {
            instructions,
            terms,
            complete,
            of_contacts: Mutex::default(),
            of_rings: Mutex::default(),
        }
    }

    /// The legs of contacts, and those of rings.
    pub(super) fn chains(&self) -> [&'a [Leg]; 2] {
        let legs = self.terms.legs;
        let (of_contacts, of_rings) = legs.split_at(legs.partition_point(|leg| !leg.of_rings));
        [of_contacts, of_rings]
    }

    /// Adds the terms of a leg.
    pub(super) fn add(&self, leg: &Leg) {
        match leg.of_rings {
            true => self.instructions.run(AddRings {
                rings: &self.terms.rings[leg.section],
                sums: &mut self.of_rings.lock().unwrap_or_else(PoisonError::into_inner),
            }),
            false => self.instructions.run(AddContacts {
                leg,
                terms: self.terms,
                sums: &mut self
                    .of_contacts
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner),
                complete: self.complete,
            }),
        }
    }

    /// When all legs are done: adds the sums to the tally.
    pub(super) fn finish(self, tally: &mut Tally) {
        let of_contacts = self.of_contacts.into_inner();
        let of_rings = self.of_rings.into_inner();
        self.instructions.run(AddAll {
            of_contacts: of_contacts.unwrap_or_else(PoisonError::into_inner),
            of_rings: of_rings.unwrap_or_else(PoisonError::into_inner),
            pairs: self.terms.pairs,
            tally,
        });
    }
}

/// Adds the terms of the contacts of a leg.
struct AddContacts<'a> {
    leg: &'a Leg,
    terms: AllTerms<'a>,
    sums: &'a mut OfContacts,
    complete: bool,
}

impl Work for AddContacts<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let AllTerms { pairs, runs, .. } = self.terms;
        for run in &runs[self.leg.runs.clone()] {
            let [Pairs { terms, .. }, _] = &pairs[run.section];
            let contacts = terms.runs[run.number].clone();
            let losses = &terms.losses[contacts.clone()];
            self.sums.losses.add::<M>(losses);
            if self.complete {
                self.sums.rest.add::<M>(&terms.rest[contacts]);
            }
        }
    }
}

/// Adds the terms of the rings of a section.
struct AddRings<'a> {
    rings: &'a Rings,
    sums: &'a mut OfRings,
}

impl Work for AddRings<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self { rings, sums } = self;
        let mut lanes = sums.map(|sum| Lanes::<M>::from_array(&sum));
        let [bonds, bonds_lose, drive, tethers, drag] = &mut lanes;
        for [energy, dissipation] in &rings.terms.bonds {
            *bonds += Lanes::from_array(energy);
            *bonds_lose += Lanes::from_array(dissipation);
        }
        for power in &rings.terms.drive {
            *drive += Lanes::from_array(power);
        }
        for [energy, dissipation] in &rings.terms.tethers {
            *tethers += Lanes::from_array(energy);
            *drag += Lanes::from_array(dissipation);
        }
        *sums = lanes.map(Lanes::to_array);
    }
}

/// Adds what is left when all legs are done, and the sums to the tally.
struct AddAll<'a> {
    of_contacts: OfContacts,
    of_rings: OfRings,
    pairs: &'a [[Pairs; 2]],
    tally: &'a mut Tally,
}

impl Work for AddAll<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            of_contacts,
            of_rings,
            pairs,
            tally,
        } = self;
        let [normal, tangential, sliding, energy] = of_contacts.losses.sum();
        tally.normal_dissipation += normal;
        tally.tangential_lost += tangential;
        tally.sliding_lost += sliding;
        tally.contact_energy += energy;
        let [overlap, axial_force, ..] = of_contacts.rest.sum();
        tally.total_overlap += overlap;
        tally.wall_axial_force += axial_force;
        let mut of_wall = InTurn::default();
        for [Pairs { terms, .. }, Pairs { terms: wall, .. }] in pairs {
            let [with_grains, with_wall, that_slide] = terms.numbers;
            tally.grain_contacts += with_grains;
            tally.wall_contacts += with_wall;
            tally.sliding_contacts += that_slide;
            tally.largest_overlap = tally.largest_overlap.max(terms.largest_overlap);
            for run in &wall.runs {
                of_wall.add::<M>(&wall.losses[run.clone()]);
            }
        }
        // Contacts of wall spheres with each other are no contacts of grains.
        let [normal, _, _, energy] = of_wall.sum();
        tally.normal_dissipation += normal;
        tally.contact_energy += energy;
        let of_rings = of_rings.map(|sum| Lanes::<M>::from_array(&sum).sum());
        let [bonds, bonds_lose, drive, tethers, drag] = of_rings;
        tally.network_energy += bonds;
        tally.network_dissipation += bonds_lose;
        tally.drive_power += drive;
        tally.keep_energy += tethers;
        tally.drag_dissipation += drag;
    }
}
