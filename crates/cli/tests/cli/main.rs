//! The program as a person or a script meets it: arguments in; exit code, streams and files out.

#![allow(clippy::unwrap_used, reason = "what is missing fails the test")]

mod bad_input;
mod checking;
mod describing;
mod designing;
mod edges;
mod folders;
mod limits;
mod pictures;
mod reproducing;
mod running;
mod sources;
mod strangers;
mod streams;
mod study;
mod trajectories;
mod validating;

#[cfg(target_os = "linux")]
mod paths;
#[cfg(unix)]
mod signals;
#[cfg(unix)]
mod viewing;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::SystemTime;

use serde_json::Value;
use tempfile::TempDir;

/// A tube that runs within milliseconds.
const SMALL: &str = "--preset frictionless grains.number=20 tube.waves=2 run.periods=4";

/// The words of a line for the program: `SMALL` stands for the small tube, and each setting, such as `run.seed=2`, gets
/// its `--set`.
fn words(line: &str) -> Vec<&str> {
    let words = line.split(' ').flat_map(|word| match word {
        "SMALL" => SMALL.split(' ').collect(),
        word => vec![word],
    });
    let is_setting = |word: &str| {
        let (key, _) = word.split_once('=').unwrap_or_default();
        key.starts_with(|first: char| first.is_ascii_lowercase()) && key.contains('.')
    };
    words
        .flat_map(|word| [is_setting(word).then_some("--set"), Some(word)])
        .flatten()
        .collect()
}

/// The program, without what a caller's environment may say about colours.
fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_peristalsis"));
    for name in [
        "NO_COLOR",
        "FORCE_COLOR",
        "CLICOLOR_FORCE",
        "RUST_BACKTRACE",
    ] {
        command.env_remove(name);
    }
    command
}

/// What a call of the program left behind.
#[derive(Debug)]
struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Outcome {
    fn of(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("the program writes UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("the program writes UTF-8"),
        }
    }

    /// Standard error without frames and line breaks, so that a sentence is in one piece.
    fn message(&self) -> String {
        self.stderr
            .split_whitespace()
            .filter(|word| *word != "│")
            .collect::<Vec<_>>()
            .join(" ")
    }

    #[track_caller]
    fn expect_code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}\n{}", self.stdout, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    /// Asserts that the message holds each part.
    #[track_caller]
    fn says(self, parts: &[&str]) -> Self {
        let message = self.message();
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
        self
    }

    /// Asserts that standard output holds each part.
    #[track_caller]
    fn shows(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(
                self.stdout.contains(part),
                "{part:?} is not in {}",
                self.stdout
            );
        }
        self
    }

    fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|error| panic!("{error}: {:?}", self.stdout))
    }
}

/// A folder of its own for a test, in which the program runs.
struct Place {
    folder: TempDir,
}

impl Place {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn command<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Command {
        let mut command = program();
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    /// The program with the [`words`] of a line.
    fn call(&self, line: &str) -> Outcome {
        Outcome::of(self.command(words(line)).output().unwrap())
    }

    /// The program with the [`words`] of a line, started, with pipes to what it says.
    fn start(&self, line: &str) -> Child {
        let mut command = self.command(words(line));
        let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        piped.spawn().unwrap()
    }

    /// A call that ends well.
    #[track_caller]
    fn does(&self, line: &str) -> Outcome {
        self.call(line).expect_code(0)
    }

    /// A call that is refused as bad input, with a message that holds each part.
    #[track_caller]
    fn refuses(&self, line: &str, parts: &[&str]) -> Outcome {
        self.call(line).expect_code(2).says(parts)
    }

    /// Whether files of a name are the same in two folders, to the byte.
    #[track_caller]
    fn assert_same(&self, folders: [&str; 2], names: &[&str]) {
        for name in names {
            let [one, other] =
                folders.map(|folder| std::fs::read(self.path(folder).join(name)).unwrap());
            assert!(one == other, "{name} differs");
        }
    }

    /// Whether two folders hold the same run, but for the time that it took.
    #[track_caller]
    fn assert_same_run(&self, folders: [&str; 2]) {
        let products = [
            "config.toml",
            "timeseries.parquet",
            "profile.parquet",
            "waves.parquet",
            "flow.svg",
            "flow.png",
            "profile.svg",
            "snapshot.svg",
        ];
        self.assert_same(folders, &products);
        let [one, other] = folders.map(|folder| {
            let mut summary = read_json(&self.path(folder).join("summary.json"));
            let all = summary.as_object_mut().unwrap();
            for key in ["seconds", "grain_steps_per_second", "trajectory"] {
                all.remove(key);
            }
            summary
        });
        assert_eq!(one, other);
    }

    /// Every file below, with content and time of change; folders with neither. A file that a running program puts in
    /// place meanwhile may be missing.
    fn inventory(&self) -> Inventory {
        let mut found = Inventory::new();
        collect(self.folder.path(), self.folder.path(), &mut found);
        found
    }
}

type Inventory = BTreeMap<PathBuf, Option<(Vec<u8>, SystemTime)>>;

fn collect(root: &Path, folder: &Path, found: &mut Inventory) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.strip_prefix(root).unwrap().to_owned();
        if path.is_dir() {
            found.insert(name, None);
            collect(root, &path, found);
        } else {
            let read = || -> std::io::Result<_> {
                Ok((std::fs::read(&path)?, path.metadata()?.modified()?))
            };
            match read() {
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                file => {
                    found.insert(name, Some(file.unwrap()));
                }
            }
        }
    }
}

/// Sends a signal to a program that was started.
#[cfg(unix)]
fn send(signal: &str, child: &Child) {
    let mut kill = Command::new("kill");
    let kill = kill.args([format!("-{signal}"), child.id().to_string()]);
    assert!(kill.status().unwrap().success());
}

/// Keys and messages of the warnings in a summary or in what `check` answers.
fn warnings(report: &Value) -> Vec<(&str, &str)> {
    let warnings = report["warnings"].as_array().unwrap().iter();
    warnings
        .map(|it| (it["key"].as_str().unwrap(), it["message"].as_str().unwrap()))
        .collect()
}

fn read_json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}
