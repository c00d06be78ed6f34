//! The scaling under which curves collapse best, with errors.

use crate::bootstrap::{Bootstrap, Randomness, Resampled, summarise};
use crate::collapse::{CollapseQuality, Curve, CurvePoint, collapse_quality, overlap};
use crate::error::{Error, checked, checked_positive, enough, ensure, same_length};
use crate::numerics::simplex::{Lowest, nelder_mead};
use serde::{Deserialize, Serialize};

/// Value of the objective where the overlap falls short; it grows with the missing overlap, so that a search finds its way
/// back.
pub(crate) const SHORT: f64 = 1e6;
/// Tolerance of the search, relative to its first steps.
const TOLERANCE: f64 = 1e-3;
/// Most fresh beginnings of a search, the number without gain that ends it, and what counts as gain.
const MOST_ROUNDS: u32 = 12;
const IDLE_ROUNDS: u32 = 3;
const GAIN: f64 = 1e-3;
/// Most evaluations of one search, for each parameter.
const EVALUATIONS: usize = 300;

/// A scaling: parameters, place of the curve among all, its own value, and a point, to the scaled point.
pub type Transform<'a> = dyn Fn(&[f64], usize, f64, CurvePoint) -> CurvePoint + 'a;

/// Curves with a scaling to try on them.
///
/// `transform(parameters, curve, parameter, point)` gives the scaled point; `curve` is the curve's place among all,
/// `parameter` its own value. [`Scaling::apply`](crate::Scaling::apply) provides the common ones, any function will do.
///
/// ```
/// use peristalsis_analysis::{Collapse, Curve, CurvePoint};
/// // y = p x: curves of p = 1 and 2 collapse as y/p^a with a = 1.
/// let curve = |p: f64| Curve {
///     parameter: p,
///     points: (0..9).map(|k| CurvePoint { x: f64::from(k), y: p * f64::from(k), error: 0.1 }).collect(),
/// };
/// let curves = [curve(1.0), curve(2.0)];
/// let collapse = Collapse {
///     curves: &curves,
///     transform: &|parameters, _, p, point| CurvePoint {
///         y: point.y * libm::pow(p, -parameters[0]),
///         ..point
///     },
///     least_overlap: 0.5,
/// };
/// let fit = collapse.fit(&[0.5], &[0.2], 1, 0)?;
/// assert!((fit.parameters[0] - 1.0).abs() < 1e-3);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Collapse<'a> {
    /// Curves as measured.
    pub curves: &'a [Curve],
    /// The scaling.
    pub transform: &'a Transform<'a>,
    /// Least fraction of points that must be compared, 0 to 1; 0.5 is a good choice. At 0 a search is free to win by
    /// pulling the curves apart.
    pub least_overlap: f64,
}

/// Best parameters of a scaling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CollapseFit {
    /// Parameters, in the order of the scaling.
    pub parameters: Vec<f64>,
    /// Quality and overlap of the collapse.
    pub quality: CollapseQuality,
    /// Starts whose search ended at this minimum to within 1 per cent of S, of all starts: few say that there are
    /// others.
    pub agreeing: usize,
    /// Searches made.
    pub starts: usize,
    /// Whether the best search converged.
    pub converged: bool,
}

impl Collapse<'_> {
    /// Quality of the collapse at given parameters.
    ///
    /// # Errors
    /// Those of [`collapse_quality`].
    pub fn quality(&self, parameters: &[f64]) -> Result<CollapseQuality, Error> {
        collapse_quality(&self.scaled(parameters))
    }

    /// The scaled points of every curve.
    pub(crate) fn scaled(&self, parameters: &[f64]) -> Vec<Vec<CurvePoint>> {
        let scaled = |(index, curve): (usize, &Curve)| {
            let scale = |&point| (self.transform)(parameters, index, curve.parameter, point);
            curve.points.iter().map(scale).collect()
        };
        self.curves.iter().enumerate().map(scaled).collect()
    }

    /// Why no search began to find enough overlap, from where one has ended.
    pub(crate) fn no_overlap(&self, ended: &[f64]) -> Error {
        match self.quality(ended) {
            Err(too_few @ Error::TooFew { .. }) => too_few,
            other => Error::NoOverlap {
                needed: self.least_overlap,
                found: other.map_or(0.0, |quality| quality.overlap),
            },
        }
    }

    /// Whether enough scaled points overlap, and all curves hang together.
    pub(crate) fn overlaps(&self, scaled: &[Vec<CurvePoint>]) -> bool {
        let (compared, is_connected) = overlap(scaled);
        let total: usize = scaled.iter().map(Vec::len).sum();
        is_connected && compared > 0 && compared as f64 >= self.least_overlap * total as f64
    }

    /// S where enough points overlap; else a wall that leans toward more overlap.
    pub(crate) fn objective(&self, parameters: &[f64]) -> f64 {
        match self.quality(parameters) {
            Err(_) => 3.0 * SHORT,
            Ok(found) if found.overlap < self.least_overlap || !found.is_connected => {
                let missing = (self.least_overlap - found.overlap).max(0.0);
                SHORT * (1.0 + missing + f64::from(u8::from(!found.is_connected)))
            }
            Ok(found) => found.quality,
        }
    }

    fn search(&self, start: &[f64], steps: &[f64]) -> Lowest {
        let objective = |parameters: &[f64]| self.objective(parameters);
        let evaluations = EVALUATIONS * start.len();
        let mut best = nelder_mead(objective, start, steps, TOLERANCE, evaluations);
        // S jumps wherever a point passes one of another curve, so that it has many shallow minima: a search begins
        // afresh, to either side and in other proportions, until that no longer helps.
        let mut idle = 0;
        for round in 0..MOST_ROUNDS {
            let fresh = |(axis, step): (usize, &f64)| {
                let is_back = (round >> (axis % 2)) & 1 == 0;
                let sign = if is_back { -1.0 } else { 1.0 };
                sign * step / f64::from(1 + round / 4)
            };
            let fresh: Vec<f64> = steps.iter().enumerate().map(fresh).collect();
            let again = nelder_mead(objective, &best.place, &fresh, TOLERANCE, evaluations);
            let gains = again.value < best.value * (1.0 - GAIN);
            idle = if gains { 0 } else { idle + 1 };
            if again.value < best.value {
                best = again;
            }
            if idle == IDLE_ROUNDS {
                break;
            }
        }
        best
    }

    /// Parameters of the smallest S with enough overlap, by downhill simplex from several starts.
    ///
    /// `start` with `steps`, the lengths in which to explore each parameter; further `starts` begin within two steps of
    /// it, by random numbers of `seed`. Collapses with less than `least_overlap`, and ones in which groups of curves
    /// part, are rejected. Look at the overlap and at `agreeing` beside S.
    ///
    /// # Errors
    /// [`Error::NoOverlap`] with the best overlap where no start finds enough, [`Error::TooFew`] below 2 curves or
    /// without starts, [`Error::LengthMismatch`], [`Error::NonFinite`], [`Error::NotPositive`] for a step,
    /// [`Error::Fraction`].
    pub fn fit(
        &self,
        start: &[f64],
        steps: &[f64],
        starts: usize,
        seed: u64,
    ) -> Result<CollapseFit, Error> {
        self.check(start, steps, starts)?;
        let search = |number: u64| self.search(&place_of_start(start, steps, seed, number), steps);
        let mut found: Vec<Lowest> = (0..starts as u64).map(search).collect();
        // Stable: of equal ones the first search comes first.
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        let Lowest {
            place: parameters,
            value,
            converged,
        } = found[0].clone();
        ensure(value < SHORT, self.no_overlap(&parameters))?;
        Ok(CollapseFit {
            quality: self.quality(&parameters)?,
            parameters,
            agreeing: found.partition_point(|other| other.value <= value * 1.01),
            starts,
            converged,
        })
    }

    /// Errors of the best parameters from their scatter when every ordinate is moved by its error.
    ///
    /// Each resample adds a normal number times the error to every y and searches anew from the best parameters, with
    /// half of the steps: a parametric bootstrap, right where the errors are normal, independent and S is near 1. A
    /// scaling that does not hold (S well above 1) has errors beyond these. Resamples that do not overlap enough count
    /// as failed.
    ///
    /// # Errors
    /// [`Error::TooFewResamples`], [`Error::LengthMismatch`], [`Error::NotPositive`] for a step.
    pub fn bootstrap(
        &self,
        fit: &CollapseFit,
        steps: &[f64],
        bootstrap: Bootstrap,
    ) -> Result<Resampled, Error> {
        same_length(fit.parameters.len(), steps.len())?;
        let steps = checked_positive(steps)?.iter();
        let steps: Vec<f64> = steps.map(|step| 0.5 * step).collect();
        let estimates = bootstrap.streams()?.map(|mut randomness| {
            let mut curves = self.curves.to_vec();
            for point in curves.iter_mut().flat_map(|curve| &mut curve.points) {
                point.y += point.error * randomness.normal();
            }
            let curves = &curves;
            let found = Collapse { curves, ..*self }.search(&fit.parameters, &steps);
            (found.value < SHORT).then_some(found.place)
        });
        summarise(&fit.parameters, estimates)
    }

    /// Fits with one curve left out in turn, in the order of the curves: exponents that hang on one curve move.
    ///
    /// Arguments as for [`fit`](Self::fit). A parameter that belongs to the curve left out keeps whatever value the
    /// search began with.
    ///
    /// # Errors
    /// [`Error::TooFew`] below 3 curves; those of [`fit`](Self::fit) for any of the fits.
    pub fn leave_one_out(
        &self,
        start: &[f64],
        steps: &[f64],
        starts: usize,
        seed: u64,
    ) -> Result<Vec<CollapseFit>, Error> {
        self.without_each(|rest| rest.fit(start, steps, starts, seed))
    }

    /// An answer for the curves without each in turn.
    pub(crate) fn without_each<T>(
        &self,
        answer: impl Fn(&Collapse<'_>) -> Result<T, Error>,
    ) -> Result<Vec<T>, Error> {
        enough(self.curves.len(), 3)?;
        let without = |left_out: usize| {
            let mut curves = self.curves.to_vec();
            curves.remove(left_out);
            let transform = |parameters: &[f64], curve: usize, parameter, point| {
                // The place of the curve among all.
                let curve = curve + usize::from(curve >= left_out);
                (self.transform)(parameters, curve, parameter, point)
            };
            answer(&Collapse {
                curves: &curves,
                transform: &transform,
                ..*self
            })
        };
        (0..self.curves.len()).map(without).collect()
    }

    /// Refuses what no search can begin with.
    pub(crate) fn check(&self, start: &[f64], steps: &[f64], starts: usize) -> Result<(), Error> {
        same_length(start.len(), steps.len())?;
        checked(start, 1)?;
        checked_positive(steps)?;
        let needed = self.least_overlap;
        ensure(
            (0.0..=1.0).contains(&needed),
            Error::Fraction { value: needed },
        )?;
        enough(self.curves.len(), 2)?;
        enough(starts, 1)
    }
}

/// Where a search begins: the first at the start, the others within two steps of it.
pub(crate) fn place_of_start(start: &[f64], steps: &[f64], seed: u64, number: u64) -> Vec<f64> {
    let mut randomness = Randomness::new(seed, number);
    let place = |(&start, &step): (&f64, &f64)| match number {
        0 => start,
        _ => start + step * (4.0 * randomness.uniform() - 2.0),
    };
    start.iter().zip(steps).map(place).collect()
}

#[cfg(test)]
mod tests;
