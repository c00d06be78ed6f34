//! When a run may end before its time.

use peristalsis_analysis::Transition;

use crate::recorder::Recorder;

/// Ends a run a number of periods after its transition.
///
/// A run without a transition goes on to its configured end: what it says of the transition time is then censored
/// there, and nowhere earlier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopping {
    /// Whole periods from the one in which the flow rate crosses the threshold; at least the periods that confirm a
    /// crossing, for it is not found before.
    pub settled_periods: u32,
}

impl Stopping {
    /// Whether a run with this record may end.
    pub fn is_settled(self, recorder: &Recorder) -> bool {
        match recorder.transition() {
            Some(Transition::At { period, .. }) => {
                recorder.periods() >= period + u64::from(self.settled_periods)
            }
            _ => false,
        }
    }

    /// The part of a run that ended so which late means are taken over: the second half of the periods that it was
    /// given to settle.
    pub(crate) fn late_fraction(self, recorder: &Recorder) -> f64 {
        let late = f64::from(self.settled_periods.div_ceil(2).max(1));
        (late / recorder.periods().max(1) as f64).min(1.0)
    }
}
