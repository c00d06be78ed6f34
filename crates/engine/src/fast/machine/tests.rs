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
        let (a, b) = (M::load(&self.a), M::load(&self.b));
        let mask = M::Truths::from_bits(self.mask);
        let array = |numbers| {
            let mut array = [0.0; LANES];
            M::store(numbers, &mut array);
            array
        };
        let numbers = [
            M::add(a, b),
            M::sub(a, b),
            M::mul(a, b),
            M::div(a, b),
            M::mul(a, M::splat(-1.0)),
            M::sqrt(M::abs(a)),
            M::abs(a),
            M::min(a, b),
            M::max(a, b),
            M::rough_reciprocal_sqrt(M::abs(a)),
            M::select(mask, a, b),
            M::splat(self.a[0]),
            M::load(&array(b)),
        ];
        let truths = [
            M::less(a, b),
            M::at_most(a, b),
            mask & M::less(a, b),
            mask | M::less(a, b),
            !mask,
        ];
        let quad = |start: usize| M::Quads::load(self.a[start..start + 4].first_chunk().unwrap());
        let quads = core::array::from_fn(|lane| match lane {
            0 => M::Quads::add(quad(0), quad(4)),
            1 => M::Quads::sub(quad(0), quad(4)),
            2 => M::Quads::mul(quad(0), quad(4)),
            3 => M::Quads::min(quad(0), quad(4)),
            4 => M::Quads::max(quad(0), quad(4)),
            5 => M::Quads::splat(self.b[2]),
            lane => quad(lane - 4),
        });
        let lanes = M::lanes_of(quads);
        let back = M::quads_of(lanes).map(|quad| {
            let mut values = [0.0; 4];
            M::Quads::store(quad, &mut values);
            [values, values].as_flattened().try_into().unwrap()
        });
        let mut set = [0; LANES];
        M::write_set_bits(self.mask, 5, &mut set);
        let mut chosen = [0; LANES];
        M::write_chosen(self.mask, &[9, 8, 7, 6, 5, 4, 3, 2], &mut chosen);
        let number = self.mask.count_ones() as usize;
        let pair = |lane: usize| self.a[lane % 7..].first_chunk().unwrap();
        let pairs = M::lanes_of_pairs(core::array::from_fn(pair));
        (
            numbers
                .into_iter()
                .chain(lanes)
                .map(array)
                .chain(back)
                .chain(pairs.map(array))
                .map(|numbers: [f64; LANES]| numbers.map(f64::to_bits))
                .collect(),
            truths
                .map(Truths::to_bits)
                .into_iter()
                .chain(truths.map(|truth| truth.any().into()))
                .chain(set[..number].iter().map(|&number| number as u8))
                .chain(chosen[..number].iter().map(|&number| number as u8))
                .collect(),
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
        for instructions in Instructions::here() {
            prop_assert_eq!(&on(instructions), &plain, "{:?}", instructions);
        }
        prop_assert_eq!(f64::from_bits(plain.0[0][3]), a[3] + b[3]);
        prop_assert_eq!(f64::from_bits(plain.0[10][5]), if mask >> 5 & 1 == 1 { a[5] } else { b[5] });
        prop_assert_eq!(plain.1[0] >> 2 & 1 == 1, a[2] < b[2]);
        // Lanes 6 and 7 are quads of the numbers themselves; back again they are the same.
        let lanes = &plain.0[13..17];
        for k in 0..4 {
            prop_assert_eq!(lanes[k][1], (a[k] - a[k + 4]).to_bits());
            prop_assert_eq!((lanes[k][6], lanes[k][7]), (a[k + 2].to_bits(), a[k + 3].to_bits()));
            for (lane, &number) in lanes[k].iter().enumerate() {
                prop_assert_eq!(plain.0[17 + lane][k], number);
            }
        }
        for lane in 0..LANES {
            prop_assert_eq!(plain.0[25][lane], a[lane % 7].to_bits());
            prop_assert_eq!(plain.0[26][lane], a[lane % 7 + 1].to_bits());
        }
        let set: Vec<u8> = (0..8).filter(|lane| mask >> lane & 1 == 1).map(|lane| lane + 5).collect();
        let chosen: Vec<u8> = set.iter().map(|number| 14 - number).collect();
        prop_assert_eq!(plain.1[5], u8::from(plain.1[0] != 0));
        prop_assert_eq!(&plain.1[10..], &[set, chosen].concat());
    }
}

// Panics end a program of WebAssembly.
#[cfg(not(target_family = "wasm"))]
#[test]
fn eight_items_lie_within_every_slice() {
    let (long, short): (Vec<u32>, Vec<u32>) = ((0..20).collect(), (100..110).collect());
    let within = [9, 0, 3, 3, 8, 1, 2, 7];
    let [one, other] = eight_of_each([&long[..], &short[..]], &within);
    assert_eq!(one.map(|&item| item), within);
    assert_eq!(other.map(|&item| item), within.map(|at| at + 100));
    for lane in 0..LANES {
        let mut at = within;
        at[lane] = 10;
        let looks = || eight_of_each([&long[..], &short[..]], &at).len();
        assert!(std::panic::catch_unwind(looks).is_err(), "lane {lane}");
    }
}
