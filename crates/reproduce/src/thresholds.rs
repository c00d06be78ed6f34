//! The thresholds of all claims, each with its reason.
//!
//! Where two claims use different values for one thing, both stand here, side by side, and the second says that it differs.

use crate::finding::Statistics;

// Which runs count.

/// Difference of J/Jmax between the halves of the late part beyond which a flow is still in its transient: half of the least
/// jump, so that no transient is taken for a flow of its own.
pub(crate) const MOST_DRIFT: f64 = 0.05;
/// Fraction of grains outside the tube beyond which a strain rate or a force is left out: the tube has another density then,
/// and the flow belongs to another system.
pub(crate) const MOST_ESCAPED: f64 = 0.05;
/// Grains are looked for outside the tube at widths within this distance of the fall \[d\]: what happens far from the
/// transition does not matter to it.
pub(crate) const ESCAPED_WITHIN: f64 = 0.1;
/// Replicates whose values of J/Jmax leave a gap of this height between them have ended in both flows: replicates of one
/// flow scatter by less.
pub(crate) const SPLIT: f64 = 0.2;
/// Least error of a mean of J/Jmax against the width: replicates that agree by chance to all digits still have one.
pub(crate) const LEAST_ERROR_AGAINST_WIDTH: f64 = 1e-3;
/// The same against the force; it differs, since fewer replicates are behind a mean.
pub(crate) const LEAST_ERROR_AGAINST_FORCE: f64 = 2e-3;

// What counts as a jump.

/// Points on either side that are continued to a jump by a straight line: the fewest that show whether a line fits.
pub(crate) const CONTINUED: usize = 3;
/// Errors from which on a difference of two flows counts: one comparison among many differs by three of its errors by chance.
pub(crate) const CLEAR: f64 = 4.0;
/// Height of J/Jmax from which on a fall between two widths counts: below lies the scatter of neighbouring widths.
pub(crate) const LEAST_FALL: f64 = 0.05;
/// Height of J/Jmax from which on a fall against the width is a jump: twice the least fall, for bisection makes the bracket
/// of the jump so narrow that a slope falls by less within it.
pub(crate) const LEAST_JUMP: f64 = 0.1;
/// The same against the force; it differs, since the forces are not bisected: a smooth rise between two of them continues to
/// less than that.
pub(crate) const LEAST_JUMP_AGAINST_FORCE: f64 = 0.25;

// What agrees with the source.

/// Standard errors within which a value agrees with the source's: the 95 per cent interval.
pub(crate) const AGREES_WITHIN: f64 = 2.0;
/// Error beyond which a value says nothing of the source's, as a fraction of the latter: hardly any value would disagree.
pub(crate) const LARGE_ERROR: f64 = 0.25;

// Transition times.

/// Widths closest to the critical one that a fit uses, of those at which at least half of the runs had a transition: nearer,
/// the four parameters of the fit have too few widths; farther, the power law need not hold.
pub(crate) const WINDOW: usize = 6;
/// Mean transition time, in periods, below which averages over periods do not resolve it: it takes three of them to be seen.
pub(crate) const RESOLVED: f64 = 3.0;

/// What a verdict takes where a claim asks for nothing else.
pub(crate) const FOR_A_VERDICT: Statistics = Statistics::FOR_A_VERDICT;
