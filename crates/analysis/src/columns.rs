//! Operations on columns of numbers that several estimators share.

/// Distinct values in increasing order; -0 and 0 are one.
pub(crate) fn distinct(column: &[f64]) -> Vec<f64> {
    let mut sorted = column.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    sorted
}

/// Rows by the width that stands beside each: the distinct widths in increasing order, and the rows of each in theirs.
pub(crate) fn by_width<T: Copy>(width: &[f64], rows: &[T]) -> (Vec<f64>, Vec<Vec<T>>) {
    let places = distinct(width);
    let rows_at = |&place: &f64| {
        let beside = width.iter().zip(rows).filter(|(width, _)| **width == place);
        beside.map(|(_, &row)| row).collect()
    };
    let rows = places.iter().map(rows_at).collect();
    (places, rows)
}

/// Arithmetic mean, summed in order as deviations from the first value, so that equal values have exactly theirs; NaN of none.
pub(crate) fn mean_of(series: &[f64]) -> f64 {
    let first = series.first().copied().unwrap_or(f64::NAN);
    first + series.iter().map(|x| x - first).sum::<f64>() / series.len() as f64
}

/// Mean, and the sum of the squared deviations from it.
pub(crate) fn mean_and_scatter(series: &[f64]) -> (f64, f64) {
    let mean = mean_of(series);
    (mean, series.iter().map(|x| (x - mean) * (x - mean)).sum())
}

/// Jackknife error of an estimator from its values with one replicate left out: `sqrt((n - 1)/n sum (v_i - <v>)^2)`.
///
/// Source: Efron & Tibshirani, An Introduction to the Bootstrap (1993), chapter 11.
pub fn jackknife_error(without_one: &[f64]) -> f64 {
    let replicates = without_one.len() as f64;
    let (_, scatter) = mean_and_scatter(without_one);
    ((replicates - 1.0) / replicates * scatter).sqrt()
}
