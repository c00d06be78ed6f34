//! A page of the viewer that looks at a simulation of Python.

use parking_lot::Mutex;
use peristalsis_viewer::page::{SCRIPT, STYLE, TUBE, WIDGET};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::run::Run;

/// What a page has been told of a simulation.
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

    /// Sends the contacts of the grains with each frame, or leaves them out.
    fn show_contacts(&self, py: Python<'_>, shown: bool) {
        py.detach(|| self.inner.lock().show_contacts(shown));
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
}

/// Document, style and script of the page, and the module by which a notebook shows it.
#[pyfunction]
pub(crate) fn page() -> [&'static str; 4] {
    [TUBE, STYLE, SCRIPT, WIDGET]
}
