//! Values that follow time: constant, a ramp, steps.

/// A piecewise linear function of time.
///
/// Constant before the first and after the last knot; two knots at one time are a step, whose later value holds from
/// that time on.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Schedule {
    /// (time \[t\], value), times ascending; never empty.
    knots: Vec<(f64, f64)>,
}

impl Schedule {
    /// The same value at all times.
    pub fn constant(value: f64) -> Self {
        Self {
            knots: vec![(0.0, value)],
        }
    }

    /// Through the given knots; `None` unless there is one at least, all finite, in order of time.
    pub fn through(knots: Vec<(f64, f64)>) -> Option<Self> {
        let finite = knots
            .iter()
            .all(|&(time, value)| time.is_finite() && value.is_finite());
        let ordered = knots.windows(2).all(|pair| pair[0].0 <= pair[1].0);
        (finite && ordered && !knots.is_empty()).then_some(Self { knots })
    }

    /// The schedule of a linear function of this one: the same times, mapped values.
    #[must_use]
    pub fn map(&self, linear: impl Fn(f64) -> f64) -> Self {
        Self {
            knots: self
                .knots
                .iter()
                .map(|&(time, value)| (time, linear(value)))
                .collect(),
        }
    }

    /// The knots (time, value).
    pub fn knots(&self) -> &[(f64, f64)] {
        &self.knots
    }

    /// Knots at or before `time`.
    fn passed(&self, time: f64) -> usize {
        self.knots.partition_point(|knot| knot.0 <= time)
    }

    /// Value at `time`.
    pub fn value(&self, time: f64) -> f64 {
        match self.passed(time) {
            0 => self.knots[0].1,
            passed if passed == self.knots.len() => self.knots[passed - 1].1,
            passed => {
                let ((start, from), (end, to)) = (self.knots[passed - 1], self.knots[passed]);
                from + (to - from) * ((time - start) / (end - start))
            }
        }
    }

    /// Slope at `time`, from the right.
    pub fn rate(&self, time: f64) -> f64 {
        match self.passed(time) {
            0 => 0.0,
            passed if passed == self.knots.len() => 0.0,
            passed => {
                let ((start, from), (end, to)) = (self.knots[passed - 1], self.knots[passed]);
                (to - from) / (end - start)
            }
        }
    }

    /// Sum of the steps after `start` and up to `end`: how much the value jumps in that time.
    pub fn jump(&self, start: f64, end: f64) -> f64 {
        self.knots
            .windows(2)
            .filter(|pair| pair[0].0 == pair[1].0 && pair[1].0 > start && pair[1].0 <= end)
            .map(|pair| pair[1].1 - pair[0].1)
            .sum()
    }

    /// Integral from 0 to `time` >= 0.
    pub fn integral(&self, time: f64) -> f64 {
        if let [(_, value)] = self.knots[..] {
            return value * time;
        }
        let mut sum = 0.0;
        let mut reached = 0.0;
        for &(knot, _) in &self.knots {
            let end = knot.clamp(0.0, time);
            if end > reached {
                sum += (end - reached) * self.value(0.5 * (reached + end));
                reached = end;
            }
        }
        sum + (time - reached) * self.value(0.5 * (reached + time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_is_constant_and_integrates_to_a_product() {
        let schedule = Schedule::constant(0.05);
        assert_eq!(schedule.value(17.0), 0.05);
        assert_eq!(schedule.rate(17.0), 0.0);
        assert_eq!(schedule.integral(17.0), 0.05 * 17.0);
    }

    #[test]
    fn ramps_and_steps() {
        let schedule =
            Schedule::through(vec![(1.0, 2.0), (3.0, 6.0), (5.0, 6.0), (5.0, 1.0)]).unwrap();
        for (time, value) in [(0.0, 2.0), (2.0, 4.0), (4.0, 6.0), (5.0, 1.0), (9.0, 1.0)] {
            assert_eq!(schedule.value(time), value, "at {time}");
        }
        assert_eq!(schedule.rate(2.0), 2.0);
        assert_eq!(schedule.jump(4.9, 5.0), -5.0);
        assert_eq!(schedule.jump(5.0, 9.0) + schedule.jump(0.0, 4.9), 0.0);
        // 2 (constant) + 8 (ramp) + 12 (plateau) + 4 (after the step)
        assert!((schedule.integral(9.0) - 26.0).abs() < 1e-12);
    }

    #[test]
    fn disorder_and_nothing_are_refused() {
        assert!(Schedule::through(vec![]).is_none());
        assert!(Schedule::through(vec![(1.0, 0.0), (0.0, 0.0)]).is_none());
        assert!(Schedule::through(vec![(0.0, f64::NAN)]).is_none());
    }
}
