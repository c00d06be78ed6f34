//! The flow where the tube is narrowest and where it is widest.

use peristalsis_observe::ProfileBin;

/// Part of a wavelength that throat and belly each take, to whole bins: the middle one and a tenth of them on either side.
const PART: f64 = 0.2;
/// Part of the range of radii within which they are the same: above rounding, and below what parts a sine's bins.
const SAME: f64 = 1e-10;
/// Bins of the same radius that make a flat stretch: a sine's extreme may lie between two.
const FLAT: usize = 3;

/// The flow in a part of the tube that travels with the wave: late means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalFlow {
    /// Grains per length of tube \[1/d\].
    pub(super) density: f64,
    /// Mean axial velocity of a grain there along the wave, laboratory frame \[d/t\].
    pub(super) axial_velocity: f64,
    /// Granular temperature, mean over the grains there \[m d^2/t^2\].
    pub(super) granular_temperature: f64,
}

impl LocalFlow {
    /// About a fifth of the wavelength about the bin in which the tube is narrowest, or the middle of a flat throat.
    pub(super) fn throat(profile: &[ProfileBin]) -> Self {
        Self::about(profile, |bin| -bin.radius)
    }

    /// About a fifth of the wavelength about the bin in which the tube is widest, or the middle of a flat belly.
    pub(super) fn belly(profile: &[ProfileBin]) -> Self {
        Self::about(profile, |bin| bin.radius)
    }

    fn about(profile: &[ProfileBin], most: impl Fn(&ProfileBin) -> f64) -> Self {
        let bins = profile.len();
        let extreme = (0..bins)
            .filter(|&bin| profile[bin].is_in_tube())
            .max_by(|&one, &other| most(&profile[one]).total_cmp(&most(&profile[other])))
            .unwrap_or(0);
        let middle = middle_of_flat(profile, extreme).unwrap_or(extreme);
        let reach = (0.5 * PART * bins as f64) as usize;
        let near: Vec<&ProfileBin> = (0..2 * reach + 1)
            .filter_map(|step| profile.get((middle + bins + step - reach) % bins))
            .filter(|bin| bin.is_in_tube())
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

/// The bin in the middle of the stretch about `extreme` over which the radius is the same; `None` where it is not flat, or
/// flat all along.
fn middle_of_flat(profile: &[ProfileBin], extreme: usize) -> Option<usize> {
    let bins = profile.len();
    let radii = || profile.iter().map(|bin| bin.radius);
    let range = radii().fold(f64::NEG_INFINITY, f64::max) - radii().fold(f64::INFINITY, f64::min);
    let is_same =
        |bin: usize| (profile[bin % bins].radius - profile[extreme].radius).abs() <= SAME * range;
    let before = (1..bins)
        .take_while(|step| is_same(extreme + bins - step))
        .count();
    let after = (1..bins).take_while(|step| is_same(extreme + step)).count();
    let width = before + after + 1;
    (FLAT..bins)
        .contains(&width)
        .then(|| (extreme + bins - before + width / 2) % bins)
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::*;
    use crate::run::Run;
    use crate::tables::late_profile;

    /// Ten bins, narrowest in the last, so that the throat reaches over the end of the wavelength.
    fn profile() -> Vec<ProfileBin> {
        (0..10)
            .map(|bin| {
                let place = f64::from((bin + 1) % 10);
                ProfileBin {
                    position: 0.1 * (f64::from(bin) + 0.5),
                    density: (place, 0.0),
                    axial_velocity: (if place > 0.0 { place } else { f64::NAN }, 0.0),
                    temperature: (if place > 0.0 { 10.0 * place } else { f64::NAN }, 0.0),
                    radius: 1.0 - 0.1 * (place - 5.0).abs(),
                    ..ProfileBin::default()
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

    #[test]
    fn a_flat_belly_is_looked_at_in_its_middle() {
        let of = |radius: &dyn Fn(usize) -> f64| {
            let mut profile = profile();
            for (place, bin) in profile.iter_mut().enumerate() {
                bin.radius = radius(place);
                bin.density.0 = place as f64;
            }
            profile
        };
        // Widest in the bins 7, 8, 9, 0 and 1, to rounding: the middle is 9, with 8 and 0 beside it.
        let flat = of(&|place| {
            let slope = [2.0, 1.5, 1.0, 1.2, 1.5];
            let steep = place.wrapping_sub(2);
            slope.get(steep).copied().unwrap_or(2.5) + 1e-15 * place as f64
        });
        let belly = LocalFlow::belly(&flat);
        assert!((belly.density - (8.0 + 9.0 + 0.0) / 3.0).abs() < 1e-12);
        // The throat is a single bin, number 4.
        assert_eq!(LocalFlow::throat(&flat).density, 4.0);
        // Two equal bins are no stretch, nor is a straight tube: the last of the equal ones, as before.
        let pair = of(&|place| {
            if place == 3 || place == 4 {
                2.0
            } else {
                1.0 + 0.01 * place as f64
            }
        });
        assert_eq!(LocalFlow::belly(&pair).density, 4.0);
        let straight = of(&|_| 1.5);
        assert!((LocalFlow::belly(&straight).density - (8.0 + 9.0 + 0.0) / 3.0).abs() < 1e-12);
    }

    #[test]
    fn only_waveforms_that_are_straight_in_between_have_a_flat_belly() {
        for (preset, waveform, middle) in [
            ("frictionless", "bolus", Some(0.75)),
            ("frictionless", "roller", Some(0.75)),
            ("frictionless", "sine", None),
            ("frictional", "roller", None),
        ] {
            let settings = [
                &format!("drive.waveform={waveform}"),
                "grains.number=20",
                "tube.waves=2",
                "run.periods=0.2",
            ];
            let configuration = Configuration::from_preset(preset, &settings).unwrap();
            let mut run = Run::new(configuration).unwrap();
            while !run.is_complete() {
                run.advance().unwrap();
            }
            let profile = late_profile(&run);
            let flat = |sign: f64| {
                let radius = |bin: &usize| sign * profile[*bin].radius;
                let extreme = (0..profile.len())
                    .max_by(|one, other| radius(one).total_cmp(&radius(other)))
                    .unwrap();
                middle_of_flat(&profile, extreme).map(|bin| profile[bin].position)
            };
            let far = |place: f64| (place - middle.unwrap_or(f64::NAN)).abs();
            match flat(1.0) {
                Some(place) => assert!(far(place) <= 0.02, "{waveform}: {place}"),
                None => assert_eq!(middle, None, "{preset} {waveform}"),
            }
            assert_eq!(flat(-1.0), None, "no throat is flat: {preset} {waveform}");
        }
    }
}
