//! Checks the files of a store against their seals; a damaged file is moved aside.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use peristalsis_formats::atomic;

use super::{
    Entry, GONE, INDEX, Index, LEASE_TIMEOUT, QUARANTINE, REASON, RUNS, State, Store, Verdict,
    done, free, not_whole,
};
use crate::error::{Result, StudyError};
use crate::identity::Identity;

/// Result of a check of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verification {
    /// Finished runs whose hashes check.
    pub whole: usize,
    /// Finished runs with an imported row and no files.
    pub imported: usize,
    /// Runs that were finished and have no seal, or files that differ from it, with what is wrong; the latter were moved aside.
    pub quarantined: Vec<(Identity, String)>,
    /// Copies of imported tables that are gone, or were changed and moved aside, with the number of runs that went with each.
    pub lost_tables: BTreeMap<String, usize>,
    /// Runs that can go on from a checkpoint.
    pub checkpointed: usize,
    /// Runs that ended in an error.
    pub failed: usize,
}

impl Store {
    /// Checks every hash of every finished run, and makes the index again from the files; what does not match is moved
    /// aside, and will be computed again.
    ///
    /// # Errors
    /// Errors of reading or moving files.
    pub fn scan(&self) -> Result<Verification> {
        let (mut index, _) = Index::open(&self.file(INDEX))?;
        self.fill(&mut index)
    }

    /// Looks whether the files of finished runs have changed since their hashes were checked, checks those that have, and
    /// moves aside what does not match; answers what happened, in words. A file whose time changed and whose content did
    /// not stays.
    pub(crate) fn check_changed(&self, index: &mut Index) -> Result<Vec<String>> {
        let leases = index.leases(LEASE_TIMEOUT)?;
        let mut news = Vec::new();
        let mut changed = Vec::new();
        for (identity, entry) in index.entries()? {
            if !entry.is_computed() || leases.contains_key(&identity) {
                continue;
            }
            match self.run_files(identity).verdict(entry.stamp.as_deref()) {
                Verdict::Done { row, stamp } => {
                    if stamp != entry.stamp {
                        changed.push((identity, done(&row, stamp)));
                    }
                }
                lost => {
                    let (reason, entry) = self.let_go(identity, lost)?;
                    news.push(not_whole(identity, &reason));
                    changed.push((identity, entry));
                }
            }
        }
        index.note(changed.iter().map(|(identity, entry)| (*identity, entry)))?;
        Ok(news)
    }

    /// What is wrong with a run that was finished and is not as it was sealed, and its entry from now on; files that differ from
    /// the seal are moved aside.
    pub(super) fn let_go(&self, identity: Identity, lost: Verdict) -> Result<(String, Entry)> {
        let reason = match &lost {
            Verdict::Damaged(reason) => {
                self.quarantine_run(identity, reason)?;
                reason.clone()
            }
            _ => GONE.to_owned(),
        };
        Ok((reason, lost.entry()))
    }

    pub(super) fn fill(&self, index: &mut Index) -> Result<Verification> {
        let before = index.findings()?;
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
        for (identity, entry) in index.entries()? {
            if entries.contains_key(&identity) || leases.contains_key(&identity) {
                continue;
            }
            if entry.is_computed() {
                found.quarantined.push((identity, GONE.to_owned()));
            } else if let Some(table) = entry.table() {
                *found.lost_tables.entry(table.to_owned()).or_default() += 1;
            }
        }
        for identity in self.identities(QUARANTINE)? {
            entries.entry(identity).or_insert_with(|| {
                Entry::new(State::Quarantined, self.reason_of_quarantine(identity))
            });
        }
        let is_imported = |entry: &&Entry| entry.state == State::Done && entry.reason.is_some();
        found.imported = entries.values().filter(is_imported).count();
        index.replace(&entries, &before)?;
        Ok(found)
    }

    /// Identities that the folders below name; other names are skipped.
    pub(super) fn identities(&self, folder: &str) -> Result<Vec<Identity>> {
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
    pub(crate) fn quarantine_run(&self, identity: Identity, reason: &str) -> Result<PathBuf> {
        self.quarantine(&self.run_folder(identity), identity, reason)
    }

    /// Moves the folder of a run, or one file of it, aside, with the reason.
    pub(crate) fn quarantine(
        &self,
        from: &Path,
        identity: Identity,
        reason: &str,
    ) -> Result<PathBuf> {
        let quarantine = self.file(QUARANTINE);
        fs::create_dir_all(&quarantine).map_err(StudyError::io("make", &quarantine))?;
        let folder = free(|number| quarantine.join(format!("{identity}.{number}")));
        let mut target = folder.clone();
        if from.is_file() {
            fs::create_dir(&folder).map_err(StudyError::io("make", &folder))?;
            target.extend(from.file_name());
        }
        fs::rename(from, &target).map_err(StudyError::io("move aside", from))?;
        atomic::write(&folder.join(REASON), format!("{reason}\n").as_bytes())?;
        Ok(folder)
    }

    fn reason_of_quarantine(&self, identity: Identity) -> Option<String> {
        let folders = self.quarantines(identity);
        let text = fs::read_to_string(folders.last()?.join(REASON)).ok()?;
        Some(text.trim().to_owned())
    }

    /// The folders that files of a run were moved aside to, in this order.
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
    pub fn retry(&self, identity: Identity) -> Result<bool> {
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
}
