//! Errors as Python exceptions, in the words of the command line.

use peristalsis_engine::EngineError;
use peristalsis_run::RunError;
use peristalsis_study::StudyError;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    peristalsis,
    ConfigurationError,
    PyValueError,
    "A configuration that cannot be: the key, where it was given, and what is allowed."
);
create_exception!(
    peristalsis,
    DoesNotFitError,
    PyValueError,
    "More grains than the tube holds."
);
create_exception!(
    peristalsis,
    DivergedError,
    PyRuntimeError,
    "A sphere moved by more than half a diameter in one step; the state is that of the step that failed."
);
create_exception!(
    peristalsis,
    SnapshotError,
    PyValueError,
    "Bytes that are no snapshot, or a damaged one."
);
create_exception!(
    peristalsis,
    StudyFailure,
    PyRuntimeError,
    "A study or its store cannot do what was asked."
);
create_exception!(
    peristalsis,
    AnalysisError,
    PyValueError,
    "Data that an estimator can say nothing about."
);

/// A configuration that cannot be; an override stands in the message as ``key=value``, without the command line's flag.
pub(crate) fn of_configuration(error: peristalsis_configuration::ConfigurationError) -> PyErr {
    ConfigurationError::new_err(error.to_string().replace("--set ", ""))
}

/// A run that cannot be, or failed.
pub(crate) fn of_run(error: RunError) -> PyErr {
    let text = error.to_string();
    match error {
        RunError::Configuration(_)
        | RunError::Steering { .. }
        | RunError::Engine(EngineError::InvalidParameter { .. }) => {
            ConfigurationError::new_err(text)
        }
        RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. }) => {
            DoesNotFitError::new_err(text)
        }
        RunError::Engine(EngineError::Diverged { .. }) => DivergedError::new_err(text),
        RunError::Engine(EngineError::SnapshotMismatch { .. }) | RunError::Format(_) => {
            SnapshotError::new_err(text)
        }
        RunError::Folder { .. } => PyOSError::new_err(text),
        _ => PyRuntimeError::new_err(text),
    }
}

/// A study that cannot be, or failed.
pub(crate) fn of_study(error: StudyError) -> PyErr {
    let text = error.to_string();
    match error {
        StudyError::Configuration(_) => ConfigurationError::new_err(text),
        StudyError::Read { .. } | StudyError::Io { .. } => PyOSError::new_err(text),
        _ => StudyFailure::new_err(text),
    }
}

/// Data that say nothing.
pub(crate) fn of_analysis(error: peristalsis_analysis::Error) -> PyErr {
    AnalysisError::new_err(error.to_string())
}
