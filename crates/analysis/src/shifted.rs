//! Transition times with a dead time before nucleation at a constant rate.

use crate::error::{Error, ensure};
use crate::lifetime::group_of;
use crate::survival::times;
use crate::transition::Transition;
use crate::uncertain::{Interval, Uncertain};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Probabilities of the narrow and of the wide interval.
const LEVELS: [f64; 2] = [0.682_689_492_137_086, 0.95];

/// Shifted exponential distribution fitted to the transition times of one ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ShiftedExponentialFit {
    /// Dead time t_0 before which no transition happens, corrected for its bias; 0 at least.
    pub dead_time: Uncertain,
    /// Mean waiting time theta after the dead time; 1/theta is the rate.
    pub waiting_time: Uncertain,
    /// Mean `<tau>` = t_0 + theta.
    pub mean: Uncertain,
    /// Variance `chi_tau = theta^2`.
    pub variance: Uncertain,
    /// Largest log-likelihood, comparable with that of a [`LifetimeFit`](crate::LifetimeFit) on the same runs.
    pub log_likelihood: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
}

/// Fits a dead time and a constant rate after it.
///
/// `S(t) = 1` for t < t_0, `exp(-(t - t_0)/theta)` beyond
///
/// With t_1 the first of d transitions, n runs at risk then and T the time that all runs were watched after t_1: theta
/// = T/(d - 1), t_0 = t_1 - theta/n, both without bias. Interval of t_0 from the exact law of n (t_1 - t_0)/theta (F
/// with 2 and 2 (d - 1) degrees of freedom), one-sided as t_0 <= t_1; that of theta from the likelihood of the times
/// after t_1, `-(d - 1) ln theta - T/theta`; that of the mean from theta, whose error is the larger by sqrt(n). Exact
/// without censoring and for runs that are all ended at one transition; else nearly so. Source: Lawless, Statistical
/// Models and Methods for Lifetime Data (2003), section 4.5.
///
/// # Errors
/// [`Error::TooFewObserved`] below 3 transitions, [`Error::NoScatter`] where all of them are at one time,
/// [`Error::NotPositive`], [`Error::NonFinite`], [`Error::Negative`].
///
/// ```
/// use peristalsis_analysis::{Transition, fit_shifted_exponential};
/// let runs = [5.0, 6.0, 10.0].map(|time| Transition::At { time, period: 0 });
/// let fit = fit_shifted_exponential(&runs)?;
/// // Watched after 5: 0 + 1 + 5, for two further transitions; the mean is that of the sample.
/// assert_eq!((fit.waiting_time.value, fit.dead_time.value), (3.0, 4.0));
/// assert_eq!(fit.mean.value, 7.0);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn fit_shifted_exponential(transitions: &[Transition]) -> Result<ShiftedExponentialFit, Error> {
    let group = group_of(transitions, 3)?;
    let observed = group.observed();
    ensure(group.scatters(), Error::NoScatter { observed })?;
    let times = times(transitions)?;
    let transition = |&(time, observed): &(f64, bool)| observed.then_some(time);
    let observed_times = times.iter().filter_map(transition);
    let first = observed_times.fold(f64::INFINITY, f64::min);
    let watched: f64 = times.iter().map(|run| (run.0 - first).max(0.0)).sum();
    let at_risk = times.iter().filter(|run| run.0 >= first).count() as f64;
    let free = observed as f64 - 1.0;
    let theta = watched / free;
    let waiting_time = waiting_time(theta, free);
    let dead = (first - theta / at_risk).max(0.0);
    let error = theta / at_risk;
    let [interval_68, interval_95] = LEVELS.map(|level| {
        let lower = first - error * free * (libm::pow(1.0 - level, -1.0 / free) - 1.0);
        Interval::new(lower.max(0.0), first)
    });
    let dead_time = Uncertain {
        value: dead,
        error,
        interval_68,
        interval_95,
    };
    let theta_error = waiting_time.error * (1.0 - 1.0 / at_risk);
    let mean_error = (theta_error * theta_error + dead_time.error * dead_time.error).sqrt();
    let largest = watched / observed as f64;
    Ok(ShiftedExponentialFit {
        dead_time,
        waiting_time,
        mean: waiting_time.map(mean_error, |theta| dead + theta),
        variance: waiting_time.map(2.0 * theta * waiting_time.error, |theta| theta * theta),
        log_likelihood: -(observed as f64) * (libm::log(largest) + 1.0),
        observed,
        censored: transitions.len() - observed,
    })
}

/// Mean waiting time with the intervals of its likelihood; `free` transitions after the first.
fn waiting_time(theta: f64, free: f64) -> Uncertain {
    let limits = [-40.0, 40.0];
    let log = Uncertain::with_intervals(0.0, 1.0 / free.sqrt(), |deviations| {
        // In the logarithm u of the ratio to theta: free (u + exp(-u) - 1) = z^2/2.
        let excess = |u: f64| free * (u + libm::expm1(-u)) - 0.5 * deviations * deviations;
        Interval::around(0.0, excess, deviations / free.sqrt(), limits, limits)
    });
    log.map(theta / free.sqrt(), |log| theta * libm::exp(log))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::{Coverage, exponential, watched_runs};
    use crate::{Family, fit_lifetime};

    fn sample(seed: u64, runs: usize, until: f64) -> Vec<Transition> {
        let mut randomness = Randomness::new(seed, 4);
        watched_runs(runs, until, || 4.0 + 6.0 * exponential(&mut randomness))
    }

    #[test]
    fn intervals_cover_with_a_quarter_censored() {
        let parameters = [
            ("dead", 4.0),
            ("waiting", 6.0),
            ("mean", 10.0),
            ("variance", 36.0),
        ];
        let mut coverage = Coverage::of(parameters);
        for seed in 0..400 {
            let fit = fit_shifted_exponential(&sample(seed, 30, 12.5)).unwrap();
            coverage.count([fit.dead_time, fit.waiting_time, fit.mean, fit.variance]);
        }
        coverage.judge([0.01; 2]);
    }

    #[test]
    fn it_is_likelier_than_a_plain_exponential_where_there_is_a_dead_time() {
        let runs = sample(1, 60, 20.0);
        let shifted = fit_shifted_exponential(&runs).unwrap();
        let plain = fit_lifetime(Family::Exponential, &runs).unwrap();
        assert!(shifted.log_likelihood > plain.log_likelihood + 6.0);
        assert_eq!(shifted.observed + shifted.censored, 60);
        // ln L = -d ln theta - sum (t - t_0)/theta at the largest: t_0 the first time, theta = T/d.
        let by_hand = fit_shifted_exponential(
            &[5.0, 6.0, 10.0].map(|time| Transition::At { time, period: 0 }),
        );
        let log_likelihood = by_hand.unwrap().log_likelihood;
        assert!((log_likelihood + 3.0 * 2.0_f64.ln() + 3.0).abs() < 1e-14);
    }

    #[test]
    fn a_dead_time_is_never_negative_and_bad_runs_are_refused() {
        let mut randomness = Randomness::new(6, 0);
        for _ in 0..50 {
            let runs = watched_runs(6, 3.0, || exponential(&mut randomness));
            if let Ok(fit) = fit_shifted_exponential(&runs) {
                assert!(fit.dead_time.value >= 0.0 && fit.dead_time.interval_95.lower >= 0.0);
            }
        }
        let at = |time| Transition::At { time, period: 0 };
        assert_refused!(fit_shifted_exponential(&[at(2.0); 4]) => NoScatter { observed: 4 });
        assert_refused!(
            fit_shifted_exponential(&[at(2.0), at(3.0)]) =>
            TooFewObserved { observed: 2, .. }
        );
        assert!(fit_shifted_exponential(&[at(f64::NAN); 4]).is_err());
    }
}
