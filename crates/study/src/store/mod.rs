//! The store of a study: a folder that keeps its runs.
//!
//! ```text
//! study.toml               the study file (with base.toml, if it builds on a file)
//! tables/                  the tables that both name
//! index.sqlite             what the files say of each run, and who works on it
//! runs/<identity>/         config.toml, state.checkpoint, state.checkpoint.1, products, done.json
//! quarantine/<identity>.N/ files that were not what had been written
//! imported/                tables of finished runs
//! ```
//!
//! The files are the truth. A run is done when its seal `done.json` is there and the hashes in it check.

mod archive;
mod check;
mod entry;
mod export;
mod import;
mod index;
mod owner;
mod run_files;
mod seal;
mod staleness;
mod survey;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use peristalsis_formats::atomic;

use crate::error::{Result, StudyError};
use crate::identity::Identity;
use crate::row::Row;
use crate::specification::Specification;
pub use archive::Packed;
pub use check::Verification;
pub use entry::{Entry, State};
pub use export::Exported;
pub(crate) use index::{Claim, Index};
pub(crate) use owner::Owner;
pub(crate) use run_files::{Assignment, RunFiles, Verdict};
pub use seal::SEAL;
pub use staleness::Staleness;
pub use survey::Survey;
pub(crate) use survey::finding;

/// The file by which a store is known.
pub const STUDY: &str = "study.toml";
const BASE: &str = "base.toml";
const TABLES: &str = "tables";
const INDEX: &str = "index.sqlite";
const RUNS: &str = "runs";
const QUARANTINE: &str = "quarantine";
const IMPORTED: &str = "imported";
const REASON: &str = "reason.txt";

/// Of a run that was finished, that it has no seal.
const GONE: &str = "its seal, done.json, is gone";

/// What is said of a finished run whose files differ from its seal.
pub fn not_whole(identity: Identity, reason: &str) -> String {
    format!(
        "run {identity} is not as it was sealed ({reason}): to be computed again; files that differ are moved aside"
    )
}

/// How long an owner of whom nothing else is known may be silent before its lease is void.
pub(crate) const LEASE_TIMEOUT: Duration = Duration::from_secs(180);

/// A folder that keeps the runs of a study.
#[derive(Clone, Debug)]
pub struct Store {
    path: PathBuf,
    /// The study that is asked about, where it is not that of the store's file.
    asked: Option<Specification>,
    /// The study as it was read last: its runs are found once while its file stays as it is.
    study: Arc<Mutex<Option<Specification>>>,
}

impl Store {
    /// Opens the store of a study, or makes one in a folder that is missing or empty; the store's copy of the study file
    /// becomes this one. What it answers is about this study, also when its file has become another since.
    ///
    /// # Errors
    /// [`StudyError::OtherStudy`], [`StudyError::NoStore`] where the folder holds other files, errors of writing.
    pub fn create(path: &Path, study: &Specification) -> Result<Self> {
        let store = Self::at(path).asked(study)?;
        if store.file(STUDY).exists() {
            // The copy is damaged; the runs are what they are.
            if store.name().is_none() {
                set_aside(&store.file(STUDY))?;
            }
        } else if !store.holds_nothing_else() {
            return Err(StudyError::NoStore {
                path: path.to_owned(),
                reason: "it holds other files".to_owned(),
            });
        }
        for folder in [path.to_owned(), store.file(RUNS)] {
            fs::create_dir_all(&folder).map_err(StudyError::io("make", folder))?;
        }
        for (name, text) in study.copies(STUDY, BASE, TABLES) {
            let file = store.file(&name);
            let folder = file.parent().unwrap_or(path);
            fs::create_dir_all(folder).map_err(StudyError::io("make", folder))?;
            write_if_other(&file, &text)?;
        }
        Ok(store)
    }

    /// Opens a store to ask about this study, which its file need not be: the file stays as it is.
    ///
    /// # Errors
    /// [`StudyError::NoStore`], [`StudyError::OtherStudy`] where it is that of a study of another name.
    pub fn open_for(path: &Path, study: &Specification) -> Result<Self> {
        Self::open(path)?.asked(study)
    }

    fn asked(self, study: &Specification) -> Result<Self> {
        match self.name() {
            Some(found) if found != study.name => Err(StudyError::OtherStudy {
                path: self.path,
                found,
                expected: study.name.clone(),
            }),
            _ => Ok(Self {
                asked: Some(study.clone()),
                ..self
            }),
        }
    }

    fn at(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            asked: None,
            study: Arc::default(),
        }
    }

    fn study(&self) -> MutexGuard<'_, Option<Specification>> {
        // Each change is one assignment: the study is whole even after a panic.
        self.study.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Name of the study that the copy of the study file gives, whatever else may be wrong with it.
    fn name(&self) -> Option<String> {
        let text = fs::read_to_string(self.file(STUDY)).ok()?;
        let table: toml::Table = toml::from_str(&text).ok()?;
        Some(table.get("name")?.as_str()?.to_owned())
    }

    /// Whether nothing is in the folder but what a process leaves that is making a store just now, or was killed doing so.
    fn holds_nothing_else(&self) -> bool {
        let is_ours = |name: &str| {
            [STUDY, BASE, TABLES, RUNS].contains(&name)
                || name.starts_with(INDEX)
                || name.ends_with(atomic::PARTIAL_SUFFIX)
        };
        fs::read_dir(&self.path).map_or(true, |entries| {
            entries
                .flatten()
                .all(|entry| entry.file_name().to_str().is_some_and(is_ours))
        })
    }

    /// Opens a store.
    ///
    /// # Errors
    /// [`StudyError::NoStore`].
    pub fn open(path: &Path) -> Result<Self> {
        let store = Self::at(path);
        if !store.file(STUDY).is_file() {
            return Err(StudyError::NoStore {
                path: path.to_owned(),
                reason: format!("there is no {STUDY}"),
            });
        }
        Ok(store)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The folder of a run, which may not be there.
    pub fn run_folder(&self, identity: Identity) -> PathBuf {
        self.file(RUNS).join(identity.to_string())
    }

    /// Whether the products of a finished run are here; an imported run may have only its row.
    pub fn holds_products(&self, identity: Identity) -> bool {
        self.run_files(identity).is_sealed()
    }

    pub(crate) fn run_files(&self, identity: Identity) -> RunFiles {
        RunFiles::new(&self.file(RUNS), identity)
    }

    /// The study that the store was opened for, or that of its file.
    ///
    /// # Errors
    /// As [`Specification::read`].
    pub fn specification(&self) -> Result<Specification> {
        if let Some(study) = &self.asked {
            return Ok(study.clone());
        }
        let (path, base) = (self.file(STUDY), self.file(BASE));
        let mut last = self.study();
        if let Some(study) = last.as_ref().filter(|study| study.is_still(&path, &base)) {
            return Ok(study.clone());
        }
        let study = Specification::read(&path)?;
        *last = Some(study.clone());
        Ok(study)
    }

    /// The index, made from the files where there was none.
    pub(crate) fn index(&self) -> Result<Index> {
        let (mut index, is_new) = Index::open(&self.file(INDEX))?;
        if is_new {
            self.fill(&mut index)?;
        }
        Ok(index)
    }

    /// The index, to be looked at only; as it stands, where the store cannot be written to.
    pub(crate) fn index_to_read(&self) -> Result<Index> {
        self.index()
            .or_else(|refusal| Index::open_to_read(&self.file(INDEX), refusal))
    }
}

/// The entry of a run that is finished here.
pub(crate) fn done(row: &Row, stamp: Option<String>) -> Entry {
    Entry {
        row: Some(row.to_csv()),
        transition_time: row.transition_time(),
        stamp,
        ..Entry::new(State::Done, None)
    }
}

/// Writes a text unless the file has it already.
fn write_if_other(path: &Path, text: &str) -> Result<()> {
    if fs::read(path).is_ok_and(|found| found == text.as_bytes()) {
        return Ok(());
    }
    Ok(atomic::write(path, text.as_bytes())?)
}

/// The first name that is not taken.
fn free(name: impl Fn(u32) -> PathBuf) -> PathBuf {
    (1_u32..)
        .map(name)
        .find(|path| path.symlink_metadata().is_err())
        .expect("there are fewer files than numbers")
}

/// Renames a damaged file to one that says so.
pub(crate) fn set_aside(path: &Path) -> Result<()> {
    let aside = free(|number| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".damaged-{number}"));
        path.with_file_name(name)
    });
    fs::rename(path, &aside).map_err(StudyError::io("move aside", path))
}
