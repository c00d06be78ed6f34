//! The neighbour list against a search over all pairs.

use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;

use super::{Drift, Neighbours, PairRule, are_within, time_within};
use crate::fast::threads::Threads;

#[derive(Clone, Debug)]
struct Spheres {
    position: Vec<DVec3>,
    diameter: Vec<f64>,
    length: f64,
    /// Of a grain, and of a sphere of the wall.
    skins: [f64; 2],
    half_width: f64,
}

/// The first spheres are grains.
const GRAINS: usize = 4;

impl Spheres {
    fn separation(&self, i: usize, j: usize) -> DVec3 {
        let mut separation = self.position[i] - self.position[j];
        separation.z -= self.length * (separation.z / self.length).round();
        separation
    }

    /// All admitted pairs i < j nearer than (d_i + d_j)/2 and these skins.
    fn pairs(&self, skins: [f64; 2]) -> BTreeSet<(u32, u32)> {
        let number = self.position.len();
        let reach = |i: usize| 0.5 * self.diameter[i] + skins[usize::from(i >= GRAINS)];
        (0..number)
            .flat_map(|i| (i + 1..number).map(move |j| (i, j)))
            .filter(|&(i, j)| {
                let reach = reach(i) + reach(j);
                admits(i, j) && self.separation(i, j).length_squared() < reach * reach
            })
            .map(|(i, j)| (i as u32, j as u32))
            .collect()
    }

    fn rebuild(&self, list: &mut Neighbours<u64>) {
        let rule = PairRule {
            diameter: &self.diameter,
            length: self.length,
            skins: self.skins,
            half_width: self.half_width,
            grains: GRAINS,
            admits,
        };
        // The list is the same for any number of threads.
        let number = self.position.len();
        let threads = Threads::new(1 + number % 3).unwrap();
        list.carry_out();
        list.rebuild(&self.position, &vec![0; number], &rule, &threads);
        list.carry_on();
    }
}

fn admits(i: usize, j: usize) -> bool {
    i < GRAINS || i % 7 != 3 || j % 5 != 1
}

/// Spheres in a tube of 2.2 cutoffs or longer, some of them far outside.
fn spheres() -> impl Strategy<Value = Spheres> {
    (
        prop::array::uniform2(0.0..0.6),
        2.2..30.0,
        0.3..8.0,
        0_usize..120,
    )
        .prop_flat_map(
            |(skins, cutoffs, half_width, number): ([f64; 2], _, _, _)| {
                let length: f64 = cutoffs * (1.0 + 2.0 * skins[0].max(skins[1]));
                let place =
                    (-1.0..1.0, -1.0..1.0, 0.0..1.0, 0..20).prop_map(move |(x, y, z, kind)| {
                        // One in twenty has escaped; some stand at the seam.
                        let out = if kind == 0 { 50.0 } else { half_width };
                        let z: f64 = if kind == 1 { 0.0 } else { z * length };
                        DVec3::new(out * x, out * y, z.min(length * (1.0 - 1e-16)))
                    });
                (
                    proptest::collection::vec(place, number),
                    proptest::collection::vec(0.3..1.0, number),
                )
                    .prop_map(move |(position, diameter)| Spheres {
                        position,
                        diameter,
                        length,
                        skins,
                        half_width,
                    })
            },
        )
}

fn listed(list: &Neighbours<u64>) -> Vec<(u32, u32)> {
    list.iter().map(|(i, j, _)| (i, j)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_list_holds_every_pair_once_in_order(spheres in spheres()) {
        let mut list = Neighbours::empty();
        spheres.rebuild(&mut list);
        let listed = listed(&list);
        prop_assert_eq!(list.pairs(), listed.len());
        let expected: Vec<_> = spheres.pairs(spheres.skins).into_iter().collect();
        prop_assert_eq!(listed, expected);
    }

    /// Histories move with their pairs; pairs that were not listed begin without.
    #[test]
    fn histories_survive_a_rebuild(spheres in spheres(), moves in proptest::collection::vec((-0.3..0.3, -0.3..0.3), 120)) {
        let mut list = Neighbours::empty();
        spheres.rebuild(&mut list);
        let name = |i: u32, j: u32| 1 + u64::from(i) * 1_000 + u64::from(j);
        let before: BTreeSet<(u32, u32)> = listed(&list).into_iter().collect();
        for &(i, j) in &before {
            prop_assert!(list.set_history(i, j, name(i, j)));
        }
        let mut moved = spheres.clone();
        for (position, by) in moved.position.iter_mut().zip(&moves) {
            position.x += by.0;
            position.y += by.1;
        }
        moved.rebuild(&mut list);
        let listed: BTreeSet<_> = listed(&list).into_iter().collect();
        // No memory is lost, not even of spheres that are far apart now.
        prop_assert!(before.is_subset(&listed) && moved.pairs(moved.skins).is_subset(&listed));
        for (i, j, &history) in list.iter() {
            let expected = if before.contains(&(i, j)) { name(i, j) } else { 0 };
            prop_assert_eq!(history, expected);
        }
        if !moved.position.is_empty() {
            prop_assert!(!list.set_history(0, 1_000, 5), "a pair that is not listed has no history");
        }
    }

    /// While the list is not outdated it holds every pair that touches, also where the spheres drift together round
    /// the tube.
    #[test]
    fn a_list_that_holds_misses_no_contact(
        spheres in spheres(),
        moves in proptest::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0), 120),
        drift in -5.0..5.0, size in 0.0..0.6,
    ) {
        let mut list = Neighbours::empty();
        spheres.rebuild(&mut list);
        let mut moved = spheres.clone();
        let mut turns = vec![0; moved.position.len()];
        for ((position, turns), by) in moved.position.iter_mut().zip(&mut turns).zip(&moves) {
            *position += size * DVec3::new(by.0, by.1, by.2) + DVec3::new(0.0, 0.0, drift);
            let turned = (position.z / moved.length).floor();
            position.z -= turned * moved.length;
            *turns = turned as i32;
        }
        if list.holds(&moved.position, &turns, moved.length, 0.0) {
            let listed: BTreeSet<_> = listed(&list).into_iter().collect();
            prop_assert!(moved.pairs([0.0; 2]).is_subset(&listed));
        }
        // A drift alone outdates nothing.
        let mut drifted = spheres.clone();
        for position in &mut drifted.position {
            position.z += 0.01 * drift;
        }
        if !drifted.position.is_empty() && spheres.skins.iter().all(|&skin| skin > 1e-6) {
            prop_assert!(list.holds(&drifted.position, &vec![0; turns.len()], spheres.length, 0.0));
        }
    }
}

/// Steps of grains and of spheres of the wall, each kind with a drift of its own.
fn steps() -> impl Strategy<Value = [Vec<DVec3>; 2]> {
    let unit = (-1.0..1.0, -1.0..1.0, -1.0..1.0);
    let sizes = (0.0..0.5, 0.0..0.5, -0.5..0.5);
    let of_kind = (proptest::collection::vec(unit, 10), sizes);
    prop::array::uniform2(of_kind).prop_map(|kinds| {
        kinds.map(|(units, (across, along, drift))| {
            let units = units.into_iter();
            units
                .map(|(x, y, z)| DVec3::new(across * x, across * y, along * z + drift))
                .collect()
        })
    })
}

proptest! {
    /// No two spheres come closer by more than their skin, in two steps whose bounds are within the skins, or in the time that
    /// these last at the velocities of the first.
    #[test]
    fn spheres_within_their_skins_come_no_closer(
        [first, second] in prop::array::uniform2(steps()),
        skins in prop::array::uniform2(0.0..2.0),
    ) {
        let bounds = |kinds: &[Vec<DVec3>; 2]| [0, 1].map(|kind| Drift::of(kinds[kind].iter().copied()));
        let (of_first, of_second) = (bounds(&first), bounds(&second));
        let within = are_within(&[0, 1].map(|kind| of_first[kind].then(of_second[kind])), skins);
        let time = time_within(&of_first, skins);
        let number = first[0].len();
        for (a, b) in (0..2 * number).flat_map(|a| (0..2 * number).map(move |b| (a, b))) {
            let skin = skins[a / number] + skins[b / number] + 1e-12;
            let apart = |steps: &[Vec<DVec3>; 2]| {
                steps[a / number][a % number] - steps[b / number][b % number]
            };
            prop_assert!(!within || (apart(&first) + apart(&second)).length() <= skin);
            prop_assert!(time * apart(&first).length() <= skin);
        }
    }
}

#[test]
fn other_spheres_outdate_the_list() {
    let list = Neighbours::<u64>::empty();
    assert!(!list.holds(&[DVec3::ZERO], &[0], 10.0, 0.0));
}
