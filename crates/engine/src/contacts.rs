//! The contacts of a simulation: listed pairs, and the histories that their law needs.

use peristalsis_physics::contact::{CundallStrack, TangentialHistory};

use crate::bodies::Bodies;
use crate::fast::threads::Threads;
use crate::neighbours::{Neighbours, PairRule};
use crate::wall::Wall;
use crate::wall::memory::WallMemory;

/// Histories of contacts, between moving spheres and with a prescribed wall.
#[derive(Clone, Debug)]
pub(crate) struct Contacts<H> {
    pub(crate) pairs: Neighbours<H>,
    pub(crate) wall: WallMemory<H>,
}

impl<H: Copy + Default + PartialEq + Sync> Contacts<H> {
    pub(crate) fn none() -> Self {
        Self {
            pairs: Neighbours::empty(),
            wall: WallMemory::default(),
        }
    }

    /// Makes the neighbour list anew where it no longer holds.
    pub(crate) fn refresh(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        let length = wall.length();
        if self
            .pairs
            .outdated(&bodies.position, &bodies.turns, length, skin)
        {
            self.rebuild(bodies, wall, skin, &Threads::default());
        }
    }

    /// Makes the neighbour list anew.
    pub(crate) fn rebuild(&mut self, bodies: &Bodies, wall: &Wall, skin: f64, threads: &Threads) {
        let grains = bodies.grains;
        let rule = PairRule {
            diameter: &bodies.diameter,
            length: wall.length(),
            skin,
            half_width: wall.usual_radius(),
            admits_all_below: grains,
            admits: |i: usize, j: usize| wall.may_touch(i - grains, j - grains),
        };
        self.pairs
            .rebuild(&bodies.position, &bodies.turns, &rule, threads);
    }
}

/// A law in the plane of contact together with the histories of its contacts, so that they cannot disagree.
#[derive(Clone, Debug)]
pub(crate) enum Memory {
    Smooth(Contacts<()>),
    Frictional(CundallStrack, Contacts<TangentialHistory>),
}

impl Memory {
    /// Memory without contacts, for this law in the plane of contact.
    pub(crate) fn of(friction: Option<CundallStrack>) -> Self {
        match friction {
            None => Self::Smooth(Contacts::none()),
            Some(law) => Self::Frictional(law, Contacts::none()),
        }
    }

    /// Makes the neighbour list anew where it no longer holds.
    pub(crate) fn refresh(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        match self {
            Self::Smooth(contacts) => contacts.refresh(bodies, wall, skin),
            Self::Frictional(_, contacts) => contacts.refresh(bodies, wall, skin),
        }
    }
}

/// Evaluates an expression with the contact law and its contacts, whose types the compiler then knows:
/// `with_contact_law!(normal, memory, |law, contacts| expression)`.
macro_rules! with_contact_law {
    ($normal:expr, $memory:expr, |$law:ident, $contacts:ident| $answer:expr) => {
        peristalsis_physics::with_normal_law!($normal, normal => match $memory {
            $crate::contacts::Memory::Smooth($contacts) => {
                let tangential = peristalsis_physics::contact::Frictionless;
                let $law = &peristalsis_physics::contact::ContactLaw { normal, tangential };
                $answer
            }
            $crate::contacts::Memory::Frictional(tangential, $contacts) => {
                let tangential = *tangential;
                let $law = &peristalsis_physics::contact::ContactLaw { normal, tangential };
                $answer
            }
        })
    };
}
pub(crate) use with_contact_law;
