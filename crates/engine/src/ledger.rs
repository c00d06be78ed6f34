//! The energy ledger: where energy comes from and where it goes.

use glam::DVec3;
use peristalsis_physics::contact::ContactForce;

/// Sums of one evaluation of the forces, at one instant.
///
/// Energies in m d^2/t^2, powers in m d^2/t^3; "lost" terms are amounts of the step that led here.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Tally {
    /// Elastic energy of all contacts.
    pub contact_energy: f64,
    /// Elastic energy of the springs of the wall's network.
    pub network_energy: f64,
    /// Energy of the tethers and of the constant force that keep an elastic wall in place.
    pub keep_energy: f64,
    /// Power of the prescribed wall on the grains, sum f . V.
    pub wall_power: f64,
    /// Power of the travelling force on an elastic wall.
    pub drive_power: f64,
    /// Power of the force that removes the mean force of an elastic wall.
    pub keep_power: f64,
    /// Power lost along the normals of contacts, never negative.
    pub normal_dissipation: f64,
    /// Power lost to drag on an elastic wall.
    pub drag_dissipation: f64,
    /// Power lost in the dashpots of the wall's network.
    pub network_dissipation: f64,
    /// Energy lost to tangential damping in this step.
    pub tangential_lost: f64,
    /// Energy lost to sliding in this step.
    pub sliding_lost: f64,
    /// Energy lost in this step to damping and sliding of rolling contacts.
    pub rolling_lost: f64,
    /// Energy of cohesion lost in this step because contacts broke.
    pub cohesion_lost: f64,
    /// Energy of tangential and rolling springs forgotten in this step because their spheres parted.
    pub history_reset: f64,
    /// Axial force of the wall on the grains, along +z \[m d/t^2\].
    pub wall_axial_force: f64,
    /// Contacts between grains.
    pub grain_contacts: u64,
    /// Contacts of grains with the wall.
    pub wall_contacts: u64,
    /// Contacts of grains that slide.
    pub sliding_contacts: u64,
    /// Largest overlap of a contact of a grain \[d\].
    pub largest_overlap: f64,
    /// Sum of the overlaps of all contacts of grains \[d\].
    pub total_overlap: f64,
}

impl Tally {
    /// Adds the answer of the law for a contact of a grain.
    #[inline(always)]
    pub(crate) fn add_contact(&mut self, answer: &ContactForce, overlap: f64) {
        self.contact_energy += answer.energy;
        self.normal_dissipation += answer.normal_dissipation;
        self.tangential_lost += answer.tangential.damped;
        self.sliding_lost += answer.tangential.slid;
        self.sliding_contacts += u64::from(answer.tangential.sliding);
        self.largest_overlap = self.largest_overlap.max(overlap);
        self.total_overlap += overlap;
    }

    /// Adds the contacts of frictionless grains in a prescribed wall that another part of the same evaluation has found.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.contact_energy += other.contact_energy;
        self.wall_power += other.wall_power;
        self.normal_dissipation += other.normal_dissipation;
        self.wall_axial_force += other.wall_axial_force;
        self.grain_contacts += other.grain_contacts;
        self.wall_contacts += other.wall_contacts;
        self.largest_overlap = self.largest_overlap.max(other.largest_overlap);
        self.total_overlap += other.total_overlap;
    }

    /// Elastic energy of contacts, with what contacts lost in this step other than along their normals.
    pub(crate) fn stored_and_lost(&self) -> f64 {
        self.contact_energy
            + self.tangential_lost
            + self.sliding_lost
            + self.rolling_lost
            + self.cohesion_lost
            + self.history_reset
    }

    /// Elastic energy of contacts, network and tethers.
    pub fn potential_energy(&self) -> f64 {
        self.contact_energy + self.network_energy + self.keep_energy
    }

    /// Power that enters from outside.
    fn input_power(&self) -> f64 {
        self.wall_power + self.drive_power + self.keep_power
    }
}

/// Energies accumulated since the start of the run, by the trapezoidal rule over the steps.
///
/// kinetic + potential = initial + wall + drive + keep + body + exchanged - normal - tangential - sliding - rolling - cohesion
/// - drag - network - reset, up to the integrator's error: [`Ledger::residual`]. All in m d^2/t^2. The work of the body force is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ledger {
    /// Kinetic and potential energy at the start.
    pub initial_energy: f64,
    /// Work of the prescribed wall on the grains.
    pub wall_work: f64,
    /// Work of the travelling force on an elastic wall.
    pub drive_work: f64,
    /// Work of the force that removes the mean force of an elastic wall.
    pub keep_work: f64,
    /// Work of the body force on the grains, up to the end of the last advance.
    pub body_work: f64,
    /// Sum m r of the grains at the start, from which that work is counted \[m d\].
    pub initial_moment: DVec3,
    /// Energy that grains brought through the inlet of an open tube, less what others took out with them.
    pub exchanged: f64,
    /// Integral of |power of wall and drive|: with the body's work the scale of the residual.
    pub gross_work: f64,
    /// Lost along the normals of contacts.
    pub normal_dissipated: f64,
    /// Lost to tangential damping.
    pub tangential_dissipated: f64,
    /// Lost to sliding.
    pub sliding_dissipated: f64,
    /// Lost to rolling resistance.
    pub rolling_dissipated: f64,
    /// Lost where contacts that cohered broke.
    pub cohesion_dissipated: f64,
    /// Lost to drag on the wall.
    pub drag_dissipated: f64,
    /// Lost in the dashpots of the wall's network.
    pub network_dissipated: f64,
    /// Energy of tangential and rolling springs forgotten because their spheres parted. Where damping brings the normal force
    /// to 0 before, as in Hertz contacts, the spring slides to nothing, and that counts as sliding.
    pub history_reset: f64,
    /// Largest overlap of a contact of a grain at any step \[d\].
    pub largest_overlap: f64,
}

/// Work, in units of the initial energy, below which the residual is compared with the initial energy.
const LEAST_WORK: f64 = 1e-6;

impl Ledger {
    /// Adds one step from the tally at its beginning to the tally at its end.
    pub(crate) fn add_step(&mut self, before: &Tally, after: &Tally, time_step: f64) {
        let half = 0.5 * time_step;
        self.wall_work += half * (before.wall_power + after.wall_power);
        self.drive_work += half * (before.drive_power + after.drive_power);
        self.keep_work += half * (before.keep_power + after.keep_power);
        self.gross_work += half * (before.input_power().abs() + after.input_power().abs());
        self.normal_dissipated += half * (before.normal_dissipation + after.normal_dissipation);
        self.drag_dissipated += half * (before.drag_dissipation + after.drag_dissipation);
        self.network_dissipated += half * (before.network_dissipation + after.network_dissipation);
        self.tangential_dissipated += after.tangential_lost;
        self.sliding_dissipated += after.sliding_lost;
        self.rolling_dissipated += after.rolling_lost;
        self.cohesion_dissipated += after.cohesion_lost;
        self.history_reset += after.history_reset;
        self.largest_overlap = self.largest_overlap.max(after.largest_overlap);
    }

    /// Adds the work of a prescribed wall that jumped.
    pub(crate) fn add_jump(&mut self, work: f64) {
        self.wall_work += work;
        self.gross_work += work.abs();
    }

    /// Work of wall and drive.
    pub fn input(&self) -> f64 {
        self.wall_work + self.drive_work + self.keep_work
    }

    /// Energy that was lost.
    pub fn dissipated(&self) -> f64 {
        self.normal_dissipated
            + self.tangential_dissipated
            + self.sliding_dissipated
            + self.rolling_dissipated
            + self.cohesion_dissipated
            + self.drag_dissipated
            + self.network_dissipated
            + self.history_reset
    }

    /// Energy that the ledger cannot account for, for kinetic plus potential energy `energy` now.
    pub fn residual(&self, energy: f64) -> f64 {
        energy - self.initial_energy - self.input() - self.body_work - self.exchanged
            + self.dissipated()
    }

    /// |residual| over the sum of the integral of |power of wall and drive| and of the size of the body force's work, of which
    /// what it gave and took cancels; over the initial energy where next to nothing entered; 0 where nothing is missing.
    pub fn relative_residual(&self, energy: f64) -> f64 {
        let residual = self.residual(energy).abs();
        let entered = self.gross_work + self.body_work.abs();
        if residual == 0.0 {
            0.0
        } else if entered > LEAST_WORK * self.initial_energy {
            residual / entered
        } else {
            residual / self.initial_energy
        }
    }
}
