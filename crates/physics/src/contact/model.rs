//! The contact model of a simulation: which laws, with which parameters.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Cohesion, CundallStrack, Elasticity, Impact, LinearSpringDashpot, NormalForce, NormalLaw,
    RollingResistance, ViscoelasticHertz,
};
use crate::real::Real;

/// Normal contact law. It takes the keys that name it; friction goes with every law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "snake_case")]
pub enum Normal {
    /// Linear spring and dashpot.
    Linear(LinearSpringDashpot),
    /// Hertz spring with viscoelastic damping.
    Hertz(ViscoelasticHertz),
}

/// Evaluates an expression with the law that a [`Normal`] holds, whose type the compiler then knows:
/// `with_normal_law!(normal, law => expression)`. The only place that lists the normal laws again.
#[macro_export]
macro_rules! with_normal_law {
    ($normal:expr, $law:ident => $answer:expr) => {
        match $normal {
            $crate::contact::Normal::Linear($law) => $answer,
            $crate::contact::Normal::Hertz($law) => $answer,
        }
    };
}

impl NormalLaw for Normal {
    #[inline(always)]
    fn force<R: Real>(&self, overlap: R, normal_velocity: R, reduced_radius: R) -> NormalForce<R> {
        with_normal_law!(self, law => law.force(overlap, normal_velocity, reduced_radius))
    }

    fn damping(&self) -> (&'static str, f64) {
        with_normal_law!(self, law => law.damping())
    }

    fn undamped(&self) -> Self {
        with_normal_law!(self, law => law.undamped().into())
    }

    fn stiffness(&self, overlap: f64, reduced_radius: f64) -> f64 {
        with_normal_law!(self, law => law.stiffness(overlap, reduced_radius))
    }

    fn elasticity(&self) -> Elasticity {
        with_normal_law!(self, law => law.elasticity())
    }

    fn impact_overlap(&self, impact: Impact) -> f64 {
        with_normal_law!(self, law => law.impact_overlap(impact))
    }

    fn impact_restitution(&self, impact: Impact) -> f64 {
        with_normal_law!(self, law => law.impact_restitution(impact))
    }

    fn with_restitution(&self, restitution: f64, impact: Impact) -> Self {
        with_normal_law!(self, law => law.with_restitution(restitution, impact).into())
    }
}

impl From<LinearSpringDashpot> for Normal {
    fn from(law: LinearSpringDashpot) -> Self {
        Self::Linear(law)
    }
}

impl From<ViscoelasticHertz> for Normal {
    fn from(law: ViscoelasticHertz) -> Self {
        Self::Hertz(law)
    }
}

/// The contact model of a simulation: which laws, with which parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactModel {
    /// Force along the line of centres.
    #[serde(flatten)]
    pub normal: Normal,
    /// Force in the plane of contact; `None`: grains are frictionless and do not rotate.
    #[serde(flatten)]
    pub friction: Option<CundallStrack>,
    /// Couple that resists rolling; `None`: grains roll freely.
    #[serde(flatten)]
    pub rolling: Option<RollingResistance>,
    /// Attraction; `None`: grains only repel.
    #[serde(flatten)]
    pub cohesion: Option<Cohesion>,
}

impl ContactModel {
    /// A normal law, with friction or without, and nothing else.
    pub const fn new(normal: Normal, friction: Option<CundallStrack>) -> Self {
        Self {
            normal,
            friction,
            rolling: None,
            cohesion: None,
        }
    }

    /// Whether it has more than friction beside the normal law: the reference kernel alone computes it.
    pub const fn is_general(&self) -> bool {
        self.rolling.is_some() || self.cohesion.is_some()
    }
}
