//! Materials, and laws of spheres made of them.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_physics::contact::{
    CundallStrack, DissipationForm, Normal, Sliding, ViscoelasticHertz,
};

use crate::textbook::experiment::frictionless;
use crate::textbook::experiment::impact::Impact;

/// An elastic material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    pub(super) name: &'static str,
    /// Young's modulus \[Pa\].
    pub(super) young_modulus: f64,
    pub(super) poisson_ratio: f64,
    /// \[kg/m^3\]
    pub(super) density: f64,
}

/// The material of the impacts of Chung & Ooi 2011, tests 3 and 4.
pub(super) const ALUMINIUM_OXIDE: Material = Material::new("aluminium oxide", 3.8e11, 0.23, 4000.0);

/// A head-on impact of those tests, of a sphere on a plane at 3.9 m/s.
pub(super) fn aluminium_oxide_impact(dissipation_time: f64) -> Impact {
    let speed = 3.9 / ALUMINIUM_OXIDE.speed();
    let law = ALUMINIUM_OXIDE.against_rigid(dissipation_time);
    Impact::on_plane(
        frictionless(Normal::Hertz(law)),
        DVec3::new(-speed, 0.0, 0.0),
    )
}

impl Material {
    pub(super) const fn new(
        name: &'static str,
        young_modulus: f64,
        poisson_ratio: f64,
        density: f64,
    ) -> Self {
        Self {
            name,
            young_modulus,
            poisson_ratio,
            density,
        }
    }

    /// d/t in m/s: sqrt(6 Y/(pi rho)), whatever the diameter.
    pub(super) fn speed(&self) -> f64 {
        (6.0 * self.young_modulus / (PI * self.density)).sqrt()
    }

    /// The law of two spheres of this material, in units of its own modulus.
    pub(super) fn spheres(&self, dissipation_time: f64) -> ViscoelasticHertz {
        ViscoelasticHertz {
            young_modulus: 1.0,
            poisson_ratio: self.poisson_ratio,
            dissipation_time,
            dissipation_form: DissipationForm::Viscoelastic,
        }
    }

    /// The law of a sphere of this material and a rigid body: only the sphere is deformed, which doubles the modulus.
    pub(super) fn against_rigid(&self, dissipation_time: f64) -> ViscoelasticHertz {
        ViscoelasticHertz {
            young_modulus: 2.0,
            ..self.spheres(dissipation_time)
        }
    }

    /// Friction without a tangential dashpot, whose stiffness is Mindlin's part 2 (1 - nu)/(2 - nu) of the stiffness m (pi/t_c)^2
    /// of a linear normal spring with the same contact time t_c, m the reduced mass.
    pub(super) fn friction(
        &self,
        coefficient: f64,
        reduced_mass: f64,
        contact_time: f64,
    ) -> CundallStrack {
        let nu = self.poisson_ratio;
        let normal_stiffness = reduced_mass * (PI / contact_time).powi(2);
        CundallStrack {
            tangential_stiffness: 2.0 * (1.0 - nu) / (2.0 - nu) * normal_stiffness,
            tangential_damping: 0.0,
            static_friction: coefficient,
            kinetic_friction: coefficient,
            sliding: Sliding::Spring,
        }
    }
}
