//! Student's distribution for whole degrees of freedom.

use std::f64::consts::FRAC_2_PI;

/// Probability that a number of Student's distribution lies further from 0, to either side.
///
/// With theta = atan(t/sqrt(nu)) a finite sum of powers of cos theta (Abramowitz & Stegun 26.7.3 and 26.7.4); 1 without
/// degrees of freedom.
pub(crate) fn two_sided_tail(score: f64, degrees_of_freedom: usize) -> f64 {
    if degrees_of_freedom == 0 {
        return 1.0;
    }
    let angle = libm::atan(score.abs() / (degrees_of_freedom as f64).sqrt());
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let is_odd = degrees_of_freedom % 2 == 1;
    // The first term and, from each to the next, (k - 1)/k cos^2.
    let (mut term, first) = if is_odd { (cosine, 3) } else { (1.0, 2) };
    let mut sum = 0.0;
    for k in (first..=degrees_of_freedom).step_by(2) {
        sum += term;
        term *= (k - 1) as f64 / k as f64 * cosine * cosine;
    }
    let within = if is_odd {
        FRAC_2_PI * (angle + sine * sum)
    } else {
        sine * sum
    };
    (1.0 - within).clamp(0.0, 1.0)
}

/// The number beyond which lies this probability to one side, 0 < tail < 1/2; infinite without degrees of freedom.
pub(crate) fn quantile(tail: f64, degrees_of_freedom: usize) -> f64 {
    if degrees_of_freedom == 0 {
        return f64::INFINITY;
    }
    let is_beyond = |score: f64| two_sided_tail(score, degrees_of_freedom) < 2.0 * tail;
    let mut upper = 1.0;
    while !is_beyond(upper) {
        upper *= 2.0;
    }
    let mut lower = 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (lower + upper);
        if is_beyond(middle) {
            upper = middle;
        } else {
            lower = middle;
        }
    }
    0.5 * (lower + upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (degrees_of_freedom, expected) in [
            (1, 12.7062),
            (2, 4.3027),
            (3, 3.1824),
            (4, 2.7764),
            (5, 2.5706),
            (10, 2.2281),
            (1000, 1.9623),
        ] {
            let found = quantile(0.025, degrees_of_freedom);
            assert!(
                (found - expected).abs() < 1e-4,
                "{degrees_of_freedom}: {found}"
            );
            assert!((two_sided_tail(found, degrees_of_freedom) - 0.05).abs() < 1e-10);
        }
        // One degree: 1 - (2/pi) atan t; none: nothing is excluded.
        assert!((two_sided_tail(1.0, 1) - 0.5).abs() < 1e-15);
        assert_eq!(two_sided_tail(3.0, 0), 1.0);
        assert!(quantile(0.025, 0).is_infinite());
    }
}
