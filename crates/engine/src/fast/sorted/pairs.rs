//! Contacts between grains: each block of grains against eight partners at a time.

use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::real::{Real, Vector};

use super::tile::{Partners, Tile};
use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::Machine;
use crate::fast::sums::Sums;

/// Squared distance \[d^2\] below which two centres count as one, and have no normal.
pub(super) const COINCIDENT: f64 = 1e-30;

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
        position: &Columns,
        velocity: &Columns,
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

    /// Adds the forces between these grains and their partners in the tile to `force`, which counts places as
    /// the tile does.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub(super) fn add_pairs<N: NormalLaw, const FULL: bool>(
        &self,
        law: &N,
        constants: &PairConstants,
        position: &Columns,
        velocity: &Columns,
        tile: &Tile,
        touching: &mut [Partners],
        force: &mut Columns,
        sums: &mut Sums<M>,
    ) {
        let block = self;
        let reach = Lanes::splat(constants.reach);
        let reach_squared = reach * reach;
        let reduced_radius = Lanes::splat(constants.reduced_radius);
        let zero = Lanes::splat(0.0);
        let mut on_block = LaneVector::default();
        let listed = tile.partners(self.place);
        // First the partners that touch, so that the branches below can be predicted.
        let mut number = 0;
        for partners in listed {
            let separation = block.position - position.load(partners.start as usize);
            let touches = separation.squared().less(reach_squared) & block.holds;
            touching[number] = *partners;
            number += usize::from(touches.any());
        }
        for partners in &touching[..number] {
            let start = partners.start as usize;
            let separation = block.position - position.load(start);
            let distance_squared = separation.squared();
            let touches = distance_squared.less(reach_squared)
                & Lanes::splat(COINCIDENT).less(distance_squared)
                & block.holds;
            let inverse = distance_squared.reciprocal_sqrt();
            let overlap = Lanes::select(touches, reach - distance_squared * inverse, zero);
            let away = block.velocity - velocity.load(start);
            let normal_velocity = Lanes::select(touches, away.dot(separation) * inverse, zero);
            let answer = law.force(overlap, normal_velocity, reduced_radius);
            let pushed = separation * Lanes::select(touches, answer.force * inverse, zero);
            on_block += pushed;
            force.add(partners.force as usize, -pushed);

            let lost = (answer.elastic_force - answer.force) * normal_velocity;
            sums.add_contact::<FULL>(overlap, answer.energy, lost);
            if FULL {
                sums.grain_contacts += touches.count();
            }
        }
        force.add(self.place - tile.first, on_block);
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
