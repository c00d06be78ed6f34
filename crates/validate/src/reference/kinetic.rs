//! Kinetic theory of a dilute gas of inelastic hard spheres.

use core::f64::consts::PI;

/// A homogeneous gas of spheres of diameter and mass 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoolingGas {
    /// e
    pub(crate) restitution: f64,
    /// n \[1/d^3\]
    pub(crate) density: f64,
    /// Surface of the walls that keep centres in over the volume \[1/d\].
    pub(crate) surface: f64,
}

impl CoolingGas {
    /// Collisions of a grain in a unit of time over sqrt(T/m): 4 sqrt(pi) n d^2 g_0 (1 - S d/(4 V)).
    ///
    /// g_0 = (1 - phi/2)/(1 - phi)^3 (Carnahan & Starling 1969). A centre at a distance x < d from a mirror can be met from a
    /// part (1 + x/d)/2 of its surroundings only: the last factor.
    pub(crate) fn collision_rate(&self) -> f64 {
        let fraction = self.density * PI / 6.0;
        let contact_value = (1.0 - 0.5 * fraction) / (1.0 - fraction).powi(3);
        4.0 * PI.sqrt() * self.density * contact_value * (1.0 - 0.25 * self.surface)
    }

    /// d T^(-1/2)/dt of Haff's law T = T_0/(1 + t/tau)^2: it does not depend on time or temperature.
    ///
    /// (1 - e^2)/6 times the collision rate times 1 + 3 a_2/16, a_2 = 16 (1 - e)(1 - 2 e^2)/(81 - 17 e + 30 e^2 (1 - e)).
    /// Sources: P. K. Haff, J. Fluid Mech. 134, 401 (1983); van Noije & Ernst, Granular Matter 1, 57 (1998).
    pub(crate) fn haff_rate(&self) -> f64 {
        let e = self.restitution;
        let a2 =
            16.0 * (1.0 - e) * (1.0 - 2.0 * e * e) / (81.0 - 17.0 * e + 30.0 * e * e * (1.0 - e));
        (1.0 - e * e) / 6.0 * self.collision_rate() * (1.0 + 3.0 / 16.0 * a2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elastic_grains_do_not_cool_and_dilute_ones_collide_as_in_the_textbook() {
        let gas = CoolingGas {
            restitution: 1.0,
            density: 1e-6,
            surface: 0.0,
        };
        assert_eq!(gas.haff_rate(), 0.0);
        // sqrt(2) pi d^2 n times the mean speed sqrt(8 T/(pi m)).
        let textbook = core::f64::consts::SQRT_2 * PI * 1e-6 * (8.0 / PI).sqrt();
        assert!((gas.collision_rate() / textbook - 1.0).abs() < 1e-5);
    }
}
