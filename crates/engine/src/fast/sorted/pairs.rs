//! Contacts between grains: each block of grains against eight partners at a time.

use core::ops::Range;

use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::real::{Real, Vector};

use super::distances::{Distances, Near};
use super::rows::NOWHERE;
use super::tile::{Partners, Tile};
use crate::fast::columns::{ColumnsMut, ColumnsRef};
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::Machine;
use crate::fast::sums::Sums;

/// Constants of all pairs of grains.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairConstants {
    /// d, the distance at which grains touch.
    pub(super) reach: f64,
    /// R_ij \[d\]
    pub(super) reduced_radius: f64,
}

/// A block of grains, one in each lane.
#[derive(Clone, Copy)]
pub(super) struct Block<M: Machine> {
    place: usize,
    pub(super) position: LaneVector<M>,
    pub(super) velocity: LaneVector<M>,
    /// Which lanes hold a grain.
    pub(super) holds: Mask<M>,
}

impl<M: Machine> Block<M> {
    /// The block that begins at `place`, of `grains` grains in all.
    #[inline(always)]
    pub(super) fn load(
        position: ColumnsRef<'_>,
        velocity: ColumnsRef<'_>,
        place: usize,
        grains: usize,
    ) -> Self {
        let holds = Mask::first(grains - place);
        let mut block = Self {
            place,
            position: position.load(place),
            velocity: velocity.load(place),
            holds,
        };
        if place + LANES > grains {
            // The numbers of the other lanes are arbitrary.
            block.position = LaneVector::select(holds, block.position, LaneVector::default());
            block.velocity = LaneVector::select(holds, block.velocity, LaneVector::default());
        }
        block
    }

    /// Writes down which of the partners in the tile touch these grains, so that what follows can be predicted.
    #[inline(always)]
    pub(super) fn find_touching(
        &self,
        reach: f64,
        position: ColumnsRef<'_>,
        tile: &Tile,
        touching: &mut Touching,
    ) {
        let reach = Lanes::splat(reach);
        let reach_squared = reach * reach;
        // Lanes without a grain are out of reach.
        let mut here = self.position;
        here.z = Lanes::select(self.holds, here.z, Lanes::splat(-NOWHERE));
        for &partners in tile.partners(self.place) {
            let separation = here - position.load(partners.start as usize);
            let squared = separation.squared();
            touching.note(partners, squared, squared.less(reach_squared).any());
        }
    }

    /// Adds the forces between these grains and the given ones that touch them to `force`, which counts places as the
    /// tile does.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub(super) fn add_pairs<N: NormalLaw, const FULL: bool>(
        &self,
        law: &N,
        constants: &PairConstants,
        position: ColumnsRef<'_>,
        velocity: ColumnsRef<'_>,
        tile: &Tile,
        touching: &Touching,
        those: Range<usize>,
        force: &mut ColumnsMut<'_>,
        sums: &mut Sums<M>,
    ) {
        let reduced_radius = Lanes::splat(constants.reduced_radius);
        let mut on_block = LaneVector::default();
        for eight in those {
            let partners = touching.partners[eight];
            let start = partners.start as usize;
            let Near {
                touch,
                overlap,
                inverse,
            } = touching.distances.near::<M>(eight, constants.reach);
            if FULL {
                sums.grain_contacts += touch.count();
            }
            let separation = self.position - position.load(start);
            let away = self.velocity - velocity.load(start);
            let normal_velocity = away.dot(separation) * inverse;
            let answer = law.force(overlap, normal_velocity, reduced_radius);
            let pushed = separation * (answer.force * inverse);
            on_block += pushed;
            force.add(partners.force as usize, -pushed);

            let lost = (answer.elastic_force - answer.force) * normal_velocity;
            sums.add_contact::<FULL>(overlap, answer.energy, lost);
        }
        force.add(self.place - tile.first, on_block);
    }
}

/// Blocks and partners of a tile that touch.
#[derive(Debug, Default)]
pub(super) struct Touching {
    partners: Vec<Partners>,
    pub(super) distances: Distances,
}

impl Touching {
    /// Begins anew, with room for so many partners.
    pub(super) fn clear(&mut self, room: usize) {
        self.distances.clear(room);
        if self.partners.len() < room {
            self.partners.resize(room, Partners::default());
        }
    }

    /// Writes down partners if they are `wanted`.
    #[inline(always)]
    fn note<M: Machine>(&mut self, partners: Partners, squared: Lanes<M>, wanted: bool) {
        self.partners[self.distances.number()] = partners;
        self.distances.note(0, squared);
        self.distances.keep(wanted.into());
    }
}

impl<M: Machine> Sums<M> {
    /// Adds contacts; lanes without one hold zeros. Sums that only observers read, not the ledger, are left out unless
    /// `FULL`.
    #[inline(always)]
    pub(super) fn add_contact<const FULL: bool>(
        &mut self,
        overlap: Lanes<M>,
        energy: Lanes<M>,
        lost: Lanes<M>,
    ) {
        self.normal_dissipation += lost;
        self.largest_overlap = self.largest_overlap.max(overlap);
        if FULL {
            self.contact_energy += energy;
            self.total_overlap += overlap;
        }
    }
}
