//! The study file: base, axes, replicates and stopping rule.

mod axis;
mod keys;
mod points;

use std::cmp::Reverse;
use std::ops::Range;
use std::path::Path;
use std::{fs, io};

use peristalsis_configuration::document::{self, Entry, Item, Node, Table};
use peristalsis_configuration::{
    Configuration, ConfigurationError, InitialState, Origin, Problem, ProblemKind, Problems,
    SourceFile, Sources, check_against, file_keys, file_of, join, word,
};
use peristalsis_formats::hexadecimal;
use peristalsis_run::Stopping;
use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::error::{Result, StudyError};
use crate::identity::{Record, column_names};
use crate::plan::{Plan, PlannedRun};
use axis::Axis;
pub(crate) use axis::{neat, number, numeric};
pub use keys::schema;
use keys::{Keys, RefineKeys};

/// Most runs of a study before refinement.
const MOST_RUNS: u64 = 1_000_000;
/// Digits of a hash that name the copy of a table.
const HASH_DIGITS: usize = 16;
/// Problems that are reported at once: one wrong axis is wrong at each of its points.
const MOST_PROBLEMS: usize = 20;

/// A study file that has been read and checked, with its runs.
#[derive(Clone, Debug)]
pub struct Specification {
    /// Short name.
    pub name: String,
    /// Title.
    pub title: String,
    /// Runs of each point.
    pub replicates: u32,
    /// When a run may end before its time.
    pub stopping: Option<Stopping>,
    /// Tables that are kept of each run.
    pub record: Record,
    pub(crate) refinement: Option<Refine>,
    pub(crate) axes: Vec<Axis>,
    /// Initial states; `None`: the one of the base configuration.
    pub(crate) states: Option<Vec<InitialState>>,
    plan: Plan,
    base: Base,
    text: String,
    /// Where `file` names the base in `text`, quotes included.
    file_span: Option<Range<usize>>,
}

/// The values of those keys that name tables.
fn tables_of<'a>(table: &'a Table, keys: &[String]) -> Vec<&'a Item> {
    let entries = keys.iter().filter_map(|key| document::entry(table, key));
    entries.map(|entry| &entry.item).collect()
}

/// A text with names, quotes included, put in places of it.
fn with_names(text: &str, mut names: Vec<(Range<usize>, String)>) -> String {
    // From the last on: places before it stay where they are.
    names.sort_by_key(|(place, _)| Reverse(place.start));
    names
        .into_iter()
        .fold(text.to_owned(), |mut text, (place, name)| {
            text.replace_range(place, &format!("\"{name}\""));
            text
        })
}

/// The base of every run.
#[derive(Clone, Debug)]
struct Base {
    preset: Option<String>,
    /// Name and text of the configuration file.
    file: Option<(String, String)>,
    /// `states`, where it is written.
    states: Option<Entry>,
    /// The table `base`.
    table: Table,
}

/// Where new points are to be added.
#[derive(Clone, Debug)]
pub(crate) struct Refine {
    /// Which of the axes.
    pub(crate) axis: usize,
    /// Distance of two values at which bisection ends.
    pub(crate) tolerance: f64,
    /// Where the file asks for it.
    pub(crate) origin: Origin,
}

/// One value of each axis: the layer that makes a point of the study.
pub(crate) type Choice<'a> = Vec<(&'a str, &'a Origin, &'a Item)>;

impl Specification {
    /// Reads a study file and the configuration file that it may build on, and checks every configuration that follows.
    ///
    /// # Errors
    /// [`StudyError::Read`] where a file cannot be read, [`StudyError::Configuration`] with everything that is wrong in
    /// it.
    pub fn read(path: &Path) -> Result<Self> {
        let read = |path: &Path| fs::read_to_string(path).map_err(StudyError::read(path));
        let text = read(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_toml(&path.display().to_string(), &text, |file| {
            let path = folder.join(file);
            Ok((path.display().to_string(), read(&path)?))
        })
    }

    /// Reads the text of a study file that builds on a preset, and on no other file.
    ///
    /// # Errors
    /// As [`Specification::read`]; a file that it names counts as one that cannot be read.
    pub fn alone(name: &str, text: &str) -> Result<Self> {
        Self::from_toml(name, text, |file| {
            let reason = io::Error::other("this study may build on a preset only");
            Err(StudyError::read(file)(reason))
        })
    }

    /// Reads the text of a study file; `file` answers name and text of the configuration file that it names.
    ///
    /// # Errors
    /// As [`Specification::read`].
    pub fn from_toml(
        name: &str,
        text: &str,
        file: impl FnOnce(&str) -> Result<(String, String)>,
    ) -> Result<Self> {
        let mut problems = Problems::default();
        let table = document::parse_file(SourceFile { name, text }, &mut problems);
        problems.check()?;
        check_against(keys::cached(), &table, &mut problems);
        check_keys(&table, &mut problems);
        problems.place_in(SourceFile { name, text });
        problems.check()?;
        let keys = Keys::deserialize(document::to_toml(&table))
            .expect("a file that follows the schema can be read");
        check_states(&table, &mut problems);
        let axes = axes(&table, &mut problems);
        let refinement = keys
            .refine
            .and_then(|keys| refinement(&keys, &table, &axes, &mut problems));
        problems.check()?;
        let file_span = document::entry(&table, "file").map(|entry| entry.item.origin.span());
        let base = Base {
            preset: keys.preset,
            file: keys
                .file
                .map(|name| file(&name))
                .transpose()
                .map_err(|error| unreadable(&table, &error))?,
            states: document::entry(&table, "states").cloned(),
            table: match document::entry(&table, "base").map(|entry| &entry.item.node) {
                Some(Node::Table(base)) => base.clone(),
                _ => Table::new(),
            },
        };
        let mut study = Self {
            name: keys.name,
            title: keys.title.unwrap_or_default(),
            replicates: keys.replicates,
            stopping: keys.stop.map(|keys| Stopping {
                settled_periods: keys.settled_periods,
            }),
            record: Record {
                columns: keys.record.columns.and_then(in_order),
                ..keys.record
            },
            refinement,
            axes,
            states: keys.states,
            plan: Plan::default(),
            base,
            text: text.to_owned(),
            file_span,
        };
        study.check_size(&table)?;
        study.plan = study.planned()?;
        Ok(study)
    }

    /// The runs of the study before refinement.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// A study of the runs of `plan` for which `is_in` holds; it is not refined.
    pub fn part(&self, plan: &Plan, is_in: impl Fn(&PlannedRun) -> bool) -> Self {
        Self {
            refinement: None,
            plan: plan.part(is_in),
            ..self.clone()
        }
    }

    /// What a store keeps of the study, by name: the tables that it names, its base, and last its own file, in which those
    /// have the names of their copies.
    pub(crate) fn copies(&self, study: &str, base: &str, tables: &str) -> Vec<(String, String)> {
        let keys = file_keys();
        let mut kept = Vec::new();
        let mut renamed = |items: Vec<&Item>| -> Vec<(Range<usize>, String)> {
            let tables = items.into_iter().filter_map(|item| {
                let path = file_of(item)?;
                let text = fs::read_to_string(&path).ok()?;
                let hash = hexadecimal(&Sha256::digest(&text));
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                let name = name.trim_end_matches(&format!("-{}", &hash[..HASH_DIGITS]));
                let name = name.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_");
                let name = format!("{tables}/{name}-{}.csv", &hash[..HASH_DIGITS]);
                kept.push((name.clone(), text));
                Some((item.origin.span(), name))
            });
            tables.collect()
        };
        let in_axes = self.axes.iter().flat_map(|axis| {
            let columns = axis.keys.iter().enumerate();
            let columns = columns.filter(|(_, (key, _))| keys.contains(key));
            columns.flat_map(|(column, _)| axis.rows.iter().map(move |row| &row[column]))
        });
        let mut names = renamed([tables_of(&self.base.table, &keys), in_axes.collect()].concat());
        let base_text = self.base.file.as_ref().map(|(name, text)| {
            let file = document::parse_file(SourceFile { name, text }, &mut Problems::default());
            with_names(text, renamed(tables_of(&file, &keys)))
        });
        names.extend(self.file_span.clone().map(|span| (span, base.to_owned())));
        kept.extend(base_text.map(|text| (base.to_owned(), text)));
        kept.push((study.to_owned(), with_names(&self.text, names)));
        kept
    }

    /// Whether this is what a study file and the file of its base say now.
    pub(crate) fn is_still(&self, study: &Path, base: &Path) -> bool {
        let says =
            |path: &Path, text: &str| fs::read_to_string(path).is_ok_and(|found| found == text);
        says(study, &self.text) && self.base_text().is_none_or(|text| says(base, text))
    }

    /// The text of the configuration file that it builds on.
    fn base_text(&self) -> Option<&str> {
        self.base.file.as_ref().map(|(_, text)| text.as_str())
    }

    /// The configuration of one point, with the seed of preset or file.
    pub(crate) fn configuration(
        &self,
        choice: &Choice<'_>,
        state: Option<InitialState>,
    ) -> Result<Configuration, ConfigurationError> {
        let settings = choice
            .iter()
            .map(|(key, origin, value)| document::setting(key, origin, (*value).clone()));
        let state = state
            .zip(self.base.states.as_ref())
            .map(|(state, entry)| initial_state(state, entry));
        // `base` does not name a state where `states` does. The axes are one layer, so that two for two alternatives (width and
        // amplitude) are found to conflict.
        let layers = [self.base.table.clone(), join(settings.collect())];
        let above: Vec<Table> = state.into_iter().chain(layers).collect();
        Configuration::from_sources_and(
            &Sources {
                file: self
                    .base
                    .file
                    .as_ref()
                    .map(|(name, text)| SourceFile { name, text }),
                preset: self.base.preset.as_deref(),
                overrides: &[],
            },
            &above,
        )
    }

    /// All points of the axes: one index into the rows of each, the last axis fastest.
    pub(crate) fn grid(&self) -> Vec<Vec<usize>> {
        self.axes.iter().fold(vec![Vec::new()], |grid, axis| {
            let with_rows = |point: &Vec<usize>| {
                let point = point.clone();
                (0..axis.rows.len()).map(move |row| [point.as_slice(), &[row]].concat())
            };
            grid.iter().flat_map(with_rows).collect()
        })
    }
}

impl Specification {
    /// Refuses a grid that nobody meant.
    fn check_size(&self, table: &Table) -> Result<()> {
        let states = self.states.as_ref().map_or(1, Vec::len);
        let rows = self.axes.iter().map(|axis| axis.rows.len() as f64);
        let runs = rows.product::<f64>() * states as f64 * f64::from(self.replicates);
        if runs <= MOST_RUNS as f64 {
            return Ok(());
        }
        let message = format!("a study of {runs} runs is beyond reach");
        let mut problem = Problem::new(ProblemKind::OutOfRange, message)
            .key("axes")
            .help(format!("at most {MOST_RUNS} runs: axes multiply"));
        if let Some(entry) = document::entry(table, "axes") {
            problem = problem.at(&entry.key, "these axes");
        }
        Err(ConfigurationError::from(problem).into())
    }
}

/// The layer that sets a state of the list `states`.
fn initial_state(state: InitialState, states: &Entry) -> Table {
    let name = word(state);
    let Node::Array(items) = &states.item.node else {
        return Table::new();
    };
    let is_it = |item: &&Item| matches!(&item.node, Node::Text(text) if *text == name);
    let item = items.iter().find(is_it).cloned();
    item.map_or_else(Table::new, |item| {
        document::setting("initial.state", &states.key, item)
    })
}

/// The problem of a configuration file that cannot be read.
fn unreadable(table: &Table, error: &StudyError) -> ConfigurationError {
    let mut problem = Problem::new(ProblemKind::Missing, error.to_string())
        .key("file")
        .help("a configuration file, its path from the folder of the study file");
    if let Some(entry) = document::entry(table, "file") {
        problem = problem.at(&entry.item.origin, "this file");
    }
    problem.into()
}

/// Checks the keys of a study beyond the schema.
fn check_keys(table: &Table, problems: &mut Problems) {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_".contains(letter);
    if let Some(entry) = document::entry(table, "name")
        && let Node::Text(name) = &entry.item.node
        && (!(1..=100).contains(&name.len()) || !name.chars().all(is_plain))
    {
        let message = format!("{name:?} cannot name a study");
        let problem = Problem::new(ProblemKind::OutOfRange, message)
            .key("name")
            .at(&entry.item.origin, "this name")
            .help("one to a hundred of the letters a to z and A to Z, digits, - and _: exported files are called by it");
        problems.push(problem);
    }
    let conflicts = [
        (
            "file",
            "preset",
            "a study builds on a preset or on a file, not on both",
            "keep one; a configuration file may itself name a preset",
        ),
        (
            "base.run.seed",
            "",
            "every run of a study has a seed of its own",
            "remove the seed; take more `replicates`",
        ),
        (
            "base.initial.state",
            "states",
            "the initial state is given twice",
            "keep `states`, or base.initial.state",
        ),
    ];
    for (key, other, message, help) in conflicts {
        let Some(entry) = document::entry(table, key) else {
            continue;
        };
        let mut problem = Problem::new(ProblemKind::Conflict, message)
            .key(key)
            .at(&entry.key, "here")
            .help(help);
        if !other.is_empty() {
            let Some(other) = document::entry(table, other) else {
                continue;
            };
            problem = problem.at(&other.key, "and here");
        }
        problems.push(problem);
    }
}

/// No state is named twice.
fn check_states(table: &Table, problems: &mut Problems) {
    let states = document::entry(table, "states").map(|entry| &entry.item.node);
    let Some(Node::Array(items)) = states else {
        return;
    };
    for (place, item) in items.iter().enumerate() {
        let is_same = |other: &&Item| other.origin.text() == item.origin.text();
        if let Some(first) = items[..place].iter().find(is_same) {
            let message = format!("states has {} twice", item.origin.text());
            let problem = Problem::new(ProblemKind::Conflict, message)
                .key("states")
                .at(&item.origin, "here")
                .at(&first.origin, "and here")
                .help("name a state once; `replicates` are runs of the same point");
            problems.push(problem);
            return;
        }
    }
}

fn axes(table: &Table, problems: &mut Problems) -> Vec<Axis> {
    let axes: Vec<Axis> = match document::entry(table, "axes").map(|entry| &entry.item.node) {
        Some(Node::Array(items)) => {
            let read = items.iter().filter_map(|item| Axis::read(item, problems));
            read.collect()
        }
        _ => Vec::new(),
    };
    let mut seen: Vec<(&str, &Origin)> = Vec::new();
    for (key, origin) in axes.iter().flat_map(|axis| &axis.keys) {
        if let Some((_, first)) = seen.iter().find(|(other, _)| other == key) {
            let problem = Problem::new(ProblemKind::Conflict, format!("{key} is varied twice"))
                .key(key)
                .at(origin, "here")
                .at(first, "and here")
                .help("one axis a key: join the values");
            problems.push(problem);
        }
        seen.push((key, origin));
    }
    for axis in &axes {
        axis.check_distinct(problems);
    }
    axes
}

fn refinement(
    keys: &RefineKeys,
    table: &Table,
    axes: &[Axis],
    problems: &mut Problems,
) -> Option<Refine> {
    let RefineKeys { key, tolerance } = keys;
    let origin = &document::entry(table, "refine.key")?.item.origin;
    let can_be = |axis: &Axis| axis.is_numeric() && axis.rows.len() > 1;
    let is_meant = |axis: &Axis| can_be(axis) && axis.keys[0].0 == *key;
    if let Some(axis) = axes.iter().position(is_meant) {
        return Some(Refine {
            axis,
            tolerance: *tolerance,
            origin: origin.clone(),
        });
    }
    // An axis that was refused may be the one meant.
    let axes_given = document::entry(table, "axes").map(|entry| &entry.item.node);
    if matches!(axes_given, Some(Node::Array(items)) if items.len() > axes.len()) {
        return None;
    }
    let candidates = axes.iter().filter(|axis| can_be(axis));
    let candidates: Vec<&str> = candidates.map(|axis| axis.keys[0].0.as_str()).collect();
    let problem = Problem::new(
        ProblemKind::Inconsistent,
        format!("{key} cannot be refined: it is not an axis of one key with two numbers or more"),
    )
    .key("refine.key")
    .at(origin, "this key")
    .help(match candidates.as_slice() {
        [] => "give it an axis with at least the two values to bisect between".to_owned(),
        candidates => format!("axes that can be: {}", candidates.join(", ")),
    });
    problems.push(problem);
    None
}

/// The columns kept, in the order of all; `None` where these are all.
fn in_order(wanted: Vec<String>) -> Option<Vec<String>> {
    let all = column_names();
    let kept = all.iter().map(|name| (*name).to_owned());
    let kept: Vec<String> = kept.filter(|name| wanted.contains(name)).collect();
    (kept.len() < all.len()).then_some(kept)
}

/// One error of all that was found at the points, each problem once.
pub(crate) fn joined(errors: Vec<ConfigurationError>) -> Result<(), ConfigurationError> {
    let mut seen: Vec<Problem> = Vec::new();
    for problem in errors.iter().flat_map(ConfigurationError::problems) {
        if seen.len() < MOST_PROBLEMS && !seen.contains(problem) {
            seen.push(problem.clone());
        }
    }
    ConfigurationError::all(seen)
}
