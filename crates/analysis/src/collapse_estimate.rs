//! The parameters of a scaling with errors that hold, or with the reasons not to trust them.

mod found;
#[cfg(test)]
mod ising;
mod likelihood;

use self::found::Found;
use self::likelihood::{Likelihood, MOST_ROUNDS};
use crate::collapse::CollapseQuality;
use crate::collapse_fit::Collapse;
use crate::error::{Error, ensure, same_length};
use crate::numerics::gamma::chi_squared_tail;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// ln of the stiffness of the common curve: where its search begins, and its step.
const STIFFNESS: (f64, f64) = (2.0, 2.0);
/// Parameters of a scaling by the likelihood of one common curve, with intervals, and whether they can be trusted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CollapseEstimate {
    /// Parameters, in the order of the scaling; intervals from the profile of the likelihood, infinite to a side that the
    /// points leave open.
    pub parameters: Vec<Uncertain>,
    /// Power of the curves' parameter in the correction to scaling that was allowed for, if one was.
    pub correction: Option<f64>,
    /// Quality S and overlap of the collapse there; S knows no correction.
    pub quality: CollapseQuality,
    /// Factor by which the errors are stretched, 1 at least: how much more the points scatter than their errors say.
    pub stretch: f64,
    /// Searches that ended here, of all.
    pub agreeing: usize,
    /// Searches made.
    pub starts: usize,
    /// Whether there is no doubt.
    pub trusted: bool,
    /// Reasons not to trust the parameters or their errors, in words.
    pub doubts: Vec<String>,
}

/// Several parameters of a collapse against values claimed for them, all at once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct JointTest {
    /// Rise of -2 ln likelihood, minimal over all else, from the best to the values claimed.
    pub chi_squared: f64,
    /// Parameters compared.
    pub degrees_of_freedom: usize,
    /// Probability of a rise at least as large if the values claimed are right.
    pub probability: f64,
}

impl<'a> Collapse<'a> {
    /// Parameters under which all points lie best on one smooth curve, with intervals from the profile of the likelihood.
    ///
    /// `Y = f(X) + p^c g(X) + noise`
    ///
    /// for the scaled points (X, Y), with smooth curves f and g: cubic splines whose bends are normal random numbers,
    /// integrated out, of a variance that is fitted too. What the curve does between and beyond the points is
    /// thus part of the error, and curves that are pulled apart gain nothing. The term in g, a correction to scaling of
    /// the power c = `correction` of the curves' parameter p, is there if asked for: below 0 it fades for large p
    /// (sizes), above 0 for small p (strain rates). An interval ends where -2 ln likelihood, minimal over all else, has
    /// risen by 1 or by 1.96^2; the noise is the error of each point, stretched by a common factor of 1 or more, fitted too.
    /// A side that the points leave open is infinite.
    ///
    /// `start` with `steps`, the lengths in which to explore each parameter; further `starts` begin within two steps of it,
    /// by random numbers of `seed`.
    ///
    /// `known` are parameters known from elsewhere, by their place: normal numbers that count as points beside the others.
    /// They serve critical widths that were fitted to each curve before. The scaling leaves them free
    /// ([`Scaling::CriticalEach`](crate::Scaling::CriticalEach), w_c of curve k at place 2 + k) and `known` gives them with
    /// their errors: the error of one w_c then moves all points of its curve together, whereas an error added to every
    /// point counts many times over and makes S too small. `quality` is S at the best, the curves moved within those errors.
    ///
    /// Without a correction the errors hold only where the data have none: a small correction shifts
    /// the exponents, and the fit still looks good. The fit is therefore compared with fits that allow for c = -1 and 1. It
    /// is not trusted where one of them may take a parameter out of its interval of 95 per cent, nor where a common curve of
    /// three times as many knots does: it then bends too sharply for them. Look at
    /// [`doubts`](CollapseEstimate::doubts). Compare Harada, Phys. Rev. E 84, 056704 (2011).
    ///
    /// # Errors
    /// [`Error::NoOverlap`] with the best overlap where no start finds enough, [`Error::TooFew`] below 2 curves, without
    /// starts or with fewer points than curve and parameters need, [`Error::LengthMismatch`] for steps or a place of `known`
    /// beyond the parameters, [`Error::NonFinite`], [`Error::NotPositive`] for a step, the error of a known parameter, or a
    /// parameter of a curve with a correction, [`Error::Fraction`],
    /// [`Error::Undetermined`] where the search does not settle.
    ///
    /// ```
    /// use peristalsis_analysis::{Collapse, Curve, CurvePoint};
    /// // y = p x^2: curves of p = 1, 2 and 4 collapse as y/p^a with a = 1.
    /// let point = |p: f64, x: f64| CurvePoint { x, y: p * x * x, error: 0.1 };
    /// let curve = |p: f64| Curve {
    ///     parameter: p,
    ///     points: (0..9).map(|k| point(p, f64::from(k))).collect(),
    /// };
    /// let curves = [curve(1.0), curve(2.0), curve(4.0)];
    /// let collapse = Collapse {
    ///     curves: &curves,
    ///     transform: &|parameters, _, p, point| {
    ///         let factor = libm::pow(p, -parameters[0]);
    ///         CurvePoint { x: point.x, y: point.y * factor, error: point.error * factor }
    ///     },
    ///     least_overlap: 0.5,
    /// };
    /// let found = collapse.estimate(&[], &[0.8], &[0.2], 4, 0, Some(1.0))?;
    /// assert!((found.parameters[0].value - 1.0).abs() < 1e-2);
    /// assert!(found.trusted, "{:?}", found.doubts);
    /// # Ok::<(), peristalsis_analysis::Error>(())
    /// ```
    pub fn estimate(
        &self,
        known: &[(usize, Uncertain)],
        start: &[f64],
        steps: &[f64],
        starts: usize,
        seed: u64,
        correction: Option<f64>,
    ) -> Result<CollapseEstimate, Error> {
        self.check(start, steps, starts)?;
        let all_steps = [steps, &[STIFFNESS.1]].concat();
        let likelihood = Likelihood::new(self, &all_steps, correction, known)?;
        let mut found = Found::search(likelihood, start, starts, seed)?;
        let mut rounds = 0;
        let parameters = loop {
            match found.intervals() {
                Ok(parameters) => break parameters,
                Err(better) if rounds < MOST_ROUNDS => found.best = better,
                Err(_) => return Err(Error::undetermined(found.likelihood.points(), steps.len())),
            }
            rounds += 1;
        };
        let doubts = found.doubts(&parameters);
        let stretch = found.likelihood.curve(&found.best.place);
        let stretch = stretch.map_or(1.0, |(curve, lost)| found.likelihood.variance(&curve, lost));
        Ok(CollapseEstimate {
            quality: self.quality(&found.best.place[..steps.len()])?,
            parameters,
            correction,
            stretch: stretch.max(1.0).sqrt(),
            agreeing: found.agreeing(),
            starts,
            trusted: doubts.is_empty(),
            doubts,
        })
    }

    /// Whether parameters that were found are those `claimed`, by their places, all at once.
    ///
    /// The ratio of the likelihoods at the best and with the claimed values held, against chi^2 of as many degrees of
    /// freedom as values. Exponents of a collapse are correlated: values that each lie within the error of theirs may
    /// together be far from the valley in which the curves collapse. `known`, `steps` as for the estimate.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for steps or places that do not belong to the estimate, [`Error::Undetermined`] where the
    /// curves do not overlap at the values claimed, and those of the estimate.
    pub fn joint_test(
        &self,
        known: &[(usize, Uncertain)],
        found: &CollapseEstimate,
        steps: &[f64],
        claimed: &[(usize, f64)],
    ) -> Result<JointTest, Error> {
        let expected = found.parameters.len();
        same_length(expected, steps.len())?;
        let last = claimed.iter().map(|&(place, _)| place + 1).max();
        let last = last.unwrap_or(0);
        ensure(
            last <= expected,
            Error::LengthMismatch {
                expected,
                found: last,
            },
        )?;
        let all_steps = [steps, &[STIFFNESS.1]].concat();
        let likelihood = Likelihood::new(self, &all_steps, found.correction, known)?;
        let best: Vec<f64> = found.parameters.iter().map(|one| one.value).collect();
        let mut from_claimed = best.clone();
        claimed
            .iter()
            .for_each(|&(place, value)| from_claimed[place] = value);
        // From curves of any stiffness; a correction may move the best far away.
        let least = |held: &[(usize, f64)]| {
            let places = [&best, &from_claimed];
            let starts = places.into_iter().flat_map(|place| {
                [0.0, 3.0, 6.0].map(|more| [&place[..], &[STIFFNESS.0 + more]].concat())
            });
            let found = starts.filter_map(|start| likelihood.settle_holding(held, &start));
            found.map(|found| found.value).min_by(f64::total_cmp)
        };
        let (Some(least), Some(held)) = (least(&[]), least(claimed)) else {
            return Err(Error::undetermined(likelihood.points(), steps.len()));
        };
        let (chi_squared, degrees_of_freedom) = ((held - least).max(0.0), claimed.len());
        Ok(JointTest {
            chi_squared,
            degrees_of_freedom,
            probability: chi_squared_tail(chi_squared, degrees_of_freedom),
        })
    }

    /// The best parameters of [`estimate`](Self::estimate) with one curve left out in turn, in the order of the curves:
    /// exponents that hang on one curve move. Two curves that are left are taken without a correction.
    ///
    /// # Errors
    /// [`Error::TooFew`] below 3 curves; those of [`estimate`](Self::estimate) for any of the fits.
    pub fn estimates_without_each(
        &self,
        start: &[f64],
        steps: &[f64],
        starts: usize,
        seed: u64,
        correction: Option<f64>,
    ) -> Result<Vec<Vec<f64>>, Error> {
        self.check(start, steps, starts)?;
        let all_steps = [steps, &[STIFFNESS.1]].concat();
        self.without_each(|rest| {
            let correction = correction.filter(|_| rest.curves.len() > 2);
            let likelihood = Likelihood::new(rest, &all_steps, correction, &[])?;
            let mut place = Found::search(likelihood, start, starts, seed)?.best.place;
            place.truncate(start.len());
            Ok(place)
        })
    }
}

#[cfg(test)]
mod tests;
