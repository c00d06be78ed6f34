//! The likelihood of points about one smooth curve.

use crate::collapse_fit::{Collapse, SHORT};
use crate::error::{Error, checked_positive, enough};
use crate::master_curve::{Scaled, Smooth};
use crate::numerics::quasi_newton::{Smallest, quasi_newton};

/// Distance, in errors, that a point counts with which the scaling sends to infinity.
const LOST: f64 = 5.0;
/// Bounds of ln of the stiffness of the common curve.
const STIFFNESSES: std::ops::RangeInclusive<f64> = -20.0..=16.0;
/// Most times that a better place is followed up.
pub(super) const MOST_ROUNDS: u32 = 8;

/// The likelihood of a scaling: of points with normal errors about one smooth curve. The parameters are those of the
/// scaling and, last, ln of the stiffness.
#[derive(Clone, Copy)]
pub(super) struct Likelihood<'a> {
    pub(super) collapse: &'a Collapse<'a>,
    pub(super) steps: &'a [f64],
    pub(super) correction: Option<f64>,
}

impl<'a> Likelihood<'a> {
    pub(super) fn new(
        collapse: &'a Collapse<'a>,
        steps: &'a [f64],
        correction: Option<f64>,
    ) -> Result<Self, Error> {
        if correction.is_some() {
            let parameters = collapse.curves.iter().map(|curve| curve.parameter);
            checked_positive(&parameters.collect::<Vec<_>>())?;
        }
        let new = Self {
            collapse,
            steps,
            correction,
        };
        enough(new.points(), Smooth::free(correction) + steps.len() + 4)?;
        Ok(new)
    }

    /// The smooth curve at some parameters and the points that the scaling sends to infinity; `None` where too few
    /// overlap.
    pub(super) fn curve(&self, parameters: &[f64]) -> Option<(Smooth, usize)> {
        let (&ln_stiffness, parameters) = parameters.split_last()?;
        if self.collapse.objective(parameters) >= SHORT || !STIFFNESSES.contains(&ln_stiffness) {
            return None;
        }
        let curves = self.collapse.curves.iter();
        let curves = curves.zip(self.collapse.scaled(parameters));
        let points = curves.flat_map(|(curve, points)| {
            let parameter = curve.parameter;
            let of_curve = move |point| Scaled { parameter, point };
            points.into_iter().map(of_curve)
        });
        let (usable, lost): (Vec<Scaled>, Vec<Scaled>) =
            points.partition(|scaled| scaled.point.is_usable());
        let curve = Smooth::of(&usable, ln_stiffness, self.correction)?;
        Some((curve, lost.len()))
    }

    pub(super) fn points(&self) -> usize {
        self.collapse
            .curves
            .iter()
            .map(|curve| curve.points.len())
            .sum()
    }

    /// Points less the coefficients of the curve that smoothness leaves free.
    pub(super) fn degrees_of_freedom(&self) -> f64 {
        (self.points() - Smooth::free(self.correction)) as f64
    }

    /// Squares of the distances over their degrees of freedom.
    pub(super) fn variance(&self, curve: &Smooth, lost: usize) -> f64 {
        (curve.squares + LOST * LOST * lost as f64) / self.degrees_of_freedom()
    }

    /// -2 ln likelihood, with errors stretched by the best factor of 1 or more; infinite where too few points overlap.
    pub(super) fn value(&self, parameters: &[f64]) -> f64 {
        let Some((curve, lost)) = self.curve(parameters) else {
            return f64::INFINITY;
        };
        let variance = self.variance(&curve, lost);
        let misfit = match variance > 1.0 {
            true => 1.0 + libm::log(variance),
            false => variance,
        };
        self.degrees_of_freedom() * misfit + curve.ln_volume
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

    /// The smallest value with one parameter held, from the others' values.
    pub(super) fn settle_beside(&self, axis: usize, held: f64, rest: &[f64]) -> Option<Smallest> {
        let mut steps = self.steps.to_vec();
        steps.remove(axis);
        let all = |rest: &[f64]| {
            let mut parameters = rest.to_vec();
            parameters.insert(axis, held);
            self.value(&parameters)
        };
        polished(all, rest, &steps)
    }
}

/// A minimum from which a fresh search leads no further.
pub(super) fn polished(
    function: impl Fn(&[f64]) -> f64,
    start: &[f64],
    steps: &[f64],
) -> Option<Smallest> {
    let mut best = quasi_newton(&function, start, steps)?;
    for _ in 0..MOST_ROUNDS {
        let again = quasi_newton(&function, &best.place, steps)?;
        let gain = best.value - again.value;
        best = again;
        if gain < 1e-3 {
            break;
        }
    }
    Some(best)
}
