//! What a kernel asks of the registers of a machine.

use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, Not};

/// Number of lanes, whatever the registers of the machine.
pub(crate) const LANES: usize = 8;

/// N double precision numbers in registers, and the instructions for them.
pub(crate) trait Arithmetic<const N: usize>: Copy + Debug + Send + Sync + 'static {
    type Numbers: Copy + Send + Sync;

    fn splat(value: f64) -> Self::Numbers;
    fn load(values: &[f64; N]) -> Self::Numbers;
    fn store(values: Self::Numbers, to: &mut [f64; N]);
    fn add(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a < b ? a : b
    fn min(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a > b ? a : b
    fn max(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
}

/// Eight truth values; bit l is that of lane l.
pub(crate) trait Truths:
    Copy + Send + Sync + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    fn from_bits(bits: u8) -> Self;
    fn to_bits(self) -> u8;

    /// Whether any is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.to_bits() != 0
    }
}

impl Truths for u8 {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        bits
    }

    #[inline(always)]
    fn to_bits(self) -> u8 {
        self
    }
}

/// The instructions for eight numbers that are not for four as well.
pub(crate) trait Machine: Arithmetic<LANES> + Default + PartialEq {
    /// Four numbers: a vector in space and one number more.
    type Quads: Arithmetic<4>;
    type Truths: Truths;

    fn div(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sqrt(a: Self::Numbers) -> Self::Numbers;
    /// The same root, for code that divides too: a processor has one unit for both, which does one at a time.
    #[inline(always)]
    fn sqrt_beside_divisions(a: Self::Numbers) -> Self::Numbers {
        Self::sqrt(a)
    }
    /// |a|
    fn abs(a: Self::Numbers) -> Self::Numbers;
    /// 1/sqrt(a) computed in single precision.
    fn rough_reciprocal_sqrt(a: Self::Numbers) -> Self::Numbers;

    fn less(a: Self::Numbers, b: Self::Numbers) -> Self::Truths;
    fn at_most(a: Self::Numbers, b: Self::Numbers) -> Self::Truths;
    fn select(mask: Self::Truths, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers;

    /// Eight pairs turned into lanes: number k of pair l becomes lane l of numbers k.
    fn lanes_of_pairs(pairs: [&[f64; 2]; LANES]) -> [Self::Numbers; 2];
    /// Eight quads turned into lanes: number k of quad l becomes lane l of numbers k.
    fn lanes_of(quads: [Quad<Self>; LANES]) -> [Self::Numbers; 4];
    /// Lanes turned into eight quads.
    fn quads_of(lanes: [Self::Numbers; 4]) -> [Quad<Self>; LANES];

    /// Writes down `first` + l for each set bit l, in order; the numbers behind them are arbitrary.
    #[inline(always)]
    fn write_set_bits(bits: u8, first: u32, to: &mut [u32; LANES]) {
        for (to, &lane) in to.iter_mut().zip(&SET_BITS[usize::from(bits)]) {
            *to = first + u32::from(lane);
        }
    }

    /// Writes down the numbers whose bits are set, in order; the numbers behind them are arbitrary.
    #[inline(always)]
    fn write_chosen(bits: u8, of: &[u32; LANES], to: &mut [u32; LANES]) {
        let mut at = 0;
        for (lane, &number) in of.iter().enumerate() {
            to[at & (LANES - 1)] = number;
            at += usize::from((bits >> lane) & 1);
        }
    }
}

/// For eight bits, those that are set, in order.
pub(super) static SET_BITS: [[u8; LANES]; 256] = set_bits();

const fn set_bits() -> [[u8; LANES]; 256] {
    let mut all = [[0; LANES]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut number) = (0, 0);
        while lane < LANES {
            if bits >> lane & 1 == 1 {
                all[bits][number] = lane as u8;
                number += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    all
}

/// Four numbers in a register of a machine.
pub(crate) type Quad<M> = <<M as Machine>::Quads as Arithmetic<4>>::Numbers;
