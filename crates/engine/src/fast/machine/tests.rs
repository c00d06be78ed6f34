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
            M::sqrt_beside_divisions(M::abs(a)),
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
        prop_assert_eq!(f64::from_bits(plain.0[11][5]), if mask >> 5 & 1 == 1 { a[5] } else { b[5] });
        prop_assert_eq!(plain.1[0] >> 2 & 1 == 1, a[2] < b[2]);
        // Lanes 6 and 7 are quads of the numbers themselves; back again they are the same.
        let lanes = &plain.0[14..18];
        for k in 0..4 {
            prop_assert_eq!(lanes[k][1], (a[k] - a[k + 4]).to_bits());
            prop_assert_eq!((lanes[k][6], lanes[k][7]), (a[k + 2].to_bits(), a[k + 3].to_bits()));
            for (lane, &number) in lanes[k].iter().enumerate() {
                prop_assert_eq!(plain.0[18 + lane][k], number);
            }
        }
        for lane in 0..LANES {
            prop_assert_eq!(plain.0[26][lane], a[lane % 7].to_bits());
            prop_assert_eq!(plain.0[27][lane], a[lane % 7 + 1].to_bits());
        }
        let set: Vec<u8> = (0..8).filter(|lane| mask >> lane & 1 == 1).map(|lane| lane + 5).collect();
        let chosen: Vec<u8> = set.iter().map(|number| 14 - number).collect();
        prop_assert_eq!(plain.1[5], u8::from(plain.1[0] != 0));
        prop_assert_eq!(&plain.1[10..], &[set, chosen].concat());
    }
}

/// Roots of eight numbers.
struct Roots([f64; LANES]);

impl Work for Roots {
    type Answer = [f64; LANES];

    #[inline(always)]
    fn run<M: Machine>(self) -> Self::Answer {
        let mut roots = [0.0; LANES];
        M::store(M::sqrt_beside_divisions(M::load(&self.0)), &mut roots);
        roots
    }
}

fn roots_are_rounded(numbers: &[f64]) {
    for instructions in Instructions::here() {
        for eight in numbers.chunks(LANES) {
            let lane = |lane: usize| eight[lane.min(eight.len() - 1)];
            let eight: [f64; LANES] = core::array::from_fn(lane);
            let roots = instructions.run(Roots(eight)).map(f64::to_bits);
            let expected = eight.map(|number| number.sqrt().to_bits());
            // The sign of what is no number is not defined.
            if !eight.iter().any(|number| number.sqrt().is_nan()) {
                assert_eq!(roots, expected, "{eight:?} {instructions:?}");
            }
        }
    }
}

#[test]
fn roots_of_numbers_far_from_one_are_rounded() {
    let far = [
        0.0,
        -0.0,
        5e-324,
        1e-310,
        1e-121,
        1e-119,
        1e119,
        1e121,
        f64::MAX,
        f64::INFINITY,
    ];
    roots_are_rounded(&far);
    for number in far {
        roots_are_rounded(&[2.0, number, 3.0, 0.5, 7.0, 1e-3, 11.0, 13.0]);
    }
    for none in [-1.0, -1e-200, f64::NEG_INFINITY, f64::NAN] {
        for instructions in Instructions::here() {
            assert!(instructions.run(Roots([4.0, none, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0]))[1].is_nan());
        }
    }
}

/// A root that is computed to 2^-104 of itself is rounded wrongly only where it is as near the middle of two neighbouring
/// numbers. Count in halves of the unit of the root's last place: the middle is an odd M of 54 bits, and the number, of 53
/// bits and then 54 or 55 zeros, is X = M^2 - d with a small d. So M is a square root of d modulo 2^54 or 2^55.
#[test]
fn roots_near_the_middle_of_two_numbers_are_rounded() {
    let mut numbers = Vec::new();
    for d in (-1023_i64..1024).step_by(8) {
        // Bit by bit: if r^2 = d modulo 2^k, then r or r + 2^(k - 1) is a root modulo 2^(k + 1).
        let mut root = 1_u64;
        for k in 3..64 {
            if (root.wrapping_mul(root) ^ d as u64) >> k & 1 == 1 {
                root = root.wrapping_add(1 << (k - 1));
            }
        }
        assert_eq!(root.wrapping_mul(root), d as u64);
        for (zeros, twos) in [(54, 1.0), (55, 2.0)] {
            let half = 1 << (zeros - 1);
            let negative = root.wrapping_neg();
            for root in [
                root,
                root.wrapping_add(half),
                negative,
                negative.wrapping_add(half),
            ] {
                let middle = root & (2 * half - 1);
                let square = u128::from(middle).pow(2).wrapping_sub(d as u128);
                let number = square >> zeros;
                if middle >> 53 == 1 && number >> 52 == 1 {
                    assert_eq!(number << zeros, square);
                    let scales = [-100, -26, 0, 75].map(|fours| 4.0_f64.powi(fours));
                    numbers.extend(scales.map(|scale| number as f64 * twos * scale));
                }
            }
        }
    }
    assert!(numbers.len() > 1000, "{}", numbers.len());
    roots_are_rounded(&numbers);
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
