//! Contact mechanics: the force that two touching spheres exert on each other.
//!
//! A contact law is a pair: a [`NormalLaw`] (one file each: [`linear`], [`hertz`]) and a [`TangentialLaw`]
//! ([`tangential`]; [`general`] with [`rolling`] resistance and [`cohesion`]). Both are structs of parameters without
//! state. The memory of a contact is the [`TangentialLaw::History`] of the law that needs it, so that law and history
//! cannot disagree. [`ContactLaw::force`] alone puts the two together; every kernel calls it.

pub mod cohesion;
pub mod general;
pub mod hertz;
pub mod linear;
pub mod model;
pub mod rolling;
pub mod tangential;

use serde::Serialize;

use crate::real::{Real, Vector};

pub use cohesion::{Cohesion, PullOff};
pub use general::{General, GeneralHistory};
pub use hertz::{DissipationForm, ViscoelasticHertz};
pub use linear::LinearSpringDashpot;
pub use model::{ContactModel, Normal};
pub use rolling::{RollingCouple, RollingResistance};
pub use tangential::{CundallStrack, Frictionless, Sliding, TangentialHistory};

/// Two touching spheres i ("this") and j ("the partner"), as a contact law sees them.
///
/// Lengths in d, velocities in d/t; `normal` points from the partner to this sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<R: Real = f64> {
    /// xi = (d_i + d_j)/2 - |r_i - r_j|, positive unless the spheres cohere.
    pub overlap: R,
    /// |r_i - r_j|.
    pub distance: R,
    /// n = (r_i - r_j)/|r_i - r_j|.
    pub normal: R::Vector,
    /// v_i - v_j of the centres.
    pub relative_velocity: R::Vector,
    /// R_ij = d_i d_j/(2 (d_i + d_j)).
    pub reduced_radius: R,
    /// l_i omega_i + l_j omega_j with the lever arms l = (d - xi)/2; zero where nothing rotates. n x this is what
    /// rotation adds to the relative velocity of the surfaces.
    pub rotation: R::Vector,
    /// omega_i - omega_j, which rolling resistance alone looks at \[1/t\].
    pub spin: R::Vector,
}

/// R_ij = d_i d_j/(2 (d_i + d_j)) \[d\], the reduced radius of two spheres.
#[inline(always)]
pub fn reduced_radius<R: Real>(diameter: R, other: R) -> R {
    diameter * other / (R::splat(2.0) * (diameter + other))
}

impl<R: Real> Contact<R> {
    /// The contact of spheres of diameters d_i and d_j at r_i - r_j = `separation`, v_i - v_j = `relative_velocity`.
    /// Neither sphere rotates.
    #[inline(always)]
    pub fn new(
        (diameter, other): (R, R),
        separation: R::Vector,
        relative_velocity: R::Vector,
    ) -> Self {
        let distance = separation.dot(separation).sqrt();
        Self {
            overlap: R::splat(0.5) * (diameter + other) - distance,
            distance,
            normal: separation * (R::splat(1.0) / distance),
            relative_velocity,
            reduced_radius: reduced_radius(diameter, other),
            rotation: R::Vector::default(),
            spin: R::Vector::default(),
        }
    }

    /// l = (d - xi)/2 \[d\]: the lever arm of a sphere of diameter `diameter`, from its centre to the plane of contact.
    #[inline(always)]
    pub fn arm(&self, diameter: R) -> R {
        R::splat(0.5) * (diameter - self.overlap)
    }

    /// The same contact with l_i omega_i + l_j omega_j = `rotation` and omega_i - omega_j = `spin`.
    #[inline(always)]
    #[must_use]
    pub fn rotating(self, rotation: R::Vector, spin: R::Vector) -> Self {
        Self {
            rotation,
            spin,
            ..self
        }
    }

    /// v_n = (v_i - v_j) . n, positive when parting.
    #[inline(always)]
    pub fn normal_velocity(&self) -> R {
        self.relative_velocity.dot(self.normal)
    }

    /// The part of v_i - v_j in the plane of contact.
    #[inline(always)]
    pub(crate) fn lateral_velocity(&self) -> R::Vector {
        self.relative_velocity - self.normal * self.normal_velocity()
    }

    /// The response of the normal law, and max(f_n, 0), which bounds friction.
    #[inline(always)]
    fn normal_force(&self, law: &impl NormalLaw) -> (NormalForce<R>, R) {
        let force = law.force(self.overlap, self.normal_velocity(), self.reduced_radius);
        (force, force.force.positive_part())
    }
}

/// The response of a normal law to a contact. Forces in m d/t^2, the energy in m d^2/t^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalForce<R: Real = f64> {
    /// f_n, the force on this sphere along n; positive repels.
    pub force: R,
    /// The part of f_n that derives from `energy`.
    pub elastic_force: R,
    /// Stored elastic energy of the contact.
    pub energy: R,
}

/// The response of a tangential law to a contact. The force in m d/t^2, energies in m d^2/t^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TangentialForce<R: Real = f64> {
    /// f_t on this sphere, perpendicular to n.
    pub force: R::Vector,
    /// Elastic energy stored in the tangential spring, k_t u^2/2.
    pub energy: R,
    /// Energy lost in this step to tangential damping.
    pub damped: R,
    /// Energy lost in this step to sliding.
    pub slid: R,
    /// Whether the contact slides.
    pub sliding: R::Mask,
}

/// A force along the line of centres.
pub trait NormalLaw: Copy + Sync {
    /// Force at overlap xi > 0, normal velocity v_n (positive when parting) and reduced radius R_ij.
    fn force<R: Real>(&self, overlap: R, normal_velocity: R, reduced_radius: R) -> NormalForce<R>;

    /// The key of its damping in a configuration, with its value: what [`NormalLaw::with_restitution`] sets.
    fn damping(&self) -> (&'static str, f64);

    /// The same law without dissipation.
    #[must_use]
    fn undamped(&self) -> Self;

    /// Slope d f_n/d xi of the elastic force at overlap xi and reduced radius R_ij: what limits the time step.
    fn stiffness(&self, overlap: f64, reduced_radius: f64) -> f64;

    /// The parameter that scales the elastic force.
    fn elasticity(&self) -> Elasticity;

    /// Largest overlap of an impact along the normal, without dissipation \[d\].
    fn impact_overlap(&self, impact: Impact) -> f64;

    /// Restitution e of an impact along the normal: the speed of parting over that of meeting.
    fn impact_restitution(&self, impact: Impact) -> f64;

    /// The same law with the damping that makes an impact end with the restitution e, 0 < e <= 1.
    #[must_use]
    fn with_restitution(&self, restitution: f64, impact: Impact) -> Self;
}

/// An impact of two spheres along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// m_ij = m_i m_j/(m_i + m_j) \[m\].
    pub reduced_mass: f64,
    /// R_ij \[d\], see [`reduced_radius`].
    pub reduced_radius: f64,
    /// Relative speed at first touch v \[d/t\].
    pub speed: f64,
}

impl Impact {
    /// Two grains of diameter `diameter` \[d\] and mass `diameter`^3 \[m\], meeting at `speed` \[d/t\].
    pub fn of_twins(diameter: f64, speed: f64) -> Self {
        Self {
            reduced_mass: 0.5 * diameter * diameter * diameter,
            reduced_radius: reduced_radius(diameter, diameter),
            speed,
        }
    }
}

/// The parameter that scales the elastic force of a normal law: the units of time and pressure follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Elasticity {
    /// Force over overlap \[m t^-2\].
    Stiffness(f64),
    /// Young's modulus \[m d^-1 t^-2\].
    YoungModulus(f64),
}

impl Elasticity {
    /// Its value, whichever it is.
    pub fn value(self) -> f64 {
        match self {
            Self::Stiffness(value) | Self::YoungModulus(value) => value,
        }
    }
}

/// A force in the plane of contact, and what else a contact has beside its normal law.
pub trait TangentialLaw: Copy + Sync {
    /// The memory of a contact from one step to the next.
    type History<R: Real>: Copy + Default + PartialEq + core::fmt::Debug + Send + Sync;

    /// Whether this law turns grains: `false` lets a kernel skip everything about rotation.
    const ROTATES: bool;

    /// Whether it has a couple or a range: `false` lets a kernel skip both.
    const IS_GENERAL: bool = false;

    /// Force after a step of length `time_step` that led to `contact`, for normal force `normal_force`; brings
    /// `history` from the step's beginning to its end. A `time_step` of zero evaluates without moving the history.
    fn force<R: Real>(
        &self,
        contact: &Contact<R>,
        normal_force: R,
        history: &mut Self::History<R>,
        time_step: f64,
    ) -> TangentialForce<R>;

    /// Energy held by the springs of a history: it is lost when the contact ends.
    fn stored_energy<R: Real>(&self, history: &Self::History<R>) -> R;

    /// The force of the normal law with what coheres, and the force that bounds friction, never negative.
    #[inline(always)]
    fn normal_force<R: Real>(
        &self,
        normal: &impl NormalLaw,
        contact: &Contact<R>,
        _history: &mut Self::History<R>,
    ) -> (NormalForce<R>, R) {
        contact.normal_force(normal)
    }

    /// Couple that resists rolling, bounded as friction is; moves `history` on as [`TangentialLaw::force`] does.
    #[inline(always)]
    fn couple<R: Real>(
        &self,
        _contact: &Contact<R>,
        _normal_force: R,
        _history: &mut Self::History<R>,
        _time_step: f64,
    ) -> RollingCouple<R> {
        RollingCouple::default()
    }

    /// Whether friction slid at the end of the last step; `false` where the contact had no normal force.
    fn slid(&self, _history: &Self::History<f64>) -> bool {
        false
    }

    /// Energy of cohesion that is lost when the contact ends.
    #[inline(always)]
    fn bond(&self, _history: &Self::History<f64>) -> f64 {
        0.0
    }

    /// Gap between surfaces up to which a contact with this history acts; without one, the largest there may be \[d\].
    fn range(
        &self,
        _normal: &impl NormalLaw,
        _reduced_radius: f64,
        _history: Option<&Self::History<f64>>,
    ) -> f64 {
        0.0
    }
}

/// A normal and a tangential law together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw<N, T> {
    /// Force along the line of centres.
    pub normal: N,
    /// Force in the plane of contact.
    pub tangential: T,
}

/// The response of a contact law. Forces in m d/t^2, energies in m d^2/t^2, powers in m d^2/t^3.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce<R: Real = f64> {
    /// Force on this sphere; the partner feels the opposite.
    pub force: R::Vector,
    /// -n x f_t: times the lever arm l_i it is the torque on this sphere, times l_j the torque on the partner.
    pub torque_per_arm: R::Vector,
    /// Energy of cohesion and of normal, tangential and rolling springs.
    pub energy: R,
    /// Rate of energy loss along the normal, (f_elastic - f_n) v_n.
    pub normal_dissipation: R,
    /// Rolling resistance: a couple besides the torque, and the energy that it takes in this step.
    pub rolling: RollingCouple<R>,
    /// Tangential part, with its losses of this step.
    pub tangential: TangentialForce<R>,
}

impl<N: NormalLaw, T: TangentialLaw> ContactLaw<N, T> {
    /// The same normal law without friction.
    #[inline(always)]
    pub fn frictionless(&self) -> ContactLaw<N, Frictionless> {
        ContactLaw {
            normal: self.normal,
            tangential: Frictionless,
        }
    }

    /// Force of one contact.
    ///
    /// f = f_n n + f_t. The tangential law sees max(f_n, 0): a contact that pulls (possible with the unclipped linear
    /// law) has no friction, unless it coheres: see [`Cohesion`].
    #[inline(always)]
    pub fn force<R: Real>(
        &self,
        contact: &Contact<R>,
        history: &mut T::History<R>,
        time_step: f64,
    ) -> ContactForce<R> {
        let (normal, pressing) = self.tangential.normal_force(&self.normal, contact, history);
        let normal_dissipation = (normal.elastic_force - normal.force) * contact.normal_velocity();
        if T::ROTATES {
            let tangential = self.tangential.force(contact, pressing, history, time_step);
            let mut answer = ContactForce {
                force: contact.normal * normal.force + tangential.force,
                torque_per_arm: -contact.normal.cross(tangential.force),
                energy: normal.energy + tangential.energy,
                normal_dissipation,
                rolling: RollingCouple::default(),
                tangential,
            };
            if T::IS_GENERAL {
                answer.rolling = self
                    .tangential
                    .couple(contact, pressing, history, time_step);
                answer.energy = answer.energy + answer.rolling.energy;
            }
            answer
        } else {
            ContactForce {
                force: contact.normal * normal.force,
                energy: normal.energy,
                normal_dissipation,
                ..ContactForce::default()
            }
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> ContactLaw<N, T> {
    /// Largest gap at which a sphere of diameter `diameter` may cohere with another, or with a wall that is not bent
    /// as much as it \[d\].
    #[inline(always)]
    pub fn range(&self, diameter: f64) -> f64 {
        match T::IS_GENERAL {
            true => self.tangential.range(&self.normal, diameter, None),
            false => 0.0,
        }
    }

    /// Whether a contact with this history acts: the spheres overlap, or cohere within reach.
    #[inline(always)]
    pub fn acts(&self, contact: &Contact, history: &T::History<f64>) -> bool {
        contact.touches()
            || T::IS_GENERAL
                && contact.distance > 0.0
                && contact.overlap
                    > -self
                        .tangential
                        .range(&self.normal, contact.reduced_radius, Some(history))
    }
}

impl Contact {
    /// Whether the spheres overlap and have a normal; two centres at one place have none.
    #[inline(always)]
    pub fn touches(&self) -> bool {
        self.overlap > 0.0 && self.distance > 0.0
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const FRICTION: CundallStrack = CundallStrack {
        tangential_stiffness: 1.0,
        tangential_damping: 0.1,
        static_friction: 0.5,
        kinetic_friction: 0.4,
        sliding: Sliding::Spring,
    };

    const LAW: ContactLaw<LinearSpringDashpot, CundallStrack> = ContactLaw {
        normal: LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: 0.2,
        },
        tangential: FRICTION,
    };

    fn contact(parting: f64) -> Contact {
        Contact {
            overlap: 0.1,
            distance: 0.9,
            normal: DVec3::X,
            relative_velocity: DVec3::new(parting, 0.3, 0.0),
            reduced_radius: 0.25,
            rotation: DVec3::ZERO,
            spin: DVec3::ZERO,
        }
    }

    #[test]
    fn force_and_torque_by_hand() {
        let found = LAW.force(&contact(-0.1), &mut TangentialHistory::default(), 0.0);
        // f_n = 0.1 + 0.02; |f_t| = 0.1 * 0.3 < 0.5 f_n, against the slip along y.
        assert!((found.force - DVec3::new(0.12, -0.03, 0.0)).length() < 1e-15);
        // -x cross (-0.03 y) = 0.03 z
        assert!((found.torque_per_arm - DVec3::new(0.0, 0.0, 0.03)).length() < 1e-15);
        assert!((found.energy - 0.005).abs() < 1e-15);
        assert!((found.normal_dissipation - 0.002).abs() < 1e-15);
    }

    #[test]
    fn a_contact_that_pulls_has_no_friction() {
        let found = LAW.force(&contact(0.8), &mut TangentialHistory::default(), 0.0);
        assert!((found.force - DVec3::new(-0.06, 0.0, 0.0)).length() < 1e-15);
        assert_eq!(found.torque_per_arm, DVec3::ZERO);
    }

    #[test]
    fn a_smooth_law_is_the_normal_law_alone() {
        let found = LAW.frictionless().force(&contact(-0.1), &mut (), 0.05);
        assert!((found.force - DVec3::new(0.12, 0.0, 0.0)).length() < 1e-15);
        assert_eq!(
            (found.torque_per_arm, found.tangential),
            (DVec3::ZERO, TangentialForce::default())
        );
    }
}
