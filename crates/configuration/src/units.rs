//! What the units of mass, length and time are in SI.

use std::f64::consts::PI;

use peristalsis_physics::contact::Elasticity;
use serde::Serialize;

/// Seconds in an hour.
pub const HOUR: f64 = 3600.0;

/// Mass of a grain, m = pi rho d^3/6 \[kg\]: rho in kg m^-3, d in m.
pub fn grain_mass(density: f64, diameter: f64) -> f64 {
    PI / 6.0 * density * diameter * diameter * diameter
}

/// The unit of length d, the density of the grains and the elasticity of their contacts in SI.
///
/// m = pi rho d^3/6;  t = sqrt(k m/k_SI) where a stiffness k scales the contact law, t = sqrt(Y m/(Y_SI d)) where Young's
/// modulus Y does, k and Y their values in our units
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Units {
    /// d: diameter of a grain whose diameter is 1 \[m\].
    pub grain_diameter: f64,
    /// rho \[kg m^-3\].
    pub density: f64,
    /// k_SI \[N m^-1\] or Y_SI \[Pa\], as the contact law has it.
    #[serde(flatten)]
    pub elasticity: Elasticity,
    /// k \[m t^-2\] or Y \[m d^-1 t^-2\]: the same in our units.
    #[serde(skip)]
    pub contact_elasticity: f64,
}

/// The key that gives an elasticity in SI.
pub fn elasticity_key(elasticity: Elasticity) -> &'static str {
    match elasticity {
        Elasticity::Stiffness(_) => "units.stiffness",
        Elasticity::YoungModulus(_) => "units.young_modulus",
    }
}

impl Units {
    /// d \[m\].
    pub fn length(&self) -> f64 {
        self.grain_diameter
    }

    /// m \[kg\].
    pub fn mass(&self) -> f64 {
        grain_mass(self.density, self.grain_diameter)
    }

    /// t \[s\].
    pub fn time(&self) -> f64 {
        let contact = self.contact_elasticity;
        match self.elasticity {
            Elasticity::Stiffness(stiffness) => (contact * self.mass() / stiffness).sqrt(),
            Elasticity::YoungModulus(modulus) => {
                (contact * self.mass() / (modulus * self.grain_diameter)).sqrt()
            }
        }
    }

    /// d/t \[m s^-1\].
    pub fn velocity(&self) -> f64 {
        self.length() / self.time()
    }

    /// m d/t^2 \[N\].
    pub fn force(&self) -> f64 {
        self.mass() * self.velocity() / self.time()
    }

    /// m/(d t^2) \[Pa\].
    pub fn pressure(&self) -> f64 {
        self.mass() / (self.length() * self.time() * self.time())
    }

    /// m d^2/t^2 \[J\], or \[N m\] of a torque.
    pub fn energy(&self) -> f64 {
        self.force() * self.length()
    }

    /// m d^2/t^3 \[W\].
    pub fn power(&self) -> f64 {
        self.mass() * self.velocity() * self.velocity() / self.time()
    }

    /// m/t \[kg s^-1\].
    pub fn mass_flow(&self) -> f64 {
        self.mass() / self.time()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Glass beads of 1 mm: m = pi/6 2500 1e-9 = 1.309e-6 kg; with k = 1 N/m a unit of time of 1.144 ms.
    #[test]
    fn units_of_glass_beads_by_hand() {
        let units = Units {
            grain_diameter: 1e-3,
            density: 2500.0,
            elasticity: Elasticity::Stiffness(1.0),
            contact_elasticity: 1.0,
        };
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
        };
        near(units.mass(), 1.309e-6);
        near(units.time(), 1.1441e-3);
        near(units.velocity(), 0.8741);
        // k/d
        near(units.pressure(), 1000.0);
        // k d^2/t
        near(units.power(), 1e-6 / 1.1441e-3);
        near(units.mass_flow(), 1.1441e-3);
        let hertz = Units {
            elasticity: Elasticity::YoungModulus(1e6),
            contact_elasticity: 2.0,
            ..units
        };
        // Pressures are in units of Y_SI over Y.
        near(hertz.pressure(), 5e5);
    }
}
