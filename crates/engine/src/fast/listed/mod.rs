//! The fast kernel for everything that has a neighbour list: rotating grains, elastic walls, wide tubes.

use peristalsis_physics::contact::{ContactLaw, NormalLaw, TangentialLaw};

use crate::bodies::Bodies;
use crate::forces::Contacts;
use crate::ledger::Tally;
use crate::wall::Wall;

/// Room to work in, kept from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {}

/// Evaluates all accelerations, as [`crate::forces::evaluate`] does.
pub(crate) fn evaluate<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &mut Bodies,
    wall: &Wall,
    contacts: &mut Contacts<T::History<f64>>,
    _scratch: &mut Scratch,
    time_step: f64,
) -> Tally {
    crate::forces::evaluate(law, bodies, wall, contacts, time_step)
}
