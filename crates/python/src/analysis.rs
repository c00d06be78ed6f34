//! The estimators, on NumPy arrays; answers are dictionaries, of which `peristalsis.analysis` makes its result objects.

use std::cell::RefCell;

use numpy::PyReadonlyArray1;
use peristalsis_analysis as analysis;
use peristalsis_analysis::{
    AfterEnd, Bootstrap, Collapse, Curve, CurvePoint, Direction, Family, Law, Scaling, Survival,
    Transition, Uncertain,
};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{AnalysisError, of_analysis};

type Answer<'py> = PyResult<Bound<'py, PyAny>>;

/// A column of numbers, from an array of NumPy.
pub(crate) struct Column(Vec<f64>);

impl FromPyObject<'_, '_> for Column {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let array: PyReadonlyArray1<'_, f64> = object.extract()?;
        Ok(Self(array.as_slice()?.to_vec()))
    }
}

/// Outcomes of runs, from the columns (time, observed): the time of the transition, or of the end of a run without one.
pub(crate) struct Runs(Vec<Transition>);

impl FromPyObject<'_, '_> for Runs {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let (Column(time), observed): (Column, Vec<bool>) = object.extract()?;
        let outcome = |(time, observed)| match observed {
            // No estimator of these asks for the period.
            true => Transition::At { time, period: 0 },
            false => Transition::Censored { time },
        };
        Ok(Self(time.into_iter().zip(observed).map(outcome).collect()))
    }
}

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
fn answer<'py, T: Serialize + Send>(
    py: Python<'py>,
    work: impl FnOnce() -> Result<T, analysis::Error> + Send,
) -> Answer<'py> {
    let value = py.detach(work).map_err(of_analysis)?;
    Ok(pythonize(py, &value)?)
}

fn uncertain((value, error): (f64, f64)) -> Uncertain {
    Uncertain::normal(value, error)
}

fn series(columns: &[Column]) -> Vec<&[f64]> {
    columns.iter().map(|column| column.0.as_slice()).collect()
}

/// What stands for runs that ended early: the mean of so many last samples, or nothing.
fn after_end(held: Option<usize>) -> AfterEnd {
    held.map_or(AfterEnd::Leave, |samples| AfterEnd::Hold { samples })
}

#[pyfunction]
pub(crate) fn mean_with_error<'py>(py: Python<'py>, series: Column) -> Answer<'py> {
    answer(py, || analysis::mean_with_error(&series.0))
}

#[pyfunction]
pub(crate) fn autocorrelation_time<'py>(py: Python<'py>, series: Column) -> Answer<'py> {
    answer(py, || analysis::autocorrelation_time(&series.0))
}

#[pyfunction]
pub(crate) fn stationary_mean<'py>(py: Python<'py>, series: Column) -> Answer<'py> {
    answer(py, || analysis::stationary_mean(&series.0))
}

#[pyfunction]
pub(crate) fn stationarity<'py>(py: Python<'py>, series: Column) -> Answer<'py> {
    answer(py, || analysis::stationarity(&series.0))
}

/// Time of the transition in a series of period averages, and whether there was one.
#[pyfunction]
pub(crate) fn transition_time(
    averages: Column,
    direction: Named<Direction>,
    threshold: f64,
    period_duration: f64,
) -> PyResult<(f64, bool)> {
    let means = analysis::PeriodMeans {
        first_period: 0,
        means: averages.0,
    };
    let found = analysis::transition_time(&means, direction.0, threshold, period_duration);
    Ok(match found.map_err(of_analysis)? {
        Transition::At { time, .. } => (time, true),
        Transition::Censored { time } => (time, false),
    })
}

#[pyfunction]
pub(crate) fn survival<'py>(py: Python<'py>, runs: Runs) -> Answer<'py> {
    answer(py, || Survival::new(&runs.0))
}

#[pyfunction]
pub(crate) fn survival_median<'py>(py: Python<'py>, runs: Runs) -> Answer<'py> {
    answer(py, || Survival::new(&runs.0)?.median())
}

#[pyfunction]
pub(crate) fn restricted_moments<'py>(py: Python<'py>, runs: Runs, horizon: f64) -> Answer<'py> {
    answer(py, || analysis::restricted_moments(&runs.0, horizon))
}

#[pyfunction]
pub(crate) fn fit_lifetime<'py>(py: Python<'py>, family: Named<Family>, runs: Runs) -> Answer<'py> {
    answer(py, || analysis::fit_lifetime(family.0, &runs.0))
}

#[pyfunction]
pub(crate) fn fit_shifted_exponential<'py>(py: Python<'py>, runs: Runs) -> Answer<'py> {
    answer(py, || analysis::fit_shifted_exponential(&runs.0))
}

#[pyfunction]
#[pyo3(signature = (law, width, value, error, known=None))]
pub(crate) fn fit_law<'py>(
    py: Python<'py>,
    law: Named<Law>,
    width: Column,
    value: Column,
    error: Column,
    known: Option<(f64, f64)>,
) -> Answer<'py> {
    answer(py, || {
        analysis::fit_law(law.0, &width.0, &value.0, &error.0, known.map(uncertain))
    })
}

#[pyfunction]
pub(crate) fn fit_law_to_runs<'py>(
    py: Python<'py>,
    law: Named<Law>,
    family: Named<Family>,
    width: Column,
    runs: Runs,
) -> Answer<'py> {
    answer(py, || {
        analysis::fit_law_to_runs(law.0, family.0, &width.0, &runs.0)
    })
}

#[pyfunction]
pub(crate) fn fit_law_to_runs_in_windows<'py>(
    py: Python<'py>,
    law: Named<Law>,
    family: Named<Family>,
    width: Column,
    runs: Runs,
) -> Answer<'py> {
    answer(py, || {
        analysis::fit_law_to_runs_in_windows(law.0, family.0, &width.0, &runs.0)
    })
}

#[pyfunction]
pub(crate) fn compare_laws<'py>(
    py: Python<'py>,
    laws: Named<Vec<Law>>,
    family: Named<Family>,
    width: Column,
    runs: Runs,
) -> Answer<'py> {
    answer(py, || {
        analysis::compare_laws(&laws.0, family.0, &width.0, &runs.0)
    })
}

#[pyfunction]
pub(crate) fn fit_law_with_scatter<'py>(py: Python<'py>, width: Column, runs: Runs) -> Answer<'py> {
    answer(py, || analysis::fit_law_with_scatter(&width.0, &runs.0))
}

#[pyfunction]
pub(crate) fn ensembles_by_width<'py>(
    py: Python<'py>,
    family: Named<Family>,
    width: Column,
    runs: Runs,
) -> Answer<'py> {
    answer(py, || {
        analysis::ensembles_by_width(family.0, &width.0, &runs.0)
    })
}

#[pyfunction]
pub(crate) fn fraction_crossing<'py>(
    py: Python<'py>,
    width: Column,
    jammed: Vec<bool>,
) -> Answer<'py> {
    answer(py, || analysis::fraction_crossing(&width.0, &jammed))
}

#[pyfunction]
pub(crate) fn hysteresis<'py>(
    py: Python<'py>,
    rest: (Column, Vec<bool>),
    jammed: (Column, Vec<bool>),
) -> Answer<'py> {
    answer(py, || {
        analysis::hysteresis((&rest.0.0, &rest.1), (&jammed.0.0, &jammed.1))
    })
}

/// Columns of width, value and error of either branch.
#[pyfunction]
pub(crate) fn jump_height<'py>(
    py: Python<'py>,
    upper: [Column; 3],
    lower: [Column; 3],
    critical: (f64, f64),
) -> Answer<'py> {
    let [upper, lower] =
        [&upper, &lower].map(|branch| branch.each_ref().map(|column| column.0.as_slice()));
    answer(py, || {
        analysis::jump_height(upper, lower, uncertain(critical))
    })
}

#[pyfunction]
pub(crate) fn dip_test<'py>(
    py: Python<'py>,
    values: Column,
    resamples: usize,
    seed: u64,
) -> Answer<'py> {
    answer(py, || {
        analysis::dip_test(&values.0, Bootstrap { resamples, seed })
    })
}

#[pyfunction]
pub(crate) fn two_peaks<'py>(py: Python<'py>, values: Column) -> Answer<'py> {
    answer(py, || analysis::two_peaks(&values.0))
}

#[pyfunction]
pub(crate) fn fit_line<'py>(py: Python<'py>, x: Column, y: Column, error: Column) -> Answer<'py> {
    answer(py, || analysis::fit_line(&x.0, &y.0, &error.0))
}

#[pyfunction]
pub(crate) fn fit_parabola<'py>(
    py: Python<'py>,
    x: Column,
    y: Column,
    error: Column,
) -> Answer<'py> {
    answer(py, || analysis::fit_parabola(&x.0, &y.0, &error.0))
}

#[pyfunction]
pub(crate) fn power_exponent<'py>(
    py: Python<'py>,
    x: Column,
    y: Column,
    error: Column,
) -> Answer<'py> {
    answer(py, || analysis::power_exponent(&x.0, &y.0, &error.0))
}

#[pyfunction]
pub(crate) fn ensemble_moments<'py>(py: Python<'py>, replicas: Vec<Column>) -> Answer<'py> {
    answer(py, || analysis::ensemble_moments(&series(&replicas)))
}

#[pyfunction]
#[pyo3(signature = (runs, held=None))]
pub(crate) fn second_moment<'py>(
    py: Python<'py>,
    runs: Vec<Column>,
    held: Option<usize>,
) -> Answer<'py> {
    answer(py, || {
        analysis::second_moment(&series(&runs), after_end(held))
    })
}

#[pyfunction]
#[pyo3(signature = (runs, held, resamples, seed))]
pub(crate) fn second_moment_peak<'py>(
    py: Python<'py>,
    runs: Vec<Column>,
    held: Option<usize>,
    resamples: usize,
    seed: u64,
) -> Answer<'py> {
    let bootstrap = Bootstrap { resamples, seed };
    answer(py, || {
        analysis::second_moment_peak(&series(&runs), after_end(held), bootstrap)
    })
}

/// A curve, from its parameter and its columns (x, y, error).
pub(crate) struct Measured(Curve);

impl FromPyObject<'_, '_> for Measured {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let (parameter, Column(x), Column(y), Column(error)) = object.extract()?;
        let points = x.into_iter().zip(y).zip(error);
        let points = points
            .map(|((x, y), error)| CurvePoint { x, y, error })
            .collect();
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

impl Scheme<'_> {
    fn apply(
        &self,
        parameters: &[f64],
        curve: usize,
        parameter: f64,
        point: CurvePoint,
    ) -> CurvePoint {
        let nowhere = CurvePoint {
            x: f64::NAN,
            y: f64::NAN,
            error: f64::NAN,
        };
        match self {
            Self::Named(scaling) => scaling.apply(parameters, curve, parameter, point),
            Self::Called { raised, .. } if raised.borrow().is_some() => nowhere,
            Self::Called { function, raised } => {
                let arguments = (
                    parameters.to_vec(),
                    parameter,
                    point.x,
                    point.y,
                    point.error,
                );
                // A search asks often and long: Ctrl-C is heard on the way.
                let scaled = function
                    .py()
                    .check_signals()
                    .and_then(|()| function.call1(arguments)?.extract::<(f64, f64, f64)>());
                match scaled {
                    Ok((x, y, error)) => CurvePoint { x, y, error },
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
    resamples: usize,
    leave_one_out: bool,
}

/// Best parameters with errors: (fit, resampled or None, contour, fits with one curve left out).
#[pyfunction]
pub(crate) fn fit_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    search: Search,
) -> Answer<'py> {
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    let collapse = Collapse {
        curves: &curves,
        transform: &|parameters, curve, parameter, point| {
            scheme.apply(parameters, curve, parameter, point)
        },
        least_overlap: search.least_overlap,
    };
    let work = || {
        let (start, steps) = (&search.start, &search.steps);
        let fit = collapse.fit(start, steps, search.starts, search.seed)?;
        let bootstrap = Bootstrap {
            resamples: search.resamples,
            seed: search.seed,
        };
        let resampled = (search.resamples > 0)
            .then(|| collapse.bootstrap(&fit, steps, bootstrap))
            .transpose()?;
        let contour = collapse.contour(&fit, steps)?;
        let left_out = if search.leave_one_out {
            collapse.leave_one_out(&fit.parameters, steps, search.starts, search.seed)?
        } else {
            Vec::new()
        };
        Ok((fit, resampled, contour, left_out))
    };
    let outcome = work();
    let found = scheme.outcome(outcome)?;
    Ok(pythonize(py, &found)?)
}

/// How well curves collapse as they are scaled with given parameters: (quality, scaled curves).
#[pyfunction]
pub(crate) fn apply_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured>,
    scheme: Scheme<'py>,
    parameters: Vec<f64>,
) -> Answer<'py> {
    let curves: Vec<Curve> = measured.into_iter().map(|curve| curve.0).collect();
    let scaled: Vec<Vec<CurvePoint>> = curves
        .iter()
        .enumerate()
        .map(|(place, curve)| {
            let points = curve.points.iter();
            points
                .map(|point| scheme.apply(&parameters, place, curve.parameter, *point))
                .collect()
        })
        .collect();
    let quality = scheme.outcome(analysis::collapse_quality(&scaled))?;
    let columns: Vec<[Vec<f64>; 3]> = scaled
        .iter()
        .map(|points| {
            let picks: [fn(&CurvePoint) -> f64; 3] = [|it| it.x, |it| it.y, |it| it.error];
            picks.map(|pick| points.iter().map(pick).collect())
        })
        .collect();
    Ok(pythonize(py, &(quality, columns))?)
}
