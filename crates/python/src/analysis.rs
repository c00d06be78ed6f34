//! The estimators, on NumPy arrays; answers are dictionaries, of which `peristalsis.analysis` makes its result objects.

use std::ops::Deref;

use numpy::PyReadonlyArray1;
use peristalsis_analysis as analysis;
use peristalsis_analysis::{
    AfterEnd, Bootstrap, Direction, Family, Law, Survival, Transition, Uncertain,
};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{AnalysisError, of_analysis};
use crate::heard::heard;

pub(crate) type Answer = PyResult<Py<PyAny>>;

/// A column of numbers, from an array of NumPy.
pub(crate) struct Column(pub(crate) Vec<f64>);

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
pub(crate) struct Named<T>(pub(crate) T);

impl<T: DeserializeOwned> FromPyObject<'_, '_> for Named<T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        depythonize(&object)
            .map(Self)
            .map_err(|error| AnalysisError::new_err(error.to_string()))
    }
}

/// Computes without the interpreter and hands the answer over.
fn answer<T: Serialize + Send + 'static>(
    work: impl FnOnce() -> Result<T, analysis::Error> + Send + 'static,
) -> Answer {
    Python::attach(|py| {
        let value = heard(py, work)?.map_err(of_analysis)?;
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
    answer(move || analysis::mean_with_error(&series))
}

#[pyfunction]
pub(crate) fn autocorrelation_time(series: Column) -> Answer {
    answer(move || analysis::autocorrelation_time(&series))
}

#[pyfunction]
pub(crate) fn stationary_mean(series: Column) -> Answer {
    answer(move || analysis::stationary_mean(&series))
}

#[pyfunction]
pub(crate) fn stationarity(series: Column) -> Answer {
    answer(move || analysis::stationarity(&series))
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
    answer(move || Survival::new(&runs.0))
}

#[pyfunction]
pub(crate) fn survival_median(runs: Runs) -> Answer {
    answer(move || Survival::new(&runs.0)?.median())
}

#[pyfunction]
pub(crate) fn restricted_moments(runs: Runs, horizon: f64) -> Answer {
    answer(move || analysis::restricted_moments(&runs.0, horizon))
}

#[pyfunction]
pub(crate) fn fit_lifetime(family: Named<Family>, runs: Runs) -> Answer {
    answer(move || analysis::fit_lifetime(family.0, &runs.0))
}

#[pyfunction]
pub(crate) fn fit_shifted_exponential(runs: Runs) -> Answer {
    answer(move || analysis::fit_shifted_exponential(&runs.0))
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
    answer(move || analysis::fit_law(law.0, &width, &value, &error, known.map(uncertain)))
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
    answer(move || {
        analysis::fit_law_to_nearest(law.0, &width, &value, &error, known.map(uncertain))
    })
}

#[pyfunction]
pub(crate) fn fit_law_to_runs(law: Named<Law>, family: Named<Family>, table: RunTable) -> Answer {
    let (width, runs) = table;
    answer(move || analysis::fit_law_to_runs(law.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn fit_law_to_runs_in_windows(
    law: Named<Law>,
    family: Named<Family>,
    table: RunTable,
) -> Answer {
    let (width, runs) = table;
    answer(move || analysis::fit_law_to_runs_in_windows(law.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn compare_laws(
    laws: Named<Vec<Law>>,
    family: Named<Family>,
    table: RunTable,
) -> Answer {
    let (width, runs) = table;
    answer(move || analysis::compare_laws(&laws.0, family.0, &width, &runs.0))
}

#[pyfunction]
pub(crate) fn compare_laws_with_scatter(laws: Named<Vec<Law>>, table: RunTable) -> Answer {
    answer(move || analysis::compare_laws_with_scatter(&laws.0, &table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn fit_law_with_scatter(table: RunTable) -> Answer {
    answer(move || analysis::fit_law_with_scatter(&table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn ensembles_by_width(family: Named<Family>, table: RunTable) -> Answer {
    answer(move || analysis::ensembles_by_width(family.0, &table.0, &table.1.0))
}

#[pyfunction]
pub(crate) fn fraction_crossing(runs: Outcomes) -> Answer {
    answer(move || analysis::fraction_crossing(&runs.0, &runs.1))
}

#[pyfunction]
pub(crate) fn hysteresis(rest: Outcomes, jammed: Outcomes) -> Answer {
    answer(move || analysis::hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1)))
}

/// Columns of width, value and error of either branch.
#[pyfunction]
pub(crate) fn jump_height(upper: [Column; 3], lower: [Column; 3], critical: (f64, f64)) -> Answer {
    answer(move || {
        let [upper, lower] = [&upper, &lower].map(|branch| branch.each_ref().map(Column::deref));
        analysis::jump_height(upper, lower, uncertain(critical))
    })
}

#[pyfunction]
pub(crate) fn dip_test(values: Column, resamples: usize, seed: u64) -> Answer {
    answer(move || analysis::dip_test(&values, Bootstrap::new(resamples, seed)))
}

#[pyfunction]
pub(crate) fn two_peaks(values: Column) -> Answer {
    answer(move || analysis::two_peaks(&values))
}

#[pyfunction]
pub(crate) fn fit_inverse_line(width: Column, value: Column, error: Column) -> Answer {
    answer(move || analysis::fit_inverse_line(&width, &value, &error))
}

#[pyfunction]
pub(crate) fn fit_inverse_parabola(width: Column, value: Column, error: Column) -> Answer {
    answer(move || analysis::fit_inverse_parabola(&width, &value, &error))
}

#[pyfunction]
pub(crate) fn fit_line_to_scatter(x: Column, y: Column, error: Column) -> Answer {
    answer(move || analysis::fit_line_to_scatter(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn fit_line(x: Column, y: Column, error: Column) -> Answer {
    answer(move || analysis::fit_line(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn fit_parabola(x: Column, y: Column, error: Column) -> Answer {
    answer(move || analysis::fit_parabola(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn power_exponent(x: Column, y: Column, error: Column) -> Answer {
    answer(move || analysis::power_exponent(&x, &y, &error))
}

#[pyfunction]
pub(crate) fn ensemble_moments(replicates: Vec<Column>) -> Answer {
    answer(move || analysis::ensemble_moments(&replicates))
}

#[pyfunction]
#[pyo3(signature = (runs, held=None))]
pub(crate) fn second_moment(runs: Vec<Column>, held: Option<usize>) -> Answer {
    answer(move || analysis::second_moment(&runs, after_end(held)))
}

#[pyfunction]
#[pyo3(signature = (runs, held, resamples, seed))]
pub(crate) fn second_moment_peak(
    runs: Vec<Column>,
    held: Option<usize>,
    resamples: usize,
    seed: u64,
) -> Answer {
    answer(move || {
        analysis::second_moment_peak(&runs, after_end(held), Bootstrap::new(resamples, seed))
    })
}
