//! How the grains lay in the late part of a run: mixed, and segregated by size.

use peristalsis_observe::{Mixing, Sample, Segregation};

use super::late::error_of;

/// M from which on grains count as mixed by half.
const MIXED: f64 = 0.5;

/// Mixing of the grains by where they began: late means of M, each with its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedGrains {
    /// Along the tube, [`Mixing::axial`]; `None` where no period ends so late, or one had no index.
    pub axial: Option<(f64, f64)>,
    /// Across it, [`Mixing::radial`]; `None` as before.
    pub radial: Option<(f64, f64)>,
    /// End of the first period in which M along the tube reaches 1/2 \[t\].
    pub axial_time: Option<f64>,
    /// End of the first period in which M across it reaches 1/2 \[t\].
    pub radial_time: Option<f64>,
}

impl MixedGrains {
    /// From all samples of a run and the [ends of its late periods](ends_of_periods).
    pub(super) fn of(samples: &[Sample], ends: &[Sample]) -> Self {
        let measured =
            |of: fn(&Mixing) -> f64| measured(ends, |sample| sample.mixing.as_ref().map(of));
        let time = |of: fn(&Mixing) -> f64| {
            let mixed = samples
                .iter()
                .find(|sample| sample.mixing.as_ref().is_some_and(|it| of(it) >= MIXED));
            mixed.map(|sample| sample.time)
        };
        Self {
            axial: measured(|it| it.axial),
            radial: measured(|it| it.radial),
            axial_time: time(|it| it.axial),
            radial_time: time(|it| it.radial),
        }
    }
}

/// Segregation of grains of several sizes: late means of correlations, each with its error; `None` where it is not defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegregatedSizes {
    /// With the distance from the axis, [`Segregation::radial`].
    pub radial: Option<(f64, f64)>,
    /// With the height, [`Segregation::height`].
    pub height: Option<(f64, f64)>,
    /// With the radius of the tube, [`Segregation::belly`].
    pub belly: Option<(f64, f64)>,
}

impl SegregatedSizes {
    /// From the [ends of the late periods](ends_of_periods) of a run.
    pub(super) fn of(ends: &[Sample]) -> Self {
        let measured =
            |of: fn(&Segregation) -> Option<f64>| measured(ends, |sample| of(&sample.segregation));
        Self {
            radial: measured(|it| it.radial),
            height: measured(|it| it.height),
            belly: measured(|it| it.belly),
        }
    }
}

/// The late samples that end a period of `each` samples, the last one first; none where none does. What is measured at the end
/// of a period is repeated by all samples up to the next, and the first period repeats how the grains began.
pub(super) fn ends_of_periods(samples: &[Sample], late: &[Sample], each: usize) -> Vec<Sample> {
    let since = samples.len() % each;
    let ends = late.iter().rev().skip(since).step_by(each);
    ends.copied().collect()
}

/// Mean and error of a number that is measured at the end of each period; `None` where one of the numbers is missing, or all.
fn measured(ends: &[Sample], value: impl Fn(&Sample) -> Option<f64>) -> Option<(f64, f64)> {
    let values: Option<Vec<f64>> = ends.iter().map(value).collect();
    let values = values.filter(|it| !it.is_empty())?;
    Some((super::mean(&values), error_of(values.into_iter())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_are_mixed_by_half_from_the_first_period_on_that_reaches_it() {
        let sample = |step: u32| Sample {
            time: f64::from(step),
            mixing: Some(Mixing {
                axial: 0.1 * f64::from(step),
                radial: 0.01 * f64::from(step),
            }),
            ..Sample::default()
        };
        let samples: Vec<Sample> = (0..40).map(sample).collect();
        let of = |late: &[Sample], each| {
            MixedGrains::of(&samples, &ends_of_periods(&samples, late, each))
        };
        let is_near = |found: Option<(f64, f64)>, value: f64| {
            assert!((found.unwrap().0 - value).abs() < 1e-12, "{found:?}");
        };
        let found = of(&samples[20..], 1);
        assert_eq!((found.axial_time, found.radial_time), (Some(5.0), None));
        is_near(found.axial, 2.95);
        is_near(found.radial, 0.295);
        // Of two samples a period the last ones: steps 21, 23, ... 39.
        is_near(of(&samples[20..], 2).axial, 3.0);
        // Of nine a period the last whole ones, which end at steps 26 and 35; what the next ones repeat is not theirs.
        is_near(of(&samples[20..], 9).axial, 3.05);
        // A run shorter than a period, or whose late part is: how the grains began is no result.
        // But when half were mixed is known.
        for (samples, late) in [(&samples[..8], 4), (&samples[..], 3)] {
            let ends = ends_of_periods(samples, &samples[samples.len() - late..], 9);
            let found = MixedGrains::of(samples, &ends);
            assert_eq!((found.axial, found.axial_time), (None, Some(5.0)));
        }
        // An open tube has no index, grains of one size no segregation.
        let open = [Sample::default(); 3];
        let found = MixedGrains::of(&open, &open);
        assert_eq!((found.axial, found.axial_time), (None, None));
        assert_eq!(SegregatedSizes::of(&open).height, None);
    }
}
