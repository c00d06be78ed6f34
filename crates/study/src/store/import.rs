//! Rows of finished runs from tables, so that what was published need not be computed again.

use std::collections::HashMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use peristalsis_formats::{FormatError, atomic, csv, hexadecimal, read_table};
use sha2::{Digest, Sha256};

use super::{Entry, IMPORTED, Packed, State, Store, done, set_aside};
use crate::error::{Result, StudyError};
use crate::identity::Identity;
use crate::plan::PlannedRun;
use crate::row::Row;

impl Store {
    /// Takes rows of finished runs from a table, CSV or Parquet, by their identity; answers how many runs it has, and how many of
    /// them were taken.
    ///
    /// A run that is finished here stays as it is, and its row is not taken. The others are copied into the store. The table
    /// is refused if a row has other parameters than the study's run of its identity, or none that a finished run has, or if
    /// two rows of one identity differ.
    ///
    /// # Errors
    /// [`StudyError::NotRows`] and errors of reading.
    pub fn import_table(&self, path: &Path) -> Result<Packed> {
        let rows = rows_of(path)?;
        if rows.is_empty() {
            return Err(StudyError::not_rows(path)("it has no rows".to_owned()));
        }
        let survey = self.survey()?;
        let runs = survey.plan.runs().iter().map(|run| (run.identity, run));
        let runs: HashMap<Identity, &PlannedRun> = runs.collect();
        let mut first_of: HashMap<Identity, &Row> = HashMap::new();
        for row in &rows {
            let before = *first_of.entry(row.identity()).or_insert(row);
            let contradiction = runs
                .get(&row.identity())
                .and_then(|run| row.contradiction(run.replicate, &survey.plan.configuration(run)))
                .or_else(|| row.impossible())
                .or_else(|| row.conflict(before));
            if let Some(reason) = contradiction {
                return Err(StudyError::not_rows(path)(reason));
            }
        }
        let mut index = self.index()?;
        let known = index.entries()?;
        let is_new = |row: &&Row| {
            let identity = row.identity();
            let is_first = std::ptr::eq(first_of[&identity], *row);
            let entry = known.get(&identity);
            is_first && entry.is_none_or(|entry| entry.state != State::Done)
        };
        // These alone are copied: `scan` makes the index anew from the copies, and finds each run in one of them.
        let new: Vec<&Row> = rows.iter().filter(is_new).collect();
        let packed = Packed {
            runs: first_of.len(),
            taken: new.len(),
            different: first_of
                .iter()
                .filter(|(identity, row)| {
                    let entry = known.get(identity).filter(|it| it.state == State::Done);
                    let here = entry.and_then(|entry| Row::from_csv(entry.row.as_deref()?).ok());
                    here.is_some_and(|here| row.conflict(&here).is_some())
                })
                .count(),
            ..Packed::default()
        };
        let Some((first, others)) = new.split_first() else {
            return Ok(packed);
        };
        let mut table = first.table().clone();
        for row in others {
            table.append(row.table().clone())?;
        }
        let text = csv::encode(&table);
        let folder = self.file(IMPORTED);
        fs::create_dir_all(&folder).map_err(StudyError::io("make", &folder))?;
        let name = hexadecimal(&Sha256::digest(text.as_bytes())[..8]);
        atomic::write(&folder.join(format!("{name}.csv")), text.as_bytes())?;
        let entry_of = |row: &&Row| (row.identity(), imported_entry(row, &name));
        let entries: Vec<(Identity, Entry)> = new.iter().map(entry_of).collect();
        index.note(entries.iter().map(|(identity, entry)| (*identity, entry)))?;
        Ok(packed)
    }

    /// The rows of all imported tables; a table that is not what was written is moved aside.
    pub(super) fn imported(&self) -> Result<HashMap<Identity, Entry>> {
        let folder = self.file(IMPORTED);
        let Ok(entries) = fs::read_dir(&folder) else {
            return Ok(HashMap::new());
        };
        let mut found = HashMap::new();
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        let is_csv = |path: &&PathBuf| path.extension().is_some_and(|it| it == "csv");
        for path in paths.iter().filter(is_csv) {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            // A copy carries its hash in its name; one that was damaged must be imported again.
            let bytes = fs::read(path).map_err(StudyError::io("read", path))?;
            if hexadecimal(&Sha256::digest(&bytes)[..8]) != name {
                set_aside(path)?;
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
fn rows_of(path: &Path) -> Result<Vec<Row>> {
    let table = read_table(path).map_err(|error| match error {
        FormatError::Io { source, .. } if source.kind() == ErrorKind::InvalidData => {
            let reason =
                "it is no text; names of tables end in .csv or .parquet, of archives in .tar";
            StudyError::not_rows(path)(reason.to_owned())
        }
        FormatError::Io { source, .. } => StudyError::read(path)(source),
        other => StudyError::not_rows(path)(other.to_string()),
    })?;
    // A column without values is of no kind, so that none holds identities.
    let has_identities = table
        .columns()
        .iter()
        .any(|column| column.name == "identity");
    if table.rows() == 0 && has_identities {
        return Ok(Vec::new());
    }
    Row::all_of(&table).map_err(StudyError::not_rows(path))
}

/// How the reason of an imported entry begins; its table follows.
const IMPORTED_WITH: &str = "imported with ";

fn imported_entry(row: &Row, table: &str) -> Entry {
    Entry {
        reason: Some(format!("{IMPORTED_WITH}{IMPORTED}/{table}.csv")),
        ..done(row, None)
    }
}

impl Entry {
    /// The copy of the table that the row of a finished run was imported with.
    pub(super) fn table(&self) -> Option<&str> {
        let reason = self.reason.as_deref().filter(|_| self.state == State::Done);
        reason?.strip_prefix(IMPORTED_WITH)
    }
}
