//! Terms of the contacts and rings of a section, which are added up at once or later.

use core::ops::Range;

use super::record::Record;
use crate::fast::lanes::{LANES, Lanes};
use crate::fast::machine::Machine;
use crate::fast::sums::Sums;

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
    pub(super) bonds: Vec<[[f64; LANES]; 2]>,
    pub(super) drive: Vec<[f64; LANES]>,
    pub(super) tethers: Vec<[[f64; LANES]; 2]>,
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

/// Terms of the contacts of a section, of which those in its rows of the list wait to be added.
#[derive(Clone, Debug, Default)]
pub(super) struct RowTerms {
    /// The contacts of each run of rows.
    pub(super) runs: Vec<Range<usize>>,
    /// Of each contact normal dissipation, tangential loss, sliding loss, energy; and room for eight more.
    pub(super) losses: Vec<Record>,
    /// Of each contact overlap and axial force of the wall, where all sums are wanted; and room for eight more.
    pub(super) rest: Vec<Record>,
    /// Of grains with grains, of grains with the wall, and of those that slide, in its rows.
    pub(super) numbers: [u64; 3],
    pub(super) largest_overlap: f64,
}

impl RowTerms {
    /// Forgets all, and makes room for so many contacts.
    pub(super) fn clear(&mut self, contacts: usize, complete: bool) {
        let room = contacts + LANES;
        if self.losses.len() < room {
            self.losses.resize(room, Record::ZERO);
        }
        if complete && self.rest.len() < room {
            self.rest.resize(room, Record::ZERO);
        }
        self.runs.clear();
        self.numbers = [0; 3];
    }
}
