//! Rows of finished runs with every column, for analyses that need more than a [`Run`](crate::Run) holds.

pub(crate) use crate::row::{Row, behind, grouped};

/// A mean over replicates with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mean {
    pub(crate) value: f64,
    /// From the scatter of the replicates or from the errors of the runs, whichever is larger; NaN where neither is known.
    pub(crate) error: f64,
    /// Runs.
    pub(crate) runs: usize,
}

/// Rows with the same key, by ascending key.
pub(crate) fn by<'a, K: PartialOrd + Copy>(
    rows: &[Row<'a>],
    key: impl Fn(&Row<'a>) -> K,
) -> Vec<(K, Vec<Row<'a>>)> {
    grouped(rows.iter().copied(), key)
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
