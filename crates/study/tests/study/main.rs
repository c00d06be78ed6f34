//! Studies from the file to the table: errors, identities, additions, and that nothing is lost.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

mod damage;
mod identity;
mod interruption;
mod quantities;
mod refinement;
mod specification;
mod transfer;

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use peristalsis_study::{Board, Effort, Ending, Plan, Specification, Store, StudyError, work_on};
use tempfile::TempDir;

/// Six runs of some hundredths of a second each.
const SMALL: &str = r#"
name = "small"
preset = "frictionless"
replicates = 3

[base]
grains.number = 20
tube.waves = 2
drive.strain_rate = 0.1
run.periods = 12

[[axes]]
key = "drive.width"
values = [2.5, 2.8]
"#;

const TWO_WORKERS: Effort = Effort {
    workers: 2,
    checkpoint_interval: Duration::from_millis(5),
    limit: None,
};

fn read(text: &str) -> Result<Specification, StudyError> {
    Specification::alone("study.toml", text)
}

fn study(text: &str) -> Specification {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

fn plan(text: &str) -> Plan {
    study(text).plan().clone()
}

/// A store of a study in a folder of its own.
struct Place {
    folder: TempDir,
    study: Specification,
}

impl Place {
    fn new(text: &str) -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            study: study(text),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn store(&self) -> Store {
        Store::create(&self.path("store"), &self.study).unwrap()
    }

    /// Works until nothing is left; answers what was told on the way.
    fn complete(&self) -> Vec<String> {
        let news = std::cell::RefCell::new(Vec::new());
        let ending = work_on(
            &self.store(),
            &self.study,
            TWO_WORKERS,
            &|| false,
            &mut |board| news.borrow_mut().extend(board.news.clone()),
        );
        assert_eq!(ending.unwrap(), Ending::Complete);
        news.into_inner()
    }

    /// Works until the board looks so.
    fn work_until(&self, is_enough: impl Fn(&Board) -> bool) -> Ending {
        let stop = Cell::new(false);
        work_on(
            &self.store(),
            &self.study,
            TWO_WORKERS,
            &|| stop.get(),
            &mut |board| {
                if is_enough(board) {
                    stop.set(true);
                }
            },
        )
        .unwrap()
    }

    /// The science tables as bytes, CSV and Parquet, time series included.
    fn tables(&self) -> [Vec<u8>; 3] {
        let out = self.path("tables");
        let exported = self.store().export(&out, true).unwrap();
        assert_eq!(exported.quarantined, []);
        let name = &self.study.name;
        ["csv", "parquet", "-series.parquet"].map(|ending| {
            let separator = if ending.starts_with('-') { "" } else { "." };
            std::fs::read(out.join(format!("{name}{separator}{ending}"))).unwrap()
        })
    }

    /// Folders of the runs, ascending.
    fn run_folders(&self) -> Vec<PathBuf> {
        let mut folders = entries(&self.path("store").join("runs"));
        folders.sort();
        folders
    }

    /// All files of all runs.
    fn run_files(&self) -> Vec<PathBuf> {
        let folders = self.run_folders();
        folders.iter().flat_map(|folder| entries(folder)).collect()
    }
}

/// When each of these runs was sealed.
fn seal_times(folders: &[PathBuf]) -> Vec<SystemTime> {
    let metadata = |folder: &PathBuf| folder.join("done.json").metadata().unwrap();
    let times = folders.iter().map(metadata);
    times.map(|metadata| metadata.modified().unwrap()).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect()
}

/// Changes one bit of a file.
fn flip(path: &Path, at: f64) {
    let mut bytes = std::fs::read(path).unwrap();
    let index = ((bytes.len() - 1) as f64 * at) as usize;
    bytes[index] ^= 0x10;
    std::fs::write(path, bytes).unwrap();
}
