//! Eight numbers in one register of 512 bits.

use core::arch::x86_64::*;

use super::arithmetic::{Arithmetic, LANES, Machine};
use super::avx2::{Avx2, Four};

/// AVX-512 (F, VL, DQ, BW) and fused multiply-add, which all of these processors have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Avx512;

// SAFETY of every block below: see the module above; the instructions have been found before any of this runs.
impl Arithmetic<LANES> for Avx512 {
    type Numbers = __m512d;

    #[inline(always)]
    fn splat(value: f64) -> __m512d {
        unsafe { _mm512_set1_pd(value) }
    }

    #[inline(always)]
    fn load(values: &[f64; LANES]) -> __m512d {
        unsafe { _mm512_loadu_pd(values.as_ptr()) }
    }

    #[inline(always)]
    fn store(values: __m512d, to: &mut [f64; LANES]) {
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), values) }
    }

    operations! { __m512d => __m512d:
        add _mm512_add_pd,
        sub _mm512_sub_pd,
        mul _mm512_mul_pd,
        min _mm512_min_pd,
        max _mm512_max_pd,
    }
}

impl Machine for Avx512 {
    type Quads = Four;
    type Truths = __mmask8;

    operations! { __m512d => __m512d: div _mm512_div_pd }

    #[inline(always)]
    fn sqrt(a: __m512d) -> __m512d {
        unsafe { _mm512_sqrt_pd(a) }
    }

    /// Multiplications from an estimate of 14 bits on, rounded like the instruction, in a third of its time.
    #[inline(always)]
    fn sqrt_beside_divisions(a: __m512d) -> __m512d {
        unsafe {
            // Far from where a product would overflow, or lose bits to underflow.
            let above = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(a, _mm512_set1_pd(1e-120));
            let within = _mm512_mask_cmp_pd_mask::<_CMP_LT_OQ>(above, a, _mm512_set1_pd(1e120));
            if within != u8::MAX {
                return rare_sqrt(a);
            }
            let half = _mm512_set1_pd(0.5);
            let estimate = _mm512_rsqrt14_pd(a);
            // sqrt(a) and 1/(2 sqrt(a)), whose product is 1/2. Each step squares what is missing.
            let mut root = _mm512_mul_pd(a, estimate);
            let mut inverse = _mm512_mul_pd(half, estimate);
            for _ in 0..2 {
                let missing = _mm512_fnmadd_pd(root, inverse, half);
                root = _mm512_fmadd_pd(root, missing, root);
                inverse = _mm512_fmadd_pd(inverse, missing, inverse);
            }
            // The root is off by a unit in its last place at most. What it leaves of `a` is exact, so that the sum, before
            // it is rounded, is off by less than 2^-104 of itself.
            let left = _mm512_fnmadd_pd(root, root, a);
            _mm512_fmadd_pd(left, inverse, root)
        }
    }

    #[inline(always)]
    fn abs(a: __m512d) -> __m512d {
        unsafe { _mm512_abs_pd(a) }
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: __m512d) -> __m512d {
        unsafe {
            let root = _mm256_sqrt_ps(_mm512_cvtpd_ps(a));
            _mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1.0), root))
        }
    }

    #[inline(always)]
    fn less(a: __m512d, b: __m512d) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) }
    }

    #[inline(always)]
    fn at_most(a: __m512d, b: __m512d) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a, b) }
    }

    #[inline(always)]
    fn select(mask: __mmask8, yes: __m512d, no: __m512d) -> __m512d {
        unsafe { _mm512_mask_blend_pd(mask, no, yes) }
    }

    #[inline(always)]
    fn lanes_of_pairs(pairs: [&[f64; 2]; LANES]) -> [__m512d; 2] {
        let [firsts, seconds] = Avx2::lanes_of_pairs(pairs);
        [both(firsts[0], firsts[1]), both(seconds[0], seconds[1])]
    }

    #[inline(always)]
    fn lanes_of([a, b, c, d, e, f, g, h]: [__m256d; LANES]) -> [__m512d; 4] {
        // In blocks of 128 bits: [x0 x1][z0 z1][x2 x3][z2 z3] and so on, whose even and odd blocks are then brought
        // together.
        unsafe {
            let (ac, bd) = (both(a, c), both(b, d));
            let (eg, fh) = (both(e, g), both(f, h));
            let (low, high) = (_mm512_unpacklo_pd(ac, bd), _mm512_unpacklo_pd(eg, fh));
            let (low_odd, high_odd) = (_mm512_unpackhi_pd(ac, bd), _mm512_unpackhi_pd(eg, fh));
            [
                _mm512_shuffle_f64x2::<0b10_00_10_00>(low, high),
                _mm512_shuffle_f64x2::<0b10_00_10_00>(low_odd, high_odd),
                _mm512_shuffle_f64x2::<0b11_01_11_01>(low, high),
                _mm512_shuffle_f64x2::<0b11_01_11_01>(low_odd, high_odd),
            ]
        }
    }

    #[inline(always)]
    fn quads_of([x, y, z, w]: [__m512d; 4]) -> [__m256d; LANES] {
        unsafe {
            let (xy_even, xy_odd) = (_mm512_unpacklo_pd(x, y), _mm512_unpackhi_pd(x, y));
            let (zw_even, zw_odd) = (_mm512_unpacklo_pd(z, w), _mm512_unpackhi_pd(z, w));
            let low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
            let high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
            let ac = _mm512_permutex2var_pd(xy_even, low, zw_even);
            let bd = _mm512_permutex2var_pd(xy_odd, low, zw_odd);
            let eg = _mm512_permutex2var_pd(xy_even, high, zw_even);
            let fh = _mm512_permutex2var_pd(xy_odd, high, zw_odd);
            let halves =
                |of: __m512d| (_mm512_castpd512_pd256(of), _mm512_extractf64x4_pd::<1>(of));
            let ((a, c), (b, d)) = (halves(ac), halves(bd));
            let ((e, g), (f, h)) = (halves(eg), halves(fh));
            [a, b, c, d, e, f, g, h]
        }
    }

    #[inline(always)]
    fn write_set_bits(bits: u8, first: u32, to: &mut [u32; LANES]) {
        unsafe {
            let numbers = _mm256_add_epi32(
                _mm256_set1_epi32(first as i32),
                _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
            );
            let packed = _mm256_maskz_compress_epi32(bits, numbers);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), packed);
        }
    }

    #[inline(always)]
    fn write_chosen(bits: u8, of: &[u32; LANES], to: &mut [u32; LANES]) {
        unsafe {
            let numbers = _mm256_loadu_si256(of.as_ptr().cast());
            let packed = _mm256_maskz_compress_epi32(bits, numbers);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), packed);
        }
    }
}

/// For zeros and numbers very far from 1.
#[cold]
#[target_feature(enable = "avx512f")]
fn rare_sqrt(a: __m512d) -> __m512d {
    _mm512_sqrt_pd(a)
}

#[inline(always)]
fn both(low: __m256d, high: __m256d) -> __m512d {
    // SAFETY: see the module above; the instructions have been found before any of this runs.
    unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high) }
}
