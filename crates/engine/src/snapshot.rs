//! The whole state of a simulation at one step.

use peristalsis_physics::contact::{GeneralHistory, TangentialHistory};

use crate::bodies::Bodies;
use crate::contacts::Remembered;
use crate::ends::Ends;
use crate::error::EngineError;
use crate::fast::sorted::Sorted;
pub use crate::fast::sorted::Sorting;
use crate::integrate::Past;
use crate::ledger::{Ledger, Tally};
use crate::parameters::Parameters;
use crate::wall::Wall;

/// The state for a restart: spheres, the integrator's past, histories of contacts, the ledger.
///
/// Wall and parameters belong to the configuration and are given again on restart. The neighbour list is not part of the
/// state, for no result depends on it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Snapshot {
    /// Steps done.
    pub step: u64,
    /// The spheres.
    pub bodies: Bodies,
    /// Velocities and accelerations of the step before.
    pub past: Past,
    /// Sums over the contacts at the last step.
    pub tally: Tally,
    /// Energies accumulated.
    pub ledger: Ledger,
    /// (sphere i, sphere j, history) of contacts between moving spheres, i < j.
    pub pair_histories: Vec<(u32, u32, TangentialHistory)>,
    /// (grain, wall sphere, history) of contacts with a prescribed wall, in order of the grains.
    pub wall_histories: Vec<(u32, u32, TangentialHistory)>,
    /// Histories of both kinds of contacts, where there is rolling resistance or cohesion.
    pub general_histories: Remembered<GeneralHistory>,
    /// The order of the grains along the tube, where the kernel keeps one.
    pub sorting: Option<Sorting>,
    /// The ends of an open tube.
    pub ends: Option<Ends>,
}

/// A [`Snapshot`] of a simulation that still holds it all: written down, it gives the same bytes, without a copy.
#[derive(Clone, Debug, serde::Serialize)]
pub struct SnapshotView<'a> {
    pub(crate) step: u64,
    pub(crate) bodies: &'a Bodies,
    pub(crate) past: &'a Past,
    pub(crate) tally: &'a Tally,
    pub(crate) ledger: &'a Ledger,
    pub(crate) pair_histories: Vec<(u32, u32, TangentialHistory)>,
    pub(crate) wall_histories: Vec<(u32, u32, TangentialHistory)>,
    pub(crate) general_histories: Remembered<GeneralHistory>,
    pub(crate) sorting: Option<Sorting>,
    pub(crate) ends: Option<&'a Ends>,
}

impl SnapshotView<'_> {
    /// A copy that does not borrow from the simulation.
    pub fn into_owned(self) -> Snapshot {
        Snapshot {
            step: self.step,
            bodies: self.bodies.clone(),
            past: self.past.clone(),
            tally: *self.tally,
            ledger: *self.ledger,
            pair_histories: self.pair_histories,
            wall_histories: self.wall_histories,
            general_histories: self.general_histories,
            sorting: self.sorting,
            ends: self.ends.cloned(),
        }
    }
}

impl Snapshot {
    /// Whether the snapshot can belong to a simulation with this wall and these parameters.
    pub(crate) fn check(&self, wall: &Wall, parameters: &Parameters) -> Result<(), EngineError> {
        let mismatch = |reason: String| Err(EngineError::SnapshotMismatch { reason });
        let bodies = &self.bodies;
        let number = bodies.number();
        let lengths = [
            bodies.turns.len(),
            bodies.velocity.len(),
            bodies.acceleration.len(),
            bodies.angular_velocity.len(),
            bodies.angular_acceleration.len(),
            bodies.diameter.len(),
            bodies.mass.len(),
            bodies.inertia.len(),
        ];
        if lengths.iter().any(|&length| length != number) || bodies.grains > number {
            return mismatch("its arrays differ in length".to_owned());
        }
        let wall_spheres = wall.mobile_spheres();
        if number - bodies.grains != wall_spheres {
            return mismatch(format!(
                "it holds {} wall spheres, the wall has {wall_spheres}",
                number - bodies.grains
            ));
        }
        let finite = bodies
            .position
            .iter()
            .chain(&bodies.velocity)
            .chain(&bodies.angular_velocity)
            .all(|vector| vector.is_finite());
        if !finite {
            return mismatch("it holds positions or velocities that are not finite".to_owned());
        }
        let ends = self.ends.as_ref();
        if ends.is_some_and(|ends| wall_spheres > 0 || !ends.fits(bodies.grains)) {
            return mismatch("its open ends are those of another tube".to_owned());
        }
        let past = &self.past;
        if [
            &past.velocity,
            &past.acceleration,
            &past.angular_velocity,
            &past.angular_acceleration,
        ]
        .iter()
        .any(|vector| !vector.is_empty() && vector.len() != number)
        {
            return mismatch("the integrator's past differs in length".to_owned());
        }
        let Self {
            pair_histories,
            wall_histories,
            general_histories,
            ..
        } = self;
        let springs = pair_histories.len() + wall_histories.len();
        let general: usize = general_histories.iter().map(Vec::len).sum();
        let is_general = parameters.contact.is_general();
        let is_frictional = parameters.contact.friction.is_some() && !is_general;
        if (springs > 0 && !is_frictional) || (general > 0 && !is_general) {
            return mismatch(
                "it remembers contacts of another law than the grains have".to_owned(),
            );
        }
        let known = check_histories(bodies, pair_histories, wall_histories)
            && check_histories(bodies, &general_histories[0], &general_histories[1]);
        if !known {
            return mismatch("it remembers contacts of spheres that do not exist".to_owned());
        }
        if let Some(sorting) = &self.sorting
            && wall.mobile_spheres() == 0
        {
            let strips = Sorted::strips(bodies, wall, parameters.skin);
            sorting
                .check(bodies.grains, strips, wall.length())
                .or_else(mismatch)?;
        }
        Ok(())
    }
}

/// Whether contacts are of spheres that exist, in their order.
fn check_histories<H>(bodies: &Bodies, pairs: &[(u32, u32, H)], wall: &[(u32, u32, H)]) -> bool {
    let known = |i: u32| (i as usize) < bodies.number();
    pairs.iter().all(|&(i, j, _)| i < j && known(j))
        && wall.windows(2).all(|pair| pair[0].0 <= pair[1].0)
        && wall
            .iter()
            .all(|&(grain, _, _)| (grain as usize) < bodies.grains)
}
