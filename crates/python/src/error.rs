//! Errors as Python exceptions, in the words of the command line.

use peristalsis_engine::EngineError;
use peristalsis_formats::FormatError;
use peristalsis_run::RunError;
use peristalsis_study::StudyError;
use pyo3::create_exception;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    peristalsis,
    ConfigurationError,
    PyValueError,
    r#"A configuration that is not possible: the key, where it was given, and what is allowed.

Examples
--------
>>> import peristalsis
>>> try:
...     peristalsis.Configuration("frictionless", width=-1)
... except peristalsis.ConfigurationError as error:
...     print("drive.width" in str(error))
True"#
);
create_exception!(
    peristalsis,
    DoesNotFitError,
    PyValueError,
    r#"More grains than the tube holds.

Examples
--------
>>> import peristalsis
>>> try:
...     peristalsis.Simulation.preset("frictionless", number=20_000)
... except peristalsis.DoesNotFitError as error:
...     print("do not fit" in str(error))
True"#
);
create_exception!(
    peristalsis,
    DivergedError,
    PyRuntimeError,
    r#"A sphere moved by more than half a diameter in one step; the simulation goes no further.

Its state is the state after the step that failed, and its summary has the status ``diverged`` and this error as its ``message``.

Examples
--------
>>> import peristalsis
>>> issubclass(peristalsis.DivergedError, RuntimeError)
True"#
);
create_exception!(
    peristalsis,
    SnapshotError,
    PyValueError,
    r#"Bytes that are no snapshot, or a damaged one.

Examples
--------
>>> import peristalsis
>>> try:
...     peristalsis.Simulation.from_bytes(b"nothing")
... except peristalsis.SnapshotError:
...     print("no snapshot")
no snapshot"#
);
create_exception!(
    peristalsis,
    StudyFailure,
    PyRuntimeError,
    r#"A study or its store cannot do what was asked.

Examples
--------
>>> import peristalsis
>>> try:
...     peristalsis.Study.open("no/such/store")
... except (peristalsis.StudyFailure, OSError):
...     print("no store")
no store"#
);
create_exception!(
    peristalsis,
    AnalysisError,
    PyValueError,
    r#"Data that do not allow an estimate.

Examples
--------
>>> import peristalsis
>>> try:
...     peristalsis.analysis.mean_with_error([1.0])
... except peristalsis.AnalysisError:
...     print("too few samples")
too few samples"#
);

/// A configuration that is not possible; an override stands in the message as ``key=value``, without the command line's flag.
pub(crate) fn of_configuration(error: peristalsis_configuration::ConfigurationError) -> PyErr {
    ConfigurationError::new_err(error.to_string().replace("--set ", ""))
}

/// A failure of a run, and what to do about one that diverged.
pub(crate) fn in_words(error: &RunError) -> String {
    let help = error.against_divergence();
    let help = help.map_or(String::new(), |help| format!("\n  help: {help}"));
    format!("{error}{help}")
}

/// A run that is not possible, or failed.
pub(crate) fn of_run(error: RunError) -> PyErr {
    let text = in_words(&error);
    match error {
        RunError::Configuration(_)
        | RunError::Steering { .. }
        | RunError::Placement { .. }
        | RunError::NotPlaced
        | RunError::Engine(EngineError::InvalidParameter { .. }) => {
            ConfigurationError::new_err(text)
        }
        RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. }) => {
            DoesNotFitError::new_err(text)
        }
        RunError::Engine(EngineError::Diverged { .. }) => DivergedError::new_err(text),
        RunError::Format(FormatError::Io { source, .. }) => {
            std::io::Error::new(source.kind(), text).into()
        }
        RunError::Engine(EngineError::SnapshotMismatch { .. }) | RunError::Format(_) => {
            SnapshotError::new_err(text)
        }
        RunError::State { .. } => SnapshotError::new_err(text),
        RunError::NoRun { .. } | RunError::NothingToResume { .. } | RunError::Complete { .. } => {
            PyFileNotFoundError::new_err(text)
        }
        RunError::Folder { .. } | RunError::AtWork { .. } => PyOSError::new_err(text),
        RunError::Trajectory { help, .. } => {
            PyValueError::new_err(format!("{text}\n  help: {help}"))
        }
        RunError::Picture { help, .. } => PyValueError::new_err(format!("{text}\n  help: {help}")),
        _ => PyRuntimeError::new_err(text),
    }
}

/// A study that is not possible, or failed.
pub(crate) fn of_study(error: StudyError) -> PyErr {
    let text = error.to_string();
    match error {
        StudyError::Configuration(_) => ConfigurationError::new_err(text),
        StudyError::Read { .. } | StudyError::Format(FormatError::Io { .. }) => {
            PyOSError::new_err(text)
        }
        _ => StudyFailure::new_err(text),
    }
}

/// Data that say nothing.
pub(crate) fn of_analysis(error: peristalsis_analysis::Error) -> PyErr {
    AnalysisError::new_err(error.to_string())
}
