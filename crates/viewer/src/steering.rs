//! The sliders of a page, and where they lead a run.

use peristalsis_configuration::ScheduledParameter;
use peristalsis_run::{Run, RunError};

use crate::message::Steered;
use crate::timeline::Driven;

/// Periods within which a parameter reaches the value of its slider, so that no wall jumps.
const RAMP: f64 = 0.25;

/// Where the sliders are, and where they led the run. Arrays are in the order of [`Steered::ALL`].
#[derive(Debug, Default)]
pub(crate) struct Steering {
    /// Values that the run has not been led to yet.
    wanted: [Option<f64>; 4],
    /// Values that the sliders were led to last.
    aims: [Option<f64>; 4],
}

impl Steering {
    /// A slider is moved. One whose parameter follows a schedule of the configuration, and not the slider's own ramp, is
    /// refused.
    pub(crate) fn want(
        &mut self,
        run: &Run,
        parameter: Steered,
        value: f64,
    ) -> Result<(), RunError> {
        if let Some(scheduled) = scheduled(parameter) {
            run.check_free(scheduled, RAMP)?;
        }
        self.wanted[parameter as usize] = Some(value);
        self.aim(parameter, value);
        Ok(())
    }

    /// A slider stands at a value that the run was led to.
    pub(crate) fn aim(&mut self, parameter: Steered, value: f64) {
        self.aims[parameter as usize] = Some(value);
    }

    /// A slider that the run can follow now, for its parameter is at rest, with its value; it is wanted no longer.
    pub(crate) fn next(&mut self, run: &Run) -> Option<(Steered, f64)> {
        let free = |it: &Steered| self.wanted[*it as usize].is_some() && !is_on_its_way(run, *it);
        let parameter = Steered::ALL.into_iter().find(free)?;
        let value = self.wanted[parameter as usize].take()?;
        Some((parameter, value))
    }

    /// Leads a parameter to a value from the present step on.
    pub(crate) fn lead(
        &mut self,
        run: &mut Run,
        parameter: Steered,
        value: f64,
    ) -> Result<(), RunError> {
        match scheduled(parameter) {
            Some(scheduled) => run.drive_to(scheduled, value, RAMP)?,
            None => run.set_friction(value)?,
        }
        self.aim(parameter, value);
        Ok(())
    }

    /// The values that sliders show: where a parameter that is on its way is led to.
    pub(crate) fn aims(&self, run: &Run) -> Driven {
        let mut aims = Driven::of(run);
        for parameter in Steered::ALL {
            let is_led = self.wanted[parameter as usize].is_some() || is_on_its_way(run, parameter);
            let aim = self.aims[parameter as usize].filter(|_| is_led);
            let value = aims.of_mut(parameter);
            *value = value.map(|now| aim.unwrap_or(now));
        }
        aims
    }
}

fn is_on_its_way(run: &Run, parameter: Steered) -> bool {
    scheduled(parameter).is_some_and(|it| !run.is_at_rest(it))
}

/// The parameter of the drive that a slider changes; `None` for friction, which no schedule changes.
fn scheduled(parameter: Steered) -> Option<ScheduledParameter> {
    match parameter {
        Steered::Width => Some(ScheduledParameter::Width),
        Steered::ForceAmplitude => Some(ScheduledParameter::ForceAmplitude),
        Steered::StrainRate => Some(ScheduledParameter::StrainRate),
        Steered::Friction => None,
    }
}
