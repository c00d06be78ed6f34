//! Studies and figures to be viewed, from what a path leads to.

use std::path::{Path, PathBuf};

use peristalsis_formats::read_table;
use peristalsis_reproduce::{STORES, Size, StudyFile};
use peristalsis_run::files::CONFIGURATION;
use peristalsis_study::{STUDY, StudyError};
use peristalsis_viewer::{Figure, Study};

use crate::commands::say;
use crate::failure::Failure;

/// Endings of tables.
const TABLES: [&str; 2] = ["parquet", "csv"];

/// What a path leads to.
#[derive(Debug, Default)]
pub(super) struct Studies {
    pub(super) studies: Vec<Study>,
    pub(super) figures: Vec<Figure>,
}

impl Studies {
    /// The studies at a path: the store of one, what `peristalsis reproduce` wrote, a table of rows of runs, or a folder of
    /// such tables; `None` where there is something else.
    pub(super) fn at(source: &Path) -> Result<Option<Self>, Failure> {
        let mut found = Self::default();
        if is_table(source) && source.is_file() {
            found.studies.push(of_table(source)?);
            return Ok(Some(found));
        }
        if !source.is_dir() || source.join(CONFIGURATION).is_file() {
            return Ok(None);
        }
        if source.join(STUDY).is_file() {
            let study = Study::of_store(source)?;
            found.studies.push(study);
            return Ok(Some(found));
        }
        found.figures = Figure::of_report(source)?;
        let stores = inside(&source.join(STORES), |path| path.join(STUDY).is_file());
        reading(stores.len(), source);
        for store in stores {
            found.add(&store, Study::of_store(&store).map_err(Failure::from));
        }
        if found.is_empty() {
            let mut tables = inside(source, |path| is_table(path) && path.is_file());
            let all = tables.clone();
            tables.retain(|table| !is_beside(table, &all));
            reading(tables.len(), source);
            for table in tables {
                found.add(&table, of_table(&table));
            }
        }
        Ok((!found.is_empty()).then_some(found))
    }

    /// A study with a fault is named, and the others are shown.
    fn add(&mut self, path: &Path, study: Result<Study, Failure>) {
        match study {
            Ok(study) => self.studies.push(study),
            Err(error) => say(&format!("left out: {}: {error}", path.display())),
        }
    }

    fn is_empty(&self) -> bool {
        self.studies.is_empty() && self.figures.is_empty()
    }
}

/// Says what takes seconds where there are many.
fn reading(studies: usize, source: &Path) {
    if studies > 1 {
        say(&format!(
            "reading {studies} studies in {}",
            source.display()
        ));
    }
}

/// The entries of a folder that fit, by name; none where there is no folder.
fn inside(folder: &Path, wanted: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.retain(|path| wanted(path));
    paths.sort();
    paths
}

/// Whether a table says no more than another: the CSV of a Parquet table, or what `study export` writes beside the rows.
fn is_beside(table: &Path, all: &[PathBuf]) -> bool {
    let stem = table.file_stem().unwrap_or_default().to_string_lossy();
    let has = |stem: &str| {
        let mut names = TABLES
            .iter()
            .map(|ending| table.with_file_name(format!("{stem}.{ending}")));
        names.any(|name| name != *table && all.contains(&name))
    };
    let is_csv = table.extension().is_some_and(|ending| ending == TABLES[1]);
    let of_rows = ["-failed", "-timing", "-series"];
    is_csv && has(&stem)
        || of_rows
            .iter()
            .any(|end| stem.strip_suffix(end).is_some_and(&has))
}

fn is_table(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| TABLES.contains(&ending))
}

/// The runs of a table can be watched where it is of a study behind the claims, whose design this program knows.
fn of_table(path: &Path) -> Result<Study, Failure> {
    // A file that is no table is no fault of the disk.
    let table = read_table(path).map_err(|error| StudyError::not_rows(path)(error.to_string()))?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = table.metadata().get("peristalsis.study");
    let of_table =
        |design: Option<&_>| Study::of_table(&stem, table.clone(), design).map_err(Failure::from);
    let mut best = of_table(None)?;
    if let Some(file) = StudyFile::named(name.map_or(&stem, |name| name.as_str())) {
        for size in [Size::Full, Size::Quick] {
            let design = file.specification(size)?;
            let study = of_table(Some(&design))?;
            if study.watchable() > best.watchable() {
                best = study;
            }
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_export_writes_beside_the_rows_is_no_study() {
        let names = [
            "a.csv",
            "a.parquet",
            "a-timing.csv",
            "a-failed.csv",
            "b-failed.csv",
        ];
        let all: Vec<PathBuf> = names.map(PathBuf::from).into();
        let kept: Vec<&PathBuf> = all.iter().filter(|table| !is_beside(table, &all)).collect();
        assert_eq!(kept, [Path::new("a.parquet"), Path::new("b-failed.csv")]);
    }
}
