//! Rows of finished runs with every column, for analyses that need more than a [`Run`](crate::Run) holds.

use peristalsis_formats::{Table, Values};

use crate::crossing::grouped;
use crate::finding::Statistics;
use crate::runs::Start;

/// One row of a study's table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    table: &'a Table,
    row: usize,
}

/// A mean over replicates with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mean {
    pub(crate) value: f64,
    /// From the scatter of the replicates or from the errors of the runs, whichever is larger; NaN where neither is known.
    pub(crate) error: f64,
    /// Runs.
    pub(crate) runs: usize,
}

/// All rows of a table.
pub(crate) fn rows_of(table: &Table) -> Vec<Row<'_>> {
    (0..table.rows()).map(|row| Row { table, row }).collect()
}

/// Rows with the same key, by ascending key.
pub(crate) fn by<'a, K: PartialOrd + Copy>(
    rows: &[Row<'a>],
    key: impl Fn(&Row<'a>) -> K,
) -> Vec<(K, Vec<Row<'a>>)> {
    grouped(rows.iter().copied(), |row| key(&row))
}

impl<'a> Row<'a> {
    /// A number; NaN where the column is not there or holds none.
    pub(crate) fn number(&self, column: &str) -> f64 {
        match self.table.column(column).map(|column| &column.values) {
            Ok(Values::Real(values)) => values[self.row],
            Ok(Values::Integer(values)) => values[self.row] as f64,
            _ => f64::NAN,
        }
    }

    /// A text; empty where the column is not there or holds none.
    pub(crate) fn text(&self, column: &str) -> &'a str {
        match self.table.column(column).map(|column| &column.values) {
            Ok(Values::Text(values)) => &values[self.row],
            _ => "",
        }
    }

    /// How the grains stood at t = 0.
    pub(crate) fn start(&self) -> Start {
        if self.text("initial_state") == "jammed" {
            Start::Jammed
        } else {
            Start::Rest
        }
    }

    /// c \[d/t\].
    pub(crate) fn wave_speed(&self) -> f64 {
        self.number("strain_rate") * self.number("wavelength")
    }
}

/// The mean of what is finite in a column, its error from that of the column `error` and from the scatter; `None` where
/// nothing is.
pub(crate) fn mean(rows: &[Row<'_>], column: &str) -> Option<Mean> {
    mean_of(rows, |row| {
        (row.number(column), row.number(&format!("{column}_error")))
    })
}

/// The same of a value with its error.
pub(crate) fn mean_of(rows: &[Row<'_>], value: impl Fn(&Row<'_>) -> (f64, f64)) -> Option<Mean> {
    let known: Vec<(f64, f64)> = rows
        .iter()
        .map(value)
        .filter(|(value, _)| value.is_finite())
        .collect();
    if known.is_empty() {
        return None;
    }
    let number = known.len() as f64;
    let mean = known.iter().map(|one| one.0).sum::<f64>() / number;
    let own = known.iter().map(|one| one.1 * one.1).sum::<f64>().sqrt() / number;
    let squares: f64 = known.iter().map(|one| (one.0 - mean).powi(2)).sum();
    let scatter = (squares / (number * (number - 1.0))).sqrt();
    Some(Mean {
        value: mean,
        // The larger of the two, and the one that is known where the other is not.
        error: own.max(scatter),
        runs: known.len(),
    })
}

/// How much is behind some rows of one strain rate that differ in a control, which counts as the width, and in the replicate.
pub(crate) fn behind<'a>(rows: &[Row<'a>], control: impl Fn(&Row<'a>) -> f64) -> Statistics {
    Statistics::at_one_rate(rows.iter().map(control))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let real = |values: &[f64]| Values::Real(values.to_vec());
        Table::builder()
            .column("width", "d", "", real(&[2.0, 1.0, 2.0, 2.0]))
            .column("flow", "1", "", real(&[0.4, 0.9, 0.6, f64::NAN]))
            .column("flow_error", "1", "", real(&[0.01, 0.02, 0.01, 0.01]))
            .build()
            .unwrap()
    }

    #[test]
    fn replicates_are_averaged_with_the_larger_error() {
        let table = table();
        let groups = by(&rows_of(&table), |row| row.number("width"));
        assert_eq!(groups.len(), 2);
        assert_eq!(groups[0].0, 1.0);
        let alone = mean(&groups[0].1, "flow").unwrap();
        assert_eq!((alone.value, alone.error, alone.runs), (0.9, 0.02, 1));
        let both = mean(&groups[1].1, "flow").unwrap();
        assert!((both.value - 0.5).abs() < 1e-12 && (both.error - 0.1).abs() < 1e-12);
        assert_eq!(both.runs, 2);
        assert_eq!(mean(&groups[0].1, "pressure"), None);
        assert!(groups[0].1[0].number("pressure").is_nan());
    }
}
