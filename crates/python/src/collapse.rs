//! Collapses of curves, under a scaling by name or one that is a function of Python.

use std::cell::RefCell;

use peristalsis_analysis as analysis;
use peristalsis_analysis::{
    Collapse, CollapseEstimate, Curve, CurvePoint, Scaling, Transform, Uncertain,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pythonize::pythonize;
use serde::Serialize;

use crate::analysis::{Answer, Column, Named};
use crate::error::{AnalysisError, of_analysis};
use crate::heard::heard;

/// A curve, from its parameter and its columns (x, y, error).
pub(crate) struct Measured(Curve);

impl FromPyObject<'_, '_> for Measured {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let (parameter, Column(x), Column(y), Column(error)) = object.extract()?;
        let points = x.into_iter().zip(y).zip(error);
        let points = points.map(|((x, y), error)| CurvePoint { x, y, error });
        let points = points.collect();
        Ok(Self(Curve { parameter, points }))
    }
}

/// A scaling: one of ours by its name, or a function of Python.
pub(crate) enum Scheme<'py> {
    Named(Scaling),
    Called {
        function: Bound<'py, PyAny>,
        /// The first exception that it raised.
        raised: RefCell<Option<PyErr>>,
    },
}

impl<'py> FromPyObject<'_, 'py> for Scheme<'py> {
    type Error = PyErr;

    fn extract(scaling: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(if scaling.is_callable() {
            Self::Called {
                function: scaling.to_owned(),
                raised: RefCell::new(None),
            }
        } else {
            Self::Named(scaling.extract::<Named<Scaling>>()?.0)
        })
    }
}

/// The result of a scaling function of the caller.
fn three_numbers(answer: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let numbers = answer.try_iter().and_then(|items| {
        let numbers = items.map(|item| item?.extract());
        numbers.collect::<PyResult<Vec<f64>>>()
    });
    let three = numbers.ok().and_then(|found| found.try_into().ok());
    three.ok_or_else(|| {
        let reason = format!(
            "the scaling is called for one point at a time and answers three numbers (x, y, error), not {answer}"
        );
        PyTypeError::new_err(reason)
    })
}

impl Scheme<'_> {
    /// Refuses another number of parameters than a scaling of ours has, and of known places than there are curves.
    fn check(&self, parameters: usize, curves: usize) -> PyResult<()> {
        let Self::Named(scaling) = self else {
            return Ok(());
        };
        let names = scaling.parameters(curves);
        if names.len() != parameters {
            let (needed, names) = (names.len(), names.join(", "));
            let reason =
                format!("this scaling has {needed} parameters ({names}), not {parameters}");
            return Err(AnalysisError::new_err(reason));
        }
        match scaling {
            Scaling::CriticalKnown(places) if places.len() != curves => {
                let known = places.len();
                let reason = format!("critical_known has {known} places for {curves} curves");
                Err(AnalysisError::new_err(reason))
            }
            _ => Ok(()),
        }
    }

    fn apply(
        &self,
        parameters: &[f64],
        curve: usize,
        parameter: f64,
        point: CurvePoint,
    ) -> CurvePoint {
        let [x, y, error] = [f64::NAN; 3];
        let nowhere = CurvePoint { x, y, error };
        match self {
            Self::Named(scaling) => scaling.apply(parameters, curve, parameter, point),
            Self::Called { raised, .. } if raised.borrow().is_some() => nowhere,
            Self::Called { function, raised } => {
                let CurvePoint { x, y, error } = point;
                let arguments = (parameters.to_vec(), parameter, x, y, error);
                // A search asks often and long: Ctrl-C is heard on the way.
                let called = function.py().check_signals();
                let called = called.and_then(|()| function.call1(arguments));
                match called.and_then(|answer| three_numbers(&answer)) {
                    Ok([x, y, error]) => CurvePoint { x, y, error },
                    Err(error) => {
                        *raised.borrow_mut() = Some(error);
                        nowhere
                    }
                }
            }
        }
    }

    /// What the function raised comes before what the search made of it.
    fn outcome<T>(self, outcome: Result<T, analysis::Error>) -> PyResult<T> {
        if let Self::Called { raised, .. } = self
            && let Some(error) = raised.into_inner()
        {
            return Err(error);
        }
        outcome.map_err(of_analysis)
    }
}

/// How a search for the best collapse goes about it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Search {
    start: Vec<f64>,
    steps: Vec<f64>,
    starts: usize,
    seed: u64,
    least_overlap: f64,
    correction: Option<f64>,
    leave_one_out: bool,
    /// Place, value and error of parameters known from elsewhere.
    known: Vec<(usize, f64, f64)>,
}

impl Search {
    fn known(&self) -> Vec<(usize, Uncertain)> {
        let known = self.known.iter();
        known
            .map(|&(place, value, error)| (place, Uncertain::normal(value, error)))
            .collect()
    }
}

/// Curves, their scaling and how to search, as the analysis takes them, and what it makes of them.
fn searched<T: Serialize + Send + 'static>(
    py: Python<'_>,
    measured: Vec<Measured>,
    scheme: Scheme<'_>,
    search: Search,
    work: impl FnOnce(&Collapse<'_>, &Search) -> Result<T, analysis::Error> + Send + 'static,
) -> Answer {
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    scheme.check(search.start.len(), curves.len())?;
    scheme.check(search.steps.len(), curves.len())?;
    let work = move |transform: &Transform<'_>| {
        let collapse = Collapse {
            curves: &curves,
            transform,
            least_overlap: search.least_overlap,
        };
        work(&collapse, &search)
    };
    let found = match scheme {
        Scheme::Named(scaling) => {
            let outcome = heard(py, move || {
                work(&|parameters, curve, parameter, point| {
                    scaling.apply(parameters, curve, parameter, point)
                })
            });
            outcome?.map_err(of_analysis)?
        }
        Scheme::Called { .. } => {
            let outcome = work(&|parameters, curve, parameter, point| {
                scheme.apply(parameters, curve, parameter, point)
            });
            scheme.outcome(outcome)?
        }
    };
    Ok(pythonize(py, &found)?.unbind())
}

/// Best parameters with errors: (estimate, parameters with one curve left out in turn).
#[pyfunction]
pub(crate) fn fit_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    search: Search,
) -> Answer {
    searched(py, measured, scheme, search, |collapse, search| {
        let (start, steps) = (&search.start, &search.steps);
        let (starts, seed, correction) = (search.starts, search.seed, search.correction);
        let known = search.known();
        let found = collapse.estimate(&known, start, steps, starts, seed, correction)?;
        let values = found.parameters.iter().map(|parameter| parameter.value);
        let left_out = if search.leave_one_out {
            let best: Vec<f64> = values.collect();
            collapse.estimates_without_each(&best, steps, starts, seed, correction)?
        } else {
            Vec::new()
        };
        Ok((found, left_out))
    })
}

/// Whether the parameters that were found are those claimed, by their places.
#[pyfunction]
pub(crate) fn test_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    search: Search,
    found: Named<CollapseEstimate>,
    claimed: Vec<(usize, f64)>,
) -> Answer {
    searched(py, measured, scheme, search, move |collapse, search| {
        collapse.joint_test(&search.known(), &found.0, &search.steps, &claimed)
    })
}

/// How well curves collapse as they are scaled with given parameters: (quality, scaled curves).
#[pyfunction]
pub(crate) fn apply_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    parameters: Vec<f64>,
) -> Answer {
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    scheme.check(parameters.len(), curves.len())?;
    let scaled = |(place, curve): (usize, &Curve)| -> Vec<CurvePoint> {
        let points = curve.points.iter();
        let scaled = points.map(|it| scheme.apply(&parameters, place, curve.parameter, *it));
        scaled.collect()
    };
    let scaled: Vec<_> = curves.iter().enumerate().map(scaled).collect();
    let quality = scheme.outcome(analysis::collapse_quality(&scaled))?;
    Ok(pythonize(py, &(quality, scaled))?.unbind())
}
