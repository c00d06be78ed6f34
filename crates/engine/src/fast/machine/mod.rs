//! Sets of instructions, and the choice of the widest that the machine has, at run time; a team of its cores.
//!
//! A kernel is written once, for any [`Machine`]: how eight numbers are held in registers and what one instruction does
//! with them. It is compiled for each of [`Instructions::ALL`] that the target can have, as the [`Work`] that
//! [`Instructions::run`] is given. Every operation follows IEEE 754, lane by lane, so that all machines give the same bits.
//!
//! This is the only module with unsafe code besides the tests. What makes it sound: the types `Avx512` and `Avx2` can be
//! named nowhere else, so that code for them is reached only through [`Instructions::run`], which has looked for the
//! instructions before. NEON and SIMD128 are compiled only for targets that have them. A [`Team`] says of itself why it is
//! sound.
#![allow(unsafe_code)]

/// Operations on two registers, each an instruction.
#[cfg(not(all(target_family = "wasm", not(target_feature = "simd128"))))]
macro_rules! operations {
    ($arguments:ty => $answer:ty: $($operation:ident $instruction:expr),+ $(,)?) => {$(
        #[inline(always)]
        #[allow(unused_unsafe, reason = "WebAssembly's are safe")]
        fn $operation(a: $arguments, b: $arguments) -> $answer {
            // SAFETY: see the module above.
            unsafe { $instruction(a, b) }
        }
    )+};
}

mod arithmetic;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(any(target_arch = "aarch64", target_feature = "simd128"))]
mod pairs;
#[cfg(not(all(feature = "small", target_feature = "simd128")))]
mod plain;
#[cfg(target_feature = "simd128")]
mod simd128;
mod team;

pub(crate) use self::arithmetic::{Arithmetic, LANES, Machine, Truths};
#[cfg(target_arch = "x86_64")]
use self::avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use self::avx512::Avx512;
#[cfg(target_arch = "aarch64")]
use self::neon::Neon;
#[cfg(not(all(feature = "small", target_feature = "simd128")))]
use self::plain::Plain;
#[cfg(target_feature = "simd128")]
use self::simd128::Simd128;
pub(crate) use self::team::{Apart, Team};

/// Work that is compiled for each set of instructions. `run` must be `#[inline(always)]`, as must be all that it calls
/// with the machine as a type.
pub(crate) trait Work {
    type Answer;
    fn run<M: Machine>(self) -> Self::Answer;
}

/// Instructions that the fast kernels are compiled for; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// 512-bit registers of x86-64.
    Avx512,
    /// 256-bit registers of x86-64.
    Avx2,
    /// 128-bit registers of 64-bit ARM.
    Neon,
    /// 128-bit registers of WebAssembly, for which it must be compiled.
    Simd128,
    /// The instructions that every machine of its kind has.
    Plain,
}

impl Default for Instructions {
    fn default() -> Self {
        Self::widest()
    }
}

impl Instructions {
    /// Each with its name and its meaning in a few words, the widest first.
    pub const ALL: &[(&str, Self, &str)] = &[
        ("avx512", Self::Avx512, "512-bit registers of x86-64"),
        ("avx2", Self::Avx2, "256-bit registers of x86-64"),
        ("neon", Self::Neon, "128-bit registers of 64-bit ARM"),
        ("simd128", Self::Simd128, "128-bit registers of WebAssembly"),
        ("plain", Self::Plain, "what every processor of the kind has"),
    ];

    /// Those that this machine has, the widest first.
    pub fn here() -> impl Iterator<Item = Self> {
        let all = Self::ALL.iter().map(|&(_, instructions, _)| instructions);
        all.filter(|instructions| instructions.available())
    }

    /// The widest that this machine has.
    pub fn widest() -> Self {
        Self::here().next().unwrap_or(Self::Plain)
    }

    /// Whether this machine has them.
    pub fn available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("fma")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt"),
            Self::Neon => cfg!(target_arch = "aarch64"),
            Self::Simd128 => cfg!(target_feature = "simd128"),
            Self::Plain => cfg!(not(all(feature = "small", target_feature = "simd128"))),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx512 | Self::Avx2 => false,
        }
    }

    /// Does the work with these instructions, or with the widest that there are if the machine lacks them.
    pub(crate) fn run<W: Work>(self, work: W) -> W::Answer {
        match self {
            // SAFETY: the features that the functions are compiled for have just been detected.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if self.available() => unsafe { with_avx512(work) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if self.available() => unsafe { with_avx2(work) },
            #[cfg(target_arch = "aarch64")]
            Self::Neon => work.run::<Neon>(),
            #[cfg(target_feature = "simd128")]
            Self::Simd128 => work.run::<Simd128>(),
            #[cfg(not(all(feature = "small", target_feature = "simd128")))]
            Self::Plain => work.run::<Plain>(),
            _ => Self::widest().run(work),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,popcnt")]
fn with_avx512<W: Work>(work: W) -> W::Answer {
    work.run::<Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,popcnt")]
fn with_avx2<W: Work>(work: W) -> W::Answer {
    work.run::<Avx2>()
}

/// Eight numbers on a line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Line(pub(crate) [f64; LANES]);

impl Line {
    /// The numbers of lines, one after the other.
    #[inline(always)]
    pub(crate) fn numbers(lines: &[Self]) -> &[f64] {
        // SAFETY: a line is eight numbers and nothing else.
        unsafe { core::slice::from_raw_parts(lines.as_ptr().cast(), lines.len() * LANES) }
    }

    /// The same, to be written to.
    #[inline(always)]
    pub(crate) fn numbers_mut(lines: &mut [Self]) -> &mut [f64] {
        // SAFETY: as above.
        unsafe { core::slice::from_raw_parts_mut(lines.as_mut_ptr().cast(), lines.len() * LANES) }
    }
}

/// Eight items of a slice. All numbers are looked at before one branch, instead of one by one.
///
/// # Panics
/// Where there is no such item.
#[inline(always)]
pub(crate) fn eight_of<'a, T>(items: &'a [T], at: &[u32; LANES]) -> [&'a T; LANES] {
    let [eight] = eight_of_each([items], at);
    eight
}

/// The same of several slices; the numbers are looked at once for all.
///
/// # Panics
/// Where one of them has no such item.
#[inline(always)]
pub(crate) fn eight_of_each<'a, T, const SLICES: usize>(
    slices: [&'a [T]; SLICES],
    at: &[u32; LANES],
) -> [[&'a T; LANES]; SLICES] {
    let mut end = u32::MAX;
    for items in slices {
        end = end.min(u32::try_from(items.len()).unwrap_or(u32::MAX));
    }
    assert!(
        at.iter().fold(true, |all, &at| all & (at < end)),
        "within the slice"
    );
    // SAFETY: all are below the length of each.
    slices.map(|items| at.map(|at| unsafe { items.get_unchecked(at as usize) }))
}

/// Asks that eight items of a slice be brought near, where the processor can be asked: they are wanted soon. There need not
/// be such items.
#[inline(always)]
pub(crate) fn bring_near<T>(items: &[T], at: &[u32; LANES]) {
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    for &at in at {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let item = items.as_ptr().wrapping_add(at as usize);
        // SAFETY: all of x86-64 have it, and it neither reads nor writes nor fails, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(item.cast()) };
    }
    #[cfg(not(all(target_arch = "x86_64", not(miri))))]
    let _ = (items, at);
}

#[cfg(test)]
mod tests;
