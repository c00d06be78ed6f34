//! The folder of a run: configuration, summary, tables, figures, state.

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use peristalsis_configuration::Configuration;
use peristalsis_formats::{FormatError, atomic, csv, parquet};

use crate::error::RunError;
use crate::files::{CONFIGURATION, PROFILE, STATE, SUMMARY, TIMESERIES, WAVES};
use crate::pictures;
use crate::run::Run;
use crate::summary::{Status, Summary};
use crate::tables::{profile_table, timeseries_table, transit_table, waves_table};
use crate::trajectory::Trajectory;

const TIMESERIES_CSV: &str = "timeseries.csv";
const TRANSIT: &str = "transit.parquet";
/// Files that a run may leave besides its figures and trajectories.
const FILES: [&str; 8] = [
    CONFIGURATION,
    SUMMARY,
    TIMESERIES,
    TIMESERIES_CSV,
    PROFILE,
    WAVES,
    TRANSIT,
    STATE,
];
/// How files of figures end.
const ENDINGS: [&str; 2] = ["svg", "png"];

/// A folder that holds one run, and no other.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Held while this program works on the run, and given back by the system when it ends, however it does.
    lock: Option<Arc<File>>,
}

impl RunFolder {
    /// Makes a folder for a new run and writes its configuration there; an empty folder may exist. Of several programs that
    /// make the same folder at once, one gets it.
    ///
    /// # Errors
    /// [`RunError::HoldsAnotherRun`] where one is there already, [`RunError::Folder`] where the folder cannot be made or
    /// written to. Nothing is changed in either case.
    pub fn create(path: &Path, configuration: &Configuration) -> Result<Self, RunError> {
        Self::check(path)?;
        let folder = Self::named(path);
        let make = || std::fs::create_dir_all(&folder.path).map_err(folder.refused());
        or_undone(&folder.path, || {
            make()?;
            folder.begin(configuration)
        })?;
        folder.claim()
    }

    /// As [`RunFolder::create`], in the first free folder of `inside/stem-1`, `inside/stem-2`, ...; no other program gets it.
    ///
    /// # Errors
    /// [`RunError::Folder`] where it cannot be made or written to. Nothing is changed then.
    pub fn create_next(
        inside: &Path,
        stem: &str,
        configuration: &Configuration,
    ) -> Result<Self, RunError> {
        or_undone(inside, || {
            let folder = Self::named(&next_folder(inside, stem)?);
            folder.begin(configuration).inspect_err(|_| {
                drop(std::fs::remove_dir(&folder.path));
            })?;
            folder.claim()
        })
    }

    /// Writes the configuration, by which the folder is this run's.
    fn begin(&self, configuration: &Configuration) -> Result<(), RunError> {
        let text = configuration.to_toml();
        let begun = atomic::write_new(&self.file(CONFIGURATION), text.as_bytes());
        begun.map_err(|error| match error {
            FormatError::Io { source, .. } if source.kind() == ErrorKind::AlreadyExists => {
                let (folder, found) = (self.path.clone(), CONFIGURATION.to_owned());
                RunError::HoldsAnotherRun { folder, found }
            }
            FormatError::Io { source, .. } => self.refused()(source),
            other => other.into(),
        })
    }

    fn refused(&self) -> impl Fn(std::io::Error) -> RunError {
        let folder = self.path.clone();
        move |source| RunError::Folder {
            folder: folder.clone(),
            source,
        }
    }

    /// Takes the folder of a new run away again, if nothing but its configuration is there.
    pub fn abandon(self) {
        drop(std::fs::remove_file(self.file(CONFIGURATION)));
        drop(std::fs::remove_dir(&self.path));
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
        RunError::if_one_is_in(path, &FILES)?;
        for ending in ENDINGS {
            let names = pictures::NAMES.map(|name| format!("{name}.{ending}"));
            RunError::if_one_is_in(path, &names.each_ref().map(String::as_str))?;
        }
        Trajectory::check(path)
    }

    /// Opens the folder of a run, finished or not, with its state.
    ///
    /// # Errors
    /// [`RunError::NoRun`] where configuration or state is missing; [`RunError::State`] where the state is damaged,
    /// another run's or another version's; errors of the configuration.
    pub fn open(path: &Path) -> Result<(Self, Run), RunError> {
        let folder = Self::named(path);
        let run = folder.run()?;
        Ok((folder, run))
    }

    /// The run in it, finished or not, with its state.
    ///
    /// # Errors
    /// As [`RunFolder::open`].
    pub fn run(&self) -> Result<Run, RunError> {
        let configuration = self.configuration()?;
        let run = self.state()?;
        run.under(configuration).map_err(|source| RunError::State {
            path: self.file(STATE),
            source: Box::new(source),
        })
    }

    /// Locks the folder for work on its run, until this value is dropped or the program ends; other programs may still read
    /// it. A file system without locks locks nothing. New folders are locked when they are made. Files that a killed program
    /// left half-written are deleted.
    ///
    /// # Errors
    /// [`RunError::AtWork`] where another program, or another value of this one, has it.
    pub fn claim(mut self) -> Result<Self, RunError> {
        // The folder itself: a file of its own would be left behind by a program that is killed.
        let Ok(opened) = File::open(&self.path) else {
            return Ok(self);
        };
        match opened.try_lock() {
            Err(TryLockError::WouldBlock) => Err(RunError::AtWork { folder: self.path }),
            _ => {
                atomic::sweep(&self.path);
                self.lock = Some(Arc::new(opened));
                Ok(self)
            }
        }
    }

    /// A folder that may hold a run.
    pub fn named(path: &Path) -> Self {
        let (path, lock) = (path.to_owned(), None);
        Self { path, lock }
    }

    /// The configuration in the folder.
    ///
    /// # Errors
    /// [`RunError::NoRun`] where it is missing; errors of the configuration.
    pub fn configuration(&self) -> Result<Configuration, RunError> {
        let name = self.file(CONFIGURATION);
        let text =
            std::fs::read_to_string(&name).map_err(|error| self.missing(CONFIGURATION, &error))?;
        Ok(Configuration::from_toml(
            &name.display().to_string(),
            &text,
        )?)
    }

    /// The run as its state in the folder was saved, with the configuration in it.
    ///
    /// # Errors
    /// As [`RunFolder::open`].
    pub fn state(&self) -> Result<Run, RunError> {
        let state = self.file(STATE);
        read_state(&state).map_err(|error| match error {
            RunError::Format(FormatError::Io { source, .. }) => self.missing(STATE, &source),
            error => error,
        })
    }

    /// Whether the folder has the results of this run as it stands: those of a state before, or of an interruption, are not.
    pub fn has_final_results_of(&self, run: &Run) -> bool {
        let interrupted = serde_json::to_value(Status::Interrupted).ok();
        self.summary().is_some_and(|summary| {
            summary["steps"] == run.simulation().step()
                && Some(&summary["status"]) != interrupted.as_ref()
        })
    }

    /// The summary in the folder, if one can be read.
    fn summary(&self) -> Option<serde_json::Value> {
        let text = std::fs::read_to_string(self.file(SUMMARY)).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// The files that its run may leave besides figures.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let names = FILES.into_iter().chain(Trajectory::names());
        names.map(|name| self.file(name))
    }

    /// Why the run in the folder diverged, if its summary says that it did.
    pub fn divergence(&self) -> Option<String> {
        let summary = self.summary()?;
        let diverged = serde_json::to_value(Status::Diverged).ok()?;
        (summary["status"] == diverged).then(|| {
            summary["message"]
                .as_str()
                .unwrap_or("it diverged")
                .to_owned()
        })
    }

    /// Whether the folder has a saved state.
    pub fn has_state(&self) -> bool {
        self.file(STATE).is_file()
    }

    fn missing(&self, name: &str, error: &std::io::Error) -> RunError {
        RunError::NoRun {
            folder: self.path.clone(),
            reason: format!("{name}: {error}"),
        }
    }

    /// Writes configuration and state of a run whose length has changed.
    ///
    /// # Errors
    /// [`RunError::Format`] where a file cannot be written; the older one stays.
    pub fn change_length(&self, run: &Run) -> Result<(), RunError> {
        let text = run.configuration().to_toml();
        self.save_state(run)?;
        Ok(atomic::write(&self.file(CONFIGURATION), text.as_bytes())?)
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

    /// Writes the time series as CSV: from now on [`RunFolder::finish`] renews it.
    ///
    /// # Errors
    /// [`RunError::Format`] where the file cannot be written; an older one stays.
    pub fn write_csv(&self, run: &Run) -> Result<(), RunError> {
        Ok(csv::write(
            &self.file(TIMESERIES_CSV),
            &timeseries_table(run)?,
        )?)
    }

    /// Writes state, tables, summary and figures, and answers the files of figures: the state first, from which the others
    /// can be made, and the summary after the tables, so that its presence says they are there. A time series in CSV that is
    /// there is renewed.
    ///
    /// # Errors
    /// The first file that cannot be written or drawn.
    pub fn finish(&self, run: &Run, summary: &Summary) -> Result<Vec<PathBuf>, RunError> {
        self.save_state(run)?;
        let timeseries = timeseries_table(run)?;
        parquet::write(&self.file(TIMESERIES), &timeseries)?;
        let text = self.file(TIMESERIES_CSV);
        if text.exists() {
            csv::write(&text, &timeseries)?;
        }
        parquet::write(&self.file(PROFILE), &profile_table(run)?)?;
        parquet::write(&self.file(WAVES), &waves_table(run)?)?;
        if let Some(transit) = transit_table(run)? {
            parquet::write(&self.file(TRANSIT), &transit)?;
        }
        atomic::write(&self.file(SUMMARY), summary.to_json().as_bytes())?;
        self.draw(run, summary)
    }

    /// Draws the figures of the run over those that there are, and answers their files. A figure that the run no longer has
    /// goes.
    ///
    /// # Errors
    /// The first file that cannot be written or drawn.
    pub fn draw(&self, run: &Run, summary: &Summary) -> Result<Vec<PathBuf>, RunError> {
        let drawings = pictures::draw_all(run, summary)?;
        let mut files = Vec::new();
        for name in pictures::NAMES {
            let [vectors, pixels] = ENDINGS.map(|ending| self.file(&format!("{name}.{ending}")));
            let Some((_, drawing)) = drawings.iter().find(|(known, _)| *known == name) else {
                drop(std::fs::remove_file(vectors));
                drop(std::fs::remove_file(pixels));
                continue;
            };
            atomic::write(&vectors, drawing.svg().as_bytes())?;
            atomic::write(&pixels, &drawing.png().map_err(RunError::of_figure(name))?)?;
            files.extend([vectors, pixels]);
        }
        Ok(files)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

/// A run from a file that holds its state, with the configuration in it.
///
/// # Errors
/// [`RunError::Format`] where the file cannot be read; [`RunError::State`] where it is damaged or another version's.
pub fn read_state(path: &Path) -> Result<Run, RunError> {
    let path = path.to_owned();
    let bytes = std::fs::read(&path).map_err(|source| FormatError::Io {
        operation: "read",
        path: path.clone(),
        source,
    })?;
    Run::from_snapshot(&bytes).map_err(|source| {
        let source = Box::new(source);
        RunError::State { path, source }
    })
}

/// Writes the state of a run to a file, whole or not at all.
///
/// # Errors
/// [`RunError::Format`] where it cannot be written, [`RunError::AtWork`] where the file belongs to a run on which another
/// program works; an older file stays.
pub fn write_state(run: &Run, path: &Path) -> Result<(), RunError> {
    let folder = path.parent().map(RunFolder::named);
    let is_of = |folder: &RunFolder| {
        path.file_name().is_some_and(|name| name == STATE) && folder.file(CONFIGURATION).exists()
    };
    let held = folder.filter(is_of).map(RunFolder::claim).transpose()?;
    let written = run.write_checkpoint(path);
    drop(held);
    written
}

/// Makes the first free one of the folders `inside/stem-1`, `inside/stem-2`, ...: no two programs get the same.
///
/// # Errors
/// [`RunError::Folder`] where it cannot be made.
pub fn next_folder(inside: &Path, stem: &str) -> Result<PathBuf, RunError> {
    let mut number = 1_u64;
    loop {
        let folder = inside.join(format!("{stem}-{number}"));
        let made = std::fs::create_dir_all(inside).and_then(|()| std::fs::create_dir(&folder));
        match made {
            Ok(()) => return Ok(folder),
            Err(error)
                if error.kind() == ErrorKind::AlreadyExists
                    && folder.symlink_metadata().is_ok() =>
            {
                number += 1;
            }
            Err(source) => return Err(RunError::Folder { folder, source }),
        }
    }
}

/// Makes things in a folder; where that fails, the folders that were made on the way go again.
fn or_undone<T>(path: &Path, make: impl FnOnce() -> Result<T, RunError>) -> Result<T, RunError> {
    let missing: Vec<&Path> = path
        .ancestors()
        .take_while(|it| !it.as_os_str().is_empty() && it.symlink_metadata().is_err())
        .collect();
    make().inspect_err(|_| {
        // Deepest first; what another program has filled meanwhile stays, for only empty folders go.
        for made in missing {
            drop(std::fs::remove_dir(made));
        }
    })
}
