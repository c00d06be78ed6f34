//! Whether samples find the wall's spheres at enough places of the wave.

use peristalsis_configuration::{Configuration, ScheduledParameter};
use peristalsis_physics::wall::Arrangement;

use super::warning::Warning;
use crate::recorder::greatest_common_divisor;

/// Places of rings in a bin that are enough.
const ENOUGH_PLACES_IN_A_BIN: u64 = 4;

/// That all samples of a wave find the rings of the wall at fewer places in its frame than the profiles have bins. Grains touch
/// the wall at its rings only: a bin without one stays empty.
///
/// Mean difference of a bin's pressure from that of its neighbours over the mean pressure, in a tube of 20 rings with
/// friction and 50 bins: 1.02 at 20 places, 0.59 at 40; 0.19 at 60, and 0.13 to 0.21 from 100 on, which is that of the
/// profile. At 80, where bins have one place or two, it was 0.44 there, but no more than usual on the lattice of the preset
/// `frictionless-source`.
pub(super) fn warning(configuration: &Configuration) -> Option<Warning> {
    let (tube, observe) = (&configuration.tube, &configuration.observe);
    let is_in_rings = matches!(
        tube.arrangement,
        Arrangement::Staggered | Arrangement::Aligned
    );
    let is_led = configuration.drive.schedule(ScheduledParameter::StrainRate);
    let (rings, samples) = (tube.rings_per_wave, observe.samples_per_period);
    let (places, bins) = (places(rings, samples), observe.profile_bins);
    if !is_in_rings
        || is_led.is_some()
        || configuration.drive.period().is_none()
        || places >= u64::from(bins)
    {
        return None;
    }
    let message = format!(
        "{samples} samples a period find the {rings} rings of a wave at {places} places in its frame, and the profiles of \
         wall pressure, shear and wear have {bins} bins: some of them are empty or uneven; take \
         observe.samples_per_period = {}",
        samples_that_meet(rings, bins, samples)
    );
    let key = "observe.samples_per_period";
    Some(Warning { key, message })
}

/// The least number of samples a period, from `least` on, that find rings of a wall at enough places of a wave for so many
/// bins of a profile.
pub fn samples_that_meet(rings_per_wave: u32, profile_bins: u32, least: u32) -> u32 {
    let enough = ENOUGH_PLACES_IN_A_BIN * u64::from(profile_bins);
    let mut samples = least..;
    let found = samples.find(|samples| places(rings_per_wave, *samples) >= enough);
    found.unwrap_or(least)
}

/// Places in the frame of the wave at which samples find rings: the least common multiple of both numbers.
fn places(rings_per_wave: u32, samples_per_period: u32) -> u64 {
    let [rings, samples] = [rings_per_wave, samples_per_period].map(|it| u64::from(it).max(1));
    rings / greatest_common_divisor(rings, samples) * samples
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::PRESETS;

    use super::*;

    fn preset(name: &str, settings: &[&str]) -> Option<String> {
        let configuration = Configuration::from_preset(name, settings).unwrap();
        warning(&configuration).map(|warning| warning.message)
    }

    #[test]
    fn rings_that_samples_find_at_the_same_places_are_warned_of() {
        for rings in [20, 40] {
            let rings = format!("tube.rings_per_wave={rings}");
            let message = preset("frictionless", &[&rings]).unwrap();
            assert!(
                message.ends_with("observe.samples_per_period = 21"),
                "{message}"
            );
            for other in [
                "observe.samples_per_period=21",
                "observe.profile_bins=10",
                "tube.arrangement=\"random\"",
            ] {
                assert_eq!(preset("frictionless", &[&rings, other]), None, "{other}");
            }
        }
        for known in PRESETS {
            assert_eq!(preset(known.name, &[]), None, "{}", known.name);
        }
    }

    #[test]
    fn places_are_the_least_common_multiple() {
        assert_eq!(
            [places(20, 20), places(42, 20), places(16, 20)],
            [20, 420, 80]
        );
        assert_eq!(samples_that_meet(20, 50, 20), 21);
        assert_eq!(samples_that_meet(42, 50, 20), 20);
        // 24 and 20 share 4, 24 and 21 share 3, 24 and 22 share 2.
        assert_eq!(samples_that_meet(24, 50, 20), 22);
    }
}
