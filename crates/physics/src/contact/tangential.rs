//! Friction of two spheres: none, or a spring in the plane of contact that slides (Cundall & Strack).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Contact, TangentialForce, TangentialLaw};
use crate::real::{Real, Vector};

/// Frictionless grains: no force in the plane of contact, no memory, no rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frictionless;

impl TangentialLaw for Frictionless {
    type History<R: Real> = ();
    const ROTATES: bool = false;

    #[inline(always)]
    fn force<R: Real>(&self, _: &Contact<R>, _: R, (): &mut (), _: f64) -> TangentialForce<R> {
        TangentialForce::default()
    }

    #[inline(always)]
    fn stored_energy<R: Real>(&self, (): &()) -> R {
        R::splat(0.0)
    }
}

/// How the tangential displacement u changes while a contact slides.
///
/// `Spring` cuts the spring to what sliding friction can hold. `Balance` lets spring and dashpot together balance the
/// sliding force. `Literal` is one way to read the source's words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// |u| is cut to mu_k f_n/k_t; the dissipation is never negative.
    #[default]
    Spring,
    /// u = -(f_t + eta_t v_t)/k_t: the common choice, which can create spring energy at onset.
    Balance,
    /// u grows on while the contact slides.
    Literal,
}

/// Tangential spring and dashpot that slides at the Coulomb limit.
///
/// f~ = -k_t u - eta_t v_t;  f_t = f~ if |f~| < mu_s f_n, else mu_k f_n f~/|f~|
///
/// A contact that slides sticks again once |f~| < mu_k f_n (forms `spring` and `balance`).
///
/// u is the tangential displacement since the contact began \[d\]: du/dt = v_t - (u . dn/dt) n, which keeps it in the
/// plane of contact; where f_n vanishes u is forgotten. v_t = v_ij - (v_ij . n) n + n x (l_i omega_i + l_j omega_j)
/// \[d/t\]. After Cundall & Strack, Geotechnique 29, 47 (1979).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CundallStrack {
    /// Tangential stiffness k_t, f_t = -k_t u - eta_t v_t below the Coulomb limit. Without effect while both frictions
    /// are 0.
    #[schemars(extend("x-unit" = "m t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub tangential_stiffness: f64,
    /// Tangential damping eta_t. Without effect while both frictions are 0.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12))]
    pub tangential_damping: f64,
    /// Static friction mu_s: a contact sticks while |f_t| < mu_s f_n. If only kinetic_friction is given, equal to it;
    /// with both 0 grains are frictionless and do not rotate.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1e6))]
    pub static_friction: f64,
    /// Kinetic friction mu_k, not above static_friction. If only static_friction is given, equal to it.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1e6))]
    pub kinetic_friction: f64,
    /// How the tangential displacement changes while a contact slides. Without effect while both frictions are 0.
    pub sliding: Sliding,
}

impl Default for CundallStrack {
    fn default() -> Self {
        Self {
            tangential_stiffness: 1.0,
            tangential_damping: 0.1,
            static_friction: 0.0,
            kinetic_friction: 0.0,
            sliding: Sliding::Spring,
        }
    }
}

/// Memory of a frictional contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(bound(
    serialize = "R: serde::Serialize, R::Vector: serde::Serialize, R::Mask: serde::Serialize",
    deserialize = "R: serde::Deserialize<'de>, R::Vector: serde::Deserialize<'de>, R::Mask: serde::Deserialize<'de>"
))]
pub struct TangentialHistory<R: Real = f64> {
    /// u \[d\]
    pub displacement: R::Vector,
    /// du/dt at the end of the last step \[d/t\]; zero at the first.
    pub rate: R::Vector,
    /// -f_t . v_t at the end of the last step: the power that the contact takes out of the tangential motion.
    pub power: R,
    /// Whether the contact slid at the end of the last step.
    pub sliding: R::Mask,
}

impl<R: Real> Default for TangentialHistory<R> {
    // Derived, it would be a call in the kernels, for lanes.
    #[inline(always)]
    fn default() -> Self {
        Self {
            displacement: R::Vector::default(),
            rate: R::Vector::default(),
            power: R::default(),
            sliding: R::Mask::default(),
        }
    }
}

impl<R: Real> TangentialHistory<R> {
    /// `yes` where `mask` holds, else `no`.
    #[inline(always)]
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        Self {
            displacement: R::Vector::select(mask, yes.displacement, no.displacement),
            rate: R::Vector::select(mask, yes.rate, no.rate),
            power: R::select(mask, yes.power, no.power),
            sliding: (mask & yes.sliding) | (!mask & no.sliding),
        }
    }
}

impl TangentialLaw for CundallStrack {
    type History<R: Real> = TangentialHistory<R>;
    const ROTATES: bool = true;

    #[inline(always)]
    fn force<R: Real>(
        &self,
        contact: &Contact<R>,
        normal_force: R,
        history: &mut TangentialHistory<R>,
        time_step: f64,
    ) -> TangentialForce<R> {
        let lateral_velocity = contact.lateral_velocity();
        let slip_velocity = lateral_velocity + contact.normal.cross(contact.rotation);
        self.respond(contact, slip_velocity, normal_force, history, time_step)
    }

    #[inline(always)]
    fn stored_energy<R: Real>(&self, history: &TangentialHistory<R>) -> R {
        R::splat(0.5 * self.tangential_stiffness) * history.displacement.dot(history.displacement)
    }

    fn slid(&self, history: &TangentialHistory) -> bool {
        history.sliding
    }
}

impl CundallStrack {
    /// Spring, dashpot and slider in the plane of contact, for any velocity `slip_velocity` in it.
    ///
    /// The displacement is brought forward by the trapezoidal rule, so that the order is 2 while a contact persists,
    /// whatever the integrator of the motion.
    #[inline(always)]
    pub(super) fn respond<R: Real>(
        &self,
        contact: &Contact<R>,
        slip_velocity: R::Vector,
        normal_force: R,
        history: &mut TangentialHistory<R>,
        time_step: f64,
    ) -> TangentialForce<R> {
        let zero = R::splat(0.0);
        let stiffness = R::splat(self.tangential_stiffness);
        let damping = R::splat(self.tangential_damping);
        let (step, half_step) = (R::splat(time_step), R::splat(0.5 * time_step));

        let normal = contact.normal;
        let normal_rate = contact.lateral_velocity() * (R::splat(1.0) / contact.distance);

        let predicted = history.displacement + history.rate * step;
        let rate = slip_velocity - normal * predicted.dot(normal_rate);
        let moved = history.displacement + (history.rate + rate) * half_step;
        let stuck = moved - normal * moved.dot(normal);

        // A contact that does not press slides freely, and forgets whatever sliding does elsewhere.
        let presses = zero.less(normal_force);
        let trial = -(stuck * stiffness) - slip_velocity * damping;
        let strength = trial.dot(trial).sqrt();
        let sliding =
            !strength.less(self.threshold::<R>(history.sliding) * normal_force) | !presses;
        let limit = R::splat(self.kinetic_friction) * normal_force;
        let scale = R::select(zero.less(strength), limit / strength, zero);
        let force = R::Vector::select(
            presses,
            R::Vector::select(sliding, trial * scale, trial),
            R::Vector::default(),
        );

        let energy_before = self.stored_energy(history);
        let power = -force.dot(slip_velocity);
        let moved = TangentialHistory {
            displacement: R::Vector::select(
                sliding,
                self.slid_displacement(stuck, force, slip_velocity, limit),
                stuck,
            ),
            rate,
            power,
            sliding,
        };
        let fresh = TangentialHistory::default();
        let after = TangentialHistory::select(presses, moved, fresh);
        let energy = self.stored_energy(&after);
        let lost = half_step * (history.power + after.power) - (energy - energy_before);
        *history = after;
        TangentialForce {
            force,
            energy,
            damped: R::select(sliding, zero, lost),
            slid: R::select(sliding, lost, zero),
            sliding,
        }
    }

    /// Coefficient that |f~|/f_n must reach for a contact to slide.
    ///
    /// A contact that slides goes on until |f~| falls below mu_k f_n: without this memory it would stick at once, its
    /// spring being cut, and be dragged to mu_s f_n again (after Luding, Granular Matter 10, 235 (2008)). The literal form
    /// needs none, for its spring is never cut.
    #[inline(always)]
    fn threshold<R: Real>(&self, slid_before: R::Mask) -> R {
        let at_rest = R::splat(self.static_friction);
        match self.sliding {
            Sliding::Literal => at_rest,
            Sliding::Spring | Sliding::Balance => {
                R::select(slid_before, R::splat(self.kinetic_friction), at_rest)
            }
        }
    }

    /// The displacement of a contact that slides with the force `force`, at most `limit` = mu_k f_n.
    #[inline(always)]
    fn slid_displacement<R: Real>(
        &self,
        displacement: R::Vector,
        force: R::Vector,
        slip_velocity: R::Vector,
        limit: R,
    ) -> R::Vector {
        let stiffness = R::splat(self.tangential_stiffness);
        match self.sliding {
            Sliding::Spring => {
                let longest = limit / stiffness;
                let length = displacement.dot(displacement).sqrt();
                let shortened = displacement * (longest / length);
                R::Vector::select(longest.less(length), shortened, displacement)
            }
            Sliding::Balance => {
                -(force + slip_velocity * R::splat(self.tangential_damping))
                    * (R::splat(1.0) / stiffness)
            }
            Sliding::Literal => displacement,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn law(sliding: Sliding) -> CundallStrack {
        CundallStrack {
            tangential_stiffness: 2.0,
            tangential_damping: 0.5,
            static_friction: 0.5,
            kinetic_friction: 0.4,
            sliding,
        }
    }

    fn contact(slip: f64) -> Contact {
        Contact {
            overlap: 0.1,
            distance: 0.9,
            normal: DVec3::Z,
            relative_velocity: DVec3::new(slip, 0.0, -0.3),
            reduced_radius: 0.25,
            rotation: DVec3::ZERO,
            spin: DVec3::ZERO,
        }
    }

    fn stretched(displacement: f64) -> TangentialHistory {
        TangentialHistory {
            displacement: DVec3::new(displacement, 0.0, 0.0),
            ..TangentialHistory::default()
        }
    }

    #[test]
    fn below_the_static_bound_spring_and_dashpot_act() {
        let mut history = stretched(0.1);
        // |f~| = 2 * 0.1 + 0.5 * 0.2 = 0.3 < 0.5 * 0.7
        let found = law(Sliding::Spring).force(&contact(0.2), 0.7, &mut history, 0.0);
        assert!(!found.sliding);
        assert!((found.force - DVec3::new(-0.3, 0.0, 0.0)).length() < 1e-15);
        assert!((found.energy - 0.01).abs() < 1e-15);
        assert_eq!(history.displacement, DVec3::new(0.1, 0.0, 0.0));
        assert!((history.power - 0.06).abs() < 1e-15);
    }

    #[test]
    fn beyond_it_kinetic_friction_acts_and_each_form_keeps_its_displacement() {
        for (sliding, expected) in [
            // mu_k f_n/k_t
            (Sliding::Spring, 0.08),
            // (mu_k f_n - eta_t v)/k_t
            (Sliding::Balance, 0.03),
            (Sliding::Literal, 0.1),
        ] {
            let mut history = stretched(0.1);
            // |f~| = 0.3 >= 0.5 * 0.4
            let found = law(sliding).force(&contact(0.2), 0.4, &mut history, 0.0);
            assert!(found.sliding);
            assert!((found.force - DVec3::new(-0.16, 0.0, 0.0)).length() < 1e-15);
            assert!(
                (history.displacement.x - expected).abs() < 1e-15,
                "{sliding:?}: {history:?}"
            );
        }
    }

    /// u = 0.1 + (0 + 0.2)/2 * 0.05 for a fresh rate of 0, and a full 0.2 * 0.05 from the second step on.
    #[test]
    fn the_displacement_follows_the_trapezoidal_rule() {
        let mut history = stretched(0.1);
        law(Sliding::Spring).force(&contact(0.2), 9.0, &mut history, 0.05);
        assert!((history.displacement.x - 0.105).abs() < 1e-15);
        law(Sliding::Spring).force(&contact(0.2), 9.0, &mut history, 0.05);
        assert!((history.displacement.x - 0.115).abs() < 1e-15);
    }

    #[test]
    fn spheres_that_roll_on_each_other_do_not_slip() {
        // v = 0.2 along x is undone by n x rotation = -0.2 along x.
        let contact = Contact {
            rotation: DVec3::new(0.0, 0.2, 0.0),
            ..contact(0.2)
        };
        let mut history = TangentialHistory::default();
        let found = law(Sliding::Spring).force(&contact, 1.0, &mut history, 0.05);
        assert!(found.force.length() < 1e-15, "{:?}", found.force);
    }

    #[test]
    fn smooth_grains_have_no_friction() {
        let found = Frictionless.force(&contact(0.2), 1.0, &mut (), 0.05);
        assert_eq!(found, TangentialForce::default());
    }
}
