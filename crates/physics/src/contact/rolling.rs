//! Rolling resistance of two spheres: a spring, a dashpot and a slider in the rolling plane.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Contact, CundallStrack, Sliding, TangentialForce, TangentialHistory, TangentialLaw};
use crate::real::{Real, Vector};

/// Couple that resists rolling, from a force f_r of the same form as friction.
///
/// v_r = R_ij (omega_i - omega_j) x n;  f~ = -k_r u_r - eta_r v_r;  f_r = f~ if |f~| < mu_r f_n, else mu_r f_n f~/|f~|
///
/// The couple on this sphere is R_ij n x f_r \[m d^2/t^2\], on the partner the opposite; f_r moves no centre. u_r is the
/// rolled distance \[d\], cut where the contact rolls on as friction cuts its own. R_ij is the reduced radius: on a plane
/// it is the radius, so that a sphere rests up to the slope tan(theta) = mu_r. A spin about n is not resisted.
/// Luding, Granular Matter 10, 235 (2008); LAMMPS calls it `rolling sds`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct RollingResistance {
    /// Rolling friction mu_r: the couple that resists rolling is at most mu_r f_n R_ij, R_ij the reduced radius. On a plane
    /// a sphere rolls where the slope is steeper than mu_r. 0: rolling is free. Needs friction.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1e6))]
    pub rolling_friction: f64,
    /// Stiffness k_r of the rolling spring, which takes a couple k_r R_ij^2 for each radian. Without effect while
    /// rolling_friction is 0.
    #[schemars(extend("x-unit" = "m t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub rolling_stiffness: f64,
    /// Damping eta_r of rolling. Without effect while rolling_friction is 0.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12))]
    pub rolling_damping: f64,
}

impl Default for RollingResistance {
    fn default() -> Self {
        Self {
            rolling_friction: 0.0,
            rolling_stiffness: 1.0,
            rolling_damping: 0.1,
        }
    }
}

/// The response of rolling resistance to a contact. Energies in m d^2/t^2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingCouple<R: Real = f64> {
    /// Couple on this sphere; the partner feels the opposite \[m d^2/t^2\].
    pub couple: R::Vector,
    /// Energy stored in the rolling spring, k_r u_r^2/2.
    pub energy: R,
    /// Energy lost in this step to damping and sliding in the rolling plane.
    pub lost: R,
}

impl RollingResistance {
    /// Spring, dashpot and slider as friction has them.
    fn spring(&self) -> CundallStrack {
        CundallStrack {
            tangential_stiffness: self.rolling_stiffness,
            tangential_damping: self.rolling_damping,
            static_friction: self.rolling_friction,
            kinetic_friction: self.rolling_friction,
            sliding: Sliding::Spring,
        }
    }

    /// Couple after a step of length `time_step` that led to `contact`, pressed by `normal_force`; moves `history` on.
    pub fn couple<R: Real>(
        &self,
        contact: &Contact<R>,
        normal_force: R,
        history: &mut TangentialHistory<R>,
        time_step: f64,
    ) -> RollingCouple<R> {
        let rolling_velocity = contact.spin.cross(contact.normal) * contact.reduced_radius;
        let spring = self.spring();
        let TangentialForce {
            force,
            energy,
            damped,
            slid,
            ..
        } = spring.respond(contact, rolling_velocity, normal_force, history, time_step);
        RollingCouple {
            couple: contact.normal.cross(force) * contact.reduced_radius,
            energy,
            lost: damped + slid,
        }
    }

    /// Energy held by a history \[m d^2/t^2\].
    pub fn stored_energy<R: Real>(&self, history: &TangentialHistory<R>) -> R {
        self.spring().stored_energy(history)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const LAW: RollingResistance = RollingResistance {
        rolling_friction: 0.1,
        rolling_stiffness: 2.0,
        rolling_damping: 0.5,
    };

    /// A sphere of radius 1/2 that rolls along x on a plane below it.
    fn rolling(spin: f64) -> Contact {
        Contact {
            overlap: 0.0,
            distance: 0.5,
            normal: DVec3::Z,
            relative_velocity: DVec3::ZERO,
            reduced_radius: 0.5,
            rotation: DVec3::ZERO,
            spin: DVec3::new(0.0, spin, 3.0),
        }
    }

    #[test]
    fn below_the_bound_spring_and_dashpot_act_against_the_roll() {
        let mut history = TangentialHistory {
            displacement: DVec3::new(0.1, 0.0, 0.0),
            ..TangentialHistory::default()
        };
        // v_r = 0.5 * 0.4 = 0.2 along x: f_r = -(2 * 0.1 + 0.5 * 0.2), the couple z x f_r/2.
        let found = LAW.couple(&rolling(0.4), 9.0, &mut history, 0.0);
        assert!((found.couple - DVec3::new(0.0, -0.15, 0.0)).length() < 1e-15);
        assert!((found.energy - 0.01).abs() < 1e-15);
    }

    #[test]
    fn beyond_it_the_couple_is_that_of_rolling_friction() {
        let mut history = TangentialHistory::default();
        let found = LAW.couple(&rolling(4.0), 1.0, &mut history, 0.05);
        // mu_r f_n R, and the spring keeps mu_r f_n/k_r at most.
        assert!((found.couple - DVec3::new(0.0, -0.05, 0.0)).length() < 1e-15);
        assert!(history.displacement.length() <= 0.05 + 1e-15 && history.sliding);
    }
}
