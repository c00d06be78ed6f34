//! Numbers that the user gives in a file: places of wall spheres, the shape of a wave, sizes of grains.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Context;
use crate::configuration::Tube;
use crate::contract;
use crate::document::{self, Entry, Item, Node, Table};
use crate::error::{Problem, ProblemKind, Problems};
use crate::source::{Origin, Source, SourceKind};

/// A key that names a file of two columns, and the keys that take its numbers.
struct FileKey {
    table: &'static str,
    name: &'static str,
    columns: &'static str,
    into: [&'static str; 2],
    help: &'static str,
}

const FILES: [FileKey; 3] = [
    FileKey {
        table: "tube",
        name: "file",
        columns: "angle,place",
        into: ["angles", "places"],
        help: "then one line per sphere: its angle [rad] and its place z [d]",
    },
    FileKey {
        table: "drive",
        name: "table",
        columns: "phase,radius",
        into: ["phases", "radii"],
        help: "then one line per point: its phase, from 0 to below 1, and the radius there",
    },
    FileKey {
        table: "grains",
        name: "file",
        columns: "diameter,fraction",
        into: ["diameters", "fractions"],
        help: "then one line per size: its diameter [d] and its part of the grains by number",
    },
];

/// Reads the files that keys name into the keys that take their numbers, within the ranges of these keys: from then on a
/// run needs the files no more.
pub(super) fn read(table: &mut Table, problems: &mut Problems) {
    for file in &FILES {
        read_one(file, table, problems);
    }
}

fn read_one(file: &FileKey, table: &mut Table, problems: &mut Problems) {
    let path = format!("{}.{}", file.table, file.name);
    let Some(Entry { key: written, item }) = document::entry(table, &path) else {
        return;
    };
    let Node::Text(name) = &item.node else { return };
    let (key_origin, origin) = (written.clone(), item.origin.clone());
    let source = source_of(name, &origin);
    let columns = match source.and_then(|source| columns_of(&source, file.columns)) {
        Ok(columns) => columns,
        Err(message) => {
            let message = format!("{path} = {name:?}: {message}");
            let problem = Problem::new(ProblemKind::Inconsistent, message)
                .key(path)
                .at(&origin, "this file")
                .help(format!("a first line {}, {}", file.columns, file.help));
            return problems.push(problem);
        }
    };
    let Some(Node::Table(keys)) = table.get_mut(file.table).map(|entry| &mut entry.item.node)
    else {
        return;
    };
    for (key, numbers) in file.into.into_iter().zip(columns) {
        let item = Item {
            origin: origin.clone(),
            node: Node::Array(numbers),
        };
        let full = format!("{}.{key}", file.table);
        contract::check(
            &document::setting(&full, &key_origin, item.clone()),
            problems,
        );
        let entry = Entry {
            key: key_origin.clone(),
            item,
        };
        keys.insert(key.to_owned(), entry);
    }
}

/// The keys that name files of numbers.
pub fn file_keys() -> Vec<String> {
    let keys = FILES.iter();
    keys.map(|key| format!("{}.{}", key.table, key.name))
        .collect()
}

/// The file that the value of such a key names: beside the one that names it, or else seen from where the program runs.
pub fn file_of(item: &Item) -> Option<PathBuf> {
    match &item.node {
        Node::Text(name) => Some(path_of(name, &item.origin)),
        _ => None,
    }
}

fn path_of(name: &str, origin: &Origin) -> PathBuf {
    let beside = match origin.source.kind {
        SourceKind::File => Path::new(&*origin.source.name).parent(),
        SourceKind::Preset | SourceKind::Override => None,
    };
    let beside = beside.map(|folder| folder.join(name));
    let path = beside.filter(|path| path.is_file());
    path.unwrap_or_else(|| name.into())
}

fn source_of(name: &str, origin: &Origin) -> Result<Arc<Source>, String> {
    let path = path_of(name, origin);
    let text = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
    Ok(Source::new(
        SourceKind::File,
        &*path.to_string_lossy(),
        &text,
    ))
}

/// The two columns of a table under this first line, each number with its place.
fn columns_of(source: &Arc<Source>, names: &str) -> Result<[Vec<Item>; 2], String> {
    let mut columns = [Vec::new(), Vec::new()];
    // Spreadsheets write a byte order mark.
    let text = source.text.trim_start_matches('\u{feff}');
    let lines = text.lines().map(str::trim).enumerate();
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let heading = lines.next().map_or("", |(_, line)| line);
    if heading.replace([' ', '"'], "") != names {
        return Err(format!("its first line is {heading:?}, not {names}"));
    }
    for (number, line) in lines {
        let mut values = line.split(',').map(|value| {
            let value = value.trim();
            let number = value.parse::<f64>().ok().filter(|it| it.is_finite())?;
            Some(Item {
                origin: Origin::new(source, place(value, &source.text)),
                node: Node::Float(number),
            })
        });
        match (values.next(), values.next(), values.next()) {
            (Some(Some(one)), Some(Some(other)), None) => {
                columns[0].push(one);
                columns[1].push(other);
            }
            _ => return Err(format!("line {} is {line:?}, not two numbers", number + 1)),
        }
    }
    Ok(columns)
}

/// The bytes of a text that a part of it covers.
fn place(part: &str, text: &str) -> Range<usize> {
    let start = part.as_ptr().addr() - text.as_ptr().addr();
    start..start + part.len()
}

/// Whether each sphere has an angle and a place in the tube.
pub(super) fn check(tube: &Tube, context: &mut Context<'_>) {
    let keys = ["tube.places", "tube.angles", "tube.arrangement"];
    let (angles, places) = (tube.angles.len(), tube.places.len());
    let length = tube.length();
    let outside = tube
        .places
        .iter()
        .position(|place| !(0.0..length).contains(place));
    let (message, help) = if places == 0 {
        let message = "tube.arrangement is \"file\", and there is no sphere".to_owned();
        (
            message,
            "give tube.file, or tube.angles and tube.places".to_owned(),
        )
    } else if angles != places {
        let message = format!("{angles} angles and {places} places");
        (message, "each wall sphere has one of both".to_owned())
    } else if let Some(sphere) = outside {
        let place = tube.places[sphere];
        let message = format!(
            "wall sphere {} stands at z = {place}, outside the tube",
            sphere + 1
        );
        (
            message,
            format!("0 <= z < L = waves * wavelength = {length}"),
        )
    } else {
        return;
    };
    context.refuse::<()>(&keys, message, help);
}
