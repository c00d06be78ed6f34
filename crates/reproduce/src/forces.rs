//! The stationary flow of the stress-controlled tube against the force amplitude, from both starts.

use peristalsis_analysis::Uncertain;
use peristalsis_analysis::number::decimal as number;

use crate::branch::{Branch, Branches, Control, Point, Step};
use crate::exhibit::listed;
use crate::finding::Statistics;
use crate::row::{Row, Start, ascending, by_strain_rate, escaped, grouped};
use crate::thresholds::{
    CLEAR, FINEST, FOR_A_VERDICT_ON_FORCES, LEAST_JUMP_AGAINST_FORCE, MOST_ESCAPED,
    STATIONARY_PERIODS,
};

/// Both branches of a tube at one strain rate.
#[derive(Clone, Debug)]
pub(crate) struct ForceLine<'a> {
    /// epsdot.
    pub(crate) strain_rate: f64,
    /// From rest and from jammed.
    pub(crate) flow: Branches<'a>,
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
    Undecided,
}

/// The runs under stress control by start and force.
fn by_start_and_force<'a>(rows: &[Row<'a>]) -> Vec<((Start, f64), Vec<Row<'a>>)> {
    let forced = rows.iter().copied().filter(|row| row.force().is_finite());
    grouped(forced, |row| (row.start(), row.force()))
}

/// Force and mean fraction of grains outside, for each start and force.
fn escaped_at(rows: &[Row<'_>]) -> Vec<(f64, f64)> {
    by_start_and_force(rows)
        .into_iter()
        .map(|((_, force), rows)| (force, escaped(&rows)))
        .collect()
}

/// Forces, ascending, at which from either start more than [`MOST_ESCAPED`] of the grains are outside.
pub(crate) fn leaking(rows: &[Row<'_>]) -> Vec<f64> {
    let leaks = escaped_at(rows)
        .into_iter()
        .filter(|(_, escaped)| *escaped > MOST_ESCAPED);
    ascending(leaks.map(|(force, _)| force))
}

/// Largest fraction of grains outside, and the forces left out for that, in words.
pub(crate) fn outside(escaped: f64, left_out: &[f64]) -> String {
    let escaped = number(escaped, 2);
    if left_out.is_empty() {
        return escaped;
    }
    let forces = listed(left_out.iter().copied());
    format!("{escaped} (left out: {forces})")
}

/// The runs that count for a verdict: means over so many stationary periods.
pub(crate) fn counting<'a>(rows: &[Row<'a>]) -> Vec<Row<'a>> {
    // Means over a whole number of samples may miss whole periods by one of them.
    let counts = |row: &&Row<'_>| {
        row.is_stationary() && row.number("late_periods") >= STATIONARY_PERIODS - 0.5
    };
    rows.iter().filter(counts).copied().collect()
}

/// Whether the flow at a point, one chosen among many, is below a bound.
pub(crate) fn is_clearly_below(point: &Point<'_>, bound: f64) -> bool {
    point.flow.value < bound - CLEAR * point.flow.error
}

impl<'a> ForceLine<'a> {
    /// The line of some runs of one tube at one strain rate.
    fn of(strain_rate: f64, rows: &[Row<'a>]) -> Self {
        let leaking = leaking(rows);
        let holds = |row: &&Row<'a>| !leaking.contains(&row.force());
        let tight: Vec<Row<'a>> = rows.iter().filter(holds).copied().collect();
        let escaped = escaped_at(rows);
        Self {
            strain_rate,
            flow: Branches::of(&tight, Control::Force),
            statistics: behind(&tight),
            escaped: escaped.iter().map(|one| one.1).fold(0.0, f64::max),
            leaking,
        }
    }

    /// The lines of all strain rates, by ascending one, that some runs of one tube show.
    pub(crate) fn all_of(rows: &[Row<'a>]) -> Vec<Self> {
        by_strain_rate(rows.iter().copied())
            .into_iter()
            .map(|(strain_rate, rows)| Self::of(strain_rate, &rows))
            .collect()
    }

    /// Whether no flow on it is stationary.
    pub(crate) fn is_empty(&self) -> bool {
        self.flow.points().next().is_none()
    }

    /// The points from rest and from jammed at forces with both flows: from jammed faster by more than a jump's least height
    /// and many errors.
    pub(crate) fn both(&self) -> Vec<(&Point<'a>, &Point<'a>)> {
        let Branches { rest, jammed } = &self.flow;
        let pairs = jammed.points.iter();
        pairs
            .filter_map(|jammed| Some((rest.at(jammed.control)?, jammed)))
            .filter(|(rest, jammed)| Step::between(rest, jammed).rises_by(LEAST_JUMP_AGAINST_FORCE))
            .collect()
    }

    /// The first and the last force with both flows.
    pub(crate) fn both_ends(&self) -> Option<(f64, f64)> {
        let both = self.both();
        Some((both.first()?.0.control, both.last()?.0.control))
    }

    /// Least and largest width of the window of forces with both flows: from the first to the last of them, and between the
    /// forces on either side, infinite where there is none; `None` where no force has both.
    pub(crate) fn window(&self) -> Option<(f64, f64)> {
        let (first, last) = self.both_ends()?;
        let forces = || self.flow.points().map(|point| point.control);
        let before = forces().filter(|force| *force < first);
        let after = forces().filter(|force| *force > last);
        let before = before.fold(f64::NEG_INFINITY, f64::max);
        let after = after.fold(f64::INFINITY, f64::min);
        Some((last - first, after - before))
    }

    /// Height of the jump: the distance of the two flows, mean over the forces that have both; where none has, that of the
    /// largest rise, the smaller of both starts.
    pub(crate) fn height(&self) -> Option<Uncertain> {
        let both = self.both();
        if both.is_empty() {
            let heights = self.flow.each().map(|branch| Some(branch.jump()?.height));
            return heights
                .into_iter()
                .flatten()
                .min_by(|one, other| one.value.total_cmp(&other.value));
        }
        let number = both.len() as f64;
        let flows = || both.iter().map(|(rest, jammed)| (rest.flow, jammed.flow));
        let distance: f64 = flows()
            .map(|(rest, jammed)| jammed.value - rest.value)
            .sum();
        let variance = flows().map(|(rest, jammed)| rest.error.powi(2) + jammed.error.powi(2));
        let error = variance.sum::<f64>().sqrt();
        Some(Uncertain::normal(distance / number, error / number))
    }

    /// Distance of the forces of the longer of the largest rises from either start.
    fn bracket(&self) -> f64 {
        self.flow
            .each()
            .into_iter()
            .filter_map(Branch::rise)
            .map(|rise| rise.controls[1] - rise.controls[0])
            .fold(0.0, f64::max)
    }

    /// Whether it jumps.
    pub(crate) fn kind(&self) -> Kind {
        let least = LEAST_JUMP_AGAINST_FORCE;
        if !self.both().is_empty() {
            return Kind::Jump;
        }
        match self.height() {
            Some(height)
                if height.value - CLEAR * height.error > least && self.bracket() <= FINEST =>
            {
                Kind::Jump
            }
            Some(height) if height.is_below(least) && self.flow.spans() => Kind::Smooth,
            _ => Kind::Undecided,
        }
    }
}

/// How much is behind some runs at one strain rate. Of each start only runs that count are counted: the number of forces that
/// have any, and the replicates at the last of the best so many forces that a verdict takes. The smaller of both starts.
fn behind(rows: &[Row<'_>]) -> Statistics {
    let groups = by_start_and_force(rows);
    let of = |start: Start| {
        let mut numbers: Vec<usize> = groups
            .iter()
            .filter(|group| group.0.0 == start)
            .map(|(_, rows)| counting(rows).len())
            .filter(|number| *number > 0)
            .collect();
        numbers.sort_unstable_by(|one, other| other.cmp(one));
        let replicates = numbers
            .get(FOR_A_VERDICT_ON_FORCES.widths - 1)
            .or(numbers.last())
            .copied()
            .unwrap_or(0);
        let forces = numbers.iter().filter(|number| **number >= replicates);
        (forces.count(), replicates)
    };
    let (rest, jammed) = (of(Start::Rest), of(Start::Jammed));
    Statistics::of(1, rest.0.min(jammed.0), rest.1.min(jammed.1), rows.len())
}

/// What is behind some lines that are compared: as many strain rates as a verdict takes, those with most behind them, and
/// the least of each number over these.
pub(crate) fn together<'b, 'a: 'b>(
    lines: impl IntoIterator<Item = &'b ForceLine<'a>>,
) -> Statistics {
    let needed = Statistics {
        strain_rates: 1,
        ..FOR_A_VERDICT_ON_FORCES
    };
    let mut all: Vec<Statistics> = lines.into_iter().map(|line| line.statistics).collect();
    let runs = all.iter().map(|one| one.runs).sum();
    all.sort_by_key(|one| {
        std::cmp::Reverse((
            one.suffice(&needed),
            one.widths.min(needed.widths),
            one.replicates,
        ))
    });
    let enough = all.iter().filter(|one| one.suffice(&needed)).count();
    let compared = enough.max(FOR_A_VERDICT_ON_FORCES.strain_rates);
    Statistics {
        runs,
        ..Statistics::weakest(all.into_iter().take(compared))
    }
}
