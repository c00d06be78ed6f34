//! Eight numbers in two registers of 256 bits.

use core::arch::x86_64::*;
use core::ops::{BitAnd, BitOr, Not};

use super::arithmetic::{Arithmetic, LANES, Machine, SET_BITS, Truths};

/// AVX2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Avx2;

/// Four numbers in one register.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four;

/// All bits of a lane are its truth value.
#[derive(Clone, Copy)]
pub(super) struct Halves([__m256d; 2]);

/// Does the same with both registers.
macro_rules! both {
    ($operation:ident($($argument:ident),+)) => {
        // SAFETY: see the module above; the instructions have been found before any of this runs.
        unsafe { [$operation($($argument[0]),+), $operation($($argument[1]),+)] }
    };
}

/// Operations on two vectors of numbers, each an instruction for both registers.
macro_rules! operations_of_both {
    ($($operation:ident $instruction:ident),+ $(,)?) => {$(
        #[inline(always)]
        fn $operation(a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
            both!($instruction(a, b))
        }
    )+};
}

// SAFETY of every block below: as above.
impl Arithmetic<4> for Four {
    type Numbers = __m256d;

    #[inline(always)]
    fn splat(value: f64) -> __m256d {
        unsafe { _mm256_set1_pd(value) }
    }

    #[inline(always)]
    fn load(values: &[f64; 4]) -> __m256d {
        unsafe { _mm256_loadu_pd(values.as_ptr()) }
    }

    #[inline(always)]
    fn store(values: __m256d, to: &mut [f64; 4]) {
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), values) }
    }

    operations! { __m256d => __m256d:
        add _mm256_add_pd,
        sub _mm256_sub_pd,
        mul _mm256_mul_pd,
        min _mm256_min_pd,
        max _mm256_max_pd,
    }
}

impl Arithmetic<LANES> for Avx2 {
    type Numbers = [__m256d; 2];

    #[inline(always)]
    fn splat(value: f64) -> [__m256d; 2] {
        unsafe { [_mm256_set1_pd(value); 2] }
    }

    #[inline(always)]
    fn load(values: &[f64; LANES]) -> [__m256d; 2] {
        let (low, high) = values.split_at(4);
        unsafe {
            [
                _mm256_loadu_pd(low.as_ptr()),
                _mm256_loadu_pd(high.as_ptr()),
            ]
        }
    }

    #[inline(always)]
    fn store(values: [__m256d; 2], to: &mut [f64; LANES]) {
        let (low, high) = to.split_at_mut(4);
        unsafe {
            _mm256_storeu_pd(low.as_mut_ptr(), values[0]);
            _mm256_storeu_pd(high.as_mut_ptr(), values[1]);
        }
    }

    operations_of_both! {
        add _mm256_add_pd,
        sub _mm256_sub_pd,
        mul _mm256_mul_pd,
        min _mm256_min_pd,
        max _mm256_max_pd,
    }
}

impl Machine for Avx2 {
    type Quads = Four;
    type Truths = Halves;

    operations_of_both! { div _mm256_div_pd }

    #[inline(always)]
    fn sqrt(a: [__m256d; 2]) -> [__m256d; 2] {
        both!(_mm256_sqrt_pd(a))
    }

    #[inline(always)]
    fn abs(a: [__m256d; 2]) -> [__m256d; 2] {
        let sign = Self::splat(-0.0);
        both!(_mm256_andnot_pd(sign, a))
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: [__m256d; 2]) -> [__m256d; 2] {
        [rough_reciprocal_sqrt(a[0]), rough_reciprocal_sqrt(a[1])]
    }

    #[inline(always)]
    fn less(a: [__m256d; 2], b: [__m256d; 2]) -> Halves {
        unsafe {
            Halves([
                _mm256_cmp_pd::<_CMP_LT_OQ>(a[0], b[0]),
                _mm256_cmp_pd::<_CMP_LT_OQ>(a[1], b[1]),
            ])
        }
    }

    #[inline(always)]
    fn at_most(a: [__m256d; 2], b: [__m256d; 2]) -> Halves {
        unsafe {
            Halves([
                _mm256_cmp_pd::<_CMP_LE_OQ>(a[0], b[0]),
                _mm256_cmp_pd::<_CMP_LE_OQ>(a[1], b[1]),
            ])
        }
    }

    #[inline(always)]
    fn select(Halves(mask): Halves, yes: [__m256d; 2], no: [__m256d; 2]) -> [__m256d; 2] {
        both!(_mm256_blendv_pd(no, yes, mask))
    }

    #[inline(always)]
    fn write_set_bits(bits: u8, first: u32, to: &mut [u32; LANES]) {
        unsafe {
            let set = _mm_loadl_epi64(SET_BITS[usize::from(bits)].as_ptr().cast());
            let numbers =
                _mm256_add_epi32(_mm256_set1_epi32(first as i32), _mm256_cvtepu8_epi32(set));
            _mm256_storeu_si256(to.as_mut_ptr().cast(), numbers);
        }
    }

    #[inline(always)]
    fn lanes_of_pairs([a, b, c, d, e, f, g, h]: [&[f64; 2]; LANES]) -> [[__m256d; 2]; 2] {
        let (ac, bd, eg, fh) = (of_two(a, c), of_two(b, d), of_two(e, g), of_two(f, h));
        unsafe {
            [
                [_mm256_unpacklo_pd(ac, bd), _mm256_unpacklo_pd(eg, fh)],
                [_mm256_unpackhi_pd(ac, bd), _mm256_unpackhi_pd(eg, fh)],
            ]
        }
    }

    #[inline(always)]
    fn write_chosen(bits: u8, of: &[u32; LANES], to: &mut [u32; LANES]) {
        unsafe {
            let from = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(CHOSEN[usize::from(bits)]));
            let chosen = _mm256_permutevar8x32_epi32(_mm256_loadu_si256(of.as_ptr().cast()), from);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), chosen);
        }
    }

    #[inline(always)]
    fn lanes_of([a, b, c, d, e, f, g, h]: [__m256d; LANES]) -> [[__m256d; 2]; 4] {
        let (low, high) = (transpose([a, b, c, d]), transpose([e, f, g, h]));
        core::array::from_fn(|k| [low[k], high[k]])
    }

    #[inline(always)]
    fn quads_of([x, y, z, w]: [[__m256d; 2]; 4]) -> [__m256d; LANES] {
        let [a, b, c, d] = transpose([x[0], y[0], z[0], w[0]]);
        let [e, f, g, h] = transpose([x[1], y[1], z[1], w[1]]);
        [a, b, c, d, e, f, g, h]
    }
}

impl Truths for Halves {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        unsafe {
            let bits = _mm256_set1_epi64x(i64::from(bits));
            let (low, high) = (
                _mm256_setr_epi64x(1, 2, 4, 8),
                _mm256_setr_epi64x(16, 32, 64, 128),
            );
            Self([
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, low), low)),
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, high), high)),
            ])
        }
    }

    #[inline(always)]
    fn to_bits(self) -> u8 {
        let Self(a) = self;
        unsafe { (_mm256_movemask_pd(a[0]) | _mm256_movemask_pd(a[1]) << 4) as u8 }
    }
}

impl BitAnd for Halves {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, Self(b): Self) -> Self {
        let Self(a) = self;
        Self(both!(_mm256_and_pd(a, b)))
    }
}

impl BitOr for Halves {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, Self(b): Self) -> Self {
        let Self(a) = self;
        Self(both!(_mm256_or_pd(a, b)))
    }
}

impl Not for Halves {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        let Self(a) = self;
        let all = unsafe { [_mm256_castsi256_pd(_mm256_set1_epi64x(-1)); 2] };
        Self(both!(_mm256_xor_pd(a, all)))
    }
}

#[inline(always)]
fn rough_reciprocal_sqrt(a: __m256d) -> __m256d {
    // SAFETY: see the module above; the instructions have been found before any of this runs.
    unsafe {
        let root = _mm_sqrt_ps(_mm256_cvtpd_ps(a));
        _mm256_cvtps_pd(_mm_div_ps(_mm_set1_ps(1.0), root))
    }
}

/// Two pairs in one register.
#[inline(always)]
fn of_two(a: &[f64; 2], b: &[f64; 2]) -> __m256d {
    // SAFETY: see the module above; the instructions have been found before any of this runs.
    unsafe { _mm256_loadu2_m128d(b.as_ptr(), a.as_ptr()) }
}

/// Rows and columns of four by four numbers exchanged.
#[inline(always)]
fn transpose([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: see the module above; the instructions have been found before any of this runs.
    unsafe {
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }
}

/// For each number of eight bits the places of those that are set, a byte each, in order.
const CHOSEN: [i64; 256] = {
    let mut table = [0; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut at) = (0, 0);
        while lane < LANES {
            if bits >> lane & 1 == 1 {
                table[bits] |= (lane as i64) << (8 * at);
                at += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    table
};
