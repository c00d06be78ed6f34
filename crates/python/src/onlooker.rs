//! A page of the viewer that looks at a simulation of Python.

use parking_lot::Mutex;
use peristalsis_viewer::page::{SCRIPT, STYLE, TUBE, WIDGET};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::{ConfigurationError, of_run};
use crate::run::Run;

/// What a page has been told of a simulation, and where its sliders lead it.
#[pyclass(frozen, module = "peristalsis._core")]
pub(crate) struct Onlooker {
    inner: Mutex<peristalsis_viewer::Onlooker>,
}

#[pymethods]
impl Onlooker {
    #[new]
    fn new() -> Self {
        let inner = Mutex::default();
        Self { inner }
    }

    /// The first message to the page, in JSON.
    fn welcome(&self, py: Python<'_>, run: &Run, title: &str) -> String {
        run.look(py, |run| self.inner.lock().welcome(run, title))
    }

    /// Moves a slider, or has contacts sent, as a command in JSON says.
    fn command(&self, py: Python<'_>, run: &Run, text: &str) -> PyResult<()> {
        run.look(py, |run| self.inner.lock().command(run, text))
            .map_err(ConfigurationError::new_err)
    }

    /// Leads the run to where sliders were moved while it was on its way elsewhere.
    fn follow(&self, py: Python<'_>, run: &Run) -> PyResult<()> {
        run.look(py, |run| self.inner.lock().follow(run))
            .map_err(of_run)
    }

    /// The bytes of the present frame.
    fn frame<'py>(
        &self,
        py: Python<'py>,
        run: &Run,
        playing: bool,
        speed: Option<f64>,
    ) -> Bound<'py, PyBytes> {
        let bytes = run.look(py, |run| self.inner.lock().frame(run, playing, speed));
        PyBytes::new(py, &bytes)
    }

    /// Where the sliders of width, force amplitude and strain rate lead.
    fn aims(&self, py: Python<'_>, run: &Run) -> [Option<f64>; 3] {
        run.look(py, |run| self.inner.lock().aims(run))
    }
}

/// Document, style and script of the page, and the module by which a notebook shows it.
#[pyfunction]
pub(crate) fn page() -> [&'static str; 4] {
    [TUBE, STYLE, SCRIPT, WIDGET]
}
