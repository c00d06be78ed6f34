//! Eight numbers in four registers of 128 bits, and four in two.

use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, Not};

use super::arithmetic::{Arithmetic, LANES, Machine, Truths};

/// Two numbers in one register, and the instructions for them.
pub(crate) trait Pair: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    type Two: Copy + Send + Sync;
    /// All bits of a lane are its truth value.
    type Truth: Copy + Send + Sync;

    fn splat(value: f64) -> Self::Two;
    fn load(values: &[f64; 2]) -> Self::Two;
    fn store(values: Self::Two, to: &mut [f64; 2]);
    fn add(a: Self::Two, b: Self::Two) -> Self::Two;
    fn sub(a: Self::Two, b: Self::Two) -> Self::Two;
    fn mul(a: Self::Two, b: Self::Two) -> Self::Two;
    fn div(a: Self::Two, b: Self::Two) -> Self::Two;
    /// a < b ? a : b
    fn min(a: Self::Two, b: Self::Two) -> Self::Two;
    /// a > b ? a : b
    fn max(a: Self::Two, b: Self::Two) -> Self::Two;
    fn sqrt(a: Self::Two) -> Self::Two;
    fn abs(a: Self::Two) -> Self::Two;
    /// 1/sqrt of two pairs, computed in single precision.
    fn rough_reciprocal_sqrt(a: Self::Two, b: Self::Two) -> [Self::Two; 2];
    /// The first numbers of both.
    fn firsts(a: Self::Two, b: Self::Two) -> Self::Two;
    /// The second numbers of both.
    fn seconds(a: Self::Two, b: Self::Two) -> Self::Two;

    fn less(a: Self::Two, b: Self::Two) -> Self::Truth;
    fn at_most(a: Self::Two, b: Self::Two) -> Self::Truth;
    fn select(mask: Self::Truth, yes: Self::Two, no: Self::Two) -> Self::Two;
    fn and(a: Self::Truth, b: Self::Truth) -> Self::Truth;
    fn or(a: Self::Truth, b: Self::Truth) -> Self::Truth;
    fn not(a: Self::Truth) -> Self::Truth;
    /// True where a bit is set that `bits` has as well.
    fn truth(bits: u8, of: [u64; 2]) -> Self::Truth;
    /// Bit 2 k + l is the truth value of lane l of pair k.
    fn bits(of: [Self::Truth; 4]) -> u8;
    fn any(of: Self::Truth) -> bool;
}

#[inline(always)]
fn each<A: Copy, B: Copy, C, const N: usize>(
    a: [A; N],
    b: [B; N],
    with: impl Fn(A, B) -> C,
) -> [C; N] {
    core::array::from_fn(|pair| with(a[pair], b[pair]))
}

/// N numbers in M pairs of them.
macro_rules! arithmetic_of_pairs {
    ($numbers:expr, $pairs:expr) => {
        impl<P: Pair> Arithmetic<$numbers> for P {
            type Numbers = [P::Two; $pairs];

            #[inline(always)]
            fn splat(value: f64) -> Self::Numbers {
                [P::splat(value); $pairs]
            }

            #[inline(always)]
            fn load(values: &[f64; $numbers]) -> Self::Numbers {
                let (pairs, _) = values.as_chunks();
                core::array::from_fn(|pair| P::load(&pairs[pair]))
            }

            #[inline(always)]
            fn store(values: Self::Numbers, to: &mut [f64; $numbers]) {
                let (pairs, _) = to.as_chunks_mut();
                for (pair, values) in pairs.iter_mut().zip(values) {
                    P::store(values, pair);
                }
            }

            #[inline(always)]
            fn add(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
                each(a, b, P::add)
            }

            #[inline(always)]
            fn sub(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
                each(a, b, P::sub)
            }

            #[inline(always)]
            fn mul(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
                each(a, b, P::mul)
            }

            #[inline(always)]
            fn min(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
                each(a, b, P::min)
            }

            #[inline(always)]
            fn max(a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
                each(a, b, P::max)
            }
        }
    };
}

arithmetic_of_pairs!(4, 2);
arithmetic_of_pairs!(8, 4);

/// Truth values of eight numbers.
#[derive(Clone, Copy)]
pub(crate) struct TruthsOf<P: Pair>([P::Truth; 4]);

impl<P: Pair> Machine for P {
    type Quads = P;
    type Truths = TruthsOf<P>;

    #[inline(always)]
    fn div(a: [P::Two; 4], b: [P::Two; 4]) -> [P::Two; 4] {
        each(a, b, P::div)
    }

    #[inline(always)]
    fn sqrt(a: [P::Two; 4]) -> [P::Two; 4] {
        a.map(P::sqrt)
    }

    #[inline(always)]
    fn abs(a: [P::Two; 4]) -> [P::Two; 4] {
        a.map(P::abs)
    }

    #[inline(always)]
    fn rough_reciprocal_sqrt([a, b, c, d]: [P::Two; 4]) -> [P::Two; 4] {
        let [a, b] = P::rough_reciprocal_sqrt(a, b);
        let [c, d] = P::rough_reciprocal_sqrt(c, d);
        [a, b, c, d]
    }

    #[inline(always)]
    fn less(a: [P::Two; 4], b: [P::Two; 4]) -> TruthsOf<P> {
        TruthsOf(each(a, b, P::less))
    }

    #[inline(always)]
    fn at_most(a: [P::Two; 4], b: [P::Two; 4]) -> TruthsOf<P> {
        TruthsOf(each(a, b, P::at_most))
    }

    #[inline(always)]
    fn select(TruthsOf(mask): TruthsOf<P>, yes: [P::Two; 4], no: [P::Two; 4]) -> [P::Two; 4] {
        core::array::from_fn(|pair| P::select(mask[pair], yes[pair], no[pair]))
    }

    #[inline(always)]
    fn lanes_of_pairs(pairs: [&[f64; 2]; LANES]) -> [[P::Two; 4]; 2] {
        let loaded = |lane: usize| P::load(pairs[lane]);
        let two = |pair: usize| (loaded(2 * pair), loaded(2 * pair + 1));
        let [a, b, c, d] = [two(0), two(1), two(2), two(3)];
        let firsts = [a, b, c, d].map(|(one, other)| P::firsts(one, other));
        [
            firsts,
            [a, b, c, d].map(|(one, other)| P::seconds(one, other)),
        ]
    }

    #[inline(always)]
    fn lanes_of(quads: [[P::Two; 2]; LANES]) -> [[P::Two; 4]; 4] {
        core::array::from_fn(|k| {
            core::array::from_fn(|pair| {
                let (a, b) = (quads[2 * pair][k / 2], quads[2 * pair + 1][k / 2]);
                if k % 2 == 0 {
                    P::firsts(a, b)
                } else {
                    P::seconds(a, b)
                }
            })
        })
    }

    #[inline(always)]
    fn quads_of([x, y, z, w]: [[P::Two; 4]; 4]) -> [[P::Two; 2]; LANES] {
        core::array::from_fn(|lane| {
            let pair = lane / 2;
            let (xy, zw) = ((x[pair], y[pair]), (z[pair], w[pair]));
            if lane % 2 == 0 {
                [P::firsts(xy.0, xy.1), P::firsts(zw.0, zw.1)]
            } else {
                [P::seconds(xy.0, xy.1), P::seconds(zw.0, zw.1)]
            }
        })
    }
}

impl<P: Pair> Truths for TruthsOf<P> {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        Self(core::array::from_fn(|pair| {
            P::truth(bits, [1 << (2 * pair), 2 << (2 * pair)])
        }))
    }

    #[inline(always)]
    fn to_bits(self) -> u8 {
        P::bits(self.0)
    }

    #[inline(always)]
    fn any(self) -> bool {
        let [a, b, c, d] = self.0;
        P::any(P::or(P::or(a, b), P::or(c, d)))
    }
}

impl<P: Pair> BitAnd for TruthsOf<P> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, Self(b): Self) -> Self {
        Self(each(self.0, b, P::and))
    }
}

impl<P: Pair> BitOr for TruthsOf<P> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, Self(b): Self) -> Self {
        Self(each(self.0, b, P::or))
    }
}

impl<P: Pair> Not for TruthsOf<P> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(P::not))
    }
}
