//! The estimators, on NumPy arrays; answers are dictionaries, of which `peristalsis.analysis` makes its result objects.

use std::cell::RefCell;
use std::ops::Deref;

use numpy::PyReadonlyArray1;
use peristalsis_analysis as analysis;
use peristalsis_analysis::{
    AfterEnd, Bootstrap, Collapse, CollapseEstimate, Curve, CurvePoint, Direction, Family, Law,
    Scaling, Survival, Transition, Uncertain,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{AnalysisError, of_analysis};

type Answer = PyResult<Py<PyAny>>;

/// A column of numbers, from an array of NumPy.
pub(crate) struct Column(Vec<f64>);

impl FromPyObject<'_, '_> for Column {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let array: PyReadonlyArray1<'_, f64> = object.extract()?;
        Ok(Self(array.as_slice()?.to_vec()))
    }
}

impl Deref for Column {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl AsRef<[f64]> for Column {
    fn as_ref(&self) -> &[f64] {
        self
    }
}

/// Outcomes of runs, from the columns (time, observed): the time of the transition, or of the end of a run without one.
pub(crate) struct Runs(Vec<Transition>);

impl FromPyObject<'_, '_> for Runs {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let (Column(time), observed): (Column, Vec<bool>) = object.extract()?;
        let runs = time.into_iter().zip(observed);
        let runs = runs.map(|(time, observed)| Transition::new(time, observed));
        Ok(Self(runs.collect()))
    }
}

/// Width and outcome of each run.
type RunTable = (Column, Runs);
/// Width of each run, and whether it ended jammed.
type Outcomes = (Column, Vec<bool>);

/// A value of one of our enumerations, from its name.
pub(crate) struct Named<T>(T);

impl<T: DeserializeOwned> FromPyObject<'_, '_> for Named<T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        depythonize(&object)
            .map(Self)
            .map_err(|error| AnalysisError::new_err(error.to_string()))
    }
}

/// Computes without the interpreter and hands the answer over.
fn answer<T: Serialize + Send>(work: impl FnOnce() -> Result<T, analysis::Error> + Send) -> Answer {
    Python::attach(|py| {
        let value = py.detach(work).map_err(of_analysis)?;
        Ok(pythonize(py, &value)?.unbind())
    })
}

fn uncertain((value, error): (f64, f64)) -> Uncertain {
    Uncertain::normal(value, error)
}

/// What stands for runs that ended early: the mean of so many last samples, or nothing.
fn after_end(held: Option<usize>) -> AfterEnd {
    held.map_or(AfterEnd::Leave, |samples| AfterEnd::Hold { samples })
}

#[pyfunction]
pub(crate) fn mean_with_error(series: Column) -> Answer {
    answer(|| analysis::mean_with_error(&series))
}

#[pyfunction]
pub(crate) fn autocorrelation_time(series: Column) -> Answer {
    answer(|| analysis::autocorrelation_time(&series))
}

#[pyfunction]
pub(crate) fn stationary_mean(series: Column) -> Answer {
    answer(|| analysis::stationary_mean(&series))
}

#[pyfunction]
pub(crate) fn stationarity(series: Column) -> Answer {
    answer(|| analysis::stationarity(&series))
}

/// Time of the transition in a series of period averages, and whether there was one.
#[pyfunction]
pub(crate) fn transition_time(
    averages: Column,
    direction: Named<Direction>,
    threshold: f64,
    period_duration: f64,
) -> PyResult<(f64, bool)> {
    let found = analysis::transition_time(&averages, direction.0, threshold, period_duration);
    found.map(Transition::time).map_err(of_analysis)
}

#[pyfunction]
pub(crate) fn survival(runs: Runs) -> Answer {
    answer(|| Survival::new(&runs.0))
}

#[pyfunction]
pub(crate) fn survival_median(runs: Runs) -> Answer {
    answer(|| Survival::new(&runs.0)?.median())
}

#[pyfunction]
pub(crate) fn restricted_moments(runs: Runs, horizon: f64) -> Answer {
    answer(|| analysis::restricted_moments(&runs.0, horizon))
}

#[pyfunction]
pub(crate) fn fit_lifetime(family: Named<Family>, runs: Runs) -> Answer {
    answer(|| analysis::fit_lifetime(family.0, &runs.0))
}

#[pyfunction]
pub(crate) fn fit_shifted_exponential(runs: Runs) -> Answer {
    answer(|| analysis::fit_shifted_exponential(&runs.0))
}

#[pyfunction]
#[pyo3(signature = (law, width, value, error, known=None))]
pub(crate) fn fit_law(
    law: Named<Law>,
    width: Column,
    value: Column,
    error: Column,
    known: Option<(f64, f64)>,
) -> Answer {
    answer(|| analysis::fit_law(law.0, &width, &value, &error, known.map(uncertain)))
}

#[pyfunction]
#[pyo3(signature = (law, width, value, error, known=None))]
pub(crate) fn fit_law_to_nearest(
    law: Named<Law>,
    width: Column,
    value: Column,
    error: Column,
    known: Option<(f64, f64)>,
) -> Answer {
    answer(|| analysis::fit_law_to_nearest(law.0, &width, &value, &error, known.map(uncertain)))
}

#[pyfunction]
pub(crate) fn fit_law_to_runs(law: Named<Law>, family: Named<Family>, table: RunTable) -> Answer {
    let (width, runs) = table;
    answer(|| analysis::fit_law_to_runs(law.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn fit_law_to_runs_in_windows(
    law: Named<Law>,
    family: Named<Family>,
    table: RunTable,
) -> Answer {
    let (width, runs) = table;
    answer(|| analysis::fit_law_to_runs_in_windows(law.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn compare_laws(
    laws: Named<Vec<Law>>,
    family: Named<Family>,
    table: RunTable,
) -> Answer {
    let (width, runs) = table;
    answer(|| analysis::compare_laws(&laws.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn compare_laws_with_scatter(laws: Named<Vec<Law>>, table: RunTable) -> Answer {
    answer(|| analysis::compare_laws_with_scatter(&laws.0, &table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn fit_law_with_scatter(table: RunTable) -> Answer {
    answer(|| analysis::fit_law_with_scatter(&table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn ensembles_by_width(family: Named<Family>, table: RunTable) -> Answer {
    answer(|| analysis::ensembles_by_width(family.0, &table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn fraction_crossing(runs: Outcomes) -> Answer {
    answer(|| analysis::fraction_crossing(&runs.0, &runs.1))
}

#[pyfunction]
pub(crate) fn hysteresis(rest: Outcomes, jammed: Outcomes) -> Answer {
    answer(|| analysis::hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1)))
}

/// Columns of width, value and error of either branch.
#[pyfunction]
pub(crate) fn jump_height(upper: [Column; 3], lower: [Column; 3], critical: (f64, f64)) -> Answer {
    let [upper, lower] = [&upper, &lower].map(|branch| branch.each_ref().map(Column::deref));
    answer(|| analysis::jump_height(upper, lower, uncertain(critical)))
}

#[pyfunction]
pub(crate) fn dip_test(values: Column, resamples: usize, seed: u64) -> Answer {
    answer(|| analysis::dip_test(&values, Bootstrap::new(resamples, seed)))
}

#[pyfunction]
pub(crate) fn two_peaks(values: Column) -> Answer {
    answer(|| analysis::two_peaks(&values))
}

#[pyfunction]
pub(crate) fn fit_inverse_line(width: Column, value: Column, error: Column) -> Answer {
    answer(|| analysis::fit_inverse_line(&width, &value, &error))
}

#[pyfunction]
pub(crate) fn fit_inverse_parabola(width: Column, value: Column, error: Column) -> Answer {
    answer(|| analysis::fit_inverse_parabola(&width, &value, &error))
}

#[pyfunction]
pub(crate) fn fit_line_to_scatter(x: Column, y: Column) -> Answer {
    answer(|| analysis::fit_line_to_scatter(&x, &y))
}

#[pyfunction]
pub(crate) fn fit_line(x: Column, y: Column, error: Column) -> Answer {
    answer(|| analysis::fit_line(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn fit_parabola(x: Column, y: Column, error: Column) -> Answer {
    answer(|| analysis::fit_parabola(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn power_exponent(x: Column, y: Column, error: Column) -> Answer {
    answer(|| analysis::power_exponent(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn ensemble_moments(replicates: Vec<Column>) -> Answer {
    answer(|| analysis::ensemble_moments(&replicates))
}

#[pyfunction]
#[pyo3(signature = (runs, held=None))]
pub(crate) fn second_moment(runs: Vec<Column>, held: Option<usize>) -> Answer {
    answer(|| analysis::second_moment(&runs, after_end(held)))
}

#[pyfunction]
#[pyo3(signature = (runs, held, resamples, seed))]
pub(crate) fn second_moment_peak(
    runs: Vec<Column>,
    held: Option<usize>,
    resamples: usize,
    seed: u64,
) -> Answer {
    answer(|| analysis::second_moment_peak(&runs, after_end(held), Bootstrap::new(resamples, seed)))
}

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

/// What a scaling of the caller's answered.
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

/// Best parameters with errors: (estimate, parameters with one curve left out in turn).
#[pyfunction]
pub(crate) fn fit_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    search: Search,
) -> Answer {
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    scheme.check(search.start.len(), curves.len())?;
    scheme.check(search.steps.len(), curves.len())?;
    let collapse = Collapse {
        curves: &curves,
        transform: &|parameters, curve, parameter, point| {
            scheme.apply(parameters, curve, parameter, point)
        },
        least_overlap: search.least_overlap,
    };
    let work = || {
        let (start, steps) = (&search.start, &search.steps);
        let (starts, seed, correction) = (search.starts, search.seed, search.correction);
        let known = search.known();
        let found = collapse.estimate_knowing(&known, start, steps, starts, seed, correction)?;
        let values = found.parameters.iter().map(|parameter| parameter.value);
        let left_out = if search.leave_one_out {
            let best: Vec<f64> = values.collect();
            collapse.estimates_without_each(&best, steps, starts, seed, correction)?
        } else {
            Vec::new()
        };
        Ok((found, left_out))
    };
    let outcome = work();
    let found = scheme.outcome(outcome)?;
    Ok(pythonize(py, &found)?.unbind())
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
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    scheme.check(search.steps.len(), curves.len())?;
    let collapse = Collapse {
        curves: &curves,
        transform: &|parameters, curve, parameter, point| {
            scheme.apply(parameters, curve, parameter, point)
        },
        least_overlap: search.least_overlap,
    };
    let outcome = collapse.joint_test(&search.known(), &found.0, &search.steps, &claimed);
    let found = scheme.outcome(outcome)?;
    Ok(pythonize(py, &found)?.unbind())
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
