//! What is added up over contacts and over the spheres of a wall, at once or later.
//!
//! Sums have one order, whichever threads worked out their terms. One thread adds them up as it goes; of several, each
//! writes down the terms of its stretch, and then they are added in the order of the stretches.

use crate::fast::lanes::{LANES, Lanes};
use crate::fast::machine::{Machine, Work};
use crate::fast::sums::Sums;
use crate::ledger::Tally;

/// Takes the terms of sums, eight side by side; lanes that hold none are 0.
pub(super) trait Book<M: Machine> {
    /// Of contacts of grains.
    fn contacts(&mut self, terms: ContactTerms<M>);
    /// Of the three bonds of wall spheres: energy and dissipation of each.
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]);
    /// Of wall spheres: energy of their tethers, power of their drive, dissipation by drag.
    fn tethers(&mut self, terms: [Lanes<M>; 3]);
}

/// What is added up over eight contacts of grains.
pub(super) struct ContactTerms<M: Machine> {
    /// Energy, normal dissipation, tangential and sliding loss, overlap, axial force of the wall.
    pub(super) in_lanes: [Lanes<M>; 6],
    /// Of grains with grains, of grains with the wall, and of those that slide.
    pub(super) numbers: [u64; 3],
}

impl<M: Machine> Book<M> for Sums<M> {
    #[inline(always)]
    fn contacts(&mut self, terms: ContactTerms<M>) {
        let [energy, normal, tangential, sliding, overlap, axial_force] = terms.in_lanes;
        self.contact_energy += energy;
        self.normal_dissipation += normal;
        self.tangential_lost += tangential;
        self.sliding_lost += sliding;
        self.total_overlap += overlap;
        self.largest_overlap = self.largest_overlap.max(overlap);
        self.wall_axial_force += axial_force;
        let [with_grains, with_wall, that_slide] = terms.numbers;
        self.grain_contacts += with_grains;
        self.wall_contacts += with_wall;
        self.sliding_contacts += that_slide;
    }

    #[inline(always)]
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]) {
        for [energy, dissipation] in terms {
            self.network_energy += energy;
            self.network_dissipation += dissipation;
        }
    }

    #[inline(always)]
    fn tethers(&mut self, [energy, power, dissipation]: [Lanes<M>; 3]) {
        self.keep_energy += energy;
        self.drive_power += power;
        self.drag_dissipation += dissipation;
    }
}

/// Terms that wait to be added.
#[derive(Clone, Debug, Default)]
pub(super) struct Terms {
    contacts: Vec<[[f64; LANES]; 6]>,
    numbers: [u64; 3],
    bonds: Vec<[[[f64; LANES]; 2]; 3]>,
    tethers: Vec<[[f64; LANES]; 3]>,
}

impl Terms {
    pub(super) fn clear(&mut self) {
        self.contacts.clear();
        self.numbers = [0; 3];
        self.bonds.clear();
        self.tethers.clear();
    }

    /// How many contacts there are.
    fn contacts(&self) -> usize {
        (self.numbers[0] + self.numbers[1]) as usize
    }
}

impl<M: Machine> Book<M> for Terms {
    #[inline(always)]
    fn contacts(&mut self, terms: ContactTerms<M>) {
        self.contacts.push(to_arrays(terms.in_lanes));
        for (all, more) in self.numbers.iter_mut().zip(terms.numbers) {
            *all += more;
        }
    }

    #[inline(always)]
    fn bonds(&mut self, terms: [[Lanes<M>; 2]; 3]) {
        let [one, two, three] = terms;
        self.bonds
            .push([to_arrays(one), to_arrays(two), to_arrays(three)]);
    }

    #[inline(always)]
    fn tethers(&mut self, terms: [Lanes<M>; 3]) {
        self.tethers.push(to_arrays(terms));
    }
}

#[inline(always)]
fn to_arrays<M: Machine, const N: usize>(lanes: [Lanes<M>; N]) -> [[f64; LANES]; N] {
    let mut arrays = [[0.0; LANES]; N];
    for (array, lanes) in arrays.iter_mut().zip(lanes) {
        *array = lanes.to_array();
    }
    arrays
}

#[inline(always)]
fn from_arrays<M: Machine, const N: usize>(arrays: &[[f64; LANES]; N]) -> [Lanes<M>; N] {
    let mut lanes = [Lanes::splat(0.0); N];
    for (lanes, array) in lanes.iter_mut().zip(arrays) {
        *lanes = Lanes::from_array(array);
    }
    lanes
}

/// Adds up terms in the order of the stretches, as if the contacts of all stood one after the other in the lanes.
pub(super) struct AddUp<'a, I: Iterator<Item = &'a Terms>> {
    pub(super) stretches: I,
    pub(super) tally: &'a mut Tally,
}

impl<'a, I: Iterator<Item = &'a Terms>> Work for AddUp<'a, I> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let mut sums = Sums::<M>::default();
        let mut turned = 0;
        for terms in self.stretches {
            let numbers = [0; 3];
            for in_lanes in &terms.contacts {
                let in_lanes = from_arrays(in_lanes);
                sums.contacts(ContactTerms { in_lanes, numbers });
            }
            // The first contact to come goes into lane 0.
            sums.turn(terms.contacts());
            turned += terms.contacts();
            for [one, two, three] in &terms.bonds {
                sums.bonds([from_arrays(one), from_arrays(two), from_arrays(three)]);
            }
            for in_lanes in &terms.tethers {
                sums.tethers(from_arrays(in_lanes));
            }
            let (in_lanes, numbers) = ([Lanes::splat(0.0); 6], terms.numbers);
            sums.contacts(ContactTerms { in_lanes, numbers });
        }
        sums.turn(LANES - turned % LANES);
        sums.add_to(self.tally);
    }
}

impl<M: Machine> Sums<M> {
    /// Moves the sums over contacts so many lanes down and round.
    #[inline(always)]
    fn turn(&mut self, by: usize) {
        for sum in [
            &mut self.contact_energy,
            &mut self.normal_dissipation,
            &mut self.tangential_lost,
            &mut self.sliding_lost,
            &mut self.total_overlap,
            &mut self.wall_axial_force,
        ] {
            let mut numbers = sum.to_array();
            numbers.rotate_left(by % LANES);
            *sum = Lanes::from_array(&numbers);
        }
    }
}
