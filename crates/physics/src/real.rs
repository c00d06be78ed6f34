//! Numbers and vectors that the contact laws are written in: one, or several side by side.
//!
//! A law is written once for any [`Real`]: with `f64` it answers for one contact, with a type of several lanes for as
//! many contacts at a time. Choices are made by [`Real::select`], so that each lane does exactly the operations, in the
//! same order, that one contact would see: the same bits, however many lanes.

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Mul, Neg, Not, Sub};

use glam::DVec3;

/// A real number, or several side by side. Every operation follows IEEE 754 in double precision, lane by lane.
pub trait Real:
    Copy
    + Send
    + Sync
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + core::ops::Div<Output = Self>
    + Neg<Output = Self>
{
    /// A truth value for each lane.
    type Mask: Copy
        + Send
        + Sync
        + Debug
        + Default
        + PartialEq
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;
    /// A vector in space of such numbers.
    type Vector: Vector<Self>;

    /// The same number in each lane.
    fn splat(value: f64) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The cube root.
    fn cube_root(self) -> Self;
    /// Where this is less than `other`.
    fn less(self, other: Self) -> Self::Mask;
    /// `yes` where `mask` holds, else `no`; both are evaluated.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// This where it is positive, else 0.
    #[inline(always)]
    fn positive_part(self) -> Self {
        let zero = Self::splat(0.0);
        Self::select(zero.less(self), self, zero)
    }

    /// The lesser of this and `other`.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// The larger of this and `other`.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// The nearest whole number, for numbers below 2^51 in size.
    #[inline(always)]
    fn nearest_integer(self) -> Self {
        // Added to a number, this leaves no digits behind the point.
        let shift = Self::splat(6_755_399_441_055_744.0);
        self + shift - shift
    }

    /// The absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(-self)
    }
}

/// A vector in space whose components are of type `R`.
pub trait Vector<R: Real<Vector = Self>>:
    Copy
    + Send
    + Sync
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<R, Output = Self>
{
    /// The scalar product.
    fn dot(self, other: Self) -> R;
    /// The vector product.
    fn cross(self, other: Self) -> Self;
    /// `yes` where `mask` holds, else `no`.
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self;
}

impl Real for f64 {
    type Mask = bool;
    type Vector = DVec3;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn cube_root(self) -> Self {
        libm::cbrt(self)
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Vector<f64> for DVec3 {
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }

    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        DVec3::cross(self, other)
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
