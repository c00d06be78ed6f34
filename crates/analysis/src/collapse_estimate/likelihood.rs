//! The likelihood of points about one smooth curve.

use crate::collapse_fit::{Collapse, SHORT};
use crate::error::{Error, checked, checked_positive, enough, ensure};
use crate::master_curve::{INTERVALS, Scaled, Smooth};
use crate::numerics::quasi_newton::{Smallest, quasi_newton};
use crate::uncertain::Uncertain;

/// Distance, in errors, that a point counts with which the scaling sends to infinity.
const LOST: f64 = 5.0;
/// Bounds of ln of the stiffness of the common curve.
const STIFFNESSES: std::ops::RangeInclusive<f64> = -20.0..=16.0;
/// Factor of the knots of a common curve that may bend more sharply.
const FINER: usize = 3;
/// Most times that a better place is followed up.
pub(super) const MOST_ROUNDS: u32 = 8;

/// The likelihood of a scaling: of points with normal errors about one smooth curve. The parameters are those of the
/// scaling and, last, ln of the stiffness.
#[derive(Clone)]
pub(super) struct Likelihood<'a> {
    pub(super) collapse: &'a Collapse<'a>,
    pub(super) steps: &'a [f64],
    /// Parameters known from elsewhere, by their place.
    known: &'a [(usize, Uncertain)],
    /// Intervals between the knots of the common curve.
    intervals: usize,
    /// Size of the correction at every curve, 1 at the largest, where one is allowed for.
    corrections: Option<Vec<f64>>,
}

impl<'a> Likelihood<'a> {
    /// `correction`: the power of the curves' parameters in it.
    pub(super) fn new(
        collapse: &'a Collapse<'a>,
        steps: &'a [f64],
        correction: Option<f64>,
        known: &'a [(usize, Uncertain)],
    ) -> Result<Self, Error> {
        let errors: Vec<f64> = known.iter().map(|(_, known)| known.error).collect();
        checked_positive(&errors)?;
        for &(place, known) in known {
            checked(&[known.value], 1)?;
            // The last step is that of the stiffness.
            let expected = steps.len() - 1;
            ensure(
                place < expected,
                Error::LengthMismatch {
                    expected,
                    found: place + 1,
                },
            )?;
        }
        let corrections = match correction {
            None => None,
            Some(power) => {
                checked(&[power], 1)?;
                let parameters = collapse.curves.iter().map(|curve| curve.parameter);
                let parameters: Vec<f64> = parameters.collect();
                let logarithms = checked_positive(&parameters)?.iter();
                let logarithms: Vec<f64> = logarithms.map(|&p| power * libm::log(p)).collect();
                let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let sizes = logarithms.iter().map(|one| libm::exp(one - largest));
                Some(sizes.collect())
            }
        };
        let new = Self {
            collapse,
            steps,
            known,
            intervals: INTERVALS,
            corrections,
        };
        enough("points", new.points(), new.free() + steps.len() + 4)?;
        Ok(new)
    }

    /// Whether a correction is allowed for.
    pub(super) fn is_corrected(&self) -> bool {
        self.corrections.is_some()
    }

    /// The same data with a correction of another power; `None` where there are too few points for it.
    pub(super) fn allowing(&self, power: f64) -> Option<Self> {
        Self::new(self.collapse, self.steps, Some(power), self.known).ok()
    }

    /// The same data with a common curve that can bend more sharply.
    pub(super) fn refined(&self) -> Self {
        let intervals = FINER * self.intervals;
        Self {
            intervals,
            ..self.clone()
        }
    }

    /// Number of parameters of the scaling that the fit has to determine alone.
    pub(super) fn unknown(&self) -> usize {
        (self.steps.len() - 1).saturating_sub(self.known.len())
    }

    fn free(&self) -> usize {
        Smooth::free(self.is_corrected())
    }

    /// The smooth curve at some parameters and the points that the scaling sends to infinity; `None` where too few
    /// overlap.
    pub(super) fn curve(&self, parameters: &[f64]) -> Option<(Smooth, usize)> {
        let (&ln_stiffness, parameters) = parameters.split_last()?;
        if !STIFFNESSES.contains(&ln_stiffness) {
            return None;
        }
        let scaled = self.collapse.scaled(parameters);
        if !self.collapse.overlaps(&scaled) {
            return None;
        }
        let mut usable = Vec::with_capacity(self.points());
        for (index, points) in scaled.iter().enumerate() {
            let corrections = self.corrections.as_ref();
            let correction = corrections.map_or(0.0, |sizes| sizes[index]);
            let of_curve = points.iter().filter(|point| point.is_usable());
            usable.extend(of_curve.map(|&point| Scaled { correction, point }));
        }
        let curve = Smooth::of(&usable, self.intervals, ln_stiffness, self.is_corrected())?;
        Some((curve, self.points() - usable.len()))
    }

    pub(super) fn points(&self) -> usize {
        self.collapse
            .curves
            .iter()
            .map(|curve| curve.points.len())
            .sum()
    }

    /// Points less the coefficients of the curve that smoothness leaves free.
    fn degrees_of_freedom(&self) -> f64 {
        (self.points() - self.free()) as f64
    }

    /// Squares of the distances over their degrees of freedom.
    pub(super) fn variance(&self, curve: &Smooth, lost: usize) -> f64 {
        (curve.squares + LOST * LOST * lost as f64) / self.degrees_of_freedom()
    }

    /// -2 ln likelihood, with errors stretched by the best factor of 1 or more, and with the estimates of parameters that
    /// were given; infinite where too few points overlap.
    pub(super) fn value(&self, parameters: &[f64]) -> f64 {
        let Some((curve, lost)) = self.curve(parameters) else {
            return f64::INFINITY;
        };
        let variance = self.variance(&curve, lost);
        let misfit = match variance > 1.0 {
            true => 1.0 + libm::log(variance),
            false => variance,
        };
        let deviation = |&(place, known): &(usize, Uncertain)| {
            let deviations = known.deviations_from(parameters[place]);
            deviations * deviations
        };
        let known: f64 = self.known.iter().map(deviation).sum();
        self.degrees_of_freedom() * misfit + curve.ln_volume + known
    }

    /// The same for a coarse search, that finds its way back to where enough points overlap.
    pub(super) fn value_or_wall(&self, parameters: &[f64]) -> f64 {
        let value = self.value(parameters);
        match value.is_finite() {
            true => value,
            false => self
                .collapse
                .objective(&parameters[..parameters.len() - 1])
                .max(SHORT),
        }
    }

    pub(super) fn settle(&self, start: &[f64]) -> Option<Smallest> {
        polished(|parameters| self.value(parameters), start, self.steps)
    }

    /// The smallest value with one parameter held, from the others' values and a guess of the inverse of their second
    /// derivatives; one above `level` is not believed before a fresh search.
    pub(super) fn settle_beside(
        &self,
        (axis, held): (usize, f64),
        rest: &[f64],
        inverse: &[Vec<f64>],
        level: f64,
    ) -> Option<Smallest> {
        let mut steps = self.steps.to_vec();
        steps.remove(axis);
        let all = |rest: &[f64]| {
            let mut parameters = rest.to_vec();
            parameters.insert(axis, held);
            self.value(&parameters)
        };
        let found = quasi_newton(all, rest, &steps, Some(inverse))?;
        match found.value < level {
            true => Some(found),
            false => polished(all, &found.place, &steps),
        }
    }

    /// The smallest value with some parameters held, from all of them.
    pub(super) fn settle_holding(&self, held: &[(usize, f64)], start: &[f64]) -> Option<Smallest> {
        let is_held = |place: usize| held.iter().any(|&(one, _)| one == place);
        let free = (0..start.len()).filter(|&place| !is_held(place));
        let free: Vec<usize> = free.collect();
        let of = |all: &[f64]| -> Vec<f64> { free.iter().map(|&place| all[place]).collect() };
        let value = |rest: &[f64]| {
            let mut parameters = start.to_vec();
            for (&place, &value) in free.iter().zip(rest) {
                parameters[place] = value;
            }
            for &(place, value) in held {
                parameters[place] = value;
            }
            self.value(&parameters)
        };
        polished(value, &of(start), &of(self.steps))
    }
}

/// A minimum to which searches from beside it, along each variable, lead back, with the curvature that they have seen.
fn polished(function: impl Fn(&[f64]) -> f64, start: &[f64], steps: &[f64]) -> Option<Smallest> {
    let mut best = quasi_newton(&function, start, steps, None)?;
    for _ in 0..MOST_ROUNDS {
        let before = best.value;
        for axis in 0..steps.len() {
            // In steps of the errors the variables are alike.
            let error = |(own, step): (usize, &f64)| {
                let error = (2.0 * best.inverse[own][own]).max(0.0).sqrt();
                error.clamp(1e-3 * step, *step)
            };
            let errors: Vec<f64> = steps.iter().enumerate().map(error).collect();
            let mut beside = best.place.clone();
            beside[axis] += 0.5 * errors[axis];
            let again = quasi_newton(&function, &beside, &errors, Some(&best.inverse));
            best = match again {
                Some(again) if again.value <= best.value => again,
                Some(again) if again.value <= best.value + 1e-3 => Smallest {
                    inverse: again.inverse,
                    ..best
                },
                _ => best,
            };
        }
        if best.value > before - 1e-3 {
            break;
        }
    }
    Some(best)
}
