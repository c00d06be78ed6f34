//! Eight numbers in an array: the meaning of every operation, and the code for machines without wide registers.

use super::{LANES, Machine};

/// Plain code.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain;

#[inline(always)]
fn zip(a: [f64; LANES], b: [f64; LANES], with: impl Fn(f64, f64) -> f64) -> [f64; LANES] {
    core::array::from_fn(|lane| with(a[lane], b[lane]))
}

#[inline(always)]
fn bits(of: impl Fn(usize) -> bool) -> u8 {
    (0..LANES).fold(0, |bits, lane| bits | (u8::from(of(lane)) << lane))
}

impl Machine for Plain {
    type Numbers = [f64; LANES];
    type Truths = u8;
    type Quad = [f64; 4];

    #[inline(always)]
    fn splat(value: f64) -> Self::Numbers {
        [value; LANES]
    }

    #[inline(always)]
    fn to_array(values: Self::Numbers) -> [f64; LANES] {
        values
    }

    #[inline(always)]
    fn load(values: &[f64; LANES]) -> Self::Numbers {
        *values
    }

    #[inline(always)]
    fn store(values: Self::Numbers, to: &mut [f64; LANES]) {
        *to = values;
    }

    #[inline(always)]
    fn add(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn div(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn neg(a: Self::Numbers) -> Self::Numbers {
        a.map(|a| -a)
    }

    #[inline(always)]
    fn sqrt(a: Self::Numbers) -> Self::Numbers {
        a.map(f64::sqrt)
    }

    #[inline(always)]
    fn abs(a: Self::Numbers) -> Self::Numbers {
        a.map(f64::abs)
    }

    #[inline(always)]
    fn min(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        zip(a, b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt(a: Self::Numbers) -> Self::Numbers {
        a.map(|a| f64::from(1.0 / (a as f32).sqrt()))
    }

    #[inline(always)]
    fn less(a: Self::Numbers, b: Self::Numbers) -> Self::Truths {
        bits(|lane| a[lane] < b[lane])
    }

    #[inline(always)]
    fn at_most(a: Self::Numbers, b: Self::Numbers) -> Self::Truths {
        bits(|lane| a[lane] <= b[lane])
    }

    #[inline(always)]
    fn select(mask: Self::Truths, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers {
        core::array::from_fn(|lane| {
            if mask >> lane & 1 == 1 {
                yes[lane]
            } else {
                no[lane]
            }
        })
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

    #[inline(always)]
    fn pack(bits: u8, values: Self::Numbers, to: &mut [f64; LANES]) {
        let mut at = 0;
        for (lane, value) in values.into_iter().enumerate() {
            to[at & (LANES - 1)] = value;
            at += usize::from((bits >> lane) & 1);
        }
    }

    #[inline(always)]
    fn unpack(bits: u8, from: &[f64; LANES]) -> Self::Numbers {
        let mut at = 0;
        core::array::from_fn(|lane| {
            let set = (bits >> lane) & 1;
            let value = from[at & (LANES - 1)];
            at += usize::from(set);
            if set == 1 { value } else { 0.0 }
        })
    }

    #[inline(always)]
    fn load_quad(values: &[f64; 4]) -> Self::Quad {
        *values
    }

    #[inline(always)]
    fn store_quad(values: Self::Quad, to: &mut [f64; 4]) {
        *to = values;
    }

    #[inline(always)]
    fn splat_quad(value: f64) -> Self::Quad {
        [value; 4]
    }

    #[inline(always)]
    fn add_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad {
        core::array::from_fn(|k| a[k] + b[k])
    }

    #[inline(always)]
    fn sub_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad {
        core::array::from_fn(|k| a[k] - b[k])
    }

    #[inline(always)]
    fn mul_quads(a: Self::Quad, b: Self::Quad) -> Self::Quad {
        core::array::from_fn(|k| a[k] * b[k])
    }

    #[inline(always)]
    fn min_quad(a: Self::Quad, b: Self::Quad) -> Self::Quad {
        core::array::from_fn(|k| if a[k] < b[k] { a[k] } else { b[k] })
    }

    #[inline(always)]
    fn max_quad(a: Self::Quad, b: Self::Quad) -> Self::Quad {
        core::array::from_fn(|k| if a[k] > b[k] { a[k] } else { b[k] })
    }

    #[inline(always)]
    fn lanes_of(quads: [Self::Quad; LANES]) -> [Self::Numbers; 4] {
        core::array::from_fn(|k| quads.map(|quad| quad[k]))
    }

    #[inline(always)]
    fn quads_of(lanes: [Self::Numbers; 4]) -> [Self::Quad; LANES] {
        core::array::from_fn(|lane| lanes.map(|numbers| numbers[lane]))
    }

    #[inline(always)]
    fn write_set_bits(bits: u8, first: u32, to: &mut [u32; LANES]) {
        let mut at = 0;
        for lane in 0..LANES {
            to[at & (LANES - 1)] = first + lane as u32;
            at += usize::from((bits >> lane) & 1);
        }
    }

    #[inline(always)]
    fn write_chosen(bits: u8, of: &[u32; LANES], to: &mut [u32; LANES]) {
        let mut at = 0;
        for (lane, &number) in of.iter().enumerate() {
            to[at & (LANES - 1)] = number;
            at += usize::from((bits >> lane) & 1);
        }
    }
}
