//! Numbers in an array: the meaning of every operation, and the code for machines without wide registers.

use super::arithmetic::{Arithmetic, LANES, Machine};

/// Plain code.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plain;

#[inline(always)]
fn zip<const N: usize>(a: [f64; N], b: [f64; N], with: impl Fn(f64, f64) -> f64) -> [f64; N] {
    core::array::from_fn(|lane| with(a[lane], b[lane]))
}

#[inline(always)]
fn bits(of: impl Fn(usize) -> bool) -> u8 {
    (0..LANES).fold(0, |bits, lane| bits | (u8::from(of(lane)) << lane))
}

impl<const N: usize> Arithmetic<N> for Plain {
    type Numbers = [f64; N];

    #[inline(always)]
    fn splat(value: f64) -> [f64; N] {
        [value; N]
    }

    #[inline(always)]
    fn load(values: &[f64; N]) -> [f64; N] {
        *values
    }

    #[inline(always)]
    fn store(values: [f64; N], to: &mut [f64; N]) {
        *to = values;
    }

    #[inline(always)]
    fn add(a: [f64; N], b: [f64; N]) -> [f64; N] {
        zip(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(a: [f64; N], b: [f64; N]) -> [f64; N] {
        zip(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(a: [f64; N], b: [f64; N]) -> [f64; N] {
        zip(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn min(a: [f64; N], b: [f64; N]) -> [f64; N] {
        zip(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(a: [f64; N], b: [f64; N]) -> [f64; N] {
        zip(a, b, |a, b| if a > b { a } else { b })
    }
}

impl Machine for Plain {
    type Quads = Self;
    type Truths = u8;

    #[inline(always)]
    fn div(a: [f64; LANES], b: [f64; LANES]) -> [f64; LANES] {
        zip(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn sqrt(a: [f64; LANES]) -> [f64; LANES] {
        a.map(f64::sqrt)
    }

    #[inline(always)]
    fn abs(a: [f64; LANES]) -> [f64; LANES] {
        a.map(f64::abs)
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: [f64; LANES]) -> [f64; LANES] {
        a.map(|a| f64::from(1.0 / (a as f32).sqrt()))
    }

    #[inline(always)]
    fn less(a: [f64; LANES], b: [f64; LANES]) -> u8 {
        bits(|lane| a[lane] < b[lane])
    }

    #[inline(always)]
    fn at_most(a: [f64; LANES], b: [f64; LANES]) -> u8 {
        bits(|lane| a[lane] <= b[lane])
    }

    #[inline(always)]
    fn select(mask: u8, yes: [f64; LANES], no: [f64; LANES]) -> [f64; LANES] {
        core::array::from_fn(|lane| {
            if mask >> lane & 1 == 1 {
                yes[lane]
            } else {
                no[lane]
            }
        })
    }

    #[inline(always)]
    fn lanes_of_pairs(pairs: [&[f64; 2]; LANES]) -> [[f64; LANES]; 2] {
        core::array::from_fn(|k| core::array::from_fn(|lane| pairs[lane][k]))
    }

    #[inline(always)]
    fn lanes_of(quads: [[f64; 4]; LANES]) -> [[f64; LANES]; 4] {
        core::array::from_fn(|k| quads.map(|quad| quad[k]))
    }

    #[inline(always)]
    fn quads_of(lanes: [[f64; LANES]; 4]) -> [[f64; 4]; LANES] {
        core::array::from_fn(|lane| lanes.map(|numbers| numbers[lane]))
    }
}
