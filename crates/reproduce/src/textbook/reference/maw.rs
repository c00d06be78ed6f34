//! Oblique impact of an elastic sphere on a rigid plane with the friction of Mindlin's contact.

/// A sphere of mass 1 and radius 1 that hits a rigid plane, in units in which the Hertz force is (4/3) xi^(3/2).
///
/// The problem of Maw, Barber & Fawcett, Wear 38, 101 (1976), solved as a row of springs side by side (Lyashenko & Popov,
/// Sci. Rep. 5, 8479 (2015)): spring x of the foundation is compressed by xi - x^2/R and displaced sideways with the surface
/// until its own force reaches mu times its own pressure. This is exact for normal and tangential forces of bodies without
/// coupling between the two, so that parts of the contact stick while others slip. The ratio of the moduli is G\*/E\* =
/// 2 (1 - nu)/(2 - nu).
#[derive(Clone, Copy, Debug)]
pub(crate) struct MindlinImpact {
    /// nu
    pub(crate) poisson_ratio: f64,
    /// mu
    pub(crate) friction: f64,
    /// v_n before, positive; small, so that the overlap is.
    pub(crate) normal_speed: f64,
    /// Tangential velocity of the contact before, over v_n.
    pub(crate) slip_ratio: f64,
}

/// Springs on one side of the middle; pressures are symmetric.
const SPRINGS: usize = 200;
/// Steps of an impact.
const STEPS: usize = 3000;

impl MindlinImpact {
    /// Tangential impulse over mu times the normal impulse 2 m v_n, from 0 to 1: 1 where the contact slides throughout.
    pub(crate) fn impulse_ratio(&self) -> f64 {
        let ratio = 2.0 * (1.0 - self.poisson_ratio) / (2.0 - self.poisson_ratio);
        let speed = self.normal_speed;
        let largest = libm::pow(1.25 * 0.75 * speed * speed, 0.4);
        let time_step = 2.944 * largest / speed / STEPS as f64;
        let spacing = (1.02 * largest).sqrt() / SPRINGS as f64;
        let mut displacement = [0.0; SPRINGS];
        let (mut overlap, mut velocity, mut slip) = (0.0, speed, self.slip_ratio * speed);
        let mut impulse = 0.0;
        let hertz = |overlap: f64| 4.0 / 3.0 * libm::pow(overlap.max(0.0), 1.5);
        let mut force = 0.0;
        loop {
            velocity -= 0.5 * time_step * force;
            overlap += time_step * velocity;
            if overlap <= 0.0 {
                return impulse / (self.friction * 2.0 * speed);
            }
            force = hertz(overlap);
            velocity -= 0.5 * time_step * force;
            let mut lateral = 0.0;
            for (spring, u) in displacement.iter_mut().enumerate() {
                let x = (spring as f64 + 0.5) * spacing;
                let compression = overlap - x * x;
                if compression <= 0.0 {
                    *u = 0.0;
                    continue;
                }
                let bound = self.friction * compression / ratio;
                *u = (*u + slip * time_step).clamp(-bound, bound);
                lateral += 2.0 * ratio * *u * spacing;
            }
            impulse += lateral * time_step;
            // 1/m + R^2/I = 7/2 for a solid sphere.
            slip -= 3.5 * lateral * time_step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(slip_ratio: f64) -> f64 {
        MindlinImpact {
            poisson_ratio: 0.3,
            friction: 0.1,
            normal_speed: 1e-3,
            slip_ratio,
        }
        .impulse_ratio()
    }

    /// Sliding throughout begins where the non-dimensional angle psi = 2 (1 - nu)/(mu (2 - nu)) tan is 4 chi - 1, chi = (7/2)
    /// (1 - nu)/(2 - nu) (Maw et al. 1976).
    #[test]
    fn a_grazing_impact_slides_throughout_and_a_steep_one_does_not() {
        let chi = 3.5 * 0.7 / 1.7;
        let limit = (4.0 * chi - 1.0) * 0.1 * 1.7 / 1.4;
        let [beyond, within] = [1.05 * limit, 0.9 * limit].map(ratio);
        assert!((beyond - 1.0).abs() < 3e-3, "{beyond}");
        assert!(within < 0.99, "{within}");
        // The slip after the impact over the slip before: impacts next to the normal stop their surface almost, oblique ones
        // turn it back (Maw et al. 1976).
        let left = |slip_ratio: f64| 1.0 - 3.5 * 2.0 * 0.1 * ratio(slip_ratio) / slip_ratio;
        let of_angle = |psi: f64| psi * 0.1 * 1.7 / 1.4;
        let [steep, oblique] = [0.2, 2.5].map(|psi| left(of_angle(psi)));
        assert!((0.0..0.4).contains(&steep), "{steep}");
        assert!(oblique < -0.05, "{oblique}");
    }
}
