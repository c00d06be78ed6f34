//! Eight numbers in one register of 512 bits.

use core::arch::x86_64::*;

use super::{LANES, Machine};

/// AVX-512 (F, VL, DQ, BW).
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx512;

// SAFETY of every block below: see the module above; the instructions have been found before any of this runs.
impl Machine for Avx512 {
    type Numbers = __m512d;
    type Truths = __mmask8;

    #[inline(always)]
    fn splat(value: f64) -> Self::Numbers {
        unsafe { _mm512_set1_pd(value) }
    }

    #[inline(always)]
    fn from_array([a, b, c, d, e, f, g, h]: [f64; LANES]) -> Self::Numbers {
        unsafe { _mm512_setr_pd(a, b, c, d, e, f, g, h) }
    }

    #[inline(always)]
    fn to_array(values: Self::Numbers) -> [f64; LANES] {
        let mut array = [0.0; LANES];
        Self::store(values, &mut array);
        array
    }

    #[inline(always)]
    fn load(values: &[f64; LANES]) -> Self::Numbers {
        unsafe { _mm512_loadu_pd(values.as_ptr()) }
    }

    #[inline(always)]
    fn store(values: Self::Numbers, to: &mut [f64; LANES]) {
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), values) }
    }

    #[inline(always)]
    fn add(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_add_pd(a, b) }
    }

    #[inline(always)]
    fn sub(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_sub_pd(a, b) }
    }

    #[inline(always)]
    fn mul(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_mul_pd(a, b) }
    }

    #[inline(always)]
    fn div(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_div_pd(a, b) }
    }

    #[inline(always)]
    fn neg(a: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_xor_pd(a, _mm512_set1_pd(-0.0)) }
    }

    #[inline(always)]
    fn sqrt(a: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_sqrt_pd(a) }
    }

    #[inline(always)]
    fn size(a: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_abs_pd(a) }
    }

    #[inline(always)]
    fn lesser(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_min_pd(a, b) }
    }

    #[inline(always)]
    fn larger(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_max_pd(a, b) }
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: Self::Numbers) -> Self::Numbers {
        unsafe {
            let root = _mm256_sqrt_ps(_mm512_cvtpd_ps(a));
            _mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1.0), root))
        }
    }

    #[inline(always)]
    fn less(a: Self::Numbers, b: Self::Numbers) -> Self::Truths {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) }
    }

    #[inline(always)]
    fn at_most(a: Self::Numbers, b: Self::Numbers) -> Self::Truths {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a, b) }
    }

    #[inline(always)]
    fn select(mask: Self::Truths, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers {
        unsafe { _mm512_mask_blend_pd(mask, no, yes) }
    }

    #[inline(always)]
    fn and(a: Self::Truths, b: Self::Truths) -> Self::Truths {
        a & b
    }

    #[inline(always)]
    fn or(a: Self::Truths, b: Self::Truths) -> Self::Truths {
        a | b
    }

    #[inline(always)]
    fn not(a: Self::Truths) -> Self::Truths {
        !a
    }

    #[inline(always)]
    fn from_bits(bits: u8) -> Self::Truths {
        bits
    }

    #[inline(always)]
    fn to_bits(a: Self::Truths) -> u8 {
        a
    }
}
