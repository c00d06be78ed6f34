//! The command line in Python's process.

use std::ffi::OsString;
use std::process::ExitCode;

use pyo3::prelude::*;

/// Does what a command line asks for, its first word the program's name, and answers the exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let code = py.detach(|| peristalsis_command::run(words));
    // An `ExitCode` does not give its number.
    let is_it = |number: &u8| ExitCode::from(*number) == code;
    (0..=u8::MAX).find(is_it).unwrap_or(1)
}
