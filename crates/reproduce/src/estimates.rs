//! Numbers with errors put together: differences, means and powers.

use peristalsis_analysis::{LineFit, Uncertain, power_exponent};

use crate::thresholds::LEAST_RATES;

/// One number less another, where an error that is not known, of a single run for instance, counts as none.
pub(crate) fn distance(one: &Uncertain, other: &Uncertain) -> Uncertain {
    let known = |number: &Uncertain| match number.error.is_nan() {
        true => Uncertain::normal(number.value, 0.0),
        false => *number,
    };
    known(one) - known(other)
}

/// Numbers with errors as columns for fits: abscissa, value, and error, which is at least `least`.
pub(crate) fn columns(
    numbers: impl IntoIterator<Item = (f64, Uncertain)>,
    least: f64,
) -> [Vec<f64>; 3] {
    let mut columns: [Vec<f64>; 3] = Default::default();
    for (x, number) in numbers {
        columns[0].push(x);
        columns[1].push(number.value);
        columns[2].push(number.error.max(least));
    }
    columns
}

/// A number midway between two bounds, of which no more is known.
pub(crate) fn bracket(lower: f64, upper: f64) -> Uncertain {
    Uncertain::bracketed(0.5 * (lower + upper), lower, upper)
}

/// Weighted mean of several estimates; the error grows with their scatter where that exceeds their errors (Birge's
/// ratio). `None` without a finite one.
pub(crate) fn weighted_mean(estimates: &[Uncertain]) -> Option<Uncertain> {
    let usable: Vec<&Uncertain> = estimates
        .iter()
        .filter(|one| one.value.is_finite() && one.error.is_finite() && one.error > 0.0)
        .collect();
    if usable.is_empty() {
        return None;
    }
    let weights: f64 = usable.iter().map(|one| one.error.powi(-2)).sum();
    let weighted = usable.iter().map(|one| one.value * one.error.powi(-2));
    let mean = weighted.sum::<f64>() / weights;
    let squares = usable
        .iter()
        .map(|one| ((one.value - mean) / one.error).powi(2));
    let chi_squared: f64 = squares.sum();
    let freedom = usable.len() - 1;
    let ratio = (chi_squared / freedom.max(1) as f64).sqrt();
    Some(stretched(mean, weights.powf(-0.5), ratio, freedom))
}

/// The slope of a line, its error stretched to the scatter about the line.
pub(crate) fn slope(line: &LineFit) -> Uncertain {
    let LineFit { slope, .. } = line;
    stretched(
        slope.value,
        slope.error,
        line.scale_factor(),
        line.degrees_of_freedom,
    )
}

/// A number with its error, stretched by a ratio above 1. Below, the errors of the data are taken as they are, with normal
/// intervals; above, the error comes from their scatter, with Student's, which are wider at once where data are few.
fn stretched(value: f64, error: f64, ratio: f64, degrees_of_freedom: usize) -> Uncertain {
    match ratio > 1.0 {
        true => Uncertain::student(value, ratio * error, degrees_of_freedom),
        false => Uncertain::normal(value, error),
    }
}

/// The power of another number, mostly the strain rate, with which one goes, its error stretched to the scatter; `None` with
/// too few positive ones.
pub(crate) fn fitted_power(
    numbers: impl IntoIterator<Item = (f64, Uncertain)>,
) -> Option<Uncertain> {
    logarithmic_line(numbers).as_ref().map(slope)
}

/// The line of the logarithms of two numbers; `None` with too few positive ones.
pub(crate) fn logarithmic_line(
    numbers: impl IntoIterator<Item = (f64, Uncertain)>,
) -> Option<LineFit> {
    let known = numbers.into_iter();
    let known = known.filter(|(_, one)| one.value > 0.0 && one.error > 0.0);
    let [x, value, error] = columns(known, 0.0);
    let line = power_exponent(&x, &value, &error).ok()?;
    (x.len() >= LEAST_RATES).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bracket_knows_its_ends() {
        let width = bracket(2.7, 2.8);
        assert!((width.value - 2.75).abs() < 1e-12 && width.interval_95.upper == 2.8);
    }

    #[test]
    fn estimates_that_scatter_widen_the_error_of_their_mean() {
        let agreeing = weighted_mean(&[Uncertain::normal(1.0, 0.1), Uncertain::normal(1.0, 0.1)]);
        assert!((agreeing.unwrap().error - 0.1 / 2_f64.sqrt()).abs() < 1e-12);
        let scattered =
            weighted_mean(&[Uncertain::normal(0.0, 0.1), Uncertain::normal(2.0, 0.1)]).unwrap();
        assert!((scattered.value - 1.0).abs() < 1e-12 && (scattered.error - 1.0).abs() < 1e-12);
        assert!(weighted_mean(&[]).is_none());
    }
}
