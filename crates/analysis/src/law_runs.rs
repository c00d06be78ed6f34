//! Critical width and exponent straight from the runs at all widths, censored ones included.

use crate::bootstrap::{Bootstrap, Randomness, Resampled, bootstrap_errors};
use crate::error::{Error, checked, checked_positive, same_length};
use crate::family::{Family, Group, GroupLikelihood, LN_SHAPE_BOUNDS};
use crate::law::{CriticalRange, Law};
use crate::numerics::minimum::{Minimum, crossing, minimise, minimise_from_grid};
use crate::regression::Regression;
use crate::survival::times;
use crate::transition::Transition;
use crate::uncertain::{Interval, NARROW, Uncertain, WIDE};
use serde::{Deserialize, Serialize};

/// Tolerances of the maximum in ln(w_c - w) and in ln k.
const TOLERANCE: f64 = 1e-5;

/// A law of the mean transition time fitted to the runs at all widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawRunsFit {
    /// The law of the mean.
    pub law: Law,
    /// The family of the distribution about the mean.
    pub family: Family,
    /// Critical width w_c; `None` for a law without one. Its lower end never lies below a width that saw a transition;
    /// an upper end of infinity says that the runs do not tell the law from an exponential.
    pub critical_width: Option<Uncertain>,
    /// Exponent, or coefficient of the barrier, B.
    pub exponent: Uncertain,
    /// ln A.
    pub ln_amplitude: f64,
    /// Shape k, common to all widths; `None` for the exponential family.
    pub shape: Option<Uncertain>,
    /// Largest log-likelihood.
    pub log_likelihood: f64,
    /// Runs with an observed transition.
    pub observed: usize,
    /// Censored runs.
    pub censored: usize,
}

impl LawRunsFit {
    /// Free parameters.
    pub fn parameters(&self) -> usize {
        self.law.parameters() + self.family.parameters() - 1
    }

    /// Akaike's criterion 2 p - 2 ln L, comparable between laws and families on the same runs.
    pub fn akaike(&self) -> f64 {
        2.0 * self.parameters() as f64 - 2.0 * self.log_likelihood
    }

    /// Mean transition time at a width; infinite from w_c on.
    pub fn mean(&self, width: f64) -> f64 {
        let critical = self.critical_width.map_or(f64::INFINITY, |w| w.value);
        if width >= critical {
            return f64::INFINITY;
        }
        let x = self.law.covariate(width, critical);
        libm::exp(self.ln_amplitude + self.exponent.value * x)
    }
}

/// A fit to the runs in one window of widths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowRunsFit {
    /// Least width in the window.
    pub least: f64,
    /// Largest width in the window.
    pub largest: f64,
    /// The fit.
    pub fit: LawRunsFit,
}

/// A fit with errors from resampled runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawBootstrap {
    /// The fit to the runs themselves.
    pub fit: LawRunsFit,
    /// w_c with bootstrap errors.
    pub critical_width: Option<Uncertain>,
    /// B with bootstrap errors.
    pub exponent: Uncertain,
    /// Shape with bootstrap errors.
    pub shape: Option<Uncertain>,
    /// Resamples that gave a fit.
    pub succeeded: usize,
    /// Resamples that did not.
    pub failed: usize,
}

/// Runs of all widths, grouped by width in increasing order.
pub(crate) struct RunTable {
    pub(crate) places: Vec<f64>,
    pub(crate) runs: Vec<Vec<(f64, bool)>>,
}

impl RunTable {
    /// Columns of one row a run, in any order.
    pub(crate) fn new(width: &[f64], transitions: &[Transition]) -> Result<Self, Error> {
        same_length(width.len(), transitions.len())?;
        checked(width, 0)?;
        let times = times(transitions)?;
        let at_0 = |&(time, observed): &(f64, bool)| observed && time == 0.0;
        if let Some(index) = times.iter().position(at_0) {
            return Err(Error::NotPositive { index, value: 0.0 });
        }
        let mut places = width.to_vec();
        places.sort_by(f64::total_cmp);
        // -0 and 0 are one width.
        places.dedup_by(|a, b| a == b);
        let runs = places
            .iter()
            .map(|&place| {
                let here = width
                    .iter()
                    .zip(&times)
                    .filter(|(width, _)| **width == place);
                here.map(|(_, &run)| run).collect()
            })
            .collect();
        Ok(Self { places, runs })
    }

    fn count(&self) -> usize {
        self.runs.iter().map(Vec::len).sum()
    }
}

/// The likelihood of one law and family, as a function of w_c and shape.
pub(crate) struct LawLikelihood {
    law: Law,
    family: Family,
    places: Vec<f64>,
    groups: Vec<Group>,
    range: CriticalRange,
}

/// Largest likelihood of a law and family.
#[derive(Clone, Copy)]
pub(crate) struct Largest {
    ln_distance: f64,
    ln_shape: f64,
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
        let groups: Vec<Group> = runs
            .iter()
            .map(|runs| Group::new(runs.iter().copied()))
            .collect();
        let with_transition = |(_, group): &(&f64, &Group)| group.observed() > 0;
        let seen: Vec<f64> = places
            .iter()
            .zip(&groups)
            .filter(with_transition)
            .map(|(&place, _)| place)
            .collect();
        if seen.len() < law.parameters() {
            return Err(Error::TooFewPlaces {
                needed: law.parameters(),
                found: seen.len(),
            });
        }
        if family != Family::Exponential && !groups.iter().any(Group::scatters) {
            return Err(Error::NoScatter {
                observed: groups.iter().map(Group::observed).sum(),
            });
        }
        let top = seen[seen.len() - 1];
        Ok(Self {
            law,
            family,
            places: places.to_vec(),
            groups,
            range: CriticalRange::new(&seen, top),
        })
    }

    /// Likelihoods of all widths at one shape.
    fn at_shape(&self, ln_shape: f64) -> Vec<GroupLikelihood<'_>> {
        let shape = libm::exp(ln_shape);
        self.groups
            .iter()
            .map(|group| group.at_shape(self.family, shape))
            .collect()
    }

    /// Regression of the mean on the law at a w_c.
    fn regression<'a>(
        &'a self,
        likelihoods: &'a [GroupLikelihood<'a>],
        ln_distance: f64,
    ) -> Regression<'a> {
        let critical = self.range.critical(ln_distance);
        // Runs at w >= w_c never change: they are certain to be censored and say nothing.
        let below = if self.law.is_critical() {
            self.places.partition_point(|&place| place < critical)
        } else {
            self.places.len()
        };
        let x = self.places[..below]
            .iter()
            .map(|&place| self.law.covariate(place, critical))
            .collect();
        Regression::new(x, &self.groups[..below], &likelihoods[..below])
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
    fn over_shapes(&self, bounds: (f64, f64), value: impl FnMut(f64) -> f64) -> Minimum {
        let mut value = value;
        if self.family == Family::Exponential {
            Minimum {
                place: 0.0,
                value: value(0.0),
            }
        } else {
            minimise(value, bounds, 1e-4)
        }
    }

    /// The largest likelihood with the shape between two bounds of ln k; `None` where it has none.
    pub(crate) fn largest(&self, bounds: (f64, f64)) -> Option<Largest> {
        let best = self.over_shapes(bounds, |ln_shape| {
            self.best_distance(ln_shape)
                .map_or(f64::INFINITY, |best| best.value)
        });
        let ln_shape = best.place;
        let ln_distance = self.best_distance(ln_shape)?.place;
        let (ln_amplitude, exponent, log_likelihood) = self
            .regression(&self.at_shape(ln_shape), ln_distance)
            .largest();
        let shape_is_inside =
            ln_shape > LN_SHAPE_BOUNDS.0 + 0.01 && ln_shape < LN_SHAPE_BOUNDS.1 - 0.01;
        (log_likelihood.is_finite() && exponent.is_finite() && shape_is_inside).then_some(Largest {
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

    /// Runs drawn from a fit, watched for the given times: one list a width.
    pub(crate) fn simulate(
        &self,
        best: &Largest,
        horizons: &[Vec<f64>],
        randomness: &mut Randomness,
    ) -> Vec<Vec<(f64, bool)>> {
        let shape = libm::exp(best.ln_shape);
        let critical = self.range.critical(best.ln_distance);
        self.places
            .iter()
            .zip(horizons)
            .map(|(&place, horizons)| {
                let mean = if self.law.is_critical() && place >= critical {
                    f64::INFINITY
                } else {
                    let x = self.law.covariate(place, critical);
                    libm::exp(best.ln_amplitude + best.exponent * x)
                };
                let one = |&horizon: &f64| {
                    let time = mean * self.family.draw(shape, randomness);
                    if time < horizon {
                        (time, true)
                    } else {
                        (horizon, false)
                    }
                };
                horizons.iter().map(one).collect()
            })
            .collect()
    }

    /// Parameters with the intervals where their profile likelihood stays within 1/2 and 1.92 of the largest.
    fn profiles(&self, best: &Largest) -> (Option<Uncertain>, Uncertain, Option<Uncertain>) {
        let observed: usize = self.groups.iter().map(Group::observed).sum();
        let first_step = 1.0 / (observed as f64).sqrt();
        let bounds = (
            (best.ln_shape - 10.0 * first_step).max(LN_SHAPE_BOUNDS.0),
            (best.ln_shape + 10.0 * first_step).min(LN_SHAPE_BOUNDS.1),
        );
        let ends = |value: f64, step: f64, limits: (f64, f64), profile: &dyn Fn(f64) -> f64| {
            [NARROW, WIDE].map(|deviations| {
                let outside = |place: f64| {
                    profile(place) + best.log_likelihood - 0.5 * deviations * deviations
                };
                let end = |limit: f64| crossing(outside, value, deviations * step, limit);
                (end(limits.0), end(limits.1))
            })
        };
        let critical = self.law.is_critical().then(|| {
            let value = best.ln_distance;
            let (nearest, farthest) = self.range.bounds();
            let limits = (nearest.min(value) - 7.0, farthest);
            let found = ends(value, first_step, limits, &|place| {
                let value = |k| -self.regression(&self.at_shape(k), place).largest().2;
                self.over_shapes(bounds, value).value
            });
            let critical = |place: f64| self.range.critical(place);
            assembled(
                critical(value),
                found.map(|(lower, upper)| Interval {
                    lower: lower.map_or(self.range.top, critical),
                    upper: upper.map_or(f64::INFINITY, critical),
                }),
            )
        });
        let grid = self.range.grid();
        let exponent_step = first_step * best.exponent.abs().max(1e-3);
        let far = 1e3 * exponent_step;
        let limits = (best.exponent - far, best.exponent + far);
        let found = ends(best.exponent, exponent_step, limits, &|exponent| {
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
        });
        let exponent = assembled(best.exponent, found.map(open_ended));
        let shape = (self.family != Family::Exponential).then(|| {
            let found = ends(best.ln_shape, first_step, LN_SHAPE_BOUNDS, &|ln_shape| {
                self.best_distance(ln_shape)
                    .map_or(f64::INFINITY, |best| best.value)
            });
            let in_logarithm = found.map(open_ended);
            assembled(
                libm::exp(best.ln_shape),
                in_logarithm.map(|interval| Interval {
                    lower: libm::exp(interval.lower),
                    upper: libm::exp(interval.upper),
                }),
            )
        });
        (critical, exponent, shape)
    }
}

fn open_ended((lower, upper): (Option<f64>, Option<f64>)) -> Interval {
    Interval {
        lower: lower.unwrap_or(f64::NEG_INFINITY),
        upper: upper.unwrap_or(f64::INFINITY),
    }
}

/// A value with its narrow and wide interval; the standard error is half of the narrow one.
fn assembled(value: f64, [narrow, wide]: [Interval; 2]) -> Uncertain {
    Uncertain {
        value,
        error: 0.5 * narrow.length(),
        interval_68: narrow,
        interval_95: wide,
    }
}

/// Fits a law of the mean transition time to the runs at all widths by maximum likelihood.
///
/// `ln L = sum_observed ln f(t_i; tau(w_i), k) + sum_censored ln S(t_i; tau(w_i), k)`
///
/// f and S of a [`Family`] with mean tau(w) by a [`Law`] and a shape k common to all widths; one row a run, `width` beside
/// `transitions`. Censored runs count with the time that they were watched, so that w_c is not drawn toward the widths
/// where few runs were long enough; runs at w >= w_c say nothing, and w_c lies above every width that saw a transition.
/// At given w_c and k the likelihood is concave in (ln A, B) and solved by Newton's method; w_c is searched from a grid.
/// Intervals by profile likelihood (1/2 and 1.92 below the largest), the standard error being half of the narrow one.
/// All of it assumes the family. A wrong one biases w_c and B where runs are censored (its tail stands for the times that
/// were not seen): compare families by [`akaike`](LawRunsFit::akaike). Without censoring below w_c it only misjudges the
/// errors, and [`bootstrap_law`] does not.
/// Source: Kalbfleisch & Prentice, The Statistical Analysis of Failure Time Data (2002), chapter 3 (regression under
/// censoring); Venzon & Moolgavkar, Appl. Stat. 37, 87 (1988) (profile likelihood).
///
/// # Errors
/// [`Error::TooFewPlaces`] where fewer widths saw a transition than the law has parameters, [`Error::NoScatter`],
/// [`Error::Undetermined`] where the best w_c lies at infinity or the shape at its bounds, [`Error::LengthMismatch`],
/// [`Error::NonFinite`], [`Error::NotPositive`], [`Error::Negative`].
pub fn fit_law_to_runs(
    law: Law,
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<LawRunsFit, Error> {
    let table = RunTable::new(width, transitions)?;
    let likelihood = LawLikelihood::new(law, family, &table.places, &table.runs)?;
    let undetermined = Error::Undetermined {
        points: table.count(),
        parameters: law.parameters() + family.parameters() - 1,
    };
    let best = likelihood
        .largest(LN_SHAPE_BOUNDS)
        .filter(|best| !best.is_beyond)
        .ok_or(undetermined)?;
    let (critical_width, exponent, shape) = likelihood.profiles(&best);
    let observed = transitions
        .iter()
        .filter(|transition| transition.observed().is_some())
        .count();
    Ok(LawRunsFit {
        law,
        family,
        critical_width,
        exponent,
        ln_amplitude: best.ln_amplitude,
        shape,
        log_likelihood: best.log_likelihood,
        observed,
        censored: transitions.len() - observed,
    })
}

/// Errors of a fitted law by resampling the runs within each width.
///
/// Resamples whose best w_c lies at infinity count with w_c and B infinite, so that the intervals end there; those with
/// transitions at too few widths fail and are counted. Percentile intervals: with few runs at the largest width that saw
/// a transition they are too short to that side, as no resample puts w_c below what it saw.
///
/// # Errors
/// Those of [`fit_law_to_runs`] and [`bootstrap_errors`].
pub fn bootstrap_law(
    law: Law,
    family: Family,
    width: &[f64],
    transitions: &[Transition],
    bootstrap: Bootstrap,
) -> Result<LawBootstrap, Error> {
    let fit = fit_law_to_runs(law, family, width, transitions)?;
    let table = RunTable::new(width, transitions)?;
    let shape = fit.shape.map_or(1.0, |shape| shape.value);
    let bounds = (
        (libm::log(shape) - 1.5).max(LN_SHAPE_BOUNDS.0),
        (libm::log(shape) + 1.5).min(LN_SHAPE_BOUNDS.1),
    );
    let Resampled {
        estimates,
        succeeded,
        failed,
    } = bootstrap_errors(&table.runs, bootstrap, |runs| {
        let likelihood = LawLikelihood::new(law, family, &table.places, runs).ok()?;
        let best = likelihood.largest(bounds)?;
        let shape = libm::exp(best.ln_shape);
        let exponent = if best.is_beyond {
            f64::INFINITY
        } else {
            best.exponent
        };
        Some([likelihood.critical_width(&best), exponent, shape])
    })?;
    // The search over fewer shapes ends within its tolerance of the fit, whose values stand.
    let with_value = |estimate: Uncertain, value: f64| Uncertain { value, ..estimate };
    Ok(LawBootstrap {
        critical_width: fit
            .critical_width
            .map(|critical| with_value(estimates[0], critical.value)),
        exponent: with_value(estimates[1], fit.exponent.value),
        shape: fit.shape.map(|shape| with_value(estimates[2], shape.value)),
        fit,
        succeeded,
        failed,
    })
}

/// Fits a law in windows that leave out the smallest, then the largest widths one by one.
///
/// The first window holds all widths; see [`fit_law_in_windows`](crate::fit_law_in_windows) for their use. Windows
/// without a fit are left out.
///
/// # Errors
/// Those of [`fit_law_to_runs`] for all runs.
pub fn fit_law_to_runs_in_windows(
    law: Law,
    family: Family,
    width: &[f64],
    transitions: &[Transition],
) -> Result<Vec<WindowRunsFit>, Error> {
    let whole = fit_law_to_runs(law, family, width, transitions)?;
    let places = RunTable::new(width, transitions)?.places;
    let mut windows = Vec::new();
    for (least, largest) in crate::law::windows(&places) {
        let inside: Vec<usize> = (0..width.len())
            .filter(|&i| least <= width[i] && width[i] <= largest)
            .collect();
        let widths: Vec<f64> = inside.iter().map(|&i| width[i]).collect();
        let runs: Vec<Transition> = inside.iter().map(|&i| transitions[i]).collect();
        let fit = if inside.len() == width.len() {
            Ok(whole)
        } else {
            fit_law_to_runs(law, family, &widths, &runs)
        };
        if let Ok(fit) = fit {
            windows.push(WindowRunsFit {
                least,
                largest,
                fit,
            });
        }
    }
    Ok(windows)
}

#[cfg(test)]
mod tests;
