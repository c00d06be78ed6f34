//! Time: the step that divides the time between samples, and the number of both.

use super::Context;
use crate::configuration::{Drive, Grains, Observe, Run};
use crate::defaults;
use crate::error::ProblemKind;
use crate::keys::RunKeys;
use crate::options::{Integrator, Kernel};

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
    keys: &RunKeys,
    drive: &Drive,
    grains: &Grains,
    observe: &Observe,
    context: &mut Context<'_>,
) -> Option<Run> {
    let longest_step = keys.time_step.unwrap_or(defaults::TIME_STEP);
    let Timing {
        samples,
        interval,
        duration,
        periods,
    } = timing(keys, drive, observe, context)?;
    let steps_per_sample = rounded_up(interval / longest_step).max(1.0);
    // Also false where a quotient of extreme values is not a number.
    let within = samples * steps_per_sample <= defaults::MOST_STEPS as f64;
    if !within {
        let length = context.written(&["run.periods", "run.duration"]);
        context.refuse(
            ProblemKind::OutOfRange,
            &[length, "run.time_step"],
            format!(
                "a run of {:e} steps is beyond reach",
                samples * steps_per_sample
            ),
            format!(
                "at most {:e} steps: a shorter run, or a longer run.time_step",
                defaults::MOST_STEPS as f64
            ),
        );
        return None;
    }
    Some(Run {
        periods,
        duration,
        time_step: interval / steps_per_sample,
        steps_per_sample: steps_per_sample as u64,
        samples: samples as u64,
        integrator: keys.integrator.unwrap_or(Integrator::Verlet),
        kernel: keys.kernel.unwrap_or(Kernel::Fast),
        seed: keys.seed.unwrap_or(defaults::SEED),
        neighbour_skin: keys
            .neighbour_skin
            .unwrap_or(defaults::NEIGHBOUR_SKIN_RATIO * grains.diameter_max),
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
    keys: &RunKeys,
    drive: &Drive,
    observe: &Observe,
    context: &mut Context<'_>,
) -> Option<Timing> {
    let Some(period) = drive.period() else {
        let Some(duration) = keys.duration else {
            let rate = context.written(&[
                "drive.strain_rate",
                "drive.wave_speed",
                "units.wave_frequency",
            ]);
            context.refuse(
                ProblemKind::Inconsistent,
                &["run.periods", rate],
                format!("{rate} = 0 is a static wave, which has no period to count in"),
                "give run.duration instead of run.periods (--set run.duration=100 replaces the preset's periods)"
                    .into(),
            );
            return None;
        };
        let samples = defaults::SAMPLES_OF_A_STATIC_RUN as f64;
        return Some(Timing {
            samples,
            interval: duration / samples,
            duration,
            periods: None,
        });
    };
    let given = match (keys.periods, keys.duration) {
        (Some(periods), _) => periods,
        (_, Some(duration)) => duration / period,
        (None, None) => return None,
    };
    let per_period = f64::from(observe.samples_per_period);
    let samples = rounded_up(given * per_period).max(1.0);
    if !(samples <= defaults::MOST_SAMPLES as f64 && period.is_finite()) {
        let length = context.written(&["run.periods", "run.duration"]);
        context.refuse(
            ProblemKind::OutOfRange,
            &[length, "observe.samples_per_period"],
            format!("a run of {samples:e} samples is beyond reach"),
            format!(
                "at most {:e} samples: a shorter run, or fewer samples a period",
                defaults::MOST_SAMPLES as f64
            ),
        );
        return None;
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
