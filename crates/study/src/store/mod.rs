//! The store of a study: a folder that keeps its runs.
//!
//! ```text
//! study.toml               the study file (with base.toml, if it builds on a file)
//! index.sqlite             what the files say of each run, and who works on it
//! runs/<identity>/         config.toml, state.checkpoint, state.checkpoint.1, products, done.json
//! quarantine/<identity>.N/ files that were not what had been written
//! imported/                tables of finished runs
//! ```
//!
//! The files are the truth. A run is done when its seal `done.json` is there and the hashes in it check.

mod archive;
mod export;
mod index;
mod owner;
mod run_files;
mod seal;

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use peristalsis_formats::{atomic, csv, parquet};
use sha2::{Digest, Sha256};

use crate::error::StudyError;
use crate::identity::{Identity, hexadecimal};
use crate::plan::Plan;
use crate::refinement::{Finding, refine};
use crate::row::Row;
use crate::specification::Specification;
pub use archive::Packed;
pub use export::Exported;
pub(crate) use index::{Claim, Index};
pub use index::{Entry, State};
pub(crate) use owner::Owner;
pub(crate) use run_files::{Assignment, RunFiles, Verdict};

const STUDY: &str = "study.toml";
const BASE: &str = "base.toml";
const INDEX: &str = "index.sqlite";
const RUNS: &str = "runs";
const QUARANTINE: &str = "quarantine";
const IMPORTED: &str = "imported";
const REASON: &str = "reason.txt";

/// How long an owner of whom nothing else is known may be silent before its lease is void.
pub const LEASE_TIMEOUT: Duration = Duration::from_secs(180);

/// A folder that keeps the runs of a study.
#[derive(Clone, Debug)]
pub struct Store {
    path: PathBuf,
}

/// All that is known of a study and its runs at one moment.
#[derive(Clone, Debug)]
pub struct Survey {
    /// The study.
    pub study: Specification,
    /// Its runs, with those that refinement has added.
    pub plan: Plan,
    /// What is known of each run, those of other plans of the same store included.
    pub entries: HashMap<Identity, Entry>,
    /// Which runs are being worked on, and by whom, in words.
    pub leases: HashMap<Identity, String>,
}

impl Survey {
    /// What has become of a run.
    #[must_use]
    pub fn state(&self, identity: Identity) -> State {
        let state = self
            .entries
            .get(&identity)
            .map_or(State::Pending, |entry| entry.state);
        if state != State::Done && self.leases.contains_key(&identity) {
            return State::Leased;
        }
        state
    }

    /// Runs of the plan in each state.
    #[must_use]
    pub fn counts(&self) -> BTreeMap<&'static str, usize> {
        let mut counts = BTreeMap::new();
        for run in self.plan.runs() {
            *counts.entry(self.state(run.identity).name()).or_default() += 1;
        }
        counts
    }

    /// What a run that has ended says of its point.
    #[must_use]
    pub fn finding(&self, identity: &Identity) -> Option<Finding> {
        finding(&self.entries, identity)
    }

    /// The run whose identity begins so, in the plan or not.
    ///
    /// # Errors
    /// [`StudyError::NoSuchRun`] unless there is exactly one.
    pub fn run_beginning(&self, prefix: &str) -> Result<Identity, StudyError> {
        let mut found: Vec<Identity> = self
            .plan
            .runs()
            .iter()
            .map(|run| run.identity)
            .chain(self.entries.keys().copied())
            .filter(|identity| identity.to_string().starts_with(prefix))
            .collect();
        found.sort();
        found.dedup();
        match found.as_slice() {
            [one] => Ok(*one),
            several => Err(StudyError::NoSuchRun {
                prefix: prefix.to_owned(),
                number: several.len(),
            }),
        }
    }
}

/// What a run that has ended says of its point.
pub(crate) fn finding(entries: &HashMap<Identity, Entry>, identity: &Identity) -> Option<Finding> {
    let entry = entries.get(identity)?;
    match entry.state {
        State::Done if entry.transition_time.is_some() => Some(Finding::Transition),
        State::Done => Some(Finding::NoTransition),
        State::Failed => Some(Finding::Nothing),
        _ => None,
    }
}

/// What a check of the files found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verification {
    /// Finished runs whose hashes check.
    pub whole: usize,
    /// Finished runs of which only the row is there, imported.
    pub imported: usize,
    /// Runs that were not what had been sealed, with what was wrong; their files were moved aside.
    pub quarantined: Vec<(Identity, String)>,
    /// Runs that can go on from a checkpoint.
    pub checkpointed: usize,
    /// Runs that ended in an error.
    pub failed: usize,
}

impl Store {
    /// Opens the store of a study, or makes one in a folder that is missing or empty; the store's copy of the study file
    /// becomes this one.
    ///
    /// # Errors
    /// [`StudyError::OtherStudy`], [`StudyError::NoStore`] where the folder holds other files, errors of writing.
    pub fn create(path: &Path, study: &Specification) -> Result<Self, StudyError> {
        let store = Self {
            path: path.to_owned(),
        };
        if store.file(STUDY).exists() {
            let found = store.specification()?.name;
            if found != study.name {
                return Err(StudyError::OtherStudy {
                    path: path.to_owned(),
                    found,
                    expected: study.name.clone(),
                });
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
        let mut copies = vec![(STUDY, study.text_with_base(BASE))];
        if let Some(base) = study.base_text() {
            copies.insert(0, (BASE, base.to_owned()));
        }
        for (name, text) in copies {
            let path = store.file(name);
            if fs::read(&path).ok().as_deref() != Some(text.as_bytes()) {
                atomic::write(&path, text.as_bytes())?;
            }
        }
        Ok(store)
    }

    /// Whether nothing is in the folder but what a process leaves that is making a store just now, or was killed doing so.
    fn holds_nothing_else(&self) -> bool {
        let is_ours = |name: &str| {
            [STUDY, BASE, RUNS].contains(&name)
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
    pub fn open(path: &Path) -> Result<Self, StudyError> {
        let store = Self {
            path: path.to_owned(),
        };
        if !store.file(STUDY).is_file() {
            return Err(StudyError::NoStore {
                path: path.to_owned(),
                reason: format!("there is no {STUDY}"),
            });
        }
        Ok(store)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The folder of a run, which may not be there.
    #[must_use]
    pub fn run_folder(&self, identity: Identity) -> PathBuf {
        self.file(RUNS).join(identity.to_string())
    }

    pub(crate) fn run_files(&self, identity: Identity) -> RunFiles {
        RunFiles::new(&self.file(RUNS), identity)
    }

    /// The study that the store keeps.
    ///
    /// # Errors
    /// As [`Specification::read`].
    pub fn specification(&self) -> Result<Specification, StudyError> {
        Specification::read(&self.file(STUDY))
    }

    /// The index, made from the files where there was none.
    pub(crate) fn index(&self) -> Result<Index, StudyError> {
        let (mut index, is_new) = Index::open(&self.file(INDEX))?;
        if is_new {
            self.fill(&mut index)?;
        }
        Ok(index)
    }

    /// All that is known of the study and its runs.
    ///
    /// # Errors
    /// Errors of reading study file or index.
    pub fn survey(&self) -> Result<Survey, StudyError> {
        let study = self.specification()?;
        let index = self.index()?;
        let entries = index.entries()?;
        let leases = index
            .leases(LEASE_TIMEOUT)?
            .into_iter()
            .map(|(identity, lease)| (identity, lease.in_words()))
            .collect();
        let mut plan = Plan::of(&study)?;
        refine(&study, &mut plan, &|identity| finding(&entries, identity))?;
        Ok(Survey {
            study,
            plan,
            entries,
            leases,
        })
    }

    /// Makes the index again from the files, every hash checked.
    ///
    /// # Errors
    /// Errors of reading or moving files.
    pub fn scan(&self) -> Result<Verification, StudyError> {
        let (mut index, _) = Index::open(&self.file(INDEX))?;
        self.fill(&mut index)
    }

    /// Checks every hash of every finished run; what does not match is moved aside, and will be computed again.
    ///
    /// # Errors
    /// Errors of moving files.
    pub fn verify(&self) -> Result<Verification, StudyError> {
        self.scan()
    }

    /// Looks whether the files of finished runs have changed since their hashes were checked, checks those that have, and
    /// moves aside what does not match; answers what happened, in words. A file whose time changed and whose content did
    /// not stays.
    pub(crate) fn check_changed(
        &self,
        index: &mut Index,
        timeout: Duration,
    ) -> Result<Vec<String>, StudyError> {
        let leases = index.leases(timeout)?;
        let mut news = Vec::new();
        let mut changed = Vec::new();
        for (identity, entry) in index.entries()? {
            let computed = entry.state == State::Done && entry.reason.is_none();
            if !computed || leases.contains_key(&identity) {
                continue;
            }
            match self.run_files(identity).verdict(entry.stamp.as_deref()) {
                Verdict::Done { row, stamp } => {
                    if stamp != entry.stamp {
                        changed.push((identity, done(&row, stamp)));
                    }
                }
                Verdict::Damaged(reason) => {
                    self.quarantine_run(identity, &reason)?;
                    news.push(format!(
                        "run {identity} is not what was sealed ({reason}): moved aside, to be computed again"
                    ));
                    changed.push((identity, Entry::new(State::Quarantined, Some(reason))));
                }
                Verdict::Nothing | Verdict::Checkpointed | Verdict::Failed(_) => {
                    news.push(format!(
                        "run {identity} was finished, and its files are gone: to be computed again"
                    ));
                    changed.push((identity, Entry::new(State::Pending, None)));
                }
            }
        }
        index.note(changed.iter().map(|(identity, entry)| (*identity, entry)))?;
        Ok(news)
    }

    fn fill(&self, index: &mut Index) -> Result<Verification, StudyError> {
        let mut found = Verification::default();
        let mut entries = self.imported()?;
        let leases = index.leases(LEASE_TIMEOUT)?;
        for identity in self.identities(RUNS)? {
            let files = self.run_files(identity);
            let entry = match files.verdict(None) {
                Verdict::Nothing => continue,
                Verdict::Checkpointed => {
                    found.checkpointed += 1;
                    Entry::new(State::Checkpointed, None)
                }
                Verdict::Done { row, stamp } => {
                    found.whole += 1;
                    files.remove_checkpoints();
                    done(&row, stamp)
                }
                // Its owner may be writing it just now.
                Verdict::Damaged(_) if leases.contains_key(&identity) => continue,
                Verdict::Damaged(reason) => {
                    self.quarantine_run(identity, &reason)?;
                    found.quarantined.push((identity, reason.clone()));
                    Entry::new(State::Quarantined, Some(reason))
                }
                Verdict::Failed(reason) => {
                    found.failed += 1;
                    Entry::new(State::Failed, Some(reason))
                }
            };
            // What was computed here goes before what was imported; what was not finished does not.
            if entry.state == State::Done || !entries.contains_key(&identity) {
                entries.insert(identity, entry);
            }
        }
        for identity in self.identities(QUARANTINE)? {
            entries.entry(identity).or_insert_with(|| {
                Entry::new(State::Quarantined, self.reason_of_quarantine(identity))
            });
        }
        found.imported = entries
            .values()
            .filter(|entry| entry.state == State::Done && entry.reason.is_some())
            .count();
        index.replace(&entries)?;
        Ok(found)
    }

    /// Identities that the folders below name; other names are none of ours.
    fn identities(&self, folder: &str) -> Result<Vec<Identity>, StudyError> {
        let folder = self.file(folder);
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(StudyError::io("read", folder)(error)),
        };
        let mut identities = Vec::new();
        for entry in entries {
            let name = entry.map_err(StudyError::io("read", &folder))?.file_name();
            let name = name.to_string_lossy();
            let stem = name.split('.').next().unwrap_or_default();
            identities.extend(stem.parse::<Identity>());
        }
        identities.sort();
        identities.dedup();
        Ok(identities)
    }

    /// Moves all files of a run aside, with the reason.
    pub(crate) fn quarantine_run(
        &self,
        identity: Identity,
        reason: &str,
    ) -> Result<PathBuf, StudyError> {
        self.quarantine(&self.run_folder(identity), identity, reason, false)
    }

    /// Moves one file of a run aside, with the reason.
    pub(crate) fn quarantine_file(
        &self,
        file: &Path,
        identity: Identity,
        reason: &str,
    ) -> Result<PathBuf, StudyError> {
        self.quarantine(file, identity, reason, true)
    }

    fn quarantine(
        &self,
        from: &Path,
        identity: Identity,
        reason: &str,
        into_new_folder: bool,
    ) -> Result<PathBuf, StudyError> {
        let quarantine = self.file(QUARANTINE);
        fs::create_dir_all(&quarantine).map_err(StudyError::io("make", &quarantine))?;
        let folder = free(|number| quarantine.join(format!("{identity}.{number}")));
        let target = if into_new_folder {
            fs::create_dir(&folder).map_err(StudyError::io("make", &folder))?;
            folder.join(from.file_name().unwrap_or_default())
        } else {
            folder.clone()
        };
        fs::rename(from, &target).map_err(StudyError::io("move aside", from))?;
        atomic::write(&folder.join(REASON), format!("{reason}\n").as_bytes())?;
        Ok(folder)
    }

    fn reason_of_quarantine(&self, identity: Identity) -> Option<String> {
        self.quarantines(identity)
            .last()
            .and_then(|folder| fs::read_to_string(folder.join(REASON)).ok())
            .map(|text| text.trim().to_owned())
    }

    /// The folders that files of a run were moved aside to, in this order.
    #[must_use]
    pub fn quarantines(&self, identity: Identity) -> Vec<PathBuf> {
        (1_u32..)
            .map(|number| self.file(QUARANTINE).join(format!("{identity}.{number}")))
            .take_while(|folder| folder.exists())
            .collect()
    }

    /// Lets a run that failed, or is finished, be computed again; its files are moved aside. Answers false for a run that
    /// is neither, or that is worked on.
    ///
    /// # Errors
    /// Errors of moving files, and of the index.
    pub fn retry(&self, identity: Identity) -> Result<bool, StudyError> {
        let mut index = self.index()?;
        let state = index.entry(identity)?.map(|entry| entry.state);
        let leased = index.leases(LEASE_TIMEOUT)?.contains_key(&identity);
        if leased || !matches!(state, Some(State::Failed | State::Done)) {
            return Ok(false);
        }
        let reason = "to be computed again, as asked for";
        if self.run_folder(identity).exists() {
            self.quarantine_run(identity, reason)?;
        }
        let entry = Entry::new(State::Quarantined, Some(reason.to_owned()));
        index.note([(identity, &entry)])?;
        Ok(true)
    }

    /// Takes rows of finished runs from a table, CSV or Parquet, by their identity; answers how many it has.
    ///
    /// The table is copied into the store. A run that is finished here stays as it is.
    ///
    /// # Errors
    /// [`StudyError::NotRows`] and errors of reading.
    pub fn import_table(&self, path: &Path) -> Result<usize, StudyError> {
        let rows = rows_of(path)?;
        let number = rows.len();
        let Some(first) = rows.first() else {
            return Ok(0);
        };
        let mut table = first.table().clone();
        for row in &rows[1..] {
            table.append(row.table().clone())?;
        }
        let text = csv::encode(&table);
        let folder = self.file(IMPORTED);
        fs::create_dir_all(&folder).map_err(StudyError::io("make", &folder))?;
        let name = hexadecimal(&Sha256::digest(text.as_bytes())[..8]);
        atomic::write(&folder.join(format!("{name}.csv")), text.as_bytes())?;
        let mut index = self.index()?;
        let known = index.entries()?;
        let new: Vec<(Identity, Entry)> = rows
            .iter()
            .filter(|row| {
                known
                    .get(&row.identity())
                    .is_none_or(|entry| entry.state != State::Done)
            })
            .map(|row| (row.identity(), imported_entry(row, &name)))
            .collect();
        index.note(new.iter().map(|(identity, entry)| (*identity, entry)))?;
        Ok(number)
    }

    /// The rows of all imported tables.
    fn imported(&self) -> Result<HashMap<Identity, Entry>, StudyError> {
        let folder = self.file(IMPORTED);
        let Ok(entries) = fs::read_dir(&folder) else {
            return Ok(HashMap::new());
        };
        let mut found = HashMap::new();
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths
            .iter()
            .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            // A copy carries its hash in its name; one that was damaged must be imported again.
            let bytes = fs::read(path).map_err(StudyError::io("read", path))?;
            if hexadecimal(&Sha256::digest(&bytes)[..8]) != name {
                set_aside(path, "damaged")?;
                continue;
            }
            for row in rows_of(path)? {
                found.insert(row.identity(), imported_entry(&row, &name));
            }
        }
        Ok(found)
    }
}

/// The rows in a table of a file, whose ending says how it is written.
fn rows_of(path: &Path) -> Result<Vec<Row>, StudyError> {
    let table = match path.extension().and_then(|extension| extension.to_str()) {
        Some("parquet") => parquet::read(path)?,
        _ => csv::read(path)?,
    };
    if table.rows() == 0 {
        return Ok(Vec::new());
    }
    Row::all_of(&table).map_err(|reason| StudyError::NotRows {
        path: path.to_owned(),
        reason,
    })
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

fn imported_entry(row: &Row, table: &str) -> Entry {
    Entry {
        reason: Some(format!("imported with {IMPORTED}/{table}.csv")),
        ..done(row, None)
    }
}

/// The first name that is not taken.
fn free(name: impl Fn(u32) -> PathBuf) -> PathBuf {
    (1_u32..)
        .map(name)
        .find(|path| path.symlink_metadata().is_err())
        .expect("there are fewer files than numbers")
}

/// Renames a file to one that says why.
pub(crate) fn set_aside(path: &Path, why: &str) -> Result<(), StudyError> {
    let aside = free(|number| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{why}-{number}"));
        path.with_file_name(name)
    });
    fs::rename(path, &aside).map_err(StudyError::io("move aside", path))
}
