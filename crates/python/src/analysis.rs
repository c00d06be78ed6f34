//! The estimators, on NumPy arrays; answers are dictionaries, of which `peristalsis.analysis` makes its result objects.

use std::cell::RefCell;

use numpy::PyReadonlyArray1;
use peristalsis_analysis as analysis;
use peristalsis_analysis::{
    AfterEnd, Bootstrap, Collapse, Curve, CurvePoint, Family, Law, Scaling, Survival, Transition,
    Uncertain,
};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Serialize;

use crate::error::of_analysis;

type Reals<'py> = PyReadonlyArray1<'py, f64>;
type Truths<'py> = PyReadonlyArray1<'py, bool>;
type Answer<'py> = PyResult<Bound<'py, PyAny>>;
/// A curve as Python hands it over: its parameter, x, y, errors.
type Measured<'py> = (f64, Reals<'py>, Reals<'py>, Reals<'py>);

/// Computes without the interpreter and hands the answer over.
fn answer<'py, T: Serialize + Send>(
    py: Python<'py>,
    work: impl FnOnce() -> Result<T, analysis::Error> + Send,
) -> Answer<'py> {
    let value = py.detach(work).map_err(of_analysis)?;
    Ok(pythonize(py, &value)?)
}

fn vector(array: &Reals<'_>) -> PyResult<Vec<f64>> {
    Ok(array.as_slice()?.to_vec())
}

fn truths(array: &Truths<'_>) -> PyResult<Vec<bool>> {
    Ok(array.as_slice()?.to_vec())
}

/// Times of transitions, and of the ends of runs without one.
fn transitions(time: &Reals<'_>, observed: &Truths<'_>) -> PyResult<Vec<Transition>> {
    let (time, observed) = (time.as_slice()?, observed.as_slice()?);
    Ok(time
        .iter()
        .zip(observed)
        .map(|(&time, &observed)| match observed {
            // Which period it was matters to none of these estimators.
            true => Transition::At { time, period: 0 },
            false => Transition::Censored { time },
        })
        .collect())
}

/// A value of one of our enumerations by its name.
fn named<'py, T: for<'a> serde::Deserialize<'a>>(name: &Bound<'py, PyAny>) -> PyResult<T> {
    depythonize(name).map_err(|error| crate::error::AnalysisError::new_err(error.to_string()))
}

fn uncertain(pair: (f64, f64)) -> Uncertain {
    Uncertain::normal(pair.0, pair.1)
}

#[pyfunction]
fn mean_with_error<'py>(py: Python<'py>, series: Reals<'py>) -> Answer<'py> {
    let series = vector(&series)?;
    answer(py, || analysis::mean_with_error(&series))
}

#[pyfunction]
fn autocorrelation_time<'py>(py: Python<'py>, series: Reals<'py>) -> Answer<'py> {
    let series = vector(&series)?;
    answer(py, || analysis::autocorrelation_time(&series))
}

#[pyfunction]
fn stationary_mean<'py>(py: Python<'py>, series: Reals<'py>) -> Answer<'py> {
    let series = vector(&series)?;
    answer(py, || analysis::stationary_mean(&series))
}

#[pyfunction]
fn stationarity<'py>(py: Python<'py>, series: Reals<'py>) -> Answer<'py> {
    let series = vector(&series)?;
    answer(py, || analysis::stationarity(&series))
}

/// Time of the transition in a series of period averages, and whether there was one.
#[pyfunction]
fn transition_time(
    averages: Reals<'_>,
    direction: &Bound<'_, PyAny>,
    threshold: f64,
    period_duration: f64,
) -> PyResult<(f64, bool)> {
    let means = analysis::PeriodMeans {
        first_period: 0,
        means: vector(&averages)?,
    };
    let direction = named(direction)?;
    let found = analysis::transition_time(&means, direction, threshold, period_duration);
    Ok(match found.map_err(of_analysis)? {
        Transition::At { time, .. } => (time, true),
        Transition::Censored { time } => (time, false),
    })
}

#[pyfunction]
fn survival<'py>(py: Python<'py>, time: Reals<'py>, observed: Truths<'py>) -> Answer<'py> {
    let runs = transitions(&time, &observed)?;
    answer(py, || Survival::new(&runs))
}

#[pyfunction]
fn survival_median<'py>(py: Python<'py>, time: Reals<'py>, observed: Truths<'py>) -> Answer<'py> {
    let runs = transitions(&time, &observed)?;
    answer(py, || Survival::new(&runs)?.median())
}

#[pyfunction]
fn restricted_moments<'py>(
    py: Python<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
    horizon: f64,
) -> Answer<'py> {
    let runs = transitions(&time, &observed)?;
    answer(py, || analysis::restricted_moments(&runs, horizon))
}

#[pyfunction]
fn fit_lifetime<'py>(
    py: Python<'py>,
    family: &Bound<'py, PyAny>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let (family, runs): (Family, _) = (named(family)?, transitions(&time, &observed)?);
    answer(py, || analysis::fit_lifetime(family, &runs))
}

#[pyfunction]
fn fit_shifted_exponential<'py>(
    py: Python<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let runs = transitions(&time, &observed)?;
    answer(py, || analysis::fit_shifted_exponential(&runs))
}

#[pyfunction]
#[pyo3(signature = (law, width, value, error, known=None))]
fn fit_law<'py>(
    py: Python<'py>,
    law: &Bound<'py, PyAny>,
    width: Reals<'py>,
    value: Reals<'py>,
    error: Reals<'py>,
    known: Option<(f64, f64)>,
) -> Answer<'py> {
    let law: Law = named(law)?;
    let (width, value, error) = (vector(&width)?, vector(&value)?, vector(&error)?);
    answer(py, || {
        analysis::fit_law(law, &width, &value, &error, known.map(uncertain))
    })
}

#[pyfunction]
fn fit_law_to_runs<'py>(
    py: Python<'py>,
    law: &Bound<'py, PyAny>,
    family: &Bound<'py, PyAny>,
    width: Reals<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let (law, family): (Law, Family) = (named(law)?, named(family)?);
    let (width, runs) = (vector(&width)?, transitions(&time, &observed)?);
    answer(py, || analysis::fit_law_to_runs(law, family, &width, &runs))
}

#[pyfunction]
fn compare_laws<'py>(
    py: Python<'py>,
    laws: Vec<Bound<'py, PyAny>>,
    family: &Bound<'py, PyAny>,
    width: Reals<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let laws: Vec<Law> = laws.iter().map(named).collect::<PyResult<_>>()?;
    let family: Family = named(family)?;
    let (width, runs) = (vector(&width)?, transitions(&time, &observed)?);
    answer(py, || analysis::compare_laws(&laws, family, &width, &runs))
}

#[pyfunction]
fn fit_law_to_runs_in_windows<'py>(
    py: Python<'py>,
    law: &Bound<'py, PyAny>,
    family: &Bound<'py, PyAny>,
    width: Reals<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let (law, family): (Law, Family) = (named(law)?, named(family)?);
    let (width, runs) = (vector(&width)?, transitions(&time, &observed)?);
    answer(py, || {
        analysis::fit_law_to_runs_in_windows(law, family, &width, &runs)
    })
}

#[pyfunction]
fn fit_law_with_scatter<'py>(
    py: Python<'py>,
    width: Reals<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let (width, runs) = (vector(&width)?, transitions(&time, &observed)?);
    answer(py, || analysis::fit_law_with_scatter(&width, &runs))
}

#[pyfunction]
fn ensembles_by_width<'py>(
    py: Python<'py>,
    family: &Bound<'py, PyAny>,
    width: Reals<'py>,
    time: Reals<'py>,
    observed: Truths<'py>,
) -> Answer<'py> {
    let family: Family = named(family)?;
    let (width, runs) = (vector(&width)?, transitions(&time, &observed)?);
    answer(py, || analysis::ensembles_by_width(family, &width, &runs))
}

#[pyfunction]
fn fraction_crossing<'py>(py: Python<'py>, width: Reals<'py>, jammed: Truths<'py>) -> Answer<'py> {
    let (width, jammed) = (vector(&width)?, truths(&jammed)?);
    answer(py, || analysis::fraction_crossing(&width, &jammed))
}

#[pyfunction]
fn hysteresis<'py>(
    py: Python<'py>,
    rest: (Reals<'py>, Truths<'py>),
    jammed: (Reals<'py>, Truths<'py>),
) -> Answer<'py> {
    let rest = (vector(&rest.0)?, truths(&rest.1)?);
    let jammed = (vector(&jammed.0)?, truths(&jammed.1)?);
    answer(py, || {
        analysis::hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1))
    })
}

#[pyfunction]
fn jump_height<'py>(
    py: Python<'py>,
    upper: [Reals<'py>; 3],
    lower: [Reals<'py>; 3],
    critical: (f64, f64),
) -> Answer<'py> {
    let vectors = |branch: &[Reals<'_>; 3]| -> PyResult<[Vec<f64>; 3]> {
        Ok([
            vector(&branch[0])?,
            vector(&branch[1])?,
            vector(&branch[2])?,
        ])
    };
    let (upper, lower) = (vectors(&upper)?, vectors(&lower)?);
    answer(py, || {
        analysis::jump_height(
            [&upper[0], &upper[1], &upper[2]],
            [&lower[0], &lower[1], &lower[2]],
            uncertain(critical),
        )
    })
}

#[pyfunction]
fn dip_test<'py>(py: Python<'py>, values: Reals<'py>, resamples: usize, seed: u64) -> Answer<'py> {
    let values = vector(&values)?;
    answer(py, || {
        analysis::dip_test(&values, Bootstrap { resamples, seed })
    })
}

#[pyfunction]
fn two_peaks<'py>(py: Python<'py>, values: Reals<'py>) -> Answer<'py> {
    let values = vector(&values)?;
    answer(py, || analysis::two_peaks(&values))
}

#[pyfunction]
fn fit_line<'py>(py: Python<'py>, x: Reals<'py>, y: Reals<'py>, error: Reals<'py>) -> Answer<'py> {
    let (x, y, error) = (vector(&x)?, vector(&y)?, vector(&error)?);
    answer(py, || analysis::fit_line(&x, &y, &error))
}

#[pyfunction]
fn fit_parabola<'py>(
    py: Python<'py>,
    x: Reals<'py>,
    y: Reals<'py>,
    error: Reals<'py>,
) -> Answer<'py> {
    let (x, y, error) = (vector(&x)?, vector(&y)?, vector(&error)?);
    answer(py, || analysis::fit_parabola(&x, &y, &error))
}

#[pyfunction]
fn power_exponent<'py>(
    py: Python<'py>,
    x: Reals<'py>,
    y: Reals<'py>,
    error: Reals<'py>,
) -> Answer<'py> {
    let (x, y, error) = (vector(&x)?, vector(&y)?, vector(&error)?);
    answer(py, || analysis::power_exponent(&x, &y, &error))
}

#[pyfunction]
fn ensemble_moments<'py>(py: Python<'py>, replicas: Vec<Reals<'py>>) -> Answer<'py> {
    let replicas: Vec<Vec<f64>> = replicas.iter().map(vector).collect::<PyResult<_>>()?;
    answer(py, || analysis::ensemble_moments(&replicas))
}

/// What stands for runs that ended early: the mean of so many last samples, or nothing.
fn after_end(held: Option<usize>) -> AfterEnd {
    held.map_or(AfterEnd::Leave, |samples| AfterEnd::Hold { samples })
}

#[pyfunction]
fn second_moment<'py>(py: Python<'py>, runs: Vec<Reals<'py>>, held: Option<usize>) -> Answer<'py> {
    let runs: Vec<Vec<f64>> = runs.iter().map(vector).collect::<PyResult<_>>()?;
    answer(py, || analysis::second_moment(&runs, after_end(held)))
}

#[pyfunction]
fn second_moment_peak<'py>(
    py: Python<'py>,
    runs: Vec<Reals<'py>>,
    held: Option<usize>,
    resamples: usize,
    seed: u64,
) -> Answer<'py> {
    let runs: Vec<Vec<f64>> = runs.iter().map(vector).collect::<PyResult<_>>()?;
    answer(py, || {
        analysis::second_moment_peak(&runs, after_end(held), Bootstrap { resamples, seed })
    })
}

/// Curves as the estimators take them.
fn curves(measured: &[Measured<'_>]) -> PyResult<Vec<Curve>> {
    measured
        .iter()
        .map(|(parameter, x, y, error)| {
            let (x, y, error) = (x.as_slice()?, y.as_slice()?, error.as_slice()?);
            let points = x.iter().zip(y).zip(error);
            Ok(Curve {
                parameter: *parameter,
                points: points
                    .map(|((&x, &y), &error)| CurvePoint { x, y, error })
                    .collect(),
            })
        })
        .collect()
}

/// A scaling: one of ours by its name, or a function of Python.
enum Scheme<'py> {
    Named(Scaling),
    Called {
        function: Bound<'py, PyAny>,
        /// The first exception that it raised.
        raised: RefCell<Option<PyErr>>,
    },
}

impl<'py> Scheme<'py> {
    fn new(scaling: &Bound<'py, PyAny>) -> PyResult<Self> {
        Ok(if scaling.is_callable() {
            Self::Called {
                function: scaling.clone(),
                raised: RefCell::new(None),
            }
        } else {
            Self::Named(named(scaling)?)
        })
    }

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
struct Search {
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
fn fit_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured<'py>>,
    scaling: &Bound<'py, PyAny>,
    search: Search,
) -> Answer<'py> {
    let (curves, scheme) = (curves(&measured)?, Scheme::new(scaling)?);
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
fn apply_collapse<'py>(
    py: Python<'py>,
    measured: Vec<Measured<'py>>,
    scaling: &Bound<'py, PyAny>,
    parameters: Vec<f64>,
) -> Answer<'py> {
    let (curves, scheme) = (curves(&measured)?, Scheme::new(scaling)?);
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
            [
                points.iter().map(|point| point.x).collect(),
                points.iter().map(|point| point.y).collect(),
                points.iter().map(|point| point.error).collect(),
            ]
        })
        .collect();
    Ok(pythonize(py, &(quality, columns))?)
}

/// Adds the functions to the module.
pub(crate) fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(mean_with_error, module)?)?;
    module.add_function(wrap_pyfunction!(autocorrelation_time, module)?)?;
    module.add_function(wrap_pyfunction!(stationary_mean, module)?)?;
    module.add_function(wrap_pyfunction!(stationarity, module)?)?;
    module.add_function(wrap_pyfunction!(transition_time, module)?)?;
    module.add_function(wrap_pyfunction!(survival, module)?)?;
    module.add_function(wrap_pyfunction!(survival_median, module)?)?;
    module.add_function(wrap_pyfunction!(restricted_moments, module)?)?;
    module.add_function(wrap_pyfunction!(fit_lifetime, module)?)?;
    module.add_function(wrap_pyfunction!(fit_shifted_exponential, module)?)?;
    module.add_function(wrap_pyfunction!(fit_law, module)?)?;
    module.add_function(wrap_pyfunction!(fit_law_to_runs, module)?)?;
    module.add_function(wrap_pyfunction!(compare_laws, module)?)?;
    module.add_function(wrap_pyfunction!(fit_law_to_runs_in_windows, module)?)?;
    module.add_function(wrap_pyfunction!(fit_law_with_scatter, module)?)?;
    module.add_function(wrap_pyfunction!(ensembles_by_width, module)?)?;
    module.add_function(wrap_pyfunction!(second_moment, module)?)?;
    module.add_function(wrap_pyfunction!(second_moment_peak, module)?)?;
    module.add_function(wrap_pyfunction!(fraction_crossing, module)?)?;
    module.add_function(wrap_pyfunction!(hysteresis, module)?)?;
    module.add_function(wrap_pyfunction!(jump_height, module)?)?;
    module.add_function(wrap_pyfunction!(dip_test, module)?)?;
    module.add_function(wrap_pyfunction!(two_peaks, module)?)?;
    module.add_function(wrap_pyfunction!(fit_line, module)?)?;
    module.add_function(wrap_pyfunction!(fit_parabola, module)?)?;
    module.add_function(wrap_pyfunction!(power_exponent, module)?)?;
    module.add_function(wrap_pyfunction!(ensemble_moments, module)?)?;
    module.add_function(wrap_pyfunction!(fit_collapse, module)?)?;
    module.add_function(wrap_pyfunction!(apply_collapse, module)?)
}
