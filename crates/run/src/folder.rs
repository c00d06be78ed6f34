//! The folder of a run: configuration, summary, tables, figures, state.

use std::path::{Path, PathBuf};

use peristalsis_configuration::Configuration;
use peristalsis_formats::{FormatError, atomic, csv, parquet};

use crate::error::RunError;
use crate::pictures;
use crate::run::Run;
use crate::summary::Summary;
use crate::tables::{profile_table, timeseries_table, waves_table};
use crate::trajectory::Trajectory;

const CONFIGURATION: &str = "config.toml";
const SUMMARY: &str = "summary.json";
const TIMESERIES: &str = "timeseries.parquet";
const TIMESERIES_CSV: &str = "timeseries.csv";
const PROFILE: &str = "profile.parquet";
const WAVES: &str = "waves.parquet";
const STATE: &str = "state.checkpoint";

/// A folder that holds one run, and no other.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
}

/// Which of the optional files are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// Tables as Parquet, figures, summary.
    Standard,
    /// The time series as CSV as well.
    WithCsv,
}

impl RunFolder {
    /// Makes a folder for a new run and writes its configuration there; an empty folder may exist.
    ///
    /// # Errors
    /// [`RunError::HoldsAnotherRun`] where one is there already, [`RunError::Folder`] where the folder cannot be made or
    /// written to. Nothing is changed in either case.
    pub fn create(path: &Path, configuration: &Configuration) -> Result<Self, RunError> {
        Self::check(path)?;
        let missing: Vec<&Path> = path
            .ancestors()
            .take_while(|it| !it.as_os_str().is_empty() && it.symlink_metadata().is_err())
            .collect();
        let path = path.to_owned();
        let folder = Self { path };
        folder.begin(configuration).inspect_err(|_| {
            // Deepest first; what another program has filled meanwhile stays, for only empty folders go.
            for made in missing {
                drop(std::fs::remove_dir(made));
            }
        })?;
        Ok(folder)
    }

    /// Makes the folder and writes the configuration.
    fn begin(&self, configuration: &Configuration) -> Result<(), RunError> {
        let refused = |source| RunError::Folder {
            folder: self.path.clone(),
            source,
        };
        std::fs::create_dir_all(&self.path).map_err(refused)?;
        let text = configuration.to_toml();
        atomic::write(&self.file(CONFIGURATION), text.as_bytes()).map_err(|error| match error {
            FormatError::Io { source, .. } => refused(source),
            other => other.into(),
        })
    }

    /// Whether a folder is free for a new run; makes nothing.
    ///
    /// # Errors
    /// [`RunError::HoldsAnotherRun`] where one is there already, [`RunError::Folder`] where there is a file of that name.
    pub fn check(path: &Path) -> Result<(), RunError> {
        if path.exists() && !path.is_dir() {
            return Err(RunError::Folder {
                folder: path.to_owned(),
                source: std::io::ErrorKind::NotADirectory.into(),
            });
        }
        let names = [CONFIGURATION, SUMMARY, TIMESERIES, PROFILE, WAVES, STATE];
        RunError::if_one_is_in(path, &names)?;
        Trajectory::check(path)
    }

    /// Opens the folder of a run that was stopped, to go on with it.
    ///
    /// # Errors
    /// [`RunError::NothingToResume`] where configuration or state is missing; [`RunError::State`] where the state is damaged,
    /// another run's or another version's; errors of the configuration.
    pub fn resume(path: &Path) -> Result<(Self, Run), RunError> {
        let (folder, run) = Self::open(path)?;
        if run.is_complete() {
            let (folder, reason) = (path.to_owned(), "it is complete".to_owned());
            return Err(RunError::NothingToResume { folder, reason });
        }
        Ok((folder, run))
    }

    /// Opens the folder of a run, finished or not, with its state.
    ///
    /// # Errors
    /// As [`RunFolder::resume`], but for a run that is complete.
    pub fn open(path: &Path) -> Result<(Self, Run), RunError> {
        let path = path.to_owned();
        let folder = Self { path };
        let missing = |name: &str, error: std::io::Error| RunError::NothingToResume {
            folder: folder.path.clone(),
            reason: format!("{name}: {error}"),
        };
        let name = folder.file(CONFIGURATION);
        let text = std::fs::read_to_string(&name);
        let text = text.map_err(|error| missing(CONFIGURATION, error))?;
        let configuration = Configuration::from_toml(&name.display().to_string(), &text)?;
        let path = folder.file(STATE);
        let state = std::fs::read(&path).map_err(|error| missing(STATE, error))?;
        let run = Run::from_snapshot(&state).and_then(|run| run.under(configuration));
        let run = run.map_err(|source| {
            let source = Box::new(source);
            RunError::State { path, source }
        })?;
        Ok((folder, run))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves the state, so that the run can go on from here.
    ///
    /// # Errors
    /// [`RunError::Format`] where the file cannot be written; an older state stays.
    pub fn save_state(&self, run: &Run) -> Result<(), RunError> {
        run.write_checkpoint(&self.file(STATE))
    }

    /// Writes tables, state, summary and figures; the summary after the tables, so that its presence says they are there.
    ///
    /// # Errors
    /// The first file that cannot be written or drawn.
    pub fn finish(&self, run: &Run, summary: &Summary, written: Written) -> Result<(), RunError> {
        let timeseries = timeseries_table(run)?;
        parquet::write(&self.file(TIMESERIES), &timeseries)?;
        if written == Written::WithCsv {
            csv::write(&self.file(TIMESERIES_CSV), &timeseries)?;
        }
        parquet::write(&self.file(PROFILE), &profile_table(run)?)?;
        parquet::write(&self.file(WAVES), &waves_table(run)?)?;
        self.save_state(run)?;
        atomic::write(&self.file(SUMMARY), summary.to_json().as_bytes())?;
        for (name, drawing) in pictures::draw_all(run, summary)? {
            atomic::write(&self.file(&format!("{name}.svg")), drawing.svg().as_bytes())?;
            let png = drawing.png().map_err(RunError::of_figure(name))?;
            atomic::write(&self.file(&format!("{name}.png")), &png)?;
        }
        Ok(())
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}
