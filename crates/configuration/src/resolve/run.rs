//! Time: the step that divides the time between samples, and the number of both.

use super::Context;
use crate::configuration::{Drive, Observe, Run};
use crate::error::ProblemKind;
use crate::grains::Grains;
use crate::keys::{LENGTHS, RATES};
use crate::limits;

/// Samples in a run without a period (a static wave).
const SAMPLES_OF_A_STATIC_RUN: u64 = 200;
/// Skin of the neighbour search over the largest grain diameter.
const NEIGHBOUR_SKIN_RATIO: f64 = 0.3;

/// Quotients this near to a whole number are taken for it, so that 0.3/0.1 is 3.
const ROUNDING: f64 = 1e-9;

/// `quotient` rounded up, but for rounding errors.
fn rounded_up(quotient: f64) -> f64 {
    let nearest = quotient.round();
    if (quotient - nearest).abs() <= ROUNDING * nearest {
        nearest
    } else {
        quotient.ceil()
    }
}

/// The run of a given drive.
pub(super) fn run(
    keys: Run,
    drive: &Drive,
    grains: &Grains,
    observe: &Observe,
    context: &mut Context<'_>,
) -> Option<Run> {
    let (mut run, interval) = timing(keys, drive, observe, context)?;
    let steps_per_sample = rounded_up(interval / keys.time_step).max(1.0);
    let (steps, most) = (
        run.samples as f64 * steps_per_sample,
        limits::MOST_STEPS as f64,
    );
    // Also false where a quotient of extreme values is not a number.
    let within = steps <= most;
    if !within {
        let keys = [context.written(LENGTHS), "run.time_step"];
        let message = format!("a run of {steps:e} steps is beyond reach");
        let help = format!("at most {most:e} steps: a shorter run, or a longer run.time_step");
        return context.refuse_as(ProblemKind::OutOfRange, &keys, message, help);
    }
    if !context.given("run.neighbour_skin") {
        run.neighbour_skin = NEIGHBOUR_SKIN_RATIO * grains.diameter_max;
    }
    run.time_step = interval / steps_per_sample;
    run.steps_per_sample = steps_per_sample as u64;
    Some(run)
}

/// The run with its samples and its length in time and in periods, and the time between two samples.
fn timing(
    keys: Run,
    drive: &Drive,
    observe: &Observe,
    context: &mut Context<'_>,
) -> Option<(Run, f64)> {
    let Some(period) = drive.period() else {
        if !context.given("run.duration") {
            let rate = context.written(RATES);
            return context.refuse(
                &["run.periods", rate],
                format!("{rate} = 0 is a static wave, which has no period to count in"),
                "give run.duration instead of run.periods (--set run.duration=100 replaces the preset's periods)",
            );
        }
        let (samples, periods) = (SAMPLES_OF_A_STATIC_RUN, None);
        let interval = keys.duration / samples as f64;
        return Some((
            Run {
                samples,
                periods,
                ..keys
            },
            interval,
        ));
    };
    let given = keys.periods.unwrap_or(keys.duration / period);
    let per_period = f64::from(observe.samples_per_period);
    let samples = rounded_up(given * per_period).max(1.0);
    let most = limits::MOST_SAMPLES as f64;
    if !(samples <= most && period.is_finite()) {
        let keys = [context.written(LENGTHS), "observe.samples_per_period"];
        let message = format!("a run of {samples:e} samples is beyond reach");
        let help = format!("at most {most:e} samples: a shorter run, or fewer samples per period");
        return context.refuse_as(ProblemKind::OutOfRange, &keys, message, help);
    }
    let periods = samples / per_period;
    let run = Run {
        periods: Some(periods),
        duration: periods * period,
        samples: samples as u64,
        ..keys
    };
    Some((run, period / per_period))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_round_up_but_for_rounding_errors() {
        assert_eq!(rounded_up(0.3 / 0.1), 3.0);
        assert_eq!(rounded_up(3.001), 4.0);
        assert_eq!(rounded_up(0.2), 1.0);
        assert!(rounded_up(f64::INFINITY).is_infinite());
    }
}
