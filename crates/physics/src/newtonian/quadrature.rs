//! Quadrature over an interval whose ends may be sharp: the throat and the edge of a bolus.

use std::f64::consts::PI;

/// Relative change at which the refinement stops.
const TOLERANCE: f64 = 1e-14;
/// Refinements at most, from steps of 1 down to 2^-12 in the transformed variable.
const LEVELS: u32 = 12;
/// Beyond this the weights of the transformed variable are below the round-off of the sum.
const REACH: f64 = 3.5;

/// Integral of a function over [lower, upper] with the tanh-sinh rule.
///
/// x = (lower + upper)/2 + (upper - lower)/2 tanh(pi/2 sinh t), trapezoid in t, its step halved until the result
/// settles. Error near 1e-14 for functions analytic inside the interval; singularities belong at its ends.
/// Source: Takahasi & Mori, Publ. RIMS Kyoto Univ. 9, 721 (1974).
pub(super) fn integrate(lower: f64, upper: f64, function: impl Fn(f64) -> f64) -> f64 {
    let middle = 0.5 * (lower + upper);
    let half = 0.5 * (upper - lower);
    let term = |t: f64| {
        let inner = 0.5 * PI * libm::sinh(t);
        let cosh = libm::cosh(inner);
        let weight = 0.5 * PI * libm::cosh(t) / (cosh * cosh);
        weight * function(middle + half * libm::tanh(inner))
    };
    let mut step = 1.0;
    let mut sum = term(0.0);
    for k in 1..=(REACH as u32) {
        sum += term(f64::from(k)) + term(-f64::from(k));
    }
    let mut previous = sum;
    for level in 1..=LEVELS {
        step *= 0.5;
        let mut odd = 1.0;
        while odd * step <= REACH {
            sum += term(odd * step) + term(-odd * step);
            odd += 2.0;
        }
        let current = sum * step;
        // The first levels are too coarse for their agreement to mean convergence.
        if level > 4 && (current - previous).abs() <= TOLERANCE * current.abs() {
            return half * current;
        }
        previous = current;
    }
    half * previous
}

/// Argument at which a function that is negative at `lower` and positive at `upper` changes sign, by bisection.
///
/// The ends are not evaluated: the caller knows the signs there. Exact to neighbouring floating-point numbers.
pub(super) fn sign_change(lower: f64, upper: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (mut negative, mut positive) = (lower, upper);
    loop {
        let middle = 0.5 * (negative + positive);
        if middle <= negative || middle >= positive {
            return middle;
        }
        if function(middle) < 0.0 {
            negative = middle;
        } else {
            positive = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{integrate, sign_change};
    use std::f64::consts::{PI, SQRT_2};

    #[test]
    fn known_integrals() {
        assert!((integrate(0.0, PI, libm::sin) - 2.0).abs() < 1e-13);
        assert!((integrate(1.0, 3.0, |x| x * x) - 26.0 / 3.0).abs() < 1e-13);
        // The square root is singular at the end, where the rule is made to be exact.
        assert!((integrate(0.0, 1.0, f64::sqrt) - 2.0 / 3.0).abs() < 1e-13);
        // A narrow peak in the middle: int_-1^1 dx/(x^2 + 0.01) = 20 atan(10).
        let peak = integrate(-1.0, 1.0, |x| 1.0 / (x * x + 0.01));
        assert!((peak - 20.0 * libm::atan(10.0)).abs() < 1e-10);
    }

    #[test]
    fn root_of_two() {
        let root = sign_change(0.0, 2.0, |x| x * x - 2.0);
        assert!((root - SQRT_2).abs() < 1e-15);
    }
}
