//! No damage to the files of a store makes it panic, a product that changed is never taken for what was sealed, an index
//! that was damaged is made again, and of the files that were not damaged none is lost.
//!
//! The input is a list of damages: the number of a file, a length (two bytes), and so many bytes that are taken as in
//! [`peristalsis_fuzz::damaged`].
#![no_main]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use peristalsis_fuzz::{damaged, scratch};
use peristalsis_study::{Effort, Ending, Specification, State, Store, work_on};

const STUDY: &str = r#"
name = "fuzz"
preset = "frictionless"
[base]
grains.number = 3
tube.waves = 1
run.periods = 1
observe.samples_per_period = 4
[record]
columns = ["time", "flow_rate_ratio"]
profile = false
"#;

/// Name of the table to be imported, beside the store.
const TABLE: &str = "rows.csv";

/// Files of a whole store, by name, and what is imported into it.
static FILES: LazyLock<BTreeMap<PathBuf, Vec<u8>>> = LazyLock::new(whole);
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| scratch("store"));

fn whole() -> BTreeMap<PathBuf, Vec<u8>> {
    let folder = scratch("store-whole");
    let study = Specification::from_toml("fuzz.toml", STUDY, |_| unreachable!("a preset"))
        .expect("the study is sound");
    let store = Store::create(&folder.join("store"), &study).expect("a store can be made");
    let effort = Effort {
        workers: 1,
        checkpoint_interval: Duration::from_secs(60),
        limit: None,
    };
    let ending = work_on(&store, &study, effort, &|| false, &mut |_| {});
    assert_eq!(ending.expect("a sound run ends"), Ending::Complete);
    store
        .export(&folder.join("tables"), false)
        .expect("the tables can be written");
    std::fs::rename(folder.join("tables/fuzz.csv"), folder.join(TABLE)).expect("it is there");
    std::fs::remove_dir_all(folder.join("tables")).expect("the folder is ours");
    let files = files_below(&folder);
    std::fs::remove_dir_all(folder).expect("the folder is ours");
    files
}

fn files_below(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("it was there just now") {
            let path = entry.expect("it was there just now").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).expect("it is below").to_owned();
                files.insert(name, std::fs::read(path).expect("it can be read"));
            }
        }
    }
    files
}

/// The files after the damages that the input lists, and which are not what they were.
fn after(mut input: &[u8]) -> (BTreeMap<PathBuf, Vec<u8>>, BTreeSet<PathBuf>) {
    let mut files = FILES.clone();
    while let [number, low, high, rest @ ..] = input {
        let length = usize::from(u16::from_le_bytes([*low, *high])).min(rest.len());
        let (change, left) = rest.split_at(length);
        input = left;
        let place = usize::from(*number) % files.len();
        if let Some(bytes) = files.values_mut().nth(place) {
            *bytes = damaged(bytes, change);
        }
    }
    let changed = FILES
        .iter()
        .filter(|(name, bytes)| files[*name] != **bytes)
        .map(|(name, _)| name.clone())
        .collect();
    (files, changed)
}

/// Products of the run that its seal guards.
fn is_guarded(name: &Path) -> bool {
    let text = name.to_string_lossy();
    text.starts_with("store/runs/")
        && ["timing.json", "done.json", "signac_statepoint.json"]
            .iter()
            .all(|other| !text.ends_with(other))
}

fuzz_target!(|input: &[u8]| {
    let (files, changed) = after(input);
    let root = FOLDER.as_path();
    std::fs::remove_dir_all(root).expect("the folder is ours");
    for (name, bytes) in &files {
        let path = root.join(name);
        std::fs::create_dir_all(path.parent().expect("it has a folder")).expect("there is room");
        std::fs::write(path, bytes).expect("there is room");
    }
    let Ok(store) = Store::open(&root.join("store")) else {
        return;
    };
    drop(store.survey());
    let verified = store.verify();
    let survey = store.survey();
    if !changed.contains(Path::new("store/study.toml")) {
        let survey = survey.expect("the study is whole, and the index has been made again");
        verified.expect("files can be read and moved");
        let [run] = survey.plan.runs() else {
            panic!("the study has one run")
        };
        let state = survey.state(run.identity);
        if changed.iter().any(|name| is_guarded(name)) {
            assert_eq!(state, State::Quarantined, "{changed:?}");
        } else if changed
            .iter()
            .all(|name| !name.starts_with("store/runs"))
        {
            assert_eq!(state, State::Done, "{changed:?}");
        }
        drop(store.rows());
        drop(store.export(&root.join("tables"), true));
        drop(store.import_table(&root.join(TABLE)));
        store.survey().expect("what was imported does no harm");
    }
    // Whatever was decided, nothing that was whole is gone.
    let left: BTreeSet<Vec<u8>> = files_below(root).into_values().collect();
    for (name, bytes) in FILES.iter() {
        if name.starts_with("store/runs") && !changed.contains(name) {
            assert!(left.contains(bytes), "{} is gone", name.display());
        }
    }
});
