//! Hartigans' dip: how far a sample is from having a single peak.

use crate::bootstrap::Bootstrap;
use crate::error::{Error, checked};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest values: below this nothing can be told from one peak.
const LEAST_VALUES: usize = 4;

/// The dip of a sample with its significance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DipTest {
    /// Largest distance of the empirical distribution from the nearest one with a single peak: 1/(2n) at least, 1/4 at
    /// most (two equal atoms).
    pub dip: f64,
    /// Probability of a dip at least as large in as many uniform numbers, the single-peaked case that is hardest to
    /// tell.
    pub probability: f64,
    /// Simulated samples behind it.
    pub simulations: usize,
}

/// A distinct value with the number of sample values below it, and up to it.
#[derive(Clone, Copy)]
struct Place {
    value: f64,
    below: f64,
    up_to: f64,
}

/// Tests a sample of independent values for more than one peak, without assuming the form of the peaks.
///
/// `dip = min_F sup_x |F_n(x) - F(x)|` over distributions F that are convex up to a mode and concave beyond
///
/// found from the greatest convex minorant and the least concave majorant of F_n on a shrinking modal interval. The
/// probability is (1 + number of simulated dips as large)/(1 + simulations); it is exact for a uniform distribution and
/// too large for others, so that a small one is safe; but values that are rounded to a tenth of their range look like several
/// peaks. Give one value per run: values of one series are not independent.
/// Source: Hartigan & Hartigan, Ann. Stat. 13, 70 (1985), sections 3 and 5.
///
/// # Errors
/// [`Error::TooFew`] below 4 values, [`Error::NonFinite`], [`Error::TooFewResamples`].
///
/// ```
/// use peristalsis_analysis::{Bootstrap, dip_test};
/// let simulations = Bootstrap::new(200, 1);
/// let found = dip_test(&[0.1, 0.1, 0.1, 0.9, 0.9, 0.9], simulations)?;
/// assert!((found.dip - 0.25).abs() < 1e-12);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn dip_test(values: &[f64], simulations: Bootstrap) -> Result<DipTest, Error> {
    let mut sample = checked(values, LEAST_VALUES)?.to_vec();
    let dip = dip(&mut sample);
    let mut as_large = 0_usize;
    for mut randomness in simulations.streams()? {
        let mut uniform: Vec<f64> = values.iter().map(|_| randomness.uniform()).collect();
        as_large += usize::from(self::dip(&mut uniform) >= dip);
    }
    Ok(DipTest {
        dip,
        probability: (as_large + 1) as f64 / (simulations.resamples + 1) as f64,
        simulations: simulations.resamples,
    })
}

/// The dip of a sample, which is sorted on the way.
fn dip(sample: &mut [f64]) -> f64 {
    sample.sort_by(f64::total_cmp);
    let mut places: Vec<Place> = Vec::with_capacity(sample.len());
    for (index, &value) in sample.iter().enumerate() {
        match places.last_mut() {
            Some(place) if place.value == value => place.up_to += 1.0,
            _ => places.push(Place {
                value,
                below: index as f64,
                up_to: (index + 1) as f64,
            }),
        }
    }
    let (mut first, mut last) = (0, places.len() - 1);
    // In counts, and twice the dip: a step of F_n is missed by half of its height at least.
    let mut doubled = 1.0_f64;
    while first < last {
        let minorant = hull(&places, first, last, |place| place.below, 1.0);
        let majorant = hull(&places, first, last, |place| place.up_to, -1.0);
        let below = on_chords(&places, &minorant, |place| place.below);
        let above = on_chords(&places, &majorant, |place| place.up_to);
        let gap = |index: usize| above[index - first] - below[index - first];
        let (widest, mode_first, mode_last) = widest_gap(gap, &minorant, &majorant);
        if widest <= doubled {
            break;
        }
        for index in first..mode_first {
            doubled = doubled.max(places[index].up_to - below[index - first]);
        }
        for index in mode_last + 1..=last {
            doubled = doubled.max(above[index - first] - places[index].below);
        }
        (first, last) = (mode_first, mode_last);
    }
    0.5 * doubled / sample.len() as f64
}

/// Corners of the greatest convex minorant (`side` 1) or least concave majorant (`side` -1) of a height over the
/// places.
fn hull(
    places: &[Place],
    first: usize,
    last: usize,
    height: impl Fn(&Place) -> f64,
    side: f64,
) -> Vec<usize> {
    let mut corners: Vec<usize> = Vec::new();
    for index in first..=last {
        while let [.., before, corner] = corners[..] {
            let [a, b, c] = [before, corner, index].map(|k| (places[k].value, height(&places[k])));
            let turn = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
            if side * turn > 0.0 {
                break;
            }
            corners.pop();
        }
        corners.push(index);
    }
    corners
}

/// Heights of the chords between corners at all places from the first corner to the last.
fn on_chords(places: &[Place], corners: &[usize], height: impl Fn(&Place) -> f64) -> Vec<f64> {
    let mut heights = vec![height(&places[corners[0]])];
    for pair in corners.windows(2) {
        let [start, end] = [pair[0], pair[1]].map(|k| (places[k].value, height(&places[k])));
        for place in &places[pair[0] + 1..=pair[1]] {
            let fraction = (place.value - start.0) / (end.0 - start.0);
            heights.push(start.1 + fraction * (end.1 - start.1));
        }
    }
    heights
}

/// Largest distance between minorant and majorant, with the modal interval that it leaves.
fn widest_gap(
    gap: impl Fn(usize) -> f64,
    minorant: &[usize],
    majorant: &[usize],
) -> (f64, usize, usize) {
    let mut widest = (f64::NEG_INFINITY, minorant[0], minorant[0]);
    for &index in minorant {
        if gap(index) > widest.0 {
            let next = majorant[majorant.partition_point(|&corner| corner < index)];
            widest = (gap(index), index, next);
        }
    }
    for &index in majorant {
        if gap(index) > widest.0 {
            let before = minorant[minorant.partition_point(|&corner| corner <= index) - 1];
            widest = (gap(index), before, index);
        }
    }
    widest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::{assert_coverage, white_noise};
    use proptest::prelude::*;

    fn of(values: &[f64]) -> f64 {
        dip(&mut values.to_vec())
    }

    #[test]
    fn dips_that_can_be_reckoned_by_hand() {
        // Evenly spaced: half a step.
        let even: Vec<f64> = (0..10).map(f64::from).collect();
        assert!((of(&even) - 0.05).abs() < 1e-15);
        assert!((of(&[3.0; 7]) - 1.0 / 14.0).abs() < 1e-15);
        // Two atoms of weights p and 1 - p: min(p, 1 - p)/2.
        assert!((of(&[0.0, 1.0, 1.0, 1.0]) - 0.125).abs() < 1e-15);
    }

    #[test]
    fn dips_as_another_program_has_them() {
        // diptest 0.10 (Python).
        let three_groups = [1.0, 2.0, 3.0, 4.0, 10.0, 11.0, 12.0, 13.5, 30.0];
        assert!((of(&three_groups) - 0.140_350_877_192_982_45).abs() < 1e-14);
        let expected = [
            (30, 101, 0.096_969_696_969_696_97),
            (50, 211, 0.0375),
            // Ties.
            (25, 7, 0.108),
            (80, 13, 0.1),
            (200, 5003, 0.021_727_111_897_390_53),
        ];
        for (count, modulus, expected) in expected {
            let scattered: Vec<f64> = (0..count)
                .map(|k| {
                    let place = f64::from((k * k * 37 + 11 * k) % modulus);
                    place
                        + if k % 3 == 0 {
                            0.8 * f64::from(modulus)
                        } else {
                            0.0
                        }
                })
                .collect();
            assert!((of(&scattered) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn one_peak_is_rarely_rejected_and_two_are() {
        let simulations = Bootstrap::new(99, 4);
        let trials = 200;
        let (mut uniform_rejected, mut normal_rejected, mut double_rejected) = (0, 0, 0);
        for seed in 0..trials {
            let mut randomness = Randomness::new(seed, 2);
            let uniform: Vec<f64> = (0..40).map(|_| randomness.uniform()).collect();
            let normal = white_noise(seed, 40);
            let double: Vec<f64> = normal
                .iter()
                .enumerate()
                .map(|(k, noise)| noise + if k % 3 == 0 { 6.0 } else { 0.0 })
                .collect();
            let rejected = |sample: &[f64]| {
                usize::from(dip_test(sample, simulations).unwrap().probability <= 0.1)
            };
            uniform_rejected += rejected(&uniform);
            normal_rejected += rejected(&normal);
            double_rejected += rejected(&double);
        }
        assert_coverage(uniform_rejected, trials as usize, 0.1, 0.02, "uniform");
        assert!(normal_rejected < 10);
        assert!(double_rejected > 170, "{double_rejected}");
    }

    #[test]
    fn too_few_values_are_refused() {
        let simulations = Bootstrap::new(50, 0);
        assert_refused!(dip_test(&[1.0, 2.0, 3.0], simulations) => TooFew { needed: 4, .. });
    }

    proptest! {
        #[test]
        fn the_dip_lies_in_its_range_and_ignores_scale_and_reflection(
            values in prop::collection::vec((-20_i32..20).prop_map(f64::from), 4..40),
        ) {
            let dip = of(&values);
            prop_assert!(dip >= 0.5 / values.len() as f64 && dip <= 0.25);
            let moved: Vec<f64> = values.iter().map(|x| 4.0 * x - 8.0).collect();
            prop_assert!((of(&moved) - dip).abs() < 1e-12);
            let mirrored: Vec<f64> = values.iter().map(|x| -x).collect();
            prop_assert!((of(&mirrored) - dip).abs() < 1e-12);
        }
    }
}
