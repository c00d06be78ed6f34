//! Two numbers in a register of NEON, which every processor of the kind has.

use core::arch::aarch64::*;

use super::pairs::Pair;

/// NEON.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Neon;

// SAFETY of every block below: the target has the instructions.
impl Pair for Neon {
    type Two = float64x2_t;
    type Truth = uint64x2_t;

    operations! { float64x2_t => float64x2_t:
        add vaddq_f64,
        sub vsubq_f64,
        mul vmulq_f64,
        div vdivq_f64,
        firsts vzip1q_f64,
        seconds vzip2q_f64,
    }
    operations! { float64x2_t => uint64x2_t:
        less vcltq_f64,
        at_most vcleq_f64,
    }
    operations! { uint64x2_t => uint64x2_t:
        and vandq_u64,
        or vorrq_u64,
    }

    #[inline(always)]
    fn splat(value: f64) -> float64x2_t {
        unsafe { vdupq_n_f64(value) }
    }

    #[inline(always)]
    fn load(values: &[f64; 2]) -> float64x2_t {
        unsafe { vld1q_f64(values.as_ptr()) }
    }

    #[inline(always)]
    fn store(values: float64x2_t, to: &mut [f64; 2]) {
        unsafe { vst1q_f64(to.as_mut_ptr(), values) }
    }

    // NEON's own minimum and maximum treat NaN in another way.
    #[inline(always)]
    fn min(a: float64x2_t, b: float64x2_t) -> float64x2_t {
        Self::select(Self::less(a, b), a, b)
    }

    #[inline(always)]
    fn max(a: float64x2_t, b: float64x2_t) -> float64x2_t {
        Self::select(Self::less(b, a), a, b)
    }

    #[inline(always)]
    fn sqrt(a: float64x2_t) -> float64x2_t {
        unsafe { vsqrtq_f64(a) }
    }

    #[inline(always)]
    fn abs(a: float64x2_t) -> float64x2_t {
        unsafe { vabsq_f64(a) }
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: float64x2_t, b: float64x2_t) -> [float64x2_t; 2] {
        unsafe {
            let root = vsqrtq_f32(vcvt_high_f32_f64(vcvt_f32_f64(a), b));
            let rough = vdivq_f32(vdupq_n_f32(1.0), root);
            [vcvt_f64_f32(vget_low_f32(rough)), vcvt_high_f64_f32(rough)]
        }
    }

    #[inline(always)]
    fn select(mask: uint64x2_t, yes: float64x2_t, no: float64x2_t) -> float64x2_t {
        unsafe { vbslq_f64(mask, yes, no) }
    }

    #[inline(always)]
    fn not(a: uint64x2_t) -> uint64x2_t {
        unsafe { veorq_u64(a, vdupq_n_u64(u64::MAX)) }
    }

    #[inline(always)]
    fn truth(bits: u8, of: [u64; 2]) -> uint64x2_t {
        unsafe { vtstq_u64(vdupq_n_u64(bits.into()), vld1q_u64(of.as_ptr())) }
    }

    #[inline(always)]
    fn bits([a, b, c, d]: [uint64x2_t; 4]) -> u8 {
        unsafe {
            let low = vmovn_high_u64(vmovn_u64(a), b);
            let high = vmovn_high_u64(vmovn_u64(c), d);
            let all = vmovn_u16(vmovn_high_u32(vmovn_u32(low), high));
            vaddv_u8(vand_u8(
                all,
                vld1_u8([1, 2, 4, 8, 16, 32, 64, 128].as_ptr()),
            ))
        }
    }

    #[inline(always)]
    fn any(of: uint64x2_t) -> bool {
        unsafe { vmaxvq_u32(vreinterpretq_u32_u64(of)) != 0 }
    }
}
