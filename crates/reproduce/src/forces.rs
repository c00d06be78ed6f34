//! The stationary flow of the stress-controlled tube against the force amplitude, from both starts.

use peristalsis_analysis::{Jump, Uncertain};

use crate::branches::{Stationary, bracket, jump_between};
use crate::finding::Statistics;
use crate::runs::{Run, Start};
use crate::text::number;

/// Periods of stationary flow that a run must have behind its late mean to count for a verdict.
pub(crate) const STATIONARY_PERIODS: f64 = 50.0;

/// What a verdict on the stress-controlled tube takes: 3 strain rates, 6 forces at each, 5 replicates from either start, all
/// of them runs with [`STATIONARY_PERIODS`].
pub(crate) const FOR_A_VERDICT: Statistics = Statistics {
    strain_rates: 3,
    widths: 6,
    replicates: 5,
    runs: 180,
};

/// What counts for a verdict, a sentence for reports.
pub(crate) const WHAT_COUNTS: &str = "What a verdict takes is counted in runs that average over 50 periods of a flow which no longer drifts, at forces that have \
     such runs from both starts; tables and figures show all stationary flows.";

/// Fraction of grains outside the tube beyond which a force is left out: another system flows then.
pub(crate) const MOST_ESCAPED: f64 = 0.05;

/// Points of a branch that are continued to the jump by a straight line.
const CONTINUED: usize = 3;
/// A jump counts from this height of J/Jmax on: a smooth rise between two forces continues to less.
pub(crate) const LEAST_JUMP: f64 = 0.25;
/// Distance of two forces beyond which a rise between them is not judged by its height: a smooth one may be as high.
const FINEST: f64 = 6e-4;
/// J/Jmax that a line must reach, and below which it must begin, to be called smooth: else the transition lies beyond it.
const SPAN: (f64, f64) = (0.3, 0.5);
/// Differences count from this many of their errors on.
pub(crate) const CLEAR: f64 = 4.0;
/// Least error of a mean of J/Jmax: replicates that agree by chance to many digits still have one.
const LEAST_ERROR: f64 = 2e-3;

/// The stationary flow at one force from one start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ForcePoint {
    /// f^P.
    pub(crate) force: f64,
    /// Mean of J/Jmax over the stationary runs.
    pub(crate) mean: f64,
    /// Its standard error from their scatter; from the blocks of the one run where there is but one.
    pub(crate) error: f64,
    /// Runs that count for a verdict.
    pub(crate) counted: usize,
    /// Fraction of the grains outside, mean.
    pub(crate) escaped: f64,
}

impl ForcePoint {
    /// Whether the mean is beyond a bound by many of its errors.
    pub(crate) fn is_below(&self, bound: f64) -> bool {
        self.mean < bound - CLEAR * self.error
    }
}

/// The stationary flow against the force, from one start.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ForceBranch {
    /// By ascending force.
    pub(crate) points: Vec<ForcePoint>,
}

/// Where a branch rises most between two neighbouring forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rise {
    /// The force below it.
    pub(crate) before: f64,
    /// The force beyond it.
    pub(crate) after: f64,
}

/// Both branches of some tube at one strain rate.
#[derive(Clone, Debug)]
pub(crate) struct ForceLine {
    /// epsdot.
    pub(crate) strain_rate: f64,
    /// From rest.
    pub(crate) rest: ForceBranch,
    /// From jammed.
    pub(crate) jammed: ForceBranch,
    /// Forces left out since from either start more than [`MOST_ESCAPED`] of the grains are outside, ascending.
    pub(crate) leaking: Vec<f64>,
    /// Largest fraction of grains outside at a force, those left out included.
    pub(crate) escaped: f64,
    /// How much is behind it.
    pub(crate) statistics: Statistics,
}

/// Whether the flow jumps along a line of forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It jumps, or both states exist at one force.
    Jump,
    /// It rises smoothly, the same from both starts.
    Smooth,
    /// The errors, or the distances of the forces, do not allow to say.
    Unclear,
}

/// Runs of one start by ascending force, a group a force.
fn by_force<'a>(runs: impl Iterator<Item = &'a Run>, start: Start) -> Vec<Vec<&'a Run>> {
    let mut runs: Vec<&Run> = runs
        .filter(|run| run.start == start && run.force().is_finite())
        .collect();
    runs.sort_by(|one, other| one.force().total_cmp(&other.force()));
    runs.chunk_by(|one, other| one.force() == other.force())
        .map(<[&Run]>::to_vec)
        .collect()
}

/// Force and mean fraction of grains outside, for each force and start.
pub(crate) fn escaped_at<'a>(runs: impl Iterator<Item = &'a Run> + Clone) -> Vec<(f64, f64)> {
    [Start::Rest, Start::Jammed]
        .into_iter()
        .flat_map(|start| by_force(runs.clone(), start))
        .map(|group| {
            let sum: f64 = group.iter().map(|run| run.escaped_fraction()).sum();
            (group[0].force(), sum / group.len() as f64)
        })
        .collect()
}

/// Forces, ascending, at which from either start more than [`MOST_ESCAPED`] of the grains are outside, from [`escaped_at`].
pub(crate) fn leaking(escaped: &[(f64, f64)]) -> Vec<f64> {
    let mut forces: Vec<f64> = escaped
        .iter()
        .filter(|(_, escaped)| *escaped > MOST_ESCAPED)
        .map(|(force, _)| *force)
        .collect();
    forces.sort_by(f64::total_cmp);
    forces.dedup();
    forces
}

/// Largest fraction of grains outside, and the forces left out for that, in words.
pub(crate) fn outside(escaped: f64, left_out: &[f64]) -> String {
    let escaped = number(escaped, 2);
    if left_out.is_empty() {
        return escaped;
    }
    let forces: Vec<String> = left_out.iter().map(f64::to_string).collect();
    format!("{escaped} (left out: {})", forces.join(", "))
}

/// Whether a run counts for a verdict.
pub(crate) fn counts(run: &Run) -> bool {
    // Means over a whole number of samples may miss whole periods by one of them.
    run.is_stationary() && run.late_periods() >= STATIONARY_PERIODS - 0.5
}

impl ForceBranch {
    /// The branch that some runs of one tube at one strain rate show; those that still drift are left out, and with them
    /// forces at which most do.
    pub(crate) fn of<'a>(runs: impl Iterator<Item = &'a Run>, start: Start) -> Self {
        let points = by_force(runs, start)
            .into_iter()
            .filter_map(|all| {
                let stationary = Stationary::of(&all)?;
                Some(ForcePoint {
                    force: all[0].force(),
                    mean: stationary.mean,
                    error: stationary.error.max(LEAST_ERROR),
                    counted: stationary.runs.iter().filter(|run| counts(run)).count(),
                    escaped: stationary.escaped,
                })
            })
            .collect();
        Self { points }
    }

    /// The point at a force.
    pub(crate) fn at(&self, force: f64) -> Option<&ForcePoint> {
        self.points.iter().find(|point| point.force == force)
    }

    /// Where it rises most from one force to the next; `None` where it rises nowhere by more than the error.
    pub(crate) fn rise(&self) -> Option<Rise> {
        self.points
            .windows(2)
            .filter(|pair| pair[1].mean - pair[0].mean > pair[1].error.hypot(pair[0].error))
            .max_by(|one, other| {
                (one[1].mean - one[0].mean).total_cmp(&(other[1].mean - other[0].mean))
            })
            .map(|pair| Rise {
                before: pair[0].force,
                after: pair[1].force,
            })
    }

    /// The jump at the largest rise, both sides continued to it as straight lines; `None` where a side is missing.
    pub(crate) fn jump(&self) -> Option<Jump> {
        let rise = self.rise()?;
        let split = self
            .points
            .partition_point(|point| point.force <= rise.before);
        let (below, beyond) = self.points.split_at(split);
        let side = |points: &[ForcePoint]| -> Vec<(f64, f64, f64)> {
            let points = points.iter();
            points
                .map(|point| (point.force, point.mean, point.error))
                .collect()
        };
        jump_between(
            &side(&beyond[..beyond.len().min(CONTINUED)]),
            &side(&below[below.len().saturating_sub(CONTINUED)..]),
            bracket(rise.before, rise.after),
        )
    }

    /// Columns force, mean and error, for figures.
    pub(crate) fn columns(&self) -> [Vec<f64>; 3] {
        let column = |value: fn(&ForcePoint) -> f64| self.points.iter().map(value).collect();
        [
            column(|point| point.force),
            column(|point| point.mean),
            column(|point| point.error),
        ]
    }
}

impl ForceLine {
    /// The lines of all strain rates, by ascending one, that some runs of one tube show.
    pub(crate) fn all_of(runs: &[Run]) -> Vec<Self> {
        crate::critical::strain_rates(runs.iter())
            .into_iter()
            .map(|strain_rate| {
                let here = || {
                    runs.iter()
                        .filter(move |run| run.strain_rate == strain_rate)
                };
                let outside = escaped_at(here());
                let leaking = leaking(&outside);
                let tight = || here().filter(|run| !leaking.contains(&run.force()));
                Self {
                    strain_rate,
                    rest: ForceBranch::of(tight(), Start::Rest),
                    jammed: ForceBranch::of(tight(), Start::Jammed),
                    statistics: behind(tight().collect()),
                    escaped: outside.iter().map(|one| one.1).fold(0.0, f64::max),
                    leaking,
                }
            })
            .collect()
    }

    /// The points from rest, then those from jammed.
    pub(crate) fn points(&self) -> impl Iterator<Item = &ForcePoint> {
        self.rest.points.iter().chain(&self.jammed.points)
    }

    /// Whether no flow on it is stationary.
    pub(crate) fn is_empty(&self) -> bool {
        self.rest.points.is_empty() && self.jammed.points.is_empty()
    }

    /// Forces with both flows: from jammed faster than from rest by more than a jump's least height and many errors.
    pub(crate) fn both(&self) -> Vec<f64> {
        self.jammed
            .points
            .iter()
            .filter(|jammed| {
                self.rest.at(jammed.force).is_some_and(|rest| {
                    let difference = jammed.mean - rest.mean;
                    difference > LEAST_JUMP.max(CLEAR * jammed.error.hypot(rest.error))
                })
            })
            .map(|point| point.force)
            .collect()
    }

    /// Least and largest width of the window of forces with both flows: from the first to the last of them, and between the
    /// forces on either side, infinite where there is none; `None` where no force has both.
    pub(crate) fn window(&self) -> Option<(f64, f64)> {
        let both = self.both();
        let (first, last) = (*both.first()?, *both.last()?);
        let forces = || self.points().map(|point| point.force);
        let before = forces()
            .filter(|force| *force < first)
            .fold(f64::NEG_INFINITY, f64::max);
        let after = forces()
            .filter(|force| *force > last)
            .fold(f64::INFINITY, f64::min);
        Some((last - first, after - before))
    }

    /// Height of the jump: the distance of the two flows, mean over the forces that have both; where none has, that of the
    /// largest rise, the smaller of both starts.
    pub(crate) fn height(&self) -> Option<Uncertain> {
        let both = self.both();
        let pairs: Vec<(&ForcePoint, &ForcePoint)> = both
            .iter()
            .filter_map(|force| Some((self.rest.at(*force)?, self.jammed.at(*force)?)))
            .collect();
        if !pairs.is_empty() {
            let number = pairs.len() as f64;
            let distance = pairs.iter().map(|(rest, jammed)| jammed.mean - rest.mean);
            let variance = pairs
                .iter()
                .map(|(rest, jammed)| rest.error.powi(2) + jammed.error.powi(2));
            return Some(Uncertain::normal(
                distance.sum::<f64>() / number,
                variance.sum::<f64>().sqrt() / number,
            ));
        }
        let heights = [&self.rest, &self.jammed].map(|branch| Some(branch.jump()?.height));
        heights
            .into_iter()
            .flatten()
            .min_by(|one, other| one.value.total_cmp(&other.value))
    }

    /// Distance of the forces of the longer of the largest rises from either start.
    fn bracket(&self) -> f64 {
        [&self.rest, &self.jammed]
            .into_iter()
            .filter_map(|branch| branch.rise())
            .map(|rise| rise.after - rise.before)
            .fold(0.0, f64::max)
    }

    /// Whether it reaches from unjammed to jammed flow.
    fn spans(&self) -> bool {
        let means = || self.points().map(|point| point.mean);
        means().any(|mean| mean < SPAN.0) && means().any(|mean| mean > SPAN.1)
    }

    /// Whether it jumps.
    pub(crate) fn kind(&self) -> Kind {
        if !self.both().is_empty() {
            return Kind::Jump;
        }
        match self.height() {
            Some(height)
                if height.value - CLEAR * height.error > LEAST_JUMP && self.bracket() <= FINEST =>
            {
                Kind::Jump
            }
            Some(height) if height.value + 2.0 * height.error < LEAST_JUMP && self.spans() => {
                Kind::Smooth
            }
            _ => Kind::Unclear,
        }
    }
}

/// How much is behind some runs at one strain rate: over the two starts the fewest forces that have runs which count, and of
/// those runs the number at the force which has fewest among the best so many as a verdict takes.
pub(crate) fn behind(runs: Vec<&Run>) -> Statistics {
    let of = |start: Start| {
        let mut numbers: Vec<usize> = by_force(runs.iter().copied(), start)
            .iter()
            .map(|group| group.iter().filter(|run| counts(run)).count())
            .filter(|number| *number > 0)
            .collect();
        numbers.sort_unstable_by(|one, other| other.cmp(one));
        let replicates = numbers
            .get(FOR_A_VERDICT.widths - 1)
            .or(numbers.last())
            .copied()
            .unwrap_or(0);
        (
            numbers
                .iter()
                .filter(|number| **number >= replicates)
                .count(),
            replicates,
        )
    };
    let (rest, jammed) = (of(Start::Rest), of(Start::Jammed));
    Statistics {
        strain_rates: 1,
        widths: rest.0.min(jammed.0),
        replicates: rest.1.min(jammed.1),
        runs: runs.len(),
    }
}

/// What is behind some lines that are compared: as many strain rates as a verdict takes, those with most behind them, and
/// the least of each number over these.
pub(crate) fn together<'a>(lines: impl Iterator<Item = &'a ForceLine>) -> Statistics {
    let mut all: Vec<Statistics> = lines.map(|line| line.statistics).collect();
    let runs = all.iter().map(|one| one.runs).sum();
    all.sort_by_key(|one| {
        std::cmp::Reverse((
            one.suffice(&one_rate()),
            one.widths.min(FOR_A_VERDICT.widths),
            one.replicates,
        ))
    });
    let enough = all
        .iter()
        .filter(|one| one.suffice(&one_rate()))
        .count()
        .max(FOR_A_VERDICT.strain_rates);
    Statistics {
        runs,
        ..Statistics::weakest(all.into_iter().take(enough))
    }
}

/// What a verdict takes at each strain rate.
pub(crate) fn one_rate() -> Statistics {
    Statistics {
        strain_rates: 1,
        ..FOR_A_VERDICT
    }
}
