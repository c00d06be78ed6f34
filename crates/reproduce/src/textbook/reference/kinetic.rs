//! Kinetic theory of a gas of inelastic spheres.

use core::f64::consts::PI;

/// A homogeneous gas of spheres of diameter and mass 1 between walls that centres do not pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoolingGas {
    /// e
    pub(crate) restitution: f64,
    /// n \[1/d^3\]
    pub(crate) density: f64,
    /// Surface of the walls over the volume, S/V \[1/d\].
    pub(crate) surface: f64,
}

impl CoolingGas {
    /// Collisions of a grain in a unit of time over sqrt(T/m): 4 sqrt(pi) n d^2 (g_0 + w S d/V).
    ///
    /// Grains collide as often as hard spheres would overlap if they grew: the rate follows from d F/dd, F their free energy. In
    /// the bulk that gives g_0 = (1 - phi/2)/(1 - phi)^3 (Carnahan & Starling 1969), and F has the part S gamma besides, by
    /// which w = (3 phi gamma' - 2 gamma)/(12 n phi), gamma(phi) in units of T/d^2. In a dilute gas w = -1/4: a centre at a
    /// distance x < d from a wall can be met from a part (1 + x/d)/2 of its surroundings only. At phi = 0.05 it is two fifths
    /// more: grains gather at the wall, where they are met less, and are missing elsewhere.
    pub(crate) fn collision_rate(&self) -> f64 {
        let fraction = self.density * PI / 6.0;
        let contact_value = (1.0 - 0.5 * fraction) / (1.0 - fraction).powi(3);
        let (tension, slope) = surface_tension(fraction);
        let wall = (3.0 * fraction * slope - 2.0 * tension) / (12.0 * self.density * fraction);
        4.0 * PI.sqrt() * self.density * (contact_value + wall * self.surface)
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

    /// K: grains that touch for t_c lose the part K sqrt(T/m) t_c/d less than hard ones, under the linear law.
    ///
    /// K = 4 sqrt(pi) e ln(1/e)/((1 - e)(pi^2 + ln^2 e)). The line of centres turns while they touch, and v_t^2/d drives them
    /// apart: to first order the squared normal velocity after the impact is e^2 v_n^2 + 4 beta e (1 + e) v_n v_t^2/(d omega^2),
    /// omega^2 = k/m_ij, beta = eta/(2 m_ij), and v_t does not change. The mean over all impacts has <v_n> = sqrt(pi T/m),
    /// <v_n^2> = <v_t^2> = 4 T/m. For 0 < e < 1.
    pub(crate) fn softness(&self) -> f64 {
        let e = self.restitution;
        let log = -libm::log(e);
        4.0 * PI.sqrt() * e * log / ((1.0 - e) * (PI * PI + log * log))
    }
}

/// gamma d^2/T of hard spheres at a wall, for the surface that their centres reach, and d gamma/d phi.
///
/// -9 phi^2 (1 + 44 phi/35 - 4 phi^2/5)/(2 pi (1 - phi)^3). Source: Henderson & Plischke, Proc. R. Soc. A 410, 409 (1987).
fn surface_tension(fraction: f64) -> (f64, f64) {
    let factor = -9.0 / (2.0 * PI * (1.0 - fraction).powi(3));
    let series = fraction.powi(2) * (1.0 + 44.0 / 35.0 * fraction - 0.8 * fraction.powi(2));
    let slope = 2.0 * fraction + 132.0 / 35.0 * fraction.powi(2) - 3.2 * fraction.powi(3);
    (
        factor * series,
        factor * (slope + 3.0 * series / (1.0 - fraction)),
    )
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use peristalsis_physics::contact::{LinearSpringDashpot, Normal};
    use rand_chacha::ChaCha8Rng;
    use rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::textbook::experiment::frictionless;
    use crate::textbook::experiment::impact::Impact;
    use crate::textbook::reference::impact::outcome;

    fn gas(restitution: f64, density: f64, surface: f64) -> CoolingGas {
        CoolingGas {
            restitution,
            density,
            surface,
        }
    }

    #[test]
    fn elastic_grains_do_not_cool_and_dilute_ones_collide_as_in_the_textbook() {
        let gas = gas(1.0, 1e-6, 0.0);
        assert_eq!(gas.haff_rate(), 0.0);
        // sqrt(2) pi d^2 n times the mean speed sqrt(8 T/(pi m)).
        let textbook = core::f64::consts::SQRT_2 * PI * 1e-6 * (8.0 / PI).sqrt();
        assert!((gas.collision_rate() / textbook - 1.0).abs() < 1e-5);
    }

    #[test]
    fn dilute_grains_at_a_wall_lack_a_quarter_of_the_surface() {
        let ratio = gas(0.8, 1e-6, 0.3).collision_rate() / gas(0.8, 1e-6, 0.0).collision_rate();
        assert!((ratio - (1.0 - 0.25 * 0.3)).abs() < 1e-6);
    }

    #[test]
    fn the_surface_tension_has_its_slope() {
        let (fraction, step) = (0.2, 1e-5);
        let [below, above] = [fraction - step, fraction + step].map(|f| surface_tension(f).0);
        let slope = surface_tension(fraction).1;
        assert!(((above - below) / (2.0 * step) / slope - 1.0).abs() < 1e-8);
    }

    /// Pairs closer than 1 + `shell` in a mean configuration of hard spheres whose centres are in a cylinder of period `length`.
    fn close_pairs(grains: usize, radius: f64, length: f64, shell: f64, sweeps: usize) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut uniform = move || (random.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        let squared = |one: DVec3, other: DVec3| {
            let mut apart = one - other;
            apart.z -= length * (apart.z / length).round();
            apart.length_squared()
        };
        let has_room = |places: &[DVec3], i: usize, place: DVec3| {
            place.x * place.x + place.y * place.y < radius * radius
                && (0..places.len()).all(|j| j == i || squared(place, places[j]) > 1.0)
        };
        let mut step = || DVec3::new(uniform(), uniform(), uniform()) * 2.0 - DVec3::ONE;
        let size = DVec3::new(radius, radius, 0.5 * length);
        let mut places: Vec<DVec3> = Vec::new();
        while places.len() < grains {
            let place = step() * size;
            if has_room(&places, grains, place) {
                places.push(place);
            }
        }
        let mut pairs = 0;
        for sweep in 0..sweeps {
            for i in 0..grains {
                // Nearby and anywhere.
                for place in [places[i] + step(), step() * size] {
                    if has_room(&places, i, place) {
                        places[i] = place;
                    }
                }
            }
            if sweep >= sweeps / 10 {
                for i in 0..grains {
                    let close =
                        |other: &&DVec3| squared(places[i], **other) < (1.0 + shell).powi(2);
                    pairs += places[..i].iter().filter(close).count();
                }
            }
        }
        pairs as f64 / (sweeps - sweeps / 10) as f64
    }

    #[test]
    fn hard_spheres_in_a_cylinder_touch_as_often_as_they_collide() {
        let (grains, radius, length, shell): (usize, f64, f64, f64) = (80, 4.0, 8.0, 0.04);
        let density = grains as f64 / (PI * radius * radius * length);
        let gas = gas(1.0, density, 2.0 / radius);
        // Pairs in a shell of width s: N n 4 pi d^2 s/2 times what the rate has besides 4 sqrt(pi) n d^2.
        let contact_value = gas.collision_rate() / (4.0 * PI.sqrt() * density);
        let volume = 4.0 / 3.0 * PI * ((1.0 + shell).powi(3) - 1.0);
        let expected = 0.5 * grains as f64 * density * volume * contact_value;
        let found = close_pairs(grains, radius, length, shell, 4000);
        assert!((found / expected - 1.0).abs() < 0.02);
        // With the wall's part of a dilute gas this would be far off.
        let bulk = CoolingGas {
            surface: 0.0,
            ..gas
        };
        let dilute = bulk.collision_rate() * (1.0 - 0.5 / radius) / gas.collision_rate();
        assert!(dilute > 1.08, "the test could not tell them apart");
    }

    #[test]
    fn soft_grains_lose_less() {
        // Impacts of a gas: v_n with v_n exp(-v_n^2/(4 T)), both v_t normal with 2 T; here (v_n^2, v_t^2)/(4 T) = -ln u.
        const PLACES: usize = 24;
        let law = LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: 0.15,
        };
        let restitution = law.restitution(0.5);
        let temperature = 1e-6;
        let loss = |normal: f64, tangential: f64| {
            let half = 0.5 * DVec3::new(-normal, tangential, 0.0);
            let impact = Impact::between(frictionless(Normal::Linear(law)), half, -half);
            let [one, other] = outcome(&impact).velocity;
            4.0 * half.length_squared() - (one - other).length_squared()
        };
        let speed = |place: usize| {
            let u = (place as f64 + 0.5) / PLACES as f64;
            (-4.0 * temperature * libm::log(u)).sqrt()
        };
        let (mut turning, mut straight) = (0.0, 0.0);
        for i in 0..PLACES {
            straight += PLACES as f64 * loss(speed(i), 0.0);
            turning += (0..PLACES).map(|j| loss(speed(i), speed(j))).sum::<f64>();
        }
        let expected = gas(restitution, 0.1, 0.0).softness() * temperature.sqrt();
        let found = (1.0 - turning / straight) / law.contact_time(0.5);
        assert!((found / expected - 1.0).abs() < 0.01);
    }
}
