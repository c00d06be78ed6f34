//! Regression of a mean transition time on one covariate under censoring.

use crate::columns::mean_of;
use crate::family::{Group, GroupLikelihood};
use crate::numerics::linear::{Cholesky, least_squares};

/// Most steps of Newton's method.
const MOST_STEPS: u32 = 60;
/// Change of the log-likelihood at which it stops.
const TOLERANCE: f64 = 1e-11;

/// Groups of runs with `ln mean = a + b x`, at one shape.
///
/// The log-likelihood is concave in (a, b) for every family, so that Newton's method with halved steps finds its
/// maximum from anywhere.
pub(crate) struct Regression<'a> {
    /// Covariate less its centre.
    x: Vec<f64>,
    centre: f64,
    groups: &'a [Group],
    likelihoods: &'a [GroupLikelihood<'a>],
}

impl<'a> Regression<'a> {
    /// One covariate, group and likelihood each.
    pub(crate) fn new(
        mut x: Vec<f64>,
        groups: &'a [Group],
        likelihoods: &'a [GroupLikelihood<'a>],
    ) -> Self {
        let centre = mean_of(&x);
        for x in &mut x {
            *x -= centre;
        }
        Self {
            x,
            centre,
            groups,
            likelihoods,
        }
    }

    /// a, b and the log-likelihood at its maximum; -infinity where there is none.
    pub(crate) fn largest(&self) -> (f64, f64, f64) {
        let nowhere = (f64::NAN, f64::NAN, f64::NEG_INFINITY);
        let Some([mut a, mut b]) = self.start() else {
            return nowhere;
        };
        let mut here = self.at(a, b);
        for _ in 0..MOST_STEPS {
            let Some(factor) = Cholesky::new(&here.information) else {
                return nowhere;
            };
            let step = factor.solve(&here.slope);
            let gain = 0.5 * (step[0] * here.slope[0] + step[1] * here.slope[1]);
            let mut fraction = 1.0;
            let mut there = self.at(a + step[0], b + step[1]);
            while !is_ascent(&here, &there) && fraction > 1e-9 {
                fraction *= 0.5;
                there = self.at(a + fraction * step[0], b + fraction * step[1]);
            }
            if !there.value.is_finite() {
                return nowhere;
            }
            a += fraction * step[0];
            b += fraction * step[1];
            here = there;
            if gain < TOLERANCE {
                break;
            }
        }
        (a - b * self.centre, b, here.value)
    }

    /// Largest log-likelihood at a given b.
    pub(crate) fn at_slope(&self, b: f64) -> f64 {
        let Some([mut a, slope]) = self.start() else {
            return f64::NEG_INFINITY;
        };
        // Keep the heaviest observed group where it was, whatever the slope.
        let heaviest = (0..self.x.len()).max_by_key(|&k| self.groups[k].observed());
        let heaviest = heaviest.unwrap_or(0);
        a += (slope - b) * self.x[heaviest];
        let mut here = self.at(a, b);
        for _ in 0..MOST_STEPS {
            let mut step = (here.slope[0] / here.information[0][0]).clamp(-3.0, 3.0);
            if step.is_nan() {
                return f64::NEG_INFINITY;
            }
            let gain = 0.5 * step * here.slope[0];
            let mut there = self.at(a + step, b);
            let mut halvings = 0;
            while !is_ascent(&here, &there) && halvings < 30 {
                step *= 0.5;
                there = self.at(a + step, b);
                halvings += 1;
            }
            a += step;
            here = there;
            if gain.abs() < TOLERANCE {
                break;
            }
        }
        here.value
    }

    /// A line through the logarithms of the crude means, each weighted with its transitions.
    fn start(&self) -> Option<[f64; 2]> {
        let groups = &self.groups[..self.x.len()];
        let ln_crude = |group: &Group| {
            let mean = group.crude_mean();
            if mean > 0.0 { libm::log(mean) } else { 0.0 }
        };
        let crude: Vec<f64> = groups.iter().map(ln_crude).collect();
        let weight: Vec<f64> = groups.iter().map(|group| group.observed() as f64).collect();
        let line = least_squares(|k| [1.0, self.x[k]], &crude, &weight)?.coefficients;
        line.iter().all(|c| c.is_finite()).then_some(line)
    }

    fn at(&self, a: f64, b: f64) -> Total {
        let mut total = Total::default();
        for (&x, likelihood) in self.x.iter().zip(self.likelihoods.iter()) {
            let here = likelihood.at(a + b * x);
            total.value += here.value;
            total.slope[0] += here.slope;
            total.slope[1] += here.slope * x;
            total.information[0][0] -= here.curvature;
            total.information[0][1] -= here.curvature * x;
            total.information[1][1] -= here.curvature * x * x;
        }
        total.information[1][0] = total.information[0][1];
        total
    }
}

/// Log-likelihood of all groups with its derivatives in (a, b).
#[derive(Default)]
struct Total {
    value: f64,
    slope: [f64; 2],
    information: [[f64; 2]; 2],
}

/// Whether a step does not lead downhill; one to a value that is not a number does.
fn is_ascent(here: &Total, there: &Total) -> bool {
    there.value >= here.value - TOLERANCE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::Family;

    fn groups() -> Vec<Group> {
        vec![
            Group::new([(1.0, true), (2.0, true), (0.5, true)]),
            Group::new([(4.0, true), (9.0, true), (10.0, false)]),
            Group::new([(30.0, true), (10.0, false), (10.0, false)]),
            Group::new([(10.0, false), (10.0, false)]),
        ]
    }

    #[test]
    fn the_maximum_is_one_for_every_family() {
        for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
            let groups = groups();
            let likelihoods: Vec<_> = groups.iter().map(|g| g.at_shape(family, 1.6)).collect();
            let regression = Regression::new(vec![0.0, 1.0, 2.0, 3.0], &groups, &likelihoods);
            let (a, b, value) = regression.largest();
            let at = |a: f64, b: f64| regression.at(a + b * regression.centre, b).value;
            assert!((at(a, b) - value).abs() < 1e-9, "{family:?}");
            for (da, db) in [(0.01, 0.0), (-0.01, 0.0), (0.0, 0.01), (0.0, -0.01)] {
                assert!(at(a + da, b + db) < value);
            }
            assert!(b > 0.8 && b < 2.5, "{b}");
            assert!((regression.at_slope(b) - value).abs() < 1e-8);
            assert!(regression.at_slope(b + 0.3) < value - 0.01);
        }
    }

    #[test]
    fn two_means_are_fitted_exactly() {
        let groups = vec![
            Group::new([(1.0, true), (3.0, true)]),
            Group::new([(5.0, true), (3.0, false)]),
        ];
        let likelihoods: Vec<_> = groups
            .iter()
            .map(|g| g.at_shape(Family::Exponential, 1.0))
            .collect();
        let (a, b, _) = Regression::new(vec![-1.0, 1.0], &groups, &likelihoods).largest();
        assert!((libm::exp(a - b) - 2.0).abs() < 1e-6);
        assert!((libm::exp(a + b) - 8.0).abs() < 1e-6);
    }
}
