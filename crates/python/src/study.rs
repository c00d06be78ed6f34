//! Studies: many runs, kept in a store.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use peristalsis_study::{Effort, Ending, Specification, Store, StudyError, work_on};
use pyo3::exceptions::PyFileNotFoundError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyList};

use crate::configuration::Configuration;
use crate::error::of_study;
use crate::table::Table;

/// Time between two checkpoints of a run.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

/// A study file that has been read and checked.
#[pyclass(frozen, module = "peristalsis._core")]
pub(crate) struct Study {
    specification: Specification,
}

#[pymethods]
impl Study {
    /// Reads a study from the text of its file; other files that it names are sought beside `name`.
    #[new]
    fn new(name: &str, text: &str) -> PyResult<Self> {
        let folder = Path::new(name).parent().unwrap_or(Path::new(""));
        Specification::from_toml(name, text, |file| {
            let path = folder.join(file);
            let text = std::fs::read_to_string(&path).map_err(StudyError::read(&path))?;
            Ok((path.display().to_string(), text))
        })
        .map(|specification| Self { specification })
        .map_err(of_study)
    }

    /// The study of a store.
    #[staticmethod]
    fn of_store(path: PathBuf) -> PyResult<Self> {
        let store = Store::open(&path).map_err(of_study)?;
        let specification = store.specification().map_err(of_study)?;
        Ok(Self { specification })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.specification.name
    }

    #[getter]
    fn title(&self) -> &str {
        &self.specification.title
    }

    /// The planned runs: (identity, replicate, settings of the point, configuration).
    #[allow(clippy::type_complexity, reason = "a row, as Python unpacks it")]
    fn plan<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Vec<(String, u32, Bound<'py, PyDict>, Configuration)>> {
        let plan = self.specification.plan();
        plan.sorted_runs()
            .iter()
            .map(|run| {
                let settings = PyDict::new(py);
                for setting in &plan.point(run).settings {
                    match (&setting.value, setting.value.number()) {
                        (_, Some(number)) => settings.set_item(&setting.key, number)?,
                        (value, None) => settings.set_item(&setting.key, value.to_string())?,
                    }
                }
                let inner = plan.configuration(run);
                let identity = run.identity.to_string();
                Ok((identity, run.replicate, settings, Configuration { inner }))
            })
            .collect()
    }

    /// Works on the study in a store; `watch` is called with (done, failed, total, part of the work, seconds left).
    ///
    /// Answers "complete", "stopped" or "time_up". What `watch` raises stops the work, every run saved.
    #[pyo3(signature = (store, workers, limit=None, watch=None))]
    fn work(
        &self,
        py: Python<'_>,
        store: PathBuf,
        workers: usize,
        limit: Option<f64>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<&'static str> {
        let effort = Effort {
            workers,
            checkpoint_interval: CHECKPOINT_INTERVAL,
            limit: limit.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
        };
        let stopped = AtomicBool::new(false);
        let mut raised = None;
        let ending = py.detach(|| {
            let store = Store::create(&store, &self.specification)?;
            work_on(
                &store,
                &self.specification,
                effort,
                &|| stopped.load(Ordering::Relaxed),
                &mut |board| {
                    let told = Python::attach(|py| {
                        py.check_signals()?;
                        let Some(watch) = &watch else { return Ok(()) };
                        let left = board.left.map(|left| left.as_secs_f64());
                        let state = (board.done, board.failed, board.total, board.fraction, left);
                        watch.call1(py, state).map(drop)
                    });
                    if let Err(error) = told {
                        stopped.store(true, Ordering::Relaxed);
                        raised.get_or_insert(error);
                    }
                },
            )
        });
        match (raised, ending.map_err(of_study)?) {
            (Some(error), _) => Err(error),
            (None, Ending::Complete) => Ok("complete"),
            (None, Ending::Stopped) => Ok("stopped"),
            (None, Ending::TimeUp) => Ok("time_up"),
        }
    }

    /// The runs of this study that are finished in a store, one a row.
    fn rows(&self, py: Python<'_>, store: PathBuf) -> PyResult<Table> {
        let rows = py.detach(|| self.store(&store)?.rows());
        Table::new(&rows.map_err(of_study)?)
    }

    /// How many runs of this study are in which state in a store.
    fn counts<'py>(&self, py: Python<'py>, store: PathBuf) -> PyResult<Bound<'py, PyDict>> {
        let survey = py.detach(|| self.store(&store)?.survey());
        let counts = survey.map_err(of_study)?.counts().into_iter();
        counts
            .map(|(state, number)| (state.name(), number))
            .into_py_dict(py)
    }

    /// Writes the tables of this study in a store as Parquet and CSV; answers the files.
    fn export<'py>(
        &self,
        py: Python<'py>,
        store: PathBuf,
        folder: PathBuf,
        series: bool,
    ) -> PyResult<Bound<'py, PyList>> {
        if !store.is_dir() {
            let text = format!("there is no store {}", store.display());
            return Err(PyFileNotFoundError::new_err(text));
        }
        let exported = py.detach(|| self.store(&store)?.export(&folder, series));
        PyList::new(py, exported.map_err(of_study)?.files)
    }
}

impl Study {
    fn store(&self, path: &Path) -> Result<Store, StudyError> {
        Store::open_for(path, &self.specification)
    }
}
