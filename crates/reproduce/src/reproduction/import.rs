//! Finished runs from tables, to whichever studies they belong.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use peristalsis_formats::read_table;
use peristalsis_study::{Identity, Row, State, Store, StudyError};
use rayon::prelude::*;

use super::Reproduction;
use crate::error::ReproduceError;

/// What tables of finished runs gave.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Import {
    /// Tables that were read.
    pub tables: usize,
    /// Files of a folder that hold no rows of runs, with the reason.
    pub skipped: Vec<(PathBuf, String)>,
    /// What each study found in them.
    pub studies: Vec<ImportedRuns>,
}

/// What a study found in tables of finished runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportedRuns {
    /// Name of the study.
    pub study: String,
    /// Runs of its plan that were in the tables.
    pub found: usize,
    /// Runs of its plan.
    pub runs: usize,
}

/// A table of finished runs.
struct Rows {
    path: PathBuf,
    identities: HashSet<Identity>,
}

impl Reproduction {
    /// Takes finished runs from tables, CSV or Parquet, or folders of them, into the stores of the studies that they belong
    /// to, by their identities. A run that is finished in a store stays as it is there.
    ///
    /// # Errors
    /// A path that cannot be read; a file that was named and holds no rows of runs (one in a folder is skipped); errors of
    /// writing to a store.
    pub fn import(&self, paths: &[PathBuf]) -> Result<Import, ReproduceError> {
        let mut import = Import::default();
        let mut tables = Vec::new();
        for path in paths {
            if path.is_dir() {
                let files = files_of(path)?;
                let read: Vec<_> = files.par_iter().map(|file| Rows::read(file)).collect();
                for (file, rows) in files.into_iter().zip(read) {
                    match rows {
                        Ok(rows) => tables.push(rows),
                        Err(error) => import.skipped.push((file, error.to_string())),
                    }
                }
            } else {
                tables.push(Rows::read(path)?);
            }
        }
        import.tables = tables.len();
        for work in &self.works {
            // A store that cannot be opened is told of when its study is worked on.
            if let Ok(store) = &work.store {
                let (found, runs) = import_into(store, &tables)?;
                import.studies.push(ImportedRuns {
                    study: work.file.name.to_owned(),
                    found,
                    runs,
                });
            }
        }
        Ok(import)
    }
}

impl Rows {
    fn read(path: &Path) -> Result<Self, StudyError> {
        fs::metadata(path).map_err(StudyError::read(path))?;
        let rows = read_table(path)
            .map_err(|error| error.to_string())
            .and_then(|table| Row::all_of(&table))
            .map_err(StudyError::not_rows(path))?;
        Ok(Self {
            path: path.to_owned(),
            identities: rows.iter().map(Row::identity).collect(),
        })
    }
}

/// The tables in a folder, by name.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(StudyError::read(folder))? {
        let path = entry.map_err(StudyError::read(folder))?.path();
        let ending = path.extension();
        let is_table = ending.is_some_and(|ending| ending == "csv" || ending == "parquet");
        if is_table && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Imports the tables that hold runs which the study lacks; answers how many runs of its plan are in any table, and how many
/// there are.
fn import_into(store: &Store, tables: &[Rows]) -> Result<(usize, usize), StudyError> {
    loop {
        let survey = store.survey()?;
        let planned: HashSet<Identity> =
            survey.plan.runs().iter().map(|run| run.identity).collect();
        let is_lacked = |identity: &&Identity| {
            planned.contains(*identity) && survey.state(**identity) != State::Done
        };
        let mut taken: HashSet<&Identity> = HashSet::new();
        for table in tables {
            let before = taken.len();
            taken.extend(table.identities.iter().filter(is_lacked));
            if taken.len() > before {
                store.import_table(&table.path)?;
            }
        }
        if taken.is_empty() {
            let is_in = |identity: &&Identity| {
                let mut tables = tables.iter();
                tables.any(|table| table.identities.contains(*identity))
            };
            return Ok((planned.iter().filter(is_in).count(), planned.len()));
        }
        // Runs that were just found may let refinement ask for more.
    }
}
