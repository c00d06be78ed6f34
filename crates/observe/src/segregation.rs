//! Segregation: where grains of several sizes gather.

use serde::{Deserialize, Serialize};

use crate::view::View;

/// Greatest place that counts: one grain in a closing throat, which has hardly any room, must not outweigh all others.
const FARTHEST: f64 = 2.0;

/// Correlations of the grains' diameters with where they are: from -1 to 1, 0 without order, with a spread of
/// (N - 1)^(-1/2) where N grains lie at random.
///
/// r = sum (d - d_m) (x - x_m)/(sum (d - d_m)^2 sum (x - x_m)^2)^(1/2), d_m and x_m the means. There is none of fewer than three
/// grains, and where all diameters or all places are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Segregation {
    /// With the radial place r/(R - (d_w + d)/2), the distance from the axis over the largest that a grain of its size can have
    /// beside a smooth wall: positive where large grains are outside. Beyond 2 a place counts as 2.
    pub radial: Option<f64>,
    /// With the height over the axis, against gravity's part across it, by the same length: positive where large grains are
    /// on top. None without such a part.
    pub height: Option<f64>,
    /// With the radius R of the tube at their z: positive where large grains are in the bellies of the wave.
    pub belly: Option<f64>,
}

impl Segregation {
    /// How the grains inside the tube are segregated now.
    pub(crate) fn of(view: &View<'_>) -> Self {
        let bodies = view.simulation.bodies();
        let diameters = &bodies.diameter[..bodies.grains];
        if diameters.windows(2).all(|pair| pair[0] == pair[1]) {
            return Self::default();
        }
        let gravity = view.simulation.parameters().body_force;
        let across = gravity.x.hypot(gravity.y);
        let with = |place: &dyn Fn(usize) -> f64| {
            let inside = (0..bodies.grains).filter(|&grain| view.inside[grain]);
            correlation(inside.map(|grain| (diameters[grain], place(grain))))
        };
        let height = |grain: usize| {
            let place = bodies.position[grain];
            let up = -(place.x * gravity.x + place.y * gravity.y) / across;
            view.over_room(up, grain).clamp(-FARTHEST, FARTHEST)
        };
        Self {
            radial: with(&|grain| view.radial_place(grain).min(FARTHEST)),
            height: (across > 0.0).then(|| with(&height)).flatten(),
            belly: with(&|grain| view.shape.radius(bodies.position[grain].z)),
        }
    }
}

/// Fewest pairs whose correlation says something: that of two is always 1 or -1.
const FEWEST: f64 = 3.0;

/// Coefficient of correlation of pairs, from -1 to 1; `None` of too few, and where one of the two is the same in all.
fn correlation(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let number = pairs.clone().count() as f64;
    let (x, y) = pairs
        .clone()
        .fold((0.0, 0.0), |(x, y), pair| (x + pair.0, y + pair.1));
    let (x, y) = (x / number, y / number);
    let (mut of_x, mut of_y, mut of_both) = (0.0, 0.0, 0.0);
    for pair in pairs {
        let (x, y) = (pair.0 - x, pair.1 - y);
        of_x += x * x;
        of_y += y * y;
        of_both += x * y;
    }
    // Rounding leaves a trace of what is the same in all.
    let is_same = |squares: f64, mean: f64| squares <= 1e-24 * number * mean * mean;
    let differ = number >= FEWEST && !is_same(of_x, x) && !is_same(of_y, y);
    // Rounding may lead beyond.
    differ.then(|| (of_both / (of_x * of_y).sqrt()).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_correlation_by_hand() {
        let of = |pairs: &[(f64, f64)]| correlation(pairs.iter().copied()).unwrap_or(f64::NAN);
        assert!((of(&[(1.0, 0.2), (2.0, 0.4), (3.0, 0.6)]) - 1.0).abs() < 1e-12);
        assert!((of(&[(1.0, 0.6), (2.0, 0.4), (3.0, 0.2)]) + 1.0).abs() < 1e-12);
        // Two sizes with the parts p and places 1 and 0, one of four misplaced: 0.25/(0.25 * 0.1875)^(1/2) of the mean 1/8.
        let found = of(&[(1.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0)]);
        assert!((found - 1.0 / 3.0_f64.sqrt()).abs() < 1e-12, "{found}");
        assert!(of(&[(1.0, 0.1), (2.0, 0.1), (3.0, 0.1)]).is_nan());
        assert!(of(&[]).is_nan() && of(&[(1.0, 0.1), (2.0, 0.2)]).is_nan());
    }

    #[test]
    fn rounding_leads_no_correlation_beyond_one() {
        for number in 3..200_u32 {
            let line = (0..number).map(|it| {
                let x = 1.0 + 0.1 * f64::from(it);
                (x, 0.3 * x)
            });
            let found = correlation(line).unwrap();
            assert!((1.0 - 1e-12..=1.0).contains(&found), "{number}: {found}");
        }
    }
}
