//! Survival curve of censored transition times, without assuming a distribution.

use crate::columns::{jackknife_error, mean_and_scatter};
use crate::error::{Error, enough, enough_observed, ensure};
use crate::transition::Transition;
use crate::uncertain::{Interval, Uncertain};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The survival curve just after one transition time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SurvivalStep {
    /// Time of the step, in the unit of the input.
    pub time: f64,
    /// Runs watched up to this time without a transition before it.
    pub at_risk: usize,
    /// Runs with their transition at this time.
    pub transitions: usize,
    /// Probability S of no transition up to and including this time, with Greenwood's error and log-log intervals.
    pub survival: Uncertain,
}

/// Kaplan-Meier estimate of the probability that a run is still without its transition.
///
/// ```
/// use peristalsis_analysis::{Survival, Transition};
/// let at = |time| Transition::At { time, period: 0 };
/// let runs = [at(1.0), Transition::Censored { time: 2.0 }, at(3.0), at(4.0)];
/// let survival = Survival::new(&runs)?;
/// // 3/4 after the first transition; then two runs are at risk, and one of them goes.
/// assert_eq!(survival.at(2.5), 0.75);
/// assert_eq!(survival.at(3.0), 0.375);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survival {
    /// One step for every distinct transition time, in order of time.
    pub steps: Vec<SurvivalStep>,
    /// Runs behind the curve.
    pub runs: usize,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Longest time at which a run was watched: beyond it nothing is known, unless the curve has reached 0.
    pub watched: f64,
}

/// Mean and variance of min(tau, horizon).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RestrictedMoments {
    /// Time at which every longer transition time is cut off.
    pub horizon: f64,
    /// Restricted mean, with normal intervals.
    pub mean: Uncertain,
    /// Restricted variance, with its error by the jackknife over runs.
    pub variance: Uncertain,
}

/// Time of a run and whether it is a transition, checked.
pub(crate) fn times(transitions: &[Transition]) -> Result<Vec<(f64, bool)>, Error> {
    transitions
        .iter()
        .enumerate()
        .map(|(index, &transition)| {
            let (value, observed) = transition.time();
            ensure(value.is_finite(), Error::NonFinite { index, value })?;
            ensure(value >= 0.0, Error::Negative { index, value })?;
            Ok((value, observed))
        })
        .collect()
}

/// Distinct transition times with the runs at risk and the transitions there.
///
/// A run censored at the very time of a transition counts as still at risk.
fn risk_table(mut times: Vec<(f64, bool)>) -> Vec<(f64, usize, usize)> {
    times.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let mut at_risk = times.len();
    let mut table: Vec<(f64, usize, usize)> = Vec::new();
    for (time, observed) in times {
        if observed {
            match table.last_mut() {
                Some((last, _, transitions)) if *last == time => *transitions += 1,
                _ => table.push((time, at_risk, 1)),
            }
        }
        at_risk -= 1;
    }
    table
}

/// Integrals of S and of 2 t S from 0 to the horizon, the curve continued at its last value.
fn restricted_integrals(table: &[(f64, usize, usize)], horizon: f64) -> (f64, f64) {
    let (mut first, mut second) = (0.0, 0.0);
    let (mut survival, mut since) = (1.0, 0.0);
    for &(time, at_risk, transitions) in table {
        if time >= horizon {
            break;
        }
        first += survival * (time - since);
        second += survival * (time * time - since * since);
        survival *= 1.0 - transitions as f64 / at_risk as f64;
        since = time;
    }
    first += survival * (horizon - since);
    second += survival * (horizon * horizon - since * since);
    (first, second)
}

impl Survival {
    /// The curve of runs with and without a transition.
    ///
    /// `S(t) = prod_(t_j <= t) (1 - d_j/n_j)`
    ///
    /// d_j transitions at t_j among n_j runs still watched. Greenwood's error is `S sqrt(sum d_j/(n_j (n_j - d_j)))`;
    /// the intervals are those of `ln(-ln S)`, which stay between 0 and 1 and hold from some ten runs on. After the
    /// last transition of uncensored runs S is 0 with error 0; its interval reaches up to the interval of the step before.
    /// Assumes that a run's end is unrelated to its transition: true of runs of a set length, not of runs that were
    /// ended because they were about to change. Sources: Kaplan & Meier, J. Am. Stat. Assoc. 53, 457 (1958); the
    /// intervals: Kalbfleisch & Prentice, The Statistical Analysis of Failure Time Data (2002), section 1.4.
    ///
    /// # Errors
    /// [`Error::TooFew`] without runs, [`Error::NonFinite`], [`Error::Negative`].
    pub fn new(transitions: &[Transition]) -> Result<Self, Error> {
        let times = times(transitions)?;
        enough("runs", times.len(), 1)?;
        let watched = times.iter().map(|time| time.0).fold(0.0, f64::max);
        let observed = times.iter().filter(|time| time.1).count();
        let mut survival = 1.0;
        let mut variance = 0.0;
        let mut last = Uncertain::normal(1.0, 0.0);
        let steps = risk_table(times)
            .into_iter()
            .map(|(time, at_risk, transitions)| {
                let (exposed, gone) = (at_risk as f64, transitions as f64);
                survival *= 1.0 - gone / exposed;
                variance += gone / (exposed * (exposed - gone));
                last = log_log(survival, variance, last);
                SurvivalStep {
                    time,
                    at_risk,
                    transitions,
                    survival: last,
                }
            })
            .collect();
        Ok(Self {
            steps,
            runs: transitions.len(),
            observed,
            watched,
        })
    }

    /// Survival probability at a time; the last known one beyond the last transition.
    pub fn at(&self, time: f64) -> f64 {
        let steps_before = self.steps.partition_point(|step| step.time <= time);
        match steps_before {
            0 => 1.0,
            _ => self.steps[steps_before - 1].survival.value,
        }
    }

    /// Median transition time: the first time with S <= 1/2.
    ///
    /// Its intervals hold the times at which the log-log interval of S contains 1/2; a side that the data leave open is
    /// infinite. The standard error is half of the narrow interval. Source: Brookmeyer & Crowley, Biometrics 38, 29
    /// (1982).
    ///
    /// # Errors
    /// [`Error::LevelNotReached`] where more than half of the runs outlast the time watched.
    pub fn median(&self) -> Result<Uncertain, Error> {
        const LEVEL: f64 = 0.5;
        let first = |quantity: &dyn Fn(&Uncertain) -> f64| {
            self.steps
                .iter()
                // Round-off must not move the median of an even number of runs.
                .find(|step| quantity(&step.survival) <= LEVEL * (1.0 + 1e-12))
                .map(|step| step.time)
        };
        let value = first(&|survival| survival.value).ok_or_else(|| Error::LevelNotReached {
            level: LEVEL,
            survival: self.at(self.watched),
        })?;
        let ends = |interval: fn(&Uncertain) -> Interval| Interval {
            lower: first(&|survival| interval(survival).lower).unwrap_or(value),
            upper: first(&|survival| interval(survival).upper).unwrap_or(f64::INFINITY),
        };
        let narrow = ends(|survival| survival.interval_68);
        let wide = ends(|survival| survival.interval_95);
        Ok(Uncertain::between(value, [narrow, wide]))
    }

    /// Mean of min(tau, horizon) with its error: what can be said of the mean without assuming a distribution.
    ///
    /// `m = int_0^h S dt`,   `error^2 = d/(d - 1) sum_j A_j^2 d_j/(n_j (n_j - d_j))`,   `A_j = int_(t_j)^h S dt`
    ///
    /// d observed transitions; intervals of Student's distribution. It lies below the true mean by `int_h^inf S dt`: near w_c, where the horizon is no
    /// longer large against tau, this is most of it. Source: Kaplan & Meier (1958), section 6; Royston & Parmar, BMC
    /// Med. Res. Methodol. 13, 152 (2013).
    ///
    /// # Errors
    /// [`Error::TooFewObserved`] below 2 transitions, [`Error::Horizon`] for a horizon that is not positive or at which
    /// no run is watched any more while S > 0.
    pub fn restricted_mean(&self, horizon: f64) -> Result<Uncertain, Error> {
        self.check_horizon(horizon, 2)?;
        let row = |step: &SurvivalStep| (step.time, step.at_risk, step.transitions);
        let table: Vec<_> = self.steps.iter().map(row).collect();
        let (mean, _) = restricted_integrals(&table, horizon);
        let (mut survival, mut since) = (1.0, 0.0);
        // Integral of S up to the step.
        let mut before = 0.0;
        let mut variance = 0.0;
        for step in self.steps.iter().take_while(|step| step.time < horizon) {
            before += survival * (step.time - since);
            (survival, since) = (step.survival.value, step.time);
            if step.at_risk > step.transitions {
                let (exposed, gone) = (step.at_risk as f64, step.transitions as f64);
                let after = mean - before;
                variance += after * after * gone / (exposed * (exposed - gone));
            }
        }
        let observed = self.observed as f64;
        let error = (variance * observed / (observed - 1.0)).sqrt();
        Ok(Uncertain::student(mean, error, self.runs - 1))
    }

    fn check_horizon(&self, horizon: f64, needed: usize) -> Result<(), Error> {
        enough_observed(self.observed, self.runs, needed)?;
        let watched = self.watched;
        let known = horizon <= watched || self.at(watched) == 0.0;
        let is_watched = horizon > 0.0 && horizon.is_finite() && known;
        ensure(is_watched, Error::Horizon { horizon, watched })
    }
}

/// Part of a variance that counts as none.
const NEARLY_NONE: f64 = 0.1;

/// Survival with Greenwood's variance of its logarithm and intervals of ln(-ln S).
fn log_log(survival: f64, log_variance: f64, before: Uncertain) -> Uncertain {
    if survival <= 0.0 {
        let mut last = Uncertain::normal(0.0, 0.0);
        last.interval_68.upper = before.interval_68.upper;
        last.interval_95.upper = before.interval_95.upper;
        return last;
    }
    let log = libm::log(survival);
    let spread = log_variance.sqrt() / log.abs();
    let end = |score: f64| libm::exp(log * libm::exp(score));
    let ends = |deviations: f64| Interval::new(end(deviations * spread), end(-deviations * spread));
    Uncertain::with_intervals(survival, survival * log_variance.sqrt(), ends)
}

/// Mean and variance of min(tau, horizon) from censored runs.
///
/// `<t> = int_0^h S dt`,   `<t^2> = int_0^h 2 t S dt`,   variance = (`<t^2> - <t>^2`) n/(n - 1)
///
/// with the Kaplan-Meier curve S of n runs: without censoring before the horizon the sample variance of the cut-off
/// times. The error of the mean is that of [`Survival::restricted_mean`]. Intervals of the variance are from the jackknife of
/// its logarithm, with Student's distribution, up to the largest variance of times below the horizon; its error is half of the
/// narrow one. Where one run alone makes up nearly all of the variance they are symmetric, from the jackknife of the variance
/// itself. Source: Miller, Ann. Math. Stat. 39, 567 (1968).
///
/// # Errors
/// [`Error::TooFewObserved`] below 3 transitions, [`Error::Horizon`], [`Error::NonFinite`], [`Error::Negative`],
/// [`Error::TooFew`].
pub fn restricted_moments(
    transitions: &[Transition],
    horizon: f64,
) -> Result<RestrictedMoments, Error> {
    let survival = Survival::new(transitions)?;
    survival.check_horizon(horizon, 3)?;
    let variance_of = |times: Vec<(f64, bool)>| {
        let runs = times.len() as f64;
        let (first, second) = restricted_integrals(&risk_table(times), horizon);
        (second - first * first).max(0.0) * runs / (runs - 1.0)
    };
    let times = times(transitions)?;
    let without_one: Vec<f64> = (0..times.len())
        .map(|left_out| {
            let mut rest = times.clone();
            rest.remove(left_out);
            variance_of(rest)
        })
        .collect();
    Ok(RestrictedMoments {
        horizon,
        mean: survival.restricted_mean(horizon)?,
        variance: with_jackknife(variance_of(times), &without_one, horizon),
    })
}

/// A variance of times up to a horizon, with intervals from its values with one run left out.
fn with_jackknife(variance: f64, without_one: &[f64], horizon: f64) -> Uncertain {
    let runs = without_one.len() as f64;
    // Where one run makes up nearly all of it, the logarithm says how small the rest is, and nothing of the variance.
    if without_one
        .iter()
        .any(|&left| left <= NEARLY_NONE * variance)
    {
        return Uncertain::normal(variance, jackknife_error(without_one));
    }
    let pseudo = without_one
        .iter()
        .map(|&left| runs * libm::log(variance) - (runs - 1.0) * libm::log(left));
    let (mean, scatter) = mean_and_scatter(&pseudo.collect::<Vec<_>>());
    let error = (scatter / (runs * (runs - 1.0))).sqrt();
    let logarithm = Uncertain::student(mean, error, without_one.len() - 1);
    let largest = 0.25 * horizon * horizon * runs / (runs - 1.0);
    let interval = |of: Interval| {
        let Interval { lower, upper } = of.map(libm::exp);
        Interval::new(lower.min(variance), upper.min(largest).max(variance))
    };
    let intervals = [logarithm.interval_68, logarithm.interval_95];
    Uncertain::between(variance, intervals.map(interval))
}

#[cfg(test)]
mod tests;
