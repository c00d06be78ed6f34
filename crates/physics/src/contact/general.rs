//! All that a contact may have beside its normal law: friction, rolling resistance and cohesion.

use serde::{Deserialize, Serialize};

use super::rolling::{RollingCouple, RollingResistance};
use super::{
    Cohesion, Contact, ContactModel, CundallStrack, NormalForce, NormalLaw, TangentialForce,
    TangentialHistory, TangentialLaw,
};
use crate::real::Real;

/// Friction, rolling resistance and cohesion, each where there is any: for the reference kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct General {
    /// Force in the plane of contact.
    pub friction: Option<CundallStrack>,
    /// Couple that resists rolling.
    pub rolling: Option<RollingResistance>,
    /// Attraction.
    pub cohesion: Option<Cohesion>,
}

/// Memory of a contact with all that it may have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "R: Serialize, TangentialHistory<R>: Serialize",
    deserialize = "R: Deserialize<'de>, TangentialHistory<R>: Deserialize<'de>"
))]
pub struct GeneralHistory<R: Real = f64> {
    /// History of friction.
    pub friction: TangentialHistory<R>,
    /// History of rolling resistance.
    pub rolling: TangentialHistory<R>,
    /// Energy that is lost when the contact breaks, above 0 where it lasts beyond touch \[m d^2/t^2\].
    pub bond: R,
}

impl General {
    /// The law of a model with rolling resistance or cohesion; `None` for a model with neither.
    pub fn of(model: &ContactModel) -> Option<Self> {
        let ContactModel {
            friction,
            rolling,
            cohesion,
            ..
        } = *model;
        model.is_general().then_some(Self {
            friction,
            rolling,
            cohesion,
        })
    }
}

impl TangentialLaw for General {
    type History<R: Real> = GeneralHistory<R>;
    const ROTATES: bool = true;
    const IS_GENERAL: bool = true;

    fn force<R: Real>(
        &self,
        contact: &Contact<R>,
        normal_force: R,
        history: &mut GeneralHistory<R>,
        time_step: f64,
    ) -> TangentialForce<R> {
        let history = &mut history.friction;
        let force = |law: CundallStrack| law.force(contact, normal_force, history, time_step);
        self.friction.map(force).unwrap_or_default()
    }

    fn stored_energy<R: Real>(&self, history: &GeneralHistory<R>) -> R {
        let none = R::splat(0.0);
        let friction = self
            .friction
            .map_or(none, |law| law.stored_energy(&history.friction));
        let rolling = self
            .rolling
            .map_or(none, |law| law.stored_energy(&history.rolling));
        friction + rolling
    }

    fn normal_force<R: Real>(
        &self,
        normal: &impl NormalLaw,
        contact: &Contact<R>,
        history: &mut GeneralHistory<R>,
    ) -> (NormalForce<R>, R) {
        match self.cohesion {
            None => contact.normal_force(normal),
            Some(cohesion) => {
                history.bond = cohesion.bond(normal, contact.reduced_radius);
                cohesion.force(normal, contact)
            }
        }
    }

    fn couple<R: Real>(
        &self,
        contact: &Contact<R>,
        normal_force: R,
        history: &mut GeneralHistory<R>,
        time_step: f64,
    ) -> RollingCouple<R> {
        let history = &mut history.rolling;
        let couple = |law: RollingResistance| law.couple(contact, normal_force, history, time_step);
        self.rolling.map(couple).unwrap_or_default()
    }

    fn slid(&self, history: &GeneralHistory) -> bool {
        self.friction.is_some() && history.friction.sliding
    }

    fn bond(&self, history: &GeneralHistory) -> f64 {
        history.bond
    }

    fn range(
        &self,
        normal: &impl NormalLaw,
        reduced_radius: f64,
        history: Option<&GeneralHistory>,
    ) -> f64 {
        match self.cohesion {
            Some(cohesion) if !cohesion.is_jkr() || history.is_none_or(|it| it.bond > 0.0) => {
                cohesion.range(normal, reduced_radius)
            }
            _ => 0.0,
        }
    }
}
