use proptest::prelude::*;

use super::*;

/// Every operation of a machine, on bits.
struct Everything {
    a: [f64; LANES],
    b: [f64; LANES],
    mask: u8,
}

impl Work for Everything {
    type Answer = (Vec<[u64; LANES]>, Vec<u8>);

    #[inline(always)]
    fn run<M: Machine>(self) -> Self::Answer {
        let (a, b) = (M::from_array(self.a), M::load(&self.b));
        let mask = M::from_bits(self.mask);
        let mut stored = [0.0; LANES];
        M::store(b, &mut stored);
        let numbers = [
            M::add(a, b),
            M::sub(a, b),
            M::mul(a, b),
            M::div(a, b),
            M::neg(a),
            M::sqrt(M::size(a)),
            M::size(a),
            M::lesser(a, b),
            M::larger(a, b),
            M::rough_reciprocal_sqrt(M::size(a)),
            M::select(mask, a, b),
            M::splat(self.a[0]),
            M::load(&stored),
        ];
        let truths = [
            M::less(a, b),
            M::at_most(a, b),
            M::and(mask, M::less(a, b)),
            M::or(mask, M::less(a, b)),
            M::not(mask),
        ];
        (
            numbers.map(|n| M::to_array(n).map(f64::to_bits)).to_vec(),
            truths.map(M::to_bits).to_vec(),
        )
    }
}

proptest! {
    #[test]
    fn all_machines_give_the_same_bits(
        a in prop::array::uniform8(-1e6_f64..1e6),
        b in prop::array::uniform8(-1.0_f64..1.0),
        equal in any::<u8>(),
        mask in any::<u8>(),
    ) {
        let mut b = b;
        for lane in 0..LANES {
            if equal >> lane & 1 == 1 {
                b[lane] = a[lane];
            }
        }
        let on = |instructions: Instructions| instructions.run(Everything { a, b, mask });
        let plain = on(Instructions::Plain);
        prop_assert_eq!(&on(Instructions::Avx2), &plain);
        prop_assert_eq!(&on(Instructions::Avx512), &plain);
        prop_assert_eq!(f64::from_bits(plain.0[0][3]), a[3] + b[3]);
        prop_assert_eq!(f64::from_bits(plain.0[10][5]), if mask >> 5 & 1 == 1 { a[5] } else { b[5] });
        prop_assert_eq!(plain.1[0] >> 2 & 1 == 1, a[2] < b[2]);
    }
}
