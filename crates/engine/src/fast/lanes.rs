//! Eight numbers side by side.
//!
//! Plain arrays and loops over them: compiled with wide registers each operation is one instruction (or two, or four),
//! and since every lane does the same operations of IEEE 754 in the same order whatever the registers, the results are
//! the same bits on every machine. For the same reason nothing here fuses a multiplication with an addition.

use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use peristalsis_physics::real::{Real, Vector};

/// Number of lanes, whatever the registers of the machine.
pub(crate) const LANES: usize = 8;

/// Eight real numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

/// Eight truth values, each all ones or all zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Mask(pub(crate) [u64; LANES]);

/// Eight vectors in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LaneVector {
    pub(crate) x: Lanes,
    pub(crate) y: Lanes,
    pub(crate) z: Lanes,
}

impl Lanes {
    /// One number from each lane's number.
    #[inline(always)]
    pub(crate) fn from_lanes(of: impl FnMut(usize) -> f64) -> Self {
        Self(core::array::from_fn(of))
    }

    /// The numbers of `slice` from `start` on.
    #[inline(always)]
    pub(crate) fn load(slice: &[f64], start: usize) -> Self {
        let window: &[f64; LANES] = slice[start..start + LANES]
            .try_into()
            .expect("a window of LANES numbers");
        Self(*window)
    }

    /// Writes the numbers into `slice` from `start` on.
    #[inline(always)]
    pub(crate) fn store(self, slice: &mut [f64], start: usize) {
        slice[start..start + LANES].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn zip(self, other: Self, with: impl Fn(f64, f64) -> f64) -> Self {
        Self(core::array::from_fn(|lane| {
            with(self.0[lane], other.0[lane])
        }))
    }

    /// Where this is at most `other`; false where either is not a number.
    #[inline(always)]
    pub(crate) fn at_most(self, other: Self) -> Mask {
        Mask(core::array::from_fn(|lane| {
            0u64.wrapping_sub(u64::from(self.0[lane] <= other.0[lane]))
        }))
    }

    /// The lesser of each lane.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    /// The larger of each lane.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    /// Without signs.
    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    /// 1/sqrt of positive numbers between 1e-30 and 1e30, to within two units in the last place: from single precision
    /// by one step of third order, y (1 + e/2 + 3 e^2/8) with e = 1 - x y^2.
    #[inline(always)]
    pub(crate) fn reciprocal_sqrt(self) -> Self {
        let seed = Self(self.0.map(|x| f64::from(1.0 / (x as f32).sqrt())));
        let rest = Self::splat(1.0) - self * (seed * seed);
        seed + seed * (rest * (Self::splat(0.5) + Self::splat(0.375) * rest))
    }

    /// The sum of all lanes, in an order that does not depend on the machine.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }

    /// The largest of all lanes.
    #[inline(always)]
    pub(crate) fn largest(self) -> f64 {
        self.0
            .into_iter()
            .reduce(|a, b| if a > b { a } else { b })
            .expect("there are lanes")
    }
}

impl Mask {
    /// From a truth value for each lane.
    #[inline(always)]
    pub(crate) fn from_lanes(mut of: impl FnMut(usize) -> bool) -> Self {
        Self(core::array::from_fn(|lane| {
            0u64.wrapping_sub(u64::from(of(lane)))
        }))
    }

    /// Whether it holds anywhere.
    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        self.0.into_iter().fold(0, |all, lane| all | lane) != 0
    }

    /// Number of lanes where it holds.
    #[inline(always)]
    pub(crate) fn count(self) -> u64 {
        self.0.into_iter().map(|lane| lane & 1).sum()
    }

    /// Whether it holds in a lane.
    #[inline(always)]
    pub(crate) fn holds(self, lane: usize) -> bool {
        self.0[lane] != 0
    }
}

impl LaneVector {
    /// A vector in each lane.
    #[inline(always)]
    pub(crate) fn new(x: Lanes, y: Lanes, z: Lanes) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    fn map(self, of: impl Fn(Lanes) -> Lanes) -> Self {
        Self::new(of(self.x), of(self.y), of(self.z))
    }
}

impl Real for Lanes {
    type Mask = Mask;
    type Vector = LaneVector;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn less(self, other: Self) -> Mask {
        Mask(core::array::from_fn(|lane| {
            0u64.wrapping_sub(u64::from(self.0[lane] < other.0[lane]))
        }))
    }

    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        Self(core::array::from_fn(|lane| {
            if mask.0[lane] != 0 {
                yes.0[lane]
            } else {
                no.0[lane]
            }
        }))
    }
}

impl Vector<Lanes> for LaneVector {
    #[inline(always)]
    fn dot(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - other.y * self.z,
            self.z * other.x - other.z * self.x,
            self.x * other.y - other.x * self.y,
        )
    }

    #[inline(always)]
    fn select(mask: Mask, yes: Self, no: Self) -> Self {
        Self::new(
            Lanes::select(mask, yes.x, no.x),
            Lanes::select(mask, yes.y, no.y),
            Lanes::select(mask, yes.z, no.z),
        )
    }
}

macro_rules! lane_by_lane {
    ($($operator:ident $method:ident $symbol:tt;)*) => {$(
        impl $operator for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }
    )*};
}

lane_by_lane! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl Add for LaneVector {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl AddAssign for LaneVector {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for LaneVector {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Neg for LaneVector {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|component| -component)
    }
}

impl Mul<Lanes> for LaneVector {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: Lanes) -> Self {
        self.map(|component| component * by)
    }
}

macro_rules! bit_by_bit {
    ($($operator:ident $method:ident $symbol:tt;)*) => {$(
        impl $operator for Mask {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(core::array::from_fn(|lane| self.0[lane] $symbol other.0[lane]))
            }
        }
    )*};
}

bit_by_bit! {
    BitAnd bitand &;
    BitOr bitor |;
}

impl Not for Mask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}
