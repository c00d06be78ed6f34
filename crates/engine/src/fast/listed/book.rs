//! What is added up over contacts and over the spheres of a wall, at once or later.
//!
//! Sums have one order, whichever threads worked out their terms. One section adds them up as it goes. Of several, each
//! writes down the terms of its own rows of the list, or rings, and then they are added in the order of the list.

use core::slice;

use super::pairs::Pairs;
use super::record::Record;
use crate::fast::lanes::{LANES, Lanes, Quad};
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::ledger::Tally;

/// Takes the terms of sums over the spheres of a wall, eight side by side; lanes that hold none are 0.
pub(super) trait Book<M: Machine> {
    /// Energy and dissipation of each of the three bonds.
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]);
    /// Power of the drive.
    fn drive(&mut self, power: Lanes<M>);
    /// Energy of the tethers, and dissipation by drag.
    fn tethers(&mut self, terms: [Lanes<M>; 2]);
}

impl<M: Machine> Book<M> for Sums<M> {
    #[inline(always)]
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]) {
        for [energy, dissipation] in terms {
            self.network_energy += energy;
            self.network_dissipation += dissipation;
        }
    }

    #[inline(always)]
    fn drive(&mut self, power: Lanes<M>) {
        self.drive_power += power;
    }

    #[inline(always)]
    fn tethers(&mut self, [energy, dissipation]: [Lanes<M>; 2]) {
        self.keep_energy += energy;
        self.drag_dissipation += dissipation;
    }
}

/// Terms of the rings of a section, which wait to be added.
#[derive(Clone, Debug, Default)]
pub(super) struct WallTerms {
    bonds: Vec<[[f64; LANES]; 2]>,
    drive: Vec<[f64; LANES]>,
    tethers: Vec<[[f64; LANES]; 2]>,
}

impl WallTerms {
    pub(super) fn clear(&mut self) {
        self.bonds.clear();
        self.drive.clear();
        self.tethers.clear();
    }
}

impl<M: Machine> Book<M> for WallTerms {
    #[inline(always)]
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]) {
        let [one, two, three] = terms;
        self.bonds
            .extend([to_arrays(one), to_arrays(two), to_arrays(three)]);
    }

    #[inline(always)]
    fn drive(&mut self, power: Lanes<M>) {
        self.drive.push(power.to_array());
    }

    #[inline(always)]
    fn tethers(&mut self, terms: [Lanes<M>; 2]) {
        self.tethers.push(to_arrays(terms));
    }
}

#[inline(always)]
fn to_arrays<M: Machine>([one, two]: [Lanes<M>; 2]) -> [[f64; LANES]; 2] {
    [one.to_array(), two.to_array()]
}

/// Terms of the contacts in the rows of a section, which wait to be added.
#[derive(Clone, Debug, Default)]
pub(super) struct RowTerms {
    /// Contacts of each row; behind them room for those of other sections.
    pub(super) rows: Vec<u32>,
    /// Of each contact normal dissipation, tangential loss, sliding loss, energy; and room for eight more.
    pub(super) losses: Vec<Record>,
    /// Of each contact overlap and axial force of the wall, where all sums are wanted; and room for eight more.
    pub(super) rest: Vec<Record>,
    pub(super) contacts: usize,
    /// Of grains with grains, of grains with the wall, and of those that slide.
    pub(super) numbers: [u64; 3],
    pub(super) largest_overlap: f64,
}

impl RowTerms {
    /// Forgets all, and makes room for so many contacts in so many rows.
    pub(super) fn clear(&mut self, rows: usize, contacts: usize, complete: bool) {
        self.rows.clear();
        self.rows.resize(rows + 1, 0);
        let room = contacts + LANES;
        if self.losses.len() < room {
            self.losses.resize(room, Record::ZERO);
        }
        if complete && self.rest.len() < room {
            self.rest.resize(room, Record::ZERO);
        }
        self.contacts = 0;
        self.numbers = [0; 3];
        self.largest_overlap = 0.0;
    }

    /// All rows, to be added up one after the other.
    fn rows(&self, complete: bool) -> Rows<'_> {
        Rows {
            rows: self.rows.iter(),
            losses: self.losses[..self.contacts].iter(),
            rest: self.rest[..if complete { self.contacts } else { 0 }].iter(),
        }
    }
}

/// Rows that are still to be added up.
struct Rows<'a> {
    rows: slice::Iter<'a, u32>,
    losses: slice::Iter<'a, Record>,
    rest: slice::Iter<'a, Record>,
}

impl Rows<'_> {
    #[inline(always)]
    fn add_next<M: Machine>(&mut self, sums: &mut ContactSums<M>) {
        for _ in 0..self.rows.next().copied().unwrap_or_default() {
            if let Some(losses) = self.losses.next() {
                sums.add(losses, self.rest.next());
            }
        }
    }
}

/// Adds up the terms of the contacts of all sections, row after row, as if they stood one after the other in the lanes.
pub(super) struct AddContacts<'a> {
    pub(super) pairs: &'a [[Pairs; 2]],
    /// The section of each grain.
    pub(super) section_of: &'a [u16],
    /// Whether all sums are wanted.
    pub(super) complete: bool,
    pub(super) tally: &'a mut Tally,
}

impl Work for AddContacts<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            pairs,
            section_of,
            complete,
            tally,
        } = self;
        let mut sums = ContactSums::<M>::new();
        let mut rows: Vec<_> = pairs
            .iter()
            .map(|[of_grains, _]| of_grains.terms.rows(complete))
            .collect();
        for &section in section_of {
            rows[section as usize].add_next(&mut sums);
        }
        let [losses, rest] = sums.added();
        let [normal, tangential, sliding, energy] = losses.0;
        tally.normal_dissipation += normal;
        tally.tangential_lost += tangential;
        tally.sliding_lost += sliding;
        tally.contact_energy += energy;
        let [overlap, axial_force, ..] = rest.0;
        tally.total_overlap += overlap;
        tally.wall_axial_force += axial_force;
        for [Pairs { terms, .. }, _] in pairs {
            let [with_grains, with_wall, that_slide] = terms.numbers;
            tally.grain_contacts += with_grains;
            tally.wall_contacts += with_wall;
            tally.sliding_contacts += that_slide;
            tally.largest_overlap = tally.largest_overlap.max(terms.largest_overlap);
        }
        // Contacts of wall spheres with each other are no contacts of grains.
        let mut of_wall = ContactSums::<M>::new();
        for [_, Pairs { terms, .. }] in pairs {
            let losses = terms.losses[..terms.contacts].iter();
            losses.for_each(|losses| of_wall.add(losses, None));
        }
        let [losses, _] = of_wall.added();
        let [normal, _, _, energy] = losses.0;
        tally.normal_dissipation += normal;
        tally.contact_energy += energy;
    }
}

/// Eight sums of each term, which contacts take in turn.
struct ContactSums<M: Machine> {
    lane: usize,
    losses: [Quad<M>; LANES],
    rest: [Quad<M>; LANES],
}

impl<M: Machine> ContactSums<M> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            lane: 0,
            losses: [Quad::<M>::splat(0.0); LANES],
            rest: [Quad::<M>::splat(0.0); LANES],
        }
    }

    #[inline(always)]
    fn add(&mut self, losses: &Record, rest: Option<&Record>) {
        let lane = self.lane % LANES;
        self.losses[lane] = self.losses[lane] + losses.quad();
        if let Some(rest) = rest {
            self.rest[lane] = self.rest[lane] + rest.quad();
        }
        self.lane += 1;
    }

    /// The sums over the lanes, as [`Lanes::sum`] adds them.
    #[inline(always)]
    fn added(self) -> [Record; 2] {
        [self.losses, self.rest]
            .map(|[a, b, c, d, e, f, g, h]| (((a + e) + (c + g)) + ((b + f) + (d + h))).record())
    }
}

/// Adds up the terms of the rings of all sections.
pub(super) struct AddRings<'a, I: Iterator<Item = &'a WallTerms>> {
    pub(super) sections: I,
    pub(super) tally: &'a mut Tally,
}

impl<'a, I: Iterator<Item = &'a WallTerms>> Work for AddRings<'a, I> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let mut sums = Sums::<M>::default();
        for terms in self.sections {
            for [energy, dissipation] in &terms.bonds {
                sums.network_energy += Lanes::from_array(energy);
                sums.network_dissipation += Lanes::from_array(dissipation);
            }
            for power in &terms.drive {
                sums.drive(Lanes::from_array(power));
            }
            for [energy, dissipation] in &terms.tethers {
                sums.tethers([Lanes::from_array(energy), Lanes::from_array(dissipation)]);
            }
        }
        sums.add_to(self.tally);
    }
}
