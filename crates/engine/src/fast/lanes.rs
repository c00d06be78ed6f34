//! Eight numbers, truth values or vectors side by side, for the kernels to compute with.
//!
//! All machines give the same bits: an addition is fused with a multiplication only where the result is rounded all the same.

use core::fmt;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use peristalsis_physics::real::{Real, Vector};

pub(crate) use super::machine::LANES;
use super::machine::{Arithmetic, Machine, Truths};

/// N real numbers.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<A: Arithmetic<N>, const N: usize>(A::Numbers);

/// Eight real numbers.
pub(crate) type Lanes<M> = Numbers<M, LANES>;

/// Four real numbers: a vector in space and one number more.
pub(crate) type Quad<M> = Numbers<<M as Machine>::Quads, 4>;

/// Eight truth values.
#[derive(Clone, Copy)]
pub(crate) struct Mask<M: Machine>(M::Truths);

/// Eight vectors in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LaneVector<M: Machine> {
    pub(crate) x: Lanes<M>,
    pub(crate) y: Lanes<M>,
    pub(crate) z: Lanes<M>,
}

#[inline(always)]
fn window<const N: usize>(slice: &[f64], start: usize) -> &[f64; N] {
    let window = slice[start..start + N].first_chunk();
    window.expect("a window of N numbers")
}

#[inline(always)]
fn window_mut<const N: usize>(slice: &mut [f64], start: usize) -> &mut [f64; N] {
    let window = slice[start..start + N].first_chunk_mut();
    window.expect("a window of N numbers")
}

impl<A: Arithmetic<N>, const N: usize> Numbers<A, N> {
    #[inline(always)]
    pub(crate) fn from_array(values: &[f64; N]) -> Self {
        Self(A::load(values))
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [f64; N] {
        let mut array = [0.0; N];
        A::store(self.0, &mut array);
        array
    }

    /// The same number everywhere.
    #[inline(always)]
    pub(crate) fn splat(value: f64) -> Self {
        Self(A::splat(value))
    }

    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        Self(A::min(self.0, other.0))
    }

    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        Self(A::max(self.0, other.0))
    }
}

impl<M: Machine> Lanes<M> {
    /// The numbers of `slice` from `start` on.
    #[inline(always)]
    pub(crate) fn load(slice: &[f64], start: usize) -> Self {
        Self(M::load(window(slice, start)))
    }

    /// The numbers of `slice` at the given places.
    #[inline(always)]
    pub(crate) fn gather(slice: &[f64], places: &[u32; LANES]) -> Self {
        let mut numbers = [0.0; LANES];
        for lane in 0..LANES {
            numbers[lane] = slice[places[lane] as usize];
        }
        Self::from_array(&numbers)
    }

    /// Writes the numbers into `slice` from `start` on.
    #[inline(always)]
    pub(crate) fn store(self, slice: &mut [f64], start: usize) {
        M::store(self.0, window_mut(slice, start));
    }

    /// The entries of a table that each lane names.
    #[inline(always)]
    pub(crate) fn look_up<T>(table: &[T], places: [i32; LANES]) -> [&T; LANES] {
        let [a, b, c, d, e, f, g, h] = places;
        let entry = |place: i32| &table[place as u32 as usize];
        [
            entry(a),
            entry(b),
            entry(c),
            entry(d),
            entry(e),
            entry(f),
            entry(g),
            entry(h),
        ]
    }

    /// Eight pairs turned into lanes: number k of pair l becomes lane l of numbers k.
    #[inline(always)]
    pub(crate) fn of_pairs(pairs: [&[f64; 2]; LANES]) -> [Self; 2] {
        let [first, second] = M::lanes_of_pairs(pairs);
        [Self(first), Self(second)]
    }

    /// Eight quads turned into lanes: number k of quad l becomes lane l of numbers k.
    #[inline(always)]
    pub(crate) fn of_quads([a, b, c, d, e, f, g, h]: [Quad<M>; LANES]) -> [Self; 4] {
        let [x, y, z, fourth] = M::lanes_of([a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0]);
        [Self(x), Self(y), Self(z), Self(fourth)]
    }

    /// Lanes turned into eight quads.
    #[inline(always)]
    pub(crate) fn to_quads([x, y, z, fourth]: [Self; 4]) -> [Quad<M>; LANES] {
        M::quads_of([x.0, y.0, z.0, fourth.0]).map(Numbers)
    }

    /// Where this is at most `other`; false where either is not a number.
    #[inline(always)]
    pub(crate) fn at_most(self, other: Self) -> Mask<M> {
        Mask(M::at_most(self.0, other.0))
    }

    /// The square root where no divisions are near: one instruction.
    #[inline(always)]
    pub(crate) fn lone_sqrt(self) -> Self {
        Self(M::sqrt(self.0))
    }

    /// 1/sqrt of positive numbers between 1e-30 and 1e30, to within two units in the last place: from single precision
    /// by one step of third order, y (1 + e/2 + 3 e^2/8) with e = 1 - x y^2.
    #[inline(always)]
    pub(crate) fn reciprocal_sqrt(self) -> Self {
        let seed = Self(M::rough_reciprocal_sqrt(self.0));
        let rest = Self::splat(1.0) - self * (seed * seed);
        seed + seed * (rest * (Self::splat(0.5) + Self::splat(0.375) * rest))
    }

    /// The nearest whole numbers, as numbers and as integers; for less than 2^31 in size.
    #[inline(always)]
    pub(crate) fn round(self) -> (Self, [i32; LANES]) {
        // Added to a number, this leaves no digits behind the point, and the integer in the lowest bits.
        let shift = Self::splat(6_755_399_441_055_744.0);
        let shifted = self + shift;
        let mut integers = [0; LANES];
        for (integer, value) in integers.iter_mut().zip(shifted.to_array()) {
            *integer = value.to_bits() as i32;
        }
        (shifted - shift, integers)
    }

    /// The sum of all lanes, in an order that does not depend on the machine.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }

    /// The largest number of all lanes.
    #[inline(always)]
    pub(crate) fn max_lane(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        let max = |a: f64, b: f64| if a > b { a } else { b };
        max(max(max(a, e), max(c, g)), max(max(b, f), max(d, h)))
    }
}

impl<M: Machine> Mask<M> {
    /// Bit l is the truth value of lane l.
    #[inline(always)]
    pub(crate) fn from_bits(bits: u8) -> Self {
        Self(M::Truths::from_bits(bits))
    }

    /// True in the first so many lanes, in all if there are fewer.
    #[inline(always)]
    pub(crate) fn first(number: usize) -> Self {
        Self::from_bits(if number < LANES {
            (1 << number) - 1
        } else {
            u8::MAX
        })
    }

    /// Bit l is the truth value of lane l.
    #[inline(always)]
    pub(crate) fn to_bits(self) -> u8 {
        self.0.to_bits()
    }

    /// Writes down `first` + l for each lane l where it holds, in order; the numbers behind them are arbitrary.
    #[inline(always)]
    pub(crate) fn write_down(self, first: u32, to: &mut [u32; LANES]) {
        M::write_set_bits(self.to_bits(), first, to);
    }

    /// Writes down the numbers of the lanes where it holds, in order; the numbers behind them are arbitrary.
    #[inline(always)]
    pub(crate) fn choose(self, of: &[u32; LANES], to: &mut [u32; LANES]) {
        M::write_chosen(self.to_bits(), of, to);
    }

    /// Whether it holds anywhere.
    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        self.0.any()
    }

    /// Number of lanes where it holds.
    #[inline(always)]
    pub(crate) fn count(self) -> u64 {
        u64::from(self.to_bits().count_ones())
    }
}

impl<M: Machine> LaneVector<M> {
    /// A vector in each lane.
    #[inline(always)]
    pub(crate) fn new(x: Lanes<M>, y: Lanes<M>, z: Lanes<M>) -> Self {
        Self { x, y, z }
    }

    /// |v|^2
    #[inline(always)]
    pub(crate) fn squared(self) -> Lanes<M> {
        self.dot(self)
    }

    #[inline(always)]
    fn map(self, of: impl Fn(Lanes<M>) -> Lanes<M>) -> Self {
        Self::new(of(self.x), of(self.y), of(self.z))
    }
}

impl<M: Machine> Real for Lanes<M> {
    type Mask = Mask<M>;
    type Vector = LaneVector<M>;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(M::splat(value))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(M::sqrt_beside_divisions(self.0))
    }

    fn cube_root(self) -> Self {
        Self::from_array(&self.to_array().map(libm::cbrt))
    }

    #[inline(always)]
    fn less(self, other: Self) -> Mask<M> {
        Mask(M::less(self.0, other.0))
    }

    #[inline(always)]
    fn select(mask: Mask<M>, yes: Self, no: Self) -> Self {
        Self(M::select(mask.0, yes.0, no.0))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(M::min(self.0, other.0))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(M::max(self.0, other.0))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(M::abs(self.0))
    }
}

impl<M: Machine> Vector<Lanes<M>> for LaneVector<M> {
    #[inline(always)]
    fn dot(self, other: Self) -> Lanes<M> {
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
    fn select(mask: Mask<M>, yes: Self, no: Self) -> Self {
        Self::new(
            Lanes::select(mask, yes.x, no.x),
            Lanes::select(mask, yes.y, no.y),
            Lanes::select(mask, yes.z, no.z),
        )
    }
}

/// Operators on numbers, truth values and vectors, and what each answers.
macro_rules! operators {
    ($([$($parameters:tt)+] $operator:ident $operation:ident for $of:ty:
        |$this:ident $(, $other:ident: $with:ty)?| $answer:expr;)+) => {$(
        impl<$($parameters)+> $operator$(<$with>)? for $of {
            type Output = Self;

            #[inline(always)]
            fn $operation($this $(, $other: $with)?) -> Self {
                $answer
            }
        }
    )+};
}

operators! {
    [A: Arithmetic<N>, const N: usize] Add add for Numbers<A, N>:
        |self, other: Self| Self(A::add(self.0, other.0));
    [A: Arithmetic<N>, const N: usize] Sub sub for Numbers<A, N>:
        |self, other: Self| Self(A::sub(self.0, other.0));
    [A: Arithmetic<N>, const N: usize] Mul mul for Numbers<A, N>:
        |self, other: Self| Self(A::mul(self.0, other.0));
    [M: Machine] Div div for Lanes<M>: |self, other: Self| Self(M::div(self.0, other.0));
    [M: Machine] Neg neg for Lanes<M>: |self| self * Self::splat(-1.0);

    [M: Machine] BitAnd bitand for Mask<M>: |self, other: Self| Self(self.0 & other.0);
    [M: Machine] BitOr bitor for Mask<M>: |self, other: Self| Self(self.0 | other.0);
    [M: Machine] Not not for Mask<M>: |self| Self(!self.0);

    [M: Machine] Add add for LaneVector<M>:
        |self, other: Self| Self::new(self.x + other.x, self.y + other.y, self.z + other.z);
    [M: Machine] Sub sub for LaneVector<M>:
        |self, other: Self| Self::new(self.x - other.x, self.y - other.y, self.z - other.z);
    [M: Machine] Neg neg for LaneVector<M>: |self| self.map(|component| -component);
    [M: Machine] Mul mul for LaneVector<M>:
        |self, by: Lanes<M>| self.map(|component| component * by);
}

impl<M: Machine> AddAssign for Lanes<M> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<M: Machine> AddAssign for LaneVector<M> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<M: Machine> Default for Lanes<M> {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl<M: Machine> Default for Mask<M> {
    #[inline(always)]
    fn default() -> Self {
        Self::from_bits(0)
    }
}

impl<M: Machine> PartialEq for Lanes<M> {
    fn eq(&self, other: &Self) -> bool {
        self.to_array() == other.to_array()
    }
}

impl<M: Machine> PartialEq for Mask<M> {
    fn eq(&self, other: &Self) -> bool {
        self.to_bits() == other.to_bits()
    }
}

impl<M: Machine> fmt::Debug for Lanes<M> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_array().fmt(formatter)
    }
}

impl<M: Machine> fmt::Debug for Mask<M> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:#010b}", self.to_bits())
    }
}

impl<M: Machine> Default for LaneVector<M> {
    #[inline(always)]
    fn default() -> Self {
        Self::new(Lanes::default(), Lanes::default(), Lanes::default())
    }
}
