//! The contacts of a simulation: listed pairs, and the histories that their law needs.

use peristalsis_physics::contact::{
    Contact, ContactLaw, ContactModel, CundallStrack, General, GeneralHistory, NormalLaw,
    TangentialHistory, TangentialLaw,
};

use crate::bodies::Bodies;
use crate::error::EngineError;
use crate::fast::threads::Threads;
use crate::neighbours::{Neighbours, PairRule, periodic};
use crate::wall::Wall;
use crate::wall::memory::WallMemory;

/// Histories of contacts between moving spheres, (sphere i, sphere j, history), i < j, and of contacts with a prescribed wall,
/// (grain, wall sphere, history), in order of the grains.
pub type Remembered<H> = [Vec<(u32, u32, H)>; 2];

/// Histories of contacts, between moving spheres and with a prescribed wall.
#[derive(Clone, Debug)]
pub(crate) struct Contacts<H> {
    pub(crate) pairs: Neighbours<H>,
    pub(crate) wall: WallMemory<H>,
    /// Largest gap at which spheres cohere \[d\].
    range: f64,
}

impl<H: Copy + Default + PartialEq + Sync> Contacts<H> {
    pub(crate) fn none() -> Self {
        Self {
            pairs: Neighbours::empty(),
            wall: WallMemory::default(),
            range: 0.0,
        }
    }

    /// All histories but fresh ones: of pairs, in their order, and of contacts with a prescribed wall.
    pub(crate) fn remembered(&self) -> Remembered<H> {
        let of_wall = self.wall.iter();
        let of_wall = of_wall.map(|(i, j, history)| (i, j, *history));
        [self.pairs.remembered().collect(), of_wall.collect()]
    }

    /// Takes histories up; the neighbour list holds their pairs.
    pub(crate) fn remember(
        &mut self,
        grains: usize,
        [pairs, of_wall]: &Remembered<H>,
    ) -> Result<(), EngineError> {
        for &(i, j, history) in pairs {
            if !self.pairs.set_history(i, j, history) {
                let reason =
                    format!("it remembers a contact of spheres {i} and {j}, which are far apart");
                return Err(EngineError::SnapshotMismatch { reason });
            }
        }
        self.wall = WallMemory::from_entries(grains, of_wall);
        Ok(())
    }

    /// Whether the neighbour list holds all pairs that may have a contact as the spheres are now.
    pub(crate) fn are_listed(&self, bodies: &Bodies, wall: &Wall) -> bool {
        let (position, turns) = (&bodies.position, &bodies.turns);
        self.pairs.holds(position, turns, wall.length(), self.range)
    }

    /// Makes the neighbour list anew where it no longer holds.
    pub(crate) fn refresh(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        if !self.are_listed(bodies, wall) {
            self.rebuild(bodies, wall, [0.5 * skin; 2], &Threads::default());
        }
    }

    /// Makes the neighbour list anew; to the skin of a pair a grain and a sphere of the wall contribute `skins`.
    pub(crate) fn rebuild(
        &mut self,
        bodies: &Bodies,
        wall: &Wall,
        skins: [f64; 2],
        threads: &Threads,
    ) {
        self.pairs.carry_out();
        self.rebuild_fresh(bodies, wall, skins, threads);
        self.pairs.carry_on();
    }

    /// The same while others keep the histories, and all here are fresh.
    pub(crate) fn rebuild_fresh(
        &mut self,
        bodies: &Bodies,
        wall: &Wall,
        skins: [f64; 2],
        threads: &Threads,
    ) {
        let grains = bodies.grains;
        let rule = PairRule {
            diameter: &bodies.diameter,
            length: wall.length(),
            skins: skins.map(|skin| skin + 0.5 * self.range),
            half_width: wall.usual_radius(),
            grains,
            admits: |i: usize, j: usize| wall.may_touch(i - grains, j - grains),
        };
        self.pairs
            .rebuild(&bodies.position, &bodies.turns, &rule, threads);
    }
}

/// A squared distance beyond reach by more than this part of it is so whatever the rounding.
const ROUNDING: f64 = 1e-9;

impl<H> Contacts<H> {
    /// Calls `visit` for each listed pair i < j of sphere i, from j = `first` on, whose contact acts: j, the contact, and its
    /// history.
    pub(crate) fn for_each_acting<N: NormalLaw, T: TangentialLaw<History<f64> = H>>(
        &self,
        law: &ContactLaw<N, T>,
        bodies: &Bodies,
        length: f64,
        i: usize,
        first: usize,
        mut visit: impl FnMut(usize, &Contact, &H),
    ) where
        H: Copy + Default + PartialEq,
    {
        let here = bodies.sphere(i);
        for (&j, history) in self.pairs.pairs_of(i, first) {
            let j = j as usize;
            let separation = periodic(here.position - bodies.position[j], length);
            let reach = 0.5 * (here.diameter + bodies.diameter[j]) + self.range;
            // Most are out of reach.
            let is_far = separation.length_squared() > (1.0 + ROUNDING) * (reach * reach);
            if is_far {
                continue;
            }
            let contact = here.contact(&bodies.sphere(j), separation);
            if law.acts(&contact, history) {
                visit(j, &contact, history);
            }
        }
    }
}

/// A law in the plane of contact together with the histories of its contacts, so that they cannot disagree.
#[derive(Clone, Debug)]
pub(crate) enum Memory {
    Smooth(Contacts<()>),
    Frictional(CundallStrack, Contacts<TangentialHistory>),
    General(General, Contacts<GeneralHistory>),
}

impl Memory {
    /// Memory without contacts, for spheres whose largest diameter is `diameter`.
    pub(crate) fn of(model: &ContactModel, diameter: f64) -> Self {
        if let Some(tangential) = General::of(model) {
            let normal = model.normal;
            let range = ContactLaw { normal, tangential }.range(diameter);
            let contacts = Contacts {
                range,
                ..Contacts::none()
            };
            return Self::General(tangential, contacts);
        }
        match model.friction {
            None => Self::Smooth(Contacts::none()),
            Some(law) => Self::Frictional(law, Contacts::none()),
        }
    }

    /// Makes the neighbour list anew where it no longer holds.
    pub(crate) fn refresh(&mut self, bodies: &Bodies, wall: &Wall, skin: f64) {
        match self {
            Self::Smooth(contacts) => contacts.refresh(bodies, wall, skin),
            Self::Frictional(_, contacts) => contacts.refresh(bodies, wall, skin),
            Self::General(_, contacts) => contacts.refresh(bodies, wall, skin),
        }
    }
}

/// Evaluates an expression with the contact law and its contacts, whose types the compiler then knows:
/// `with_contact_law!(normal, memory, |law, contacts| expression)`; of two expressions the first is for a general law.
macro_rules! with_contact_law {
    ($normal:expr, $memory:expr, |$law:ident, $contacts:ident| $answer:expr) => {
        $crate::contacts::with_contact_law!($normal, $memory, |$law, $contacts| $answer, $answer)
    };
    ($normal:expr, $memory:expr, |$law:ident, $contacts:ident| $general:expr, $answer:expr) => {
        peristalsis_physics::with_normal_law!($normal, normal => match $memory {
            $crate::contacts::Memory::General(tangential, $contacts) => {
                let tangential = *tangential;
                let $law = &peristalsis_physics::contact::ContactLaw { normal, tangential };
                $general
            }
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
