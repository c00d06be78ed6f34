//! How the diameters of grains are distributed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Form of a distribution of diameters between a least and a largest one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SizeForm {
    /// All diameters between diameter_min and diameter_max are equally likely.
    #[default]
    Uniform,
    /// ln d is normal around ln diameter_median with the standard deviation diameter_spread, cut at diameter_min and
    /// diameter_max.
    Lognormal,
    /// Grains of diameter_min and of diameter_max.
    Two,
    /// The diameters of a table, each with its part of the grains.
    Table,
}

impl SizeForm {
    /// Whether it is the uniform one.
    pub fn is_uniform(&self) -> bool {
        *self == Self::Uniform
    }
}

/// A distribution of diameters, by number.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// Uniform between the least and the largest \[d\].
    Uniform([f64; 2]),
    /// Normal in ln d, cut at the least and the largest.
    Lognormal {
        /// Least and largest diameter \[d\].
        bounds: [f64; 2],
        /// Median before the cut \[d\].
        median: f64,
        /// Standard deviation of ln d before the cut.
        spread: f64,
    },
    /// Single diameters \[d\], ascending, each with the part of the grains that are smaller or as large.
    Classes(Vec<(f64, f64)>),
}

/// The normal distribution function.
fn normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x / core::f64::consts::SQRT_2)
}

impl Sizes {
    /// Single diameters with weights, which need not add up to 1; `None` where no weight is positive.
    pub fn classes(mut classes: Vec<(f64, f64)>) -> Option<Self> {
        classes.retain(|it| it.1 > 0.0);
        classes.sort_by(|one, other| one.0.total_cmp(&other.0));
        let whole: f64 = classes.iter().map(|it| it.1).sum();
        let mut below = 0.0;
        for class in &mut classes {
            below += class.1 / whole;
            class.1 = below;
        }
        // Rounding must leave no number without a class.
        classes.last_mut()?.1 = 1.0;
        Some(Self::Classes(classes))
    }

    /// The diameter below which the fraction `part` of the grains lies, 0 <= part < 1 \[d\]: of a uniform random number a random
    /// diameter.
    pub fn diameter(&self, part: f64) -> f64 {
        match self {
            Self::Uniform([least, largest]) => least + (largest - least) * part,
            Self::Lognormal {
                bounds: [least, largest],
                median,
                spread,
            } => {
                let below = |diameter: f64| normal(libm::log(diameter / median) / spread);
                let (low, high) = (below(*least), below(*largest));
                let wanted = low + (high - low) * part;
                // By bisection in ln d, to the last bits.
                let (mut from, mut to) = (libm::log(*least), libm::log(*largest));
                for _ in 0..60 {
                    let middle = 0.5 * (from + to);
                    match below(libm::exp(middle)) < wanted {
                        true => from = middle,
                        false => to = middle,
                    }
                }
                libm::exp(0.5 * (from + to)).clamp(*least, *largest)
            }
            Self::Classes(classes) => {
                let class = classes.iter().find(|class| part < class.1);
                class.or(classes.last()).map_or(f64::NAN, |class| class.0)
            }
        }
    }

    /// Mean of d^power over the grains, power 1 or more \[d^power\].
    pub fn mean(&self, power: i32) -> f64 {
        match self {
            Self::Uniform([least, largest]) if power == 1 => 0.5 * (least + largest),
            Self::Uniform([least, largest]) if power == 3 => {
                (least + largest) * (least * least + largest * largest) / 4.0
            }
            Self::Uniform([least, largest]) => {
                let terms = (0..=power).map(|k| least.powi(k) * largest.powi(power - k));
                terms.sum::<f64>() / f64::from(power + 1)
            }
            Self::Lognormal {
                bounds,
                median,
                spread,
            } => {
                // The weight d^n moves the median of a lognormal distribution by exp(n sigma^2).
                let shift = f64::from(power) * spread;
                let [low, high] = bounds.map(|bound| libm::log(bound / median) / spread);
                let part =
                    (normal(high - shift) - normal(low - shift)) / (normal(high) - normal(low));
                libm::pow(*median, f64::from(power)) * libm::exp(0.5 * shift * shift) * part
            }
            Self::Classes(classes) => {
                let mut before = 0.0;
                let part = |&(diameter, below): &(f64, f64)| {
                    let part = below - before;
                    before = below;
                    part * libm::pow(diameter, f64::from(power))
                };
                classes.iter().map(part).sum()
            }
        }
    }

    /// Fraction by number of the larger of two sizes, where it makes up the fraction `volume` by volume.
    pub fn number_of_volume([small, large]: [f64; 2], volume: f64) -> f64 {
        let number = |diameter: f64, volume: f64| volume / (diameter * diameter * diameter);
        let (large, small) = (number(large, volume), number(small, 1.0 - volume));
        large / (large + small)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lognormal() -> Sizes {
        Sizes::Lognormal {
            bounds: [0.5, 1.6],
            median: 0.9,
            spread: 0.3,
        }
    }

    fn two() -> Sizes {
        Sizes::classes(vec![(1.5, 0.25), (0.5, 0.75)]).unwrap()
    }

    /// Means of many evenly spaced parts, of each form.
    #[test]
    fn means_are_those_of_the_diameters() {
        for sizes in [Sizes::Uniform([0.5, 1.5]), lognormal(), two()] {
            let number = 20_000;
            let parts = (0..number).map(|it| (f64::from(it) + 0.5) / f64::from(number));
            let diameters: Vec<f64> = parts.map(|part| sizes.diameter(part)).collect();
            assert!(diameters.is_sorted());
            for power in [1, 3, 6] {
                let mean =
                    diameters.iter().map(|it| it.powi(power)).sum::<f64>() / f64::from(number);
                let expected = sizes.mean(power);
                assert!(
                    (mean / expected - 1.0).abs() < 1e-6,
                    "{sizes:?}: {mean} {expected}"
                );
            }
        }
    }

    #[test]
    fn diameters_stay_between_their_bounds() {
        for (sizes, [least, largest]) in [(lognormal(), [0.5, 1.6]), (two(), [0.5, 1.5])] {
            assert!((sizes.diameter(0.0) - least).abs() < 1e-9);
            let last = sizes.diameter(1.0 - f64::EPSILON);
            assert!((last - largest).abs() < 1e-6 && last <= largest);
        }
        assert_eq!(Sizes::classes(vec![(1.0, 0.0)]), None);
    }

    /// The median of a distribution that is cut far from it on both sides.
    #[test]
    fn half_the_grains_are_smaller_than_the_median() {
        let sizes = Sizes::Lognormal {
            bounds: [0.01, 81.0],
            median: 0.9,
            spread: 0.3,
        };
        assert!((sizes.diameter(0.5) - 0.9).abs() < 1e-9);
    }

    /// Two sizes of ratio 2 with half the volume each: eight small ones to a large one.
    #[test]
    fn numbers_of_volumes_by_hand() {
        assert!((Sizes::number_of_volume([0.5, 1.0], 0.5) - 1.0 / 9.0).abs() < 1e-15);
    }
}
