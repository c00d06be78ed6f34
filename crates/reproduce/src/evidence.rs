//! What the studies have found so far.

use std::collections::BTreeMap;

use peristalsis_formats::{Table, parquet};
use peristalsis_run::files;
use peristalsis_study::Store;

use crate::error::{ReproduceError, Result};
use crate::row::{Row, check, rows_of};

/// The results of one study.
#[derive(Clone, Debug)]
pub struct StudyResults {
    /// Where the products of the runs are; `None` for rows from elsewhere.
    store: Option<Store>,
    /// Where those are that were computed again for their products.
    again: Option<Store>,
    /// Finished runs, a row each, in the order of the axes.
    table: Table,
}

/// The results of the studies that are there, by name.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    studies: BTreeMap<String, StudyResults>,
}

impl Evidence {
    /// Adds the results of a study; `again` holds products of runs of which `store` has only imported rows.
    ///
    /// # Errors
    /// Errors of reading the store.
    pub fn add(&mut self, store: Store, again: Option<Store>) -> Result<()> {
        let survey = store.survey()?;
        let table = store.rows()?;
        check(&table)?;
        let results = StudyResults {
            store: Some(store),
            again,
            table,
        };
        self.studies.insert(survey.study.name, results);
        Ok(())
    }

    /// Adds a table of runs as the results of a study, without their time series.
    ///
    /// # Errors
    /// A column that every row has is missing or of another kind.
    pub fn add_table(&mut self, name: &str, table: Table) -> Result<()> {
        check(&table)?;
        let results = StudyResults {
            store: None,
            again: None,
            table,
        };
        self.studies.insert(name.to_owned(), results);
        Ok(())
    }

    /// The results of a study.
    ///
    /// # Errors
    /// [`ReproduceError::NoSuchStudy`].
    pub fn study(&self, name: &str) -> Result<&StudyResults> {
        self.studies
            .get(name)
            .ok_or_else(|| ReproduceError::NoSuchStudy(name.to_owned()))
    }

    /// The finished runs of several studies, one study after the other.
    pub(crate) fn rows(&self, studies: &[&str]) -> Result<Vec<Row<'_>>> {
        let rows = studies.iter().map(|name| Ok(self.study(name)?.rows()));
        Ok(rows.collect::<Result<Vec<_>>>()?.concat())
    }
}

/// The first of some runs whose product was kept, with the product; `None` where no run's was.
pub(crate) fn first_kept<'a>(
    rows: &[Row<'a>],
    product: impl Fn(&Row<'a>) -> Result<Option<Table>>,
) -> Result<Option<(Row<'a>, Table)>> {
    for row in rows {
        if let Some(table) = product(row)? {
            return Ok(Some((*row, table)));
        }
    }
    Ok(None)
}

impl StudyResults {
    /// The finished runs in the order of the axes.
    pub fn rows(&self) -> Vec<Row<'_>> {
        rows_of(&self.table)
    }

    /// The time series of a run; `None` where only its row was imported.
    ///
    /// # Errors
    /// Errors of reading.
    pub fn series(&self, row: &Row<'_>) -> Result<Option<Table>> {
        self.product(row, files::TIMESERIES)
    }

    /// A table that a run may have kept, by the name of its [file](files); `None` where it was not kept, or only its row was
    /// imported.
    pub(crate) fn product(&self, row: &Row<'_>, file: &str) -> Result<Option<Table>> {
        let Ok(identity) = row.identity().parse() else {
            return Ok(None);
        };
        let stores = [&self.store, &self.again].into_iter().flatten();
        let path = stores
            .map(|store| store.run_folder(identity).join(file))
            .find(|path| path.is_file());
        Ok(path.map(|path| parquet::read(&path)).transpose()?)
    }

    /// J/Jmax averaged over each period of a run; `None` where only its row was imported, or its series is too coarse.
    pub(crate) fn period_averages(&self, row: &Row<'_>) -> Result<Option<Vec<f64>>> {
        let Some(table) = self.series(row)? else {
            return Ok(None);
        };
        let (period, ratio) = (table.reals("period")?, table.reals("flow_rate_ratio")?);
        // A row belongs to the period in which it ends.
        let ends = period.iter().map(|end| (end - 1e-6).floor());
        let rows: Vec<(f64, f64)> = ends.zip(ratio.iter().copied()).collect();
        let averages = rows.chunk_by(|one, other| one.0 == other.0).map(|rows| {
            let ratios = rows.iter().map(|row| row.1);
            ratios.sum::<f64>() / rows.len() as f64
        });
        let mut averages: Vec<f64> = averages.collect();
        // Of a run so long that a row covers several periods nothing is known of each.
        let last = rows.last().map_or(0.0, |row| row.0 + 1.0);
        if averages.len() as f64 != last {
            return Ok(None);
        }
        // What a run did of its last period is not an average over it.
        if period
            .last()
            .is_some_and(|end| (end - end.round()).abs() > 1e-6)
        {
            averages.pop();
        }
        Ok(Some(averages))
    }
}
