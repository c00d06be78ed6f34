//! Linear spring and dashpot: the contact law of the frictionless model.

use core::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Elasticity, Impact, NormalForce, NormalLaw};
use crate::real::Real;

/// Normal contact force of two spheres, a spring and a dashpot in parallel.
///
/// f_n = k xi - eta v_n
///
/// xi overlap \[d\], v_n relative velocity along n, positive when parting \[d/t\]. Not clipped: a parting contact may
/// pull. Source: Yoshioka & Hayakawa, Phys. Rev. E 85, 031302 (2012).
///
/// ```
/// use peristalsis_physics::contact::LinearSpringDashpot;
/// let law = LinearSpringDashpot { normal_stiffness: 1.0, normal_damping: 5.48e-3 };
/// assert!((law.restitution(0.5) - 0.988).abs() < 5e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct LinearSpringDashpot {
    /// Stiffness k of the linear law, f_n = k xi - eta v_n.
    #[schemars(extend("x-unit" = "m t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub normal_stiffness: f64,
    /// Damping eta of the linear law.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12))]
    pub normal_damping: f64,
}

impl Default for LinearSpringDashpot {
    /// Restitution 0.988 for two grains of diameter 1.
    fn default() -> Self {
        Self {
            normal_stiffness: 1.0,
            normal_damping: 5.48e-3,
        }
    }
}

impl LinearSpringDashpot {
    /// Restitution of a normal impact, for reduced mass m_ij.
    ///
    /// e = exp(-pi beta/sqrt(omega_0^2 - beta^2)), beta = eta/(2 m_ij), omega_0^2 = k/m_ij; for m_ij = 1/2 and k = 1
    /// this is exp(-pi eta/sqrt(2 - eta^2)). Zero where the contact is overdamped. The contact ends where the overlap
    /// returns to zero, as the unclipped law has it.
    pub fn restitution(&self, reduced_mass: f64) -> f64 {
        let (damping_rate, frequency_squared) = self.oscillation(reduced_mass);
        if frequency_squared <= 0.0 {
            return 0.0;
        }
        libm::exp(-PI * damping_rate / frequency_squared.sqrt())
    }

    /// Duration of a normal impact, pi/sqrt(omega_0^2 - beta^2) \[t\], for reduced mass m_ij; infinite where the contact
    /// is overdamped.
    pub fn contact_time(&self, reduced_mass: f64) -> f64 {
        let (_, frequency_squared) = self.oscillation(reduced_mass);
        if frequency_squared <= 0.0 {
            return f64::INFINITY;
        }
        PI / frequency_squared.sqrt()
    }

    /// beta, and omega_0^2 - beta^2.
    fn oscillation(&self, reduced_mass: f64) -> (f64, f64) {
        let damping_rate = self.normal_damping / (2.0 * reduced_mass);
        let frequency_squared = self.normal_stiffness / reduced_mass - damping_rate * damping_rate;
        (damping_rate, frequency_squared)
    }
}

impl NormalLaw for LinearSpringDashpot {
    #[inline(always)]
    fn force<R: Real>(&self, overlap: R, normal_velocity: R, _reduced_radius: R) -> NormalForce<R> {
        let elastic_force = R::splat(self.normal_stiffness) * overlap;
        NormalForce {
            force: elastic_force - R::splat(self.normal_damping) * normal_velocity,
            elastic_force,
            energy: R::splat(0.5) * elastic_force * overlap,
        }
    }

    fn damping(&self) -> (&'static str, f64) {
        ("contact.normal_damping", self.normal_damping)
    }

    fn undamped(&self) -> Self {
        Self {
            normal_damping: 0.0,
            ..*self
        }
    }

    fn stiffness(&self, _overlap: f64, _reduced_radius: f64) -> f64 {
        self.normal_stiffness
    }

    fn elasticity(&self) -> Elasticity {
        Elasticity::Stiffness(self.normal_stiffness)
    }

    /// xi = v (m_ij/k)^(1/2)
    fn impact_overlap(&self, impact: Impact) -> f64 {
        impact.speed * (impact.reduced_mass / self.normal_stiffness).sqrt()
    }

    /// At any speed: e = exp(-pi beta/sqrt(omega_0^2 - beta^2)), see [`LinearSpringDashpot::restitution`].
    fn impact_restitution(&self, impact: Impact) -> f64 {
        self.restitution(impact.reduced_mass)
    }

    /// eta = 2 (m_ij k)^(1/2) L/(pi^2 + L^2)^(1/2), L = -ln e
    fn with_restitution(&self, restitution: f64, impact: Impact) -> Self {
        // One zero, not two.
        let logarithm = 0.0 - libm::log(restitution);
        let part = logarithm / (PI * PI + logarithm * logarithm).sqrt();
        Self {
            normal_damping: 2.0 * (impact.reduced_mass * self.normal_stiffness).sqrt() * part,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: LinearSpringDashpot = LinearSpringDashpot {
        normal_stiffness: 2.0,
        normal_damping: 0.5,
    };

    #[test]
    fn force_and_energy_by_hand() {
        let found = LAW.force(0.1, -0.2, 0.25);
        assert!((found.force - 0.3).abs() < 1e-15);
        assert!((found.elastic_force - 0.2).abs() < 1e-15);
        assert!((found.energy - 0.01).abs() < 1e-15);
        assert_eq!(
            LAW.undamped().force(0.1, -0.2, 0.25).force,
            found.elastic_force
        );
        assert_eq!(LAW.stiffness(0.1, 0.25), 2.0);
        // m v^2/2 = k xi^2/2
        assert!((LAW.impact_overlap(Impact::of_twins(1.0, 0.1)) - 0.05).abs() < 1e-15);
    }

    #[test]
    fn a_parting_contact_may_pull() {
        assert!((LAW.force(0.01, 0.2, 0.25).force + 0.08).abs() < 1e-15);
    }

    #[test]
    fn an_overdamped_contact_does_not_bounce() {
        let law = LinearSpringDashpot {
            normal_damping: 3.0,
            ..LAW
        };
        assert_eq!(law.restitution(0.5), 0.0);
        assert_eq!(law.contact_time(0.5), f64::INFINITY);
    }
}
