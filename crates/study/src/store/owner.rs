//! The process that holds a lease: who it is, and whether it still lives.

use std::time::{SystemTime, UNIX_EPOCH};

use sha2::{Digest, Sha256};

use peristalsis_formats::hexadecimal;

/// A process that works on a store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Owner {
    /// Machine and process table that `process` belongs to.
    pub(crate) host: String,
    /// Number of the process.
    pub(crate) process: u32,
    /// When the process started, in the machine's own count, so that a number used again is told apart; empty where the
    /// system does not say.
    pub(crate) started: String,
    /// Distinguishes owners within one process.
    pub(crate) token: String,
}

impl Owner {
    /// This process, as a new owner.
    pub(crate) fn new() -> Self {
        let process = std::process::id();
        let (host, started) = (host(), started(process).unwrap_or_default());
        let moment = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_nanos());
        let address = std::thread::current().id();
        let text = format!("{host} {process} {started} {moment} {address:?}");
        Self {
            host,
            process,
            started,
            token: hexadecimal(&Sha256::digest(text.as_bytes())[..8]),
        }
    }

    /// Whether this process certainly lives no more, as seen from here; of other machines nothing is certain.
    pub(crate) fn is_dead(&self) -> bool {
        if self.started.is_empty() || self.host != host() {
            return false;
        }
        // Without any entry of our own the process table cannot be read here.
        started(std::process::id()).is_some()
            && started(self.process).is_none_or(|started| started != self.started)
    }
}

/// Seconds since 1970.
pub(crate) fn now() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs() as i64)
}

/// Name of the machine, with its boot and its process table where the system tells.
fn host() -> String {
    let line = |path: &str| {
        std::fs::read_to_string(path)
            .map(|text| text.trim().to_owned())
            .unwrap_or_default()
    };
    let table = std::fs::read_link("/proc/self/ns/pid")
        .map(|link| link.display().to_string())
        .unwrap_or_default();
    format!(
        "{} {} {table}",
        line("/proc/sys/kernel/hostname"),
        line("/proc/sys/kernel/random/boot_id")
    )
}

/// Start of a process, in ticks since boot; `None` without such a process, or where the system does not tell.
fn started(process: u32) -> Option<String> {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the program, in brackets, may hold anything; the state follows, Z and X for a dead process.
    let mut fields = text.rsplit_once(')')?.1.split_whitespace();
    let state = fields.next()?;
    if matches!(state, "Z" | "X") {
        return None;
    }
    // Field 22 of the whole line; the state was field 3.
    fields.nth(18).map(str::to_owned)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn this_process_lives_and_one_of_another_start_does_not() {
        let this = Owner::new();
        assert!(!this.is_dead());
        assert_ne!(this.token, Owner::new().token);
        let reused = Owner {
            started: "1".into(),
            ..this.clone()
        };
        assert!(reused.is_dead());
        let elsewhere = Owner {
            host: "another machine".into(),
            ..reused
        };
        assert!(!elsewhere.is_dead());
    }

    #[test]
    fn a_process_that_ended_is_dead() {
        let mut child = std::process::Command::new("sleep")
            .arg("100")
            .spawn()
            .unwrap();
        let owner = Owner {
            process: child.id(),
            started: started(child.id()).unwrap(),
            ..Owner::new()
        };
        assert!(!owner.is_dead());
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(owner.is_dead());
    }
}
