//! The formulas of an integrator, for any vectors.

use core::ops::{Add, Mul, Sub};

/// Vectors that can be added, and multiplied by numbers of type `S`.
pub(crate) trait Linear<S>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<S, Output = Self>
{
}

impl<S, V: Copy + Add<Output = V> + Sub<Output = V> + Mul<S, Output = V>> Linear<S> for V {}

/// The formulas of an integrator, for the vectors of one sphere or of several side by side.
pub(crate) trait Scheme<V> {
    /// Whether it needs the velocities of the step before.
    const TWO_STEP: bool;

    /// Displacement of the step.
    fn displacement(&self, velocity: V, acceleration: V, velocity_before: V) -> V;

    /// Velocity at the end of the step, as the forces there see it.
    fn predicted(&self, velocity: V, acceleration: V, acceleration_before: V) -> V;

    /// Velocity at the end of the step, from the predicted one and the acceleration there.
    fn corrected(&self, velocity: V, acceleration: V, acceleration_before: V) -> V;
}
