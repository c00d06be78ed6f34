//! The two branches of the stationary flow and the jump between them.

use peristalsis_analysis::{Interval, Jump, Uncertain, jump_height};

use crate::finding::Statistics;
use crate::runs::{Run, Start};

/// Points of a branch that are continued to the jump by a straight line.
const CONTINUED: usize = 3;
/// A jump counts from this many of its errors on.
const CLEAR: f64 = 4.0;
/// A jump counts from this height on.
const LEAST_JUMP: f64 = 0.1;
/// A fall between two widths counts from this height on, and from so many of its errors on.
const LEAST_FALL: f64 = 0.05;
/// Replicates whose flow rates leave a gap of this height between them have ended in both flows.
const SPLIT: f64 = 0.2;
/// Grains are looked for outside the tube at widths within this distance of the fall \[d\].
const NEAR: f64 = 0.1;

/// The stationary flow at one width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BranchPoint {
    /// w \[d\].
    pub(crate) width: f64,
    /// Mean of J/Jmax over the replicates.
    pub(crate) mean: f64,
    /// Its standard error from their scatter; from the blocks of the one run where there is but one.
    pub(crate) error: f64,
    /// Runs.
    pub(crate) runs: usize,
    /// Fraction of the grains outside, mean.
    pub(crate) escaped: f64,
}

/// The stationary flow against the width, from one start.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Branch {
    /// By ascending width.
    pub(crate) points: Vec<BranchPoint>,
}

/// Where a branch falls most between two neighbouring widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drop {
    /// The width before the fall.
    pub(crate) before: f64,
    /// The width after it.
    pub(crate) after: f64,
    /// J/Jmax before and after.
    pub(crate) ratio: (f64, f64),
}

impl Drop {
    /// The width midway, with the bracket as its interval.
    pub(crate) fn width(&self) -> Uncertain {
        bracket(self.before, self.after)
    }

    /// J/Jmax midway.
    pub(crate) fn threshold(&self) -> f64 {
        0.5 * (self.ratio.0 + self.ratio.1)
    }
}

/// A number of which only two bounds are known: its error is that of a uniform distribution between them, which is the 68 per
/// cent interval as well, so that it reads the same everywhere; the bounds are the 95 per cent interval.
pub(crate) fn bracket(lower: f64, upper: f64) -> Uncertain {
    let (value, error) = (0.5 * (lower + upper), (upper - lower) / 12_f64.sqrt());
    Uncertain {
        value,
        error,
        interval_68: Interval {
            lower: value - error,
            upper: value + error,
        },
        interval_95: Interval { lower, upper },
    }
}

/// Mean and standard error; the error is not a number for a single value.
pub(crate) fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let number = values.len() as f64;
    let mean = values.iter().sum::<f64>() / number;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (number * (number - 1.0))).sqrt())
}

/// Whether replicates ended in two flows.
fn is_split(ratios: &[f64]) -> bool {
    let mut ratios = ratios.to_vec();
    ratios.sort_by(f64::total_cmp);
    ratios.windows(2).any(|pair| pair[1] - pair[0] > SPLIT)
}

/// The runs at one point of a branch that no longer drift.
pub(crate) struct Stationary<'a> {
    pub(crate) runs: Vec<&'a Run>,
    /// Mean of J/Jmax.
    pub(crate) mean: f64,
    /// Its standard error from their scatter; from the blocks of the run where there is but one.
    pub(crate) error: f64,
    /// Fraction of the grains outside, mean.
    pub(crate) escaped: f64,
}

impl<'a> Stationary<'a> {
    /// Of all runs at the point; `None` where none has a flow, or most still drift.
    pub(crate) fn of(all: &[&'a Run]) -> Option<Self> {
        let runs: Vec<&Run> = all
            .iter()
            .copied()
            .filter(|run| run.is_stationary() && run.flow_rate_ratio.is_finite())
            .collect();
        if runs.is_empty() || 2 * runs.len() < all.len() {
            return None;
        }
        let ratios: Vec<f64> = runs.iter().map(|run| run.flow_rate_ratio).collect();
        let (mean, error) = mean_and_error(&ratios);
        let escaped: f64 = runs.iter().map(|run| run.escaped_fraction()).sum();
        Some(Self {
            mean,
            error: if error.is_finite() {
                error
            } else {
                runs[0].flow_rate_ratio_error
            },
            escaped: escaped / runs.len() as f64,
            runs,
        })
    }
}

/// The jump between the points (place, mean, error) next to it on either side, both continued to it as straight lines; `None`
/// where a side is missing.
pub(crate) fn jump_between(
    upper: &[(f64, f64, f64)],
    lower: &[(f64, f64, f64)],
    place: Uncertain,
) -> Option<Jump> {
    let columns = |points: &[(f64, f64, f64)]| -> [Vec<f64>; 3] {
        [
            points.iter().map(|point| point.0).collect(),
            points.iter().map(|point| point.1).collect(),
            points.iter().map(|point| point.2).collect(),
        ]
    };
    let ([x, mean, error], below) = (columns(upper), columns(lower));
    jump_height(
        [&x, &mean, &error],
        [&below[0], &below[1], &below[2]],
        place,
    )
    .ok()
}

impl Branch {
    /// The branch that some runs of one tube at one strain rate show; those that still drift are left out, and with them
    /// widths at which most do. A width at which chance leads some replicates to each of the two flows is on neither
    /// branch, but between them.
    pub(crate) fn of<'a>(runs: impl Iterator<Item = &'a Run>, start: Start) -> Self {
        let mut runs: Vec<&Run> = runs
            .filter(|run| run.start == start && run.flow_rate_ratio.is_finite())
            .collect();
        runs.sort_by(|one, other| one.width.total_cmp(&other.width));
        let points = runs
            .chunk_by(|one, other| one.width == other.width)
            .filter_map(|all| {
                let stationary = Stationary::of(all)?;
                let runs = stationary.runs.iter();
                let ratios: Vec<f64> = runs.map(|run| run.flow_rate_ratio).collect();
                (!is_split(&ratios)).then_some(BranchPoint {
                    width: all[0].width,
                    mean: stationary.mean,
                    error: stationary.error,
                    runs: all.len(),
                    escaped: stationary.escaped,
                })
            })
            .collect();
        Self { points }
    }

    /// Where it falls most steeply of all falls that are clear, or most where none is; `None` with a single width.
    pub(crate) fn drop(&self) -> Option<Drop> {
        let fall = |pair: &[BranchPoint]| pair[0].mean - pair[1].mean;
        let clear = |pair: &[BranchPoint]| {
            let error = pair[0].error.max(0.0).hypot(pair[1].error.max(0.0));
            fall(pair) > LEAST_FALL.max(CLEAR * error)
        };
        let steepness = |pair: &[BranchPoint]| fall(pair) / (pair[1].width - pair[0].width);
        let most = |value: &dyn Fn(&[BranchPoint]) -> f64, pairs: Vec<&'_ [BranchPoint]>| {
            pairs
                .into_iter()
                .max_by(|one, other| value(one).total_cmp(&value(other)))
                .map(|pair| Drop {
                    before: pair[0].width,
                    after: pair[1].width,
                    ratio: (pair[0].mean, pair[1].mean),
                })
        };
        let pairs = || self.points.windows(2);
        most(&steepness, pairs().filter(|pair| clear(pair)).collect())
            .or_else(|| most(&fall, pairs().collect()))
    }

    /// What is behind it, at its one strain rate.
    pub(crate) fn statistics(&self, runs: usize) -> Statistics {
        Statistics {
            strain_rates: 1,
            widths: self.points.len(),
            replicates: self
                .points
                .iter()
                .map(|point| point.runs)
                .min()
                .unwrap_or(0),
            runs,
        }
    }

    /// J/Jmax midway between the two branches at the jump.
    pub(crate) fn threshold(&self) -> Option<f64> {
        let drop = self.drop()?;
        Some(self.jump().map_or(drop.threshold(), |jump| {
            0.5 * (jump.upper.value + jump.lower.value)
        }))
    }

    /// Largest fraction of grains outside at a width next to the fall, over all widths without one.
    pub(crate) fn escaped(&self) -> f64 {
        let middle = self.drop().map(|drop| 0.5 * (drop.before + drop.after));
        self.points
            .iter()
            .filter(|point| middle.is_none_or(|middle| (point.width - middle).abs() <= NEAR))
            .map(|point| point.escaped)
            .fold(0.0, f64::max)
    }

    /// The jump at the largest fall, both sides continued to it as straight lines; `None` where a side is missing.
    pub(crate) fn jump(&self) -> Option<Jump> {
        let drop = self.drop()?;
        let split = self
            .points
            .partition_point(|point| point.width <= drop.before);
        let (below, beyond) = self.points.split_at(split);
        // Replicates that agree to all digits still have an error.
        let side = |points: &[BranchPoint]| -> Vec<(f64, f64, f64)> {
            let points = points.iter();
            points
                .map(|point| (point.width, point.mean, point.error.max(1e-3)))
                .collect()
        };
        jump_between(
            &side(&below[below.len().saturating_sub(CONTINUED)..]),
            &side(&beyond[..beyond.len().min(CONTINUED)]),
            drop.width(),
        )
    }

    /// Whether the fall is a jump: high, and by many of its errors.
    pub(crate) fn jumps(&self) -> bool {
        self.jump().is_some_and(|jump| {
            jump.height.value > LEAST_JUMP && jump.height.value > CLEAR * jump.height.error
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(ratios: &[(f64, f64)]) -> Branch {
        let point = |&(width, mean): &(f64, f64)| BranchPoint {
            width,
            mean,
            error: 0.01,
            runs: 10,
            escaped: 0.0,
        };
        Branch {
            points: ratios.iter().map(point).collect(),
        }
    }

    #[test]
    fn a_step_is_a_jump_and_a_slope_is_none() {
        let step = branch(&[
            (2.5, 1.0),
            (2.6, 0.98),
            (2.7, 0.96),
            (2.72, 0.2),
            (2.8, 0.1),
            (2.9, 0.0),
        ]);
        let drop = step.drop().unwrap();
        assert_eq!((drop.before, drop.after), (2.7, 2.72));
        assert!((drop.threshold() - 0.58).abs() < 1e-12);
        assert!((step.jump().unwrap().height.value - 0.745).abs() < 0.01);
        assert!(step.jumps());
        let slope: Vec<(f64, f64)> = (0..12)
            .map(|k| (2.4 + 0.05 * f64::from(k), 1.0 - 0.09 * f64::from(k)))
            .collect();
        assert!(!branch(&slope).jumps());
    }

    #[test]
    fn replicates_of_both_flows_are_told_from_those_of_one() {
        assert!(is_split(&[0.60, 0.0, 0.01, 0.61]));
        assert!(!is_split(&[0.3, 0.0, 0.15, 0.45, 0.6]), "one that scatters");
        assert!(!is_split(&[0.9]) && !is_split(&[]));
    }

    #[test]
    fn a_bracket_knows_its_ends() {
        let width = bracket(2.7, 2.8);
        assert!((width.value - 2.75).abs() < 1e-12 && width.interval_95.upper == 2.8);
    }
}
