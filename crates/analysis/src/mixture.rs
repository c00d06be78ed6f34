//! One peak or two: histogram, and a mixture of two normal distributions against one.

use crate::error::{Error, checked, enough, ensure};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Fewest values for a mixture of two.
const LEAST_VALUES: usize = 8;
/// Narrowest peak, as a fraction of the standard deviation of all values: a peak of one value would have no width.
const NARROWEST: f64 = 0.1;
/// Most steps of the iteration from one start.
const MOST_STEPS: u32 = 500;
/// Parts into which the sorted values are split to start from.
const STARTS: usize = 10;

/// Numbers of values in bins of equal width.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Edges of the bins, one more than bins. A bin includes its lower edge, the last one its upper edge too.
    pub edges: Vec<f64>,
    /// Values in each bin.
    pub counts: Vec<usize>,
    /// Values outside of all bins.
    pub outside: usize,
}

/// One peak of a mixture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Peak {
    /// Fraction of the values that belong to it.
    pub weight: f64,
    /// Its mean.
    pub mean: f64,
    /// Standard error of the mean, as if it were known which values belong to the peak: too small where peaks overlap.
    pub mean_error: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Mixture of two normal distributions against a single one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TwoPeaks {
    /// Mean and deviation of all values as one peak.
    pub single: Peak,
    /// Peak at the smaller mean.
    pub lower: Peak,
    /// Peak at the larger mean.
    pub upper: Peak,
    /// Schwarz's criterion of one peak less that of two: positive for two peaks, beyond 10 very clearly so.
    pub criterion_gain: f64,
    /// Distance of the peaks over their widths, sqrt(2) |m_2 - m_1|/sqrt(s_1^2 + s_2^2): two peaks can be seen beyond
    /// 2.
    pub separation: f64,
}

impl TwoPeaks {
    /// Whether two peaks describe the values better and are far enough apart to be two.
    pub fn is_double(&self) -> bool {
        self.criterion_gain > 10.0 && self.separation > 2.0
    }
}

/// Counts values in bins of equal width between two bounds.
///
/// # Errors
/// [`Error::NonFinite`] for a value or a bound, [`Error::TooFew`] without bins, [`Error::NotPositive`] for bounds that
/// are not in order (index 1).
///
/// ```
/// use peristalsis_analysis::histogram;
/// let found = histogram(&[0.1, 0.2, 0.9, 1.0, 1.3], 0.0, 1.0, 2)?;
/// assert_eq!((found.counts, found.outside), (vec![2, 2], 1));
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn histogram(values: &[f64], lower: f64, upper: f64, bins: usize) -> Result<Histogram, Error> {
    checked(values, 0)?;
    checked(&[lower, upper], 2)?;
    enough("bins", bins, 1)?;
    let range = upper - lower;
    let (index, value) = (1, range);
    ensure(
        range > 0.0 && range.is_finite(),
        Error::NotPositive { index, value },
    )?;
    let mut counts = vec![0; bins];
    let mut outside = 0;
    for &value in values {
        if (lower..=upper).contains(&value) {
            let bin = ((value - lower) / range * bins as f64) as usize;
            counts[bin.min(bins - 1)] += 1;
        } else {
            outside += 1;
        }
    }
    let edge = |k| lower + range * (k as f64 / bins as f64);
    Ok(Histogram {
        edges: (0..=bins).map(edge).collect(),
        counts,
        outside,
    })
}

/// Fits one and two normal distributions to independent values and compares them.
///
/// `f(x) = p N(x; m_1, s_1) + (1 - p) N(x; m_2, s_2)`,   gain = BIC_1 - BIC_2,   BIC = q ln n - 2 ln L, q = 2 and 5
///
/// The best of nine fits by expectation-maximisation, from nine splits of the sorted values; no peak is narrower than a
/// tenth of the deviation of all values, or a few values that happen to lie close would be one (Hathaway). The criterion
/// favours two peaks also for one skew peak, and for 8 or 10 values of one peak it is positive in a quarter of the cases or
/// more: read it beside the separation and the [`dip_test`](crate::dip_test), which assumes no form. Give one value per run.
/// Sources: Dempster, Laird & Rubin, J. R. Stat. Soc. B 39, 1 (1977); Hathaway, Ann. Stat. 13, 795 (1985); Schwarz, Ann.
/// Stat. 6, 461 (1978); the separation: Ashman, Bird & Zepf, Astron. J. 108, 2348 (1994).
///
/// # Errors
/// [`Error::TooFew`] below 8 values, [`Error::NonFinite`], [`Error::NoScatter`] for equal values.
///
/// ```
/// use peristalsis_analysis::two_peaks;
/// let found = two_peaks(&[0.1, 0.2, 0.3, 0.2, 0.9, 1.0, 0.9, 1.0, 0.95, 0.95])?;
/// assert!(found.is_double() && (found.lower.weight - 0.4).abs() < 1e-6);
/// assert!((found.upper.mean - found.lower.mean - 0.75).abs() < 1e-6);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn two_peaks(values: &[f64]) -> Result<TwoPeaks, Error> {
    let mut sorted = checked(values, LEAST_VALUES)?.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    let no_scatter = Error::NoScatter { observed: count };
    let single = peak_of(&sorted, |_| 1.0, 0.0);
    let narrowest = NARROWEST * single.deviation;
    let scatters = single.deviation > 1e-12 * single.mean.abs();
    ensure(scatters && single.deviation.is_finite(), no_scatter)?;
    let from_part = |part: usize| {
        let below = (part * count / STARTS).clamp(1, count - 1);
        maximise(&sorted, below, narrowest)
    };
    let best = (1..STARTS)
        .map(from_part)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let (log_likelihood, a, b) = best.ok_or(no_scatter)?;
    let (lower, upper) = if a.mean <= b.mean { (a, b) } else { (b, a) };
    let plain: f64 = sorted.iter().map(|&x| ln_density(single, x)).sum();
    let spread = lower.deviation * lower.deviation + upper.deviation * upper.deviation;
    Ok(TwoPeaks {
        single,
        lower,
        upper,
        criterion_gain: 2.0 * (log_likelihood - plain) - 3.0 * libm::log(count as f64),
        separation: (upper.mean - lower.mean) * (2.0 / spread).sqrt(),
    })
}

/// Logarithm of weight times normal density.
fn ln_density(peak: Peak, x: f64) -> f64 {
    let score = (x - peak.mean) / peak.deviation;
    libm::log(peak.weight / peak.deviation) - 0.5 * (score * score + libm::log(TAU))
}

/// Peak of the values with a share of each.
fn peak_of(values: &[f64], share: impl Fn(usize) -> f64, narrowest: f64) -> Peak {
    let total: f64 = (0..values.len()).map(&share).sum();
    let sum: f64 = values.iter().enumerate().map(|(k, x)| share(k) * x).sum();
    let mean = sum / total;
    let squared = |(k, x): (usize, &f64)| share(k) * (x - mean) * (x - mean);
    let scatter: f64 = values.iter().enumerate().map(squared).sum();
    let deviation = (scatter / total).sqrt().max(narrowest);
    Peak {
        weight: total / values.len() as f64,
        mean,
        mean_error: deviation / total.sqrt(),
        deviation,
    }
}

/// Expectation-maximisation from a split of the sorted values, so many of them below; log-likelihood and the two peaks.
fn maximise(values: &[f64], below: usize, narrowest: f64) -> (f64, Peak, Peak) {
    let is_below = |place: usize| f64::from(u8::from(place < below));
    let mut shares: Vec<f64> = (0..values.len()).map(is_below).collect();
    let mut last = f64::NEG_INFINITY;
    let peaks = |shares: &[f64]| {
        let first = peak_of(values, |k| shares[k], narrowest);
        (first, peak_of(values, |k| 1.0 - shares[k], narrowest))
    };
    for _ in 0..MOST_STEPS {
        let total: f64 = shares.iter().sum();
        // A peak without values does not count.
        if !(total > 1e-9 && total < values.len() as f64 - 1e-9) {
            let nowhere = peak_of(values, |_| 1.0, narrowest);
            return (f64::NEG_INFINITY, nowhere, nowhere);
        }
        let (first, second) = peaks(&shares);
        let mut log_likelihood = 0.0;
        for (share, &x) in shares.iter_mut().zip(values) {
            let (a, b) = (ln_density(first, x), ln_density(second, x));
            let larger = a.max(b);
            let both = larger + libm::log(libm::exp(a - larger) + libm::exp(b - larger));
            *share = libm::exp(a - both);
            log_likelihood += both;
        }
        if log_likelihood - last < 1e-9 * (1.0 + log_likelihood.abs()) {
            return (log_likelihood, first, second);
        }
        last = log_likelihood;
    }
    let (first, second) = peaks(&shares);
    (last, first, second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{assert_coverage, white_noise};

    /// A third of the values about 0.2, the others about 0.95.
    fn double(seed: u64, count: usize) -> Vec<f64> {
        white_noise(seed, count)
            .iter()
            .enumerate()
            .map(|(k, noise)| {
                if k % 3 == 0 {
                    0.2 + 0.1 * noise
                } else {
                    0.95 + 0.05 * noise
                }
            })
            .collect()
    }

    #[test]
    fn units_and_equal_values_change_nothing() {
        let values = [0.1, 0.2, 0.3, 0.2, 0.9, 1.0, 0.9, 1.0, 0.95, 0.95];
        let gain = |scale: f64| {
            two_peaks(&values.map(|x| scale * x))
                .unwrap()
                .criterion_gain
        };
        assert!((gain(3e-13) - gain(1.0)).abs() < 1e-9 && (gain(1e12) - gain(1.0)).abs() < 1e-9);
        // Nine starts, all among equal values.
        let tied = |sign: f64| {
            let values: Vec<f64> = (0..20).map(|k| if k < 19 { 0.0 } else { sign }).collect();
            two_peaks(&values).unwrap()
        };
        let (above, below) = (tied(1.0), tied(-1.0));
        assert!(
            (above.criterion_gain - below.criterion_gain).abs() < 1e-9,
            "{above:?}"
        );
        assert!((above.lower.weight - 0.95).abs() < 1e-6 && above.upper.mean == 1.0);
    }

    #[test]
    fn the_peaks_of_a_mixture_are_found_with_errors_that_cover() {
        let trials = 300;
        let mut covered = [0; 2];
        for seed in 0..trials {
            let found = two_peaks(&double(seed, 60)).unwrap();
            assert!(found.is_double(), "{found:?}");
            assert!((found.lower.weight - 1.0 / 3.0).abs() < 0.02);
            covered[0] += usize::from((found.lower.mean - 0.2).abs() < found.lower.mean_error);
            covered[1] += usize::from((found.upper.mean - 0.95).abs() < found.upper.mean_error);
        }
        for (covered, what) in covered.into_iter().zip(["lower", "upper"]) {
            // Deviations with divisor n cost a hundredth or two.
            assert_coverage(covered, trials as usize, 0.6827, 0.02, what);
        }
    }

    #[test]
    fn one_normal_peak_is_one() {
        let double = (0..200)
            .filter(|&seed| two_peaks(&white_noise(seed, 40)).unwrap().is_double())
            .count();
        assert!(double <= 4, "{double}");
    }

    #[test]
    fn narrow_peaks_of_equal_values_do_not_break_it() {
        let mut values = vec![0.2; 10];
        values.extend([0.998; 12]);
        let found = two_peaks(&values).unwrap();
        assert!(found.is_double());
        assert!((found.upper.mean - found.lower.mean - 0.798).abs() < 1e-9);
        assert!((found.lower.weight - 10.0 / 22.0).abs() < 1e-9);
        assert_refused!(two_peaks(&[0.3; 20]) => NoScatter { observed: 20 });
        assert_refused!(two_peaks(&[0.3; 7]) => TooFew { needed: 8, .. });
    }

    #[test]
    fn bad_bins_are_refused() {
        assert!(histogram(&[0.5], 0.0, 1.0, 0).is_err());
        assert_refused!(histogram(&[0.5], 1.0, 1.0, 3) => NotPositive { .. });
        assert!(histogram(&[f64::NAN], 0.0, 1.0, 3).is_err());
        let found = histogram(&[], 0.0, 1.5, 3).unwrap();
        assert_eq!(
            (found.edges, found.counts),
            (vec![0.0, 0.5, 1.0, 1.5], vec![0; 3])
        );
    }
}
