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
/// From so many of its errors on a difference of two flows counts that was chosen among many: by chance one of many reaches
/// three. Where a single difference is asked for, its 95 per cent interval decides.
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

/// Length of the 95 per cent interval, as a fraction of the source's value, beyond which a value says nothing of it: hardly
/// any value would disagree.
pub(crate) const LONG: f64 = 1.0;

/// Probability below which what a claim says is excluded, as by the 95 per cent interval.
pub(crate) const BY_CHANCE: f64 = 0.05;

/// Strain rates at which a claim can be told, at least, for a wall to have a verdict.
pub(crate) const LEAST_RATES: usize = 3;
/// Part of them at which it must hold for the wall to reproduce it; where it fails at that part, the wall differs. One of
/// four may err, so that no strain rate alone decides.
pub(crate) const MOST_RATES: f64 = 0.75;

// Transition times.

/// Part of the runs at a width with a transition from which on their mean time counts: censored runs bear on it through the
/// likelihood.
pub(crate) const SEEN: f64 = 0.5;
/// The same for the variance of their times, and for a collapse; more, since the likelihood takes the shape of the distribution
/// of long times for granted.
pub(crate) const MOSTLY_SEEN: f64 = 0.75;

/// Widths closest to the critical one that a fit uses, of those at which at least half of the runs had a transition: nearer,
/// the four parameters of the fit have too few widths; farther, the power law need not hold.
pub(crate) const WINDOW: usize = 6;
/// Distance from w_c, over epsdot^(3/2), up to which widths are near it: the source's laws are for distances about 1.
pub(crate) const NEAR: f64 = 4.0;
/// Widths that a straight line of 1/tau takes at least.
pub(crate) const STRAIGHT: usize = 4;
/// Mean transition time, in periods, below which averages over periods do not resolve it: it takes three of them to be seen.
pub(crate) const RESOLVED: f64 = 3.0;

// The stress-controlled tube.

/// Periods of stationary flow behind the late mean of a run that counts for a verdict: fewer leave a slow drift unseen.
pub(crate) const STATIONARY_PERIODS: f64 = 50.0;
/// What a verdict takes there: 3 strain rates, 6 forces at each and 5 replicates from either start, all of them runs with
/// [`STATIONARY_PERIODS`]. Less than elsewhere, since each of these runs takes minutes, not seconds.
pub(crate) const FOR_A_VERDICT_ON_FORCES: Statistics = Statistics::needed(3, 6, 5);
/// Distance of two forces beyond which a rise between them is not judged by its height: a smooth rise may be as high.
pub(crate) const FINEST: f64 = 6e-4;
/// J/Jmax below which a line must begin, and which it must reach, to be called smooth: else the transition lies beyond it.
pub(crate) const SPAN: (f64, f64) = (0.3, 0.5);
/// J/Jmax below which a jam has given way: between the jammed flow, 0.6 and more, and the unjammed flow, near 0.
pub(crate) const GIVEN_WAY: f64 = 0.3;
/// Flow against the wave, in parts of Jmax, that would go unnoticed.
pub(crate) const LEAST_BACK_FLOW: f64 = 0.01;
/// J/Jmax below which a flow is unjammed, clear of the jump.
pub(crate) const UNJAMMED: f64 = 0.2;
/// J/Jmax from which on a flow is fast: midway between the two flows.
pub(crate) const FAST: f64 = 0.5;
/// J/Jmax at which a critical width is looked at once more: jammed flow is faster as a rule.
pub(crate) const HIGHER: f64 = 0.7;
/// Parts of the tube's diameter by which the critical width may change from the one threshold to the other.
pub(crate) const SHARP: f64 = 0.01;

// What differs between two flows.

/// Distance of two bottlenecks, in parts of the tube's diameter, within which flows are compared: over it the flow of one
/// model hardly changes.
pub(crate) const MATCHED: f64 = 0.01;
/// Part of the pairs of flows of one model that are no farther apart than what counts as a difference.
pub(crate) const WITHIN_A_MODEL: f64 = 0.95;
/// Pressure on the wall, as a fraction of its largest, below which grains fly freely.
pub(crate) const FREE_FLIGHT: f64 = 0.01;

// Collapse of curves.

/// Fraction of the points that must be compared: with less a search wins by pulling the curves apart.
pub(crate) const OVERLAP: f64 = 0.75;
/// Distance of the points from one curve, in their errors, up to which there is a collapse: errors are known as well as that.
pub(crate) const COLLAPSED_WITHIN: f64 = 1.5;
/// The same from which on there is none.
pub(crate) const NO_COLLAPSE_BEYOND: f64 = 3.0;

// F1: two kinds of flow.

/// J/Jmax below which a flow is slow: half of the jammed flow.
pub(crate) const SLOW: f64 = 0.5;
/// J/Jmax from which on a flow is near Jmax, as the source says of the jammed flow.
pub(crate) const NEAR_ONE: f64 = 0.9;
/// Distance below the jump \[d\] at which the jammed flow is read off: next to the jump grains still slip back.
pub(crate) const BELOW_THE_JUMP: f64 = 0.1;
/// Fraction of runs that must do as the claim says: one of twenty may err, for widths next to the jump are among them.
pub(crate) const NEARLY_ALL: f64 = 0.95;

// F5: the second moment of the flow.

/// Part of its bound, the variance of runs of which half have passed from one flow to the other, from which on a peak of the
/// second moment cannot grow.
pub(crate) const SATURATED: f64 = 0.8;
/// Bound of the second moment below which thresholds 0.1 apart do not resolve the distance of the flows, 0.3.
pub(crate) const LEAST_BOUND: f64 = 0.0225;
/// Least error of a peak: resampled runs that all jam at one time give none.
pub(crate) const LEAST_ERROR_OF_A_MOMENT: f64 = 1e-4;
/// Runs at a width below which there is no variance to speak of.
pub(crate) const LEAST_RUNS_OF_A_MOMENT: usize = 8;

// F6: the jump.

/// Distance from the jump \[d\] of the widths whose runs make the histogram: near enough for both flows.
pub(crate) const NEAR_THE_JUMP: f64 = 0.05;

// F8: densities.

/// What F8 takes: one strain rate, for it is about densities.
pub(crate) const F8_NEEDED: Statistics = Statistics::needed(1, 8, 10);
/// Densities that a verdict takes.
pub(crate) const LEAST_DENSITIES: usize = 4;
/// Change of 2a − w_c over the range of densities, as a fraction of its mean, up to which w_c hardly depends on them. The
/// distance from the straight tube is what counts: of w_c itself everything is a few per cent.
pub(crate) const HARDLY: f64 = 0.2;
/// Width at which the flow of all densities is compared \[d\]: all of them are jammed there.
pub(crate) const COMPARED_WIDTH: f64 = 2.6;

// F9: the loop.

/// Probability of such outcomes of the runs from both starts if the start did not matter, below which both flows exist at a
/// width; shared among all widths that are compared.
pub(crate) const ONE_FLOW_BY_CHANCE: f64 = 0.01;
/// Distance beyond w_c \[d\] within which both starts must have runs to say that both flows exist nowhere: loops are seldom
/// narrower.
pub(crate) const NEXT_TO_THE_FALL: f64 = 0.02;
/// Contacts a grain below which grains do not jam but coast, past one another and the wall. Of 2,258 fast flows from jammed 1,581
/// have fewer than 0.8, 662 have more than 1.8, and 15 lie between.
pub(crate) const LEAST_CONTACTS: f64 = 1.0;

// Q1: small strain rates.

/// For an answer: four strain rates, five replicates, since each run takes long.
pub(crate) const Q1_NEEDED: Statistics = Statistics::needed(4, 8, 5);
/// Errors by which the critical width must fall to turn back; it differs from [`CLEAR`], since the
/// errors are those of brackets.
pub(crate) const CLEAR_TURN: f64 = 3.0;
/// J/Jmax of the threshold that first runs had.
pub(crate) const HALF: f64 = 0.5;

// Q2: roughness.

/// For an answer: five lattices are asked for apart.
pub(crate) const Q2_NEEDED: Statistics = Statistics::needed(2, 7, 5);
/// Lattices that an answer takes.
pub(crate) const LEAST_LATTICES: usize = 5;

// Q3 to Q5 and Q11: one parameter varied at a time.

/// For an answer of Q3: seven widths of each value, three replicates, since many values are compared.
pub(crate) const Q3_NEEDED: Statistics = Statistics::needed(1, 7, 3);
/// For an answer of Q4: one strain rate, for it is about lengths.
pub(crate) const Q4_NEEDED: Statistics = F8_NEEDED;
/// Lengths that an answer to Q4 takes, and lengths of tubes and of sweeps in Q8: an exponent through two has no say.
pub(crate) const LEAST_LENGTHS: usize = 3;
/// Difference of Akaike's criterion from which on a law is worse: the better one is then exp(2), some seven times, as likely.
pub(crate) const WORSE: f64 = 4.0;
/// Probability below which pure chance is excluded.
pub(crate) const EXCLUDED: f64 = 1e-3;
/// For an answer of Q11: one strain rate, five replicates, since each method is computed anew.
pub(crate) const Q11_NEEDED: Statistics = Statistics::needed(1, 7, 5);

/// For an answer to Q12, of each tube: widths and replicates at one strain rate. The number of tubes is asked for apart.
pub(crate) const Q12_NEEDED: Statistics = Statistics::needed(1, 7, 3);
/// For an answer to Q13: seven occlusions, three replicates.
pub(crate) const Q13_NEEDED: Statistics = Statistics::needed(1, 7, 3);
/// For an answer to Q14: without and with a head, three replicates of each drive.
pub(crate) const Q14_NEEDED: Statistics = Statistics::needed(1, 2, 3);
/// For an answer to Q15: outlets and replicates.
pub(crate) const Q15_NEEDED: Statistics = Statistics::needed(1, 6, 3);
/// Tubes whose critical widths were not known when the predictions were made.
pub(crate) const LEAST_TESTS: usize = 6;
/// Part of the measured value by which a prediction without the tube's details may miss it.
pub(crate) const PREDICTED_WITHIN: f64 = 0.2;

// Q6 to Q10.

/// For an answer to Q6: six values of the friction, three replicates.
pub(crate) const Q6_NEEDED: Statistics = Statistics::needed(4, 6, 3);

/// For an answer to Q7: eight bottlenecks a corner, three replicates.
pub(crate) const Q7_NEEDED: Statistics = Statistics::needed(1, 8, 3);

/// For an answer to Q8: two strain rates, six forces in each of three lengths, two sweeps of each kind.
pub(crate) const Q8_NEEDED: Statistics = Statistics::needed(2, 6, 1);

/// For an answer to Q9: eight pressures of the sine in either model, three replicates.
pub(crate) const Q9_NEEDED: Statistics = Statistics::needed(1, 8, 3);

/// For an answer to Q10, of each setting: so many forces and replicates at one strain rate. The number of settings is asked for
/// apart.
pub(crate) const Q10_NEEDED: Statistics = Statistics::needed(1, 5, 2);
/// Settings that it takes: one for each thing that the source does not give.
pub(crate) const LEAST_SETTINGS: usize = 8;
/// Forces without a leak from which on a setting is judged: two make one rise.
pub(crate) const LEAST_FORCES: usize = 3;
