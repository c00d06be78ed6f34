//! Frames of a run in files, and pictures of it.

use std::path::PathBuf;

use parking_lot::Mutex;
use peristalsis_command::choice::{self, View, value_of};
use peristalsis_run::{
    Drawing, FrameFile, FrameFormat, FrameSource, Look, PictureScene, RunError, Writing, space_time,
};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::ThreadPoolBuilder;

use crate::error::of_run;
use crate::heard::heard;
use crate::run::Run;

/// Whether a format is known by the ending of a file's name; refuses it where none is.
#[pyfunction]
pub(crate) fn check_frame_format(path: PathBuf) -> PyResult<()> {
    FrameFormat::of(&path).map(drop).map_err(of_run)
}

/// Writes the present state of a run to a file.
#[pyfunction]
pub(crate) fn write_frame(py: Python<'_>, run: &Run, path: PathBuf) -> PyResult<()> {
    let format = FrameFormat::of(&path).map_err(of_run)?;
    run.look(py, |run| format.write(&path, run)).map_err(of_run)
}

/// Frames that are being written to a file.
#[pyclass(frozen, module = "peristalsis._core")]
pub(crate) struct Frames {
    file: Mutex<FrameFile>,
}

#[pymethods]
impl Frames {
    /// Begins without a frame, over an older file.
    #[new]
    fn new(py: Python<'_>, run: &Run, path: PathBuf) -> PyResult<Self> {
        let format = FrameFormat::of(&path).map_err(of_run)?;
        let file = run
            .look(py, |run| FrameFile::create(&path, format, run))
            .map_err(of_run)?;
        let file = Mutex::new(file);
        Ok(Self { file })
    }

    /// Writes the present state.
    fn append(&self, py: Python<'_>, run: &Run) -> PyResult<()> {
        run.look(py, |run| self.file.lock().append(run))
            .map_err(of_run)
    }

    /// Brings all frames to the disk.
    fn synchronize(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.file.lock().synchronize()).map_err(of_run)
    }

    /// Frames written.
    #[getter]
    fn number(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.file.lock().frames())
    }
}

/// The value of an option by its name.
fn chosen<T: Copy>(option: &str, choices: &[choice::Choice<T>], name: &str) -> PyResult<T> {
    value_of(choices, &name.replace('_', "-")).ok_or_else(|| {
        let known: Vec<&str> = choices.iter().map(|(known, ..)| *known).collect();
        PyValueError::new_err(format!(
            "{option} = {name:?} is not possible; there are {}",
            known.join(", ")
        ))
    })
}

/// A picture of a run as it stands: PNG, or SVG where `vector` is true.
#[pyfunction]
#[pyo3(signature = (run, *, view, colour, range, wall, place, position, waves, width, paper, bare, vector))]
#[allow(
    clippy::too_many_arguments,
    reason = "the options of `peristalsis render`"
)]
pub(crate) fn render<'py>(
    py: Python<'py>,
    run: &Run,
    view: &str,
    colour: &str,
    range: Option<(f64, f64)>,
    wall: &str,
    place: Option<f64>,
    position: Option<f64>,
    waves: f64,
    width: Option<u32>,
    paper: &str,
    bare: bool,
    vector: bool,
) -> PyResult<Bound<'py, PyBytes>> {
    let (field, wall) = (
        chosen("colour", choice::FIELDS, colour)?,
        chosen("wall", choice::WALLS, wall)?,
    );
    let paper = chosen("paper", choice::PAPERS, paper)?;
    let writing = match bare {
        true => Writing::None,
        false => Writing::Full,
    };
    let view = chosen("view", choice::VIEWS, view)?;
    if (place.is_some() || position.is_some()) && view != View::Section {
        return Err(PyValueError::new_err(
            "place and position are those of view = \"section\"",
        ));
    }
    let look = |middle: f64| Look {
        aspect: view.aspect(place, position, middle),
        field,
        range,
        wall,
        waves,
        width: width.unwrap_or(view.usual_width(false)),
        paper,
        writing,
        ..Look::default()
    };
    let draw = run.look(py, |run| match view {
        View::SpaceTime => space_time(run).map(|drawing| Box::new(move || Ok(drawing)) as Draw),
        _ => still(run, look(0.5 * run.simulation().wall().length())),
    });
    let draw = draw.map_err(of_run)?;
    // Threads of this picture alone: those that all share do not come along where the process forks.
    let threads = ThreadPoolBuilder::new().build();
    let threads = threads.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let bytes = heard(py, move || threads.install(|| encoded(&draw()?, vector)))?;
    Ok(PyBytes::new(py, &bytes.map_err(of_run)?))
}

/// What is left to do of a picture once the run has been looked at.
type Draw = Box<dyn FnOnce() -> Result<Drawing, RunError> + Send>;

fn still(run: &peristalsis_run::Run, look: Look) -> Result<Draw, RunError> {
    let frame = FrameSource::now(run, look.needs_contacts());
    let samples = [frame];
    let scene = PictureScene::new(run, look, &samples)?;
    Ok(Box::new(move || scene.draw(&samples[0])))
}

fn encoded(drawing: &Drawing, vector: bool) -> Result<Vec<u8>, RunError> {
    match vector {
        true => Ok(drawing.svg().into_bytes()),
        false => drawing.png().map_err(RunError::of_figure("the picture")),
    }
}
