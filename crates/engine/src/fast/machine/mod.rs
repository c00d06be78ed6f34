//! Sets of instructions, and the choice of the widest that the machine has, at run time.
//!
//! A kernel is written once, for any [`Machine`]: how eight numbers are held in registers and what one instruction does
//! with them. It is compiled for AVX-512, for AVX2 and for plain code, as the [`Work`] that [`Instructions::run`] is
//! given. Every operation follows IEEE 754, lane by lane, so that all machines give the same bits.
//!
//! This is the only module with unsafe code besides the tests. What makes it sound: the types `Avx512` and `Avx2` can be
//! named nowhere else, so that code for them is reached only through [`Instructions::run`], which has looked for the
//! instructions before.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod plain;

use core::fmt::Debug;

#[cfg(target_arch = "x86_64")]
use self::avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use self::avx512::Avx512;
pub(crate) use self::plain::Plain;

/// Number of lanes, whatever the registers of the machine.
pub(crate) const LANES: usize = 8;

/// Eight double precision numbers in registers, and the instructions for them.
pub(crate) trait Machine: Copy + Debug + Send + Sync + 'static {
    /// Eight numbers.
    type Numbers: Copy;
    /// Eight truth values.
    type Truths: Copy;
    /// Four numbers: a vector in space and one number more.
    type Quad: Copy;

    fn splat(value: f64) -> Self::Numbers;
    fn to_array(values: Self::Numbers) -> [f64; LANES];
    fn load(values: &[f64; LANES]) -> Self::Numbers;
    fn store(values: Self::Numbers, to: &mut [f64; LANES]);

    fn add(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn div(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn neg(a: Self::Numbers) -> Self::Numbers;
    fn sqrt(a: Self::Numbers) -> Self::Numbers;
    /// |a|
    fn abs(a: Self::Numbers) -> Self::Numbers;
    /// a < b ? a : b
    fn min(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a > b ? a : b
    fn max(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// 1/sqrt(a) computed in single precision.
    fn rough_reciprocal_sqrt(a: Self::Numbers) -> Self::Numbers;

    fn less(a: Self::Numbers, b: Self::Numbers) -> Self::Truths;
    fn at_most(a: Self::Numbers, b: Self::Numbers) -> Self::Truths;
    fn select(mask: Self::Truths, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers;

    fn and(a: Self::Truths, b: Self::Truths) -> Self::Truths;
    fn or(a: Self::Truths, b: Self::Truths) -> Self::Truths;
    fn not(a: Self::Truths) -> Self::Truths;
    /// Bit l is the truth value of lane l.
    fn from_bits(bits: u8) -> Self::Truths;
    fn to_bits(a: Self::Truths) -> u8;

    /// Writes down the numbers whose bits are set, in order; the numbers behind them are 0 or
    /// some of the numbers.
    fn pack(bits: u8, values: Self::Numbers, to: &mut [f64; LANES]);
    /// The opposite: the numbers in order, one in each lane whose bit is set, and 0 in the others.
    fn unpack(bits: u8, from: &[f64; LANES]) -> Self::Numbers;

    fn load_quad(values: &[f64; 4]) -> Self::Quad;
    fn store_quad(values: Self::Quad, to: &mut [f64; 4]);
    fn splat_quad(value: f64) -> Self::Quad;
    fn add_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad;
    fn sub_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad;
    fn mul_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad;
    /// a < b ? a : b
    fn min_quad(a: Self::Quad, b: Self::Quad) -> Self::Quad;
    /// a > b ? a : b
    fn max_quad(a: Self::Quad, b: Self::Quad) -> Self::Quad;
    /// Eight quads turned into lanes: number k of quad l becomes lane l of numbers k.
    fn lanes_of(quads: [Self::Quad; LANES]) -> [Self::Numbers; 4];
    /// Lanes turned into eight quads.
    fn quads_of(lanes: [Self::Numbers; 4]) -> [Self::Quad; LANES];
    /// Writes down `first` + l for each set bit l, in order; the numbers behind them are arbitrary.
    fn write_set_bits(bits: u8, first: u32, to: &mut [u32; LANES]);
    /// Writes down the numbers whose bits are set, in order; the numbers behind them are arbitrary.
    fn write_chosen(bits: u8, of: &[u32; LANES], to: &mut [u32; LANES]);
}

/// Work that is compiled for each set of instructions. `run` must be `#[inline(always)]`, as must be all that it calls
/// with the machine as a type.
pub(crate) trait Work {
    type Answer;
    fn run<M: Machine>(self) -> Self::Answer;
}

/// Instructions that the fast kernels are compiled for; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// 512-bit registers.
    Avx512,
    /// 256-bit registers.
    Avx2,
    /// The instructions that every machine of its kind has.
    Plain,
}

impl Instructions {
    /// The widest that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt");
            let has_avx512 = has_avx2
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw");
            if has_avx512 {
                return Self::Avx512;
            }
            if has_avx2 {
                return Self::Avx2;
            }
        }
        Self::Plain
    }

    /// Whether this machine has them.
    #[must_use]
    pub fn available(self) -> bool {
        match Self::widest() {
            Self::Avx512 => true,
            Self::Avx2 => self != Self::Avx512,
            Self::Plain => self == Self::Plain,
        }
    }

    /// Does the work with these instructions, or with the widest that there are if the machine lacks them.
    pub(crate) fn run<W: Work>(self, work: W) -> W::Answer {
        #[cfg(target_arch = "x86_64")]
        match (self, Self::widest()) {
            (Self::Avx512, Self::Avx512) => {
                // SAFETY: the features that the function is compiled for have just been detected.
                return unsafe { with_avx512(work) };
            }
            (Self::Avx512 | Self::Avx2, Self::Avx512 | Self::Avx2) => {
                // SAFETY: AVX2 has just been detected; a processor with AVX-512 has it too.
                return unsafe { with_avx2(work) };
            }
            _ => {}
        }
        work.run::<Plain>()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
fn with_avx512<W: Work>(work: W) -> W::Answer {
    work.run::<Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,popcnt")]
fn with_avx2<W: Work>(work: W) -> W::Answer {
    work.run::<Avx2>()
}

#[cfg(test)]
mod tests;
