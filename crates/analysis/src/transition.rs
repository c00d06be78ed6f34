//! Transition time between unjammed and jammed flow, with censoring.

use crate::error::{Error, ensure};
use serde::{Deserialize, Serialize};

/// Period averages in a row that must lie beyond the threshold before a crossing counts.
pub const CONFIRMATION_PERIODS: u32 = 3;

/// Time up to which a transition is found in a run of so many whole periods, in the unit of the period duration T: its last
/// crossing that can be confirmed ends in the middle of the third period from the end.
///
/// `watched = (periods - 5/2) T`, 0 at least
pub fn watched(periods: u64, period_duration: f64) -> f64 {
    (periods as f64 - (f64::from(CONFIRMATION_PERIODS) - 0.5)).max(0.0) * period_duration
}

/// The way in which the flow rate crosses the threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From below to above: from unjammed to jammed flow, in runs started from `rest`.
    Upward,
    /// From above to below: from jammed to unjammed flow, in runs started from `jammed`, or from rest to back flow.
    Downward,
}

impl Direction {
    /// J/Jmax of the initial state at t = 0: 0 at rest, 1 jammed.
    fn initial_ratio(self) -> f64 {
        match self {
            Self::Upward => 0.0,
            Self::Downward => 1.0,
        }
    }

    fn is_beyond(self, ratio: f64, threshold: f64) -> bool {
        match self {
            Self::Upward => ratio > threshold,
            Self::Downward => ratio < threshold,
        }
    }
}

/// Transition of one run, or the time up to which it was watched without one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Transition {
    /// The flow changed its kind.
    At {
        /// Transition time tau, in the unit of the period duration.
        time: f64,
        /// First period whose average lies beyond the threshold, from 0.
        period: u64,
    },
    /// The run ended before a transition was complete: a lower bound, which an estimator must use and not drop.
    Censored {
        /// Time up to which a transition would have been found ([`watched`]), in the unit of the period duration.
        time: f64,
    },
}

impl Transition {
    /// Outcome of a run of whose period nothing is known: the time of its transition, or up to which it was watched without one.
    pub fn new(time: f64, observed: bool) -> Self {
        match observed {
            true => Self::At { time, period: 0 },
            false => Self::Censored { time },
        }
    }

    /// Time of the transition or, where none was observed, up to which the run was watched; and whether one was.
    pub fn time(self) -> (f64, bool) {
        match self {
            Self::At { time, .. } => (time, true),
            Self::Censored { time } => (time, false),
        }
    }

    /// Transition time tau, or `None` for a censored run.
    pub fn observed(self) -> Option<f64> {
        let (time, observed) = self.time();
        observed.then_some(time)
    }
}

/// A crossing under way: beyond the threshold for fewer than the periods that confirm it, or confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Crossing {
    time: f64,
    period: u64,
    confirmed_periods: u32,
}

/// Finds the transition of a run while it goes on, fed with one period average after another.
///
/// A *crossing* is a period k whose average m_k lies beyond the threshold (strictly above it for
/// [`Direction::Upward`], strictly below it for [`Direction::Downward`]) while the average before does not. The
/// transition is the first crossing with m_k, m_(k+1) and m_(k+2) all beyond the threshold; a crossing that falls back
/// earlier is forgotten. With theta the threshold and T the period,
///
/// tau = t_(k-1) + (t_k - t_(k-1)) (theta - m_(k-1))/(m_k - m_(k-1)),   t_k = (k + 1/2) T
///
/// the straight line between the middles of the two periods. Before the first period stands the initial state, m = 0
/// at rest or 1 jammed, at t = 0, so that a run that is beyond the threshold in its first period has 0 <= tau < T/2:
/// 0 where the initial state is not short of the threshold either.
/// A run of n periods without one is censored at (n - 5/2) T ([`watched`]): a crossing before would have been confirmed, and
/// one after, if it is under way, is not yet.
///
/// ```
/// use peristalsis_analysis::{Direction, Transition, TransitionDetector};
/// let mut detector = TransitionDetector::new(Direction::Upward, 0.5, 10.0)?;
/// for average in [0.1, 0.4, 0.8, 0.9] {
///     detector.push(average)?;
/// }
/// assert_eq!(detector.outcome(), Transition::Censored { time: 15.0 });
/// // A quarter of the way from the middle of period 1 to the middle of period 2.
/// assert_eq!(detector.push(0.9)?, Transition::At { time: 17.5, period: 2 });
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TransitionDetector {
    direction: Direction,
    threshold: f64,
    period_duration: f64,
    periods: u64,
    /// Periods with an average in a row, up to the last.
    in_a_row: u32,
    /// Periods up to the last at which a crossing could be confirmed.
    confirmable: u64,
    last_average: f64,
    crossing: Option<Crossing>,
}

impl TransitionDetector {
    /// A detector at the start of a run. There J/Jmax is 0 for [`Direction::Upward`] and 1 for
    /// [`Direction::Downward`] unless [`starting_at`](Self::starting_at) says otherwise.
    ///
    /// `threshold` of J/Jmax, any finite number: below 0 for back flow; `period_duration` T = lambda/c in the unit of the
    /// times to report (1 for times in periods).
    ///
    /// # Errors
    /// [`Error::Threshold`], [`Error::PeriodDuration`].
    pub fn new(direction: Direction, threshold: f64, period_duration: f64) -> Result<Self, Error> {
        let duration = period_duration;
        ensure(threshold.is_finite(), Error::Threshold { threshold })?;
        ensure(
            duration > 0.0 && duration.is_finite(),
            Error::PeriodDuration { duration },
        )?;
        Ok(Self {
            direction,
            threshold,
            period_duration,
            periods: 0,
            in_a_row: 0,
            confirmable: 0,
            last_average: direction.initial_ratio(),
            crossing: None,
        })
    }

    /// The detector of a run whose J/Jmax is `ratio` at t = 0.
    #[must_use]
    pub fn starting_at(self, ratio: f64) -> Self {
        Self {
            last_average: ratio,
            ..self
        }
    }

    /// Takes the average of J/Jmax over the next period and returns the outcome so far.
    ///
    /// Once found, a transition does not change any more.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with the number of the period; the detector is then as it was before.
    pub fn push(&mut self, average: f64) -> Result<Transition, Error> {
        let (index, value) = (self.periods as usize, average);
        ensure(average.is_finite(), Error::NonFinite { index, value })?;
        if !self.is_complete() {
            let mut crossing = self.crossing.unwrap_or_else(|| Crossing {
                time: self.crossing_time(average),
                period: self.periods,
                confirmed_periods: 0,
            });
            crossing.confirmed_periods += 1;
            let is_beyond = self.direction.is_beyond(average, self.threshold);
            self.crossing = is_beyond.then_some(crossing);
        }
        self.last_average = average;
        self.periods += 1;
        self.in_a_row = self.in_a_row.saturating_add(1);
        if self.in_a_row >= CONFIRMATION_PERIODS {
            self.confirmable = self.periods;
        }
        Ok(self.outcome())
    }

    /// Takes a period without an average, as of a wave that stands still: a crossing under way is forgotten. The line to the
    /// next average begins with the last one, as if it were of the period before; where that lies beyond the threshold too, the
    /// crossing is where the line begins.
    pub fn skip(&mut self) {
        if !self.is_complete() {
            self.crossing = None;
        }
        self.periods += 1;
        self.in_a_row = 0;
    }

    /// The transition, or the time up to which the run has been watched without one.
    pub fn outcome(&self) -> Transition {
        match self.crossing {
            Some(Crossing { time, period, .. }) if self.is_complete() => {
                Transition::At { time, period }
            }
            _ => Transition::Censored {
                time: self.watched(),
            },
        }
    }

    /// Time up to which a transition is found in the periods so far: [`watched`] of those up to the last three in a row that
    /// have an average.
    pub fn watched(&self) -> f64 {
        watched(self.confirmable, self.period_duration)
    }

    /// Whether the transition has been found, so that a run need not go on for its sake.
    pub fn is_complete(&self) -> bool {
        self.crossing
            .is_some_and(|crossing| crossing.confirmed_periods >= CONFIRMATION_PERIODS)
    }

    /// Time at which the straight line from the last average to this one meets the threshold.
    fn crossing_time(&self, average: f64) -> f64 {
        let middle = self.periods as f64 + 0.5;
        let previous = if self.periods == 0 { 0.0 } else { middle - 1.0 };
        let fraction = (self.threshold - self.last_average) / (average - self.last_average);
        // It is elsewhere, or no number, only where the initial state is beyond the threshold, or what came before a pause:
        // that begins the line, and the flow has been beyond since.
        let is_between = (0.0..=1.0).contains(&fraction);
        let fraction = if is_between { fraction } else { 0.0 };
        (previous + (middle - previous) * fraction) * self.period_duration
    }
}

/// Transition time of a finished run from its period averages; [`TransitionDetector`] states the definition.
///
/// `averages`: those of all whole periods from the start of the run; with two or fewer the run is censored at time 0.
///
/// # Errors
/// [`Error::NonFinite`] with the period at fault, [`Error::Threshold`], [`Error::PeriodDuration`].
pub fn transition_time(
    averages: &[f64],
    direction: Direction,
    threshold: f64,
    period_duration: f64,
) -> Result<Transition, Error> {
    let mut detector = TransitionDetector::new(direction, threshold, period_duration)?;
    for &average in averages {
        detector.push(average)?;
    }
    Ok(detector.outcome())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn upward(means: &[f64]) -> Transition {
        transition_time(means, Direction::Upward, 0.5, 2.0).unwrap()
    }

    fn downward(means: &[f64]) -> Transition {
        transition_time(means, Direction::Downward, 0.5, 2.0).unwrap()
    }

    #[test]
    fn a_step_is_crossed_halfway_between_the_middles_of_its_periods() {
        // Middles at 1, 3, 5, ...: from 0 at t = 5 to 1 at t = 7.
        let step = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert_eq!(
            upward(&step),
            Transition::At {
                time: 6.0,
                period: 3
            }
        );
        let mirrored = step.map(|ratio| 1.0 - ratio);
        assert_eq!(downward(&mirrored), upward(&step));
    }

    #[test]
    fn the_first_period_is_joined_to_the_initial_state() {
        // From 0 at t = 0 to 0.8 at t = 1.
        let Transition::At { time, period } = upward(&[0.8, 0.9, 0.9]) else {
            panic!("crosses at once");
        };
        assert!((time - 0.625).abs() < 1e-15);
        assert_eq!(period, 0);
        // From 1 at t = 0 to 0.25 at t = 1: two thirds of the way.
        let time = downward(&[0.25, 0.1, 0.1]).observed().unwrap();
        assert!((time - 2.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_flicker_shorter_than_three_periods_does_not_count() {
        let flicker = [0.1, 0.9, 0.9, 0.1, 0.2, 0.6, 0.7, 0.8, 0.1];
        let Transition::At { time, period } = upward(&flicker) else {
            panic!("the second crossing is confirmed");
        };
        assert_eq!(period, 5);
        // From 0.2 at t = 9 to 0.6 at t = 11.
        assert!((time - 10.5).abs() < 1e-12);
    }

    #[test]
    fn the_threshold_itself_is_not_beyond_the_threshold() {
        assert_eq!(upward(&[0.5; 8]), Transition::Censored { time: 11.0 });
        assert_eq!(downward(&[0.5; 8]), Transition::Censored { time: 11.0 });
    }

    #[test]
    fn runs_that_end_early_are_censored_before_a_crossing_under_way() {
        assert_eq!(upward(&[]), Transition::Censored { time: 0.0 });
        assert_eq!(upward(&[0.1; 4]), Transition::Censored { time: 3.0 });
        // A crossing at 1.5 T with two of its three periods.
        assert_eq!(upward(&[0.1, 0.9, 0.9]), Transition::Censored { time: 1.0 });
        assert_eq!(upward(&[0.1, 0.9, 0.9]).observed(), None);
    }

    /// A newcomer: a wave that stood from the fifth period on, for ever, counted as watched until then.
    #[test]
    fn periods_without_an_average_are_not_watched() {
        let mut detector = TransitionDetector::new(Direction::Upward, 0.5, 2.0).unwrap();
        for average in [0.1, 0.2, 0.4, 0.6] {
            detector.push(average).unwrap();
        }
        assert_eq!(detector.watched(), 3.0);
        (0..20).for_each(|_| detector.skip());
        assert_eq!(detector.watched(), 3.0);
        // Two are too few to confirm a crossing.
        detector.push(0.1).unwrap();
        detector.push(0.1).unwrap();
        assert_eq!(detector.watched(), 3.0);
        detector.push(0.1).unwrap();
        assert_eq!(detector.outcome(), Transition::Censored { time: 49.0 });
    }

    #[test]
    fn a_crossing_that_falls_back_is_forgotten_and_the_next_one_is_confirmed() {
        let mut detector = TransitionDetector::new(Direction::Upward, 0.5, 2.0).unwrap();
        let completes = [0.0, 1.0, 0.0, 1.0, 1.0, 1.0].map(|average| {
            detector.push(average).unwrap();
            detector.is_complete()
        });
        assert_eq!(completes, [false, false, false, false, false, true]);
        assert_eq!(detector.outcome().observed(), Some(6.0));
    }

    #[test]
    fn bad_input_is_refused_and_leaves_the_detector_as_it_was() {
        let mut detector = TransitionDetector::new(Direction::Upward, 0.5, 2.0).unwrap();
        detector.push(0.3).unwrap();
        let before = detector.clone();
        assert_refused!(detector.push(f64::NAN) => NonFinite { index: 1, .. });
        assert_eq!(detector, before);
        for threshold in [f64::INFINITY, f64::NAN] {
            let refused = TransitionDetector::new(Direction::Upward, threshold, 2.0);
            assert!(matches!(refused, Err(Error::Threshold { .. })));
        }
        for duration in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            let refused = TransitionDetector::new(Direction::Upward, 0.5, duration);
            assert!(matches!(refused, Err(Error::PeriodDuration { .. })));
        }
    }

    /// The definition read word for word: the first period from which three averages lie beyond, none before it.
    fn by_definition(means: &[f64], direction: Direction, threshold: f64) -> Option<usize> {
        let beyond = |ratio: &f64| match direction {
            Direction::Upward => *ratio > threshold,
            Direction::Downward => *ratio < threshold,
        };
        means.windows(3).position(|three| three.iter().all(beyond))
    }

    fn direction() -> impl Strategy<Value = Direction> {
        prop_oneof![Just(Direction::Upward), Just(Direction::Downward)]
    }

    proptest! {
        #[test]
        fn the_detector_agrees_with_the_definition_and_survives_serialisation(
            means in prop::collection::vec(-0.2..1.2_f64, 0..40),
            direction in direction(),
            threshold in -0.3..1.3_f64,
            interruption in 0_usize..40,
        ) {
            let mut detector = TransitionDetector::new(direction, threshold, 3.0).unwrap();
            for (k, &average) in means.iter().enumerate() {
                if k == interruption {
                    let bytes = postcard::to_stdvec(&detector).unwrap();
                    detector = postcard::from_bytes(&bytes).unwrap();
                }
                detector.push(average).unwrap();
            }
            let batch = transition_time(&means, direction, threshold, 3.0).unwrap();
            prop_assert_eq!(detector.outcome(), batch);
            match by_definition(&means, direction, threshold) {
                None => prop_assert_eq!(
                    batch,
                    Transition::Censored { time: 3.0 * (means.len() as f64 - 2.5).max(0.0) }
                ),
                Some(first) => {
                    let Transition::At { time, period } = batch else {
                        panic!("missed the transition at {first}");
                    };
                    prop_assert_eq!(period, first as u64);
                    let middle = (first as f64 + 0.5) * 3.0;
                    prop_assert!(time <= middle && time >= (middle - 3.0).max(0.0));
                    // Where it is confirmed just now, it is before the time up to which the run was watched; a period
                    // earlier it was after that.
                    prop_assert!(time <= watched(first as u64 + 3, 3.0));
                    prop_assert!(time >= watched(first as u64 + 2, 3.0));
                }
            }
        }

        #[test]
        fn upward_and_downward_mirror_each_other(
            means in prop::collection::vec(0.0..1.0_f64, 0..40),
        ) {
            let mirrored: Vec<f64> = means.iter().map(|ratio| 1.0 - ratio).collect();
            match (upward(&means), downward(&mirrored)) {
                (Transition::At { time: a, period: k }, Transition::At { time: b, period: l }) => {
                    prop_assert_eq!(k, l);
                    prop_assert!((a - b).abs() < 1e-9);
                }
                (a, b) => prop_assert_eq!(a, b),
            }
        }
    }
}
