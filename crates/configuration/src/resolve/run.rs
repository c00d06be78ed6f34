//! Time: the step that divides the time between samples, and the number of both.

use super::Context;
use crate::configuration::{Drive, Grains, Observe, Run};
use crate::error::ProblemKind;
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
    let Timing {
        samples,
        interval,
        duration,
        periods,
    } = timing(&keys, drive, observe, context)?;
    let steps_per_sample = rounded_up(interval / keys.time_step).max(1.0);
    // Also false where a quotient of extreme values is not a number.
    let within = samples * steps_per_sample <= limits::MOST_STEPS as f64;
    if !within {
        let length = context.written(LENGTHS);
        return context.refuse(
            ProblemKind::OutOfRange,
            &[length, "run.time_step"],
            format!(
                "a run of {:e} steps is beyond reach",
                samples * steps_per_sample
            ),
            format!(
                "at most {:e} steps: a shorter run, or a longer run.time_step",
                limits::MOST_STEPS as f64
            ),
        );
    }
    let neighbour_skin = if context.given("run.neighbour_skin") {
        keys.neighbour_skin
    } else {
        NEIGHBOUR_SKIN_RATIO * grains.diameter_max
    };
    Some(Run {
        periods,
        duration,
        time_step: interval / steps_per_sample,
        steps_per_sample: steps_per_sample as u64,
        samples: samples as u64,
        neighbour_skin,
        ..keys
    })
}

/// Samples (a whole number), the time between them, and the length in time and in periods.
struct Timing {
    samples: f64,
    interval: f64,
    duration: f64,
    periods: Option<f64>,
}

fn timing(
    keys: &Run,
    drive: &Drive,
    observe: &Observe,
    context: &mut Context<'_>,
) -> Option<Timing> {
    let Some(period) = drive.period() else {
        if !context.given("run.duration") {
            let rate = context.written(RATES);
            return context.refuse(
                ProblemKind::Inconsistent,
                &["run.periods", rate],
                format!("{rate} = 0 is a static wave, which has no period to count in"),
                "give run.duration instead of run.periods (--set run.duration=100 replaces the preset's periods)"
                    .into(),
            );
        }
        let (duration, samples) = (keys.duration, SAMPLES_OF_A_STATIC_RUN as f64);
        return Some(Timing {
            samples,
            interval: duration / samples,
            duration,
            periods: None,
        });
    };
    let given = keys.periods.unwrap_or(keys.duration / period);
    let per_period = f64::from(observe.samples_per_period);
    let samples = rounded_up(given * per_period).max(1.0);
    if !(samples <= limits::MOST_SAMPLES as f64 && period.is_finite()) {
        let length = context.written(LENGTHS);
        return context.refuse(
            ProblemKind::OutOfRange,
            &[length, "observe.samples_per_period"],
            format!("a run of {samples:e} samples is beyond reach"),
            format!(
                "at most {:e} samples: a shorter run, or fewer samples a period",
                limits::MOST_SAMPLES as f64
            ),
        );
    }
    let periods = samples / per_period;
    Some(Timing {
        samples,
        interval: period / per_period,
        duration: periods * period,
        periods: Some(periods),
    })
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
