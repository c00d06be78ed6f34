//! The stationary flow against a control from one start: where it falls or rises, and the jump there.

use peristalsis_analysis::{Jump, Uncertain, jump_height};

use crate::estimates::{bracket, columns, distance};
use crate::finding::Statistics;
use crate::row::{Row, Start, escaped, grouped, mean, scattered};
use crate::thresholds::{
    CLEAR, CONTINUED, ESCAPED_WITHIN, LEAST_ERROR_AGAINST_FORCE, LEAST_ERROR_AGAINST_WIDTH,
    LEAST_FALL, LEAST_JUMP, SPAN, SPLIT,
};

/// What is varied along a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Control {
    /// w \[d\]: the flow falls with it.
    Width,
    /// f^P: the flow rises with it.
    Force,
    /// Dp over a wavelength: the flow falls with it.
    BackPressure,
}

impl Control {
    /// Its column.
    pub(crate) fn column(self) -> &'static str {
        match self {
            Self::Width => "width",
            Self::Force => "force_amplitude",
            Self::BackPressure => "pressure_rise",
        }
    }

    /// Its value in a run.
    pub(crate) fn of(self, row: &Row<'_>) -> f64 {
        row.number(self.column())
    }
}

/// The flow at one value of the control.
#[derive(Clone, Debug)]
pub(crate) struct Point<'a> {
    /// The control.
    pub(crate) control: f64,
    /// Mean of J/Jmax over `rows` with its standard error.
    pub(crate) flow: Uncertain,
    /// The runs behind the mean.
    pub(crate) rows: Vec<Row<'a>>,
    /// Runs at this value, those that the mean leaves out included.
    pub(crate) runs: usize,
}

impl Point<'_> {
    /// Fraction of the grains outside, mean.
    pub(crate) fn escaped(&self) -> f64 {
        escaped(&self.rows)
    }

    /// Mean of another column over the same runs.
    pub(crate) fn mean(&self, column: &str) -> Option<Uncertain> {
        mean(&self.rows, column)
    }
}

/// The flow against a control, from one start.
#[derive(Clone, Debug)]
pub(crate) struct Branch<'a> {
    /// What is varied.
    pub(crate) control: Control,
    /// By ascending control.
    pub(crate) points: Vec<Point<'a>>,
}

/// The difference of two flows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// The controls of the first and of the second flow.
    pub(crate) controls: [f64; 2],
    /// J/Jmax of both.
    pub(crate) flows: [f64; 2],
    /// The second flow less the first.
    pub(crate) height: Uncertain,
}

impl Step {
    /// From one point to another.
    pub(crate) fn between(one: &Point<'_>, other: &Point<'_>) -> Self {
        Self {
            controls: [one.control, other.control],
            flows: [one.flow.value, other.flow.value],
            height: distance(&other.flow, &one.flow),
        }
    }

    /// Midway between the controls, with these as its bounds.
    pub(crate) fn place(&self) -> Uncertain {
        bracket(self.controls[0], self.controls[1])
    }

    /// J/Jmax midway.
    pub(crate) fn middle(&self) -> f64 {
        0.5 * (self.flows[0] + self.flows[1])
    }

    /// Whether the flows differ by more than `least` and [`CLEAR`] errors, in either direction.
    pub(crate) fn counts(&self, least: f64) -> bool {
        self.height.value.abs() > least.max(CLEAR * self.height.error)
    }

    /// Whether the second flow is higher by more than `least` and [`CLEAR`] errors.
    pub(crate) fn rises_by(&self, least: f64) -> bool {
        self.height.value > 0.0 && self.counts(least)
    }
}

/// The fraction of the grains outside the tube near a transition, by the one rule of all claims: the mean over the runs from
/// one start at a width, the largest of those of all widths within [`ESCAPED_WITHIN`] of the transition, or of all widths
/// where there is no transition.
pub(crate) fn leak(rows: &[Row<'_>], transition: Option<f64>) -> f64 {
    let is_near = |row: &&Row<'_>| {
        transition.is_none_or(|place| (row.width() - place).abs() <= ESCAPED_WITHIN)
    };
    let near = rows.iter().copied().filter(|row| is_near(&row));
    grouped(near, |row| (row.start(), row.width()))
        .iter()
        .map(|(_, rows)| escaped(rows))
        .fold(0.0, f64::max)
}

/// The runs at one value of a control that no longer drift, with their flow; `None` where none has one, or most still drift.
pub(crate) fn stationary<'a>(all: &[Row<'a>]) -> Option<(Vec<Row<'a>>, Uncertain)> {
    let rows: Vec<Row<'a>> = all
        .iter()
        .filter(|row| row.is_stationary() && row.flow_rate_ratio().is_finite())
        .copied()
        .collect();
    if rows.is_empty() || 2 * rows.len() < all.len() {
        return None;
    }
    let flow = flow_of(&rows);
    Some((rows, flow))
}

/// The mean of J/Jmax with its error from the scatter, or from the blocks of the run where there is but one.
pub(crate) fn flow_of(rows: &[Row<'_>]) -> Uncertain {
    let flow = scattered(rows, Row::flow_rate_ratio);
    if flow.error.is_finite() {
        return flow;
    }
    Uncertain::normal(flow.value, rows[0].number("flow_rate_ratio_error"))
}

/// Whether replicates ended in two flows.
pub(crate) fn is_split(rows: &[Row<'_>]) -> bool {
    let mut ratios: Vec<f64> = rows.iter().map(Row::flow_rate_ratio).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.windows(2).any(|pair| pair[1] - pair[0] > SPLIT)
}

impl<'a> Branch<'a> {
    /// The stationary branch that some runs of one tube at one strain rate show; those that still drift are left out, and with
    /// them values of the control at which most do. A width at which chance leads some replicates to each of the two flows is
    /// on neither branch, but between them.
    pub(crate) fn of(rows: &[Row<'a>], start: Start, control: Control) -> Self {
        let from = rows.iter().copied().filter(|row| row.start() == start);
        Self::with(from, control, |all| {
            let (rows, mut flow) = stationary(all)?;
            if control == Control::Width && is_split(&rows) {
                return None;
            }
            if control == Control::Force {
                flow = Uncertain::normal(flow.value, flow.error.max(LEAST_ERROR_AGAINST_FORCE));
            }
            Some((rows, flow))
        })
    }

    /// The means over all runs at each value of the control.
    pub(crate) fn of_all(rows: &[Row<'a>], control: Control) -> Self {
        Self::with(rows.iter().copied(), control, |all| {
            Some((all.to_vec(), mean(all, "flow_rate_ratio")?))
        })
    }

    /// A branch whose points are found by `point` from the runs at each value of the control: the runs that count, and their
    /// mean.
    pub(crate) fn with(
        rows: impl IntoIterator<Item = Row<'a>>,
        control: Control,
        mut point: impl FnMut(&[Row<'a>]) -> Option<(Vec<Row<'a>>, Uncertain)>,
    ) -> Self {
        let known = rows.into_iter().filter(|row| control.of(row).is_finite());
        let points = grouped(known, |row| control.of(row))
            .into_iter()
            .filter_map(|(value, all)| {
                let (rows, flow) = point(&all)?;
                Some(Point {
                    control: value,
                    flow,
                    rows,
                    runs: all.len(),
                })
            })
            .collect();
        Self { control, points }
    }

    /// The point at a value of the control.
    pub(crate) fn at(&self, control: f64) -> Option<&Point<'a>> {
        self.points.iter().find(|point| point.control == control)
    }

    /// The differences from each value of the control to the next.
    pub(crate) fn steps(&self) -> impl Iterator<Item = Step> {
        self.points
            .windows(2)
            .map(|pair| Step::between(&pair[0], &pair[1]))
    }

    /// Where it falls most steeply of all falls that are clear, or most where none is; `None` with a single point.
    pub(crate) fn fall(&self) -> Option<Step> {
        let steepness = |step: &Step| step.height.value / (step.controls[1] - step.controls[0]);
        self.steps()
            .filter(|step| step.height.value < 0.0 && step.counts(LEAST_FALL))
            .max_by(|one, other| steepness(other).total_cmp(&steepness(one)))
            .or_else(|| self.largest_step(|height| -height))
    }

    /// Where it rises most from one point to the next; `None` where it rises nowhere by more than the error.
    pub(crate) fn rise(&self) -> Option<Step> {
        self.steps()
            .filter(|step| step.height.value > step.height.error)
            .max_by(|one, other| one.height.value.total_cmp(&other.height.value))
    }

    /// Where it passes from one flow to the other: its rise against a force, else its fall.
    pub(crate) fn step(&self) -> Option<Step> {
        match self.control {
            Control::Force => self.rise(),
            Control::Width | Control::BackPressure => self.fall(),
        }
    }

    /// The difference between neighbours that is largest by this measure of its height.
    pub(crate) fn largest_step(&self, measure: fn(f64) -> f64) -> Option<Step> {
        let height = |step: &Step| measure(step.height.value);
        self.steps()
            .max_by(|one, other| height(one).total_cmp(&height(other)))
    }

    /// The jump at its step, both sides continued to it as straight lines; `None` where a side is missing.
    pub(crate) fn jump(&self) -> Option<Jump> {
        let step = self.step()?;
        let split = self
            .points
            .partition_point(|point| point.control <= step.controls[0]);
        let (before, after) = self.points.split_at(split);
        let known = |points: &[Point<'_>]| {
            let flows = points.iter().map(|point| (point.control, point.flow));
            columns(flows, LEAST_ERROR_AGAINST_WIDTH)
        };
        let before = known(&before[before.len().saturating_sub(CONTINUED)..]);
        let after = known(&after[..after.len().min(CONTINUED)]);
        let (upper, lower) = match self.control {
            Control::Force => (after, before),
            Control::Width | Control::BackPressure => (before, after),
        };
        let slices = |columns| <[Vec<f64>; 3]>::each_ref(columns).map(Vec::as_slice);
        jump_height(slices(&upper), slices(&lower), step.place()).ok()
    }

    /// Whether the step is a jump: high, and by many of its errors.
    pub(crate) fn jumps(&self) -> bool {
        let clear = |height: Uncertain| height.deviations_from(0.0) > CLEAR;
        self.jump()
            .is_some_and(|jump| jump.height.value > LEAST_JUMP && clear(jump.height))
    }

    /// J/Jmax midway between the two flows at the step.
    pub(crate) fn threshold(&self) -> Option<f64> {
        let step = self.step()?;
        Some(self.jump().map_or(step.middle(), |jump| {
            0.5 * (jump.upper.value + jump.lower.value)
        }))
    }

    /// How much is behind it, at its one strain rate.
    pub(crate) fn statistics(&self) -> Statistics {
        let runs = || self.points.iter().map(|point| point.runs);
        let replicates = runs().min().unwrap_or(0);
        Statistics::of(1, self.points.len(), replicates, runs().sum())
    }

    /// Control and flow of each point, for figures.
    pub(crate) fn flows(&self) -> impl Iterator<Item = (f64, Uncertain)> {
        self.points.iter().map(|point| (point.control, point.flow))
    }
}

/// The branches of one tube from both starts.
#[derive(Clone, Debug)]
pub(crate) struct Branches<'a> {
    pub(crate) rest: Branch<'a>,
    pub(crate) jammed: Branch<'a>,
}

impl<'a> Branches<'a> {
    /// Whether the flow reaches from unjammed to jammed.
    pub(crate) fn spans(&self) -> bool {
        let flows = || self.points().map(|point| point.flow.value);
        flows().any(|flow| flow < SPAN.0) && flows().any(|flow| flow > SPAN.1)
    }

    /// The stationary branches that some runs of one tube at one strain rate show.
    pub(crate) fn of(rows: &[Row<'a>], control: Control) -> Self {
        Self {
            rest: Branch::of(rows, Start::Rest, control),
            jammed: Branch::of(rows, Start::Jammed, control),
        }
    }

    /// Both.
    pub(crate) fn each(&self) -> [&Branch<'a>; 2] {
        [&self.rest, &self.jammed]
    }

    /// The points from rest, then those from jammed.
    pub(crate) fn points(&self) -> impl Iterator<Item = &Point<'a>> {
        self.rest.points.iter().chain(&self.jammed.points)
    }

    /// The point of the smallest flow.
    pub(crate) fn lowest(&self) -> Option<&Point<'a>> {
        self.points()
            .min_by(|one, other| one.flow.value.total_cmp(&other.flow.value))
    }

    /// The largest excess of the flow from jammed at one value of the control.
    pub(crate) fn gap(&self) -> Option<Step> {
        let points = self.rest.points.iter();
        points
            .filter_map(|rest| Some(Step::between(rest, self.jammed.at(rest.control)?)))
            .max_by(|one, other| one.height.value.total_cmp(&other.height.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(control: Control, flows: &[(f64, f64)]) -> Branch<'static> {
        let point = |&(control, flow): &(f64, f64)| Point {
            control,
            flow: Uncertain::normal(flow, 0.01),
            rows: Vec::new(),
            runs: 10,
        };
        Branch {
            control,
            points: flows.iter().map(point).collect(),
        }
    }

    #[test]
    fn a_step_is_a_jump_and_a_slope_is_none() {
        let falling = [
            (2.5, 1.0),
            (2.6, 0.98),
            (2.7, 0.96),
            (2.72, 0.2),
            (2.8, 0.1),
            (2.9, 0.0),
        ];
        let rising = falling.map(|(width, flow)| (-width, flow));
        let mut rising = rising.to_vec();
        rising.reverse();
        for (step, controls) in [
            (branch(Control::Width, &falling), [2.7, 2.72]),
            (branch(Control::Force, &rising), [-2.72, -2.7]),
        ] {
            assert_eq!(step.step().unwrap().controls, controls);
            assert!((step.step().unwrap().middle() - 0.58).abs() < 1e-12);
            assert!((step.jump().unwrap().height.value - 0.745).abs() < 0.01);
            assert!(step.jumps());
        }
        let slope: Vec<(f64, f64)> = (0..12)
            .map(|k| (2.4 + 0.05 * f64::from(k), 1.0 - 0.09 * f64::from(k)))
            .collect();
        assert!(!branch(Control::Width, &slope).jumps());
    }

    #[test]
    fn a_gap_lies_between_two_branches_at_one_control() {
        let rest = branch(Control::Force, &[(1.0, 0.1), (2.0, 0.2), (3.0, 0.9)]);
        let jammed = branch(Control::Force, &[(2.0, 0.8), (3.0, 0.9), (4.0, 1.0)]);
        let gap = Branches { rest, jammed }.gap().unwrap();
        assert_eq!((gap.controls, gap.flows), ([2.0, 2.0], [0.2, 0.8]));
        assert!(gap.counts(LEAST_JUMP) && !gap.counts(0.7));
    }
}
