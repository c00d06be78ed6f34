//! The folder of one run in a store: its configuration, checkpoints, products and seal.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use peristalsis_configuration::Configuration;
use peristalsis_formats::{Table, atomic, parquet};
use peristalsis_run::files::{CONFIGURATION, PROFILE, SNAPSHOT, STATE, SUMMARY, TIMESERIES, WAVES};
use peristalsis_run::{
    Run, RunError, Stopping, Summary, profile_table, snapshot_table, timeseries_table, waves_table,
};
use serde_json::Value;

use super::seal::{SEAL, Seal};
use super::{Entry, State, done, write_if_other};
use crate::error::{Result, StudyError};
use crate::identity::{Identity, PHYSICS_VERSION, Record};
use crate::plan::{Plan, PlannedRun};
use crate::row::Row;

/// The file that signac and row look for beside each run.
pub(crate) const STATEPOINT: &str = "signac_statepoint.json";
/// The newer and the older generation of the state.
const CHECKPOINTS: [&str; 2] = [STATE, "state.checkpoint.1"];
const ROW: &str = "row.csv";
/// The time that the run took: the one file of a finished run without a hash in the seal, for it differs each time.
pub(crate) const TIMING: &str = "timing.json";
/// The numbers of a summary that go into it.
pub(crate) const TIMES: [&str; 2] = ["seconds", "grain_steps_per_second"];
const FAILED: &str = "failed.json";

/// The state of a run as its files tell it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// Nothing is there but perhaps its configuration.
    Nothing,
    /// It was interrupted.
    Checkpointed,
    /// It is finished, and its hashes check.
    Done {
        /// Its row.
        row: Box<Row>,
        /// Sizes and times of change of what was checked.
        stamp: Option<String>,
    },
    /// Its files differ from its seal.
    Damaged(String),
    /// It ended in this error.
    Failed(String),
}

impl Verdict {
    /// The entry of a run that is not finished, or no more.
    pub(crate) fn entry(self) -> Entry {
        match self {
            Self::Nothing => Entry::new(State::Pending, None),
            Self::Checkpointed => Entry::new(State::Checkpointed, None),
            Self::Damaged(reason) => Entry::new(State::Quarantined, Some(reason)),
            Self::Failed(reason) => Entry::new(State::Failed, Some(reason)),
            Self::Done { row, stamp } => done(&row, stamp),
        }
    }
}

/// All that is needed to begin a run.
#[derive(Clone, Debug)]
pub(crate) struct Assignment {
    pub(crate) identity: Identity,
    pub(crate) replicate: u32,
    pub(crate) configuration: Configuration,
    pub(crate) stopping: Option<Stopping>,
    pub(crate) record: Record,
}

impl Assignment {
    pub(crate) fn of(plan: &Plan, run: &PlannedRun) -> Self {
        Self {
            identity: run.identity,
            replicate: run.replicate,
            configuration: plan.configuration(run),
            stopping: plan.stopping,
            record: plan.record.clone(),
        }
    }
}

/// The folder of one run.
#[derive(Clone, Debug)]
pub(crate) struct RunFiles {
    identity: Identity,
    path: PathBuf,
}

impl RunFiles {
    pub(crate) fn new(runs: &Path, identity: Identity) -> Self {
        Self {
            identity,
            path: runs.join(identity.to_string()),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Whether its products were written to the end.
    pub(crate) fn is_sealed(&self) -> bool {
        self.file(SEAL).exists()
    }

    /// Whether there is a state to go on from.
    pub(crate) fn has_checkpoint(&self) -> bool {
        CHECKPOINTS.iter().any(|name| self.file(name).exists())
    }

    /// The verdict of the files. A run whose files have the stamp `checked` is taken as unchanged since its hashes were checked.
    pub(crate) fn verdict(&self, checked: Option<&str>) -> Verdict {
        if self.is_sealed() {
            return self.sealed(checked).unwrap_or_else(Verdict::Damaged);
        }
        if let Ok(text) = fs::read_to_string(self.file(FAILED)) {
            let reason = serde_json::from_str::<Value>(&text)
                .ok()
                .and_then(|value| Some(value.get("reason")?.as_str()?.to_owned()));
            return Verdict::Failed(reason.unwrap_or(text));
        }
        match self.has_checkpoint() {
            true => Verdict::Checkpointed,
            false => Verdict::Nothing,
        }
    }

    fn sealed(&self, checked: Option<&str>) -> Result<Verdict, String> {
        let seal = Seal::read(&self.path, self.identity)?;
        let stamp = seal.stamp(&self.path);
        if checked.is_none() || stamp.as_deref() != checked {
            seal.check(&self.path)?;
        }
        let text = fs::read_to_string(self.file(ROW))
            .map_err(|error| format!("{ROW} cannot be read: {error}"))?;
        let row = Row::from_csv(&text).map_err(|error| format!("{ROW}: {error}"))?;
        if row.identity() != self.identity {
            return Err(format!("{ROW} is that of run {}", row.identity()));
        }
        Ok(Verdict::Done {
            row: Box::new(row),
            stamp,
        })
    }

    /// Names of the files of a finished run, the seal last.
    pub(crate) fn sealed_names(&self) -> Result<Vec<String>, String> {
        let seal = Seal::read(&self.path, self.identity)?;
        let mut names: Vec<String> = seal.names().map(str::to_owned).collect();
        names.extend([STATEPOINT, TIMING, SEAL].map(str::to_owned));
        names.retain(|name| self.file(name).exists());
        Ok(names)
    }

    /// Makes the folder with the files that do not change during the run, and removes half-written files of a killed process.
    pub(crate) fn begin(&self, assignment: &Assignment) -> Result<()> {
        fs::create_dir_all(&self.path).map_err(StudyError::io("make", &self.path))?;
        if let Some(runs) = self.path.parent() {
            atomic::synchronize(runs)?;
        }
        atomic::sweep(&self.path);
        let configuration = assignment.configuration.to_toml();
        write_if_other(&self.file(CONFIGURATION), &configuration)?;
        let statepoint = format!("{:#}\n", statepoint(assignment));
        write_if_other(&self.file(STATEPOINT), &statepoint)
    }

    /// The run from its newest whole checkpoint, or from the start. `aside` moves each damaged checkpoint away; `stop` is
    /// asked often whether to stop.
    pub(crate) fn resume(
        &self,
        assignment: &Assignment,
        aside: &mut dyn FnMut(&Path, &str) -> Result<()>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Run> {
        let configuration = || assignment.configuration.clone();
        let mut run = None;
        for path in CHECKPOINTS.map(|name| self.file(name)) {
            let bytes = match fs::read(&path) {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(error) => return Err(StudyError::io("read", path)(error)),
            };
            match Run::from_snapshot(&bytes).and_then(|run| run.under(configuration())) {
                Ok(found) => {
                    run = Some(found);
                    break;
                }
                Err(error) => aside(&path, &error.to_string())?,
            }
        }
        let mut run = match run {
            Some(run) => run,
            None => Run::new_unless(configuration(), stop).map_err(|source| self.failed(source))?,
        };
        if let Some(stopping) = assignment.stopping {
            run.stop_when(stopping);
        }
        Ok(run)
    }

    /// Saves the state; the one before becomes the older generation.
    pub(crate) fn save(&self, run: &Run) -> Result<()> {
        let [newer, older] = CHECKPOINTS.map(|name| self.file(name));
        match fs::rename(&newer, &older) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(StudyError::io("rename", newer)(error));
            }
            _ => {}
        }
        run.write_checkpoint(&newer)
            .map_err(|source| self.failed(source))
    }

    /// Writes the products and seals them.
    pub(crate) fn finish(
        &self,
        run: &Run,
        summary: &Summary,
        assignment: &Assignment,
    ) -> Result<()> {
        let row = Row::of(self.identity, assignment.replicate, summary);
        let timeseries = kept(timeseries_table(run)?, assignment.record.columns.as_deref());
        let (science, timing) = split(summary);
        let mut products = vec![
            (
                CONFIGURATION,
                assignment.configuration.to_toml().into_bytes(),
            ),
            (TIMESERIES, parquet::encode(&timeseries)?),
        ];
        if assignment.record.profile {
            products.push((PROFILE, parquet::encode(&profile_table(run)?)?));
        }
        if assignment.record.waves {
            products.push((WAVES, parquet::encode(&waves_table(run)?)?));
        }
        if assignment.record.snapshot {
            products.push((SNAPSHOT, parquet::encode(&snapshot_table(run)?)?));
        }
        products.push((SUMMARY, science.into_bytes()));
        products.push((ROW, row.to_csv().into_bytes()));
        for (name, bytes) in &products[1..] {
            atomic::write(&self.file(name), bytes)?;
        }
        atomic::write(&self.file(TIMING), timing.as_bytes())?;
        Seal::write(&self.path, self.identity, &products)?;
        self.remove_checkpoints();
        Ok(())
    }

    /// Takes the checkpoints of a finished run away; one that stays does no harm.
    pub(crate) fn remove_checkpoints(&self) {
        for name in CHECKPOINTS {
            drop(fs::remove_file(self.file(name)));
        }
    }

    /// Notes the error that the run ended in, beside its last state.
    pub(crate) fn fail(&self, reason: &str) -> Result<()> {
        let report = serde_json::json!({
            "identity": self.identity.to_string(),
            "reason": reason,
            "physics_version": PHYSICS_VERSION,
            "version": peristalsis_run::VERSION,
            "revision": peristalsis_run::REVISION,
        });
        Ok(atomic::write(
            &self.file(FAILED),
            format!("{report:#}\n").as_bytes(),
        )?)
    }

    fn failed(&self, source: RunError) -> StudyError {
        StudyError::Run {
            identity: self.identity,
            source,
        }
    }
}

/// A summary as JSON in two parts: the results, and the time that they took.
fn split(summary: &Summary) -> (String, String) {
    let mut science = serde_json::to_value(summary).expect("a summary is plain numbers and text");
    let take = |name: &str| Some((name.to_owned(), science.as_object_mut()?.remove(name)?));
    let timing: Value = TIMES.into_iter().filter_map(take).collect();
    (format!("{science:#}\n"), format!("{timing:#}\n"))
}

/// A table with only these of its columns.
fn kept(table: Table, columns: Option<&[String]>) -> Table {
    let Some(names) = columns else { return table };
    let kept: Vec<_> = table
        .columns()
        .iter()
        .filter(|column| names.contains(&column.name))
        .cloned()
        .collect();
    if kept.is_empty() {
        // None of them applies to this model: better all than no series.
        return table;
    }
    let mut builder = Table::builder().columns(kept);
    for (key, value) in table.metadata() {
        builder = builder.metadata(key, value);
    }
    builder
        .build()
        .expect("a part of the columns of a table is a table")
}

/// The state point: every key of the configuration and what else makes the identity.
pub(crate) fn statepoint(assignment: &Assignment) -> Value {
    let text = assignment.configuration.to_toml();
    let mut table: toml::Table =
        toml::from_str(&text).expect("the canonical form of a configuration is TOML");
    table.remove("resolved");
    let mut statepoint =
        serde_json::to_value(table).expect("a configuration is finite numbers and text");
    statepoint["replicate"] = assignment.replicate.into();
    statepoint["physics_version"] = PHYSICS_VERSION.into();
    statepoint["stop"] = match assignment.stopping {
        Some(stopping) => serde_json::json!({ "settled_periods": stopping.settled_periods }),
        None => Value::Null,
    };
    statepoint["record"] =
        serde_json::to_value(&assignment.record).expect("a record is names and choices");
    statepoint
}
