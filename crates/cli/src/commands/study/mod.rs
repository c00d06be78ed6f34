//! `peristalsis study`: one file a group of subcommands.

mod keep;
mod plan;
pub(crate) mod progress;
mod run;
mod status;
mod submit;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::{Args, Subcommand};
use peristalsis_engine::processors;
use peristalsis_study::{Effort, Specification};

use crate::commands::schema::{SchemaArguments, study_schema};
use crate::failure::Failure;

/// What to do with a study.
#[derive(Debug, Subcommand)]
pub(crate) enum StudyCommand {
    /// Say what a study would run, and how much time and disk it would take, after a short trial; writes nothing.
    Plan(PlanArguments),
    /// Compute the runs that are missing; may be stopped, called again, and called several times at once.
    Run(RunArguments),
    /// Write a job script for a cluster, whose tasks work on one store.
    Submit(SubmitArguments),
    /// Say how far a study is.
    Status(StatusArguments),
    /// Say everything about one run: its state, and the reason for it.
    Why(WhyArguments),
    /// Mark runs to be computed again; their files are moved aside.
    Retry(RetryArguments),
    /// Check the hashes of all finished runs; files that do not match are moved aside.
    Verify(StoreArguments),
    /// Make the index of a store anew from its files.
    Scan(StoreArguments),
    /// Write the tables of a study: one row per run.
    Export(ExportArguments),
    /// Write the finished runs of a store to one archive.
    Pack(PackArguments),
    /// Add finished runs from tables or archives, by their identity.
    Import(ImportArguments),
    /// Print the JSON schema of a study file.
    Schema(SchemaArguments),
}

#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    /// Study file in TOML.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Store whose finished runs are counted; the default is the store of `study run`.
    #[arg(long, value_name = "DIR")]
    store: Option<PathBuf>,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// Study file in TOML.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Folder that keeps the runs; the default is stores/NAME, after the study's name.
    #[arg(long, value_name = "DIR")]
    store: Option<PathBuf>,
    #[command(flatten)]
    work: WorkArguments,
    /// Time after which the state of a run is saved again.
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = time_span)]
    checkpoint_every: Duration,
    /// Print the status as JSON on standard output at the end, and nothing else there.
    #[arg(long)]
    json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// How much work is done at a time, and for how long.
#[derive(Debug, Args)]
pub(crate) struct WorkArguments {
    /// Runs at a time, one processor each; the default is the number of processors. When fewer runs are left, each takes
    /// more threads.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Stop after this time, such as 90s, 30m, 2h, with every run saved.
    #[arg(long = "for", value_name = "TIME", value_parser = time_span)]
    pub(crate) limit: Option<Duration>,
}

impl WorkArguments {
    /// The effort, with so much time between two checkpoints of a run.
    pub(crate) fn effort(&self, checkpoint_interval: Duration) -> Effort {
        Effort {
            workers: self.workers.map_or_else(processors, usize::from),
            checkpoint_interval,
            limit: self.limit,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct SubmitArguments {
    /// Study file in TOML.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Write an array job for Slurm, the only kind of cluster so far.
    #[arg(long, required = true)]
    slurm: bool,
    /// Folder that keeps the runs, which all tasks see; the default is stores/NAME, after the study's name.
    #[arg(long, value_name = "DIR")]
    store: Option<PathBuf>,
    /// Tasks of the array.
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u16).range(1..=10000))]
    tasks: u16,
    /// Processors of a task, and runs at a time within it.
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u16).range(1..=1024))]
    processors: u16,
    /// Time of a task, such as 90m, 8h, 2d; it ends by itself two minutes earlier, with every run saved.
    #[arg(long, value_name = "TIME", default_value = "4h", value_parser = time_span)]
    time: Duration,
    /// Partition of the cluster.
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Account that pays.
    #[arg(long, value_name = "NAME")]
    account: Option<String>,
    /// A further option of sbatch, such as --option=--mem-per-cpu=1G; may be given several times.
    #[arg(long = "option", value_name = "OPTION", allow_hyphen_values = true)]
    options: Vec<String>,
    /// Script to write, - for standard output; the default is NAME.sbatch. An older file is replaced.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl SubmitArguments {
    /// What would be more than a line of the script, or none of its options.
    fn further_lines(&self) -> Option<&String> {
        let plain = |text: &&String| text.contains(char::is_control) || text.is_empty();
        let mut options = self.options.iter();
        let mut named = options.clone().chain(&self.partition).chain(&self.account);
        let wrong = options.find(|option| !option.starts_with('-'));
        wrong.or_else(|| named.find(plain))
    }
}

#[derive(Debug, Args)]
pub(crate) struct StoreArguments {
    /// Folder that keeps the runs.
    #[arg(value_name = "STORE")]
    store: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct StatusArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WhyArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Identity of the run (column `identity` of `study export`), or its beginning.
    #[arg(value_name = "RUN")]
    run: String,
}

#[derive(Debug, Args)]
pub(crate) struct RetryArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Identities of the runs, or their beginnings.
    #[arg(value_name = "RUN", required_unless_present = "failed")]
    runs: Vec<String>,
    /// All runs that failed.
    #[arg(long, conflicts_with = "runs")]
    failed: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Folder for the tables; those in it are replaced.
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Also write J/Jmax against time of every run.
    #[arg(long)]
    series: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PackArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Archive to write (tar); one that is there is replaced.
    #[arg(value_name = "ARCHIVE")]
    archive: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ImportArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Exported tables (.csv, .parquet), or archives (.tar).
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Study file, needed where the store does not exist yet.
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
}

/// Does what was asked for.
pub(crate) fn study(command: &StudyCommand) -> Result<ExitCode, Failure> {
    match command {
        StudyCommand::Plan(arguments) => plan::plan(arguments),
        StudyCommand::Run(arguments) => run::run(arguments),
        StudyCommand::Submit(arguments) => submit::submit(arguments),
        StudyCommand::Status(arguments) => status::status(arguments),
        StudyCommand::Why(arguments) => status::why(arguments),
        StudyCommand::Retry(arguments) => keep::retry(arguments),
        StudyCommand::Verify(arguments) => keep::verify(arguments),
        StudyCommand::Scan(arguments) => keep::scan(arguments),
        StudyCommand::Export(arguments) => keep::export(arguments),
        StudyCommand::Pack(arguments) => keep::pack(arguments),
        StudyCommand::Import(arguments) => keep::import(arguments),
        StudyCommand::Schema(arguments) => study_schema(*arguments),
    }
}

/// The store that was named, or else the usual one of a study.
fn store_path(named: &Option<PathBuf>, study: &Specification) -> PathBuf {
    let usual = || PathBuf::from("stores").join(&study.name);
    named.clone().unwrap_or_else(usual)
}

/// Reads a time such as 30m, 1.5h, 90s or 250ms.
pub(crate) fn time_span(text: &str) -> Result<Duration, String> {
    let letters = text.find(|letter: char| letter.is_ascii_alphabetic());
    let (number, unit) = text.split_at(letters.unwrap_or(text.len()));
    let misread = "a number with ms, s, m, h or d, such as 30m";
    let factor = match unit {
        "ms" => 1e-3,
        "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        "d" => 86400.0,
        _ => return Err(misread.to_owned()),
    };
    let number: f64 = number.trim().parse().map_err(|_| misread)?;
    if number > 0.0 {
        Duration::try_from_secs_f64(number * factor).map_err(|error| error.to_string())
    } else {
        Err("a time above 0".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_read_with_their_units() {
        for (text, seconds) in [
            ("30m", 1800.0),
            ("1.5h", 5400.0),
            ("90s", 90.0),
            ("250ms", 0.25),
            ("2d", 172_800.0),
        ] {
            assert_eq!(time_span(text).unwrap().as_secs_f64(), seconds, "{text}");
        }
        for text in ["", "30", "m", "0s", "-1h", "1y", "NaNs", "infh"] {
            assert!(time_span(text).is_err(), "{text}");
        }
    }
}
