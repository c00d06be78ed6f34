//! One file a command.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod design;
pub(crate) mod figures;
pub(crate) mod newtonian;
pub(crate) mod presets;
pub(crate) mod render;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod runs;
pub(crate) mod schema;
pub(crate) mod study;
pub(crate) mod trajectory;
pub(crate) mod validate;
pub(crate) mod view;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Once, mpsc};
use std::time::Duration;

pub(crate) use peristalsis_analysis::number::{counted, significant};
use peristalsis_configuration::{Arrangement, Configuration, InitialState};
use peristalsis_run::Warning;
use serde::Serialize;

use crate::failure::{Failure, say};

/// Prints on standard output and answers success; a reader that has gone away is no failure.
fn print(text: &str) -> Result<ExitCode, Failure> {
    let mut output = std::io::stdout().lock();
    let written = output.write_all(text.as_bytes());
    match written.and_then(|()| output.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Output(error)),
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Prints a value as JSON on standard output.
fn print_json(value: &impl Serialize) -> Result<ExitCode, Failure> {
    let value = serde_json::to_value(value).expect("reports have texts for keys");
    print(&format!("{value:#}\n"))
}

/// Prints a report on standard output: as JSON, or in words. Only the one asked for is made; that of many runs is large.
fn print_report<R: Serialize>(
    as_json: bool,
    report: impl FnOnce() -> R,
    in_words: impl FnOnce() -> String,
) -> Result<ExitCode, Failure> {
    if as_json {
        print_json(&report())
    } else {
        print(&in_words())
    }
}

/// The exit code of work that came to its end, well or not.
fn code_of(is_well: bool) -> ExitCode {
    ExitCode::from(u8::from(!is_well))
}

/// Says something on standard error, unless asked to be quiet.
fn tell(is_quiet: bool, text: &str) {
    if !is_quiet {
        say(text);
    }
}

/// Says that a file which is about to be written replaces one. Every command that writes a file which its user names does
/// so, and says so.
fn say_if_replaced(path: &Path) {
    if path.exists() {
        say(&format!("replaces {}", path.display()));
    }
}

/// Refuses to write a file over one that must stay. Asked before anything is computed.
fn refuse_loss(path: &Path, kept: impl IntoIterator<Item = PathBuf>) -> Result<(), Failure> {
    let Ok(written) = path.canonicalize() else {
        return Ok(());
    };
    let is_written = |kept: PathBuf| kept.canonicalize().is_ok_and(|kept| kept == written);
    match kept.into_iter().any(is_written) {
        true => Err(Failure::usage(
            format!("{} is needed, and would be lost", path.display()),
            "name another file to write",
        )),
        false => Ok(()),
    }
}

/// Prints warnings on standard error, without those that were said before: no progress, so that they are said in quiet runs
/// as well.
fn warn_besides(said: &[Warning], warnings: &[Warning]) {
    for warning in warnings.iter().filter(|warning| !said.contains(warning)) {
        say(&format!("warning: {}: {}", warning.key, warning.message));
    }
}

/// How long work may take before something is said of it.
const PATIENCE: Duration = Duration::from_secs(3);

/// Packs the grains of a configuration, which may have to settle, and says so on standard error where it takes longer than
/// one waits for in silence, and warnings that would come after it otherwise.
fn packing<T>(configuration: &Configuration, warnings: &[Warning], work: impl FnOnce() -> T) -> T {
    let words = packing_words(configuration);
    let (working, ended) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            if ended.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                // Once, however many runs are packed at a time.
                static SAID: Once = Once::new();
                SAID.call_once(|| {
                    say(&words);
                    warn_besides(&[], warnings);
                });
            }
        });
        let outcome = work();
        drop(working);
        outcome
    })
}

/// That packing takes long.
fn packing_words(configuration: &Configuration) -> String {
    let settling = match configuration.initial.state {
        InitialState::Settled => " and letting them settle",
        _ => "",
    };
    let wall = match configuration.tube.arrangement {
        Arrangement::Smooth => "in a smooth wall".to_owned(),
        _ => format!(
            "among {} spheres of the wall",
            configuration.tube.wall_spheres()
        ),
    };
    format!(
        "packing grains{settling}: it takes long for {} grains {wall}; Ctrl-C ends it",
        configuration.grains.number
    )
}

/// A number that reads 0 with so many decimals as 0, which has no sign.
pub(crate) fn unsigned_zero(value: f64, decimals: i32) -> f64 {
    match value.abs() < 0.5 * 0.1_f64.powi(decimals) {
        true => 0.0,
        false => value,
    }
}

/// A number with at most four significant digits, and none that are zeros at the end.
fn rounded(value: f64) -> String {
    let text = significant(value, 4);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::{packing_words, rounded, unsigned_zero};

    /// A pump engineer: grains were packed "among 0 spheres of the wall".
    #[test]
    fn a_smooth_wall_has_no_spheres_to_pack_grains_among() {
        let words = |settings: &[&str]| {
            packing_words(&Configuration::from_preset("frictionless", settings).unwrap())
        };
        let among = "packing grains: it takes long for 203 grains among 1680 spheres of the wall; Ctrl-C ends it";
        assert_eq!(words(&[]), among);
        let smooth = words(&["tube.arrangement=smooth"]);
        assert!(smooth.contains("203 grains in a smooth wall;"), "{smooth}");
    }

    #[test]
    fn a_number_that_reads_zero_has_no_sign() {
        let texts = [-3e-5, -0.0, -6e-5].map(|it| format!("{:.4}", unsigned_zero(it, 4)));
        assert_eq!(texts, ["0.0000", "0.0000", "-0.0001"]);
        assert_eq!(format!("{:+.3}", unsigned_zero(-4e-4, 3)), "+0.000");
    }

    #[test]
    fn rounded_numbers_are_as_short_as_they_can_be() {
        let numbers = [4987.531172069826, 20.0, 0.05, 249.3765586034913, 1e7, 0.0];
        let texts = ["4988", "20", "0.05", "249.4", "1.000e7", "0"];
        assert_eq!(numbers.map(rounded), texts);
    }
}
