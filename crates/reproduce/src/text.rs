//! Numbers as sentences and cells of tables say them, in the markup of figures.

use peristalsis_analysis::Uncertain;

/// Value and standard error with as many digits as the error deserves: two where its first digit is 1, else one.
pub(crate) fn with_error(value: f64, error: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if !(error.is_finite() && error > 0.0) {
        return typeset(&format!("{value:.4}"));
    }
    let mut decimals = -(error.log10().floor() as i32);
    let leading = error * 10_f64.powi(decimals);
    if leading < 1.95 {
        decimals += 1;
    }
    let digits = decimals.max(0) as usize;
    typeset(&format!("{value:.digits$} ± {error:.digits$}"))
}

/// The same of an estimate.
pub(crate) fn estimate(number: &Uncertain) -> String {
    with_error(number.value, number.error)
}

/// The interval that covers the truth in 95 per cent of repetitions.
pub(crate) fn interval(number: &Uncertain) -> String {
    let end = |value: f64| match value {
        value if value == f64::INFINITY => "∞".to_owned(),
        value if value == f64::NEG_INFINITY => "−∞".to_owned(),
        value => typeset(&format!("{value:.3}")),
    };
    format!(
        "{} … {}",
        end(number.interval_95.lower),
        end(number.interval_95.upper)
    )
}

/// A probability; very small ones come from the tails of approximate distributions, and are called small.
pub(crate) fn probability(value: f64) -> String {
    if value < 1e-3 {
        "< 0.001".to_owned()
    } else {
        number(value, 3)
    }
}

/// A plain number with so many decimals.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        // No minus before what is zero in these digits.
        let rounded = 10_f64.powi(decimals as i32);
        let value = if (value * rounded).round() == 0.0 {
            0.0
        } else {
            value
        };
        typeset(&format!("{value:.decimals$}"))
    } else {
        "–".to_owned()
    }
}

/// A minus sign in place of the hyphen.
fn typeset(text: &str) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_one_digit_or_two() {
        assert_eq!(with_error(2.79412, 0.0031), "2.794 ± 0.003");
        assert_eq!(with_error(2.79412, 0.0131), "2.794 ± 0.013");
        assert_eq!(with_error(-3.756, 0.31), "−3.8 ± 0.3");
        assert_eq!(with_error(1234.0, 56.0), "1234 ± 56");
        assert_eq!(with_error(f64::NAN, 1.0), "–");
    }
}
