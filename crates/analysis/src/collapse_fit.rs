//! Curves with a scaling to try on them, and what every search of its parameters needs.

use crate::bootstrap::Randomness;
use crate::collapse::{CollapseQuality, Curve, CurvePoint, collapse_quality, overlap};
use crate::error::{Error, checked, checked_positive, enough, ensure, same_length};

/// Value of the objective where the overlap falls short; it grows with the missing overlap, so that a search finds its way
/// back.
pub(crate) const SHORT: f64 = 1e6;

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
/// // S falls to its least where the exponent is right.
/// assert!(collapse.quality(&[1.0])?.quality < 1e-9 && collapse.quality(&[0.5])?.quality > 1.0);
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

    /// An answer for the curves without each in turn.
    pub(crate) fn without_each<T>(
        &self,
        answer: impl Fn(&Collapse<'_>) -> Result<T, Error>,
    ) -> Result<Vec<T>, Error> {
        enough("curves", self.curves.len(), 3)?;
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
        enough("curves", self.curves.len(), 2)?;
        enough("starts", starts, 1)
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
