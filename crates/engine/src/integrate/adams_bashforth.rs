//! Two-step Adams-Bashforth, the integrator of the source.
//!
//! x' = x + h (3 v - v_before)/2;  v' = v + h (3 a - a_before)/2;  then a' = f(x', v')/m
//!
//! The first step has no past: x' = x + h v + h^2 a/2, v' = v + h a. Its local errors, of order h^3 in x and h^2 in v,
//! occur once, so that the order stays 2. A snapshot holds the past, so that a restart is no first step.

use super::scheme::{Linear, Scheme};

/// Adams-Bashforth from the second step on.
#[derive(Clone, Copy)]
pub(crate) struct AdamsBashforth {
    /// h
    pub(crate) step: f64,
}

impl<V: Linear<f64>> Scheme<V> for AdamsBashforth {
    const TWO_STEP: bool = true;

    #[inline(always)]
    fn displacement(&self, velocity: V, _acceleration: V, velocity_before: V) -> V {
        (velocity * 1.5 - velocity_before * 0.5) * self.step
    }

    #[inline(always)]
    fn predicted(&self, velocity: V, acceleration: V, acceleration_before: V) -> V {
        velocity + (acceleration * 1.5 - acceleration_before * 0.5) * self.step
    }

    #[inline(always)]
    fn corrected(&self, velocity: V, _acceleration: V, _acceleration_before: V) -> V {
        velocity
    }
}
