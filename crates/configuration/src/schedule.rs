//! Parameters of the drive that follow time.

use serde::Serialize;

use crate::configuration::{Configuration, Control, Drive};

/// A parameter of the drive that may follow a schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ScheduledParameter {
    /// w \[d\], strain control.
    Width,
    /// f^P \[m d t^-2\], stress control.
    ForceAmplitude,
    /// c/lambda \[t^-1\].
    StrainRate,
}

/// The course of one parameter of the drive in time; times in periods of the drive's own strain rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// What follows the schedule.
    pub parameter: ScheduledParameter,
    /// How.
    pub(crate) form: ScheduleForm,
    /// The parameter's own value, which holds before the first step.
    pub(crate) before: f64,
}

/// Form of a [`Schedule`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ScheduleForm {
    /// Two pairs (time in periods, value) between which the value is linear in time, constant before and after.
    Ramp([(f64, f64); 2]),
    /// (time in periods, value), times ascending, at least one: each value from its time on.
    Steps(Vec<(f64, f64)>),
    /// Such pairs between which the value is linear in time, constant before the first and after the last; of two at one
    /// time the later holds from then on.
    Course(Vec<(f64, f64)>),
}

impl Schedule {
    /// A course that has been at `value` up to now.
    pub fn resting(parameter: ScheduledParameter, value: f64) -> Self {
        Self {
            parameter,
            form: ScheduleForm::Course(vec![(0.0, value)]),
            before: value,
        }
    }

    /// This schedule up to `start`, then linear in time to `value` at `end`, then constant; times in periods. Where `end`
    /// equals `start` it jumps, and an earlier jump at that time is forgotten.
    ///
    /// `None` where the schedule has not come to rest by `start`, or `end` is before it: the past does not change.
    pub fn going_on(&self, start: f64, end: f64, value: f64) -> Option<Self> {
        let mut knots = self.knots();
        let &(rest, resting) = knots.last()?;
        if !(rest <= start && start <= end) {
            return None;
        }
        if rest < start {
            knots.push((start, resting));
        } else if start == end && knots.len() > 1 && knots[knots.len() - 2].0 == start {
            knots.pop();
        }
        knots.push((end, value));
        Some(Self {
            form: ScheduleForm::Course(knots),
            ..self.clone()
        })
    }

    /// When it comes to rest, in periods.
    pub fn rest(&self) -> f64 {
        self.knots().last().map_or(0.0, |knot| knot.0)
    }

    /// The course as knots (time in periods, value): linear between knots, constant before the first and after the last;
    /// of two knots at one time the later holds from then on.
    pub fn knots(&self) -> Vec<(f64, f64)> {
        match &self.form {
            ScheduleForm::Ramp(ends) => ends.to_vec(),
            ScheduleForm::Steps(steps) => {
                let mut knots = Vec::with_capacity(2 * steps.len());
                let mut last = self.before;
                for &(time, value) in steps {
                    knots.extend([(time, last), (time, value)]);
                    last = value;
                }
                knots
            }
            ScheduleForm::Course(knots) => knots.clone(),
        }
    }

    /// Least and largest value from the start to a time in periods.
    pub fn range(&self, periods: f64) -> (f64, f64) {
        let knots = self.knots();
        let within = knots.iter().filter(|knot| knot.0 > 0.0 && knot.0 < periods);
        let ends = [self.value(0.0), self.value(periods)];
        let values: Vec<f64> = within.map(|knot| knot.1).chain(ends).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        (least, values.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    /// What this is in short up to a time in periods: its first and its last value, or the least and the largest where it goes
    /// beyond these.
    pub fn extent(&self, periods: f64) -> [f64; 2] {
        let ends = [self.value(0.0), self.value(periods)];
        let (least, largest) = self.range(periods);
        match ends[0].min(ends[1]) > least || ends[0].max(ends[1]) < largest {
            true => [least, largest],
            false => ends,
        }
    }

    /// Value at a time in periods.
    pub fn value(&self, periods: f64) -> f64 {
        match &self.form {
            ScheduleForm::Ramp([(start, from), (end, to)]) => {
                let progress = ((periods - start) / (end - start)).clamp(0.0, 1.0);
                from + (to - from) * progress
            }
            ScheduleForm::Steps(steps) => {
                let passed = steps.partition_point(|(time, _)| *time <= periods);
                passed
                    .checked_sub(1)
                    .map_or(self.before, |last| steps[last].1)
            }
            ScheduleForm::Course(knots) => {
                let passed = knots.partition_point(|(time, _)| *time <= periods);
                let (_, from) = knots[passed.saturating_sub(1)];
                match (passed.checked_sub(1), knots.get(passed)) {
                    (Some(last), Some((end, to))) => {
                        let start = knots[last].0;
                        from + (to - from) * ((periods - start) / (end - start))
                    }
                    _ => from,
                }
            }
        }
    }
}

impl Configuration {
    /// This run under a constant drive as hard on the grains as its schedules ever become: the least width, the largest
    /// force amplitude and the fastest wave. Without schedules it is the run itself.
    pub fn at_its_hardest(&self) -> Self {
        let mut hardest = self.clone();
        let periods = self.run.periods.unwrap_or(0.0);
        for schedule in std::mem::take(&mut hardest.drive.schedules) {
            let (least, most) = schedule.range(periods);
            match schedule.parameter {
                ScheduledParameter::StrainRate => hardest.drive.strain_rate = most,
                ScheduledParameter::Width => hardest.drive.set_amplitude(schedule.parameter, least),
                ScheduledParameter::ForceAmplitude => {
                    hardest.drive.set_amplitude(schedule.parameter, most);
                }
            }
        }
        hardest
    }

    /// This run with each amplitude that has a schedule as it is at t = 0, whatever value it has besides: the same run,
    /// which two configurations share that differ in such a value alone.
    pub fn at_its_start(&self) -> Self {
        let mut start = self.clone();
        for schedule in &mut start.drive.schedules {
            schedule.before = schedule.value(0.0);
        }
        for schedule in start.drive.schedules.clone() {
            start
                .drive
                .set_amplitude(schedule.parameter, schedule.before);
        }
        start
    }
}

impl Drive {
    /// Sets the amplitude of the drive that is led by a parameter; a drive of the other control stays.
    pub fn set_amplitude(&mut self, parameter: ScheduledParameter, value: f64) {
        match (parameter, &mut self.control) {
            (ScheduledParameter::Width, Control::Strain { width }) => *width = value,
            (
                ScheduledParameter::ForceAmplitude,
                Control::Stress {
                    force_amplitude, ..
                },
            ) => *force_amplitude = value,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn width(form: ScheduleForm) -> Schedule {
        Schedule {
            parameter: ScheduledParameter::Width,
            form,
            before: 2.5,
        }
    }

    fn steps(steps: &[(f64, f64)]) -> Schedule {
        width(ScheduleForm::Steps(steps.to_vec()))
    }

    fn assert_values(schedule: &Schedule, values: &[(f64, f64)]) {
        for (time, value) in values {
            assert_eq!(schedule.value(*time), *value, "at {time}");
        }
    }

    #[test]
    fn a_ramp_is_linear_between_its_ends() {
        let ramp = width(ScheduleForm::Ramp([(1.0, 3.0), (5.0, 2.0)]));
        let values = [(0.0, 3.0), (1.0, 3.0), (3.0, 2.5), (5.0, 2.0), (9.0, 2.0)];
        assert_values(&ramp, &values);
        assert_eq!(ramp.knots(), [(1.0, 3.0), (5.0, 2.0)]);
        assert_eq!(ramp.range(9.0), (2.0, 3.0));
        assert_eq!(ramp.range(3.0), (2.5, 3.0), "it ends under way");
    }

    #[test]
    fn a_course_goes_from_value_to_value() {
        let knots = vec![(1.0, 3.0), (2.0, 4.0), (6.0, 2.0)];
        let course = width(ScheduleForm::Course(knots.clone()));
        let values = [(0.0, 3.0), (1.5, 3.5), (2.0, 4.0), (5.0, 2.5), (9.0, 2.0)];
        assert_values(&course, &values);
        assert_eq!(course.knots(), knots);
        assert_eq!(course.extent(9.0), [2.0, 4.0], "it goes beyond its ends");
        assert_eq!(course.extent(2.0), [3.0, 4.0]);
        assert_eq!(
            width(ScheduleForm::Ramp([(1.0, 3.0), (5.0, 2.0)])).extent(9.0),
            [3.0, 2.0]
        );
    }

    #[test]
    fn a_schedule_goes_on_by_ramps_and_jumps() {
        let steps = steps(&[(1.0, 3.0)]);
        assert_eq!(steps.going_on(0.5, 2.0, 2.8), None, "under way");
        assert_eq!(steps.going_on(2.0, 1.5, 2.8), None, "backwards");
        let ramped = steps.going_on(2.0, 4.0, 2.0).unwrap();
        let jumped = ramped.going_on(5.0, 5.0, 2.9).unwrap();
        let thought_better = jumped.going_on(5.0, 5.0, 2.7).unwrap();
        assert_values(&thought_better, &[(0.0, 2.5), (1.0, 3.0), (3.0, 2.5)]);
        assert_values(&thought_better, &[(4.5, 2.0), (5.0, 2.7), (9.0, 2.7)]);
        assert_eq!(jumped.value(5.0), 2.9);
        assert_eq!(jumped.knots().len(), thought_better.knots().len());
    }

    #[test]
    fn steps_hold_from_their_time_on() {
        let two = steps(&[(1.0, 3.0), (2.0, 4.0)]);
        let values = [(0.0, 2.5), (1.0, 3.0), (1.5, 3.0), (2.0, 4.0), (7.0, 4.0)];
        assert_values(&two, &values);
        let knots = [(1.0, 2.5), (1.0, 3.0), (2.0, 3.0), (2.0, 4.0)];
        assert_eq!(two.knots(), knots);
        for (periods, range) in [(0.5, (2.5, 2.5)), (1.0, (2.5, 3.0)), (9.0, (2.5, 4.0))] {
            assert_eq!(two.range(periods), range, "up to {periods}");
        }
        let at_once = steps(&[(0.0, 3.0)]);
        assert_eq!(at_once.range(9.0), (3.0, 3.0), "its own value never holds");
    }
}
