//! Driving a run while it goes on.

use peristalsis_configuration::{Configuration, Schedule, ScheduledParameter, word};
use peristalsis_physics::wall::Schedule as Course;

use super::Run;
use crate::assemble::{frequency, walls};
use crate::error::RunError;

/// Largest force amplitude and strain rate, as for the keys of the drive.
const LARGEST: f64 = 1e6;

/// Time from `now` on in which the integral of `frequency` grows by `cycles`; `None` where it never does.
fn time_of_cycles(frequency: &Course, now: f64, cycles: f64) -> Option<f64> {
    let last = frequency.knots().last().map_or(now, |knot| knot.0.max(now));
    let grown = |time: f64| frequency.integral(time) - frequency.integral(now);
    if grown(last) < cycles {
        // After the last knot a constant rate gives cycles/rate to the bit.
        let time = (last - now) + (cycles - grown(last)) / frequency.value(last);
        return time.is_finite().then_some(time);
    }
    let (mut least, mut most) = (now, last);
    // Until no number lies between.
    while let middle = 0.5 * (least + most)
        && least < middle
        && middle < most
    {
        match grown(middle) < cycles {
            true => least = middle,
            false => most = middle,
        }
    }
    Some(most - now)
}

fn still_follows(parameter: ScheduledParameter) -> RunError {
    let reason = format!("drive.{} still follows its schedule", word(parameter));
    RunError::Steering { reason }
}

impl Run {
    /// The value of a parameter of the drive for the next step, in the units of its key; `None` for the amplitude of the other
    /// control.
    pub fn driven(&self, parameter: ScheduledParameter) -> Option<f64> {
        let own = self.configuration.drive.own(parameter)?;
        let schedule = self.schedule(parameter);
        Some(schedule.map_or(own, |schedule| schedule.value(self.soonest())))
    }

    /// Time until the wave has run so many wavelengths more, under the drive as it is scheduled \[t\]; `None` where it never
    /// does.
    pub fn time_of_periods(&self, periods: f64) -> Option<f64> {
        time_of_cycles(
            &frequency(&self.configuration),
            self.simulation.time(),
            periods,
        )
    }

    /// Whether a parameter of the drive stays what it is.
    pub fn is_at_rest(&self, parameter: ScheduledParameter) -> bool {
        self.schedule(parameter)
            .is_none_or(|schedule| schedule.rest() <= self.soonest())
    }

    /// Refuses a parameter of the drive that its schedule still leads for more than so many periods.
    ///
    /// # Errors
    /// [`RunError::Steering`].
    pub fn check_free(&self, parameter: ScheduledParameter, periods: f64) -> Result<(), RunError> {
        let free_from = self.soonest() + periods;
        match self.schedule(parameter) {
            Some(schedule) if schedule.rest() > free_from => Err(still_follows(parameter)),
            _ => Ok(()),
        }
    }

    /// The value that a parameter of the drive has now, if it could be led to `value`.
    ///
    /// # Errors
    /// As [`Run::drive_to`], but for a parameter that is under way.
    pub fn check_drive(&self, parameter: ScheduledParameter, value: f64) -> Result<f64, RunError> {
        let refused = |reason: String| Err(RunError::Steering { reason });
        let name = format!("drive.{}", word(parameter));
        let most = match parameter {
            ScheduledParameter::Width => 2.0 * self.configuration.tube.radius,
            _ => LARGEST,
        };
        let Some(now) = self.driven(parameter) else {
            return refused(format!("{name} belongs to the other drive.control"));
        };
        if self.configuration.drive.period().is_none() {
            return refused(format!("{name} cannot follow a wave that stands still"));
        }
        if value > most {
            return refused(format!("{name} = {value} is above {most}"));
        }
        if value.is_nan() || value < 0.0 {
            return refused(format!("{name} = {value} is not a number from 0 on"));
        }
        let (period, step) = (1.0 / value, self.configuration.run.time_step);
        if parameter == ScheduledParameter::StrainRate && period < step {
            return refused(format!(
                "drive.strain_rate = {value} makes a period of {period:.3e}, shorter than a step of {step:.3e}: begin with a \
                 shorter run.time_step"
            ));
        }
        Ok(now)
    }

    /// Leads a parameter of the drive to `value` within `periods` periods, linearly in time, beginning with the next step.
    /// Within 0 periods it jumps there; what the jump does to the contacts counts as work of the wall.
    ///
    /// The [configuration](Run::configuration) keeps the course: a run from its start, or from a checkpoint, takes the same
    /// course to the same bits. A `value` that the parameter already has changes no bit.
    ///
    /// # Errors
    /// [`RunError::Steering`] for a value out of range, for a period shorter than a step, where the wave stands still (its
    /// periods never pass), and while the parameter is still under way; nothing is changed then.
    pub fn drive_to(
        &mut self,
        parameter: ScheduledParameter,
        value: f64,
        periods: f64,
    ) -> Result<(), RunError> {
        let now = self.check_drive(parameter, value)?;
        if value == now && self.is_at_rest(parameter) {
            return Ok(());
        }
        let start = self.soonest();
        let going_on = self
            .schedule(parameter)
            .cloned()
            .unwrap_or_else(|| Schedule::resting(parameter, now))
            .going_on(start, start + periods, value);
        let Some(schedule) = going_on else {
            return Err(still_follows(parameter));
        };
        let mut configuration = self.configuration.clone();
        let schedules = &mut configuration.drive.schedules;
        schedules.retain(|known| known.parameter != parameter);
        schedules.push(schedule);
        schedules.sort_by_key(|schedule| schedule.parameter);
        self.simulation.drive_by(walls(&configuration))?;
        self.configuration = configuration;
        self.steered = true;
        self.last_to_next_sample();
        Ok(())
    }

    /// Extends the configured length to the next sample, if it is shorter. A run that goes on past its end is a longer run,
    /// and its configuration repeats it. (A static wave has a number of samples whatever its length, and keeps it.)
    pub(super) fn last_to_next_sample(&mut self) {
        let Configuration {
            run,
            observe,
            drive,
            ..
        } = &mut self.configuration;
        let samples = self.simulation.step() / run.steps_per_sample + 1;
        let (Some(period), true) = (drive.period(), samples > run.samples) else {
            return;
        };
        let periods = samples as f64 / f64::from(observe.samples_per_period);
        run.samples = samples;
        (run.periods, run.duration) = (Some(periods), periods * period);
    }

    /// Gives contacts this coefficient of kinetic friction from the next step on, and a static one in the proportion that
    /// they had.
    ///
    /// The configuration keeps the coefficients that hold now: a checkpoint goes on with them, but a run from the start
    /// would have them from the start.
    ///
    /// # Errors
    /// [`RunError::Steering`] where grains have no friction, or for a coefficient that is not above 0 and at most 1e6.
    pub fn set_friction(&mut self, kinetic: f64) -> Result<(), RunError> {
        let mut configuration = self.configuration.clone();
        let Some(friction) = &mut configuration.contact.friction else {
            let reason = "its grains began without friction".to_owned();
            return Err(RunError::Steering { reason });
        };
        if !(kinetic > 0.0 && kinetic <= LARGEST) {
            let reason = format!(
                "a coefficient of friction of {kinetic} is not above 0 and at most {LARGEST:e}"
            );
            return Err(RunError::Steering { reason });
        }
        let proportion = if friction.kinetic_friction > 0.0 {
            friction.static_friction / friction.kinetic_friction
        } else {
            1.0
        };
        friction.kinetic_friction = kinetic;
        friction.static_friction = (proportion * kinetic).max(kinetic);
        let (fixed, sliding) = (friction.static_friction, friction.kinetic_friction);
        self.simulation.set_friction(fixed, sliding)?;
        self.configuration = configuration;
        Ok(())
    }

    fn schedule(&self, parameter: ScheduledParameter) -> Option<&Schedule> {
        self.configuration.drive.schedule(parameter)
    }

    /// When the next course can begin, in periods: between two steps, so that no step sees half of it.
    fn soonest(&self) -> f64 {
        let run = &self.configuration.run;
        let period = self.configuration.drive.period().unwrap_or(1.0);
        (self.simulation.step() as f64 + 0.5) * run.time_step / period
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn periods_last_until_the_wave_has_run_them() {
        let constant = Course::constant(0.05);
        assert_eq!(time_of_cycles(&constant, 7.0, 3.0), Some(3.0 / 0.05));
        // From 0 to 0.05 within 40, one wavelength in all, and 0.05 from then on.
        let ramp = Course::through(vec![(0.0, 0.0), (40.0, 0.05)]).unwrap();
        let of = |now: f64, cycles: f64| time_of_cycles(&ramp, now, cycles).unwrap();
        assert!((of(0.0, 0.25) - 20.0).abs() < 1e-9);
        assert!((of(20.0, 1.75) - 40.0).abs() < 1e-9);
        // A pause, after which the wave goes on; and one without an end.
        let pause = [(10.0, 0.1), (10.0, 0.0), (30.0, 0.0), (30.0, 0.2)];
        let [through, for_ever] = [4, 3].map(|knots| Course::through(pause[..knots].to_vec()));
        assert!((time_of_cycles(&through.unwrap(), 0.0, 2.0).unwrap() - 35.0).abs() < 1e-9);
        assert_eq!(time_of_cycles(&for_ever.unwrap(), 0.0, 1.5), None);
    }
}
