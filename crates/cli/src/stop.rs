//! Stops on request: Ctrl-C, SIGTERM and SIGUSR1 (which batch systems send before their time is up) end a run cleanly, a
//! second one at once.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

#[cfg(unix)]
use signal_hook::consts::SIGUSR1;
use signal_hook::consts::{SIGINT, SIGTERM};

use crate::failure::Failure;

/// Watches for signals that ask to stop.
pub(crate) struct Stop {
    signal: Arc<AtomicUsize>,
    /// Whether the next signal ends the program at once.
    at_once: Arc<AtomicBool>,
}

/// Added to a signal's number in an exit code, by convention of the shell.
const SIGNAL_BASE: u8 = 128;

impl Stop {
    /// Begins to watch. Until [`Stop::keep_results`] a signal ends the program at once: there is nothing to lose.
    pub(crate) fn watch() -> Result<Self, Failure> {
        let signal = Arc::new(AtomicUsize::new(0));
        let at_once = Arc::new(AtomicBool::new(true));
        for number in [
            SIGINT,
            SIGTERM,
            #[cfg(unix)]
            SIGUSR1,
        ] {
            let code = i32::from(SIGNAL_BASE) + number;
            // In this order: the first signal finds `at_once` false, sets it and is noted; a second one exits.
            signal_hook::flag::register_conditional_shutdown(number, code, Arc::clone(&at_once))
                .and_then(|_| signal_hook::flag::register(number, Arc::clone(&at_once)))
                .and_then(|_| {
                    signal_hook::flag::register_usize(number, Arc::clone(&signal), number as usize)
                })
                .map_err(Failure::Signals)?;
        }
        Ok(Self { signal, at_once })
    }

    /// From here on the first signal is only noted, so that what there is can be written.
    pub(crate) fn keep_results(&self) {
        self.at_once.store(false, Ordering::Relaxed);
    }

    /// The exit code of the signal that asked to stop, if one did.
    pub(crate) fn requested(&self) -> Option<u8> {
        match self.signal.load(Ordering::Relaxed) {
            0 => None,
            number => Some(SIGNAL_BASE + number as u8),
        }
    }

    /// The exit code of that signal, or of success.
    pub(crate) fn exit_code(&self) -> ExitCode {
        self.requested().map_or(ExitCode::SUCCESS, ExitCode::from)
    }
}
