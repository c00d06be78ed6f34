//! The tables of a study: one row per run.

use std::fs;
use std::path::{Path, PathBuf};

use peristalsis_configuration::takes_whole_numbers;
use peristalsis_formats::{Column, Table, Values, csv, parquet};
use peristalsis_run::files;
use serde_json::Value;

use super::run_files::{TIMES, TIMING};
use super::{Index, Store, Survey, Verdict};
use crate::error::{Result, StudyError};
use crate::identity::{Identity, PHYSICS_VERSION};
use crate::plan::{Plan, PlannedRun, Setting, SettingValue};
use crate::row::{PHYSICS, Row};
use crate::store::entry::{Entry, State};

/// Result of an export.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exported {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Those that took the place of a file of the same name.
    pub replaced: Vec<PathBuf>,
    /// Tables of an older export that would say something else beside these: they were removed.
    pub removed: Vec<PathBuf>,
    /// Finished runs in the table.
    pub rows: usize,
    /// Those among them that lost grains through the wall.
    pub leaking: usize,
    /// Runs of the plan that are not finished, those that failed among them.
    pub missing: usize,
    /// Runs of the plan that failed.
    pub failed: usize,
    /// Finished runs that have no time series here: they were imported as rows, or the study does not keep J/Jmax.
    pub without_series: usize,
    /// Runs that were finished and have no seal, or files that differ from it, with what is wrong; they are missing.
    pub quarantined: Vec<(Identity, String)>,
}

/// A finished run and where its row was found.
struct Finished {
    run: PlannedRun,
    row: Row,
    imported: bool,
}

impl Store {
    /// The finished runs of the study, a row each in the order of the axes, every hash checked: the first table of
    /// [`Store::export`].
    ///
    /// # Errors
    /// Errors of reading the store.
    pub fn rows(&self) -> Result<Table> {
        let survey = self.survey()?;
        let (finished, _) = self.finished(&survey, &mut self.index_to_read()?)?;
        rows_table(&survey, &finished)
    }

    /// A survey of the study, and its finished runs from the index, a row each in the order of the axes.
    ///
    /// For looking on while a study is computed: no hash is checked, and no file of a run is touched. Rows
    /// to rely on come from [`Store::rows`].
    ///
    /// # Errors
    /// Errors of reading study file or index.
    pub fn look(&self) -> Result<(Survey, Table)> {
        let survey = self.survey()?;
        let mut finished = Vec::new();
        for run in survey.plan.sorted_runs() {
            let entry = survey.entries.get(&run.identity);
            if let Some(entry) = entry.filter(|it| it.state == State::Done) {
                finished.push(self.finished_by_index(run, entry)?);
            }
        }
        let rows = rows_table(&survey, &finished)?;
        Ok((survey, rows))
    }

    /// A finished run with the row that the index has of it.
    fn finished_by_index(&self, run: PlannedRun, entry: &Entry) -> Result<Finished> {
        let text = entry.row.as_deref().unwrap_or_default();
        let row = Row::from_csv(text).map_err(StudyError::not_rows(self.path()))?;
        Ok(Finished {
            run,
            row,
            imported: entry.reason.is_some(),
        })
    }

    /// Writes the tables of the study into a folder: `NAME.parquet` and `NAME.csv`, a row a finished run in the order of
    /// the axes; `NAME-timing.csv`, what each took; `NAME-failed.csv`, the runs that failed; and with `series`
    /// `NAME-series.parquet`, J/Jmax in time of every run. Where an older export left one of the last two that this one does
    /// not write, it goes.
    ///
    /// Every hash is checked on the way. The first table holds nothing that depends on when, in which order or how often
    /// interrupted the runs were computed: the same study gives the same bytes.
    ///
    /// # Errors
    /// Errors of reading the store and of writing.
    pub fn export(&self, folder: &Path, series: bool) -> Result<Exported> {
        let survey = self.survey()?;
        let mut index = self.index_to_read()?;
        let (finished, quarantined) = self.finished(&survey, &mut index)?;
        fs::create_dir_all(folder).map_err(StudyError::io("make", folder))?;
        let name = &survey.study.name;
        let mut exported = Exported {
            files: Vec::new(),
            replaced: Vec::new(),
            removed: Vec::new(),
            rows: finished.len(),
            leaking: finished.iter().filter(|it| it.row.leaks()).count(),
            missing: survey.plan.runs().len() - finished.len(),
            failed: survey.counts().get(&State::Failed).copied().unwrap_or(0),
            without_series: 0,
            quarantined,
        };
        let mut note = |file: String| {
            let path = folder.join(file);
            if path.exists() {
                exported.replaced.push(path.clone());
            }
            exported.files.push(path.clone());
            path
        };
        let rows = rows_table(&survey, &finished)?;
        parquet::write(&note(format!("{name}.parquet")), &rows)?;
        csv::write(&note(format!("{name}.csv")), &rows)?;
        let timing = self.timing_table(&finished)?;
        csv::write(&note(format!("{name}-timing.csv")), &timing)?;
        let failed = failed_table(&survey)?;
        let [of_failed, of_series] = [
            format!("{name}-failed.csv"),
            format!("{name}-series.parquet"),
        ];
        let has_failed = failed.rows() > 0;
        if has_failed {
            csv::write(&note(of_failed.clone()), &failed)?;
        }
        if series {
            let (table, without) = self.series_table(&finished)?;
            parquet::write(&note(of_series.clone()), &table)?;
            exported.without_series = without;
        }
        for (file, is_written) in [(of_failed, has_failed), (of_series, series)] {
            let path = folder.join(file);
            if !is_written && path.is_file() {
                fs::remove_file(&path).map_err(StudyError::io("remove", &path))?;
                exported.removed.push(path);
            }
        }
        Ok(exported)
    }

    /// Every finished run of the plan, its hashes checked.
    #[expect(
        clippy::type_complexity,
        reason = "both lists are named at the one place that takes them"
    )]
    fn finished(
        &self,
        survey: &Survey,
        index: &mut Index,
    ) -> Result<(Vec<Finished>, Vec<(Identity, String)>)> {
        let (mut finished, mut quarantined) = (Vec::new(), Vec::new());
        for run in survey.plan.sorted_runs() {
            let entry = survey.entries.get(&run.identity);
            let Some(entry) = entry.filter(|it| it.state == State::Done) else {
                continue;
            };
            if entry.reason.is_some() {
                finished.push(self.finished_by_index(run, entry)?);
                continue;
            }
            match self.run_files(run.identity).verdict(None) {
                Verdict::Done { row, .. } => finished.push(Finished {
                    run,
                    row: *row,
                    imported: false,
                }),
                lost => {
                    let (reason, entry) = self.let_go(run.identity, lost)?;
                    index.note([(run.identity, &entry)])?;
                    quarantined.push((run.identity, reason));
                }
            }
        }
        Ok((finished, quarantined))
    }

    fn timing_table(&self, finished: &[Finished]) -> Result<Table> {
        let columns = [
            ["seconds", "s", "seconds that engine and observables took"],
            [TIMES[1], "1/s", "grains times steps over these seconds"],
        ];
        let timed = computed(finished).map(|identity| {
            let text = fs::read_to_string(self.run_folder(identity).join(TIMING)).ok();
            let timing: Option<Value> = text.and_then(|text| serde_json::from_str(&text).ok());
            let timing = timing.unwrap_or_default();
            let numbers = TIMES.map(|name| vec![timing[name].as_f64().unwrap_or(f64::NAN)]);
            (identity, numbers)
        });
        by_run(columns, timed)
    }

    /// J/Jmax in time of every run that was computed here and keeps it, and how many runs have none.
    fn series_table(&self, finished: &[Finished]) -> Result<(Table, usize)> {
        let ratio = "J/Jmax, mean over the interval, grains inside";
        let columns = [
            ["time", "t", "end of the interval that the row is about"],
            ["period", "1", "wavelengths that the wave has run"],
            ["flow_rate_ratio", "1", ratio],
        ];
        let mut series = Vec::new();
        for identity in computed(finished) {
            let table = parquet::read(&self.run_folder(identity).join(files::TIMESERIES))?;
            if table.reals("flow_rate_ratio").is_err() {
                continue;
            }
            let values = columns.map(|[name, ..]| match table.reals(name) {
                Ok(values) => values.to_vec(),
                // A study may keep other columns.
                Err(_) => vec![f64::NAN; table.rows()],
            });
            series.push((identity, values));
        }
        let without = finished.len() - series.len();
        Ok((by_run(columns, series)?, without))
    }
}

/// The runs that were computed here.
fn computed(finished: &[Finished]) -> impl Iterator<Item = Identity> {
    let computed = finished.iter().filter(|one| !one.imported);
    computed.map(|one| one.run.identity)
}

/// A table of the numbers of runs, with name, unit and meaning of each column.
fn by_run<const N: usize>(
    columns: [[&str; 3]; N],
    runs: impl IntoIterator<Item = (Identity, [Vec<f64>; N])>,
) -> Result<Table> {
    let mut identities = Vec::new();
    let mut numbers = [const { Vec::new() }; N];
    for (identity, of_run) in runs {
        identities.extend(std::iter::repeat_n(identity.to_string(), of_run[0].len()));
        for (numbers, of_run) in numbers.iter_mut().zip(of_run) {
            numbers.extend(of_run);
        }
    }
    let identities = Values::Text(identities);
    let mut table = Table::builder().column("identity", "", "the run", identities);
    for ([name, unit, meaning], numbers) in columns.into_iter().zip(numbers) {
        table = table.column(name, unit, meaning, Values::Real(numbers));
    }
    Ok(table.build()?)
}

/// The rows with the keys of the axes before them.
fn rows_table(survey: &Survey, finished: &[Finished]) -> Result<Table> {
    let mut rows: Option<Table> = None;
    for one in finished {
        match &mut rows {
            None => rows = Some(one.row.table().clone()),
            Some(rows) => rows.append(one.row.table().clone())?,
        }
    }
    let rows = rows.unwrap_or_else(Row::no_rows);
    let runs: Vec<PlannedRun> = finished.iter().map(|one| one.run).collect();
    let study = &survey.study;
    Ok(Table::builder()
        .columns(axis_columns(&survey.plan, &runs))
        .columns(rows.columns().iter().cloned())
        .metadata("peristalsis.study", &study.name)
        .metadata("peristalsis.title", &study.title)
        .metadata(PHYSICS, PHYSICS_VERSION.to_string())
        .build()?)
}

/// One column for each key of the axes.
fn axis_columns(plan: &Plan, runs: &[PlannedRun]) -> Vec<Column> {
    let Some(first) = plan.points().first() else {
        return Vec::new();
    };
    let column = |(index, setting): (usize, &Setting)| {
        let values: Vec<&SettingValue> = runs
            .iter()
            .map(|run| &plan.point(run).settings[index].value)
            .collect();
        Column {
            name: setting.key.clone(),
            unit: String::new(),
            description: "key of an axis of the study".to_owned(),
            values: column_values(&setting.key, &values),
        }
    };
    first.settings.iter().enumerate().map(column).collect()
}

/// Values as numbers where all are, whole ones where the key takes no others, else as text.
fn column_values(key: &str, values: &[&SettingValue]) -> Values {
    if takes_whole_numbers(key) {
        let whole = |value: &&SettingValue| match value {
            SettingValue::Whole(whole) => Some(*whole),
            _ => None,
        };
        if let Some(whole) = values.iter().map(whole).collect() {
            return Values::Integer(whole);
        }
    }
    if values.iter().all(|value| value.number().is_some()) {
        let numbers = values.iter().filter_map(|value| value.number());
        return Values::Real(numbers.collect());
    }
    Values::Text(values.iter().map(ToString::to_string).collect())
}

/// The runs of the plan that failed, each with its reason.
fn failed_table(survey: &Survey) -> Result<Table> {
    let failed: Vec<(PlannedRun, &Entry)> = survey
        .plan
        .sorted_runs()
        .into_iter()
        .filter_map(|run| {
            let entry = survey.entries.get(&run.identity)?;
            (entry.state == State::Failed).then_some((run, entry))
        })
        .collect();
    let runs: Vec<PlannedRun> = failed.iter().map(|(run, _)| *run).collect();
    let identities = Values::Text(runs.iter().map(|run| run.identity.to_string()).collect());
    let replicates = Values::Integer(runs.iter().map(|run| run.replicate.into()).collect());
    let number = "number of the replicate, from 0";
    let reasons = failed.iter().map(|(_, entry)| entry.reason.clone());
    let reasons = Values::Text(reasons.map(Option::unwrap_or_default).collect());
    Ok(Table::builder()
        .columns(axis_columns(&survey.plan, &runs))
        .column("identity", "", "the run", identities)
        .column("replicate", "1", number, replicates)
        .column("reason", "", "the error that it ended in", reasons)
        .build()?)
}
