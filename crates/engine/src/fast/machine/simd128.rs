//! Two numbers in a register of WebAssembly.

use core::arch::wasm32::*;

use super::pairs::Pair;

/// SIMD128.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Simd128;

impl Pair for Simd128 {
    type Two = v128;
    type Truth = v128;

    operations! { v128 => v128:
        add f64x2_add,
        sub f64x2_sub,
        mul f64x2_mul,
        div f64x2_div,
        firsts i64x2_shuffle::<0, 2>,
        seconds i64x2_shuffle::<1, 3>,
        less f64x2_lt,
        at_most f64x2_le,
        and v128_and,
        or v128_or,
    }

    #[inline(always)]
    fn splat(value: f64) -> v128 {
        f64x2_splat(value)
    }

    #[inline(always)]
    fn load(values: &[f64; 2]) -> v128 {
        // SAFETY: sixteen bytes lie there; they may lie anywhere.
        unsafe { v128_load(values.as_ptr().cast()) }
    }

    #[inline(always)]
    fn store(values: v128, to: &mut [f64; 2]) {
        // SAFETY: as above.
        unsafe { v128_store(to.as_mut_ptr().cast(), values) }
    }

    // f64x2_pmin(a, b) is b < a ? b : a.
    #[inline(always)]
    fn min(a: v128, b: v128) -> v128 {
        f64x2_pmin(b, a)
    }

    #[inline(always)]
    fn max(a: v128, b: v128) -> v128 {
        f64x2_pmax(b, a)
    }

    #[inline(always)]
    fn sqrt(a: v128) -> v128 {
        f64x2_sqrt(a)
    }

    #[inline(always)]
    fn abs(a: v128) -> v128 {
        f64x2_abs(a)
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: v128, b: v128) -> [v128; 2] {
        // Both in one register take longer: the compiler brings them together number by number.
        [a, b].map(|a| {
            let root = f32x4_sqrt(f32x4_demote_f64x2_zero(a));
            f64x2_promote_low_f32x4(f32x4_div(f32x4_splat(1.0), root))
        })
    }

    #[inline(always)]
    fn select(mask: v128, yes: v128, no: v128) -> v128 {
        v128_bitselect(yes, no, mask)
    }

    #[inline(always)]
    fn not(a: v128) -> v128 {
        v128_not(a)
    }

    #[inline(always)]
    fn truth(bits: u8, [first, second]: [u64; 2]) -> v128 {
        let of = u64x2(first, second);
        i64x2_eq(v128_and(u64x2_splat(bits.into()), of), of)
    }

    #[inline(always)]
    fn bits([a, b, c, d]: [v128; 4]) -> u8 {
        let low = i32x4_shuffle::<0, 2, 4, 6>(a, b);
        let high = i32x4_shuffle::<0, 2, 4, 6>(c, d);
        i16x8_bitmask(i16x8_narrow_i32x4(low, high))
    }

    #[inline(always)]
    fn any(of: v128) -> bool {
        v128_any_true(of)
    }
}
