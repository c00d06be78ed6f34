//! Likelihood of the runs at all widths under a law of their mean transition time.

use crate::columns::by_width;
use crate::error::{Error, checked, checked_positive, enough_places, ensure, same_length};
use crate::family::{Family, Group, GroupLikelihood, LN_SHAPE_BOUNDS};
use crate::law::{CriticalRange, Law};
use crate::lifetime::positive_times;
use crate::numerics::minimum::{Minimum, minimise, minimise_from_grid};
use crate::regression::Regression;
use crate::transition::Transition;
use crate::uncertain::{Interval, NARROW, Uncertain, WIDE};

/// Tolerance of the maximum in ln(w_c - w).
const TOLERANCE: f64 = 1e-5;

/// Runs of all widths, grouped by width in increasing order.
pub(crate) struct RunTable {
    pub(crate) places: Vec<f64>,
    pub(crate) runs: Vec<Vec<(f64, bool)>>,
}

impl RunTable {
    /// Columns of one row per run, in any order.
    pub(crate) fn new(width: &[f64], transitions: &[Transition]) -> Result<Self, Error> {
        same_length(width.len(), transitions.len())?;
        checked(width, 0)?;
        let (places, runs) = by_width(width, &positive_times(transitions)?);
        Ok(Self { places, runs })
    }
}

/// The likelihood of one law and family, as a function of w_c and shape.
pub(crate) struct LawLikelihood {
    pub(crate) law: Law,
    family: Family,
    pub(crate) places: Vec<f64>,
    pub(crate) groups: Vec<Group>,
    pub(crate) range: CriticalRange,
    /// Runs, those that say nothing included.
    pub(crate) runs: usize,
}

/// Largest likelihood of a law and family.
#[derive(Clone, Copy)]
pub(crate) struct Largest {
    pub(crate) ln_distance: f64,
    pub(crate) ln_shape: f64,
    pub(crate) ln_amplitude: f64,
    pub(crate) exponent: f64,
    pub(crate) log_likelihood: f64,
    /// Whether w_c has run away to infinity.
    pub(crate) is_beyond: bool,
}

impl LawLikelihood {
    /// Checks that transitions were seen at as many widths as the law has parameters.
    pub(crate) fn new(
        law: Law,
        family: Family,
        places: &[f64],
        runs: &[Vec<(f64, bool)>],
    ) -> Result<Self, Error> {
        if let Law::Barrier { power } = law {
            checked_positive(&[power])?;
        }
        let group = |runs: &Vec<(f64, bool)>| Group::new(runs.iter().copied());
        let groups: Vec<Group> = runs.iter().map(group).collect();
        let with_transition =
            |(&place, group): (&f64, &Group)| (group.observed() > 0).then_some(place);
        let seen: Vec<f64> = places
            .iter()
            .zip(&groups)
            .filter_map(with_transition)
            .collect();
        enough_places(seen.len(), law.parameters())?;
        let observed = groups.iter().map(Group::observed).sum();
        let has_shape = family == Family::Exponential || groups.iter().any(Group::scatters);
        ensure(has_shape, Error::NoScatter { observed })?;
        let top = seen[seen.len() - 1];
        Ok(Self {
            law,
            family,
            places: places.to_vec(),
            groups,
            range: CriticalRange::new(&seen, top),
            runs: runs.iter().map(Vec::len).sum(),
        })
    }

    /// Likelihoods of all widths at one shape.
    fn at_shape(&self, ln_shape: f64) -> Vec<GroupLikelihood<'_>> {
        let shape = libm::exp(ln_shape);
        let at_shape = |group| Group::at_shape(group, self.family, shape);
        self.groups.iter().map(at_shape).collect()
    }

    /// Widths below a w_c: runs beyond never change, are certain to be censored and say nothing.
    pub(crate) fn below(&self, critical: f64) -> usize {
        match self.law.is_critical() {
            true => self.places.partition_point(|&place| place < critical),
            false => self.places.len(),
        }
    }

    /// Regression of the mean on the law at a w_c.
    pub(crate) fn regression<'a>(
        &'a self,
        likelihoods: &'a [GroupLikelihood<'a>],
        ln_distance: f64,
    ) -> Regression<'a> {
        let critical = self.range.critical(ln_distance);
        let below = self.below(critical);
        let covariate = |&place: &f64| self.law.covariate(place, critical);
        let x = self.places[..below].iter().map(covariate).collect();
        Regression::new(x, &self.groups[..below], &likelihoods[..below])
    }

    /// Difference of the largest and the least covariate of the law, of the widths below the best w_c.
    fn covariates_apart(&self, best: &Largest) -> f64 {
        let critical = self.range.critical(best.ln_distance);
        let below = &self.places[..self.below(critical)];
        let covariates = below.iter().map(|&it| self.law.covariate(it, critical));
        let (least, largest) = covariates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        largest - least
    }

    /// Best w_c at one shape; `value` is minus the log-likelihood.
    fn best_distance(&self, ln_shape: f64) -> Option<Minimum> {
        let likelihoods = self.at_shape(ln_shape);
        let value = |place: f64| -self.regression(&likelihoods, place).largest().2;
        if self.law.is_critical() {
            minimise_from_grid(value, &self.range.grid(), TOLERANCE)
        } else {
            let value = value(0.0);
            value.is_finite().then_some(Minimum { place: 0.0, value })
        }
    }

    /// Smallest value of a function of ln k over the shapes that the family has.
    fn over_shapes(&self, bounds: (f64, f64), mut value: impl FnMut(f64) -> f64) -> Minimum {
        if self.family == Family::Exponential {
            let (place, value) = (0.0, value(0.0));
            return Minimum { place, value };
        }
        minimise(value, bounds, 1e-4)
    }

    /// Transitions seen.
    pub(crate) fn observed(&self) -> usize {
        self.groups.iter().map(Group::observed).sum()
    }

    /// The error where the likelihood has no maximum within the allowed range.
    pub(crate) fn undetermined(&self) -> Error {
        Error::undetermined(self.runs, self.law.parameters_with(self.family))
    }

    /// The largest likelihood.
    ///
    /// # Errors
    /// [`Error::Undetermined`] where it has no maximum.
    pub(crate) fn largest(&self) -> Result<Largest, Error> {
        let best = self.over_shapes(LN_SHAPE_BOUNDS, |ln_shape| {
            self.best_distance(ln_shape)
                .map_or(f64::INFINITY, |best| best.value)
        });
        let ln_shape = best.place;
        let best = self.best_distance(ln_shape);
        let ln_distance = best.ok_or_else(|| self.undetermined())?.place;
        let (ln_amplitude, exponent, log_likelihood) = self
            .regression(&self.at_shape(ln_shape), ln_distance)
            .largest();
        let shape_is_inside =
            ln_shape > LN_SHAPE_BOUNDS.0 + 0.01 && ln_shape < LN_SHAPE_BOUNDS.1 - 0.01;
        let is_found = log_likelihood.is_finite() && exponent.is_finite() && shape_is_inside;
        ensure(is_found, self.undetermined())?;
        Ok(Largest {
            ln_distance,
            ln_shape,
            ln_amplitude,
            exponent,
            log_likelihood,
            is_beyond: self.law.is_critical() && self.range.is_beyond(ln_distance),
        })
    }

    /// Best w_c; infinite where it has run away.
    pub(crate) fn critical_width(&self, best: &Largest) -> f64 {
        if best.is_beyond {
            f64::INFINITY
        } else {
            self.range.critical(best.ln_distance)
        }
    }

    /// Parameters with the intervals where their profile likelihood stays within 1/2 and 1.92 of the largest.
    pub(crate) fn profiles(
        &self,
        best: &Largest,
    ) -> (Option<Uncertain>, Uncertain, Option<Uncertain>) {
        let first_step = 1.0 / (self.observed() as f64).sqrt();
        let bounds = (
            (best.ln_shape - 10.0 * first_step).max(LN_SHAPE_BOUNDS.0),
            (best.ln_shape + 10.0 * first_step).min(LN_SHAPE_BOUNDS.1),
        );
        let excess = |deficit: f64, deviations: f64| {
            deficit + best.log_likelihood - 0.5 * deviations * deviations
        };
        let critical = self.law.is_critical().then(|| {
            let intervals = [NARROW, WIDE].map(|deviations| {
                let outside = |place: f64| {
                    let value = |k| -self.regression(&self.at_shape(k), place).largest().2;
                    excess(self.over_shapes(bounds, value).value, deviations)
                };
                let step = deviations * first_step;
                self.range.interval(best.ln_distance, outside, step)
            });
            Uncertain::between(self.range.critical(best.ln_distance), intervals)
        });
        let grid = self.range.grid();
        let at_exponent = |exponent: f64| {
            let least = self.over_shapes(bounds, |ln_shape| {
                let likelihoods = self.at_shape(ln_shape);
                let value = |place: f64| -self.regression(&likelihoods, place).at_slope(exponent);
                if self.law.is_critical() {
                    minimise_from_grid(value, &grid, 1e-4).map_or(f64::INFINITY, |m| m.value)
                } else {
                    value(0.0)
                }
            });
            least.value
        };
        // An exponent near 0 may have any sign: by its size, or by what tells the widths apart under the law.
        let apart = self.covariates_apart(best);
        let step = first_step * best.exponent.abs().max(1e-3 / apart);
        let limits = [best.exponent - 1e3 * step, best.exponent + 1e3 * step];
        let intervals = [NARROW, WIDE].map(|deviations| {
            let outside = |exponent: f64| excess(at_exponent(exponent), deviations);
            let step = deviations * step;
            Interval::around(best.exponent, outside, step, limits, Interval::OPEN)
        });
        let exponent = Uncertain::between(best.exponent, intervals);
        let shape = (self.family != Family::Exponential).then(|| {
            let limits = LN_SHAPE_BOUNDS.into();
            let intervals = [NARROW, WIDE].map(|deviations| {
                let outside = |ln_shape: f64| {
                    let best = self.best_distance(ln_shape);
                    excess(best.map_or(f64::INFINITY, |best| best.value), deviations)
                };
                let step = deviations * first_step;
                Interval::around(best.ln_shape, outside, step, limits, Interval::OPEN)
                    .map(libm::exp)
            });
            Uncertain::between(libm::exp(best.ln_shape), intervals)
        });
        (critical, exponent, shape)
    }
}
