//! Sums over the contacts and over the spheres of a wall, lane by lane.

use super::lanes::Lanes;
use super::machine::Machine;
use crate::ledger::Tally;

/// The fields of [`Tally`] that kernels add up in lanes.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums<M: Machine> {
    pub(super) contact_energy: Lanes<M>,
    pub(super) network_energy: Lanes<M>,
    pub(super) keep_energy: Lanes<M>,
    pub(super) wall_power: Lanes<M>,
    pub(super) drive_power: Lanes<M>,
    pub(super) normal_dissipation: Lanes<M>,
    pub(super) drag_dissipation: Lanes<M>,
    pub(super) network_dissipation: Lanes<M>,
    pub(super) tangential_lost: Lanes<M>,
    pub(super) sliding_lost: Lanes<M>,
    pub(super) wall_axial_force: Lanes<M>,
    pub(super) largest_overlap: Lanes<M>,
    pub(super) total_overlap: Lanes<M>,
    pub(super) grain_contacts: u64,
    pub(super) wall_contacts: u64,
    pub(super) sliding_contacts: u64,
}

impl<M: Machine> Sums<M> {
    /// Adds the sums over the lanes.
    #[inline(always)]
    pub(super) fn add_to(&self, tally: &mut Tally) {
        tally.contact_energy += self.contact_energy.sum();
        tally.network_energy += self.network_energy.sum();
        tally.keep_energy += self.keep_energy.sum();
        tally.wall_power += self.wall_power.sum();
        tally.drive_power += self.drive_power.sum();
        tally.normal_dissipation += self.normal_dissipation.sum();
        tally.drag_dissipation += self.drag_dissipation.sum();
        tally.network_dissipation += self.network_dissipation.sum();
        tally.tangential_lost += self.tangential_lost.sum();
        tally.sliding_lost += self.sliding_lost.sum();
        tally.wall_axial_force += self.wall_axial_force.sum();
        let largest_overlap = self.largest_overlap.max_lane();
        tally.largest_overlap = tally.largest_overlap.max(largest_overlap);
        tally.total_overlap += self.total_overlap.sum();
        tally.grain_contacts += self.grain_contacts;
        tally.wall_contacts += self.wall_contacts;
        tally.sliding_contacts += self.sliding_contacts;
    }
}
