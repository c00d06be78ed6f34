//! `peristalsis study`: what it says, and that nothing is lost whatever happens to the process, the disk or the files.

mod commands;
#[cfg(unix)]
mod robustness;

use std::path::PathBuf;

use crate::Place;

/// Twelve runs of some tenths of a second each.
const STUDY: &str = r#"
name = "tested"
title = "a study to be disturbed"
preset = "frictionless"
states = ["rest", "jammed"]
replicates = 3

[base]
grains.number = 100
tube.waves = 5
drive.strain_rate = 0.1
run.periods = 70

[[axes]]
key = "drive.width"
values = [2.4, 2.9]

[stop]
settled_periods = 30
"#;

/// Four runs that take no time.
pub(crate) fn quick() -> String {
    STUDY
        .replace("grains.number = 100", "grains.number = 20")
        .replace("tube.waves = 5", "tube.waves = 2")
        .replace("run.periods = 70", "run.periods = 4")
        .replace("replicates = 3", "replicates = 1")
}

/// A place with a study file in it.
fn place_of(text: &str) -> Place {
    let place = Place::new();
    place.write("study.toml", text);
    place
}

/// A place with a finished study of four runs in the folder `store`.
pub(crate) fn finished() -> Place {
    let place = place_of(&quick());
    place.does("study run study.toml --store store");
    place
}

/// The science tables of a store in this place: rows as CSV and Parquet, and time series.
fn tables(place: &Place, store: &str) -> [Vec<u8>; 3] {
    let out = format!("{store}-tables");
    place.does(&format!("study export {store} --out {out} --series"));
    let file = |name: &str| -> PathBuf { place.path(&out).join(name) };
    ["tested.csv", "tested.parquet", "tested-series.parquet"]
        .map(|name| std::fs::read(file(name)).unwrap())
}
