//! Long work during which Ctrl-C is heard.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Time between two looks for a signal.
pub(crate) const EACH_LOOK: Duration = Duration::from_millis(50);

/// Does work in a thread of its own, without the interpreter. What a signal raises meanwhile is raised at once; the thread is
/// then left to end by itself.
pub(crate) fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (done, mut outcome) = sync_channel(1);
    let thread = thread::Builder::new().spawn(move || drop(done.send(work())))?;
    loop {
        let (found, again) = py.detach(move || (outcome.recv_timeout(EACH_LOOK), outcome));
        outcome = again;
        match found {
            Ok(found) => return Ok(found),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return match thread.join() {
                    Err(panic) => resume_unwind(panic),
                    Ok(()) => Err(PyRuntimeError::new_err("the work ended without an answer")),
                };
            }
        }
    }
}
