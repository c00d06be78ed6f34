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

mod arithmetic;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod plain;

pub(crate) use self::arithmetic::{Arithmetic, LANES, Machine, Truths};
#[cfg(target_arch = "x86_64")]
use self::avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use self::avx512::Avx512;
use self::plain::Plain;

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

impl Default for Instructions {
    fn default() -> Self {
        Self::widest()
    }
}

impl Instructions {
    /// The widest that this machine has.
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
