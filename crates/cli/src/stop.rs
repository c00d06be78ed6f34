//! Stops on request: Ctrl-C, SIGTERM, SIGUSR1 (which batch systems send before their time is up) and SIGHUP (a lost
//! connection) end work cleanly. One more ends it at once, but only a second later: some programs, `timeout` among them,
//! send the same signal twice.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

#[cfg(unix)]
use signal_hook::consts::{SIGHUP, SIGUSR1, SIGXFSZ};
use signal_hook::consts::{SIGINT, SIGTERM};

use crate::failure::{Failure, say};

/// Watches for signals that ask to stop.
#[derive(Clone)]
pub(crate) struct Stop {
    signal: Arc<AtomicUsize>,
    /// Whether there is something that a signal must not lose.
    keeps: Arc<Mutex<bool>>,
}

/// Added to a signal's number in an exit code, by convention of the shell.
const SIGNAL_BASE: u8 = 128;
/// Time from the first signal in which more of them are the same request.
const ONE_REQUEST: Duration = Duration::from_secs(1);
/// Time between two looks for the first signal.
const LOOK: Duration = Duration::from_millis(100);

impl Stop {
    /// Begins to watch. Until [`Stop::keep_results`] a signal ends the program, which says so: there is nothing to lose.
    pub(crate) fn watch() -> Result<Self, Failure> {
        let signal = Arc::new(AtomicUsize::new(0));
        let (at_once, keeps) = (Arc::new(AtomicBool::new(false)), Arc::default());
        for number in signals() {
            let code = i32::from(SIGNAL_BASE) + number;
            // In this order: a signal that is not to end the program is noted.
            signal_hook::flag::register_conditional_shutdown(number, code, Arc::clone(&at_once))
                .and_then(|_| {
                    signal_hook::flag::register_usize(number, Arc::clone(&signal), number as usize)
                })
                .map_err(Failure::Signals)?;
        }
        let stop = Self { signal, keeps };
        let watched = stop.clone();
        // A thread of its own, for whoever asks may be at a long piece of work.
        std::thread::spawn(move || {
            let code = loop {
                match watched.requested() {
                    Some(code) => break code,
                    None => std::thread::sleep(LOOK),
                }
            };
            let keeps = watched.keeps();
            if !*keeps {
                // The lock is held to the end: nothing begins that would have to be kept.
                say("stopped before there was any result");
                std::process::exit(code.into());
            }
            drop(keeps);
            std::thread::sleep(ONE_REQUEST);
            at_once.store(true, Ordering::Relaxed);
        });
        Ok(stop)
    }

    /// From here on the first signal is only noted, so that what there is can be written.
    pub(crate) fn keep_results(&self) {
        *self.keeps() = true;
    }

    fn keeps(&self) -> MutexGuard<'_, bool> {
        self.keeps.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a signal asked to stop, and did not end the program by itself.
    pub(crate) fn is_asked_for(&self) -> bool {
        self.requested().is_some() && *self.keeps()
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

/// Makes of the signal that a file may not grow an error of writing, which is told and loses nothing.
pub(crate) fn outlive_limits_of_files() -> Result<(), Failure> {
    #[cfg(unix)]
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map_err(Failure::Signals)?;
    Ok(())
}

/// The signals that ask to stop.
fn signals() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    {
        signals.push(SIGUSR1);
        if !ignores_hangups() {
            signals.push(SIGHUP);
        }
    }
    signals
}

/// Whether this program was begun to outlive its terminal, as by `nohup`. Where the system does not say it, hang-ups are
/// left as they are.
#[cfg(unix)]
fn ignores_hangups() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}
