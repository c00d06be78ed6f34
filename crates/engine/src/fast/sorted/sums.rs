//! Sums over contacts, lane by lane.

use peristalsis_physics::real::Real;

use crate::fast::lanes::Lanes;
use crate::fast::machine::Machine;
use crate::ledger::Tally;

/// Sums over the contacts of a tile; the fields of [`Tally`] that smooth grains in a prescribed wall fill.
#[derive(Clone, Copy)]
pub(super) struct Sums<M: Machine> {
    pub(super) wall_power: Lanes<M>,
    normal_dissipation: Lanes<M>,
    largest_overlap: Lanes<M>,
    contact_energy: Lanes<M>,
    total_overlap: Lanes<M>,
    pub(super) wall_axial_force: Lanes<M>,
    pub(super) grain_contacts: u64,
    pub(super) wall_contacts: u64,
}

impl<M: Machine> Sums<M> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        let zero = Lanes::default();
        Self {
            wall_power: zero,
            normal_dissipation: zero,
            largest_overlap: zero,
            contact_energy: zero,
            total_overlap: zero,
            wall_axial_force: zero,
            grain_contacts: 0,
            wall_contacts: 0,
        }
    }

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

    /// The sums over the lanes.
    #[inline(always)]
    pub(super) fn tally(&self) -> Tally {
        Tally {
            wall_power: self.wall_power.sum(),
            normal_dissipation: self.normal_dissipation.sum(),
            largest_overlap: self.largest_overlap.max_lane(),
            contact_energy: self.contact_energy.sum(),
            total_overlap: self.total_overlap.sum(),
            wall_axial_force: self.wall_axial_force.sum(),
            grain_contacts: self.grain_contacts,
            wall_contacts: self.wall_contacts,
            ..Tally::default()
        }
    }
}
