//! Closed forms for normal impacts.

use core::f64::consts::PI;

use peristalsis_physics::contact::{Normal, ViscoelasticHertz};

use crate::textbook::experiment::impact::Impact;

/// kappa of the Hertz force kappa xi^(3/2), at a reduced radius \[m d^(-1/2) t^(-2)\].
pub(crate) fn stiffness(law: &ViscoelasticHertz, reduced_radius: f64) -> f64 {
    let nu = law.poisson_ratio;
    2.0 * law.young_modulus * reduced_radius.sqrt() / (3.0 * (1.0 - nu * nu))
}

/// A head-on impact of elastic spheres whose force is F = kappa xi^(3/2).
///
/// xi_max = (5 m v^2/(4 kappa))^(2/5), m the reduced mass; t_c = 2 sqrt(pi) Gamma(7/5)/Gamma(9/10) xi_max/v = 2.9433 xi_max/v.
/// Source: H. Hertz, J. reine angew. Math. 92, 156 (1882); Johnson, Contact Mechanics (1985), section 11.4.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HertzImpact {
    /// kappa \[m d^(-1/2) t^(-2)\]
    pub(crate) stiffness: f64,
    /// m
    pub(crate) reduced_mass: f64,
    /// v, the relative speed \[d/t\]
    pub(crate) speed: f64,
}

impl HertzImpact {
    /// The impact under the elastic part of a law.
    pub(crate) fn of(law: &ViscoelasticHertz, impact: &Impact) -> Self {
        Self {
            stiffness: stiffness(law, impact.reduced_radius()),
            reduced_mass: impact.reduced_mass(),
            speed: impact.relative_velocity().length(),
        }
    }

    /// xi_max \[d\]
    pub(crate) fn largest_overlap(&self) -> f64 {
        let ratio = 1.25 * self.reduced_mass * self.speed * self.speed / self.stiffness;
        libm::pow(ratio, 0.4)
    }

    /// t_c \[t\]
    pub(crate) fn contact_time(&self) -> f64 {
        2.0 * PI.sqrt() * libm::tgamma(1.4) / libm::tgamma(0.9) * self.largest_overlap()
            / self.speed
    }

    /// kappa xi_max^(3/2)
    pub(crate) fn peak_force(&self) -> f64 {
        self.stiffness * libm::pow(self.largest_overlap(), 1.5)
    }
}

/// Duration of a head-on impact without its dissipation \[t\].
pub(crate) fn contact_time(impact: &Impact) -> f64 {
    if let Normal::Hertz(law) = impact.contact.normal {
        HertzImpact::of(&law, impact).contact_time()
    } else if let Normal::Linear(law) = impact.contact.normal {
        PI / (law.normal_stiffness / impact.reduced_mass()).sqrt()
    } else {
        unreachable!("the cases have impacts of these two laws")
    }
}

/// Restitution of slow viscoelastic spheres, e = 1 - C s + (3/5) C^2 s^2 + (4/15) s^(5/2) + O(s^3).
///
/// s = B (kappa/m)^(2/5) v^(1/5) for the force kappa (xi^(3/2) - B sqrt(xi) v_n), clipped at 0; C = Gamma(3/5) sqrt(pi)/(2^(1/5)
/// 5^(2/5) Gamma(21/10)) = 1.15344. Source: Schwager & Poeschel, Phys. Rev. E 57, 650 (1998), Ramirez et al., Phys. Rev. E
/// 60, 4465 (1999); the term of order 5/2 is the attraction that the clipped force leaves out (Schwager & Poeschel, Phys.
/// Rev. E 78, 051304 (2008)).
pub(crate) fn viscoelastic_series(s: f64) -> f64 {
    let c = libm::tgamma(0.6) * PI.sqrt()
        / (libm::pow(2.0, 0.2) * libm::pow(5.0, 0.4) * libm::tgamma(2.1));
    1.0 - c * s + 0.6 * c * c * s * s + 4.0 / 15.0 * libm::pow(s, 2.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_and_the_known_constants() {
        let impact = HertzImpact {
            stiffness: 0.7,
            reduced_mass: 0.5,
            speed: 0.02,
        };
        let stored = 0.4 * impact.stiffness * libm::pow(impact.largest_overlap(), 2.5);
        assert!((stored / (0.25 * 0.02 * 0.02) - 1.0).abs() < 1e-12);
        let ratio = impact.contact_time() * impact.speed / impact.largest_overlap();
        assert!((ratio - 2.943_275).abs() < 2e-5, "{ratio}");
        assert!((viscoelastic_series(1e-6) - (1.0 - 1.153_44e-6)).abs() < 1e-11);
    }
}
