//! Velocity Verlet for forces that depend on velocity.
//!
//! x' = x + h v + h^2 a/2;  a' = f(x', v + h a)/m;  v' = v + h (a + a')/2
//!
//! The velocity that the forces see is predicted to the end of the step, with an error of order h^2, so that damping is
//! integrated to order 2 as well (a velocity of the half step would leave order 1). Without damping this is the
//! symplectic velocity Verlet method. Groot & Warren, J. Chem. Phys. 107, 4423 (1997), with lambda = 1.

use super::scheme::{Linear, Scheme};

/// Velocity Verlet with steps of length h, as a number that multiplies vectors of the kind at hand.
#[derive(Clone, Copy)]
pub(crate) struct Verlet<S> {
    /// h
    pub(crate) step: S,
    /// h/2
    pub(crate) half_step: S,
}

impl Verlet<f64> {
    pub(crate) fn with_step(step: f64) -> Self {
        Self {
            step,
            half_step: 0.5 * step,
        }
    }
}

impl<S: Copy, V: Linear<S>> Scheme<V> for Verlet<S> {
    const TWO_STEP: bool = false;

    #[inline(always)]
    fn displacement(&self, velocity: V, acceleration: V, _velocity_before: V) -> V {
        (velocity + acceleration * self.half_step) * self.step
    }

    #[inline(always)]
    fn predicted(&self, velocity: V, acceleration: V, _acceleration_before: V) -> V {
        velocity + acceleration * self.step
    }

    #[inline(always)]
    fn corrected(&self, velocity: V, acceleration: V, acceleration_before: V) -> V {
        velocity + (acceleration - acceleration_before) * self.half_step
    }
}
