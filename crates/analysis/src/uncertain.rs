//! A number with its uncertainty.

use core::ops::Sub;

use crate::columns::mean_and_scatter;
use crate::numerics::minimum::crossing;
use crate::numerics::student;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Standard deviations of the narrow interval: 68.27 per cent.
pub(crate) const NARROW: f64 = 1.0;
/// Standard deviations of the wide interval: 95 per cent.
pub(crate) const WIDE: f64 = 1.959_963_984_540_054;
/// Probability to either side of the narrow interval.
const NARROW_TAIL: f64 = 0.158_655_253_931_457;
/// Probability to either side of the wide interval.
const WIDE_TAIL: f64 = 0.025;

/// Confidence interval; a side that the data leave open is infinite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Interval {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

impl Interval {
    /// Ends that are open to either side.
    pub(crate) const OPEN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// The interval about `inside` in which a function stays at or below 0. Its ends are the crossings, searched for in
    /// growing steps from `first_step` on as far as `limits`; a side without a crossing ends at that side of `open`.
    pub(crate) fn around(
        inside: f64,
        outside: impl Fn(f64) -> f64,
        first_step: f64,
        limits: [f64; 2],
        open: [f64; 2],
    ) -> Self {
        let [lower, upper] = [0, 1]
            .map(|side| crossing(&outside, inside, first_step, limits[side]).unwrap_or(open[side]));
        Self { lower, upper }
    }

    pub(crate) const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// The shortest interval that holds both.
    pub(crate) fn hull(&self, other: Self) -> Self {
        Self::new(self.lower.min(other.lower), self.upper.max(other.upper))
    }

    /// Whether a value lies in the interval, ends included.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// The interval of an increasing function of the number.
    pub(crate) fn map(&self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(function(self.lower), function(self.upper))
    }

    /// Distance of the ends.
    pub fn length(&self) -> f64 {
        self.upper - self.lower
    }
}

/// A number with its standard error and its confidence intervals.
///
/// The intervals need not be symmetric, nor the error half of the narrow one: each estimator states whether they come
/// from a profile likelihood, a bootstrap or the normal approximation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Uncertain {
    /// The estimate.
    pub value: f64,
    /// Its standard error (one standard deviation).
    pub error: f64,
    /// Interval that covers the truth in 68.27 per cent of repetitions.
    pub interval_68: Interval,
    /// Interval that covers the truth in 95 per cent of repetitions.
    pub interval_95: Interval,
}

impl Uncertain {
    /// Normal approximation: value +- error and value +- 1.96 error.
    pub fn normal(value: f64, error: f64) -> Self {
        Self::with_intervals(value, error, |deviations| {
            Interval::new(value - deviations * error, value + deviations * error)
        })
    }

    /// A mean or the like whose error is taken from the scatter of the data, with so many degrees of freedom: intervals of
    /// Student's distribution, open without degrees of freedom.
    pub fn student(value: f64, error: f64, degrees_of_freedom: usize) -> Self {
        let between = |tail: f64| {
            if degrees_of_freedom == 0 {
                let [lower, upper] = Interval::OPEN;
                return Interval::new(lower, upper);
            }
            let reach = student::quantile(tail, degrees_of_freedom) * error;
            Interval::new(value - reach, value + reach)
        };
        Self {
            value,
            error,
            interval_68: between(NARROW_TAIL),
            interval_95: between(WIDE_TAIL),
        }
    }

    /// A number of which only two bounds are known, most likely `value`: its error is the standard deviation of a uniform
    /// distribution between them, and the narrow interval is 68.27 per cent of that as long, cut at the bounds. The bounds are
    /// the wide one.
    pub fn bracketed(value: f64, lower: f64, upper: f64) -> Self {
        let length = upper - lower;
        let half = 0.5 * (1.0 - 2.0 * NARROW_TAIL) * length;
        Self {
            value,
            error: length / 12_f64.sqrt(),
            interval_68: Interval::new((value - half).max(lower), (value + half).min(upper)),
            interval_95: Interval::new(lower, upper),
        }
    }

    /// A number whose two intervals follow from the deviations, in standard errors, of a normal number at their ends.
    pub(crate) fn with_intervals(
        value: f64,
        error: f64,
        interval: impl Fn(f64) -> Interval,
    ) -> Self {
        Self {
            value,
            error,
            interval_68: interval(NARROW),
            interval_95: interval(WIDE),
        }
    }

    /// A number with its narrow and wide interval; the standard error is half of the narrow one.
    pub(crate) fn between(value: f64, [interval_68, interval_95]: [Interval; 2]) -> Self {
        Self {
            value,
            error: 0.5 * interval_68.length(),
            interval_68,
            interval_95,
        }
    }

    /// Percentile bootstrap: standard deviation and quantiles of the estimates from resampled data.
    ///
    /// `None` with fewer than two finite estimates. Source: Efron & Tibshirani, An Introduction to the Bootstrap
    /// (1993), chapters 6 and 13.
    pub(crate) fn from_bootstrap(value: f64, resampled: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = resampled.iter().copied().filter(|x| !x.is_nan()).collect();
        sorted.sort_by(f64::total_cmp);
        let finite: Vec<f64> = sorted.iter().copied().filter(|x| x.is_finite()).collect();
        if finite.len() < 2 {
            return None;
        }
        let (_, scatter) = mean_and_scatter(&finite);
        let between =
            |tail: f64| Interval::new(quantile(&sorted, tail), quantile(&sorted, 1.0 - tail));
        Some(Self {
            value,
            error: (scatter / (finite.len() as f64 - 1.0)).sqrt(),
            interval_68: between(NARROW_TAIL),
            interval_95: between(WIDE_TAIL),
        })
    }

    /// The number whose logarithm this is; its error by the law of propagation, its intervals exactly.
    pub(crate) fn exponential(self) -> Self {
        let value = libm::exp(self.value);
        self.map(value * self.error, libm::exp)
    }

    /// An increasing function of the number, with a given standard error.
    #[must_use]
    pub fn map(self, error: f64, function: impl Fn(f64) -> f64) -> Self {
        Self {
            value: function(self.value),
            error,
            interval_68: self.interval_68.map(&function),
            interval_95: self.interval_95.map(&function),
        }
    }

    /// The number in another unit: times a positive factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        self.map(self.error * factor, |value| value * factor)
    }

    /// Distance from a reference value in standard errors.
    pub fn deviations_from(&self, reference: f64) -> f64 {
        if self.value == reference {
            0.0
        } else {
            (self.value - reference) / self.error
        }
    }

    /// Whether the 95 per cent interval lies above a bound.
    pub fn is_above(&self, bound: f64) -> bool {
        self.interval_95.lower > bound
    }

    /// Whether the 95 per cent interval lies below a bound.
    pub fn is_below(&self, bound: f64) -> bool {
        self.interval_95.upper < bound
    }
}

/// One number less another, of independent errors. Errors add in quadrature, and so do the sides of the intervals: the lower
/// side of the first with the upper side of the second, and the other way round.
///
/// Source: Zou & Donner, Statistics in Medicine 27, 1693 (2008), equation 3.
impl Sub for Uncertain {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let between = |of: fn(&Self) -> Interval| {
            let [(down, up), (other_down, other_up)] = [&self, &other].map(|one| {
                let Interval { lower, upper } = of(one);
                (lower - one.value, upper - one.value)
            });
            let ends = [-down.hypot(other_up), up.hypot(other_down)];
            let [lower, upper] = ends.map(|end| end - (other.value - self.value));
            Interval::new(lower, upper)
        };
        Self {
            value: self.value - other.value,
            error: self.error.hypot(other.error),
            interval_68: between(|one| one.interval_68),
            interval_95: between(|one| one.interval_95),
        }
    }
}

/// Quantile of sorted values by linear interpolation between order statistics.
pub(crate) fn quantile(sorted: &[f64], probability: f64) -> f64 {
    let place = probability.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    let fraction = place - below as f64;
    if fraction == 0.0 || sorted[below] == sorted[above] {
        sorted[below]
    } else {
        sorted[below] + fraction * (sorted[above] - sorted[below])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::white_noise;

    #[test]
    fn intervals_of_the_normal_approximation() {
        let found = Uncertain::normal(2.0, 0.5);
        assert_eq!(found.interval_68, Interval::new(1.5, 2.5));
        assert!((found.interval_95.length() - 1.959_964).abs() < 1e-6);
        assert!(found.interval_68.contains(1.5) && !found.interval_68.contains(1.49));
        assert!((found.deviations_from(3.0) + 2.0).abs() < 1e-15);
        assert_eq!(Uncertain::normal(1.0, 0.0).deviations_from(1.0), 0.0);
        let few = Uncertain::student(2.0, 0.5, 2);
        assert!((few.interval_95.upper - 2.0 - 0.5 * 4.3027).abs() < 1e-4);
        assert!((few.interval_68.length() - 1.3213).abs() < 1e-3);
        let alone = Uncertain::student(2.0, f64::NAN, 0);
        assert!(alone.interval_95.contains(-1e9) && alone.interval_95.contains(1e9));
        let ratio = Uncertain::normal(libm::log(10.0), 0.1).exponential();
        assert!((ratio.error - 1.0).abs() < 1e-12);
        let product = ratio.interval_95.lower * ratio.interval_95.upper;
        assert!((product - 100.0).abs() < 1e-9);
    }

    #[test]
    fn a_number_between_two_bounds_never_leaves_them() {
        let near_one = Uncertain::bracketed(1.1, 1.0, 2.0);
        assert!((near_one.error - 12_f64.sqrt().recip()).abs() < 1e-15);
        assert_eq!(near_one.interval_95, Interval::new(1.0, 2.0));
        assert_eq!(near_one.interval_68.lower, 1.0);
        // 68.27 per cent of a uniform number, in the middle.
        assert!((near_one.interval_68.upper - 1.1 - 0.341_345).abs() < 1e-6);
    }

    #[test]
    fn differences_have_the_sides_of_both() {
        let more = Uncertain::normal(3.0, 0.3) - Uncertain::normal(1.0, 0.4);
        let same = Uncertain::normal(2.0, 0.5);
        assert!((more.error - same.error).abs() < 1e-15);
        assert!((more.interval_95.upper - same.interval_95.upper).abs() < 1e-12);
        assert!(more.is_above(1.0) && !more.is_above(1.1) && more.is_below(3.0));
        let sided = |lower, upper| Uncertain {
            interval_95: Interval::new(lower, upper),
            ..Uncertain::normal(1.0, 0.1)
        };
        let apart = sided(0.7, 1.1) - sided(0.6, 1.9);
        assert!((apart.interval_95.lower + 0.3_f64.hypot(0.9)).abs() < 1e-15);
        assert!((apart.interval_95.upper - 0.1_f64.hypot(0.4)).abs() < 1e-15);
        let open = Uncertain::student(1.0, f64::NAN, 0) - same;
        assert!(!open.is_above(-1e9) && !open.is_below(1e9));
    }

    #[test]
    fn quantiles_of_resampled_estimates() {
        let found = Uncertain::from_bootstrap(0.1, &white_noise(3, 20_000)).unwrap();
        assert_eq!(found.value, 0.1);
        assert!((found.error - 1.0).abs() < 0.02);
        assert!((found.interval_68.lower + 1.0).abs() < 0.04);
        assert!((found.interval_95.upper - 1.96).abs() < 0.06);
        assert!(Uncertain::from_bootstrap(0.0, &[1.0, f64::NAN]).is_none());
        let open = Uncertain::from_bootstrap(0.0, &[1.0, 2.0, f64::INFINITY]).unwrap();
        assert_eq!(open.interval_95.upper, f64::INFINITY);
        assert!((quantile(&[1.0, 2.0, 4.0], 0.75) - 3.0).abs() < 1e-15);
    }
}
