//! A study that is shown: its rows, and the configurations of its runs.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peristalsis_configuration::{Configuration, InitialState};
use peristalsis_formats::{Column, Table, Values, parquet, shell_word};
use peristalsis_run::{TrajectoryFormat, files, label, row_columns};
use peristalsis_study::{Finding, Identity, Plan, PlannedRun, Specification, State, Store, refine};
use serde::Serialize;

use super::error::ViewerError;
use crate::within::{Sibling, Within};

/// Least time between two looks into a store.
const EACH: Duration = Duration::from_secs(2);

/// A study: the rows of its finished runs and, where its design is known, the configuration behind each.
#[derive(Debug)]
pub struct Study {
    name: String,
    title: String,
    /// The folder of its runs; `None` for a table alone.
    store: Option<Store>,
    plan: Option<Plan>,
    table: Table,
    /// Runs of the plan in each state.
    counts: BTreeMap<State, usize>,
    /// All runs that were ever seen; the place is the number of the run for pages.
    runs: Vec<Identity>,
    numbers: HashMap<Identity, usize>,
    /// Grows with every change.
    version: u64,
    looked: Instant,
}

/// A run of a study that is to be watched.
#[derive(Clone, Debug)]
pub(crate) struct StudyRun {
    pub(crate) configuration: Configuration,
    pub(crate) title: String,
    /// Beginning of the names of saved states.
    pub(crate) stem: String,
    /// Time and J/Jmax of the run in the study.
    pub(crate) record: Vec<(f64, f64)>,
    /// Its recording, if there is one.
    pub(crate) trajectory: Option<PathBuf>,
    pub(crate) within: Within,
}

/// A study in JSON, for its page.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS), ts(rename = "Study"))]
pub(crate) struct Shown<'a> {
    version: u64,
    name: &'a str,
    title: &'a str,
    columns: Vec<ShownColumn<'a>>,
    /// Number of the run of each row; null where it cannot be watched.
    runs: Vec<Option<usize>>,
    #[cfg_attr(test, ts(as = "BTreeMap<String, usize>"))]
    counts: &'a BTreeMap<State, usize>,
    /// Whether there may be more rows later.
    growing: bool,
    /// The folder of its runs, as a word of a shell; null for a table alone.
    store: Option<String>,
}

/// A column of its table.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS), ts(rename = "Column"))]
pub(crate) struct ShownColumn<'a> {
    name: &'a str,
    /// Words or symbol at an axis, with the unit.
    label: String,
    description: &'a str,
    /// NaN, a missing number, is null.
    #[cfg_attr(test, ts(type = "Array<number | string | boolean | null>"))]
    values: &'a Values,
}

impl Study {
    /// The study in a store, with the rows that are there.
    ///
    /// # Errors
    /// [`ViewerError::Study`].
    pub fn of_store(path: &Path) -> Result<Self, ViewerError> {
        let store = Store::open(path)?;
        let (survey, table) = store.look()?;
        let mut study = Self::new(survey.study.name.clone(), survey.study.title.clone(), table);
        study.counts = survey.counts();
        study.store = Some(store);
        study.follow(survey.plan);
        Ok(study)
    }

    /// A table of rows of finished runs. With their study, which holds their configurations, the runs can be watched.
    ///
    /// # Errors
    /// [`ViewerError::NotRows`] where the table has no identities of runs; [`ViewerError::Study`] where the study file is
    /// wrong.
    pub fn of_table(
        name: &str,
        table: Table,
        design: Option<&Specification>,
    ) -> Result<Self, ViewerError> {
        let refused = |reason| ViewerError::NotRows {
            name: name.to_owned(),
            reason,
        };
        // Before the identities: a column without values has no kind.
        if table.rows() == 0 {
            return Err(refused("it has no rows".to_owned()));
        }
        identities(&table).map_err(refused)?;
        let said = |key: &str| table.metadata().get(key).cloned();
        let name = said("peristalsis.study").unwrap_or_else(|| name.to_owned());
        let title = said("peristalsis.title").unwrap_or_default();
        let plan = design.map(|design| plan_of(design, &table));
        let mut study = Self::new(name, title, table);
        study.counts = BTreeMap::from([(State::Done, study.table.rows())]);
        if let Some(plan) = plan {
            study.follow(plan);
        }
        Ok(study)
    }

    fn new(name: String, title: String, table: Table) -> Self {
        Self {
            name,
            title,
            store: None,
            plan: None,
            table,
            counts: BTreeMap::new(),
            runs: Vec::new(),
            numbers: HashMap::new(),
            version: 1,
            looked: Instant::now(),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Finished runs in it.
    pub fn rows(&self) -> usize {
        self.table.rows()
    }

    /// Rows whose run can be watched.
    pub fn watchable(&self) -> usize {
        self.numbers_of_rows().iter().flatten().count()
    }

    pub(crate) fn title(&self) -> &str {
        &self.title
    }

    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// Takes over the plan; each new run gets the next number.
    fn follow(&mut self, plan: Plan) {
        for run in plan.runs() {
            self.numbers.entry(run.identity).or_insert_with(|| {
                self.runs.push(run.identity);
                self.runs.len() - 1
            });
        }
        self.plan = Some(plan);
    }

    /// Reads the store again, if the last look was some time ago.
    ///
    /// # Errors
    /// [`ViewerError::Study`] where the store cannot be read any more.
    pub(crate) fn refresh(&mut self) -> Result<(), ViewerError> {
        let Some(store) = &self.store else {
            return Ok(());
        };
        if self.looked.elapsed() < EACH {
            return Ok(());
        }
        let (survey, table) = store.look()?;
        let counts = survey.counts();
        if table != self.table || counts != self.counts {
            self.version += 1;
            self.table = table;
            self.counts = counts;
            self.follow(survey.plan);
        }
        self.looked = Instant::now();
        Ok(())
    }

    pub(crate) fn shown(&self) -> Shown<'_> {
        let columns = self.table.columns().iter();
        let is_known = |values: &Values| match values {
            Values::Real(values) => values.iter().any(|value| value.is_finite()),
            _ => true,
        };
        Shown {
            version: self.version,
            name: &self.name,
            title: &self.title,
            columns: columns
                .filter(|column| is_known(&column.values))
                .map(|column| ShownColumn {
                    name: &column.name,
                    label: label(&column.name, &column.unit),
                    description: meaning(column),
                    values: &column.values,
                })
                .collect(),
            runs: self.numbers_of_rows(),
            counts: &self.counts,
            growing: self.store.is_some() && self.counts.keys().any(|it| it.is_unfinished()),
            store: self.store.as_ref().map(|store| shell_word(store.path())),
        }
    }

    fn numbers_of_rows(&self) -> Vec<Option<usize>> {
        let identities = identities(&self.table).unwrap_or_default();
        let number = |identity: &Identity| self.numbers.get(identity).copied();
        identities.iter().map(number).collect()
    }

    /// The run of this number.
    pub(crate) fn run(&self, number: usize) -> Option<StudyRun> {
        let plan = self.plan.as_ref()?;
        let identity = self.runs.get(number)?;
        let run = plan.runs().iter().find(|run| run.identity == *identity)?;
        let finished: HashSet<Identity> = identities(&self.table)
            .unwrap_or_default()
            .into_iter()
            .collect();
        // What nobody has computed has nothing to compare with.
        let is_there =
            |it: &&PlannedRun| it.identity == *identity || finished.contains(&it.identity);
        let siblings = plan
            .runs()
            .iter()
            .filter(|it| it.point == run.point)
            .filter(is_there);
        let sibling = |run: &PlannedRun| {
            let replicate = run.replicate;
            let number = *self.numbers.get(&run.identity)?;
            Some(Sibling { number, replicate })
        };
        let folder = self.store.as_ref().map(|store| store.run_folder(*identity));
        let file = |name: &str| Some(folder.as_ref()?.join(name));
        let record = file(files::TIMESERIES).and_then(|path| series(&path));
        let trajectory = file(TrajectoryFormat::Gsd.file_name());
        let identity = identity.to_string();
        Some(StudyRun {
            configuration: plan.configuration(run),
            title: title_of(plan, run),
            stem: format!("{}-{}", file_name(&self.name), &identity[..8]),
            record: record.unwrap_or_default(),
            trajectory: trajectory.filter(|path| path.is_file()),
            within: Within {
                study: self.name.clone(),
                number,
                siblings: siblings.filter_map(sibling).collect(),
            },
        })
    }
}

/// What a column means; a table of an earlier program may say it in other words.
fn meaning(column: &Column) -> &str {
    let known = row_columns().iter().find(|it| it.name == column.name);
    known.map_or(&column.description, |it| it.text)
}

/// The plan of a study with these finished runs.
fn plan_of(design: &Specification, table: &Table) -> Plan {
    let identities = identities(table).unwrap_or_default();
    let times = table.reals("transition_time").unwrap_or_default();
    let finding = |time: &f64| match time.is_nan() {
        true => Finding::NoTransition,
        false => Finding::Transition,
    };
    let findings = identities.into_iter().zip(times.iter().map(finding));
    let findings: HashMap<Identity, Finding> = findings.collect();
    let found = |identity: &Identity| findings.get(identity).copied();
    let mut plan = design.plan().clone();
    refine(design, &mut plan, &found);
    plan
}

/// Identities of the runs of the rows.
fn identities(table: &Table) -> Result<Vec<Identity>, String> {
    let texts = table.texts("identity").map_err(|error| error.to_string())?;
    let parsed = |text: &String| text.parse().map_err(|error| format!("{text}: {error}"));
    texts.iter().map(parsed).collect()
}

/// Time and J/Jmax of a run; `None` if they are not kept or cannot be read.
fn series(path: &Path) -> Option<Vec<(f64, f64)>> {
    let table = parquet::read(path).ok()?;
    let times = table.reals("time").ok()?.iter().copied();
    let ratios = table.reals("flow_rate_ratio").ok()?.iter().copied();
    Some(times.zip(ratios).collect())
}

/// A point in words, such as "width 2.7, strain rate 0.05, from rest".
fn title_of(plan: &Plan, run: &PlannedRun) -> String {
    let point = plan.point(run);
    let mut words: Vec<String> = point
        .settings
        .iter()
        .map(|setting| {
            let key = setting.key.rsplit('.').next().unwrap_or(&setting.key);
            format!("{} {}", key.replace('_', " "), setting.value)
        })
        .collect();
    let start = match point.state {
        InitialState::Rest => "from rest",
        InitialState::Settled => "from settled grains",
        InitialState::Jammed => "from jammed",
        InitialState::Placed => "from placed grains",
    };
    words.push(start.to_owned());
    words.join(", ")
}

/// A name without characters that file names should not have.
fn file_name(name: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    name.chars()
        .map(|letter| if is_plain(letter) { letter } else { '-' })
        .collect()
}
