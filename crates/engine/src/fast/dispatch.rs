//! The widest instructions that the machine has, found at run time.
//!
//! The kernels are ordinary safe code; here each is compiled three times, for AVX-512, for AVX2 and for the plainest
//! x86-64 (or, elsewhere, once). All three give the same bits.
#![allow(unsafe_code)]

/// Work that is compiled for each set of instructions. `run` must be `#[inline(always)]`, as must be all that it calls
/// and that is worth wide instructions.
pub(crate) trait Work {
    type Answer;
    fn run(self) -> Self::Answer;
}

/// Instructions that a kernel is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// 512-bit registers.
    Avx512,
    /// 256-bit registers.
    Avx2,
    /// What every machine of its kind has.
    Plain,
}

impl Instructions {
    /// The widest that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let has_avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw");
            if has_avx512 {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Plain
    }

    /// Does the work with these instructions, or with the widest that there are if the machine lacks them.
    pub(crate) fn run<W: Work>(self, work: W) -> W::Answer {
        let widest = Self::widest();
        #[cfg(target_arch = "x86_64")]
        {
            if self == Self::Avx512 && widest == Self::Avx512 {
                // SAFETY: the features that the function is compiled for have just been detected.
                return unsafe { with_avx512(work) };
            }
            if self != Self::Plain && widest != Self::Plain {
                // SAFETY: AVX2 has just been detected; a processor with AVX-512 has it too.
                return unsafe { with_avx2(work) };
            }
        }
        let _ = widest;
        work.run()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2")]
fn with_avx512<W: Work>(work: W) -> W::Answer {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<W: Work>(work: W) -> W::Answer {
    work.run()
}
