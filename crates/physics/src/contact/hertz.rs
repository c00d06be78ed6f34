//! Hertz spring with viscoelastic dissipation: the normal law of the frictional model.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Elasticity, Impact, NormalForce, NormalLaw};
use crate::real::Real;

/// How the dissipation time enters the viscoelastic force: f_n is proportional to xi^(3/2) - B sqrt(xi) v_n.
///
/// Standard is B = 3A/2 (Kuwabara & Kono 1987; Mueller & Poeschel, Phys. Rev. E 84, 021302 (2011)); the talk prints B = A.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DissipationForm {
    /// As the talk prints it: xi^(3/2) - A sqrt(xi) v_n.
    Printed,
    /// The standard viscoelastic sphere: 3/2 in front of A.
    #[default]
    Viscoelastic,
}

/// Normal contact force of two viscoelastic spheres.
///
/// f_n = 2 Y sqrt(R_ij)/(3 (1 - nu^2)) (xi^(3/2) - B sqrt(xi) v_n), and 0 where this is negative (no cohesion);
/// B = A or 3A/2 by [`DissipationForm`]
///
/// xi overlap \[d\], v_n positive when parting \[d/t\], R_ij = d_i d_j/(2 (d_i + d_j)) \[d\]. Stored energy
/// (2/5) 2 Y sqrt(R_ij)/(3 (1 - nu^2)) xi^(5/2). While the bracket is negative the spheres part faster than the
/// material recovers, and the energy that is still stored counts as dissipated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct ViscoelasticHertz {
    /// Young's modulus Y of the Hertz law, f_n = 2 Y sqrt(R)/(3 (1 - nu^2)) (xi^(3/2) - B sqrt(xi) v_n); B is 3 A/2,
    /// or A where dissipation_form is "printed".
    #[schemars(extend("x-unit" = "m d^-1 t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub young_modulus: f64,
    /// Poisson's ratio nu of the Hertz law.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = -1, "maximum" = 0.5))]
    pub poisson_ratio: f64,
    /// Dissipation time A of the Hertz law.
    #[schemars(extend("x-unit" = "t", "minimum" = 0, "maximum" = 1e12))]
    pub dissipation_time: f64,
    /// Factor of the damping of the Hertz law: 1 as printed, 3/2 for the standard viscoelastic sphere.
    pub dissipation_form: DissipationForm,
}

impl Default for ViscoelasticHertz {
    fn default() -> Self {
        Self {
            young_modulus: 1.0,
            poisson_ratio: 0.5,
            dissipation_time: 0.1,
            dissipation_form: DissipationForm::Viscoelastic,
        }
    }
}

impl ViscoelasticHertz {
    /// 2 Y/(3 (1 - nu^2)): the force is this times sqrt(R_ij) xi^(3/2).
    #[inline(always)]
    pub fn modulus(&self) -> f64 {
        2.0 * self.young_modulus / (3.0 * (1.0 - self.poisson_ratio * self.poisson_ratio))
    }

    /// B, the time that multiplies sqrt(xi) v_n.
    #[inline(always)]
    pub fn relaxation_time(&self) -> f64 {
        match self.dissipation_form {
            DissipationForm::Printed => self.dissipation_time,
            DissipationForm::Viscoelastic => 1.5 * self.dissipation_time,
        }
    }

    /// l = (m_ij v^2/K)^(2/5), K = 2 Y R_ij^(1/2)/(3 (1 - nu^2)): with l as unit of length and l/v as unit of time an
    /// impact depends on s = B v/l alone.
    fn impact_length(&self, impact: Impact) -> f64 {
        let stiffness = self.modulus() * impact.reduced_radius.sqrt();
        let energy = impact.reduced_mass * impact.speed * impact.speed;
        libm::pow(energy / stiffness, 0.4)
    }
}

/// Step of time in [`scaled_restitution`], of a contact that lasts 3.2 without damping.
const SCALED_STEP: f64 = 1e-3;
/// s above which e, which falls about as s^(-5/3), is below 2e-5 and taken for 0.
const OVERDAMPED: f64 = 1000.0;

/// Restitution of the impact x'' = -max(x^(3/2) + s x^(1/2) x', 0), x(0) = 0, x'(0) = 1 of viscoelastic spheres, by the fourth-order
/// Runge-Kutta method. From where the force vanishes the spheres part freely.
fn scaled_restitution(damping: f64) -> f64 {
    if damping > OVERDAMPED {
        return 0.0;
    }
    let acceleration = |x: f64, rate: f64| {
        let x = x.max(0.0);
        -(x.sqrt() * (x + damping * rate)).max(0.0)
    };
    let (step, half) = (SCALED_STEP, 0.5 * SCALED_STEP);
    let (mut x, mut rate) = (0.0, 1.0);
    while rate > 0.0 || x + damping * rate > 0.0 {
        let a1 = acceleration(x, rate);
        let (r2, a2) = (
            rate + half * a1,
            acceleration(x + half * rate, rate + half * a1),
        );
        let (r3, a3) = (
            rate + half * a2,
            acceleration(x + half * r2, rate + half * a2),
        );
        let (r4, a4) = (
            rate + step * a3,
            acceleration(x + step * r3, rate + step * a3),
        );
        x += step * (rate + 2.0 * (r2 + r3) + r4) / 6.0;
        rate += step * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
        // Without damping the force vanishes where the spheres part.
        if x <= 0.0 {
            break;
        }
    }
    (-rate).min(1.0)
}

/// s of an impact that ends with this restitution, by bisection.
fn scaled_damping(restitution: f64) -> f64 {
    let is_enough = |damping: f64| scaled_restitution(damping) <= restitution;
    let mut enough = 1.0;
    while !is_enough(enough) {
        enough *= 2.0;
    }
    let (mut least, mut most) = (0.0, enough);
    // To the accuracy of the integration.
    while most - least > 1e-12 * enough {
        let middle = 0.5 * (least + most);
        match is_enough(middle) {
            true => most = middle,
            false => least = middle,
        }
    }
    0.5 * (least + most)
}

impl NormalLaw for ViscoelasticHertz {
    #[inline(always)]
    fn force<R: Real>(&self, overlap: R, normal_velocity: R, reduced_radius: R) -> NormalForce<R> {
        let root = (reduced_radius * overlap).sqrt() * R::splat(self.modulus());
        let elastic_force = root * overlap;
        let damping_force = root * R::splat(self.relaxation_time()) * normal_velocity;
        NormalForce {
            force: (elastic_force - damping_force).positive_part(),
            elastic_force,
            energy: R::splat(0.4) * elastic_force * overlap,
        }
    }

    fn damping(&self) -> (&'static str, f64) {
        ("contact.dissipation_time", self.dissipation_time)
    }

    fn undamped(&self) -> Self {
        Self {
            dissipation_time: 0.0,
            ..*self
        }
    }

    fn stiffness(&self, overlap: f64, reduced_radius: f64) -> f64 {
        1.5 * self.modulus() * (reduced_radius * overlap).sqrt()
    }

    fn elasticity(&self) -> Elasticity {
        Elasticity::YoungModulus(self.young_modulus)
    }

    /// xi = (5 m_ij v^2/(4 K))^(2/5), K = 2 Y R_ij^(1/2)/(3 (1 - nu^2))
    fn impact_overlap(&self, impact: Impact) -> f64 {
        let stiffness = self.modulus() * impact.reduced_radius.sqrt();
        let energy = impact.reduced_mass * impact.speed * impact.speed;
        libm::pow(1.25 * energy / stiffness, 0.4)
    }

    /// By integration of the impact, which depends on s = B v/l alone, l = (m_ij v^2/K)^(2/5); at rest the limit of slow
    /// impacts, e = 1.
    fn impact_restitution(&self, impact: Impact) -> f64 {
        let length = self.impact_length(impact);
        let damping = self.relaxation_time() * impact.speed / length;
        // Nor a number where the impact is out of the range of numbers.
        if length == 0.0 || damping.is_nan() {
            return 1.0;
        }
        scaled_restitution(damping)
    }

    /// A from B = s l/v, with the s that belongs to the restitution.
    fn with_restitution(&self, restitution: f64, impact: Impact) -> Self {
        if restitution >= 1.0 {
            return self.undamped();
        }
        let relaxation_time =
            scaled_damping(restitution) * self.impact_length(impact) / impact.speed;
        let dissipation_time = match self.dissipation_form {
            DissipationForm::Printed => relaxation_time,
            DissipationForm::Viscoelastic => relaxation_time / 1.5,
        };
        Self {
            dissipation_time,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: ViscoelasticHertz = ViscoelasticHertz {
        young_modulus: 1.0,
        poisson_ratio: 0.5,
        dissipation_time: 0.1,
        dissipation_form: DissipationForm::Viscoelastic,
    };

    /// Y = 1, nu = 1/2: 2/(3 * 3/4) = 8/9; sqrt(R xi) = 0.1 for R = 1/4, xi = 0.04.
    #[test]
    fn force_and_energy_by_hand() {
        let found = LAW.force(0.04, -0.2, 0.25);
        let elastic = 8.0 / 9.0 * 0.1 * 0.04;
        assert!((found.elastic_force - elastic).abs() < 1e-15);
        assert!((found.force - elastic - 8.0 / 9.0 * 0.1 * 0.15 * 0.2).abs() < 1e-15);
        assert!((found.energy - 0.4 * elastic * 0.04).abs() < 1e-15);
        let printed = ViscoelasticHertz {
            dissipation_form: DissipationForm::Printed,
            ..LAW
        };
        let less = printed.force(0.04, -0.2, 0.25);
        assert!((less.force - elastic - 8.0 / 9.0 * 0.1 * 0.1 * 0.2).abs() < 1e-15);
        assert_eq!(
            LAW.undamped().force(0.04, -0.2, 0.25).force,
            found.elastic_force
        );
    }

    #[test]
    fn a_fast_parting_contact_lets_go_instead_of_pulling() {
        let found = LAW.force(0.04, 1.0, 0.25);
        assert_eq!(found.force, 0.0);
        assert!(found.elastic_force > 0.0);
    }

    #[test]
    fn stiffness_is_the_slope_of_the_elastic_force() {
        let (overlap, step) = (0.07, 1e-6);
        let force = |overlap: f64| LAW.undamped().force(overlap, 0.0, 0.25).force;
        let slope = (force(overlap + step) - force(overlap - step)) / (2.0 * step);
        assert!((LAW.stiffness(overlap, 0.25) - slope).abs() < 1e-9);
    }

    #[test]
    fn an_impact_stores_its_kinetic_energy() {
        let overlap = LAW.impact_overlap(Impact::of_twins(1.0, 0.02));
        let stored = LAW.force(overlap, 0.0, 0.25).energy;
        assert!((stored / (0.5 * 0.5 * 0.02 * 0.02) - 1.0).abs() < 1e-12);
    }
}
