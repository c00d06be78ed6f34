//! The flow where the tube is narrowest and where it is widest.

use peristalsis_observe::ProfileBin;

/// Part of a wavelength that throat and belly each take.
const PART: f64 = 0.2;

/// The flow in a part of the tube that travels with the wave: late means.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LocalFlow {
    /// Grains per length of tube \[1/d\].
    pub density: f64,
    /// Mean axial velocity of a grain there along the wave, laboratory frame \[d/t\].
    pub axial_velocity: f64,
    /// Granular temperature, mean over the grains there \[m d^2/t^2\].
    pub granular_temperature: f64,
}

impl LocalFlow {
    /// The fifth of the wavelength about the bin in which the tube is narrowest.
    pub(crate) fn throat(profile: &[ProfileBin]) -> Self {
        Self::about(profile, |bin| -bin.radius)
    }

    /// The fifth of the wavelength about the bin in which the tube is widest.
    pub(crate) fn belly(profile: &[ProfileBin]) -> Self {
        Self::about(profile, |bin| bin.radius)
    }

    fn about(profile: &[ProfileBin], most: impl Fn(&ProfileBin) -> f64) -> Self {
        let bins = profile.len();
        let middle = (0..bins)
            .max_by(|&one, &other| most(&profile[one]).total_cmp(&most(&profile[other])))
            .unwrap_or(0);
        let reach = (0.5 * PART * bins as f64) as usize;
        let near: Vec<&ProfileBin> = (0..2 * reach + 1)
            .filter_map(|step| profile.get((middle + bins + step - reach) % bins))
            .collect();
        let grains: f64 = near.iter().map(|bin| bin.density.0).sum();
        let over_grains = |value: fn(&ProfileBin) -> f64| {
            // A bin without grains has no velocity.
            let sum: f64 = near
                .iter()
                .filter(|bin| bin.density.0 > 0.0)
                .map(|bin| bin.density.0 * value(bin))
                .sum();
            sum / grains
        };
        Self {
            density: grains / near.len() as f64,
            axial_velocity: over_grains(|bin| bin.axial_velocity.0),
            granular_temperature: over_grains(|bin| bin.temperature.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten bins, narrowest in the last, so that the throat reaches over the end of the wavelength.
    fn profile() -> Vec<ProfileBin> {
        let none = (f64::NAN, f64::NAN);
        (0..10)
            .map(|bin| {
                let place = f64::from((bin + 1) % 10);
                ProfileBin {
                    position: 0.1 * (f64::from(bin) + 0.5),
                    density: (place, 0.0),
                    axial_velocity: (if place > 0.0 { place } else { f64::NAN }, 0.0),
                    temperature: (if place > 0.0 { 10.0 * place } else { f64::NAN }, 0.0),
                    radius: 1.0 - 0.1 * (place - 5.0).abs(),
                    least_radius: 1.0,
                    largest_radius: 1.0,
                    wall_normal_force: none,
                    wall_tangential_force: none,
                    wall_pressure: none,
                    wall_shear: none,
                    wall_axial_velocity: none,
                }
            })
            .collect()
    }

    #[test]
    fn throat_and_belly_are_means_over_their_grains() {
        let profile = profile();
        // Densities 9, 0 and 1, the one without grains between them.
        let throat = LocalFlow::throat(&profile);
        assert!((throat.density - 10.0 / 3.0).abs() < 1e-12);
        assert!((throat.axial_velocity - 8.2).abs() < 1e-12);
        assert!((throat.granular_temperature - 82.0).abs() < 1e-12);
        // Densities 4, 5 and 6.
        let belly = LocalFlow::belly(&profile);
        assert!((belly.density - 5.0).abs() < 1e-12);
        assert!((belly.axial_velocity - 77.0 / 15.0).abs() < 1e-12);
    }
}
