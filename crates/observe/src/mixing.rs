//! Mixing: how far grains of two kinds, told apart by where they began, are from lying at random.

use peristalsis_engine::Simulation;
use serde::{Deserialize, Serialize};

use crate::view::View;

/// Cells that the grains are counted in, at most; an even number, so that both kinds fill whole cells at the start.
const CELLS: usize = 10;
/// Grains in a cell, at least.
const IN_A_CELL: usize = 10;

/// Lacey's index of mixing of two kinds of grains, by cells along the tube and by cells from its axis outward.
///
/// M = (s_0^2 - s^2)/(s_0^2 - s_r^2), after Lacey, J. Appl. Chem. 4, 257 (1954). s^2 is the variance over the cells of the
/// part p_c of one kind, about p, its part of all. It is s_0^2 = p (1 - p) where the kinds lie apart, so that M = 0, and
/// on average s_r^2 = s_0^2 (C - 1)/(N - 1) for N grains thrown into C cells at random. Over
/// random arrangements its mean is 1 and its standard deviation (2 (C - 1))^(1/2)/(N - C).
///
/// The cells hold equal numbers of grains, N/C, in the order of a coordinate: 10 cells, fewer where they would hold less than 10
/// grains. M needs 20 grains and a periodic tube: in an open one grains come and go. M depends on the cells: more
/// of them see unmixed patches that are smaller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mixing {
    /// M of the grains that began in front of the middle of the tube and behind it. The cells lie along the tube and move with
    /// the mean of the grains: grains that all move alike do not mix.
    pub axial: f64,
    /// M of the grains that began nearer to the axis and nearer to the wall. The cells are shells from the axis outward, by the
    /// radial place r/(R - (d_w + d)/2) of a grain: R the radius of the tube at its z, d_w the diameter of the wall's spheres.
    pub radial: f64,
}

/// Two kinds of grains, by where they began: of each grain whether it is of the second kind. None in an open tube.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Kinds {
    /// The half farther along the tube.
    behind: Vec<bool>,
    /// The half farther from the axis.
    outer: Vec<bool>,
}

impl Kinds {
    /// As the grains lie now.
    pub(crate) fn new(simulation: &Simulation) -> Self {
        if simulation.ends().is_some() {
            return Self::default();
        }
        let grains: Vec<usize> = (0..simulation.bodies().grains).collect();
        let view = View::of(simulation);
        let second_half = |place: &dyn Fn(usize) -> f64| {
            let mut is_second = vec![false; grains.len()];
            for &grain in &in_order(&grains, place)[grains.len() / 2..] {
                is_second[grain] = true;
            }
            is_second
        };
        Self {
            behind: second_half(&|grain| simulation.bodies().position[grain].z),
            outer: second_half(&|grain| view.radial_place(grain)),
        }
    }

    /// Whether they can be those of so many grains.
    pub(crate) fn fits(&self, grains: usize) -> bool {
        let number = self.behind.len();
        (number == grains || number == 0) && self.outer.len() == number
    }
}

impl Mixing {
    /// How the grains inside the tube are mixed now; `start` and `unfolded` are the z at which they began and, of the
    /// unfolded tube, where they are \[d\].
    pub(crate) fn of(
        kinds: &Kinds,
        start: &[f64],
        unfolded: &[f64],
        view: &View<'_>,
    ) -> Option<Self> {
        if kinds.behind.is_empty() {
            return None;
        }
        let mut inside: Vec<usize> = (0..view.inside.len()).collect();
        inside.retain(|&grain| view.inside[grain]);
        let moved = |&grain: &usize| unfolded[grain] - start[grain];
        let mean = inside.iter().map(moved).sum::<f64>() / inside.len() as f64;
        let length = view.simulation.length();
        let along = |grain: usize| (unfolded[grain] - mean).rem_euclid(length);
        let radial = |grain: usize| view.radial_place(grain);
        Some(Self {
            axial: index(&in_order(&inside, &along), &kinds.behind)?,
            radial: index(&in_order(&inside, &radial), &kinds.outer)?,
        })
    }
}

/// Grains in the order of a coordinate, of equal ones in their own.
fn in_order(grains: &[usize], place: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let placed = grains.iter().map(|&grain| (place(grain), grain));
    let mut placed: Vec<(f64, usize)> = placed.collect();
    placed.sort_by(|one, other| one.0.total_cmp(&other.0));
    placed.into_iter().map(|(_, grain)| grain).collect()
}

/// M of grains that stand in the order of the cells; `is_second` says which kind a grain is of. None of less than 20, nor of one
/// kind alone.
fn index(grains: &[usize], is_second: &[bool]) -> Option<f64> {
    let number = grains.len();
    let cells = (number / IN_A_CELL).min(CELLS) / 2 * 2;
    if cells == 0 {
        return None;
    }
    let part = |grains: &[usize]| {
        let second = grains.iter().filter(|&&grain| is_second[grain]).count();
        second as f64 / grains.len() as f64
    };
    let whole = part(grains);
    let apart = whole * (1.0 - whole);
    if apart == 0.0 {
        return None;
    }
    let squares = (0..cells).map(|cell| {
        let in_cell = &grains[cell * number / cells..(cell + 1) * number / cells];
        let off = part(in_cell) - whole;
        in_cell.len() as f64 * off * off
    });
    let variance = squares.sum::<f64>() / number as f64;
    let (number, cells) = (number as f64, cells as f64);
    Some((1.0 - variance / apart) * (number - 1.0) / (number - cells))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what is missing fails the test")]
mod tests {
    use super::*;

    #[test]
    fn kinds_that_lie_apart_have_the_index_zero() {
        for number in [20, 21, 47, 100, 203, 1001] {
            let grains: Vec<usize> = (0..number).collect();
            let is_second: Vec<bool> = grains.iter().map(|&grain| grain >= number / 2).collect();
            assert!(
                index(&grains, &is_second).unwrap().abs() < 1e-12,
                "{number}"
            );
        }
        assert_eq!(index(&[0, 1, 2], &[true, false, true]), None);
        // Of one kind alone the others have left the tube.
        assert_eq!(index(&Vec::from_iter(0..40), &[true; 40]), None);
    }

    /// Kinds that alternate: every cell of 10 holds 5 of each, s^2 = 0, and M = (N - 1)/(N - C), above 1 as what is laid out
    /// is better mixed than what is thrown. By hand for a quarter that is apart: the variance of 1/2, 1/2, 0, 1.
    #[test]
    fn the_index_by_hand() {
        let grains: Vec<usize> = (0..100).collect();
        let alternate: Vec<bool> = grains.iter().map(|grain| grain % 2 == 1).collect();
        assert!((index(&grains, &alternate).unwrap() - 99.0 / 90.0).abs() < 1e-12);
        // 40 grains in 4 cells.
        let kind = |grain: usize| match grain / 10 {
            0 | 1 => grain % 2 == 1,
            cell => cell == 3,
        };
        let kinds: Vec<bool> = (0..40).map(kind).collect();
        // p = 1/2, s^2 = (0 + 0 + 1/4 + 1/4)/4 = 1/8, s_0^2 = 1/4.
        let expected = 0.5 * 39.0 / 36.0;
        assert!((index(&grains[..40], &kinds).unwrap() - expected).abs() < 1e-12);
    }

    /// The mean over arrangements drawn at random is 1, and their spread (2 (C - 1))^(1/2)/(N - C), for unequal kinds too.
    #[test]
    fn grains_at_random_have_the_index_one() {
        for (number, second) in [(203_usize, 101), (60, 20), (1000, 500)] {
            let cells = (number / IN_A_CELL).min(CELLS) / 2 * 2;
            let is_second: Vec<bool> = (0..number).map(|grain| grain < second).collect();
            let mut state = 7_u64;
            let mut below = |limit: usize| {
                // Knuth's congruential generator; its upper bits are good enough to shuffle.
                state = state.wrapping_mul(6_364_136_223_846_793_005);
                state = state.wrapping_add(1_442_695_040_888_963_407);
                (state >> 33) as usize % limit
            };
            let mut grains: Vec<usize> = (0..number).collect();
            let (mut sum, mut squares) = (0.0, 0.0);
            const DRAWS: usize = 4000;
            for _ in 0..DRAWS {
                for last in (1..number).rev() {
                    grains.swap(last, below(last + 1));
                }
                let found = index(&grains, &is_second).unwrap() - 1.0;
                sum += found;
                squares += found * found;
            }
            let draws = DRAWS as f64;
            let spread = (squares / draws).sqrt();
            let expected = (2.0 * (cells as f64 - 1.0)).sqrt() / (number - cells) as f64;
            let error = spread / draws.sqrt();
            assert!(
                (sum / draws).abs() < 4.0 * error,
                "{number}: {}",
                sum / draws
            );
            assert!((spread / expected - 1.0).abs() < 0.06, "{number}: {spread}");
        }
    }
}
